//! Parts of a population, by the files and runs of tolerance studies.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use slipfit_tolerance::counting::file::{FormatError, Found, Reader, integer};

use super::{
    Unit,
    kept::Outcomes,
    ranked::Ranked,
    tally::{Tally, VERDICTS},
    unit::{FAULTS, UnitOutcome},
};
use crate::dynamics::outcome::Moment;

/// Units of a block.
const BLOCK: u64 = 512;

/// What a population of a scene is made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Settings {
    /// Units in all.
    pub units: u64,
    /// Seed of the production.
    pub seed: u64,
    /// Whether the opening is simulated, not the stroke.
    pub opening: bool,
    /// Bits of the correlation of gaps: text would round them.
    correlation: u64,
    /// Bits of a motor's force (N).
    limit: Option<u64>,
    /// Which of the drives of a mechanism, from 0 on.
    drive: usize,
}

impl Settings {
    /// Of `units` of the production `seed`, with the `correlation` of gaps and a motor's force `limit` (N), by the first drive.
    pub fn new(units: u64, seed: u64, opening: bool, correlation: f64, limit: Option<f64>) -> Self {
        let (correlation, limit) = (correlation.to_bits(), limit.map(f64::to_bits));
        Self { units, seed, opening, correlation, limit, drive: 0 }
    }

    /// The same by the `drive` of that number of a mechanism, from 0 on.
    pub fn by_drive(self, drive: usize) -> Self {
        Self { drive, ..self }
    }

    /// Which of the drives of a mechanism, from 0 on.
    pub fn drive(&self) -> usize {
        self.drive
    }

    /// Correlation of any two gaps.
    pub fn correlation(&self) -> f64 {
        f64::from_bits(self.correlation)
    }

    /// A motor's force (N).
    pub fn limit(&self) -> Option<f64> {
        self.limit.map(f64::from_bits)
    }

    /// Units of `blocks`.
    pub fn units_in(&self, blocks: &Range<u64>) -> Range<u64> {
        blocks.start * BLOCK..(blocks.end * BLOCK).min(self.units)
    }
}

impl Found for Tally {
    type Settings = Settings;
    const MAGIC: &'static [u8; 8] = b"SLIPUTAL";

    fn blocks(settings: &Settings) -> u64 {
        settings.units.div_ceil(BLOCK)
    }

    fn difference(one: &Settings, other: &Settings) -> Option<&'static str> {
        if one.seed != other.seed {
            Some("seed")
        } else if one.units != other.units {
            Some("number of units")
        } else if one.opening != other.opening {
            Some("length")
        } else if one.correlation != other.correlation {
            Some("correlation")
        } else if one.drive != other.drive {
            Some("drive")
        } else {
            (one.limit != other.limit).then_some("force limit")
        }
    }

    fn units(&self) -> u64 {
        self.counts.units
    }

    /// Whatever the scene, as much is kept.
    fn fits(&self, _: &Self) -> bool {
        true
    }

    fn join(&mut self, other: Self) {
        self.join(other);
    }

    /// Counts, figures, outcomes, then units: the worst, and the first of each verdict.
    fn encode(&self, out: &mut Vec<u8>) {
        let mut counts = self.counts.clone();
        counts.each().for_each(|count| integer(out, *count));
        integer(out, counts.pressed.len() as u64);
        counts.pressed.iter().for_each(|count| integer(out, *count));
        self.figures.each().into_iter().for_each(|figure| figure.encode(out));
        self.outcomes.encode(out);
        for units in [&self.worst].into_iter().chain(&self.first) {
            integer(out, units.len() as u64);
            units.iter().for_each(|unit| encode(unit, out));
        }
    }

    fn decode(reader: &mut Reader) -> Result<Self, FormatError> {
        let mut found = Self::new();
        for count in found.counts.each() {
            *count = reader.integer()?;
        }
        found.counts.pressed = (0..reader.count()?).map(|_| reader.integer()).collect::<Result<_, _>>()?;
        for figure in found.figures.each_mut() {
            *figure = Ranked::decode(reader)?;
        }
        found.outcomes = Outcomes::decode(reader)?;
        for units in [&mut found.worst].into_iter().chain(&mut found.first) {
            *units = (0..reader.count()?).map(|_| unit(reader)).collect::<Result<_, _>>()?;
        }
        Ok(found)
    }
}

