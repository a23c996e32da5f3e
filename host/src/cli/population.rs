//! `slipfit population`: what every unit of a production does.

pub(super) mod asked;
mod conclude;
pub(super) mod page;
pub(super) mod rare;
pub(super) mod reports;
mod rows;
pub(super) mod uncertain;
pub(super) mod words;

use super::{by_one_drive::ByOneDrive, failure::Failure};

pub(super) use asked::Arguments;

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        if !(-1.0..=1.0).contains(&self.correlation) {
            return Err(Failure::Input(format!("--correlation {}: allowed is -1 to 1", self.correlation)));
        }
        if let Some(limit) = self.force_limit.filter(|limit| !(limit.is_finite() && *limit > 0.0)) {
            return Err(Failure::Input(format!("--force-limit {limit}: allowed is more than 0 N")));
        }
        let (mut moving, product) = self.scene.load_moving_with_product(&[])?;
        self.set_length(&mut moving)?;
        let of = ByOneDrive::new(&moving, &self.drive)?;
        let design = self.design(of.has_unknowns())?;
        let production = of.production(product.as_ref(), self.correlation, self.seed)?;
        let (duty, bar) = (self.duty_of(of.subject()), self.bar(design));
        let Some(tally) = self.simulated(of.subject(), &production, duty, of.drive(), &bar)? else { return Ok(()) };
        let answer = |design| self.threads.install(|| of.answer(&production, design, duty, |units| bar.inc(units)));
        let unknown = design.map(answer).transpose()?.transpose()?;
        bar.finish_and_clear();
        self.conclude(&of, &production, tally, unknown, product.as_ref())
    }
}
