//! An axis of the grid: equidistant nodes, and where a coordinate lies between them.

use super::{TableError, layout::NODES_MOST};

/// What varies along an axis; the discriminant is what a table stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum AxisKind {
    /// Tolerance level n.
    Level = 1,
    /// Time t (s).
    Time = 2,
    /// Position z (m).
    Position = 3,
    /// Velocity (m/s).
    Velocity = 4,
}

impl AxisKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Level, Self::Time, Self::Position, Self::Velocity];

    /// The kind stored as `code`.
    pub fn of(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| *kind as u8 == code)
    }
}

/// Equidistant nodes, in the unit of the axis's kind.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Axis {
    kind: AxisKind,
    count: usize,
    first: f32,
    last: f32,
    step: f32,
    per_step: f32,
    last_cell: usize,
}

/// Where a coordinate lies: `fraction` of the way from node `cell` to the next one, 0 to 1 but for rounding.
pub(super) struct Place {
    pub(super) cell: usize,
    pub(super) fraction: f32,
    /// Bits in which the coordinate differs from the nearest one inside: 0 if it lies inside.
    pub(super) outside: u32,
}

impl Axis {
    /// `count` nodes at `first`, `first + step`, and so on.
    ///
    /// # Errors
    /// [`TableError::Header`] names what is out of bounds: fewer than 2 nodes or more than
    /// [`NODES_MOST`], an end that is not finite, a step that is not positive or that f32 does not resolve at the ends.
    pub fn new(kind: AxisKind, first: f32, step: f32, count: usize) -> Result<Self, TableError> {
        if !(2..=NODES_MOST).contains(&count) {
            return Err(TableError::Header("number of nodes"));
        }
        let top = (count - 1) as f32;
        let last = first + step * top;
        if !(first.is_finite() && last.is_finite()) {
            return Err(TableError::Header("first or last node"));
        }
        // 1/step, but such that the last node as f32 has it is `top` steps away.
        let per_step = top / (last - first);
        if !(step > 0.0 && per_step.is_finite() && first + step > first && last - step < last) {
            return Err(TableError::Header("step between nodes"));
        }
        Ok(Self { kind, count, first, last, step, per_step, last_cell: count - 2 })
    }

    /// What varies.
    pub fn kind(&self) -> AxisKind {
        self.kind
    }

    /// The number of nodes, at least 2.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The first node.
    pub fn first(&self) -> f32 {
        self.first
    }

    /// The last node; a coordinate beyond it is outside.
    pub fn last(&self) -> f32 {
        self.last
    }

    /// The distance between nodes.
    pub fn step(&self) -> f32 {
        self.step
    }

    /// The `i`-th node, as f32 has it: what a table's values should be computed at.
    pub fn node(&self, i: usize) -> f32 {
        self.first + self.step * i as f32
    }

    /// The place of `x`. NaN fails the first comparison, so that it ends at the low end, and differs from it.
    #[inline(always)]
    pub(super) fn locate(&self, x: f32) -> Place {
        let inside = if x >= self.first { x } else { self.first };
        let inside = if inside <= self.last { inside } else { self.last };
        let steps = (inside - self.first) * self.per_step;
        let whole = steps as u32 as usize;
        let cell = if whole < self.last_cell { whole } else { self.last_cell };
        Place { cell, fraction: steps - cell as u32 as f32, outside: inside.to_bits() ^ x.to_bits() }
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, AxisKind, TableError};

    #[test]
    fn places_coordinates() {
        let axis = Axis::new(AxisKind::Level, -1.0, 0.5, 4).unwrap();
        let inf = f32::INFINITY;
        for (x, cell, fraction, clamped) in [
            (-1.0, 0, 0.0, false),
            (-0.875, 0, 0.25, false),
            (-0.5, 1, 0.0, false),
            (0.25, 2, 0.5, false),
            (0.5, 2, 1.0, false),
            (0.500_001, 2, 1.0, true),
            (-1.000_001, 0, 0.0, true),
            (f32::MAX, 2, 1.0, true),
            (f32::MIN, 0, 0.0, true),
            (inf, 2, 1.0, true),
            (-inf, 0, 0.0, true),
            (f32::NAN, 0, 0.0, true),
        ] {
            let place = axis.locate(x);
            assert_eq!((place.cell, place.fraction, place.outside != 0), (cell, fraction, clamped), "{x}");
        }
    }

    #[test]
    fn every_node_is_inside() {
        let axis = Axis::new(AxisKind::Time, 0.05, 0.1, 1000).unwrap();
        assert!((0..1000).all(|i| axis.locate(axis.node(i)).outside == 0));
        assert_eq!(axis.node(999), axis.last());
    }

    #[test]
    fn refuses_what_f32_cannot_resolve() {
        let axis = |first, step, count| Axis::new(AxisKind::Position, first, step, count).map(|_| ());
        assert_eq!(axis(0.0, 1.0, 2), Ok(()));
        for count in [0, 1, (1 << 16) + 1] {
            assert_eq!(axis(0.0, 1.0, count), Err(TableError::Header("number of nodes")));
        }
        for (first, step) in
            [(f32::NAN, 1.0), (f32::INFINITY, 1.0), (3e38, 3e38), (0.0, f32::NAN), (0.0, f32::INFINITY)]
        {
            assert_eq!(axis(first, step, 2), Err(TableError::Header("first or last node")));
        }
        for (first, step) in [(0.0, 0.0), (0.0, -1.0), (0.0, 1e-45), (1e9, 1.0), (-1e9, 1.0)] {
            assert_eq!(axis(first, step, 3), Err(TableError::Header("step between nodes")));
        }
    }
}
