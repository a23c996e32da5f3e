//! Strokes of units on their rig: one that is what it is taken for, one with more friction, one that jams.

use slipfit_core::{
    monitor::{Estimate, Verdict},
    pose::Pose,
    table::{AxisKind, Table},
};
use slipfit_firmware::{
    count::{Count, Range},
    machine::Machine,
};

use crate::{
    control::{Motions, Record, prediction},
    rig::{OnRig, Rig},
    say,
    scene::SCENE_HASH,
};

/// Periods of a stroke.
pub const PERIODS: u32 = 1500;

/// Periods from one printed line to the next.
const PERIODS_A_LINE: u32 = 100;

/// 2 % of the peak force (N).
const NOISE: f32 = 0.02;

const RIGS: [(&str, Rig); 3] = [
    ("as taken for", Rig { level: 2.0, friction: 1.0, taken_for: 2.0, noise: NOISE, seed: 1 }),
    ("friction up by 20 %", Rig { level: 2.2, friction: 1.2, taken_for: 2.0, noise: NOISE, seed: 2 }),
    ("jams", Rig { level: 5.0, friction: 1.2, taken_for: 2.0, noise: NOISE, seed: 3 }),
];

/// A machine that calls a rig once a millisecond.
pub trait Ticking: Machine {
    /// Memory for the motions of a prediction, as they are at its `start`.
    fn motions(&mut self, start: impl FnOnce() -> Motions) -> &'static mut Motions;

    /// Runs `rig` for [`PERIODS`] from the interrupt, shows every record from the main loop, and gives the rig back.
    fn ticks(&mut self, rig: OnRig, show: impl FnMut(&mut Self, &Record)) -> OnRig;

    /// Instructions of a record's cost.
    fn cost(&self, record: &Record) -> Option<u32>;

    /// The deepest stack since the start (bytes), if the machine can tell.
    fn deepest_stack(&mut self) -> Option<u32>;
}

/// Runs all strokes; `false` without a table.
pub fn run(machine: &mut impl Ticking, flash: &'static [u8]) -> bool {
    let axes = [AxisKind::Level, AxisKind::Time];
    let opened = Table::open(flash).and_then(|table| table.expect_axes(axes)?.expect_scene(SCENE_HASH));
    let table = match opened {
        Ok(table) => table,
        Err(error) => {
            say::refused(machine, error);
            return false;
        }
    };
    let mut motions = machine.motions(|| prediction(RIGS[0].1.taken_for).0.at_rest(Pose::nominal(), 0, |_| 0.0));
    let mut costs = Count::default();
    for (name, rig) in RIGS {
        say::rig(machine, name, &rig);
        let (mut firsts, mut least_lead) = (Firsts::default(), f32::INFINITY);
        let mut on_rig = machine.ticks(OnRig::new(&rig, (table, flash), motions), |machine, record| {
            costs.add(machine.cost(record));
            firsts.see(record);
            least_lead = least_lead.min(record.lead);
            if record.periods.is_multiple_of(PERIODS_A_LINE) {
                say::record(machine, record);
            }
        });
        let (estimate, damaged) = (on_rig.control.bank.estimate(), on_rig.control.damaged);
        let stack = machine.stack(|| _ = on_rig.tick(|| 0));
        say::stroke(machine, &Stroke { firsts, least_lead, estimate, damaged, stack });
        motions = on_rig.control.motions;
    }
    let instructions = costs.range().map(Range::ends);
    let (stack, control, motions) = (machine.deepest_stack(), size_of::<OnRig>(), size_of::<Motions>());
    say::everything(machine, &Everything { instructions, stack, control, motions });
    true
}

/// What there is to say of a stroke.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stroke {
    /// When verdicts were first given.
    pub firsts: Firsts,
    /// The least lead of the prediction over the clock (s).
    pub least_lead: f32,
    /// The unit's tolerance level, from all of the stroke.
    pub estimate: Option<Estimate>,
    /// Rounds in which the table had changed.
    pub damaged: u32,
    /// Stack of a period (bytes).
    pub stack: Option<u32>,
}

/// What there is to say in the end.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Everything {
    /// The least and the greatest number of instructions of a period.
    pub instructions: Option<(u32, u32)>,
    /// The deepest stack since the start (bytes).
    pub stack: Option<u32>,
    /// What of it the rig takes, the controller's objects and the unit (bytes).
    pub control: usize,
    /// What the prediction keeps, elsewhere (bytes).
    pub motions: usize,
}

/// When a verdict was first given (ms).
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Firsts {
    /// Tight.
    pub tight: Option<u32>,
    /// Jammed.
    pub jam: Option<u32>,
}

impl Firsts {
    fn see(&mut self, record: &Record) {
        let first = match record.verdict {
            Verdict::Tight => &mut self.tight,
            Verdict::Jam => &mut self.jam,
            Verdict::Blind | Verdict::Free | Verdict::NoData | Verdict::Ended => return,
        };
        *first = first.or(Some(record.periods));
    }
}
