//! Pictures of where malfunction comes from: the histogram of forces, the sides on which units fail, what drives them.

use super::{
    Unit,
    drivers::Driver,
    picture::effort,
    statistics::{Share, malfunctions},
    study::Population,
    subject::Subject,
};
use crate::{
    dynamics::driven::DriveKind,
    scene::Scene,
    show::{
        bars::{Bar, Block, bars},
        chart::outline,
        number::fixed,
        plot::{Chart, Look, Panel, PlotError, Series, small_chart},
    },
};

/// Classes of the histogram.
const CLASSES: usize = 48;
/// The most bars of a block.
const MOST: usize = 8;
/// Least share (%) that is shown.
const LEAST: f64 = 0.1;

/// How the greatest force spreads over all units and over those that malfunction, beside a motor's greatest force.
///
/// # Errors
/// [`PlotError`], if no unit has a force.
pub fn histogram<G>(title: &str, kind: DriveKind, units: &[Unit<G>], limit: Option<f64>) -> Result<String, PlotError> {
    let forces: Vec<(f64, bool)> =
        units.iter().filter_map(|unit| Some((unit.outcome.peak_force?, malfunctions(unit, limit)))).collect();
    if forces.is_empty() {
        return Err(PlotError::Empty);
    }
    let [low, high] =
        forces.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (f, _)| [low.min(*f), high.max(*f)]);
    // Units that all need the same have a class of their own.
    let step = f64::max((high - low) / CLASSES as f64, 1e-6 * high.abs());
    let shares = |failed: bool| {
        let mut counts = [0u64; CLASSES];
        for (force, _) in forces.iter().filter(|(_, fails)| *fails || !failed) {
            counts[(((force - low) / step) as usize).min(CLASSES - 1)] += 1;
        }
        let share = |count: &u64| 100.0 * *count as f64 / units.len().max(1) as f64;
        outline(counts.iter().enumerate().map(|(k, count)| (low + step * k as f64, share(count))), step)
    };
    let line = |label: &str, look, points| Series { label: label.into(), look, points };
    let mut series = vec![line("all", Look::Level(0.0), shares(false))];
    if forces.iter().any(|(_, fails)| *fails) {
        series.push(line("malfunction", Look::Level(1.0), shares(true)));
    }
    let top = series[0].points.iter().map(|(_, share)| *share).fold(0.0, f64::max);
    let over = limit.map(|limit| {
        series.push(line("", Look::Guide, vec![(limit, 0.0), (limit, 1.05 * top)]));
        let over = forces.iter().filter(|(force, _)| *force > limit).count() as u64;
        let share = 100.0 * Share::new(over, units.len().max(1) as u64).share;
        let unit = kind.effort_unit();
        format!("; grey: the motor's {} {unit}, which {} % exceed", fixed(limit, 2), fixed(share, 2))
    });
    small_chart(&Chart {
        title: title.into(),
        subtitle: format!("{} units{}", units.len(), over.unwrap_or_default()),
        x_label: effort(kind),
        panels: vec![Panel { y_label: "share of the units (%)".into(), series, ..Panel::default() }],
        ..Chart::default()
    })
}

/// On which side units malfunction: loose or tight, and the contact that is pressed hardest.
pub fn sides(scene: &Scene, units: &[Unit], limit: Option<f64>) -> String {
    let mut placed: Vec<(f64, &Unit)> = units.iter().map(|unit| (scene.tightness(&unit.gaps), unit)).collect();
    placed.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let tenth = placed.len().div_ceil(10);
    let failing = |name: &str, of: &[(f64, &Unit)]| {
        let failed = of.iter().filter(|(_, unit)| malfunctions(unit, limit)).count();
        bar(name, failed, of.len())
    };
    let (loose, tight) = placed.split_at(placed.len() / 2);
    let mut blocks = vec![Block {
        heading: "of these units malfunction".into(),
        bars: vec![
            failing("the loosest tenth", &placed[..tenth]),
            failing("the looser half", loose),
            failing("the tighter half", tight),
            failing("the tightest tenth", &placed[placed.len() - tenth..]),
        ],
    }];
    let failed: Vec<&Unit> = units.iter().filter(|unit| malfunctions(unit, limit)).collect();
    let pressed = |(contact, name): (usize, String)| {
        let own = |unit: &&&Unit| unit.outcome.most_loaded.is_some_and(|(most, _)| most == contact);
        bar(&name, failed.iter().filter(own).count(), failed.len())
    };
    let mut contacts: Vec<Bar> = scene.contact_names().into_iter().enumerate().map(pressed).collect();
    contacts.retain(|bar| bar.percent >= LEAST);
    contacts.sort_by(|one, other| other.percent.total_cmp(&one.percent));
    contacts.truncate(MOST);
    if !contacts.is_empty() {
        blocks.push(Block { heading: "of those press hardest at".into(), bars: contacts });
    }
    bars(&scene.title, "where units fail, % of them, with the standard error", &blocks)
}

