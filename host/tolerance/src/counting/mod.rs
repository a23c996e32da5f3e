//! Studies of many units: drawn, measured, counted and summed up, in parts that can be split, stopped and joined.

pub mod file;
pub mod forest;
pub mod pairs;
pub mod run;
pub mod shard;
pub mod study;
pub mod tally;
