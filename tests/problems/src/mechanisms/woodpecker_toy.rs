// Woodpecker toy: a mechanism for firmware, to be compiled against slipfit-core. SI units.

use slipfit_core::{
    ParameterError, SVector, Scalar, Vector2,
    clearance::GapStatistics,
    integrator::ImplicitEuler,
    kernel::{Kernel, StateOf},
    law::{Impact, Regularised, ThreeHalves},
    system::{
        Element, System,
        law::{Contact, Pad, Spring},
        planar::{Across, Chain, Frame, Kind, Path, PlanarTree, Point, Rigid, Topology, Turning},
    },
};

/// Number of coordinates.
pub const DIMENSION: usize = 3;

/// Step (s).
pub const STEP: f32 = 0.001;

/// Steps of the scene's run.
pub const STEPS: u32 = 600;

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
            _ => Kind::Turn,
        }
    }
}

/// The bodies.
pub type Bodies<S> = PlanarTree<S, 3, Joints>;

/// What acts on them.
pub type Elements<S> = (Element<Across<S, 3, Path<0b111, 2>, Frame>, Pad<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 2>, ([Element<Across<S, 3, Path<0b011, 1>, Frame>, Pad<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 2>; 2], Element<Turning<Path<0b011, 1>, Path<0b111, 2>>, Spring<S>, 1>));

/// A unit's type: what the mechanism does not have leaves no code.
pub type Unit<S> = System<Bodies<S>, Elements<S>>;

/// Gaps over the production, mean and standard deviation (m).
pub const GAPS: [[f64; 2]; 3] = [
    [0.0024, 5e-5], // beak
    [0.0006, 2e-5], // lower edge
    [0.0006, 2e-5], // upper edge
];

/// The unit of tolerance level `n`.
///
/// # Errors
/// If a gap at that level, or another parameter, is out of bounds.
pub fn unit<S: Scalar + PartialOrd>(n: S) -> Result<Unit<S>, ParameterError<S>> {
    let s = S::from_f64;
    let gap = |[mean, deviation]: [f64; 2], least| GapStatistics { mean: s(mean), deviation: s(deviation) }.checked_at(n, least);
    let gaps = [gap(GAPS[0], -10.0)?, gap(GAPS[1], -10.0)?, gap(GAPS[2], -10.0)?];
    let contact_0 = Contact { normal: Impact::new(ThreeHalves::new(s(10000000.0))?, s(2.0), s(1e-6))?, friction: Regularised::new(s(0.3), s(0.0001))? };
    let contact_1 = Contact { normal: Impact::new(ThreeHalves::new(s(10000000.0))?, s(6.0), s(1e-6))?, friction: Regularised::new(s(0.3), s(0.0001))? };
    let bodies = PlanarTree::of(Joints, [Vector2::new(s(0.0), s(1.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))], &[Rigid { mass: s(0.0003), inertia: s(5e-9), centre: Point { carrier: Chain { turn: Some(1), moves: [true, true, false] }, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] } }, Rigid { mass: s(0.0045), inertia: s(7e-7), centre: Point { carrier: Chain { turn: Some(2), moves: [true, true, true] }, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.01), s(0.0)), Vector2::new(s(0.015000000000000001), s(0.0))] } }], Vector2::new(s(0.0), s(-9.81)))?;
    let elements = (Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.01), s(0.0)), Vector2::new(s(-0.0050999999999999995), s(0.02))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.004900000000000001), s(0.02)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(1.0), s(0.0)) }, law: Pad { gap: gaps[0], contact: contact_0 } }, ([
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0031), s(-0.0058)), Vector2::new(s(0.0), s(0.0))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0031), s(-0.0058)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(1.0), s(0.0)) }, law: Pad { gap: gaps[1], contact: contact_1 } },
        Element { link: Across { point: Point { carrier: Path, base: Vector2::new(s(0.0), s(0.0)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0031), s(0.0058)), Vector2::new(s(0.0), s(0.0))] }, seat: Point { carrier: Path, base: Vector2::new(s(0.0031), s(0.0058)), arms: [Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0)), Vector2::new(s(0.0), s(0.0))] }, normal: Vector2::new(s(1.0), s(0.0)) }, law: Pad { gap: gaps[2], contact: contact_1 } },
    ], Element { link: Turning { body: Path, against: Path }, law: Spring { stiffness: s(0.0056), damping: s(0.0), rest: s(0.0), start: s(0.1752) } }));
    Ok(System::new(bodies, elements))
}

/// Where and how fast the unit starts: pose and generalised velocities.
pub fn start<S: Scalar>() -> ([[S; 2]; 3], SVector<S, 3>) {
    let s = S::from_f64;
    let pose = [[s(0.0), s(0.0)], [s(0.9986586799638738), s(-0.051776837802371814)], [s(0.9902995438375262), s(-0.1389489599643968)]];
    (pose, SVector::from([s(-0.3411), s(0.0), s(-7.4583)]))
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
