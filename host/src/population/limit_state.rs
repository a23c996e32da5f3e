//! Kinds of malfunction as limit states over independent standard normal scores: margins that change steadily with the unit.

use slipfit_system::interrupt;
use slipfit_tolerance::failure::Margins;

use super::{
    production::Production,
    subject::Subject,
    unit::{Decisive, Fault},
};
use crate::dynamics::{
    outcome::{JAMMED, OVERRUNS, RUNS},
    simulate::SimulateError,
};

pub use super::malfunction::{Kind, Side};

/// Speed, as a share of the command, below which units do not differ.
const STANDSTILL: f64 = 1e-9;

impl Kind {
    /// Below 0 where a unit malfunctions in this way; none if that is not known. Units that malfunction in another way must not rank
    /// before those that run because their speeds are close together: subsets would fill up with them, and never come to where this
    /// malfunction is.
    pub(super) fn margin(self, figures: &Decisive, limit: Option<f64>) -> Option<f64> {
        // 1 at full speed.
        let faster = |speed: f64| (speed - RUNS) / (1.0 - RUNS);
        // 1 at a share of 1/e of the limit, and far beyond 1 at standstill, where jammed units creep.
        let slower = |speed: f64| libm::log(JAMMED / speed.max(STANDSTILL));
        // 1 at standstill.
        let short_of_running = |speed: f64| (RUNS - speed) / RUNS;
        match self {
            Self::Crawls => figures.speed.map(|speed| faster(speed).max(slower(speed))),
            // A unit that runs backwards overruns.
            Self::Jams => figures.speed.map(|speed| (speed - JAMMED).max(-RUNS - speed)),
            Self::Overruns => figures.speed.map(|speed| (OVERRUNS - speed).min(speed + RUNS)),
            // 1 without any force.
            Self::OverLimit => {
                let left = 1.0 - figures.force? / limit?;
                Some(figures.speed.map_or(left, |speed| left.max(short_of_running(speed)).max(speed - OVERRUNS)))
            }
        }
    }
}

/// The limit state of one kind on one side.
pub struct LimitState<'a> {
    /// What the units are of.
    pub subject: &'a dyn Subject,
    /// What varies.
    pub production: &'a Production<'a>,
    /// How units malfunction.
    pub kind: Kind,
    /// Which units do.
    pub side: Side,
    /// A motor's force (N).
    pub limit: Option<f64>,
    /// What was found out so far.
    pub log: Log,
    /// The probability of the subset from which units are drawn now, over how many are.
    pub weight: f64,
}

/// What happened while margins were computed.
#[derive(Debug, Default)]
pub struct Log {
    /// Units that were simulated.
    pub simulated: u64,
    /// Those without a verdict.
    pub undecided: u64,
    /// Those whose parameters are out of bounds.
    pub out_of_bounds: u64,
    /// About the share of the production without a verdict, or out of bounds, as far as subsets contain it.
    pub unknown: f64,
    /// Why no more units were.
    pub error: Option<SimulateError>,
}

impl LimitState<'_> {
    fn found(&mut self, points: &[Vec<f64>]) -> Result<Vec<f64>, SimulateError> {
        if interrupt::requested() {
            return Err(SimulateError::Interrupted);
        }
        let mut margins = vec![f64::INFINITY; points.len()];
        let (drawn, made) = self.production.at(points);
        let asked: Vec<usize> =
            (0..points.len()).filter(|i| made[*i] && self.side.has(self.subject, &drawn.gaps[*i])).collect();
        for (i, figures) in asked.iter().zip(self.subject.decisive(&drawn, &asked)?) {
            self.log.simulated += 1;
            match figures.map(|figures| self.kind.margin(&figures, self.limit)) {
                Ok(Some(margin)) => {
                    margins[*i] = margin;
                    continue;
                }
                Err(Fault::OutOfBounds) => self.log.out_of_bounds += 1,
                Ok(None) | Err(Fault::Unsolved | Fault::Unassembled) => self.log.undecided += 1,
            }
            self.log.unknown += self.weight;
        }
        Ok(margins)
    }
}

