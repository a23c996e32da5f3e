//! Expressions of source text, each with its type.

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

/// A law by the name of `law` that a drive acts by.
pub fn driven(law: &str, by: &slipfit_core::drive::Drive<f64>) -> Typed {
    typed(format!("{law}<Drive<S>>"), format!("{law}({})", drive(by)))
}
