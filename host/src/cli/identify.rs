//! `slipfit identify`: parameters from measured motion.

mod found;
mod output;
mod report;
mod words;

use std::path::{Path, PathBuf};

use clap::Args;
use slipfit_core::slide::CONTACTS;
use slipfit_identify::{
    between::{between, explained},
    compare::{Compared, best, compare},
    drive_train::{self, DriveTrain, Filtered, LAWS, filtered},
    estimate::Estimate,
    fit,
    model::Model,
    record::{Needs, Record, read_file},
};
use slipfit_system::files;

use self::{
    found::{Found, OfUnit, Written},
    report::{Report, UnitReport},
};
use super::{
    arguments::SceneArguments,
    endings,
    failure::Failure,
    terminal::{print, print_json, warn},
};
use crate::{
    dynamics::driven::DriveKind,
    identify::{Compared as Quantity, Identification, Law, MotionModel, OfRecord, Sought, SoughtValue, Subject, Unit},
    show::report::{Identified, identified_page},
};

/// Estimates parameters from measured motion, and says what the record does not determine.
///
/// The table `[identify]` of the scene says what is sought. A slide or a mechanism is simulated, and what its drive does is compared with
/// the record. A drive train (`model = "drive-train"`) is fitted along the measured motion; several laws are compared. A record is a CSV
/// file whose first row names the columns with their units: t (s), force (N), position (m) or speed (m/s). Intervals are of 95 % and allow
/// for noise whose samples depend on each other.
#[derive(Args)]
pub(super) struct Arguments {
    /// Scene file (TOML) with a table [identify].
    scene: PathBuf,
    /// Records (CSV) of one unit; a folder stands for all records in it.
    #[arg(required = true, value_name = "RUN.csv")]
    records: Vec<PathBuf>,
    /// Takes each RUN for another unit, fits each, and prints their mean and spread. A folder holds the runs of one unit.
    #[arg(long)]
    each: bool,
    /// Tolerance level of the gaps that are not sought.
    #[arg(long, allow_hyphen_values = true)]
    n: Option<f64>,
    /// Sets a key of the scene, such as identify.law=symmetric; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Writes the estimate as a scene's table (TOML) to this file.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Writes a page with measured and computed motion, residuals, profiles and correlations (HTML).
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// Prints JSON instead of text.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// Runs the command.
    ///
    /// # Errors
    /// A scene or a record that cannot be read, a parameter without influence, a unit that cannot be simulated.
    pub(super) fn run(self) -> Result<(), Failure> {
        let arguments = SceneArguments { scene: self.scene.clone(), set: self.set.clone(), json: self.json };
        let file = arguments.load_file(&[])?;
        let mut outputs = Vec::new();
        for (option, path, ending) in [("--output", &self.output, "toml"), ("--page", &self.page, "html")] {
            if let Some(path) = path {
                endings::check_one(option, path, &[ending])?;
                outputs.push((option, path.as_path()));
            }
        }
        if !outputs.is_empty() {
            arguments.check_outputs(&outputs)?;
            let records: Vec<_> = self.records.iter().map(|record| ("a record", record.as_path())).collect();
            files::check_distinct(&records, &outputs)?;
        }
        let Some(identify) = &file.identify else {
            let why = "the scene has no table [identify]; see the guide, identify.md";
            return Err(Failure::Input(format!("{}: {why}", self.scene.display())));
        };
        match &identify.subject {
            Subject::DriveTrain { law, cutoff } => {
                if self.n.is_some() {
                    let why = "--n is for slides and mechanisms, whose gaps have levels; a drive train has none";
                    return Err(Failure::Input(why.into()));
                }
                let units = self.units(identify, Needs::Motion)?;
                let mut found = each(&units, |unit| drive_train(unit, law.as_ref(), *cutoff, &identify.options))?;
                if self.each && law.is_none() {
                    choose_alike(&mut found)?;
                }
                self.finish(
                    &file.title,
                    Written { compared: "force (N)", model: "drive-train", exponent: None, lists: &[] },
                    &units,
                    found,
                )
            }
            Subject::Slide(of) => {
                let scene = file.slide.as_ref().ok_or_else(|| Failure::Input("the scene has no slide".into()))?;
                let levels = [self.level()?; CONTACTS];
                scene.check_gaps(&levels).map_err(|error| Failure::Input(format!("--n: {error}")))?;
                let units = self.units(identify, needs(of))?;
                let found = self.of_unit(scene, levels.to_vec(), of, &units, identify, &scene.warnings)?;
                let lists: Vec<_> = of.sought.iter().map(Sought::place).collect();
                let exponent = Some(scene.contact.exponent);
                self.finish(
                    &file.title,
                    Written { compared: compared(of, false), model: "slide", exponent, lists: &lists },
                    &units,
                    found,
                )
            }
            Subject::Mechanism(of) => {
                let mechanism =
                    file.mechanism.as_ref().ok_or_else(|| Failure::Input("the scene has no mechanism".into()))?;
                let levels = vec![self.level()?; mechanism.gaps.len()];
                mechanism.gaps_at(&levels).map_err(|error| Failure::Input(format!("--n: {error}")))?;
                let units = self.units(identify, needs(of))?;
                let found = self.of_unit(mechanism, levels, of, &units, identify, &mechanism.warnings)?;
                let lists: Vec<_> = of.sought.iter().map(Sought::place).collect();
                let joint = mechanism.joints.iter().find(|joint| !joint.kind.is_ideal());
                let exponent = joint.map(|joint| joint.laws.contact.spring()[1]);
                let turns = mechanism.drives[of.drive].action.kind() == DriveKind::Turns;
                let written = Written { compared: compared(of, turns), model: "mechanism", exponent, lists: &lists };
                self.finish(&file.title, written, &units, found)
            }
        }
    }

