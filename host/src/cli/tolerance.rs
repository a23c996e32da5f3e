//! `slipfit tolerance`: how the gaps vary over the production.

use std::fmt::Write;

use clap::Args;
use serde::Serialize;

use super::{Failure, SceneArguments, print, print_json, text_table};
use crate::{
    number::fixed,
    scene::SURFACES,
    table2::{Table2, derived},
};

/// Shows the gaps' statistics as the scene gives them, with Table 2's derived columns.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Tolerance level of the derived columns; positive is tighter. The paper's is 3.43.
    #[arg(long, default_value_t = 3.43, allow_hyphen_values = true)]
    n: f64,
}

#[derive(Serialize)]
struct Report {
    title: String,
    measures: Vec<Measure>,
    derived_m: Table2,
    tightest: Option<Tightest>,
}

/// mm, as the drawing's tolerances are.
#[derive(Serialize)]
struct Measure {
    name: String,
    mean: f64,
    sd: f64,
}

#[derive(Serialize)]
struct Tightest {
    pin: String,
    direction: String,
    n: f64,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        if !self.n.is_finite() {
            return Err(Failure::Input(format!("--n is {}, allowed is any finite number", self.n)));
        }
        let scene = self.scene.load(&[])?;
        let measures = scene.pins.iter().flat_map(|pin| {
            pin.gaps.iter().zip(SURFACES).filter_map(|(gap, surface)| {
                let gap = (*gap)?;
                let name = format!("{} {surface}", pin.name);
                Some(Measure { name, mean: millimetres(gap.mean), sd: millimetres(gap.deviation) })
            })
        });
        let derived_m = derived(&scene, self.n);
        let tightest = derived_m.tightest().map(|closure| Tightest {
            pin: closure.pin.into(),
            direction: closure.direction.to_string(),
            n: closure.n,
        });
        let report = Report { title: scene.title.clone(), measures: measures.collect(), tightest, derived_m };
        if self.scene.json { print_json(&report) } else { print(&describe(&report)) }
    }
}

/// A length (m) in mm, without the digits that the conversion to metres made up.
fn millimetres(length: f64) -> f64 {
    (length * 1e15).round() / 1e12
}

fn describe(report: &Report) -> String {
    let rows: Vec<Vec<String>> = report
        .measures
        .iter()
        .map(|measure| vec![measure.name.clone(), fixed(measure.mean, 4), fixed(measure.sd, 4)])
        .collect();
    let mut text = format!("{}\n\n", report.title);
    let _ = writeln!(text, "{}", text_table(&["gap", "mean, mm", "σ, mm"], &rows));
    let _ = write!(text, "{}", report.derived_m);
    text
}
