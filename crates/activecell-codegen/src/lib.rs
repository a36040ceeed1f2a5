//! The rules of activecell as C99, Verilog-2005 and VHDL-93, from the tables of the core.
//!
//! A rule is a small truth table, so the navigator becomes firmware and gates. Here the tables are read from the core,
//! reduced to formulas, and held as [`logic::Circuit`]s; each language has a printer for circuits. Nothing of a rule is
//! written down a second time.
//!
//! ```
//! use activecell::Lattice;
//! use activecell_codegen::{circuits, verilog};
//! let text = verilog::module(&circuits::decision(Lattice::Square));
//! assert!(text.contains("module decide_square"));
//! ```

mod banks;
mod bundle;
pub mod c;
pub mod circuits;
pub(crate) mod colours;
mod images;
pub mod logic;
pub mod model;
mod motors;
mod navigator;
mod source;
mod template;
mod text;
pub mod verilog;
pub mod vhdl;
mod window;

pub use banks::{Banks, MOST_STORED};
pub use bundle::{Bundle, GenerateError, Language, Order, Size, generate, long_way};
pub use source::SourceFile;
