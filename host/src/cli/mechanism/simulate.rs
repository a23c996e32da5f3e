//! What `simulate` says of a mechanism.

use std::fmt::Write;

use maud::Markup;
use nalgebra::Vector3;
use serde::Serialize;
use slipfit_system::files;
use slipfit_tolerance::number::{fixed, level, or_dash, ten_digits};

use super::{DriveReport, GapReport, Wanted, gap_reports, levels, shown, units};
use crate::{
    cli::{
        call::{self, Want},
        failure::Failure,
        terminal::{print, print_json, text_table, warn},
    },
    dynamics::{answer::on_the_way, error_control::Stopped, film::MOMENTS},
    mechanism::{
        Action, ByDrive, Mechanism, MechanismRun, RunError, SCHEME, agreement::Agreement, confirmed, controller_run,
        doubts, film,
    },
    population::{mechanism::mechanism_of, production::Production},
    setup::ControllerSpec,
    show::{
        export::of_samples,
        figure::{columns_over_time, word},
        player,
        report::{Figure, unit_page},
    },
};

#[derive(Serialize)]
struct SimulateReport<'a> {
    title: &'a str,
    n: &'a [f64],
    integrator: &'static str,
    tolerance_m_per_s: f64,
    accepted: u32,
    refused: u32,
    integration_ms: f64,
    /// The greatest difference of a column to a run at a tenth of the tolerance, as a share of its peak.
    difference: f64,
    /// Which column that is; none if nothing differs.
    difference_column: Option<&'a str>,
    /// None without a drive.
    controller: Option<ControllerReport>,
    drives: Vec<DriveReport<'a>>,
    gaps: Vec<GapReport<'a>>,
    warnings: &'a [String],
    columns: &'a [String],
    samples: &'a [Vec<f64>],
}

/// What the controller computes with, and how far it is off.
#[derive(Serialize)]
struct ControllerReport {
    integrator: &'static str,
    step_s: f64,
    /// Whether figures and samples are its own.
    shown: bool,
    /// From the desk, as a share of the peak; none if the motion left the finite range.
    difference: Option<f64>,
}

/// A unit that is simulated.
pub struct OneUnit {
    /// Which it is, in words.
    label: String,
    /// The level of all its gaps, or of each.
    n: Vec<f64>,
    gaps: Vec<f64>,
}

impl OneUnit {
    /// That of the levels `n`: one for all gaps, or one each.
    pub fn at_levels(mechanism: &Mechanism, n: &[f64]) -> Result<Self, Failure> {
        let gaps = mechanism.gaps_at(levels(mechanism, n)?)?;
        let words: Vec<String> = n.iter().map(|&n| level(n)).collect();
        Ok(Self { label: format!("n = {}", words.join(", ")), n: n.to_vec(), gaps })
    }

    /// That with this `number` in a `production`, and the mechanism with its parameters.
    pub fn of_production(
        mechanism: &Mechanism,
        production: &Production,
        number: u64,
    ) -> Result<(Mechanism, Self), Failure> {
        let (drawn, i) = production.draw_one(number);
        let gaps = drawn.gaps[i].clone();
        if let Some(gap) = mechanism.misfit(&gaps) {
            let (name, mm) = (&mechanism.gaps[gap].name, fixed(gaps[gap] * 1e3, 4));
            return Err(Failure::Input(format!("unit {number} cannot be assembled: its gap \"{name}\" is {mm} mm")));
        }
        // What does not vary has any level.
        let n = mechanism.levels_of(&gaps).into_iter().map(Option::unwrap_or_default);
        let unit = Self { label: format!("unit {number}"), n: n.collect(), gaps };
        Ok((mechanism_of(mechanism, &drawn, i), unit))
    }
}

