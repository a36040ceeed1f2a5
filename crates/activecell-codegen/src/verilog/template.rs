//! Templates: the sequential parts of the hardware, as text with places to be filled in.

/// The template with each `@NAME@` replaced by its value.
pub(super) fn fill(template: &str, values: &[(&str, &str)]) -> String {
    let filled = values
        .iter()
        .fold(template.to_owned(), |text, (name, value)| text.replace(&format!("@{name}@"), value));
    debug_assert!(!filled.contains('@') || filled.contains("@("), "a place was left empty:\n{filled}");
    filled
}
