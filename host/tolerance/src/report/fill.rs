//! A report from an analysis.

use super::contents::{
    Defects, Estimates, LossReport, MeasureReport, Quadrature, Report, Rss, SecondOrder, Share, SumReport,
};
use crate::{
    analysis::{Analysis, better},
    failure::{
        importance::REPLICATES,
        tail::{Source, Tail},
    },
    model::{Contributor, Model, Quantity, Sum},
    sampling::sampler::Method,
    statistics::{
        estimate::{Estimate, Statistics},
        interval::student_factor,
    },
    theory::moments::Moments,
};

fn defects(counted: &Estimate, tail: Option<&Tail>) -> Defects {
    let (probability, error, source) = better(counted, tail);
    let interval = match (source, error) {
        (Source::ImportanceSampling | Source::SubsetSimulation, Some(error)) => {
            let half = student_factor(REPLICATES as usize) * error;
            [probability - half, probability + half].map(|end| Some(end.clamp(0.0, 1.0)))
        }
        _ => counted.interval,
    };
    Defects {
        dpm: probability * 1e6,
        error: error.map(|error| error * 1e6),
        source,
        interval: interval.map(|end| end.map(|end| end * 1e6)),
        reliability: tail.and_then(|tail| tail.reliability),
        evaluations: tail.map(|tail| tail.evaluations),
    }
}

/// The report of an `analysis` of `model`.
pub fn report(title: &str, model: &Model, analysis: &Analysis) -> Report {
    let Analysis { settings, theory, joint } = analysis;
    let sum = |(i, sum): (usize, &Sum)| {
        let quantity = sum.measures.first().map_or(Quantity::Ratio, |measure| model.measures[*measure].quantity);
        let closing = &theory.closings[i];
        let pair: Option<[usize; 2]> = sum.measures.clone().try_into().ok();
        SumReport {
            name: sum.name.clone(),
            unit: quantity.unit(),
            mean: closing.mean * quantity.factor(),
            sd: closing.deviation * quantity.factor(),
            correlation: pair.map(|[one, other]| joint.correlation[one][other]),
            correlation_interval: pair.map(|[one, other]| joint.correlation_intervals[one][other]),
            model: defects(&joint.closed[i], closing.tail.as_ref()),
            counted: joint.closed[i].scaled(1e6),
            normal_ppm: closing.normal * 1e6,
            eq9_ppm: closing.together * 1e6,
            independent_ppm: closing.independent * 1e6,
        }
    };
    Report {
        title: title.into(),
        method: settings.method,
        samples: settings.samples,
        replicates: settings.replicates,
        seed: settings.seed,
        yield_of_all: joint.good,
        measures: (0..model.measures.len()).map(|i| measure(model, analysis, i)).collect(),
        correlation: joint.correlation.clone(),
        correlation_intervals: joint.correlation_intervals.clone(),
        sums: model.sums.iter().enumerate().map(sum).collect(),
        notes: notes(model, analysis),
    }
}

/// What a slope is per: its size in the SI unit, inverted, and its name.
fn per(quantity: Quantity) -> (f64, &'static str) {
    if quantity == Quantity::Angle { (1.0, "rad") } else { (quantity.factor(), quantity.unit()) }
}

/// Share of the units' standard deviation below which that of second order misses what makes them differ.
const MISSED: f64 = 0.1;

/// Whether units of a measure differ that is level by its `moments` of second order: what makes them differ is met by few.
fn misses_variation(moments: &Moments, found: &Statistics) -> bool {
    let [low, high] = found.extremes;
    let is_rounding = high - low <= 1e-9 * low.abs().max(high.abs());
    !is_rounding && moments.deviation < MISSED * found.deviation.value
}

