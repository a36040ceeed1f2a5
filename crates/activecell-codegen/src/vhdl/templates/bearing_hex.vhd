-- Where the target lies as seen from a cell: the comparisons from which the sector follows. Generated
-- by activecell.
--
-- Across is counted in half cells, since odd rows stand half a cell to the right; down in rows. So a
-- step along a row is 2 across, any other step 1 across and 1 down.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.lanes.all;

entity bearing_hex is
    generic (
        COLUMN_BITS : positive := 8; -- bits of a column's number
        ROW_BITS    : positive := 8  -- bits of a row's number
    );
    port (
        x        : in  std_logic_vector(COLUMN_BITS - 1 downto 0); -- the cell's column
        y        : in  std_logic_vector(ROW_BITS - 1 downto 0);    -- the cell's row, 0 on top
        target_x : in  std_logic_vector(COLUMN_BITS - 1 downto 0); -- the target's column
        target_y : in  std_logic_vector(ROW_BITS - 1 downto 0);    -- the target's row
        is_left  : out std_logic;                                  -- the target lies to the left
        is_right : out std_logic;                                  -- the target lies to the right
        is_above : out std_logic;                                  -- the target lies above
        is_below : out std_logic;                                  -- the target lies below
        is_wide  : out std_logic;                                  -- farther across than down
        is_level : out std_logic;                                  -- as far across as down
        is_flat  : out std_logic;                                  -- farther across than three times down
        is_even  : out std_logic;                                  -- as far across as three times down
        is_near  : out std_logic                                   -- the target is a neighbour
    );
end entity bearing_hex;

architecture rtl of bearing_hex is
    constant ACROSS_MAX : positive := 2**(COLUMN_BITS + 1);
    constant DOWN_MAX   : positive := 2**ROW_BITS;

    -- Half cells from the left edge to the centres, less the half cell that both have: twice the
    -- column, 1 more in odd rows.
    signal from_left   : std_logic_vector(COLUMN_BITS downto 0);
    signal target_left : std_logic_vector(COLUMN_BITS downto 0);
    signal across      : integer range -ACROSS_MAX to ACROSS_MAX;
    signal down        : integer range -DOWN_MAX to DOWN_MAX;

    -- One is farther than the other if their sum and their difference have the same sign, and as far if
    -- one of these is 0.
    signal sum         : integer range -ACROSS_MAX - DOWN_MAX to ACROSS_MAX + DOWN_MAX;
    signal rest        : integer range -ACROSS_MAX - DOWN_MAX to ACROSS_MAX + DOWN_MAX;
    signal thrice_sum  : integer range -ACROSS_MAX - 3*DOWN_MAX to ACROSS_MAX + 3*DOWN_MAX;
    signal thrice_rest : integer range -ACROSS_MAX - 3*DOWN_MAX to ACROSS_MAX + 3*DOWN_MAX;
begin
    from_left   <= x & y(0);
    target_left <= target_x & target_y(0);

    across <= to_integer(unsigned(target_left)) - to_integer(unsigned(from_left));
    down   <= to_integer(unsigned(target_y)) - to_integer(unsigned(y));

    is_left  <= flag(across < 0);
    is_right <= flag(across > 0);
    is_above <= flag(down < 0);
    is_below <= flag(down > 0);

    sum         <= across + down;
    rest        <= across - down;
    thrice_sum  <= across + 3*down;
    thrice_rest <= across - 3*down;

    is_level <= flag(sum = 0 or rest = 0);
    is_wide  <= flag(sum /= 0 and rest /= 0 and (sum < 0) = (rest < 0));
    is_even  <= flag(thrice_sum = 0 or thrice_rest = 0);
    is_flat  <= flag(thrice_sum /= 0 and thrice_rest /= 0 and (thrice_sum < 0) = (thrice_rest < 0));

    is_near <= flag(
        (down = 0 and (across = 2 or across = -2))
        or ((down = 1 or down = -1) and (across = 1 or across = -1))
    );
end architecture rtl;
