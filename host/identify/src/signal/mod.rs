//! Signals sampled at equal intervals: filters without a shift of phase, differences, spikes, noise.

pub mod butterworth;
pub mod difference;
pub mod noise;
pub mod spikes;
