// The fabric: the map as cells of hardware, each a small automaton (@LATTICE@, @WIDTH@ by @HEIGHT@ cells).
//
// A wave spreads from the target, a cell a clock. Each free cell keeps the direction from which the wave came
// first: its pointer. When the wave comes to the start, the start becomes the active cell; the active bit
// then follows the pointers, a move a clock, along a shortest way. At the target, which has no pointer, it
// ends.
//
// Cells are counted in columns from the left and rows from the top, from 0.
// A task whose way has n steps takes 2 n + 7 clocks, the one in which it begins among them.
module fabric #(
    parameter WIDTH = @WIDTH@,         // columns
    parameter HEIGHT = @HEIGHT@,        // rows
    parameter COLUMN_BITS = @COLUMN_BITS@,    // enough for WIDTH - 1
    parameter ROW_BITS = @ROW_BITS@        // enough for HEIGHT - 1
) (
    input  wire                   clk,
    input  wire                   reset,       // ends any task
@MAP_PORTS@    input  wire                   begin_task,  // takes the four inputs below and begins, also within a task
    input  wire [COLUMN_BITS-1:0] start_x,
    input  wire [ROW_BITS-1:0]    start_y,
    input  wire [COLUMN_BITS-1:0] target_x,
    input  wire [ROW_BITS-1:0]    target_y,
    output reg                    busy,        // a task is being done
    output reg                    moving,      // the robot was in the cell below, three clocks ago
    output reg  [COLUMN_BITS-1:0] at_x,        // where the robot was, three clocks ago; where it stands
    output reg  [ROW_BITS-1:0]    at_y,
    output reg                    arrived,     // the task is done: the robot is at the target
    output reg                    unreachable  // the task is done: no way leads to the target
);
    localparam CELLS = WIDTH * HEIGHT;
    localparam COLOURS = @COLOURS@; // a cell and its neighbours all have different ones

@MAP@
    wire clear = stop | begin_task;

    // The task, one bit a column and a row: short wires instead of comparisons in every cell.
    reg [WIDTH-1:0]  start_column;
    reg [HEIGHT-1:0] start_row;
    reg [WIDTH-1:0]  target_column;
    reg [HEIGHT-1:0] target_row;
    integer i;
    always @(posedge clk)
        if (stop) begin
            start_column <= 0;
            start_row <= 0;
            target_column <= 0;
            target_row <= 0;
        end else if (begin_task) begin
            for (i = 0; i < WIDTH; i = i + 1) begin
                start_column[i] <= start_x == i;
                target_column[i] <= target_x == i;
            end
            for (i = 0; i < HEIGHT; i = i + 1) begin
                start_row[i] <= start_y == i;
                target_row[i] <= target_y == i;
            end
        end

`ifdef FORMAL
    wire [CELLS-1:0] formal_active;
    reg formal_begun = 1'b0; // the first clock is over
    always @(posedge clk)
        formal_begun <= 1'b1;
`endif

    // The cells, within a frame of places where nothing is ever reached: the map's row 0 is row 1 here, its
    // column 0 is column 1. Each place has wires of its own, for its neighbours to look at; simulators wake
    // only these neighbours then, not all that look at a bit of some vector of the whole map.
    genvar x, y;
    generate
        for (y = 0; y < HEIGHT + 2; y = y + 1) begin : row
            for (x = 0; x < WIDTH + 2; x = x + 1) begin : column
                wire       reached;
                wire       active;
                wire [@TOP@:0] leaving;
                wire [COLOURS-1:0] colour_seen; // the robot's, if it is here or further left in this row
                wire       front_seen; // the wave, coming to a watched cell here or further left
                if (x == 0 || x > WIDTH || y == 0 || y > HEIGHT) begin : outside
                    assign {reached, active, leaving, colour_seen, front_seen} = 0;
                end else begin : inside
                    localparam COLUMN = x - 1;
                    localparam ROW = y - 1;
                    localparam HERE = ROW * WIDTH + COLUMN; // the number of the cell on the map
                    localparam COLOUR = @COLOUR@;
                    localparam WATCHED = @WATCHED@ != 0; // one of two side by side is
@ODD@                    wire here_is_target = target_column[COLUMN] & target_row[ROW];
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
                        .is_obstacle(obstacles[HERE]),
                        .is_target(here_is_target),
                        .is_start(here_is_start),
                        .reached_around(reached_around),
                        .entering(entering),
                        .reached(reached),
                        .is_front(is_front),
                        .pointer(pointer),
                        .active(active),
                        .leaving(leaving)
                    );
                    assign colour_seen = row[y].column[x - 1].colour_seen | active << COLOUR;
                    assign front_seen = row[y].column[x - 1].front_seen | (WATCHED & is_front);

`ifdef FORMAL
                    assign formal_active[HERE] = active;
                    always @*
                        if (formal_begun) begin
                            // The wave never enters an obstacle, the robot goes where the wave has been.
                            assert (!(reached && obstacles[HERE]));
                            assert (!active || reached);
                            // A pointer leads to a cell that the wave has reached; only the target has none.
                            assert (!reached || (pointer & ~reached_around) == 0);
                            assert (!reached || (pointer & (pointer - 1)) == 0);
                            assert (!reached || pointer != 0 || here_is_target);
                            // The start makes the active bit once: afterwards it is reached for good.
                            assert (!here_is_start || formal_active == 0 || (reached && !is_front));
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
                row_colour[COLOURS*y +: COLOURS] <= clear ? 0 : row[y + 1].column[WIDTH].colour_seen;
                row_front[y] <= ~clear & row[y + 1].column[WIDTH].front_seen;
            end
        end
    endgenerate

    reg [COLOURS-1:0] colour_in_rows;
    always @* begin
        colour_in_rows = 0;
        for (i = 0; i < HEIGHT; i = i + 1)
            colour_in_rows = colour_in_rows | row_colour[COLOURS*i +: COLOURS];
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