/// `simulate`.
pub fn simulate(mechanism: &Mechanism, unit: &OneUnit, every: f64, wanted: &Wanted) -> Result<(), Failure> {
    let OneUnit { label, n, gaps } = unit;
    wanted.check_outputs()?;
    let [desk, finer] = confirmed(mechanism, gaps, every)?;
    let agreement = desk.agreement(&finer, mechanism);
    let controller = controller(mechanism, gaps, every, &desk, wanted.by_controller)?;
    let one = match &controller {
        Some(Controller { run: Some(run), .. }) if wanted.by_controller => run,
        _ => &desk,
    };
    call::columns(Want::Columns, wanted.csv.as_deref(), || Ok(of_samples(&one.samples)))?;
    call::picture(wanted.plot.as_deref(), "motion", || {
        columns_over_time(&one.samples, &plotted(mechanism), &mechanism.title, label)
    })?;
    let computed =
        || computed(mechanism, &desk, &agreement) + &controllers(mechanism, controller.as_ref(), wanted.by_controller);
    let words = || described(mechanism, label, one) + &computed();
    let mut warnings = wanted.warnings(mechanism)?;
    warnings.extend(doubts(mechanism, &desk, &finer, &agreement));
    if let Some(path) = wanted.page {
        files::write(path, page(mechanism, unit, one, &words(), &warnings)?.into_string().as_bytes())?;
    }
    if wanted.scene.json {
        let named = mechanism.drives.iter().zip(&one.outcomes);
        let drives = named.map(|(drive, outcome)| DriveReport {
            name: &drive.name,
            unit: units(drive.action)[0],
            outcome: *outcome,
        });
        return print_json(&SimulateReport {
            title: &mechanism.title,
            n,
            integrator: SCHEME,
            tolerance_m_per_s: desk.tolerance,
            accepted: desk.effort.accepted,
            refused: desk.effort.refused,
            integration_ms: desk.integration.as_secs_f64() * 1e3,
            difference: agreement.share,
            difference_column: agreement.column.as_deref(),
            controller: controller.as_ref().map(|controller| ControllerReport {
                integrator: mechanism.controller.integrator.name(),
                step_s: mechanism.controller.step,
                shown: wanted.by_controller,
                difference: controller.difference,
            }),
            drives: drives.collect(),
            gaps: gap_reports(mechanism, gaps),
            warnings: &warnings,
            columns: &one.samples.columns,
            samples: &one.samples.rows,
        });
    }
    print(&words())?;
    warn(&warnings);
    Ok(())
}

/// The page of `one` run of a unit, with the desk's for the player.
fn page(
    mechanism: &Mechanism,
    unit: &OneUnit,
    one: &MechanismRun,
    words: &str,
    warnings: &[String],
) -> Result<Markup, Failure> {
    let OneUnit { label, gaps, .. } = unit;
    let driven = ByDrive::new(mechanism, 0);
    let label = |run: &MechanismRun| match run.outcomes.first() {
        Some(outcome) => format!("{label}: {}", word(outcome.verdict)),
        None => label.clone(),
    };
    let desk = film(mechanism, gaps, MOMENTS)?;
    let played = player::of_mechanism(mechanism, driven.as_ref(), gaps, label(&desk), &desk);
    let player = player::figure(&[played], "The desk's run, on its joints:").map_err(anyhow::Error::from)?;
    let svg = columns_over_time(&one.samples, &plotted(mechanism), &mechanism.title, &unit.label);
    let svg = svg.map_err(anyhow::Error::from)?;
    let picture = Figure { caption: over_time(mechanism, one), svg };
    Ok(unit_page(&mechanism.title, words, player, picture, warnings))
}

/// What the picture of `one` run shows, and which of its maxima are no peak.
fn over_time(mechanism: &Mechanism, one: &MechanismRun) -> String {
    let mut caption = "Over time, as CSV files have it.".to_owned();
    for (i, (drive, outcome)) in mechanism.drives.iter().zip(&one.outcomes).enumerate() {
        let ramp = drive.drive.ramp_start;
        let before =
            one.samples.rows.iter().filter(|row| row[0] < ramp).map(|row| row[1 + i].abs()).fold(0.0, f64::max);
        if let Some(peak) = outcome.peak_force.filter(|peak| before > *peak) {
            let unit = drive.action.kind().effort_unit();
            let _ = write!(
                caption,
                " The peak of \"{}\", {} {unit}, counts from the ramp's start at {} ms on. Before it the bodies settle in their \
                 gaps, which takes up to {} {unit}. The player has fewer moments, so that it can miss so short a rise.",
                drive.name,
                fixed(peak, 4),
                ten_digits(ramp * 1e3),
                fixed(before, 4),
            );
        }
    }
    caption
}

