//! Expressions as trees: made at random, written for a scene, and evaluated without slipfit.
//!
//! Lengths are in mm, angles in rad.

use std::f64::consts::{FRAC_PI_2, PI};

use super::chance::Chance;

/// What kind of number an expression is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Length,
    Angle,
    Ratio,
}

/// An expression.
#[derive(Clone, Debug)]
pub enum Tree {
    /// In mm, ° or 1.
    Constant(f64, Kind),
    Input(usize),
    Measure(usize),
    One(One, Box<Tree>),
    Two(Two, Box<Tree>, Box<Tree>),
    Power(Box<Tree>, f64),
    /// Least, or greatest if true.
    Extreme(bool, Vec<Tree>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum One {
    Negate,
    Absolute,
    Root,
    Sine,
    Cosine,
    Tangent,
    ArcSine,
    ArcCosine,
    ArcTangent,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Two {
    Add,
    Subtract,
    Multiply,
    Divide,
}

use One::*;
use Two::*;

/// Least and greatest value.
pub type Range = [f64; 2];

fn one(of: One, x: f64) -> f64 {
    match of {
        Negate => -x,
        Absolute => x.abs(),
        Root => libm::sqrt(x),
        Sine => libm::sin(x),
        Cosine => libm::cos(x),
        Tangent => libm::tan(x),
        ArcSine => libm::asin(x),
        ArcCosine => libm::acos(x),
        ArcTangent => libm::atan(x),
    }
}

fn two(of: Two, a: f64, b: f64) -> f64 {
    match of {
        Add => a + b,
        Subtract => a - b,
        Multiply => a * b,
        Divide => a / b,
    }
}

fn hull(values: &[f64]) -> Option<Range> {
    let range = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
    values.iter().all(|x| x.is_finite()).then_some(range)
}

/// A bound of a cosine: exact where the range has no turning point.
fn cosine([low, high]: Range) -> Range {
    let turns = |at: f64| libm::floor((high - at) / (2.0 * PI)) > libm::floor((low - at) / (2.0 * PI));
    let [a, b] = [libm::cos(low), libm::cos(high)];
    [if turns(PI) { -1.0 } else { a.min(b) }, if turns(0.0) { 1.0 } else { a.max(b) }]
}

impl Tree {
    /// Its value for these inputs and earlier measures; not a number where it has none.
    pub fn value(&self, inputs: &[f64], measures: &[f64]) -> f64 {
        match self {
            Self::Constant(x, Kind::Angle) => x.to_radians(),
            Self::Constant(x, _) => *x,
            Self::Input(i) => inputs[*i],
            Self::Measure(i) => measures[*i],
            Self::One(of, x) => one(*of, x.value(inputs, measures)),
            Self::Two(of, a, b) => two(*of, a.value(inputs, measures), b.value(inputs, measures)),
            Self::Power(x, power) => libm::pow(x.value(inputs, measures), *power),
            Self::Extreme(greatest, of) => {
                let values: Vec<f64> = of.iter().map(|x| x.value(inputs, measures)).collect();
                if values.iter().any(|x| x.is_nan()) {
                    return f64::NAN;
                }
                values.into_iter().reduce(if *greatest { f64::max } else { f64::min }).unwrap()
            }
        }
    }

    /// A range that holds every value for inputs and measures in theirs, by interval arithmetic; `None` where it may have no
    /// finite value.
    pub fn range(&self, inputs: &[Range], measures: &[Range]) -> Option<Range> {
        let range = match self {
            Self::Constant(..) => [self.value(&[], &[]); 2],
            Self::Input(i) => inputs[*i],
            Self::Measure(i) => measures[*i],
            Self::One(of, x) => {
                let [low, high] = x.range(inputs, measures)?;
                match of {
                    Negate => [-high, -low],
                    Absolute if low > 0.0 || high < 0.0 => [low.abs().min(high.abs()), low.abs().max(high.abs())],
                    Absolute => [0.0, high.max(-low)],
                    Sine => cosine([low - FRAC_PI_2, high - FRAC_PI_2]),
                    Cosine => cosine([low, high]),
                    Tangent if low.abs().max(high.abs()) > 1.4 => return None,
                    // Next to 1 and to 0 the value hardly has digits.
                    ArcSine | ArcCosine if low.abs().max(high.abs()) > 0.999 => return None,
                    Root if low < 0.0 => return None,
                    _ => hull(&[one(*of, low), one(*of, high)])?,
                }
            }
            Self::Two(of, a, b) => {
                let (a, b) = (a.range(inputs, measures)?, b.range(inputs, measures)?);
                if *of == Divide && b[0] <= 0.0 && b[1] >= 0.0 {
                    return None;
                }
                hull(&[two(*of, a[0], b[0]), two(*of, a[0], b[1]), two(*of, a[1], b[0]), two(*of, a[1], b[1])])?
            }
            Self::Power(x, power) => {
                let [low, high] = x.range(inputs, measures)?;
                let ends = [low, high].map(|x| libm::pow(x, *power));
                if low <= 0.0 && (*power < 0.0 || power.fract() != 0.0) {
                    return None;
                }
                let inside = if low < 0.0 && high > 0.0 { 0.0 } else { ends[0] };
                hull(&[ends[0], ends[1], inside])?
            }
            Self::Extreme(greatest, of) => {
                let ranges = of.iter().map(|x| x.range(inputs, measures)).collect::<Option<Vec<_>>>()?;
                let of = if *greatest { f64::max } else { f64::min };
                ranges.into_iter().reduce(|a, b| [of(a[0], b[0]), of(a[1], b[1])])?
            }
        };
        hull(&range)
    }

    /// Inputs that it reads, those of the `measures` that it reads included.
    pub fn inputs(&self, measures: &[Vec<usize>]) -> Vec<usize> {
        let mut found = match self {
            Self::Constant(..) => Vec::new(),
            Self::Input(i) => vec![*i],
            Self::Measure(i) => measures[*i].clone(),
            Self::One(_, x) | Self::Power(x, _) => x.inputs(measures),
            Self::Two(_, a, b) => [a.inputs(measures), b.inputs(measures)].concat(),
            Self::Extreme(_, of) => of.iter().flat_map(|x| x.inputs(measures)).collect(),
        };
        found.sort_unstable();
        found.dedup();
        found
    }

    /// As a scene has it, with these names of inputs and measures; `constant` writes a constant.
    pub fn text(&self, names: [&[String]; 2], constant: &dyn Fn(f64, Kind) -> String) -> String {
        let quoted = |name: &String| {
            let plain = name.chars().all(|c| c.is_alphanumeric() || c == '_')
                && !name.starts_with(|c: char| c.is_ascii_digit());
            if plain && name != "pi" { name.clone() } else { format!("'{name}'") }
        };
        match self {
            Self::Constant(x, kind) if *x < 0.0 => format!("(-{})", constant(-x, *kind)),
            Self::Constant(x, kind) => constant(*x, *kind),
            Self::Input(i) => quoted(&names[0][*i]),
            Self::Measure(i) => quoted(&names[1][*i]),
            Self::One(Negate, x) => format!("(-{})", x.text(names, constant)),
            Self::One(of, x) => {
                let name = match of {
                    Absolute => "abs",
                    Root => "sqrt",
                    Sine => "sin",
                    Cosine => "cos",
                    Tangent => "tan",
                    ArcSine => "asin",
                    ArcCosine => "acos",
                    ArcTangent | Negate => "atan",
                };
                format!("{name}({})", x.text(names, constant))
            }
            Self::Two(of, a, b) => {
                let sign = match of {
                    Add => '+',
                    Subtract => '-',
                    Multiply => '*',
                    Divide => '/',
                };
                format!("({} {sign} {})", a.text(names, constant), b.text(names, constant))
            }
            Self::Power(x, power) => format!("({})^{power}", x.text(names, constant)),
            Self::Extreme(greatest, of) => {
                let name = if *greatest { "max" } else { "min" };
                let of: Vec<_> = of.iter().map(|x| x.text(names, constant)).collect();
                format!("{name}({})", of.join(", "))
            }
        }
    }
}

/// What an expression can be made of.
pub struct Material<'a> {
    /// Kinds of the inputs, and ranges that hold all units.
    pub inputs: &'a [(Kind, Range)],
    /// The same of earlier measures.
    pub measures: &'a [(Kind, Range)],
}

impl Material<'_> {
    fn range(&self, tree: &Tree) -> Option<Range> {
        let of = |all: &[(Kind, Range)]| all.iter().map(|(_, range)| *range).collect::<Vec<_>>();
        tree.range(&of(self.inputs), &of(self.measures)).filter(|[low, high]| low.abs().max(high.abs()) < 1e5)
    }

    fn leaf(&self, kind: Kind, chance: &mut Chance) -> Tree {
        let of_kind = |all: &[(Kind, Range)]| (0..all.len()).filter(|i| all[*i].0 == kind).collect::<Vec<_>>();
        let (inputs, measures) = (of_kind(self.inputs), of_kind(self.measures));
        if !measures.is_empty() && chance.happens(0.15) {
            return Tree::Measure(chance.one_of(&measures));
        }
        if inputs.is_empty() || chance.happens(0.1) {
            let constant = match kind {
                Kind::Length => chance.decimal(0.5, 20.0, 2),
                Kind::Angle => chance.decimal(5.0, 60.0, 1),
                Kind::Ratio => chance.one_of(&[0.5, 1.0, 1.5, 2.0, 3.0, 0.1]),
            };
            return Tree::Constant(constant, kind);
        }
        Tree::Input(chance.one_of(&inputs))
    }

    /// Σ ± factor · input, over most inputs of this kind.
    pub fn chain(&self, kind: Kind, chance: &mut Chance) -> Tree {
        let mut sum = self.leaf(kind, chance);
        for i in (0..self.inputs.len()).filter(|i| self.inputs[*i].0 == kind) {
            if chance.happens(0.2) {
                continue;
            }
            let input = Box::new(Tree::Input(i));
            let factor = Box::new(Tree::Constant(chance.one_of(&[0.5, 2.0, 1.25, 0.1]), Kind::Ratio));
            let term = match chance.below(4) {
                0 => Tree::Two(Multiply, factor, input),
                1 => Tree::Two(Divide, input, factor),
                _ => *input,
            };
            sum = Tree::Two(chance.one_of(&[Add, Subtract, Subtract]), Box::new(sum), Box::new(term));
        }
        sum
    }

    /// A random expression that is defined in all units; deeper ones read more.
    pub fn random(&self, kind: Kind, depth: usize, chance: &mut Chance) -> Tree {
        if depth == 0 {
            return self.leaf(kind, chance);
        }
        for _ in 0..20 {
            let tree = self.attempt(kind, depth - 1, chance);
            if self.range(&tree).is_some() {
                return tree;
            }
        }
        self.leaf(kind, chance)
    }

    fn attempt(&self, kind: Kind, depth: usize, chance: &mut Chance) -> Tree {
        let mut of = |kind| Box::new(self.random(kind, depth, chance));
        let mut pair = |kind| (of(kind), of(kind));
        let (a, b) = pair(kind);
        match (chance.below(10), kind) {
            (0 | 1, _) => Tree::Two(Add, a, b),
            (2 | 3, _) => Tree::Two(Subtract, a, b),
            (4, _) => Tree::One(chance.one_of(&[Absolute, Absolute, Negate]), a),
            (5, _) => {
                let mut of = vec![*a, *b];
                if chance.happens(0.3) {
                    of.push(self.random(kind, depth, chance));
                }
                Tree::Extreme(chance.happens(0.5), of)
            }
            (6, _) => {
                let factor = Box::new(self.random(Kind::Ratio, depth.min(1), chance));
                Tree::Two(chance.one_of(&[Multiply, Divide]), a, factor)
            }
            (7, Kind::Length) => {
                let square = |x: Box<Tree>| Box::new(Tree::Power(x, 2.0));
                Tree::One(Root, Box::new(Tree::Two(Add, square(a), square(b))))
            }
            (8, Kind::Length) => Tree::One(Root, Box::new(Tree::Two(Multiply, a, b))),
            (9, Kind::Length) => {
                let angle = Box::new(self.random(Kind::Angle, depth.min(2), chance));
                Tree::Two(Multiply, a, Box::new(Tree::One(chance.one_of(&[Sine, Cosine, Tangent]), angle)))
            }
            (7 | 8, Kind::Angle) => {
                let ratio = Box::new(self.random(Kind::Ratio, depth, chance));
                Tree::One(chance.one_of(&[ArcSine, ArcCosine, ArcTangent, ArcTangent]), ratio)
            }
            (7, Kind::Ratio) => {
                let angle = Box::new(self.random(Kind::Angle, depth, chance));
                Tree::One(chance.one_of(&[Sine, Cosine, Tangent]), angle)
            }
            (8, Kind::Ratio) => Tree::Power(a, chance.one_of(&[2.0, 3.0, -1.0, 0.5, 1.5])),
            (9, _) => {
                let of = if kind == Kind::Angle { Kind::Ratio } else { Kind::Length };
                let [x, y] = [0, 1].map(|_| Box::new(self.random(of, depth, chance)));
                let ratio = Tree::Two(Divide, x, y);
                if kind == Kind::Angle { Tree::One(ArcTangent, Box::new(ratio)) } else { ratio }
            }
            _ => Tree::Two(Multiply, a, b),
        }
    }
}
