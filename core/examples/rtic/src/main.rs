//! RTIC 2: a task of high priority steps the kernel at 1 kHz, a channel hands each force to a task of low priority.
#![no_std]
#![no_main]
#![forbid(unsafe_code)]

use rtic_monotonics::systick::prelude::*;

// Ticks at 1 kHz. Chips have better timers: rtic-monotonics has those of many.
systick_monotonic!(Clock, 1000);

/// Forces that the channel has room for, while the task of low priority does other work.
const ROOM: usize = 8;

/// The two interrupts are used by no hardware here, so that RTIC starts tasks by them.
#[rtic::app(device = lm3s6965, dispatchers = [GPIOA, GPIOB])]
mod app {
    use recipe_common::{CLOCK, Controller, Forces, LEVEL, PERIODS};
    use rtic_sync::{
        channel::{Receiver, Sender},
        make_channel,
    };

    use super::*;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        controller: Controller,
    }

    #[init]
    fn init(context: init::Context) -> (Shared, Local) {
        Clock::start(context.core.SYST, CLOCK);
        let (sender, receiver) = make_channel!(f32, ROOM);
        control::spawn(sender).expect("it is spawned once");
        report::spawn(receiver).expect("it is spawned once");
        (Shared {}, Local { controller: Controller::new(LEVEL) })
    }

    /// Once a period. The controller is local to this task, so that it is stepped without a lock, and this task can be
    /// interrupted by any of higher priority.
    #[task(priority = 2, local = [controller])]
    async fn control(context: control::Context, mut sender: Sender<'static, f32, ROOM>) {
        let mut next = Clock::now();
        for _ in 0..PERIODS {
            // From one instant to the next, not from the end of the last step: so the period does not drift.
            next += 1.millis();
            Clock::delay_until(next).await;
            let force = context.local.controller.step().expect("the motion can be moved");
            sender.try_send(force).expect("the other task keeps up");
        }
    }

    /// What the product does with forces.
    #[task(priority = 1)]
    async fn report(_: report::Context, mut receiver: Receiver<'static, f32, ROOM>) {
        let mut forces = Forces::default();
        for _ in 0..PERIODS {
            forces.add(receiver.recv().await.expect("the sender is not dropped while forces are left"));
        }
        forces.print_and_exit()
    }
}
