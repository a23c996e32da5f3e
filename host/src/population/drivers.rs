//! What drives force and malfunction: the share of the variance that each contributor explains alone.
//!
//! The shares need no runs of their own. Units whose outcome is known are drawn again, which takes far less time than to simulate them,
//! and put into order by each variable (`explained`). A contributor with several variables, such as a plane in its zone, explains
//! what each of them does alone, or what their most telling linear combination does, whichever is more.

use std::{collections::BTreeMap, ops::Range};

use rayon::prelude::*;
use serde::Serialize;

use slipfit_system::parallel;

use super::{
    explained::{Explained, Marked, explained},
    kept::{Judged, Kept, Outcomes},
    production::Production,
};

/// Units from which on contributors are ranked.
pub const LEAST_UNITS: u64 = 120;
/// Units of the rarer outcome from which on they are.
pub const LEAST_OUTCOMES: usize = 3;
/// Marked units that a weight of a linear combination takes.
const UNITS_A_WEIGHT: usize = 10;
/// Units that are drawn at a time.
const PIECE: u64 = 4096;
/// Units that means and variances of variables are found from.
const PILOT: u64 = 1024;

/// Share of a contributor in the variance of a figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Driver {
    /// Name of the contributor.
    pub name: String,
    /// Correlation ratio; about 0 where it does nothing.
    pub share: f64,
    /// Its standard error.
    pub error: f64,
    /// What the greatest share of as many contributors without effect exceeds with a chance of at most 5 %.
    pub chance: f64,
}

impl Driver {
    /// Whether the share is more than chance explains.
    pub fn is_significant(&self) -> bool {
        self.share > self.chance
    }
}

/// What malfunction varies with, the strongest first, in a `production` of whose first `units` the `outcomes` are known. Empty if fewer
/// than [`LEAST_UNITS`] are, or fewer than [`LEAST_OUTCOMES`] do or do not malfunction: the luckiest of many contributors would
/// explain all.
pub fn of_malfunction(production: &Production, outcomes: &Outcomes, units: u64) -> Vec<Driver> {
    let Judged { units, marked } = outcomes.judged(units);
    let marked: Vec<(u64, f64)> = marked.into_iter().map(|number| (number, 1.0)).collect();
    let enough = marked.len() >= LEAST_OUTCOMES && units - marked.len() as u64 >= LEAST_OUTCOMES as u64;
    if enough && units >= LEAST_UNITS { ranked(production, units, &marked) } else { Vec::new() }
}

/// What the greatest force varies with, likewise.
pub fn of_force(production: &Production, outcomes: &Outcomes, units: u64) -> Vec<Driver> {
    let forces = outcomes.with_force(units);
    let count = forces.len() as u64;
    if count < LEAST_UNITS {
        return Vec::new();
    }
    let mean = forces.iter().map(|unit| unit.force).sum::<f64>() / count as f64;
    let marked: Vec<(u64, f64)> = forces.iter().map(|Kept { number, force }| (*number, force - mean)).collect();
    ranked(production, count, &marked)
}

/// A variable, or a linear combination of those of a contributor: which, and their weights.
type Column = Vec<(usize, f64)>;

fn value(column: &Column, variables: &[Vec<f64>], i: usize) -> f64 {
    column.iter().map(|(variable, weight)| weight * variables[*variable][i]).sum()
}

/// The contributors by falling share in the variance of a figure that is 0 except for the `marked` units: numbers, ascending, and
/// figures. Where these are `units` in all, no others are looked at; otherwise all up to that number are.
fn ranked(production: &Production, units: u64, marked: &[(u64, f64)]) -> Vec<Driver> {
    let contributors = production.contributors();
    let variables = contributors.iter().map(|(_, own)| own.len()).sum::<usize>();
    let drawn = of_marked(production, variables, marked);
    let pilot = production.draw(0..PILOT).variables;
    let mut columns: Vec<Column> = (0..variables).map(|variable| vec![(variable, 1.0)]).collect();
    let mut combined = BTreeMap::new();
    for (contributor, (_, own)) in contributors.iter().enumerate() {
        if own.len() > 1 && marked.len() >= UNITS_A_WEIGHT * own.len() {
            combined.insert(contributor, columns.len());
            columns.push(combination(own.clone(), marked, &drawn, &pilot));
        }
    }
    let found = columns_explained(production, units, marked, &drawn, &columns);
    let of = |(contributor, (name, own)): (usize, &(&str, Range<usize>))| {
        let each = own.clone().filter_map(|variable| found[variable]);
        let alone = each.fold(Explained { share: 0.0, error: 0.0, chance: 0.0 }, |sum, next| Explained {
            share: sum.share + next.share,
            error: libm::hypot(sum.error, next.error),
            chance: libm::hypot(sum.chance, next.chance),
        });
        let together = combined.get(&contributor).and_then(|column| found[*column]);
        let best = together.filter(|together| together.share > alone.share).unwrap_or(alone);
        Driver { name: (*name).to_owned(), share: best.share, error: best.error, chance: best.chance }
    };
    let mut drivers: Vec<Driver> = contributors.iter().enumerate().map(of).collect();
    drivers.sort_by(|one, other| other.share.total_cmp(&one.share));
    drivers
}

