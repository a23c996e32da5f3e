//! The log as frames of defmt: what varies, and a number for the text around it, which only the desk knows.
//!
//! Frames and text must not share a stream, so that nothing here prints text.

use defmt::{error, info};
use defmt_semihosting as _;
use slipfit_core::table::TableError;
use slipfit_firmware::machine::Machine;

use crate::{
    control::Record,
    program::{Everything, Stroke},
    rig::Rig,
};

/// That there is no table to work with.
pub fn refused(_: &mut impl Machine, error: TableError) {
    error!("no table: {}", error);
}

/// The unit that follows.
pub fn rig(_: &mut impl Machine, name: &str, rig: &Rig) {
    info!("{=str}: {}", name, rig);
}

/// A period.
pub fn record(_: &mut impl Machine, record: &Record) {
    info!("{}", record);
}

/// A stroke that has ended.
pub fn stroke(_: &mut impl Machine, stroke: &Stroke) {
    info!("{}", stroke);
}

/// All strokes together.
pub fn everything(_: &mut impl Machine, everything: &Everything) {
    info!("{}", everything);
}
