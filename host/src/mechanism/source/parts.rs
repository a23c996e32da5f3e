//! What the source text of a mechanism is put together from.

use super::expression::Typed;

/// What one kind of mechanism is made of.
pub struct Parts {
    /// What the file says before the types.
    pub head: String,
    /// Number of coordinates.
    pub dimension: usize,
    /// Bodies.
    pub bodies: Typed,
    /// Elements, in the order in which they act.
    pub elements: Vec<Typed>,
    /// How many velocities the bodies have without their ideal joints, where elements act through these.
    pub through_joints: Option<usize>,
    /// Names used from `slipfit_core::system::law`, and from the module `module` of `slipfit_core::system`.
    pub laws: Vec<&'static str>,
    pub module: &'static str,
    pub names: Vec<&'static str>,
    /// Names used from `slipfit_core::drive`.
    pub drives: Vec<&'static str>,
    /// Type and value of the pose that it starts in, and the rates (m/s, rad/s).
    pub pose: Typed,
    pub rates: Vec<f64>,
}

impl Parts {
    /// Where each of the elements is in the unit's `elements()`.
    pub fn paths(&self) -> Vec<String> {
        let inside = if self.through_joints.is_some() { ".0" } else { "" };
        paths(&self.elements).iter().map(|at| format!("{inside}{at}")).collect()
    }
}

/// Where each of the `elements` is among all.
fn paths(elements: &[Typed]) -> Vec<String> {
    let groups: Vec<_> = elements.chunk_by(|one, next| one.of == next.of).collect();
    let of_group = |(i, group): (usize, &&[Typed])| {
        let last = i + 1 == groups.len();
        let at = ".1".repeat(i) + if last { "" } else { ".0" };
        let many = group.len() > 1;
        (0..group.len()).map(move |k| if many { format!("{at}[{k}]") } else { at.clone() }).collect::<Vec<_>>()
    };
    groups.iter().enumerate().flat_map(of_group).collect()
}
