//! The stability map: `slipfit precision --stability`.

use std::{fmt::Write, path::Path};

use clap::Args;
use serde::Serialize;
use slipfit_system::files;

use super::{
    arguments::ThreadArguments,
    call,
    failure::Failure,
    terminal::{print, print_json, progress, text_table},
};
use crate::{
    quality::stability::{self, FACTORS, Grade, Point, tally},
    setup::Scene,
    show::{export::stability_csv, stability::stability_map},
};

/// What the stability map takes besides the scene and its outputs.
#[derive(Args)]
pub(super) struct MapArguments {
    /// Makes the stability map instead: for which parameters steps of one length are right.
    ///
    /// Parameters of the scene are varied one at a time and in random combinations, far beyond any slide. For each run the map says
    /// whether its drive force is right, and whether a wrong run comes with a warning.
    #[arg(long)]
    pub stability: bool,
    /// Number of random combinations in the stability map.
    #[arg(long, default_value_t = 1000, requires = "stability", value_parser = clap::value_parser!(u32).range(..=1_000_000))]
    random: u32,
    /// Seed of the random combinations.
    #[arg(long, default_value_t = 1, requires = "stability")]
    seed: u64,
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

impl MapArguments {
    /// Makes the map of `scene` and writes and prints it.
    pub fn run(&self, scene: &Scene, json: bool, csv: Option<&Path>, plot: Option<&Path>) -> Result<(), Failure> {
        let bar = progress("simulating", stability::one_at_a_time_count() + self.random as usize);
        let (single, random) = self.threads.install(|| {
            let single = stability::one_at_a_time(scene, || bar.inc(1));
            (single, stability::random(scene, self.seed, self.random as usize, || bar.inc(1)))
        })?;
        let (single, random) = (single?, random?);
        bar.finish_and_clear();
        if let Some(path) = csv {
            files::write(path, &stability_csv(single.iter().chain(&random))?)?;
        }
        call::picture(plot, "stability", || Ok(stability_map(&single, &random, &scene.title)))?;
        if json {
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
        silent.map(|point| format!("{}; {}", point.integrator, values(point))).collect()
    };
    for point in silent(single).iter().chain(&silent(random)) {
        let _ = writeln!(text, "wrong without a warning: {point}");
    }
    text
}

/// What was varied, name and value.
fn values(point: &Point) -> String {
    let varied = FACTORS.iter().filter(|factor| [factor.name, "random"].contains(&point.factor));
    let pairs =
        varied.zip(&point.values).map(|(factor, value)| format!("{} = {}", factor.name, (factor.label)(*value)));
    pairs.collect::<Vec<_>>().join("; ")
}
