//! Derivatives against differences, for every link and law.

use super::{
    Axes, Bodies, Displacement, Element, Elements, Jacobian, Law, OnAxis, System, ThroughJoints,
    law::{
        Axis, Contact, Contour, Contoured, Journal, LineSpring, Motor, Pad, Pin, Pusher, Ring, Slot, Spring, Stopped,
        Wall,
    },
    planar::{self, PlanarTree, example::Linkage},
    spatial::{
        self, FreeBodies, Port, Rim, Seat,
        tree::{Joint, Mount, SpatialTree},
    },
};
use crate::{
    SVector, Vector2, Vector3,
    drive::Drive,
    law::{self, Frictionless, Impact, Regularised, ThreeHalves},
    mechanism::{Mechanism, Way},
};

type Touching = Contact<Impact<f64, ThreeHalves<f64>>, Regularised<f64>>;

fn contact() -> Touching {
    Contact {
        normal: Impact::new(ThreeHalves::new(3e4).unwrap(), 20.0, 0.01).unwrap(),
        friction: Regularised::new(0.4, 0.05).unwrap(),
    }
}

fn drive() -> Drive<f64> {
    Drive { gain: 3.0, ramp_start: 0.0, ramp_end: 1.0, speed: 0.7, point_b: Vector3::zeros() }
}

/// Numbers in −½…½.
fn numbers() -> impl FnMut() -> f64 {
    let mut seed = 7u32;
    move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed) / 4_294_967_296.0 - 0.5
    }
}

/// Compares `differentiated` with differences at random motions, of which some have the elements touch.
fn check<B: Bodies<f64, D>, E: Elements<f64, B, D>, const D: usize>(
    system: &System<B, E>,
    start: B::Pose,
    scale: f64,
    touches: impl Fn(&SVector<f64, D>) -> bool,
) {
    let mut next = numbers();
    let (t, h, internal) = (0.3, 1e-6, system.fresh());
    let mut touched = 0;
    // An interpreter takes long.
    for _ in 0..if cfg!(miri) { 1 } else { 100 } {
        let at = SVector::<f64, D>::from_fn(|_, _| next() * scale);
        let v = SVector::<f64, D>::from_fn(|_, _| next());
        let pose = system.normalised(&system.explicit_update(&start, &at, 1.0));
        let found = system.differentiated(t, &pose, &internal, &v);
        let acceleration = system.velocity(&pose, &found.force);
        let residual = |t: f64, turn: &SVector<f64, D>, v: &SVector<f64, D>| {
            let there = system.explicit_update(&pose, turn, 1.0);
            system.forces(t, &there, &internal, v, 1.0, None) - system.momentum(&there, &acceleration)
        };
        let zero = SVector::zeros();
        touched += u32::from(touches(&found.force));
        let close = |found: SVector<f64, D>, expected: SVector<f64, D>, what: &str| {
            let size = 1.0 + found.norm() + expected.norm();
            assert!((found - expected).norm() < 2e-5 * size, "{what}: {found} {expected}");
        };
        close(found.per_time, (residual(t + h, &zero, &v) - residual(t - h, &zero, &v)) / (2.0 * h), "time");
        for k in 0..D {
            let mut step = zero;
            step[k] = h;
            let by_place = (residual(t, &step, &v) - residual(t, &-step, &v)) / (2.0 * h);
            close(system.pushed(&found.jacobians, &step) / h, by_place, "place");
            let by_rate = (residual(t, &zero, &(v + step)) - residual(t, &zero, &(v - step))) / (2.0 * h);
            let axes = &found.jacobians.axes;
            let damped = axes.to_velocities(&found.jacobians.damping.times(&axes.to_sum(&step)));
            close(-damped / h, by_rate, "velocity");
        }
    }
    assert!(cfg!(miri) || (20..=100).contains(&touched), "{touched}");
}

