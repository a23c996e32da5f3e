//! The laws of a drive train that are compared.

use serde::Serialize;

use super::{Filtered, motion::Signal};
use crate::model::{Model, ModelError, Parameter};

/// A term of the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Term {
    /// Mass times acceleration.
    Mass,
    /// Viscous friction, the same in both directions.
    Viscous,
    /// Viscous friction forwards.
    ViscousForwards,
    /// Viscous friction backwards.
    ViscousBackwards,
    /// Coulomb friction, the same in both directions.
    Coulomb,
    /// Coulomb friction forwards.
    CoulombForwards,
    /// Coulomb friction backwards.
    CoulombBackwards,
    /// Constant force.
    Offset,
    /// Time by which the recorded force leads the motion: half an interval where a controller holds its command, more with a slow bus.
    Delay,
}

/// The laws that are compared, from the simplest on, with their names.
pub const LAWS: [(&str, &[Term]); 5] = [
    ("coulomb", &Term::DRY),
    ("symmetric", &Term::SYMMETRIC),
    ("by-direction", &Term::BY_DIRECTION),
    ("symmetric-delayed", &Term::SYMMETRIC_DELAYED),
    ("by-direction-delayed", &Term::BY_DIRECTION_DELAYED),
];

impl Term {
    /// Every term.
    pub const ALL: [Self; 9] = [
        Self::Mass,
        Self::Viscous,
        Self::ViscousForwards,
        Self::ViscousBackwards,
        Self::Coulomb,
        Self::CoulombForwards,
        Self::CoulombBackwards,
        Self::Offset,
        Self::Delay,
    ];
    /// Mass, viscous and Coulomb friction, and an offset.
    pub const SYMMETRIC: [Self; 4] = [Self::Mass, Self::Viscous, Self::Coulomb, Self::Offset];
    /// Mass and Coulomb friction alone.
    pub const DRY: [Self; 2] = [Self::Mass, Self::Coulomb];
    /// Friction by direction, which has the offset in it.
    pub const BY_DIRECTION: [Self; 5] =
        [Self::Mass, Self::ViscousForwards, Self::CoulombForwards, Self::ViscousBackwards, Self::CoulombBackwards];

    /// [`SYMMETRIC`](Self::SYMMETRIC) with a delay.
    pub const SYMMETRIC_DELAYED: [Self; 5] = [Self::Mass, Self::Viscous, Self::Coulomb, Self::Offset, Self::Delay];
    /// [`BY_DIRECTION`](Self::BY_DIRECTION) with a delay.
    pub const BY_DIRECTION_DELAYED: [Self; 6] = [
        Self::Mass,
        Self::ViscousForwards,
        Self::CoulombForwards,
        Self::ViscousBackwards,
        Self::CoulombBackwards,
        Self::Delay,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mass => "mass",
            Self::Viscous => "viscous",
            Self::ViscousForwards => "viscous forwards",
            Self::ViscousBackwards => "viscous backwards",
            Self::Coulomb => "coulomb",
            Self::CoulombForwards => "coulomb forwards",
            Self::CoulombBackwards => "coulomb backwards",
            Self::Offset => "offset",
            Self::Delay => "delay",
        }
    }

    /// The symbol of its SI unit, and of that of its ratio to the mass.
    fn units(self) -> [&'static str; 2] {
        match self {
            Self::Mass => ["kg", ""],
            Self::Viscous | Self::ViscousForwards | Self::ViscousBackwards => ["N·s/m", "1/s"],
            Self::Coulomb | Self::CoulombForwards | Self::CoulombBackwards | Self::Offset => ["N", "m/s²"],
            Self::Delay => ["s", ""],
        }
    }

    /// Its force for a parameter of 1, sample by sample, and the derivative of that by time; `None` of a delay, which is no force.
    fn force(self, motion: &Filtered) -> Option<Signal> {
        let Filtered { acceleration, speed, forwards, speed_forwards, .. } = motion;
        let samples = speed.value.len();
        let combined = |a: f64, one: &Signal, b: f64, other: &Signal, constant: f64| Signal {
            value: one.value.iter().zip(&other.value).map(|(x, y)| a * x + b * y + constant).collect(),
            rate: one.rate.iter().zip(&other.rate).map(|(x, y)| a * x + b * y).collect(),
        };
        Some(match self {
            Self::Mass => acceleration.clone(),
            Self::Viscous => speed.clone(),
            Self::ViscousForwards => speed_forwards.clone(),
            Self::ViscousBackwards => combined(1.0, speed, -1.0, speed_forwards, 0.0),
            Self::Coulomb => combined(2.0, forwards, 0.0, forwards, -1.0),
            Self::CoulombForwards => forwards.clone(),
            Self::CoulombBackwards => combined(1.0, forwards, 0.0, forwards, -1.0),
            Self::Offset => Signal { value: vec![1.0; samples], rate: vec![0.0; samples] },
            Self::Delay => return None,
        })
    }
}