/// The variables of the `marked` units, a column each.
fn of_marked(production: &Production, variables: usize, marked: &[(u64, f64)]) -> Vec<Vec<f64>> {
    let mut all = vec![Vec::with_capacity(marked.len()); variables];
    for group in marked.chunk_by(|(one, _), (next, _)| one / PIECE == next / PIECE) {
        let (first, end) = (group[0].0 / PIECE * PIECE, group[group.len() - 1].0 + 1);
        let drawn = production.draw(first..end).variables;
        for (column, drawn) in all.iter_mut().zip(&drawn) {
            column.extend(group.iter().map(|(number, _)| drawn[(number - first) as usize]));
        }
    }
    all
}

/// The linear combination of a contributor's `own` variables that the figure follows most, each weighed by its covariance with the
/// figure over its variance.
fn combination(own: Range<usize>, marked: &[(u64, f64)], drawn: &[Vec<f64>], pilot: &[Vec<f64>]) -> Column {
    let weight = |variable: usize| {
        let (values, count) = (&pilot[variable], pilot[variable].len() as f64);
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count;
        let covariance: f64 = marked.iter().zip(&drawn[variable]).map(|((_, y), x)| y * (x - mean)).sum();
        (variable, if variance > 0.0 { covariance / variance } else { 0.0 })
    };
    own.map(weight).collect()
}

/// What each of the `columns` explains.
fn columns_explained(
    production: &Production,
    units: u64,
    marked: &[(u64, f64)],
    drawn: &[Vec<f64>],
    columns: &[Column],
) -> Vec<Option<Explained>> {
    // By value, then by number: units with equal values come in an order that tells nothing.
    let sorted = parallel::map(columns, |column| {
        let mut sorted: Vec<(f64, usize)> = (0..marked.len()).map(|i| (value(column, drawn, i), i)).collect();
        sorted.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        sorted
    });
    let places = if marked.len() as u64 == units {
        vec![(0..units).collect(); columns.len()]
    } else {
        places(production, units, marked, columns, &sorted)
    };
    let of = |k: usize| {
        let (sorted, places) = (&sorted[k], &places[k]);
        let unit = |((_, i), place): (&(f64, usize), &u64)| Marked { place: *place, value: marked[*i].1 };
        let ordered: Vec<Marked> = sorted.iter().zip(places).map(unit).collect();
        explained(units, &ordered, columns.len())
    };
    parallel::each(columns.len(), of)
}

/// How many of the first `units` come before each of the marked ones, which are `sorted`, by each of the `columns`.
fn places(
    production: &Production,
    units: u64,
    marked: &[(u64, f64)],
    columns: &[Column],
    sorted: &[Vec<(f64, usize)>],
) -> Vec<Vec<u64>> {
    // How many units lie between two marked ones, and before the first.
    let mut counts = vec![vec![0u64; marked.len() + 1]; columns.len()];
    let pieces: Vec<u64> = (0..units).step_by(PIECE as usize).collect();
    // As many pieces at a time as keep all threads at work.
    for starts in pieces.chunks(4 * rayon::current_num_threads()) {
        let draw = |first: &u64| (*first, production.draw(*first..units.min(first + PIECE)).variables);
        let drawn: Vec<(u64, Vec<Vec<f64>>)> = parallel::map(starts, draw);
        counts.par_iter_mut().zip(columns).zip(sorted).for_each(|((counts, column), sorted)| {
            for (first, variables) in &drawn {
                for i in 0..units.min(first + PIECE) - first {
                    let x = value(column, variables, i as usize);
                    let before = |(other, k): &(f64, usize)| {
                        other.total_cmp(&x).then(marked[*k].0.cmp(&(first + i))) != std::cmp::Ordering::Greater
                    };
                    counts[sorted.partition_point(before)] += 1;
                }
            }
        });
    }
    let running = |counts: &Vec<u64>| {
        let sum = |before: &mut u64, count: &u64| {
            *before += count;
            Some(*before)
        };
        counts[..marked.len()].iter().scan(0, sum).collect()
    };
    counts.iter().map(running).collect()
}

#[cfg(test)]
mod tests {
    use super::{Driver, LEAST_UNITS, of_force, of_malfunction};
    use crate::{
        dynamics::example,
        population::{kept::Outcomes, production::Production},
        scene::{SceneFile, shipped},
        setup::Scene,
    };
    use slipfit_tolerance::numeric::normal::quantile;

    type Variables<'a> = &'a dyn Fn(usize) -> f64;

    /// What the first `units` of a `production` do whose figure and outcome follow from their variables.
    fn outcomes(production: &Production, units: u64, of: impl Fn(Variables) -> (Option<f64>, bool)) -> Outcomes {
        let mut all = Outcomes::default();
        for first in (0..units).step_by(4096) {
            let drawn = production.draw(first..units.min(first + 4096));
            for (i, number) in drawn.numbers.clone().enumerate() {
                let (force, fails) = of(&|variable| drawn.variables[variable][i]);
                all.add(number, force, fails);
            }
        }
        all
    }

