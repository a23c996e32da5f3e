//! Scene files with other tolerances: the text as it is but for these.

use slipfit_tolerance::{
    number::ten_digits,
    product::costed::{Costed, Written},
};

/// The `text` of the scene file that `costed` was read from, with `tolerances` (SI), one each, in `digits` significant digits
/// and never wider. Those that do not stand in the file stay.
pub fn with_tolerances(text: &str, costed: &[Costed], tolerances: &[f64], digits: usize) -> String {
    let placed = costed.iter().zip(tolerances).filter_map(|(costed, t)| Some((costed.place.clone()?, costed, *t)));
    let mut edits: Vec<_> = placed.collect();
    edits.sort_by_key(|(place, ..)| place.start);
    let mut written = String::with_capacity(text.len());
    let mut at = 0;
    for (place, costed, t) in edits {
        let Some(before) = text.get(at..place.start) else { continue };
        written.push_str(before);
        written.push_str(&tolerance(costed, t, digits));
        at = place.end;
    }
    written.push_str(text.get(at..).unwrap_or_default());
    written
}

/// A tolerance (SI) as it stands in a scene.
pub fn tolerance(costed: &Costed, t: f64, digits: usize) -> String {
    let form = &costed.written;
    let with_unit = |number: f64| match form.unit {
        Some(unit) => format!("\"{number} {unit}\""),
        None => number.to_string(),
    };
    match deviations(form, t, digits) {
        Deviations::Both(t) => with_unit(t),
        Deviations::Each([lower, upper]) => format!("[{}, {}]", with_unit(lower), with_unit(upper)),
    }
}

/// A tolerance (SI) as it stands on a drawing: a size with its deviations, or a zone with its datums.
pub fn callout(costed: &Costed, t: f64, digits: usize) -> String {
    let (form, callout) = (&costed.written, &costed.callout);
    let unit = form.unit.or(Some(costed.quantity.unit()).filter(|unit| !unit.is_empty()));
    let unit = unit.map(|unit| if unit == "°" { unit.to_owned() } else { format!(" {unit}") }).unwrap_or_default();
    let key = callout.key.as_ref().map(|key| key.replace('_', " ") + " ").unwrap_or_default();
    let signed = |number: f64| if number == 0.0 { "0".to_owned() } else { format!("{number:+}") };
    // The digits that the conversion made up do not count.
    let nominal = callout.nominal.map(|nominal| ten_digits(nominal * form.per_si) + " ").unwrap_or_default();
    match deviations(form, t, digits) {
        Deviations::Both(t) if form.key == "zone" => format!("{key}{t}{unit}{}", callout.frame),
        Deviations::Both(t) => format!("{key}{nominal}± {t}{unit}"),
        Deviations::Each([lower, upper]) => format!("{key}{nominal}{} / {}{unit}", signed(upper), signed(lower)),
    }
}

/// A tolerance in its unit.
enum Deviations {
    /// To both sides, or the width of a zone.
    Both(f64),
    /// Lower and upper.
    Each([f64; 2]),
}

fn deviations(form: &Written, t: f64, digits: usize) -> Deviations {
    let t = rounded_down(t * form.per_si, digits);
    if form.middle == 0.0 {
        return Deviations::Both(t);
    }
    let middle = form.middle * form.per_si;
    // The digits that the conversion and the sum made up do not count.
    let made_up = if digits < 15 { 11 } else { 15 };
    Deviations::Each([middle - t, middle + t].map(|end| format!("{end:.made_up$e}").parse().unwrap_or(end)))
}

/// `t` > 0 in some significant digits, never more than it is but for what is lost in 15 digits.
fn rounded_down(t: f64, digits: usize) -> f64 {
    let nearest = |digits: usize, t: f64| format!("{t:.*e}", digits - 1).parse::<f64>().unwrap_or(t);
    let t = nearest(15, t);
    let rounded = nearest(digits, t);
    if rounded <= t {
        return rounded;
    }
    let unit = libm::pow(10.0, libm::floor(libm::log10(t)) + 1.0 - digits as f64);
    nearest(digits, rounded - unit)
}

#[cfg(test)]
mod tests {
    use slipfit_tolerance::{
        model::Quantity,
        product::costed::{Callout, Costed, Written},
    };

    use super::{callout, rounded_down, tolerance};

    /// Deviations about a middle have no more digits than the tolerance.
    #[test]
    fn sums_have_no_digits_of_their_own() {
        let written = Written { key: "tolerance", unit: None, per_si: 1e3, middle: 0.075e-3 };
        let (part, feature, key) = (Some("plate".to_owned()), "bore".to_owned(), Some("diameter".to_owned()));
        let place = Callout { part, feature, key, nominal: Some(15.875e-3), frame: String::new() };
        let (quantity, processes) = (Quantity::Length, Vec::new());
        let costed =
            Costed { name: place.name(), stated: 0.125e-3, processes, quantity, written, callout: place, place: None };
        for (t, deviations, on_drawing) in [
            (0.12382e-3, "[-0.04882, 0.19882]", "+0.19882 / -0.04882"),
            (0.075e-3, "[0, 0.15]", "+0.15 / 0"),
            (0.0321e-3, "[0.0429, 0.1071]", "+0.1071 / +0.0429"),
        ] {
            assert_eq!(tolerance(&costed, t, 6), deviations);
            assert_eq!(callout(&costed, t, 6), format!("diameter 15.875 {on_drawing} mm"));
        }
        assert_eq!(costed.name, "plate.bore.diameter");
    }

    #[test]
    fn tolerances_are_never_rounded_up() {
        for (t, expected) in [
            (0.173_842_49, 0.173_842),
            (0.173_842_99, 0.173_842),
            (0.1, 0.1),
            (0.2 + 1e-17, 0.2),
            (0.299_999_999_999_999_9, 0.3),
            (0.999_999_9, 0.999_999),
            (1.000_000_1, 1.0),
            (0.008_114_23, 0.008_114_23),
        ] {
            assert_eq!(rounded_down(t, 6), expected, "{t}");
        }
    }
}
