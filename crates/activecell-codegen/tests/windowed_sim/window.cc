// Pairs of cells in, the second the one to be seen and the first that of the clock before; the windows out.
static bool place(cxxrtl_design::p_map__window &top) {
    uint32_t bytes[4];
    for (uint32_t &byte : bytes)
        byte = std::getchar();
    top.p_x.set<uint32_t>(bytes[0] | bytes[1] << 8);
    top.p_y.set<uint32_t>(bytes[2] | bytes[3] << 8);
    return !std::feof(stdin);
}

int main() {
    cxxrtl_design::p_map__window top;
    top.p_enable.set<bool>(true);
    while (place(top)) {
        top.p_clk.set<bool>(false);
        top.step();
        top.p_clk.set<bool>(true);
        top.step();
        place(top);
        top.step();
        uint32_t window = top.p_window.get<uint32_t>();
        for (int i = 0; i < 4; i++)
            std::putchar(window >> 8 * i & 255);
    }
}
