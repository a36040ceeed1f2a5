    // The map: a chain of registers through all cells, 1 for an obstacle.
    reg [0:CELLS-1] obstacles;
    always @(posedge clk)
        if (load_map)
            obstacles <= obstacles << 1 | scan_in;
    assign scan_out = obstacles[0];
    wire stop = reset | load_map;
