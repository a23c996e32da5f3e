//! Random stacks: dimensions with their distributions, correlations and measures, and their scene text.

use std::fmt::Write;

use super::{
    chance::{Chance, decimal},
    expected::value_correlation,
    expression::{Kind, Material, One, Range, Tree, Two},
    law::{Law, Mean, Spread, Width},
};

/// A dimension, in mm, ° or 1.
#[derive(Clone, Debug)]
pub struct Dimension {
    pub name: String,
    pub kind: Kind,
    pub value: f64,
    /// Lower and upper deviation, if it has a tolerance.
    pub tolerance: Option<[f64; 2]>,
    pub law: Law,
}

/// A measure; limits in mm, ° or 1.
#[derive(Clone, Debug)]
pub struct Measure {
    pub name: String,
    pub kind: Kind,
    pub tree: Tree,
    pub limits: [Option<f64>; 2],
}

/// Dimensions, their correlations, and measures; the first measures are the dimensions themselves.
#[derive(Clone, Debug)]
pub struct Stack {
    pub dimensions: Vec<Dimension>,
    /// Dimensions and coefficient.
    pub correlations: Vec<(usize, usize, f64)>,
    /// Whether the coefficients are those of ranks.
    pub ranks: bool,
    pub measures: Vec<Measure>,
    /// Measures whose sum may close.
    pub sums: Vec<Vec<usize>>,
}

