//! What one unit does, as fast as it can be computed: the verdict and the player, as a part of a page.

use maud::{Markup, html};
use slipfit_tolerance::number::{fixed, level};

use crate::{
    cli::{
        arguments::{Moving, SceneArguments},
        check,
        failure::Failure,
        mechanism,
        terminal::print,
    },
    dynamics::{
        driven::Driven,
        film::{MOMENTS, film as film_of_slide},
        outcome::Outcome,
    },
    mechanism::{ByDrive, film},
    show::{figure::word, player},
};

/// Prints the unit of level `n`: a slide's over its stroke, where it states one.
pub fn preview(scene: &SceneArguments, n: f64) -> Result<(), Failure> {
    let (moving, product) = scene.load_moving_with_product(&[])?;
    let label = format!("n = {}", level(n));
    let (verdicts, run, mut warnings) = match moving {
        Moving::Slide(mut slide) => {
            slide.run.duration = slide.stroke_duration().unwrap_or(slide.run.duration);
            let levels = [n; slipfit_core::slide::CONTACTS];
            slide.check_gaps(&levels).map_err(|error| Failure::Input(error.to_string()))?;
            let film = film_of_slide(&slide, &slide.gaps_at(&levels), MOMENTS)?;
            let verdict = verdict("drive", &*slide, &film.outcome);
            (vec![verdict], player::of_slide(&slide, label, &film), check::warnings_of(&slide))
        }
        Moving::Mechanism(found) => {
            let gaps = found.gaps_at(&[n])?;
            let film = film(&found, &gaps, MOMENTS)?;
            let driven: Vec<_> = (0..found.drives.len()).filter_map(|drive| ByDrive::new(&found, drive)).collect();
            let verdicts =
                driven.iter().zip(&film.outcomes).map(|(driven, outcome)| verdict(driven.name(), driven, outcome));
            let run = player::of_mechanism(&found, driven.first(), &gaps, label, &film);
            (verdicts.collect(), run, mechanism::warnings_of(&found)?)
        }
    };
    warnings.extend(product.into_iter().flat_map(|product| product.warnings));
    let player = player::figure(&[run], "The unit on its joints:").map_err(anyhow::Error::from)?;
    let page = html! {
        @for verdict in verdicts { (verdict) }
        @if !warnings.is_empty() { ul.notes { @for warning in &warnings { li { (warning) } } } }
        (player)
    };
    print(&page.into_string())
}

/// The verdict on the drive called `name`.
fn verdict(name: &str, driven: &dyn Driven, outcome: &Outcome) -> Markup {
    let (kind, word) = (driven.kind(), word(outcome.verdict));
    html! {
        p.verdict {
            (name) ": " strong class=(word) { (word) }
            @if let Some(peak) = outcome.peak_force {
                ", peak " (kind.effort()) " " (fixed(peak, 3)) " " (kind.effort_unit())
            }
            ", final speed " (fixed(kind.speed(outcome.final_velocity), 2)) " " (kind.speed_unit())
        }
    }
}
