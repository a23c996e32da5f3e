//! The independent integration: absolute coordinates of all bodies with angular momenta in the frame, ideal joints by multipliers
//! with projection after each step, and the explicit method of Dormand and Prince of order 5 with error control.

use nalgebra::{Matrix3, Quaternion, SVector, UnitQuaternion};

use super::{
    constraints::Constraints,
    forces::{Forces, Load, Placed, Touch},
    motion::{Moved, Row},
    scene::{Body, Scene, Vec3},
    start::start,
};

/// Of one body: place (m), orientation, angle about z (rad), velocity (m/s), angular momentum (N·m·s).
type BodyState = SVector<f64, 14>;
type State = Vec<BodyState>;

/// Weights of earlier stages in each stage; those of the last are those of the result.
const STAGES: [&[f64]; 7] = [
    &[],
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
const TIMES: [f64; 7] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];
/// Weights of the stages in the difference from the embedded method of order 4.
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

/// Longest step (s).
const LONGEST: f64 = 5e-4;
/// Shortest step (s) to which an open contact that may close limits a step; a contact shorter than this is no event.
const EVENT: f64 = 2e-6;
/// Steps after which an integration is given up.
const MOST_STEPS: usize = 3_000_000;

/// The motion of a scene.
#[derive(Clone, Debug)]
pub struct Motion {
    pub rows: Vec<Row>,
    /// How often a contact closed.
    pub closed: usize,
}

/// Scales of a state's components, which the tolerance is a share of.
fn scales(scene: &Scene) -> State {
    let of = |body: &Body| {
        let momentum = body.inertia.min();
        let mut scale = BodyState::repeat(1.0);
        (0..3).for_each(|k| scale[k] = 0.01);
        (8..11).for_each(|k| scale[k] = 0.1);
        (11..14).for_each(|k| scale[k] = momentum);
        scale
    };
    scene.bodies.iter().map(of).collect()
}

/// Integrates `scene` to its end with a row every `every` (s). `None` where it takes too many steps.
///
/// `nudge` changes places and velocities at the start by that share of 10 mm, 1 rad, 0.1 m/s and 1 rad/s, as far as joints let it.
pub fn integrate(scene: &Scene, every: f64, tolerance: f64, nudge: f64) -> Option<Motion> {
    Integration::of(scene).run(every, tolerance, nudge)
}

struct Integration<'a> {
    scene: &'a Scene,
    forces: Forces<'a>,
    constraints: Constraints,
}

impl<'a> Integration<'a> {
    fn of(scene: &'a Scene) -> Self {
        Self { scene, forces: Forces::of(scene), constraints: Constraints::of(scene) }
    }

    fn run(&self, every: f64, tolerance: f64, nudge: f64) -> Option<Motion> {
        let scales = scales(self.scene);
        let mut state = start(self.scene).iter().enumerate().map(|at| self.packed(at)).collect::<State>();
        for (i, (body, scale)) in state.iter_mut().zip(&scales).enumerate() {
            // Alternating signs, so that no motion of the whole is all that changes; in a plane nothing leaves it.
            let in_plane = [0, 1, 8, 9, 13];
            for k in (0..14).filter(|k| !(3..8).contains(k) && (!self.scene.planar || in_plane.contains(k))) {
                body[k] += nudge * scale[k] * if (i + k) % 2 == 0 { 1.0 } else { -0.7 };
            }
        }
        self.project(&mut state);
        let samples = (self.scene.duration / every + 1e-6) as usize;
        let mut motion = Motion { rows: vec![self.row(0.0, &state)], closed: 0 };
        let (mut t, mut h, mut steps) = (0.0_f64, 1e-6_f64, 0);
        let mut slope = self.slope(t, &state);
        let mut touches = self.forces.touches(&self.placed(&state));
        for sample in 1..=samples {
            let end = sample as f64 * every;
            while t < end {
                steps += 1;
                if steps > MOST_STEPS {
                    return None;
                }
                let allowed = self.until_contact(&state, &slope, &touches).min(LONGEST);
                let wanted = h.min(allowed);
                let length = if t + wanted * (1.0 + 1e-6) >= end { end - t } else { wanted };
                let (mut next, error) = self.step(t, length, &state, &slope, &scales, tolerance);
                // A stage may leave the finite range; such a step is far too long.
                let error = if error.is_finite() { error.max(1e-10) } else { 1e10 };
                let next_h = length * (0.9 / libm::pow(error, 0.2)).clamp(0.2, 4.0);
                if error > 1.0 {
                    h = next_h;
                    continue;
                }
                self.project(&mut next);
                let next_touches = self.forces.touches(&self.placed(&next));
                let dips = touches.iter().zip(&next_touches).any(|(from, to)| dips(from, to, length));
                if dips && length > EVENT {
                    h = 0.3 * length;
                    continue;
                }
                motion.closed += touches.iter().zip(&next_touches).filter(|(a, b)| a.gap >= 0.0 && b.gap < 0.0).count();
                h = if length < 0.99 * wanted { h.max(next_h) } else { next_h };
                t = if length == end - t { end } else { t + length };
                (state, touches) = (next, next_touches);
                slope = self.slope(t, &state);
            }
            motion.rows.push(self.row(t, &state));
        }
        Some(motion)
    }

