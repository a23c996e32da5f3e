//! The system timer's interrupt, and what it shares with the main loop.

use core::{
    cell::RefCell,
    mem::{MaybeUninit, swap},
};

use cortex_m::peripheral::SYST;
use cortex_m_rt::exception;
use critical_section::Mutex;
use heapless::Deque;
use slipfit_firmware::board::{Board, TICK};

use crate::{
    control::{Motions, Record},
    program::{PERIODS, Ticking},
    rig::OnRig,
};

/// Time of an instruction (ns): what this image's emulator is told by `-icount shift=3`, fast enough for 1 kHz.
const INSTRUCTION: u32 = 8;

/// Ticks of a period of 1 ms.
const PERIOD: u32 = 1_000_000 / TICK;

/// What the interrupt is handed over before a motion and hands back after it, and what it has to say meanwhile.
struct Shared {
    rig: Option<OnRig>,
    left: u32,
    records: Deque<Record, 4>,
    /// Records that the main loop was too slow for.
    lost: u32,
}

static SHARED: Mutex<RefCell<Shared>> =
    Mutex::new(RefCell::new(Shared { rig: None, left: 0, records: Deque::new(), lost: 0 }));

fn with<T>(work: impl FnOnce(&mut Shared) -> T) -> T {
    critical_section::with(|section| work(&mut SHARED.borrow_ref_mut(section)))
}

#[exception]
fn SysTick() {
    // The interrupt owns the rig for a motion, so that it steps it outside of any critical section: interrupts of higher priority,
    // which is every other one, are not delayed by it. Critical sections are some instructions long, except for the two swaps.
    static mut OWN: Option<OnRig> = None;
    if OWN.is_none() {
        with(|shared| {
            // After the last period it stays with the main loop.
            if shared.left > 0 {
                swap(OWN, &mut shared.rig);
            }
        });
    }
    let Some(rig) = OWN else { return };
    // The timer counts down, once a period.
    let record = rig.tick(|| PERIOD - SYST::get_current());
    with(|shared| {
        shared.left -= 1;
        shared.lost += u32::from(shared.records.push_back(record).is_err());
        if shared.left == 0 {
            swap(OWN, &mut shared.rig);
        }
    });
}

impl Ticking for Board {
    fn motions(&mut self, start: impl FnOnce() -> Motions) -> &'static mut Motions {
        let internal = cortex_m::singleton!(: MaybeUninit<Motions> = MaybeUninit::uninit());
        internal.expect("it is asked for once").write(start())
    }

    fn ticks(&mut self, rig: OnRig, mut show: impl FnMut(&mut Self, &Record)) -> OnRig {
        with(|shared| {
            shared.left = PERIODS;
            shared.rig = Some(rig);
        });
        self.tick_every(PERIOD);
        loop {
            let (record, is_over) = with(|shared| (shared.records.pop_front(), shared.left == 0));
            match record {
                Some(record) => show(self, &record),
                None if is_over => break,
                None => cortex_m::asm::wfi(),
            }
        }
        self.tick_no_more();
        with(|shared| {
            assert_eq!(shared.lost, 0, "the main loop was too slow");
            shared.rig.take().expect("it was put there above")
        })
    }

    fn cost(&self, record: &Record) -> Option<u32> {
        Some(record.cost * TICK / INSTRUCTION)
    }

    fn deepest_stack(&mut self) -> Option<u32> {
        Some(self.deepest_stack())
    }
}
