// Hatch on two hinges: a mechanism for firmware, to be compiled against slipfit-core. SI units.

use slipfit_core::{
    ParameterError, SVector, Scalar, Vector3,
    clearance::GapStatistics,
    drive::Drive,
    integrator::Extrapolated,
    kernel::{Kernel, StateOf},
    law::{Impact, Regularised, ThreeHalves},
    pose::Pose,
    system::{
        Driving, Element, System,
        law::{Axis, Contact, Motor, Ring, Wall},
        spatial::{About, FreeBodies, Port, Rigid, Rim, Seat},
    },
};

/// Number of coordinates.
pub const DIMENSION: usize = 6;

/// Step (s).
pub const STEP: f32 = 0.00025;

/// Steps of the scene's run.
pub const STEPS: u32 = 6000;

/// The scheme.
pub type Scheme = Extrapolated<2, 4>;

/// What a flash table of this mechanism is stamped with: it must be equal before a lookup is trusted.
pub const SCENE_HASH: u64 = 0xb3c96a5a41e38ac7;

/// The bodies.
pub type Bodies<S> = FreeBodies<S, 1, 6>;

/// What acts on them.
pub type Elements<S> = ([Element<Rim<S, slipfit_core::SMatrix<S, 3, 3>>, Ring<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 3>; 2], (Element<Seat<S>, Wall<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 3>, ([Element<Rim<S, slipfit_core::SMatrix<S, 3, 3>>, Ring<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 3>; 2], (Element<Seat<S>, Wall<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 3>, Element<About<S>, Motor<Drive<S>>, 1>))));

/// A unit's type: what the mechanism does not have leaves no code.
pub type Unit<S> = System<Bodies<S>, Elements<S>>;

/// Gaps over the production, mean and standard deviation (m).
pub const GAPS: [[f64; 2]; 4] = [
    [0.0001, 1e-5], // left hinge
    [0.0002, 5e-5], // left collar
    [0.0001, 1e-5], // right hinge
    [0.0002, 5e-5], // right collar
];

/// The unit of tolerance level `n`.
///
/// # Errors
/// If a gap at that level, or another parameter, is out of bounds.
pub fn unit<S: Scalar + PartialOrd>(n: S) -> Result<Unit<S>, ParameterError<S>> {
    let s = S::from_f64;
    let gap = |[mean, deviation]: [f64; 2], least| GapStatistics { mean: s(mean), deviation: s(deviation) }.checked_at(n, least);
    let gaps = [gap(GAPS[0], 0.0)?, gap(GAPS[1], -10.0)?, gap(GAPS[2], 0.0)?, gap(GAPS[3], -10.0)?];
    let contact_0 = Contact { normal: Impact::new(ThreeHalves::new(s(100000000.0))?, s(300.0), s(1e-5))?, friction: Regularised::new(s(0.15), s(0.001))? };
    let bodies = FreeBodies::new([Rigid { mass: s(2.0), inertia_b: Vector3::new(s(0.015), s(0.042), s(0.027)), centre_w: Vector3::new(s(0.0), s(0.0), s(0.15)) }], Vector3::new(s(0.0), s(-9.81), s(0.0)))?;
    let elements = ([
        Element { link: Rim { seat: Seat { point: Port { body: Some(0), lever: Vector3::new(s(-0.16499999999999998), s(0.0), s(-0.15)) }, from: None }, axes: slipfit_core::SMatrix::<S, 3, 3>::new(s(0.0), s(0.0), s(1.0), s(1.0), s(0.0), s(0.0), s(0.0), s(1.0), s(0.0)), radius: s(0.004) }, law: Ring { clearance: gaps[0], contact: contact_0 } },
        Element { link: Rim { seat: Seat { point: Port { body: Some(0), lever: Vector3::new(s(-0.135), s(0.0), s(-0.15)) }, from: None }, axes: slipfit_core::SMatrix::<S, 3, 3>::new(s(0.0), s(0.0), s(1.0), s(1.0), s(0.0), s(0.0), s(0.0), s(1.0), s(0.0)), radius: s(0.004) }, law: Ring { clearance: gaps[0], contact: contact_0 } },
    ], (Element { link: Seat { point: Port { body: Some(0), lever: Vector3::new(s(-0.165), s(0.0), s(-0.15)) }, from: None }, law: Wall { axis: Axis::X, sign: s(1.0), gap: gaps[1], contact: contact_0 } }, ([
        Element { link: Rim { seat: Seat { point: Port { body: Some(0), lever: Vector3::new(s(0.135), s(0.0), s(-0.15)) }, from: None }, axes: slipfit_core::SMatrix::<S, 3, 3>::new(s(0.0), s(0.0), s(1.0), s(1.0), s(0.0), s(0.0), s(0.0), s(1.0), s(0.0)), radius: s(0.004) }, law: Ring { clearance: gaps[2], contact: contact_0 } },
        Element { link: Rim { seat: Seat { point: Port { body: Some(0), lever: Vector3::new(s(0.16499999999999998), s(0.0), s(-0.15)) }, from: None }, axes: slipfit_core::SMatrix::<S, 3, 3>::new(s(0.0), s(0.0), s(1.0), s(1.0), s(0.0), s(0.0), s(0.0), s(1.0), s(0.0)), radius: s(0.004) }, law: Ring { clearance: gaps[2], contact: contact_0 } },
    ], (Element { link: Seat { point: Port { body: Some(0), lever: Vector3::new(s(0.165), s(0.0), s(-0.15)) }, from: None }, law: Wall { axis: Axis::X, sign: s(-1.0), gap: gaps[3], contact: contact_0 } }, Element { link: About { body: 0, axis_w: Vector3::new(s(-1.0), s(0.0), s(0.0)) }, law: Motor(Drive { gain: s(20.0), ramp_start: s(0.05), ramp_end: s(0.3), speed: s(1.0), point_b: Vector3::new(s(0.0), s(0.0), s(0.0)) }.checked()?) }))));
    Ok(System::new(bodies, elements))
}

/// Where and how fast the unit starts: pose and generalised velocities.
pub fn start<S: Scalar>() -> ([Pose<S>; 1], SVector<S, 6>) {
    let s = S::from_f64;
    let pose = [Pose::nominal(); 1];
    (pose, SVector::from([s(0.0), s(0.0), s(0.0), s(0.0), s(0.0), s(0.0)]))
}

/// A kernel and the state that it steps.
pub type Predictor = (Kernel<f32, Unit<f32>, Scheme>, StateOf<f32, Unit<f32>, 6>);

/// The state of a unit's `kernel` at the start.
pub fn at_start(kernel: &Kernel<f32, Unit<f32>, Scheme>) -> StateOf<f32, Unit<f32>, 6> {
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
pub fn drive_motor<S: Scalar>(unit: &Unit<S>, t: S, pose: &[Pose<S>; 1], velocity: &SVector<S, DIMENSION>) -> Driving<S> {
    unit.driving(&unit.elements().1.1.1.1, t, pose, velocity)
}

/// From now on the commanded speed (rad/s) of the drive "motor" is `speed`, in place of the scene's, until another one is set.
pub fn command_motor<S: Scalar>(unit: &mut Unit<S>, speed: S) {
    slipfit_core::drive::Commandable::set_command(&mut unit.elements_mut().1.1.1.1.law.0, speed);
}
