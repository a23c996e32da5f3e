//! Lookups in integers, for cores that compute floating point in software: a table of i16 at one level.

use super::{I16Nodes, Place, Table, layout::CHANNELS};
use crate::{ParameterError, error::bounded};

/// Bits behind the point of a place along the second axis, in nodes.
const PLACE_BITS: u32 = 16;

/// Bits behind the point of a weight: a difference of two i16 times a weight fits an i32.
const WEIGHT_BITS: u32 = 14;

/// The most counts that the second axis may span: the last bits of the rate are then less than 2⁻⁹ of a node.
const SPAN_MOST: f32 = 16_777_216.0;

/// A table of i16 over level and time or position, at one level. Made with floating point, looked up without.
#[derive(Clone, Copy, Debug)]
pub struct Integers<'a> {
    nodes: &'a [[u8; 4]],
    /// Where the nodes of the level below and of the one above begin.
    rows: [usize; 2],
    /// How far the level lies between them.
    across: i32,
    /// Nodes in a count, times 2³².
    rate: u32,
    /// Where count 0 is, in nodes times 2¹⁶.
    origin: i64,
    /// Where the last node is.
    last: i64,
    /// Least and greatest value of each channel when the table was opened.
    ranges: [[i32; 2]; CHANNELS],
    scales: [f32; CHANNELS],
    is_outside: bool,
    is_mixed: bool,
}

/// What a table says about one point, in integers. Flags as in [`Lookup`](super::Lookup).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct IntegerLookup {
    /// Force, in units of the first of [`Integers::scales`].
    pub force: i32,
    /// Velocity, in units of the second.
    pub velocity: i32,
    /// The point lay outside the grid, or the level does.
    pub clamped: bool,
    /// The level lies between motions whose verdicts differ.
    pub mixed: bool,
    /// A value lay outside the range of the channel's nodes when the table was opened, and is held to it.
    pub damaged: bool,
}

impl<'a> Table<'a, 2, I16Nodes<'a>> {
    /// This table at the level `n`, for counts of `unit` along the second axis (s or m): 0.001 for milliseconds.
    ///
    /// # Errors
    /// If the unit is greater than the distance of two nodes, or the axis spans more than 2²⁴ of them.
    pub fn integers(&self, n: f32, unit: f32) -> Result<Integers<'a>, ParameterError<f32>> {
        let [levels, axis] = &self.axes;
        let span = axis.last() - axis.first();
        let unit = bounded("table.unit", unit, [(span / SPAN_MOST).into(), axis.step().into()])?;
        let steps = (axis.count() - 1) as f32;
        // In double precision, once: a place is exact to a part of a node in so many.
        let per_unit = f64::from(unit) * f64::from(steps) / (f64::from(axis.last()) - f64::from(axis.first()));
        let place = levels.locate(n);
        let row = |level: usize| level.wrapping_mul(axis.count());
        let (nodes, scales, ranges) = self.nodes.parts(&self.ranges);
        let origin = -f64::from(axis.first()) / f64::from(unit) * per_unit;
        Ok(Integers {
            nodes,
            rows: [row(place.node), row(place.node.wrapping_add(usize::from(place.has_next)))],
            across: rounded(place.fraction.into(), WEIGHT_BITS) as i32,
            rate: rounded(per_unit, 32).clamp(1, u32::MAX.into()) as u32,
            origin: rounded(origin, PLACE_BITS),
            last: (axis.count() as i64 - 1) << PLACE_BITS,
            ranges,
            scales,
            is_outside: place.outside != 0,
            is_mixed: self.is_mixed(&[place, Place::at(0)]),
        })
    }
}

/// `x` with so many bits behind the point.
fn rounded(x: f64, bits: u32) -> i64 {
    libm::round(x * (1u64 << bits) as f64) as i64
}

impl Integers<'_> {
    /// What a force (N) and a velocity (m/s) of 1 stand for.
    pub fn scales(&self) -> [f32; CHANNELS] {
        self.scales
    }

    /// Force and velocity `at` so many counts along the second axis, with the same work at every place. They differ from those of
    /// [`Table::lookup`] by at most 1 + d/2¹⁴ + e units, where d sums up the differences of the cell's values along both axes and e is what
    /// 2⁻⁹ of a node makes along the second one (of an axis of 2²⁴ counts; of a shorter one in proportion).
    #[inline]
    pub fn lookup(&self, at: i32) -> IntegerLookup {
        // None of this overflows, which the compiler does not know.
        let place = (i64::from(at).wrapping_mul(i64::from(self.rate)) >> (32 - PLACE_BITS)).wrapping_add(self.origin);
        let inside = place.max(0).min(self.last);
        // To the nearest weight, which a node has exactly.
        let nearest = (inside as u32).wrapping_add(1 << (PLACE_BITS - WEIGHT_BITS - 1));
        let node = (nearest >> PLACE_BITS) as usize;
        let fraction = (nearest as i32 & ((1 << PLACE_BITS) - 1)) >> (PLACE_BITS - WEIGHT_BITS);
        let flags = IntegerLookup {
            clamped: self.is_outside | (inside != place),
            mixed: self.is_mixed,
            ..IntegerLookup::default()
        };
        let row = |row: usize| self.nodes.get(row.wrapping_add(node)..)?.first_chunk::<2>();
        let (Some([a, b]), Some([c, d])) = (row(self.rows[0]), row(self.rows[1])) else { return flags };
        let (mut values, mut changes) = ([0; CHANNELS], 0);
        for (channel, (value, [low, high])) in values.iter_mut().zip(self.ranges).enumerate() {
            let of = |node: &[u8; 4]| I16Nodes::integer(node, channel);
            let lower = blended(of(a), of(b), fraction);
            let found = blended(lower, blended(of(c), of(d), fraction), self.across);
            *value = found.max(low).min(high);
            changes |= *value ^ found;
        }
        IntegerLookup { force: values[0], velocity: values[1], damaged: changes != 0, ..flags }
    }
}