/// Adds the bytes of a unit: number, verdict, whether the desk computed it, fault (3 if none), breakaway, peak and settled force, final speed, end,
/// how many gaps, which of them is pressed in deepest (that many if none), the force there, gaps. NaN is none.
fn encode(Unit { number, gaps, outcome }: &Unit, out: &mut Vec<u8>) {
    integer(out, *number);
    let verdict = VERDICTS.iter().position(|verdict| *verdict == outcome.verdict).unwrap_or(VERDICTS.len() - 1);
    let (contact, force) = outcome.most_loaded.unwrap_or((gaps.len(), 0.0));
    let fault = FAULTS.iter().position(|fault| Some(*fault) == outcome.fault).unwrap_or(FAULTS.len());
    out.extend([verdict as u8, u8::from(outcome.at_desk), fault as u8]);
    let optional = [outcome.breakaway, outcome.peak_force, outcome.settled_force];
    let figures = optional.map(|figure| figure.unwrap_or(f64::NAN)).into_iter();
    let numbers = figures.chain([outcome.final_velocity, outcome.end.t, outcome.end.z]);
    numbers.for_each(|number| out.extend(number.to_le_bytes()));
    [gaps.len(), contact].into_iter().for_each(|count| integer(out, count as u64));
    [force].iter().chain(gaps).for_each(|number| out.extend(number.to_le_bytes()));
}

fn unit(reader: &mut Reader) -> Result<Unit, FormatError> {
    let number = reader.integer()?;
    let [verdict, at_desk, fault] = reader.array()?;
    let verdict = *VERDICTS.get(usize::from(verdict)).ok_or(FormatError::Damaged)?;
    let mut optional = || Ok(Some(reader.number()?).filter(|figure| !figure.is_nan()));
    let (breakaway, peak_force, settled_force) = (optional()?, optional()?, optional()?);
    let final_velocity = reader.number()?;
    let end = Moment { t: reader.number()?, z: reader.number()? };
    let (count, contact) = (reader.count()?, reader.integer()?);
    let force = reader.number()?;
    let gaps: Vec<f64> = (0..count).map(|_| reader.number()).collect::<Result<_, _>>()?;
    let most_loaded = match contact {
        none if none == gaps.len() as u64 => None,
        contact if contact < gaps.len() as u64 => Some((contact as usize, force)),
        _ => return Err(FormatError::Damaged),
    };
    let (at_desk, fault) = (at_desk != 0, FAULTS.get(usize::from(fault)).copied());
    let outcome =
        UnitOutcome { verdict, breakaway, peak_force, settled_force, final_velocity, end, most_loaded, at_desk, fault };
    Ok(Unit { number, gaps, outcome })
}

#[cfg(test)]
mod tests {
    use super::Settings;
    use crate::{
        dynamics::example,
        population::{
            production::Production,
            simulation::Simulation,
            tally::{Counter, Duty, Tally},
        },
    };
    use slipfit_tolerance::counting::{
        file::{Found, Source},
        run::{Keep, RunError, Shard, merge, run},
    };

    #[test]
    fn shards_in_any_order_are_the_whole() {
        // With units that have no run.
        let scene = example::of_uncertain_friction();
        let production = Production::new(&scene, None, 0.25, 5).unwrap();
        let settings = Settings::new(1100, 5, true, 0.25, Some(0.3));
        let counter = Counter::new(&scene, Duty { limit: settings.limit(), stroke: None });
        let simulation = Simulation { subject: &scene, production: &production, settings, counter, listener: None };
        let source = Source { name: "cd-rom".into(), text: "its text".into(), set: Vec::new(), measured: None };
        let folder = tempfile::tempdir().unwrap();
        let path = |name: String| folder.path().join(name);
        let shard = |out: &std::path::Path, shard: Shard, resume: bool| {
            run(&simulation, &source, shard, Some(&Keep { out, resume }), |_| ())
        };
        let whole = path("whole".into());
        let units = shard(&whole, Shard::ALL, false).unwrap();
        assert_eq!(units.counts.units, 1100);
        assert!(units.counts.faults.iter().sum::<u64>() > 0);
        let parts: Vec<_> = (1..=3).map(|number| path(format!("part{number}"))).collect();
        for (number, out) in (1..).zip(&parts) {
            shard(out, Shard { number, count: 3 }, false).unwrap();
        }
        for order in [[0, 1, 2], [2, 0, 1]] {
            let merged = merge::<Tally>(&order.map(|i: usize| parts[i].clone())).unwrap();
            assert_eq!(merged.encode().unwrap(), std::fs::read(&whole).unwrap());
            assert_eq!(merged.tallies, units);
        }
        // What is done is not done again; what is damaged or of other settings is refused.
        assert_eq!(shard(&whole, Shard::ALL, true).unwrap(), units);
        let mut bytes = std::fs::read(&parts[1]).unwrap();
        bytes.truncate(bytes.len() / 2);
        std::fs::write(&parts[1], bytes).unwrap();
        assert!(matches!(merge::<Tally>(&parts), Err(RunError::Format { .. })));
        let other = Settings::new(1100, 5, true, 0.25, None);
        assert_eq!(Tally::difference(&settings, &other), Some("force limit"));
        assert_eq!((settings.correlation(), settings.limit()), (0.25, Some(0.3)));
    }
}
