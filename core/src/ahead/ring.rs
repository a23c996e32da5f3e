//! The motions of the last accepted steps, and the value at an instant among them.

use crate::{SVector, Scalar};

use super::cubic::weights;

/// A motion at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot<S, P, const D: usize> {
    /// Pose.
    pub pose: P,
    /// Generalised velocities.
    pub velocity: SVector<S, D>,
}

/// `N` motions, the last of them the newest; one place is free for the attempt at the next.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ring<S, P, const D: usize, const N: usize> {
    /// Count of motions.
    newest: u32,
    /// When each holds, in ticks; those that there are not yet, with the oldest.
    times: [u32; N],
    knots: [Knot<S, P, D>; N],
}

/// Where an instant lies among the motions.
struct Bracket<S> {
    /// Counts of the motions before, at or before, after, and after that; the same where there are none.
    counts: [u32; 4],
    /// Weights of the changes between them.
    weights: [S; 3],
}

impl<S: Scalar, P: Copy, const D: usize, const N: usize> Ring<S, P, D, N> {
    const MASK: u32 = {
        // More would reach over half of the range of ticks while the first half is filled.
        assert!(N.is_power_of_two() && N >= 8 && N <= 256, "a ring holds a power of two, 8 to 256");
        N as u32 - 1
    };

    /// At rest in `pose` at time 0.
    pub fn new(pose: P) -> Self {
        Self { newest: 0, times: [0; N], knots: [Knot { pose, velocity: SVector::zeros() }; N] }
    }

    /// At rest in `pose` until the time `end` (ticks), since `start`.
    pub fn put_at_rest(&mut self, pose: P, start: u32, end: u32) {
        self.times.fill(start);
        self.knots.fill(Knot { pose, velocity: SVector::zeros() });
        self.newest = 0;
        self.times[0] = end;
    }

    #[inline(always)]
    fn place(count: u32) -> usize {
        (count & Self::MASK) as usize
    }

    #[inline(always)]
    fn time(&self, count: u32) -> u32 {
        self.times[Self::place(count)]
    }

    #[inline(always)]
    fn knot(&self, count: u32) -> &Knot<S, P, D> {
        &self.knots[Self::place(count)]
    }

    /// Whether there is a motion but that at rest.
    #[inline(always)]
    pub fn has_moved(&self) -> bool {
        self.newest != 0
    }

    /// When the newest motion holds (ticks).
    #[inline(always)]
    pub fn head(&self) -> u32 {
        self.time(self.newest)
    }

    /// How many motions before the newest the last one is that is not after `instant` (ticks); by bisection.
    #[inline(always)]
    fn age(&self, instant: u32) -> u32 {
        let mut count = self.newest.wrapping_sub(Self::MASK);
        let mut stride = N as u32 / 2;
        while stride > 0 {
            let tried = count.wrapping_add(stride);
            // All ones where the time is not after the instant.
            let not_after =
                (self.time(tried).wrapping_sub(instant).wrapping_sub(1).cast_signed() >> 31).cast_unsigned();
            count = count.wrapping_add(stride & not_after);
            stride /= 2;
        }
        self.newest.wrapping_sub(count)
    }

    /// 1 if one more motion leaves what `instant` (ticks) is read from, else 0.
    #[inline(always)]
    pub fn has_room(&self, instant: u32) -> S {
        S::from_count(Self::MASK - 2).select_gt(S::from_count(self.age(instant)), S::one(), S::zero())
    }

    /// The newest motion.
    #[inline(always)]
    pub fn newest(&self) -> &Knot<S, P, D> {
        self.knot(self.newest)
    }

    /// Puts `pose` and the newest motion's velocity with its `change` to the place of the next motion.
    #[inline(always)]
    pub fn next(&mut self, pose: P, change: &SVector<S, D>) -> &Knot<S, P, D> {
        let velocity = self.newest().velocity + change;
        let next = &mut self.knots[Self::place(self.newest.wrapping_add(1))];
        *next = Knot { pose, velocity };
        next
    }

    /// Makes what was put to the next place the newest motion, `length` (ticks) later, if `accepted` is 1.
    #[inline(always)]
    pub fn extend(&mut self, accepted: u32, length: u32) {
        let time = self.head().wrapping_add(length);
        self.newest = self.newest.wrapping_add(accepted);
        // As old as it was where nothing is accepted, because then the length is 0.
        self.times[Self::place(self.newest)] = time;
    }

    /// Where `instant` (ticks) lies. After the newest motion all places are its own.
    #[inline(always)]
    fn bracket(&self, instant: u32) -> Bracket<S> {
        let age = self.age(instant);
        let before = age + 1;
        let counts =
            [before, age, age.saturating_sub(1), age.saturating_sub(2)].map(|age| self.newest.wrapping_sub(age));
        let [a, b, c, d] = counts.map(|count| self.time(count));
        let length = |from: u32, to: u32| S::from_count(to.wrapping_sub(from));
        let (own, into) = (length(b, c), signed::<S>(instant.wrapping_sub(b)));
        // Of no length where the instant is not before the newest motion, which is then the value.
        let (one, zero) = (S::one(), S::zero());
        let s = own.select_gt(zero, into / own, zero);
        let weights = weights([length(a, b), own.max_of(one), length(c, d)], s);
        Bracket { counts, weights }
    }

    /// The numbers that `values` are of a motion, at `instant` (ticks).
    #[inline(always)]
    pub fn read<const V: usize>(&self, instant: u32, values: impl Fn(&Knot<S, P, D>) -> [S; V]) -> [S; V] {
        let Bracket { counts: [a, b, c, d], weights: [p, q, r] } = self.bracket(instant);
        let [a, b, c, d] = [self.knot(a), self.knot(b), self.knot(c), self.knot(d)].map(values);
        core::array::from_fn(|i| b[i] + ((b[i] - a[i]) * p + (c[i] - b[i]) * q + (d[i] - c[i]) * r))
    }

    /// The motion at `instant` (ticks), or the newest if that is older; `shifted` is base + weight·(to − from).
    pub fn interpolated(
        &self,
        instant: u32,
        shifted: impl Fn(&Knot<S, P, D>, &Knot<S, P, D>, &Knot<S, P, D>, S) -> Knot<S, P, D>,
    ) -> Knot<S, P, D> {
        let Bracket { counts: [a, b, c, d], weights: [p, q, r] } = self.bracket(instant);
        let [a, b, c, d] = [self.knot(a), self.knot(b), self.knot(c), self.knot(d)];
        shifted(&shifted(&shifted(b, a, b, p), b, c, q), c, d, r)
    }

    /// Starts anew from `knot`, which holds at `instant` (ticks), or when the newest motion does if that is earlier.
    pub fn restart(&mut self, instant: u32, knot: Knot<S, P, D>) {
        let head = self.head();
        self.times = [if head.wrapping_sub(instant).cast_signed() < 0 { head } else { instant }; N];
        self.knots[Self::place(self.newest)] = knot;
    }
}

/// A difference of ticks as a number.
#[inline(always)]
pub(super) fn signed<S: Scalar>(ticks: u32) -> S {
    let ticks = ticks.cast_signed();
    S::from_count(ticks.max(0).cast_unsigned()) - S::from_count(ticks.min(0).unsigned_abs())
}
