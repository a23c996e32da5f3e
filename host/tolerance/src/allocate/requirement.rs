//! What is required of measures, as figures that must not exceed 1.
//!
//! A figure grows with tolerances as their sum (worst case) or as the sum of their squares (all others): exactly so where the
//! measure is linear and normal, and nearly elsewhere.

use super::{
    AllocateError,
    figures::{Figures, Precision},
    full_model::{Formula, any_defects, defects, drawn},
    program::Power,
};
use crate::{
    model::{Measure, Model},
    numeric::normal,
    theory::{
        derivative::evaluate,
        moments::{self, Moments},
    },
};

/// What is required.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// No combination of limits is outside.
    WorstCase,
    /// The root of the sum of squares is at most half the distance of the limits, as if the middle were there.
    Rss,
    /// The middle ± the root of the sum of squares lies within the limits.
    RssOffCentre,
    /// The share of units outside is at most this, by the full model.
    Defects(f64),
    /// Ppk of drawn units is at least this.
    Ppk(f64),
    /// The share of units that malfunction is at most this, by simulation of what every one does.
    Malfunction {
        /// The share that is allowed.
        allowed: f64,
        /// The greatest force (N) that the motor has; units that need more malfunction.
        force_limit: Option<f64>,
    },
}

/// The share of units that malfunction with given tolerances (SI) and a motor's greatest force (N).
pub type Malfunctions<'a> = dyn Fn(&[f64], Option<f64>) -> Result<f64, AllocateError> + Sync + 'a;

/// A requirement of one measure, or of all that have limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requirement {
    /// Which measure; `None` for all together.
    pub measure: Option<usize>,
    /// What.
    pub kind: Kind,
}

/// One figure of a requirement.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Whose.
    pub requirement: Requirement,
    /// Lower (0) or upper (1) limit, where each has a figure of its own.
    pub side: Option<usize>,
    /// What the figure is 1 at (SI): a distance from the middle.
    distance: f64,
    /// Value at the middle of all tolerances (SI).
    middle: f64,
}

/// A figure in the units of what is required.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown {
    /// What was found: a tolerance or an extreme (SI), ppm, Ppk, percent.
    pub found: f64,
    /// What is allowed.
    pub allowed: f64,
}

/// Requirements of the measures of a product whose model follows from tolerances.
pub struct OfMeasures<'a> {
    rows: Vec<Row>,
    model: &'a (dyn Fn(&[f64]) -> Result<Model, AllocateError> + Sync),
    malfunctions: Option<&'a Malfunctions<'a>>,
    /// Whether slopes describe all measures of which something is required.
    smooth: bool,
    seed: u64,
}

/// What counts as on a limit, as a share of how far a measure varies.
const TOUCHING: f64 = 1e-9;

impl Kind {
    /// How its figures grow.
    pub fn power(self) -> Power {
        if self == Self::WorstCase { Power::One } else { Power::Two }
    }
}

impl<'a> OfMeasures<'a> {
    /// Of `requirements` with the `model` of given tolerances, such as those to `start` from.
    ///
    /// # Errors
    /// [`AllocateError`], if there is no model, or RSS is required of a measure that slopes do not describe.
    pub fn new(
        requirements: &[Requirement],
        model: &'a (dyn Fn(&[f64]) -> Result<Model, AllocateError> + Sync),
        start: &[f64],
        seed: u64,
    ) -> Result<Self, AllocateError> {
        let at_start = model(start)?;
        let by_slopes: Vec<bool> = moments::of_measures(&at_start).iter().map(Moments::by_slopes).collect();
        let values = evaluate(&at_start, &[at_start.middles()]).concat();
        let mut rows = Vec::new();
        for requirement in requirements {
            let row = |side, distance, middle| Row { requirement: *requirement, side, distance, middle };
            let Some(i) = requirement.measure else {
                rows.push(row(None, 1.0, 0.0));
                continue;
            };
            let Measure { name, limits, .. } = &at_start.measures[i];
            if matches!(requirement.kind, Kind::Rss | Kind::RssOffCentre) && !by_slopes[i] {
                return Err(AllocateError::NotLinear(name.clone()));
            }
            let room = [limits[0].map(|limit| values[i] - limit), limits[1].map(|limit| limit - values[i])];
            match (requirement.kind, limits) {
                (Kind::Rss, [Some(lower), Some(upper)]) => rows.push(row(None, 0.5 * (upper - lower), values[i])),
                (Kind::Defects(_), _) => rows.push(row(None, 1.0, values[i])),
                _ => rows.extend(
                    room.into_iter().enumerate().filter_map(|(side, room)| Some(row(Some(side), room?, values[i]))),
                ),
            }
        }
        let is_meant = |i: usize| match requirements.iter().any(|one| one.measure.is_none()) {
            true => at_start.measures[i].limits != [None; 2],
            false => requirements.iter().any(|one| one.measure == Some(i)),
        };
        let smooth = (0..by_slopes.len()).all(|i| by_slopes[i] || !is_meant(i));
        Ok(Self { rows, model, malfunctions: None, smooth, seed })
    }

    /// The same, with what tells how many units malfunction.
    pub fn with_malfunctions(self, malfunctions: &'a Malfunctions<'a>) -> Self {
        Self { malfunctions: Some(malfunctions), ..self }
    }

