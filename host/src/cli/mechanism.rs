//! What `check`, `simulate` and `sweep` say of a mechanism of bodies and joints.

use std::{fmt::Write, path::PathBuf};

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;

use super::{
    Failure, JSON_VERSION, SceneArguments, ThreadArguments, given, print, print_json, progress, text_table, warn,
};
use crate::{
    answer::ranges_of,
    export::rows_csv,
    figure::{columns_over_time, drives_over_n},
    files,
    mechanism::{Action, Freedom, GapError, Mechanism, MechanismRun, RunError, SCHEME, run},
    number::{fixed, level, or_dash},
    outcome::{Outcome, Verdict},
    scene::RunSpec,
};

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Unsolved(_) | RunError::Interrupted => Self::Work(error.into()),
            RunError::Mounts(_) | RunError::Bodies(_) | RunError::Parameter(_) => Self::Input(error.to_string()),
        }
    }
}

impl From<GapError> for Failure {
    fn from(error: GapError) -> Self {
        Self::Input(format!("--n: {error}"))
    }
}

/// What to write and at which level.
pub(super) struct Wanted<'a> {
    pub scene: &'a SceneArguments,
    pub csv: &'a Option<PathBuf>,
    pub plot: &'a Option<PathBuf>,
}

impl Wanted<'_> {
    fn check_outputs(&self) -> Result<(), Failure> {
        self.scene.check_outputs(&given([("--csv", self.csv), ("--plot", self.plot)]))
    }
}

/// A drive's outcome with its name.
#[derive(Serialize)]
struct DriveReport<'a> {
    name: &'a str,
    /// N and m/s, or N·m and rad/s.
    unit: &'static str,
    #[serde(flatten)]
    outcome: Outcome,
}

#[derive(Serialize)]
struct GapReport<'a> {
    name: &'a str,
    mm: f64,
    /// The level that closes it; none where it does not vary.
    #[serde(skip_serializing_if = "Option::is_none")]
    closes_at_n: Option<f64>,
}

#[derive(Serialize)]
struct SimulateReport<'a> {
    json_version: u32,
    title: &'a str,
    n: &'a [f64],
    integrator: &'static str,
    tolerance_m_per_s: f64,
    accepted: u32,
    refused: u32,
    integration_ms: f64,
    /// The greatest difference of a drive's force or torque to a run at a tenth of the tolerance, as a share of its peak.
    difference: f64,
    drives: Vec<DriveReport<'a>>,
    gaps: Vec<GapReport<'a>>,
    columns: &'a [String],
    samples: &'a [Vec<f64>],
}

/// The unit of a drive's force and of its speed.
fn units(action: Action) -> [&'static str; 2] {
    match action {
        Action::Pushes { .. } => ["N", "mm/s"],
        Action::Turns { .. } => ["N·m", "rad/s"],
    }
}

/// What makes a drive's speed one in the unit that is shown.
fn shown(action: Action) -> f64 {
    if matches!(action, Action::Pushes { .. }) { 1e3 } else { 1.0 }
}

fn gap_reports<'a>(mechanism: &'a Mechanism, gaps: &[f64]) -> Vec<GapReport<'a>> {
    let report = |(gap, value): (&'a crate::mechanism::Gap, &f64)| {
        let closes_at_n = Some(gap.statistics.mean / gap.statistics.deviation).filter(|n| n.is_finite());
        GapReport { name: &gap.name, mm: value * 1e3, closes_at_n }
    };
    mechanism.gaps.iter().zip(gaps).map(report).collect()
}

/// One level for all gaps, or one each.
fn levels<'a>(mechanism: &Mechanism, n: &'a [f64]) -> Result<&'a [f64], Failure> {
    let count = mechanism.gaps.len();
    if n.len() != 1 && n.len() != count {
        return Err(Failure::Input(format!("--n holds {} values, allowed are 1 or {count}, one a gap", n.len())));
    }
    match n.iter().find(|n| !n.is_finite()) {
        Some(bad) => Err(Failure::Input(format!("--n holds {bad}, allowed are finite numbers"))),
        None => Ok(n),
    }
}

