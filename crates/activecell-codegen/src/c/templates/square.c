uint32_t ac_distance(ac_cell from, ac_cell to)
{
    return apart(from.x, to.x) + apart(from.y, to.y);
}

uint32_t ac_sector(ac_cell from, ac_cell target)
{
    return ac_sector_square(@COMPARISONS@);
}
