//! Exact Coulomb friction: sticks without drift, slides with μN against the motion.
//!
//! The set-valued law |f| ≤ μN at rest, f = −μN·u/|u| in motion, is solved within the implicit step by a return mapping:
//! f is the trial force λ − ρu brought back into the cone, where λ is the force that the last step or stage ended
//! with. At rest f = λ: the law holds a load without any motion. Where the load changes, the body yields by Δf/ρ; with
//! ρ = κ·m/a, a the implicit part of the step, that is a displacement of a²·Δf/(κ·m), which vanishes with the square of the
//! step. The cost depends on nothing.

use super::{Friction, SlidingContact, Traction};
use crate::{ParameterError, Scalar, error::bounded};

/// κ: how many times stiffer than the body's inertia a stick is. At 1 the yield shows in the force; at 10 it is below the
/// error of a 1 ms step; at 100 Newton starts to jump between sticks.
const PENALTY: f64 = 10.0;

/// Coulomb friction with true stick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exact<S> {
    coefficient: S,
}

impl<S: Scalar + PartialOrd> Exact<S> {
    /// Friction with `coefficient` μ.
    ///
    /// # Errors
    /// If μ is negative, above 100 or not finite.
    pub fn new(coefficient: S) -> Result<Self, ParameterError<S>> {
        Ok(Self { coefficient: bounded("friction.coefficient", coefficient, [0.0, 100.0])? })
    }
}

impl<S: Scalar> Friction<S> for Exact<S> {
    /// The friction force on the body along the two tangents (N).
    type Internal = [S; 2];

    const STICKS: bool = true;

    #[inline(always)]
    fn fresh() -> [S; 2] {
        [S::zero(); 2]
    }

    #[inline(always)]
    fn traction(&self, internal: &[S; 2], contact: &SlidingContact<S>) -> (Traction<S>, [S; 2]) {
        return_mapping(internal, contact, [self.coefficient; 2])
    }

    #[inline(always)]
    fn shifted(base: &[S; 2], from: &[S; 2], to: &[S; 2], weight: S) -> [S; 2] {
        [base[0] + (to[0] - from[0]) * weight, base[1] + (to[1] - from[1]) * weight]
    }

    #[inline(always)]
    fn or_old(new: &[S; 2], condition: S, old: &[S; 2]) -> [S; 2] {
        [new[0].or_old(condition, old[0]), new[1].or_old(condition, old[1])]
    }
}

