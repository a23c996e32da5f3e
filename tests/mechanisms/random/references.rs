//! The independent integration against the reference runs, which a third program computed.

use slipfit_tests::known_runs::mechanism_rows;

use super::{
    integration::integrate,
    motion::Row,
    scene::{Body, Drive, Joint, Kind, Laws, Loss, Port, Scene, Vec3},
};

fn body(name: &str, mass: f64, inertia: Vec3, centre: Vec3) -> Body {
    Body { name: name.into(), mass, inertia, centre, angle: 0.0, spin: 0.0, speed: 0.0 }
}

fn joint(between: [Port; 2], at: Vec3, kind: Kind, laws: Option<Laws>) -> Joint {
    Joint { name: String::new(), between, at, kind, laws }
}

fn laws(stiffness: f64, damping: f64, friction: f64) -> Laws {
    let loss = Loss::Impact { damping, depth: 1e-5 };
    Laws { stiffness, exponent: 1.5, loss, friction: Some([friction, 1e-3]) }
}

/// Mechanism P1, fast: contact opens and closes.
fn slider_crank() -> Scene {
    let at = |x: f64| Vec3::x() * x;
    let journal = Kind::Journal { gap: 5e-4, radius: 0.0095 };
    let turns = || Kind::Revolute(Vec3::z());
    Scene {
        planar: true,
        gravity: Vec3::y() * -9.81,
        bodies: vec![
            body("crank", 0.3, Vec3::repeat(1e-4), at(0.025)),
            body("rod", 0.21, Vec3::repeat(2.5e-4), at(0.11)),
            body("slider", 0.14, Vec3::repeat(1e-4), at(0.17)),
        ],
        joints: vec![
            joint([None, Some(0)], at(0.0), turns(), None),
            joint([Some(0), Some(1)], at(0.05), turns(), None),
            joint([None, Some(2)], at(0.17), Kind::Prismatic(Vec3::x()), None),
            joint([Some(1), Some(2)], at(0.17), journal, Some(laws(1e9, 200.0, 0.05))),
        ],
        springs: Vec::new(),
        drives: vec![Drive {
            body: 0,
            turns: true,
            axis: Vec3::z(),
            point: Vec3::zeros(),
            at_centre: true,
            gain: 0.5,
            ramp: [0.0, 0.1],
            speed: 100.0,
        }],
        duration: 0.2,
    }
}

/// Mechanism S1, jamming.
fn linear_guide() -> Scene {
    let bearing = |x: f64, z: f64| {
        let kind = Kind::Bearing { gap: 5e-5, axis: Vec3::z(), length: 0.02, radius: 0.006 };
        joint([Some(0), None], Vec3::new(x, -0.01, z), kind, Some(laws(1e8, 300.0, 0.3)))
    };
    Scene {
        planar: false,
        gravity: Vec3::y() * -9.81,
        bodies: vec![body("carriage", 0.6, Vec3::new(8e-4, 2e-3, 1.4e-3), Vec3::zeros())],
        joints: vec![bearing(-0.06, -0.03), bearing(0.06, -0.03), bearing(-0.06, 0.03), bearing(0.06, 0.03)],
        springs: Vec::new(),
        drives: vec![Drive {
            body: 0,
            turns: false,
            axis: Vec3::z(),
            point: Vec3::x() * 0.15,
            at_centre: true,
            gain: 200.0,
            ramp: [0.05, 0.25],
            speed: 0.1,
        }],
        duration: 0.5,
    }
}

/// The numbers of a row in the order of a reference file, without the time.
type Numbers = fn(&Row) -> Vec<f64>;

#[test]
fn the_independent_integration_meets_reference_runs() {
    let crank: Numbers = |row| {
        let [crank, rod, slider] = &row.bodies[..] else { panic!("three bodies") };
        let angles = [crank.turn.z, rod.turn.z, slider.shift.x + 0.17];
        let [torque, speeds] = [row.efforts[0], slider.velocity.x];
        [vec![torque, crank.spin.z], angles.to_vec(), vec![rod.spin.z, speeds]].concat()
    };
    let guide: Numbers = |row| {
        let carriage = &row.bodies[0];
        let vectors = carriage.shift.iter().chain(&carriage.turn).copied();
        [row.efforts[0], carriage.velocity.z].into_iter().chain(vectors).collect()
    };
    for (file, scene, every, numbers) in
        [("P1-fast", slider_crank(), 1e-4, crank), ("S1-jams", linear_guide(), 1e-3, guide)]
    {
        let expected = mechanism_rows(file);
        let rows = integrate(&scene, every, 1e-10, 0.0).unwrap().rows;
        assert_eq!(rows.len(), expected.len());
        let found: Vec<_> = rows.iter().map(numbers).collect();
        for k in 0..found[0].len() {
            let peak = expected.iter().map(|row| row[k].abs()).fold(0.0, f64::max);
            let pairs = expected.iter().zip(&found);
            let error = pairs.map(|(expected, found)| (expected[k] - found[k]).abs()).fold(0.0, f64::max);
            assert!(error <= 1e-6 * peak, "{file}, column {k}: {error:e} of {peak:e}");
        }
    }
}
