//! Share of a figure's variance that one variable explains, Var(E[y|x])/Var(y): the correlation ratio, which is the first-order
//! Sobol' index of independent variables.
//!
//! Units are put into classes of equal size by x. Two units of a class agree in x, nearly, and in nothing else, so that the
//! products of their figures have the mean E[E[y|x]²] without bias, however few units a class has. Classes that are too wide lose a
//! part of the share, and narrow ones have more noise: they are halved as long as that raises the share by more than noise does
//! (Lepski's rule). So a smooth effect is found in few classes, and a failure of one unit in 100,000 in classes that are as narrow as
//! the tail that fails.

/// Classes to begin with.
const FEWEST: u64 = 16;
/// −ln of about the chance that noise halves the classes once.
const HALVING: f64 = 2.0;
/// The chance that any of the variables without effect passes for one with an effect.
const LUCK: f64 = 0.05;

/// How much a variable explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Explained {
    /// Share of the variance; about 0 where the variable does nothing.
    pub share: f64,
    /// Its standard error.
    pub error: f64,
    /// What the greatest share of as many variables without effect exceeds with a chance of at most 5 %.
    pub chance: f64,
}

/// A unit whose figure is not 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marked {
    /// How many units have a smaller x.
    pub place: u64,
    /// Its figure.
    pub value: f64,
}

/// Units of a class, and the sums of their figures and of the squares of these.
#[derive(Clone, Copy, Debug, Default)]
struct Class {
    number: u64,
    units: f64,
    marked: f64,
    sum: f64,
    square: f64,
}

impl Class {
    /// Variance of the figure within the class.
    fn variance(&self) -> f64 {
        (self.square - self.sum * self.sum / self.units) / (self.units - 1.0)
    }
}

/// Classes of equal size that hold a marked unit, of `count` classes in all: sums of `parts`, each with its class, by ascending class.
fn classes(units: u64, count: u64, parts: impl Iterator<Item = (u64, Class)>) -> Vec<Class> {
    let first = |number: u64| (number * units).div_ceil(count);
    let mut all: Vec<Class> = Vec::new();
    for (number, part) in parts {
        if all.last().is_none_or(|class| class.number != number) {
            all.push(Class { number, units: (first(number + 1) - first(number)) as f64, ..Class::default() });
        }
        if let Some(class) = all.last_mut() {
            class.marked += part.marked;
            class.sum += part.sum;
            class.square += part.square;
        }
    }
    all
}

/// The classes of the `marked` units, of [`FEWEST`] classes first, and each time of twice as many, as long as a class has two units.
fn halvings(units: u64, marked: &[Marked]) -> Vec<(u64, Vec<Class>)> {
    let mut count = FEWEST;
    while 4 * count <= units {
        count *= 2;
    }
    let of_unit = |Marked { place, value }: &Marked| {
        let part = Class { marked: 1.0, sum: *value, square: value * value, ..Class::default() };
        (place * count / units, part)
    };
    let mut all = vec![(count, classes(units, count, marked.iter().map(of_unit)))];
    while count > FEWEST {
        count /= 2;
        let finer = all.last().map_or(&[][..], |(_, classes)| classes);
        let coarser = classes(units, count, finer.iter().map(|class| (class.number / 2, *class)));
        all.push((count, coarser));
    }
    all.reverse();
    all
}

/// What a variable explains of a figure of so many `units`, 32 or more, which is 0 except for the `marked` units, by ascending place.
/// `variables` is how many are looked at. None if the figure does not vary.
pub fn explained(units: u64, marked: &[Marked], variables: usize) -> Option<Explained> {
    let n = units as f64;
    let sum: f64 = marked.iter().map(|unit| unit.value).sum();
    let square: f64 = marked.iter().map(|unit| unit.value * unit.value).sum();
    let greatest = marked.iter().map(|unit| unit.value * unit.value).fold(0.0, f64::max);
    let (mean, squares) = (sum / n, square - sum * sum / n);
    if squares.is_nan() || squares <= 1e-12 * square {
        return None;
    }
    // The mean product of any two units, over the mean square: of a variable without effect.
    let nothing = (sum * sum - square) / ((n - 1.0) * square);
    let scale = square * (1.0 - nothing);
    let levels = libm::log2(n / FEWEST as f64).max(1.0);
    let sure = libm::log(variables.max(1) as f64 * levels / LUCK);
    let share = |classes: &[Class]| {
        let pairs = |class: &Class| (class.sum * class.sum - class.square) / (class.units - 1.0);
        (classes.iter().map(pairs).sum::<f64>() - nothing * square) / scale
    };
    // Bernstein's bound of the share by `count` classes, if there is no effect within those whose squared variances come to
    // `fourth`: each pair of units counts about 2/(class size − 1).
    let noise = |fourth: f64, count: u64, sure: f64| {
        let others = n / count as f64 - 1.0;
        (libm::sqrt(4.0 * sure * fourth / others) + sure * 2.0 / (3.0 * others) * greatest) / scale
    };
    let fourth =
        |classes: &[Class]| classes.iter().map(|class| class.units * class.variance() * class.variance()).sum::<f64>();
    let mut halvings = halvings(units, marked).into_iter();
    let (mut count, mut chosen) = halvings.next()?;
    for (finer, next) in halvings {
        if share(&next) - share(&chosen) > noise(fourth(&chosen), finer, HALVING) {
            (count, chosen) = (finer, next);
        }
    }
    let found = share(&chosen);
    let variance = squares / (n - 1.0);
    let chance = noise(n * variance * variance, count, sure) + 2.0 * sure / n;
    // How much one unit moves the share (its influence), squared: 2·y·g − g² − share·y², both about the mean.
    let influence = |value: f64, g: f64| {
        let y = value - mean;
        let by = (2.0 * y - g) * g - found * y * y;
        by * by
    };
    let (mut influences, mut others, mut pairs, mut rest) = (0.0, marked.iter(), 0.0, n);
    for class in &chosen {
        let g = class.sum / class.units - mean;
        let own = others.by_ref().take(class.marked as usize);
        influences += own.map(|unit| influence(unit.value, g)).sum::<f64>();
        influences += (class.units - class.marked) * influence(0.0, g);
        pairs += 2.0 * class.variance() * class.variance() * class.units / (class.units - 1.0);
        rest -= class.units;
    }
    influences += rest * influence(0.0, -mean);
    // Where the figure begins and ends to depend on x is known to a unit on either side.
    let border = 2.0 / marked.len() as f64;
    let error = libm::hypot(libm::sqrt(influences + pairs) / squares, border);
    Some(Explained { share: found, error, chance })
}

