//! An analysis as people and machines read it: lengths in mm, angles in degrees.

use std::fmt::Write;

use serde::Serialize;

use super::{
    analysis::{Analysis, LINEAR, Source, better},
    estimate::Estimate,
    importance::Tail,
    model::{Model, Quantity},
    sampler::Method,
};

/// All of an analysis.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scene's title.
    pub title: String,
    /// How units were drawn.
    pub method: Method,
    /// Units in all.
    pub samples: u64,
    /// Independent designs they were split into.
    pub replicates: u64,
    /// Seed of the production.
    pub seed: u64,
    /// Share of units with all measures within their limits, if any has limits.
    pub yield_of_all: Option<Estimate>,
    /// Measures in the model's order.
    pub measures: Vec<MeasureReport>,
    /// Correlation matrix of the measures, row by row.
    pub correlation: Vec<Vec<f64>>,
    /// Sums that must stay positive.
    pub sums: Vec<SumReport>,
    /// What a reader has to know.
    pub notes: Vec<String>,
}

/// One measure.
#[derive(Clone, Debug, Serialize)]
pub struct MeasureReport {
    /// Name.
    pub name: String,
    /// mm, ° or empty.
    pub unit: &'static str,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Skewness.
    pub skew: f64,
    /// Kurtosis; 3 for a normal.
    pub kurtosis: f64,
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
    /// The 0.135 % point.
    pub q00135: f64,
    /// The median.
    pub median: f64,
    /// The 99.865 % point.
    pub q99865: f64,
    /// Units in which it could not be computed.
    pub undefined: u64,
    /// Specification limits.
    pub limits: [Option<f64>; 2],
    /// Width between both limits over 6σ.
    pub pp: Option<f64>,
    /// Nearer limit over 3σ.
    pub ppk: Option<f64>,
    /// Defects per million below and above, the better known of both sources.
    pub dpm: [Option<Defects>; 2],
    /// Share within the limits.
    #[serde(rename = "yield")]
    pub good: Option<f64>,
    /// The same numbers with standard errors and 95 % intervals.
    pub estimates: Estimates,
    /// Worst case by slopes.
    pub worst_case: [f64; 2],
    /// Worst case over all combinations of limits, where these are few.
    pub worst_case_vertices: Option<[f64; 2]>,
    /// Root sum of squares: value at the middle of the limits, half the tolerance, standard deviation of first order.
    pub rss: Rss,
    /// Moments of second order.
    pub second_order: SecondOrder,
    /// By contributor, largest share first.
    pub contributors: Vec<Share>,
}

/// Numbers with their errors.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs, reason = "named as in the measure")]
pub struct Estimates {
    pub mean: Estimate,
    pub sd: Estimate,
    pub skew: Estimate,
    pub kurtosis: Estimate,
    pub q00135: Estimate,
    pub median: Estimate,
    pub q99865: Estimate,
    pub pp: Option<Estimate>,
    pub ppk: Option<Estimate>,
    pub dpm_below: Option<Estimate>,
    pub dpm_above: Option<Estimate>,
    #[serde(rename = "yield")]
    pub good: Option<Estimate>,
}

/// Defects per million on one side.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Defects {
    /// Defects per million.
    pub dpm: f64,
    /// Standard error.
    pub error: Option<f64>,
    /// Where the number comes from.
    pub source: Source,
    /// Reliability index: distance of the most probable defect in standard deviations.
    pub reliability: Option<f64>,
    /// Evaluations that importance sampling took.
    pub evaluations: Option<u64>,
}

/// Root sum of squares.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs, reason = "see the report")]
pub struct Rss {
    pub middle: f64,
    pub tolerance: f64,
    pub sd: f64,
}

/// Moments of second order.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs, reason = "named as in the measure")]
pub struct SecondOrder {
    pub mean: f64,
    pub mean_shift: f64,
    pub sd: f64,
    pub skew: f64,
    pub kurtosis: f64,
}

