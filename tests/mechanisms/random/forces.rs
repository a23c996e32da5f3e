//! Contacts, springs and drives of the independent integration: geometry and laws written from their specification alone.

use nalgebra::Matrix3;

use super::scene::{Drive, Joint, Kind, Laws, Loss, Port, Scene, Vec3};

/// Where a body is and how it moves, in the axes of the frame.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// Centre of mass (m).
    pub place: Vec3,
    /// From the body's axes to the frame's.
    pub turned: Matrix3<f64>,
    /// Angle about z (rad), counted over full turns; for springs in a plane.
    pub angle: f64,
    /// Velocity of the centre of mass (m/s).
    pub velocity: Vec3,
    /// Angular velocity (rad/s).
    pub spin: Vec3,
}

impl Placed {
    /// The frame.
    pub fn frame() -> Self {
        let zero = Vec3::zeros();
        Self { place: zero, turned: Matrix3::identity(), angle: 0.0, velocity: zero, spin: zero }
    }

    /// Velocity (m/s) of the body's material at a point of the frame.
    pub fn material(&self, at: &Vec3) -> Vec3 {
        self.velocity + self.spin.cross(&(at - self.place))
    }
}

/// Force (N) and torque about the centre of mass (N·m).
#[derive(Clone, Copy, Debug)]
pub struct Load {
    pub force: Vec3,
    pub torque: Vec3,
}

impl Load {
    pub fn none() -> Self {
        Self { force: Vec3::zeros(), torque: Vec3::zeros() }
    }
}

/// One contact of a joint: which geometry, in the axes of its bodies.
#[derive(Clone, Debug)]
struct Contact {
    ports: [Port; 2],
    /// A point of the first body and one of the second, from their centres of mass.
    points: [Vec3; 2],
    surface: Surface,
    laws: Laws,
}

#[derive(Clone, Debug)]
enum Surface {
    /// The first body's point before a plane through the second's, with the normal towards the point.
    Plane { normal: Vec3 },
    /// A hole of the first body around a pin of the second.
    Pin { gap: f64, radius: f64 },
    /// A ring of the first body around a rod of the second.
    Rod { gap: f64, radius: f64, axis: Vec3 },
}

/// How the surfaces of a contact lie.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Gap (m), negative where they are pressed together, and how fast it grows (m/s).
    pub gap: f64,
    pub rate: f64,
    /// Direction of the normal force on the first body.
    normal: Vec3,
    /// Where the force acts (m).
    at: Vec3,
}

/// Everything that acts on the bodies of a scene, except ideal joints.
#[derive(Clone, Debug)]
pub struct Forces<'a> {
    scene: &'a Scene,
    contacts: Vec<Contact>,
}