/// The greatest difference of the drives' forces between two runs, as a share of the greatest force; of the first body's columns where
/// there is no drive.
fn difference(mechanism: &Mechanism, one: &MechanismRun, finer: &MechanismRun) -> f64 {
    let columns =
        if mechanism.drives.is_empty() { 1..one.samples.columns.len() } else { 1..1 + mechanism.drives.len() };
    let of_column = |k: usize| {
        let peak = finer.samples.rows.iter().fold(f64::MIN_POSITIVE, |most, row| most.max(row[k].abs()));
        let pairs = one.samples.rows.iter().zip(&finer.samples.rows);
        pairs.fold(0.0, |most: f64, (one, finer)| most.max((one[k] - finer[k]).abs())) / peak
    };
    columns.map(of_column).fold(0.0, f64::max)
}

/// The run at a tenth of the tolerance.
fn finer(mechanism: &Mechanism, gaps: &[f64], every: f64) -> Result<MechanismRun, RunError> {
    let run_spec = RunSpec { error: mechanism.run.error / 10.0, ..mechanism.run };
    run(&Mechanism { run: run_spec, ..mechanism.clone() }, gaps, every)
}

/// `simulate`.
pub(super) fn simulate(mechanism: &Mechanism, n: &[f64], every: f64, wanted: &Wanted) -> Result<(), Failure> {
    let gaps = mechanism.gaps_at(levels(mechanism, n)?)?;
    wanted.check_outputs()?;
    let one = run(mechanism, &gaps, every)?;
    let difference = difference(mechanism, &one, &finer(mechanism, &gaps, every)?);
    if let Some(path) = wanted.csv {
        files::write(path, &rows_csv(&one.samples)?)?;
    }
    if let Some(path) = wanted.plot {
        let n = if n.len() == 1 { level(n[0]) } else { "one for each gap".to_owned() };
        let columns = plotted(mechanism);
        let svg = columns_over_time(&one.samples, &columns, &mechanism.title, &n).map_err(anyhow::Error::from)?;
        files::write(path, svg.as_bytes())?;
    }
    if wanted.scene.json {
        let named = mechanism.drives.iter().zip(&one.outcomes);
        let drives = named.map(|(drive, outcome)| DriveReport {
            name: &drive.name,
            unit: units(drive.action)[0],
            outcome: *outcome,
        });
        return print_json(&SimulateReport {
            json_version: JSON_VERSION,
            title: &mechanism.title,
            n,
            integrator: SCHEME,
            tolerance_m_per_s: one.tolerance,
            accepted: one.effort.accepted,
            refused: one.effort.refused,
            integration_ms: one.integration.as_secs_f64() * 1e3,
            difference,
            drives: drives.collect(),
            gaps: gap_reports(mechanism, &gaps),
            columns: &one.samples.columns,
            samples: &one.samples.rows,
        });
    }
    print(&described(mechanism, n, &one, difference))
}

