//! A slide on four pins, as data.

use std::sync::Arc;

use slipfit_core::{
    Scalar,
    clearance::GapStatistics,
    drive::Drive,
    menu::{ContactData, FrictionData, SlideData},
    slide::{ABSENT, Body, CONTACTS, PINS, box_inertia},
};
use slipfit_tolerance::number::ten_digits;

use super::{
    Adjustable, ControllerSpec, GAP_MOST, LevelRange, Measured, RunSpec, SlideParameter, Uncertain, Varied, tilted_x,
    tilted_z,
};

/// Which surfaces meet a pin, in the order of Table 2.
pub const SURFACES: [&str; 4] = ["left", "right", "rail", "wall"];

/// A sliding mechanism and what is to be done with it. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Title, for plots and reports.
    pub title: String,
    /// The slide.
    pub slide: SlideSpec,
    /// Contact law.
    pub contact: ContactData<f64>,
    /// Friction law.
    pub friction: FrictionData<f64>,
    /// Drive.
    pub drive: Drive<f64>,
    /// Pins with their gaps.
    pub pins: [PinSpec; PINS],
    /// Nominal clearances stated on the drawing, [across, up and down] (m); information only.
    pub nominal_clearance: Option<[f64; 2]>,
    /// What is simulated.
    pub run: RunSpec,
    /// How the controller computes it.
    pub controller: ControllerSpec,
    /// Tolerance levels of a sweep.
    pub sweep: LevelRange,
    /// What varies over the production beside the gaps.
    pub vary: Vec<Varied>,
    /// Parameters with one unknown value in the whole production.
    pub uncertain: Vec<Uncertain>,
    /// Which measure of the product each gap is, pin by pin; `None` where the scene gives its statistics.
    pub gap_measures: GapMeasures,
    /// Dimensions and gaps whose distribution is that of measured parts, if any is.
    pub measured: Option<Arc<Measured>>,
    /// What the user should know of the scene file: what is possible but implausible, each with its place.
    pub warnings: Vec<String>,
}

/// Which measure of the product each gap of each pin is, in the order of [`SURFACES`].
pub type GapMeasures = [[Option<usize>; 4]; PINS];

/// The moving body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlideSpec {
    /// Mass (kg).
    pub mass: f64,
    /// Edges x, y, z (m) of the uniform box that has the slide's inertia.
    pub inertia_box: [f64; 3],
    /// Gravity in the fixed frame (m/s²).
    pub gravity: [f64; 3],
}

/// A pin of the frame and its gaps over the production.
#[derive(Clone, Debug, PartialEq)]
pub struct PinSpec {
    /// Name, such as "left front".
    pub name: String,
    /// Position from the slide's centre of mass at the nominal pose (m).
    pub position: [f64; 3],
    /// Left, right, rail and wall gap; `None` where the pin has no such contact.
    pub gaps: [Option<GapStatistics<f64>>; 4],
}

/// A tolerance level at which a gap is out of bounds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "at n = {} the {contact} gap is {} mm, allowed is -{} to {} mm",
    ten_digits(*n),
    ten_digits(gap * 1e3),
    GAP_MOST * 1e3,
    GAP_MOST * 1e3
)]
pub struct GapError {
    /// Tolerance level.
    pub n: f64,
    /// Pin and surface, such as "left front rail".
    pub contact: String,
    /// The gap (m).
    pub gap: f64,
}

impl Scene {
    /// Whether a value or distribution of the whole production is unknown.
    pub fn has_unknowns(&self) -> bool {
        !self.uncertain.is_empty() || self.measured.is_some()
    }

    /// Names of the sixteen contacts, such as "left front rail"; those that the scene leaves out too.
    pub fn contact_names(&self) -> [String; CONTACTS] {
        std::array::from_fn(|i| format!("{} {}", self.pins[i / 4].name, SURFACES[i % 4]))
    }