    /// Name, mean and standard deviation of gaps of the slide.
    fn gaps(scene: &Scene) -> Vec<[f64; 2]> {
        scene.pins.iter().flat_map(|pin| pin.gaps).flatten().map(|gap| [gap.mean, gap.deviation]).collect()
    }

    #[track_caller]
    fn only(drivers: &[Driver], name: &str) {
        println!("{:?}", &drivers[..2]);
        assert_eq!(drivers[0].name, name);
        assert!((drivers[0].share - 1.0).abs() <= 2.0 * drivers[0].error, "{:?}", drivers[0]);
        assert!(drivers[0].is_significant() && !drivers[1..].iter().any(Driver::is_significant), "{drivers:?}");
    }

    /// A single gap decides: at 68 %, at 1 %, on both sides, and at 1 in 100,000 units. The true share is 100 %.
    #[test]
    fn the_only_cause_of_failure_has_all_of_it() {
        let scene = example::cd_rom();
        let gaps = gaps(&scene);
        let production = Production::new(&scene, None, 0.0, 9).unwrap();
        let name = production.contributors()[3].0.to_owned();
        for (units, p, both) in
            [(20_000, 0.68, false), (20_000, 0.01, false), (20_000, 0.01, true), (1 << 21, 1e-5, false)]
        {
            let limit = -quantile(if both { 0.5 * p } else { p });
            let fails = |x: Variables| {
                let z = (x(3) - gaps[3][0]) / gaps[3][1];
                if both { z.abs() > limit } else { z > limit }
            };
            let outcomes = outcomes(&production, units, |x| (None, fails(x)));
            only(&of_malfunction(&production, &outcomes, units), &name);
        }
    }

    /// A plane decides by a corner of its zone: by offset and both tilts together.
    #[test]
    fn the_only_cause_may_have_several_variables() {
        let file = SceneFile::parse("drawing", shipped("cd-rom-slide-drawing").unwrap(), &[]).unwrap();
        let (scene, product) = (file.slide.unwrap(), file.product.unwrap());
        let production = Production::new(&scene, Some(&product), 0.0, 1).unwrap();
        let contributors = production.contributors();
        let (name, own) = contributors.iter().find(|(_, own)| own.len() == 3).unwrap();
        let pilot = production.draw(0..2048).variables;
        let spread = |k: usize| libm::sqrt(pilot[k].iter().map(|x| x * x).sum::<f64>() / 2048.0);
        let weights: Vec<f64> = own.clone().map(|k| 1.0 / spread(k)).collect();
        let corner = |x: Variables| own.clone().zip(&weights).map(|(k, weight)| weight * x(k)).sum::<f64>();
        for limit in [3.0, 0.8] {
            let outcomes = outcomes(&production, 8192, |x| (Some(corner(x)), corner(x) > limit));
            let drivers = of_malfunction(&production, &outcomes, 8192);
            println!("{:?}", &drivers[..2]);
            assert_eq!(drivers[0].name, *name);
            // The weights are those of some hundred units.
            assert!(drivers[0].share > 0.85 && drivers[0].is_significant(), "{:?}", drivers[0]);
            assert!(!drivers[1].is_significant(), "{:?}", drivers[1]);
            let forces = of_force(&production, &outcomes, 8192);
            assert!(forces[0].name == *name && forces[0].share > 0.98, "{:?}", forces[0]);
        }
    }

    /// Gaps that are correlated tell of each other: with ρ = 0.8 the force, 2·a, is known to 64 % from any other gap.
    #[test]
    fn forces_have_their_shares_and_correlated_gaps_tell_of_each_other() {
        let scene = example::cd_rom();
        let production = Production::new(&scene, None, 0.8, 2).unwrap();
        let outcomes = outcomes(&production, 4000, |x| (Some(2.0 * x(0)), false));
        let drivers = of_force(&production, &outcomes, 4000);
        assert!((drivers[0].share - 1.0).abs() < 0.01, "{:?}", drivers[0]);
        for other in &drivers[1..] {
            assert!((other.share - 0.64).abs() < 4.0 * other.error + 0.01, "{other:?}");
        }
        assert!(of_malfunction(&production, &outcomes, 4000).is_empty());
    }

    /// Of three units one of many contributors always explains all: nothing is said, nor of two malfunctions.
    #[test]
    fn few_units_tell_nothing() {
        let scene = example::cd_rom();
        let production = Production::new(&scene, None, 0.0, 1).unwrap();
        let few = outcomes(&production, LEAST_UNITS - 1, |x| (Some(x(0)), x(0) > 0.0));
        assert!(of_force(&production, &few, LEAST_UNITS - 1).is_empty());
        assert!(of_malfunction(&production, &few, LEAST_UNITS - 1).is_empty());
        let mut two = outcomes(&production, 500, |_| (None, false));
        [500, 501].into_iter().for_each(|number| two.add(number, None, true));
        assert!(of_malfunction(&production, &two, 502).is_empty());
    }
}
