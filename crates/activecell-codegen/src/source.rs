//! What a generator gives back.

/// A file to be written: where, relative to the folder that the user names, and what it holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceFile {
    /// With forward slashes: `rtl/decide_square.v`.
    pub path: String,
    /// Its text, ending with a newline.
    pub text: String,
}

impl SourceFile {
    /// A file of that path and text.
    pub fn new(path: impl Into<String>, text: impl Into<String>) -> Self {
        Self { path: path.into(), text: text.into() }
    }
}