/// Which columns a plot shows: what drives do and how fast their bodies go; without drives how all bodies go.
fn plotted(mechanism: &Mechanism) -> Vec<String> {
    let speed = |body: usize, action: Option<Action>| {
        let name = &mechanism.bodies[body].name;
        match action {
            Some(Action::Turns { .. }) | None if mechanism.planar => format!("{name}.spin (rad/s)"),
            Some(Action::Pushes { axis }) => {
                let most = (0..3).max_by(|a, b| axis[*a].abs().total_cmp(&axis[*b].abs())).unwrap_or(2);
                format!("{name}.v{} (m/s)", ["x", "y", "z"][most])
            }
            _ => format!("{name}.vz (m/s)"),
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

fn described(mechanism: &Mechanism, n: &[f64], run: &MechanismRun, difference: f64) -> String {
    let mut text = String::new();
    let n: Vec<String> = n.iter().map(|&n| level(n)).collect();
    let _ = writeln!(text, "{}, n = {}\n", mechanism.title, n.join(", "));
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
    let last = run.samples.rows.last().map(Vec::as_slice).unwrap_or_default();
    let heading: &[&str] = if mechanism.planar {
        &["at the end", "x, mm", "y, mm", "angle, °"]
    } else {
        &["at the end", "x, mm", "y, mm", "z, mm"]
    };
    let each = if mechanism.planar { 6 } else { 9 };
    let rows: Vec<_> = mechanism
        .bodies
        .iter()
        .enumerate()
        .map(|(i, body)| {
            let at = 1 + mechanism.drives.len() + i * each;
            let third = if mechanism.planar { last[at + 2].to_degrees() } else { last[at + 2] * 1e3 };
            vec![body.name.clone(), fixed(last[at] * 1e3, 3), fixed(last[at + 1] * 1e3, 3), fixed(third, 3)]
        })
        .collect();
    let _ = writeln!(text, "{}", text_table(heading, &rows));
    let _ = writeln!(
        text,
        "Computed by the desk, error-controlled to {:.1e} m/s a step ({SCHEME}, {} steps, {} refused) in {} ms",
        run.tolerance,
        run.effort.accepted,
        run.effort.refused,
        fixed(run.integration.as_secs_f64() * 1e3, 2)
    );
    let _ = writeln!(text, "A run at a tenth of that differs by {:.4} % of the peak", difference * 100.0);
    text
}

#[derive(Serialize)]
struct CheckReport<'a> {
    json_version: u32,
    title: &'a str,
    freedom: Freedom,
    n: f64,
    gaps: Vec<GapReport<'a>>,
    warnings: &'a [String],
}

/// `check`.
pub(super) fn check(mechanism: &Mechanism, n: f64, scene: &SceneArguments) -> Result<(), Failure> {
    let gaps = mechanism.gaps_at(&[n])?;
    let freedom = Freedom::of(mechanism)?;
    let warnings = warnings(mechanism, &freedom);
    if scene.json {
        let gaps = gap_reports(mechanism, &gaps);
        let title = &mechanism.title;
        return print_json(&CheckReport { json_version: JSON_VERSION, title, freedom, n, gaps, warnings: &warnings });
    }
    let mut text = format!("{}\n\nDegrees of freedom  {}\n\n", mechanism.title, freedom.describe());
    let joints: Vec<_> = mechanism
        .joints
        .iter()
        .map(|joint| {
            let [first, second] = joint.between.map(|port| mechanism.name_of(port).to_owned());
            let play = if joint.kind.is_ideal() { "none" } else { "yes" };
            vec![joint.name.clone(), joint.kind.name().into(), first, second, play.into()]
        })
        .collect();
    text += &text_table(&["joint", "kind", "of", "and", "play"], &joints);
    let rows: Vec<_> = gap_reports(mechanism, &gaps)
        .into_iter()
        .map(|gap| vec![gap.name.to_owned(), fixed(gap.mm, 4), or_dash(gap.closes_at_n, |n| fixed(n, 2))])
        .collect();
    let _ = write!(text, "\n{}", text_table(&[&format!("gap at n = {}", level(n)), "mm", "closes at n"], &rows));
    print(&text)?;
    warn(&warnings);
    Ok(())
}

/// What a designer should know before trusting a run.
fn warnings(mechanism: &Mechanism, freedom: &Freedom) -> Vec<String> {
    let driven = mechanism.drives.len() as i64;
    let free = freedom.degrees_of_freedom;
    if free < driven {
        return vec![format!("{free} degrees of freedom are left for {driven} drives: the joints hold the mechanism")];
    }
    Vec::new()
}

#[derive(Serialize)]
struct SweepReport<'a> {
    json_version: u32,
    title: &'a str,
    levels: Vec<LevelReport<'a>>,
}

#[derive(Serialize)]
struct LevelReport<'a> {
    n: f64,
    drives: Vec<DriveReport<'a>>,
}

