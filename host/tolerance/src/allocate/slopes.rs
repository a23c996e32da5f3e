//! How figures grow with tolerances: each is taken for a constant and a weighted sum of powers of the tolerances.

use slipfit_system::parallel;

use super::{
    AllocateError,
    figures::{Figures, Slopes},
    program::Power,
};

/// Sweeps of the least squares.
const SWEEPS: usize = 1000;
/// A change of a weight (share of the greatest) that no longer counts.
const STILL: f64 = 1e-10;

/// The weights of all tolerances in every figure (one list a figure, one weight a tolerance, 1/SI to the figure's power), around
/// `at` (SI); where the design moves them tolerances stay within `ends` (SI).
///
/// # Errors
/// [`AllocateError`], where a figure cannot be had.
pub fn weights(
    slopes: Slopes,
    at: &[f64],
    ends: &[[f64; 2]],
    figures: &dyn Figures,
) -> Result<Vec<Vec<f64>>, AllocateError> {
    match slopes {
        Slopes::Differences(step) => of_differences(step, at, figures),
        Slopes::Design(factor) => of_design(factor, at, ends, figures),
    }
}

fn of_differences(step: f64, at: &[f64], figures: &dyn Figures) -> Result<Vec<Vec<f64>>, AllocateError> {
    let moved: Vec<(usize, f64)> = (0..at.len()).flat_map(|item| [(item, 1.0 - step), (item, 1.0 + step)]).collect();
    let values = parallel::try_map(&moved, |(item, factor)| {
        let mut tolerances = at.to_vec();
        tolerances[*item] *= factor;
        figures.values(&tolerances)
    })?;
    let powers = figures.powers();
    let weight = |row: usize, item: usize| {
        let [low, high] = [2 * item, 2 * item + 1].map(|point| values[point][row]);
        let [tight, wide] = [1.0 - step, 1.0 + step].map(|factor| powers[row].of(factor * at[item]));
        // A tolerance that lowers a figure, by rounding or by a shift of the mean, counts as without effect.
        ((high - low) / (wide - tight)).max(0.0)
    };
    Ok((0..powers.len()).map(|row| (0..at.len()).map(|item| weight(row, item)).collect()).collect())
}

/// Every run of a two-level orthogonal array moves all tolerances, and another run each of them the other way (fold-over), so
/// that no pair of tolerances that act together passes for a third. With r runs a weight errs by √(2/r) of what the
/// difference of two runs would err by (Box, Hunter and Hunter, Statistics for Experimenters, chapters 5 and 6). Weights are
/// those of least squares that are not negative.
fn of_design(
    factor: f64,
    at: &[f64],
    ends: &[[f64; 2]],
    figures: &dyn Figures,
) -> Result<Vec<Vec<f64>>, AllocateError> {
    let runs = (at.len() + 1).next_power_of_two();
    let mut points = Vec::with_capacity(2 * runs);
    for (run, fold) in (0..runs).flat_map(|run| [(run, 0), (run, 1)]) {
        let up = |item: usize| ((run & (item + 1)).count_ones() + fold) % 2 == 1;
        let moved = |(item, (t, [low, high])): (usize, (&f64, &[f64; 2]))| {
            (if up(item) { t * factor } else { t / factor }).clamp(*low, *high)
        };
        points.push(at.iter().zip(ends).enumerate().map(moved).collect::<Vec<f64>>());
    }
    let mut values = Vec::with_capacity(points.len());
    for point in &points {
        values.push(figures.values(point)?);
    }
    let of_row = |(row, power): (usize, &Power)| {
        let observed: Vec<f64> = values.iter().map(|values| values[row]).collect();
        let regressors: Vec<Vec<f64>> =
            points.iter().map(|point| point.iter().map(|t| power.of(*t)).collect()).collect();
        least_squares(&regressors, &observed)
    };
    Ok(figures.powers().iter().enumerate().map(of_row).collect())
}

