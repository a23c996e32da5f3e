//! The paper's sliding mechanism: a slide that hangs on four pins by sixteen clearance contacts.
//!
//! The frame carries the pins; the slide carries rails and walls. x is across, y is up, z is the opening direction.
//! Each pin P_j meets four unbounded planes of the slide, in the order of Table 2: left (outward normal N = +x), right
//! (−x), rail (−y, it lies on the pin) and wall (+y). With the pose (r, R) the gap of a plane is
//! g = (R N)·(P − r − R A), A = P − q·N. Seen from the slide, the pin is displaced by d = (Rᵀ − I)P − Rᵀr, normals stand
//! still along the axes, and the gaps are q + d·N: a difference of small numbers, not of positions, so that f32 keeps
//! its digits. Opposing planes of a pin form a slot.

mod energy;

use nalgebra::Matrix3;

use crate::{
    ParameterError, SVector, Scalar, Vector3,
    drive::Drive,
    error::bounded,
    law::{
        Elastic, Friction, Impact,
        friction::{Contact, Rubbing},
    },
    linear::Blocks,
    mechanism::{Evaluation, Mechanism},
    pose::Pose,
};

pub use energy::{Energy, Power};

/// Pins of the slide.
pub const PINS: usize = 4;

/// Contacts of the slide: left, right, rail, wall of each pin in turn.
pub const CONTACTS: usize = 4 * PINS;

/// Slots of the slide, each two opposing contacts: across, then up and down, of each pin in turn.
pub const SLOTS: usize = 2 * PINS;

/// A gap (m) that never closes: what a contact that the scene leaves out has.
pub const ABSENT: f64 = 1e6;

/// Everything about a slide but its laws, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<S> {
    /// Mass (kg).
    pub mass: S,
    /// Principal moments of inertia about the centre of mass (kg·m²), along the body's axes.
    pub inertia_b: Vector3<S>,
    /// Gravity (m/s²).
    pub gravity_w: Vector3<S>,
    /// Pins, from the centre of mass at the nominal pose (m).
    pub pins_w: [Vector3<S>; PINS],
    /// Gaps at the nominal pose (m): left, right, rail, wall of each pin; [`ABSENT`] for none.
    pub gaps: [S; CONTACTS],
}

/// The moments of inertia (kg·m²) of a uniform box with edges `x`, `y`, `z` (m) about its centre.
pub fn box_inertia<S: Scalar>(mass: S, [x, y, z]: [S; 3]) -> Vector3<S> {
    let twelfth = mass / S::from_f64(12.0);
    Vector3::new((y * y + z * z) * twelfth, (x * x + z * z) * twelfth, (x * x + y * y) * twelfth)
}

/// A slide with its normal law, friction law and drive.
///
/// Generalised velocities are the velocity of the centre of mass in the frame (m/s) and the angular velocity in the
/// body (rad/s), so that the mass matrix is constant and free flight is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slide<S, E, F> {
    body: Body<S>,
    contact: Impact<S, E>,
    friction: F,
    drive: Drive<S>,
    /// 1/m: the inverse of the farthest pin's distance.
    per_lever: S,
}

