//! `slipfit sweep --over`: one or two keys of the scene, value by value.

use std::fmt::Write;

use serde::Serialize;
use slipfit_system::{interrupt, parallel};
use slipfit_tolerance::{
    number::{fixed, or_dash, ten_digits},
    product::Product,
};

use super::{Arguments, of_point};
use crate::{
    cli::{
        arguments::Moving,
        by_one_drive::ByOneDrive,
        call::{self, Want},
        failure::Failure,
        population::words::{faults, malfunction},
        terminal::{given, print, print_json, progress, text_table, warn},
    },
    dynamics::{answer::on_the_way, driven::DriveKind, outcome::Outcome, simulate::SimulateError},
    population::{
        statistics::Statistics,
        study::Population,
        tally::{Duty, VERDICTS},
    },
    scene::{Override, parse_levels},
    setup::LevelRange,
    show::{
        columns::{Column, Columns},
        export::of_figures,
        figure::{OverKey, Swept, over_keys},
    },
};

/// The key that is the tolerance level.
const LEVEL: &str = "n";
/// The most points.
const MOST_POINTS: usize = 100_000;
/// Seed of the productions: every point has the same units, so that points differ by the keys alone.
const SEED: u64 = 1;

/// A key of the scene, or the level n, and its values.
struct Key {
    name: String,
    values: LevelRange,
}

impl Key {
    /// From `KEY=A:B:STEP`.
    fn parse(text: &str) -> Result<Self, Failure> {
        let form = || {
            Failure::Input(format!("--over {text}: allowed is KEY=A:B:STEP, such as friction.coefficient=0.1:0.4:0.02"))
        };
        let (name, values) = text.split_once('=').ok_or_else(form)?;
        let values = parse_levels(values).map_err(|error| Failure::Input(format!("--over {text}: {error}")))?;
        Ok(Self { name: name.trim().to_owned(), values })
    }

    /// All values, as they are written: 0.1 and twice 0.1 more are 0.3.
    fn values(&self) -> Vec<f64> {
        self.values.levels().into_iter().map(|value| ten_digits(value).parse().unwrap_or(value)).collect()
    }
}

/// The scene as it was read, and the keys that are swept.
struct Read<'a> {
    keys: &'a [Key],
    /// Of the file.
    name: &'a str,
    text: &'a str,
    /// Options of the run as settings.
    of_run: &'a [Override],
}

/// What a unit, or a production, does with some values of the keys.
#[derive(Serialize)]
struct Point {
    /// Of each key.
    values: Vec<f64>,
    /// Tolerance level of the unit.
    n: f64,
    #[serde(flatten)]
    outcome: Outcome,
    /// What units of the production do; none if it was not asked for.
    population: Option<Statistics>,
    /// What a designer should know of the scene with these values.
    #[serde(skip)]
    warnings: Vec<String>,
    /// What speaks against the unit's run.
    #[serde(skip)]
    doubts: Vec<String>,
}

#[derive(Serialize)]
struct Report<'a> {
    title: &'a str,
    drive: &'a str,
    /// N, or N·m of a drive that turns, whose forces, speeds and travel are torques, rad/s and rad.
    effort_unit: &'static str,
    keys: Vec<&'a str>,
    points: &'a [Point],
    warnings: Vec<String>,
}