/// What a contributor has in a measure.
#[derive(Clone, Debug, Serialize)]
pub struct Share {
    /// Name.
    pub name: String,
    /// Share in the variance of first order, in %.
    pub percent: f64,
    /// ∂measure/∂tolerance: per mm (or radian) that a scalar moves.
    pub slope: Option<f64>,
    /// How far the whole tolerance moves the measure to either side.
    pub reach: f64,
    /// Sobol' index of first order, where the measure is not linear.
    pub sobol_first: Option<f64>,
    /// Total Sobol' index, where the measure is not linear.
    pub sobol_total: Option<f64>,
}

/// One sum that must stay positive.
#[derive(Clone, Debug, Serialize)]
pub struct SumReport {
    /// Name.
    pub name: String,
    /// mm, ° or empty.
    pub unit: &'static str,
    /// Mean of second order.
    pub mean: f64,
    /// Standard deviation with the model's own correlation.
    pub sd: f64,
    /// Correlation of its measures in the sample, if there are two.
    pub correlation: Option<f64>,
    /// P(sum < 0) with the model's own correlation, ppm, the better known of both sources.
    pub model: Defects,
    /// Counted alone, ppm.
    pub counted: Estimate,
    /// ppm if the sum were normal, with the model's own correlation.
    pub normal_ppm: f64,
    /// ppm as eq. 9 reads it: normal, both measures moving together, ρ = +1.
    pub eq9_ppm: f64,
    /// ppm if normal and independent.
    pub independent_ppm: f64,
}

impl Quantity {
    /// What an SI value is multiplied by for a report.
    pub fn factor(self) -> f64 {
        match self {
            Self::Length => 1e3,
            Self::Angle => 180.0 / std::f64::consts::PI,
            Self::Ratio => 1.0,
        }
    }

    /// The unit of a report.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Length => "mm",
            Self::Angle => "°",
            Self::Ratio => "",
        }
    }
}

fn defects(counted: &Estimate, tail: Option<&Tail>) -> Defects {
    let (probability, error, source) = better(counted, tail);
    Defects {
        dpm: probability * 1e6,
        error: error.map(|error| error * 1e6),
        source,
        reliability: tail.map(|tail| tail.reliability),
        evaluations: tail.map(|tail| tail.evaluations),
    }
}

