//! The paper's CD-ROM slide (Tables 1 and 2), SI units.
//!
//! ```
//! use slipfit_core::{integrator::ImplicitEuler, kernel::Kernel, pose::Pose};
//!
//! let slide = slipfit_problems::cd_rom::slide(2.5f32);
//! let kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(slide, 1e-3)?; // parameters
//! let mut state = kernel.at_rest(Pose::nominal()); // state
//! for _ in 0..200 {
//!     let report = kernel.step(&mut state);
//!     assert!(report.residual < 1e-3, "N·s");
//! }
//! let force = kernel.mechanism().drive().force(kernel.time(state.steps), state.motion.velocity[2]);
//! assert!((force - 0.24).abs() < 1e-3, "N");
//! # Ok::<(), slipfit_core::ParameterError<f32>>(())
//! ```

use slipfit_core::{
    ParameterError, Scalar, Vector3,
    clearance::GapStatistics,
    drive::Drive,
    law::{Friction, Impact, Regularised, ThreeHalves},
    menu::{ContactData, FrictionData, SlideData},
    slide::{Body, CONTACTS, Slide, box_inertia},
};

/// The slide's type: progressive contact with exponent 3/2, regularised friction.
pub type CdRomSlide<S> = Slide<S, ThreeHalves<S>, Regularised<S>>;

/// Table 2: mean and standard deviation (mm) of the left, right, rail and wall gap of the pins left back, right back,
/// left front, right front.
pub const TABLE_2: [[f64; 2]; CONTACTS] = [
    [0.0064, 0.0404],
    [0.4327, 0.0266],
    [-0.0003, 0.0145],
    [0.5757, 0.0465],
    [0.2049, 0.0573],
    [0.7760, 0.0478],
    [0.0002, 0.0148],
    [0.5779, 0.0490],
    [-0.0223, 0.0624],
    [0.4037, 0.0488],
    [-0.0003, 0.0176],
    [0.5754, 0.0581],
    [0.2040, 0.0767],
    [0.7776, 0.0633],
    [0.0002, 0.0177],
    [0.5778, 0.0579],
];

/// Stick band of the reference runs (m/s).
pub const STICK_BAND: f64 = 1e-4;

/// End of the ramp as printed (s); the fast opening has 0.1.
pub const RAMP_END: f64 = 1.0;

/// The slide at tolerance level `n`.
pub fn data<S: Scalar>(n: S) -> SlideData<S> {
    let s = S::from_f64;
    let mm = |x: f64| s(x / 1000.0);
    let vector = |x, y, z| Vector3::new(s(x), s(y), s(z));
    let mass = 81.8 / 1000.0;
    let inertia = box_inertia(mass, [0.13, 0.012, 0.15]);
    SlideData {
        body: Body {
            mass: s(mass),
            inertia_b: vector(inertia.x, inertia.y, inertia.z),
            gravity_w: vector(0.0, -9.81, 0.0),
            pins_w: [
                vector(-0.062, 0.0, -0.018),
                vector(0.062, 0.0, -0.018),
                vector(-0.062, 0.0, 0.018),
                vector(0.062, 0.0, 0.018),
            ],
            gaps: TABLE_2.map(|[mean, deviation]| GapStatistics { mean: mm(mean), deviation: mm(deviation) }.at(n)),
        },
        contact: ContactData { stiffness: s(STIFFNESS), exponent: s(1.5), damping: s(1000.0), depth: s(1e-4) },
        friction: FrictionData::Regularised { coefficient: s(0.3), stick_band: s(STICK_BAND) },
        drive: Drive {
            gain: s(40.0),
            ramp_start: s(0.05),
            ramp_end: s(RAMP_END),
            speed: s(0.1),
            point_b: Vector3::zeros(),
        },
    }
}

/// 100 N/mm^1.5 in N/m^1.5: 100·1000^1.5.
pub const STIFFNESS: f64 = 3_162_277.660_168_379_5;

/// The slide at tolerance level `n` as a mechanism.
pub fn slide<S: Scalar + PartialOrd>(n: S) -> CdRomSlide<S> {
    from_data(&data(n))
}

/// A slide of this type from `data`.
///
/// # Panics
/// If the data is out of bounds, asks for another exponent or for another friction law.
pub fn from_data<S: Scalar + PartialOrd>(data: &SlideData<S>) -> CdRomSlide<S> {
    let FrictionData::Regularised { coefficient, stick_band } = data.friction else {
        panic!("the CD-ROM slide has regularised friction")
    };
    with_friction(data, built(Regularised::new(coefficient, stick_band)))
}

/// A slide from `data` with another friction law.
///
/// # Panics
/// If the data is out of bounds or asks for another exponent.
pub fn with_friction<S: Scalar + PartialOrd, F: Friction<S>>(
    data: &SlideData<S>,
    friction: F,
) -> Slide<S, ThreeHalves<S>, F> {
    let ContactData { stiffness, damping, depth, .. } = data.contact;
    let contact = built(Impact::new(built(ThreeHalves::new(stiffness)), damping, depth));
    built(data.body.slide(contact, friction, data.drive))
}

fn built<T, S>(result: Result<T, ParameterError<S>>) -> T {
    match result {
        Ok(built) => built,
        Err(error) => panic!("{} out of bounds", error.parameter),
    }
}
