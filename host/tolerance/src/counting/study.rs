//! Drawing and measuring all units of a study, or a part of them.

use std::ops::Range;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{
    forest::Forest,
    tally::{Counts, Frame, Sums, TILE, Tile},
};
use crate::{
    model::Model,
    numeric::lanes::{LANES, Lanes},
    sampling::{
        draw::{Draw, DrawError},
        sampler::{Method, Sampler},
        sobol::{DIGITS, MOST_DIMENSIONS},
    },
};

/// Units whose sums are one leaf of the tree.
pub const BLOCK: u64 = 4096;
/// Units that find where a measure lies and how far it spreads before any are counted.
const PILOT: u64 = 256;
/// The same for measures that do not vary in those.
const LONG_PILOT: u64 = 1 << 16;
/// The most units of a study.
pub const MOST_UNITS: u64 = 1 << 40;

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Settings {
    /// How.
    pub method: Method,
    /// Units in all.
    pub samples: u64,
    /// Equal, independent designs that they are split into.
    pub replicates: u64,
    /// Seed of the production.
    pub seed: u64,
}

/// Why there is no study.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// Nothing can be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// Too few or too many units.
    #[error("{0} samples, allowed are 2 to {MOST_UNITS}")]
    Samples(u64),
    /// Units that cannot be split.
    #[error(
        "{samples} samples cannot be split into {replicates} replicates, allowed is a multiple of {replicates}, at least two each"
    )]
    Replicates {
        /// Units.
        samples: u64,
        /// Designs.
        replicates: u64,
    },
    /// More variables than Sobol' points have coordinates.
    #[error("the model has {0} variables, Sobol' points at most {MOST_DIMENSIONS}")]
    Dimensions(usize),
    /// More units than Sobol' points have values.
    #[error("{0} samples a replicate, Sobol' points at most 2^{DIGITS}")]
    SobolSamples(u64),
    /// A measure without statistics.
    #[error("`{measure}` can be computed in {computed} of {units} units, allowed is two or more")]
    Undefined {
        /// Its name.
        measure: String,
        /// Units in which it can be computed.
        computed: u64,
        /// Units of the replicate.
        units: u64,
    },
    /// Somebody asked to stop while results were worked out.
    #[error("interrupted")]
    Interrupted,
}

/// A model with all that it takes to draw any of its units.
pub struct Study<'a> {
    /// The model.
    pub model: &'a Model,
    /// What is drawn of it.
    pub settings: Settings,
    draw: Draw,
    sampler: Sampler,
    frames: Vec<Frame>,
}

/// What was found of one replicate, or of a part of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    /// What is counted.
    pub counts: Counts,
    /// Sums of its blocks.
    pub sums: Forest,
}

impl Settings {
    /// Units of a replicate.
    pub fn units(&self) -> u64 {
        self.samples / self.replicates
    }

    /// Blocks of a replicate; the last may be smaller.
    pub fn blocks_each(&self) -> u64 {
        self.units().div_ceil(BLOCK)
    }

    /// Blocks in all.
    pub fn blocks(&self) -> u64 {
        self.blocks_each() * self.replicates
    }

    /// Units of `blocks`.
    pub fn units_in(&self, blocks: &Range<u64>) -> u64 {
        blocks.clone().map(|block| self.block(block).2).map(|units| units.end - units.start).sum()
    }

    /// Replicate, number within it, and units of block `block`.
    fn block(&self, block: u64) -> (usize, u64, Range<u64>) {
        let (replicate, within) = (block / self.blocks_each(), block % self.blocks_each());
        let start = replicate * self.units() + within * BLOCK;
        (replicate as usize, within, start..(start + BLOCK).min((replicate + 1) * self.units()))
    }

    fn check(&self, dimensions: usize) -> Result<(), StudyError> {
        let Self { method, samples, replicates, .. } = *self;
        if !(2..=MOST_UNITS).contains(&samples) {
            return Err(StudyError::Samples(samples));
        }
        if replicates == 0 || !samples.is_multiple_of(replicates) || samples / replicates < 2 {
            return Err(StudyError::Replicates { samples, replicates });
        }
        if method == Method::ScrambledSobol {
            if dimensions > MOST_DIMENSIONS {
                return Err(StudyError::Dimensions(dimensions));
            }
            if self.units() > 1 << DIGITS {
                return Err(StudyError::SobolSamples(self.units()));
            }
        }
        Ok(())
    }
}

impl<'a> Study<'a> {
    /// Of `model` with `settings`.
    ///
    /// # Errors
    /// [`StudyError`], if the model cannot be drawn or the settings do not fit.
    pub fn new(model: &'a Model, settings: Settings) -> Result<Self, StudyError> {
        let draw = Draw::new(model, settings.seed)?;
        settings.check(draw.dimensions())?;
        let Settings { method, seed, replicates, .. } = settings;
        let sampler = Sampler::new(method, seed, draw.dimensions(), replicates, settings.units());
        let frames = vec![Frame { origin: 0.0, scale: 1.0 }; model.measures.len()];
        let mut study = Self { model, settings, draw, sampler, frames };
        study.frames = study.pilot();
        Ok(study)
    }

