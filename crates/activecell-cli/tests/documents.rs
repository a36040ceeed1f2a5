//! Every command that a document shows prints what the document says.

/// README and docs; `[..]` in them stands for anything.
#[test]
fn the_documents_tell_the_truth() {
    trycmd::TestCases::new().case("../../README.md").case("../../docs/*.md").case("tests/cmd/*.trycmd").run();
}
