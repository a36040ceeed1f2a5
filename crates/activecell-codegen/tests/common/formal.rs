//! Proofs: yosys writes a design and its assertions for a solver, `yosys-smtbmc` asks the solver.

use super::{command, root, yosys};
use std::path::{Path, PathBuf};

/// What a proof needs: names for [`super::programs`].
pub(crate) const TOOLS: [&str; 3] = ["yosys", "yosys-smtbmc", "z3"];

/// Whether the assertions in the module `top` of these files of the folder hold for ever: in the first `clocks` from the
/// beginning, and after any `clocks` in which they held.
pub(crate) fn holds(tools: &[PathBuf; 3], folder: &Path, files: &str, top: &str, clocks: u32) -> bool {
    let [yosys_file, smtbmc, z3] = tools;
    let script = format!(
        "read_verilog -formal {files}; prep -flatten -top {top} -nordff; async2sync; dffunmap; write_smt2 -wires {top}.smt2"
    );
    yosys(yosys_file, folder, &script);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut path: Vec<PathBuf> = std::env::split_paths(&path).collect();
    // It looks for z3 itself.
    path.insert(0, root().join(z3.parent().expect("a full path")));
    let path = std::env::join_paths(path).expect("they were joined before");
    let asks = |induction: &[&str]| {
        let mut smtbmc = command(smtbmc, folder);
        let clocks = clocks.to_string();
        smtbmc
            .env("PATH", &path)
            .args(["-s", "z3", "-t", &clocks])
            .args(induction)
            .arg(format!("{top}.smt2"));
        let output = smtbmc.output().expect("a program that was found can be run");
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(text.contains("Status:"), "{text}{}", String::from_utf8_lossy(&output.stderr));
        output.status.success()
    };
    asks(&[]) && asks(&["-i"])
}
