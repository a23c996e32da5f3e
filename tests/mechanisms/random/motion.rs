//! A motion as rows over time, and how far two of them differ, as shares of the peaks.

use nalgebra::{Rotation3, UnitQuaternion};

use super::{
    forces::{Forces, Placed},
    scene::{Scene, Vec3},
};

/// A moment of a motion.
#[derive(Clone, Debug)]
pub struct Row {
    /// Time (s).
    pub t: f64,
    /// Effort of each drive (N, N·m).
    pub efforts: Vec<f64>,
    pub bodies: Vec<Moved>,
}

/// How a body has moved since the drawn pose.
#[derive(Clone, Copy, Debug)]
pub struct Moved {
    /// Displacement of the centre of mass (m).
    pub shift: Vec3,
    /// Rotation vector (rad); in a plane the angle about z, counted over full turns.
    pub turn: Vec3,
    /// Velocity of the centre of mass (m/s).
    pub velocity: Vec3,
    /// Angular velocity in the frame (rad/s).
    pub spin: Vec3,
}

impl Row {
    /// The row of the numbers that slipfit writes.
    pub fn of(scene: &Scene, numbers: &[f64]) -> Self {
        let (first, rest) = numbers.split_at(1 + scene.drives.len());
        let vector = |of: &[f64]| Vec3::new(of[0], of[1], of[2]);
        let bodies = if scene.planar {
            let of = |n: &[f64; 6]| {
                let [x, y, angle, vx, vy, spin] = *n;
                Moved {
                    shift: Vec3::new(x, y, 0.0),
                    turn: Vec3::z() * angle,
                    velocity: Vec3::new(vx, vy, 0.0),
                    spin: Vec3::z() * spin,
                }
            };
            rest.as_chunks::<6>().0.iter().map(of).collect()
        } else {
            let of = |n: &[f64; 12]| Moved {
                shift: vector(&n[..3]),
                turn: vector(&n[3..]),
                velocity: vector(&n[6..]),
                spin: vector(&n[9..]),
            };
            rest.as_chunks::<12>().0.iter().map(of).collect()
        };
        Self { t: first[0], efforts: first[1..].to_vec(), bodies }
    }

    pub fn is_finite(&self) -> bool {
        let vectors = |moved: &Moved| [moved.shift, moved.turn, moved.velocity, moved.spin];
        let numbers = self.bodies.iter().flat_map(vectors).map(|vector| vector.norm());
        numbers.chain(self.efforts.iter().copied()).all(f64::is_finite)
    }

    /// The bodies in this row.
    pub fn placed(&self, scene: &Scene) -> Vec<Placed> {
        let of = |(body, moved): (&super::scene::Body, &Moved)| Placed {
            place: body.centre + moved.shift,
            turned: Rotation3::from_scaled_axis(moved.turn).into_inner(),
            angle: moved.turn.z,
            velocity: moved.velocity,
            spin: moved.spin,
        };
        scene.bodies.iter().zip(&self.bodies).map(of).collect()
    }

    /// Kinetic energy (J), and all that is stored.
    pub fn energies(&self, scene: &Scene, forces: &Forces) -> [f64; 2] {
        let placed = self.placed(scene);
        let kinetic = |(body, at): (&super::scene::Body, &Placed)| {
            let spin = at.turned.transpose() * at.spin;
            0.5 * (body.mass * at.velocity.norm_squared() + spin.dot(&spin.component_mul(&body.inertia)))
        };
        [scene.bodies.iter().zip(&placed).map(kinetic).sum(), forces.stored(&placed)]
    }

    /// Momentum (N·s) of all bodies without what gravity has given them, and angular momentum (N·m·s) about their common centre of mass.
    pub fn momenta(&self, scene: &Scene) -> [Vec3; 2] {
        let placed = self.placed(scene);
        let all = || scene.bodies.iter().zip(&placed);
        let mass: f64 = scene.bodies.iter().map(|body| body.mass).sum();
        let centre = all().map(|(body, at)| at.place * body.mass).sum::<Vec3>() / mass;
        let linear = all().map(|(body, at)| at.velocity * body.mass).sum::<Vec3>() - scene.gravity * mass * self.t;
        let angular = all().map(|(body, at)| {
            let spin = at.turned * (at.turned.transpose() * at.spin).component_mul(&body.inertia);
            spin + (at.place - centre).cross(&at.velocity) * body.mass
        });
        [linear, angular.sum()]
    }
}

/// Below this share of the greatest peak of its kind a column counts against that share.
const LEAST_PEAK: f64 = 1e-4;

/// Peaks (m, rad, N and their rates) below this are rounding, such as the angle of a body on a slide of the frame.
const ROUNDING: f64 = 1e-9;

/// What differs: the quantity, and of which drive or body.
pub type Column = (&'static str, usize);

/// The greatest difference of each column over the rows of `found`, as a share of its peak in all of `expected`. In a plane each number is a column, in space each vector
/// counts against its greatest component; orientations by the angle between them.
pub fn differences(scene: &Scene, expected: &[Row], found: &[Row]) -> Vec<(Column, f64)> {
    let mut all = Vec::new();
    for drive in 0..scene.drives.len() {
        let error = greatest(expected.iter().zip(found).map(|(e, f)| e.efforts[drive] - f.efforts[drive]));
        // An effort errs as its drive's speed does.
        let least = LEAST_PEAK * (scene.drives[drive].gain * scene.drives[drive].speed).abs();
        let peak = greatest(expected.iter().map(|e| e.efforts[drive])).max(least);
        all.push((("effort", drive), share(error, peak)));
    }
    type Part = fn(&Moved) -> Vec3;
    let parts: [([&'static str; 3], Part); 4] = [
        (["x", "y", "z"], |moved| moved.shift),
        (["ax", "ay", "angle"], |moved| moved.turn),
        (["vx", "vy", "vz"], |moved| moved.velocity),
        (["wx", "wy", "spin"], |moved| moved.spin),
    ];
    for (names, part) in parts {
        let peak = |body: usize, k: usize| greatest(expected.iter().map(|row| part(&row.bodies[body])[k]));
        let peaks = (0..scene.bodies.len()).flat_map(|body| (0..3).map(move |k| (body, k)));
        let least = LEAST_PEAK * greatest(peaks.map(|(body, k)| peak(body, k)));
        for body in 0..scene.bodies.len() {
            let pairs = || expected.iter().zip(found).map(|(e, f)| (part(&e.bodies[body]), part(&f.bodies[body])));
            if !scene.planar && names[0] == "ax" {
                let turned = UnitQuaternion::from_scaled_axis;
                let angle = |(e, f)| (turned(e).inverse() * turned(f)).scaled_axis().norm();
                let own = greatest((0..3).map(|k| peak(body, k))).max(least);
                all.push((("turn", body), share(greatest(pairs().map(angle)), own)));
                continue;
            }
            for k in 0..3 {
                let own = if scene.planar { peak(body, k) } else { greatest((0..3).map(|k| peak(body, k))) };
                let error = greatest(pairs().map(|(e, f)| e[k] - f[k]));
                all.push(((names[k], body), share(error, own.max(least))));
            }
        }
    }
    all
}

/// The greatest of `differences`.
pub fn worst(differences: &[(Column, f64)]) -> (Column, f64) {
    differences.iter().copied().max_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or((("none", 0), 0.0))
}

/// The greatest magnitude; not a number if one is not.
fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| if value.is_nan() || value.abs() > most { value.abs() } else { most })
}

fn share(error: f64, peak: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / peak.max(ROUNDING) }
}
