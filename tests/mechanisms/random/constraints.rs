//! Ideal joints of the independent integration: equations between the absolute coordinates of all bodies, and multipliers.

use nalgebra::Matrix3;

use super::{
    forces::{Load, Placed},
    scene::{Joint, Kind, Port, Scene, Vec3},
};

/// An equation of constraint, with vectors in the axes of their bodies.
#[derive(Clone, Debug)]
enum Equation {
    /// Two points coincide along a direction that a body carries: (p₁ − p₂)·n = 0.
    Along { ports: [Port; 2], points: [Vec3; 2], direction: Vec3, carrier: Port },
    /// A direction of the first body is normal to one of the second.
    Normal { ports: [Port; 2], directions: [Vec3; 2] },
}

/// An equation at one moment: value, its rates by the bodies' velocities and spins, and what its second derivative is without
/// accelerations.
struct Row {
    value: f64,
    rates: Vec<(usize, Vec3, Vec3)>,
    rest: f64,
}

/// The ideal joints of a scene.
#[derive(Clone, Debug)]
pub struct Constraints {
    equations: Vec<Equation>,
}

impl Constraints {
    pub fn of(scene: &Scene) -> Self {
        Self { equations: scene.joints.iter().flat_map(|joint| equations(scene, joint)).collect() }
    }

    /// Adds the constraint loads that keep the second derivatives of all equations at zero.
    pub fn add_loads(&self, bodies: &[Placed], inverse: &[(f64, Matrix3<f64>)], spins: &[Vec3], loads: &mut [Load]) {
        let rows = self.rows(bodies);
        let missing = |row: &Row| {
            let free = row.rates.iter().map(|(body, line, turn)| {
                let (per_mass, per_inertia) = &inverse[*body];
                let turning = per_inertia * (loads[*body].torque - spins[*body]);
                line.dot(&loads[*body].force) * per_mass + turn.dot(&turning)
            });
            -row.rest - free.sum::<f64>()
        };
        let missing: Vec<f64> = rows.iter().map(missing).collect();
        for (row, multiplier) in rows.iter().zip(multipliers(&rows, inverse, missing)) {
            for (body, line, turn) in &row.rates {
                loads[*body].force += line * multiplier;
                loads[*body].torque += turn * multiplier;
            }
        }
    }

    /// The impulses that take away the rates of all equations, each as a load over a unit of time.
    pub fn impulses(&self, bodies: &[Placed], inverse: &[(f64, Matrix3<f64>)]) -> Vec<Load> {
        self.corrections(bodies, inverse, |row| {
            let of = |(body, line, turn): &(usize, Vec3, Vec3)| {
                line.dot(&bodies[*body].velocity) + turn.dot(&bodies[*body].spin)
            };
            -row.rates.iter().map(of).sum::<f64>()
        })
    }

    /// The same for their values: displacements, times mass and moment of inertia.
    pub fn shifts(&self, bodies: &[Placed], inverse: &[(f64, Matrix3<f64>)]) -> Vec<Load> {
        self.corrections(bodies, inverse, |row| -row.value)
    }

    fn corrections(
        &self,
        bodies: &[Placed],
        inverse: &[(f64, Matrix3<f64>)],
        missing: impl Fn(&Row) -> f64,
    ) -> Vec<Load> {
        let rows = self.rows(bodies);
        let mut all = vec![Load::none(); bodies.len()];
        let missing = rows.iter().map(missing).collect();
        for (row, multiplier) in rows.iter().zip(multipliers(&rows, inverse, missing)) {
            for (body, line, turn) in &row.rates {
                all[*body].force += line * multiplier;
                all[*body].torque += turn * multiplier;
            }
        }
        all
    }

    fn rows(&self, bodies: &[Placed]) -> Vec<Row> {
        self.equations.iter().map(|equation| equation.row(bodies)).collect()
    }
}

/// Solves (G·M⁻¹·Gᵀ)·λ = `right`, by Cholesky's factors.
fn multipliers(rows: &[Row], inverse: &[(f64, Matrix3<f64>)], right: Vec<f64>) -> Vec<f64> {
    let n = rows.len();
    let scaled: Vec<Vec<(Vec3, Vec3)>> = rows
        .iter()
        .map(|row| {
            let of = |(body, line, turn): &(usize, Vec3, Vec3)| (line * inverse[*body].0, inverse[*body].1 * turn);
            row.rates.iter().map(of).collect()
        })
        .collect();
    let mut factor = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let mut sum = 0.0;
            for (body, line, turn) in &rows[i].rates {
                for ((other, ..), (by_line, by_turn)) in rows[j].rates.iter().zip(&scaled[j]) {
                    if other == body {
                        sum += line.dot(by_line) + turn.dot(by_turn);
                    }
                }
            }
            sum -= factor[i].iter().zip(&factor[j]).take(j).map(|(one, other)| one * other).sum::<f64>();
            factor[i][j] = if i == j { libm::sqrt(sum) } else { sum / factor[j][j] };
        }
    }
    let mut x = right;
    for i in 0..n {
        for k in 0..i {
            x[i] -= factor[i][k] * x[k];
        }
        x[i] /= factor[i][i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            x[i] -= factor[k][i] * x[k];
        }
        x[i] /= factor[i][i];
    }
    x
}

