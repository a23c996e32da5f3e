//! The cube root by which step lengths change.

/// ∛`x` to 0.02 %, for x > 0 and normal: Halley's step from a guess whose bits have a third of the exponent.
#[inline(always)]
pub fn cube_root(x: f32) -> f32 {
    let guess = f32::from_bits(x.to_bits() / 3 + 0x2a51_19f2);
    let cube = guess * guess * guess;
    guess * (cube + x + x) / (cube + cube + x)
}

#[cfg(test)]
mod tests {
    use super::cube_root;

    #[test]
    fn cube_roots_meet_their_bound() {
        for k in -4000..4000 {
            let x = libm::exp2f(k as f32 / 67.0);
            let error = f64::from(cube_root(x)) / libm::cbrt(f64::from(x)) - 1.0;
            assert!(error.abs() < 2e-4, "{x:e}: {error:e}");
        }
    }
}
