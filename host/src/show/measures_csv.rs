//! The measures of a report as CSV.

use slipfit_tolerance::{number::ten_digits, report::Report};

/// Measures, one line each, as CSV.
///
/// # Errors
/// Those of the writer, none in memory.
pub fn measures_csv(report: &Report) -> anyhow::Result<Vec<u8>> {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
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
        "nominal",
        "lower",
        "upper",
        "pp",
        "ppk",
        "pp_by_points",
        "ppk_by_points",
        "mean_loss",
        "signal_to_noise",
        "balanced_tolerance",
        "dpm_below",
        "dpm_above",
        "yield",
        "worst_low",
        "worst_high",
        "rss_middle",
        "rss_tolerance",
        "rss_bender",
        "rss_gilson",
        "rss_modified",
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
            m.skew,
            m.kurtosis,
            Some(m.min),
            Some(m.q00135),
            Some(m.median),
            Some(m.q99865),
            Some(m.max),
            m.nominal,
            m.limits[0],
            m.limits[1],
            m.pp,
            m.ppk,
            m.pp_by_points,
            m.ppk_by_points,
            m.loss.map(|loss| loss.mean.value),
            m.loss.and_then(|loss| loss.signal_to_noise),
            m.loss.and_then(|loss| loss.balanced_tolerance),
            below,
            above,
            m.good,
            Some(m.worst_case[0]),
            Some(m.worst_case[1]),
            m.rss.map(|rss| rss.middle),
            m.rss.map(|rss| rss.tolerance),
            m.rss.map(|rss| rss.bender),
            m.rss.map(|rss| rss.gilson),
            m.rss.map(|rss| rss.modified),
            m.second_order.map(|moments| moments.mean),
            m.second_order.map(|moments| moments.sd),
        ];
        let record = [m.name.clone(), m.unit.into()].into_iter().chain(numbers.map(optional));
        writer.write_record(record)?;
    }
    Ok(writer.into_inner()?)
}
