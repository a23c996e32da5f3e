//! Self-contained pages: figures and tables, and a player where units are simulated; nothing from outside.
//!
//! The same input gives the same bytes; there is no date on the page.

mod clearances;
mod html;
mod identified;
mod measured;
mod production;
mod sweep;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use slipfit_measured::{capability::Capability, table::MeasuredTable};

use self::html::{figure, list, minus_signs, real};
pub use self::{
    clearances::Clearances,
    identified::{Course, Identified, identified_page},
    production::Production,
};
use super::{palette::style_sheet, player, plot::PlotError};
use crate::dynamics::{driven::DriveKind, sweep::Sweep};

/// What a report is made of.
#[derive(Clone, Copy)]
pub struct ReportInput<'a> {
    /// The scene's title.
    pub title: &'a str,
    /// Its sweep.
    pub sweep: &'a Sweep,
    /// What it comes to, as plain lines; empty for none.
    pub answer: &'a str,
    /// Pictures, in order.
    pub figures: &'a [Figure],
    /// The gaps.
    pub clearances: Clearances<'a>,
    /// What units of the production do, if these were simulated.
    pub units: Option<&'a Units>,
    /// How the product's measures vary, if the scene has a product.
    pub production: Option<&'a Production>,
    /// The flash table, if one was made.
    pub flash: Option<Flash>,
    /// What the reader should know, as plain text.
    pub notes: &'a [String],
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Plain text below it.
    pub caption: String,
    /// An SVG document without XML declaration, as [`super::plot`] makes it; it goes onto the page as it is.
    pub svg: String,
}

/// What units drawn one by one do.
#[derive(Clone, Debug)]
pub struct Units {
    /// Pictures, in order.
    pub figures: Vec<Figure>,
    /// A player, as [`super::player::figure`] makes it.
    pub player: Option<Markup>,
}

/// Figures of a flash table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flash {
    /// Its size.
    pub bytes: usize,
    /// Worst error of an interpolated force (N).
    pub worst_force_error: f64,
    /// Worst error of an interpolated velocity (m/s).
    pub worst_velocity_error: f64,
}

/// The page as HTML.
pub fn report(input: &ReportInput) -> Markup {
    let (first, others) = input.figures.split_at(input.figures.len().min(1));
    let sections = html! {
        (verdict(input.answer))
        (figures(first))
        (notes(input.notes))
        @if let Some(of) = input.units { (units(of)) }
        @if !others.is_empty() { h2 { "Figures" } (figures(others)) }
        (sweep::levels(input.sweep))
        (sweep::summary(input.sweep, &input.clearances))
        @if let Some(of) = input.production { (production::section(of)) }
        (clearances::section(&input.clearances, input.production.is_some()))
        @if let Some(of) = &input.flash { (flash(input.sweep.kind, of)) }
    };
    page(input.title, &sections, input.units)
}

/// A page of a population: what it comes to, as plain lines, then player and pictures.
pub fn units_page(title: &str, answer: &str, of: &Units, remarks: &[String]) -> Markup {
    page(title, &html! { (verdict(answer)) (notes(remarks)) (units(of)) }, Some(of))
}

/// The same of one unit, with one picture.
pub fn unit_page(title: &str, answer: &str, player: Markup, picture: Figure, remarks: &[String]) -> Markup {
    let of = Units { figures: vec![picture], player: Some(player) };
    page(title, &html! { (verdict(answer)) (notes(remarks)) h2 { "What this unit does" } (moving(&of)) }, Some(&of))
}

/// The page of measured parts from a file, with pictures and figures of every characteristic, divided by a grouping of the
/// table if one is given.
///
/// # Errors
/// [`PlotError`], if a number is not finite.
pub fn measured_page(
    source: &str,
    table: &MeasuredTable,
    characteristics: &[Capability],
    grouping: Option<usize>,
    remarks: &[String],
) -> Result<Markup, PlotError> {
    let sections = measured::sections(table, characteristics, grouping)?;
    Ok(page(
        &format!("Capability of {source}"),
        &html! { (measured::summary(characteristics)) (notes(remarks)) (sections) },
        None,
    ))
}

/// The head of a page: its title, the style of all pages and, if it `plays`, of the player, and what `more` it has.
pub fn head(title: &str, plays: bool, more: &Markup) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            title { (title) }
            style {
                (PreEscaped(style_sheet()))
                (PreEscaped(include_str!("page.css")))
                @if plays { (player::STYLE) }
            }
            (more)
        }
    }
}

/// A page with these sections, and with what moves the player of `units`.
fn page(title: &str, sections: &Markup, units: Option<&Units>) -> Markup {
    let plays = units.is_some_and(|units| units.player.is_some());
    html! {
        (DOCTYPE)
        html lang="en" {
            (head(title, plays, &html! {}))
            body {
                main { h1 { (title) } (sections) }
                @if plays { script { (player::SCRIPT) } }
            }
        }
    }
}

/// The answer, line by line, so that what follows of a long line is indented as far as the texts behind their names. Its tables,
/// which cannot be broken, are parts of their own.
fn verdict(answer: &str) -> Markup {
    let unnamed = " ".repeat(16);
    html! {
        @if !answer.is_empty() {
            div.answer {
                @for part in answer.split("\n\n") {
                    pre.table[part.contains('─')] {
                        @for line in part.lines().map(minus_signs) {
                            @match line.strip_prefix(&unnamed) {
                                Some(more) => span.more { (more) },
                                None => span { (line) },
                            }
                        }
                    }
                }
            }
        }
    }
}

fn notes(notes: &[String]) -> Markup {
    html! { @if !notes.is_empty() { h2 { "Notes" } (list(notes)) } }
}

fn figures(figures: &[Figure]) -> Markup {
    html! { @for Figure { caption, svg } in figures { (figure(caption, svg)) } }
}

fn units(of: &Units) -> Markup {
    html! { h2 { "What units do" } (moving(of)) }
}

/// Player and pictures.
fn moving(Units { figures: pictures, player }: &Units) -> Markup {
    html! {
        @if let Some(player) = player { (player) }
        (figures(pictures))
    }
}

fn flash(kind: DriveKind, flash: &Flash) -> Markup {
    html! {
        h2 { "Flash table" }
        dl {
            dt { "Size" }
            dd { (flash.bytes) " bytes" }
            dt { "Worst interpolation error" }
            dd {
                (real(flash.worst_force_error, 6)) " " (kind.effort_unit()) " in " (kind.effort()) ", "
                (real(kind.speed(flash.worst_velocity_error), 4)) " " (kind.speed_unit()) " in velocity"
            }
        }
    }
}

#[cfg(test)]
mod tests;
