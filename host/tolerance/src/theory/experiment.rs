//! Designed experiments: a few units at chosen values instead of many random ones.
//!
//! Factors are variables at two or three levels: scalars at their limits (and the middle between), variables of a zone
//! at ±1/3 (and 0), of a disc at ±1/√2, so that all corners of the design lie on the zone's boundary; place and tilts of an axis at
//! ±1/(2√2), so that none leaves it. Tilts that another tolerance narrows further leave the rest to the place. Orthogonal arrays are
//! Taguchi's: L4, L8, … of strength 2 for two levels, L9, L27, … for three; columns are the linear functions of the run's digits.

use std::f64::consts::FRAC_1_SQRT_2;

use serde::Serialize;

use super::derivative::evaluate;
use crate::model::{Distribution, Model, Variation};

/// Which runs are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Design {
    /// All combinations of two levels.
    FullFactorial,
    /// The smallest two-level array with enough columns: L4, L8, L16, L32, …
    TwoLevel,
    /// The smallest three-level array with enough columns: L9, L27, L81, …
    ThreeLevel,
}

/// Why an experiment is not made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DesignError {
    /// Too many runs.
    #[error("{0} factors at two levels are 2^{0} runs, allowed are {MOST_FACTORS} factors; take an orthogonal array")]
    TooLarge(usize),
}

/// The most factors of a full factorial.
pub const MOST_FACTORS: usize = 16;

/// What an experiment finds of one measure (SI). Where it cannot be computed in some runs, there is no mean, and there are no effects nor
/// shares: not a number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Runs in which it cannot be computed.
    pub undefined: usize,
    /// Mean of all runs.
    pub mean: f64,
    /// Least and greatest of all runs.
    pub range: [f64; 2],
    /// Of each factor: mean at its highest level minus mean at its lowest.
    pub effects: Vec<f64>,
    /// Share of each factor in the sum of squares of all factors.
    pub shares: Vec<f64>,
}

/// An experiment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Experiment {
    /// Runs made.
    pub runs: usize,
    /// The contributor of each factor.
    pub factors: Vec<String>,
    /// Of each measure.
    pub findings: Vec<Finding>,
}

/// Makes the experiment.
///
/// # Errors
/// [`DesignError`], if it were too large.
pub fn experiment(model: &Model, design: Design) -> Result<Experiment, DesignError> {
    let mut centre = Vec::new();
    let mut factors: Vec<(usize, f64, String)> = Vec::new();
    for contributor in &model.contributors {
        match &contributor.variation {
            Variation::Scalar { distribution: Distribution::Constant(value), .. } => centre.push(*value),
            Variation::Scalar { limits: [low, high], .. } => {
                factors.push((centre.len(), 0.5 * (high - low), contributor.name.clone()));
                centre.push(0.5 * (low + high));
            }
            zone @ (Variation::Zone(_) | Variation::Disc(_) | Variation::Nested(_)) => {
                let count = zone.variables();
                for k in 0..count {
                    let half = match zone {
                        Variation::Disc(_) => FRAC_1_SQRT_2,
                        Variation::Nested(zone) => zone.factorial()[usize::from(k >= zone.places())],
                        _ => 1.0 / count as f64,
                    };
                    factors.push((centre.len(), half, format!("{} {}", contributor.name, k + 1)));
                    centre.push(0.0);
                }
            }
        }
    }
    let (levels, rows) = rows(design, factors.len())?;
    let place = |level: usize| 2.0 * level as f64 / (levels - 1) as f64 - 1.0;
    let point = |row: &Vec<usize>| {
        let mut point = centre.clone();
        factors.iter().zip(row).for_each(|((at, half, _), level)| point[*at] += half * place(*level));
        point
    };
    let values = evaluate(model, &rows.iter().map(point).collect::<Vec<_>>());
    let finding = |i: usize| {
        let runs = rows.len() as f64;
        let mean = values.iter().map(|value| value[i]).sum::<f64>() / runs;
        let at = |factor: usize, level: usize| {
            let here = rows.iter().zip(&values).filter(|(row, _)| row[factor] == level);
            here.map(|(_, value)| value[i]).sum::<f64>() * levels as f64 / runs
        };
        let squares: Vec<f64> = (0..factors.len())
            .map(|factor| (0..levels).map(|level| at(factor, level) - mean).map(|d| d * d).sum::<f64>())
            .collect();
        let total: f64 = squares.iter().sum();
        let extreme = |of: fn(f64, f64) -> f64, start| values.iter().map(|value| value[i]).fold(start, of);
        Finding {
            undefined: values.iter().filter(|value| !value[i].is_finite()).count(),
            mean,
            range: [extreme(f64::min, f64::INFINITY), extreme(f64::max, f64::NEG_INFINITY)],
            effects: (0..factors.len()).map(|factor| at(factor, levels - 1) - at(factor, 0)).collect(),
            shares: squares.iter().map(|square| if total == 0.0 { 0.0 } else { square / total }).collect(),
        }
    };
    Ok(Experiment {
        runs: rows.len(),
        findings: (0..model.measures.len()).map(finding).collect(),
        factors: factors.into_iter().map(|(_, _, name)| name).collect(),
    })
}

