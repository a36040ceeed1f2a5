    // The map: a chain of registers through all cells, the first cell last in it. All cells are obstacles
    // after power-up.
    wire chain [0:CELLS]; // 1 for a free cell
    assign chain[CELLS] = ~scan_in;
    assign scan_out = ~chain[0];
    wire stop = reset | load_map;
