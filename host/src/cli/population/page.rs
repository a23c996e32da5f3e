//! What units do, for a page: pictures, and a player of one unit of each kind.

use maud::Markup;
use rayon::prelude::*;

use crate::{
    cli::failure::Failure,
    dynamics::{
        driven::{DriveKind, Driven},
        film::MOMENTS,
    },
    mechanism::{ByDrive, film},
    population::{
        Unit,
        mechanism::{MechanismPopulation, mechanism_of},
        production::Production,
        study::Population,
        telling::{filmed, one_of_each},
        uncertain::answer::Answer,
    },
    setup::Scene,
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

/// The same of a mechanism.
pub const MECHANISM_FIGURES: [&str; 3] = ["population.svg", "population-forces.svg", "population-drivers.svg"];

/// Name of the picture of the unknowns.
pub const UNKNOWN_FIGURE: &str = "population-unknown.svg";

/// What the picture of forces shows.
const EVERY_MARK: &str = "Every mark is a unit of the production, drawn with gaps of its own. No level stands for it: its gaps \
                          differ from each other.";

/// Pictures and player of a `population`, with a motor's force `limit` (N), and the names of the pictures' files.
pub fn units(
    scene: &Scene,
    production: &Production,
    population: &Population,
    limit: Option<f64>,
) -> Result<(Units, Vec<&'static str>), Failure> {
    let all = &population.tally;
    let pictures = [
        (EVERY_MARK, units::forces(scene, all, limit)),
        (
            "What force units need. Those that jam need all that the drive has.",
            causes::histogram(&scene.title, DriveKind::Pushes, all, limit),
        ),
        (
            "Where units fail: how many of the loose and of the tight ones, and which contact presses hardest.",
            Ok(causes::sides(scene, all)),
        ),
        (
            "Which tolerances the force and the malfunction vary with, the strongest first. What is missing to 100 % comes from \
             weaker ones and from several together.",
            causes::ranking(&scene.title, DriveKind::Pushes, population),
        ),
    ];
    let run = |unit: &Unit| {
        let film = filmed(scene, production, unit.number, MOMENTS)?;
        Ok(player::of_slide(scene, label(unit), &film))
    };
    let player = played(&one_of_each(all), run, "on its pins")?;
    let (figures, names) = shown(FIGURES, pictures)?;
    Ok((Units { figures, player }, names))
}

/// The same of a mechanism.
pub fn units_of_mechanism(
    driven: &ByDrive,
    production: &Production<Vec<f64>>,
    population: &MechanismPopulation,
    limit: Option<f64>,
) -> Result<(Units, Vec<&'static str>), Failure> {
    let (title, kind, all) = (driven.title(), driven.kind(), &population.tally);
    let pictures = [
        (EVERY_MARK, units::forces(driven, all, limit)),
        ("The greatest force or torque that units need of the drive.", causes::histogram(title, kind, all, limit)),
        (
            "Which gaps and tolerances malfunction and the greatest force or torque vary with, the strongest first.",
            causes::ranking(title, kind, population),
        ),
    ];
    let run = |unit: &Unit<Vec<f64>>| {
        let (drawn, i) = production.draw_one(unit.number);
        let own = mechanism_of(driven.mechanism(), &drawn, i);
        let own = ByDrive::new(&own, driven.index()).ok_or_else(|| Failure::Input("no such drive".into()))?;
        let filmed = film(own.mechanism(), &drawn.gaps[i], MOMENTS)?;
        Ok(player::of_mechanism(own.mechanism(), Some(&own), &drawn.gaps[i], label(unit), &filmed))
    };
    let player = played(&one_of_each(all), run, "on its joints")?;
    let (figures, names) = shown(MECHANISM_FIGURES, pictures)?;
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
fn label<G>(unit: &Unit<G>) -> String {
    format!("unit {}: {}", unit.number, word(unit.outcome.verdict))
}

/// The player of `units`, one of each kind, `whereon` they move; none if there is no unit.
fn played<G: Sync>(
    units: &[&Unit<G>],
    run: impl Fn(&Unit<G>) -> Result<player::Run, Failure> + Sync + Send,
    whereon: &str,
) -> Result<Option<Markup>, Failure> {
    let runs = units.par_iter().map(|unit| run(unit)).collect::<Result<Vec<_>, _>>()?;
    let words = format!(
        "A typical unit of each kind (that with the median of the greatest force among those that jam, crawl or run), {whereon}:"
    );
    Ok((!runs.is_empty()).then(|| player::figure(&runs, &words)).transpose().map_err(anyhow::Error::from)?)
}

/// Those of the `pictures` that show something, and the names of their files.
fn shown<const N: usize>(
    files: [&'static str; N],
    pictures: [(&str, Result<String, PlotError>); N],
) -> Result<(Vec<Figure>, Vec<&'static str>), Failure> {
    let (mut figures, mut names) = (Vec::new(), Vec::new());
    for (name, (caption, svg)) in files.into_iter().zip(pictures) {
        match svg {
            Err(PlotError::Empty) => {}
            svg => {
                figures.push(Figure { caption: caption.into(), svg: svg.map_err(anyhow::Error::from)? });
                names.push(name);
            }
        }
    }
    Ok((figures, names))
}
