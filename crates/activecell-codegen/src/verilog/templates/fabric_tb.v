// A bench that checks the fabric by itself: at every clock the inputs of a line of tb/fabric.hex, and what
// must be seen after the clock, as the model in Rust says. Run it in the folder above rtl and tb.
`timescale 1ns / 1ps
`default_nettype none

module fabric_tb;
    localparam CLOCKS = @CLOCKS@;

    // A line, from the left, a digit: reset, load_map, scan_in, begin_task; three digits each: start_x,
    // start_y, target_x, target_y; a digit: busy, moving, arrived, unreachable; three digits each: at_x,
    // at_y.
    reg [79:0] trace [0:CLOCKS-1];
    reg [79:0] line;

    reg clk = 1'b0;
    wire [@COLUMN_TOP@:0] at_x;
    wire [@ROW_TOP@:0] at_y;
    wire busy, moving, arrived, unreachable;
    fabric dut (
        .clk(clk),
        .reset(line[79]),
@LOADING@        .begin_task(line[76]),
        .start_x(line[64 +: @COLUMN_BITS@]),
        .start_y(line[52 +: @ROW_BITS@]),
        .target_x(line[40 +: @COLUMN_BITS@]),
        .target_y(line[28 +: @ROW_BITS@]),
        .busy(busy),
        .moving(moving),
        .at_x(at_x),
        .at_y(at_y),
        .arrived(arrived),
        .unreachable(unreachable)
    );

    integer clock;
    integer errors = 0;
    integer arrivals = 0;
    reg was_arrived = 1'b0;
    initial begin
        $readmemh("tb/fabric.hex", trace);
        for (clock = 0; clock < CLOCKS; clock = clock + 1) begin
            line = trace[clock];
            #5 clk = 1'b1;
            #1;
            // The place counts only while the robot moves, and where it arrived.
            if ({busy, moving, arrived, unreachable} !== line[27:24]
                || ((moving || arrived)
                    && (at_x !== line[12 +: @COLUMN_BITS@] || at_y !== line[0 +: @ROW_BITS@]))) begin
                errors = errors + 1;
                if (errors <= 10)
                    $display(
                        "clock %0d: busy, moving, arrived, unreachable %b at (%0d,%0d), not %b at (%0d,%0d)",
                        clock, {busy, moving, arrived, unreachable}, at_x, at_y,
                        line[27:24], line[23:12], line[11:0]);
            end
            if (arrived && !was_arrived)
                arrivals = arrivals + 1;
            was_arrived = arrived;
            #4 clk = 1'b0;
        end
        if (errors == 0)
            $display("PASS fabric: %0d clocks, %0d arrivals as in the model", CLOCKS, arrivals);
        else
            $display("FAIL fabric: %0d of %0d clocks are not as in the model", errors, CLOCKS);
        $finish;
    end
endmodule

`default_nettype wire
