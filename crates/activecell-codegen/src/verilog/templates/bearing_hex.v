// Where the target lies as seen from a cell: the comparisons from which the sector follows.
//
// Across is counted in half cells, since odd rows stand half a cell to the right; down in rows. So a step
// along a row is 2 across, any other step 1 across and 1 down.
`default_nettype none

module bearing_hex #(
    parameter COLUMN_BITS = 8, // bits of a column's number
    parameter ROW_BITS    = 8  // bits of a row's number
) (
    input  wire [COLUMN_BITS-1:0] x,        // the cell's column
    input  wire [ROW_BITS-1:0]    y,        // the cell's row, 0 on top
    input  wire [COLUMN_BITS-1:0] target_x, // the target's column
    input  wire [ROW_BITS-1:0]    target_y, // the target's row
    output wire                   is_left,  // the target lies to the left
    output wire                   is_right, // the target lies to the right
    output wire                   is_above, // the target lies above
    output wire                   is_below, // the target lies below
    output wire                   is_wide,  // farther across than down
    output wire                   is_level, // as far across as down
    output wire                   is_flat,  // farther across than three times down
    output wire                   is_even,  // as far across as three times down
    output wire                   is_near   // the target is a neighbour
);
    localparam BITS = (COLUMN_BITS > ROW_BITS ? COLUMN_BITS : ROW_BITS) + 4;

    // Half cells from the left edge to the centres, less the half cell that both have: twice the column,
    // 1 more in odd rows.
    wire signed [BITS-1:0] across = $signed({1'b0, target_x, target_y[0]}) - $signed({1'b0, x, y[0]});
    wire signed [BITS-1:0] down   = $signed({1'b0, target_y}) - $signed({1'b0, y});
    wire signed [BITS-1:0] thrice = down + (down <<< 1);

    assign is_left  = across < 0;
    assign is_right = ~is_left & (across != 0);
    assign is_above = down < 0;
    assign is_below = ~is_above & (down != 0);

    // One is farther than the other if their sum and their difference have the same sign, and as far if
    // one of these is 0.
    wire signed [BITS-1:0] sum         = across + down;
    wire signed [BITS-1:0] rest        = across - down;
    wire signed [BITS-1:0] thrice_sum  = across + thrice;
    wire signed [BITS-1:0] thrice_rest = across - thrice;

    assign is_level = (sum == 0) | (rest == 0);
    assign is_wide  = ~is_level & ((sum < 0) == (rest < 0));
    assign is_even  = (thrice_sum == 0) | (thrice_rest == 0);
    assign is_flat  = ~is_even & ((thrice_sum < 0) == (thrice_rest < 0));

    assign is_near = ((down == 0) & ((across == 2) | (across == -2)))
                   | (is_level & ((across == 1) | (across == -1)));
endmodule

`default_nettype wire
