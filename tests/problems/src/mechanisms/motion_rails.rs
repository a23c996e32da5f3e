// A stage between lines whose gaps are stated at three places: a mechanism for firmware, to be compiled against slipfit-core. SI units.

use slipfit_core::{
    ParameterError, SVector, Scalar, Vector2, Vector3,
    clearance::GapStatistics,
    drive::Drive,
    integrator::ImplicitEuler,
    kernel::{Kernel, StateOf},
    law::{Impact, Linear, Regularised},
    system::{
        Driving, Element, System,
        law::{Axis, Contact, Contour, Contoured, Pad, Pusher},
        planar::{Across, Along, Chain, Frame, Kind, Path, PlanarTree, Point, Rigid, Topology},
    },
};

/// Number of coordinates.
pub const DIMENSION: usize = 3;

/// Step (s).
pub const STEP: f32 = 0.0002;

/// Steps of the scene's run.
pub const STEPS: u32 = 12000;

/// The scheme.
pub type Scheme = ImplicitEuler<4>;

/// What the coordinates are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joints;

impl Topology<3> for Joints {
    #[inline(always)]
    fn kind(&self, k: usize) -> Kind {
        match k {
            0 => Kind::Slide { on: None },
            1 => Kind::Slide { on: None },
            _ => Kind::Turn,
        }
    }
}

/// What a flash table of this mechanism is stamped with: it must be equal before a lookup is trusted.
pub const SCENE_HASH: u64 = 0x193ab220bdbb94e3;

/// The bodies.
pub type Bodies<S> = PlanarTree<S, 3, Joints>;

/// What acts on them.
pub type Elements<S> = ([Element<Across<S, 3, Path<0b111, 2>, Frame>, Contoured<S, Pad<S, Impact<S, Linear<S>>, Regularised<S>>>, 2>; 4], Element<Along<S, 3, Path<0b111, 2>>, Pusher<Drive<S>>, 2>);

/// A unit's type: what the mechanism does not have leaves no code.
pub type Unit<S> = System<Bodies<S>, Elements<S>>;

/// Gaps over the production, mean and standard deviation (m).
pub const GAPS: [[f64; 2]; 3] = [
    [0.0005, 5e-5], // guide
    [0.0004, 5e-5], // guide at 50 mm
    [-0.0001, 5e-5], // guide at 100 mm
];

/// The unit of tolerance level `n`.
///
/// # Errors
/// If a gap at that level, or another parameter, is out of bounds.
pub fn unit<S: Scalar + PartialOrd>(n: S) -> Result<Unit<S>, ParameterError<S>> {
    let s = S::from_f64;
    let gap = |[mean, deviation]: [f64; 2], least| GapStatistics { mean: s(mean), deviation: s(deviation) }.checked_at(n, least);
    let gaps = [gap(GAPS[0], -0.1)?, gap(GAPS[1], -0.1)?, gap(GAPS[2], -0.1)?];
    let contact_0 = Contact { normal: Impact::new(Linear::new(s(1000000.0))?, s(200.0), s(1e-6))?, friction: Regularised::new(s(0.05), s(0.0001))? };
    let bodies = PlanarTree::of(Joints, [Vector2::new(s(1.0), s(0.0)), Vector2::new(s(0.0), s(1.0)), Vector2::new(s(0.0), s(0.0))], &[Rigid { mass: s(0.1), inertia: s(3e-5), centre: Point { carrier: Chain { turn: Some(2), moves: [true, true, true] }, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] } }], Vector2::new(s(0.0), s(0.0)))?;
    let elements = ([
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.02), s(0.01))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.01)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(0.0), s(-1.0)) }, law: Contoured { wall: Pad { gap: gaps[0], contact: contact_0 }, along: Axis::Y, contour: Contour { slope: s(30.0) * gaps[0] + s(-40.0) * gaps[1] + s(10.0) * gaps[2], curvature: s(-400.0) * gaps[0] + s(800.0) * gaps[1] + s(-400.0) * gaps[2] } } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(-0.02), s(0.01))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.01)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(0.0), s(-1.0)) }, law: Contoured { wall: Pad { gap: gaps[0], contact: contact_0 }, along: Axis::Y, contour: Contour { slope: s(30.0) * gaps[0] + s(-40.0) * gaps[1] + s(10.0) * gaps[2], curvature: s(-400.0) * gaps[0] + s(800.0) * gaps[1] + s(-400.0) * gaps[2] } } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.02), s(-0.01))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0), s(-0.01)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(-0.0), s(1.0)) }, law: Contoured { wall: Pad { gap: gaps[0], contact: contact_0 }, along: Axis::Y, contour: Contour { slope: s(-30.0) * gaps[0] + s(40.0) * gaps[1] + s(-10.0) * gaps[2], curvature: s(-400.0) * gaps[0] + s(800.0) * gaps[1] + s(-400.0) * gaps[2] } } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(-0.02), s(-0.01))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0), s(-0.01)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(-0.0), s(1.0)) }, law: Contoured { wall: Pad { gap: gaps[0], contact: contact_0 }, along: Axis::Y, contour: Contour { slope: s(-30.0) * gaps[0] + s(40.0) * gaps[1] + s(-10.0) * gaps[2], curvature: s(-400.0) * gaps[0] + s(800.0) * gaps[1] + s(-400.0) * gaps[2] } } },
    ], Element { link: Along { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, sensor: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, axis: Vector2::new(s(1.0), s(0.0)) }, law: Pusher(Drive { gain: s(60.0), ramp_start: s(0.0), ramp_end: s(0.1), speed: s(0.05), point_b: Vector3::new(s(0.0), s(0.0), s(0.0)) }.checked()?) });
    Ok(System::new(bodies, elements))
}

/// Where and how fast the unit starts: pose and generalised velocities.
pub fn start<S: Scalar>() -> ([[S; 2]; 3], SVector<S, 3>) {
    let s = S::from_f64;
    let pose = [[s(0.0), s(0.0)], [s(0.0), s(0.0)], [s(1.0), s(0.0)]];
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

/// Speed (m/s) and force (N) of the drive "motor" at time `t` (s).
pub fn drive_motor<S: Scalar>(unit: &Unit<S>, t: S, pose: &[[S; 2]; 3], velocity: &SVector<S, DIMENSION>) -> Driving<S> {
    unit.driving(&unit.elements().1, t, pose, velocity)
}

/// From now on the commanded speed (m/s) of the drive "motor" is `speed`, in place of the scene's, until another one is set.
pub fn command_motor<S: Scalar>(unit: &mut Unit<S>, speed: S) {
    slipfit_core::drive::Commandable::set_command(&mut unit.elements_mut().1.law.0, speed);
}
