//! One body on one axis: the smallest mechanism.

use super::{
    Bodies, Element, Law, Link, Response, Seen, System,
    jacobian::Own,
    law::{Motor, Stopped},
};
use crate::{
    ParameterError, SMatrix, SVector, Scalar,
    drive::{Push, SetpointDrive},
    error::bounded,
    law::{Elastic, Impact, Stop, stop::Resistance},
    mechanism::Driven,
};

/// A body that moves along one axis, and gravity along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnAxis<S> {
    mass: S,
    gravity: S,
}

impl<S: Scalar + PartialOrd> OnAxis<S> {
    /// A body of `mass` (kg) with the acceleration of free fall `gravity` (m/s², along the axis).
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(mass: S, gravity: S) -> Result<Self, ParameterError<S>> {
        Ok(Self { mass: bounded("mass", mass, [1e-6, 1e6])?, gravity: bounded("gravity", gravity, [-1e4, 1e4])? })
    }
}

/// The body's displacement (m) along the axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Displacement;

/// A body on an axis at a stop `C`, with a drive `P`, `()` for none.
pub type AxisBody<S, E, C, P = ()> =
    System<OnAxis<S>, (Element<Displacement, Stopped<C, Impact<S, E>>, 1>, Element<Displacement, Motor<P>, 1>)>;

/// A body of `mass` (kg) with the acceleration `gravity` (m/s², along the axis) at `stop`, driven by `push`.
///
/// # Errors
/// [`ParameterError`] names the first parameter that is not finite or out of bounds, of the drive too. The stop is validated where
/// it is made.
pub fn on_axis<S: Scalar + PartialOrd, E: Elastic<S>, C: Stop<S>, P: Push<S>>(
    mass: S,
    gravity: S,
    stop: C,
    contact: Impact<S, E>,
    push: P,
) -> Result<AxisBody<S, E, C, P>, ParameterError<S>> {
    let stop = Element { link: Displacement, law: Stopped { stop, contact } };
    let drive = Element { link: Displacement, law: Motor(push.checked()?) };
    Ok(System::new(OnAxis::new(mass, gravity)?, (stop, drive)))
}

impl<S: Scalar, E: Elastic<S>, C: Stop<S>, P: Push<S>> AxisBody<S, E, C, P> {
    /// Force of the stop on the body (N) at `position` (m) and `velocity` (m/s), all positive along the axis.
    pub fn stop_force(&self, position: S, velocity: S) -> S {
        let Stopped { stop, contact } = &self.elements().0.law;
        stop.resistance(contact, -position, velocity).force()
    }
}

impl<S: Scalar, E: Elastic<S>, C: Stop<S>> Driven<S, 1> for AxisBody<S, E, C, SetpointDrive<S>> {
    fn drive(&self) -> &SetpointDrive<S> {
        &self.elements().1.law.0
    }

    fn drive_mut(&mut self) -> &mut SetpointDrive<S> {
        &mut self.elements_mut().1.law.0
    }

    fn mass(&self) -> S {
        self.bodies().mass
    }

    fn speed(&self, velocity: &SVector<S, 1>) -> S {
        velocity.x
    }

    fn position(&self, pose: &S) -> S {
        *pose
    }
}

impl<S: Scalar> Bodies<S, 1> for OnAxis<S> {
    /// Position (m).
    type Pose = S;

    /// Position (m) and velocity (m/s).
    type Placed = [S; 2];

    type Mass = ();
    type Axes = ();
    type Jacobian = Own<S, 1>;

    const MASS_IS_CONSTANT: bool = true;

    const MATRIX_IS_LEAN: bool = true;

    #[inline(always)]
    fn implicit_update(&self, pose: &S, velocity: &SVector<S, 1>, dt: S) -> S {
        *pose + velocity.x * dt
    }

    #[inline(always)]
    fn explicit_update(&self, pose: &S, velocity: &SVector<S, 1>, dt: S) -> S {
        *pose + velocity.x * dt
    }

    #[inline(always)]
    fn shifted(&self, base: &S, from: &S, to: &S, weight: S) -> S {
        *base + (*to - *from) * weight
    }

    #[inline(always)]
    fn normalised(&self, pose: &S) -> S {
        *pose
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &S, kept: &mut S) {
        *kept = next.or_old(condition, *kept);
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &S) -> S {
        *pose * S::zero()
    }

