//! Pictures of measured parts: a histogram, a probability plot, values in order and by subgroup.

use slipfit_measured::{
    capability::{Capability, Estimate},
    families::{Family, Kind},
    table::Grouping,
};
use slipfit_tolerance::{
    number::{decimals, fixed, or_dash, typeset},
    numeric::normal::quantile,
};

use super::{
    chart::{Chart, Look, Markers, Panel, PlotError, Series, Shape, outline},
    plot::small_chart,
};

/// The most points that a picture shows one by one.
const POINTS: usize = 500;
/// Points of a curve.
const CURVE: i32 = 200;

/// An index with its interval.
pub fn index(estimate: Option<Estimate>) -> String {
    or_dash(estimate, |Estimate { value, interval: [low, high] }| {
        format!("{} [{}, {}]", fixed(value, 2), fixed(low, 2), fixed(high, 2))
    })
}

/// A characteristic with its measured parts: the index of each and its value, in the order of the file.
pub struct Measured<'a> {
    /// What was found.
    pub of: &'a Capability,
    /// Parts and values.
    pub values: &'a [(usize, f64)],
}

impl Measured<'_> {
    fn family(&self) -> Box<dyn Family> {
        let parameters: Vec<f64> = self.of.distribution.parameters.iter().map(|(_, value)| *value).collect();
        self.of.distribution.family.with(&parameters)
    }

    fn with_unit(&self, name: &str) -> String {
        match self.of.unit.symbol() {
            "" => name.to_owned(),
            unit => format!("{name} ({unit})"),
        }
    }

    /// The chart of a panel.
    fn chart(&self, subtitle: &str, x_label: String, panel: Panel) -> Result<String, PlotError> {
        let (title, subtitle) = (self.of.name.clone(), subtitle.to_owned());
        small_chart(&Chart { title, subtitle, x_label, panels: vec![panel], ..Chart::default() })
    }

    fn is_outlier(&self, part: usize) -> bool {
        self.of.outliers.iter().any(|outlier| outlier.part == part)
    }

    /// Marks of parts, outliers apart, at the places of some of their values.
    fn marks(&self, points: impl Iterator<Item = (usize, (f64, f64))>) -> Vec<Markers> {
        let (outliers, usual): (Vec<_>, Vec<_>) = points.partition(|(part, _)| self.is_outlier(*part));
        let markers = |label: &str, shape, points: Vec<(usize, (f64, f64))>| Markers {
            label: label.into(),
            shape,
            points: points.into_iter().map(|(_, point)| point).collect(),
        };
        vec![markers("parts", Shape::Dot, usual), markers("outliers", Shape::Cross, outliers)]
    }

    /// Histogram with the distribution and the limits.
    ///
    /// # Errors
    /// [`PlotError`], if a number is not finite.
    pub fn histogram(&self) -> Result<String, PlotError> {
        let Capability { least, greatest, limits, .. } = *self.of;
        let n = self.values.len() as f64;
        // Classes of the bulk, so that a part far away leaves them narrow.
        let [low, _, high] = self.of.distribution.points;
        let bulk = (greatest - least).min(high - low);
        let classes = ((greatest - least) / bulk * 2.0 * libm::cbrt(n)).ceil().clamp(4.0, 100.0);
        let width = (greatest - least) / classes;
        let mut counts = vec![0.0; classes as usize];
        for (_, value) in self.values {
            let class = (((value - least) / width) as usize).min(counts.len() - 1);
            counts[class] += 1.0;
        }
        let bars = counts.iter().enumerate().map(|(i, count)| (least + i as f64 * width, count / (n * width)));
        let bars = outline(bars, width);
        let family = self.family();
        let margin = 0.05 * (high - low);
        let (from, to) = (low.min(least) - margin, high.max(greatest) + margin);
        let curve: Vec<(f64, f64)> = (0..=CURVE)
            .map(|k| from + (to - from) * f64::from(k) / f64::from(CURVE))
            .map(|x| (x, libm::exp(family.ln_density(x))))
            .filter(|(_, density)| density.is_finite())
            .collect();
        let top = bars.iter().chain(&curve).map(|(_, density)| *density).fold(0.0, f64::max);
        let line = |label: &str, look, points| Series { label: label.into(), look, points };
        let mut series = vec![line("parts", Look::Level(0.0), bars), line(name(self.of), Look::Level(1.0), curve)];
        for limit in limits.into_iter().flatten() {
            series.push(line("", Look::Guide, vec![(limit, 0.0), (limit, 1.05 * top)]));
        }
        let y_label = match self.of.unit.symbol() {
            "" => "density".to_owned(),
            unit => format!("density (1/{unit})"),
        };
        let subtitle = format!("{} parts and their distribution{}", self.of.count, grey(self.of));
        self.chart(&subtitle, self.with_unit("value"), Panel { y_label, series, ..Panel::default() })
    }

    /// Sorted values over the scores that a normal production has at their ranks, with the distribution.
    ///
    /// # Errors
    /// [`PlotError`], if a number is not finite.
    pub fn probability_plot(&self) -> Result<String, PlotError> {
        let mut sorted = self.values.to_vec();
        sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
        let n = sorted.len() as f64;
        let score = |i: usize| quantile((i as f64 + 0.625) / (n + 0.25));
        let every = sorted.len().div_ceil(POINTS);
        // The ends in full: they show the tails.
        let is_shown = |i: usize| i.is_multiple_of(every) || i < 50 || i + 50 >= sorted.len();
        let points = sorted.iter().enumerate().filter(|(i, (part, _))| is_shown(*i) || self.is_outlier(*part));
        let points: Vec<_> = points.map(|(i, (part, value))| (*part, (*value, score(i)))).collect();
        let farthest = score(sorted.len() - 1).max(3.0);
        let family = self.family();
        let curve = (0..=CURVE).map(|k| farthest * (2.0 * f64::from(k) / f64::from(CURVE) - 1.0));
        let curve: Vec<_> = curve.map(|score| (family.value(score), score)).filter(|(x, _)| x.is_finite()).collect();
        let mut series = vec![Series { label: name(self.of).into(), look: Look::Level(1.0), points: curve }];
        for limit in self.of.limits.into_iter().flatten() {
            let points = vec![(limit, -farthest), (limit, farthest)];
            series.push(Series { label: String::new(), look: Look::Guide, points });
        }
        let panel = Panel {
            y_label: "σ of a normal".into(),
            series,
            markers: self.marks(points.into_iter()),
            ..Panel::default()
        };
        let subtitle = format!("probability plot: a normal production is a straight line{}", grey(self.of));
        self.chart(&subtitle, self.with_unit("value"), panel)
    }

    /// What values are shown from, the nominal value or else the mean, and how that is said.
    fn origin(&self) -> (f64, String) {
        let (origin, what) = match self.of.nominal {
            Some(nominal) => (nominal, "nominal"),
            None => (self.of.mean.value, "mean"),
        };
        (origin, format!("{what} {}", typeset(&fixed(origin, decimals(self.of.deviation.value, 3)))))
    }

    /// Limits as lines between two abscissas.
    fn limits(&self, ends: [f64; 2], origin: f64) -> Vec<Series> {
        let line = |limit: f64| Series {
            label: String::new(),
            look: Look::Guide,
            points: ends.map(|x| (x, limit - origin)).to_vec(),
        };
        self.of.limits.into_iter().flatten().map(line).collect()
    }

    /// Values in the order of the file.
    ///
    /// # Errors
    /// [`PlotError`], if a number is not finite.
    pub fn in_order(&self) -> Result<String, PlotError> {
        let (origin, from) = self.origin();
        let every = self.values.len().div_ceil(4 * POINTS);
        let points = self.values.iter().enumerate().filter(|(i, (part, _))| i % every == 0 || self.is_outlier(*part));
        let points: Vec<_> = points.map(|(_, (part, value))| (*part, ((*part + 1) as f64, value - origin))).collect();
        let last = self.values.last().map_or(1, |(part, _)| part + 1) as f64;
        let series = self.limits([1.0, last], origin);
        let y_label = self.with_unit("deviation");
        let panel = Panel { y_label, series, markers: self.marks(points.into_iter()), ..Panel::default() };
        self.chart(
            &format!("deviations from {from} in order{}", grey(self.of)),
            "part, in the order of the file".into(),
            panel,
        )
    }

    /// Values by subgroup, with the means of these.
    ///
    /// # Errors
    /// [`PlotError`], if a number is not finite.
    pub fn by_subgroup(&self, grouping: &Grouping) -> Result<String, PlotError> {
        let (origin, from) = self.origin();
        let group = |part: usize| grouping.group_of.get(part).copied().flatten();
        let every = self.values.len().div_ceil(4 * POINTS);
        let points = self.values.iter().enumerate().filter(|(i, (part, _))| i % every == 0 || self.is_outlier(*part));
        let points =
            points.filter_map(|(_, (part, value))| Some((*part, (f64::from(group(*part)? + 1), value - origin))));
        let mut markers = self.marks(points);
        let means = self.of.within.iter().flat_map(|within| &within.groups).filter_map(|of| {
            let number = grouping.groups.iter().position(|name| *name == of.name)?;
            Some(((number + 1) as f64, of.mean - origin))
        });
        markers.push(Markers { label: "means".into(), shape: Shape::Ring, points: means.collect() });
        let series = self.limits([1.0, grouping.groups.len().max(2) as f64], origin);
        let names: Vec<_> = grouping.groups.iter().enumerate().map(|(i, name)| format!("{} {name}", i + 1)).collect();
        let panel = Panel { y_label: self.with_unit("deviation"), series, markers, ..Panel::default() };
        let subtitle = format!("deviations from {from} by {}: {}{}", grouping.name, names.join(", "), grey(self.of));
        self.chart(&subtitle, format!("number of {}", grouping.name), panel)
    }
}

