/* Where the centre of a cell lies, in half cells: odd rows are shifted right. */
static uint32_t centre(ac_cell cell)
{
    return (2U * (uint32_t)cell.x) + ((uint32_t)cell.y & 1U);
}

/* The steps that cover so many half cells across and so many rows down. */
static uint32_t steps(uint32_t across, uint32_t down)
{
    /* Every row crossed also moves half a cell sideways; the rest is walked along the row. */
    return (across > down) ? ((across + down) >> 1U) : down;
}

uint32_t ac_distance(ac_cell from, ac_cell to)
{
    return steps(apart(centre(from), centre(to)), apart(from.y, to.y));
}

uint32_t ac_bearing(ac_cell from, ac_cell target)
{
    /*
     * For a target less far across than down, as far, farther, three times as far, farther than that:
     * in the same row, below, above; and there straight, to the right, to the left.
     */
    static const uint8_t sectors[5][3][3] = {
@SECTOR_TABLE@    };
    const uint32_t here = centre(from);
    const uint32_t there = centre(target);
    const uint32_t across = apart(here, there);
    const uint32_t down = apart(from.y, target.y);
    const uint32_t steep = less(down, across) + less(3U * down, across);
    const uint32_t flat = less(across, down) + less(across, 3U * down);
    const uint32_t sector = sectors[(2U + steep) - flat][side(from.y, target.y)][side(here, there)];
    return (steps(across, down) == 1U) ? (sector | AC_NEAR) : sector;
}
