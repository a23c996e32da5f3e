//! `slipfit tolerance`: how the measures of a product vary over the production.

use std::{fmt::Write, path::PathBuf};

use clap::{Args, ValueEnum};
use indicatif::ProgressBar;
use serde::Serialize;

use super::{Failure, SceneArguments, ThreadArguments, print, print_json, progress, refused, text_table};
use crate::{
    files,
    number::{fixed, or_dash, three_digits},
    scene::{SURFACES, Scene},
    table2::{Table2, derived},
    tolerance::{
        analysis::conclude,
        experiment::{Design, Finding, experiment},
        file::Source,
        model::{Measure as Measured, Model},
        picture::{contributors_svg, correlation_svg, histogram_svg},
        report::{self, measures_csv},
        run::{Keep, RunError, Shard, checkpoint, run},
        sampler::Method,
        study::{Settings, Study, Tally},
    },
};

/// How the measures vary: Monte Carlo, worst case, RSS, contributors, capability, joint statistics.
///
/// A scene that gives its gaps instead of a product has them shown with Table 2's derived columns.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Tolerance level of the derived columns; positive is tighter. The paper's is 3.43.
    #[arg(long, default_value_t = 3.43, allow_hyphen_values = true)]
    n: f64,
    /// Units; of every replicate, where there are several.
    #[arg(long, default_value_t = 5000)]
    samples: u64,
    /// How units are drawn.
    #[arg(long, value_enum, default_value_t = Sampling::Mc)]
    method: Sampling,
    /// Independent designs; 8 for lhs and sobol if not given, 1 for mc. Their spread is the standard error.
    #[arg(long)]
    replicates: Option<u64>,
    /// Seed of the production.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    threads: ThreadArguments,
    /// Works on one of n parts, i from 1 to n; `slipfit merge` joins them.
    #[arg(long, value_name = "I/N", requires = "out")]
    shard: Option<Shard>,
    /// Writes what `slipfit merge` reads.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Goes on where a run with the same --out stopped.
    #[arg(long, requires = "out")]
    resume: bool,
    /// Writes every unit's measures as CSV.
    #[arg(long, value_name = "FILE", conflicts_with = "shard")]
    draws: Option<PathBuf>,
    #[command(flatten)]
    outputs: OutputArguments,
}

/// How units are drawn.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Sampling {
    /// Pseudo-random.
    Mc,
    /// Latin hypercube.
    Lhs,
    /// Owen-scrambled Sobol' points.
    Sobol,
    /// No random units: all combinations of the limits.
    Factorial,
    /// No random units: the smallest two-level orthogonal array (L4, L8, …).
    Taguchi,
    /// No random units: the smallest three-level orthogonal array (L9, L27, …).
    Taguchi3,
}

impl Sampling {
    /// The designed experiment, if it is one.
    fn design(self) -> Option<Design> {
        match self {
            Self::Mc | Self::Lhs | Self::Sobol => None,
            Self::Factorial => Some(Design::FullFactorial),
            Self::Taguchi => Some(Design::TwoLevel),
            Self::Taguchi3 => Some(Design::ThreeLevel),
        }
    }
}

/// What is written of an analysis.
#[derive(Args)]
pub(super) struct OutputArguments {
    /// Writes the measures' statistics as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draws histograms, contributors and correlations as SVG into a folder.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

#[derive(Serialize)]
struct Given {
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
        let file = self.scene.load_file(&[])?;
        match (&file.product, &file.slide) {
            (Some(product), _) => {
                product.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
                self.study(&file.title, &product.model)
            }
            (None, Some(scene)) => self.given(scene),
            (None, None) => Ok(()),
        }
    }

