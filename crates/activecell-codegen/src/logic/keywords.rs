//! Words that are no names in one of the languages.

/// Those of C99 and C++, Verilog-2005 and VHDL-93, and names that their standard libraries own, in lower case.
const KEYWORDS: &str = "
    abs access after alias all always and architecture array assert assign attribute auto automatic begin block body
    bool buf buffer bufif0 bufif1 bus case casex casez cell char class cmos component config configuration const
    constant continue deassign default defparam design disable disconnect do double downto edge else elsif end endcase
    endconfig endfunction endgenerate endmodule endprimitive endspecify endtable endtask entity enum event exit extern
    false file float for force forever fork free function generate generic genvar goto group guarded highz0 highz1 if
    ifnone impure in inertial initial inline inout input instance int integer is join label large liblist library
    linkage literal localparam long loop macromodule main map medium mod module nand negedge new next nmos nor noshowcancelled
    not notif0 notif1 null of on open operator or others out output package parameter pmos port posedge postponed
    primitive private procedure process protected public pull0 pull1 pulldown pullup pulsestyle_ondetect
    pulsestyle_onevent pure range rcmos real realtime record reg register reject release rem repeat report restrict return
    rnmos rol ror rpmos rtran rtranif0 rtranif1 scalared select severity shared short showcancelled signal signed sizeof
    sla sll small specify specparam sra srl static strong0 strong1 struct subtype supply0 supply1 switch table task
    template then this time to tran tranif0 tranif1 transport tri tri0 tri1 triand trior trireg true type typedef
    unaffected union units unsigned until use variable vectored void volatile wait wand weak0 weak1 when while wire with
    wor work xnor xor";

/// Whether one of the languages keeps the word for itself.
pub(super) fn is_keyword(name: &str) -> bool {
    KEYWORDS.split_whitespace().any(|word| word == name)
}
