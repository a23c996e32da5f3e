// Slider-crank with play in its guide: a mechanism for firmware, to be compiled against slipfit-core. SI units.

use slipfit_core::{
    ParameterError, SVector, Scalar, Vector2, Vector3,
    clearance::GapStatistics,
    drive::Drive,
    integrator::Extrapolated,
    kernel::{Kernel, StateOf},
    law::{Impact, Regularised, ThreeHalves},
    system::{
        Driving, Element, System,
        law::{Contact, Motor, Pad},
        planar::{Across, Chain, Frame, Kind, Path, PlanarTree, Point, Rigid, Topology, Turning},
    },
};

/// Number of coordinates.
pub const DIMENSION: usize = 3;

/// Step (s).
pub const STEP: f32 = 0.00025;

/// Steps of the scene's run.
pub const STEPS: u32 = 2000;

/// The scheme.
pub type Scheme = Extrapolated<2, 4>;

/// What the coordinates are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joints;

impl Topology<3> for Joints {
    #[inline(always)]
    fn kind(&self, _: usize) -> Kind {
        Kind::Turn
    }
}

/// What a flash table of this mechanism is stamped with: it must be equal before a lookup is trusted.
pub const SCENE_HASH: u64 = 0x06760324070446a0;

/// The bodies.
pub type Bodies<S> = PlanarTree<S, 3, Joints>;

/// What acts on them.
pub type Elements<S> = ([Element<Across<S, 3, Path<0b111, 2>, Frame>, Pad<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 2>; 4], Element<Turning<Path<0b001, 0>, Frame>, Motor<Drive<S>>, 1>);

/// A unit's type: what the mechanism does not have leaves no code.
pub type Unit<S> = System<Bodies<S>, Elements<S>>;

/// Gaps over the production, mean and standard deviation (m).
pub const GAPS: [[f64; 2]; 1] = [
    [0.0003, 2.9999999999999997e-5], // guide
];

/// The unit of tolerance level `n`.
///
/// # Errors
/// If a gap at that level, or another parameter, is out of bounds.
pub fn unit<S: Scalar + PartialOrd>(n: S) -> Result<Unit<S>, ParameterError<S>> {
    let s = S::from_f64;
    let gap = |[mean, deviation]: [f64; 2], least| GapStatistics { mean: s(mean), deviation: s(deviation) }.checked_at(n, least);
    let gaps = [gap(GAPS[0], -0.1)?];
    let contact_0 = Contact { normal: Impact::new(ThreeHalves::new(s(10000000.0))?, s(300.0), s(5e-6))?, friction: Regularised::new(s(0.1), s(0.001))? };
    let bodies = PlanarTree::of(Joints, [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))], &[Rigid { mass: s(0.038), inertia: s(7.4e-5), centre: Point { carrier: Chain { turn: Some(0), moves: [true, false, false] }, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0765), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] } }, Rigid { mass: s(0.038), inertia: s(0.00059), centre: Point { carrier: Chain { turn: Some(1), moves: [true, true, false] }, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.153), s(0.0)), Vector2::new(s(0.153), s(0.0)), Vector2::new(s(0.0), s(0.0))] } }, Rigid { mass: s(0.076), inertia: s(7.9e-5), centre: Point { carrier: Chain { turn: Some(2), moves: [true, true, true] }, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.153), s(0.0)), Vector2::new(s(0.30600000000000005), s(0.0)), Vector2::new(s(0.0), s(0.0))] } }], Vector2::new(s(0.0), s(-9.81)))?;
    let elements = ([
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.153), s(0.0)), Vector2::new(s(0.30600000000000005), s(0.0)), Vector2::new(s(0.04999999999999999), s(0.025))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.459), s(0.025)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(0.0), s(-1.0)) }, law: Pad { gap: gaps[0], contact: contact_0 } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.153), s(0.0)), Vector2::new(s(0.30600000000000005), s(0.0)), Vector2::new(s(-0.04999999999999999), s(0.025))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.459), s(0.025)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(0.0), s(-1.0)) }, law: Pad { gap: gaps[0], contact: contact_0 } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.153), s(0.0)), Vector2::new(s(0.30600000000000005), s(0.0)), Vector2::new(s(0.04999999999999999), s(-0.025))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.459), s(-0.025)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(-0.0), s(1.0)) }, law: Pad { gap: gaps[0], contact: contact_0 } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.153), s(0.0)), Vector2::new(s(0.30600000000000005), s(0.0)), Vector2::new(s(-0.04999999999999999), s(-0.025))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.459), s(-0.025)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(-0.0), s(1.0)) }, law: Pad { gap: gaps[0], contact: contact_0 } },
    ], Element { link: Turning { body: Path, against: Path }, law: Motor(Drive { gain: s(0.1), ramp_start: s(0.0), ramp_end: s(0.2), speed: s(20.0), point_b: Vector3::new(s(0.0), s(0.0), s(0.0)) }.checked()?) });
    Ok(System::new(bodies, elements))
}

/// Where and how fast the unit starts: pose and generalised velocities.
pub fn start<S: Scalar>() -> ([[S; 2]; 3], SVector<S, 3>) {
    let s = S::from_f64;
    let pose = [[s(1.0), s(0.0)], [s(1.0), s(0.0)], [s(0.9999998750000026), s(0.0004999999791666669)]];
    (pose, SVector::from([s(0.0), s(0.0), s(0.0)]))
}

/// A kernel and the state that it steps.
pub type Predictor = (Kernel<f32, Unit<f32>, Scheme>, StateOf<f32, Unit<f32>, 3>);

/// The state of a unit's `kernel` at the start.
pub fn at_start(kernel: &Kernel<f32, Unit<f32>, Scheme>) -> StateOf<f32, Unit<f32>, 3> {
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
pub fn drive_motor<S: Scalar>(unit: &Unit<S>, t: S, pose: &[[S; 2]; 3], velocity: &SVector<S, DIMENSION>) -> Driving<S> {
    unit.driving(&unit.elements().1, t, pose, velocity)
}

/// From now on the commanded speed (rad/s) of the drive "motor" is `speed`, in place of the scene's, until another one is set.
pub fn command_motor<S: Scalar>(unit: &mut Unit<S>, speed: S) {
    slipfit_core::drive::Commandable::set_command(&mut unit.elements_mut().1.law.0, speed);
}
