//! slipfit's results of a stack beside those of the test's own.

use slipfit::{
    scene::SceneFile,
    tolerance::{
        analysis::conclude,
        counting::study::{Settings, Study},
        report::{MeasureReport, Report, report},
        sampling::sampler::Method,
    },
};

use super::{
    assembly::Product,
    chance::Chance,
    expected::{Units, apart, extremes, moments, total_indices},
    expression::Kind,
    stack::Stack,
};

/// How many standard errors two results may differ by. A normal is beyond with a probability of 8e-11, so that not one of the
/// hundred million comparisons of a day is expected to be.
pub const ERRORS: f64 = 6.5;
/// What the passes of a solver may leave of 0 (mm, °).
const ROUNDING: f64 = 1e-6;
/// Units that slipfit draws, and that are drawn without it.
pub const UNITS: usize = 8192;

/// What was found wrong.
#[derive(Default)]
pub struct Deviations {
    pub all: Vec<String>,
}

impl Deviations {
    pub fn that(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            self.all.push(what());
        }
    }

    pub fn near(&mut self, what: &str, found: f64, expected: f64, bound: f64) {
        // Not a number is beyond every bound.
        let holds = (found - expected).abs() <= bound || found == expected;
        self.that(holds, || format!("{what}: {found}, not {expected} within {bound:e}"));
    }
}

/// An analysis by slipfit, and the measures (mm, rad, 1) of its units.
pub struct Analysed {
    pub report: Report,
    pub units: Vec<Vec<f64>>,
}

/// mm, rad or 1 for the SI unit; mm, ° or 1 for these.
fn scales(kind: Kind) -> [f64; 2] {
    match kind {
        Kind::Length => [1e3, 1.0],
        Kind::Angle => [1.0, 180.0 / std::f64::consts::PI],
        Kind::Ratio => [1.0, 1.0],
    }
}

/// Reads and analyses a scene whose measures have these kinds.
///
/// # Errors
/// What slipfit refuses.
pub fn analysed(text: &str, kinds: &[Kind], settings: Settings) -> Result<Analysed, String> {
    let file = SceneFile::parse("random.toml", text, &[]).map_err(|error| format!("refused: {error}"))?;
    let model = file.product.ok_or("no product")?.model;
    let study = Study::new(&model, settings).map_err(|error| error.to_string())?;
    let mut tallies = study.empty();
    study.add(0..settings.blocks(), &mut tallies, |_| ());
    let analysis = conclude(&study, &tallies).map_err(|error| error.to_string())?;
    let mut units = vec![Vec::new(); kinds.len()];
    for first in (0..settings.samples).step_by(8) {
        let left = (settings.samples - first).min(8) as usize;
        for ((values, measure), kind) in units.iter_mut().zip(study.unit_measures(first)).zip(kinds) {
            values.extend(measure.0[..left].iter().map(|x| x * scales(*kind)[0]));
        }
    }
    Ok(Analysed { report: report("random", &model, &analysis), units })
}

/// The measures of random units of a stack, measure by measure.
pub fn drawn(stack: &Stack, chance: &mut Chance) -> Vec<Vec<f64>> {
    let units = Units::new(stack);
    let mut drawn = vec![Vec::with_capacity(UNITS); stack.measures.len()];
    for _ in 0..UNITS {
        let values = stack.values(&units.draw(chance));
        drawn.iter_mut().zip(values).for_each(|(all, value)| all.push(value));
    }
    drawn
}

/// Whether the `error` is that a measure cannot be computed in two of so many `units`, and hardly any of those `drawn` has one.
pub fn is_right_to_refuse(error: &str, drawn: &[Vec<f64>], units: usize) -> bool {
    let expected = |values: &Vec<f64>| values.iter().filter(|x| x.is_finite()).count() * units / UNITS;
    error.contains("can be computed in") && drawn.iter().any(|values| expected(values) < 20)
}

