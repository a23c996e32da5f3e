//! Which unknowns decide: the share of a figure's variance that each explains alone.
//!
//! The figure is known, with some noise, at a few points of the unit cube. A sum of one polynomial a coordinate is fitted to it
//! (Legendre's, which are orthonormal there), so that the squares of its coefficients, less what noise adds to them, are the variance
//! that a coordinate explains: its first-order Sobol' index. The error is that of leaving out points one by one (jackknife).

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};

/// The greatest degree of a polynomial.
const DEGREE: usize = 5;
/// Points for each coefficient.
const POINTS_A_TERM: usize = 4;
/// The chance that any of the unknowns without effect passes for one with an effect.
const LUCK: f64 = 0.05;

/// A figure at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Where, each coordinate between 0 and 1.
    pub at: Vec<f64>,
    /// The figure.
    pub figure: f64,
}

/// What one unknown explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Its share of the variance between the points, noise excepted: 0 to 1.
    pub share: f64,
    /// Its standard error.
    pub error: f64,
}

/// What each of the unknowns, which have these ranges of coordinates, explains of a figure that is known with a `noise` (variance) at
/// these points. None of an unknown whose effect noise explains.
pub fn shares(points: &[Point], unknowns: &[Range<usize>], noise: f64) -> Vec<Option<Share>> {
    let nothing = || vec![None; unknowns.len()];
    let Some(all) = Fit::new(points, unknowns, noise) else { return nothing() };
    if !differs(points, noise) {
        return nothing();
    }
    // What is alone explains all.
    if unknowns.len() == 1 {
        return vec![Some(Share { share: 1.0, error: 0.0 })];
    }
    let without = |left_out: usize| {
        let others = points.iter().enumerate().filter(|(i, _)| *i != left_out).map(|(_, point)| point.clone());
        Fit::new(&others.collect::<Vec<_>>(), unknowns, noise)
    };
    let fits: Vec<Fit> = (0..points.len()).filter_map(without).collect();
    let share = |u: usize| {
        let count = fits.len() as f64;
        let mean = fits.iter().map(|fit| fit.shares[u]).sum::<f64>() / count;
        let square = fits.iter().map(|fit| (fit.shares[u] - mean) * (fit.shares[u] - mean)).sum::<f64>();
        let error = libm::sqrt(square * (count - 1.0) / count);
        let is_more = all.chances[u] < LUCK / unknowns.len() as f64;
        is_more.then(|| Share { share: all.shares[u].clamp(0.0, 1.0), error })
    };
    (0..unknowns.len()).map(share).collect()
}

/// Whether the figure differs between the points by more than noise does.
fn differs(points: &[Point], noise: f64) -> bool {
    let square = variance(points) * (points.len() - 1) as f64;
    if noise <= 0.0 {
        return square > 0.0;
    }
    ChiSquared::new((points.len() - 1) as f64).is_ok_and(|chi| chi.sf(square / noise) < LUCK)
}

fn variance(points: &[Point]) -> f64 {
    let count = points.len() as f64;
    let mean = points.iter().map(|point| point.figure).sum::<f64>() / count;
    points.iter().map(|point| (point.figure - mean) * (point.figure - mean)).sum::<f64>() / (count - 1.0)
}

/// A fit, and what each unknown explains by it.
struct Fit {
    /// Shares of the variance.
    shares: Vec<f64>,
    /// The chances that an unknown without effect explains as much.
    chances: Vec<f64>,
}

impl Fit {
    fn new(points: &[Point], unknowns: &[Range<usize>], noise: f64) -> Option<Self> {
        let coordinates = unknowns.last()?.end;
        let degree = (points.len() / POINTS_A_TERM / coordinates).clamp(1, DEGREE);
        let columns = |left_out: Option<&Range<usize>>| {
            let kept = (0..coordinates).filter(move |i| left_out.is_none_or(|range| !range.contains(i)));
            kept.flat_map(|i| (1..=degree).map(move |order| (i, order))).collect::<Vec<_>>()
        };
        let between = variance(points) - noise;
        if between <= 0.0 {
            return None;
        }
        let all = columns(None);
        let whole = Regression::new(points, &all)?;
        let left = whole.freedom();
        let each = |range: &Range<usize>| {
            let own = |k: &usize| range.contains(&all[*k].0);
            let terms = (0..all.len()).filter(own).map(|k| whole.terms[k]);
            let explained = terms.map(|[c, error]| c * c - error).sum::<f64>();
            let rest = Regression::new(points, &columns(Some(range)))?;
            let more = (rest.squares - whole.squares) / (range.len() * degree) as f64;
            let ratio = more / (whole.squares / left).max(f64::MIN_POSITIVE);
            let law = FisherSnedecor::new((range.len() * degree) as f64, left).ok()?;
            Some((explained / between, law.sf(ratio)))
        };
        let (shares, chances) = unknowns.iter().map(each).collect::<Option<Vec<_>>>()?.into_iter().unzip();
        Some(Self { shares, chances })
    }
}

/// A least-squares fit.
struct Regression {
    /// Of every term its coefficient and the variance of that.
    terms: Vec<[f64; 2]>,
    /// Sum of the squares that are left.
    squares: f64,
    points: usize,
}

