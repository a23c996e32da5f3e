//! `slipfit simulate`: one unit.

use std::{fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;
use slipfit_core::{clearance::GapClass, slide::CONTACTS};

use super::{
    Failure, SceneArguments,
    check::{GapReport, gap_reports},
    print, print_json, text_table,
};
use crate::{
    audit::Audit,
    confirm::confirmed,
    export, files,
    number::{fixed, level, or_dash, ten_digits},
    outcome::{Outcome, Trajectory, Verdict},
    scene::{Override, Scene, parse_every},
    scheme::IntegratorKind,
    simulate::{Run, ScalarKind, Settings, audited, simulate},
    trust::Trust,
};

/// Simulates one unit: velocity and drive force over time.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Tolerance level, positive is tighter: one for all gaps, or sixteen separated by commas, in the order left,
    /// right, rail, wall of each pin.
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true, default_value = "0")]
    n: Vec<f64>,
    /// Writes t,vz,force,x,y in s, m/s, N, m, m.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Interval of the samples, such as 1ms or 500us.
    #[arg(long, default_value = "1ms", allow_hyphen_values = true)]
    every: String,
    /// Prints where the energy went: work, gains, losses, and what the scheme lost or made up.
    #[arg(long)]
    audit: bool,
    #[command(flatten)]
    stepping: SteppingArguments,
    /// Error-controlled steps instead of fixed ones: the error of the drive force (N) that a step may make, such as 1e-4.
    #[arg(long, value_name = "N", conflicts_with_all = ["step", "integrator", "scalar", "audit"], allow_hyphen_values = true)]
    error: Option<f64>,
}

/// How to step, where it differs from the scene, and in which numbers.
#[derive(Args)]
pub(super) struct SteppingArguments {
    #[command(flatten)]
    scheme: SchemeArguments,
    /// Number type: f32 is the controller's.
    #[arg(long, value_enum, default_value_t)]
    pub scalar: ScalarKind,
}

/// How to step, where it differs from the scene.
#[derive(Args)]
pub(super) struct SchemeArguments {
    /// Step, such as 100us (a bare number is µs).
    #[arg(long, allow_hyphen_values = true)]
    step: Option<String>,
    /// Scheme.
    #[arg(long, value_enum)]
    integrator: Option<IntegratorKind>,
}

impl SteppingArguments {
    /// The options as settings of the scene.
    pub fn overrides(&self) -> Vec<Override> {
        self.scheme.overrides()
    }
}

impl SchemeArguments {
    /// The options as settings of the scene.
    pub fn overrides(&self) -> Vec<Override> {
        let step = self.step.as_ref().map(|step| Override::option("--step", "run.step", step));
        let integrator = self.integrator.map(|kind| Override::option("--integrator", "run.integrator", kind.name()));
        step.into_iter().chain(integrator).collect()
    }
}

