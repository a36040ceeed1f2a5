// An example of how windowed_@LATTICE@ is used: one task, whose cells and steps it prints. It checks
// nothing. Run it in the folder above rtl and tb.
`timescale 1ns / 1ps
`default_nettype none

module windowed_example_tb;
    localparam CLOCKS_A_CELL = 5; // a robot's drive takes some million

    reg         clk        = 1'b0;
    reg         reset      = 1'b1;
    reg         enable     = 1'b0;
    reg         begin_task = 1'b0;
    wire @COLUMN_RANGE@ at_x;
    wire @ROW_RANGE@ at_y;
    wire @DIRECTION_RANGE@ direction;
    wire        busy, arrived, enclosed, trapped;

    windowed_@LATTICE@ navigator (
        .clk(clk), .reset(reset), .enable(enable), .begin_task(begin_task),
        .start_x(@COLUMN_BITS@'d@START_X@), .start_y(@ROW_BITS@'d@START_Y@),
        .target_x(@COLUMN_BITS@'d@TARGET_X@), .target_y(@ROW_BITS@'d@TARGET_Y@),
        .at_x(at_x), .at_y(at_y), .direction(direction),
        .busy(busy), .arrived(arrived), .enclosed(enclosed), .trapped(trapped)
    );

    always #5 clk = ~clk;

    // What the robot is told.
    reg [8*2-1:0] name;
    always @*
        case (direction)
@NAMES@
            default: name = "no";
        endcase

    // The rising edges are what counts, so inputs change with the falling ones.
    initial begin
        @(negedge clk);
        reset = 1'b0;
        begin_task = 1'b1;
        @(negedge clk);
        begin_task = 1'b0;
        @(negedge clk); // the map has been read
        while (busy) begin
            $display("at (%0d,%0d): step %0s", at_x, at_y, name);
            repeat (CLOCKS_A_CELL) @(negedge clk); // the robot drives there
            enable = 1'b1; // it has come to the cell
            @(negedge clk);
            enable = 1'b0;
        end
        if ((arrived | enclosed | trapped) === 1'b1)
            $display("at (%0d,%0d): %0s", at_x, at_y,
                arrived ? "arrived" : enclosed ? "enclosed" : "trapped");
        else
            $display("FAIL example: the memories have no map; run it in the folder above rtl");
        $finish;
    end
endmodule

`default_nettype wire
