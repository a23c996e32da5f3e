//! Reading the law along a contact's tangents.

use slipfit_core::{law::StribeckData, menu::FrictionData};
use slipfit_tolerance::{
    number::three_digits,
    unit::{self, Quantity},
};

use super::{
    Problem, SceneError, plausible,
    quantity::{COEFFICIENT, STICK_BAND},
    value::Field,
};
use crate::mechanism::SlidingData;

const VISCOUS: Quantity = Quantity { units: unit::PER_SPEED, range: [0.0, 1e6] };
const STRIBECK_SPEED: Quantity = Quantity { units: unit::SPEED, range: [1e-7, 1e5] };

/// How many stick bands a fall from static to kinetic friction should at least take.
const NEAR: f64 = 10.0;

/// Names of the laws in scene files.
const LAWS: &str = "regularised, exact, none";

/// Reads the friction of a slide, which has one coefficient: with others it is read as a mechanism.
pub(super) fn coulomb(table: &Field) -> Result<FrictionData<f64>, SceneError> {
    match sliding(table)? {
        SlidingData::Coulomb(data) => Ok(data),
        SlidingData::Stribeck(_) | SlidingData::StaticKinetic { .. } => {
            let what = "friction with two coefficients of the slide's own types".into();
            Err(table.error(Problem::Unsupported { what }, "law, coefficient, stick_band"))
        }
    }
}

/// Reads any law.
pub(super) fn sliding(table: &Field) -> Result<SlidingData, SceneError> {
    let law = table.require("law", LAWS)?;
    let coefficient = || -> Result<f64, SceneError> {
        let coefficient = table.number("coefficient", &COEFFICIENT)?;
        if let Some(field) = table.get("coefficient") {
            plausible::friction(&field, coefficient);
        }
        Ok(coefficient)
    };
    // Not used, but wrong all the same.
    let unused = |key: &str, quantity| table.get(key).map(|field| field.to_number(quantity)).transpose().map(drop);
    match law.to_text()? {
        "regularised" => regularised(table, coefficient()?),
        "none" => {
            unused("coefficient", &COEFFICIENT)?;
            unused("stick_band", &STICK_BAND)?;
            Ok(SlidingData::NONE)
        }
        "exact" => {
            unused("stick_band", &STICK_BAND)?;
            let kinetic = coefficient()?;
            Ok(match static_coefficient(table, kinetic)? {
                None => SlidingData::Coulomb(FrictionData::Exact { coefficient: kinetic }),
                Some(at_rest) => SlidingData::StaticKinetic { at_rest, kinetic },
            })
        }
        _ => Err(law.error(Problem::Choice { key: law.key.clone(), written: law.written("") }, LAWS)),
    }
}

/// The static coefficient, not below the `kinetic` one; `None` if none is stated.
fn static_coefficient(table: &Field, kinetic: f64) -> Result<Option<f64>, SceneError> {
    let Some(field) = table.get("static_coefficient") else { return Ok(None) };
    let at_rest = field.to_number(&COEFFICIENT)?;
    if at_rest < kinetic {
        return Err(field.out_of_range("", format!("{kinetic}, which is the coefficient of what slides, or more")));
    }
    Ok(Some(at_rest))
}

/// The regularised law with the `kinetic` coefficient.
fn regularised(table: &Field, kinetic: f64) -> Result<SlidingData, SceneError> {
    let stick_band = table.number("stick_band", &STICK_BAND)?;
    let at_rest = static_coefficient(table, kinetic)?;
    let viscous = table.get("viscous").map(|field| field.to_number(&VISCOUS)).transpose()?;
    if at_rest.is_none() && viscous.is_none() {
        return Ok(SlidingData::Coulomb(FrictionData::Regularised { coefficient: kinetic, stick_band }));
    }
    let stribeck_speed = match at_rest {
        None => stick_band,
        Some(_) => {
            let speed = table.number("stribeck_speed", &STRIBECK_SPEED)?;
            if let Some(field) = table.get("stribeck_speed").filter(|_| speed < stick_band) {
                return Err(field.out_of_range("mm/s", format!("{} mm/s, the stick band, or more", stick_band * 1e3)));
            }
            if let Some(field) = table.get("static_coefficient").filter(|_| speed < NEAR * stick_band) {
                let share = stick_band / speed;
                let reached = kinetic + (at_rest.unwrap_or(kinetic) - kinetic) / (1.0 + share * share);
                field.warn(&format!(
                    "friction comes to {} at the end of the stick band, because it falls to kinetic friction within {} stick bands: a stick \
                     band of a tenth of `stribeck_speed` or less leaves all but a hundredth of the difference",
                    three_digits(reached),
                    three_digits(speed / stick_band)
                ));
            }
            speed
        }
    };
    let (at_rest, viscous) = (at_rest.unwrap_or(kinetic), viscous.unwrap_or_default());
    Ok(SlidingData::Stribeck(StribeckData { at_rest, kinetic, stribeck_speed, viscous, stick_band }))
}
