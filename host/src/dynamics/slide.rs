//! A slide on pins as what moves under one drive.

use slipfit_core::{drive::Drive, slide::CONTACTS};

use super::{
    confirm::confirmed,
    driven::{DriveKind, Driven, Motion},
    level::{Level, classes},
    run::SimulateError,
    settings::Settings,
    simulate::simulate,
};
use crate::setup::{LevelRange, RunSpec, Scene, scene_hash};

impl Driven for Scene {
    fn title(&self) -> &str {
        &self.title
    }

    fn kind(&self) -> DriveKind {
        DriveKind::Pushes
    }

    fn drive(&self) -> &Drive<f64> {
        &self.drive
    }

    fn run(&self) -> RunSpec {
        self.run
    }

    fn levels(&self) -> &LevelRange {
        &self.sweep
    }

    fn gap_names(&self) -> Vec<String> {
        self.contact_names().into()
    }

    fn hash(&self) -> u64 {
        let deviations = self.pins.iter().flat_map(|pin| pin.gaps.map(|gap| gap.map_or(0.0, |gap| gap.deviation)));
        let mut all = [0.0; CONTACTS];
        all.iter_mut().zip(deviations).for_each(|(slot, deviation)| *slot = deviation);
        scene_hash(&self.slide_data::<f64>(&self.gaps_at(&[0.0; CONTACTS])), &all)
    }

    fn level(&self, n: f64, Motion { speed, run, every }: Motion) -> Result<Level, SimulateError> {
        let settings = Settings { run, ..Settings::desk(self, every) };
        let commanded = Self { drive: Drive { speed, ..self.drive }, ..self.clone() };
        slide_level(&commanded, n, &settings)
    }
}

/// The slide of level `n` as `settings` have it computed, and once more as [`confirmed`] does.
///
/// # Errors
/// See [`SimulateError`].
pub fn slide_level(scene: &Scene, n: f64, settings: &Settings) -> Result<Level, SimulateError> {
    let n_each = [n; CONTACTS];
    let gaps = settings.gaps(scene, &n_each);
    let run = confirmed(scene, &gaps, settings, simulate(scene, &gaps, settings)?)?;
    Ok(Level {
        n,
        trajectory: run.trajectory,
        outcome: run.outcome,
        solved: run.solved,
        trust: run.trust,
        doubts: run.trust.warning().into_iter().collect(),
        classes: classes(&scene.gaps_at(&n_each)),
    })
}
