//! The paper's slide at n = 2.5 for C: `main.c` gives it to SUNDIALS CVODE.
#![allow(unsafe_code, reason = "names that C can link to; the functions themselves are safe")]

use std::sync::LazyLock;

use slipfit_problems::{
    cd_rom::{self, CdRomSlide},
    first_order::{EQUATIONS, rates},
};

static SLIDE: LazyLock<CdRomSlide<f64>> = LazyLock::new(|| cd_rom::slide(2.5));

/// Rates of the `state` at time `t` (s).
#[unsafe(no_mangle)]
pub extern "C" fn slide_rates(t: f64, state: &[f64; EQUATIONS], into: &mut [f64; EQUATIONS]) {
    *into = rates(&*SLIDE, t, state);
}

/// The drive force (N) at time `t` (s) and speed `v_z` (m/s).
#[unsafe(no_mangle)]
pub extern "C" fn slide_drive_force(t: f64, v_z: f64) -> f64 {
    SLIDE.drive().force(t, v_z)
}