/// Compares all of slipfit's results of a stack.
pub fn compare(
    stack: &Stack,
    text: &str,
    method: Method,
    chance: &mut Chance,
    wrong: &mut Deviations,
) -> Option<Analysed> {
    let kinds: Vec<Kind> = stack.measures.iter().map(|measure| measure.kind).collect();
    let replicates = if method == Method::PseudoRandom { 1 } else { 8 };
    let settings = Settings { method, samples: UNITS as u64, replicates, seed: chance.below(1 << 30) as u64 };
    let analysed = analysed(text, &kinds, settings);
    let drawn = drawn(stack, chance);
    let found = match analysed {
        Ok(found) => found,
        Err(error) => {
            if !is_right_to_refuse(&error, &drawn, UNITS / replicates as usize) {
                wrong.all.push(error);
            }
            return None;
        }
    };
    expressions(stack, &found, wrong);
    let reads = stack.reads();
    let limits: Vec<_> = stack.dimensions.iter().map(|dimension| dimension.limits()).collect();
    for (i, measure) in stack.measures.iter().enumerate() {
        let of = &found.report.measures[i];
        let scale = scales(measure.kind)[1];
        let sample: Vec<f64> = found.units[i].iter().map(|x| x * scale).collect();
        let own: Vec<f64> = drawn[i].iter().map(|x| x * scale).collect();
        counted(of, &sample, measure.limits, wrong);
        distributed(of, &sample, &own, method, wrong);
        let function = |inputs: &[f64]| stack.values(inputs)[i] * scale;
        let range = extremes(&function, &limits, &reads[i], chance);
        worst(of, range, wrong);
        if i >= stack.dimensions.len() {
            linearised(stack, of, &function, &limits, wrong);
            if stack.correlations.is_empty() && of.sd > 0.0 {
                contributors(stack, &found.report, i, scale, chance, wrong);
            }
        }
    }
    joint(stack, &found, wrong);
    Some(found)
}

/// Compares slipfit's results of an assembly.
pub fn compare_assembly(product: &Product, text: &str, method: Method, chance: &mut Chance, wrong: &mut Deviations) {
    let replicates = if method == Method::PseudoRandom { 1 } else { 8 };
    let settings = Settings { method, samples: UNITS as u64, replicates, seed: chance.below(1 << 30) as u64 };
    let found = match analysed(text, &product.kinds(), settings) {
        Ok(found) => found,
        Err(error) => return wrong.all.push(error),
    };
    let mut drawn = vec![Vec::with_capacity(UNITS); product.measures.len()];
    for _ in 0..UNITS / 2 {
        drawn.iter_mut().zip(product.draw(chance)).for_each(|(all, value)| all.push(value));
    }
    for (i, own) in drawn.iter().enumerate() {
        let of = &found.report.measures[i];
        let scale = scales(product.kinds()[i])[1];
        let sample: Vec<f64> = found.units[i].iter().map(|x| x * scale).collect();
        counted(of, &sample, [None; 2], wrong);
        distributed(of, &sample, own, method, wrong);
        let [low, high] = product.extremes(i, chance);
        let width = high - low;
        let found = of.worst_case;
        let bounds = found[0] <= low + 1e-3 * width + ROUNDING && found[1] >= high - 1e-3 * width - ROUNDING;
        wrong.that(bounds, || format!("{}: worst case {found:?} does not hold [{low}, {high}]", of.name));
        // A tilt with a lever that another tolerance gives it is not found from every start.
        let near = found[1] - found[0] <= 1.5 * width + 1e-6;
        wrong.that(near, || format!("{}: worst case {found:?} is far wider than [{low}, {high}]", of.name));
    }
}

/// Every unit's measures follow from its dimensions.
fn expressions(stack: &Stack, found: &Analysed, wrong: &mut Deviations) {
    for unit in (0..UNITS).step_by(7) {
        let inputs: Vec<f64> = (0..stack.dimensions.len()).map(|i| found.units[i][unit]).collect();
        for (i, expected) in stack.values(&inputs).into_iter().enumerate() {
            let value = found.units[i][unit];
            let same =
                (value.is_nan() && expected.is_nan()) || (value - expected).abs() <= 1e-8 * (1.0 + expected.abs());
            if !same {
                wrong.all.push(format!("{} of unit {unit}: {value}, not {expected}", stack.measures[i].name));
                return;
            }
        }
    }
}