impl<'a> Forces<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        let contacts = scene.joints.iter().flat_map(|joint| contacts(scene, joint)).collect();
        Self { scene, contacts }
    }

    /// How the surfaces of all contacts lie.
    pub fn touches(&self, bodies: &[Placed]) -> Vec<Touch> {
        self.contacts.iter().map(|contact| contact.touch(bodies)).collect()
    }

    /// Whether the contact with this number presses at its `touch`.
    pub fn pushes(&self, contact: usize, touch: &Touch) -> bool {
        touch.gap < 0.0 && normal_force(&self.contacts[contact].laws, -touch.gap, -touch.rate) > 0.0
    }

    /// The energy (J) that contacts and springs store, and that of height.
    pub fn stored(&self, bodies: &[Placed]) -> f64 {
        let pressed = |contact: &Contact| {
            let (depth, e) = ((-contact.touch(bodies).gap).max(0.0), contact.laws.exponent);
            contact.laws.stiffness / (e + 1.0) * libm::pow(depth, e + 1.0)
        };
        let turned = |port: Port| port.map_or(0.0, |body| bodies[body].angle);
        let springs = self.scene.springs.iter().map(|spring| {
            let by = turned(spring.between[0]) - turned(spring.between[1]);
            0.5 * spring.stiffness * by * by
        });
        let heights = self.scene.bodies.iter().zip(bodies);
        let height = heights.map(|(body, at)| -body.mass * self.scene.gravity.dot(&(at.place - body.centre)));
        self.contacts.iter().map(pressed).sum::<f64>() + springs.sum::<f64>() + height.sum::<f64>()
    }

    /// The effort (N, N·m) of each drive at time `t` (s).
    pub fn efforts(&self, t: f64, bodies: &[Placed]) -> Vec<f64> {
        self.scene.drives.iter().map(|drive| effort(drive, t, &bodies[drive.body])).collect()
    }

    /// The loads on all bodies at time `t` (s).
    pub fn loads(&self, t: f64, bodies: &[Placed], loads: &mut [Load]) {
        for (load, body) in loads.iter_mut().zip(&self.scene.bodies) {
            *load = Load { force: self.scene.gravity * body.mass, torque: Vec3::zeros() };
        }
        for contact in &self.contacts {
            let touch = contact.touch(bodies);
            if touch.gap >= 0.0 {
                continue;
            }
            let force = contact.force(&touch, bodies);
            for (port, sign) in contact.ports.into_iter().zip([1.0, -1.0]) {
                let Some(body) = port else { continue };
                loads[body].force += force * sign;
                loads[body].torque += (touch.at - bodies[body].place).cross(&force) * sign;
            }
        }
        for spring in &self.scene.springs {
            let of = |port: Port| port.map_or([0.0; 2], |body| [bodies[body].angle, bodies[body].spin.z]);
            let ([one, one_rate], [other, other_rate]) = (of(spring.between[0]), of(spring.between[1]));
            let torque = -spring.stiffness * (one - other) - spring.damping * (one_rate - other_rate);
            for (port, sign) in spring.between.into_iter().zip([1.0, -1.0]) {
                if let Some(body) = port {
                    loads[body].torque.z += sign * torque;
                }
            }
        }
        for drive in &self.scene.drives {
            let at = &bodies[drive.body];
            let vector = drive.axis * effort(drive, t, at);
            if drive.turns {
                loads[drive.body].torque += vector;
            } else {
                loads[drive.body].force += vector;
                loads[drive.body].torque += (at.turned * drive.point).cross(&vector);
            }
        }
    }
}

/// gain·(STEP(t, start, 0, end, speed) − actual speed).
fn effort(drive: &Drive, t: f64, at: &Placed) -> f64 {
    let [start, end] = drive.ramp;
    let s = ((t - start) / (end - start)).clamp(0.0, 1.0);
    let of_point = || at.velocity + at.spin.cross(&(at.turned * drive.point));
    let actual = match (drive.turns, drive.at_centre) {
        (true, _) => at.spin,
        (false, true) => at.velocity,
        (false, false) => of_point(),
    };
    let actual = actual.dot(&drive.axis);
    drive.gain * (drive.speed * s * s * (3.0 - 2.0 * s) - actual)
}

/// The contacts of a joint.
fn contacts(scene: &Scene, joint: &Joint) -> Vec<Contact> {
    let Some(laws) = joint.laws else { return Vec::new() };
    let centre = |port: Port| port.map_or(Vec3::zeros(), |body| scene.bodies[body].centre);
    let [first, second] = joint.between.map(centre);
    let contact = |point: Vec3, on: Vec3, surface: Surface| Contact {
        ports: joint.between,
        points: [point - first, on - second],
        surface,
        laws,
    };
    let plane = |point: Vec3, gap: f64, normal: Vec3| contact(point, point - normal * gap, Surface::Plane { normal });
    let at = joint.at;
    match &joint.kind {
        Kind::Journal { gap, radius } => vec![contact(at, at, Surface::Pin { gap: *gap, radius: *radius })],
        Kind::Guide { gap, axis, edges: [length, width] } => {
            let across = Vec3::z().cross(axis);
            let corner = |along: f64, side: f64| {
                let corner = at + axis * (0.5 * length * along) + across * (0.5 * width * side);
                plane(corner, *gap, across * -side)
            };
            vec![corner(1.0, 1.0), corner(-1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)]
        }
        Kind::Bearing { gap, axis, length, radius } => {
            let ring = |end: f64| {
                let rod = Surface::Rod { gap: *gap, radius: *radius, axis: *axis };
                contact(at + axis * (0.5 * length * end), at, rod)
            };
            vec![ring(1.0), ring(-1.0)]
        }
        Kind::Track(gaps) => {
            let normals = [Vec3::x(), -Vec3::x(), -Vec3::y(), Vec3::y()];
            gaps.iter().zip(normals).filter_map(|(gap, normal)| Some(plane(at, (*gap)?, normal))).collect()
        }
        Kind::Stop { gap, normal } => vec![plane(at, *gap, *normal)],
        _ => Vec::new(),
    }
}

