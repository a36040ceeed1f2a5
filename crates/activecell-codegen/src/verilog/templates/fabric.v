@ABOUT@
`default_nettype none

module fabric #(
@SIZE_PARAMETERS@    parameter COLUMN_BITS = @COLUMN_BITS@, // enough for WIDTH - 1
    parameter ROW_BITS = @ROW_BITS@ // enough for HEIGHT - 1
) (
    input  wire                   clk,
    input  wire                   reset,       // active high; ends any task, begins none; needed at first
@MAP_PORTS@    input  wire                   begin_task,  // for one clock: a task begins, in place of any other
    input  wire [COLUMN_BITS-1:0] start_x,     // column and row where the robot is, taken with begin_task
    input  wire [ROW_BITS-1:0]    start_y,
    input  wire [COLUMN_BITS-1:0] target_x,    // where it is to go; an obstacle, or outside: unreachable
    input  wire [ROW_BITS-1:0]    target_y,
    output reg                    busy,        // a task is being done
    output reg                    moving,      // at_x, at_y are a cell of the way
    output reg  [COLUMN_BITS-1:0] at_x,        // while moving one cell of the way a clock: first the start,
    output reg  [ROW_BITS-1:0]    at_y,        //   last the target, where they stay
    output reg                    arrived,     // the task is done: the way was shown to its end
    output reg                    unreachable  // the task is done: no way leads to the target
);
@SIZE_CONSTANTS@    localparam CELLS = WIDTH * HEIGHT;
    localparam COLOURS = @COLOURS@; // a cell and its neighbours all have different ones

    generate
        if (WIDTH > 1 << COLUMN_BITS || HEIGHT > 1 << ROW_BITS) begin : guard
            // There is no such module: its name is the message.
            COLUMN_BITS_or_ROW_BITS_of_fabric_are_too_few stop_here ();
        end
    endgenerate

@MAP@    wire clear = stop | begin_task;

    // The task, one bit a column and a row: short wires instead of comparisons in every cell.
    localparam [WIDTH-1:0]  FIRST_COLUMN = 1;
    localparam [HEIGHT-1:0] FIRST_ROW = 1;
    reg [WIDTH-1:0]  start_column;
    reg [HEIGHT-1:0] start_row;
    reg [WIDTH-1:0]  target_column;
    reg [HEIGHT-1:0] target_row;
    always @(posedge clk)
        if (stop) begin
            start_column <= 0;
            start_row <= 0;
            target_column <= 0;
            target_row <= 0;
        end else if (begin_task) begin
            start_column <= FIRST_COLUMN << start_x;
            start_row <= FIRST_ROW << start_y;
            target_column <= FIRST_COLUMN << target_x;
            target_row <= FIRST_ROW << target_y;
        end

`ifdef FORMAL
    wire [CELLS-1:0] formal_active;
    reg formal_begun = 1'b0; // the first clock is over
    always @(posedge clk)
        formal_begun <= 1'b1;
`endif

    // The cells, within a frame of places where nothing is ever reached: the map's row 0 is row 1 here, its
    // column 0 is column 1. Arrays, not vectors of the whole map: each place is a wire of its own, and
    // simulators wake only those that look at it.
    wire               reached [0:HEIGHT + 1][0:WIDTH + 1];
    wire               active [0:HEIGHT + 1][0:WIDTH + 1];
    wire [@TOP@:0]         leaving [0:HEIGHT + 1][0:WIDTH + 1];
    wire [COLOURS-1:0] colour_seen [0:HEIGHT + 1][0:WIDTH + 1]; // the robot's, if it is here or further left
    wire               wave_seen [0:HEIGHT + 1][0:WIDTH + 1]; // coming to a watched cell here or further left
    genvar x, y;
    generate
        for (y = 0; y < HEIGHT + 2; y = y + 1) begin : row
            for (x = 0; x < WIDTH + 2; x = x + 1) begin : column
                if (x == 0 || x > WIDTH || y == 0 || y > HEIGHT) begin : frame
                    assign reached[y][x] = 1'b0;
                    assign active[y][x] = 1'b0;
                    assign leaving[y][x] = 0;
                    assign colour_seen[y][x] = 0;
                    assign wave_seen[y][x] = 1'b0;
                end else begin : on_map
                    localparam COLUMN = x - 1;
                    localparam ROW = y - 1;
                    localparam HERE = ROW * WIDTH + COLUMN; // the number of the cell on the map
                    localparam COLOUR = @COLOUR@;
                    localparam WATCHED = @WATCHED@ != 0; // one of two side by side is
@ODD@@IS_FREE@                    wire here_is_target = target_column[COLUMN] & target_row[ROW];
                    wire here_is_start = start_column[COLUMN] & start_row[ROW];
                    wire is_front;
                    wire [@TOP@:0] reached_around = {
@REACHED@
                    };
                    wire [@TOP@:0] entering = {
@ENTERING@
                    };
                    wire [@TOP@:0] pointer;
                    fabric_cell_@LATTICE@ cell_here (
                        .clk(clk),
                        .clear(clear),
                        .is_free(is_free),
                        .is_target(here_is_target),
                        .is_start(here_is_start),
                        .reached_around(reached_around),
                        .entering(entering),
                        .reached(reached[y][x]),
                        .is_front(is_front),
                        .pointer(pointer),
                        .active(active[y][x]),
                        .leaving(leaving[y][x])
                    );
                    assign colour_seen[y][x] = colour_seen[y][x - 1] | active[y][x] << COLOUR;
                    assign wave_seen[y][x] = wave_seen[y][x - 1] | (WATCHED & is_front);

`ifdef FORMAL
                    wire here_is_reached = reached[y][x];
                    assign formal_active[HERE] = active[y][x];
                    always @*
                        if (formal_begun) begin
                            // The wave never enters an obstacle, the robot goes where the wave has been.
                            assert (!here_is_reached || is_free);
                            assert (!formal_active[HERE] || here_is_reached);
                            // A pointer leads to a cell that the wave has reached; only the target has none.
                            assert (!here_is_reached || (pointer & ~reached_around) == 0);
                            assert (!here_is_reached || (pointer & (pointer - 1)) == 0);
                            assert (!here_is_reached || pointer != 0 || here_is_target);
                            // The start makes the active bit once: afterwards it is reached for good.
                            assert (!here_is_start || formal_active == 0 || (here_is_reached && !is_front));
                        end
