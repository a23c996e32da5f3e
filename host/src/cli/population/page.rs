//! What units do, for a page: pictures, and a player of one unit of each kind.

use maud::Markup;

use slipfit_system::parallel;

use crate::{
    cli::{by_one_drive::ByOneDrive, failure::Failure},
    population::{Unit, production::Production, study::Population, telling::one_of_each, uncertain::answer::Answer},
    show::{
        causes,
        figure::word,
        player,
        plot::PlotError,
        report::{Figure, Units},
        uncertain::decisive,
        units,
    },
};

/// Names of the pictures' files, of which those that would show nothing are not made.
pub const FIGURES: [&str; 4] =
    ["population.svg", "population-forces.svg", "population-sides.svg", "population-drivers.svg"];

/// Name of the picture of the unknowns.
pub const UNKNOWN_FIGURE: &str = "population-unknown.svg";

/// What the picture of forces shows.
const EVERY_MARK: &str = "Every mark is a unit of the production, drawn with gaps of its own. No level stands for it: its gaps \
                          differ from each other.";

/// Pictures and player of a `population`, with a motor's force `limit` (N, N·m), and the names of the pictures' files.
pub fn units(
    of: &ByOneDrive,
    production: &Production,
    population: &Population,
    limit: Option<f64>,
) -> Result<(Units, Vec<&'static str>), Failure> {
    let (subject, all) = (of.subject(), &population.tally);
    let (title, kind) = (subject.title(), subject.kind());
    let pictures = [
        (EVERY_MARK.to_owned(), units::forces(subject, all, limit)),
        (
            format!("What {} units need. Those that jam need all that the drive has.", kind.effort()),
            causes::histogram(title, kind, all, limit),
        ),
        (
            format!(
                "Where units fail: how many of the loose and of the tight ones{}.",
                if all.counts.pressed.is_empty() { "" } else { ", and which contact presses hardest" }
            ),
            causes::sides(subject, all),
        ),
        (
            format!(
                "Which tolerances the {} and the malfunction vary with, the strongest first. What is missing to 100 % comes \
                 from weaker ones and from several together.",
                kind.effort()
            ),
            causes::ranking(title, kind, population),
        ),
    ];
    let player = played(of, production, &one_of_each(all))?;
    let (figures, names) = shown(FIGURES, pictures)?;
    Ok((Units { figures, player }, names))
}

/// The picture of the unknown that decides most of an `answer`; none where no unknown has a number.
pub fn unknown_figure(title: &str, answer: Option<&Answer>) -> Result<Option<Figure>, Failure> {
    let Some(answer) = answer.filter(|answer| !answer.unknowns.is_empty()) else { return Ok(None) };
    let svg = decisive(title, answer).map_err(anyhow::Error::from)?;
    let caption = "How many units malfunction, over the unknown that decides most. Each ring is a value that was tried, with \
                   units of its own; the other unknowns differ between them.";
    Ok(Some(Figure { caption: caption.into(), svg }))
}

/// What tells a unit from others.
fn label(unit: &Unit) -> String {
    format!("unit {}: {}", unit.number, word(unit.outcome.verdict))
}

/// The player of typical `units`; none if there is no unit.
fn played(of: &ByOneDrive, production: &Production, units: &[&Unit]) -> Result<Option<Markup>, Failure> {
    let runs = parallel::try_map(units, |unit| of.played(production, unit, label(unit)))?;
    let words =
        "A typical unit of each kind (that with the median of the greatest force among those that jam, crawl or run):";
    Ok((!runs.is_empty()).then(|| player::figure(&runs, words)).transpose().map_err(anyhow::Error::from)?)
}

/// Those of the `pictures` that show something, and the names of their files.
fn shown<const N: usize>(
    files: [&'static str; N],
    pictures: [(String, Result<String, PlotError>); N],
) -> Result<(Vec<Figure>, Vec<&'static str>), Failure> {
    let (mut figures, mut names) = (Vec::new(), Vec::new());
    for (name, (caption, svg)) in files.into_iter().zip(pictures) {
        match svg {
            Err(PlotError::Empty) => {}
            svg => {
                figures.push(Figure { caption, svg: svg.map_err(anyhow::Error::from)? });
                names.push(name);
            }
        }
    }
    Ok((figures, names))
}
