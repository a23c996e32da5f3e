//! What an importer sets and reads.

/// A variable of a unit. Its value reference is its place in the unit's list, from 1 on; 0 is the time.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Name.
    pub name: String,
    /// Who determines it, and when.
    pub causality: Causality,
    /// Its unit, one of [`UNITS`].
    pub unit: &'static str,
    /// What it is.
    pub description: String,
    /// What it is unless it is set; outputs have none.
    pub start: Option<f64>,
}

/// Who determines a variable, and when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// The importer, before initialization ends.
    Fixed,
    /// The importer, between any two steps too.
    Tunable,
    /// The importer, as something that changes all the time.
    Input,
    /// The kernel.
    Output,
}

/// Units and what they are of kilogram, metre, second and radian.
pub const UNITS: [(&str, [i32; 4]); 11] = [
    ("1", [0; 4]),
    ("m", [0, 1, 0, 0]),
    ("s", [0, 0, 1, 0]),
    ("rad", [0, 0, 0, 1]),
    ("m/s", [0, 1, -1, 0]),
    ("rad/s", [0, 0, -1, 1]),
    ("N", [1, 1, -2, 0]),
    ("N.m", [1, 2, -2, 0]),
    ("N.s", [1, 1, -1, 0]),
    ("N.s/m", [1, 0, -1, 0]),
    ("N.m.s/rad", [1, 2, -1, -1]),
];

/// The variables of a unit in the order of their value references, each told what its value is called in the model's source.
#[derive(Default)]
pub(super) struct Variables {
    all: Vec<Variable>,
}

impl Variables {
    /// Adds one that the importer sets; gives the expression of its value.
    pub fn set(
        &mut self,
        causality: Causality,
        name: impl Into<String>,
        unit: &'static str,
        start: f64,
        description: impl Into<String>,
    ) -> String {
        let value = format!("values[{}]", self.all.len());
        let (name, description) = (name.into(), description.into());
        self.all.push(Variable { name, causality, unit, description, start: Some(start) });
        value
    }

    /// Adds one that the kernel determines.
    pub fn output(&mut self, name: impl Into<String>, unit: &'static str, description: impl Into<String>) {
        let (name, description) = (name.into(), description.into());
        self.all.push(Variable { name, causality: Causality::Output, unit, description, start: None });
    }

    /// All of them.
    pub fn all(self) -> Vec<Variable> {
        self.all
    }
}
