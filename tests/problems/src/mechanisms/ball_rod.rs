// Crank, ball rod and slide: a mechanism for firmware, to be compiled against slipfit-core. SI units.

use slipfit_core::{
    ParameterError, SVector, Scalar, Vector3,
    clearance::GapStatistics,
    drive::Drive,
    integrator::Extrapolated,
    kernel::{Kernel, StateOf},
    law::{Impact, Regularised, ThreeHalves},
    system::{
        Driving, Element, System, ThroughJoints,
        law::{Axis, Contact, Motor, Pin, Wall},
        spatial::{About, FreeBodies, Port, Rigid, Seat, tree::{Joint, Mount, SpatialTree}},
    },
};

/// Number of coordinates.
pub const DIMENSION: usize = 5;

/// Step (s).
pub const STEP: f32 = 0.0001;

/// Steps of the scene's run.
pub const STEPS: u32 = 6000;

/// The scheme.
pub type Scheme = Extrapolated<2, 4>;

/// What a flash table of this mechanism is stamped with: it must be equal before a lookup is trusted.
pub const SCENE_HASH: u64 = 0x4133cb33c690e9d5;

/// The bodies.
pub type Bodies<S> = SpatialTree<S, 3, 18, 5>;

/// What acts on them.
pub type Elements<S> = ThroughJoints<(Element<Seat<S>, Pin<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 3>, ([Element<Seat<S>, Wall<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 3>; 2], Element<About<S>, Motor<Drive<S>>, 1>)), 18>;

/// A unit's type: what the mechanism does not have leaves no code.
pub type Unit<S> = System<Bodies<S>, Elements<S>>;

/// Gaps over the production, mean and standard deviation (m).
pub const GAPS: [[f64; 2]; 6] = [
    [5e-5, 1e-5], // upper ball left
    [5e-5, 1e-5], // upper ball right
    [5e-5, 1e-5], // upper ball rail
    [5e-5, 1e-5], // upper ball wall
    [5e-5, 1e-5], // front
    [5e-5, 1e-5], // back
];

/// The unit of tolerance level `n`.
///
/// # Errors
/// If a gap at that level, or another parameter, is out of bounds.
pub fn unit<S: Scalar + PartialOrd>(n: S) -> Result<Unit<S>, ParameterError<S>> {
    let s = S::from_f64;
    let gap = |[mean, deviation]: [f64; 2], least| GapStatistics { mean: s(mean), deviation: s(deviation) }.checked_at(n, least);
    let gaps = [gap(GAPS[0], -0.1)?, gap(GAPS[1], -0.1)?, gap(GAPS[2], -0.1)?, gap(GAPS[3], -0.1)?, gap(GAPS[4], -10.0)?, gap(GAPS[5], -10.0)?];
    let contact_0 = Contact { normal: Impact::new(ThreeHalves::new(s(100000000.0))?, s(100.0), s(5e-6))?, friction: Regularised::new(s(0.1), s(0.001))? };
    let bodies = SpatialTree::new(FreeBodies::new([Rigid { mass: s(0.05), inertia_b: Vector3::new(s(2e-6), s(2e-6), s(2e-6)), centre_w: Vector3::new(s(0.0), s(0.0), s(0.0)) }, Rigid { mass: s(0.02), inertia_b: Vector3::new(s(6e-6), s(2e-7), s(6e-6)), centre_w: Vector3::new(s(0.015), s(0.03), s(0.0)) }, Rigid { mass: s(0.2), inertia_b: Vector3::new(s(5e-5), s(5e-5), s(5e-5)), centre_w: Vector3::new(s(0.015), s(0.08), s(0.0)) }], Vector3::new(s(0.0), s(0.0), s(-9.81)))?, &[
        Mount { body: 0, on: None, joint: Joint::Revolute { at: Vector3::new(s(0.0), s(0.0), s(0.0)), axis: Vector3::new(s(0.0), s(0.6), s(0.8)) } },
        Mount { body: 1, on: Some(0), joint: Joint::Spherical { at: Vector3::new(s(0.015), s(0.0), s(0.0)) } },
        Mount { body: 2, on: None, joint: Joint::Prismatic { axis: Vector3::new(s(0.0), s(1.0), s(0.0)) } },
    ])?;
    let elements = ThroughJoints((Element { link: Seat { point: Port { body: Some(1), lever: Vector3::new(s(0.0), s(0.03), s(0.0)) }, from: Some(2) }, law: Pin { gaps: [gaps[0], gaps[1], gaps[2], gaps[3]], contact: contact_0 } }, ([
        Element { link: Seat { point: Port { body: Some(1), lever: Vector3::new(s(0.0), s(0.03), s(0.0)) }, from: Some(2) }, law: Wall { axis: Axis::Z, sign: s(1.0), gap: gaps[4], contact: contact_0 } },
        Element { link: Seat { point: Port { body: Some(1), lever: Vector3::new(s(0.0), s(0.03), s(0.0)) }, from: Some(2) }, law: Wall { axis: Axis::Z, sign: s(-1.0), gap: gaps[5], contact: contact_0 } },
    ], Element { link: About { body: 0, axis_w: Vector3::new(s(0.0), s(0.6), s(0.8)) }, law: Motor(Drive { gain: s(0.05), ramp_start: s(0.05), ramp_end: s(0.2), speed: s(40.0), point_b: Vector3::new(s(0.0), s(0.0), s(0.0)) }.checked()?) })));
    Ok(System::new(bodies, elements))
}

/// Where and how fast the unit starts: pose and generalised velocities.
pub fn start<S: Scalar>() -> ([[S; 2]; 5], SVector<S, 5>) {
    let s = S::from_f64;
    let pose = [[s(1.0), s(0.0)], [s(1.0), s(0.0)], [s(0.0), s(0.0)], [s(0.0), s(0.0)], [s(0.0), s(0.0)]];
    (pose, SVector::from([s(0.0), s(0.0), s(0.0), s(0.0), s(0.0)]))
}

/// A kernel and the state that it steps.
pub type Predictor = (Kernel<f32, Unit<f32>, Scheme>, StateOf<f32, Unit<f32>, 5>);

/// The state of a unit's `kernel` at the start.
pub fn at_start(kernel: &Kernel<f32, Unit<f32>, Scheme>) -> StateOf<f32, Unit<f32>, 5> {
    let (pose, velocity) = start();
    let mut state = kernel.at_rest(pose);
    state.motion.velocity = velocity;
    state
}

/// The kernel of the unit of tolerance level `n` and its state at the start.
///
/// # Errors
/// If a gap at that level, or another parameter, is out of bounds.
pub fn predictor(n: f32) -> Result<Predictor, ParameterError<f32>> {
    let kernel = Kernel::new(unit(n)?, STEP)?;
    let state = at_start(&kernel);
    Ok((kernel, state))
}

/// Speed (rad/s) and torque (N·m) of the drive "motor" at time `t` (s).
pub fn drive_motor<S: Scalar>(unit: &Unit<S>, t: S, pose: &[[S; 2]; 5], velocity: &SVector<S, DIMENSION>) -> Driving<S> {
    unit.driving_through_joints(&unit.elements().0.1.1, t, pose, velocity)
}

/// From now on the commanded speed (rad/s) of the drive "motor" is `speed`, in place of the scene's, until another one is set.
pub fn command_motor<S: Scalar>(unit: &mut Unit<S>, speed: S) {
    slipfit_core::drive::Commandable::set_command(&mut unit.elements_mut().0.1.1.law.0, speed);
}
