//! The modes of a production: the functions of which its units are sums, each with a coefficient of its own.
//!
//! Principal components of the forces, which are straight between nodes: a scalar product is the integral over the places, so that
//! what a controller sums up over its samples gives the coefficients (Ramsay, Silverman, "Functional Data Analysis", 2005, chapter 8).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, SymmetricEigen};

/// Equidistant nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The first node.
    pub first: f64,
    /// Their distance.
    pub step: f64,
    /// How many there are.
    pub count: usize,
}

impl Grid {
    /// Where the nodes are.
    pub fn places(&self) -> Vec<f64> {
        (0..self.count).map(|i| self.first + self.step * i as f64).collect()
    }

    /// Scalar products of the functions that are 1 at a node and 0 at all others.
    fn products(&self) -> DMatrix<f64> {
        let mut products = DMatrix::zeros(self.count, self.count);
        for i in 1..self.count {
            for (row, column, share) in [(i, i, 2.0), (i - 1, i - 1, 2.0), (i, i - 1, 1.0), (i - 1, i, 1.0)] {
                products[(row, column)] += self.step / 6.0 * share;
            }
        }
        products
    }
}

/// Mean and modes of forces and speeds, values at the nodes.
#[derive(Clone, Debug)]
pub struct Modes {
    /// Mean of the forces and of the speeds.
    pub mean: [Vec<f64>; 2],
    /// For each mode what force and speed differ by for a coefficient of 1, one standard deviation.
    pub modes: Vec<[Vec<f64>; 2]>,
    /// Square of each mode's force, integrated over the places.
    pub norms: Vec<f64>,
}

impl Modes {
    /// The greatest `count` modes of units with these forces and speeds at the nodes of `grid`, those that are of any size.
    pub fn of(grid: &Grid, forces: &[Vec<f64>], speeds: &[Vec<f64>], count: usize) -> Self {
        let units = forces.len();
        let mean = |all: &[Vec<f64>]| {
            let mut mean = vec![0.0; grid.count];
            all.iter().for_each(|one| mean.iter_mut().zip(one).for_each(|(sum, x)| *sum += x / units as f64));
            mean
        };
        let [force, speed] = [mean(forces), mean(speeds)];
        let centred = |all: &[Vec<f64>], mean: &[f64]| DMatrix::from_fn(grid.count, units, |i, u| all[u][i] - mean[i]);
        let [by_force, by_speed] = [centred(forces, &force), centred(speeds, &speed)];
        let none = Self { mean: [force.clone(), speed.clone()], modes: Vec::new(), norms: Vec::new() };
        let products = grid.products();
        let Some(root) = Cholesky::<f64, Dyn>::new(products.clone()).map(|cholesky| cholesky.l()) else { return none };
        let covariance = &by_force * by_force.transpose() / units as f64;
        let parts = SymmetricEigen::new(root.transpose() * covariance * &root);
        let mut order: Vec<usize> = (0..grid.count).collect();
        order.sort_by(|one, other| parts.eigenvalues[*other].total_cmp(&parts.eigenvalues[*one]));
        let whole: f64 = parts.eigenvalues.iter().sum();
        let mut found = none;
        for i in order.into_iter().take(count) {
            let variance = parts.eigenvalues[i];
            // What is left is rounding.
            if variance.is_nan() || variance <= 1e-9 * whole {
                break;
            }
            let vector = parts.eigenvectors.column(i).into_owned();
            let Some(mode) = root.transpose().solve_upper_triangular(&vector) else { break };
            let mode: DVector<f64> = mode * libm::sqrt(variance);
            // Coefficients of all units.
            let coefficients = by_force.transpose() * (&products * &mode) / variance;
            let speeds = &by_speed * coefficients / units as f64;
            found.modes.push([mode.as_slice().to_vec(), speeds.as_slice().to_vec()]);
            found.norms.push(variance);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::{Grid, Modes};

    #[test]
    fn functions_of_which_all_are_sums_are_found() {
        let grid = Grid { first: 0.0, step: 0.01, count: 101 };
        let places = grid.places();
        // Two functions that are orthogonal over the range, with uncorrelated coefficients of deviations 3 and 0.5.
        let sine = |k: f64| places.iter().map(|x| libm::sin(k * core::f64::consts::PI * x)).collect::<Vec<f64>>();
        let (one, other) = (sine(1.0), sine(2.0));
        let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let sum = |[a, b]: [f64; 2]| (0..101).map(|i| 2.0 + 3.0 * a * one[i] + 0.5 * b * other[i]).collect();
        let forces: Vec<Vec<f64>> = signs.map(sum).into();
        let speeds: Vec<Vec<f64>> = signs.map(|[a, _]| vec![1.0 - 0.1 * a; 101]).into();
        let found = Modes::of(&grid, &forces, &speeds, 8);
        assert_eq!(found.modes.len(), 2);
        for (i, (mean, speed)) in found.mean[0].iter().zip(&found.mean[1]).enumerate() {
            assert!((mean - 2.0).abs() < 1e-12 && (speed - 1.0).abs() < 1e-12, "{i}");
        }
        // Over the range, sin² is a half.
        for (norm, expected) in found.norms.iter().zip([4.5, 0.125]) {
            assert!((norm / expected - 1.0).abs() < 1e-3, "{norm} {expected}");
        }
        let sign = found.modes[0][0][50].signum();
        let [greater, lesser] = [&found.modes[0], &found.modes[1]];
        for (i, expected) in one.iter().enumerate() {
            assert!((sign * greater[0][i] - 3.0 * expected).abs() < 3e-3, "{i}");
            // Speeds go with the first.
            assert!((sign * greater[1][i] + 0.1).abs() < 1e-9 && lesser[1][i].abs() < 1e-9, "{i}");
        }
    }
}
