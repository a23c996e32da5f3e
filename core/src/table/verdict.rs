//! What became of the motions that a table is made of.

use super::{Axis, TableError, axis::Place};

/// The verdict on one motion of the table, a unit of some level at some command; the discriminant is what a table stores.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum MotionVerdict {
    /// Not told: the motion ended too early, or its verdict is in doubt.
    #[default]
    Undecided = 0,
    /// At least half of the commanded speed at the end.
    Runs = 1,
    /// 1 % to 50 % of it.
    Crawls = 2,
    /// Below 1 %.
    Jammed = 3,
}

impl MotionVerdict {
    /// All verdicts.
    pub const ALL: [Self; 4] = [Self::Undecided, Self::Runs, Self::Crawls, Self::Jammed];

    /// The verdict stored as `code`.
    pub fn of(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|verdict| *verdict as u8 == code)
    }

    /// The verdict's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Undecided => "undecided",
            Self::Runs => "runs",
            Self::Crawls => "crawls",
            Self::Jammed => "jammed",
        }
    }
}

/// How many motions a table over axes of so many nodes holds: the nodes of the grid without its second axis, along which a
/// motion proceeds. `None` beyond what a `usize` counts.
pub fn motions(counts: impl IntoIterator<Item = usize>) -> Option<usize> {
    let across = counts.into_iter().enumerate().filter(|(axis, _)| *axis != 1);
    across.map(|(_, count)| count).try_fold(1, usize::checked_mul)
}

/// Added to a motion's byte where the motion at the next node of the first axis has another verdict.
const DIFFERS: u8 = 1;

/// What a byte says of its own motion.
pub(super) fn code(byte: u8) -> u8 {
    byte >> 1
}

/// The bytes that a table stores for motions with these `verdicts`; the motion at the next node of the first axis is the one
/// `apart` places on.
pub fn verdict_bytes(verdicts: &[MotionVerdict], apart: usize) -> impl Iterator<Item = u8> {
    let next = verdicts.iter().skip(apart).map(Some).chain(core::iter::repeat(None));
    verdicts.iter().zip(next).map(|(verdict, next)| {
        let differs = next.is_some_and(|next| next != verdict);
        (*verdict as u8) << 1 | if differs { DIFFERS } else { 0 }
    })
}

/// The bytes of so many `motions`, from what is behind the nodes; `apart` is how far the next node of the first axis is.
pub(super) fn checked(rest: &[u8], motions: usize, apart: usize) -> Result<&[u8], TableError> {
    if motions.checked_next_multiple_of(4) != Some(rest.len()) {
        return Err(TableError::Header("length"));
    }
    let bytes = rest.get(..motions).unwrap_or_default();
    for (place, byte) in rest.iter().enumerate() {
        let next = bytes.get(place.saturating_add(apart)).unwrap_or(byte);
        let differs = code(*next) != code(*byte);
        let is_verdict = MotionVerdict::of(code(*byte)).is_some() && differs == (byte & DIFFERS != 0);
        if !(is_verdict && (place < motions || *byte == 0)) {
            return Err(TableError::Value("verdicts"));
        }
    }
    Ok(bytes)
}

/// Whether the point at `places` on `axes` lies between motions whose verdicts differ.
#[inline(always)]
pub(super) fn differ(bytes: &[u8], axes: &[Axis], places: &[Place]) -> bool {
    // Beyond the motions, where an open table never looks, all are the same.
    let at = |place: usize| bytes.get(place).copied().unwrap_or_default();
    match (axes, places) {
        // A byte tells, without a look at the next one.
        ([_, _], [level, _]) => u32::from(at(level.node)) & level.between() >> 31 != 0,
        ([_, _, speeds], [level, _, speed]) => {
            let ([low, high], [left, right]) = (level.ends(), speed.ends());
            let of = |level: usize, speed: usize| code(at(level.wrapping_mul(speeds.count()).wrapping_add(speed)));
            let first = of(low, left);
            first != of(low, right) || first != of(high, left) || first != of(high, right)
        }
        _ => false,
    }
}
