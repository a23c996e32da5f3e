//! What the stability map varies, and how far.

use slipfit_core::{menu::FrictionData, slide::CONTACTS};
use slipfit_tolerance::number::fixed;

use crate::{
    dynamics::{
        scheme::{IntegratorKind, ScalarKind},
        simulate::Settings,
    },
    setup::{ControllerSpec, Scene},
};

/// One point of the map: a scene with the unit to be simulated.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The scene.
    pub scene: Scene,
    /// Tolerance level.
    pub n: f64,
    /// How much every gap is narrowed beyond that (m).
    pub interference: f64,
}

/// Step (s) of the points that vary something else: fine enough that most of them hold.
pub const STEP: f64 = 50e-6;

impl Setup {
    /// `scene` at the tolerance level `n`, in steps of [`STEP`] in f64.
    pub fn new(scene: Scene, n: f64) -> Self {
        let controller = ControllerSpec { step: STEP, scalar: ScalarKind::F64, ..scene.controller };
        Self { scene: Scene { controller, ..scene }, n, interference: 0.0 }
    }

    /// The gaps (m).
    pub fn gaps(&self) -> [f64; CONTACTS] {
        self.scene.gaps_at(&[self.n; CONTACTS]).map(|gap| gap - self.interference)
    }

    /// The controller with a quarter of the step in f64.
    pub fn finer(&self) -> ControllerSpec {
        let ControllerSpec { step, integrator, .. } = self.scene.controller;
        ControllerSpec { step: step / 4.0, integrator, scalar: ScalarKind::F64 }
    }

    /// Settings that sample every millisecond, or every step if that is longer.
    pub fn settings(&self) -> Settings {
        Settings::controller(&self.scene, self.scene.controller.step.max(1e-3))
    }
}

/// A quantity that is varied.
#[derive(Clone, Copy, Debug)]
pub struct Factor {
    /// Name, with the unit of its values.
    pub name: &'static str,
    /// Its values.
    pub range: Range,
    /// Sets it.
    pub set: fn(&mut Setup, f64),
    /// What a value is called under its strip of the map.
    pub label: fn(f64) -> String,
}

/// The values of a factor.
#[derive(Clone, Copy, Debug)]
pub enum Range {
    /// Powers of ten between two exponents, and what `0` stands for if that is allowed too.
    Decades(i32, i32, Zero),
    /// Equal steps from the first to the second; the third is their number.
    Even(f64, f64, u32),
    /// These.
    These(&'static [f64]),
}

/// Whether zero belongs to a range of decades.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zero {
    /// It does.
    Too,
    /// It does not.
    Not,
}

impl Range {
    /// The values that are tried one at a time.
    pub fn values(self) -> Vec<f64> {
        match self {
            Self::Decades(low, high, zero) => {
                let zero = (zero == Zero::Too).then_some(0.0);
                zero.into_iter().chain((2 * low..=2 * high).map(|half| libm::exp10(f64::from(half) / 2.0))).collect()
            }
            Self::Even(low, high, steps) => {
                (0..=steps).map(|i| low + (high - low) * f64::from(i) / f64::from(steps)).collect()
            }
            Self::These(values) => values.to_vec(),
        }
    }

    /// The value at `share` in 0..1 of the range, each of a set being as likely as the others.
    pub fn at(self, share: f64) -> f64 {
        match self {
            Self::Decades(low, high, zero) => {
                // Zero, where it is allowed, takes a tenth.
                let share = if zero == Zero::Too { (share - 0.1) / 0.9 } else { share };
                if share < 0.0 { 0.0 } else { libm::exp10(f64::from(low) + f64::from(high - low) * share) }
            }
            Self::Even(low, high, _) => low + (high - low) * share,
            Self::These(values) => values[((share * values.len() as f64) as usize).min(values.len() - 1)],
        }
    }
}

/// The schemes that the map is drawn for.
pub const SCHEMES: [IntegratorKind; 3] =
    [IntegratorKind::ImplicitEuler, IntegratorKind::Sdirk2, IntegratorKind::Extrapolated];

