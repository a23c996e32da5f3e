//! What the images share: the board they run on, and the desk on which the same programs print what they must print.
#![cfg_attr(target_os = "none", no_std)]

pub mod count;
pub mod fingerprint;
pub mod lookups;
pub mod machine;
pub mod slide;

#[cfg(all(target_os = "none", target_arch = "arm"))]
pub mod board;
#[cfg(not(target_os = "none"))]
pub mod desk;
