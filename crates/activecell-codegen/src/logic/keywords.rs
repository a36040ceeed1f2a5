//! Words that are no names in one of the languages.

/// Those of C99 and C++, Verilog-2005, SystemVerilog-2012 and VHDL-93, and names that their standard libraries own, in lower case.
const KEYWORDS: &str = "
    abs accept_on access after alias all always always_comb always_ff always_latch and architecture array assert
    assign assume attribute auto automatic before begin bind bins binsof bit block body bool break buf buffer
    bufif0 bufif1 bus byte case casex casez cell chandle char checker class clocking cmos component config
    configuration const constant constraint context continue cover covergroup coverpoint cross deassign default
    defparam design disable disconnect dist do double downto edge else elsif end endcase endchecker endclass
    endclocking endconfig endfunction endgenerate endgroup endinterface endmodule endpackage endprimitive
    endprogram endproperty endsequence endspecify endtable endtask entity enum event eventually exit expect export
    extends extern false file final first_match float for force foreach forever fork forkjoin free function
    generate generic genvar global goto group guarded highz0 highz1 if iff ifnone ignore_bins illegal_bins
    implements implies import impure in inertial initial inline inout input inside instance int integer
    interconnect interface intersect is join label large let liblist library linkage literal local localparam
    logic long longint loop macromodule main map matches medium mod modport module nand negedge nettype new next
    nexttime nmos nor noshowcancelled not notif0 notif1 null of on open operator or others out output package
    packed parameter pmos port posedge postponed primitive priority private procedure process program property
    protected public pull0 pull1 pulldown pullup pulsestyle_ondetect pulsestyle_onevent pure rand randc randcase
    randsequence range rcmos real realtime record ref reg register reject reject_on release rem repeat report
    restrict return rnmos rol ror rpmos rtran rtranif0 rtranif1 s_always s_eventually s_nexttime s_until
    s_until_with scalared select sequence severity shared short shortint shortreal showcancelled signal signed
    sizeof sla sll small soft solve specify specparam sra srl static string strong strong0 strong1 struct subtype
    super supply0 supply1 switch sync_accept_on sync_reject_on table tagged task template then this throughout
    time timeprecision timeunit to tran tranif0 tranif1 transport tri tri0 tri1 triand trior trireg true type
    typedef unaffected union unique unique0 units unsigned until until_with untyped use uwire var variable
    vectored virtual void volatile wait wait_order wand weak weak0 weak1 when while wildcard wire with within wor
    work xnor xor";

/// Whether one of the languages keeps the word for itself.
pub(super) fn is_keyword(name: &str) -> bool {
    KEYWORDS.split_whitespace().any(|word| word == name)
}