    fn level(&self) -> Result<f64, Failure> {
        match self.n.unwrap_or(0.0) {
            level if level.is_finite() => Ok(level),
            level => Err(Failure::Input(format!("--n is {level}, allowed are finite numbers"))),
        }
    }

    /// The records, unit by unit.
    fn units(&self, identify: &Identification, needs: Needs) -> Result<Vec<OfUnit>, Failure> {
        let read = |path: &Path| -> Result<Vec<Record>, Failure> {
            let paths = if path.is_dir() { records_in(path)? } else { vec![path.to_path_buf()] };
            paths.iter().map(|path| Ok(read_file(path, &identify.columns, needs)?)).collect()
        };
        let named = |path: &PathBuf| Ok(OfUnit { name: path.display().to_string(), records: read(path)? });
        let units = self.records.iter().map(named).collect::<Result<Vec<_>, Failure>>()?;
        if self.each {
            return match units.len() {
                0 | 1 => Err(Failure::Input("--each needs the records of two units or more".into())),
                _ => Ok(units),
            };
        }
        let names: Vec<_> = units.iter().map(|unit| unit.name.as_str()).collect();
        let name = names.join(", ");
        Ok(vec![OfUnit { name, records: units.into_iter().flat_map(|unit| unit.records).collect() }])
    }

    /// What the records of each unit say of one of a scene.
    fn of_unit<U: Unit>(
        &self,
        unit: &U,
        levels: Vec<f64>,
        of: &OfRecord<U::Parameter>,
        units: &[OfUnit],
        identify: &Identification,
        warnings: &[String],
    ) -> Result<Vec<Found>, Failure> {
        let is_of_all = |of: &&Sought<U::Parameter>| of.prior.is_some() && !matches!(of.value, SoughtValue::Level(_));
        if let (true, Some(of)) = (self.each, of.sought.iter().find(is_of_all)) {
            let why =
                "with --each what is known of it beforehand would count once for every unit; allowed are two bounds";
            return Err(Failure::Input(format!("{}: {why}", of.name)));
        }
        each(units, |records| {
            let model = MotionModel::new(unit, levels.clone(), of, &records.records);
            let model = model.map_err(|error| Failure::Input(error.to_string()))?;
            let (compared, mut refused) = compare(&[("as stated", &model as &dyn Model)], &identify.options);
            if compared.is_empty() {
                return Err(refused.swap_remove(0).1.into());
            }
            let [measured, times] = [model.measured().to_vec(), model.times()];
            let (runs, warnings) = (model.runs(), warnings.to_vec());
            Ok(Found { measured, times, runs, compared, chosen: 0, spikes: None, cutoff_hz: None, warnings })
        })
    }

