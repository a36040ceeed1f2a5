@ABOUT@
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.lanes.all;

entity fabric is
    generic (
@SIZE_GENERICS@        COLUMN_BITS : positive := @COLUMN_BITS@; -- enough for WIDTH - 1
        ROW_BITS    : positive := @ROW_BITS@  -- enough for HEIGHT - 1
    );
    port (
        clk         : in  std_logic;
        -- Active high; ends any task, begins none; needed once, at first.
        reset       : in  std_logic;
@MAP_PORTS@        -- For one clock: a task begins, instead of one that is being done.
        begin_task  : in  std_logic;
        -- Column and row where the robot is, taken with begin_task.
        start_x     : in  std_logic_vector(COLUMN_BITS - 1 downto 0);
        start_y     : in  std_logic_vector(ROW_BITS - 1 downto 0);
        -- Where it is to go; an obstacle, or outside: unreachable.
        target_x    : in  std_logic_vector(COLUMN_BITS - 1 downto 0);
        target_y    : in  std_logic_vector(ROW_BITS - 1 downto 0);
        busy        : out std_logic; -- a task is being done
        moving      : out std_logic; -- at_x, at_y are a cell of the way
        -- While moving one cell of the way a clock: first the start, last the target, where they stay.
        at_x        : out std_logic_vector(COLUMN_BITS - 1 downto 0);
        at_y        : out std_logic_vector(ROW_BITS - 1 downto 0);
        arrived     : out std_logic; -- the task is done: the way was shown to its end
        unreachable : out std_logic  -- the task is done: no way leads to the target
    );
end entity fabric;

architecture rtl of fabric is
@SIZE_CONSTANTS@    constant CELLS   : positive := WIDTH * HEIGHT;
    constant COLOURS : positive := @COLOURS@; -- a cell and its neighbours all have different ones

    -- The number of a cell in row order; CELLS for all that lies outside, where nothing is ever reached.
    function at (x, y : integer) return natural is
    begin
        if x < 0 or x >= WIDTH or y < 0 or y >= HEIGHT then
            return CELLS;
        end if;
        return y * WIDTH + x;
    end function at;

@MAP@
    signal stop  : std_logic;
    signal clear : std_logic;

    -- What the cells show each other. Lane j of a cell is bit @DEGREE@ * number + j.
    signal reached  : std_logic_vector(CELLS downto 0);
    signal active   : std_logic_vector(CELLS - 1 downto 0);
    signal is_front : std_logic_vector(CELLS - 1 downto 0);
    signal leaving  : std_logic_vector(@DEGREE@*CELLS + @TOP@ downto 0);

    -- The task, one bit a column and a row: short wires instead of comparisons in every cell.
    signal start_column  : std_logic_vector(WIDTH - 1 downto 0) := (others => '0');
    signal start_row     : std_logic_vector(HEIGHT - 1 downto 0) := (others => '0');
    signal target_column : std_logic_vector(WIDTH - 1 downto 0) := (others => '0');
    signal target_row    : std_logic_vector(HEIGHT - 1 downto 0) := (others => '0');

    -- The robot's colour, and whether the wave still spreads: by rows, then altogether, each in a clock, so
    -- that the fabric's speed is that of its cells. Two colours that follow each other are a move. A wave
    -- that spreads comes from a cell to one beside it: of two clocks, one sees it in a watched cell.
    subtype colour_lanes is std_logic_vector(COLOURS - 1 downto 0);
    type colours_of_rows is array (0 to HEIGHT - 1) of colour_lanes;
    signal row_colour  : colours_of_rows := (others => (others => '0')); -- a clock ago
    signal row_front   : std_logic_vector(HEIGHT - 1 downto 0) := (others => '0');
    signal colour      : colour_lanes := (others => '0'); -- two clocks ago; none before the wave has come
    signal last_colour : colour_lanes := (others => '0'); -- three clocks ago
@MOVE_SIGNALS@
    -- The control: a task ends when the robot is at the target, where the active bit ends, or when the wave
    -- has stopped and no cell is active.
    signal warm_up         : std_logic_vector(4 downto 0) := "00001"; -- clocks until the wave is seen here
    signal front_seen      : std_logic := '0';                        -- the wave was seen, two clocks ago
    signal last_front_seen : std_logic := '0';                        -- three clocks ago
    signal is_busy         : std_logic := '0';
    signal is_moving       : std_logic := '0';
    signal is_arrived      : std_logic := '0';
    signal is_unreachable  : std_logic := '0';
    signal column          : unsigned(COLUMN_BITS - 1 downto 0) := (others => '0');
    signal row             : unsigned(ROW_BITS - 1 downto 0) := (others => '0');
    signal at_target       : std_logic;
    signal stopped         : std_logic;

    -- Whether the robot went from a colour to the one that is so many further.
    function goes (from, to_colour : colour_lanes; step : natural) return std_logic is
    begin
        return or_reduce(to_colour and std_logic_vector(rotate_left(unsigned(from), step)));
    end function goes;