    /// How long a step (s) may be at least before an open contact can close, or one that opens too fast to push can push again.
    fn until_contact(&self, state: &State, slope: &State, touches: &[Touch]) -> f64 {
        self.until_closed(state, slope, touches).min(self.until_pushed(touches)).max(EVENT)
    }

    /// Damping may fade out faster than elastic force as a contact opens: half of its depth is left after a step.
    fn until_pushed(&self, touches: &[Touch]) -> f64 {
        let slack =
            |(k, touch): &(usize, &Touch)| touch.gap < 0.0 && touch.rate > 0.0 && !self.forces.pushes(*k, touch);
        let times = touches.iter().enumerate().filter(slack).map(|(_, touch)| -0.5 * touch.gap / touch.rate);
        times.fold(LONGEST, f64::min)
    }

    fn until_closed(&self, state: &State, slope: &State, touches: &[Touch]) -> f64 {
        const AHEAD: f64 = 1e-7;
        if touches.iter().all(|touch| touch.gap < 0.0) {
            return LONGEST;
        }
        let ahead: State = state.iter().zip(slope).map(|(body, slope)| body + slope * AHEAD).collect();
        let ahead = self.forces.touches(&self.placed(&ahead));
        let open = touches.iter().zip(&ahead).filter(|(touch, _)| touch.gap >= 0.0);
        let times = open.map(|(touch, ahead)| {
            // Threefold, since the acceleration of a gap changes on the way.
            let bend = 10.0 + 3.0 * ((ahead.rate - touch.rate) / AHEAD).abs();
            0.9 * (touch.rate + libm::sqrt(touch.rate * touch.rate + 2.0 * bend * touch.gap)) / bend
        });
        times.fold(LONGEST, f64::min)
    }

    /// The state after a step, and its error, of which 1 is allowed.
    fn step(&self, t: f64, h: f64, from: &State, slope: &State, scales: &State, tolerance: f64) -> (State, f64) {
        let mut slopes: Vec<State> = vec![slope.clone()];
        let mut at = from.clone();
        for (weights, time) in STAGES.iter().zip(TIMES).skip(1) {
            at.clone_from(from);
            for (weight, slope) in weights.iter().zip(&slopes) {
                at.iter_mut().zip(slope).for_each(|(body, slope)| *body += slope * (h * weight));
            }
            slopes.push(self.slope(t + time * h, &at));
        }
        let mut worst: f64 = 0.0;
        for (i, scale) in scales.iter().enumerate() {
            let mut error = BodyState::zeros();
            for (weight, slope) in ERROR.iter().zip(&slopes) {
                error += slope[i] * (h * weight);
            }
            for k in 0..error.len() {
                let share = error[k].abs() / (tolerance * (scale[k] + from[i][k].abs()));
                if share > worst || share.is_nan() {
                    worst = share;
                }
            }
        }
        (at, worst)
    }

    fn slope(&self, t: f64, state: &State) -> State {
        let bodies = self.placed(state);
        let inverse = self.inverse(&bodies);
        let mut loads = vec![Load::none(); bodies.len()];
        self.forces.loads(t, &bodies, &mut loads);
        // ω × (I·ω), which turns the angular momentum with the body.
        let gyroscopic: Vec<Vec3> =
            bodies.iter().zip(state).map(|(body, state)| body.spin.cross(&momentum(state))).collect();
        self.constraints.add_loads(&bodies, &inverse, &gyroscopic, &mut loads);
        let of = |(i, body): (usize, &Placed)| {
            let q = quaternion(&state[i]);
            let turning = Quaternion::from_parts(0.0, body.spin) * q * 0.5;
            let (v, a, m) = (body.velocity, loads[i].force * inverse[i].0, loads[i].torque);
            #[rustfmt::skip]
            let slope = [
                v.x, v.y, v.z, turning.w, turning.i, turning.j, turning.k, body.spin.z, a.x, a.y, a.z, m.x, m.y, m.z,
            ];
            BodyState::from(slope)
        };
        bodies.iter().enumerate().map(of).collect()
    }

