//! A drive at work on a Cortex-M4F: a 1 kHz interrupt predicts and watches a simulated unit, the main loop prints.
//!
//! `cargo qemu-drive TABLE` runs the image with a table of the scene in `tests/reference/scene.rs`. With the feature `defmt`
//! the image's log is not text but frames, which `defmt-print` decodes on the desk.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod control;
mod program;
mod rig;
#[rustfmt::skip]
#[allow(dead_code, reason = "its predictor is not the one that this image has")]
#[path = "../../../../reference/scene.rs"]
mod scene;

#[cfg(target_os = "none")]
mod interrupt;

#[cfg(not(all(feature = "defmt", target_os = "none")))]
#[path = "text.rs"]
mod say;
#[cfg(all(feature = "defmt", target_os = "none"))]
#[path = "frames.rs"]
mod say;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    slipfit_firmware::board::boot(program::run)
}

#[cfg(not(target_os = "none"))]
fn main() -> std::io::Result<std::process::ExitCode> {
    slipfit_firmware::desk::boot(program::run)
}

/// On the desk periods follow each other at once.
#[cfg(not(target_os = "none"))]
impl program::Ticking for slipfit_firmware::desk::Desk {
    fn motions(&mut self, start: impl FnOnce() -> control::Motions) -> &'static mut control::Motions {
        Box::leak(Box::new(start()))
    }

    fn ticks(&mut self, mut rig: rig::OnRig, mut show: impl FnMut(&mut Self, &control::Record)) -> rig::OnRig {
        for _ in 0..program::PERIODS {
            let record = rig.tick(|| 0);
            show(self, &record);
        }
        rig
    }

    /// The desk's clock stands still.
    fn cost(&self, record: &control::Record) -> Option<u32> {
        (record.cost > 0).then_some(record.cost)
    }

    fn deepest_stack(&mut self) -> Option<u32> {
        None
    }
}