    /// All rows, in the order of their figures.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    fn value(&self, row: &Row, model: &Model, formula: Option<&Formula>) -> Result<f64, AllocateError> {
        let share = |part: f64, distance: f64| if distance > 0.0 { part / distance } else { f64::INFINITY };
        let Some(i) = row.requirement.measure else { return Ok(f64::NAN) };
        Ok(match (row.requirement.kind, formula) {
            (Kind::WorstCase, Some(formula)) => {
                let [low, high] = formula.worst[i];
                let part = if row.side == Some(0) { row.middle - low } else { high - row.middle };
                // A measure that lies on its limit in the middle, and goes nowhere beyond, holds it.
                let close = TOUCHING * (high - low);
                let touches = close.is_finite() && row.distance.abs() <= close;
                if touches && part <= close { 0.0 } else { share(part, row.distance) }
            }
            (Kind::Rss | Kind::RssOffCentre, Some(formula)) => {
                let share = share(formula.rss[i], row.distance);
                share * share
            }
            (Kind::Defects(allowed), _) => of_defects(defects(model, i, self.seed)?, allowed),
            (Kind::Ppk(allowed), _) => {
                let Some([mean, deviation]) = drawn(model, i, self.seed)? else { return Ok(f64::INFINITY) };
                let limit = model.measures[i].limits[row.side.unwrap_or(0)].unwrap_or(f64::NAN);
                let room = if row.side == Some(0) { mean - limit } else { limit - mean };
                let share = share(3.0 * deviation * allowed, room);
                share * share
            }
            (Kind::WorstCase | Kind::Rss | Kind::RssOffCentre, None) | (Kind::Malfunction { .. }, _) => f64::NAN,
        })
    }
}

impl Figures for OfMeasures<'_> {
    fn powers(&self) -> Vec<Power> {
        self.rows.iter().map(|row| row.requirement.kind.power()).collect()
    }

    fn precision(&self) -> Precision {
        let counts = self.rows.iter().any(|row| matches!(row.requirement.kind, Kind::Malfunction { .. }));
        if counts { Precision::COUNTED } else { Precision::COMPUTED }
    }

    fn smooth(&self) -> bool {
        self.smooth
    }

    fn reliefs(&self) -> Vec<f64> {
        self.rows.iter().map(Row::relief).collect()
    }

    fn values(&self, tolerances: &[f64]) -> Result<Vec<f64>, AllocateError> {
        let model = (self.model)(tolerances)?;
        let by_formula = |row: &Row| matches!(row.requirement.kind, Kind::WorstCase | Kind::Rss | Kind::RssOffCentre);
        let of_worst = |row: &Row| row.requirement.measure.filter(|_| row.requirement.kind == Kind::WorstCase);
        let mut worst_of: Vec<usize> = self.rows.iter().filter_map(of_worst).collect();
        worst_of.dedup();
        let formula = self.rows.iter().any(by_formula).then(|| Formula::new(&model, &worst_of));
        let mut values = Vec::with_capacity(self.rows.len());
        for row in &self.rows {
            values.push(self.value(row, &model, formula.as_ref())?);
        }
        let of_all = |pick: fn(Kind) -> bool| {
            self.rows.iter().position(|row| row.requirement.measure.is_none() && pick(row.requirement.kind))
        };
        if let Some(at) = of_all(|kind| matches!(kind, Kind::Defects(_)))
            && let Kind::Defects(allowed) = self.rows[at].requirement.kind
        {
            values[at] = of_defects(any_defects(model, self.seed)?, allowed);
        }
        if let Some(at) = of_all(|kind| matches!(kind, Kind::Malfunction { .. }))
            && let Kind::Malfunction { allowed, force_limit } = self.rows[at].requirement.kind
            && let Some(malfunctions) = self.malfunctions
        {
            values[at] = of_defects(malfunctions(tolerances, force_limit)?, allowed);
        }
        Ok(values)
    }
}

impl Row {
    /// A figure in the units of the requirement.
    pub fn shown(&self, figure: f64) -> Shown {
        let root = libm::sqrt(figure);
        let sign = if self.side == Some(0) { -1.0 } else { 1.0 };
        match self.requirement.kind {
            Kind::WorstCase => Shown {
                found: self.middle + sign * figure * self.distance,
                allowed: self.middle + sign * self.distance,
            },
            Kind::Rss => Shown { found: root * self.distance, allowed: self.distance },
            Kind::RssOffCentre => {
                Shown { found: self.middle + sign * root * self.distance, allowed: self.middle + sign * self.distance }
            }
            Kind::Defects(allowed) => {
                let found = 2.0 * normal::tail(score(allowed) / root);
                Shown { found: found * 1e6, allowed: allowed * 1e6 }
            }
            Kind::Ppk(allowed) => Shown { found: allowed / root, allowed },
            Kind::Malfunction { allowed, .. } => {
                Shown { found: 200.0 * normal::tail(score(allowed) / root), allowed: 100.0 * allowed }
            }
        }
    }

    /// The measure at the middle of all tolerances (SI).
    pub fn middle(&self) -> f64 {
        self.middle
    }

    /// What 1 % wider limits, or 10 % more defects, add to what the figure may be.
    pub fn relief(&self) -> f64 {
        match self.requirement.kind {
            Kind::Defects(allowed) | Kind::Malfunction { allowed, .. } => {
                let [now, more] = [allowed, (1.1 * allowed).min(1.0 - f64::EPSILON)].map(score);
                now * now / (more * more) - 1.0
            }
            kind => 0.01 * kind.power().exponent(),
        }
    }
}

/// The score beyond which a share lies on both sides of a normal.
fn score(share: f64) -> f64 {
    -normal::quantile(0.5 * share)
}

/// The figure of a share of defects: what the variance is over what it may be, were the measure normal.
fn of_defects(share: f64, allowed: f64) -> f64 {
    if share >= 1.0 {
        return f64::INFINITY;
    }
    if share <= 0.0 {
        return 0.0;
    }
    let [found, allowed] = [share, allowed].map(score);
    allowed * allowed / (found * found)
}
