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

/// Names of the pictures' files; there is none of forces where the run ends before the ramp begins.
pub const FIGURES: [&str; 4] =
    ["population.svg", "population-sides.svg", "population-drivers.svg", "population-forces.svg"];

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
    let mut figures = vec![
        figure(
            "Every mark is a unit of the production, drawn with gaps of its own. No level stands for it: units of the same \
             mean tightness run, crawl and jam.",
            picture::forces(scene, all, limit),
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
    match shares::histogram(scene, all, limit) {
        Err(PlotError::Empty) => {}
        svg => figures.push(figure("What force units need. Those that jam need all that the drive has.", svg)?),
    }
    let played = one_of_each(all);
    let run = |unit: &&Unit| {
        let Unit { number, outcome, .. } = unit;
        let film = filmed(scene, production, *number, MOMENTS)?;
        Ok::<_, Failure>(player::of_slide(scene, format!("unit {number}: {}", word(outcome.verdict)), &film))
    };
    let runs = played.iter().map(run).collect::<Result<Vec<_>, _>>()?;
    let caption = "Of the units that jam, crawl and run the one whose greatest force is in their middle, on its pins:";
    let player = (!runs.is_empty()).then(|| player::figure(&runs, caption)).transpose().map_err(anyhow::Error::from)?;
    Ok(Units { figures, player })
}
