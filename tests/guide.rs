//! Pages of the guide, and numbers as these have them.

use std::fs;

/// The text of a page of that `name`.
///
/// # Panics
/// If there is none.
pub fn page(name: &str) -> String {
    let file = format!("{}/host/guide/src/{name}.md", env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// The same with every line break and run of blanks as one blank: what is said, wherever its lines end.
///
/// # Panics
/// If there is none.
#[allow(dead_code, reason = "not every test that has this module looks at running text")]
pub fn prose(name: &str) -> String {
    page(name).split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A `number` below a million, with a comma before its last three digits.
pub fn with_comma(number: u32) -> String {
    match number {
        ..1000 => number.to_string(),
        _ => format!("{},{:03}", number / 1000, number % 1000),
    }
}