begin
    assert WIDTH <= 2**COLUMN_BITS and HEIGHT <= 2**ROW_BITS
        report "fabric: COLUMN_BITS or ROW_BITS are too few for WIDTH or HEIGHT"
        severity failure;

    stop  <= @STOP@;
    clear <= stop or begin_task;

    -- Outside.
    reached(CELLS) <= '0';
    leaving(@DEGREE@*CELLS + @TOP@ downto @DEGREE@*CELLS) <= (others => '0');

    rows : for y in 0 to HEIGHT - 1 generate
        columns : for x in 0 to WIDTH - 1 generate
            constant HERE : natural := y * WIDTH + x;
@ODD@            signal is_target      : std_logic;
            signal is_start       : std_logic;
            signal reached_around : std_logic_vector(@TOP@ downto 0);
            signal entering       : std_logic_vector(@TOP@ downto 0);
        begin
            is_target <= target_column(x) and target_row(y);
            is_start  <= start_column(x) and start_row(y);
@AROUND@
            cell : entity work.fabric_cell_@LATTICE@
                port map (
                    clk => clk, clear => clear,
                    is_free => free(HERE), is_target => is_target, is_start => is_start,
                    reached_around => reached_around, entering => entering,
                    reached => reached(HERE), is_front => is_front(HERE),
                    pointer => open, active => active(HERE),
                    leaving => leaving(@DEGREE@*HERE + @TOP@ downto @DEGREE@*HERE)
                );
        end generate columns;
    end generate rows;

    take_task : process (clk)
    begin
        if rising_edge(clk) then
            if stop = '1' then
                start_column  <= (others => '0');
                start_row     <= (others => '0');
                target_column <= (others => '0');
                target_row    <= (others => '0');
            elsif begin_task = '1' then
                for x in 0 to WIDTH - 1 loop
                    start_column(x)  <= flag(unsigned(start_x) = x);
                    target_column(x) <= flag(unsigned(target_x) = x);
                end loop;
                for y in 0 to HEIGHT - 1 loop
                    start_row(y)  <= flag(unsigned(start_y) = y);
                    target_row(y) <= flag(unsigned(target_y) = y);
                end loop;
            end if;
        end if;
    end process take_task;

    sum_up : process (clk)
        variable seen  : colour_lanes;
        variable front : std_logic;
    begin
        if rising_edge(clk) then
            for y in 0 to HEIGHT - 1 loop
                seen  := (others => '0');
                front := '0';
                for x in 0 to WIDTH - 1 loop
                    seen(@COLOUR@) := seen(@COLOUR@) or active(y*WIDTH + x);
                    if @WATCHED@ /= 0 then
                        front := front or is_front(y*WIDTH + x);
                    end if;
                end loop;
                row_colour(y) <= mux(clear, (seen'range => '0'), seen);
                row_front(y)  <= front and not clear;
            end loop;
        end if;
    end process sum_up;

@MOVES@
    at_target <= is_moving and not or_reduce(colour);
    stopped   <= warm_up(4) and not (front_seen or last_front_seen or or_reduce(colour) or is_moving);

    control : process (clk)
        variable seen : colour_lanes;
    begin
        if rising_edge(clk) then
            if clear = '1' then
                is_busy         <= not stop;
                warm_up         <= "00001";
                front_seen      <= '0';
                last_front_seen <= '0';
                colour          <= (others => '0');
                last_colour     <= (others => '0');
                is_moving       <= '0';
                is_arrived      <= '0';
                is_unreachable  <= '0';
                if begin_task = '1' then
                    column <= unsigned(start_x);
                    row    <= unsigned(start_y);
                end if;
            else
                seen := (others => '0');
                for y in 0 to HEIGHT - 1 loop
                    seen := seen or row_colour(y);
                end loop;
                warm_up         <= (warm_up(4) or warm_up(3)) & warm_up(2 downto 0) & '0';
                front_seen      <= or_reduce(row_front);
                last_front_seen <= front_seen;
                colour          <= seen;
                last_colour     <= colour;
                is_moving       <= or_reduce(colour);
                is_arrived      <= is_arrived or at_target;
                is_unreachable  <= is_unreachable or (is_busy and stopped and not is_arrived);
                if at_target = '1' or stopped = '1' then
                    is_busy <= '0';
                end if;
                if right = '1' then
                    column <= column + 1;
                elsif left = '1' then
                    column <= column - 1;
                end if;
                if down = '1' then
                    row <= row + 1;
                elsif up = '1' then
                    row <= row - 1;
                end if;
            end if;
        end if;
    end process control;

    at_x        <= std_logic_vector(column);
    at_y        <= std_logic_vector(row);
    busy        <= is_busy;
    moving      <= is_moving;
    arrived     <= is_arrived;
    unreachable <= is_unreachable;
@LOADING@end architecture rtl;
