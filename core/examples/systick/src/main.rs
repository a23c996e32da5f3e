//! Plain SysTick: an interrupt at 1 kHz steps the kernel, a queue hands each force to the main loop.
#![no_std]
#![no_main]
#![deny(unsafe_code)]

use core::cell::RefCell;

use cortex_m::{
    Peripherals, asm,
    peripheral::{SCB, SYST, scb::SystemHandler, syst::SystClkSource},
};
use cortex_m_rt::{entry, exception};
use critical_section::Mutex;
use heapless::spsc::{Producer, Queue};
// Nothing is called by its name here, but the image needs its table of interrupts.
use lm3s6965 as _;
use recipe_common::{CLOCK, Controller, Forces, LEVEL, PERIODS};

/// What belongs to the interrupt: the controller, and the end of the queue that forces go into.
type Own = (Controller, Producer<'static, f32>);

/// Where the main program leaves that for the interrupt.
static HANDED_OVER: Mutex<RefCell<Option<Own>>> = Mutex::new(RefCell::new(None));

#[exception]
fn SysTick() {
    // The interrupt takes it out once and is its only user from then on. So the kernel is stepped outside of any critical
    // section, and interrupts of higher priority, which is every other one, are not delayed by it.
    static mut OWN: Option<Own> = None;
    if OWN.is_none() {
        *OWN = critical_section::with(|section| HANDED_OVER.take(section));
    }
    if let Some((controller, forces)) = OWN {
        let force = controller.step().expect("the motion can be moved");
        forces.enqueue(force).expect("the main loop keeps up");
    }
}

#[entry]
fn main() -> ! {
    // Lock-free, for one sender and one receiver. It has room for seven forces, while the main loop does other work.
    static mut QUEUE: Queue<f32, 8> = Queue::new();
    let (sender, mut receiver) = QUEUE.split();
    let own = (Controller::new(LEVEL), sender);
    critical_section::with(|section| HANDED_OVER.replace(section, Some(own)));
    let Peripherals { SCB: mut system, SYST: mut timer, .. } =
        Peripherals::take().expect("nobody has taken them before");
    give_way(&mut system);
    start(&mut timer);

    let mut forces = Forces::default();
    let mut left = PERIODS;
    while left > 0 {
        match receiver.dequeue() {
            Some(force) => {
                forces.add(force);
                left -= 1;
            }
            None => asm::wfi(),
        }
    }
    timer.disable_interrupt();
    forces.print_and_exit()
}

/// Gives the interrupt the lowest priority. After a reset it has the highest, so that every other interrupt would wait for a step.
#[allow(unsafe_code, reason = "a wrong priority breaks critical sections that rely on it; none does here")]
fn give_way(system: &mut SCB) {
    // SAFETY: no critical section relies on priorities: those of critical-section mask all interrupts.
    unsafe { system.set_priority(SystemHandler::SysTick, 0xff) }
}

/// Has the interrupt called every millisecond.
fn start(timer: &mut SYST) {
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(CLOCK / 1000 - 1);
    timer.clear_current();
    timer.enable_interrupt();
    timer.enable_counter();
}
