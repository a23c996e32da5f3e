//! Whether a program was compiled with the library's own header.

use crate::{
    ahead::*,
    deadline::*,
    integers::*,
    jam_watch::*,
    monitor::*,
    observer::*,
    predictor::*,
    production::*,
    scene::*,
    scrubber::*,
    slots::*,
    status::{Refusal, SLIPFIT_HEADER, SLIPFIT_VERSION, slipfit_status, status},
    table::*,
};

/// The sizes (bytes) of all structs, by their names in alphabetical order, as one number.
macro_rules! layout {
    ($($name:ident),*) => {
        0usize$(.wrapping_mul(31).wrapping_add(size_of::<$name>()))*
    };
}

#[rustfmt::skip]
const LAYOUT: usize = layout!(
    slipfit_ahead, slipfit_ahead_limits, slipfit_ahead_prediction, slipfit_bank, slipfit_deadline, slipfit_estimate, slipfit_integer_lookup,
    slipfit_integers, slipfit_jam_watch, slipfit_limits, slipfit_lookup, slipfit_monitor, slipfit_observer,
    slipfit_prediction, slipfit_predictor, slipfit_production_report, slipfit_production_sample, slipfit_record, slipfit_report, slipfit_sample,
    slipfit_scene, slipfit_scrubber, slipfit_slots, slipfit_spare, slipfit_stroke_end, slipfit_table, slipfit_table3,
    slipfit_timing, slipfit_unit, slipfit_watch, slipfit_wear
);

/// Call it once, as slipfit_check_header(SLIPFIT_VERSION, SLIPFIT_LAYOUT): SLIPFIT_HEADER if the program was compiled with a header of
/// another version, or with structs of other sizes, than the library that is linked.
#[unsafe(no_mangle)]
pub extern "C" fn slipfit_check_header(version: u32, layout: usize) -> slipfit_status {
    status(|| if version == SLIPFIT_VERSION && layout == LAYOUT { Ok(()) } else { Err(Refusal(SLIPFIT_HEADER)) })
}