#[cfg(test)]
mod tests {
    use super::{Explained, Marked, explained};
    use slipfit_core::sampling::stream::{Rng, uniform, unit_stream};
    use slipfit_tolerance::numeric::normal::{quantile, tail};

    /// Independent uniform numbers.
    fn uniforms(seed: u64) -> impl FnMut() -> f64 {
        let mut stream = unit_stream(seed, 0);
        move || uniform(stream.next_u64())
    }

    /// What x explains of `figures`, of units by ascending x; none if these do not differ.
    fn of(figures: &[f64], variables: usize) -> Option<Explained> {
        let marked: Vec<Marked> = (0..)
            .zip(figures)
            .filter(|(_, value)| **value != 0.0)
            .map(|(place, value)| Marked { place, value: *value })
            .collect();
        explained(figures.len() as u64, &marked, variables)
    }

    /// Whether each of so many units fails: `chance` of the place of its x, from 0 to 1.
    fn failures(units: usize, seed: u64, chance: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut uniform = uniforms(seed);
        (0..units).map(|i| f64::from(uniform() < chance((i as f64 + uniform()) / units as f64))).collect()
    }

    /// The only cause there is explains all, at any rate, below a limit or above it, on one side or on both, in the middle or in bands.
    #[test]
    fn the_only_cause_explains_all() {
        type Case = (&'static str, usize, fn(f64) -> bool);
        let cases: [Case; 9] = [
            ("1 % above", 20_000, |u| u > 0.99),
            ("1 % below", 5_000, |u| u < 0.01),
            ("1 % on both sides", 20_000, |u| (u - 0.5).abs() > 0.495),
            ("68 %", 20_000, |u| u < 0.68),
            ("68 % in the middle", 5_000, |u| (u - 0.5).abs() < 0.34),
            ("32 % of few units", 150, |u| u > 0.68),
            ("1 in 100,000", 10_000_000, |u| u > 1.0 - 1e-5),
            ("1 in 100,000 inside", 10_000_000, |u| (0.3..0.300_01).contains(&u)),
            ("1 in 1,000,000", 10_000_000, |u| u < 1e-6),
        ];
        for (name, units, fails) in cases {
            let fails = |i: usize| fails((i as f64 + 0.3) / units as f64);
            let count = (0..units).filter(|i| fails(*i)).count();
            // The rarer outcome is marked.
            let marks = |i: &usize| fails(*i) == (2 * count <= units);
            let marked: Vec<Marked> =
                (0..units).filter(marks).map(|i| Marked { place: i as u64, value: 1.0 }).collect();
            let found = explained(units as u64, &marked, 20).unwrap();
            println!("{name}: {found:?}");
            assert!((found.share - 1.0).abs() <= 2.0 * found.error, "{name}: {found:?}");
            assert!(found.error < 2.5 / marked.len() as f64 + 0.01, "{name}: {found:?}");
            assert!(found.share > found.chance, "{name}: {found:?}");
        }
    }

    /// Two causes of equal strength: either alone makes a unit fail, both have to, or their sum does. Closed forms.
    #[test]
    fn shares_are_those_of_known_functions() {
        for (units, p) in [(5_000, 0.02), (100_000, 2e-3), (3_000, 0.4), (3_000, 0.8)] {
            let limit = 1.0 - libm::sqrt(1.0 - p);
            // Two units that share this cause both fail: for this cause, or both for the other one.
            let exact = (limit + (1.0 - limit) * limit * limit - p * p) / (p * (1.0 - p));
            let both = libm::sqrt(p);
            let exact_both = (both * both * both - p * p) / (p * (1.0 - p));
            let mut held = [0; 2];
            for seed in 0..100 {
                for (held, (exact, chance)) in held.iter_mut().zip([
                    (exact, Box::new(move |u: f64| if u < limit { 1.0 } else { limit }) as Box<dyn Fn(f64) -> f64>),
                    (exact_both, Box::new(move |u: f64| if u > 1.0 - both { both } else { 0.0 })),
                ]) {
                    let found = of(&failures(units, seed, chance), 1).unwrap();
                    *held += u32::from((found.share - exact).abs() < 2.0 * found.error);
                }
            }
            println!("{p}: {held:?} of 100 hold");
            assert!(held.iter().all(|held| *held >= 86), "{p}: {held:?}");
        }
    }

    /// A unit fails where √ρ·x + √(1 − ρ)·z exceeds a limit: the share is (P₂ − p²)/(p − p²), with P₂ the probability that two
    /// normals with the correlation ρ both exceed it, by integration over x.
    #[test]
    fn a_cause_among_others_has_its_share_of_the_variance() {
        for (units, p, rho) in [(2_000, 0.5, 0.3), (20_000, 0.01, 0.5), (100_000, 1e-3, 0.9), (5_000, 0.1, 0.8)] {
            let limit = -quantile(p);
            let chance = |u: f64| tail((limit + libm::sqrt(rho) * quantile(u)) / libm::sqrt(1.0 - rho));
            let count = 2_000_000;
            let twice = (0..count).map(|i| chance((f64::from(i) + 0.5) / f64::from(count))).map(|q| q * q).sum::<f64>();
            let exact = (twice / f64::from(count) - p * p) / (p - p * p);
            let found: Vec<Explained> = (0..60).filter_map(|seed| of(&failures(units, seed, chance), 1)).collect();
            let held = found.iter().filter(|found| (found.share - exact).abs() < 2.0 * found.error).count();
            let mean = found.iter().map(|found| found.share).sum::<f64>() / 60.0;
            println!("{p} {rho}: {exact:.4}, mean {mean:.4}, {held} of 60 hold");
            assert!(held >= 51 && (mean / exact - 1.0).abs() < 0.06, "{p} {rho}: {exact} {mean} {held}");
        }
    }

    /// Of variables without effect hardly any exceeds what chance does.
    #[test]
    fn chance_is_rarely_taken_for_a_cause() {
        for (units, p) in [(150, 0.5), (1_000, 0.01), (5_000, 1e-3), (20_000, 0.3)] {
            let mut lucky = 0;
            for trial in 0..60 {
                let of = |k: u64| of(&failures(units, 1000 * trial + k, |_| p), 30);
                let figures: Vec<Explained> = (0..30).filter_map(of).collect();
                lucky += u32::from(figures.iter().any(|found| found.share > found.chance));
            }
            assert!(lucky <= 6, "{units} {p}: {lucky} of 60");
        }
    }

    /// A force that jumps, as between units that run and units that jam, and one that grows steadily.
    #[test]
    fn figures_that_are_not_yes_or_no_have_their_share() {
        let normal = |seed| {
            let mut uniform = uniforms(seed);
            move || quantile(uniform())
        };
        let units = 5_000;
        let x = |i: usize| quantile((i as f64 + 0.5) / units as f64);
        let spread = (0..units).map(|i| x(i) * x(i)).sum::<f64>() / units as f64;
        type Case = (fn(f64) -> f64, f64, f64);
        let cases: [Case; 3] = [
            (|x| if x < 0.467_7 { 4.0 } else { 1.2 }, 0.0, 2.8 * 2.8 * 0.68 * 0.32),
            (|x| if x < -2.326_3 { 4.0 } else { 1.2 }, 0.1, 2.8 * 2.8 * 0.01 * 0.99),
            (|x| 2.0 * x, 1.0, 4.0),
        ];
        for (of_x, noise, variance) in cases {
            let variance = if noise == 1.0 { variance * spread } else { variance };
            let mut normal = normal(3);
            let figures: Vec<f64> = (0..units).map(|i| of_x(x(i)) + noise * normal()).collect();
            let mean = figures.iter().sum::<f64>() / units as f64;
            let marked: Vec<Marked> =
                (0..).zip(&figures).map(|(place, figure)| Marked { place, value: figure - mean }).collect();
            let found = explained(units as u64, &marked, 20).unwrap();
            let exact = variance / (variance + noise * noise);
            assert!((found.share - exact).abs() < 3.0 * found.error && found.error < 0.025, "{exact} {found:?}");
        }
    }

    #[test]
    fn what_does_not_vary_is_not_explained() {
        assert_eq!(explained(200, &[], 3), None);
        let all: Vec<Marked> = (0..200).map(|place| Marked { place, value: 1.0 }).collect();
        assert_eq!(explained(200, &all, 3), None);
    }
}