/// All factors but the scheme. Those in × multiply the scene's own value.
pub const FACTORS: [Factor; 13] = [
    Factor {
        name: "stiffness, ×",
        range: Range::Decades(-2, 4, Zero::Not),
        set: |setup, x| setup.scene.contact.stiffness *= x,
        label: few_digits,
    },
    Factor {
        name: "mass, ×",
        range: Range::Decades(-2, 2, Zero::Not),
        set: |setup, x| setup.scene.slide.mass *= x,
        label: few_digits,
    },
    Factor {
        name: "damping, ×",
        range: Range::Decades(-2, 2, Zero::Too),
        set: |setup, x| setup.scene.contact.damping *= x,
        label: few_digits,
    },
    Factor { name: "exponent e", range: Range::Even(1.0, 3.0, 8), set: set_exponent, label: few_digits },
    Factor {
        name: "friction law",
        range: Range::These(&[0.0, 1.0]),
        set: set_law,
        label: |law| if law == 0.0 { "regularised" } else { "exact" }.into(),
    },
    Factor { name: "friction μ", range: Range::Even(0.0, 1.4, 14), set: set_coefficient, label: few_digits },
    Factor {
        name: "stick band, m/s",
        range: Range::Decades(-9, -3, Zero::Not),
        set: set_stick_band,
        label: few_digits,
    },
    Factor {
        name: "tolerance level n",
        range: Range::Even(-6.0, 8.0, 14),
        set: |setup, x| setup.n = x,
        label: few_digits,
    },
    Factor {
        name: "interference, mm",
        range: Range::Even(0.0, 1.0, 8),
        set: |setup, x| setup.interference = x * 1e-3,
        label: few_digits,
    },
    Factor {
        name: "drive point x, mm",
        range: Range::Even(-62.0, 62.0, 8),
        set: |setup, x| setup.scene.drive.point_b.x = x * 1e-3,
        label: few_digits,
    },
    Factor {
        name: "gravity, ° from down",
        range: Range::Even(0.0, 1.0, 13),
        set: set_gravity,
        label: |share| fixed(libm::acos(1.0 - 2.0 * share).to_degrees(), 0),
    },
    Factor {
        name: "step, µs",
        range: Range::These(&[10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0]),
        set: |setup, x| setup.scene.controller.step = x * 1e-6,
        label: few_digits,
    },
    Factor {
        name: "number type",
        range: Range::These(&[32.0, 64.0]),
        set: set_scalar,
        label: |bits| format!("f{bits}"),
    },
];

/// Few digits: powers of ten as such, others with at most two decimals.
fn few_digits(value: f64) -> String {
    if value != 0.0 && !(0.01..1e5).contains(&value.abs()) {
        return format!("{value:.0e}");
    }
    let decimals = if value.abs() >= 10.0 { 0 } else { 2 };
    let text = fixed(value, decimals);
    if decimals > 0 { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// k in N/mm^e stays, as `--set contact.exponent` leaves it.
fn set_exponent(setup: &mut Setup, exponent: f64) {
    let contact = &mut setup.scene.contact;
    contact.stiffness *= libm::pow(1000.0, exponent - contact.exponent);
    contact.exponent = exponent;
}

fn set_law(setup: &mut Setup, law: f64) {
    let coefficient = setup.scene.friction.coefficient();
    let stick_band = stick_band(setup);
    setup.scene.friction = if law == 0.0 {
        FrictionData::Regularised { coefficient, stick_band }
    } else {
        FrictionData::Exact { coefficient }
    };
}

fn set_coefficient(setup: &mut Setup, to: f64) {
    match &mut setup.scene.friction {
        FrictionData::None => {}
        FrictionData::Regularised { coefficient, .. } | FrictionData::Exact { coefficient } => *coefficient = to,
    }
}

fn set_stick_band(setup: &mut Setup, to: f64) {
    if let FrictionData::Regularised { stick_band, .. } = &mut setup.scene.friction {
        *stick_band = to;
    }
}

fn stick_band(setup: &Setup) -> f64 {
    match setup.scene.friction {
        FrictionData::Regularised { stick_band, .. } => stick_band,
        _ => 1e-4,
    }
}

/// Directions spread evenly over the sphere along a spiral; 9.81 m/s² towards each.
fn set_gravity(setup: &mut Setup, share: f64) {
    let up = 1.0 - 2.0 * share;
    let across = libm::sqrt((1.0 - up * up).max(0.0));
    let turn = share * 40.0;
    setup.scene.slide.gravity = [across * libm::cos(turn), up, across * libm::sin(turn)].map(|x| -9.81 * x);
}

fn set_scalar(setup: &mut Setup, bits: f64) {
    setup.scene.controller.scalar = if bits == 32.0 { ScalarKind::F32 } else { ScalarKind::F64 };
}
