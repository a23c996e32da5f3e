//! Whether a contact acts within a step that does not act at its start: one that closes and opens again, or one that is closed and pushes
//! only while it opens.
//!
//! Where no contact acts the error estimate of a step is zero however long it is, so that a step may begin before a bounce and end after
//! it. Between the ends a gap is the cubic that has its values and rates there; what that leaves out is bounded by how far the bodies
//! turn, since straight motion under constant forces is a parabola.

mod cubic;
mod wide;

use std::array;

use slipfit_core::{
    Scalar,
    law::Normal,
    slide::ABSENT,
    system::{LANES, Lanes},
};

pub use wide::WideGaps;

use cubic::Cubic;

/// A contact at one instant, or several side by side: a number `S` has a value for each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Approach<S = f64> {
    /// Gap (m), negative where it penetrates.
    pub gap: S,
    /// How fast it opens (m/s).
    pub rate: S,
    /// Speed (m/s) of one body past the other at the contact.
    pub speed: S,
    /// 1 where it is closed and does not push, since it opens faster than its spring can follow; else 0.
    pub slack: S,
}

impl<S: Scalar + PartialOrd> Approach<S> {
    /// A contact with the `normal` law.
    #[inline(always)]
    pub fn new(gap: S, rate: S, speed: S, normal: &impl Normal<S>) -> Self {
        let (zero, one) = (S::zero(), S::one());
        let opens = (-gap).at_most(rate);
        // Most are open, or close.
        let slack = if opens <= zero {
            zero
        } else {
            normal.response(-gap, -rate).force.select_gt(zero, zero, opens.select_gt(zero, one, zero))
        };
        Self { gap, rate, speed, slack }
    }
}

impl<S: Lanes<f64>> Approach<S> {
    /// The contacts of each lane.
    #[inline(always)]
    pub fn lanes(self) -> Approach<[f64; LANES]> {
        let Self { gap, rate, speed, slack } = self;
        Approach { gap: gap.each(), rate: rate.each(), speed: speed.each(), slack: slack.each() }
    }
}

impl Approach<[f64; LANES]> {
    /// No contact in any lane.
    const NONE: Self = Self { gap: [ABSENT; LANES], rate: [0.0; LANES], speed: [0.0; LANES], slack: [0.0; LANES] };

    /// The contact in a `lane`.
    fn of(&self, lane: usize) -> Approach {
        let Self { gap, rate, speed, slack } = self;
        Approach { gap: gap[lane], rate: rate[lane], speed: speed[lane], slack: slack[lane] }
    }
}

/// All contacts of a mechanism at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gaps {
    /// The contacts, always in the same order. Four at a time are compared in the time of one.
    fours: Vec<Approach<[f64; LANES]>>,
    /// Lanes of the last four that hold none.
    free: usize,
    /// The greatest angular velocity (rad/s) of a body.
    spin: f64,
}

impl Gaps {
    /// Forgets all contacts; no body is faster than `spin` (rad/s).
    pub fn clear(&mut self, spin: f64) {
        self.fours.clear();
        (self.free, self.spin) = (0, spin);
    }

    /// Adds a contact.
    pub fn add(&mut self, contact: Approach) {
        if self.free == 0 {
            self.fours.push(Approach::NONE);
            self.free = LANES;
        }
        let lane = LANES - self.free;
        self.free -= 1;
        if let Some(four) = self.fours.last_mut() {
            let Approach { gap, rate, speed, slack } = contact;
            (four.gap[lane], four.rate[lane], four.speed[lane], four.slack[lane]) = (gap, rate, speed, slack);
        }
    }

    /// Adds four contacts.
    #[inline(always)]
    pub fn add_four(&mut self, contacts: Approach<[f64; LANES]>) {
        self.fours.push(contacts);
        self.free = 0;
    }