    /// The gaps as the scene gives them.
    fn given(&self, scene: &Scene) -> Result<(), Failure> {
        let measures = scene.pins.iter().flat_map(|pin| {
            pin.gaps.iter().zip(SURFACES).filter_map(|(gap, surface)| {
                let gap = (*gap)?;
                let name = format!("{} {surface}", pin.name);
                Some(Measure { name, mean: millimetres(gap.mean), sd: millimetres(gap.deviation) })
            })
        });
        let derived_m = derived(scene, self.n);
        let tightest = derived_m.tightest().map(|closure| Tightest {
            pin: closure.pin.into(),
            direction: closure.direction.to_string(),
            n: closure.n,
        });
        let given = Given { title: scene.title.clone(), measures: measures.collect(), tightest, derived_m };
        if self.scene.json { print_json(&given) } else { print(&describe(&given)) }
    }

    fn settings(&self) -> Result<Settings, Failure> {
        let (method, replicates) = match self.method {
            Sampling::Lhs => (Method::LatinHypercube, 8),
            Sampling::Sobol => (Method::ScrambledSobol, 8),
            _ => (Method::PseudoRandom, 1),
        };
        let replicates = self.replicates.unwrap_or(replicates);
        let bad = || Failure::Input(format!("{} samples in {replicates} replicates are too many", self.samples));
        let samples = self.samples.checked_mul(replicates).ok_or_else(bad)?;
        if replicates > 1024 {
            return Err(Failure::Input(format!("--replicates is {replicates}, allowed are 1 to 1024")));
        }
        Ok(Settings { method, samples, replicates, seed: self.seed })
    }

    fn study(&self, title: &str, model: &Model) -> Result<(), Failure> {
        if let Some(design) = self.method.design() {
            return self.experiment(title, model, design);
        }
        let settings = self.settings()?;
        let study = Study::new(model, settings).map_err(RunError::from)?;
        let partial = self.out.as_deref().map(checkpoint);
        for path in [&self.out, &partial, &self.draws].into_iter().flatten().chain(self.outputs.paths()) {
            self.scene.check_output(path)?;
        }
        self.outputs.prepare()?;
        let (name, text) = self.scene.text()?;
        let source = Source { name, text: text.into_owned(), set: self.scene.set.clone() };
        let shard = self.shard.unwrap_or(Shard::ALL);
        let keep = self.out.as_deref().map(|out| Keep { out, resume: self.resume });
        let blocks = shard.blocks(&settings);
        let bar = progress("drawing", settings.units_in(&blocks) as usize);
        let tallies = self.threads.install(|| run(&study, &source, shard, keep.as_ref(), |units| bar.inc(units)))??;
        bar.finish_and_clear();
        if let Some(path) = &self.draws {
            files::write(path, &draws_csv(&study, &progress("writing", settings.samples as usize))?)?;
        }
        match (&self.out, shard) {
            (Some(out), Shard { number, count: 2.. }) => {
                let units: u64 = tallies.iter().map(|tally| tally.counts.units).sum();
                let written = Written { shard: number, of: shard.count, units, file: out.display().to_string() };
                if self.scene.json { print_json(&written) } else { print(&written.to_string()) }
            }
            _ => self.outputs.show(title, &study, &tallies, self.scene.json),
        }
    }
}

impl Arguments {
    fn experiment(&self, title: &str, model: &Model, design: Design) -> Result<(), Failure> {
        let made = experiment(model, design).map_err(|error| Failure::Input(error.to_string()))?;
        let scaled = |finding: &Finding, factor: f64| Finding {
            mean: finding.mean * factor,
            range: finding.range.map(|end| end * factor),
            effects: finding.effects.iter().map(|effect| effect * factor).collect(),
            shares: finding.shares.clone(),
        };
        let quantities = model.measures.iter().map(|measure| measure.quantity);
        let findings: Vec<_> =
            made.findings.iter().zip(quantities).map(|(finding, q)| scaled(finding, q.factor())).collect();
        if self.scene.json {
            let measures = model.measures.iter().zip(findings).map(|(measure, finding)| Named {
                name: measure.name.clone(),
                unit: measure.quantity.unit(),
                finding,
            });
            let measures = measures.collect();
            return print_json(&Designed { title, design, runs: made.runs, factors: &made.factors, measures });
        }
        let row = |(measure, finding): (&Measured, &Finding)| {
            let mut ranks: Vec<usize> = (0..made.factors.len()).collect();
            ranks.sort_by(|one, other| finding.shares[*other].total_cmp(&finding.shares[*one]));
            let most = ranks
                .into_iter()
                .take(3)
                .map(|k| format!("{} {}", made.factors[k], fixed(finding.shares[k] * 100.0, 1)));
            let [low, high] = finding.range;
            vec![
                measure.name.clone(),
                fixed(finding.mean, 4),
                fixed(low, 4),
                fixed(high, 4),
                most.collect::<Vec<_>>().join(", "),
            ]
        };
        let rows: Vec<_> = model.measures.iter().zip(&findings).map(row).collect();
        let table = text_table(&["measure", "mean", "least", "greatest", "factors, %"], &rows);
        print(&format!("{title}\n{} runs\n\n{table}", made.runs))
    }
}

