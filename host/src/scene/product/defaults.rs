//! Reads what holds where a dimension or a feature says nothing else.

use slipfit_tolerance::{
    model::ZoneRule,
    product::{contacts::Order, iso2768::General},
    unit::{self, Quantity},
};

use crate::scene::{Problem, SceneError, value::Field};

/// Standard deviations in half of a tolerance, where nothing else is said.
pub(in crate::scene) const SIGMA_DEFAULT: f64 = 3.0;
pub(super) const SIGMA: Quantity = Quantity { units: unit::ONE, range: [1.0, 100.0] };

/// How frames of datums come to lie on features that do not fit them exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Frames {
    /// A secondary or tertiary datum that cannot be met in place and direction turns the frame by a least-squares fit of both.
    LeastSquares,
    /// By ISO 5459: the secondary datum turns the frame by its orientation, the tertiary one by its location alone.
    Iso5459,
}

impl Frames {
    /// What has precedence in the datum of this `number`, from 0.
    pub fn order(self, number: usize) -> Order {
        match (self, number) {
            (Self::LeastSquares, _) | (_, 0) => Order::LeastSquares,
            (Self::Iso5459, 1) => Order::Orientation,
            (Self::Iso5459, _) => Order::Location,
        }
    }
}

/// What holds for the whole product.
#[derive(Clone, Copy)]
pub(super) struct Defaults {
    pub general: General,
    pub rule: ZoneRule,
    pub sigma: f64,
    pub frames: Frames,
}

/// The table `[tolerance]`.
pub(super) fn defaults(root: &Field) -> Result<Defaults, SceneError> {
    let mut defaults = Defaults {
        general: General::default(),
        rule: ZoneRule::SigmaZone,
        sigma: SIGMA_DEFAULT,
        frames: Frames::LeastSquares,
    };
    let Some(table) = root.get("tolerance") else { return Ok(defaults) };
    table.expect_table()?;
    if let Some(field) = table.get("general") {
        const ALLOWED: &str =
            "ISO 2768 classes: f, m, c, v for sizes and H, K, L for geometry, such as \"mH\" or \"K\"";
        let choice = |_| field.error(Problem::Choice { key: field.key.clone(), written: field.written("") }, ALLOWED);
        defaults.general = field.to_text()?.parse().map_err(choice)?;
    }
    if let Some(field) = table.get("rule") {
        defaults.rule = rule(&field)?;
    }
    if let Some(field) = table.get("sigma") {
        // Below 1 a third of the units of a normal distribution would be outside.
        defaults.sigma = field.to_number(&SIGMA)?;
    }
    if let Some(field) = table.get("datums") {
        defaults.frames = match field.to_text()? {
            "least-squares" => Frames::LeastSquares,
            "iso-5459" => Frames::Iso5459,
            _ => {
                let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
                return Err(field.error(problem, "least-squares, iso-5459"));
            }
        };
    }
    Ok(defaults)
}

/// How a plane varies in its zone.
pub(super) fn rule(field: &Field) -> Result<ZoneRule, SceneError> {
    match field.to_text()? {
        "sigma-zone" => Ok(ZoneRule::SigmaZone),
        "truncated" => Ok(ZoneRule::Truncated),
        "uniform-in-zone" => Ok(ZoneRule::UniformInZone),
        "translation" => Ok(ZoneRule::Translation),
        _ => {
            let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
            Err(field.error(problem, "sigma-zone, truncated, uniform-in-zone, translation"))
        }
    }
}
