//! embassy: a task in an interrupt steps the kernel at 1 kHz, a channel hands each force to the main task.
#![no_std]
#![no_main]

use cortex_m::Peripherals;
use cortex_m_rt::exception;
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_sync::{blocking_mutex::raw::CriticalSectionRawMutex, channel::Channel};
use embassy_time::{Duration, Ticker};
use embassy_time_driver::time_driver_impl;
use lm3s6965::{Interrupt, interrupt};
use recipe_common::{CLOCK, Controller, Forces, LEVEL, PERIODS};
use systick_timer::SystickDriver;

// The clock of embassy-time: it ticks at 1 kHz. Leave it and its interrupt out with a HAL that has a time driver.
time_driver_impl!(static TIMER: SystickDriver<4> = SystickDriver::new_default(CLOCK as u64));

#[exception]
fn SysTick() {
    TIMER.systick_interrupt();
}

/// Runs tasks in an interrupt that no hardware uses here, so that they come before the main task, whatever that does.
static URGENT: InterruptExecutor = InterruptExecutor::new();

#[interrupt]
fn GPIOA() {
    #[allow(unsafe_code, reason = "embassy leaves to its user that nobody else calls this")]
    // SAFETY: it is only called here, and the interrupt comes only once the executor is started, which enables it.
    unsafe {
        URGENT.on_interrupt();
    }
}

/// The forces (N), eight at most, while the main task does other work. Only its queue is behind a critical section, for some
/// instructions; the kernel is not.
static FORCES: Channel<CriticalSectionRawMutex, f32, 8> = Channel::new();

/// Once a period.
#[embassy_executor::task]
async fn control(mut controller: Controller) {
    let mut period = Ticker::every(Duration::from_millis(1));
    for _ in 0..PERIODS {
        period.next().await;
        let force = controller.step().expect("the motion can be moved");
        FORCES.try_send(force).expect("the main task keeps up");
    }
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let mut core = Peripherals::take().expect("nobody has taken them before");
    TIMER.start(&mut core.SYST);
    // The lowest priority. After a reset it is the highest, so that every other interrupt, the timer's too, would wait for a step.
    #[allow(unsafe_code, reason = "a wrong priority breaks critical sections that rely on it; none does here")]
    // SAFETY: no critical section relies on priorities: those of critical-section mask all interrupts.
    unsafe {
        core.NVIC.set_priority(Interrupt::GPIOA, 0xff);
    }
    let task = control(Controller::new(LEVEL)).expect("it is spawned once");
    URGENT.start(Interrupt::GPIOA).spawn(task);

    let mut forces = Forces::default();
    for _ in 0..PERIODS {
        forces.add(FORCES.receive().await);
    }
    forces.print_and_exit()
}
