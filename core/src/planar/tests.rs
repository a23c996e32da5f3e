//! Against the slide, held in the plane by having nothing above and below.

use nalgebra::Vector2;

use super::{Across, Joint, Journal, Planar, PlanarBody, PlanarPose};
use crate::{
    SVector, Vector3,
    drive::Drive,
    integrator::{Extrapolated, ImplicitEuler, Integrator, Rodas3},
    kernel::Kernel,
    law::{Exact, Friction, Frictionless, Impact, Regularised, Slot, ThreeHalves},
    mechanism::Mechanism,
    pose::Pose,
    slide::{ABSENT, Body, Slide},
};

type Contact = Impact<f64, ThreeHalves<f64>>;
type Flat<F> = Planar<f64, Across<Slot<f64>>, ThreeHalves<f64>, F, 4>;

const GAPS: [[f64; 2]; 4] = [[1e-5, -2e-5], [2e-4, 1e-4], [-1e-5, 1e-5], [3e-5, 2e-4]];
const PINS: [[f64; 2]; 4] = [[-0.062, -0.018], [0.062, -0.018], [-0.062, 0.018], [0.062, 0.018]];

fn both<F: Friction<f64>>(friction: F) -> (Slide<f64, ThreeHalves<f64>, F>, Flat<F>) {
    let contact: Contact = Impact::new(ThreeHalves::new(3e6).unwrap(), 1000.0, 1e-4).unwrap();
    let drive =
        Drive { gain: 40.0, ramp_start: 0.0, ramp_end: 0.1, speed: 0.1, point_b: Vector3::new(0.03, 0.0, -0.01) };
    let mut gaps = [ABSENT; 16];
    for ([left, right, ..], gap) in gaps.as_chunks_mut::<4>().0.iter_mut().zip(GAPS) {
        [*left, *right] = gap;
    }
    let body = Body {
        mass: 0.08,
        inertia_b: Vector3::new(1.0, 3e-4, 1.0),
        gravity_w: Vector3::new(2.0, 0.0, 0.5),
        pins_w: PINS.map(|[x, z]| Vector3::new(x, 0.0, z)),
        gaps,
    };
    let flat = PlanarBody {
        mass: 0.08,
        inertia: 3e-4,
        gravity_w: Vector2::new(2.0, 0.5),
        pins_w: PINS.map(Vector2::from),
        joints: GAPS.map(|[lower, upper]| Across(Slot::new(lower, upper).unwrap())),
    };
    (Slide::new(body, contact, friction, drive).unwrap(), Planar::new(flat, contact, friction, drive).unwrap())
}

fn agrees<F: Friction<f64>, I: Integrator>(friction: F, step: f64) {
    let (slide, flat) = both(friction);
    let slide = Kernel::<f64, _, I>::new(slide, step).unwrap();
    let flat = Kernel::<f64, _, I>::new(flat, step).unwrap();
    let (mut a, mut b) = (slide.at_rest::<6>(Pose::nominal()), flat.at_rest::<3>(PlanarPose::nominal()));
    // An interpreter that looks for undefined behaviour has no time for a whole motion.
    for _ in 0..if cfg!(miri) { 2 } else { 2000 } {
        slide.step(&mut a);
        flat.step(&mut b);
        let (v, w) = (a.motion.velocity, b.motion.velocity);
        let miss = [v.x - w.x, v.z - w.y, v[4] - w.z, a.motion.pose.orientation.v.y - b.motion.pose.half_turn[1]];
        assert!(miss.iter().all(|miss| libm::fabs(*miss) < 1e-8), "{miss:?} at {}", a.steps);
    }
    let turned = libm::fabs(b.motion.pose.half_turn[1]);
    assert!(cfg!(miri) || turned > 1e-5 && b.motion.velocity.y > 0.01, "it turns and moves: {turned}");
}

#[test]
fn moves_as_the_slide_in_its_plane() {
    // So many passes that both converge: what they leave depends on how the angle is linearised.
    agrees::<_, ImplicitEuler<6>>(Frictionless, 1e-4);
    agrees::<_, Extrapolated<2, 4>>(Regularised::new(0.1, 1e-4).unwrap(), 1e-4);
    agrees::<_, ImplicitEuler<6>>(Exact::new(0.1).unwrap(), 1e-4);
    agrees::<_, Rodas3>(Regularised::new(0.1, 1e-3).unwrap(), 2e-5);
}

#[test]
fn slopes_are_derivatives() {
    let friction = Regularised::new(0.3, 1e-2).unwrap();
    let (_, flat) = both(friction);
    let nominal = PlanarPose { displacement_w: Vector2::new(2e-5, 0.01), half_turn: [1.0, 2e-4] };
    slopes(flat, nominal);

    let Planar { body, contact, drive, .. } = flat;
    let PlanarBody { mass, inertia, gravity_w, pins_w, .. } = body;
    let joints = [1e-5, 2e-5, 3e-5, 4e-5].map(|clearance| Journal::new(clearance, 5e-3).unwrap());
    let swing = PlanarBody { mass, inertia, gravity_w, pins_w, joints };
    let off = PlanarPose { displacement_w: Vector2::new(4e-5, -3e-5), ..nominal };
    slopes(Planar::new(swing, contact, friction, drive).unwrap(), off);
}

fn slopes<C: Joint<f64>, F: Friction<f64, Memory = ()>>(
    flat: Planar<f64, C, ThreeHalves<f64>, F, 4>,
    nominal: PlanarPose<f64>,
) {
    let velocity = SVector::<f64, 3>::new(0.01, 0.005, 0.3);
    let force = |pose: &PlanarPose<f64>, v: &SVector<f64, 3>| flat.forces(0.05, pose, &[(); 4], v, 1e-3, None);
    let slopes = flat.differentiated(0.05, &nominal, &[(); 4], &velocity).slopes;
    let solve = flat.linearisation(&slopes, 1e-3);
    for axis in 0..3 {
        let mut displacement = SVector::<f64, 3>::zeros();
        displacement[axis] = 1e-9;
        let moved = |sign: f64| flat.moved(&nominal, &(displacement * sign), 1.0);
        let change = (force(&moved(1.0), &velocity) - force(&moved(-1.0), &velocity)) / 2.0;
        let found = flat.pushed(&slopes, &displacement);
        assert!((found - change).norm() <= 1e-5 * (1e-9 + change.norm()), "{axis}: {found} {change}");

        // The linearised balance is M/a − ∂force/∂V with the pose moved over a.
        let balance = |sign: f64| {
            let v = velocity + displacement * sign;
            flat.momentum(&nominal, &v) / 1e-3 - force(&flat.moved(&nominal, &(displacement * (sign * 1e-3)), 1.0), &v)
        };
        let back = flat.solve(&solve, &((balance(1.0) - balance(-1.0)) / 2.0));
        assert!((back - displacement).norm() <= 1e-5 * 1e-9, "{axis}: {back}");
    }
}

#[test]
fn refuses_what_it_cannot_step() {
    let (_, flat) = both(Frictionless);
    let Planar { body, contact, friction, drive, .. } = flat;
    for body in [PlanarBody { mass: 0.0, ..body }, PlanarBody { inertia: f64::NAN, ..body }] {
        assert!(Planar::new(body, contact, friction, drive).is_err());
    }
    assert!(Planar::new(body, contact, friction, Drive { gain: -1.0, ..drive }).is_err());
}
