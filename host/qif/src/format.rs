//! Numbers as they are written.

/// `value` (mm) without the digits that conversions made up: to 10⁻⁹ mm.
pub fn rounded(value: f64) -> f64 {
    let nano = (value * 1e9).round();
    // Beyond 2⁵³ all digits are before the point; adding 0 turns −0 into 0.
    if nano.abs() < 9e15 { nano / 1e9 + 0.0 } else { value }
}

/// A unit vector without the digits that calculations made up: to 10⁻¹².
pub fn rounded_direction(vector: [f64; 3]) -> [f64; 3] {
    vector.map(|x| (x * 1e12).round() / 1e12 + 0.0)
}

/// `value` rounded to 12 significant digits, as a product with a unit's factor is.
pub fn twelve_digits(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// Unit vector of `vector`.
pub fn unit(vector: [f64; 3]) -> Option<[f64; 3]> {
    let length = libm::sqrt(dot(vector, vector));
    (length > 1e-9 && length.is_finite()).then(|| vector.map(|x| x / length))
}

/// Scalar product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a` + `scale` · `b`.
pub fn plus(a: [f64; 3], scale: f64, b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + scale * b[i])
}

#[cfg(test)]
mod tests {
    use super::{rounded, rounded_direction, twelve_digits};

    #[test]
    fn made_up_digits_are_dropped() {
        assert_eq!(rounded(-175.000000000001), -175.0);
        assert!(rounded(-1e-15).is_sign_positive());
        assert_eq!(twelve_digits(0.438 * 0.0254 * 1000.0), 11.1252);
        assert_eq!(rounded_direction([0.6, -1e-16, 0.8]), [0.6, 0.0, 0.8]);
    }
}
