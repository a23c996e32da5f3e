//! Rigid bodies that rest on three planes, solved for by Newton's method.

pub type Vector = [f64; 3];

pub fn plus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] + b[i])
}

pub fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

pub fn times(a: Vector, factor: f64) -> Vector {
    a.map(|x| x * factor)
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

pub fn norm(a: Vector) -> f64 {
    libm::sqrt(dot(a, a))
}

/// Place and direction of a feature.
#[derive(Clone, Copy, Debug)]
pub struct Located {
    pub place: Vector,
    pub direction: Vector,
}

/// A turn by a rotation vector about the origin, then a shift.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    pub turn: Vector,
    pub shift: Vector,
}

impl Motion {
    /// Rodrigues' formula.
    pub fn turned(&self, v: Vector) -> Vector {
        let angle = norm(self.turn);
        if angle == 0.0 {
            return v;
        }
        let axis = times(self.turn, 1.0 / angle);
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        plus(plus(times(v, c), times(cross(axis, v), s)), times(axis, dot(axis, v) * (1.0 - c)))
    }

    pub fn moved(&self, feature: Located) -> Located {
        Located { place: plus(self.turned(feature.place), self.shift), direction: self.turned(feature.direction) }
    }
}

/// The motion that brings three planes of a body onto three others: the first in place and direction; the second in place, and
/// turned about the normal of the first; the third in place alone. Pairs of the body's own plane and the other.
pub fn onto(planes: [[Located; 2]; 3]) -> Motion {
    let [[_, first], ..] = planes;
    let size = norm(first.direction);
    let across = {
        let least = if first.direction[0].abs() < 0.6 * size { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let one = cross(first.direction, least);
        [one, cross(first.direction, one)]
    };
    let residual = |x: &[f64; 6]| -> [f64; 6] {
        let motion = Motion { turn: [x[0], x[1], x[2]], shift: [x[3], x[4], x[5]] };
        let [a, b, c] = planes.map(|[own, other]| (motion.moved(own), other));
        let off = |(own, other): (Located, Located)| dot(minus(own.place, other.place), other.direction);
        let tilt = |(own, other): (Located, Located)| cross(own.direction, other.direction);
        [off(a), dot(tilt(a), across[0]), dot(tilt(a), across[1]), off(b), dot(tilt(b), first.direction), off(c)]
    };
    let mut x = [0.0; 6];
    let mut rows = [[0.0; 7]; 6];
    for k in 0..6 {
        const STEP: f64 = 1e-6;
        let [up, down] = [STEP, -STEP].map(|step| {
            let mut moved = x;
            moved[k] = step;
            residual(&moved)
        });
        (0..6).for_each(|i| rows[i][k] = (up[i] - down[i]) / (2.0 * STEP));
    }
    // With the slopes of the start each pass gains a factor of the size of the turn.
    for _ in 0..12 {
        let at = residual(&x);
        (0..6).for_each(|i| rows[i][6] = at[i]);
        let change = solved(rows);
        (0..6).for_each(|k| x[k] -= change[k]);
        if change.iter().all(|change| change.abs() < 1e-13) {
            break;
        }
    }
    Motion { turn: [x[0], x[1], x[2]], shift: [x[3], x[4], x[5]] }
}

/// The solution of six equations, by Gauss's elimination with pivots.
fn solved(mut rows: [[f64; 7]; 6]) -> [f64; 6] {
    for k in 0..6 {
        let pivot = (k..6).max_by(|i, j| rows[*i][k].abs().total_cmp(&rows[*j][k].abs())).unwrap();
        rows.swap(k, pivot);
        for i in (0..6).filter(|i| *i != k) {
            let factor = rows[i][k] / rows[k][k];
            (k..7).for_each(|j| rows[i][j] -= factor * rows[k][j]);
        }
    }
    [0, 1, 2, 3, 4, 5].map(|k| rows[k][6] / rows[k][k])
}