impl Regression {
    /// Of a constant and of `columns`: coordinates with the orders of their polynomials. None if there are too few points.
    fn new(points: &[Point], columns: &[(usize, usize)]) -> Option<Self> {
        let (rows, width) = (points.len(), columns.len() + 1);
        if rows <= width {
            return None;
        }
        let term = |i: usize, k: usize| match k.checked_sub(1) {
            None => 1.0,
            Some(k) => legendre(columns[k].1, points[i].at[columns[k].0]),
        };
        let design = DMatrix::from_fn(rows, width, term);
        let figures = DVector::from_iterator(rows, points.iter().map(|point| point.figure));
        let inverse = design.tr_mul(&design).cholesky()?.inverse();
        let coefficients = &inverse * design.tr_mul(&figures);
        let squares = (&design * &coefficients - figures).norm_squared();
        let variance = squares / (rows - width) as f64;
        let terms = (1..width).map(|k| [coefficients[k], variance * inverse[(k, k)]]).collect();
        Some(Self { terms, squares, points: rows })
    }

    /// Degrees of freedom that are left.
    fn freedom(&self) -> f64 {
        (self.points - self.terms.len() - 1) as f64
    }
}

/// Legendre's polynomial of this order on [0, 1], of mean square 1.
fn legendre(order: usize, u: f64) -> f64 {
    let x = 2.0 * u - 1.0;
    let (mut before, mut value) = (1.0, x);
    for k in 1..order {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
    }
    value * libm::sqrt(2.0 * order as f64 + 1.0)
}

#[cfg(test)]
mod tests {
    use super::{Point, Share, shares};
    use crate::sampling::sampler::{Method, Sampler};
    use slipfit_core::sampling::stream::{Rng, derived, uniform, unit_stream};

    /// Shares of hits among `units` at 64 points of which three coordinates are unknown, and their variance by counting.
    fn counted(units: u64, seed: u64, p: impl Fn(&[f64]) -> f64) -> (Vec<Point>, f64) {
        let sampler = Sampler::new(Method::ScrambledSobol, derived(seed, 1), 3, 1, 64);
        let mut stream = unit_stream(seed, 0);
        let mut share = move || uniform(stream.next_u64());
        let mut point = |i| {
            let mut bits = vec![[0; crate::numeric::lanes::LANES]; 3];
            sampler.fill(i, &mut bits);
            let at: Vec<f64> = bits.iter().map(|bits| bits[0] as f64 / libm::ldexp(1.0, 64)).collect();
            let chance = p(&at);
            let hits = (0..units).filter(|_| share() < chance).count();
            Point { figure: hits as f64 / units as f64, at }
        };
        let points: Vec<Point> = (0..64).map(&mut point).collect();
        let noise = points.iter().map(|point| point.figure * (1.0 - point.figure)).sum::<f64>();
        (points, noise / 64.0 / (units - 1) as f64)
    }

    const EACH: [std::ops::Range<usize>; 3] = [0..1, 1..2, 2..3];

    /// A line, a bend, a jump; of the three unknowns the second alone matters.
    #[test]
    fn the_only_one_that_matters_decides() {
        for (p, least) in [
            ((|u| 0.1 + 0.5 * u) as fn(f64) -> f64, 0.97),
            (|u| 0.5 * libm::exp(-20.0 * (u - 0.4) * (u - 0.4)), 0.93),
            (|u| if u < 0.4 { 0.02 } else { 0.5 }, 0.85),
        ] {
            let (mut mean, mut others) = (0.0, 0);
            for seed in 0..50 {
                let (points, noise) = counted(312, seed, |u| p(u[1]));
                let found = shares(&points, &EACH, noise);
                let Some(Share { share, error }) = found[1] else { panic!("{found:?}") };
                assert!(error < 0.2, "{found:?}");
                mean += share / 50.0;
                others += u32::from(found[0].is_some()) + u32::from(found[2].is_some());
            }
            println!("{mean}, {others} others of 100");
            assert!((least..=1.0).contains(&mean) && others <= 10, "{mean} {others}");
        }
    }

    /// Two that add up: 0.36 and 0.64 of the variance. A product of two leaves each 3/7.
    #[test]
    fn shares_are_those_of_known_functions() {
        type Case = (fn(&[f64]) -> f64, [f64; 2]);
        let cases: [Case; 2] =
            [(|u| 0.1 + 0.3 * u[0] + 0.4 * u[2], [0.36, 0.64]), (|u| u[0] * u[2], [3.0 / 7.0, 3.0 / 7.0])];
        for (p, known) in cases {
            let (mut held, mut mean) = (0, [0.0; 2]);
            for seed in 0..50 {
                let (points, noise) = counted(312, seed, p);
                let found = shares(&points, &EACH, noise);
                let both = [found[0].unwrap(), found[2].unwrap()];
                mean = [0, 1].map(|i| mean[i] + both[i].share / 50.0);
                held += (0..2).filter(|i| (both[*i].share - known[*i]).abs() < 2.0 * both[*i].error).count();
            }
            println!("{mean:?} for {known:?}, {held} of 100 hold");
            assert!((0..2).all(|i| (mean[i] - known[i]).abs() < 0.02) && held >= 86, "{mean:?} {held}");
        }
    }

    #[test]
    fn noise_decides_nothing() {
        let mut listed = 0;
        for seed in 0..100 {
            let (points, noise) = counted(64, seed, |_| 0.3);
            listed += shares(&points, &EACH, noise).iter().flatten().count();
        }
        assert!(listed <= 8, "{listed}");
        let (points, noise) = counted(64, 1, |_| 0.0);
        assert_eq!(shares(&points, &EACH, noise), [None; 3]);
        // What is alone decides all.
        let (points, noise) = counted(64, 1, |u| u[0]);
        assert_eq!(shares(&points, &vec![0..3; 1], noise), [Some(Share { share: 1.0, error: 0.0 })]);
    }
}
