// CD-ROM slide: a scene for firmware, to be compiled against slipfit-core. SI units.

use slipfit_core::{
    ParameterError,
    integrator::ImplicitEuler,
    kernel::Kernel,
    law::{Impact, Regularised, ThreeHalves},
    menu::{ContactData, FrictionData},
    scene::SceneData,
    slide::Slide,
};

/// A unit's type: what the scene does not need leaves no code.
pub type Unit = Slide<f32, ThreeHalves<f32>, Regularised<f32>>;

/// The kernel's type.
pub type Predictor = Kernel<f32, Unit, ImplicitEuler<4>>;

/// Step (s).
pub const STEP: f32 = 0.001;

/// What a flash table of this scene is stamped with.
pub const SCENE_HASH: u64 = 0x83f741c20cd1f0bd;

/// The slide over the production.
#[rustfmt::skip]
pub const SCENE: SceneData<f32> = SceneData {
    mass: 0.0818,
    inertia_b: [0.0001543566, 0.00026857667, 0.00011618327],
    gravity_w: [0.0, -9.81, 0.0],
    pins_w: [[-0.062, 0.0, -0.018], [0.062, 0.0, -0.018], [-0.062, 0.0, 0.018], [0.062, 0.0, 0.018]],
    gap_means: [6.4e-6, 0.0004327, -3e-7, 0.0005757, 0.0002049, 0.000776, 2e-7, 0.0005779, -2.23e-5, 0.0004037, -3e-7, 0.0005754, 0.000204, 0.0007776, 2e-7, 0.0005778],
    gap_deviations: [4.04e-5, 2.66e-5, 1.45e-5, 4.65e-5, 5.73e-5, 4.78e-5, 1.48e-5, 4.9e-5, 6.24e-5, 4.88e-5, 1.76e-5, 5.81e-5, 7.67e-5, 6.33e-5, 1.77e-5, 5.79e-5],
    contact: ContactData { stiffness: 3162277.8, exponent: 1.5, damping: 1000.0, depth: 0.0001 },
    friction: FrictionData::Regularised { coefficient: 0.3, stick_band: 0.0001 },
    drive_gain: 40.0,
    drive_ramp: [0.05, 1.0],
    drive_speed: 0.1,
    drive_point_b: [0.0, 0.0, 0.0],
};

/// The kernel of a unit of tolerance level `n`.
///
/// # Errors
/// If a gap at that level, or `n`, is out of bounds.
pub fn predictor(n: f32) -> Result<Predictor, ParameterError<f32>> {
    let unit = SCENE.at(n)?;
    let ContactData { stiffness, damping, depth, .. } = unit.contact;
    let contact = Impact::new(ThreeHalves::new(stiffness)?, damping, depth)?;
    Kernel::new(unit.body.slide(contact, Regularised::new(0.3, 0.0001)?, unit.drive)?, STEP)
}