    #[inline(always)]
    fn rate(&self, _: &SVector<S, 1>, velocity: &SVector<S, 1>) -> SVector<S, 1> {
        *velocity
    }

    #[inline(always)]
    fn placed(&self, pose: &S, velocity: &SVector<S, 1>) -> [S; 2] {
        [*pose, velocity.x]
    }

    #[inline(always)]
    fn axes(&self, _: &[S; 2]) {}

    #[inline(always)]
    fn mass(&self, _: &[S; 2]) {}

    #[inline(always)]
    fn inertia(&self, (): &(), rate: S) -> Own<S, 1> {
        Own(SMatrix::<S, 1, 1>::new(self.mass * rate))
    }

    #[inline(always)]
    fn momentum(&self, (): &(), velocity: &SVector<S, 1>) -> SVector<S, 1> {
        velocity * self.mass
    }

    #[inline(always)]
    fn velocity(&self, (): &(), momentum: &SVector<S, 1>) -> SVector<S, 1> {
        momentum / self.mass
    }

    #[inline(always)]
    fn own_force(&self, _: &[S; 2]) -> SVector<S, 1> {
        SVector::<S, 1>::new(self.mass * self.gravity)
    }

    #[inline(always)]
    fn own_jacobians(&self, _: &[S; 2], (): &(), _: &SVector<S, 1>, _: &mut Own<S, 1>, _: &mut Own<S, 1>) {}

    #[inline(always)]
    fn least_mass(&self) -> S {
        self.mass
    }

    #[inline(always)]
    fn per_lever(&self) -> SVector<S, 1> {
        SVector::<S, 1>::new(S::one())
    }

    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, 1>) -> S {
        imbalance.x.magnitude()
    }

    #[inline(always)]
    fn weighed(&self, change: &SVector<S, 1>) -> S {
        self.impulse(&self.momentum(&(), change))
    }
}

impl<S: Scalar> Link<S, OnAxis<S>, 1, 1> for Displacement {
    type View = ();

    #[inline(always)]
    fn view(&self, _: &OnAxis<S>, _: &[S; 2]) {}

    #[inline(always)]
    fn seen(&self, (_, [position, velocity]): (&OnAxis<S>, &[S; 2]), (): &()) -> Seen<S, 1> {
        Seen { place: SVector::<S, 1>::new(*position), rate: SVector::<S, 1>::new(*velocity) }
    }

    #[inline(always)]
    fn add_force(&self, _: (&OnAxis<S>, &[S; 2]), (): &(), force: &SVector<S, 1>, sum: &mut SVector<S, 1>) {
        *sum += force;
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, 1>>(
        &self,
        _: (&OnAxis<S>, &[S; 2]),
        (): &(),
        response: &Response<S, 1>,
        _: S,
        matrix: &mut Own<S, 1>,
    ) {
        matrix.0 += response.impedance;
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, 1>>(
        &self,
        _: (&OnAxis<S>, &[S; 2]),
        (): &(),
        response: &Response<S, 1>,
        damping: &mut Own<S, 1>,
        stiffness: &mut Own<S, 1>,
    ) {
        damping.0 += response.impedance;
        if W::PLACES > 0 {
            stiffness.0 += response.stiffness;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::on_axis;
    use crate::{
        Vector3,
        drive::Drive,
        law::{Impact, Pad, ThreeHalves},
    };

    #[test]
    fn refuses_a_drive_that_is_none() {
        let contact = Impact::new(ThreeHalves::new(3e6f32).unwrap(), 1000.0, 1e-4).unwrap();
        let good = Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() };
        let made = |drive| on_axis(0.1, 0.0, Pad::new(0.0).unwrap(), contact, drive).map(drop);
        assert_eq!(made(good), Ok(()));
        for (bad, parameter) in [
            (Drive { gain: f32::NAN, ..good }, "drive.gain"),
            (Drive { gain: -1.0, ..good }, "drive.gain"),
            (Drive { ramp_end: 0.05, ..good }, "drive.ramp_duration"),
            (Drive { ramp_end: 0.0, ..good }, "drive.ramp_end"),
            (Drive { speed: f32::INFINITY, ..good }, "drive.speed"),
        ] {
            assert_eq!(made(bad).unwrap_err().parameter, parameter);
        }
    }
}
