//! Every command that a document shows prints what the document says.

/// README and docs, run in the project's folder; `[..]` in them stands for anything.
#[test]
fn the_documents_tell_the_truth() {
    let project = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    std::env::set_current_dir(project).expect("the tests run inside the project");
    trycmd::TestCases::new().case("README.md").case("docs/*.md").run();
}