/// An experiment for machines.
#[derive(Serialize)]
struct Designed<'a> {
    title: &'a str,
    design: Design,
    runs: usize,
    factors: &'a [String],
    measures: Vec<Named>,
}

#[derive(Serialize)]
struct Named {
    name: String,
    unit: &'static str,
    #[serde(flatten)]
    finding: Finding,
}

/// A shard that is done.
#[derive(Serialize)]
struct Written {
    shard: u64,
    of: u64,
    units: u64,
    file: String,
}

impl std::fmt::Display for Written {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "shard {} of {}: {} units in {}", self.shard, self.of, self.units, self.file)
    }
}

/// Measures of every unit, in mm and degrees, one line a unit.
fn draws_csv(study: &Study, bar: &ProgressBar) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let measures = &study.model.measures;
    let heading = measures.iter().map(|measure| measure.name.clone());
    writer.write_record(std::iter::once("unit".to_owned()).chain(heading))?;
    for first in (0..study.settings.samples).step_by(crate::tolerance::lanes::LANES) {
        let values = study.unit_measures(first);
        let units = (study.settings.samples - first).min(crate::tolerance::lanes::LANES as u64);
        for lane in 0..units as usize {
            let scaled = measures.iter().zip(&values).map(|(measure, value)| value.0[lane] * measure.quantity.factor());
            let fields = scaled.map(crate::number::ten_digits);
            writer.write_record(std::iter::once((first + lane as u64).to_string()).chain(fields))?;
        }
        bar.inc(units);
    }
    bar.finish_and_clear();
    Ok(writer.into_inner()?)
}

impl OutputArguments {
    /// The files to be written.
    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.csv.iter()
    }

    /// Makes the folder for pictures.
    pub fn prepare(&self) -> Result<(), Failure> {
        self.plots.as_deref().map_or(Ok(()), |folder| files::prepare_folder(folder).map_err(refused))
    }

    /// Shows and writes what was found of `study`.
    pub fn show(&self, title: &str, study: &Study, tallies: &[Tally], json: bool) -> Result<(), Failure> {
        let analysis = conclude(study, tallies).map_err(RunError::from)?;
        let report = report::report(title, study.model, &analysis);
        if let Some(path) = &self.csv {
            files::write(path, &measures_csv(&report)?)?;
        }
        if let Some(folder) = &self.plots {
            files::write(&folder.join("contributors.svg"), contributors_svg(&report).as_bytes())?;
            files::write(&folder.join("correlation.svg"), correlation_svg(&report).as_bytes())?;
            for i in 0..report.measures.len() {
                let svg = histogram_svg(&report, study, tallies, i).map_err(anyhow::Error::from)?;
                files::write(&folder.join(format!("histogram-{}.svg", i + 1)), svg.as_bytes())?;
            }
        }
        if json { print_json(&report) } else { print(&for_people(&report)) }
    }
}