impl Arguments {
    /// Simulates a unit, and units of the production if they are asked for, at all values of the keys.
    pub(super) fn over_keys(&self, of_run: &[Override]) -> Result<(), Failure> {
        let keys = self.over.iter().map(|text| Key::parse(text)).collect::<Result<Vec<_>, _>>()?;
        let points = combinations(&keys)?;
        self.scene.check_outputs(&given([("--csv", &self.csv), ("--plot", &self.plot)]))?;
        let level = self.level_of_points(&keys)?;
        // Once: it may be a stream, or change meanwhile.
        let (name, text) = self.scene.text()?;
        let read = Read { keys: &keys, name: &name, text: &text, of_run };
        // Mistakes at any value are reported before hours of simulation.
        parallel::try_map(&points, |values| {
            let (moving, _) = self.at(&read, values)?;
            self.check_units(&keys, &ByOneDrive::new(&moving, &self.drive)?)
        })?;
        let (moving, _) = self.at(&read, &points[0])?;
        let of = ByOneDrive::new(&moving, &self.drive)?;
        let kind = of.subject().kind();
        let bar = progress("simulating", points.len());
        let found = self.threads.install(|| {
            parallel::try_map(&points, |values| {
                let point = self.point(&read, values, level);
                bar.inc(1);
                point
            })
        })??;
        bar.finish_and_clear();
        call::columns(Want::Columns, self.csv.as_deref(), || Ok(columns(&keys, kind, &found)))?;
        call::picture(self.plot.as_deref(), "values", || {
            let swept: Vec<Swept> = found.iter().map(shown).collect();
            let named: Vec<OverKey> =
                keys.iter().map(|key| OverKey { name: &key.name, count: key.values.count }).collect();
            over_keys(&named, &swept, kind, of.subject().title())
        })?;
        let mut warnings = gathered(&keys, &found);
        warnings.extend(doubts(&keys, &found));
        if self.scene.json {
            return print_json(&Report {
                title: of.subject().title(),
                drive: of.drive_name(),
                effort_unit: kind.effort_unit(),
                keys: keys.iter().map(|key| key.name.as_str()).collect(),
                points: &found,
                warnings,
            });
        }
        print(&format!("{}\n\n{}\n{}", of.title(), answer(&keys, &found), table(&keys, kind, &found)))?;
        warn(&warnings);
        Ok(())
    }

    /// The level of all units, where it is no key.
    fn level_of_points(&self, keys: &[Key]) -> Result<f64, Failure> {
        let Some(n) = &self.levels.n else { return Ok(0.0) };
        let one = parse_levels(n).ok().filter(|levels| levels.count == 1);
        match one {
            _ if keys.iter().any(|key| key.name == LEVEL) => {
                Err(Failure::Input(format!("--n {n}: --over has the level n as a key")))
            }
            Some(level) => Ok(level.first),
            None => Err(Failure::Input(format!(
                "--n {n}: beside --over one level is allowed, such as --n 2; or --over n={n}"
            ))),
        }
    }

    /// What moves with these `values` of the keys.
    fn at(&self, read: &Read, values: &[f64]) -> Result<(Moving, Option<Product>), Failure> {
        let named = read.keys.iter().zip(values).filter(|(key, _)| key.name != LEVEL);
        let set =
            named.map(|(key, value)| Override::assigned("--over", &format!("{}={}", key.name, ten_digits(*value))));
        let all = self.scene.overrides(&read.of_run.iter().cloned().chain(set).collect::<Vec<_>>());
        let (moving, product) = Moving::parse(read.name, read.text, &all)?;
        Ok((self.of_length(moving)?, product))
    }

    /// Whether units of the production tell anything at the points.
    fn check_units(&self, keys: &[Key], of: &ByOneDrive) -> Result<(), Failure> {
        let why = match self.units {
            None => return Ok(()),
            Some(_) if of.has_unknowns() => "allowed is a scene without [uncertain] and [measured]",
            Some(_) if self.controller.given() => {
                "they are the desk's: allowed is no --step, --integrator and --scalar"
            }
            Some(_) if keys.iter().all(|key| key.name == LEVEL) => "units have gaps of their own, whatever the level n",
            Some(_) => return Ok(()),
        };
        Err(Failure::Input(format!("--units beside --over: {why}")))
    }

