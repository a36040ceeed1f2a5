
    scan_out <= not free(0);

    load : process (clk)
    begin
        if rising_edge(clk) then
            if load_map = '1' then
                free <= free(1 to CELLS - 1) & not scan_in;
            end if;
        end if;
    end process load;