    /// Writes and prints what was `found` of the `units`.
    fn finish(&self, title: &str, written: Written, units: &[OfUnit], found: Vec<Found>) -> Result<(), Failure> {
        let chosen: Vec<&Compared> = found.iter().map(|one| &one.compared[one.chosen]).collect();
        let pooled = self.each.then(|| between(&chosen.iter().map(|one| &one.estimate).collect::<Vec<_>>()));
        if let Some(path) = &self.output {
            let table = match &pooled {
                None => output::of_one(title, &written, &chosen[0].estimate),
                Some(pooled) => output::of_several(title, &written, pooled),
            };
            files::write(path, table.as_bytes())?;
        }
        let reports: Vec<UnitReport> =
            units.iter().zip(&found).map(|(unit, found)| UnitReport::new(unit, found)).collect();
        let report = Report { title, model: written.model, units: &reports, between: pooled.as_deref() };
        let text = match &pooled {
            None => words::described(&report, &reports[0], chosen[0]),
            Some(pooled) => words::between(&report, &chosen, pooled),
        };
        let mut warnings: Vec<String> = Vec::new();
        for warning in found.iter().flat_map(|one| &one.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        if pooled.is_some() {
            let all: Vec<&Estimate> = chosen.iter().map(|one| &one.estimate).collect();
            let counted = explained(&all);
            let left_out = (0..all.len()).filter(|k| !counted.contains(k));
            warnings.extend(left_out.map(|k| {
                let why = all[k].lack.verdict.as_deref().unwrap_or_default();
                format!("{} is left out of the mean, because the model does not explain it: {why}", units[k].name)
            }));
        }
        if let Some(path) = &self.page {
            let units: Vec<Identified> = units.iter().zip(&found).map(|(unit, found)| found.on_page(unit)).collect();
            let page =
                identified_page(title, &text, &units, written.compared, &warnings).map_err(anyhow::Error::from)?;
            files::write(path, page.into_string().as_bytes())?;
        }
        if self.json {
            return match &pooled {
                None => print_json(&report.of_one()),
                Some(_) => print_json(&report),
            };
        }
        print(&text)?;
        warn(&warnings);
        Ok(())
    }
}

/// What is compared of a drive that `turns` or pushes, with its unit.
fn compared<P>(of: &OfRecord<P>, turns: bool) -> &'static str {
    match (of.compared, turns) {
        (Quantity::Force, false) => "force (N)",
        (Quantity::Force, true) => "torque (N·m)",
        (Quantity::Speed, false) => "speed (m/s)",
        (Quantity::Speed, true) => "angular velocity (rad/s)",
        (Quantity::Position, false) => "distance (m)",
        (Quantity::Position, true) => "angle (rad)",
    }
}

/// What a fit needs of a record.
fn needs<P>(of: &OfRecord<P>) -> Needs {
    match (of.along, of.compared) {
        (Some(_), _) => Needs::Motion,
        (None, Quantity::Force) => Needs::Force,
        (None, Quantity::Speed) => Needs::Speed,
        (None, Quantity::Position) => Needs::Position,
    }
}

/// What is found of each of the `units`; errors of one of several name it.
fn each(units: &[OfUnit], find: impl Fn(&OfUnit) -> Result<Found, Failure>) -> Result<Vec<Found>, Failure> {
    let named = |unit: &OfUnit| {
        find(unit).map_err(|failure| match failure {
            Failure::Input(why) if units.len() > 1 && !why.contains(&unit.name) => {
                Failure::Input(format!("{}: {why}", unit.name))
            }
            failure => failure,
        })
    };
    units.iter().map(named).collect()
}

