//! Tosses of a cube that were measured, against the same tosses simulated.
//!
//! 40 of 570 tosses of an acrylic cube on a wood plate, tracked at 148 Hz (S. Pfrommer, M. Halm, M. Posa, "ContactNets: learning
//! discontinuous contact dynamics with smooth, implicit representations", CoRL 2020; BSD licence beside the data in `cube-tosses`).

use std::path::Path;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rayon::prelude::*;
use slipfit::{
    mechanism::{Mechanism, Thrown, run},
    scene::SceneFile,
};

/// Edge (m), mass (kg) and moment of inertia (kg·m²) of the cube.
const EDGE: f64 = 0.1048;
const MASS: f64 = 0.37;
const INERTIA: f64 = 8.1e-4;
const G: f64 = 9.81;

/// A sample: time (s), place (m), orientation, velocity (m/s) and angular velocity in the axes of the body (rad/s).
#[derive(Clone, Copy, Debug)]
struct Sample {
    t: f64,
    place: Vector3<f64>,
    turned: UnitQuaternion<f64>,
    velocity: Vector3<f64>,
    spin_b: Vector3<f64>,
}

impl Sample {
    /// Energy (J) above that at rest on a plate at this height (m).
    fn energy(&self, plate: f64) -> f64 {
        0.5 * (MASS * self.velocity.norm_squared() + INERTIA * self.spin_b.norm_squared())
            + MASS * G * (self.place.z - plate - EDGE / 2.0)
    }

    /// Height (m) of the lowest corner.
    fn lowest(&self) -> f64 {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| (self.turned * axis).z.abs());
        self.place.z - 0.5 * EDGE * (x + y + z)
    }
}

/// A measured toss.
fn measured(number: usize) -> Vec<Sample> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/cube-tosses/{number:03}.csv"));
    let text = std::fs::read_to_string(path).unwrap();
    let sample = |line: &str| {
        let n: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let vector = |k: usize| Vector3::new(n[k], n[k + 1], n[k + 2]);
        let turned = UnitQuaternion::new_normalize(Quaternion::new(n[4], n[5], n[6], n[7]));
        Sample { t: n[0], place: vector(1), turned, velocity: vector(8), spin_b: vector(11) }
    };
    text.lines().skip(1).map(sample).collect()
}

