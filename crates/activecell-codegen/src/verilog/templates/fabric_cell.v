// A cell of the fabric on the @LATTICE@ lattice: it knows its neighbours and nothing else.
// Lanes are the neighbours, clockwise from the top: @NAMES@ (bit 0 first).
`default_nettype none

module fabric_cell_@LATTICE@ (
    input  wire       clk,
    input  wire       clear,          // forget the last task
    input  wire       is_free,        // this cell is no obstacle
    input  wire       is_target,      // the robot wants to come here
    input  wire       is_start,       // the robot stands here when the task begins
    input  wire [@TOP@:0] reached_around, // neighbours to which the wave has come
    input  wire [@TOP@:0] entering,       // neighbours from which the robot moves here
    output wire       reached,        // the wave has come here
    output wire       is_front,       // it came here at the last clock
    output wire [@TOP@:0] pointer,        // the neighbour from which it came, one bit; none at the target
    output reg        active,         // the robot is here: the active cell
    output wire [@TOP@:0] leaving         // the neighbour to which the robot moves
);
    wire       reached_next;
    wire [@TOP@:0] pointer_next;
    wire       active_next;
    fabric_step_@LATTICE@ step (
        .is_free(is_free),
        .is_target(is_target),
        .is_start(is_start),
        .is_front(is_front),
        .reached_around(reached_around),
        .entering(entering),
        .reached_next(reached_next),
        .pointer_next(pointer_next),
        .active_next(active_next)
    );

    // What a cell keeps, inverted where this saves lookup tables: `waiting` enables the clock of `closed`,
    // and a lane of `closed` can be a neighbour's `waiting` as it is.
    reg       waiting;     // the wave has not come yet
    reg [@TOP@:0] closed;      // the neighbours to which the pointer does not point
    reg       was_waiting; // waiting, a clock before

    assign reached = ~waiting;
    assign pointer = ~closed;
    assign is_front = reached & was_waiting;
    assign leaving = pointer & {@DEGREE@{active}};

    always @(posedge clk) begin
        if (clear) begin
            waiting <= 1'b1;
            was_waiting <= 1'b1;
            active <= 1'b0;
        end else begin
            waiting <= ~reached_next;
            was_waiting <= waiting;
            active <= active_next;
        end
        // The pointer follows the neighbours until the wave is here, then it stays. It needs no clearing:
        // before a wave nothing is reached, so it falls to none by itself.
        if (waiting)
            closed <= ~pointer_next;
    end
endmodule

`default_nettype wire