    /// Puts the state back on the constraints.
    fn project(&self, state: &mut State) {
        let bodies = self.placed(state);
        let inverse = self.inverse(&bodies);
        let shifts = self.constraints.shifts(&bodies, &inverse);
        for ((body, load), (per_mass, per_inertia)) in state.iter_mut().zip(shifts).zip(&inverse) {
            let turn = per_inertia * load.torque;
            let moved = load.force * *per_mass;
            let q = UnitQuaternion::from_scaled_axis(turn) * UnitQuaternion::new_normalize(quaternion(body));
            (0..3).for_each(|k| body[k] += moved[k]);
            (body[3], body[4], body[5], body[6]) = (q.w, q.i, q.j, q.k);
            body[7] += turn.z;
        }
        let bodies = self.placed(state);
        let inverse = self.inverse(&bodies);
        let impulses = self.constraints.impulses(&bodies, &inverse);
        for ((body, load), (per_mass, _)) in state.iter_mut().zip(impulses).zip(&inverse) {
            for k in 0..3 {
                body[8 + k] += load.force[k] * per_mass;
                body[11 + k] += load.torque[k];
            }
        }
    }

    fn placed(&self, state: &State) -> Vec<Placed> {
        let of = |(body, state): (&Body, &BodyState)| {
            let turned = UnitQuaternion::new_normalize(quaternion(state)).to_rotation_matrix().into_inner();
            let spin = turned * (turned.transpose() * momentum(state)).component_div(&body.inertia);
            Placed { place: three(state, 0), turned, angle: state[7], velocity: three(state, 8), spin }
        };
        self.scene.bodies.iter().zip(state).map(of).collect()
    }

    fn packed(&self, (i, at): (usize, &Placed)) -> BodyState {
        let q = UnitQuaternion::from_matrix(&at.turned);
        let inertia = at.turned * Matrix3::from_diagonal(&self.scene.bodies[i].inertia) * at.turned.transpose();
        let (r, v, l) = (at.place, at.velocity, inertia * at.spin);
        BodyState::from([r.x, r.y, r.z, q.w, q.i, q.j, q.k, at.angle, v.x, v.y, v.z, l.x, l.y, l.z])
    }

    /// The reciprocals of masses and moments of inertia, the latter in the axes of the frame.
    fn inverse(&self, bodies: &[Placed]) -> Vec<(f64, Matrix3<f64>)> {
        let of = |(body, at): (&Body, &Placed)| {
            let inverse = Matrix3::from_diagonal(&body.inertia.map(|moment| 1.0 / moment));
            (1.0 / body.mass, at.turned * inverse * at.turned.transpose())
        };
        self.scene.bodies.iter().zip(bodies).map(of).collect()
    }

    fn row(&self, t: f64, state: &State) -> Row {
        let bodies = self.placed(state);
        let of = |(body, at): (&Body, &Placed)| {
            let turn = UnitQuaternion::from_matrix(&at.turned).scaled_axis();
            Moved {
                shift: at.place - body.centre,
                turn: if self.scene.planar { Vec3::z() * at.angle } else { turn },
                velocity: at.velocity,
                spin: at.spin,
            }
        };
        let efforts = self.forces.efforts(t, &bodies);
        Row { t, efforts, bodies: self.scene.bodies.iter().zip(&bodies).map(of).collect() }
    }
}

fn quaternion(body: &BodyState) -> Quaternion<f64> {
    Quaternion::new(body[3], body[4], body[5], body[6])
}

fn momentum(body: &BodyState) -> Vec3 {
    three(body, 11)
}

fn three(body: &BodyState, from: usize) -> Vec3 {
    Vec3::new(body[from], body[from + 1], body[from + 2])
}

/// Whether a gap that is open at both ends of a step of `h` (s) closes within it, by the cubic with its values and rates.
fn dips(from: &Touch, to: &Touch, h: f64) -> bool {
    let open = from.gap >= 0.0 && to.gap >= 0.0;
    let inside = |s: f64| {
        let rest = 1.0 - s;
        from.gap * rest * rest * (1.0 + 2.0 * s)
            + to.gap * s * s * (3.0 - 2.0 * s)
            + h * (from.rate * s * rest * rest - to.rate * s * s * rest)
    };
    open && from.rate < 0.0 && to.rate > 0.0 && (1..16).any(|k| inside(f64::from(k) / 16.0) < 0.0)
}
