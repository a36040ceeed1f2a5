//! Text files with places to fill in.

/// The template with each `@NAME@` replaced by its value, a `&str` or a `String`.
pub(crate) fn fill<S: AsRef<str>>(template: &str, values: &[(&str, S)]) -> String {
    let fill_in =
        |text: String, (name, value): &(&str, S)| text.replace(&format!("@{name}@"), value.as_ref());
    values.iter().fold(template.to_owned(), fill_in)
}
