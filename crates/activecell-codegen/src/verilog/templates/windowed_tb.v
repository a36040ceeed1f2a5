// Test bench of windowed_@LATTICE@: @TASKS@ tasks over @CLOCKS@ clocks. Each line of tb/windowed.hex is a
// clock: the inputs, and what the model in Rust shows. Prints PASS, or FAIL with the first difference.
// Run it in the folder above rtl and tb. How the navigator is used, windowed_example_tb shows.
`timescale 1ns / 1ps
`default_nettype none

module windowed_tb;
    localparam CLOCKS   = @CLOCKS@;
    localparam X_DIGITS = @X_DIGITS@; // hexadecimal digits of a column's number in the file
    localparam Y_DIGITS = @Y_DIGITS@; // and of a row's
    localparam LINE     = 16 + 12*(X_DIGITS + Y_DIGITS);

    reg [LINE-1:0] lines [0:CLOCKS-1];
    integer        n;

    // The fields of a line.
    reg [3:0]            control; // reset, enable, begin_task in bit 0
    reg [4*X_DIGITS-1:0] start_x, target_x, expected_x;
    reg [4*Y_DIGITS-1:0] start_y, target_y, expected_y;
    reg [7:0]            expected_direction;
    reg [3:0]            expected_flags;

    reg         clk = 1'b0;
    wire @COLUMN_RANGE@ at_x;
    wire @ROW_RANGE@ at_y;
    wire @DIRECTION_RANGE@ direction;
    wire        busy, arrived, enclosed, trapped;

    windowed_@LATTICE@ dut (
        .clk(clk), .reset(control[2]), .enable(control[1]), .begin_task(control[0]),
        .start_x(start_x[@COLUMN_TOP@:0]), .start_y(start_y[@ROW_TOP@:0]),
        .target_x(target_x[@COLUMN_TOP@:0]), .target_y(target_y[@ROW_TOP@:0]),
        .at_x(at_x), .at_y(at_y), .direction(direction),
        .busy(busy), .arrived(arrived), .enclosed(enclosed), .trapped(trapped)
    );

    always #5 clk = ~clk;

    initial begin
        $readmemh("tb/windowed.hex", lines);
        control = 4'b0100;
        {start_x, start_y, target_x, target_y} = 0;
        @(negedge clk);
        for (n = 0; n < CLOCKS; n = n + 1) begin
            {control, start_x, start_y, target_x, target_y,
             expected_x, expected_y, expected_direction, expected_flags} = lines[n];
            #1;
            if (at_x !== expected_x[@COLUMN_TOP@:0] || at_y !== expected_y[@ROW_TOP@:0]
                || direction !== expected_direction[@TOP@:0]
                || {busy, arrived, enclosed, trapped} !== expected_flags) begin
                $display("FAIL windowed_@LATTICE@: clock %0d: at (%0d,%0d), direction %b, status %b",
                    n, at_x, at_y, direction, {busy, arrived, enclosed, trapped});
                $display("    expected: at (%0d,%0d), direction %b, status %b",
                    expected_x, expected_y, expected_direction[@TOP@:0], expected_flags);
                $display("    (status: busy, arrived, enclosed, trapped)");
                $finish;
                n = CLOCKS;
            end
            @(negedge clk);
        end
        if (n == CLOCKS)
            $display("PASS windowed_@LATTICE@: @TASKS@ tasks, %0d clocks as in the model", CLOCKS);
        $finish;
    end
endmodule

`default_nettype wire
