//! Normal numbers by inversion: one random number gives one normal, as designs and importance sampling need it.
//!
//! Wichura, "The percentage points of the normal distribution", Applied Statistics 37 (1988), algorithm AS 241, routine
//! PPND16: three ratios of polynomials, of which the right one is selected, so that nothing branches.

#![allow(clippy::excessive_precision, reason = "coefficients as published")]

use crate::Scalar;

/// A ratio of two polynomials of degree 7, coefficients in ascending order.
struct Ratio {
    above: [f64; 8],
    below: [f64; 8],
}

/// In 0.425² − q², q = ½ − v, for q ≤ 0.425.
const CENTRE: Ratio = Ratio {
    above: [
        3.387_132_872_796_366_608,
        1.331_416_678_917_843_774_5e2,
        1.971_590_950_306_551_442_7e3,
        1.373_169_376_550_946_112_5e4,
        4.592_195_393_154_987_145_7e4,
        6.726_577_092_700_870_085_3e4,
        3.343_057_558_358_812_810_5e4,
        2.509_080_928_730_122_672_7e3,
    ],
    below: [
        1.0,
        4.231_333_070_160_091_125_2e1,
        6.871_870_074_920_579_083e2,
        5.394_196_021_424_751_107_7e3,
        2.121_379_430_158_659_586_7e4,
        3.930_789_580_009_271_061e4,
        2.872_908_573_572_194_267_4e4,
        5.226_495_278_852_854_561e3,
    ],
};

/// In r − 1.6, r = √(−ln v), for r ≤ 5.
const TAIL: Ratio = Ratio {
    above: [
        1.423_437_110_749_683_577_34,
        4.630_337_846_156_545_295_9,
        5.769_497_221_460_691_405_5,
        3.647_848_324_763_204_605_04,
        1.270_458_252_452_368_382_58,
        2.417_807_251_774_506_117_7e-1,
        2.272_384_498_926_918_458_33e-2,
        7.745_450_142_783_414_076_4e-4,
    ],
    below: [
        1.0,
        2.053_191_626_637_758_821_87,
        1.676_384_830_183_803_849_4,
        6.897_673_349_851_000_045_5e-1,
        1.481_039_764_274_800_745_9e-1,
        1.519_866_656_361_645_719_66e-2,
        5.475_938_084_995_344_946e-4,
        1.050_750_071_644_416_843_24e-9,
    ],
};

/// In r − 5, beyond.
const FAR_TAIL: Ratio = Ratio {
    above: [
        6.657_904_643_501_103_777_2,
        5.463_784_911_164_114_369_9,
        1.784_826_539_917_291_335_8,
        2.965_605_718_285_048_912_3e-1,
        2.653_218_952_657_612_309_3e-2,
        1.242_660_947_388_078_438_6e-3,
        2.711_555_568_743_487_578_15e-5,
        2.010_334_399_292_288_132_65e-7,
    ],
    below: [
        1.0,
        5.998_322_065_558_879_376_9e-1,
        1.369_298_809_227_358_053_1e-1,
        1.487_536_129_085_061_485_25e-2,
        7.868_691_311_456_132_591e-4,
        1.846_318_317_510_054_681_8e-5,
        1.421_511_758_316_445_888_7e-7,
        2.044_263_103_389_939_785_64e-15,
    ],
};

impl Ratio {
    #[inline(always)]
    fn at<S: Scalar>(&self, x: S) -> S {
        let polynomial = |coefficients: &[f64; 8]| {
            coefficients.iter().rev().fold(S::zero(), |sum, coefficient| sum * x + S::from_f64(*coefficient))
        };
        polynomial(&self.above) / polynomial(&self.below)
    }
}

/// The score z ≥ 0 above which a standard normal lies with probability `tail` = v, 0 < v ≤ ½.
///
/// Relative error ≤ 4e-15 in f64 for v ≥ 1e-300 and v ≤ 0.49, absolute error ≤ 1e-16 nearer the middle; 2e-6 and 2e-7
/// in f32 for v ≥ 1e-37.
#[inline(always)]
pub fn upper_score<S: Scalar>(tail: S) -> S {
    let s = S::from_f64;
    let q = s(0.5) - tail;
    let centre = q * CENTRE.at(s(0.180_625) - q * q);
    let r = (-tail.ln()).sqrt();
    let outside = r.select_gt(s(5.0), FAR_TAIL.at(r - s(5.0)), TAIL.at(r - s(1.6)));
    q.select_gt(s(0.425), outside, centre)
}

/// The standard normal of 64 random `bits`, read as the odd number u = (bits | 1)/2⁶⁴ in (0, 1): never infinite, and
/// exactly antisymmetric about u = ½.
#[inline(always)]
pub fn score<S: Scalar>(bits: u64) -> S {
    let above = bits | 1;
    let below = above.wrapping_neg();
    let tail = if above < below { above } else { below };
    let magnitude = upper_score(S::from_word(tail));
    if above < below { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::{score, upper_score};

    /// Standard normal tails with 50 digits of working precision.
    const TAILS: [(f64, f64); 8] = [
        (0.49, 0.025_068_908_258_711_06),
        (0.25, 0.674_489_750_196_081_7),
        (0.1, 1.281_551_565_544_600_5),
        (0.025, 1.959_963_984_540_054_2),
        (1e-3, 3.090_232_306_167_813_5),
        (1e-9, 5.997_807_015_007_687),
        (1e-20, 9.262_340_089_798_408),
        (1e-300, 37.047_096_299_361_2),
    ];

    #[test]
    fn scores_meet_their_bounds() {
        for (tail, score) in TAILS {
            let error = libm::fabs(upper_score(tail) / score - 1.0);
            assert!(error <= 4e-15, "{tail}: {error:e}");
            if tail > 1e-37 {
                // What rounding the tail itself does is not the routine's error.
                let single = tail as f32;
                let error = libm::fabs(f64::from(upper_score(single)) / upper_score(f64::from(single)) - 1.0);
                assert!(error <= 2e-6, "{tail}: {error:e} in f32");
            }
        }
        assert_eq!(upper_score(0.5), 0.0);
        assert!(libm::fabs(upper_score(0.5 - 1e-6) - 2.506_628_274_633_626e-6) <= 1e-16);
    }

    /// The tail of a score, by libm: what the score was asked for.
    #[test]
    fn scores_invert_the_distribution() {
        for step in (1..=4000).step_by(if cfg!(miri) { 200 } else { 1 }) {
            let tail = 0.5 * libm::exp2(-f64::from(step) / 50.0);
            let score = upper_score(tail);
            let back = 0.5 * libm::erfc(score * core::f64::consts::FRAC_1_SQRT_2);
            // An error of the score is magnified by the density, about z² in relative terms.
            assert!(libm::fabs(back / tail - 1.0) <= 4e-15 * (2.0 + score * score), "{tail:e}");
        }
    }

    #[test]
    fn every_word_has_a_finite_score_and_its_mirror_the_opposite() {
        for bits in [0, 1, 2, 12_345, u64::MAX / 2, u64::MAX / 3] {
            let (one, other) = (score::<f64>(bits), score::<f64>(!bits));
            assert!(one.is_finite() && one <= 0.0 && one == -other, "{bits}: {one} {other}");
        }
        assert!(score::<f32>(0) < -9.0 && score::<f32>(0).is_finite());
    }
}