/// Brings the trial force λ − ρu back into the cone: it holds up to `coefficients[0]` times the normal force and slides
/// with `coefficients[1]` times it. The internal variables are the force (N).
#[inline(always)]
pub(super) fn return_mapping<S: Scalar>(
    internal: &[S; 2],
    contact: &SlidingContact<S>,
    [at_rest, sliding]: [S; 2],
) -> (Traction<S>, [S; 2]) {
    let SlidingContact { sliding: [x, y], normal, mass_rate, tangent_share } = *contact;
    let penalty = S::from_f64(PENALTY) * mass_rate;
    let trial = [internal[0] - penalty * x, internal[1] - penalty * y];
    let trial_squared = trial[0] * trial[0] + trial[1] * trial[1];
    let limit = at_rest * normal;
    let limit_squared = limit * limit;
    // What is added keeps the root finite where there is neither load nor trial.
    let inverse = trial_squared.max_of(limit_squared + S::from_f64(1e-30)).rsqrt();
    // Without a load it slides, with no force, and nothing is stiff.
    let slides = |yes: S, no: S| limit_squared.select_gt(trial_squared, no, yes);
    let share = slides(sliding * normal * inverse, S::one());
    let force = [trial[0] * share, trial[1] * share];

    // Of the trial force where it slides, else zero.
    let scale = slides(inverse, S::zero());
    let direction = [trial[0] * scale, trial[1] * scale];
    let along = penalty * share;
    let turn = tangent_share * along;
    let turned = [turn * direction[0], turn * direction[1]];
    let traction = Traction {
        force,
        impedance: [along - turned[0] * direction[0], -turned[0] * direction[1], along - turned[1] * direction[1]],
        per_normal: [-sliding * direction[0], -sliding * direction[1]],
    };
    (traction, force)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn traction(internal: [f64; 2], normal: f64, sliding: [f64; 2]) -> (Traction<f64>, [f64; 2]) {
        let contact = SlidingContact { sliding, normal, mass_rate: 80.0, tangent_share: 1.0 };
        Exact::new(0.3).unwrap().traction(&internal, &contact)
    }

    #[test]
    fn holds_a_load_without_motion() {
        for load in [[0.0, 0.0], [0.3, -0.2], [0.0, 0.599]] {
            let (traction, internal) = traction(load, 2.0, [0.0; 2]);
            assert_eq!(internal, load);
            assert_eq!(traction.force, load);
        }
    }

    #[test]
    fn slides_with_the_full_force_against_the_motion() {
        let [x, y] = traction([0.0; 2], 2.0, [3.0, -4.0]).0.force;
        assert!(libm::fabs(x + 0.36) < 1e-15 && libm::fabs(y - 0.48) < 1e-15);
        // Without load there is no friction, and nothing that is not finite.
        let idle = SlidingContact { sliding: [0.0; 2], normal: 0.0, mass_rate: 80.0f32, tangent_share: 1.0 };
        let (traction, internal) = Exact::new(0.3f32).unwrap().traction(&[0.0; 2], &idle);
        assert_eq!(internal, [0.0; 2]);
        assert!(traction.impedance.iter().chain(&traction.per_normal).all(|x| x.is_finite()));
    }

    #[test]
    fn an_unloaded_contact_does_not_stick() {
        for sliding in [[0.0; 2], [1e-9, 0.0], [0.1, -0.2]] {
            let (traction, internal) = traction([0.0; 2], 0.0, sliding);
            assert_eq!((traction.force.map(f64::abs), traction.impedance.map(f64::abs)), ([0.0; 2], [0.0; 3]));
            assert_eq!(internal.map(f64::abs), [0.0; 2]);
        }
        let (loaded, _) = traction([0.0; 2], 1.0, [0.0; 2]);
        assert_eq!(loaded.impedance, [800.0, 0.0, 800.0]);
    }

    #[test]
    fn impedance_is_the_derivative() {
        let h = 1e-8;
        for (internal, normal, sliding) in [([0.1, 0.2], 2.005, [3e-5, -2e-5]), ([0.0, 0.0], 2.0, [0.02, 0.01])] {
            let at = traction(internal, normal, sliding).0;
            let moved = |h: [f64; 3]| traction(internal, normal + h[0], [sliding[0] + h[1], sliding[1] + h[2]]).0.force;
            let slope = |row: usize, h: [f64; 3]| -(moved(h)[row] - moved(h.map(|h| -h))[row]);
            let [xx, xy, yy] = at.impedance;
            for (row, found) in [[at.per_normal[0], xx, xy], [at.per_normal[1], xy, yy]].into_iter().enumerate() {
                let slopes = [[h, 0.0, 0.0], [0.0, h, 0.0], [0.0, 0.0, h]].map(|h| slope(row, h) / 2.0e-8);
                for (found, slope) in found.into_iter().zip(slopes) {
                    assert!(libm::fabs(found - slope) <= 1e-4, "{row} {found} {slope}");
                }
            }
        }
    }

    #[test]
    fn never_leaves_the_cone() {
        for k in 0..1000u16 {
            let angle = f64::from(k) * 0.1;
            let speed = 1e-6 * f64::from(u32::from(k) * u32::from(k) % 9973);
            let [x, y] = traction([0.2, -0.1], 2.0, [speed * libm::cos(angle), speed * libm::sin(angle)]).0.force;
            assert!(libm::hypot(x, y) <= 0.6 * (1.0 + 1e-15));
        }
    }
}