/// Two directions that make a right-handed triad with `axis`.
fn across(axis: &Vec3) -> [Vec3; 2] {
    let aside = if axis.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let one = axis.cross(&aside).normalize();
    [one, axis.cross(&one)]
}

/// The equations of a joint. Axes of the bodies are parallel in the drawn pose.
fn equations(scene: &Scene, joint: &Joint) -> Vec<Equation> {
    let centre = |port: Port| port.map_or(Vec3::zeros(), |body| scene.bodies[body].centre);
    let points = joint.between.map(|port| joint.at - centre(port));
    let ports = joint.between;
    let [first, second] = ports;
    let along = |direction: Vec3, carrier: Port| Equation::Along { ports, points, direction, carrier };
    let normal = |one: Vec3, other: Vec3| Equation::Normal { ports, directions: [one, other] };
    let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
    let together = || vec![along(x, None), along(y, None), along(z, None)];
    let untwisted = || vec![normal(x, y), normal(y, z), normal(z, x)];
    let parallel = |axis: &Vec3| across(axis).map(|other| normal(*axis, other)).to_vec();
    let on_line = |axis: &Vec3| across(axis).map(|other| along(other, second)).to_vec();
    if scene.planar {
        return match &joint.kind {
            Kind::Revolute(_) => vec![along(x, None), along(y, None)],
            Kind::Prismatic(axis) => vec![along(z.cross(axis), second), normal(x, y)],
            Kind::PinSlot(axis) => vec![along(z.cross(axis), first)],
            Kind::Fixed => vec![along(x, None), along(y, None), normal(x, y)],
            _ => Vec::new(),
        };
    }
    match &joint.kind {
        Kind::Fixed => [together(), untwisted()].concat(),
        Kind::Spherical => together(),
        Kind::Revolute(axis) => [together(), parallel(axis)].concat(),
        Kind::Prismatic(axis) => [on_line(axis), untwisted()].concat(),
        Kind::Cylindrical(axis) => [on_line(axis), parallel(axis)].concat(),
        _ => Vec::new(),
    }
}

impl Equation {
    fn row(&self, bodies: &[Placed]) -> Row {
        let placed = |port: Port| port.map_or_else(Placed::frame, |body| bodies[body]);
        let mut rates: Vec<(usize, Vec3, Vec3)> = Vec::with_capacity(3);
        let mut add = |port: Port, line: Vec3, turn: Vec3| {
            let Some(body) = port else { return };
            match rates.iter_mut().find(|(other, ..)| *other == body) {
                Some(known) => (known.1, known.2) = (known.1 + line, known.2 + turn),
                None => rates.push((body, line, turn)),
            }
        };
        match self {
            Self::Along { ports, points, direction, carrier } => {
                let [first, second] = ports.map(placed);
                let by = placed(*carrier);
                let n = by.turned * direction;
                let [s1, s2] = [first.turned * points[0], second.turned * points[1]];
                let apart = first.place + s1 - second.place - s2;
                let (w1, w2, w) = (first.spin, second.spin, by.spin);
                let apart_rate = first.velocity + w1.cross(&s1) - second.velocity - w2.cross(&s2);
                add(ports[0], n, s1.cross(&n));
                add(ports[1], -n, -s2.cross(&n));
                add(*carrier, Vec3::zeros(), n.cross(&apart));
                let centripetal = w1.cross(&w1.cross(&s1)) - w2.cross(&w2.cross(&s2));
                let turning = w.cross(&n);
                let rest = n.dot(&centripetal) + 2.0 * apart_rate.dot(&turning) + apart.dot(&w.cross(&turning));
                Row { value: n.dot(&apart), rates, rest }
            }
            Self::Normal { ports, directions } => {
                let [first, second] = ports.map(placed);
                let (u, w) = (first.turned * directions[0], second.turned * directions[1]);
                let (by_first, by_second) = (first.spin, second.spin);
                let axis = u.cross(&w);
                add(ports[0], Vec3::zeros(), axis);
                add(ports[1], Vec3::zeros(), -axis);
                let [u_rate, w_rate] = [by_first.cross(&u), by_second.cross(&w)];
                let rest =
                    by_first.cross(&u_rate).dot(&w) + 2.0 * u_rate.dot(&w_rate) + u.dot(&by_second.cross(&w_rate));
                Row { value: u.dot(&w), rates, rest }
            }
        }
    }
}
