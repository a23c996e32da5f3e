//! What an operating system has: files that are whole or not there, threads, and a request to stop.
#![forbid(unsafe_code)]

pub mod files;
pub mod interrupt;
pub mod parallel;