/// What the controller of a mechanism does.
struct Controller {
    /// Its run; none if it left the finite range.
    run: Option<MechanismRun>,
    /// The greatest difference of the drives' forces from the desk's, as a share of the peak.
    difference: Option<f64>,
}

/// The controller beside the run of the `desk`: where there is a drive, or somebody has `asked` for it.
fn controller(
    mechanism: &Mechanism,
    gaps: &[f64],
    every: f64,
    desk: &MechanismRun,
    asked: bool,
) -> Result<Option<Controller>, Failure> {
    let scheme = mechanism.controller.integrator;
    if !scheme.is_implicit() {
        let why = format!(
            "the controller's scheme is {}: of a mechanism only implicit ones are computed, such as extrapolated",
            scheme.name()
        );
        return if asked { Err(Failure::Input(why)) } else { Ok(None) };
    }
    if mechanism.drives.is_empty() && !asked {
        return Ok(None);
    }
    match controller_run(mechanism, gaps, every) {
        Err(RunError::Stopped { stopped: Stopped::NotFinite { .. } }) if !asked => {
            Ok(Some(Controller { run: None, difference: None }))
        }
        run => {
            let run = run?;
            let difference = Some(differing(mechanism, &run, desk));
            Ok(Some(Controller { run: Some(run), difference }))
        }
    }
}

/// The greatest difference of the drives' efforts between two runs, as a share of the greatest effort; of all columns where there is no
/// drive.
fn differing(mechanism: &Mechanism, one: &MechanismRun, finer: &MechanismRun) -> f64 {
    if mechanism.drives.is_empty() {
        return one.agreement(finer, mechanism).share;
    }
    let columns = 1..1 + mechanism.drives.len();
    let of_column = |k: usize| {
        let peak = finer.samples.rows.iter().fold(f64::MIN_POSITIVE, |most, row| most.max(row[k].abs()));
        let pairs = one.samples.rows.iter().zip(&finer.samples.rows);
        pairs.fold(0.0, |most: f64, (one, finer)| most.max((one[k] - finer[k]).abs())) / peak
    };
    columns.map(of_column).fold(0.0, f64::max)
}

/// Which columns a plot shows: what drives do and how fast their bodies go; without drives how all bodies go.
fn plotted(mechanism: &Mechanism) -> Vec<String> {
    let along = |axis: [f64; 3]| {
        let most = (0..3).max_by(|a, b| axis[*a].abs().total_cmp(&axis[*b].abs())).unwrap_or(2);
        ["x", "y", "z"][most]
    };
    let speed = |body: usize, action: Option<Action>| {
        let name = &mechanism.bodies[body].name;
        match action {
            Some(Action::Turns { .. }) | None if mechanism.planar => format!("{name}.spin (rad/s)"),
            Some(Action::Turns { axis }) => format!("{name}.w{} (rad/s)", along(axis)),
            Some(Action::Pushes { axis }) => format!("{name}.v{} (m/s)", along(axis)),
            None => format!("{name}.vz (m/s)"),
        }
    };
    let all = mechanism.columns();
    if mechanism.drives.is_empty() {
        return (0..mechanism.bodies.len()).map(|body| speed(body, None)).collect();
    }
    let forces = all.iter().skip(1).take(mechanism.drives.len()).cloned();
    let speeds = mechanism.drives.iter().map(|drive| speed(drive.body, Some(drive.action)));
    let mut columns: Vec<String> = Vec::new();
    for column in speeds.chain(forces) {
        if !columns.contains(&column) && all.contains(&column) {
            columns.push(column);
        }
    }
    columns
}