/// Number of levels, and the level of every factor in every run.
fn rows(design: Design, factors: usize) -> Result<(usize, Vec<Vec<usize>>), DesignError> {
    let levels = if design == Design::ThreeLevel { 3 } else { 2 };
    if design == Design::FullFactorial {
        if factors > MOST_FACTORS {
            return Err(DesignError::TooLarge(factors));
        }
        return Ok((levels, (0..1 << factors).map(|run| (0..factors).map(|k| run >> k & 1).collect()).collect()));
    }
    // Runs are all words of that many digits; the array has (runs − 1)/(levels − 1) columns.
    let (mut digits, mut runs) = (2, levels * levels);
    while (runs - 1) / (levels - 1) < factors {
        digits += 1;
        runs *= levels;
    }
    let word = |number: usize| -> Vec<usize> {
        let places = std::iter::successors(Some(number), |left| Some(left / levels));
        places.take(digits).map(|left| left % levels).collect()
    };
    // Of the words that are multiples of each other one: that whose first digit other than 0 is 1.
    let columns: Vec<Vec<usize>> =
        (1..runs).map(word).filter(|word| word.iter().find(|digit| **digit > 0) == Some(&1)).take(factors).collect();
    let level =
        |run: &Vec<usize>, column: &Vec<usize>| run.iter().zip(column).map(|(a, b)| a * b).sum::<usize>() % levels;
    let row = |run| columns.iter().map(|column| level(&run, column)).collect();
    Ok((levels, (0..runs).map(word).map(row).collect()))
}

#[cfg(test)]
mod tests {
    use super::{Design, DesignError, experiment, rows};
    use crate::examples::{MM, chain, clutch, normals};

    #[test]
    fn arrays_are_orthogonal_and_of_taguchi_s_sizes() {
        for (design, factors, runs) in [
            (Design::TwoLevel, 3, 4),
            (Design::TwoLevel, 7, 8),
            (Design::TwoLevel, 15, 16),
            (Design::TwoLevel, 31, 32),
            (Design::ThreeLevel, 4, 9),
            (Design::ThreeLevel, 13, 27),
            (Design::FullFactorial, 5, 32),
        ] {
            let (levels, rows) = rows(design, factors).unwrap();
            assert_eq!(rows.len(), runs);
            for one in 0..factors {
                for other in 0..one {
                    for pair in 0..levels * levels {
                        let here = rows.iter().filter(|row| row[one] + levels * row[other] == pair).count();
                        assert_eq!(here * levels * levels, runs, "{design:?} {one} {other}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_factorial_at_the_limits_finds_the_worst_case() {
        for (design, runs) in [(Design::FullFactorial, 128), (Design::TwoLevel, 8), (Design::ThreeLevel, 27)] {
            let experiment = experiment(&chain(), design).unwrap();
            assert_eq!(experiment.runs, runs);
            let finding = &experiment.findings[0];
            assert!((finding.mean - 0.4 * MM).abs() < 1e-12);
            for (effect, tolerance) in finding.effects.iter().zip([0.036, -0.03, -0.06, 0.026, -0.145, 0.026, -0.06]) {
                assert!((effect - 2.0 * tolerance * MM).abs() < 1e-12, "{design:?} {effect}");
            }
            if design == Design::FullFactorial {
                assert!((finding.range[0] - 0.017 * MM).abs() < 1e-12 && (finding.range[1] - 0.783 * MM).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn shares_are_those_of_the_variance() {
        let finding = experiment(&clutch(), Design::FullFactorial).unwrap().findings[0].clone();
        for (share, percent) in finding.shares.iter().zip([81.942, 13.013, 5.045]) {
            assert!((share * 100.0 - percent).abs() < 0.2, "{share}");
        }
        assert_eq!(experiment(&normals(&[1.0; 17]), Design::FullFactorial).err(), Some(DesignError::TooLarge(17)));
    }
}