    /// The gaps (m), four at a time.
    pub fn gaps(&self) -> impl Iterator<Item = [f64; LANES]> {
        self.fours.iter().map(|four| four.gap)
    }

    /// The least gap (m); infinite without contacts.
    pub fn least(&self) -> f64 {
        let fours = self
            .fours
            .iter()
            .fold([f64::INFINITY; LANES], |least, four| array::from_fn(|lane| least[lane].at_most(four.gap[lane])));
        fours.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// How long (s) a step may be for contacts that do not push now, and are deeper than `depth` (m): longer ones would be refused.
    pub fn until_pushed(&self, depth: f64) -> f64 {
        until_pushed(self.each(), depth)
    }

    /// Each contact.
    fn each(&self) -> impl Iterator<Item = Approach> {
        self.fours.iter().flat_map(|four| (0..LANES).map(|lane| four.of(lane)))
    }
}

/// See [`Gaps::until_pushed`].
fn until_pushed(contacts: impl Iterator<Item = Approach>, depth: f64) -> f64 {
    let slack = contacts.filter(|contact| contact.slack > 0.0 && contact.gap < -depth);
    slack.map(|Approach { gap, rate, .. }| (1.0 - DEPTH_AIMED) * -gap / rate).fold(f64::INFINITY, f64::min)
}

/// What is known of a step between its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Between {
    /// No contact begins to act.
    Apart,
    /// One may: a step of this share of the length ends within it. The share is less than 1.
    Closes(f64),
}

/// The greatest angle (rad) by which a body may turn in a step, where gaps are cubics.
const MOST_TURN: f64 = 0.5;

/// The greatest share of ∫|g'| by which a cubic falls below the values at its ends: that of s·(1 − s)².
const DIP: f64 = 4.0 / 27.0;

/// The share of its depth that a contact which does not push has at least after a step. It will push before it opens where damping fades
/// out faster than elastic force, at a depth that only the law knows.
pub const DEPTH_LEFT: f64 = 0.25;

/// The share of its depth that a step aims at which was made shorter.
const DEPTH_AIMED: f64 = 0.3;

/// What happens between the ends `before` and `after` of a step of `length` (s). A contact not deeper than `depth` (m) does not count.
pub fn between(before: &Gaps, after: &Gaps, length: f64, depth: f64) -> Between {
    let turn = before.spin.max(after.spin) * length;
    let most = most_left_out(turn);
    let fours = before.fours.iter().zip(&after.fours);
    let may = fours.fold([0.0; LANES], |may, (from, to)| {
        array::from_fn(|lane| may_act(may[lane], &[from.of(lane), to.of(lane)], length, most))
    });
    if may == [0.0; LANES] {
        return Between::Apart;
    }
    between_each(before.each().zip(after.each()), length, turn, depth)
}

/// What a cubic leaves out where bodies `turn` (rad) in a step, as a share of how far a contact goes.
#[inline(always)]
fn left_out_of<S: Scalar>(turn: S) -> S {
    // |g''''| ≤ spin³·speed; it errs by at most length⁴/384 of it. Twice, since the speed is that of the ends.
    turn * turn * turn / S::from_f64(192.0)
}

/// The same for a first look, to which a body that turns too far may go anywhere.
#[inline(always)]
fn most_left_out<S: Scalar>(turn: S) -> S {
    let left_out = left_out_of(turn);
    turn.select_gt(S::from_f64(MOST_TURN), left_out.max_of(S::one()), left_out)
}

/// `before`, or more than 0 where a contact may begin to act in a step of `length` (s), or does not push at its start; `most` of how far
/// it goes is left out. Without branches, since it is asked of every contact after every step.
#[inline(always)]
fn may_act<S: Scalar>(before: S, ends: &[Approach<S>; 2], length: S, most: S) -> S {
    let (low, way) = least_and_way(ends, length);
    before.max_of(low * (fall(ends, length) + most * way - low)).max_of(ends[0].slack)
}

