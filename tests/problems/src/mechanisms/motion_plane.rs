// A drawer between lines that converge, with what drives, springs and friction can have in a plane: a mechanism for firmware, to be compiled against slipfit-core. SI units.

use slipfit_core::{
    ParameterError, SVector, Scalar, Vector2,
    clearance::GapStatistics,
    drive::{Commanded, Piece, Push, Train, TrainData},
    integrator::ImplicitEuler,
    kernel::{Kernel, StateOf},
    law::{Impact, Stribeck, StribeckData, ThreeHalves},
    system::{
        Driving, Element, System,
        law::{Axis, Contact, Contour, Contoured, LineSpring, Motor, Pad, Pusher, Spring},
        planar::{Across, Along, Between, Chain, Frame, Kind, Path, PlanarTree, Point, Rigid, Topology, Turning},
    },
};

/// Number of coordinates.
pub const DIMENSION: usize = 4;

/// Step (s).
pub const STEP: f32 = 0.001;

/// Steps of the scene's run.
pub const STEPS: u32 = 400;

/// The scheme.
pub type Scheme = ImplicitEuler<4>;

/// What the coordinates are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joints;

impl Topology<4> for Joints {
    #[inline(always)]
    fn kind(&self, k: usize) -> Kind {
        match k {
            1 => Kind::Slide { on: None },
            2 => Kind::Slide { on: None },
            _ => Kind::Turn,
        }
    }
}

/// What a flash table of this mechanism is stamped with: it must be equal before a lookup is trusted.
pub const SCENE_HASH: u64 = 0x7409ceb3177ca4f6;

/// The bodies.
pub type Bodies<S> = PlanarTree<S, 4, Joints>;

/// What acts on them.
pub type Elements<S> = ([Element<Across<S, 4, Path<0b1110, 3>, Frame>, Contoured<S, Pad<S, Impact<S, ThreeHalves<S>>, Stribeck<S>>>, 2>; 4], (Element<Between<S, 4, Path<0b0001, 0>, Path<0b1110, 3>>, LineSpring<S, 2>, 4>, (Element<Turning<Path<0b0001, 0>, Frame>, Spring<S>, 1>, (Element<Turning<Path<0b0001, 0>, Frame>, Motor<Train<S, ()>>, 1>, Element<Along<S, 4, Path<0b1110, 3>>, Pusher<Train<S, Commanded<S, [Piece<S>; 6]>>>, 2>))));

/// A unit's type: what the mechanism does not have leaves no code.
pub type Unit<S> = System<Bodies<S>, Elements<S>>;

/// Gaps over the production, mean and standard deviation (m).
pub const GAPS: [[f64; 2]; 1] = [
    [0.0003, 2.9999999999999997e-5], // rails
];

