//! Expressions of source text, each with its type.

use slipfit_core::{
    drive::{Piece, TrainData},
    system::law::{Axis, Contour, LineSpring},
};

use crate::mechanism::{Mechanism, NamedDrive, Walls};

/// Type and value of an expression.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Typed {
    pub of: String,
    pub value: String,
}

/// An expression of that type and value.
pub fn typed(of: impl Into<String>, value: impl Into<String>) -> Typed {
    Typed { of: of.into(), value: value.into() }
}

/// An element of a link that measures `count` numbers, and a law.
pub fn element(link: Typed, law: Typed, count: usize) -> Typed {
    typed(
        format!("Element<{}, {}, {count}>", link.of, law.of),
        format!("Element {{ link: {}, law: {} }}", link.value, law.value),
    )
}

/// Neighbours of one type as arrays.
pub fn grouped(elements: &[Typed]) -> Vec<Typed> {
    let groups = elements.chunk_by(|one, next| one.of == next.of);
    let group = |group: &[Typed]| match group {
        [one] => one.clone(),
        all => {
            let values: Vec<_> = all.iter().map(|one| one.value.as_str()).collect();
            let value = format!("[\n        {},\n    ]", values.join(",\n        "));
            typed(format!("[{}; {}]", all[0].of, all.len()), value)
        }
    };
    groups.map(group).collect()
}

/// `(a, (b, c))` of several, `()` of none.
pub fn nested(all: Vec<Typed>) -> Typed {
    let pair = |rest: Typed, first: Typed| {
        typed(format!("({}, {})", first.of, rest.of), format!("({}, {})", first.value, rest.value))
    };
    all.into_iter().rev().reduce(pair).unwrap_or_else(|| typed("()", "()"))
}

/// Numbers as arguments, converted to the unit's scalar.
pub fn numbers(values: &[f64]) -> String {
    let texts: Vec<_> = values.iter().map(|value| format!("s({value:?})")).collect();
    texts.join(", ")
}

/// A vector of two or three numbers.
pub fn vector(values: &[f64]) -> String {
    format!("Vector{}::new({})", values.len(), numbers(values))
}

/// A drive that can be stepped.
fn drive(drive: &slipfit_core::drive::Drive<f64>) -> String {
    format!(
        "Drive {{ gain: s({:?}), ramp_start: s({:?}), ramp_end: s({:?}), speed: s({:?}), point_b: {} }}.checked()?",
        drive.gain,
        drive.ramp_start,
        drive.ramp_end,
        drive.speed,
        vector(drive.point_b.as_slice())
    )
}

/// A law by the name of `law` that a drive of `mechanism` acts by, and the names that it needs from core's drives.
fn driven(law: &str, named: &NamedDrive, mechanism: &Mechanism) -> (Typed, Vec<&'static str>) {
    let mut names = Vec::new();
    let controller = match &named.command {
        None => {
            names.push("Drive");
            typed("Drive<S>", drive(&named.drive))
        }
        Some(command) => {
            let pieces = &command.pieces.0;
            names.extend(["Commanded", "Piece", "Push"]);
            let piece = |Piece { start, coefficients }: &Piece<f64>| {
                format!("Piece {{ start: s({start:?}), coefficients: [{}] }}", numbers(coefficients))
            };
            let all: Vec<_> = pieces.iter().map(piece).collect();
            typed(
                format!("Commanded<S, [Piece<S>; {}]>", pieces.len()),
                format!("Commanded {{ gain: s({:?}), command: [{}] }}.checked()?", named.drive.gain, all.join(", ")),
            )
        }
    };
    let whole = match named.train_in(mechanism) {
        None => controller,
        Some(data) => on_train(&controller, &data, &mut names),
    };
    (typed(format!("{law}<{}>", whole.of), format!("{law}({})", whole.value)), names)
}

/// The laws of all frictions of joints and drives of `mechanism`, in the order of its elements; what a drive acts by is called `law` when
/// it is asked for. The names that they need from core's drives are added to `used`.
pub fn driving<'a>(mechanism: &'a Mechanism, used: &'a mut Vec<&'static str>) -> impl FnMut(&str) -> Typed + 'a {
    let mut frictions = mechanism.joints.iter().filter_map(|joint| joint.drag);
    let mut drives = mechanism.drives.iter();
    move |law: &str| {
        if let Some(data) = frictions.next() {
            let drag = on_train(&typed("()", "()"), &data, used);
            return typed(format!("{law}<{}>", drag.of), format!("{law}({})", drag.value));
        }
        let Some(named) = drives.next() else { return Typed::default() };
        let (typed, names) = driven(law, named, mechanism);
        used.extend(names);
        typed
    }
}

/// A `controller` on a drive train.
fn on_train(controller: &Typed, data: &TrainData<f64>, names: &mut Vec<&'static str>) -> Typed {
    names.extend(["Train", "TrainData"]);
    let TrainData { limit, coulomb, stick_band, viscous, offset } = data;
    typed(
        format!("Train<S, {}>", controller.of),
        format!(
            "Train::new({}, TrainData {{ limit: s({limit:?}), coulomb: [{}], stick_band: s({stick_band:?}), \
             viscous: s({viscous:?}), offset: s({offset:?}) }})?",
            controller.value,
            numbers(coulomb)
        ),
    )
}

/// A spring along a line, of so many dimensions.
pub fn line_spring<const K: usize>(law: &LineSpring<f64, K>) -> Typed {
    let LineSpring { stiffness, damping, free_length, drawn } = law;
    typed(
        format!("LineSpring<S, {K}>"),
        format!(
            "LineSpring {{ stiffness: s({stiffness:?}), damping: s({damping:?}), free_length: s({free_length:?}), drawn: {} }}",
            vector(drawn.as_slice())
        ),
    )
}

/// The law of a `wall` with a contour.
pub fn contoured(wall: Typed, along: Axis, contour: &str) -> Typed {
    typed(
        format!("Contoured<S, {}>", wall.of),
        format!("Contoured {{ wall: {}, along: Axis::{along:?}, contour: {contour} }}", wall.value),
    )
}

/// The contour of wall `i`, whose slope counts with the sign of `sense`, as the `stated` one or as the gaps have it.
pub fn contour(walls: &Walls, i: usize, sense: f64, stated: &Contour<f64>) -> String {
    let [slope, curvature] = match walls {
        Walls::OfGaps(walls) => {
            let term = |adds: f64, gap: usize| (adds != 0.0).then(|| format!("s({adds:?}) * gaps[{gap}]"));
            let sum = |k: usize, sign: f64| {
                let all = walls.get(i).into_iter().flatten();
                let terms: Vec<String> = all.filter_map(|of| term(sign * of.adds[k], of.gap)).collect();
                if terms.is_empty() { "s(0.0)".into() } else { terms.join(" + ") }
            };
            [sum(0, sense), sum(1, 1.0)]
        }
        _ => [stated.slope, stated.curvature].map(|value| format!("s({value:?})")),
    };
    format!("Contour {{ slope: {slope}, curvature: {curvature} }}")
}
