    input  wire                   load_map,    // takes scan_in, the map moves on by a cell; ends any task
    input  wire                   scan_in,     // the map, row by row from the top left, 1 for an obstacle
    output wire                   scan_out,    // the map that was loaded before, in the same order
