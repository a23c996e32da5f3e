// Four-bar linkage with a loose joint: a mechanism for firmware, to be compiled against slipfit-core. SI units.

use slipfit_core::{
    ParameterError, SVector, Scalar, Vector2, Vector3,
    clearance::GapStatistics,
    drive::Drive,
    integrator::Extrapolated,
    kernel::{Kernel, StateOf},
    law::{Impact, Regularised, ThreeHalves},
    system::{
        Driving, Element, System,
        law::{Contact, Journal, Motor},
        planar::{Between, Chain, Frame, Kind, Path, PlanarTree, Point, Rigid, Topology, Turning},
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
pub const SCENE_HASH: u64 = 0x746ae030bc1376a4;

/// The bodies.
pub type Bodies<S> = PlanarTree<S, 3, Joints>;

/// What acts on them.
pub type Elements<S> = (Element<Between<S, 3, Path<0b011, 1>, Path<0b100, 2>>, Journal<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 4>, Element<Turning<Path<0b001, 0>, Frame>, Motor<Drive<S>>, 1>);

/// A unit's type: what the mechanism does not have leaves no code.
pub type Unit<S> = System<Bodies<S>, Elements<S>>;

/// Gaps over the production, mean and standard deviation (m).
pub const GAPS: [[f64; 2]; 1] = [
    [0.0002, 2e-5], // rocker pin
];

/// The unit of tolerance level `n`.
///
/// # Errors
/// If a gap at that level, or another parameter, is out of bounds.
pub fn unit<S: Scalar + PartialOrd>(n: S) -> Result<Unit<S>, ParameterError<S>> {
    let s = S::from_f64;
    let gap = |[mean, deviation]: [f64; 2], least| GapStatistics { mean: s(mean), deviation: s(deviation) }.checked_at(n, least);
    let gaps = [gap(GAPS[0], 0.0)?];
    let contact_0 = Contact { normal: Impact::new(ThreeHalves::new(s(100000000.0))?, s(200.0), s(1e-5))?, friction: Regularised::new(s(0.1), s(0.001))? };
    let bodies = PlanarTree::of(Joints, [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))], &[Rigid { mass: s(0.15), inertia: s(5e-5), centre: Point { carrier: Chain { turn: Some(0), moves: [true, false, false] }, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.021939564047259316), s(0.011985638465105076)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] } }, Rigid { mass: s(0.3), inertia: s(0.0008), centre: Point { carrier: Chain { turn: Some(1), moves: [true, true, false] }, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.04387912809451863), s(0.02397127693021015)), Vector2::new(s(0.07046777432475364), s(0.04753201848980949)), Vector2::new(s(0.0), s(0.0))] } }, Rigid { mass: s(0.2), inertia: s(0.0003), centre: Point { carrier: Chain { turn: Some(2), moves: [false, false, true] }, base: Vector2::new(s(0.2), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(-0.007592661627987052), s(0.05951765695491459))] } }], Vector2::new(s(0.0), s(-9.81)))?;
    let elements = (Element { link: Between { hole: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.04387912809451863), s(0.02397127693021015)), Vector2::new(s(0.14093554864950728), s(0.09506403697961899)), Vector2::new(s(0.0), s(0.0))] }, pin: Point { carrier: Path, base: Vector2::new(s(0.2), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(-0.015185323255974104), s(0.11903531390982915))] } }, law: Journal { clearance: gaps[0], radius: s(0.006), contact: contact_0 } }, Element { link: Turning { body: Path, against: Path }, law: Motor(Drive { gain: s(0.2), ramp_start: s(0.0), ramp_end: s(0.1), speed: s(30.0), point_b: Vector3::new(s(0.0), s(0.0), s(0.0)) }.checked()?) });
    Ok(System::new(bodies, elements))
}

/// Where and how fast the unit starts: pose and generalised velocities.
pub fn start<S: Scalar>() -> ([[S; 2]; 3], SVector<S, 3>) {
    let s = S::from_f64;
    let pose = [[s(1.0), s(0.0)], [s(1.0), s(0.0)], [s(1.0), s(0.0)]];
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
