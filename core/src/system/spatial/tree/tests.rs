//! Trees in space against closed forms, trees in a plane and free bodies.

use super::{Joint, Mount, SpatialTree};
use crate::{
    SVector, Scalar, Vector2, Vector3,
    integrator::{Integrator, Motion, Rodas4},
    mechanism::Mechanism,
    product::times,
    system::{
        Bodies, System,
        planar::{self, Coordinate, PlanarTree, Point},
        spatial::{FreeBodies, Rigid},
    },
};

/// The motion after `steps` steps of `h` (s) from a pose and a velocity.
fn after<B: Bodies<f64, D>, const D: usize>(
    bodies: B,
    start: (B::Pose, [f64; D]),
    h: f64,
    steps: usize,
    mut look: impl FnMut(f64, &B::Pose, &SVector<f64, D>),
) {
    let system = System::new(bodies, ());
    let mut motion =
        Motion { pose: start.0, velocity: SVector::from(start.1), acceleration: SVector::zeros(), internal: () };
    // An interpreter takes long.
    for step in 0..if cfg!(miri) { 2 } else { steps } {
        motion = Rodas4::step(&system, step as f64 * h, h, &motion).motion;
        motion.pose = system.normalised(&motion.pose);
        look((step + 1) as f64 * h, &motion.pose, &motion.velocity);
    }
}

fn rigid<S: Scalar>(mass: f64, inertia: [f64; 3], centre: [f64; 3]) -> Rigid<S> {
    let vector = |v: [f64; 3]| Vector3::from(v.map(S::from_f64));
    Rigid { mass: S::from_f64(mass), inertia_b: vector(inertia), centre_w: vector(centre) }
}

fn half(angle: f64) -> [f64; 2] {
    [libm::cos(angle / 2.0), libm::sin(angle / 2.0)]
}