#[derive(Serialize)]
struct Report<'a> {
    title: &'a str,
    n: &'a [f64],
    integrator: &'static str,
    scalar: ScalarKind,
    step_s: f64,
    duration_s: f64,
    integration_ms: f64,
    #[serde(flatten)]
    outcome: Outcome,
    gaps: Vec<GapReport>,
    trust: Trust,
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_j: Option<Audit>,
    samples: &'a Trajectory,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let scene = self.scene.load(&self.stepping.overrides())?;
        let n = levels(&self.n)?;
        scene.check_gaps(&n).map_err(|error| Failure::Input(format!("--n: {error}")))?;
        let every = parse_every(&self.every)?;
        if let Some(path) = &self.csv {
            self.scene.check_output(path)?;
        }
        if let Some(error) = self.error.filter(|error| !(1e-12..=1e3).contains(error)) {
            return Err(Failure::Input(format!("--error is {error}, allowed is 1e-12 to 1e3 N")));
        }
        let settings = Settings { run: scene.run, every, scalar: self.stepping.scalar, tolerance: self.error };
        let gaps = scene.gaps_at(&n);
        let run = if self.audit { audited } else { simulate };
        let run = confirmed(&scene, &gaps, &settings, run(&scene, &gaps, &settings)?)?;
        if let Some(path) = &self.csv {
            files::write(path, &export::trajectory_csv(&run.trajectory)?)?;
        }
        if self.scene.json {
            print_json(&Report {
                title: &scene.title,
                n: &self.n,
                integrator: scene.run.integrator.name(),
                scalar: self.stepping.scalar,
                step_s: scene.run.step,
                duration_s: scene.run.duration,
                integration_ms: run.integration.as_secs_f64() * 1e3,
                outcome: run.outcome,
                gaps: gap_reports(&scene, &gaps),
                trust: run.trust,
                audit_j: run.audit,
                samples: &run.trajectory,
            })
        } else {
            print(&self.describe(&scene, &run, &gap_reports(&scene, &gaps)))
        }
    }

    fn describe(&self, scene: &Scene, run: &Run, gaps: &[GapReport]) -> String {
        let mut text = String::new();
        let Outcome { breakaway, peak_force, settled_force, final_velocity, verdict } = run.outcome;
        let n: Vec<String> = self.n.iter().map(|&n| level(n)).collect();
        let integration = run.integration.as_secs_f64() * 1e3;
        let _ = writeln!(text, "{}, n = {}\n", scene.title, n.join(", "));
        let _ = writeln!(text, "Breakaway       {} ms", or_dash(breakaway, |t| fixed(t * 1e3, 2)));
        let _ = writeln!(text, "Peak force      {} N", or_dash(peak_force, |f| fixed(f, 4)));
        let _ = writeln!(text, "Settled force   {} N", or_dash(settled_force, |f| fixed(f, 4)));
        let _ = writeln!(text, "Final velocity  {} mm/s", fixed(final_velocity * 1e3, 3));
        let _ = writeln!(text, "Verdict         {verdict}{}", why_undecided(scene, verdict));
        let classes = |class| {
            let of_class = gaps.iter().filter(|gap| gap.class == class);
            of_class.map(|gap| gap.name.as_str()).collect::<Vec<_>>().join(", ")
        };
        for class in [GapClass::Compressed, GapClass::Zero].map(|class| class.to_string()) {
            let names = classes(class.clone());
            if !names.is_empty() {
                let _ = writeln!(text, "Gaps {class:10} {names}");
            }
        }
        let how = match self.error {
            Some(error) => format!("error-controlled to {error:e} N a step"),
            None => format!(
                "in steps of {} µs, {}, {}",
                ten_digits(scene.run.step * 1e6),
                scene.run.integrator.name(),
                self.stepping.scalar.name()
            ),
        };
        let _ = writeln!(
            text,
            "\n{} ms {how}: integrated in {} ms, worst residual {:.1e} N·s",
            ten_digits(scene.run.duration * 1e3),
            fixed(integration, 2),
            run.trajectory.worst_residual
        );
        if let Some(audit) = &run.audit {
            let _ = write!(text, "\n{}", describe_audit(audit));
        }
        if let Some(warning) = run.trust.warning() {
            let _ = writeln!(text, "\nwarning: {warning}");
        }
        text
    }
}

/// The energy account as a table.
fn describe_audit(audit: &Audit) -> String {
    // A unit in which the greatest entry has one to three digits before the point.
    let (unit, scale) = match audit.exchanged {
        most if most >= 1.0 => ("J", 1.0),
        most if most >= 1e-3 => ("mJ", 1e3),
        _ => ("µJ", 1e6),
    };
    let rows = [
        ("work of the drive", audit.work),
        ("= gain of kinetic energy", audit.kinetic),
        ("+ gain of height", audit.gravity),
        ("+ gain of compression", audit.elastic),
        ("+ lost in contacts", audit.damping),
        ("+ lost to friction", audit.friction),
        ("+ defect", audit.defect),
    ];
    let rows: Vec<_> = rows.iter().map(|(name, energy)| vec![(*name).into(), fixed(energy * scale, 6)]).collect();
    format!(
        "{}The worst defect at any time is {:.1e} of the greatest energy exchanged; positive is lost by the scheme.\n",
        text_table(&["energy", unit], &rows),
        audit.relative_defect()
    )
}

/// A remark behind an undecided verdict.
pub(super) fn why_undecided(scene: &Scene, verdict: Verdict) -> String {
    if verdict != Verdict::Undecided {
        return String::new();
    }
    let [end, ramp] = [scene.run.duration, scene.drive.ramp_end].map(|t| ten_digits(t * 1e3));
    if scene.run.duration < scene.drive.ramp_end {
        let stroke = ten_digits((scene.drive.ramp_end + 0.5) * 1e3);
        format!(" (the run ends at {end} ms, the ramp at {ramp} ms; --set run.duration={stroke} runs the stroke)")
    } else if scene.drive.speed == 0.0 {
        " (nothing is commanded)".into()
    } else {
        " (a run at half the step came to another verdict: take a smaller step)".into()
    }
}

/// One level for all contacts, or one each.
fn levels(n: &[f64]) -> Result<[f64; CONTACTS], Failure> {
    if let Some(bad) = n.iter().find(|n| !n.is_finite()) {
        return Err(Failure::Input(format!("--n holds {bad}, allowed are finite numbers")));
    }
    match n {
        [all] => Ok([*all; CONTACTS]),
        _ => n
            .try_into()
            .map_err(|_| Failure::Input(format!("--n holds {} values, allowed are 1 or {CONTACTS}", n.len()))),
    }
}
