//! A mechanism whose forces are compiled once, not once for every scheme that calls them.
//!
//! Firmware wants the forces inlined into its one step. At the desk every scheme steps every kind of mechanism; calls cost
//! nothing beside what they do, and building takes a fraction of the time. The bits are the same.

use slipfit_core::{
    SVector, Scalar,
    mechanism::{Balance, Differentiated, Mechanism},
};

/// How the forces of a mechanism `M` are computed where their derivatives are known, as methods with error control ask for
/// them.
pub trait Contacts<S: Scalar, M: Mechanism<S, D>, const D: usize> {
    /// As [`Mechanism::forces_by`].
    #[expect(clippy::too_many_arguments, reason = "those of the mechanism")]
    fn forces_by(
        &self,
        mechanism: &M,
        jacobians: &M::Jacobians,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
    ) -> SVector<S, D>;

    /// As [`Mechanism::differentiated`].
    fn differentiated(
        &self,
        mechanism: &M,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, M::Jacobians, D>;
}

/// One contact after the other, as the mechanism does it.
#[derive(Clone, Copy, Debug)]
pub struct InTurn;

impl<S: Scalar, M: Mechanism<S, D>, const D: usize> Contacts<S, M, D> for InTurn {
    #[inline(always)]
    fn forces_by(
        &self,
        mechanism: &M,
        jacobians: &M::Jacobians,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
    ) -> SVector<S, D> {
        mechanism.forces_by(jacobians, t, pose, internal, velocity, a)
    }

    #[inline(always)]
    fn differentiated(
        &self,
        mechanism: &M,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, M::Jacobians, D> {
        mechanism.differentiated(t, pose, internal, velocity)
    }
}

/// The mechanism `M`, its forces out of line.
pub struct OutOfLine<M, C = InTurn> {
    mechanism: M,
    contacts: C,
}

impl<M> OutOfLine<M> {
    /// `mechanism`, its laws without internal variables where it is differentiated.
    pub fn new(mechanism: M) -> Self {
        Self::by(mechanism, InTurn)
    }
}

impl<M, C> OutOfLine<M, C> {
    /// The same, with what computes its contacts.
    pub fn by(mechanism: M, contacts: C) -> Self {
        Self { mechanism, contacts }
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &M {
        &self.mechanism
    }

    /// What computes its contacts.
    pub fn contacts(&self) -> &C {
        &self.contacts
    }
}

impl<S: Scalar, M: Mechanism<S, D>, const D: usize, C: Contacts<S, M, D>> Mechanism<S, D> for OutOfLine<M, C> {
    type Pose = M::Pose;
    type Internal = M::Internal;
    type IterationMatrix = M::IterationMatrix;
    type Jacobians = M::Jacobians;

    const STICKS: bool = M::STICKS;

    fn implicit_update(&self, pose: &M::Pose, velocity: &SVector<S, D>, dt: S) -> M::Pose {
        self.mechanism.implicit_update(pose, velocity, dt)
    }

    fn explicit_update(&self, pose: &M::Pose, velocity: &SVector<S, D>, dt: S) -> M::Pose {
        self.mechanism.explicit_update(pose, velocity, dt)
    }

    fn shifted(&self, base: &M::Pose, from: &M::Pose, to: &M::Pose, weight: S) -> M::Pose {
        self.mechanism.shifted(base, from, to, weight)
    }

    fn internal_shifted(&self, base: &M::Internal, from: &M::Internal, to: &M::Internal, weight: S) -> M::Internal {
        self.mechanism.internal_shifted(base, from, to, weight)
    }

    fn normalised(&self, pose: &M::Pose) -> M::Pose {
        self.mechanism.normalised(pose)
    }

    fn fresh(&self) -> M::Internal {
        self.mechanism.fresh()
    }

    fn remembered(&self, pose: &M::Pose, internal: &M::Internal) -> M::Internal {
        self.mechanism.remembered(pose, internal)
    }

    fn accept(&self, condition: S, next: (&M::Pose, &M::Internal), kept: (&mut M::Pose, &mut M::Internal)) {
        self.mechanism.accept(condition, next, kept);
    }

    fn finiteness_probe(&self, pose: &M::Pose) -> S {
        self.mechanism.finiteness_probe(pose)
    }

    fn settled(&self, velocity: &SVector<S, D>, a: S) -> SVector<S, D> {
        self.mechanism.settled(velocity, a)
    }

    fn momentum(&self, pose: &M::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.momentum(pose, velocity)
    }

    fn velocity(&self, pose: &M::Pose, momentum: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.velocity(pose, momentum)
    }

    fn momentum_by(&self, jacobians: &M::Jacobians, pose: &M::Pose, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.momentum_by(jacobians, pose, velocity)
    }

