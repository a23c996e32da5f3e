//! `slipfit table --production`: what units that complete their stroke need.

use std::path::Path;

use clap::Args;
use serde::Serialize;
use slipfit_core::{production::Row, table::AxisKind};
use slipfit_tolerance::number::fixed;

use super::{axis::AxisReport, file};
use crate::{
    cli::{
        arguments::{DriveArguments, SceneArguments, ThreadArguments},
        by_one_drive::ByOneDrive,
        failure::Failure,
        terminal::{print, print_json, progress, warn},
    },
    dynamics::driven::DriveKind,
    firmware::production_table::{self as table, ProductionTable, Wish},
};

/// What only a table of the production takes.
#[derive(Args)]
pub(super) struct ProductionArguments {
    /// Makes the table of the production instead of the one over the level n.
    ///
    /// It holds the mean force of units that complete their stroke, how far units are from it, and in which modes they differ. From a unit's
    /// first strokes the controller learns its modes, and from then on knows its force.
    #[arg(long)]
    pub production: bool,
    /// Units to simulate for a table of the production. If not given, 10000.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(100..=100_000))]
    units: Option<u64>,
    /// Seed of the production. If not given, 1.
    #[arg(long)]
    seed: Option<u64>,
    /// White noise of the measured force: its standard deviation, in % of the greatest mean force.
    ///
    /// The limits of the controller's watch hold for this noise. If not given, 2 %.
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true)]
    noise: Option<f64>,
    /// How the friction of a unit differs from stroke to stroke: its standard deviation, in % of it.
    ///
    /// If not given, 3 %.
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true)]
    stroke_friction: Option<f64>,
    /// Interval of the controller's samples (ms). If not given, 1 ms.
    #[arg(long, value_name = "MS", allow_hyphen_values = true)]
    period: Option<f64>,
    /// Greatest size of the table. If not given, 16384 bytes.
    #[arg(long, value_name = "BYTES")]
    bytes: Option<usize>,
}

#[derive(Serialize)]
struct Report {
    file: String,
    bytes: usize,
    axes: Vec<AxisReport>,
    /// N, or N·m of a drive that turns, whose forces and speeds are torques and rad/s.
    effort_unit: &'static str,
    scene_hash: String,
    units: u64,
    complete: u64,
    modes: usize,
    greatest_mean_force_n: f64,
    noise_n: f64,
    rms_from_mean_n: f64,
    rms_of_taught_n: f64,
    rms_within_stroke_n: f64,
    rms_of_fit_n: f64,
    band_mean_n: f64,
    band_widest_n: f64,
    friction_deviation: f32,
    friction_margin: f32,
    moving_from: f32,
    warnings: Vec<String>,
}

impl ProductionArguments {
    /// Refuses what has no effect on a table over levels.
    pub fn refuse(&self) -> Result<(), Failure> {
        let given = [
            ("--units", self.units.is_some()),
            ("--seed", self.seed.is_some()),
            ("--noise", self.noise.is_some()),
            ("--stroke-friction", self.stroke_friction.is_some()),
            ("--period", self.period.is_some()),
            ("--bytes", self.bytes.is_some()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(Failure::Input(format!("{option} is for --production"))),
            None => Ok(()),
        }
    }

    fn wish(&self, over: table::Over) -> Result<Wish, Failure> {
        let within = |option: &str, value: f64, [least, most]: [f64; 2], unit: &str| {
            if (least..=most).contains(&value) {
                Ok(value)
            } else {
                Err(Failure::Input(format!("{option} is {value}, allowed is {least} to {most} {unit}")))
            }
        };
        Ok(Wish {
            over,
            units: self.units.unwrap_or(10_000),
            seed: self.seed.unwrap_or(1),
            noise: within("--noise", self.noise.unwrap_or(2.0), [0.0, 100.0], "%")? / 100.0,
            friction: within("--stroke-friction", self.stroke_friction.unwrap_or(3.0), [0.01, 30.0], "%")? / 100.0,
            period: within("--period", self.period.unwrap_or(1.0), [0.05, 100.0], "ms")? * 1e-3,
            bytes: self.bytes.unwrap_or(16_384),
        })
    }
}

/// What a table of the production is made of, and where it goes.
pub(super) struct Output<'a> {
    pub scene: &'a SceneArguments,
    pub drive: &'a DriveArguments,
    pub threads: &'a ThreadArguments,
    pub output: &'a Path,
    pub over: table::Over,
}

