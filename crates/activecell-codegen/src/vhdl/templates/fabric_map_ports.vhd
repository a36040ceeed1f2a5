        -- Takes scan_in, the map moves on by a cell; ends any task.
        load_map    : in  std_logic;
        -- The map, row by row from the top left, 1 for an obstacle.
        scan_in     : in  std_logic;
        -- What leaves: the map that was loaded before, in the same order.
        scan_out    : out std_logic;
