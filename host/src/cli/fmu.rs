//! `slipfit fmu`: the scene's kernel as a co-simulation unit.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use maud::{DOCTYPE, Markup, html};
use serde::Serialize;
use slipfit_system::files;

use super::{
    arguments::{Moving, SceneArguments},
    endings,
    failure::Failure,
    kernel::core_folder,
    simulate::StepArguments,
    terminal::{print, print_json},
};
use crate::{
    dynamics::scheme::ScalarKind,
    firmware::fmu::{
        Causality, CompileError, Entry, Fmi, Sources, Unit, archive, compile, description, identifier, library_path,
        mechanism_unit, slide_unit,
    },
    xml::printable,
};

/// Packs the controller's kernel as an FMI co-simulation unit (FMU).
///
/// For slides and mechanisms. The kernel is compiled on this machine, which needs Cargo. The FMU runs on machines of the same kind only.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// File to write.
    #[arg(short, long, value_name = "FILE", default_value = "scene.fmu")]
    output: PathBuf,
    /// Version of the FMI standard; 2 is for tools that cannot read version 3.
    #[arg(long, value_enum, default_value_t = Version::Three)]
    fmi: Version,
    /// Folder of slipfit-core to compile, instead of the source that is part of this program.
    #[arg(long, value_name = "DIR")]
    core: Option<PathBuf>,
    #[command(flatten)]
    steps: StepArguments,
}

/// A version of the standard as it is typed.
#[derive(Clone, Copy, ValueEnum)]
enum Version {
    #[value(name = "2")]
    Two,
    #[value(name = "3")]
    Three,
}

#[derive(Serialize)]
struct Report<'a> {
    file: String,
    fmi_version: &'static str,
    /// What importers compare.
    token: &'a str,
    /// Step of the kernel (s).
    step_s: f64,
    variables: Vec<VariableReport<'a>>,
}

#[derive(Serialize)]
struct VariableReport<'a> {
    name: &'a str,
    unit: &'a str,
    causality: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    start: Option<f64>,
}

impl From<CompileError> for Failure {
    fn from(error: CompileError) -> Self {
        Self::Work(error.into())
    }
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        endings::check_one("--output", &self.output, &["fmu"])?;
        let moving = self.scene.load_moving(&self.steps.overrides())?;
        let controller = match &moving {
            Moving::Slide(scene) => scene.controller,
            Moving::Mechanism(mechanism) => mechanism.controller,
        };
        if controller.scalar != ScalarKind::F32 {
            return Err(Failure::Input(
                "controller.scalar is f64, a unit computes what the controller does, in f32: --set controller.scalar=f32".into(),
            ));
        }
        let sources = self.sources()?;
        self.scene.check_outputs(&[("--output", &self.output)])?;
        let unit = match &moving {
            Moving::Slide(scene) => slide_unit(scene, sources.path()),
            Moving::Mechanism(mechanism) => mechanism_unit(mechanism, sources.path())?,
        };
        let fmi = match self.fmi {
            Version::Two => Fmi::Two,
            Version::Three => Fmi::Three,
        };
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} compiling the kernel, {elapsed}: {msg}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(std::time::Duration::from_millis(250));
        let library = compile(&unit, &sources, |line| bar.set_message(line.to_owned()));
        bar.finish_and_clear();
        let entries = self.entries(&unit, fmi, library?)?;
        files::write(&self.output, &archive(&entries).map_err(anyhow::Error::from)?)?;
        self.report(&unit, fmi)
    }

    /// Where slipfit-core is taken from.
    fn sources(&self) -> Result<Sources, Failure> {
        Ok(self.core.as_deref().map(core_folder).transpose()?.map_or(Sources::Embedded, Sources::Folder))
    }

    fn entries(&self, unit: &Unit, fmi: Fmi, library: Vec<u8>) -> Result<Vec<Entry>, Failure> {
        let name = identifier(&self.output.file_stem().unwrap_or_default().to_string_lossy());
        let (_, scene) = self.scene.text()?;
        // The settings belong to the scene as it was compiled.
        let settings = self.scene.overrides(&self.steps.overrides());
        let settings: String =
            settings.iter().map(|setting| format!("# {}\n", printable(&setting.to_string()))).collect();
        Ok(vec![
            ("modelDescription.xml".into(), description(unit, fmi, &name).into_bytes()),
            (library_path(fmi, &name), library),
            (Path::new("resources").join("scene.toml"), (settings + &scene).into_bytes()),
            (Path::new("documentation").join("index.html"), documentation(unit).into_string().into_bytes()),
        ])
    }

    fn report(&self, unit: &Unit, fmi: Fmi) -> Result<(), Failure> {
        let file = self.output.display().to_string();
        let fmi_version = match fmi {
            Fmi::Two => "2.0",
            Fmi::Three => "3.0",
        };
        if !self.scene.json {
            return print(&format!("{file}, FMI {fmi_version}, steps of {} s, {}", unit.step, unit.token));
        }
        let variables = unit.variables.iter().map(|one| VariableReport {
            name: &one.name,
            unit: one.unit,
            causality: causality(one.causality),
            start: one.start,
        });
        print_json(&Report { file, fmi_version, token: &unit.token, step_s: unit.step, variables: variables.collect() })
    }
}

fn causality(of: Causality) -> &'static str {
    match of {
        Causality::Fixed => "fixed parameter",
        Causality::Tunable => "tunable parameter",
        Causality::Input => "input",
        Causality::Output => "output",
    }
}

/// A page that says what the unit is.
fn documentation(unit: &Unit) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                title { (unit.title) }
            }
            body {
                h1 { (unit.title) }
                p {
                    "The controller's kernel, " (unit.token) ". It steps by " (unit.step) " s from the start of the simulation on. "
                    "At a communication point its motion is that of its last instant at or before it, so that the trajectory does "
                    "not depend on communication steps. Inputs count from the next of its steps on. Fixed parameters are set before "
                    "initialization ends or after a reset, tunable ones at any communication point."
                }
                table {
                    tr { @for heading in ["name", "what", "unit", "start", "description"] { th { (heading) } } }
                    @for one in &unit.variables {
                        tr {
                            td { (one.name) }
                            td { (causality(one.causality)) }
                            td { (one.unit) }
                            td { @if let Some(start) = one.start { (format_args!("{start:?}")) } }
                            td { (one.description) }
                        }
                    }
                }
            }
        }
    }
}
