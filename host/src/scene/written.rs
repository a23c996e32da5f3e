//! Scene files with other tolerances: the text as it is but for these.

use slipfit_tolerance::product::costed::Costed;

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
    let t = rounded_down(t * form.per_si, digits);
    let with_unit = |number: f64| match form.unit {
        Some(unit) => format!("\"{number} {unit}\""),
        None => number.to_string(),
    };
    if form.middle == 0.0 {
        return with_unit(t);
    }
    let middle = form.middle * form.per_si;
    // The digits that the conversion made up do not count.
    let [lower, upper] = [middle - t, middle + t].map(|end| format!("{end:.15e}").parse().unwrap_or(end));
    format!("[{}, {}]", with_unit(lower), with_unit(upper))
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
    use super::rounded_down;

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