/// The unit of tolerance level `n`.
///
/// # Errors
/// If a gap at that level, or another parameter, is out of bounds.
pub fn unit<S: Scalar + PartialOrd>(n: S) -> Result<Unit<S>, ParameterError<S>> {
    let s = S::from_f64;
    let gap = |[mean, deviation]: [f64; 2], least| GapStatistics { mean: s(mean), deviation: s(deviation) }.checked_at(n, least);
    let gaps = [gap(GAPS[0], -0.1)?];
    let contact_0 = Contact { normal: Impact::new(ThreeHalves::new(s(1000000.0))?, s(200.0), s(1e-5))?, friction: Stribeck::new(StribeckData { at_rest: s(0.25), kinetic: s(0.15), stribeck_speed: s(0.005), viscous: s(0.05), stick_band: s(0.001) })? };
    let bodies = PlanarTree::of(Joints, [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(1.0), s(0.0)), Vector2::new(s(0.0), s(1.0)), Vector2::new(s(0.0), s(0.0))], &[Rigid { mass: s(0.6), inertia: s(0.002), centre: Point { carrier: Chain { turn: Some(3), moves: [false, true, true, true] }, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] } }, Rigid { mass: s(0.1), inertia: s(0.0001), centre: Point { carrier: Chain { turn: Some(0), moves: [true, false, false, false] }, base: Vector2::new(s(-0.1), s(0.06)), arms: [Vector2::new(s(0.0), s(0.03)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] } }], Vector2::new(s(0.0), s(-9.81)))?;
    let elements = ([
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.06), s(0.1))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.1)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(0.0), s(-1.0)) }, law: Contoured { wall: Pad { gap: gaps[0], contact: contact_0 }, along: Axis::Y, contour: Contour { slope: s(0.001), curvature: s(-0.008888888888888889) } } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(-0.06), s(0.1))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.1)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(0.0), s(-1.0)) }, law: Contoured { wall: Pad { gap: gaps[0], contact: contact_0 }, along: Axis::Y, contour: Contour { slope: s(0.001), curvature: s(-0.008888888888888889) } } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.06), s(-0.1))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0), s(-0.1)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(-0.0), s(1.0)) }, law: Contoured { wall: Pad { gap: gaps[0], contact: contact_0 }, along: Axis::Y, contour: Contour { slope: s(-0.002), curvature: s(-0.0) } } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(-0.06), s(-0.1))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0), s(-0.1)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(-0.0), s(1.0)) }, law: Contoured { wall: Pad { gap: gaps[0], contact: contact_0 }, along: Axis::Y, contour: Contour { slope: s(-0.002), curvature: s(-0.0) } } },
    ], (Element { link: Between { hole: Point { carrier: Path, base: Vector2::new(s(-0.1), s(0.06)), arms: [Vector2::new(s(0.0), s(0.06)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, pin: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(-0.06), s(0.0))] } }, law: LineSpring { stiffness: s(20.0), damping: s(0.3), free_length: s(0.10149110640673517), drawn: Vector2::new(s(0.0), s(0.0)) } }, (Element { link: Turning { body: Path, against: Path }, law: Spring { stiffness: s(0.05), damping: s(0.0), rest: s(0.09999999999999999), start: s(0.0) } }, (Element { link: Turning { body: Path, against: Path }, law: Motor(Train::new((), TrainData { limit: s(1000000000000.0), coulomb: [s(0.001), s(0.001)], stick_band: s(0.1), viscous: s(0.0001), offset: s(0.0) })?) }, Element { link: Along { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.01))] }, sensor: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.01))] }, axis: Vector2::new(s(1.0), s(0.0)) }, law: Pusher(Train::new(Commanded { gain: s(200.0), command: [Piece { start: s(0.0), coefficients: [s(0.0), s(0.0), s(20.0), s(0.0)] }, Piece { start: s(0.05), coefficients: [s(0.05), s(2.0), s(0.0), s(0.0)] }, Piece { start: s(0.075), coefficients: [s(0.09999999999999999), s(2.0), s(-20.0), s(0.0)] }, Piece { start: s(0.125), coefficients: [s(0.15), s(0.0), s(0.0), s(0.0)] }, Piece { start: s(0.225), coefficients: [s(0.15), s(0.0), s(-89.99999999999997), s(599.9999999999998)] }, Piece { start: s(0.325), coefficients: [s(-0.15), s(0.0), s(0.0), s(0.0)] }] }.checked()?, TrainData { limit: s(8.0), coulomb: [s(0.4), s(0.5)], stick_band: s(0.001), viscous: s(2.0), offset: s(0.1) })?) }))));
    Ok(System::new(bodies, elements))
}

/// Where and how fast the unit starts: pose and generalised velocities.
pub fn start<S: Scalar>() -> ([[S; 2]; 4], SVector<S, 4>) {
    let s = S::from_f64;
    let pose = [[s(1.0), s(0.0)], [s(0.0), s(0.0)], [s(0.0), s(0.0)], [s(1.0), s(0.0)]];
    (pose, SVector::from([s(0.0), s(0.0), s(0.0), s(0.0)]))
}

/// A kernel and the state that it steps.
pub type Predictor = (Kernel<f32, Unit<f32>, Scheme>, StateOf<f32, Unit<f32>, 4>);

/// The state of a unit's `kernel` at the start.
pub fn at_start(kernel: &Kernel<f32, Unit<f32>, Scheme>) -> StateOf<f32, Unit<f32>, 4> {
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
pub fn drive_motor<S: Scalar>(unit: &Unit<S>, t: S, pose: &[[S; 2]; 4], velocity: &SVector<S, DIMENSION>) -> Driving<S> {
    unit.driving(&unit.elements().1.1.1.1, t, pose, velocity)
}

/// From now on the commanded speed (m/s) of the drive "motor" is `speed`, in place of the scene's, until another one is set.
pub fn command_motor<S: Scalar>(unit: &mut Unit<S>, speed: S) {
    slipfit_core::drive::Commandable::set_command(&mut unit.elements_mut().1.1.1.1.law.0, speed);
}