/// How a scene is written, without effect on what it means.
#[derive(Clone, Debug)]
pub struct Writing {
    /// Unit of lengths and how many make a mm.
    pub length: (&'static str, f64),
    /// Unit of angles and how many make a °.
    pub angle: (&'static str, f64),
    /// The order in which dimensions are written.
    pub order: Vec<usize>,
    /// Whether measures and correlations are written before the dimensions.
    pub measures_first: bool,
}

impl Writing {
    /// In the units of the scene format and in order.
    pub fn plain(dimensions: &[Dimension]) -> Self {
        let order = (0..dimensions.len()).collect();
        Self { length: ("", 1.0), angle: ("", 1.0), order, measures_first: false }
    }

    pub fn number(&self, x: f64, kind: Kind) -> String {
        let of = |(unit, per): (&str, f64), own: &str| match unit {
            "" if own.is_empty() => format!("{x}"),
            "" => format!("\"{x} {own}\""),
            _ => format!("\"{} {unit}\"", x * per),
        };
        match kind {
            Kind::Length => of(self.length, ""),
            Kind::Angle => of(self.angle, "°"),
            Kind::Ratio => format!("{x}"),
        }
    }

    fn constant(&self, x: f64, kind: Kind) -> String {
        let of = |(unit, per): (&str, f64), own: &str| match unit {
            "" => format!("{x} {own}"),
            _ => format!("{} {unit}", x * per),
        };
        match kind {
            Kind::Length => of(self.length, "mm"),
            Kind::Angle => of(self.angle, "°"),
            Kind::Ratio => format!("{x}"),
        }
    }

    fn pair(&self, [a, b]: [f64; 2], kind: Kind) -> String {
        if a == -b && b > 0.0 {
            self.number(b, kind)
        } else {
            format!("[{}, {}]", self.number(a, kind), self.number(b, kind))
        }
    }

    /// The keys `sigma` and `distribution` of a law, with what separates them from others.
    pub fn law(&self, law: &Law, kind: Kind, end: &str) -> String {
        let number = |x: &f64| self.number(*x, kind);
        let numbers = |of: &[f64]| format!("[{}]", of.iter().map(number).collect::<Vec<_>>().join(", "));
        let mut sigma = None;
        // What of a mean and a standard deviation is stated in the distribution's own table.
        let spread = |spread: &Spread| {
            let mean = match spread.mean {
                Mean::Middle => String::new(),
                Mean::Stated(mean) => format!(", mean = {}", self.number(mean, kind)),
                Mean::Shifted(shift) => format!(", shift = {}", self.number(shift, kind)),
            };
            match spread.width {
                Width::Sigma(_) => mean,
                Width::Deviation(deviation) => format!("{mean}, deviation = {}", self.number(deviation, kind)),
                Width::Cpk(cpk) => format!("{mean}, cpk = {cpk}"),
            }
        };
        if let Law::Normal(of) | Law::Truncated(of) | Law::Skewed(of, _) = law
            && let Width::Sigma(of) = of.width
        {
            sigma = Some(of);
        }
        let named = |name: &str, keys: String| match keys.as_str() {
            "" => format!("\"{name}\""),
            keys => format!("{{ kind = \"{name}\"{keys} }}"),
        };
        let shape = match law {
            Law::Constant => "\"constant\"".into(),
            Law::Normal(of) => named("normal", spread(of)),
            Law::Truncated(of) => named("truncated-normal", spread(of)),
            Law::Uniform => "\"uniform\"".into(),
            Law::Triangular { mode: None } => "\"triangular\"".into(),
            Law::Triangular { mode: Some(mode) } => format!("{{ kind = \"triangular\", mode = {} }}", number(mode)),
            Law::Trapezoidal { shoulders } => {
                format!("{{ kind = \"trapezoidal\", shoulders = {} }}", numbers(shoulders))
            }
            Law::Beta { shapes: [a, b] } => format!("{{ kind = \"beta\", shapes = [{a}, {b}] }}"),
            Law::Skewed(of, skewness) => named("skewed", format!(", skewness = {skewness}{}", spread(of))),
            Law::Weibull { shape, scale, location } => {
                let (scale, location) = (number(scale), number(location));
                format!("{{ kind = \"weibull\", shape = {shape}, scale = {scale}, location = {location} }}")
            }
            Law::Gumbel { mode, scale, smallest } => {
                let kind = if *smallest { "gumbel-smallest" } else { "gumbel" };
                format!("{{ kind = \"{kind}\", mode = {}, scale = {} }}", number(mode), number(scale))
            }
            Law::Lognormal { mean, deviation, location } => {
                let [mean, deviation, location] = [mean, deviation, location].map(number);
                format!("{{ kind = \"lognormal\", mean = {mean}, deviation = {deviation}, location = {location} }}")
            }
            Law::Table(values) => format!("{{ kind = \"table\", deviations = {} }}", numbers(values)),
            Law::Mixture(parts) => {
                let part = |(weight, limits, law): &(f64, [f64; 2], Law)| {
                    let tolerance = if law.is_scaled() {
                        format!(", tolerance = {}", self.pair(*limits, kind))
                    } else {
                        String::new()
                    };
                    format!("{{ weight = {weight}{tolerance}{} }}", self.law(law, kind, ""))
                };
                format!("{{ kind = \"mixture\", of = [{}] }}", parts.iter().map(part).collect::<Vec<_>>().join(", "))
            }
        };
        let between = if end.is_empty() { ", " } else { "" };
        let sigma = sigma.filter(|sigma| *sigma != 3.0).map(|sigma| format!("{between}sigma = {sigma}{end}"));
        format!("{}{between}distribution = {shape}{end}", sigma.unwrap_or_default())
    }

    fn dimension(&self, dimension: &Dimension) -> String {
        let Dimension { name, kind, value, tolerance, law } = dimension;
        let mut text = format!("[[dimension]]\nname = \"{name}\"\nvalue = {}\n", self.number(*value, *kind));
        if *kind == Kind::Ratio {
            text += "quantity = \"number\"\n";
        }
        if let Some(tolerance) = tolerance {
            let _ = writeln!(text, "tolerance = {}", self.pair(*tolerance, *kind));
        }
        text + &self.law(law, *kind, "\n")
    }

    /// The scene.
    pub fn text(&self, stack: &Stack) -> String {
        let names = [
            stack.dimensions.iter().map(|d| d.name.clone()).collect(),
            stack.measures.iter().map(|m| m.name.clone()).collect::<Vec<_>>(),
        ];
        let dimensions: String = self.order.iter().map(|i| self.dimension(&stack.dimensions[*i])).collect();
        let mut rest = String::new();
        for (a, b, coefficient) in &stack.correlations {
            let _ = writeln!(
                rest,
                "[[correlation]]\nof = [\"{}\", \"{}\"]\ncoefficient = {coefficient}",
                names[0][*a], names[0][*b]
            );
        }
        for Measure { name, kind, tree, limits } in &stack.measures {
            let is = tree.text([&names[0], &names[1]], &|x, kind| self.constant(x, kind));
            let _ = writeln!(rest, "[[measure]]\nname = \"{name}\"\nis = \"{is}\"");
            for (key, limit) in ["lower", "upper"].into_iter().zip(limits) {
                if let Some(limit) = limit {
                    let _ = writeln!(rest, "{key} = {}", self.number(*limit, *kind));
                }
            }
        }
        for (number, of) in stack.sums.iter().enumerate() {
            let of: Vec<_> = of.iter().map(|i| format!("\"{}\"", names[1][*i])).collect();
            let _ = writeln!(rest, "[[sum]]\nname = \"sum {number}\"\nof = [{}]", of.join(", "));
        }
        let ranks = if stack.ranks { "[tolerance]\ncorrelation = \"spearman\"\n" } else { "" };
        if self.measures_first { format!("{ranks}{rest}{dimensions}") } else { format!("{ranks}{dimensions}{rest}") }
    }
}

impl Dimension {
    fn random(number: usize, chance: &mut Chance) -> Self {
        let kind = chance.one_of(&[Kind::Length, Kind::Length, Kind::Length, Kind::Angle, Kind::Ratio]);
        // Equal values are frequent, so that differences have kinks and folds where units are.
        let (value, widest) = match kind {
            Kind::Length => (chance.one_of(&[10.0, 10.0, 10.0, 20.0, 5.0, 12.5, 0.0]), 0.5),
            Kind::Angle => (chance.one_of(&[0.0, 0.0, 30.0, 45.0, 2.0]), 3.0),
            Kind::Ratio => (chance.one_of(&[1.0, 1.0, 0.5, 2.0, 0.0]), 0.3),
        };
        let half = chance.decimal(0.02 * widest, widest, 3).max(0.005);
        let limits = match chance.below(4) {
            0 => [-half, 0.0],
            1 => {
                let low = chance.decimal(-half, half, 3);
                [low, super::chance::decimal(low + half, 4)]
            }
            _ => [-half, half],
        };
        let law = if chance.happens(0.03) { Law::Constant } else { Law::random(chance, limits, false) };
        let tolerance = (law.is_scaled() || law.has_width() && chance.happens(0.5)).then_some(limits);
        let name = chance.one_of(&["d", "side ", "Maß.", "ø-", "x_"]);
        Self { name: format!("{name}{number}"), kind, value, tolerance, law }
    }

    /// The tolerance from which its law has place and width.
    fn scale(&self) -> [f64; 2] {
        self.tolerance.unwrap_or([0.0; 2])
    }

    /// A value (mm, rad, 1) drawn without slipfit.
    pub fn draw(&self, chance: &mut Chance) -> f64 {
        self.inside(
            self.value + if matches!(self.law, Law::Constant) { 0.0 } else { self.law.draw(self.scale(), chance) },
        )
    }

    /// The value (mm, rad, 1) below which this share lies.
    pub fn point(&self, share: f64) -> f64 {
        self.inside(self.value + self.law.point(self.scale(), share))
    }

    /// Limits (mm, rad, 1) for the worst case.
    pub fn limits(&self) -> Range {
        self.law.limits(self.tolerance).map(|x| self.inside(self.value + x))
    }

    /// A range (mm, rad, 1) that holds limits, units and the value on the drawing.
    pub fn support(&self) -> Range {
        let ends =
            [self.law.support(self.scale()).map(|x| self.inside(self.value + x)), self.limits(), [self.nominal(); 2]];
        ends.into_iter().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap()
    }

    /// Its value on the drawing (mm, rad, 1).
    pub fn nominal(&self) -> f64 {
        self.inside(self.value)
    }

    fn inside(&self, x: f64) -> f64 {
        if self.kind == Kind::Angle { x.to_radians() } else { x }
    }
}

impl Stack {
    /// The stack number `number`: one to twelve dimensions, one to three measures beside them.
    pub fn random(chance: &mut Chance) -> Self {
        let count = 1 + chance.below(12);
        let dimensions: Vec<_> = (0..count).map(|number| Dimension::random(number, chance)).collect();
        let inputs: Vec<_> = dimensions.iter().map(|d| (d.kind, d.support())).collect();
        let own = |(i, d): (usize, &Dimension)| Measure {
            name: format!("own {i}"),
            kind: d.kind,
            tree: Tree::Input(i),
            limits: [None; 2],
        };
        let mut measures: Vec<Measure> = dimensions.iter().enumerate().map(own).collect();
        let mut known: Vec<(Kind, Range)> = inputs.clone();
        for number in 0..1 + chance.below(3) {
            let kind = chance.one_of(&[Kind::Length, Kind::Length, Kind::Angle, Kind::Ratio]);
            let material = Material { inputs: &inputs, measures: &known };
            let clipped = if chance.happens(0.15) { Self::clipped(&dimensions, chance) } else { None };
            let (kind, tree) = if let Some(tree) = clipped {
                (Kind::Length, tree)
            } else if chance.happens(0.3) {
                (kind, material.chain(kind, chance))
            } else {
                let depth = 1 + chance.below(4);
                (kind, material.random(kind, depth, chance))
            };
            let ranges: Vec<_> =
                [&inputs, &known].map(|all| all.iter().map(|(_, range)| *range).collect::<Vec<_>>()).into();
            let Some(range) = tree.range(&ranges[0], &ranges[1]) else { continue };
            known.push((kind, range));
            measures.push(Measure { name: format!("measure {number}"), kind, tree, limits: [None; 2] });
        }
        if chance.happens(0.1) {
            measures.extend(Self::undefined(&dimensions, chance));
        }
        let mut made =
            Self { dimensions, correlations: Vec::new(), ranks: chance.happens(0.3), measures, sums: Vec::new() };
        if chance.happens(0.3) {
            made.correlate(chance);
        }
        let own = made.dimensions.len();
        let lengths: Vec<_> = (own..made.measures.len()).filter(|i| made.measures[*i].kind == Kind::Length).collect();
        if lengths.len() > 1 {
            made.sums.push(lengths);
        }
        made
    }

    /// A length that is 0 but where a chain of dimensions is near a place inside its worst case: at all corners it is level.
    fn clipped(dimensions: &[Dimension], chance: &mut Chance) -> Option<Tree> {
        let limits: Vec<_> = dimensions.iter().map(|d| (d.kind, d.limits())).collect();
        let chain = Material { inputs: &limits, measures: &[] }.chain(Kind::Length, chance);
        let ranges: Vec<Range> = limits.iter().map(|(_, range)| *range).collect();
        let [low, high] = chain.range(&ranges, &[])?;
        let (place, width) = (low + (high - low) * chance.between(0.2, 0.8), (high - low) * chance.between(0.05, 0.3));
        let constant = |x: f64| Box::new(Tree::Constant(decimal(x, 5), Kind::Length));
        let apart = Tree::One(One::Absolute, Box::new(Tree::Two(Two::Subtract, Box::new(chain), constant(place))));
        let height = Tree::Two(Two::Subtract, constant(width), Box::new(apart));
        (high - low > 1e-3).then(|| Tree::Extreme(true, vec![*constant(0.0), height]))
    }

    /// A measure that some units do not have, if there are dimensions for one: it is defined at the nominal values.
    fn undefined(dimensions: &[Dimension], chance: &mut Chance) -> Option<Measure> {
        let input = |i: usize| Box::new(Tree::Input(i));
        let lengths: Vec<_> = (0..dimensions.len()).filter(|i| dimensions[*i].kind == Kind::Length).collect();
        let pairs = lengths.iter().flat_map(|a| lengths.iter().map(|b| (*a, *b)));
        let pairs: Vec<_> = pairs.filter(|(a, b)| a != b && dimensions[*a].value == dimensions[*b].value).collect();
        let zeros: Vec<_> = lengths.iter().copied().filter(|i| dimensions[*i].value == 0.0).collect();
        let root = |x| {
            let unit = Box::new(Tree::Constant(1.0, Kind::Length));
            Tree::One(One::Root, Box::new(Tree::Two(Two::Multiply, x, unit)))
        };
        let (kind, tree) = match chance.below(3) {
            0 if !zeros.is_empty() => (Kind::Length, root(input(chance.one_of(&zeros)))),
            1 if !pairs.is_empty() => {
                let (a, b) = chance.one_of(&pairs);
                (Kind::Length, root(Box::new(Tree::Two(Two::Subtract, input(a), input(b)))))
            }
            _ => {
                let (a, b) = chance.one_of(
                    pairs
                        .iter()
                        .filter(|(a, _)| dimensions[*a].value > 1.0)
                        .copied()
                        .collect::<Vec<_>>()
                        .as_slice()
                        .get(..1)?,
                );
                (Kind::Angle, Tree::One(One::ArcCosine, Box::new(Tree::Two(Two::Divide, input(a), input(b)))))
            }
        };
        Some(Measure { name: "sometimes".into(), kind, tree, limits: [None; 2] })
    }

    /// Correlates pairs of neighbours whose distributions have points in closed form.
    fn correlate(&mut self, chance: &mut Chance) {
        let able: Vec<_> = (0..self.dimensions.len()).filter(|i| self.dimensions[*i].law.has_points()).collect();
        for pair in able.chunks(2) {
            if let [a, b] = *pair
                && chance.happens(0.7)
            {
                // Two laws of different shapes cannot have every coefficient.
                let ends = [-1.0, 1.0].map(|r| {
                    if self.ranks { r } else { value_correlation(&self.dimensions[a], &self.dimensions[b], r) }
                });
                let coefficient = super::chance::decimal(0.9 * chance.between(ends[0], ends[1]), 2);
                if coefficient != 0.0 {
                    self.correlations.push((a, b, coefficient));
                }
            }
        }
    }

    /// The correlation of the values of two dimensions.
    pub fn value_correlation(&self, a: usize, b: usize) -> f64 {
        let pair = |(one, other, _): &&(usize, usize, f64)| [*one, *other] == [a, b];
        match self.correlations.iter().find(pair) {
            Some((.., coefficient)) if self.ranks => {
                let scores = 2.0 * libm::sin(std::f64::consts::PI / 6.0 * coefficient);
                value_correlation(&self.dimensions[a], &self.dimensions[b], scores)
            }
            Some((.., coefficient)) => *coefficient,
            None => 0.0,
        }
    }

    /// Inputs that each measure reads.
    pub fn reads(&self) -> Vec<Vec<usize>> {
        let mut reads = Vec::new();
        for measure in &self.measures {
            reads.push(measure.tree.inputs(&reads));
        }
        reads
    }

    /// All measures (mm, rad, 1) of a unit with these dimensions.
    pub fn values(&self, inputs: &[f64]) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.measures.len());
        for measure in &self.measures {
            let value = measure.tree.value(inputs, &values);
            values.push(value);
        }
        values
    }
}
