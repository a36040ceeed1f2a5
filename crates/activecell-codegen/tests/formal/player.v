// What must never happen, whatever the program (its memory holds anything) and the inputs.
module player_formal (
    input wire       clk,
    input wire       reset,
    input wire       go,
    input wire       tick,
    input wire [3:0] obstacles
);
    wire [3:0] q;
    wire [2:0] segment;
    wire       turning;
    wire       done;

    player #(.SEGMENTS(7), .SEGMENT_BITS(3), .TICK_BITS(3)) player (
        .clk(clk), .reset(reset), .go(go), .tick(tick), .obstacles(obstacles),
        .q0(q[0]), .q1(q[1]), .q2(q[2]), .q3(q[3]),
        .segment(segment), .turning(turning), .done(done)
    );

    // The motions, as q3 to q0 say them.
    wire is_forward = q == 4'b0010;
    wire is_left    = q == 4'b0110;
    wire is_right   = q == 4'b1010;
    wire is_reverse = q == 4'b1100;
    wire is_moving  = is_forward | is_left | is_right | is_reverse;

    // The clock before.
    reg       has_past = 1'b0;
    reg       was_reset;
    reg       went;
    reg       was_done;
    reg       was_turning;
    reg [3:0] were;

    always @(posedge clk) begin
        has_past    <= 1'b1;
        was_reset   <= reset;
        went        <= go;
        was_done    <= done;
        was_turning <= turning;
        were        <= obstacles;
    end

    always @(*) begin
        if (!has_past)
            assume (reset);
        if (has_past) begin
            // Six words of sixteen; left and right never both while it drives.
            assert (is_moving | q == 4'b0001 | q == 4'b0000);
            // Never towards an obstacle.
            assert (!(is_forward & were[2]));
            assert (!(is_left & were[1]));
            assert (!(is_right & were[0]));
            assert (!(is_reverse & were[3]));
            // Only when told, and no other way than M's.
            assert (went | !is_moving);
            assert (!is_moving | (is_left | is_right) == was_turning);
            if (was_reset)
                assert (!is_moving);
            // After the end never again.
            if (was_done & !was_reset) begin
                assert (done);
                assert (!is_moving);
            end
        end
    end
endmodule
