//! Whether steps of slides on the lanes of a pack pass over a contact that begins to act.

use pulp::Simd;
use slipfit_core::{
    SVector, Scalar, Vector3,
    menu::SlideData,
    slide::{PINS, to_walls},
    system::Seen,
};

use crate::{
    closing::{self, Between, DEPTH_LEFT, Gaps},
    laws::any_normal,
    pack::Pack,
    slide::approaches,
};

/// How slides see their pins, and how they move, at one end of a step.
#[derive(Clone, Copy)]
pub struct End<'a, V: Simd> {
    /// Pins.
    pub pins: &'a [Seen<Pack<V>, 3>; PINS],
    /// Velocities (m/s) and angular velocities (rad/s).
    pub velocity: &'a SVector<Pack<V>, 6>,
}

/// The share of each step of a `length` (s) between two `ends` after which it ends within a contact of `slides` that it would pass over; 1
/// where there is none, and where `asked` is 0. A contact not deeper than `depth` (m) does not count. `pressed` is the normal force (N) of
/// a contact at this penetration (m) and its rate (m/s).
#[inline(always)]
pub fn share<V: Simd>(
    slides: &SlideData<Pack<V>>,
    ends: [End<V>; 2],
    length: Pack<V>,
    asked: Pack<V>,
    depth: f64,
    pressed: impl Fn(Pack<V>, Pack<V>) -> Pack<V>,
) -> Pack<V> {
    let (zero, one) = (Pack::splat(0.0), Pack::splat(1.0));
    // Above zero where a gap that is open at both ends is smaller than what it may fall by in between.
    let mut closes_within = -one;
    // The least of all gaps at both ends.
    let mut deepest = zero;
    let (most, kept) = (Pack::from_f64(-depth), Pack::from_f64(DEPTH_LEFT));
    let nominal = slides.body.gaps.as_chunks::<4>().0;
    for ([left, right, rail, wall], (from, to)) in nominal.iter().zip(ends[0].pins.iter().zip(ends[1].pins)) {
        for (axis, opens, closes) in [(0, left, right), (1, wall, rail)] {
            let (before, after) = (from.place[axis], to.place[axis]);
            let reach = closing::reach(from.rate[axis], to.rate[axis]) * length;
            for gap in [*opens + before.at_most(after), *closes - before.max_of(after)] {
                closes_within = closes_within.max_of(gap * (reach - gap));
                deepest = deepest.at_most(gap);
            }
        }
    }
    let near = closes_within.select_gt(zero, asked, zero);
    let leaves = if (most - deepest) * asked <= zero { zero } else { leaving(nominal, ends, [most, kept], asked) };
    if near.max_of(leaves) <= zero {
        return one;
    }
    let mut dips = zero;
    for (nominal, (from, to)) in nominal.iter().zip(ends[0].pins.iter().zip(ends[1].pins)) {
        let gaps = [to_walls(*nominal, &from.place), to_walls(*nominal, &to.place)];
        let still = [zero; 4];
        let rates = [to_walls(still, &from.rate), to_walls(still, &to.rate)];
        for k in 0..4 {
            let [before, after] = [gaps[0][k], gaps[1][k]];
            let open = before.select_gt(zero, after.select_gt(zero, one, zero), zero);
            let dip = closing::dips([before, after], [rates[0][k] * length, rates[1][k] * length]);
            dips = dips.max_of(open * dip * near);
            let opens = most.select_gt(before, after.select_gt(kept * before, leaves, zero), zero);
            dips = dips.max_of(pressed(-before, -rates[0][k]).select_gt(zero, zero, opens));
        }
    }
    if dips <= zero { one } else { lane_by_lane(slides, ends, length, dips, depth) }
}

/// `asked` in the lanes in which a contact that is deeper than −`most` (m) opens, or keeps less than the share `kept` of its depth; 0 in
/// the others.
#[inline(always)]
fn leaving<V: Simd>(
    nominal: &[[Pack<V>; 4]],
    ends: [End<V>; 2],
    [most, kept]: [Pack<V>; 2],
    asked: Pack<V>,
) -> Pack<V> {
    let (zero, one) = (Pack::splat(0.0), Pack::splat(1.0));
    let mut opens_by = -one;
    for ([left, right, rail, wall], (from, to)) in nominal.iter().zip(ends[0].pins.iter().zip(ends[1].pins)) {
        for (axis, opens, closes) in [(0, left, right), (1, wall, rail)] {
            let (before, after) = (from.place[axis], to.place[axis]);
            for [before, after] in [[*opens + before, *opens + after], [*closes - before, *closes - after]] {
                opens_by = opens_by.max_of(most.select_gt(before, after - kept * before, -one));
            }
        }
    }
    opens_by.select_gt(zero, asked, zero)
}

/// [`share`] where a contact `may` begin to act. Out of line, since it is rare.
#[inline(never)]
fn lane_by_lane<V: Simd>(
    SlideData { body, contact, .. }: &SlideData<Pack<V>>,
    ends: [End<V>; 2],
    length: Pack<V>,
    may: Pack<V>,
    depth: f64,
) -> Pack<V> {
    let mut shares = Pack::splat(1.0);
    for lane in (0..Pack::<V>::LANES).filter(|lane| may.get(*lane) > 0.0) {
        let number = |pack: &Pack<V>| f64::from(pack.get(lane));
        let Ok(normal) = any_normal(&contact.cast(|pack| number(&pack))) else { continue };
        let vector = |[x, y, z]: [&Pack<V>; 3]| Vector3::new(number(x), number(y), number(z));
        let [before, after] = ends.map(|End { pins, velocity }| {
            let [vx, vy, vz, wx, wy, wz] = velocity.data.0[0].each_ref();
            let (velocity, spin) = (vector([vx, vy, vz]).norm(), vector([wx, wy, wz]).norm());
            let mut gaps = Gaps::default();
            gaps.clear(spin);
            for (k, pin) in pins.iter().enumerate() {
                let [place, rate] = [&pin.place, &pin.rate].map(|v| vector([&v.x, &v.y, &v.z]));
                let lever = vector(body.pins_w[k].data.0[0].each_ref()) + place;
                let nominal = std::array::from_fn(|of| number(&body.gaps[4 * k + of]));
                let seen = Seen { place, rate };
                let of_pin = approaches(&seen, nominal, velocity + spin * lever.norm(), &normal);
                of_pin.into_iter().for_each(|contact| gaps.add(contact));
            }
            gaps
        });
        if let Between::Closes(share) = closing::between(&before, &after, number(&length), depth) {
            shares.set(lane, share as f32);
        }
    }
    shares
}