/// The figures of a sample are those of its units.
fn counted(of: &MeasureReport, sample: &[f64], limits: [Option<f64>; 2], wrong: &mut Deviations) {
    let name = &of.name;
    let mut defined: Vec<f64> = sample.iter().copied().filter(|x| x.is_finite()).collect();
    wrong.near(&format!("{name}: undefined"), of.undefined as f64, (sample.len() - defined.len()) as f64, 0.0);
    if defined.len() < 3 {
        return;
    }
    defined.sort_by(f64::total_cmp);
    let n = defined.len() as f64;
    let [mean, sd, skew, kurtosis] = moments(&defined);
    let size = defined[0].abs().max(defined[defined.len() - 1].abs());
    wrong.near(&format!("{name}: mean of its units"), of.mean, mean, 1e-9 * size + 1e-9 * sd);
    wrong.near(&format!("{name}: sd of its units"), of.sd, sd, 1e-6 * sd + 1e-9 * size);
    wrong.near(&format!("{name}: min"), of.min, defined[0], 1e-12 * size);
    wrong.near(&format!("{name}: max"), of.max, defined[defined.len() - 1], 1e-12 * size);
    if sd > 1e-9 * size {
        wrong.near(&format!("{name}: skew of its units"), of.skew.unwrap_or(f64::NAN), skew, 1e-5 * (1.0 + skew.abs()));
        wrong.near(
            &format!("{name}: kurtosis of its units"),
            of.kurtosis.unwrap_or(f64::NAN),
            kurtosis,
            1e-5 * kurtosis,
        );
    }
    // A point is good to a bin: somewhere within one of it the share is the stated one, to within a unit.
    let bin = sd / 64.0 + 1e-9 * size;
    for (what, point, share) in
        [("0.135 % point", of.q00135, 0.001_35), ("median", of.median, 0.5), ("99.865 % point", of.q99865, 0.998_65)]
    {
        let below = |x: f64| defined.partition_point(|value| *value < x) as f64;
        let up_to = |x: f64| defined.partition_point(|value| *value <= x) as f64;
        let rank = share * n;
        let holds = below(point - bin) <= rank + 1.0 && up_to(point + bin) >= rank - 1.0;
        wrong.that(holds, || format!("{name}: {what} {point}: {} of {n} units lie below", below(point)));
    }
    let sides = [
        limits[0].map(|limit| defined.iter().filter(|x| **x < limit).count()),
        limits[1].map(|limit| defined.iter().filter(|x| **x > limit).count()),
    ];
    for ((side, estimate), what) in
        sides.iter().zip([of.estimates.dpm_below, of.estimates.dpm_above]).zip(["below", "above"])
    {
        let share = side.map(|count| count as f64 / sample.len() as f64 * 1e6);
        wrong.that(share.is_some() == estimate.is_some(), || format!("{name}: defects {what} missing"));
        if let (Some(share), Some(estimate)) = (share, estimate) {
            wrong.near(&format!("{name}: counted defects {what}"), estimate.value, share, 1e-6 * share + 1e-6);
        }
    }
    let [low, high] = limits;
    let (below, above) = (low.map_or(f64::INFINITY, |low| mean - low), high.map_or(f64::INFINITY, |high| high - mean));
    if sd > 1e-9 * size && (low.is_some() || high.is_some()) {
        let ppk = below.min(above) / (3.0 * sd);
        wrong.near(&format!("{name}: Ppk of its units"), of.ppk.unwrap_or(f64::NAN), ppk, 1e-5 * (1.0 + ppk.abs()));
    }
    if let (Some(low), Some(high)) = (low, high)
        && sd > 1e-9 * size
    {
        let pp = (high - low) / (6.0 * sd);
        wrong.near(&format!("{name}: Pp of its units"), of.pp.unwrap_or(f64::NAN), pp, 1e-5 * pp);
    }
    if low.is_some() || high.is_some() {
        let outside: usize = sides.iter().flatten().sum();
        let good = (defined.len() - outside) as f64 / sample.len() as f64;
        wrong.near(
            &format!("{name}: counted yield"),
            of.estimates.good.map_or(f64::NAN, |good| good.value),
            good,
            1e-9,
        );
    }
}