#[test]
fn a_crank_with_a_rod_and_a_slider_moves_as_in_its_plane() {
    let gravity = [0.4, -9.81];
    let inertia = |moment| [0.3, 0.2, moment];
    let centres = [[0.2, 0.1], [0.5, 0.05], [0.6, 0.2]];
    let (masses, moments) = ([0.5, 0.8, 0.3], [0.02, 0.03, 0.01]);
    let [pivot, pin, axis] = [[0.05, -0.1], [0.35, 0.1], [0.6, 0.8]].map(Vector2::from);
    let start = ([0.3, -0.4, 0.02], [1.5, -2.0, 0.4]);

    let coordinates = [Coordinate::Turn, Coordinate::Turn, Coordinate::Slide { on: Some(1), axis }];
    let on = |point: Point<f64, 3>, k: usize| point.on(k, &coordinates[k]);
    let crank = on(Point::fixed(pivot), 0);
    let rod = on(crank.plus(pin - pivot), 1);
    let slider = on(rod.plus(Vector2::zeros()), 2);
    let points = [crank.plus(Vector2::from(centres[0]) - pivot), rod.plus(Vector2::from(centres[1]) - pin)];
    let points = [points[0], points[1], slider.plus(Vector2::from(centres[2]) - pin)];
    let bodies: [_; 3] =
        core::array::from_fn(|i| planar::Rigid { mass: masses[i], inertia: moments[i], centre: points[i] });
    let flat = PlanarTree::new(coordinates, &bodies, gravity.into()).unwrap();

    let deep = |v: Vector2<f64>| Vector3::new(v.x, v.y, 0.3);
    let body = |i: usize| rigid(masses[i], inertia(moments[i]), [centres[i][0], centres[i][1], 0.1]);
    let free = FreeBodies::new([body(0), body(1), body(2)], Vector3::new(gravity[0], gravity[1], 0.0)).unwrap();
    let z = Vector3::z();
    let mounts = [
        Mount { body: 0, on: None, joint: Joint::Revolute { at: deep(pivot), axis: z } },
        Mount { body: 1, on: Some(0), joint: Joint::Revolute { at: deep(pin), axis: z } },
        Mount { body: 2, on: Some(1), joint: Joint::Prismatic { axis: Vector3::new(axis.x, axis.y, 0.0) } },
    ];
    let tree = SpatialTree::<f64, 3, 18, 3>::new(free, &mounts).unwrap();

    // Angles in the plane are those in the frame, in space those against the body before.
    let [[a, b, s], [da, db, ds]] = [start.0, start.1];
    let (mut places, mut worst) = ([[Vector2::zeros(); 2]; 3000], 0.0f64);
    let mut k = 0;
    after(flat, (flat.pose([a, a + b, s], half), [da, da + db, ds]), 1e-3, 3000, |_, pose, velocity| {
        places[k] = flat.motion_of(&points[2], &flat.placed(pose, velocity));
        k += 1;
    });
    k = 0;
    after(tree, (tree.pose(start.0, half), start.1), 1e-3, 3000, |_, pose, velocity| {
        let slider = tree.placed(pose, velocity).free.body(2);
        let [place, rate] = places[k];
        let moved = place - Vector2::from(centres[2]);
        let misses = [moved - slider.displacement_w.xy(), rate - slider.velocity_w.xy()];
        worst = misses.iter().fold(worst, |worst, miss| worst.max(miss.norm()));
        k += 1;
    });
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn a_top_precesses_steadily() {
    let (mass, length, tilt, across, along, g) = (0.2, 0.06, 0.5, 8e-4, 3e-4, 9.81);
    // I₁·Ω²·cos θ − I₃·ω₃·Ω + m·g·l = 0 with the spin ω₃ about the top's axis.
    let precession = 1.7;
    let spin = (across * precession * precession * libm::cos(tilt) + mass * g * length) / (along * precession);
    let about_point = across - mass * length * length;
    let body = rigid(mass, [about_point, along, about_point], [0.0, length, 0.0]);
    let free = FreeBodies::new([body], Vector3::new(0.0, -g, 0.0)).unwrap();
    let mounts = [Mount { body: 0, on: None, joint: Joint::Spherical { at: Vector3::zeros() } }];
    let tree = SpatialTree::<f64, 1, 6, 3>::new(free, &mounts).unwrap();
    // Tilted about z; the precession about y seen from the top, and the rest of its spin.
    let [cos, sin] = [libm::cos(tilt), libm::sin(tilt)];
    let start = (tree.pose([0.0, 0.0, tilt], half), [precession * sin, spin, 0.0]);
    assert!(libm::fabs(spin - precession * cos) > 100.0, "it spins fast");
    let mut worst = 0.0f64;
    after(tree, start, 2e-4, 5_000, |t, pose, velocity| {
        let axis = times(&tree.placed(pose, velocity).free.body(0).to_frame, &Vector3::y());
        let turned = precession * t;
        let expected = Vector3::new(-sin * libm::cos(turned), cos, sin * libm::sin(turned));
        worst = worst.max((axis - expected).norm());
    });
    assert!(worst < 2e-8, "{worst:e}");
}

#[test]
fn what_nothing_holds_is_a_free_body() {
    let body = rigid(0.4, [0.02, 0.03, 0.04], [0.1, 0.2, -0.3]);
    let free = FreeBodies::<f64, 1, 6>::new([body], Vector3::new(0.0, -9.81, 1.0)).unwrap();
    let tree = SpatialTree::<f64, 1, 6, 6>::new(free, &[Mount { body: 0, on: None, joint: Joint::Free }]).unwrap();
    let start = [0.3, -0.2, 0.1, 3.0, -2.0, 1.0];
    let mut last = None;
    after(free, (free.nominal(), start), 1e-3, 500, |_, pose, velocity| last = Some((pose[0], *velocity)));
    let mut found = None;
    after(tree, (tree.nominal(), start), 1e-3, 500, |_, pose, velocity| found = Some((*pose, *velocity)));
    let (Some((pose, velocity)), Some((of_tree, velocity_of_tree))) = (last, found) else { panic!("steps") };
    assert!((velocity - velocity_of_tree).norm() < 1e-10);
    let q = pose.orientation;
    let r = pose.displacement_w;
    let expected = [r.x, 0.0, r.y, 0.0, r.z, 0.0, q.w, q.v.x, q.v.y, q.v.z, 0.0, 0.0];
    let miss = of_tree.as_flattened().iter().zip(expected).map(|(a, b)| libm::fabs(a - b));
    assert!(miss.fold(0.0, f64::max) < 1e-10);
}

/// A free body, a flap on it, and a cylinder on the flap that carries nothing.
fn chain<S: Scalar + PartialOrd>() -> (SpatialTree<S, 3, 18, 9>, [Vector3<S>; 2], [Vector3<S>; 2]) {
    let vector = |v: [f64; 3]| Vector3::from(v.map(S::from_f64));
    let inertia = [0.02, 0.03, 0.025];
    let bodies = [[0.0; 3], [0.2, 0.1, 0.0], [0.3, 0.2, 0.2]].map(|centre| rigid(0.5, inertia, centre));
    let free = FreeBodies::new(bodies, vector([0.0, -9.81, 0.0])).unwrap();
    let (places, axes) =
        ([[0.1, 0.0, 0.05], [0.3, 0.1, 0.1]].map(vector), [[0.48, 0.6, 0.64], [0.0, 0.8, 0.6]].map(vector));
    let mounts = [
        Mount { body: 0, on: None, joint: Joint::Free },
        Mount { body: 1, on: Some(0), joint: Joint::Revolute { at: places[0], axis: axes[0] } },
        Mount { body: 2, on: Some(1), joint: Joint::Cylindrical { at: places[1], axis: axes[1] } },
    ];
    (SpatialTree::new(free, &mounts).unwrap(), places, axes)
}

/// By how much the joints of [`chain`] come apart (m) and lean (rad) at the worst.
fn apart<S: Scalar + PartialOrd>(
    (tree, places, axes): &(SpatialTree<S, 3, 18, 9>, [Vector3<S>; 2], [Vector3<S>; 2]),
    pose: &[[S; 2]; 9],
    velocity: &SVector<S, 9>,
) -> S {
    let placed = tree.placed(pose, velocity);
    let mut worst = S::zero();
    for (i, (place, axis)) in places.iter().zip(axes).enumerate() {
        let [one, other] = [i, i + 1].map(|body| {
            let (at, centre) = (placed.free.body(body), tree.free_bodies().bodies()[body].centre_w);
            (centre + at.displacement_w + times(&at.to_frame, &(place - centre)), times(&at.to_frame, axis))
        });
        let gap = other.0 - one.0;
        // The second slides along its axis.
        let along = if i == 1 { one.1 * gap.dot(&one.1) } else { Vector3::zeros() };
        let (gap, lean) = (gap - along, other.1 - one.1);
        worst = worst.max_of(gap.dot(&gap).sqrt()).max_of(lean.dot(&lean).sqrt());
    }
    worst
}

#[test]
fn joints_hold_and_energy_stays() {
    let of = chain::<f64>();
    let tree = of.0;
    let start = [0.2, 0.1, -0.3, 1.0, 2.0, -1.5, 3.0, 0.4, -2.0];
    let energy = |pose: &[[f64; 2]; 9], velocity: &SVector<f64, 9>| {
        let placed = tree.placed(pose, velocity);
        let bodies = tree.free_bodies().bodies().iter().zip(&placed.free.bodies);
        let lifted: f64 = bodies.map(|(body, at)| body.mass * 9.81 * at.displacement_w.y).sum();
        0.5 * velocity.dot(&(tree.mass(&placed) * velocity)) + lifted
    };
    let at_start = energy(&tree.nominal(), &SVector::from(start));
    let (mut worst, mut drift) = (0.0f64, 0.0f64);
    after(tree, (tree.nominal(), start), 1e-3, 2000, |_, pose, velocity| {
        worst = worst.max(apart(&of, pose, velocity));
        drift = drift.max(libm::fabs(energy(pose, velocity) / at_start - 1.0));
    });
    assert!(worst < 1e-12, "{worst:e}");
    assert!(drift < 1e-8, "{drift:e}");
}

#[test]
fn joints_hold_to_rounding_in_single_precision() {
    let of = chain::<f32>();
    let system = System::new(of.0, ());
    let start: [f32; 9] = [0.2, 0.1, -0.3, 1.0, 2.0, -1.5, 3.0, 0.4, -2.0];
    let (mut pose, mut velocity) = (of.0.nominal(), SVector::from(start));
    for _ in 0..if cfg!(miri) { 2 } else { 100_000 } {
        pose = system.normalised(&system.implicit_update(&pose, &velocity, 1e-3));
        // It turns on and on without sliding away.
        velocity[0] = -velocity[0];
        velocity[1] = -velocity[1];
        velocity[2] = -velocity[2];
        velocity[7] = -velocity[7];
        let apart = apart(&of, &pose, &velocity);
        assert!(apart < 5e-7, "{apart:e}");
    }
}

#[test]
fn refuses_what_is_no_tree() {
    let body = rigid(0.5, [0.02, 0.03, 0.025], [0.0; 3]);
    let free = FreeBodies::<f64, 2, 12>::new([body; 2], Vector3::zeros()).unwrap();
    let (at, axis) = (Vector3::zeros(), Vector3::z());
    let hinge = Joint::Revolute { at, axis };
    let refused = |mounts: &[Mount<f64>]| SpatialTree::<f64, 2, 12, 7>::new(free, mounts).unwrap_err().parameter;
    let mount = |body, on, joint| Mount { body, on, joint };
    assert_eq!(refused(&[]), "mounts");
    assert_eq!(refused(&[mount(0, Some(1), hinge), mount(1, None, hinge)]), "on");
    assert_eq!(refused(&[mount(0, Some(0), hinge)]), "on");
    assert_eq!(refused(&[mount(0, None, hinge), mount(0, None, hinge)]), "body");
    assert_eq!(refused(&[mount(2, None, hinge)]), "body");
    assert_eq!(refused(&[mount(0, None, Joint::Free), mount(1, None, Joint::Free)]), "coordinates");
    assert_eq!(refused(&[mount(0, None, Joint::Prismatic { axis: Vector3::new(0.0, 0.0, 2.0) })]), "axis");
    assert_eq!(refused(&[mount(0, None, Joint::Spherical { at: axis * f64::NAN })]), "at");
    // What moves as one counts as one, and what stands still does not.
    let as_one = [mount(0, None, hinge), mount(1, Some(0), Joint::Fixed)];
    assert_eq!(SpatialTree::<f64, 2, 12, 1>::new(free, &as_one).unwrap().least_mass(), 1.0);
    let held = [mount(0, None, Joint::Fixed), mount(1, Some(0), hinge)];
    assert_eq!(SpatialTree::<f64, 2, 12, 1>::new(free, &held).unwrap().least_mass(), 0.5);
}

/// The change of the place of a turning body by its turn belongs to the derivatives.
#[test]
#[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
fn errors_fall_with_the_fourth_power_where_bodies_turn() {
    let body = rigid(0.4, [0.02, 0.03, 0.04], [0.1, 0.2, -0.3]);
    let free = FreeBodies::<f64, 1, 6>::new([body], Vector3::new(0.0, -9.81, 1.0)).unwrap();
    let mounts = [Mount { body: 0, on: None, joint: Joint::Spherical { at: Vector3::zeros() } }];
    let ball = SpatialTree::<f64, 1, 6, 3>::new(free, &mounts).unwrap();
    let ends = [50, 100, 200].map(|steps| {
        let h = 1.0 / steps as f64;
        let mut end = [0.0; 2];
        let start = (free.nominal(), [0.0, 0.0, 0.0, 3.0, -2.0, 1.0]);
        after(free, start, h, steps, |_, pose, velocity| end[0] = pose[0].orientation.v.x + velocity[3]);
        after(ball, (ball.nominal(), [1.0, -2.0, 3.0]), h, steps, |_, pose, velocity| {
            end[1] = pose[0][1] + velocity[0]
        });
        end
    });
    let [coarse, middle, fine] = ends.map(SVector::<f64, 2>::from);
    for order in (middle - coarse).component_div(&(fine - middle)).iter().map(|ratio| libm::log2(*ratio)) {
        assert!((3.7..5.0).contains(&order), "{order}");
    }
}
