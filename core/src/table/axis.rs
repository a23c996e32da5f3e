//! An axis of the grid: equidistant nodes, and where a coordinate lies between them.

use super::{AxisKind, TableError, layout::NODES_MOST};

/// Equidistant nodes, in the unit of the axis's kind.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Axis {
    kind: AxisKind,
    count: usize,
    first: f32,
    last: f32,
    step: f32,
    /// The first node, −0 for 0: what is subtracted from −0 must not leave −0, which would count as outside.
    origin: f32,
    per_step: f32,
    /// Steps to the last node, as the bits of an f32.
    top: i32,
}

/// Where a coordinate lies: `fraction` of the way from `node` to the next one, 0 to below 1, and 0 at the last node.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Place {
    pub(crate) node: usize,
    pub(crate) fraction: f32,
    /// Whether another node follows.
    pub(crate) has_next: bool,
    /// Not 0 if the coordinate lies outside the axis.
    pub(crate) outside: u32,
}

impl Place {
    /// At `node`.
    pub(crate) fn at(node: usize) -> Self {
        Self { node, ..Self::default() }
    }

    /// In the middle between `node` and the next one.
    pub(crate) fn after(node: usize) -> Self {
        Self { node, fraction: 0.5, has_next: true, outside: 0 }
    }

    /// The nodes that count: the one below and the one above, the same one twice at a node.
    #[inline(always)]
    pub(super) fn ends(&self) -> [usize; 2] {
        [self.node, self.node + usize::from(self.fraction.to_bits() != 0)]
    }

    /// Has its highest bit set if the coordinate lies between two nodes.
    #[inline(always)]
    pub(super) fn between(&self) -> u32 {
        // Bits of a positive number are a positive integer.
        0u32.wrapping_sub(self.fraction.to_bits())
    }
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
        // 1/step, but such that the last node as f32 has it is `top` steps away, not more by rounding.
        let per_step = top / (last - first);
        let per_step =
            if per_step.is_finite() && (last - first) * per_step > top { per_step.next_down() } else { per_step };
        if !(step > 0.0 && per_step.is_finite() && first + step > first && last - step < last) {
            return Err(TableError::Header("step between nodes"));
        }
        let origin = if first == 0.0 { -0.0 } else { first };
        Ok(Self { kind, count, first, last, step, origin, per_step, top: top.to_bits().cast_signed() })
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

    /// The place of `x`. Beyond an end by less than f32 resolves in steps counts as inside; NaN is outside, at either end.
    ///
    /// As integers the bits of numbers from 0 on are in the numbers' order, and those of negative ones are negative.
    #[inline(always)]
    pub(crate) fn locate(&self, x: f32) -> Place {
        let bits = ((x - self.origin) * self.per_step).to_bits().cast_signed();
        let raised = if bits > 0 { bits } else { 0 };
        let has_next = raised < self.top;
        let inside = if has_next { raised } else { self.top };
        let steps = f32::from_bits(inside.cast_unsigned());
        let node = steps as u32;
        let outside = (inside ^ bits).cast_unsigned();
        Place { node: node as usize, fraction: steps - node as f32, has_next, outside }
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, AxisKind, TableError};

    #[test]
    fn places_coordinates() {
        let axis = Axis::new(AxisKind::Level, -1.0, 0.5, 4).unwrap();
        let inf = f32::INFINITY;
        for (x, node, fraction, clamped) in [
            (-1.0, 0, 0.0, false),
            (-0.875, 0, 0.25, false),
            (-0.5, 1, 0.0, false),
            (0.25, 2, 0.5, false),
            (0.5, 3, 0.0, false),
            (0.500_001, 3, 0.0, true),
            (-1.000_001, 0, 0.0, true),
            (f32::MAX, 3, 0.0, true),
            (f32::MIN, 0, 0.0, true),
            (inf, 3, 0.0, true),
            (-inf, 0, 0.0, true),
            (-0.0, 2, 0.0, false),
        ] {
            let place = axis.locate(x);
            assert_eq!((place.node, place.fraction, place.outside != 0), (node, fraction, clamped), "{x}");
            assert_eq!(place.has_next, node < 3, "{x}");
        }
        // Which end follows from NaN's sign, which arithmetic may change.
        let place = axis.locate(f32::NAN);
        assert!([0, 3].contains(&place.node) && place.fraction == 0.0 && place.outside != 0);
    }

    #[test]
    fn every_node_is_inside() {
        for first in [0.05, 0.0, -0.0, -7.3] {
            let axis = Axis::new(AxisKind::Time, first, 0.1, 1000).unwrap();
            assert!((0..1000).all(|i| axis.locate(axis.node(i)).outside == 0));
            assert_eq!(axis.node(999), axis.last());
        }
        let axis = Axis::new(AxisKind::Time, 0.0, 0.1, 1000).unwrap();
        assert!(axis.locate(-0.0).outside == 0 && axis.locate(-1e-30).outside != 0);
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
