
    scan_out <= obstacles(0);

    load : process (clk)
    begin
        if rising_edge(clk) then
            if load_map = '1' then
                obstacles <= obstacles(1 to CELLS - 1) & scan_in;
            end if;
        end if;
    end process load;
