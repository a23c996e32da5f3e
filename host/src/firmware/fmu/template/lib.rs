//! The kernel of one scene as a co-simulation unit: FMI 2.0 and 3.0.
//!
//! What holds for every scene is in `instance`; the functions of C are `fmi2` and `fmi3`, which with `ffi` alone may be `unsafe`.
#![deny(unsafe_code)]

mod clock;
#[allow(unsafe_code)]
mod ffi;
#[allow(unsafe_code)]
mod fmi2;
#[allow(unsafe_code)]
mod fmi3;
mod instance;
mod model;
mod numbers;