impl<S: Scalar + PartialOrd, E: Elastic<S>, F: Friction<S>> Slide<S, E, F> {
    /// A slide of parameters that can be stepped without failing.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter of `body` or `drive` that is not finite or out of bounds.
    /// The laws are validated where they are made, see [`menu`](crate::menu).
    pub fn new(body: Body<S>, contact: Impact<S, E>, friction: F, drive: Drive<S>) -> Result<Self, ParameterError<S>> {
        bounded("slide.mass", body.mass, [1e-6, 1e6])?;
        for moment in body.inertia_b.iter() {
            bounded("slide.inertia", *moment, [1e-12, 1e9])?;
        }
        for component in body.gravity_w.iter() {
            bounded("slide.gravity", *component, [-1e4, 1e4])?;
        }
        let mut farthest = S::from_f64(1e-6);
        for pin in &body.pins_w {
            for component in pin.iter() {
                bounded("pin.position", *component, [-1e3, 1e3])?;
            }
            farthest = farthest.max_of(pin.dot(pin).sqrt());
        }
        for gap in body.gaps {
            bounded("gap", gap, [-1.0, ABSENT])?;
        }
        bounded("drive.gain", drive.gain, [0.0, 1e9])?;
        bounded("drive.ramp_start", drive.ramp_start, [-1e6, 1e6])?;
        bounded("drive.ramp_end", drive.ramp_end, [drive.ramp_start.to_f64(), 1e6])?;
        bounded("drive.ramp_duration", drive.ramp_end - drive.ramp_start, [1e-6, 1e6])?;
        bounded("drive.speed", drive.speed, [-1e3, 1e3])?;
        for component in drive.point_b.iter() {
            bounded("drive.point", *component, [-1e3, 1e3])?;
        }
        Ok(Self { body, contact, friction, drive, per_lever: S::one() / farthest })
    }
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S>> Slide<S, E, F> {
    /// The drive.
    pub fn drive(&self) -> &Drive<S> {
        &self.drive
    }

    /// The sixteen gaps (m) at `pose`, in the order of [`Body::gaps`]; negative where parts penetrate.
    pub fn gaps(&self, pose: &Pose<S>) -> [S; CONTACTS] {
        let to_body = pose.to_body();
        let shift = to_body.apply(pose.displacement_w);
        let mut gaps = self.body.gaps;
        for (quad, pin) in gaps.as_chunks_mut::<4>().0.iter_mut().zip(&self.body.pins_w) {
            let d = to_body.change(*pin) - shift;
            let [left, right, rail, wall] = *quad;
            *quad = [left + d.x, right - d.x, rail - d.y, wall + d.y];
        }
        gaps
    }

    /// A slot along one axis: what it does to the slide and how that changes, axis first.
    #[inline(always)]
    fn slot(
        &self,
        memory: &mut F::Memory,
        gaps: [S; 2],
        offset: S,
        [along, sliding_0, sliding_1]: [S; 3],
        way: Way<S>,
    ) -> Contact<S> {
        let slot = self.contact.slot(gaps[0], gaps[1], offset, along, way.a);
        let zero = S::zero();
        let mut contact = Contact {
            force: [slot.force, zero, zero],
            impedance: [[slot.force_slope, zero, zero], [zero; 3], [zero; 3]],
        };
        let rubbing = Rubbing {
            sliding: [sliding_0, sliding_1],
            normal: slot.normal,
            normal_slope: slot.normal_slope,
            mass_rate: way.mass_rate,
            tangent_share: way.tangent_share,
        };
        *memory = self.friction.add(memory, &rubbing, &mut contact);
        contact
    }

    /// Force on the slide at one pin and its impedance −∂force/∂u, in body axes, for the pin's offset `d` and the
    /// velocity `u` of the slide's material there.
    #[inline(always)]
    fn pin(
        &self,
        memory: &mut [F::Memory; 2],
        [left, right, rail, wall]: [S; 4],
        d: Vector3<S>,
        u: Vector3<S>,
        way: Way<S>,
    ) -> (Vector3<S>, Matrix3<S>) {
        let [across_memory, up_memory] = memory;
        let across = self.slot(across_memory, [left, right], d.x, [u.x, u.y, u.z], way);
        let up = self.slot(up_memory, [wall, rail], d.y, [u.y, u.x, u.z], way);
        let (f, g) = (across.force, up.force);
        let (c, k) = (across.impedance, up.impedance);
        let force = Vector3::new(f[0] + g[1], f[1] + g[0], f[2] + g[2]);
        #[rustfmt::skip]
        let impedance = Matrix3::new(
            c[0][0] + k[1][1], c[0][1] + k[1][0], c[0][2] + k[1][2],
            c[1][0] + k[0][1], c[1][1] + k[0][0], c[1][2] + k[0][2],
            c[2][0] + k[2][1], c[2][1] + k[2][0], c[2][2] + k[2][2],
        );
        (force, impedance)
    }
}

/// How forces are to be linearised.
#[derive(Clone, Copy, Debug)]
struct Way<S> {
    /// Implicit part of the step (s).
    a: S,
    /// Mass over it (kg/s).
    mass_rate: S,
    /// See [`Rubbing`].
    tangent_share: S,
}

/// [a]×, the matrix with [a]×·b = a × b.
#[inline(always)]
fn cross_matrix<S: Scalar>(a: &Vector3<S>) -> Matrix3<S> {
    let o = S::zero();
    Matrix3::new(o, -a.z, a.y, a.z, o, -a.x, -a.y, a.x, o)
}

#[inline(always)]
fn split<S: Scalar>(v: &SVector<S, 6>) -> (Vector3<S>, Vector3<S>) {
    let [a, b, c, d, e, f] = v.data.0[0];
    (Vector3::new(a, b, c), Vector3::new(d, e, f))
}

#[inline(always)]
fn join<S: Scalar>(a: Vector3<S>, b: Vector3<S>) -> SVector<S, 6> {
    SVector::<S, 6>::new(a.x, a.y, a.z, b.x, b.y, b.z)
}

/// The momentum balance linearised in body axes, and the rotation that leads there.
#[derive(Clone, Copy, Debug)]
pub struct SlideLinearisation<S> {
    blocks: Blocks<S>,
    to_body: crate::pose::ToBody<S>,
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S>> Mechanism<S, 6> for Slide<S, E, F> {
    type Pose = Pose<S>;
    type Memory = [F::Memory; SLOTS];
    type Linearisation = SlideLinearisation<S>;

    #[inline(always)]
    fn advanced(&self, pose: &Pose<S>, velocity: &SVector<S, 6>, dt: S) -> Pose<S> {
        let (v_w, w_b) = split(velocity);
        pose.advanced(v_w, w_b, dt)
    }

    #[inline(always)]
    fn moved(&self, pose: &Pose<S>, velocity: &SVector<S, 6>, dt: S) -> Pose<S> {
        let (v_w, w_b) = split(velocity);
        pose.moved(v_w, w_b, dt)
    }

    #[inline(always)]
    fn shifted(&self, base: &Pose<S>, from: &Pose<S>, to: &Pose<S>, weight: S) -> Pose<S> {
        base.shifted(from, to, weight)
    }

    #[inline(always)]
    fn memory_shifted(
        &self,
        base: &[F::Memory; SLOTS],
        from: &[F::Memory; SLOTS],
        to: &[F::Memory; SLOTS],
        weight: S,
    ) -> [F::Memory; SLOTS] {
        let mut memory = *base;
        for ((slot, from), to) in memory.iter_mut().zip(from).zip(to) {
            *slot = F::shifted(slot, from, to, weight);
        }
        memory
    }

    #[inline(always)]
    fn normalised(&self, pose: &Pose<S>) -> Pose<S> {
        pose.normalised()
    }

    #[inline(always)]
    fn fresh(&self) -> [F::Memory; SLOTS] {
        [F::fresh(); SLOTS]
    }

    #[inline(always)]
    fn selected(
        &self,
        condition: S,
        (yes, yes_memory): (&Pose<S>, &[F::Memory; SLOTS]),
        (no, no_memory): (&Pose<S>, &[F::Memory; SLOTS]),
    ) -> (Pose<S>, [F::Memory; SLOTS]) {
        let mut memory = *no_memory;
        for (slot, yes) in memory.iter_mut().zip(yes_memory) {
            *slot = F::selected(condition, yes, slot);
        }
        (Pose::selected(condition, yes, no), memory)
    }

    #[inline(always)]
    fn nought(&self, pose: &Pose<S>) -> S {
        let zero = S::zero();
        let Pose { displacement_w: r, orientation: q } = pose;
        r.x * zero + r.y * zero + r.z * zero + q.w * zero + q.v.x * zero + q.v.y * zero + q.v.z * zero
    }

    /// Velocities are rounded to the last place of 4 m/s (4e-16 m/s in f64, 2e-7 m/s in f32): what rounding of the
    /// contact forces stirs up stays below, and a body that sticks comes to rest to the last bit.
    #[inline(always)]
    fn settled(&self, velocity: &SVector<S, 6>) -> SVector<S, 6> {
        if !F::STICKS {
            return *velocity;
        }
        let (v_w, w_b) = split(velocity);
        let round = |x: S, unit: S| (x + unit) - unit;
        let unit = S::from_f64(4.0);
        join(v_w.map(|x| round(x, unit)), w_b.map(|x| round(x, unit * self.per_lever)))
    }

    #[inline(always)]
    fn momentum(&self, velocity: &SVector<S, 6>) -> SVector<S, 6> {
        let (v_w, w_b) = split(velocity);
        join(v_w * self.body.mass, w_b.component_mul(&self.body.inertia_b))
    }

    #[inline(always)]
    fn velocity(&self, momentum: &SVector<S, 6>) -> SVector<S, 6> {
        let (p_w, l_b) = split(momentum);
        join(p_w / self.body.mass, l_b.component_div(&self.body.inertia_b))
    }

    #[inline(always)]
    fn evaluated(
        &self,
        t: S,
        pose: &Pose<S>,
        memory: &[F::Memory; SLOTS],
        velocity: &SVector<S, 6>,
        a: S,
        tangent_share: S,
    ) -> Evaluation<S, [F::Memory; SLOTS], SlideLinearisation<S>, 6> {
        let (v_w, w_b) = split(velocity);
        let to_body = pose.to_body();
        let v_b = to_body.apply(v_w);
        let shift = to_body.apply(pose.displacement_w);
        let way = Way { a, mass_rate: self.body.mass / a, tangent_share };

        let mut memory = *memory;
        let mut force = Vector3::zeros();
        let mut torque = Vector3::zeros();
        let mut blocks = Blocks { a: Matrix3::zeros(), b: Matrix3::zeros(), c: Matrix3::zeros(), d: Matrix3::zeros() };
        let pins = self.body.gaps.as_chunks::<4>().0.iter().zip(&self.body.pins_w);
        for ((gaps, pin), memory) in pins.zip(memory.as_chunks_mut::<2>().0) {
            let d = to_body.change(*pin) - shift;
            let lever = *pin + d;
            let (f, impedance) = self.pin(memory, *gaps, d, v_b + w_b.cross(&lever), way);
            let arm = cross_matrix(&lever);
            let turned = arm * impedance;
            force += f;
            torque += lever.cross(&f);
            blocks.a += impedance;
            blocks.b -= impedance * arm;
            blocks.c += turned;
            blocks.d -= turned * arm;
        }

        // The drive pushes along the frame's z with what the speed of the centre of mass leaves of the command.
        let z_b = to_body.apply(Vector3::z());
        let drive_lever = self.drive.point_b.cross(&z_b);
        let push = self.drive.force(t, v_w.z);
        let gain_z = z_b * self.drive.gain;
        force += z_b * push;
        torque += drive_lever * push;
        blocks.a += z_b * gain_z.transpose();
        blocks.c += drive_lever * gain_z.transpose();

        let spin = w_b.component_mul(&self.body.inertia_b);
        torque -= w_b.cross(&spin);
        let force_w = to_body.apply_inverse(force) + self.body.gravity_w * self.body.mass;

        let m = self.body.mass;
        blocks.a = blocks.a * a + Matrix3::from_diagonal(&Vector3::new(m, m, m));
        blocks.b *= a;
        blocks.c *= a;
        blocks.d = blocks.d * a + Matrix3::from_diagonal(&self.body.inertia_b);
        Evaluation { force: join(force_w, torque), memory, linearisation: SlideLinearisation { blocks, to_body } }
    }

    #[inline(always)]
    fn solve(&self, linearisation: &SlideLinearisation<S>, residual: &SVector<S, 6>) -> SVector<S, 6> {
        let (p_w, l_b) = split(residual);
        let (v_b, w_b) = linearisation.blocks.solve(linearisation.to_body.apply(p_w), l_b);
        join(linearisation.to_body.apply_inverse(v_b), w_b)
    }

    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, 6>) -> S {
        let (p, l) = split(imbalance);
        (p.dot(&p) + l.dot(&l) * self.per_lever * self.per_lever).sqrt()
    }
}
