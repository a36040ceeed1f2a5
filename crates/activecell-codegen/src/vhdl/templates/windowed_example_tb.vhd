-- An example of how windowed_@LATTICE@ is used: one task, whose cells and steps it prints. It checks
-- nothing. Run it in any folder.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;
use work.map_image.all;

entity windowed_example_tb is
end entity windowed_example_tb;

architecture example of windowed_example_tb is
    constant CLOCKS_A_CELL : positive := 5; -- a robot's drive takes some million

    constant START_X  : std_logic_vector := std_logic_vector(to_unsigned(@START_X@, COLUMN_BITS));
    constant START_Y  : std_logic_vector := std_logic_vector(to_unsigned(@START_Y@, ROW_BITS));
    constant TARGET_X : std_logic_vector := std_logic_vector(to_unsigned(@TARGET_X@, COLUMN_BITS));
    constant TARGET_Y : std_logic_vector := std_logic_vector(to_unsigned(@TARGET_Y@, ROW_BITS));

    signal clk        : std_logic := '0';
    signal reset      : std_logic := '1';
    signal enable     : std_logic := '0';
    signal begin_task : std_logic := '0';
    signal at_x       : std_logic_vector(COLUMN_BITS - 1 downto 0);
    signal at_y       : std_logic_vector(ROW_BITS - 1 downto 0);
    signal direction  : std_logic_vector(@TOP@ downto 0);
    signal busy       : std_logic;
    signal arrived    : std_logic;
    signal enclosed   : std_logic;
    signal trapped    : std_logic;
    signal ended      : boolean := false;

    -- What the robot is told.
    function name (lanes : std_logic_vector(@TOP@ downto 0)) return string is
    begin
        case lanes is
@NAMES@
            when others => return "no";
        end case;
    end function name;
begin
    navigator : entity work.windowed_@LATTICE@
        port map (
            clk => clk, reset => reset, enable => enable, begin_task => begin_task,
            start_x => START_X, start_y => START_Y, target_x => TARGET_X, target_y => TARGET_Y,
            at_x => at_x, at_y => at_y, direction => direction,
            busy => busy, arrived => arrived, enclosed => enclosed, trapped => trapped
        );

    clk <= not clk after 5 ns when not ended else '0';

    -- The rising edges are what counts, so inputs change with the falling ones.
    drive : process
        procedure print (told : string) is
            variable content : line;
        begin
            write(content, "at (" & integer'image(to_integer(unsigned(at_x))) & ","
                & integer'image(to_integer(unsigned(at_y))) & "): " & told);
            writeline(output, content);
        end procedure print;
    begin
        wait until falling_edge(clk);
        reset      <= '0';
        begin_task <= '1';
        wait until falling_edge(clk);
        begin_task <= '0';
        wait until falling_edge(clk); -- the map has been read
        while busy = '1' loop
            print("step " & name(direction));
            for pause in 1 to CLOCKS_A_CELL loop
                wait until falling_edge(clk); -- the robot drives there
            end loop;
            enable <= '1'; -- it has come to the cell
            wait until falling_edge(clk);
            enable <= '0';
        end loop;
        if arrived = '1' then
            print("arrived");
        elsif enclosed = '1' then
            print("enclosed");
        else
            print("trapped");
        end if;
        ended <= true;
        wait;
    end process drive;
end architecture example;