/// How the desk has computed its run.
fn computed(mechanism: &Mechanism, run: &MechanismRun, agreement: &Agreement) -> String {
    let asked = mechanism.run.error;
    let refined = if run.error < asked {
        format!("Its run.error is {:.1e}, because at {asked:.1e} a finer run differed by more than 0.3 %\n", run.error)
    } else {
        String::new()
    };
    let computed = format!(
        "Computed by the desk, error-controlled to {:.1e} m/s a step ({SCHEME}, {} steps, {} refused) in {} ms\n\
         A run at a tenth of that differs by {:.4} % of {}{}\n",
        run.tolerance,
        run.effort.accepted,
        run.effort.refused,
        fixed(run.integration.as_secs_f64() * 1e3, 2),
        agreement.share * 100.0,
        agreement.whole,
        agreement.column.as_ref().map_or_else(String::new, |column| format!(" at most, in {column}"))
    );
    computed + &refined
}

/// How far the controller is off; its run is what was `shown`, if it was asked for.
fn controllers(mechanism: &Mechanism, controller: Option<&Controller>, shown: bool) -> String {
    let Some(controller) = controller else { return String::new() };
    let ControllerSpec { step, integrator, .. } = mechanism.controller;
    let by = format!("{}, steps of {} µs, double precision", integrator.name(), ten_digits(step * 1e6));
    let whose = if shown { "The run above is the controller's" } else { "The controller" };
    match controller.difference {
        Some(difference) if difference < 10.0 => {
            format!("{whose} ({by}): differs from the desk by {:.2} % of the peak\n", difference * 100.0)
        }
        Some(_) => {
            format!("{whose} ({by}): differs from the desk by more than 1000 % of the peak: take shorter steps\n")
        }
        None => format!("{whose} ({by}): its motion leaves the finite range: take shorter steps\n"),
    }
}

fn described(mechanism: &Mechanism, label: &str, run: &MechanismRun) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{}, {label}\n", mechanism.title);
    let rows: Vec<_> = mechanism
        .drives
        .iter()
        .zip(&run.outcomes)
        .map(|(drive, outcome)| {
            let [force, speed] = units(drive.action);
            vec![
                drive.name.clone(),
                outcome.verdict.to_string(),
                or_dash(outcome.peak_force, |f| format!("{} {force}", fixed(f, 4))),
                or_dash(outcome.settled_force, |f| format!("{} {force}", fixed(f, 4))),
                format!("{} {speed}", fixed(outcome.final_velocity * shown(drive.action), 3)),
            ]
        })
        .collect();
    if !rows.is_empty() {
        let _ = writeln!(text, "{}", text_table(&["drive", "verdict", "peak", "settled", "final speed"], &rows));
    }
    for (drive, outcome) in mechanism.drives.iter().zip(&run.outcomes) {
        let way = on_the_way(drive.action.kind(), outcome);
        if !way.is_empty() {
            let _ = writeln!(text, "On the way of {}: {way}\n", drive.name);
        }
    }
    let last = run.samples.rows.last().map(Vec::as_slice).unwrap_or_default();
    let heading: &[&str] = if mechanism.planar {
        &["at the end", "x, mm", "y, mm", "angle, °"]
    } else {
        &["at the end", "x, mm", "y, mm", "z, mm", "turned by, °"]
    };
    let each = mechanism.columns_of_body().len();
    let rows: Vec<_> = mechanism
        .bodies
        .iter()
        .enumerate()
        .map(|(i, body)| {
            let at = 1 + mechanism.drives.len() + i * each;
            let places = if mechanism.planar { &last[at..at + 2] } else { &last[at..at + 3] };
            let angle =
                if mechanism.planar { last[at + 2] } else { Vector3::from_column_slice(&last[at + 3..at + 6]).norm() };
            let places = places.iter().map(|place| fixed(place * 1e3, 3));
            std::iter::once(body.name.clone()).chain(places).chain([fixed(angle.to_degrees(), 3)]).collect::<Vec<_>>()
        })
        .collect();
    let _ = writeln!(text, "{}", text_table(heading, &rows));
    text
}