/// The units are distributed like those that were drawn without slipfit, and so are the figures by formula.
fn distributed(of: &MeasureReport, sample: &[f64], own: &[f64], method: Method, wrong: &mut Deviations) {
    let name = &of.name;
    let sorted = |values: &[f64]| {
        let mut values: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let share = |values: &[f64]| values.iter().filter(|x| !x.is_finite()).count() as f64 / values.len() as f64;
    let (a, b) = (share(sample), share(own));
    let n = sample.len().min(own.len()) as f64;
    wrong.near(
        &format!("{name}: share that is undefined"),
        a,
        b,
        ERRORS * libm::sqrt(2.0 * (b * (1.0 - b) + 1.0 / n) / n),
    );
    let (sample, own) = (sorted(sample), sorted(own));
    if sample.len() < 100 || own.len() < 100 {
        return;
    }
    let size = own[0].abs().max(own[own.len() - 1].abs());
    if own[own.len() - 1] - own[0] <= 1e-9 * size + ROUNDING {
        // It does not vary.
        wrong.near(&format!("{name}: least of a constant"), sample[0], own[0], 1e-8 * size + ROUNDING);
        wrong.near(
            &format!("{name}: greatest of a constant"),
            sample[sample.len() - 1],
            own[0],
            1e-8 * size + ROUNDING,
        );
        return;
    }
    // Dvoretzky, Kiefer, Wolfowitz, Massart: beyond with a probability of 2·e^(−2nd²), here 1e-10, for either sample.
    let bound = |n: usize| libm::sqrt(libm::log(2e10) / (2.0 * n as f64));
    let distance = apart(&sample, &own);
    wrong.that(distance <= bound(sample.len()) + bound(own.len()), || {
        format!("{name}: distribution functions are {distance} apart")
    });
    let ([mean, sd, ..], [own_mean, own_sd, _, own_kurtosis]) = (moments(&sample), moments(&own));
    // With heavier tails a mean of so many is not normal.
    if own_kurtosis > 30.0 {
        return;
    }
    let n = own.len() as f64;
    let (of_mean, of_sd) = (own_sd / libm::sqrt(n), own_sd * libm::sqrt((own_kurtosis - 1.0) / (4.0 * n)));
    let both = if method == Method::PseudoRandom { std::f64::consts::SQRT_2 } else { 1.3 };
    wrong.near(&format!("{name}: mean"), mean, own_mean, ERRORS * both * of_mean);
    wrong.near(&format!("{name}: sd"), sd, own_sd, ERRORS * both * of_sd);
    let formulas = [
        of.quadrature.map(|q| ("by quadrature", q.mean, q.sd)),
        of.second_order.map(|s| ("of second order", s.mean, s.sd)),
    ];
    for (what, mean, sd) in formulas.into_iter().flatten() {
        // The second order is an approximation: where it describes the measure, within a twentieth of its spread.
        let more = if what == "by quadrature" { 0.0 } else { 0.05 * own_sd };
        wrong.near(&format!("{name}: mean {what}"), mean, own_mean, ERRORS * of_mean + more);
        wrong.near(&format!("{name}: sd {what}"), sd, own_sd, ERRORS * of_sd + more);
    }
    for ((side, limit), what) in of.dpm.iter().zip(of.limits).zip(["below", "above"]) {
        let (Some(side), Some(limit)) = (side, limit) else { continue };
        let outside = own.iter().filter(|x| if what == "below" { **x < limit } else { **x > limit }).count();
        // Of all units, those that are undefined included.
        let p = outside as f64 / UNITS as f64;
        let error = side.error.unwrap_or(0.0) / 1e6;
        let expected = side.dpm / 1e6;
        // Counted in both samples; the rule of succession keeps the error of few hits from being 0.
        let least = (p * n + 1.0) / (n + 2.0);
        let bound = ERRORS * libm::sqrt(least * (1.0 - least) / n + error * error)
            + 20.0 / n * f64::from(u8::from(p * n < 20.0));
        wrong.near(&format!("{name}: defects {what} ({:?})", side.source), expected, p, bound);
    }
}

/// The worst case bounds what corners and a search find, and is no wider.
fn worst(of: &MeasureReport, [low, high]: [f64; 2], wrong: &mut Deviations) {
    let size = low.abs().max(high.abs());
    let bound = 1e-3 * (high - low) + 1e-9 * size + 1e-12;
    wrong.near(&format!("{}: worst case, least", of.name), of.worst_case[0], low, bound);
    wrong.near(&format!("{}: worst case, greatest", of.name), of.worst_case[1], high, bound);
}

/// Slopes at the middle of the limits (Richardson's extrapolation), and RSS by them.
fn linearised(
    stack: &Stack,
    of: &MeasureReport,
    function: &dyn Fn(&[f64]) -> f64,
    limits: &[[f64; 2]],
    wrong: &mut Deviations,
) {
    let Some(rss) = of.rss else { return };
    let middle: Vec<f64> = limits.iter().map(|[low, high]| 0.5 * (low + high)).collect();
    let part = |(k, [low, high]): (usize, &[f64; 2])| {
        let half = 0.5 * (high - low);
        let slope = |h: f64| {
            let at = |sign: f64| {
                let mut place = middle.clone();
                place[k] += sign * h * half;
                function(&place)
            };
            (at(1.0) - at(-1.0)) / (2.0 * h)
        };
        (4.0 * slope(0.005) - slope(0.01)) / 3.0
    };
    let parts: Vec<f64> = limits.iter().enumerate().map(part).collect();
    let correlated =
        stack.correlations.iter().map(|(a, b, _)| 2.0 * stack.value_correlation(*a, *b) * parts[*a] * parts[*b]);
    let square = parts.iter().map(|part| part * part).sum::<f64>() + correlated.sum::<f64>();
    let size = function(&middle).abs();
    let expected = libm::sqrt(square.max(0.0));
    wrong.near(&format!("{}: RSS, middle", of.name), rss.middle, function(&middle), 1e-9 * (1.0 + size));
    // The correlation of values whose ranks are correlated is good to a thousandth.
    let bound = if stack.correlations.is_empty() { 1e-4 } else { 5e-3 } * expected + 1e-9 * size;
    wrong.near(&format!("{}: RSS", of.name), rss.tolerance, expected, bound);
}

/// Shares of the contributors are those of their total indices.
fn contributors(stack: &Stack, report: &Report, i: usize, scale: f64, chance: &mut Chance, wrong: &mut Deviations) {
    let of = &report.measures[i];
    // So many that lots of a thousandth, far away, are among them.
    const COUNT: usize = 8000;
    let totals = total_indices(stack, i, COUNT, chance);
    let sum: f64 = totals.iter().map(|[total, _]| total).sum();
    // Without two units in which it is defined there is nothing to share.
    if sum.is_nan() || sum * scale * scale <= 1e-18 {
        return;
    }
    let note = |text: &str| report.notes.iter().find(|note| note.starts_with(&of.name) && note.contains(text));
    // Withheld, and said so, where few of its units have the measure, or differ: then its kurtosis is large.
    let few = 2 * of.undefined as usize > UNITS || of.kurtosis.is_none_or(|kurtosis| kurtosis > 50.0);
    if few && of.contributors.iter().all(|share| share.percent.is_none()) {
        let is_said = note("too few units have it").or(note("too few units differ")).is_some();
        return wrong.that(is_said, || format!("{}: shares are withheld without a note", of.name));
    }
    // Where few units carry the variance the shares have the standard error that is said.
    let said = note("standard error of").and_then(|note| {
        let (_, after) = note.split_once("standard error of ")?;
        after.split(' ').next()?.parse::<f64>().ok()
    });
    for (dimension, [total, error]) in stack.dimensions.iter().zip(totals) {
        let found = of.contributors.iter().find(|share| share.name == dimension.name).and_then(|share| share.percent);
        // Both have an error; slipfit's 4096 units are spread evenly. Products of few large numbers converge slowly.
        let bound = 100.0 * (ERRORS * 1.5 * error / sum) + 2.0 + ERRORS * said.unwrap_or(0.0);
        wrong.near(
            &format!("{}: share of {}", of.name, dimension.name),
            found.unwrap_or(f64::NAN),
            100.0 * total / sum,
            bound,
        );
    }
}

/// Correlations and the yield of all measures together.
fn joint(stack: &Stack, found: &Analysed, wrong: &mut Deviations) {
    let report = &found.report;
    let correlation = |i: usize, j: usize| {
        let (a, b) = (&found.units[i], &found.units[j]);
        let ([mean_a, sd_a, ..], [mean_b, sd_b, ..]) = (moments(a), moments(b));
        a.iter().zip(b).map(|(x, y)| (x - mean_a) * (y - mean_b)).sum::<f64>() / (a.len() as f64 - 1.0) / (sd_a * sd_b)
    };
    for i in 0..stack.measures.len() {
        for j in 0..i {
            if [i, j].iter().all(|k| {
                found.units[*k].iter().all(|x| x.is_finite())
                    && report.measures[*k].sd > 1e-9 * report.measures[*k].max.abs()
            }) {
                let what = format!("correlation of {} and {}", report.measures[i].name, report.measures[j].name);
                wrong.near(&what, report.correlation[i][j], correlation(i, j), 1e-6);
            }
        }
    }
    let n = UNITS as f64;
    for (a, b, coefficient) in &stack.correlations {
        let mut samples = [found.units[*a].clone(), found.units[*b].clone()];
        if stack.ranks {
            for sample in &mut samples {
                let mut order: Vec<usize> = (0..sample.len()).collect();
                order.sort_by(|one, other| sample[*one].total_cmp(&sample[*other]));
                order.into_iter().enumerate().for_each(|(rank, unit)| sample[unit] = rank as f64);
            }
        }
        let [[mean_a, sd_a, ..], [mean_b, sd_b, ..]] = [moments(&samples[0]), moments(&samples[1])];
        let products: Vec<f64> =
            samples[0].iter().zip(&samples[1]).map(|(x, y)| (x - mean_a) * (y - mean_b) / (sd_a * sd_b)).collect();
        let [mean, spread, ..] = moments(&products);
        wrong.near(
            &format!("coefficient of dimensions {a} and {b}"),
            mean,
            *coefficient,
            ERRORS * 1.5 * spread / libm::sqrt(n),
        );
    }
    if let Some(good) = report.yield_of_all {
        let is_good = |unit: &usize| {
            stack.measures.iter().enumerate().all(|(i, measure)| {
                let value = found.units[i][*unit] * scales(measure.kind)[1];
                let [low, high] = measure.limits;
                value.is_finite() && low.is_none_or(|low| value >= low) && high.is_none_or(|high| value <= high)
            })
        };
        let expected = (0..UNITS).filter(is_good).count() as f64 / n;
        wrong.near("yield of all", good.value, expected, 1e-9);
    }
    for (sum, of) in report.sums.iter().zip(&stack.sums) {
        let closed = (0..UNITS).filter(|unit| of.iter().map(|i| found.units[*i][*unit]).sum::<f64>() < 0.0).count();
        wrong.near(&format!("{} closes", sum.name), sum.counted.value, closed as f64 / n * 1e6, 100.0);
    }
}