/// The weights, not negative, of the columns of `rows` that with a constant come nearest to what was `observed`; by
/// coordinate descent. Runs without a finite figure are left out; large figures count less, as they scatter more.
fn least_squares(rows: &[Vec<f64>], observed: &[f64]) -> Vec<f64> {
    let columns = rows.first().map_or(0, Vec::len);
    let used: Vec<(&Vec<f64>, f64, f64)> = rows
        .iter()
        .zip(observed)
        .filter(|(_, y)| y.is_finite())
        .map(|(row, y)| (row, *y, 1.0 / (1.0 + y * y)))
        .collect();
    let total: f64 = used.iter().map(|(_, _, share)| share).sum();
    let mean = |of: &dyn Fn(&Vec<f64>, f64) -> f64| {
        used.iter().map(|(row, y, share)| share * of(row, *y)).sum::<f64>() / total
    };
    let means: Vec<f64> = (0..columns).map(|k| mean(&|row, _| row[k])).collect();
    let middle = mean(&|_, y| y);
    let square: Vec<f64> = (0..columns)
        .map(|k| used.iter().map(|(row, _, share)| share * (row[k] - means[k]) * (row[k] - means[k])).sum())
        .collect();
    let mut left: Vec<f64> = used.iter().map(|(_, y, _)| y - middle).collect();
    let mut weights = vec![0.0; columns];
    for _ in 0..SWEEPS {
        let mut changed: f64 = 0.0;
        for k in 0..columns {
            if square[k] <= 0.0 {
                continue;
            }
            let slope: f64 =
                used.iter().zip(&left).map(|((row, _, share), left)| share * (row[k] - means[k]) * left).sum();
            let next = f64::max(weights[k] + slope / square[k], 0.0);
            let step = next - weights[k];
            used.iter().zip(&mut left).for_each(|((row, ..), left)| *left -= step * (row[k] - means[k]));
            weights[k] = next;
            changed = changed.max(step.abs() * libm::sqrt(square[k]));
        }
        if changed <= STILL * libm::sqrt(total) {
            break;
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::{Slopes, weights};
    use crate::allocate::{AllocateError, figures::Figures, program::Power};

    /// 0.2 + Σ w·t², and 0.1 + Σ w·t.
    struct Known;

    const OF_SQUARES: [f64; 5] = [1.0, 0.0, 30.0, 4.0, 0.5];
    const OF_SUM: [f64; 5] = [0.3, 2.0, 0.0, 0.0, 1.0];

    impl Figures for Known {
        fn powers(&self) -> Vec<Power> {
            vec![Power::Two, Power::One]
        }

        fn values(&self, tolerances: &[f64]) -> Result<Vec<f64>, AllocateError> {
            let sum = |weights: [f64; 5], power: Power| {
                weights.iter().zip(tolerances).map(|(weight, t)| weight * power.of(*t)).sum::<f64>()
            };
            Ok(vec![0.2 + sum(OF_SQUARES, Power::Two), 0.1 + sum(OF_SUM, Power::One)])
        }
    }

    #[test]
    fn weights_of_known_figures_are_found_in_both_ways() {
        let at = [0.1, 0.2, 0.05, 0.1, 0.3];
        // The third tolerance cannot become wider: its upper runs stay where it is.
        let ends = [[0.01, 1.0], [0.01, 1.0], [0.01, 0.05], [0.01, 1.0], [0.01, 1.0]];
        for slopes in [Slopes::Differences(0.02), Slopes::Design(1.3)] {
            let found = weights(slopes, &at, &ends, &Known).unwrap();
            for (found, known) in found.iter().zip([OF_SQUARES, OF_SUM]) {
                for (found, known) in found.iter().zip(known) {
                    assert!((found - known).abs() < 1e-7 * (1.0 + known), "{slopes:?}: {found} {known}");
                }
            }
        }
    }
}