/// What drives force and malfunction, the strongest first.
///
/// # Errors
/// If no contributor is told from nothing.
pub fn ranking<G>(title: &str, kind: DriveKind, population: &Population<G>) -> Result<String, PlotError> {
    let block = |heading: &str, drivers: &[Driver]| {
        let bar = |driver: &Driver| Bar {
            name: driver.name.clone(),
            percent: 100.0 * driver.share,
            error: Some(100.0 * driver.error),
        };
        let bars = drivers.iter().map(bar).filter(|bar| bar.percent >= LEAST).take(MOST).collect();
        Block { heading: heading.into(), bars }
    };
    let mut blocks = vec![
        block("malfunction", &population.of_malfunction),
        block(&format!("greatest {}", kind.effort()), &population.of_force),
    ];
    blocks.retain(|block| !block.bars.is_empty());
    if blocks.is_empty() {
        return Err(PlotError::Empty);
    }
    Ok(bars(title, "shares in the variance, % (correlation ratios), with the standard error", &blocks))
}

/// So many of all, with the standard error.
fn bar(name: &str, some: usize, all: usize) -> Bar {
    let all = all.max(1) as f64;
    let share = some as f64 / all;
    Bar { name: name.into(), percent: 100.0 * share, error: Some(100.0 * libm::sqrt(share * (1.0 - share) / all)) }
}

#[cfg(test)]
mod tests {
    use super::{histogram, ranking, sides};
    use crate::{
        dynamics::{
            driven::{DriveKind, Driven},
            example,
        },
        population::{production::Production, study::Population},
        show::plot::PlotError,
    };

    #[test]
    fn pictures_count_what_the_population_does() {
        let mut scene = example::cd_rom();
        scene.run.duration = scene.stroke_duration().unwrap();
        let production = Production::new(&scene, None, 0.0, 1).unwrap();
        let mut population = Population::study(&scene, &production, 240, (None, None), |_| {}).unwrap();
        let failed = population.statistics.malfunctions.units;
        assert!(failed > 20 && failed < 220, "{failed}");
        // A limit that half of all forces exceed.
        let mut forces: Vec<f64> = population.units.iter().filter_map(|unit| unit.outcome.peak_force).collect();
        forces.sort_by(f64::total_cmp);
        let drawn =
            histogram(&scene.title, DriveKind::Pushes, &population.units, Some(0.5 * (forces[119] + forces[120])))
                .unwrap();
        assert!(drawn.contains("which 50.00 % exceed") && drawn.contains("malfunction"), "{drawn}");
        let drawn = sides(&scene, &population.units, None);
        assert!(drawn.contains("the tightest tenth") && drawn.contains("press hardest at"), "{drawn}");
        assert!(ranking(&scene.title, DriveKind::Pushes, &population).unwrap().contains("greatest force"));
        // Without failures and without forces there is less to show, and no error.
        population.units.iter_mut().for_each(|unit| {
            (unit.outcome.peak_force, unit.outcome.verdict) = (None, crate::dynamics::outcome::Verdict::Undecided);
        });
        assert_eq!(histogram(&scene.title, DriveKind::Pushes, &population.units, None), Err(PlotError::Empty));
        assert!(!sides(&scene, &population.units, None).contains("press hardest"));
    }
}