/// Name of the family, short enough for the end of a line.
fn name(of: &Capability) -> &'static str {
    match of.distribution.family {
        Kind::ShiftedLognormal => "lognormal",
        Kind::ShiftedWeibull => "Weibull",
        kind => kind.name(),
    }
}

fn grey(of: &Capability) -> &'static str {
    if of.limits == [None; 2] { "" } else { "; grey: limits" }
}

#[cfg(test)]
mod tests {
    use slipfit_measured::{
        capability::{Options, capability},
        csv,
        families::Kind,
    };

    use super::Measured;

    #[test]
    fn pictures_are_well_formed_and_name_outliers() {
        let rows: String = (0..40).map(|i| format!("{i},{},{}\n", i % 2, if i == 7 { 30 } else { i % 5 })).collect();
        let options = csv::Options { groups: vec!["tool".into()], ..csv::Options::default() };
        let table = csv::read(format!("part,tool,<a> [mm]\nupper,,9\n{rows}").as_bytes(), &options).unwrap();
        let with = Options { family: Some(Kind::Normal), grouping: Some(0), ..Options::default() };
        let of = capability(&table, 0, &with).unwrap();
        let values: Vec<_> =
            table.columns()[0].values.iter().enumerate().filter_map(|(i, value)| Some((i, (*value)?))).collect();
        let measured = Measured { of: &of, values: &values };
        let grouping = &table.groupings()[0];
        for svg in [
            measured.histogram().unwrap(),
            measured.probability_plot().unwrap(),
            measured.in_order().unwrap(),
            measured.by_subgroup(grouping).unwrap(),
        ] {
            assert!(roxmltree::Document::parse(&svg).is_ok() && svg.contains("&lt;a&gt;") && !svg.contains("NaN"));
        }
        assert!(measured.in_order().unwrap().contains("outliers"));
    }
}
