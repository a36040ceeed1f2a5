// Maps and inputs in, what the navigator shows in each clock out. The banks are filled anew for each map.
static uint32_t number(int bytes) {
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++)
        value |= uint32_t(std::getchar()) << 8 * i;
    return value;
}

static void show(uint32_t value, int bytes) {
    for (int i = 0; i < bytes; i++)
        std::putchar(value >> 8 * i & 255);
}

int main() {
    for (uint32_t clocks = number(4); !std::feof(stdin); clocks = number(4)) {
        cxxrtl_design::p_@TOP@ top;
        cxxrtl::memory<4> *banks[16] = {@BANKS@};
        for (auto bank : banks)
            for (size_t address = 0; address < bank->depth; address++)
                (*bank)[address].set<uint32_t>(number(1));
        top.p_reset.set<bool>(true);
        for (uint32_t clock = 0; clock <= clocks; clock++) {
            if (clock > 0) {
                uint32_t control = number(1);
                top.p_reset.set<bool>(control & 4);
                top.p_enable.set<bool>(control & 2);
                top.p_begin__task.set<bool>(control & 1);
                top.p_start__x.set<uint32_t>(number(2));
                top.p_start__y.set<uint32_t>(number(2));
                top.p_target__x.set<uint32_t>(number(2));
                top.p_target__y.set<uint32_t>(number(2));
            }
            top.p_clk.set<bool>(true);
            top.step();
            top.p_clk.set<bool>(false);
            top.step();
            show(top.p_at__x.get<uint32_t>(), 2);
            show(top.p_at__y.get<uint32_t>(), 2);
            show(top.p_direction.get<uint32_t>(), 1);
            show(top.p_busy.get<uint32_t>() << 3 | top.p_arrived.get<uint32_t>() << 2 | top.p_enclosed.get<uint32_t>() << 1
                     | top.p_trapped.get<uint32_t>(), 1);
        }
    }
}
