//! The contacts of several units at a time.

use super::{Approach, Between, between_each, may_act, most_left_out, until_pushed};
use crate::real::Real;

/// The contacts of several units at one instant: a number has a value for each.
#[derive(Clone, Debug, Default)]
pub struct WideGaps<S> {
    /// The contacts, always in the same order.
    pub contacts: Vec<Approach<S>>,
    /// The greatest angular velocity (rad/s) of a body.
    pub spin: S,
}

impl<S: Real> WideGaps<S> {
    /// Makes those of units for which `condition` > 0 the `next` ones.
    #[inline(always)]
    pub fn accept(&mut self, condition: S, next: &Self) {
        let zero = S::zero();
        for (kept, next) in self.contacts.iter_mut().zip(&next.contacts) {
            kept.gap = condition.select_gt(zero, next.gap, kept.gap);
            kept.rate = condition.select_gt(zero, next.rate, kept.rate);
            kept.speed = condition.select_gt(zero, next.speed, kept.speed);
            kept.slack = condition.select_gt(zero, next.slack, kept.slack);
        }
        self.spin = condition.select_gt(zero, next.spin, self.spin);
    }

    /// The least gap (m) of each unit; infinite without contacts.
    #[inline(always)]
    pub fn least(&self) -> S {
        let mut least = S::from_f64(f64::INFINITY);
        for contact in &self.contacts {
            least = least.at_most(contact.gap);
        }
        least
    }

    /// The greatest slack of each unit: 0 where [`until_pushed`](Self::until_pushed) has nothing to say.
    #[inline(always)]
    pub fn slack(&self) -> S {
        let mut most = S::zero();
        for contact in &self.contacts {
            most = most.max_of(contact.slack);
        }
        most
    }

    /// [`Gaps::until_pushed`](super::Gaps::until_pushed) of the unit on a `lane`.
    pub fn until_pushed(&self, lane: usize, depth: f64) -> f64 {
        until_pushed(self.of_unit(lane), depth)
    }

    /// Above 0 for units of which a contact may begin to act in a step of `length` (s) that ends with `after`.
    #[inline(always)]
    pub fn may_act(&self, after: &Self, length: S) -> S {
        let most = most_left_out(self.spin.max_of(after.spin) * length);
        let mut may = S::zero();
        for (from, to) in self.contacts.iter().zip(&after.contacts) {
            may = may_act(may, &[*from, *to], length, most);
        }
        may
    }

    /// [`between`](super::between) of the unit on a `lane`.
    pub fn between(&self, after: &Self, lane: usize, length: f64, depth: f64) -> Between {
        let turn = self.spin.get(lane).max(after.spin.get(lane)) * length;
        between_each(self.of_unit(lane).zip(after.of_unit(lane)), length, turn, depth)
    }

    /// The contacts of the unit on a `lane`.
    fn of_unit(&self, lane: usize) -> impl Iterator<Item = Approach> {
        self.contacts.iter().map(move |Approach { gap, rate, speed, slack }| Approach {
            gap: gap.get(lane),
            rate: rate.get(lane),
            speed: speed.get(lane),
            slack: slack.get(lane),
        })
    }
}
