//! What was found of measured parts, as data.

use serde::Serialize;
use slipfit_measured::capability::Capability;

/// All characteristics of some parts.
#[derive(Serialize)]
pub struct Report {
    pub parts: usize,
    pub characteristics: Vec<Capability>,
    pub refused: Vec<Refused>,
    pub warnings: Vec<String>,
}

/// A characteristic whose capability cannot be told.
#[derive(Serialize)]
pub struct Refused {
    pub name: String,
    pub why: String,
}
