                    reg is_free = 1'b0;
                    always @(posedge clk)
                        if (load_map)
                            is_free <= chain[HERE + 1];
                    assign chain[HERE] = is_free;
