//! Numbers as people read them.

/// A tolerance level with its sign: "+2.5", "−1", "0".
pub fn level(n: f64) -> String {
    let rounded = (n * 1e6).round() / 1e6;
    match rounded {
        0.0 => "0".into(),
        n if n > 0.0 => format!("+{n}"),
        n => format!("−{}", -n),
    }
}

/// `x` to `decimals` places, without a negative zero.
pub fn fixed(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|b| matches!(b, b'0' | b'.')) => digits.into(),
        _ => text,
    }
}

/// Ten significant digits, the shortest way to write them.
pub fn ten_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.9e}").parse().unwrap_or(x);
    if rounded == 0.0 {
        "0".into()
    } else if (1e-4..1e10).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// `present` through `format`, or an en dash.
pub fn or_dash(present: Option<f64>, format: impl Fn(f64) -> String) -> String {
    present.map_or_else(|| "–".into(), format)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_and_zeros() {
        assert_eq!([2.5, -1.0, 0.0, -0.0, 0.1 + 0.2].map(level), ["+2.5", "−1", "0", "0", "+0.3"]);
        assert_eq!(fixed(-0.000_016, 4), "0.0000");
        assert_eq!(fixed(-0.000_06, 4), "-0.0001");
        assert_eq!(ten_digits(0.293_000_000_000_000_04), "0.293");
        assert_eq!(ten_digits(-0.0), "0");
        assert_eq!(ten_digits(2.782_455_694_123e-5), "2.782455694e-5");
    }
}