#[test]
fn planar_derivatives_are_those_of_the_forces() {
    let Linkage { coordinates, bodies, points: [rod, slider, lift] } = planar::example::linkage();
    let tree = PlanarTree::new(coordinates, &bodies, Vector2::new(1.0, -9.81)).unwrap();
    let start = tree.pose([0.3, -0.4, 0.05, 0.02, 0.1, -0.04], |x| [libm::cos(x / 2.0), libm::sin(x / 2.0)]);
    let pin = lift.plus(Vector2::new(0.1, 0.1));
    let elements = (
        (
            Element::<_, _, 4> {
                link: planar::Between { hole: slider.plus(Vector2::new(0.15, 0.0)), pin },
                law: Journal { clearance: 0.05, radius: 0.02, contact: contact() },
            },
            Element::<_, _, 2> {
                link: planar::Across { point: pin, seat: rod, normal: Vector2::new(0.8, -0.6) },
                law: Pad { gap: -0.1, contact: contact() },
            },
        ),
        (
            Element::<_, _, 1> {
                link: planar::Turning { body: Some(1), against: Some(0) },
                law: Spring { stiffness: 3.0, damping: 0.2, rest: 0.1, start: 0.0 },
            },
            (
                Element::<_, _, 2> {
                    link: planar::Along { point: pin, sensor: lift, axis: Vector2::new(0.0, 1.0) },
                    law: Pusher(drive()),
                },
                Element::<_, _, 1> { link: planar::Turning { body: Some(0), against: None }, law: Motor(drive()) },
            ),
        ),
    );
    let elements = (
        elements,
        (
            Element::<_, _, 2> {
                link: planar::Across { point: pin, seat: rod, normal: Vector2::new(-0.6, 0.8) },
                law: Contoured {
                    wall: Pad { gap: -0.1, contact: contact() },
                    along: Axis::Y,
                    contour: Contour { slope: 0.2, curvature: -0.7 },
                },
            },
            Element::<_, _, 4> {
                link: planar::Between { hole: rod, pin },
                law: LineSpring { stiffness: 30.0, damping: 4.0, free_length: 0.1, drawn: Vector2::zeros() },
            },
        ),
    );
    check(&System::new(tree, elements), start, 0.3, |force| force.norm() > 20.0);
}

#[test]
fn spatial_derivatives_are_those_of_the_forces() {
    let body = |mass, x: f64| spatial::Rigid {
        mass,
        inertia_b: Vector3::new(0.02, 0.03, 0.04),
        centre_w: Vector3::new(x, 0.1, 0.0),
    };
    let bodies =
        FreeBodies::<f64, 2, 12>::new([body(0.5, 0.0), body(0.8, 0.3)], Vector3::new(0.0, -9.81, 0.0)).unwrap();
    let port = |body, x, y, z| Port { body, lever: Vector3::new(x, y, z) };
    let axes = crate::pose::Pose::nominal().implicit_update(Vector3::zeros(), Vector3::new(0.4, 0.9, -0.7), 1.0);
    let elements = (
        [
            Element::<_, _, 3> {
                link: Seat { point: port(None, 0.1, 0.2, 0.3), from: Some(0) },
                law: Pin { gaps: [0.02, 0.03, 0.01, 0.05], contact: contact() },
            },
            Element::<_, _, 3> {
                link: Seat { point: port(Some(1), 0.2, 0.1, -0.1), from: Some(0) },
                law: Pin { gaps: [0.02, -0.01, 0.01, 0.05], contact: contact() },
            },
            Element::<_, _, 3> {
                link: Seat { point: port(Some(1), 0.2, 0.1, -0.1), from: None },
                law: Pin { gaps: [0.02, -0.01, 0.01, 0.05], contact: contact() },
            },
        ],
        (
            Element::<_, _, 3> {
                link: Seat { point: port(Some(0), -0.2, 0.1, 0.1), from: Some(1) },
                law: Wall { axis: Axis::Z, sign: -1.0, gap: 0.01, contact: contact() },
            },
            (
                [(Some(0), true), (None, true), (Some(0), false), (None, false)].map(|(from, turns)| Element::<
                    _,
                    _,
                    3,
                > {
                    link: Rim {
                        seat: Seat { point: port(Some(1), 0.1, 0.1, -0.1), from },
                        axes: turns.then(|| axes.to_body().matrix()),
                        radius: 0.05,
                    },
                    law: Ring { clearance: 0.02, contact: contact() },
                }),
                (
                    Element::<_, _, 2> {
                        link: spatial::Along { body: 1, lever: Vector3::new(0.1, -0.2, 0.3), axis_w: Vector3::z() },
                        law: Pusher(drive()),
                    },
                    Element::<_, _, 1> {
                        link: spatial::About { body: 0, axis_w: Vector3::new(0.6, 0.0, 0.8) },
                        law: Motor(drive()),
                    },
                ),
            ),
        ),
    );
    let elements = (
        elements,
        (
            [(Axis::X, Axis::Z, 1.0, Some(0)), (Axis::Y, Axis::Z, -1.0, None), (Axis::Z, Axis::X, 1.0, Some(0))].map(
                |(axis, along, sign, from)| Element::<_, _, 3> {
                    link: Seat { point: port(Some(1), 0.2, 0.1, -0.1), from },
                    law: Contoured {
                        wall: Wall { axis, sign, gap: 0.012, contact: contact() },
                        along,
                        contour: Contour { slope: -0.2, curvature: 0.7 },
                    },
                },
            ),
            (
                Element::<_, _, 1> {
                    link: spatial::AtPoint { body: 0, lever: Vector3::new(0.1, -0.2, 0.3), axis_w: Vector3::y() },
                    law: Motor(drive()),
                },
                [Some(0), None].map(|from| Element::<_, _, 3> {
                    link: Seat { point: port(Some(1), 0.2, 0.1, -0.1), from },
                    law: LineSpring {
                        stiffness: 30.0,
                        damping: 4.0,
                        free_length: 0.1,
                        drawn: Vector3::new(0.2, -0.1, 0.1),
                    },
                }),
            ),
        ),
    );
    let start = bodies.nominal();
    check(&System::new(bodies, elements), start, 0.1, |force| force.norm() > 20.0);
}