/// The cube above its plate, of which a corner that strikes with 1 m/s rebounds with `restitution`.
fn cube(friction: f64, restitution: f64) -> Mechanism {
    // a·v − ln(1 + a·v) = −a·w − ln(1 − a·w) at v = 1 m/s, w = restitution: the left side less the right falls with a.
    let excess = |a: f64| a - libm::log(1.0 + a) + a * restitution + libm::log(1.0 - a * restitution);
    let (mut low, mut high) = (1e-9, 1.0 / restitution);
    for _ in 0..200 {
        let a = 0.5 * (low + high);
        if excess(a) > 0.0 { low = a } else { high = a }
    }
    let speed = 1.5 / low * 1e3;
    let mut text = format!(
        "[mechanism]\ngravity = [0, 0, -9.81]\n[run]\nduration = 1000\nerror = 1e-5\n\
         [contact]\nlaw = \"hunt-crossley\"\nstiffness = \"1e8 N/m^1.5\"\nexponent = 1.5\nrestitution = 0\nspeed = {speed}\n\
         [friction]\nlaw = \"regularised\"\ncoefficient = {friction}\nstick_band = 1\n\
         [[body]]\nname = \"cube\"\nmass = 370\ninertia = [\"8.1e-4 kg·m²\", \"8.1e-4 kg·m²\", \"8.1e-4 kg·m²\"]\ncentre = [0, 0, 52.4]\n"
    );
    for k in 0..8 {
        let corner = |bit: usize| if k >> bit & 1 == 1 { 52.4 } else { -52.4 };
        text += &format!(
            "[[joint]]\nname = \"corner {k}\"\nkind = \"stop\"\nbetween = [\"cube\", \"frame\"]\nat = [{}, {}, {}]\nnormal = [0, 0, 1]\n\
             clearance = [{}, 0]\n",
            corner(0),
            corner(1),
            corner(2) + 52.4,
            corner(2) + 52.4,
        );
    }
    SceneFile::parse("cube.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap()
}

/// The toss simulated over a plate at this height (m), in samples of the measured one and for half as long again.
fn simulated(cube: &Mechanism, toss: &[Sample], plate: f64) -> Vec<Sample> {
    let first = toss[0];
    let mut cube = cube.clone();
    cube.bodies[0].start.thrown = Some(Thrown {
        displacement: (first.place - Vector3::z() * (plate + EDGE / 2.0)).into(),
        turned: first.turned.scaled_axis().into(),
        velocity: first.velocity.into(),
        spin: (first.turned * first.spin_b).into(),
    });
    let every = toss[1].t - first.t;
    cube.run.duration = 1.5 * (toss[toss.len() - 1].t - first.t);
    let run = run(&cube, &cube.stated_gaps_at(&[0.0]), every).unwrap();
    let sample = |row: &Vec<f64>| {
        let vector = |k: usize| Vector3::new(row[k], row[k + 1], row[k + 2]);
        let turned = UnitQuaternion::from_scaled_axis(vector(4));
        let place = vector(1) + Vector3::z() * (plate + EDGE / 2.0);
        Sample { t: first.t + row[0], place, turned, velocity: vector(7), spin_b: turned.inverse() * vector(10) }
    };
    run.samples.rows.iter().map(sample).collect()
}

/// What is compared of a toss.
#[derive(Clone, Copy, Debug)]
struct Figures {
    /// Height of the centre (m) at the end.
    height: f64,
    /// When it comes to rest (s), from the start.
    rest: f64,
    /// Energy (J) 40 ms after a corner has come to the plate, which is after the first bounce.
    after: f64,
}

/// Speed (m/s) and angular velocity (rad/s) below which a cube is at rest: what the tracker makes of one that is.
const AT_REST: (f64, f64) = (0.08, 1.0);

/// Those of a toss over a plate at the `height` (m), which comes to it within 2 mm.
fn figures(toss: &[Sample], plate: f64) -> Figures {
    let last = toss[toss.len() - 1];
    let moves = |at: &Sample| at.velocity.norm() > AT_REST.0 || at.spin_b.norm() > AT_REST.1;
    let rest = toss.iter().rfind(|at| moves(at)).map_or(0.0, |at| at.t - toss[0].t);
    let touch = toss.iter().position(|at| at.lowest() - plate < 2e-3).unwrap_or(0);
    Figures { height: last.place.z, rest, after: toss[(touch + 6).min(toss.len() - 1)].energy(plate) }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<_> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Medians over tosses of the errors of height (m), of the time to rest (share) and of the energy after the first bounce (J), and by how
/// much the time and the energy are too large.
#[derive(Clone, Copy, Debug)]
struct Errors {
    height: f64,
    rest: f64,
    after: f64,
    bias: [f64; 2],
}

fn errors(tosses: &[Vec<Sample>], plate: f64, friction: f64, restitution: f64) -> Errors {
    let cube = cube(friction, restitution);
    let of_toss = |toss: &Vec<Sample>| {
        let [measured, found] = [figures(toss, plate), figures(&simulated(&cube, toss, plate), plate)];
        [found.height - measured.height, found.rest / measured.rest - 1.0, found.after - measured.after]
    };
    let all: Vec<_> = tosses.par_iter().map(of_toss).collect();
    let typical = |k: usize| median(all.iter().map(|error| error[k].abs()));
    let bias = [1, 2].map(|k| median(all.iter().map(|error| error[k])));
    Errors { height: typical(0), rest: typical(1), after: typical(2), bias }
}

/// One friction coefficient and one restitution are fitted to twenty tosses; the other twenty judge them.
#[test]
fn measured_tosses_of_a_cube_are_those_simulated() {
    let tosses: Vec<_> = (0..40).map(measured).collect();
    let (fitted, judged) = tosses.split_at(20);
    // Where the tracker has the plate: cubes at rest are half an edge above it.
    let plate = median(fitted.iter().map(|toss| toss[toss.len() - 1].place.z)) - EDGE / 2.0;
    let scale = median(fitted.iter().map(|toss| figures(toss, plate).after));
    let mut best = (f64::INFINITY, [0.0; 2]);
    for friction in (0..7).map(|k| 0.14 + 0.02 * f64::from(k)) {
        for restitution in (0..5).map(|k| 0.05 + 0.1 * f64::from(k)) {
            let found = errors(fitted, plate, friction, restitution);
            let cost = found.rest + found.after / scale;
            if cost < best.0 {
                best = (cost, [friction, restitution]);
            }
        }
    }
    let [friction, restitution] = best.1;
    let found = errors(judged, plate, friction, restitution);
    let authors = errors(judged, plate, 0.18, 0.125);
    println!("plate at {:.2} mm, friction {friction:.2}, restitution {restitution:.2}: {found:?}", plate * 1e3);
    println!("the authors' 0.18 and 0.125: {authors:?}");
    // How much the energies after the first bounce differ from toss to toss: half of them lie within this of their median.
    let known = || judged.iter().map(|toss| figures(toss, plate).after);
    let middle = median(known());
    let spread = median(known().map(|after| (after - middle).abs()));
    println!("spread of the energy after the first bounce: {spread:.4} of {middle:.4} J");
    assert!(found.height < 1e-3 && found.rest < 0.10 && found.after < spread, "{found:?}, {spread}");
    // Nor is the time too long or too short on the whole, nor the energy too large or too small.
    assert!(found.bias[0].abs() < 0.05 && found.bias[1].abs() < 0.5 * spread, "{found:?}");
}
