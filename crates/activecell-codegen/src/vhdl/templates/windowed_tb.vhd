-- Test bench of windowed_@LATTICE@. Each line of tb/windowed.hex is a clock: the inputs, and what the
-- model in Rust shows. Reports PASS, or FAIL with the first difference. Run it in the folder above rtl
-- and tb. How the navigator is used, windowed_example_tb shows.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;
use work.hex_lines.all;
use work.map_image.all;

entity windowed_tb is
end entity windowed_tb;

architecture test of windowed_tb is
    constant X_DIGITS : positive := @X_DIGITS@; -- hexadecimal digits of a column's number in the file
    constant Y_DIGITS : positive := @Y_DIGITS@; -- and of a row's

    -- Where the fields of a line begin.
    constant Y_AT        : positive := 12;
    constant X_AT        : positive := Y_AT + 4*Y_DIGITS;
    constant TARGET_Y_AT : positive := X_AT + 4*X_DIGITS;
    constant TARGET_X_AT : positive := TARGET_Y_AT + 4*Y_DIGITS;
    constant START_Y_AT  : positive := TARGET_X_AT + 4*X_DIGITS;
    constant START_X_AT  : positive := START_Y_AT + 4*Y_DIGITS;
    constant CONTROL_AT  : positive := START_X_AT + 4*X_DIGITS; -- reset, enable, begin_task in bit 0

    signal clk       : std_logic := '0';
    signal control   : std_logic_vector(2 downto 0) := "100";
    signal start_x   : std_logic_vector(COLUMN_BITS - 1 downto 0) := (others => '0');
    signal start_y   : std_logic_vector(ROW_BITS - 1 downto 0)    := (others => '0');
    signal target_x  : std_logic_vector(COLUMN_BITS - 1 downto 0) := (others => '0');
    signal target_y  : std_logic_vector(ROW_BITS - 1 downto 0)    := (others => '0');
    signal at_x      : std_logic_vector(COLUMN_BITS - 1 downto 0);
    signal at_y      : std_logic_vector(ROW_BITS - 1 downto 0);
    signal direction : std_logic_vector(@TOP@ downto 0);
    signal flags     : std_logic_vector(3 downto 0); -- busy, arrived, enclosed, trapped
    signal ended     : boolean := false;
begin
    dut : entity work.windowed_@LATTICE@
        port map (
            clk => clk, reset => control(2), enable => control(1), begin_task => control(0),
            start_x => start_x, start_y => start_y, target_x => target_x, target_y => target_y,
            at_x => at_x, at_y => at_y, direction => direction,
            busy => flags(3), arrived => flags(2), enclosed => flags(1), trapped => flags(0)
        );

    clk <= not clk after 5 ns when not ended else '0';

    check : process
        file trace : text open read_mode is "tb/windowed.hex";
        variable fields : std_logic_vector(CONTROL_AT + 3 downto 0);
        variable clocks : natural := 0;
    begin
        wait until falling_edge(clk);
        while not endfile(trace) loop
            read_hex(trace, fields);
            control  <= fields(CONTROL_AT + 2 downto CONTROL_AT);
            start_x  <= fields(START_X_AT + COLUMN_BITS - 1 downto START_X_AT);
            start_y  <= fields(START_Y_AT + ROW_BITS - 1 downto START_Y_AT);
            target_x <= fields(TARGET_X_AT + COLUMN_BITS - 1 downto TARGET_X_AT);
            target_y <= fields(TARGET_Y_AT + ROW_BITS - 1 downto TARGET_Y_AT);
            wait for 1 ns;
            assert at_x = fields(X_AT + COLUMN_BITS - 1 downto X_AT)
                    and at_y = fields(Y_AT + ROW_BITS - 1 downto Y_AT)
                    and direction = fields(@TOP@ + 4 downto 4) and flags = fields(3 downto 0)
                report "FAIL windowed_@LATTICE@: line " & integer'image(clocks + 1) & ": at ("
                    & integer'image(to_integer(unsigned(at_x))) & ","
                    & integer'image(to_integer(unsigned(at_y))) & ")"
                severity failure;
            clocks := clocks + 1;
            wait until falling_edge(clk);
        end loop;
        ended <= true;
        report "PASS windowed_@LATTICE@: " & integer'image(clocks) & " clocks as in the model";
        wait;
    end process check;
end architecture test;