/// Three bodies, with what acts on them.
fn three_bodies() -> (FreeBodies<f64, 3, 18>, impl Elements<f64, FreeBodies<f64, 3, 18>, 18> + Copy) {
    let body = |mass, x: f64| spatial::Rigid {
        mass,
        inertia_b: Vector3::new(0.02, 0.03, 0.04),
        centre_w: Vector3::new(x, 0.1, -0.2),
    };
    let bodies = [body(0.5, 0.0), body(0.8, 0.3), body(0.3, -0.2)];
    let port = |body, x, y, z| Port { body, lever: Vector3::new(x, y, z) };
    let elements = (
        Element::<_, _, 3> {
            link: Seat { point: port(Some(2), 0.2, 0.1, -0.1), from: Some(0) },
            law: Pin { gaps: [0.02, -0.01, 0.01, 0.05], contact: contact() },
        },
        (
            Element::<_, _, 3> {
                link: Rim {
                    seat: Seat { point: port(Some(1), 0.1, 0.1, -0.1), from: None },
                    axes: spatial::Parallel,
                    radius: 0.05,
                },
                law: Ring { clearance: 0.02, contact: contact() },
            },
            (
                Element::<_, _, 2> {
                    link: spatial::Along { body: 2, lever: Vector3::new(0.1, -0.2, 0.3), axis_w: Vector3::z() },
                    law: Pusher(drive()),
                },
                Element::<_, _, 1> {
                    link: spatial::About { body: 1, axis_w: Vector3::new(0.6, 0.0, 0.8) },
                    law: Motor(drive()),
                },
            ),
        ),
    );
    (FreeBodies::new(bodies, Vector3::new(1.0, -9.81, 0.5)).unwrap(), elements)
}

#[test]
fn bodies_on_joints_have_the_derivatives_of_their_forces() {
    let at = Vector3::new(0.1, -0.05, 0.2);
    let axis = Vector3::new(0.48, 0.6, 0.64);
    let mount = |body, on, joint| Mount { body, on, joint };
    let (free, elements) = three_bodies();
    let elements = ThroughJoints::<_, 18>(elements);
    let mounts = [
        mount(1, None, Joint::Free),
        mount(0, Some(1), Joint::Revolute { at, axis }),
        mount(2, Some(0), Joint::Cylindrical { at: -at, axis: Vector3::y() }),
    ];
    let tree = SpatialTree::<f64, 3, 18, 9>::new(free, &mounts).unwrap();
    check(&System::new(tree, elements), tree.nominal(), 0.3, |force| force.norm() > 20.0);
    let mounts = [
        mount(0, None, Joint::Spherical { at }),
        mount(2, Some(0), Joint::Prismatic { axis }),
        mount(1, Some(2), Joint::Fixed),
    ];
    // One coordinate more than there is use for.
    let tree = SpatialTree::<f64, 3, 18, 5>::new(free, &mounts).unwrap();
    check(&System::new(tree, elements), tree.nominal(), 0.25, |force| force.norm() > 20.0);
    let mounts = [
        mount(0, None, Joint::Cylindrical { at, axis }),
        mount(1, Some(0), Joint::Revolute { at: -at, axis: Vector3::x() }),
        mount(2, Some(0), Joint::Spherical { at: Vector3::zeros() }),
    ];
    let tree = SpatialTree::<f64, 3, 18, 6>::new(free, &mounts).unwrap();
    check(&System::new(tree, elements), tree.nominal(), 0.3, |force| force.norm() > 20.0);
}

