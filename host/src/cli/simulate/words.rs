//! A run of one unit in words.

use std::fmt::Write;

use slipfit_core::clearance::GapClass;
use slipfit_tolerance::number::{fixed, level, or_dash, ten_digits};

use super::Arguments;
use crate::{
    cli::{check::GapReport, terminal::text_table},
    dynamics::{
        answer::on_the_way,
        audit::Audit,
        driven::{DriveKind, Driven},
        outcome::{Outcome, Verdict},
        simulate::Run,
        trust::Trust,
    },
    setup::Scene,
};

impl Arguments {
    /// Which unit it is.
    pub(super) fn of(&self, n: &[f64]) -> String {
        match self.unit {
            Some(number) => format!("unit {number}"),
            None => format!("n = {}", n.iter().map(|&n| level(n)).collect::<Vec<_>>().join(", ")),
        }
    }

    /// The run in words. `controller` is how the controller's run does beside it: not there where the run is its own, `None`
    /// where it left the finite range.
    pub(super) fn describe(
        &self,
        scene: &Scene,
        run: &Run,
        controller: Option<Option<&Run>>,
        gaps: &[GapReport],
        n: &[f64],
    ) -> String {
        let mut text = String::new();
        let Outcome { breakaway, peak_force, settled_force, final_velocity, end, stroke_reached, verdict, .. } =
            run.outcome;
        let of = self.of(n);
        let way = on_the_way(DriveKind::Pushes, &run.outcome);
        let _ = writeln!(text, "{}, {of}\n", scene.title);
        let _ = writeln!(text, "Verdict         {verdict}{}", why_undecided(scene, verdict));
        let _ = writeln!(text, "Breakaway       {}", or_dash(breakaway, |t| fixed(t * 1e3, 2) + " ms"));
        let _ = writeln!(text, "Peak force      {}", or_dash(peak_force, |f| fixed(f, 4) + " N"));
        let _ = writeln!(text, "Settled force   {}", or_dash(settled_force, |f| fixed(f, 4) + " N"));
        let _ = writeln!(text, "Final velocity  {} mm/s", fixed(final_velocity * 1e3, 3));
        let reached = match stroke_reached {
            Some(true) => ", the end of the stroke",
            Some(false) | None => "",
        };
        let [z, t] = [end.z, end.t].map(|x| x * 1e3);
        let _ = writeln!(text, "Travel          {} mm in {} ms{reached}", fixed(z, 3), fixed(t, 1));
        if !way.is_empty() {
            let _ = writeln!(text, "On the way      {way}");
        }
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
        let percent = |trust: &Trust| {
            or_dash(trust.difference, |share| match share {
                ..10.0 => format!("{:.2} %", share * 100.0),
                _ => "more than 1000 %".into(),
            })
        };
        let integration = fixed(run.integration.as_secs_f64() * 1e3, 2);
        let _ = writeln!(text, "\nComputed by {} in {integration} ms", run.solved.describe());
        match controller {
            None => {
                let off = percent(&run.trust);
                let _ =
                    writeln!(text, "Its force errs by {off} of the peak, from the ramp's start on, against the desk's");
            }
            Some(Some(controller)) => {
                let (off, how) = (percent(&controller.trust), controller.solved.describe());
                let _ = writeln!(text, "Beside it {how}: its force errs by {off} of the peak from the ramp's start on");
            }
            Some(None) => {
                text += "Beside it the controller: its motion leaves the finite range; take a smaller --step\n";
            }
        }
        if let Some(audit) = &run.audit {
            let _ = write!(text, "\n{}", describe_audit(audit));
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
pub fn why_undecided(scene: &Scene, verdict: Verdict) -> String {
    if verdict != Verdict::Undecided {
        return String::new();
    }
    let [end, ramp] = [scene.run.duration, scene.drive.ramp_end].map(|t| ten_digits(t * 1e3));
    if scene.run.duration < scene.drive.ramp_end {
        let advice = match scene.stroke_duration() {
            Some(_) => "--stroke runs the whole stroke".to_owned(),
            None => format!("--set run.duration={} runs on", ten_digits((scene.drive.ramp_end + 0.5) * 1e3)),
        };
        format!(" (the run ends at {end} ms, the ramp at {ramp} ms; {advice})")
    } else if scene.drive.speed == 0.0 {
        " (nothing is commanded)".into()
    } else {
        " (a finer run came to another verdict: take a smaller --error, or a smaller --step of the controller)".into()
    }
}