/// `sweep` over the mechanism's levels.
pub(super) fn sweep(mechanism: &Mechanism, wanted: &Wanted, threads: &ThreadArguments) -> Result<(), Failure> {
    wanted.check_outputs()?;
    if mechanism.drives.is_empty() {
        return Err(Failure::Input("the mechanism has no [[drive]], whose force a sweep tells".into()));
    }
    let n = mechanism.sweep.levels();
    let units_of: Vec<_> =
        n.iter().map(|n| mechanism.gaps_at(&[*n]).map(|gaps| (*n, gaps))).collect::<Result<_, _>>()?;
    let bar = progress("simulating", n.len());
    let one = |(n, gaps): &(f64, Vec<f64>)| -> Result<(f64, Vec<Outcome>), RunError> {
        let [coarse, fine] = [run(mechanism, gaps, 1e-3)?, finer(mechanism, gaps, 1e-3)?];
        bar.inc(1);
        // A verdict counts if the finer run agrees.
        let agreed = coarse.outcomes.iter().zip(&fine.outcomes).map(|(coarse, fine)| {
            let agree = coarse.verdict == fine.verdict;
            Outcome { verdict: if agree { coarse.verdict } else { Verdict::Undecided }, ..*coarse }
        });
        Ok((*n, agreed.collect()))
    };
    let levels = threads.install(|| units_of.par_iter().map(one).collect::<Result<Vec<_>, _>>())?;
    bar.finish_and_clear();
    let levels = levels?;
    if let Some(path) = wanted.csv {
        files::write(path, &rows_csv(&table(mechanism, &levels))?)?;
    }
    if let Some(path) = wanted.plot {
        let judged = |k: usize| levels.iter().map(|(n, all)| (*n, all[k].verdict, all[k].peak_force)).collect();
        let named = mechanism.drives.iter().enumerate();
        let drives: Vec<_> =
            named.map(|(k, drive)| (format!("{} ({})", drive.name, units(drive.action)[0]), judged(k))).collect();
        let svg = drives_over_n(&drives, &mechanism.title).map_err(anyhow::Error::from)?;
        files::write(path, svg.as_bytes())?;
    }
    if wanted.scene.json {
        let level = |(n, outcomes): &(f64, Vec<Outcome>)| {
            let drives = mechanism.drives.iter().zip(outcomes).map(|(drive, outcome)| DriveReport {
                name: &drive.name,
                unit: units(drive.action)[0],
                outcome: *outcome,
            });
            LevelReport { n: *n, drives: drives.collect() }
        };
        let levels = levels.iter().map(level).collect();
        return print_json(&SweepReport { json_version: JSON_VERSION, title: &mechanism.title, levels });
    }
    let mut text = format!("{}\n", mechanism.title);
    for (k, drive) in mechanism.drives.iter().enumerate() {
        let [force, speed] = units(drive.action);
        let verdicts: Vec<_> = levels.iter().map(|(n, outcomes)| (*n, outcomes[k].verdict)).collect();
        let _ = write!(text, "\n{}: {}\n\n", drive.name, ranges_of(&verdicts).join("; "));
        let rows: Vec<_> = levels
            .iter()
            .map(|(n, outcomes)| {
                let outcome = &outcomes[k];
                vec![
                    level(*n),
                    or_dash(outcome.peak_force, |f| fixed(f, 4)),
                    or_dash(outcome.settled_force, |f| fixed(f, 4)),
                    fixed(outcome.final_velocity * shown(drive.action), 3),
                    outcome.verdict.to_string(),
                ]
            })
            .collect();
        let heading =
            ["n", &format!("peak, {force}"), &format!("settled, {force}"), &format!("final, {speed}"), "verdict"];
        text += &text_table(&heading, &rows);
    }
    print(&text)
}

/// The figures of all drives over n.
fn table(mechanism: &Mechanism, levels: &[(f64, Vec<Outcome>)]) -> crate::mechanism::Samples {
    let of_drive = mechanism.drives.iter().flat_map(|drive| {
        let [force, speed] =
            if matches!(drive.action, Action::Pushes { .. }) { ["N", "m/s"] } else { ["N·m", "rad/s"] };
        let name = &drive.name;
        [format!("{name}.peak ({force})"), format!("{name}.settled ({force})"), format!("{name}.final ({speed})")]
    });
    let columns = std::iter::once("n".to_owned()).chain(of_drive).collect();
    let row = |(n, outcomes): &(f64, Vec<Outcome>)| {
        let of_drive = outcomes.iter().flat_map(|outcome| {
            let known = |x: Option<f64>| x.unwrap_or(f64::NAN);
            [known(outcome.peak_force), known(outcome.settled_force), outcome.final_velocity]
        });
        std::iter::once(*n).chain(of_drive).collect()
    };
    crate::mechanism::Samples { columns, rows: levels.iter().map(row).collect() }
}