impl Margins for LimitState<'_> {
    /// As many as keep the lanes of a pack busy while units end one by one.
    const TOGETHER: usize = 64;

    fn dimensions(&self) -> usize {
        self.production.scores()
    }

    fn enter(&mut self, probability: f64, points: usize) {
        self.weight = probability / points as f64;
    }

    /// After an error no unit malfunctions any more: the log tells.
    fn at(&mut self, points: &[Vec<f64>]) -> Vec<f64> {
        let found = if self.log.error.is_some() { Ok(Vec::new()) } else { self.found(points) };
        let mut margins = found.unwrap_or_else(|error| {
            self.log.error = Some(error);
            Vec::new()
        });
        margins.resize(points.len(), f64::INFINITY);
        margins
    }
}

#[cfg(test)]
mod tests {
    use super::{Kind, LimitState, Log, Side};
    use crate::{
        dynamics::{
            example,
            outcome::{JAMMED, RUNS},
        },
        population::{production::Production, unit::Decisive},
    };
    use slipfit_tolerance::failure::Margins;

    #[test]
    fn a_unit_malfunctions_in_one_way_only() {
        for speed in [-0.1, 0.0, 0.5 * JAMMED, 0.1, 0.49, 0.6, 1.0] {
            for force in [0.5, 1.5] {
                let figures = Decisive { speed: Some(speed), force: Some(force) };
                let below = |kind: Kind| kind.margin(&figures, Some(1.0)).unwrap() < 0.0;
                let kinds = [Kind::Crawls, Kind::Jams, Kind::OverLimit].map(below);
                let crawls = (JAMMED..RUNS).contains(&speed);
                assert_eq!(kinds, [crawls, speed < JAMMED, speed >= RUNS && force > 1.0], "{speed} {force}");
            }
        }
        let unknown = Decisive { speed: None, force: Some(2.0) };
        assert_eq!(Kind::Jams.margin(&unknown, Some(1.0)), None);
        assert_eq!(Kind::OverLimit.margin(&unknown, Some(1.0)), Some(-1.0));
    }

    /// Jammed units, which stand still, do not rank before running ones, whatever they malfunction by; those at the border do.
    #[test]
    fn units_that_malfunction_in_another_way_do_not_rank_first() {
        let margin = |kind: Kind, speed: f64, force: f64| {
            kind.margin(&Decisive { speed: Some(speed), force: Some(force) }, Some(1.0)).unwrap()
        };
        let standstill = 1e-5;
        for speed in [0.55, 0.7, 0.9] {
            assert!(margin(Kind::Crawls, speed, 0.2) < margin(Kind::Crawls, standstill, 0.9), "{speed}");
            assert!(margin(Kind::OverLimit, speed, 0.2) < margin(Kind::OverLimit, standstill, 0.9), "{speed}");
        }
        assert!(margin(Kind::Crawls, 0.99 * JAMMED, 0.2) < margin(Kind::Crawls, 0.6, 0.2));
        assert!(margin(Kind::OverLimit, 0.99 * RUNS, 1.1) < margin(Kind::OverLimit, 0.9, 0.9));
        // Without a command it moves backwards: as far as can be.
        assert!(margin(Kind::Crawls, -0.2, 0.2) > 1.0);
    }

    #[test]
    fn every_unit_is_on_one_side_and_undecided_ones_are_counted() {
        let scene = example::cd_rom();
        let production = Production::new(&scene, None, 0.0, 1).unwrap();
        let drawn = production.draw(0..200);
        let tight = drawn.gaps.iter().filter(|gaps| Side::Tight.has(&scene, gaps)).count();
        let loose = drawn.gaps.iter().filter(|gaps| Side::Loose.has(&scene, gaps)).count();
        assert!(tight + loose == 200 && tight > 70 && loose > 70);
        // The opening ends before the ramp does.
        let mut state = LimitState {
            subject: &scene,
            production: &production,
            kind: Kind::Jams,
            side: Side::Any,
            limit: None,
            log: Log::default(),
            weight: 0.0,
        };
        state.enter(0.5, 4);
        let margins = state.at(&vec![vec![0.0; production.scores()]; 3]);
        assert!(margins.iter().all(|margin| *margin == f64::INFINITY));
        assert_eq!((state.log.simulated, state.log.undecided, state.log.unknown), (3, 3, 0.375));
    }
}
