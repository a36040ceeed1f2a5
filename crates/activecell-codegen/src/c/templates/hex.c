/* Where the centre of a cell lies, in half cells: odd rows are shifted right. */
static uint32_t centre(ac_cell cell)
{
    return (2U * cell.x) + (cell.y & 1U);
}

uint32_t ac_distance(ac_cell from, ac_cell to)
{
    /* Every row crossed also moves half a cell sideways; the rest is walked along the row. */
    const uint32_t across = apart(centre(from), centre(to));
    const uint32_t down = apart(from.y, to.y);
    return (across > down) ? (down + ((across - down) >> 1U)) : down;
}

uint32_t ac_sector(ac_cell from, ac_cell target)
{
    const uint32_t here = centre(from);
    const uint32_t there = centre(target);
    const uint32_t across = apart(here, there);
    const uint32_t down = apart(from.y, target.y);
    return ac_sector_hex(@COMPARISONS@);
}
