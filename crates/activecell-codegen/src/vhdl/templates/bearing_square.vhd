-- Where the target lies as seen from a cell: the comparisons from which the sector follows. Generated
-- by activecell.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.lanes.all;

entity bearing_square is
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
        is_near  : out std_logic                                   -- the target is a neighbour
    );
end entity bearing_square;

architecture rtl of bearing_square is
    signal column        : natural range 0 to 2**COLUMN_BITS - 1;
    signal row           : natural range 0 to 2**ROW_BITS - 1;
    signal target_column : natural range 0 to 2**COLUMN_BITS - 1;
    signal target_row    : natural range 0 to 2**ROW_BITS - 1;
begin
    column        <= to_integer(unsigned(x));
    row           <= to_integer(unsigned(y));
    target_column <= to_integer(unsigned(target_x));
    target_row    <= to_integer(unsigned(target_y));

    is_left  <= flag(target_column < column);
    is_right <= flag(target_column > column);
    is_above <= flag(target_row < row);
    is_below <= flag(target_row > row);

    -- One column aside in the same row, or one row in the same column.
    is_near <= flag(
        (row = target_row and (column + 1 = target_column or target_column + 1 = column))
        or (column = target_column and (row + 1 = target_row or target_row + 1 = row))
    );
end architecture rtl;
