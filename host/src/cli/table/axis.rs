//! An axis of a table, as JSON has it.

use serde::Serialize;
use slipfit_core::table::AxisKind;

use crate::{dynamics::driven::DriveKind, firmware::flash::AxisSpec};

/// An axis.
#[derive(Serialize)]
pub(super) struct AxisReport {
    kind: &'static str,
    unit: &'static str,
    first: f32,
    step: f32,
    count: usize,
}

impl AxisReport {
    pub fn new(drive: DriveKind, &AxisSpec { kind, first, step, count }: &AxisSpec) -> Self {
        let unit = match kind {
            AxisKind::Position => drive.choose(kind.unit(), "rad"),
            AxisKind::Velocity => drive.choose(kind.unit(), "rad/s"),
            AxisKind::Level | AxisKind::Time | AxisKind::Row => kind.unit(),
        };
        Self { kind: kind.name(), unit, first, step, count }
    }
}
