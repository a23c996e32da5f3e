//! What units do, for a page: pictures, and a player of one unit of each kind.

use rayon::prelude::*;

use crate::{
    cli::{Failure, simulate::MOMENTS},
    dynamics::driven::DriveKind,
    population::{
        Unit, picture,
        production::Production,
        shares,
        study::Population,
        telling::{filmed, one_of_each},
    },
    scene::Scene,
    show::{
        figure::word,
        player,
        plot::PlotError,
        report::{Figure, Units},
    },
};

/// Names of the pictures' files, of which those that would show nothing are not made.
pub const FIGURES: [&str; 4] =
    ["population.svg", "population-forces.svg", "population-sides.svg", "population-drivers.svg"];

/// Pictures and player of a `population`, with a motor's force `limit` (N), and the names of the pictures' files.
pub fn units(
    scene: &Scene,
    production: &Production,
    population: &Population,
    limit: Option<f64>,
) -> Result<(Units, Vec<&'static str>), Failure> {
    let all = &population.tally;
    let pictures = [
        (
            "Every mark is a unit of the production, drawn with gaps of its own. No level stands for it: its gaps differ from \
             each other.",
            picture::forces(scene, all, limit),
        ),
        (
            "What force units need. Those that jam need all that the drive has.",
            shares::histogram(&scene.title, DriveKind::Pushes, all, limit),
        ),
        (
            "Where units fail: how many of the loose and of the tight ones, and which contact presses hardest.",
            Ok(shares::sides(scene, all)),
        ),
        (
            "Which tolerances the force and the malfunction vary with, the strongest first. What is missing to 100 % comes from \
             weaker ones and from several together.",
            shares::ranking(&scene.title, DriveKind::Pushes, population),
        ),
    ];
    let (mut figures, mut names) = (Vec::new(), Vec::new());
    for (name, (caption, svg)) in FIGURES.into_iter().zip(pictures) {
        match svg {
            Err(PlotError::Empty) => {}
            svg => {
                figures.push(Figure { caption: caption.into(), svg: svg.map_err(anyhow::Error::from)? });
                names.push(name);
            }
        }
    }
    let run = |unit: &&Unit| {
        let Unit { number, outcome, .. } = unit;
        let film = filmed(scene, production, *number, MOMENTS)?;
        Ok::<_, Failure>(player::of_slide(scene, format!("unit {number}: {}", word(outcome.verdict)), &film))
    };
    let runs = one_of_each(all).par_iter().map(run).collect::<Result<Vec<_>, _>>()?;
    let words = "A typical unit of each kind (that with the median of the greatest force among those that jam, crawl or run), on its pins:";
    let player = (!runs.is_empty()).then(|| player::figure(&runs, words)).transpose().map_err(anyhow::Error::from)?;
    Ok((Units { figures, player }, names))
}
