//! What the full model says of the tolerances, beside what the root of the sum of squares says.

use super::{
    AllocateError,
    requirement::{Kind, Requirement},
};
use crate::{
    analysis::analyse,
    counting::study::Settings,
    model::Model,
    numeric::normal,
    sampling::sampler::Method,
    statistics::{binomial, estimate::Estimate},
};

/// A measure with limits (SI; probabilities as shares).
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// Which measure.
    pub measure: usize,
    /// Lowest and highest.
    pub worst_case: [f64; 2],
    /// Root of the sum of squares, where slopes describe the measure.
    pub rss: Option<f64>,
    /// Share outside if that were three standard deviations of a normal in the middle of the limits.
    pub by_rss: Option<f64>,
    /// Share outside by importance sampling or subset simulation, where each limit has a figure to be trusted; and its
    /// standard error.
    pub by_tails: Option<[f64; 2]>,
    /// Counted units below and above, and those in which it cannot be computed.
    pub counted: u64,
    /// The 95 % interval of their share.
    pub interval: [f64; 2],
    /// Of drawn units.
    pub ppk: Option<Estimate>,
}

/// All measures with limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// One a measure.
    pub measures: Vec<Checked>,
    /// Units that were drawn.
    pub units: u64,
    /// Share of units with all measures within their limits.
    pub good: Option<Estimate>,
}

/// See [`Check::contradicts`].
const UNLIKELY: f64 = 1e-3;

impl Check {
    /// The first of some `requirements` on shares of units that the counted ones speak against, and how many of these are outside: as many
    /// have a chance of a thousandth at most where the requirement is met.
    pub fn contradicts<'a>(&self, requirements: &'a [Requirement]) -> Option<(&'a Requirement, u64)> {
        requirements.iter().find_map(|requirement| {
            let Kind::Defects(allowed) = requirement.kind else { return None };
            let outside = match requirement.measure {
                Some(measure) => self.measures.iter().find(|checked| checked.measure == measure)?.counted,
                None => ((1.0 - self.good?.value) * self.units as f64).round() as u64,
            };
            let [least, _] = binomial::limits(outside, self.units, UNLIKELY);
            (least > allowed).then_some((requirement, outside))
        })
    }
}

/// Draws `units` units of `model`.
///
/// # Errors
/// [`AllocateError`], if it cannot be drawn.
pub fn check(model: &Model, units: u64, seed: u64) -> Result<Check, AllocateError> {
    let settings = Settings { method: Method::PseudoRandom, samples: units, replicates: 1, seed };
    let found = analyse(model, settings, |_| ())?;
    let limited = (0..model.measures.len()).filter(|i| model.measures[*i].limits.iter().any(Option::is_some));
    let of = |i: usize| {
        let (statistics, worst) = (&found.joint.measures[i], &found.theory.worst_cases[i]);
        let limits = model.measures[i].limits;
        let rss = found.theory.moments[i].by_slopes().then(|| &found.theory.sums_of_squares[i]);
        let by_rss = rss.map(|rss| {
            let sides = |distance: f64| normal::tail(3.0 * distance / rss.tolerance);
            match limits {
                [Some(lower), Some(upper)] => 2.0 * sides(0.5 * (upper - lower)),
                [Some(lower), None] => sides(rss.middle - lower),
                [None, Some(upper)] => sides(upper - rss.middle),
                [None, None] => 0.0,
            }
        });
        let tails = limits.iter().zip(&found.theory.tails[i]).filter(|(limit, _)| limit.is_some());
        let by_tails = tails.map(|(_, tail)| tail.as_ref()).try_fold([0.0, 0.0], |[sum, error], tail| {
            tail.map(|tail| [sum + tail.probability, libm::hypot(error, tail.error)])
        });
        // What cannot be computed is outside.
        let undefined = statistics.undefined as f64 / units as f64;
        let by_tails = by_tails.map(|[sum, error]| {
            [sum + undefined, libm::hypot(error, libm::sqrt(undefined * (1.0 - undefined) / units as f64))]
        });
        let counted = statistics.outside_counts(0).0 + statistics.outside_counts(1).0 + statistics.undefined;
        Checked {
            measure: i,
            worst_case: worst.range,
            rss: rss.map(|rss| rss.tolerance),
            by_rss,
            by_tails,
            counted,
            interval: crate::statistics::interval::proportion(counted, units),
            ppk: statistics.ppk,
        }
    };
    Ok(Check { measures: limited.map(of).collect(), units, good: found.joint.good })
}

#[cfg(test)]
mod tests {
    use super::{Check, Checked, Estimate, Kind, Requirement};

    fn check(counted: u64, good: f64) -> Check {
        let measure = Checked {
            measure: 3,
            worst_case: [0.0, 0.0],
            rss: None,
            by_rss: None,
            by_tails: None,
            counted,
            interval: [0.0, 1.0],
            ppk: None,
        };
        let good = Some(Estimate { value: good, error: None, interval: [None; 2] });
        Check { measures: vec![measure], units: 1_000_000, good }
    }

    /// With 1 in a million allowed 5 of a million have a chance of 0.0037, 6 of 0.0006 (Poisson).
    #[test]
    fn counted_units_speak_against_a_requirement_beyond_chance() {
        let allowed = |measure| [Requirement { measure, kind: Kind::Defects(1e-6) }];
        for (counted, speaks) in [(0, false), (1, false), (5, false), (6, true), (100, true)] {
            let of_one = check(counted, 0.0);
            assert_eq!(of_one.contradicts(&allowed(Some(3))).map(|(_, outside)| outside), speaks.then_some(counted));
            let of_all = check(0, 1.0 - counted as f64 * 1e-6);
            assert_eq!(of_all.contradicts(&allowed(None)).map(|(_, outside)| outside), speaks.then_some(counted));
        }
        assert!(check(100, 0.0).contradicts(&[Requirement { measure: Some(3), kind: Kind::Ppk(1.0) }]).is_none());
    }
}