fn measure(model: &Model, analysis: &Analysis, i: usize) -> MeasureReport {
    let (measure, theory, found) = (&model.measures[i], &analysis.theory, &analysis.joint.measures[i]);
    let factor = measure.quantity.factor();
    let scaled = |value: f64| value * factor;
    let (rss, moments, tails) = (&theory.sums_of_squares[i], theory.moments[i], &theory.tails[i]);
    let is_missed = misses_variation(&moments, found);
    let by_slopes = moments.by_slopes() && !is_missed;
    let total: f64 = theory.indices[i].as_ref().map_or(0.0, |indices| indices.total.iter().sum());
    let by_indices = total > 0.0 && (!by_slopes || moments.curved > COUNTS);
    let percent = |k: usize| match &theory.indices[i] {
        Some(indices) if by_indices => Some(indices.total[k] / total * 100.0),
        _ => by_slopes.then(|| rss.shares[k] * 100.0),
    };
    let moved: Vec<_> = model.offsets().into_iter().map(|at| per(model.function.quantity(at))).collect();
    let contributor = |(k, contributor): (usize, &Contributor)| {
        let sensitivity = theory.sensitivities[i][k];
        let indices = theory.indices[i].as_ref();
        Share {
            name: contributor.name.clone(),
            percent: percent(k),
            slope: sensitivity.slope.map(|slope| slope * (factor / moved[k].0)),
            per: sensitivity.slope.map(|_| moved[k].1),
            reach: scaled(sensitivity.reach),
            sobol_first: indices.map(|indices| indices.first[k]),
            sobol_total: indices.map(|indices| indices.total[k]),
        }
    };
    let mut contributors: Vec<Share> = model.contributors.iter().enumerate().map(contributor).collect();
    let size = |share: &Share| share.percent.unwrap_or(0.0);
    contributors.sort_by(|one, other| size(other).total_cmp(&size(one)));
    let [q00135, median, q99865] = found.points.map(|point| point.scaled(factor));
    let [pp_by_points, ppk_by_points] = found.by_points.unwrap_or_default();
    let finite = |estimate: Option<Estimate>| estimate.map(|found| found.value).filter(|value| value.is_finite());
    let per_million = |share: Option<Estimate>| share.map(|share| share.scaled(1e6));
    let estimates = Estimates {
        mean: found.mean.scaled(factor),
        sd: found.deviation.scaled(factor),
        skew: found.skewness,
        kurtosis: found.kurtosis,
        q00135,
        median,
        q99865,
        pp: found.pp,
        ppk: found.ppk,
        pp_by_points,
        ppk_by_points,
        dpm_below: per_million(found.outside[0]),
        dpm_above: per_million(found.outside[1]),
        good: found.good,
    };
    MeasureReport {
        name: measure.name.clone(),
        unit: measure.quantity.unit(),
        mean: estimates.mean.value,
        sd: estimates.sd.value,
        skew: found.skewness.map(|skewness| skewness.value),
        kurtosis: found.kurtosis.map(|kurtosis| kurtosis.value),
        min: scaled(found.extremes[0]),
        max: scaled(found.extremes[1]),
        q00135: q00135.value,
        median: median.value,
        q99865: q99865.value,
        undefined: found.undefined,
        nominal: theory.nominal.as_ref().map(|nominal| scaled(nominal[i])),
        limits: measure.limits.map(|limit| limit.map(scaled)),
        pp: finite(found.pp),
        ppk: finite(found.ppk),
        normal: moments.shape.is_normal(),
        pp_by_points: finite(pp_by_points),
        ppk_by_points: finite(ppk_by_points),
        dpm: [0, 1].map(|side| found.outside[side].map(|counted| defects(&counted, tails[side].as_ref()))),
        good: found.good.map(|good| good.value),
        loss: model.function.loss(i).zip(found.loss).map(|(loss, mean)| LossReport {
            target: scaled(loss.target),
            coefficient: loss.coefficient() / (factor * factor),
            mean,
            signal_to_noise: Some(loss.signal_to_noise(found.mean.value, found.deviation.value))
                .filter(|ratio| ratio.is_finite()),
            balanced_tolerance: loss.tolerance().map(scaled),
        }),
        estimates,
        worst_case: theory.worst_cases[i].range.map(scaled),
        worst_case_linear: Some(theory.worst_cases[i].linear.map(scaled))
            .filter(|ends| ends.iter().all(|x| x.is_finite())),
        by_indices,
        rss: by_slopes.then(|| Rss {
            middle: scaled(rss.middle),
            tolerance: scaled(rss.tolerance),
            bender: scaled(rss.modified.bender),
            gilson: scaled(rss.modified.gilson),
            modified: scaled(rss.modified.by_count),
            sd: scaled(rss.deviation),
        }),
        second_order: (moments.described && !is_missed).then(|| SecondOrder {
            mean: scaled(moments.mean),
            mean_shift: scaled(moments.shift),
            sd: scaled(moments.deviation),
            skew: Some(moments.skewness).filter(|skewness| skewness.is_finite()),
            kurtosis: Some(moments.kurtosis).filter(|kurtosis| kurtosis.is_finite()),
        }),
        quadrature: theory.exact[i].map(|exact| Quadrature {
            mean: scaled(exact.mean),
            sd: scaled(exact.deviation),
            skew: exact.skewness,
            kurtosis: exact.kurtosis,
        }),
        contributors,
    }
}

