//! What units do, for a page: pictures, and a player of one unit of each kind.

use crate::{
    cli::{Failure, simulate::MOMENTS},
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

/// Names of the pictures' files.
pub const FIGURES: [&str; 4] =
    ["population.svg", "population-forces.svg", "population-sides.svg", "population-drivers.svg"];

/// Pictures and player of a `population`, with a motor's force `limit` (N).
pub fn units(
    scene: &Scene,
    production: &Production,
    population: &Population,
    limit: Option<f64>,
) -> Result<Units, Failure> {
    let all = &population.units;
    let figure = |caption: &str, svg: Result<String, PlotError>| {
        Ok::<_, Failure>(Figure { caption: caption.into(), svg: svg.map_err(anyhow::Error::from)? })
    };
    let figures = vec![
        figure(
            "Every mark is a unit of the production, drawn with gaps of its own. No level stands for it: units of the same \
             mean tightness run, crawl and jam.",
            picture::forces(scene, all, limit),
        )?,
        figure(
            "What force units need. Those that jam need all that the drive has.",
            shares::histogram(scene, all, limit),
        )?,
        figure(
            "Where units fail: how many of the loose and of the tight ones, and which contact presses hardest.",
            Ok(shares::sides(scene, all, limit)),
        )?,
        figure(
            "Which tolerances drive it: tighten the first ones first. What is missing to 100 % comes from several together.",
            Ok(shares::ranking(scene, population)),
        )?,
    ];
    let played = one_of_each(all);
    let run = |unit: &&Unit| {
        let Unit { number, outcome, .. } = unit;
        let film = filmed(scene, production, *number, MOMENTS)?;
        Ok::<_, Failure>(player::of_slide(scene, format!("unit {number}: {}", word(outcome.verdict)), &film))
    };
    let runs = played.iter().map(run).collect::<Result<Vec<_>, _>>()?;
    let caption = "One unit of each kind. Travel is to scale, gaps and the motion within them are enlarged; a side is \
                   coloured where it touches its pin, by force.";
    let player = (!runs.is_empty()).then(|| player::figure(&runs, caption)).transpose().map_err(anyhow::Error::from)?;
    Ok(Units { figures, player })
}
