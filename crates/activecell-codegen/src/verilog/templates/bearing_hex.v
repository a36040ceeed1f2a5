// Where the target lies as seen from a cell: the comparisons from which the sector follows.
//
// Across is counted in half cells, since odd rows stand half a cell to the right; down in rows. So a step along a row is
// 2 across, any other step 1 across and 1 down.
module bearing_hex #(
    parameter X_BITS = 8, // bits of a column's number
    parameter Y_BITS = 8  // bits of a row's number
) (
    input  wire [X_BITS-1:0] x,        // the cell's column
    input  wire [Y_BITS-1:0] y,        // the cell's row, 0 on top
    input  wire [X_BITS-1:0] target_x, // the target's column
    input  wire [Y_BITS-1:0] target_y, // the target's row
    output wire              is_left,  // the target lies to the left
    output wire              is_right, // the target lies to the right
    output wire              is_above, // the target lies above
    output wire              is_below, // the target lies below
    output wire              is_wide,  // farther across than down
    output wire              is_level, // as far across as down
    output wire              is_flat,  // farther across than three times down
    output wire              is_even,  // as far across as three times down
    output wire              is_near   // the target is a neighbour
);
    // Half cells from the left edge to the centres, less the half cell that both have.
    wire [X_BITS:0] half        = {x, y[0]};
    wire [X_BITS:0] target_half = {target_x, target_y[0]};

    assign is_left  = target_half < half;
    assign is_right = ~is_left & half != target_half;
    assign is_above = target_y < y;
    assign is_below = ~is_above & y != target_y;

    wire [X_BITS:0]   across   = is_left ? half - target_half : target_half - half;
    wire [Y_BITS-1:0] down     = is_above ? y - target_y : target_y - y;
    wire [Y_BITS+1:0] down_thrice = {1'b0, down, 1'b0} + down;

    assign is_wide  = across > down;
    assign is_level = across == down;
    assign is_flat  = across > down_thrice;
    assign is_even  = across == down_thrice;

    assign is_near = down == 0 & across == 2 | down == 1 & across == 1;
endmodule