    fn point(&self, read: &Read, values: &[f64], level: f64) -> Result<Point, Failure> {
        if interrupt::requested() {
            return Err(SimulateError::Interrupted.into());
        }
        let (moving, product) = self.at(read, values)?;
        let of = ByOneDrive::new(&moving, &self.drive)?;
        let n = read.keys.iter().position(|key| key.name == LEVEL).map_or(level, |k| values[k]);
        let unit = of_point(&of, n, self.controller.given())?;
        let mut warnings = of.warnings()?;
        warnings.extend(product.iter().flat_map(|product| product.warnings.iter().cloned()));
        let population = self.units.map(|units| {
            let production = of.production(product.as_ref(), 0.0, SEED)?;
            let stroke = of.subject().run().stroke.filter(|_| !of.has_opening() || self.length.stroke);
            let duty = Duty { limit: None, stroke };
            let population = Population::study(of.subject(), &production, units, duty, |_| ())?;
            warnings.extend(faults(of.subject(), &production, &population)?);
            Ok::<_, Failure>(population.statistics)
        });
        let population = population.transpose()?;
        Ok(Point { values: values.to_vec(), n, outcome: unit.outcome, population, warnings, doubts: unit.doubts })
    }
}

/// All combinations of values, the last key's fastest.
fn combinations(keys: &[Key]) -> Result<Vec<Vec<f64>>, Failure> {
    if keys.len() > 2 {
        return Err(Failure::Input(format!("--over is given {} times, allowed are one or two keys", keys.len())));
    }
    if let [one, other] = keys
        && one.name == other.name
    {
        return Err(Failure::Input(format!("--over names {} twice", one.name)));
    }
    let count: usize = keys.iter().map(|key| key.values.count).product();
    if count > MOST_POINTS {
        return Err(Failure::Input(format!("--over makes {count} points, allowed are {MOST_POINTS}")));
    }
    let mut points = vec![Vec::new()];
    for key in keys {
        let with = |point: &Vec<f64>| {
            key.values().into_iter().map(|value| [&point[..], &[value]].concat()).collect::<Vec<_>>()
        };
        points = points.iter().flat_map(with).collect();
    }
    Ok(points)
}

/// The values of the keys in words.
fn place(keys: &[Key], values: &[f64]) -> String {
    let of = |(key, value): (&Key, &f64)| format!("{} = {}", key.name, ten_digits(*value));
    keys.iter().zip(values).map(of).collect::<Vec<_>>().join(", ")
}

/// Which values do what: of one key in ranges, of two in counts; and the least and the greatest share that malfunctions.
fn answer(keys: &[Key], points: &[Point]) -> String {
    let mut text = String::new();
    if let [key] = keys {
        for range in points.chunk_by(|one, next| one.outcome.verdict == next.outcome.verdict) {
            let [first, last] = [&range[0], &range[range.len() - 1]].map(|point| ten_digits(point.values[0]));
            let values = if range.len() == 1 { first } else { format!("{first} … {last}") };
            let _ = writeln!(text, "{} = {values}: {}", key.name, range[0].outcome.verdict);
        }
    } else {
        for verdict in VERDICTS {
            let count = points.iter().filter(|point| point.outcome.verdict == verdict).count();
            if count > 0 {
                let _ = writeln!(text, "{verdict} at {count} of {} combinations", points.len());
            }
        }
    }
    let share = |point: &&Point| point.population.as_ref().map_or(0.0, |found| found.malfunctions.share);
    let all: Vec<&Point> = points.iter().filter(|point| point.population.is_some()).collect();
    // Where units come to no verdict, more may malfunction than are known to.
    let judged = all.iter().filter(|point| point.population.as_ref().is_some_and(|found| found.undecided.units == 0));
    let least = judged.min_by(|one, other| share(one).total_cmp(&share(other)));
    let most = all.iter().max_by(|one, other| share(one).total_cmp(&share(other)));
    for (name, point) in [("least", least), ("greatest", most)] {
        if let Some(Point { values, population: Some(found), .. }) = point {
            let _ =
                writeln!(text, "The {name} share that malfunctions: {} at {}", malfunction(found), place(keys, values));
        }
    }
    text
}

