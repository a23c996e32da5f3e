//! Pictures of where malfunction comes from: the histogram of forces, the sides on which units fail, what drives them.

use slipfit_tolerance::number::fixed;

use crate::{
    dynamics::driven::DriveKind,
    show::{
        bars::{Bar, Block, bars},
        chart::outline,
        plot::{Chart, Look, Panel, PlotError, Series, small_chart},
    },
};
use crate::{
    population::{
        drivers::Driver,
        ranked::Ranked,
        statistics::Share,
        study::Population,
        subject::Subject,
        tally::{Counts, Tally},
    },
    show::units::effort,
};

/// The fewest and the most classes of a histogram.
const CLASSES: [usize; 2] = [5, 48];
/// The most bars of a block.
const MOST: usize = 8;
/// Least share (%) that is shown.
const LEAST: f64 = 0.1;

/// How many classes a histogram of so many units has: the square root of their number.
fn classes(units: u64) -> usize {
    let [fewest, most] = CLASSES;
    (units.isqrt() as usize).clamp(fewest, most)
}

/// How the greatest force spreads over all units of a `tally` and over those that malfunction, beside a motor's greatest force.
///
/// # Errors
/// [`PlotError`], if no unit has a force.
pub fn histogram(title: &str, kind: DriveKind, tally: &Tally, limit: Option<f64>) -> Result<String, PlotError> {
    let Tally { counts: Counts { units, over_limit, .. }, figures, .. } = tally;
    let [low, high] = figures.force.ends().ok_or(PlotError::Empty)?;
    let all = (*units).max(1);
    let classes = classes(figures.force.units());
    // Units that all need the same have a class of their own.
    let step = f64::max((high - low) / classes as f64, 1e-6 * high.abs());
    let shares = |forces: &Ranked| {
        let mut counts = vec![0u64; classes];
        for (force, units) in forces.values() {
            counts[(((force - low) / step) as usize).min(classes - 1)] += units;
        }
        let share = |count: &u64| 100.0 * *count as f64 / all as f64;
        outline(counts.iter().enumerate().map(|(k, count)| (low + step * k as f64, share(count))), step)
    };
    let line = |label: &str, look, points| Series { label: label.into(), look, points };
    let mut series = vec![line("all", Look::Level(0.0), shares(&figures.force))];
    if figures.failing_force.units() > 0 {
        series.push(line("malfunction", Look::Level(1.0), shares(&figures.failing_force)));
    }
    let top = series[0].points.iter().map(|(_, share)| *share).fold(0.0, f64::max);
    let over = limit.map(|limit| {
        series.push(line("", Look::Guide, vec![(limit, 0.0), (limit, 1.05 * top)]));
        let share = 100.0 * Share::new(*over_limit, all).share;
        let unit = kind.effort_unit();
        format!("; grey: the motor's {} {unit}, which {} % exceed", fixed(limit, 2), fixed(share, 2))
    });
    small_chart(&Chart {
        title: title.into(),
        subtitle: format!("{units} units{}", over.unwrap_or_default()),
        x_label: effort(kind),
        panels: vec![Panel { y_label: "share of the units (%)".into(), series, ..Panel::default() }],
        ..Chart::default()
    })
}

