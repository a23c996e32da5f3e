//! What a table of a production says beside its rows: how it was calibrated, and the limits that follow.

use crate::table::{
    TableError,
    layout::{PRODUCTION_NUMBERS, VALUE_MOST},
};

/// The most modes of a production.
pub const MODES_MOST: usize = 8;

/// Rates of false alarms in a stroke that limits are stored for, a decade apart.
pub const RATES: [f32; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// The part of the mean unit's response below which the force of a unit does not show its friction.
const RESPONSE_LEAST: f32 = 0.1;

/// The record of a production. Places are on the table's second axis: s, or m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Record {
    /// The place from which units that complete their stroke move: three in ten thousand strokes stand for ten samples later.
    pub moving: f32,
    /// Time (s) from one sample to the next, for which the limits are.
    pub period: f32,
    /// Standard deviation (N) of the white noise of a measured force, for which the limits are.
    pub noise: f32,
    /// Standard deviation of the friction of a unit from one stroke to the next, as a share of it, for which the limits are.
    pub friction: f32,
    /// Share of the units that complete their stroke. The rows are about these.
    pub completing: f32,
    /// How many units they are made of.
    pub units: f32,
    /// Widths about the mean within which 99 % of their strokes stay all along.
    pub band: f32,
    /// Widths, with three standard deviations of what smoothing leaves of the noise, by which the smoothed force of a unit that is
    /// not taught exceeds the mean in the shares [`RATES`] of the strokes.
    pub untaught: [f32; RATES.len()],
    /// The same of taught units and what is expected of them, in three tenths of these shares.
    pub taught: [f32; RATES.len()],
    /// Standard deviations by which a friction seems to rise where it does not, in seven tenths of these shares.
    pub drift: [f32; RATES.len()],
    /// Standard deviation of the friction that one stroke tells, as a share of it.
    pub deviation: f32,
    /// Squared weight, summed over the places (N²·s or N²·m), which a stroke has to come to before half of what it tells of its friction
    /// is believed.
    pub doubt: f32,
    /// What the weighted force of a stroke rises by with the friction (N·s or N·m for a rise by its own size), of the mean unit.
    pub response: f32,
    /// What a mode adds to that response.
    pub responses: [f32; MODES_MOST],
    /// Rise of the friction, as a share of it, with which one in a hundred units does not complete its stroke any more; the
    /// greatest that was tried if fewer do not.
    pub margin: f32,
    /// Root mean square (N) of the difference of a taught unit's force from what is expected of it.
    pub residual: f32,
    /// Square of each mode, summed over the places (N²·s or N²·m).
    pub norms: [f32; MODES_MOST],
    /// Variance of the coefficient of a mode from one stroke of a unit to the next, of 1 from stroke to stroke of all units.
    pub variances: [f32; MODES_MOST],
}

impl Record {
    /// The record in `bytes`.
    ///
    /// # Errors
    /// [`TableError::Header`] names what is out of bounds.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, TableError> {
        let (numbers, []) = bytes.as_chunks() else { return Err(TableError::Header("record of the production")) };
        let mut numbers = numbers.iter().map(|bytes| f32::from_le_bytes(*bytes));
        let mut next = || numbers.next().unwrap_or(f32::NAN);
        let read = Self {
            moving: next(),
            period: next(),
            noise: next(),
            friction: next(),
            completing: next(),
            units: next(),
            band: next(),
            untaught: core::array::from_fn(|_| next()),
            taught: core::array::from_fn(|_| next()),
            drift: core::array::from_fn(|_| next()),
            deviation: next(),
            doubt: next(),
            response: next(),
            responses: core::array::from_fn(|_| next()),
            margin: next(),
            residual: next(),
            norms: core::array::from_fn(|_| next()),
            variances: core::array::from_fn(|_| next()),
        };
        read.checked()
    }

    /// Its numbers, in the order in which a table stores them.
    pub fn numbers(&self) -> impl Iterator<Item = f32> {
        let Self { moving, period, noise, friction, completing, units, band, .. } = *self;
        let first = [moving, period, noise, friction, completing, units, band];
        let limits = self.untaught.into_iter().chain(self.taught).chain(self.drift);
        let rest = [self.deviation, self.doubt, self.response].into_iter().chain(self.responses);
        let last = [self.margin, self.residual].into_iter().chain(self.norms).chain(self.variances);
        first.into_iter().chain(limits).chain(rest).chain(last)
    }

    /// What the weighted force of a stroke rises by with the friction (N·s or N·m for a rise by its own size), of the unit with these
    /// coefficients; `None` where its force hardly depends on it.
    pub fn response_of(&self, coefficients: &[f32; MODES_MOST]) -> Option<f32> {
        let added: f32 = coefficients.iter().zip(self.responses).map(|(c, response)| c * response).sum();
        let response = self.response + added;
        (response != 0.0 && response.abs() >= RESPONSE_LEAST * self.response.abs()).then_some(response)
    }

    /// This record, if all its numbers are in bounds.
    ///
    /// # Errors
    /// [`TableError::Header`] names the first that is out of bounds.
    pub fn checked(self) -> Result<Self, TableError> {
        // NaN is in no range.
        let within = |x: f32, least: f32, most: f32| x >= least && x <= most;
        let limits = |limits: &[f32; RATES.len()]| limits.iter().all(|limit| within(*limit, 0.0, 1e6));
        for (name, is_good) in [
            ("start of the production", within(self.moving, -1e6, 1e6)),
            ("period of the production", within(self.period, 1e-6, 1.0)),
            ("noise of the production", within(self.noise, 0.0, VALUE_MOST)),
            ("friction of the production", within(self.friction, 0.0, 1.0) && within(self.margin, 0.0, 1e6)),
            ("units of the production", within(self.completing, 0.0, 1.0) && within(self.units, 1.0, 1e9)),
            ("band of the production", within(self.band, 0.0, 1e6)),
            ("limits of the production", [&self.untaught, &self.taught, &self.drift].into_iter().all(limits)),
            ("deviation of the production", within(self.deviation, 1e-9, 1e6)),
            ("doubt of the production", within(self.doubt, f32::MIN_POSITIVE, VALUE_MOST)),
            ("response of the production", within(self.response, -VALUE_MOST, VALUE_MOST)),
            ("response of the production", self.responses.iter().all(|x| within(*x, -VALUE_MOST, VALUE_MOST))),
            ("residual of the production", within(self.residual, 0.0, VALUE_MOST)),
            ("norms of the production", self.norms.iter().all(|x| within(*x, 0.0, VALUE_MOST))),
            ("variances of the production", self.variances.iter().all(|x| within(*x, 0.0, 1e12))),
        ] {
            if !is_good {
                return Err(TableError::Header(name));
            }
        }
        Ok(self)
    }
}

/// How many numbers there are, is what the layout says.
const _: () = assert!(7 + 3 * RATES.len() + 3 + MODES_MOST + 2 + 2 * MODES_MOST == PRODUCTION_NUMBERS);
