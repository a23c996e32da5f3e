// Telescopic drawer: a mechanism for firmware, to be compiled against slipfit-core. SI units.

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
        law::{Axis, Contact, Pin, Pusher, Wall},
        spatial::{Along, FreeBodies, Port, Rigid, Seat},
    },
};

/// Number of coordinates.
pub const DIMENSION: usize = 12;

/// Step (s).
pub const STEP: f32 = 0.00025;

/// Steps of the scene's run.
pub const STEPS: u32 = 2800;

/// The scheme.
pub type Scheme = Extrapolated<2, 4>;

/// What a flash table of this mechanism is stamped with: it must be equal before a lookup is trusted.
pub const SCENE_HASH: u64 = 0x556eba4d39ee768d;

/// The bodies.
pub type Bodies<S> = FreeBodies<S, 2, 12>;

/// What acts on them.
pub type Elements<S> = ([Element<Seat<S>, Pin<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 3>; 8], ([Element<Seat<S>, Wall<S, Impact<S, ThreeHalves<S>>, Regularised<S>>, 3>; 4], Element<Along<S>, Pusher<Drive<S>>, 2>));

/// A unit's type: what the mechanism does not have leaves no code.
pub type Unit<S> = System<Bodies<S>, Elements<S>>;

/// Gaps over the production, mean and standard deviation (m).
pub const GAPS: [[f64; 2]; 36] = [
    [0.0001, 2e-5], // outer left back left
    [0.0004, 2e-5], // outer left back right
    [5e-5, 1e-5], // outer left back rail
    [0.0004, 2e-5], // outer left back wall
    [0.0001, 2e-5], // outer right back left
    [0.0004, 2e-5], // outer right back right
    [5e-5, 1e-5], // outer right back rail
    [0.0004, 2e-5], // outer right back wall
    [0.0001, 2e-5], // outer left front left
    [0.0004, 2e-5], // outer left front right
    [5e-5, 1e-5], // outer left front rail
    [0.0004, 2e-5], // outer left front wall
    [0.0001, 2e-5], // outer right front left
    [0.0004, 2e-5], // outer right front right
    [5e-5, 1e-5], // outer right front rail
    [0.0004, 2e-5], // outer right front wall
    [5e-5, 2e-5], // inner left back left
    [0.0003, 2e-5], // inner left back right
    [5e-5, 1e-5], // inner left back rail
    [0.0003, 2e-5], // inner left back wall
    [5e-5, 2e-5], // inner right back left
    [0.0003, 2e-5], // inner right back right
    [5e-5, 1e-5], // inner right back rail
    [0.0003, 2e-5], // inner right back wall
    [5e-5, 2e-5], // inner left front left
    [0.0003, 2e-5], // inner left front right
    [5e-5, 1e-5], // inner left front rail
    [0.0003, 2e-5], // inner left front wall
    [5e-5, 2e-5], // inner right front left
    [0.0003, 2e-5], // inner right front right
    [5e-5, 1e-5], // inner right front rail
    [0.0003, 2e-5], // inner right front wall
    [0.03, 0.0001], // outer stop left
    [0.03, 0.0001], // outer stop right
    [0.04, 0.0001], // inner stop left
    [0.04, 0.0001], // inner stop right
];