/// What happens in a step of `length` (s) in which bodies `turn` (rad), by all contacts at both of its ends.
fn between_each(contacts: impl Iterator<Item = (Approach, Approach)>, length: f64, turn: f64, depth: f64) -> Between {
    let left_out = left_out_of(turn);
    let mut share: Option<f64> = None;
    for (from, to) in contacts {
        let found = if from.slack > 0.0 && from.gap < -depth {
            let cubic = || Cubic::new([from.gap, to.gap], [from.rate * length, to.rate * length]);
            (to.gap > DEPTH_LEFT * from.gap).then(|| cubic().opening(DEPTH_AIMED * from.gap))
        } else {
            closes(&[from, to], length, turn, left_out, depth)
        };
        share = found.into_iter().chain(share).reduce(f64::min);
    }
    share.map_or(Between::Apart, Between::Closes)
}

/// The least gap (m) at the ends of a step of `length` (s), and how far (m) one body goes past the other in it.
#[inline(always)]
fn least_and_way<S: Scalar>([from, to]: &[Approach<S>; 2], length: S) -> (S, S) {
    (from.gap.at_most(to.gap), from.speed.max_of(to.speed) * length)
}

/// How far (m) below its values at the ends of a step of `length` (s) the gap's cubic may fall.
#[inline(always)]
fn fall<S: Scalar>([from, to]: &[Approach<S>; 2], length: S) -> S {
    reach(from.rate, to.rate) * length
}

/// The share of a step of `length` (s), in which bodies `turn` (rad), after which it would end within a contact that is open at both ends.
fn closes(ends: &[Approach; 2], length: f64, turn: f64, left_out: f64, depth: f64) -> Option<f64> {
    let [from, to] = ends;
    let (low, way) = least_and_way(ends, length);
    if low <= 0.0 {
        return None;
    }
    if turn > MOST_TURN && low < way {
        return Some(0.9 * MOST_TURN / turn);
    }
    let left_out = left_out * way;
    if low > fall(ends, length) + left_out {
        return None;
    }
    let cubic = Cubic::new([from.gap, to.gap], [from.rate * length, to.rate * length]);
    match cubic.lowest() {
        Some((at, lowest)) if lowest < -depth => Some(cubic.closing(at).min(0.9)),
        // Too long to know: half of it is sixteen times as certain.
        Some((_, lowest)) if lowest < left_out - depth && left_out > depth => Some(0.5),
        _ => None,
    }
}

/// How far (m) below the values at its ends a gap may fall in between at most, by its rates times the step's length (m) there.
#[inline(always)]
pub fn reach<S: Scalar>(before: S, after: S) -> S {
    (before.max_of(-before) + after.max_of(-after)) * S::from_f64(DIP)
}

