//! What construction refuses.

/// A parameter outside its bounds, or not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ParameterError<S> {
    /// The parameter's name, as in the data it came from.
    pub parameter: &'static str,
    /// The value found, SI.
    pub value: S,
    /// The least value allowed, SI.
    pub least: S,
    /// The greatest value allowed, SI.
    pub greatest: S,
}

impl<S: core::fmt::Display> core::fmt::Display for ParameterError<S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { parameter, value, least, greatest } = self;
        write!(f, "{parameter} is {value}, allowed is {least} to {greatest} (SI units)")
    }
}

impl<S: core::fmt::Display + core::fmt::Debug> core::error::Error for ParameterError<S> {}

/// `value` if it lies in [`least`, `greatest`].
///
/// # Errors
/// [`ParameterError`] if it does not, or is NaN.
pub(crate) fn bounded<S: crate::Scalar + PartialOrd>(
    parameter: &'static str,
    value: S,
    [least, greatest]: [f64; 2],
) -> Result<S, ParameterError<S>> {
    let (least, greatest) = (S::from_f64(least), S::from_f64(greatest));
    if value >= least && value <= greatest {
        Ok(value)
    } else {
        Err(ParameterError { parameter, value, least, greatest })
    }
}