/// All points as a table.
fn table(keys: &[Key], kind: DriveKind, points: &[Point]) -> String {
    let has_units = points.iter().any(|point| point.population.is_some());
    let row = |point: &Point| {
        let Outcome { breakaway, peak_force, final_velocity, end, verdict, .. } = point.outcome;
        let mut row: Vec<String> = point.values.iter().map(|value| ten_digits(*value)).collect();
        row.extend([
            verdict.to_string(),
            or_dash(breakaway, |t| fixed(t * 1e3, 2)),
            or_dash(peak_force, |force| fixed(force, 4)),
            fixed(kind.speed(final_velocity), 3),
            fixed(kind.travel(end.z), 2),
        ]);
        if let Some(found) = &point.population {
            row.push(malfunction(found));
            row.push(found.undecided.units.to_string());
        }
        row.push(on_the_way(kind, &point.outcome));
        row
    };
    let rows: Vec<_> = points.iter().map(row).collect();
    let [peak, speed, travel] = [
        format!("peak, {}", kind.effort_unit()),
        format!("final, {}", kind.speed_unit()),
        format!("travel, {}", kind.travel_unit()),
    ];
    let mut heading: Vec<&str> = keys.iter().map(|key| key.name.as_str()).collect();
    heading.extend(["verdict", "breakaway, ms", &peak, &speed, &travel]);
    if has_units {
        heading.extend(["units that malfunction", "undecided"]);
    }
    heading.push("on the way");
    text_table(&heading, &rows)
}

/// A row for every point in SI units.
fn columns(keys: &[Key], kind: DriveKind, points: &[Point]) -> Columns {
    let own = keys.iter().enumerate().filter(|(_, key)| key.name != LEVEL);
    let of_key = |(k, key): (usize, &Key)| Column::numbers(&key.name, points.iter().map(|point| point.values[k]));
    let mut all: Vec<_> = own.map(of_key).collect();
    all.push(Column::numbers(LEVEL, points.iter().map(|point| point.n)));
    all.push(Column::words("verdict", points.iter().map(|point| Some(point.outcome.verdict.to_string()))));
    all.extend(of_figures(kind, points.iter().map(|point| &point.outcome)));
    let count = |name, count: fn(&Statistics) -> u64| {
        let of_point = |point: &Point| point.population.as_ref().map(|found| count(found) as f64);
        Column::optional(name, points.iter().map(of_point))
    };
    all.push(count("units", |found| found.units));
    all.push(count("malfunctions", |found| found.malfunctions.units));
    all.push(count("undecided", |found| found.undecided.units));
    Columns(all)
}

/// A point as pictures show it: the share in per cent, where any unit comes to a verdict.
fn shown(point: &Point) -> Swept {
    let share = |found: &Statistics| (found.undecided.units < found.units).then_some(100.0 * found.malfunctions.share);
    Swept {
        values: point.values.clone(),
        verdict: point.outcome.verdict,
        peak: point.outcome.peak_force,
        malfunction: point.population.as_ref().and_then(share),
    }
}

/// The warnings of all points: of those that differ by numbers alone the first, with where it holds unless that is everywhere.
fn gathered(keys: &[Key], points: &[Point]) -> Vec<String> {
    let kind = |text: &str| text.split(|c: char| c.is_ascii_digit()).next().unwrap_or_default().to_owned();
    let mut kinds: Vec<(String, Vec<(&Point, &str)>)> = Vec::new();
    for point in points {
        for warning in &point.warnings {
            let of = kind(warning);
            match kinds.iter_mut().find(|(other, _)| *other == of) {
                Some((_, all)) => all.push((point, warning)),
                None => kinds.push((of, vec![(point, warning)])),
            }
        }
    }
    let told = |(_, all): &(String, Vec<(&Point, &str)>)| {
        let (first, warning) = all[0];
        if all.len() >= points.len() && all.iter().all(|(_, other)| *other == warning) {
            return warning.to_owned();
        }
        format!("at {}{}: {warning}", place(keys, &first.values), others(all.len() - 1))
    };
    kinds.iter().map(told).collect()
}

/// How many other points there are.
fn others(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => " (and at another point)".into(),
        more => format!(" (and at {more} other points)"),
    }
}

/// What speaks against the runs, of the first of which it does.
fn doubts(keys: &[Key], points: &[Point]) -> Option<String> {
    let mut doubtful = points.iter().filter(|point| !point.doubts.is_empty());
    let first = doubtful.next()?;
    Some(format!("at {}{}: {}", place(keys, &first.values), others(doubtful.count()), first.doubts[0]))
}
