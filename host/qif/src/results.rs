//! Measurement results.
