//! The drawer effect: whether a body that is driven beside its guide locks.
//!
//! A moment that is carried by two contacts a length L apart along the travel, at a distance b from the line of the drive, locks
//! at μ ≥ L/(2b): each contact carries N = F·b/L and rubs with μN. With the other resistances acting at distance b0, it locks only if
//! the drive passes beyond their line; on it, the body is on the edge; short of it, the body turns the other way and never locks.
//!
//! Which two contacts carry follows from the way the drive turns the body: of all pairs that oppose that turn, the pair that closes at
//! the least angle. Both may be on one side of the body, or one on either side; b counts from the middle between them, because their
//! friction does. Pairs that close at one angle share the load. A drive beside its guide and above it uses both directions at once:
//! separate contacts rub with the sum of their forces, so that it locks at 2μ·Σ b/L ≥ 1; a round rod carries both at one contact,
//! with the root of the sum of squares.

mod slide;
mod stage;

use nalgebra::Vector3;
use serde::Serialize;

pub use slide::{Guide, guide};
pub use stage::{Locked, locked};

/// Lengths (m) that differ by rounding alone.
const SAME: f64 = 1e-9;
/// Turns (rad) at which contacts close together: less than any contact yields.
const SAME_TURN: f64 = 1e-6;

/// Where the drive passes, seen from the guide line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum DriveSide {
    /// Beyond the line of the other resistances: locks above the critical friction.
    Beyond,
    /// On that line: nothing turns the body, the least disturbance does.
    Edge,
    /// Short of it: never locks.
    Short,
}
/// A drive beside the two contacts that carry its moment, in one direction across the travel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Lever {
    /// Distance L of the contacts along the travel (m).
    pub length: f64,
    /// Distance b of the drive from the middle between them (m): negative where the drive, seen from the other resistances, is on
    /// its side.
    pub distance: f64,
    /// Coordinate of the middle between the contacts (m).
    #[serde(skip)]
    middle: f64,
    /// Whether the drive is on the line of the other resistances.
    #[serde(skip)]
    on_edge: bool,
}

impl Lever {
    /// b/L.
    fn ratio(&self) -> f64 {
        self.distance / self.length
    }
}

/// A contact that guides a body: where (m), the direction in which it pushes the body, and its gap (m).
#[derive(Clone, Copy, Debug)]
struct Contact {
    at: Vector3<f64>,
    push: Vector3<f64>,
    gap: f64,
}

/// A body, or several that move as one, on its contacts, pushed through a point along an axis in the direction of travel.
struct Guided<'a> {
    contacts: &'a [Contact],
    axis: Vector3<f64>,
    point: Vector3<f64>,
    centre: Vector3<f64>,
    gravity: Vector3<f64>,
    planar: bool,
}

impl Guided<'_> {
    /// The lever in the direction `across`, a unit vector; `None` where no pair of contacts carries a moment in it.
    fn lever(&self, across: Vector3<f64>) -> Option<Lever> {
        let drive = self.point.dot(&across);
        let off = drive - self.resistance(across);
        if off.abs() > SAME {
            return self.carried(across, off.signum(), drive);
        }
        // On the edge either turn is possible, and the one that locks sooner counts.
        let turns = [1.0, -1.0].into_iter().filter_map(|turn| self.carried(across, turn, drive));
        let worst = turns.max_by(|one, other| one.ratio().total_cmp(&other.ratio()))?;
        Some(Lever { on_edge: true, ..worst })
    }

    /// Where the other resistances act: at the contacts that the weight lies on where it presses in this direction, else at the centre
    /// of mass.
    fn resistance(&self, across: Vector3<f64>) -> f64 {
        let weight = self.gravity.dot(&across);
        let carry = self.contacts.iter().filter(|contact| contact.push.dot(&across) * weight < 0.0);
        let (sum, count) = carry.fold((0.0, 0.0), |(sum, count), contact| (sum + contact.at.dot(&across), count + 1.0));
        if count > 0.0 { sum / count } else { self.centre.dot(&across) }
    }

    /// The lever of the contacts that carry where the drive is on the positive side of the resistances (`turn` 1) or on the negative
    /// one (−1): the one ahead pushes to the drive's side, the one behind away from it.
    fn carried(&self, across: Vector3<f64>, turn: f64, drive: f64) -> Option<Lever> {
        let pushing =
            |sign: f64| self.contacts.iter().filter(move |contact| contact.push.dot(&across) * sign * turn > 0.5);
        let pairs: Vec<_> = pushing(1.0)
            .flat_map(|ahead| pushing(-1.0).map(move |behind| (ahead, behind)))
            .map(|(ahead, behind)| {
                let length = (ahead.at - behind.at).dot(&self.axis);
                let middle = (ahead.at + behind.at).dot(&across) / 2.0;
                ((ahead.gap + behind.gap) / length, length, middle)
            })
            .filter(|(_, length, _)| *length > SAME)
            .collect();
        let least = pairs.iter().map(|(angle, ..)| *angle).fold(f64::INFINITY, f64::min);
        let closed = pairs.iter().filter(|(angle, ..)| *angle <= least + SAME_TURN);
        let (length, middle, count) =
            closed.fold((0.0, 0.0, 0.0), |(l, m, count), (_, length, middle)| (l + length, m + middle, count + 1.0));
        (count > 0.0).then(|| {
            let middle = middle / count;
            Lever { length: length / count, distance: turn * (drive - middle), middle, on_edge: false }
        })
    }
}

/// Where the drive passes, and the critical coefficient of friction, of `levers` across each other. Forces add up in two contacts, or at
/// right angles in one that is `round`.
fn locking(levers: [Option<Lever>; 2], round: bool) -> (DriveSide, Option<f64>) {
    let levers = || levers.iter().flatten();
    let sum: f64 = levers().map(Lever::ratio).sum();
    let ratio = if round { libm::sqrt(levers().map(|lever| lever.ratio().max(0.0)).map(|r| r * r).sum()) } else { sum };
    let edge = levers().any(|lever| lever.on_edge && lever.ratio() > 0.0);
    let side = match () {
        () if sum <= 0.0 && ratio <= 0.0 => DriveSide::Short,
        () if edge => DriveSide::Edge,
        () => DriveSide::Beyond,
    };
    let size = if ratio == 0.0 { sum } else { ratio };
    (side, (size.abs() > 1e-9).then(|| 0.5 / size.abs()))
}
/// The direction of travel at a `speed` of the command.
fn direction(speed: f64) -> f64 {
    if speed < 0.0 { -1.0 } else { 1.0 }
}
/// The directions across an `axis`: one in a plane, two in space, where the axes of the frame are taken if it is one of them.
fn sideways(planar: bool, axis: Vector3<f64>) -> Vec<Vector3<f64>> {
    if planar {
        return vec![Vector3::new(-axis.y, axis.x, 0.0)];
    }
    let aside = if axis.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let first = (aside - axis * axis.dot(&aside)).normalize();
    vec![first, axis.cross(&first)]
}
