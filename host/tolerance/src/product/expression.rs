//! Arithmetic expressions of dimensions and measures, such as `acos((a + c) / (e - c))`.
//!
//! Lengths, angles, plain numbers, forces, masses, times and what they make are told apart: a length cannot be added to an
//! angle, `sqrt(a * b)` of two lengths is a length, a force over a length a stiffness. A constant carries its unit (`3 mm`,
//! `30°`) or is a plain number. A name with spaces stands in single quotes.

mod affine;
mod fault;
mod grammar;
#[cfg(test)]
pub(crate) mod interpreted;
mod kind;
mod operation;
mod tape;

pub use self::{
    affine::Affine,
    fault::{ExpressionError, Fault},
    grammar::{FUNCTIONS, parse},
    kind::Kind,
    operation::{Expression, Source},
    tape::Tape,
};

#[cfg(test)]
mod tests {
    use super::{ExpressionError, Fault, Kind, Source, parse};
    use crate::{model::Quantity, numeric::lanes::Lanes};

    /// Variables: a 2 mm, b 3 mm, φ 60°; measure `the gap` 0.5 mm.
    fn value(text: &str) -> Result<(f64, Quantity), ExpressionError> {
        let resolve = |name: &str| match name {
            "a" => Some((Source::Variable(0), Kind::LENGTH)),
            "b.c" => Some((Source::Variable(1), Kind::LENGTH)),
            "φ" => Some((Source::Variable(2), Kind::ANGLE)),
            "the gap" => Some((Source::Measure(0), Kind::LENGTH)),
            _ => None,
        };
        let variables = [2e-3, 3e-3, std::f64::consts::FRAC_PI_3].map(Lanes::splat);
        let measures = [Lanes::splat(0.5e-3)];
        let expression = parse(text, resolve)?;
        expression.check(&variables, &measures)?;
        let value = expression.evaluate(&variables, &measures);
        assert_eq!(value.0[0].to_bits(), value.0[7].to_bits());
        Ok((value.0[0], expression.quantity()))
    }

    #[test]
    fn arithmetic() {
        for (text, expected, quantity) in [
            ("a + b.c", 5e-3, Quantity::Length),
            ("a - b.c - 'the gap'", -1.5e-3, Quantity::Length),
            ("-a + 3 * b.c ÷ 2 × 1", 2.5e-3, Quantity::Length),
            ("a − 1 mm + 10 µm + 0.001 cm + 1e-6 m", 1.021e-3, Quantity::Length),
            ("2^3^2 / 2^-1", 1024.0, Quantity::Ratio),
            ("-2^2", -4.0, Quantity::Ratio),
            ("sqrt(a^2 + b.c * b.c)", libm::sqrt(13.0) * 1e-3, Quantity::Length),
            ("(a * b.c)^0.5", libm::sqrt(6.0) * 1e-3, Quantity::Length),
            ("sin(φ) * a", libm::sqrt(3.0) * 1e-3, Quantity::Length),
            ("cos(60 deg) + tan(45°) - sin(0.5 rad) / sin(0.5)", 0.5, Quantity::Ratio),
            ("acos(a / b.c) - asin(2 / 3) + atan(0)", libm::acos(2.0 / 3.0) - libm::asin(2.0 / 3.0), Quantity::Angle),
            ("1 in - 25.4 mm + a", 2e-3, Quantity::Length),
            ("abs(a - b.c)", 1e-3, Quantity::Length),
            ("min(a, b.c, 'the gap') + max(a, b.c)", 3.5e-3, Quantity::Length),
            ("pi * 2 * a / a", std::f64::consts::TAU, Quantity::Ratio),
            ("φ * a", 2e-3 * std::f64::consts::FRAC_PI_3, Quantity::Length),
            ("φ / 1°", 60.0, Quantity::Ratio),
            ("2 kg * 3 m / 1 s^2 - 5 N", 1.0, Quantity::Force),
            ("0.5 kN / 2 mm", 250e3, Quantity::Stiffness),
            ("5 N * a", 0.01, Quantity::Moment),
            ("8 N / a^2 - 1.5 MPa", 0.5e6, Quantity::Pressure),
            ("2 * 3 g", 6e-3, Quantity::Mass),
            ("sqrt(1 kg * a / 5 N)", 0.02, Quantity::Time),
            ("8 N / a^2 / 1 MPa", 2.0, Quantity::Ratio),
        ] {
            let (found, kind) = value(text).unwrap_or_else(|error| panic!("{text}: {}", error.fault));
            assert!((found - expected).abs() < 1e-14 * expected.abs().max(1.0), "{text}: {found}, not {expected}");
            assert_eq!(kind, quantity, "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_pointed_at() {
        for (text, marked, message) in [
            ("", "", "expected a number, a name, a function or a parenthesis, found the end"),
            ("a +", "", "expected a number, a name, a function or a parenthesis, found the end"),
            ("a * / 2", "/", "found `/`"),
            ("(a", "", "expected `)`, found the end"),
            ("a b.c", "b.c", "expected an operator, found `b.c`"),
            ("a ? 2", "?", "found `?`"),
            ("'the gap", "'the gap", "expected a closing quote"),
            ("a + c", "c", "no measure above called `c`"),
            ("sinus(φ)", "sinus", "no function `sinus`"),
            ("hypot(a, b.c)", "hypot", "no function `hypot`"),
            ("if(a > 1, a, b.c)", "if", "no function `if`"),
            ("min()", ")", "found `)`"),
            ("3 inch + a", "inch", "`inch` is no unit"),
            ("1.2.3", "1.2.3", "expected a number"),
            ("a + 3", "+", "cannot add a length and a plain number"),
            ("a - φ", "-", "cannot subtract a length and an angle"),
            ("sin(a)", "sin", "takes an angle or a plain number, not a length"),
            ("acos(a)", "acos", "takes a plain number, not a length"),
            ("a ^ b.c", "^", "cannot raise"),
            ("max(a, 1)", "max", "cannot compare a length and a plain number"),
            ("a * a", "a * a", "the result is a length to the power 2"),
            ("a + 5 N", "+", "cannot add a length and a force"),
            ("5 N * 1 s", "5 N * 1 s", "the result is a number in m·kg·s^-1"),
            ("a / (b.c - 3 mm)", "/", "divides by zero at the nominal"),
            ("acos(b.c / a)", "acos", "is not a finite number at the nominal"),
            ("sqrt(a - b.c) / sqrt(a)", "sqrt", "is not a finite number"),
            ("a * 1e200", "1e200", "is 1e100 or more at the nominal"),
            ("a * 1e60 * 1e60", "*", "is 1e100 or more at the nominal"),
        ] {
            let error = value(text).unwrap_err();
            assert!(error.fault.to_string().contains(message), "{text}: {}", error.fault);
            assert_eq!(&text[error.place.clone()], marked, "{text}");
        }
        for deep in ["(".repeat(10_000), "-".repeat(10_000), "a+(".repeat(20) + "a", "2^".repeat(10_000)] {
            assert_eq!(value(&deep).unwrap_err().fault, Fault::Depth);
        }
    }

    proptest::proptest! {
        #[test]
        fn no_text_panics(text in "[a-z0-9+*/^()', .φ°-]{0,40}|.*") {
            if let Err(error) = value(&text) {
                assert!(text.get(error.place).is_some());
            }
        }
    }
}
