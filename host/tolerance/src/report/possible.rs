//! Unknowns of a production widen the intervals of its report.

use super::contents::{Defects, Report};
use crate::statistics::{estimate::Estimate, interval::of_values};

/// Widens the intervals and errors of `report`, which is of the likeliest production, by `possible` reports of the same model
/// and productions that are drawn with their probability.
///
/// What the sampling errors explain of the variance of a figure among them is taken away; its 95 % interval is that of what
/// remains, with the sampling error of the report itself added in quadrature.
pub fn widen(report: &mut Report, possible: &[Report]) {
    let mut possible = possible.to_vec();
    let others: Vec<Vec<Option<Estimate>>> =
        possible.iter_mut().map(|report| figures(report).into_iter().map(|figure| figure.copied()).collect()).collect();
    for (number, figure) in figures(report).into_iter().enumerate() {
        let Some(figure) = figure else { continue };
        *figure = widened(*figure, others.iter().filter_map(|figures| figures[number]));
    }
    let shares = report.measures.iter_mut().filter_map(|measure| measure.estimates.good.as_mut());
    for share in report.yield_of_all.iter_mut().chain(shares) {
        share.interval = share.interval.map(|end| end.map(|end| end.clamp(0.0, 1.0)));
    }
    for (i, row) in report.correlation_intervals.iter_mut().enumerate() {
        for (j, interval) in row.iter_mut().enumerate().filter(|(j, _)| *j != i) {
            let of = |report: &Report| (report.correlation[i][j], report.correlation_intervals[i][j]);
            let estimate = |(value, interval)| Estimate { value, error: None, interval };
            let own = estimate((report.correlation[i][j], *interval));
            *interval = widened(own, possible.iter().map(|report| estimate(of(report)))).interval;
        }
    }
    for (i, sum) in report.sums.iter_mut().enumerate() {
        widen_defects(&mut sum.model, possible.iter().map(|report| report.sums[i].model));
        if let Some((value, interval)) = sum.correlation.zip(sum.correlation_interval.as_mut()) {
            let own = Estimate { value, error: None, interval: *interval };
            let other = |report: &Report| Some(Estimate { value: report.sums[i].correlation?, ..own });
            *interval = widened(own, possible.iter().filter_map(other)).interval;
        }
    }
    for (i, measure) in report.measures.iter_mut().enumerate() {
        for (side, defects) in measure.dpm.iter_mut().enumerate() {
            let others = possible.iter().filter_map(|report| report.measures[i].dpm[side]);
            defects.iter_mut().for_each(|defects| widen_defects(defects, others.clone()));
        }
    }
}

/// The estimates of a `report` in a fixed order, with those that it does not have.
fn figures(report: &mut Report) -> Vec<Option<&mut Estimate>> {
    let mut all = vec![report.yield_of_all.as_mut()];
    for measure in &mut report.measures {
        let of = &mut measure.estimates;
        all.extend([&mut of.mean, &mut of.sd, &mut of.q00135, &mut of.median, &mut of.q99865].map(Some));
        all.extend([of.skew.as_mut(), of.kurtosis.as_mut(), of.pp.as_mut(), of.ppk.as_mut()]);
        all.extend([of.pp_by_points.as_mut(), of.ppk_by_points.as_mut()]);
        all.extend([of.dpm_below.as_mut(), of.dpm_above.as_mut(), of.good.as_mut()]);
        all.push(measure.loss.as_mut().map(|loss| &mut loss.mean));
    }
    all
}

/// `own` with the interval of what `others` have.
fn widened(own: Estimate, others: impl Iterator<Item = Estimate>) -> Estimate {
    let (mut values, mut noise) = (Vec::new(), 0.0);
    for other in others.filter(|other| other.value.is_finite()) {
        values.push(other.value);
        noise += other.error.map_or(0.0, |error| error * error);
    }
    if values.len() < 2 || !own.value.is_finite() {
        return own;
    }
    values.sort_by(f64::total_cmp);
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (count - 1.0);
    let left = libm::sqrt((1.0 - noise / count / square).max(0.0));
    let left = if left.is_finite() { left } else { 0.0 };
    let ends = of_values(&values).map(|end| mean + left * (end - mean));
    let error = own.error.unwrap_or(0.0);
    let end = |side: usize| {
        let sign = [-1.0, 1.0][side];
        let (reach, sampled) =
            (sign * (ends[side] - own.value), own.interval[side].map(|end| sign * (end - own.value))?);
        // An interval that lies on one side of the likeliest value still holds what is possible.
        Some(if reach > 0.0 { own.value + sign * libm::hypot(reach, sampled) } else { ends[side] + sign * sampled })
    };
    Estimate {
        value: own.value,
        error: Some(libm::hypot(left * libm::sqrt(square), error)),
        interval: [end(0), end(1)],
    }
}

fn widen_defects(own: &mut Defects, others: impl Iterator<Item = Defects>) {
    let estimate = |of: Defects| Estimate { value: of.dpm, error: of.error, interval: of.interval };
    let Estimate { error, interval, .. } = widened(estimate(*own), others.map(estimate));
    own.error = error;
    own.interval = interval.map(|end| end.map(|end| end.clamp(0.0, 1e6)));
}