/// A drive train along the measured motion of some runs.
#[derive(Clone, Debug)]
pub struct DriveTrain {
    parameters: Vec<Parameter>,
    /// Forces for parameters of 1; the delay has none.
    forces: Vec<Signal>,
    has_delay: bool,
    measured: Vec<f64>,
    runs: Vec<usize>,
    times: Vec<f64>,
}

impl DriveTrain {
    /// With these `terms`. Without a force the drive coasts: the terms are ratios to the mass, which is not among them then.
    pub fn new(terms: &[Term], runs: &[Filtered]) -> Self {
        let coasts = runs.iter().any(|run| run.force.is_none());
        let counts = |term: &Term| !coasts || !matches!(term, Term::Mass | Term::Delay);
        // The delay comes last, whatever the order.
        let (delays, mut terms): (Vec<Term>, Vec<Term>) =
            terms.iter().copied().filter(counts).partition(|term| *term == Term::Delay);
        let has_delay = !delays.is_empty();
        let of_term = |term: &Term| {
            let mut all = Signal::default();
            for force in runs.iter().filter_map(|run| term.force(run)) {
                all.value.extend(force.value);
                all.rate.extend(force.rate);
            }
            all
        };
        let forces = terms.iter().map(of_term).collect();
        terms.extend(delays.first());
        let parameter = |term: &Term| Parameter {
            name: if coasts { format!("{} / mass", term.name()) } else { term.name().into() },
            unit: term.units()[usize::from(coasts)],
            bounds: [f64::NEG_INFINITY, f64::INFINITY],
            start: 0.0,
            prior: None,
        };
        let measured = |run: &Filtered| match &run.force {
            Some(force) if !coasts => force.clone(),
            // 0 = mass·acceleration + friction.
            _ => run.acceleration.value.iter().map(|acceleration| -acceleration).collect(),
        };
        Self {
            parameters: terms.iter().map(parameter).collect(),
            forces,
            has_delay,
            measured: runs.iter().flat_map(measured).collect(),
            runs: runs.iter().map(|run| run.speed.value.len()).collect(),
            times: runs.iter().flat_map(|run| run.times.iter().copied()).collect(),
        }
    }

    /// The sum of the forces, or of their rates, for these `values`.
    fn sum<'a>(&'a self, values: &[f64], part: impl Fn(&'a Signal) -> &'a Vec<f64>) -> Vec<f64> {
        let mut sum = vec![0.0; self.measured.len()];
        for (force, value) in self.forces.iter().zip(values) {
            sum.iter_mut().zip(part(force)).for_each(|(sum, part)| *sum += value * part);
        }
        sum
    }

    fn delay(&self, values: &[f64]) -> f64 {
        values.last().copied().filter(|_| self.has_delay).unwrap_or_default()
    }
}

/// `values` a `delay` later, where they change by `rates`.
fn later(values: &[f64], rates: &[f64], delay: f64) -> Vec<f64> {
    values.iter().zip(rates).map(|(value, rate)| value + delay * rate).collect()
}

impl Model for DriveTrain {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn measured(&self) -> &[f64] {
        &self.measured
    }

    fn runs(&self) -> Vec<usize> {
        self.runs.clone()
    }

    fn times(&self) -> Vec<f64> {
        self.times.clone()
    }

    fn simulate(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        let force = self.sum(values, |force| &force.value);
        if !self.has_delay {
            return Ok(force);
        }
        Ok(later(&force, &self.sum(values, |force| &force.rate), self.delay(values)))
    }

    fn sensitivities(&self, values: &[f64], _: &[f64]) -> Result<Vec<Vec<f64>>, ModelError> {
        let delay = self.delay(values);
        let mut columns: Vec<Vec<f64>> =
            self.forces.iter().map(|force| later(&force.value, &force.rate, delay)).collect();
        if self.has_delay {
            columns.push(self.sum(values, |force| &force.rate));
        }
        Ok(columns)
    }
}
