//! Exact Coulomb friction: sticks without drift, slides with μN against the motion.
//!
//! The set-valued law |f| ≤ μN at rest, f = −μN·u/|u| in motion, is solved within the implicit step by a return mapping:
//! f is the trial force λ − ρu brought back into the cone, where λ is the force that the last step or stage ended
//! with. At rest f = λ: the law holds a load without any motion. Where the load changes, the body yields by Δf/ρ; with
//! ρ = κ·m/a, a the implicit part of the step, that is a displacement of a²·Δf/(κ·m), which vanishes with the square of the
//! step. The cost depends on nothing.

use super::{Contact, Friction, Rubbing};
use crate::{ParameterError, Scalar, error::bounded};

/// κ: how many times stiffer than the body's inertia a stick is. At 1 the yield of a 1 ms step costs 0.6 % of the peak
/// force on the slide's opening; at 10 it is below the error of the step; at 100 Newton starts to jump between sticks, and
/// SDIRK2 loses the opening at n = 1 by 15 %.
const GRIP: f64 = 10.0;

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
    type Memory = [S; 2];

    const STICKS: bool = true;

    #[inline(always)]
    fn fresh() -> [S; 2] {
        [S::zero(); 2]
    }

    #[inline(always)]
    fn add(&self, memory: &[S; 2], rubbing: &Rubbing<S>, contact: &mut Contact<S>) -> [S; 2] {
        return_mapping(memory, rubbing, [self.coefficient; 2], contact)
    }

    #[inline(always)]
    fn shifted(base: &[S; 2], from: &[S; 2], to: &[S; 2], weight: S) -> [S; 2] {
        [base[0] + (to[0] - from[0]) * weight, base[1] + (to[1] - from[1]) * weight]
    }

    #[inline(always)]
    fn selected(condition: S, yes: &[S; 2], no: &[S; 2]) -> [S; 2] {
        let pick = |i: usize| condition.select_gt(S::zero(), yes[i], no[i]);
        [pick(0), pick(1)]
    }
}

/// Brings the trial force λ − ρu back into the cone: it holds up to `coefficients[0]` times the normal force and slides
/// with `coefficients[1]` times it. Adds the tangential part to `contact` and returns the force (N).
#[inline(always)]
pub(super) fn return_mapping<S: Scalar>(
    memory: &[S; 2],
    rubbing: &Rubbing<S>,
    [at_rest, sliding]: [S; 2],
    contact: &mut Contact<S>,
) -> [S; 2] {
    let Rubbing { sliding: [x, y], normal, normal_slope, mass_rate, tangent_share } = *rubbing;
    let grip = S::from_f64(GRIP) * mass_rate;
    let trial = [memory[0] - grip * x, memory[1] - grip * y];
    let trial_squared = trial[0] * trial[0] + trial[1] * trial[1];
    let limit = at_rest * normal;
    let limit_squared = limit * limit;
    // The least square keeps the root finite where there is neither load nor trial.
    let inverse = trial_squared.max_of(limit_squared).max_of(S::from_f64(1e-30)).rsqrt();
    let slides = |yes: S, no: S| trial_squared.select_gt(limit_squared, yes, no);
    let share = slides(sliding * normal * inverse, S::one());
    let force = [trial[0] * share, trial[1] * share];

    let direction = [trial[0] * inverse, trial[1] * inverse];
    let along = grip * share;
    let turn = slides(tangent_share * along, S::zero());
    let pull = slides(sliding * normal_slope, S::zero());
    let shear = -turn * direction[0] * direction[1];
    contact.force[1] = force[0];
    contact.force[2] = force[1];
    contact.impedance[1] = [-pull * direction[0], along - turn * direction[0] * direction[0], shear];
    contact.impedance[2] = [-pull * direction[1], shear, along - turn * direction[1] * direction[1]];
    force
}

#[cfg(test)]
mod tests {
    use super::*;

    fn traction(memory: [f64; 2], velocity: [f64; 3]) -> (Contact<f64>, [f64; 2]) {
        let mut contact = Contact { force: [0.0; 3], impedance: [[0.0; 3]; 3] };
        let rubbing = Rubbing {
            sliding: [velocity[1], velocity[2]],
            // A normal force of 2 N that grows by 5 N·s/m.
            normal: 2.0 + 5.0 * velocity[0],
            normal_slope: 5.0,
            mass_rate: 80.0,
            tangent_share: 1.0,
        };
        let memory = Exact::new(0.3).unwrap().add(&memory, &rubbing, &mut contact);
        (contact, memory)
    }

    #[test]
    fn holds_a_load_without_motion() {
        for load in [[0.0, 0.0], [0.3, -0.2], [0.0, 0.599]] {
            let (contact, memory) = traction(load, [0.0; 3]);
            assert_eq!(memory, load);
            assert_eq!([contact.force[1], contact.force[2]], load);
        }
    }

    #[test]
    fn slides_with_the_full_force_against_the_motion() {
        let (contact, _) = traction([0.0; 2], [0.0, 3.0, -4.0]);
        assert!(libm::fabs(contact.force[1] + 0.36) < 1e-15 && libm::fabs(contact.force[2] - 0.48) < 1e-15);
        // Without load there is no friction, and nothing that is not finite.
        let mut contact = Contact { force: [0.0; 3], impedance: [[0.0; 3]; 3] };
        let idle =
            Rubbing { sliding: [0.0; 2], normal: 0.0, normal_slope: 0.0, mass_rate: 80.0f32, tangent_share: 1.0 };
        assert_eq!(Exact::new(0.3f32).unwrap().add(&[0.0; 2], &idle, &mut contact), [0.0; 2]);
        assert!(contact.impedance.iter().flatten().all(|x| x.is_finite()));
    }

    #[test]
    fn impedance_is_the_derivative() {
        for (memory, velocity) in [([0.1, 0.2], [1e-3, 3e-5, -2e-5]), ([0.0, 0.0], [0.0, 0.02, 0.01])] {
            let at = traction(memory, velocity).0;
            for column in 0..3 {
                let h = 1e-8;
                let shifted = |h: f64| {
                    let mut velocity = velocity;
                    velocity[column] += h;
                    traction(memory, velocity).0.force
                };
                for row in 1..3 {
                    let slope = -(shifted(h)[row] - shifted(-h)[row]) / (2.0 * h);
                    let found = at.impedance[row][column];
                    assert!(libm::fabs(found - slope) <= 1e-4, "{row}{column} {found} {slope}");
                }
            }
        }
    }

    #[test]
    fn never_leaves_the_cone() {
        for k in 0..1000u16 {
            let angle = f64::from(k) * 0.1;
            let speed = 1e-6 * f64::from(u32::from(k) * u32::from(k) % 9973);
            let (contact, _) = traction([0.2, -0.1], [0.0, speed * libm::cos(angle), speed * libm::sin(angle)]);
            assert!(libm::hypot(contact.force[1], contact.force[2]) <= 0.6 * (1.0 + 1e-15));
        }
    }
}
