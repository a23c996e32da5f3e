//! Capability within subgroups, and whether they differ.

use serde::Serialize;
use slipfit_tolerance::statistics::interval;

use super::{
    estimate::Estimate,
    indices::{Indices, Known},
    sample::{Sample, mean_and_deviation},
};
use crate::numeric::tails::fisher_above;
use crate::table::{Column, Grouping};

/// What subgroups tell of a column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Within {
    /// Name of the grouping.
    pub grouping: String,
    /// Subgroups with measured parts.
    pub groups: Vec<Group>,
    /// Standard deviation within the subgroups, pooled.
    pub deviation: Estimate,
    /// Its degrees of freedom.
    pub freedom: usize,
    /// Cp and Cpk.
    pub indices: Indices,
    /// Share of the variance that is between subgroups, 0 or more (analysis of variance).
    pub between: f64,
    /// The probability of means as different if the subgroups have the same one (R. Fisher's F test).
    pub p: f64,
}

/// A subgroup.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// Its name; empty for the parts of no subgroup.
    pub name: String,
    /// Measured parts.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation; `None` of one part.
    pub deviation: Option<f64>,
}

impl Within {
    /// Of a column; `None` without two subgroups, or if no subgroup has two parts that differ.
    pub fn new(column: &Column, grouping: &Grouping, sample: &Sample) -> Option<Self> {
        let mut values = vec![Vec::new(); grouping.groups.len() + 1];
        for (value, group) in column.values.iter().zip(&grouping.group_of) {
            let group = group.map_or(grouping.groups.len(), |group| group as usize);
            if let (Some(value), Some(values)) = (value, values.get_mut(group)) {
                values.push(*value);
            }
        }
        let names = grouping.groups.iter().cloned().chain([String::new()]);
        let (mut squares, mut freedom, mut apart, mut sizes) = (0.0, 0, 0.0, 0.0);
        let mut groups = Vec::new();
        for (name, values) in names.zip(&values).filter(|(_, values)| !values.is_empty()) {
            let count = values.len();
            let (mean, deviation) = if count > 1 { mean_and_deviation(values) } else { (values[0], 0.0) };
            squares += (count - 1) as f64 * deviation * deviation;
            freedom += count - 1;
            apart += count as f64 * (mean - sample.mean) * (mean - sample.mean);
            sizes += (count * count) as f64;
            groups.push(Group { name, count, mean, deviation: (count > 1).then_some(deviation) });
        }
        let deviation = libm::sqrt(squares / freedom as f64);
        if groups.len() < 2 || freedom == 0 || deviation <= 0.0 || !deviation.is_finite() {
            return None;
        }
        let degrees = [(groups.len() - 1) as f64, freedom as f64];
        let [between, within] = [apart / degrees[0], deviation * deviation];
        // Parts of a subgroup; of unequal ones, as analysis of variance weighs them.
        let n = sample.count();
        let size = (n - sizes / n) / degrees[0];
        let variance = ((between - within) / size).max(0.0);
        let known = Known { parts: n, mean: sample.mean, deviation, freedom: degrees[1] };
        Some(Self {
            grouping: grouping.name.clone(),
            groups,
            deviation: Estimate { value: deviation, interval: interval::deviation(deviation, degrees[1]) },
            freedom,
            indices: known.indices(column.limits),
            between: variance / (variance + within),
            p: fisher_above(between / within, degrees),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Within;
    use crate::{
        capability::sample::Sample,
        table::{Column, Grouping},
    };

    #[test]
    fn analysis_of_variance_as_in_the_nist_handbook() {
        // NIST/SEMATECH e-Handbook of Statistical Methods, 7.4.3.4: three levels of five; F = 9.59 with 2 and 12 degrees of
        // freedom, mean squares 13.849 and 1.444 (sums 27.897 and 17.452), p = 0.0033 (cut: 0.00325).
        let levels = [[6.9, 5.4, 5.8, 4.6, 4.0], [8.3, 6.8, 7.8, 9.2, 6.5], [8.0, 10.5, 8.1, 6.9, 9.3]];
        let values: Vec<_> = levels.iter().flatten().copied().map(Some).collect();
        let names = ["1", "2", "3"].into_iter().flat_map(|name| [name; 5]);
        let column = Column { name: "a".into(), values, limits: [Some(0.0), None], ..Column::default() };
        let sample = Sample::new("a", &column.values).expect("a sample");
        let within = Within::new(&column, &Grouping::new("level", names), &sample).expect("subgroups");
        assert_eq!(within.freedom, 12);
        assert!((within.deviation.value * within.deviation.value * 12.0 - 17.452).abs() < 5e-4, "{within:?}");
        assert!((within.p - 0.00325).abs() < 1e-5, "{within:?}");
        assert!(within.indices.lower.is_some() && within.indices.spread.is_none());
    }
}
