//! The stability map: `slipfit precision --stability`.

use std::{fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;

use super::{Failure, SceneArguments, ThreadArguments, print, print_json, progress, refused, text_table};
use crate::{
    export::stability_csv,
    files,
    stability::{self, FACTORS, Grade, Point, tally},
    strips::stability_map,
};

/// Shows how far from the scene a fixed step still holds, and whether runs that do not hold say so.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Random combinations of all factors, besides the factors one at a time.
    #[arg(long, default_value_t = 1000)]
    random: usize,
    /// Seed of the random combinations.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Writes every point as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Writes the picture as SVG.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    threads: ThreadArguments,
}

#[derive(Serialize)]
struct Report {
    seed: u64,
    one_at_a_time: Vec<Point>,
    /// The order of the random points' values.
    factors: Vec<&'static str>,
    random: Vec<Point>,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let scene = self.scene.load(&[])?;
        for path in self.csv.iter().chain(&self.plot) {
            files::check_writable(path).map_err(refused)?;
        }
        let bar = progress("simulating", stability::one_at_a_time_count() + self.random);
        let (single, random) = self.threads.install(|| {
            let single = stability::one_at_a_time(&scene, || bar.inc(1));
            (single, stability::random(&scene, self.seed, self.random, || bar.inc(1)))
        })?;
        let (single, random) = (single?, random?);
        bar.finish_and_clear();
        if let Some(path) = &self.csv {
            files::write(path, &stability_csv(single.iter().chain(&random))?)?;
        }
        if let Some(path) = &self.plot {
            files::write(path, stability_map(&single, &random, &scene.title).as_bytes())?;
        }
        if self.scene.json {
            let factors = FACTORS.map(|factor| factor.name).into();
            print_json(&Report { seed: self.seed, one_at_a_time: single, factors, random })
        } else {
            print(&describe(&scene.title, &single, &random))
        }
    }
}

fn describe(title: &str, single: &[Point], random: &[Point]) -> String {
    let row = |name: &str, points: &[Point]| {
        let counts = tally(points).map(|(_, count)| count.to_string());
        std::iter::once(name.to_owned()).chain(counts).collect::<Vec<_>>()
    };
    let mut rows: Vec<_> = FACTORS
        .iter()
        .map(|factor| {
            let points: Vec<_> = single.iter().filter(|point| point.factor == factor.name).cloned().collect();
            row(factor.name, &points)
        })
        .collect();
    rows.push(row("random combinations", random));
    let heading = ["factor", "sound", "right, warns", "wrong, warns", "stopped", "wrong, silent"];
    let mut text = format!("{title}: stability\n\n{}", text_table(&heading, &rows));
    let silent = |points: &[Point]| -> Vec<String> {
        let silent = points.iter().filter(|point| point.grade() == Grade::Silent);
        silent.map(|point| format!("{}, {} {:?}", point.integrator, point.factor, point.values)).collect()
    };
    for point in silent(single).iter().chain(&silent(random)) {
        let _ = writeln!(text, "wrong without a warning: {point}");
    }
    text
}
