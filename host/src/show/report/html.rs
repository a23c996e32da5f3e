//! Pieces of the page.

use maud::{Markup, PreEscaped, Render, html};
use slipfit_tolerance::number::{fixed, level, typeset};

use crate::{
    dynamics::outcome::Verdict,
    show::{figure::word, svg::width},
};

/// The widest picture (px) that a phone shows without scrolling.
const NARROW: f64 = 490.0;

/// An SVG document with its caption.
pub fn figure(caption: &str, svg: &str) -> Markup {
    let wide = width(svg).is_some_and(|width| width > NARROW);
    html! {
        figure {
            div.scroll.wide[wide] { (PreEscaped(svg)) }
            figcaption { (caption) }
        }
    }
}

/// A table with a caption; `head` is one row or several.
pub fn table(caption: &str, head: Markup, rows: impl IntoIterator<Item = Markup>) -> Markup {
    html! {
        div.scroll {
            table {
                caption { (caption) }
                thead { (head) }
                tbody { @for row in rows { (row) } }
            }
        }
    }
}

/// Headings of columns.
pub fn columns(names: &[&str]) -> Markup {
    html! { @for name in names { th scope="col" { (name) } } }
}

/// The heading of a column beside groups of columns.
pub fn tall(name: impl Render) -> Markup {
    html! { th scope="col" rowspan="2" { (name) } }
}

/// The heading of `count` columns.
pub fn group(name: &str, count: usize) -> Markup {
    html! { th scope="colgroup" colspan=(count) { (name) } }
}

/// A row with `name` as its heading.
pub fn row(name: &str, cells: impl IntoIterator<Item = impl Render>) -> Markup {
    html! { tr { th scope="row" { (name) } @for cell in cells { td { (cell) } } } }
}

/// Sentences as a list.
pub fn list(notes: &[String]) -> Markup {
    html! { @if !notes.is_empty() { ul.notes { @for note in notes { li { (note) } } } } }
}

/// A verdict in its colour.
pub fn marked(verdict: Verdict) -> Markup {
    let word = word(verdict);
    html! { span class=(word) { (word) } }
}

/// Plain text in which a hyphen between a blank and a digit becomes a minus sign.
pub fn minus_signs(text: &str) -> String {
    let mut parts = text.split(" -");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        let sign = if part.starts_with(|c: char| c.is_ascii_digit()) { " \u{2212}" } else { " -" };
        text + sign + part
    })
}

/// A tolerance level.
pub fn typed(n: f64) -> String {
    typeset(&level(n))
}

/// With a fixed number of decimals.
pub fn real(value: f64, decimals: usize) -> String {
    typeset(&fixed(value, decimals))
}

/// What is there, else a dash.
pub fn optional(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| real(value, decimals))
}

/// A length (m) in mm.
pub fn mm(length: Option<f64>) -> String {
    optional(length.map(|length| length * 1e3), 4)
}
