//! Strokes of units on their rig: one that is what it is taken for, one with more friction, one that jams.

use slipfit_core::{
    monitor::Verdict,
    table::{AxisKind, Table},
};
use slipfit_firmware::{
    count::Count,
    machine::{Machine, print},
};

use crate::control::{Control, Record, Rig};

/// What the table must be stamped with: the scene of the kernel, but simulated in steps of 50 µs by the scheme of the
/// desk.
const TABLE_HASH: u64 = 0x60ae4a547f71e143;

/// Periods of a stroke.
pub const PERIODS: u32 = 1500;

/// Periods from one printed line to the next.
const PERIODS_A_LINE: u32 = 100;

/// Clock and cycles of the drive that the load is given for (Hz): instructions take 1.48 cycles at zero wait states.
const CLOCK: f32 = 168e6;
const CYCLES: f32 = 1.48;

/// 2 % of the peak force (N).
const NOISE: f32 = 0.02;

const RIGS: [(&str, Rig); 3] = [
    ("as taken for", Rig { level: 2.0, friction: 1.0, taken_for: 2.0, noise: NOISE, seed: 1 }),
    ("friction up by 20 %", Rig { level: 2.2, friction: 1.2, taken_for: 2.0, noise: NOISE, seed: 2 }),
    ("jams", Rig { level: 5.0, friction: 1.2, taken_for: 2.0, noise: NOISE, seed: 3 }),
];

/// A machine that calls a control once a millisecond.
pub trait Ticking: Machine {
    /// Runs `control` for [`PERIODS`] from the interrupt, shows every record from the main loop, and gives the control
    /// back.
    fn ticks(&mut self, control: Control, show: impl FnMut(&mut Self, &Record)) -> Control;

    /// Instructions of a record's cost.
    fn cost(&self, record: &Record) -> Option<u32>;

    /// The deepest stack since the start (bytes), if the machine can tell.
    fn deepest_stack(&mut self) -> Option<u32>;
}

/// Runs all strokes.
pub fn run(machine: &mut impl Ticking, flash: &'static [u8]) {
    let axes = [AxisKind::Level, AxisKind::Time];
    let opened = Table::open(flash).and_then(|table| table.expect_axes(axes)?.expect_scene(TABLE_HASH));
    let table = match opened {
        Ok(table) => table,
        Err(error) => return print(machine, format_args!("no table: {error}")),
    };
    let mut costs = Count::default();
    for (name, rig) in RIGS {
        let Rig { level, friction, taken_for, .. } = rig;
        print(machine, format_args!("\n== {name}: n = {level}, friction {friction}, taken for n = {taken_for}"));
        print(machine, format_args!(" t (ms)  measured (N)  kernel (N)   table (N)  verdict"));
        let mut firsts = Firsts::default();
        let mut control = machine.ticks(Control::new(&rig, (table, flash)), |machine, record| {
            costs.add(machine.cost(record));
            firsts.see(record);
            let Record { periods, measured, predicted, expected, verdict, .. } = record;
            if periods.is_multiple_of(PERIODS_A_LINE) {
                let line = format_args!("{periods:7}{measured:14.4}{predicted:12.4}{expected:12.4}  {verdict:?}");
                print(machine, line);
            }
        });
        print(machine, format_args!("first tight at {:?} ms, first jam at {:?} ms", firsts.tight, firsts.jam));
        if let Some(estimate) = control.bank.estimate(&table) {
            let [low, high] = estimate.interval;
            print(machine, format_args!("n = {:.3}, with 95 % between {low:.3} and {high:.3}", estimate.level));
        }
        print(machine, format_args!("table damaged in {} rounds", control.damaged));
        if let Some(bytes) = machine.stack(|| _ = control.tick(|| 0)) {
            print(machine, format_args!("stack of a period: {bytes} bytes"));
        }
    }
    print(machine, format_args!(""));
    if let Some((least, greatest)) = costs.range().map(|range| range.ends()) {
        print(machine, format_args!("instructions of a period: {least} to {greatest}"));
        let load = greatest as f32 * CYCLES * 1e3 / CLOCK * 100.0;
        print(machine, format_args!("instructions at 1 kHz, {CYCLES} cycles each: {load:.1} % of 168 MHz"));
    }
    if let Some(bytes) = machine.deepest_stack() {
        print(machine, format_args!("stack of everything: {bytes} bytes, control of {}", size_of::<Control>()));
    }
    print(machine, format_args!("done"));
}

/// When a verdict was first given (ms).
#[derive(Default)]
struct Firsts {
    tight: Option<u32>,
    jam: Option<u32>,
}

impl Firsts {
    fn see(&mut self, record: &Record) {
        let first = match record.verdict {
            Verdict::Tight => &mut self.tight,
            Verdict::Jam => &mut self.jam,
            Verdict::Blind | Verdict::Free => return,
        };
        *first = first.or(Some(record.periods));
    }
}
