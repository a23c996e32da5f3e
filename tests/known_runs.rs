//! The reference runs, shared by tests and benches.
//!
//! Each comes from an adaptive Radau integration in f64 at rtol 1e-10, written independently of this project; two
//! tolerances agree to 1e-6 of the peak force or better.

use std::path::PathBuf;

use serde::Deserialize;
use slipfit::dynamics::deviation::Deviation;

/// A reference run and what it was run with.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Name of the file without its extension.
    pub name: String,
    /// Tolerance level.
    pub n: f64,
    /// Duration (s).
    pub duration: f64,
    /// End of the drive's ramp (s).
    pub ramp_end: f64,
    /// Stick band (m/s).
    pub stick_band: f64,
    /// Greatest |force| (N).
    pub peak: f64,
    /// Drive force (N) every millisecond.
    pub force: Vec<f64>,
    /// Velocity along z (m/s) every millisecond.
    pub vz: Vec<f64>,
}

#[derive(Deserialize)]
struct Manifest {
    defaults: Defaults,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Defaults {
    vs_m_per_s: f64,
}

#[derive(Deserialize)]
struct Case {
    file: String,
    n: f64,
    t_end_s: f64,
    #[serde(rename = "peak_force_N")]
    peak_force: f64,
    t1: Option<f64>,
    vs: Option<f64>,
}

#[derive(Deserialize)]
struct Row {
    vz: f64,
    force: f64,
}

/// All reference runs.
///
/// # Panics
/// If a file is missing or not as expected.
pub fn references() -> Vec<Reference> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference");
    let text = std::fs::read_to_string(folder.join("slide.json")).expect("slide.json");
    let manifest: Manifest = serde_json::from_str(&text).expect("slide.json");
    let load = |case: Case| {
        let mut reader = csv::Reader::from_path(folder.join(&case.file)).expect("a listed file");
        let rows: Vec<Row> = reader.deserialize().collect::<Result<_, _>>().expect("t,vz,force,x,y");
        assert_eq!(rows.len(), (case.t_end_s * 1e3).round() as usize + 1, "{}", case.file);
        let peak = rows.iter().map(|row| row.force.abs()).fold(0.0, f64::max);
        assert!((peak / case.peak_force - 1.0).abs() < 1e-8, "{}", case.file);
        Reference {
            name: case.file.trim_end_matches(".csv").into(),
            n: case.n,
            duration: case.t_end_s,
            ramp_end: case.t1.unwrap_or(slipfit_problems::cd_rom::RAMP_END),
            stick_band: case.vs.unwrap_or(manifest.defaults.vs_m_per_s),
            peak,
            force: rows.iter().map(|row| row.force).collect(),
            vz: rows.iter().map(|row| row.vz).collect(),
        }
    };
    manifest.cases.into_iter().map(load).collect()
}

/// The rows of a reference run of a mechanism, without the time.
///
/// # Panics
/// If the file is missing or not as expected.
pub fn mechanism_rows(file: &str) -> Vec<Vec<f64>> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/reference/mechanisms/{file}.csv"));
    let mut reader = csv::Reader::from_path(path).expect("a reference run");
    reader.deserialize().map(|row: Result<Vec<f64>, _>| row.expect("numbers")[1..].to_vec()).collect()
}

impl Reference {
    /// How far `force` (N, every millisecond) is off.
    ///
    /// # Panics
    /// If it is not as long as the reference.
    pub fn errors(&self, force: &[f64]) -> Deviation {
        assert_eq!(force.len(), self.force.len(), "{}", self.name);
        Deviation::between(force, &self.force)
    }
}
