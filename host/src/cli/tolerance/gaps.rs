//! Table 2's derived columns, and the gaps of a scene that gives them.

use std::fmt::{self, Write};

use serde::Serialize;
use slipfit_tolerance::number::fixed;

use crate::{
    cli::terminal::text_table,
    mechanism::closing::{Table2, derived},
    setup::{SURFACES, Scene},
};

/// What follows from a slide's gaps at a tolerance level.
#[derive(Serialize)]
pub(super) struct Columns {
    derived_m: Table2,
    tightest: Option<Tightest>,
}

#[derive(Serialize)]
struct Tightest {
    pin: String,
    direction: String,
    n: f64,
}

impl Columns {
    /// Of `scene` at level `n`.
    pub fn new(scene: &Scene, n: f64) -> Self {
        let derived_m = derived(scene, n);
        let tightest = derived_m.tightest().map(|closure| Tightest {
            pin: closure.pin.into(),
            direction: closure.direction.to_string(),
            n: closure.n,
        });
        Self { derived_m, tightest }
    }
}

impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.derived_m.fmt(f)
    }
}

/// The gaps as a scene gives them.
#[derive(Serialize)]
pub(super) struct Given {
    title: String,
    measures: Vec<Measure>,
    #[serde(flatten)]
    columns: Columns,
}

/// mm, as the drawing's tolerances are.
#[derive(Serialize)]
struct Measure {
    name: String,
    mean: f64,
    sd: f64,
}

impl Given {
    /// Of `scene`, with the derived columns at level `n`.
    pub fn new(scene: &Scene, n: f64) -> Self {
        let measures = scene.pins.iter().flat_map(|pin| {
            pin.gaps.iter().zip(SURFACES).filter_map(|(gap, surface)| {
                let gap = (*gap)?;
                let name = format!("{} {surface}", pin.name);
                Some(Measure { name, mean: millimetres(gap.mean), sd: millimetres(gap.deviation) })
            })
        });
        Self { title: scene.title.clone(), measures: measures.collect(), columns: Columns::new(scene, n) }
    }

    /// As text.
    pub fn describe(&self) -> String {
        let row = |measure: &Measure| vec![measure.name.clone(), fixed(measure.mean, 4), fixed(measure.sd, 4)];
        let mut text = format!("{}\n\n", self.title);
        let rows: Vec<_> = self.measures.iter().map(row).collect();
        let _ = writeln!(text, "{}", text_table(&["gap", "mean, mm", "σ, mm"], &rows));
        text + &self.columns.to_string()
    }
}

/// A length (m) in mm, without the digits that the conversion to metres made up.
fn millimetres(length: f64) -> f64 {
    (length * 1e15).round() / 1e12
}
