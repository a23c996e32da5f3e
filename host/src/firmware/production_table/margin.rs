//! How much more friction the units of a production stand.

use slipfit_system::parallel;

use crate::{
    dynamics::simulate::SimulateError,
    population::{production::Production, subject::Subject},
};

/// Units whose friction is raised until they do not complete their stroke.
pub const UNITS: u64 = 400;

/// By what shares it is raised: whole percents, up to twice itself.
const RISES: usize = 100;
const RISE: f64 = 0.01;

/// The greatest margin: there may be more.
pub const MARGIN_MOST: f64 = RISES as f64 * RISE;

/// The rise of the friction with which one in a hundred units does not complete its stroke any more; the greatest that is tried if fewer do
/// not.
pub fn margin(
    subject: &dyn Subject,
    production: &Production,
    chosen: &[u64],
    period: f64,
    done: &(impl Fn() + Sync),
) -> Result<f32, SimulateError> {
    let step = chosen.len().div_ceil(UNITS as usize);
    let few: Vec<u64> = chosen.iter().step_by(step).copied().collect();
    let mut found = parallel::try_map(&few, |number| {
        let (drawn, i) = production.draw_one(*number);
        let completes = |rise: usize| {
            let friction = RISE * rise as f64;
            match subject.stroke(&drawn, i, friction, period.max(1e-2)) {
                Ok(stroke) => Ok(stroke.is_complete()),
                Err(interrupted @ SimulateError::Interrupted) => Err(interrupted),
                Err(_) => Ok(false),
            }
        };
        // Half and half: what does not complete with some friction does not with more.
        let (mut good, mut bad) = (0, RISES + 1);
        while bad - good > 1 {
            let middle = usize::midpoint(good, bad);
            if completes(middle)? { good = middle } else { bad = middle }
        }
        done();
        Ok::<_, SimulateError>(bad)
    })?;
    found.sort_unstable();
    let first = found.get(found.len() / 100).copied().unwrap_or(RISES);
    Ok((RISE * first.min(RISES) as f64) as f32)
}
