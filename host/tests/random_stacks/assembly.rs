//! Random assemblies: blocks one upon the other, their faces, points and bores in zones, against rigid bodies of the test's own.

use std::fmt::Write;

use super::{
    chance::Chance,
    expression::Kind,
    law::Law,
    rigid::{Located, Motion, Vector, cross, dot, minus, norm, onto, plus, times},
    stack::Writing,
};

/// How a feature lies in its zone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    SigmaZone,
    Truncated,
    UniformInZone,
    Translation,
}

impl Rule {
    fn text(self) -> &'static str {
        match self {
            Self::SigmaZone => "sigma-zone",
            Self::Truncated => "truncated",
            Self::UniformInZone => "uniform-in-zone",
            Self::Translation => "translation",
        }
    }

    /// Height of the middle and of two edges over half of the zone of a face, whose sum of sizes is 1 at most.
    fn of_face(self, chance: &mut Chance) -> Vector {
        let inside = |[a, b, c]: Vector| a.abs() + b.abs() + c.abs() <= 1.0;
        let normal = |chance: &mut Chance| [0, 1, 2].map(|_| chance.normal() / libm::sqrt(27.0));
        match self {
            Self::SigmaZone => normal(chance),
            Self::Truncated => std::iter::repeat_with(|| normal(chance)).find(|point| inside(*point)).unwrap(),
            Self::UniformInZone => std::iter::repeat_with(|| [0, 1, 2].map(|_| chance.between(-1.0, 1.0)))
                .find(|point| inside(*point))
                .unwrap(),
            Self::Translation => [chance.normal() / 3.0, 0.0, 0.0],
        }
    }

    /// A place over the radius of a circle.
    fn of_circle(self, chance: &mut Chance) -> [f64; 2] {
        let inside = |[a, b]: [f64; 2]| a * a + b * b <= 1.0;
        let normal = |chance: &mut Chance| [0, 1].map(|_| chance.normal() / 3.0);
        match self {
            Self::SigmaZone | Self::Translation => normal(chance),
            Self::Truncated => std::iter::repeat_with(|| normal(chance)).find(|point| inside(*point)).unwrap(),
            Self::UniformInZone => std::iter::repeat_with(|| [0, 1].map(|_| chance.between(-1.0, 1.0)))
                .find(|point| inside(*point))
                .unwrap(),
        }
    }

    /// A height over half of a zone.
    fn of_point(self, chance: &mut Chance) -> f64 {
        match self {
            Self::SigmaZone | Self::Translation => chance.normal() / 3.0,
            Self::Truncated => std::iter::repeat_with(|| chance.normal() / 3.0).find(|x| x.abs() <= 1.0).unwrap(),
            Self::UniformInZone => chance.between(-1.0, 1.0),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Plane,
    Point,
    Axis,
}

/// What varies in a feature; widths and extents in mm.
#[derive(Clone, Debug)]
pub enum Tolerance {
    /// Flatness of a plane, profile of a point, without datums.
    Zone(f64, Rule),
    /// Along the normal, with its limits.
    Offset([f64; 2], Law),
    /// A profile to the bottom of the part.
    ToBottom(f64, Rule),
    /// A position to the bottom, the back and the stop of the part.
    ToAll(f64, Rule),
}

/// A feature as drawn, in the frame of the product (mm).
#[derive(Clone, Debug)]
pub struct Feature {
    pub name: String,
    pub part: usize,
    pub shape: Shape,
    pub nominal: Located,
    /// Direction of the first extent; of an axis any direction across.
    pub along: Vector,
    /// Extents of a plane; the length of an axis, twice.
    pub extents: [f64; 2],
    pub tolerances: Vec<Tolerance>,
}

/// A product of blocks. The features of part 0 are its top, back and stop, those of every other its bottom, back, stop, then top
/// and others.
#[derive(Clone, Debug)]
pub struct Product {
    /// Origins of the parts' frames.
    pub origins: Vec<Vector>,
    pub features: Vec<Feature>,
    pub measures: Vec<(String, Between)>,
}

#[derive(Clone, Copy, Debug)]
pub enum Between {
    /// Distance of a place from a plane.
    FromPlane(usize, usize),
    Points(usize, usize),
    FromAxis(usize, usize),
    Angle(usize, usize),
}

impl Product {
    pub fn random(chance: &mut Chance) -> Self {
        let (length, depth) = (chance.decimal(40.0, 120.0, 0), chance.decimal(30.0, 90.0, 0));
        let blocks = 1 + chance.below(3);
        let mut made = Self { origins: Vec::new(), features: Vec::new(), measures: Vec::new() };
        let mut height = 0.0;
        for part in 0..=blocks {
            let origin = [0, 1, 2].map(|_| chance.decimal(-30.0, 30.0, 0));
            made.origins.push(origin);
            let next = height + if part > 0 { chance.decimal(8.0, 40.0, 1) } else { 0.0 };
            let own = if part == 0 { 1.0 } else { -1.0 };
            let wall = 0.5 * (height + next) + 4.0 * f64::from(u8::from(part == 0));
            let mut add = |name: &str, shape, place, direction, along, extents, chance: &mut Chance| {
                made.features.push(Feature {
                    name: format!("{}.{name}", part_name(part)),
                    part,
                    shape,
                    nominal: Located { place, direction },
                    along,
                    extents,
                    tolerances: Vec::new(),
                });
                let feature = made.features.len() - 1;
                made.features[feature].tolerances = tolerances(&made.features[feature], name, chance);
                feature
            };
            let z = [0.0, 0.0, 1.0];
            let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
            let walls = [length, if part == 0 { 8.0 } else { next - height }];
            let base = if part == 0 { "top" } else { "bottom" };
            add(base, Shape::Plane, [0.0, 0.0, height], times(z, own), x, [length, depth], chance);
            add("back", Shape::Plane, [0.0, 0.5 * depth, wall], times(y, -own), x, walls, chance);
            add("stop", Shape::Plane, [-0.5 * length, 0.0, wall], times(x, own), y, [depth, walls[1]], chance);
            if part > 0 {
                let inside =
                    |chance: &mut Chance| [chance.decimal(-0.4, 0.4, 2) * length, chance.decimal(-0.4, 0.4, 2) * depth];
                let top = add("top", Shape::Plane, [0.0, 0.0, next], z, x, [length, depth], chance);
                let [px, py] = inside(chance);
                let tip = add("tip", Shape::Point, [px, py, next], z, x, [1.0; 2], chance);
                let bores = [0, 1].map(|k| {
                    let [px, py] = inside(chance);
                    let place = [px + 3.0 * f64::from(k), py, 0.5 * (height + next)];
                    add(&format!("bore {k}"), Shape::Axis, place, z, x, [next - height; 2], chance)
                });
                let of = [
                    ("height", Between::FromPlane(tip, 0)),
                    ("lean", Between::Angle(top, 0)),
                    ("bores", Between::FromAxis(bores[0], bores[1])),
                    ("bore from back", Between::FromPlane(bores[0], 1)),
                    ("bore from own stop", Between::FromPlane(bores[1], top - 1)),
                    ("bore leans", Between::Angle(bores[1], top - 3)),
                ];
                made.measures.extend(
                    of.into_iter().filter(|_| chance.happens(0.5)).map(|(name, of)| (format!("{name} {part}"), of)),
                );
                if part == blocks {
                    made.measures.push(("tip".into(), Between::FromPlane(tip, 0)));
                    if let Some(below) =
                        made.features.iter().position(|feature| feature.shape == Shape::Point && feature.part < part)
                    {
                        made.measures.push(("tips".into(), Between::Points(tip, below)));
                    }
                }
            }
            height = next;
        }
        made
    }

    /// Measures of a unit (mm, °).
    pub fn draw(&self, chance: &mut Chance) -> Vec<f64> {
        let deviations = |feature: &Feature| {
            feature.tolerances.iter().map(|tolerance| tolerance.draw(feature.shape, chance)).collect()
        };
        let deviations: Vec<_> = self.features.iter().map(deviations).collect();
        self.measured(&deviations)
    }

    /// The least and the greatest value of a measure within all zones and limits: each tolerance in turn goes to the best of its
    /// corners, until nothing changes.
    pub fn extremes(&self, measure: usize, chance: &mut Chance) -> [f64; 2] {
        let mut climbed = |sign: f64, random: bool| {
            let mut start = |tolerance: &Tolerance, shape| {
                let middle = tolerance.middle(shape);
                if random { chance.one_of(&tolerance.corners(shape, &middle)) } else { middle }
            };
            let mut start = |feature: &Feature| {
                feature.tolerances.iter().map(|tolerance| start(tolerance, feature.shape)).collect()
            };
            let mut deviations: Vec<Vec<Vec<f64>>> = self.features.iter().map(&mut start).collect();
            let mut best = sign * self.measured(&deviations)[measure];
            for _ in 0..3 {
                let before = best;
                for (i, feature) in self.features.iter().enumerate() {
                    for (k, tolerance) in feature.tolerances.iter().enumerate() {
                        for corner in tolerance.corners(feature.shape, &deviations[i][k]) {
                            let before = std::mem::replace(&mut deviations[i][k], corner);
                            let value = sign * self.measured(&deviations)[measure];
                            if value > best { best = value } else { deviations[i][k] = before }
                        }
                    }
                }
                if best == before {
                    break;
                }
            }
            best
        };
        [-1.0, 1.0].map(|sign| sign * (0..4).map(|start| climbed(sign, start > 0)).fold(f64::NEG_INFINITY, f64::max))
    }

    /// Measures (mm, °) of a unit with these deviations of every tolerance of every feature.
    fn measured(&self, deviations: &[Vec<Vec<f64>>]) -> Vec<f64> {
        let made = |(feature, deviations): (&Feature, &Vec<Vec<f64>>)| feature.made(deviations);
        let mut located: Vec<Located> = self.features.iter().zip(deviations).map(made).collect();
        for part in 0..self.origins.len() {
            let own: Vec<usize> = (0..self.features.len()).filter(|i| self.features[*i].part == part).collect();
            let [bottom, back, stop] = [own[0], own[1], own[2]];
            for i in own.clone() {
                for tolerance in &self.features[i].tolerances {
                    let nominal = |k: usize| self.features[k].nominal;
                    let motion = match tolerance {
                        Tolerance::ToBottom(..) => onto_plane(nominal(bottom), located[bottom]),
                        Tolerance::ToAll(..) => onto([bottom, back, stop].map(|k| [nominal(k), located[k]])),
                        Tolerance::Zone(..) | Tolerance::Offset(..) => continue,
                    };
                    located[i] = motion.moved(located[i]);
                }
            }
            if part > 0 {
                // The top of the block below, and back and stop of the first part.
                let below = self
                    .features
                    .iter()
                    .position(|feature| feature.part == part - 1 && feature.name.ends_with(".top"))
                    .unwrap();
                let motion =
                    onto([[located[bottom], located[below]], [located[back], located[1]], [located[stop], located[2]]]);
                own.iter().for_each(|i| located[*i] = motion.moved(located[*i]));
            }
        }
        self.measures.iter().map(|(_, between)| between.value(&located)).collect()
    }

    pub fn kinds(&self) -> Vec<Kind> {
        self.measures
            .iter()
            .map(|(_, between)| if matches!(between, Between::Angle(..)) { Kind::Angle } else { Kind::Length })
            .collect()
    }

    /// The scene, the whole product turned by these Euler angles (°) and shifted (mm).
    pub fn text(&self, writing: &Writing, turned: Vector, shift: Vector) -> String {
        let mut text = String::new();
        for (part, origin) in self.origins.iter().enumerate() {
            let at = plus(euler(turned, *origin), shift);
            let [a, b, c] = turned;
            let _ = writeln!(text, "[[part]]\nname = \"{}\"\nat = {at:?}\nturned = [{a}, {b}, {c}]", part_name(part));
            for (key, shape) in [("plane", Shape::Plane), ("point", Shape::Point), ("axis", Shape::Axis)] {
                for feature in self.features.iter().filter(|feature| feature.part == part && feature.shape == shape) {
                    let _ = writeln!(text, "[[part.{key}]]\n{}", feature.text(*origin, writing));
                }
            }
        }
        for part in 1..self.origins.len() {
            let (own, below) = (part_name(part), part_name(part - 1));
            let contacts = format!(
                "[\"{own}.bottom\", \"{below}.top\"], [\"{own}.back\", \"base.back\"], [\"{own}.stop\", \"base.stop\"]"
            );
            let _ = writeln!(text, "[[mate]]\npart = \"{own}\"\ncontacts = [{contacts}]");
        }
        for (name, between) in &self.measures {
            let (key, one, two) = match between {
                Between::FromPlane(one, two) | Between::Points(one, two) | Between::FromAxis(one, two) => {
                    ("distance", one, two)
                }
                Between::Angle(one, two) => ("angle", one, two),
            };
            let [one, two] = [one, two].map(|i| &self.features[*i].name);
            let _ = writeln!(text, "[[measure]]\nname = \"{name}\"\n{key} = [\"{one}\", \"{two}\"]");
        }
        text
    }
}

fn part_name(part: usize) -> String {
    if part == 0 { "base".into() } else { format!("block {part}") }
}

fn tolerances(feature: &Feature, name: &str, chance: &mut Chance) -> Vec<Tolerance> {
    let rule =
        chance.one_of(&[Rule::SigmaZone, Rule::SigmaZone, Rule::Truncated, Rule::UniformInZone, Rule::Translation]);
    let width = chance.decimal(0.02, 0.4, 3);
    let limits = [-chance.decimal(0.05, 0.3, 3), chance.decimal(0.01, 0.3, 3)];
    let offset = Tolerance::Offset(
        limits,
        loop {
            let law = Law::random(chance, limits, true);
            if law.is_scaled() {
                break law;
            }
        },
    );
    match (feature.shape, chance.below(5)) {
        (Shape::Axis, 0) => Vec::new(),
        (Shape::Axis, _) => vec![Tolerance::ToAll(width, rule)],
        (_, 0) => Vec::new(),
        (_, 1) => vec![offset],
        (_, 2) if name == "top" && feature.part > 0 || name == "tip" => vec![Tolerance::ToBottom(width, rule)],
        (_, 3) => vec![Tolerance::Zone(width, rule), offset],
        _ => vec![Tolerance::Zone(width, rule)],
    }
}

impl Tolerance {
    /// A deviation: of an offset in mm, of a face the height of its middle and of two edges over half of the zone, of an axis both
    /// of its ends over the radius of the zone.
    fn draw(&self, shape: Shape, chance: &mut Chance) -> Vec<f64> {
        match (self, shape) {
            (Self::Offset(limits, law), _) => vec![law.draw(*limits, chance)],
            (Self::Zone(_, rule) | Self::ToBottom(_, rule) | Self::ToAll(_, rule), shape) => match shape {
                Shape::Point => vec![rule.of_point(chance)],
                Shape::Plane => rule.of_face(chance).to_vec(),
                Shape::Axis => {
                    let [one, two] = [0, 1].map(|_| rule.of_circle(chance));
                    [one, if *rule == Rule::Translation { one } else { two }].concat()
                }
            },
        }
    }

    fn middle(&self, shape: Shape) -> Vec<f64> {
        match (self, shape) {
            (Self::Offset([low, high], _), _) => vec![0.5 * (low + high)],
            (_, Shape::Point) => vec![0.0],
            (_, Shape::Plane) => vec![0.0; 3],
            (_, Shape::Axis) => vec![0.0; 4],
        }
    }

    /// Corners of its zone; of an axis places of one end on the rim, the other end as in `now`.
    fn corners(&self, shape: Shape, now: &[f64]) -> Vec<Vec<f64>> {
        let (rule, now) = match self {
            Self::Offset(limits, _) => return limits.iter().map(|limit| vec![*limit]).collect(),
            Self::Zone(_, rule) | Self::ToBottom(_, rule) | Self::ToAll(_, rule) => (*rule, now.to_vec()),
        };
        let signs = [-1.0, 1.0];
        match shape {
            Shape::Point => signs.map(|sign| vec![sign]).into(),
            Shape::Plane if rule == Rule::Translation => signs.map(|sign| vec![sign, 0.0, 0.0]).into(),
            Shape::Plane => (0..3)
                .flat_map(|k| signs.map(|sign| (0..3).map(|j| if j == k { sign } else { 0.0 }).collect()))
                .collect(),
            Shape::Axis => {
                let rim =
                    (0..32).map(|k| std::f64::consts::TAU * f64::from(k) / 32.0).map(|a| [libm::cos(a), libm::sin(a)]);
                let with = |end: [f64; 2]| {
                    let (one, two) = (now[..2].to_vec(), now[2..].to_vec());
                    let end = end.to_vec();
                    let both = [end.clone(), end.clone()].concat();
                    if rule == Rule::Translation {
                        vec![both]
                    } else {
                        vec![[end.clone(), two].concat(), [one, end].concat(), both]
                    }
                };
                rim.flat_map(with).collect()
            }
        }
    }
}

impl Feature {
    /// As it was made with these deviations, one a tolerance, before its datums move it.
    fn made(&self, deviations: &[Vec<f64>]) -> Located {
        let mut located = self.nominal;
        let other = cross(self.nominal.direction, self.along);
        for (tolerance, deviation) in self.tolerances.iter().zip(deviations) {
            let width = match tolerance {
                Tolerance::Offset(..) => {
                    located.place = plus(located.place, times(self.nominal.direction, deviation[0]));
                    continue;
                }
                Tolerance::Zone(width, _) | Tolerance::ToBottom(width, _) | Tolerance::ToAll(width, _) => *width,
            };
            let half = 0.5 * width;
            match self.shape {
                Shape::Point => located.place = plus(located.place, times(self.nominal.direction, half * deviation[0])),
                Shape::Plane => {
                    located.place = plus(located.place, times(self.nominal.direction, half * deviation[0]));
                    let [a, b] = [0, 1].map(|k| deviation[k + 1] * width / self.extents[k]);
                    located.direction = minus(located.direction, plus(times(self.along, a), times(other, b)));
                }
                Shape::Axis => {
                    let [one, two] = [0, 2]
                        .map(|k| plus(times(self.along, deviation[k] * half), times(other, deviation[k + 1] * half)));
                    located.place = plus(located.place, times(plus(one, two), 0.5));
                    located.direction = plus(located.direction, times(minus(two, one), 1.0 / self.extents[0]));
                }
            }
        }
        located
    }

    fn text(&self, origin: Vector, writing: &Writing) -> String {
        let (_, name) = self.name.split_once('.').unwrap();
        let at = minus(self.nominal.place, origin);
        let direction = self.nominal.direction;
        let mut text = format!("name = \"{name}\"\nat = {at:?}\n");
        let _ = match self.shape {
            Shape::Plane => {
                writeln!(text, "normal = {direction:?}\nalong = {:?}\nextents = {:?}", self.along, self.extents)
            }
            Shape::Point => writeln!(text, "normal = {direction:?}"),
            Shape::Axis => writeln!(text, "along = {direction:?}\nlength = {:?}", self.extents[0]),
        };
        let part = self.name.split_once('.').unwrap().0;
        for tolerance in &self.tolerances {
            let _ = match tolerance {
                Tolerance::Offset(limits, law) => {
                    writeln!(
                        text,
                        "offset = {{ tolerance = [{}, {}]{} }}",
                        limits[0],
                        limits[1],
                        writing.law(law, Kind::Length, "")
                    )
                }
                Tolerance::Zone(width, rule) => {
                    let key = if self.shape == Shape::Point { "profile" } else { "flatness" };
                    writeln!(text, "{key} = {{ zone = {width}, rule = \"{}\" }}", rule.text())
                }
                Tolerance::ToBottom(width, rule) => {
                    writeln!(
                        text,
                        "profile = {{ zone = {width}, rule = \"{}\", datum = \"{part}.bottom\" }}",
                        rule.text()
                    )
                }
                Tolerance::ToAll(width, rule) => {
                    let datums = format!("\"{part}.bottom\", \"{part}.back\", \"{part}.stop\"");
                    writeln!(text, "position = {{ zone = {width}, rule = \"{}\", datum = [{datums}] }}", rule.text())
                }
            };
        }
        text
    }
}

/// The shortest motion that brings a nominal plane onto the actual one.
fn onto_plane(nominal: Located, actual: Located) -> Motion {
    let turn = cross(nominal.direction, actual.direction);
    let angle = libm::atan2(norm(turn), dot(nominal.direction, actual.direction));
    let turn = if norm(turn) > 0.0 { times(turn, angle / norm(turn)) } else { [0.0; 3] };
    let about = Motion { turn, shift: [0.0; 3] };
    let height = dot(actual.direction, minus(actual.place, nominal.place)) / dot(actual.direction, nominal.direction);
    // The middle of the nominal plane goes along its normal.
    let middle = plus(nominal.place, times(nominal.direction, height));
    Motion { turn, shift: minus(middle, about.turned(nominal.place)) }
}

impl Between {
    fn value(self, located: &[Located]) -> f64 {
        match self {
            Self::FromPlane(one, two) => {
                let plane = located[two];
                dot(minus(located[one].place, plane.place), plane.direction) / norm(plane.direction)
            }
            Self::Points(one, two) => norm(minus(located[one].place, located[two].place)),
            Self::FromAxis(one, two) => {
                let axis = located[two];
                norm(cross(minus(located[one].place, axis.place), axis.direction)) / norm(axis.direction)
            }
            Self::Angle(one, two) => {
                let [one, two] = [one, two].map(|i| located[i].direction);
                libm::atan2(norm(cross(one, two)), dot(one, two)).to_degrees()
            }
        }
    }
}

/// A vector turned by Euler's angles z-x-z (°): first the third about z, then the second about x, then the first about z.
pub fn euler([alpha, beta, gamma]: Vector, v: Vector) -> Vector {
    let about =
        |axis: Vector, angle: f64, v| Motion { turn: times(axis, angle.to_radians()), shift: [0.0; 3] }.turned(v);
    let (x, z) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    about(z, alpha, about(x, beta, about(z, gamma, v)))
}