/// An analysis as tables.
fn for_people(report: &report::Report) -> String {
    let mut text = format!("{}\n", report.title);
    let replicates =
        if report.replicates > 1 { format!(" in {} replicates", report.replicates) } else { String::new() };
    let _ = writeln!(text, "{} units{replicates}, seed {}\n", report.samples, report.seed);
    let measure = |m: &report::MeasureReport| {
        let digits = |x: f64| fixed(x, 4);
        let dpm = |side: Option<report::Defects>| or_dash(side.map(|side| side.dpm), three_digits);
        let mut row =
            vec![format!("{}{}", m.name, if m.unit.is_empty() { String::new() } else { format!(", {}", m.unit) })];
        row.extend([m.mean, m.sd].map(digits));
        row.extend([m.skew, m.kurtosis].map(|x| fixed(x, 3)));
        row.extend([m.min, m.q00135, m.median, m.q99865, m.max].map(digits));
        row.extend([m.pp, m.ppk].map(|x| or_dash(x, |x| fixed(x, 3))));
        row.extend(m.dpm.map(dpm));
        row
    };
    let heading = [
        "measure",
        "mean",
        "σ",
        "skew",
        "kurt",
        "min",
        "0.135 %",
        "50 %",
        "99.865 %",
        "max",
        "Pp",
        "Ppk",
        "ppm below",
        "ppm above",
    ];
    let _ = writeln!(text, "{}", text_table(&heading, &report.measures.iter().map(measure).collect::<Vec<_>>()));
    let theory = |m: &report::MeasureReport| {
        let [low, high] = m.worst_case;
        let half = |error: &crate::tolerance::estimate::Estimate| {
            or_dash(error.error, |error| format!("±{}", three_digits(error)))
        };
        vec![
            m.name.clone(),
            half(&m.estimates.mean),
            half(&m.estimates.sd),
            format!("{} … {}", fixed(low, 4), fixed(high, 4)),
            format!("{} ± {}", fixed(m.rss.middle, 4), fixed(m.rss.tolerance, 4)),
            fixed(m.rss.sd, 4),
            fixed(m.second_order.mean, 4),
            fixed(m.second_order.sd, 4),
        ]
    };
    let heading =
        ["measure", "error of mean", "of σ", "worst case", "RSS", "σ linear", "mean 2nd order", "σ 2nd order"];
    let _ = writeln!(text, "{}", text_table(&heading, &report.measures.iter().map(theory).collect::<Vec<_>>()));
    let _ = writeln!(text, "Contributors, % of variance");
    for m in &report.measures {
        let most = m.contributors.iter().filter(|share| share.percent.abs() >= 1.0).take(6);
        let most: Vec<String> = most.map(|share| format!("{} {}", share.name, fixed(share.percent, 1))).collect();
        let _ = writeln!(text, "  {}: {}", m.name, most.join(", "));
    }
    if !report.sums.is_empty() {
        let sum = |s: &report::SumReport| {
            vec![
                s.name.clone(),
                fixed(s.mean, 4),
                fixed(s.sd, 4),
                or_dash(s.correlation, |rho| fixed(rho, 3)),
                three_digits(s.model.dpm),
                or_dash(s.model.error, |error| format!("±{}", three_digits(error))),
                three_digits(s.eq9_ppm),
                three_digits(s.independent_ppm),
            ]
        };
        let heading = ["sum < 0", "mean", "σ", "ρ", "ppm", "error", "eq. 9 (ρ = 1)", "ρ = 0"];
        let rows: Vec<_> = report.sums.iter().map(sum).collect();
        let _ = writeln!(text, "\n{}", text_table(&heading, &rows));
        text += "ppm: with the model's own correlation; eq. 9 and ρ = 0: read from means and σ alone\n";
    }
    if let Some(good) = report.yield_of_all {
        let [low, high] = good.interval.map(|end| or_dash(end.map(|end| end * 100.0), |x| fixed(x, 4)));
        let _ = writeln!(text, "\nyield {} % ({low} … {high})", fixed(good.value * 100.0, 4));
    }
    for note in &report.notes {
        let _ = writeln!(text, "note: {note}");
    }
    text
}

/// A length (m) in mm, without the digits that the conversion to metres made up.
fn millimetres(length: f64) -> f64 {
    (length * 1e15).round() / 1e12
}

fn describe(report: &Given) -> String {
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
