uint32_t ac_distance(ac_cell from, ac_cell to)
{
    return apart(from.x, to.x) + apart(from.y, to.y);
}

uint32_t ac_bearing(ac_cell from, ac_cell target)
{
    /* For a target in the same row, below, above: in the same column, to the right, to the left. */
    static const uint8_t sectors[3][3] = {
@SECTOR_TABLE@    };
    const uint32_t sector = sectors[side(from.y, target.y)][side(from.x, target.x)];
    return (ac_distance(from, target) == 1U) ? (sector | AC_NEAR) : sector;
}
