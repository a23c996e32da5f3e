//! Signals sampled at equal intervals: filters without a shift of phase, differences, spikes.

pub mod butterworth;
pub mod difference;
pub mod spikes;