/// Chooses the law that explains the records of all units best, so that their parameters are the same.
fn choose_alike(found: &mut [Found]) -> Result<(), Failure> {
    let behind = |name: &str| {
        let of_unit = |one: &Found| one.compared.iter().find(|law| law.name == name).map(|law| law.behind);
        found.iter().map(of_unit).sum::<Option<f64>>()
    };
    let names = found.first().map_or(&[][..], |one| &one.compared);
    let all = names.iter().filter_map(|law| Some((law.name.clone(), behind(&law.name)?)));
    let best = all.min_by(|one, other| one.1.total_cmp(&other.1));
    let Some((name, _)) = best else {
        return Err(Failure::Input("no law has an estimate for every unit; state one as identify.law".into()));
    };
    for one in found {
        one.chosen = one.compared.iter().position(|law| law.name == name).unwrap_or(one.chosen);
    }
    Ok(())
}

/// The CSV files of a `folder`, by their names.
fn records_in(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries =
        std::fs::read_dir(folder).map_err(|error| Failure::Input(format!("{}: {error}", folder.display())))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")));
    paths.sort();
    match paths.len() {
        0 => Err(Failure::Input(format!("{}: the folder has no file that ends in .csv", folder.display()))),
        _ => Ok(paths),
    }
}

/// What the records of a `unit` say of a drive train with this `law`, or of all laws.
fn drive_train(
    unit: &OfUnit,
    law: Option<&Law>,
    cutoff: Option<f64>,
    options: &fit::Options,
) -> Result<Found, Failure> {
    let motion = drive_train::Options { cutoff };
    let runs: Vec<Filtered> = unit.records.iter().map(|record| filtered(record, &motion)).collect();
    // The stated law first; a drive that coasts has no delay.
    let coasts = runs.iter().any(|run| run.force.is_none());
    let mut laws: Vec<(String, DriveTrain)> = Vec::new();
    let stated = law.into_iter().map(|law| (law.name.as_str(), &law.terms[..]));
    for (name, terms) in stated.chain(LAWS) {
        let is_known = laws.iter().any(|(other, _)| other == name);
        let is_undelayed = coasts && terms.contains(&drive_train::Term::Delay);
        if !(is_known || is_undelayed) {
            laws.push((name.to_owned(), DriveTrain::new(terms, &runs)));
        }
    }
    let models: Vec<(&str, &dyn Model)> = laws.iter().map(|(name, law)| (name.as_str(), law as &dyn Model)).collect();
    let (compared, mut refused) = compare(&models, options);
    // A stated law has to have an estimate, else any.
    let error = |name: Option<&str>| refused.iter().position(|(law, _)| name.is_none_or(|name| name == *law));
    let fatal = match law {
        Some(law) => error(Some(&law.name)),
        None if compared.is_empty() => error(None),
        None => None,
    };
    if let Some(at) = fatal {
        return Err(refused.swap_remove(at).1.into());
    }
    let mut warnings: Vec<String> =
        refused.iter().map(|(name, why)| format!("the law {name} is not compared: {why}")).collect();
    let by_name = law.and_then(|law| compared.iter().position(|one| one.name == law.name));
    let chosen = by_name.or_else(|| best(&compared).and_then(|best| compared.iter().position(|one| one == best)));
    let Some(chosen) = chosen else { return Err(Failure::Input("no law has an estimate".into())) };
    warnings.extend(words::better(&compared[chosen], &compared));
    let spikes = Some(runs.iter().map(|run| run.spikes).sum());
    let cutoff_hz = runs.first().map(|run| run.cutoff);
    let (_, model) = &laws[0];
    let [measured, times] = [model.measured().to_vec(), model.times()];
    Ok(Found { measured, times, runs: model.runs(), chosen, spikes, cutoff_hz, warnings, compared })
}