    /// Whether all gaps at the tolerance levels `n` are within [`GAP_MOST`].
    ///
    /// # Errors
    /// [`GapError`] names the first that is not.
    pub fn check_gaps(&self, n: &[f64; CONTACTS]) -> Result<(), GapError> {
        let names = self.contact_names();
        for ((contact, gap), n) in names.into_iter().zip(self.gaps_at(n)).zip(n) {
            if gap != ABSENT && (gap.is_nan() || gap.abs() > GAP_MOST) {
                return Err(GapError { n: *n, contact, gap });
            }
        }
        Ok(())
    }

    /// All sixteen gaps (m) at the tolerance levels `n`, one a contact; [`ABSENT`] where there is no contact.
    pub fn gaps_at(&self, n: &[f64; CONTACTS]) -> [f64; CONTACTS] {
        self.gaps_in(n)
    }

    /// The tolerance levels at which the contacts have these `gaps` (m); `None` for one that does not vary, or is none.
    pub fn levels_of(&self, gaps: &[f64]) -> Vec<Option<f64>> {
        let statistics = self.pins.iter().flat_map(|pin| pin.gaps);
        statistics.zip(gaps).map(|(of, gap)| Some(of.filter(|of| of.deviation > 0.0)?.level(*gap))).collect()
    }

    /// [`gaps_at`](Self::gaps_at) computed in the scalar `S`, from levels and statistics rounded to it: in f32 the bits of
    /// [`SceneData::at`](slipfit_core::scene::SceneData::at).
    pub fn gaps_in<S: Scalar>(&self, n: &[f64; CONTACTS]) -> [S; CONTACTS] {
        let s = S::from_f64;
        let mut gaps = [s(ABSENT); CONTACTS];
        let statistics = self.pins.iter().flat_map(|pin| &pin.gaps);
        for ((gap, statistics), n) in gaps.iter_mut().zip(statistics).zip(n) {
            if let Some(GapStatistics { mean, deviation }) = *statistics {
                *gap = GapStatistics { mean: s(mean), deviation: s(deviation) }.at(s(*n));
            }
        }
        gaps
    }

    /// The slide with the given `gaps` (m), [`ABSENT`] where none is given, as the kernel's data, every number rounded once to the scalar `S`.
    pub fn slide_data<S: Scalar>(&self, gaps: &[f64]) -> SlideData<S> {
        let body = Body {
            mass: self.slide.mass,
            inertia_b: box_inertia(self.slide.mass, self.slide.inertia_box),
            gravity_w: self.slide.gravity.into(),
            pins_w: [0, 1, 2, 3].map(|i| self.pins[i].position.into()),
            gaps: std::array::from_fn(|i| gaps.get(i).copied().unwrap_or(ABSENT)),
        };
        let data: SlideData<f64> =
            SlideData { body, contact: self.contact, friction: self.friction, drive: self.drive };
        data.cast(S::from_f64)
    }
}

impl Adjustable for SlideParameter {
    type Of = Scene;

    fn change(self, scene: &mut Scene, change: &mut dyn FnMut(f64) -> f64) {
        let gravity = scene.slide.gravity;
        let value = match self {
            Self::Friction => scene.friction.coefficient_mut(),
            Self::StickBand => scene.friction.stick_band_mut(),
            Self::Stiffness => Some(&mut scene.contact.stiffness),
            Self::Damping => Some(&mut scene.contact.damping),
            Self::Depth => Some(&mut scene.contact.depth),
            Self::Mass => Some(&mut scene.slide.mass),
            Self::Gain => Some(&mut scene.drive.gain),
            Self::RampEnd => Some(&mut scene.drive.ramp_end),
            Self::TiltX => return scene.slide.gravity = tilted_x(gravity, change(0.0)),
            Self::TiltZ => return scene.slide.gravity = tilted_z(gravity, change(0.0)),
        };
        if let Some(value) = value {
            *value = change(*value);
        }
    }

    fn varies_by_shares(self) -> bool {
        self == Self::Stiffness
    }
}
