// One of the 16 memories of the map: tiles of 2 x 2 cells, 1 for an obstacle.
module map_bank #(
    parameter ADDRESS_BITS = 10, // the bank holds 2^ADDRESS_BITS tiles
    parameter IMAGE = ""         // the file of its contents, for $readmemh
) (
    input  wire                    clk,
    input  wire [ADDRESS_BITS-1:0] address, // which tile
    output reg  [3:0]              tile     // a clock later: from bit 0 the upper two cells, the lower two
);
    (* ram_style = "block", rom_style = "block" *)
    reg [3:0] tiles [0:(1 << ADDRESS_BITS) - 1];

    generate
        if (IMAGE != "") begin : filled
            initial $readmemh(IMAGE, tiles);
        end
    endgenerate

    always @(posedge clk)
        tile <= tiles[address];
endmodule