/// 1 where a gap has a minimum within a step, by its values (m) and its rates times the step's length (m) at the ends; else 0.
#[inline(always)]
pub fn dips<S: Scalar>([from, to]: [S; 2], [before, after]: [S; 2]) -> S {
    let rise = to - from;
    // Monotone if both slopes have the rise's sign and neither is three times as steep (Fritsch and Carlson, SIAM J. Numer. Anal. 17,
    // 1980).
    let (one, other) = (before * rise, after * rise);
    let least = one.select_gt(other, other, one);
    let steep = one.max_of(other) - S::from_f64(3.0) * rise * rise;
    // Where it rises first and falls at last it has a maximum alone.
    let turns = (-before).max_of(after).select_gt(S::zero(), S::one(), S::zero());
    steep.max_of(-least).select_gt(S::zero(), turns, S::zero())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two contacts over a step of `length` (s): one that is always far away, and one with this gap and rate over time.
    fn step(length: f64, spin: f64, speed: f64, gap: impl Fn(f64) -> [f64; 2]) -> [Gaps; 2] {
        [0.0, length].map(|t| {
            let [gap, rate] = gap(t);
            let far = Approach { gap: 10.0, rate: 0.0, speed, slack: 0.0 };
            let mut gaps = Gaps::default();
            gaps.clear(spin);
            [far, Approach { gap, rate, ..far }].into_iter().for_each(|contact| gaps.add(contact));
            gaps
        })
    }

    #[test]
    fn a_throw_against_a_ceiling_is_found_however_short_the_contact() {
        // 50.968 mm high by itself, below a ceiling at 50.9 mm, and below one that it does not reach.
        for (start, length) in [(0.0, 0.2), (0.08, 0.04), (0.09, 0.025)] {
            let gap = |ceiling: f64| {
                move |t: f64| {
                    let (t, v) = (start + t, 1.0);
                    [ceiling - v * t + 0.5 * 9.81 * t * t, -v + 9.81 * t]
                }
            };
            let [before, after] = step(length, 0.0, 1.0, gap(0.0509));
            let Between::Closes(share) = between(&before, &after, length, 1e-9) else { panic!("missed from {start}") };
            let [there, _] = gap(0.0509)(share * length);
            assert!(share < 1.0 && (-6.8e-5..0.0).contains(&there), "{start}: {share} {there}");
            let [before, after] = step(length, 0.0, 1.0, gap(0.051));
            assert_eq!(between(&before, &after, length, 1e-9), Between::Apart);
        }
    }

    #[test]
    fn grazing_counts_from_the_given_depth_on() {
        for deep in [-1e-6, 1e-10, 1e-6] {
            let [before, after] = step(0.02, 0.0, 0.1, |t| {
                let s = t - 0.013;
                [10.0 * s * s - deep, 20.0 * s]
            });
            let found = matches!(between(&before, &after, 0.02, 1e-9), Between::Closes(_));
            assert_eq!(found, deep > 1e-9, "{deep}");
        }
    }

    #[test]
    fn a_point_that_turns_is_followed_until_the_cubic_is_good_enough() {
        // A point on a radius of 0.1 m sweeps past a wall; halved as `between` asks, the contact is found or excluded.
        let (radius, spin) = (0.1, 40.0);
        for distance in [0.0999, 0.099_999, 0.100_001, 0.1001] {
            let gap = |t: f64| {
                let angle: f64 = spin * t - 1.3;
                [distance - radius * libm::cos(angle), radius * spin * libm::sin(angle)]
            };
            let (mut t, mut length, mut closed) = (0.0, 0.065, false);
            while t < 0.065 - 1e-12 {
                let [before, after] = step(length, spin, radius * spin, |s| gap(t + s));
                match between(&before, &after, length, 1e-9) {
                    Between::Closes(share) => length *= share,
                    Between::Apart => {
                        t += length;
                        closed |= gap(t)[0] < 0.0;
                        length = (0.065 - t).clamp(0.0, 0.02);
                    }
                }
            }
            assert_eq!(closed, distance < radius, "{distance}");
        }
    }

    /// What excludes a step by its ends alone excludes none whose cubic has a minimum, and no minimum lies deeper than it may.
    #[test]
    fn no_minimum_is_excluded() {
        let mut seed = 1u64;
        let mut roll = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let (mut with, mut excluded) = (0, 0);
        for _ in 0..100_000 {
            let (gaps, rates) = ([1.0 + roll(), 1.0 + roll()], [6.0 * roll(), 6.0 * roll()]);
            let may = dips(gaps, rates) > 0.0;
            excluded += u32::from(!may);
            let Some((at, lowest)) = Cubic::new(gaps, rates).lowest() else { continue };
            with += 1;
            assert!(may, "{gaps:?} {rates:?} at {at}");
            assert!(lowest > gaps[0].min(gaps[1]) - reach(rates[0], rates[1]) - 1e-12, "{gaps:?} {rates:?}");
        }
        assert!(with > 20_000 && excluded > 20_000, "{with} {excluded}");
    }
}
