        load_map    : in  std_logic;                                  -- moves the map on by a cell; ends any task
        scan_in     : in  std_logic;                                  -- the map row by row, 1 for an obstacle
        scan_out    : out std_logic;                                  -- the map that was loaded before