/// The report of an `analysis` of `model`.
pub fn report(title: &str, model: &Model, analysis: &Analysis) -> Report {
    let Analysis { settings, theory, joint } = analysis;
    let sum = |(i, sum): (usize, &super::model::Sum)| {
        let quantity = sum.measures.first().map_or(Quantity::Ratio, |measure| model.measures[*measure].quantity);
        let closing = &theory.closings[i];
        let pair: Option<[usize; 2]> = sum.measures.clone().try_into().ok();
        SumReport {
            name: sum.name.clone(),
            unit: quantity.unit(),
            mean: closing.mean * quantity.factor(),
            sd: closing.deviation * quantity.factor(),
            correlation: pair.map(|[one, other]| joint.correlation[one][other]),
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
        sums: model.sums.iter().enumerate().map(sum).collect(),
        notes: notes(model, analysis),
    }
}

fn measure(model: &Model, analysis: &Analysis, i: usize) -> MeasureReport {
    let (measure, theory, found) = (&model.measures[i], &analysis.theory, &analysis.joint.measures[i]);
    let factor = measure.quantity.factor();
    let scaled = |value: f64| value * factor;
    let (rss, moments, tails) = (&theory.sums_of_squares[i], theory.moments[i], &theory.tails[i]);
    let contributor = |(k, contributor): (usize, &super::model::Contributor)| {
        let sensitivity = theory.sensitivities[i][k];
        let indices = theory.indices[i].as_ref();
        Share {
            name: contributor.name.clone(),
            percent: rss.shares[k] * 100.0,
            // Per mm or radian: a length over a length has no factor.
            slope: sensitivity
                .slope
                .map(|slope| if measure.quantity == Quantity::Length { slope } else { slope * factor * 1e-3 }),
            reach: scaled(sensitivity.reach),
            sobol_first: indices.map(|indices| indices.first[k]),
            sobol_total: indices.map(|indices| indices.total[k]),
        }
    };
    let mut contributors: Vec<Share> = model.contributors.iter().enumerate().map(contributor).collect();
    contributors.sort_by(|one, other| other.percent.total_cmp(&one.percent));
    let [q00135, median, q99865] = found.points.map(|point| point.scaled(factor));
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
        dpm_below: per_million(found.outside[0]),
        dpm_above: per_million(found.outside[1]),
        good: found.good,
    };
    MeasureReport {
        name: measure.name.clone(),
        unit: measure.quantity.unit(),
        mean: estimates.mean.value,
        sd: estimates.sd.value,
        skew: found.skewness.value,
        kurtosis: found.kurtosis.value,
        min: scaled(found.extremes[0]),
        max: scaled(found.extremes[1]),
        q00135: q00135.value,
        median: median.value,
        q99865: q99865.value,
        undefined: found.undefined,
        limits: measure.limits.map(|limit| limit.map(scaled)),
        pp: found.pp.map(|pp| pp.value),
        ppk: found.ppk.map(|ppk| ppk.value),
        dpm: [0, 1].map(|side| found.outside[side].map(|counted| defects(&counted, tails[side].as_ref()))),
        good: found.good.map(|good| good.value),
        estimates,
        worst_case: theory.worst_cases[i].linear.map(scaled),
        worst_case_vertices: theory.worst_cases[i].vertices.map(|range| range.map(scaled)),
        rss: Rss { middle: scaled(rss.middle), tolerance: scaled(rss.tolerance), sd: scaled(rss.deviation) },
        second_order: SecondOrder {
            mean: scaled(moments.mean),
            mean_shift: scaled(moments.shift),
            sd: scaled(moments.deviation),
            skew: moments.skewness,
            kurtosis: moments.kurtosis,
        },
        contributors,
    }
}

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
    for (measure, moments) in model.measures.iter().zip(&analysis.theory.moments) {
        if moments.curved > LINEAR {
            let percent = moments.curved * 100.0;
            let mut note = String::new();
            let _ = write!(note, "{} is not linear: {percent:.2} % of its variance is curvature", measure.name);
            notes.push(note);
        }
    }
    for (measure, found) in model.measures.iter().zip(&analysis.joint.measures) {
        if found.undefined > 0 {
            notes.push(format!("{} could not be computed in {} units", measure.name, found.undefined));
        }
    }
    notes
}

/// Measures, one line each, as CSV.
///
/// # Errors
/// Those of the writer, none in memory.
pub fn measures_csv(report: &Report) -> anyhow::Result<Vec<u8>> {
    use crate::number::ten_digits;
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "measure",
        "unit",
        "mean",
        "mean_error",
        "sd",
        "sd_error",
        "skew",
        "kurtosis",
        "min",
        "q00135",
        "median",
        "q99865",
        "max",
        "lower",
        "upper",
        "pp",
        "ppk",
        "dpm_below",
        "dpm_above",
        "yield",
        "worst_low",
        "worst_high",
        "rss_middle",
        "rss_tolerance",
        "second_order_mean",
        "second_order_sd",
    ])?;
    let optional = |x: Option<f64>| x.map_or_else(String::new, ten_digits);
    for m in &report.measures {
        let [below, above] = m.dpm.map(|side| side.map(|side| side.dpm));
        let numbers = [
            Some(m.mean),
            m.estimates.mean.error,
            Some(m.sd),
            m.estimates.sd.error,
            Some(m.skew),
            Some(m.kurtosis),
            Some(m.min),
            Some(m.q00135),
            Some(m.median),
            Some(m.q99865),
            Some(m.max),
            m.limits[0],
            m.limits[1],
            m.pp,
            m.ppk,
            below,
            above,
            m.good,
            Some(m.worst_case[0]),
            Some(m.worst_case[1]),
            Some(m.rss.middle),
            Some(m.rss.tolerance),
            Some(m.second_order.mean),
            Some(m.second_order.sd),
        ];
        let record = [m.name.clone(), m.unit.into()].into_iter().chain(numbers.map(optional));
        writer.write_record(record)?;
    }
    Ok(writer.into_inner()?)
}