#[test]
fn a_floating_body_has_the_derivatives_of_its_forces() {
    let body = planar::Floating::new(0.5, 0.02, Vector2::new(1.0, -9.81), &[Vector2::new(0.2, 0.0)]).unwrap();
    let at = |x, y| Vector2::new(x, y);
    let elements = (
        [at(0.2, 0.1), at(-0.2, 0.1)].map(|place| Element::<_, _, 2> {
            link: planar::Pin { place },
            law: Slot { gaps: [-0.01, 0.03], contact: contact() },
        }),
        (
            Element::<_, _, 4> {
                link: planar::Hole { centre: at(0.1, -0.2) },
                law: Journal { clearance: 0.02, radius: 0.05, contact: contact() },
            },
            Element::<_, _, 2> { link: planar::Pull { point: at(0.1, 0.3), axis: at(0.6, 0.8) }, law: Pusher(drive()) },
        ),
    );
    check(&System::new(body, elements), planar::PlanarPose::nominal(), 0.1, |force| force.norm() > 20.0);
    let smooth = Contact { normal: contact().normal, friction: Frictionless };
    let hole = Element::<_, _, 4> {
        link: planar::Hole { centre: at(0.1, -0.2) },
        law: Journal { clearance: 0.02, radius: 0.05, contact: smooth },
    };
    check(&System::new(body, hole), planar::PlanarPose::nominal(), 0.1, |force| force.norm() > 20.0);
}

/// That a law tells an impedance over a time as that of no time and the stiffness times it.
fn folds<W: Law<f64, R>, const R: usize>(law: W, places: [f64; R], rates: [f64; R]) {
    let (a, internal) = (0.01, law.fresh());
    let told = |over| {
        let way = Way { over, mass_rate: 0.0, tangent_share: 1.0 };
        law.response(0.3, &places.into(), &rates.into(), &internal, way).0
    };
    let (apart, folded) = (told(None), told(Some(a)));
    assert!(apart.stiffness.norm() > 1.0, "it touches");
    let expected = apart.impedance + apart.stiffness * a;
    assert!((folded.impedance - expected).norm() < 1e-12 * expected.norm(), "{} {expected}", folded.impedance);
    assert_eq!((folded.force, folded.stiffness), (apart.force, apart.stiffness));
}

#[test]
fn impedances_over_a_time_take_in_the_stiffness() {
    let contact = contact();
    let smooth = Contact { normal: contact.normal, friction: Frictionless };
    folds(Spring { stiffness: 3.0, damping: 0.2, rest: 0.1, start: 0.0 }, [0.5], [0.1]);
    folds(Stopped { stop: law::Slot::new(0.01, 0.02).unwrap(), contact: contact.normal }, [0.05], [0.1]);
    folds(Pad { gap: -0.1, contact }, [0.05, 0.0], [-0.1, 0.02]);
    folds(Slot { gaps: [-0.01, 0.03], contact }, [0.05, 0.0], [0.1, 0.02]);
    folds(Journal { clearance: 0.02, radius: 0.05, contact }, [0.03, 0.04, 0.0, 0.0], [0.1, 0.2, 0.3, -0.1]);
    folds(Journal { clearance: 0.02, radius: 0.05, contact: smooth }, [0.03, 0.04, 0.0, 0.0], [0.1, 0.2, 0.3, -0.1]);
    folds(Pin { gaps: [0.02, 0.03, 0.01, 0.05], contact }, [0.05, -0.06, 0.0], [0.1, 0.2, 0.3]);
    folds(Wall { axis: Axis::Z, sign: -1.0, gap: 0.01, contact }, [0.0, 0.0, 0.05], [0.1, 0.2, 0.3]);
    folds(Ring { clearance: 0.02, contact }, [0.03, 0.04, 0.0], [0.1, 0.2, 0.3]);
}

#[test]
fn a_body_on_an_axis_has_the_derivatives_of_its_forces() {
    let stop = Element::<_, _, 1> {
        link: Displacement,
        law: Stopped { stop: law::Slot::new(0.01, 0.02).unwrap(), contact: contact().normal },
    };
    let motor = Element::<_, _, 1> { link: Displacement, law: Motor(drive()) };
    let system = System::new(OnAxis::new(0.5, -9.81).unwrap(), (stop, motor));
    check(&system, 0.0, 0.1, |force| force.norm() > 10.0);
}
