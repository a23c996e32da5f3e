//! Ranges of tolerance levels, or of other numbers, `FIRST:LAST:STEP`.

use crate::setup::LevelRange;

/// The most levels of a sweep.
pub const MOST_LEVELS: usize = 100_000;

/// What is not a range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LevelError {
    /// Neither one number nor three.
    #[error("\"{0}\" is neither FIRST:LAST:STEP, such as -3:5:0.1, nor one number")]
    Form(String),
    /// A part that is not a number.
    #[error("\"{0}\" is not a number")]
    NotANumber(String),
    /// NaN or infinite.
    #[error("{0} is not finite")]
    NotFinite(f64),
    /// The last is below the first.
    #[error("the last, {last}, is below the first, {first}")]
    Backwards {
        /// The first.
        first: f64,
        /// The last.
        last: f64,
    },
    /// The step is not positive.
    #[error("the step is {0}, it must be positive")]
    Step(f64),
    /// More than [`MOST_LEVELS`].
    #[error("the step of {step:?} makes more than {MOST_LEVELS} values")]
    TooMany {
        /// The step.
        step: f64,
    },
}

/// Reads `FIRST:LAST:STEP`, both ends included, or a single number.
///
/// # Errors
/// [`LevelError`] if a part is not a finite number, the step is not positive, the range runs backwards, or it has more
/// than [`MOST_LEVELS`].
pub fn parse_levels(text: &str) -> Result<LevelRange, LevelError> {
    let number = |part: &str| match part.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(number) => Err(LevelError::NotFinite(number)),
        Err(_) => Err(LevelError::NotANumber(part.trim().into())),
    };
    let parts: Vec<_> = text.split(':').collect();
    let (first, last, step) = match parts[..] {
        [level] if !level.trim().is_empty() => return Ok(LevelRange { first: number(level)?, step: 1.0, count: 1 }),
        [first, last, step] => (number(first)?, number(last)?, number(step)?),
        _ => return Err(LevelError::Form(text.into())),
    };
    if step <= 0.0 {
        return Err(LevelError::Step(step));
    }
    if last < first {
        return Err(LevelError::Backwards { first, last });
    }
    // The margin keeps the last level where the quotient is rounded down.
    let steps = (last - first) / step + 1e-6;
    if steps >= MOST_LEVELS as f64 {
        return Err(LevelError::TooMany { step });
    }
    Ok(LevelRange { first, step, count: steps as usize + 1 })
}

#[cfg(test)]
mod tests {
    use super::{LevelError, parse_levels};

    #[test]
    fn both_ends_are_levels() {
        for (text, count, last) in
            [("0:5:0.1", 51, 5.0), ("-3:5:0.1", 81, 5.0), ("0:1:0.3", 4, 0.9), (" 1 : 1 : 9 ", 1, 1.0), ("2.5", 1, 2.5)]
        {
            let levels = parse_levels(text).unwrap();
            assert_eq!(levels.count, count, "{text}");
            assert!((levels.level(count - 1) - last).abs() < 1e-12, "{text}");
        }
        assert_eq!(parse_levels("0:99999:1").map(|levels| levels.count), Ok(100_000));
    }

    #[test]
    fn what_is_no_range_is_refused() {
        for (text, expected) in [
            ("", LevelError::Form("".into())),
            (" ", LevelError::Form(" ".into())),
            ("0:5", LevelError::Form("0:5".into())),
            ("0:5:1:2", LevelError::Form("0:5:1:2".into())),
            ("0::1", LevelError::NotANumber("".into())),
            ("a", LevelError::NotANumber("a".into())),
            ("0:inf:1", LevelError::NotFinite(f64::INFINITY)),
            ("0:1:inf", LevelError::NotFinite(f64::INFINITY)),
            ("5:0:1", LevelError::Backwards { first: 5.0, last: 0.0 }),
            ("0:5:0", LevelError::Step(0.0)),
            ("5:0:-1", LevelError::Step(-1.0)),
            ("0:100000:1", LevelError::TooMany { step: 1.0 }),
            ("-1e308:1e308:1", LevelError::TooMany { step: 1.0 }),
            ("0:1:1e-320", LevelError::TooMany { step: 1e-320 }),
        ] {
            assert_eq!(parse_levels(text), Err(expected), "{text}");
        }
        assert!(matches!(parse_levels("0:1:nan"), Err(LevelError::NotFinite(_))));
    }
}
