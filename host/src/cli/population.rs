//! `slipfit population`: what every unit of a production does.

pub(super) mod asked;
pub(super) mod page;
pub(super) mod rare;
pub(super) mod reports;
mod rows;
mod slide;
pub(super) mod uncertain;
pub(super) mod words;

use slipfit_tolerance::product::Product;

use super::{arguments::Moving, failure::Failure, mechanism};
use crate::{
    mechanism::{ByDrive, Mechanism},
    population::{tally::Tally, uncertain::study},
};

pub(super) use asked::Arguments;

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        if !(-1.0..=1.0).contains(&self.correlation) {
            return Err(Failure::Input(format!("--correlation {}: allowed is -1 to 1", self.correlation)));
        }
        if let Some(limit) = self.force_limit.filter(|limit| !(limit.is_finite() && *limit > 0.0)) {
            return Err(Failure::Input(format!("--force-limit {limit}: allowed is more than 0 N")));
        }
        let (moving, product) = self.scene.load_moving_with_product(&[])?;
        let mut scene = match moving {
            Moving::Slide(scene) => *scene,
            Moving::Mechanism(mechanism) => return self.of_mechanism(&mechanism, product.as_ref()),
        };
        self.drive.refuse()?;
        let design = self.design(scene.has_unknowns())?;
        let production = self.prepare(&mut scene, product.as_ref())?;
        let (duty, bar) = (self.duty_of(&scene), self.bar(design));
        let Some(tally) = self.simulated(&scene, &production, duty, 0, &bar)? else { return Ok(()) };
        let answer = |design| {
            self.threads.install(|| study::of_slide(&scene, &production, design, duty, |units| bar.inc(units)))
        };
        let unknown = design.map(answer).transpose()?.transpose()?;
        bar.finish_and_clear();
        self.conclude(&scene, &production, tally, unknown, product.as_ref())
    }

    /// The population of a `mechanism`.
    fn of_mechanism(&self, mechanism: &Mechanism, product: Option<&Product>) -> Result<(), Failure> {
        if self.opening {
            return Err(Failure::Input(
                "--opening is for slides on pins: a mechanism has one run, `run.duration`".into(),
            ));
        }
        let driven = self.drive.of(mechanism)?;
        let design = self.design(mechanism.has_unknowns())?;
        let production = self.production_of(mechanism, product)?;
        let (duty, bar) = (self.duty_of_mechanism(mechanism), self.bar(design));
        let Some(tally) = self.simulated(&driven, &production, duty, driven.index(), &bar)? else { return Ok(()) };
        let answer = |design| {
            self.threads.install(|| study::of_mechanism(&driven, &production, design, duty, |units| bar.inc(units)))
        };
        let unknown = design.map(answer).transpose()?.transpose()?;
        bar.finish_and_clear();
        mechanism::population::conclude(self, &driven, &production, tally, unknown, product)
    }

    /// Shows and writes what all units of a mechanism, counted in `tally`, did, by the drive that they were simulated by.
    pub fn conclude_mechanism(
        &self,
        driven: &ByDrive,
        tally: Tally<Vec<f64>>,
        product: Option<&Product>,
    ) -> Result<(), Failure> {
        let production = self.production_of(driven.mechanism(), product)?;
        mechanism::population::conclude(self, driven, &production, tally, None, product)
    }
}