    /// Where the measures are seen from.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// The measures of the units from `first` on.
    pub fn unit_measures(&self, first: u64) -> Vec<Lanes> {
        let mut room = Room::new(self);
        room.work(self, &self.sampler, first);
        room.measures
    }

    /// Frames of every measure from a few pseudo-random units; from more, if one does not vary in these, as a gap that is
    /// rarely open.
    fn pilot(&self) -> Vec<Frame> {
        let few = self.frames_of(PILOT);
        if few.iter().all(|(_, varies)| *varies) {
            return few.into_iter().map(|(frame, _)| frame).collect();
        }
        let many = self.frames_of(LONG_PILOT);
        few.into_iter().zip(many).map(|((few, varies), (many, _))| if varies { few } else { many }).collect()
    }

    /// Frames of every measure from `units` pseudo-random units, and whether it varies in these.
    fn frames_of(&self, units: u64) -> Vec<(Frame, bool)> {
        let sampler = Sampler::new(Method::PseudoRandom, self.settings.seed, self.draw.dimensions(), 1, units);
        let mut room = Room::new(self);
        let mut values = vec![Vec::new(); self.model.measures.len()];
        for first in (0..units).step_by(LANES) {
            room.work(self, &sampler, first);
            for (values, measures) in values.iter_mut().zip(&room.measures) {
                values.extend(measures.0.iter().copied().filter(|value| value.is_finite()));
            }
        }
        let frame = |values: Vec<f64>| {
            let count = values.len().max(1) as f64;
            let origin = values.iter().sum::<f64>() / count;
            let square = values.iter().map(|value| (value - origin) * (value - origin)).sum::<f64>() / count;
            // What does not vary but for rounding is seen at the size of its own value.
            let least = 1e-12 * origin.abs();
            let scale = libm::sqrt(square);
            let varies = scale > least;
            let constant = if origin != 0.0 { origin.abs() } else { 1.0 };
            (Frame { origin, scale: if varies { scale } else { constant } }, varies)
        };
        values.into_iter().map(frame).collect()
    }

    /// One empty tally a replicate.
    pub fn empty(&self) -> Vec<Tally> {
        let tally = Tally { counts: Counts::new(self.model), sums: Forest::default() };
        vec![tally; self.settings.replicates as usize]
    }

    /// Works through `blocks` on all threads of the current pool and adds them to `tallies`, one a replicate; the
    /// result does not depend on the number of threads. `done` is called with the units of every block.
    pub fn add(&self, blocks: Range<u64>, tallies: &mut [Tally], done: impl Fn(u64) + Sync) {
        // Long pieces, because every one has histograms of its own.
        let threads = rayon::current_num_threads() as u64;
        let piece = (blocks.end - blocks.start).div_ceil(4 * threads).max(1);
        let pieces: Vec<_> =
            blocks.clone().step_by(piece as usize).map(|start| start..(start + piece).min(blocks.end)).collect();
        let parts: Vec<_> = pieces
            .into_par_iter()
            .map(|blocks| {
                let (mut part, mut room) = (self.empty(), Room::new(self));
                for block in blocks {
                    done(self.work(block, &mut part, &mut room));
                }
                part
            })
            .collect();
        for part in &parts {
            join(tallies, part);
        }
    }

    /// Draws, measures and adds a block; returns its units.
    fn work(&self, block: u64, tallies: &mut [Tally], room: &mut Room) -> u64 {
        let (replicate, within, units) = self.settings.block(block);
        let tally = &mut tallies[replicate];
        let mut sums = Sums::new(self.model.measures.len());
        let mut tile = Tile::new(self.model, &self.frames);
        for start in units.clone().step_by(TILE) {
            let end = (start + TILE as u64).min(units.end);
            for (group, first) in (start..end).step_by(LANES).enumerate() {
                room.work(self, &self.sampler, first);
                for (row, measures) in tile.rows().iter_mut().zip(&room.measures) {
                    row[group * LANES..][..LANES].copy_from_slice(&measures.0);
                }
            }
            tile.add_to((end - start) as usize, &mut sums, &mut tally.counts);
        }
        tally.sums.insert(within, 0, sums);
        units.end - units.start
    }
}

/// Adds the tallies of another part of a study.
pub fn join(tallies: &mut [Tally], part: &[Tally]) {
    for (tally, part) in tallies.iter_mut().zip(part) {
        tally.counts.join(&part.counts);
        for (first, height, sums) in part.sums.nodes() {
            tally.sums.insert(first, height, sums.clone());
        }
    }
}

/// Numbers of the units at work.
struct Room {
    bits: Vec<[u64; LANES]>,
    variables: Vec<Lanes>,
    measures: Vec<Lanes>,
}

impl Room {
    fn new(study: &Study) -> Self {
        let dimensions = study.draw.dimensions();
        Self {
            bits: vec![[0; LANES]; dimensions],
            variables: vec![Lanes::ZERO; dimensions],
            measures: vec![Lanes::ZERO; study.model.measures.len()],
        }
    }

    fn work(&mut self, study: &Study, sampler: &Sampler, first: u64) {
        sampler.fill(first, &mut self.bits);
        study.draw.variables(first, &self.bits, &mut self.variables);
        study.model.function.evaluate(&self.variables, &mut self.measures);
    }
}