    #[inline(never)]
    fn forces_by(
        &self,
        jacobians: &M::Jacobians,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
    ) -> SVector<S, D> {
        self.contacts.forces_by(&self.mechanism, jacobians, t, pose, internal, velocity, a)
    }

    #[inline(never)]
    fn forces(
        &self,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
        updated: Option<&mut M::Internal>,
    ) -> SVector<S, D> {
        self.mechanism.forces(t, pose, internal, velocity, a, updated)
    }

    #[inline(never)]
    fn balance(
        &self,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
        a: S,
        tangent_share: S,
    ) -> Balance<S, M::IterationMatrix, D> {
        self.mechanism.balance(t, pose, internal, velocity, a, tangent_share)
    }

    #[inline(never)]
    fn solve(&self, iteration_matrix: &M::IterationMatrix, residual: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.solve(iteration_matrix, residual)
    }

    fn impulse(&self, imbalance: &SVector<S, D>) -> S {
        self.mechanism.impulse(imbalance)
    }

    fn weighed(&self, pose: &M::Pose, change: &SVector<S, D>) -> S {
        self.mechanism.weighed(pose, change)
    }

    #[inline(never)]
    fn differentiated(
        &self,
        t: S,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, M::Jacobians, D> {
        self.contacts.differentiated(&self.mechanism, t, pose, internal, velocity)
    }

    #[inline(never)]
    fn iteration_matrix(&self, jacobians: &M::Jacobians, velocity: &SVector<S, D>, a: S) -> M::IterationMatrix {
        self.mechanism.iteration_matrix(jacobians, velocity, a)
    }

    fn pushed(&self, jacobians: &M::Jacobians, displacement: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.pushed(jacobians, displacement)
    }

    fn displacement(&self, velocity: &SVector<S, D>, rate: &SVector<S, D>, a: S) -> SVector<S, D> {
        self.mechanism.displacement(velocity, rate, a)
    }

    fn rate(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        self.mechanism.rate(displacement, velocity)
    }
}

#[cfg(test)]
mod tests {
    use slipfit_core::{
        SVector, Vector3,
        law::{Exact, Friction, Impact, Regularised, ThreeHalves},
        mechanism::Mechanism,
        system::{
            Element, System, ThroughJoints,
            law::{Contact, Pin},
            spatial::{
                FreeBodies, Port, Rigid, Seat,
                tree::{Joint, Mount, SpatialTree},
            },
        },
    };

    use super::OutOfLine;

    type Bar<F> = Element<Seat<f64>, Pin<f64, Impact<f64, ThreeHalves<f64>>, F>, 3>;
    type Tumbling<F> = System<SpatialTree<f64, 2, 12, 7>, ThroughJoints<Bar<F>, 12>>;

    /// A body that tumbles, with a flap on a hinge; a pin of the flap is in a slot of the frame. Nothing about it is straight or
    /// constant, so that no method does what a default one would.
    fn tumbling<F: Friction<f64>>(friction: F) -> Tumbling<F> {
        let body =
            |x| Rigid { mass: 0.5, inertia_b: Vector3::new(0.02, 0.03, 0.04), centre_w: Vector3::new(x, 0.1, 0.0) };
        let free = FreeBodies::new([body(0.0), body(0.3)], Vector3::new(1.0, -9.81, 0.5)).unwrap();
        let axis = Vector3::new(0.48, 0.6, 0.64);
        let hinge = Joint::Revolute { at: Vector3::new(0.2, 0.1, 0.05), axis };
        let mounts = [Mount { body: 0, on: None, joint: Joint::Free }, Mount { body: 1, on: Some(0), joint: hinge }];
        let normal = Impact::new(ThreeHalves::new(3e4).unwrap(), 20.0, 0.01).unwrap();
        let pin = Element {
            link: Seat { point: Port { body: Some(1), lever: Vector3::new(0.1, -0.1, 0.2) }, from: None },
            law: Pin { gaps: [0.02, -0.01, 0.01, 0.05], contact: Contact { normal, friction } },
        };
        System::new(SpatialTree::new(free, &mounts).unwrap(), ThroughJoints(pin))
    }

    /// Two motions.
    fn motions<M: Mechanism<f64, 7>>(mechanism: &M, nominal: &M::Pose) -> [(M::Pose, SVector<f64, 7>); 2] {
        [[0.03, -0.02, 0.04, 0.1, 0.2, -0.15, 0.3], [-0.05, 0.01, 0.02, -0.2, 0.1, 0.25, -0.4]].map(|numbers| {
            let numbers = SVector::from(numbers);
            (mechanism.normalised(&mechanism.explicit_update(nominal, &numbers, 1.0)), numbers * 7.0)
        })
    }