/// The unit of tolerance level `n`.
///
/// # Errors
/// If a gap at that level, or another parameter, is out of bounds.
pub fn unit<S: Scalar + PartialOrd>(n: S) -> Result<Unit<S>, ParameterError<S>> {
    let s = S::from_f64;
    let gap = |[mean, deviation]: [f64; 2], least| GapStatistics { mean: s(mean), deviation: s(deviation) }.checked_at(n, least);
    let gaps = [gap(GAPS[0], -0.1)?, gap(GAPS[1], -0.1)?, gap(GAPS[2], -0.1)?, gap(GAPS[3], -0.1)?, gap(GAPS[4], -0.1)?, gap(GAPS[5], -0.1)?, gap(GAPS[6], -0.1)?, gap(GAPS[7], -0.1)?, gap(GAPS[8], -0.1)?, gap(GAPS[9], -0.1)?, gap(GAPS[10], -0.1)?, gap(GAPS[11], -0.1)?, gap(GAPS[12], -0.1)?, gap(GAPS[13], -0.1)?, gap(GAPS[14], -0.1)?, gap(GAPS[15], -0.1)?, gap(GAPS[16], -0.1)?, gap(GAPS[17], -0.1)?, gap(GAPS[18], -0.1)?, gap(GAPS[19], -0.1)?, gap(GAPS[20], -0.1)?, gap(GAPS[21], -0.1)?, gap(GAPS[22], -0.1)?, gap(GAPS[23], -0.1)?, gap(GAPS[24], -0.1)?, gap(GAPS[25], -0.1)?, gap(GAPS[26], -0.1)?, gap(GAPS[27], -0.1)?, gap(GAPS[28], -0.1)?, gap(GAPS[29], -0.1)?, gap(GAPS[30], -0.1)?, gap(GAPS[31], -0.1)?, gap(GAPS[32], -10.0)?, gap(GAPS[33], -10.0)?, gap(GAPS[34], -10.0)?, gap(GAPS[35], -10.0)?];
    let contact_0 = Contact { normal: Impact::new(ThreeHalves::new(s(10000000.0))?, s(300.0), s(5e-5))?, friction: Regularised::new(s(0.2), s(0.001))? };
    let bodies = FreeBodies::new([Rigid { mass: s(0.15), inertia_b: Vector3::new(s(0.0002), s(0.0004), s(0.00025)), centre_w: Vector3::new(s(0.0), s(0.0), s(0.0)) }, Rigid { mass: s(0.4), inertia_b: Vector3::new(s(0.0008), s(0.0016), s(0.0009)), centre_w: Vector3::new(s(0.0), s(0.012), s(0.0)) }], Vector3::new(s(0.0), s(-9.81), s(0.0)))?;
    let elements = ([
        Element { link: Seat { point: Port { body: None, lever: Vector3::new(s(-0.062), s(0.0), s(-0.025)) }, from: Some(0) }, law: Pin { gaps: [gaps[0], gaps[1], gaps[2], gaps[3]], contact: contact_0 } },
        Element { link: Seat { point: Port { body: None, lever: Vector3::new(s(0.062), s(0.0), s(-0.025)) }, from: Some(0) }, law: Pin { gaps: [gaps[4], gaps[5], gaps[6], gaps[7]], contact: contact_0 } },
        Element { link: Seat { point: Port { body: None, lever: Vector3::new(s(-0.062), s(0.0), s(0.025)) }, from: Some(0) }, law: Pin { gaps: [gaps[8], gaps[9], gaps[10], gaps[11]], contact: contact_0 } },
        Element { link: Seat { point: Port { body: None, lever: Vector3::new(s(0.062), s(0.0), s(0.025)) }, from: Some(0) }, law: Pin { gaps: [gaps[12], gaps[13], gaps[14], gaps[15]], contact: contact_0 } },
        Element { link: Seat { point: Port { body: Some(0), lever: Vector3::new(s(-0.05), s(0.012), s(-0.03)) }, from: Some(1) }, law: Pin { gaps: [gaps[16], gaps[17], gaps[18], gaps[19]], contact: contact_0 } },
        Element { link: Seat { point: Port { body: Some(0), lever: Vector3::new(s(0.05), s(0.012), s(-0.03)) }, from: Some(1) }, law: Pin { gaps: [gaps[20], gaps[21], gaps[22], gaps[23]], contact: contact_0 } },
        Element { link: Seat { point: Port { body: Some(0), lever: Vector3::new(s(-0.05), s(0.012), s(0.03)) }, from: Some(1) }, law: Pin { gaps: [gaps[24], gaps[25], gaps[26], gaps[27]], contact: contact_0 } },
        Element { link: Seat { point: Port { body: Some(0), lever: Vector3::new(s(0.05), s(0.012), s(0.03)) }, from: Some(1) }, law: Pin { gaps: [gaps[28], gaps[29], gaps[30], gaps[31]], contact: contact_0 } },
    ], ([
        Element { link: Seat { point: Port { body: Some(0), lever: Vector3::new(s(-0.04), s(0.004), s(0.0)) }, from: None }, law: Wall { axis: Axis::Z, sign: s(-1.0), gap: gaps[32], contact: contact_0 } },
        Element { link: Seat { point: Port { body: Some(0), lever: Vector3::new(s(0.04), s(0.004), s(0.0)) }, from: None }, law: Wall { axis: Axis::Z, sign: s(-1.0), gap: gaps[33], contact: contact_0 } },
        Element { link: Seat { point: Port { body: Some(1), lever: Vector3::new(s(-0.04), s(0.004), s(0.0)) }, from: Some(0) }, law: Wall { axis: Axis::Z, sign: s(-1.0), gap: gaps[34], contact: contact_0 } },
        Element { link: Seat { point: Port { body: Some(1), lever: Vector3::new(s(0.04), s(0.004), s(0.0)) }, from: Some(0) }, law: Wall { axis: Axis::Z, sign: s(-1.0), gap: gaps[35], contact: contact_0 } },
    ], Element { link: Along { body: 1, lever: Vector3::new(s(0.01), s(0.0), s(0.05)), axis_w: Vector3::new(s(0.0), s(0.0), s(1.0)) }, law: Pusher(Drive { gain: s(60.0), ramp_start: s(0.05), ramp_end: s(0.25), speed: s(0.2), point_b: Vector3::new(s(0.01), s(0.0), s(0.05)) }.checked()?) }));
    Ok(System::new(bodies, elements))
}

/// Where and how fast the unit starts: pose and generalised velocities.
pub fn start<S: Scalar>() -> ([Pose<S>; 2], SVector<S, 12>) {
    let s = S::from_f64;
    let pose = [Pose::nominal(); 2];
    (pose, SVector::from([s(0.0), s(0.0), s(0.0), s(0.0), s(0.0), s(0.0), s(0.0), s(0.0), s(0.0), s(0.0), s(0.0), s(0.0)]))
}

/// A kernel and the state that it steps.
pub type Predictor = (Kernel<f32, Unit<f32>, Scheme>, StateOf<f32, Unit<f32>, 12>);

/// The state of a unit's `kernel` at the start.
pub fn at_start(kernel: &Kernel<f32, Unit<f32>, Scheme>) -> StateOf<f32, Unit<f32>, 12> {
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
pub fn drive_motor<S: Scalar>(unit: &Unit<S>, t: S, pose: &[Pose<S>; 2], velocity: &SVector<S, DIMENSION>) -> Driving<S> {
    unit.driving(&unit.elements().1.1, t, pose, velocity)
}

/// From now on the commanded speed (m/s) of the drive "motor" is `speed`, in place of the scene's, until another one is set.
pub fn command_motor<S: Scalar>(unit: &mut Unit<S>, speed: S) {
    slipfit_core::drive::Commandable::set_command(&mut unit.elements_mut().1.1.law.0, speed);
}