/// On which side units of `subject` malfunction: loose or tight, and the contact that is pressed hardest.
///
/// # Errors
/// [`PlotError`], if no gap varies or no unit malfunctions.
pub fn sides(subject: &dyn Subject, tally: &Tally) -> Result<String, PlotError> {
    if !subject.has_levels() || tally.counts.malfunctions == 0 {
        return Err(PlotError::Empty);
    }
    let Tally { counts, figures, .. } = tally;
    let (all, failing) = (&figures.tightness, &figures.failing_tightness);
    // Units before the unit of this rank, from the loosest on, and those that malfunction among them.
    let before = |rank: u64| all.at(rank).map_or([0, 0], |n| [all.below(n), failing.below(n)]);
    let looser = |name: &str, rank: u64| {
        let [units, failed] = before(rank);
        bar(name, failed, units)
    };
    let tighter = |name: &str, rank: u64| {
        let [units, failed] = before(rank);
        bar(name, failing.units() - failed, all.units() - units)
    };
    let (half, tenth) = (counts.units / 2, counts.units.div_ceil(10));
    let mut blocks = vec![Block {
        heading: "of these units malfunction".into(),
        bars: vec![
            looser("the loosest tenth", tenth),
            looser("the looser half", half),
            tighter("the tighter half", half),
            tighter("the tightest tenth", counts.units - tenth),
        ],
    }];
    let pressed = |(units, name): (&u64, String)| bar(&name, *units, counts.malfunctions);
    let mut contacts: Vec<Bar> = counts.pressed.iter().zip(subject.gap_names()).map(pressed).collect();
    contacts.retain(|bar| bar.percent >= LEAST);
    contacts.sort_by(|one, other| other.percent.total_cmp(&one.percent));
    contacts.truncate(MOST);
    if !contacts.is_empty() {
        blocks.push(Block { heading: "of those press hardest at".into(), bars: contacts });
    }
    Ok(bars(subject.title(), "where units fail, % of them, with the standard error", &blocks))
}

/// What drives force and malfunction, the strongest first.
///
/// # Errors
/// If no contributor is told from nothing.
pub fn ranking(title: &str, kind: DriveKind, population: &Population) -> Result<String, PlotError> {
    let block = |heading: &str, drivers: &[Driver]| {
        let bar = |driver: &Driver| Bar {
            name: driver.name.clone(),
            percent: 100.0 * driver.share,
            error: Some(100.0 * driver.error),
        };
        let bars = drivers.iter().filter(|driver| driver.is_significant()).map(bar).take(MOST).collect();
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
fn bar(name: &str, some: u64, all: u64) -> Bar {
    let all = all.max(1) as f64;
    let share = some as f64 / all;
    Bar { name: name.into(), percent: 100.0 * share, error: Some(100.0 * libm::sqrt(share * (1.0 - share) / all)) }
}

#[cfg(test)]
mod tests {
    use super::{classes, histogram, ranking, sides};
    use crate::{
        dynamics::{
            driven::{DriveKind, Driven},
            example,
        },
        population::{
            production::Production,
            study::Population,
            tally::{Duty, Tally},
        },
        show::plot::PlotError,
    };

    #[test]
    fn few_units_make_few_classes() {
        assert_eq!([0, 1, 24, 128, 256, 2_000, 1_000_000].map(classes), [5, 5, 5, 11, 16, 44, 48]);
    }

    #[test]
    fn pictures_count_what_the_population_does() {
        let mut scene = example::cd_rom();
        scene.run.duration = scene.stroke_duration().unwrap();
        let production = Production::new(&scene, None, 0.0, 1).unwrap();
        let study = |limit| {
            let duty = Duty { limit, stroke: None };
            Population::study(&scene, &production, 240, duty, |_| {}).unwrap()
        };
        let population = study(None);
        let failed = population.statistics.malfunctions.units;
        assert!(failed > 20 && failed < 220, "{failed}");
        // A limit that half of all forces exceed.
        let force = &population.tally.figures.force;
        let limit = Some(0.5 * (force.at(119).unwrap() + force.at(120).unwrap()));
        let drawn = histogram(&scene.title, DriveKind::Pushes, &study(limit).tally, limit).unwrap();
        assert!(drawn.contains("which 50.00 % exceed") && drawn.contains("malfunction"), "{drawn}");
        let drawn = sides(&scene, &population.tally).unwrap();
        assert!(drawn.contains("the tightest tenth") && drawn.contains("press hardest at"), "{drawn}");
        assert!(ranking(&scene.title, DriveKind::Pushes, &population).unwrap().contains("greatest force"));
        // Without failures and without forces there is less to show, and no error.
        let nothing = Tally::new();
        assert_eq!(histogram(&scene.title, DriveKind::Pushes, &nothing, None), Err(PlotError::Empty));
        assert_eq!(sides(&scene, &nothing), Err(PlotError::Empty));
    }
}
