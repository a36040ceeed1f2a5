// Where the target lies as seen from a cell: the comparisons from which the sector follows.
`default_nettype none

module bearing_square #(
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
    output wire                   is_near   // the target is a neighbour
);
    wire is_column = x == target_x;
    wire is_row    = y == target_y;

    assign is_left  = target_x < x;
    assign is_right = ~is_left & ~is_column;
    assign is_above = target_y < y;
    assign is_below = ~is_above & ~is_row;

    // One column aside in the same row, or one row in the same column. The literal widens the sums, so
    // none wraps.
    wire is_column_aside = (x + 1 == target_x) | (target_x + 1 == x);
    wire is_row_aside    = (y + 1 == target_y) | (target_y + 1 == y);

    assign is_near = (is_row & is_column_aside) | (is_column & is_row_aside);
endmodule

`default_nettype wire
