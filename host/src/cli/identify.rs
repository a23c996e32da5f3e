//! `slipfit identify`: parameters from measured motion.

mod output;
mod report;
mod words;

use std::path::PathBuf;

use clap::Args;
use slipfit_core::slide::CONTACTS;
use slipfit_identify::{
    compare::{Compared, best, compare},
    drive_train::{self, DriveTrain, Filtered, LAWS, filtered},
    model::Model,
    record::{Needs, Record, read_file},
};
use slipfit_system::files;

use self::report::Report;
use super::{
    arguments::SceneArguments,
    endings,
    failure::Failure,
    terminal::{print, print_json, warn},
};
use crate::{
    identify::SlideModel,
    scene::SceneFile,
    setup::{Identification, Law, Subject},
};

/// Estimates parameters from measured motion, and says what the record does not determine.
///
/// The table `[identify]` of the scene says what is sought. A slide is simulated, and the force of its drive compared with the record's. A
/// drive train (`model = "drive-train"`) is fitted along the measured motion; several laws are compared. A record is a CSV file whose first
/// row names the columns with their units: t (s), force (N), position (m) or speed (m/s). Intervals are of 95 % and allow for noise whose
/// samples depend on each other.
#[derive(Args)]
pub(super) struct Arguments {
    /// Scene file (TOML) with a table [identify].
    scene: PathBuf,
    /// Records (CSV), each of one run of the same unit.
    #[arg(required = true, value_name = "RUN.csv")]
    records: Vec<PathBuf>,
    /// Tolerance level of the gaps that are not sought.
    #[arg(long, allow_hyphen_values = true)]
    n: Option<f64>,
    /// Sets a key of the scene, such as identify.law=symmetric; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Writes the estimate as a scene's table (TOML) to this file.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Prints JSON instead of text.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// Runs the command.
    ///
    /// # Errors
    /// A scene or a record that cannot be read, a parameter without influence, a slide that cannot be simulated.
    pub(super) fn run(self) -> Result<(), Failure> {
        let arguments = SceneArguments { scene: self.scene.clone(), set: self.set.clone(), json: self.json };
        let file = arguments.load_file(&[])?;
        if let Some(path) = &self.output {
            endings::check_one("--output", path, &["toml"])?;
            arguments.check_outputs(&[("--output", path)])?;
            let records: Vec<_> = self.records.iter().map(|record| ("a record", record.as_path())).collect();
            files::check_distinct(&records, &[("--output", path)])?;
        }
        let Some(identify) = &file.identify else {
            let why = "the scene has no table [identify] for a slide or a drive train; see the guide, identify.md";
            return Err(Failure::Input(format!("{}: {why}", self.scene.display())));
        };
        match &identify.subject {
            Subject::DriveTrain { law, cutoff } => self.drive_train(&file, identify, law.as_ref(), *cutoff),
            Subject::Slide(_) => self.slide(&file, identify),
        }
    }

    fn records(&self, identify: &Identification, needs: Needs) -> Result<Vec<Record>, Failure> {
        self.records.iter().map(|path| Ok(read_file(path, &identify.columns, needs)?)).collect()
    }

    fn drive_train(
        &self,
        file: &SceneFile,
        identify: &Identification,
        law: Option<&Law>,
        cutoff: Option<f64>,
    ) -> Result<(), Failure> {
        if self.n.is_some() {
            return Err(Failure::Input("--n is for slides, whose gaps have levels; a drive train has none".into()));
        }
        let records = self.records(identify, Needs::Motion)?;
        let options = drive_train::Options { cutoff };
        let runs: Vec<Filtered> = records.iter().map(|record| filtered(record, &options)).collect();
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
        let models: Vec<(&str, &dyn Model)> =
            laws.iter().map(|(name, law)| (name.as_str(), law as &dyn Model)).collect();
        let (compared, refused) = compare(&models, &identify.options);
        // A stated law has to have an estimate, else any.
        let error = |name: Option<&str>| refused.iter().position(|(law, _)| name.is_none_or(|name| name == *law));
        let fatal = match law {
            Some(law) => error(Some(&law.name)),
            None if compared.is_empty() => error(None),
            None => None,
        };
        let mut refused = refused;
        if let Some(at) = fatal {
            return Err(refused.swap_remove(at).1.into());
        }
        let mut warnings: Vec<String> =
            refused.iter().map(|(name, why)| format!("the law {name} is not compared: {why}")).collect();
        let chosen = law.and_then(|law| compared.iter().find(|one| one.name == law.name)).or(best(&compared));
        let Some(chosen) = chosen else { return Err(Failure::Input("no law has an estimate".into())) };
        warnings.extend(words::better(chosen, &compared));
        let spikes = runs.iter().map(|run| run.spikes).sum();
        let cutoff_hz = runs.first().map(|run| run.cutoff);
        let report = Report {
            title: &file.title,
            model: "drive-train",
            records: records.iter().map(|record| record.name.as_str()).collect(),
            law: &chosen.name,
            spikes: Some(spikes),
            cutoff_hz,
            compared: &compared,
            warnings: &warnings,
        };
        self.finish(&report, chosen, records.iter().map(Record::duration).sum(), None)
    }

    fn slide(&self, file: &SceneFile, identify: &Identification) -> Result<(), Failure> {
        let (Some(scene), Subject::Slide(sought)) = (&file.slide, &identify.subject) else {
            return Err(Failure::Input("the scene has no slide".into()));
        };
        let level = self.n.unwrap_or(0.0);
        if !level.is_finite() {
            return Err(Failure::Input(format!("--n is {level}, allowed are finite numbers")));
        }
        let levels = [level; CONTACTS];
        scene.check_gaps(&levels).map_err(|error| Failure::Input(format!("--n: {error}")))?;
        let records = self.records(identify, Needs::Force)?;
        let model = SlideModel::new(scene, levels, sought, &records);
        let model = model.map_err(|error| Failure::Input(error.to_string()))?;
        let (compared, mut refused) = compare(&[("as stated", &model as &dyn Model)], &identify.options);
        let Some(chosen) = compared.first() else { return Err(refused.swap_remove(0).1.into()) };
        let warnings = scene.warnings.clone();
        let report = Report {
            title: &file.title,
            model: "slide",
            records: records.iter().map(|record| record.name.as_str()).collect(),
            law: &chosen.name,
            spikes: None,
            cutoff_hz: None,
            compared: &compared,
            warnings: &warnings,
        };
        self.finish(&report, chosen, records.iter().map(Record::duration).sum(), Some(scene.contact.exponent))
    }

    /// Writes and prints the `report`, of which one estimate was `chosen`, of records of this `duration` (s) and contacts of this `exponent`.
    fn finish(&self, report: &Report, chosen: &Compared, duration: f64, exponent: Option<f64>) -> Result<(), Failure> {
        if let Some(path) = &self.output {
            files::write(path, output::table(report.title, report.model, &chosen.estimate, exponent).as_bytes())?;
        }
        if self.json {
            return print_json(report);
        }
        print(&words::described(report, chosen, duration))?;
        warn(report.warnings);
        Ok(())
    }
}
