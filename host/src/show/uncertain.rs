//! The picture of an unknown.

use super::{
    plot::{Chart, Markers, Panel, PlotError, Scale, Shape, line_chart},
    units::with_interval,
};
use crate::population::{
    statistics::Share,
    uncertain::answer::{Answer, ValueReport},
};

/// Neighbouring values that make one point of the line.
const NEIGHBOURS: usize = 4;
/// How many times the least value the greatest one is from which on the axis is logarithmic.
const DECADE: f64 = 10.0;

/// The share that malfunctions over the unknown that decides most of it.
///
/// # Errors
/// [`PlotError`], if there is nothing to show.
pub fn decisive(title: &str, answer: &Answer) -> Result<String, PlotError> {
    let number = answer.most_decisive();
    let unknown = answer.unknowns.get(number).ok_or(PlotError::Empty)?;
    let mut values: Vec<&ValueReport> = answer.values.iter().collect();
    values.sort_by(|one, other| one.values[number].total_cmp(&other.values[number]));
    let group = |group: &[&ValueReport]| {
        let middle = group.iter().map(|value| value.values[number]).sum::<f64>() / group.len() as f64;
        let failed = group.iter().map(|value| value.malfunctions).sum();
        (middle, Share::new(failed, answer.units_each * group.len() as u64))
    };
    let shares: Vec<(f64, Share)> = values.chunks(NEIGHBOURS).map(group).collect();
    let each =
        |value: &&ValueReport| (value.values[number], 100.0 * value.malfunctions as f64 / answer.units_each as f64);
    let [low, high] = unknown.tried;
    let unit = if unknown.unit.is_empty() { String::new() } else { format!(" ({})", unknown.unit) };
    line_chart(&Chart {
        title: title.into(),
        subtitle: format!("{} values, {} units of each", values.len(), answer.units_each),
        x_label: format!("{}{unit}", unknown.name),
        scale: if low > 0.0 && high > DECADE * low { Scale::LogAcross } else { Scale::Linear },
        panels: vec![Panel {
            y_label: "share that malfunctions (%)".into(),
            note: "grey: 95 % interval of four neighbours together".into(),
            series: with_interval(&shares, "mean"),
            markers: vec![Markers {
                label: String::new(),
                shape: Shape::Ring,
                points: values.iter().map(each).collect(),
            }],
            ..Panel::default()
        }],
    })
}
