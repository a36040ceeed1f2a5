    // The map: 1 for an obstacle. Cells that are obstacles need no hardware.
    localparam [0:CELLS-1] OBSTACLES = {
@ROWS@
    };
    wire stop = reset;