/// The share `weight` of the way from `a` to `b`, to the nearest integer.
#[inline(always)]
fn blended(a: i32, b: i32, weight: i32) -> i32 {
    a.wrapping_add((b.wrapping_sub(a).wrapping_mul(weight).wrapping_add(1 << (WEIGHT_BITS - 1))) >> WEIGHT_BITS)
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::{Integers, WEIGHT_BITS};
    use crate::table::{AxisKind, Table, example, layout};

    /// Forces that jump about over the whole range.
    fn force(node: u32) -> i16 {
        (node.wrapping_mul(40_503) >> 3) as i16
    }

    fn bytes(step: f32) -> Vec<u8> {
        example::table_of_integers(&[(AxisKind::Level, 3, 0.5), (AxisKind::Time, 50, step)], force)
    }

    fn integers(bytes: &[u8], n: f32, unit: f32) -> Integers<'_> {
        Table::<2>::open(bytes).unwrap().i16().unwrap().integers(n, unit).unwrap()
    }

    #[test]
    fn is_the_lookup_within_its_bound() {
        for (step, unit) in [(2e-3, 1e-3), (3e-3, 1e-3), (0.0137, 1e-4), (0.0137, 1e-6)] {
            let bytes = bytes(step);
            let table = Table::<2>::open(&bytes).unwrap();
            for n in [0.0f32, 0.1, 0.5, 0.77, 1.0] {
                let integers = integers(&bytes, n, unit);
                let [force_scale, velocity_scale] = integers.scales();
                let most = (step * 50.0 / unit) as i32;
                for k in (0..500).step_by(if cfg!(miri) { 50 } else { 1 }) {
                    let at = most * (k - 20) / 480;
                    let (found, expected) = (integers.lookup(at), table.lookup([n, at as f32 * unit]));
                    // Within a count of an end either may be outside.
                    let x = at as f32 * unit;
                    let is_near_end = x.abs() < 1e-6 || (x - step * 49.0).abs() < 1e-5;
                    assert!(found.clamped == expected.clamped || is_near_end, "{at}: {found:?} {expected:?}");
                    assert!(!found.mixed && !found.damaged, "{found:?}");
                    // Differences up to 65,535 along either axis; f32 places a point of the table to 2⁻¹⁸ of a node.
                    let bound = 1.0 + 2.0 * 65_535.0 * (1.0 / f64::from(1 << WEIGHT_BITS) + 4e-6);
                    let error = f64::from(found.force) - f64::from(expected.force / force_scale);
                    assert!(error.abs() <= bound, "{step} {unit} {n} {at}: {error}");
                    let error = f64::from(found.velocity) - f64::from(expected.velocity / velocity_scale);
                    assert!(error.abs() <= 2.0 + bound / 10.0, "{step} {unit} {n} {at}: {error}");
                }
            }
        }
    }

    #[test]
    fn is_exact_at_nodes_and_holds_beyond_the_ends() {
        let bytes = bytes(2e-3);
        for (level, n) in [0.0, 0.5, 1.0].into_iter().enumerate() {
            let integers = integers(&bytes, n, 1e-3);
            for node in 0..50 {
                let found = integers.lookup(2 * node);
                let expected = force(50 * level as u32 + node as u32).into();
                assert_eq!((found.force, found.clamped), (expected, false), "{level} {node}");
            }
            for (outside, node) in [(-1, 0), (i32::MIN, 0), (99, 49), (i32::MAX, 49)] {
                let found = integers.lookup(outside);
                assert_eq!((found.force, found.clamped), (force(50 * level as u32 + node).into(), true), "{outside}");
            }
        }
        for n in [-0.1, 1.1, f32::NAN] {
            assert!(integers(&bytes, n, 1e-3).lookup(10).clamped);
        }
    }

    #[test]
    fn says_what_is_mixed_and_what_is_damaged() {
        let mut bytes = example::table_of_integers(&[(AxisKind::Level, 3, 0.5), (AxisKind::Time, 4, 1e-3)], |_| 100);
        // The first level has another verdict than the others.
        let body = bytes.len() - layout::CHECKSUM_SIZE;
        bytes.truncate(body);
        bytes[body - 4..][..3].copy_from_slice(&[1, 2, 2]);
        bytes.extend(layout::checksum(&bytes).to_le_bytes());
        let table = Table::<2>::open(&bytes).unwrap().i16().unwrap();
        for (n, is_mixed) in [(0.0, false), (0.2, true), (0.5, false), (0.7, false)] {
            assert_eq!(table.integers(n, 1e-3).unwrap().lookup(1).mixed, is_mixed, "{n}");
        }
        let mut damaged = table.integers(0.0, 1e-3).unwrap();
        assert!(!damaged.lookup(1).damaged);
        damaged.ranges = [[0, 99], [0, 99]];
        let found = damaged.lookup(1);
        assert!(found.damaged && found.force == 99, "{found:?}");
    }

    #[test]
    fn units_that_are_too_coarse_or_too_fine_are_refused() {
        let bytes = bytes(2e-3);
        let table = Table::<2>::open(&bytes).unwrap().i16().unwrap();
        for unit in [2.1e-3, 0.0, -1e-3, 1e-9, f32::NAN, f32::INFINITY] {
            assert_eq!(table.integers(0.0, unit).unwrap_err().parameter, "table.unit", "{unit}");
        }
    }
}
