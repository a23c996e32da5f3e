//! The log as lines of text.

use core::fmt;

use slipfit_core::table::TableError;
use slipfit_firmware::machine::{Machine, print};

use crate::{
    control::Record,
    program::{Everything, Stroke},
    rig::Rig,
};

/// When something happened first (ms), if it did.
struct When(Option<u32>);

impl fmt::Display for When {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(milliseconds) => write!(f, "at {milliseconds} ms"),
            None => f.write_str("never"),
        }
    }
}

/// That there is no table to work with.
pub fn refused(machine: &mut impl Machine, error: TableError) {
    print(machine, format_args!("no table: {error}"));
}

/// The unit that follows.
pub fn rig(machine: &mut impl Machine, name: &str, rig: &Rig) {
    let Rig { level, friction, taken_for, .. } = rig;
    print(machine, format_args!("\n== {name}: n = {level}, friction {friction}, taken for n = {taken_for}"));
    print(machine, format_args!(" t (ms)  measured (N)  predicted (N)   table (N)  lead (ms)  verdict"));
}

/// A period.
pub fn record(machine: &mut impl Machine, record: &Record) {
    let Record { periods, measured, predicted, lead, expected, verdict, .. } = record;
    let lead = lead * 1e3;
    print(machine, format_args!("{periods:7}{measured:14.4}{predicted:15.4}{expected:12.4}{lead:11.1}  {verdict:?}"));
}

/// A stroke that has ended.
pub fn stroke(machine: &mut impl Machine, stroke: &Stroke) {
    let Stroke { firsts, least_lead, estimate, damaged, stack } = stroke;
    print(machine, format_args!("first tight {}, first jam {}", When(firsts.tight), When(firsts.jam)));
    if let Some(estimate) = estimate {
        let [low, high] = estimate.interval;
        print(machine, format_args!("n = {:.3}, with 95 % between {low:.3} and {high:.3}", estimate.level));
    }
    print(machine, format_args!("least lead: {:.1} ms", least_lead * 1e3));
    print(machine, format_args!("table damaged in {damaged} rounds"));
    if let Some(bytes) = stack {
        print(machine, format_args!("stack of a period: {bytes} bytes"));
    }
}

/// All strokes together.
pub fn everything(machine: &mut impl Machine, everything: &Everything) {
    let Everything { instructions, stack, control, motions } = everything;
    print(machine, format_args!(""));
    if let Some((least, greatest)) = instructions {
        print(machine, format_args!("instructions of a period: {least} to {greatest}"));
    }
    if let Some(bytes) = stack {
        print(machine, format_args!("stack of everything: {bytes} bytes, control of {control}; motions of {motions}"));
    }
    print(machine, format_args!("done"));
}