/// Share of the curvature in a variance from which on a note says so.
const NOTED: f64 = 1e-3;
/// The same from which on contributors have total Sobol' indices instead of shares in the variance of first order.
const COUNTS: f64 = 1e-2;

/// The standard error of contributors' shares from which on a note states it.
const UNCERTAIN: f64 = 0.03;

fn notes(model: &Model, analysis: &Analysis) -> Vec<String> {
    let mut notes = Vec::new();
    let settings = analysis.settings;
    if settings.method == Method::ScrambledSobol && !settings.units().is_power_of_two() {
        notes.push(format!(
            "{} Sobol' points a replicate are not a power of two: they are less even than they could be",
            settings.units()
        ));
    }
    if settings.method != Method::PseudoRandom && settings.replicates < 2 {
        notes.push("one replicate of a design has no standard error: see --replicates".into());
    }
    let theory = &analysis.theory;
    let found = &analysis.joint.measures;
    for (((measure, moments), indices), found) in
        model.measures.iter().zip(&theory.moments).zip(&theory.indices).zip(found)
    {
        let contributors = match indices {
            Some(indices) if indices.total.iter().sum::<f64>() > 0.0 => "; its contributors are by Sobol' indices",
            None if found.undefined > 0 && model.correlations.is_empty() => {
                "; too few units have it to tell what its contributors are"
            }
            _ if misses_variation(moments, found) => "; too few units differ to tell what its contributors are",
            _ => "",
        };
        if !moments.described || misses_variation(moments, found) {
            notes.push(format!(
                "{} has a kink or a fold where it varies, as a radius or an angle has at 0: slopes do not describe it{contributors}",
                measure.name
            ));
        } else if !moments.by_slopes() {
            let percent = moments.curved * 100.0;
            notes.push(format!(
                "{} is far from linear: curvature changes its variance by {percent:.2} %; slopes do not describe it{contributors}",
                measure.name
            ));
        } else if moments.curved >= NOTED {
            let percent = moments.curved * 100.0;
            notes.push(format!("{} is not linear: curvature changes its variance by {percent:.2} %", measure.name));
        }
        if let Some(indices) = indices.as_ref().filter(|indices| indices.error > UNCERTAIN) {
            notes.push(format!(
                "{}: the shares of its contributors by Sobol' indices have a standard error of {:.0} points: few units carry its variance",
                measure.name,
                indices.error * 100.0
            ));
        }
    }
    for (measure, (tails, found)) in
        model.measures.iter().zip(analysis.theory.tails.iter().zip(&analysis.joint.measures))
    {
        let unknown = |(tail, counted): (&Option<Tail>, &Option<Estimate>)| tail.is_none() && counted.is_some();
        if tails.iter().zip(&found.outside).any(unknown) {
            notes.push(format!(
                "{}: no sampled figure of its defects agrees with itself and with the units, these are counted ones",
                measure.name
            ));
        }
    }
    for (measure, found) in model.measures.iter().zip(&analysis.joint.measures) {
        if found.undefined > 0 {
            notes.push(format!(
                "{} could not be computed in {} units, which count as outside of its limits",
                measure.name, found.undefined
            ));
        }
    }
    for (measure, worst) in model.measures.iter().zip(&analysis.theory.worst_cases) {
        if worst.range[0] <= worst.range[1] && worst.range.iter().any(|end| end.is_infinite()) {
            notes.push(format!(
                "{} grows beyond all bounds near some point within the limits: it has no worst case there",
                measure.name
            ));
        } else if worst.undefined {
            notes.push(format!(
                "{} cannot be computed everywhere within the limits: its worst case is that of all that can",
                measure.name
            ));
        }
    }
    notes
}