impl ProductionArguments {
    /// Makes the table.
    pub fn make(&self, Output { scene, drive, threads, output, over }: &Output<'_>) -> Result<(), Failure> {
        let wish = self.wish(*over)?;
        let (moving, product) = scene.load_moving_with_product(&[])?;
        let of = ByOneDrive::new(&moving, drive)?;
        let longer = of.longer();
        let of = of.or_longer(&longer);
        let subject = of.subject();
        if subject.has_segments() {
            let message = "a table of the production is of a ramp to one speed, not of drive.segment";
            return Err(Failure::Input(message.into()));
        }
        let extension = file::format_of(output)?;
        table::check(&wish).map_err(|error| Failure::Input(error.to_string()))?;
        scene.check_outputs(&[("--output", *output)])?;
        let production = of.production(product.as_ref(), 0.0, wish.seed)?;
        let mut warnings = of.warnings()?;
        warnings.extend(product.iter().flat_map(|product| product.warnings.clone()));

        let bar = progress("simulating", table::work(&wish) as usize);
        let made = threads.install(|| table::make(subject, &production, &wish, || bar.inc(1)))?;
        bar.finish_and_clear();
        let made = made.map_err(anyhow::Error::from)?;
        file::write(output, &extension, &made.bytes)?;
        if !scene.json {
            print(&format!("{}\n{}", output.display(), describe(subject.kind(), &made)))?;
            warn(&warnings);
            return Ok(());
        }
        let [rms_from_mean_n, rms_of_taught_n, rms_within_stroke_n] = made.differences;
        let [units, complete] = made.units;
        let [band, widest] = band(&made);
        print_json(&Report {
            file: output.display().to_string(),
            bytes: made.bytes.len(),
            axes: made.axes.iter().map(|axis| AxisReport::new(subject.kind(), axis)).collect(),
            effort_unit: subject.kind().effort_unit(),
            scene_hash: format!("{:016x}", subject.hash()),
            units,
            complete,
            modes: made.axes[0].count - Row::Mode as usize,
            greatest_mean_force_n: made.greatest,
            noise_n: made.noise,
            rms_from_mean_n,
            rms_of_taught_n,
            rms_within_stroke_n,
            rms_of_fit_n: made.fit,
            band_mean_n: band,
            band_widest_n: widest,
            friction_deviation: made.record.deviation,
            friction_margin: made.record.margin,
            moving_from: made.record.moving,
            warnings,
        })
    }
}

/// Width (N) of the band of a table: its mean over the places, and its greatest.
fn band(table: &ProductionTable) -> [f64; 2] {
    let widths = || table.band.iter().map(|[_, _, above, below]| above + below);
    [widths().sum::<f64>() / table.band.len().max(1) as f64, widths().fold(0.0, f64::max)]
}

/// What there is to say of a table.
fn describe(kind: DriveKind, table: &ProductionTable) -> String {
    let ([units, complete], record) = (table.units, &table.record);
    let [rows, places] = [&table.axes[0], &table.axes[1]];
    let over_time = places.kind == AxisKind::Time;
    let place = |x: f64| match over_time {
        true => fixed(x * 1e3, 0) + " ms",
        false => fixed(kind.travel(x), 2) + " " + kind.travel_unit(),
    };
    let unit = kind.effort_unit();
    let [from_mean, taught, within] = table.differences.map(|x| format!("{} {unit}", fixed(x, 4)));
    let last = f64::from(places.first) + f64::from(places.step) * (places.count - 1) as f64;
    let [band, widest] = band(table);
    let percent = |x: f32, digits: usize| format!("{} %", fixed(f64::from(x) * 100.0, digits));
    let friction = if record.response == 0.0 {
        String::from("Friction      none that the force would tell\n")
    } else {
        let margin = percent(record.margin, 0);
        let margin = if f64::from(record.margin) < table::MARGIN_MOST {
            format!("with {margin} more friction one unit in a hundred does not complete its stroke")
        } else {
            format!("up to {margin} more friction fewer than one unit in a hundred do not complete their stroke")
        };
        format!(
            "Friction      a stroke tells it to {}; it differs by {} from stroke to stroke\n\
             Margin        {margin}\n",
            percent(record.deviation, 2),
            percent(record.friction, 1)
        )
    };
    format!(
        "{} bytes: {} rows ({} modes) by {} places from {} to {}\n\
         Units         {complete} of {units} complete their stroke ({}); the table is about these\n\
         Force         {} {unit} in the mean at most; root mean square of what a stroke differs by\n\
         \u{20}             from the mean                        {from_mean}\n\
         \u{20}             from the unit's own, after 3 strokes {taught}\n\
         \u{20}             and with what the stroke tells so far {within}\n\
         \u{20}             from mean and modes that fit it best {} {unit}\n\
         Band          {} {unit} wide in the mean over the places, {} {unit} at most, holds 99 % of the strokes\n\
         {friction}\
         Jam           reported from {} on\n\
         Limits        for {} {unit} of noise and samples every {} ms\n",
        table.bytes.len(),
        rows.count,
        rows.count - Row::Mode as usize,
        places.count,
        place(f64::from(places.first)),
        place(last),
        percent(record.completing, 1),
        fixed(table.greatest, 4),
        fixed(table.fit, 4),
        fixed(band, 3),
        fixed(widest, 3),
        place(f64::from(record.moving)),
        fixed(table.noise, 4),
        fixed(f64::from(record.period) * 1e3, 3)
    )
}