impl Contact {
    fn placed(&self, bodies: &[Placed]) -> [Placed; 2] {
        self.ports.map(|port| port.map_or_else(Placed::frame, |body| bodies[body]))
    }

    fn touch(&self, bodies: &[Placed]) -> Touch {
        let [first, second] = self.placed(bodies);
        let point = first.place + first.turned * self.points[0];
        let on = second.place + second.turned * self.points[1];
        let (gap, normal, at) = match &self.surface {
            Surface::Plane { normal } => {
                let normal = second.turned * normal;
                (normal.dot(&(point - on)), normal, point)
            }
            Surface::Pin { gap, radius } => {
                let apart = on - point;
                let normal = direction(&apart);
                (gap - apart.norm(), normal, on + normal * *radius)
            }
            Surface::Rod { gap, radius, axis } => {
                let axis = second.turned * axis;
                let from = point - on;
                let apart = from - axis * from.dot(&axis);
                let outwards = direction(&apart);
                (gap - apart.norm(), -outwards, point - outwards * (apart.norm() + radius))
            }
        };
        let rate = normal.dot(&(first.material(&at) - second.material(&at)));
        Touch { gap, rate, normal, at }
    }

    /// The force (N) on the first body.
    fn force(&self, touch: &Touch, bodies: &[Placed]) -> Vec3 {
        let [first, second] = self.placed(bodies);
        let pressed = normal_force(&self.laws, -touch.gap, -touch.rate);
        let Some([coefficient, band]) = self.laws.friction else { return touch.normal * pressed };
        let apart = first.material(&touch.at) - second.material(&touch.at);
        let sliding = apart - touch.normal * touch.normal.dot(&apart);
        let speed = sliding.norm();
        let w = (speed / band).min(1.0);
        let share = coefficient * w * (3.0 - w * w) / 2.0;
        // Below the least positive speed the force is zero too.
        let along = if speed > 0.0 { sliding / speed } else { Vec3::zeros() };
        touch.normal * pressed - along * (share * pressed)
    }
}

/// Of unit length; any for zero, where there is no force.
fn direction(vector: &Vec3) -> Vec3 {
    let length = vector.norm();
    if length > 0.0 { vector / length } else { Vec3::x() }
}

/// The normal force (N) at a `depth` > 0 (m) that grows at `rate` (m/s).
fn normal_force(laws: &Laws, depth: f64, rate: f64) -> f64 {
    let elastic = laws.stiffness * libm::pow(depth, laws.exponent);
    let force = match laws.loss {
        Loss::Impact { damping, depth: full } => {
            let s = (depth / full).min(1.0);
            elastic + damping * s * s * (3.0 - 2.0 * s) * rate
        }
        Loss::HuntCrossley { restitution, speed } => elastic * (1.0 + 3.0 * (1.0 - restitution) / (2.0 * speed) * rate),
        Loss::LankaraniNikravesh { restitution, speed } => {
            elastic * (1.0 + 3.0 * (1.0 - restitution * restitution) / (4.0 * speed) * rate)
        }
    };
    force.max(0.0)
}
