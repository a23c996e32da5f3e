//! Pieces of the page.

use std::fmt::Write;

use crate::{
    dynamics::outcome::Verdict,
    show::{
        figure::word,
        markup::escape,
        number::{fixed, level, typeset},
    },
};

/// An SVG document with its caption.
pub fn figure(caption: &str, svg: &str) -> String {
    format!("<figure>\n<div class=\"scroll\">{svg}</div>\n<figcaption>{}</figcaption>\n</figure>\n", escape(caption))
}

/// A table with a caption; `head` and `body` are rows.
pub fn table(caption: &str, head: &str, body: &str) -> String {
    format!(
        "<div class=\"scroll\"><table>\n<caption>{caption}</caption>\n<thead>\n{head}</thead>\n<tbody>\n{body}</tbody>\n</table></div>\n"
    )
}

/// A row with `name` as its heading, or with its first cell if there is no name.
pub fn tr(name: &str, cells: &[String]) -> String {
    let (name, cells) = match cells {
        [first, rest @ ..] if name.is_empty() => (first.as_str(), rest),
        _ => (name, cells),
    };
    let mut row = format!("<tr><th scope=\"row\">{name}</th>");
    for cell in cells {
        let _ = write!(row, "<td>{cell}</td>");
    }
    row + "</tr>\n"
}

/// Sentences as a list.
pub fn list(notes: &[String]) -> String {
    let items: String = notes.iter().map(|note| format!("<li>{}</li>\n", escape(note))).collect();
    if items.is_empty() { items } else { format!("<ul class=\"notes\">\n{items}</ul>\n") }
}

/// A verdict in its colour.
pub fn marked(verdict: Verdict) -> String {
    let word = word(verdict);
    format!("<span class=\"{word}\">{word}</span>")
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