    #[test]
    fn every_method_is_the_mechanisms() {
        let one = tumbling(Regularised::new(0.4, 0.05).unwrap());
        let nominal = one.bodies().nominal();
        let other = OutOfLine::new(one);
        let ([(p, v), (q, w)], a) = (motions(&one, &nominal), 1e-3);
        assert_eq!(motions(&other, &nominal), [(p, v), (q, w)]);
        assert_eq!(one.implicit_update(&p, &v, a), other.implicit_update(&p, &v, a));
        assert_eq!(one.shifted(&p, &p, &q, 0.3), other.shifted(&p, &p, &q, 0.3));
        assert_eq!(one.finiteness_probe(&p), other.finiteness_probe(&p));
        assert_eq!(one.momentum(&p, &v), other.momentum(&p, &v));
        assert_eq!(one.velocity(&p, &v), other.velocity(&p, &v));
        assert_eq!(one.impulse(&v), other.impulse(&v));

        let internal = one.fresh();
        let [at, found] = [one.differentiated(0.1, &p, &internal, &v), other.differentiated(0.1, &p, &internal, &v)];
        assert_eq!((at.force, at.per_time), (found.force, found.per_time));
        assert_eq!(one.pushed(&at.jacobians, &w), other.pushed(&found.jacobians, &w));
        let matrices = [one.iteration_matrix(&at.jacobians, &v, a), other.iteration_matrix(&found.jacobians, &v, a)];
        assert_eq!(one.solve(&matrices[0], &w), other.solve(&matrices[1], &w));
        let [at_stage, at_other] =
            [one.balance(0.1, &p, &internal, &v, a, 0.5), other.balance(0.1, &p, &internal, &v, a, 0.5)];
        assert_eq!(at_stage.force, at_other.force);
        assert_eq!(one.solve(&at_stage.iteration_matrix, &w), other.solve(&at_other.iteration_matrix, &w));
        let force = one.forces(0.1, &q, &internal, &w, a, None);
        assert_eq!(force, other.forces(0.1, &q, &internal, &w, a, None));

        // A wrapper can forget those that have a default, which would say something else.
        let jacobians = &at.jacobians;
        let expected = one.momentum_by(jacobians, &q, &w);
        assert_eq!(expected, other.momentum_by(jacobians, &q, &w));
        assert_ne!(expected, one.momentum(&q, &w));
        let expected = one.forces_by(jacobians, 0.1, &q, &internal, &w, a);
        assert_eq!(expected, other.forces_by(jacobians, 0.1, &q, &internal, &w, a));
        assert_ne!(expected, force);
        assert_eq!(one.weighed(&p, &v), other.weighed(&p, &v));
        assert_ne!(one.weighed(&p, &v), one.impulse(&one.momentum(&p, &v)));
        let expected = one.displacement(&v, &w, a);
        assert_eq!(expected, other.displacement(&v, &w, a));
        assert_ne!(expected, w * a);
        let expected = one.rate(&v, &w);
        assert_eq!(expected, other.rate(&v, &w));
        assert_ne!(expected, w);
    }

    #[test]
    fn what_friction_remembers_is_the_mechanisms() {
        let one = tumbling(Exact::new(0.4).unwrap());
        let nominal = one.bodies().nominal();
        let other = OutOfLine::new(one);
        let ([(p, v), (q, w)], a) = (motions(&one, &nominal), 1e-3);
        fn sticks<M: Mechanism<f64, 7>>(_: &M) -> bool {
            M::STICKS
        }
        assert!(sticks(&one) && sticks(&other));
        let settled = one.settled(&v, a);
        assert_eq!(settled, other.settled(&v, a));
        assert_ne!(settled, v);
        let fresh = one.fresh();
        assert_eq!(fresh, other.fresh());
        let mut kept = [fresh; 2];
        let force = one.forces(0.1, &p, &fresh, &v, a, Some(&mut kept[0]));
        assert_eq!(force, other.forces(0.1, &p, &fresh, &v, a, Some(&mut kept[1])));
        assert!(kept[0] == kept[1] && kept[0] != fresh);
        let between = one.internal_shifted(&fresh, &fresh, &kept[0], 0.3);
        assert_eq!(between, other.internal_shifted(&fresh, &fresh, &kept[0], 0.3));
        for condition in [1.0, -1.0] {
            let mut accepted = [(p, fresh); 2];
            let [(one_pose, one_internal), (other_pose, other_internal)] = &mut accepted;
            one.accept(condition, (&q, &between), (one_pose, one_internal));
            other.accept(condition, (&q, &between), (other_pose, other_internal));
            let expected = if condition > 0.0 { (q, between) } else { (p, fresh) };
            assert_eq!(accepted, [expected; 2]);
        }
        assert_ne!(v, w);
    }
}
