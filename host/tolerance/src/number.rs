//! Numbers as people read them.

/// `value` with `decimals` digits after the point, and never a negative zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "-∞" }.into();
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|byte| matches!(byte, b'0' | b'.')) => digits.to_owned(),
        _ => text,
    }
}

/// A tolerance level with its sign and no more digits than it needs: `+2.5`, `0`, `-1`.
pub fn level(n: f64) -> String {
    if n.abs() >= 1e10 {
        return format!("{n:+e}");
    }
    let digits = fixed(n, 4);
    let short = digits.trim_end_matches('0').trim_end_matches('.');
    if short.starts_with('-') || short == "0" { short.to_owned() } else { format!("+{short}") }
}

/// For pictures and pages: a real minus sign instead of the hyphen.
pub fn typeset(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

/// Ten significant digits, the shortest way to write them.
pub fn ten_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.9e}").parse().unwrap_or(x);
    if rounded == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e10).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// Three significant digits, for measured values of any size.
pub fn three_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    let size = rounded.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        rounded.to_string()
    } else {
        format!("{rounded:.1e}")
    }
}

/// Decimals with which a number has so many significant digits of a deviation of this `size`.
pub fn decimals(size: f64, digits: i32) -> usize {
    let magnitude = libm::floor(libm::log10(size.max(1e-12)));
    (f64::from(digits - 1) - magnitude).clamp(0.0, 12.0) as usize
}

/// Defects per million in three digits. Nobody can tell a millionth of one from nothing.
pub fn per_million(ppm: f64) -> String {
    if ppm > 0.0 && ppm < 1e-6 { "below 1e-6".to_owned() } else { three_digits(ppm) }
}

/// A share in percent with so many `decimals`; with three digits where these would not show two of it: 7.7 in a million are
/// 0.00077 %, not nothing.
pub fn percent(share: f64, decimals: usize) -> String {
    let percent = 100.0 * share;
    let least = (0..decimals).fold(10.0, |least, _| least / 10.0);
    if percent != 0.0 && percent.abs() < least { small(percent) } else { fixed(percent, decimals) }
}

/// Three significant digits without an exponent down to a millionth.
fn small(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    if rounded.abs() >= 1e-6 { rounded.to_string() } else { format!("{rounded:e}") }
}

/// What is there through `format`, else a dash.
pub fn or_dash<T>(value: Option<T>, format: impl Fn(T) -> String) -> String {
    value.map_or_else(|| "-".to_owned(), format)
}

#[cfg(test)]
mod tests {
    use super::{fixed, level, per_million, percent, ten_digits, three_digits, typeset};

    #[test]
    fn ten_digits_are_short() {
        assert_eq!(ten_digits(0.293_000_000_000_000_04), "0.293");
        assert_eq!(ten_digits(-0.0), "0");
        assert_eq!(ten_digits(2.782_455_694_123e-5), "2.782455694e-5");
    }

    #[test]
    fn three_digits_of_any_size() {
        assert_eq!(
            [0.0, 0.012_345, 1.0, 99.96, 1234.0, 4.44e-7, 2e12].map(three_digits),
            ["0", "0.0123", "1", "100", "1230", "4.4e-7", "2.0e12"]
        );
    }

    #[test]
    fn hardly_any_defects_have_no_number() {
        assert_eq!(
            [0.0, 4.1e-80, 9.9e-7, 1.2e-6, 302.0].map(per_million),
            ["0", "below 1e-6", "below 1e-6", "1.2e-6", "302"]
        );
    }

    #[test]
    fn a_small_share_is_not_nothing() {
        assert_eq!(
            [0.0, 7.7e-6, 1.0 / 130_000.0, 3e-9, 0.000_95, 0.001, 0.054_32, 1.0].map(|share| percent(share, 2)),
            ["0.00", "0.00077", "0.000769", "3e-7", "0.095", "0.10", "5.43", "100.00"]
        );
        assert_eq!([0.004, 0.000_4, 0.12].map(|share| percent(share, 1)), ["0.4", "0.04", "12.0"]);
    }

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(fixed(-0.000016, 4), "0.0000");
        assert_eq!(fixed(-0.0, 0), "0");
        assert_eq!(fixed(-0.00006, 4), "-0.0001");
        assert_eq!(fixed(10.0, 0), "10");
    }

    #[test]
    fn a_level_shows_its_sign() {
        assert_eq!(
            [2.5, 0.0, -0.0, -1.0, 10.0, 3.43, 0.1 + 0.2, 1e300].map(level),
            ["+2.5", "0", "0", "-1", "+10", "+3.43", "+0.3", "+1e300"]
        );
        assert_eq!(typeset("-1"), "\u{2212}1");
    }
}
