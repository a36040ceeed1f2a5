// Test bench of windowed_@LATTICE@: @TASKS@ tasks over @CLOCKS@ clocks. Each line of tb/windowed.hex is a
// clock: the inputs, and what the model in Rust shows. Prints PASS, or FAIL with the first difference.
// Run it in the folder above rtl and tb.
`timescale 1ns / 1ns
module windowed_tb;
    localparam CLOCKS   = @CLOCKS@;
    localparam X_DIGITS = @X_DIGITS@; // hexadecimal digits of a column's number in the file
    localparam Y_DIGITS = @Y_DIGITS@; // and of a row's
    localparam LINE     = 16 + 12*(X_DIGITS + Y_DIGITS);

    reg [LINE-1:0] lines [0:CLOCKS-1];
    integer        n;

    // The fields of a line.
    reg [3:0]            load;
    reg [4*X_DIGITS-1:0] start_x, target_x, expected_x;
    reg [4*Y_DIGITS-1:0] start_y, target_y, expected_y;
    reg [7:0]            expected_go;
    reg [3:0]            expected_flags;

    reg                 clk = 1'b0;
    reg                 reset = 1'b1;
    wire [@X_BITS@-1:0] x;
    wire [@Y_BITS@-1:0] y;
    wire [@TOP@:0]      go;
    wire                busy, arrived, enclosed, trapped;

    windowed_@LATTICE@ dut (
        .clk(clk), .reset(reset), .load(load[0]),
        .start_x(start_x[@X_BITS@-1:0]), .start_y(start_y[@Y_BITS@-1:0]),
        .target_x(target_x[@X_BITS@-1:0]), .target_y(target_y[@Y_BITS@-1:0]),
        .x(x), .y(y), .go(go), .busy(busy), .arrived(arrived), .enclosed(enclosed), .trapped(trapped)
    );

    always #5 clk = ~clk;

    initial begin
        $readmemh("tb/windowed.hex", lines);
        load = 4'd0;
        {start_x, start_y, target_x, target_y} = 0;
        @(negedge clk);
        reset = 1'b0;
        for (n = 0; n < CLOCKS; n = n + 1) begin
            {load, start_x, start_y, target_x, target_y,
             expected_x, expected_y, expected_go, expected_flags} = lines[n];
            #1;
            if (x !== expected_x[@X_BITS@-1:0] || y !== expected_y[@Y_BITS@-1:0]
                || go !== expected_go[@TOP@:0]
                || {busy, arrived, enclosed, trapped} !== expected_flags) begin
                $display("FAIL windowed_@LATTICE@: clock %0d: at (%0d,%0d), go %b, status %b",
                    n, x, y, go, {busy, arrived, enclosed, trapped});
                $display("    expected: at (%0d,%0d), go %b, status %b (busy, arrived, enclosed, trapped)",
                    expected_x, expected_y, expected_go[@TOP@:0], expected_flags);
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