`endif
                end
            end
        end
    endgenerate

    // The robot's colour, and whether the wave still spreads: by rows, then altogether, each in a clock, so
    // that the fabric's speed is that of its cells. Two colours that follow each other are a move. A wave
    // that spreads comes from a cell to one beside it: of two clocks, one sees it in a watched cell.
    reg [HEIGHT*COLOURS-1:0] row_colour; // a clock ago, row by row
    reg [HEIGHT-1:0]         row_front;
    generate
        for (y = 0; y < HEIGHT; y = y + 1) begin : row_sum
            always @(posedge clk) begin
                row_colour[COLOURS*y +: COLOURS] <= clear ? 0 : colour_seen[y + 1][WIDTH];
                row_front[y] <= ~clear & wave_seen[y + 1][WIDTH];
            end
        end
    endgenerate

    reg [COLOURS-1:0] colour_in_rows;
    always @* begin : all_rows
        integer each;
        colour_in_rows = 0;
        for (each = 0; each < HEIGHT; each = each + 1)
            colour_in_rows = colour_in_rows | row_colour[COLOURS*each +: COLOURS];
    end

    reg [COLOURS-1:0] colour;      // the robot's colour, two clocks ago; none before the wave has come to it
    reg [COLOURS-1:0] last_colour; // three clocks ago
@MOVES@

    // The control: a task ends when the robot is at the target, where the active bit ends, or when the wave
    // has stopped and no cell is active.
    reg       front_seen;      // the wave was seen, two clocks ago
    reg       last_front_seen; // three clocks ago
    reg [4:0] warm_up;         // clocks from the beginning until the wave is seen here
    wire      at_target = moving & ~|colour;
    wire      stopped = warm_up[4] & ~front_seen & ~last_front_seen & ~|colour & ~moving;
    always @(posedge clk) begin
        if (clear) begin
            busy <= ~stop;
            warm_up <= 5'b00001;
            front_seen <= 1'b0;
            last_front_seen <= 1'b0;
            colour <= 0;
            last_colour <= 0;
            moving <= 1'b0;
            arrived <= 1'b0;
            unreachable <= 1'b0;
            if (begin_task) begin
                at_x <= start_x;
                at_y <= start_y;
            end
        end else begin
            warm_up <= {warm_up[4] | warm_up[3], warm_up[2:0], 1'b0};
            front_seen <= |row_front;
            last_front_seen <= front_seen;
            colour <= colour_in_rows;
            last_colour <= colour;
            moving <= |colour;
            arrived <= arrived | at_target;
            unreachable <= unreachable | busy & stopped & ~arrived;
            if (at_target | stopped)
                busy <= 1'b0;
            if (right)
                at_x <= at_x + 1'b1;
            else if (left)
                at_x <= at_x - 1'b1;
            if (down)
                at_y <= at_y + 1'b1;
            else if (up)
                at_y <= at_y - 1'b1;
        end
    end

`ifdef FORMAL
    // What is proven by induction for every map, whatever is loaded or begun at any clock, after a first
    // clock of reset.
    always @*
        if (formal_begun) begin
            assert ((formal_active & (formal_active - 1)) == 0); // at most one cell is active
            assert ((start_column & (start_column - 1)) == 0);
            assert ((start_row & (start_row - 1)) == 0);
        end else
            assume (reset);
`endif
endmodule

`default_nettype wire
