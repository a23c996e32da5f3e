//! Nominal places: what the drawing and the kinematic displacements make of a part's own frame.

/// A rigid motion P ↦ R·P + t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    rows: [[f64; 3]; 3],
    shift: [f64; 3],
}

impl Pose {
    /// None.
    pub const IDENTITY: Self = Self { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], shift: [0.0; 3] };

    /// A shift (m).
    pub fn shift(shift: [f64; 3]) -> Self {
        Self { shift, ..Self::IDENTITY }
    }

    /// A turn by `angle` (rad) about the axis through `point` (m) along the unit vector `axis`.
    pub fn turn(point: [f64; 3], axis: [f64; 3], angle: f64) -> Self {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        let [x, y, z] = axis;
        let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
        let entry =
            |i: usize, j: usize| f64::from(u8::from(i == j)) * c + (1.0 - c) * axis[i] * axis[j] + s * cross[i][j];
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
        let turn = Self { rows, shift: [0.0; 3] };
        let moved = turn.point(point);
        Self { shift: [0, 1, 2].map(|i| point[i] - moved[i]), ..turn }
    }

    /// The turn by Euler's angles z-x-z (rad): first γ about z, then β about x, then α about z, as eq. 3 has it.
    pub fn euler([alpha, beta, gamma]: [f64; 3]) -> Self {
        let about = |axis, angle| Self::turn([0.0; 3], axis, angle);
        let z = [0.0, 0.0, 1.0];
        about(z, alpha).after(&about([1.0, 0.0, 0.0], beta)).after(&about(z, gamma))
    }

    /// First `other`, then this.
    pub fn after(&self, other: &Self) -> Self {
        let columns = [0, 1, 2].map(|j| self.direction([0, 1, 2].map(|i| other.rows[i][j])));
        Self { rows: [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i])), shift: self.point(other.shift) }
    }

    /// Where a point (m) goes.
    pub fn point(&self, point: [f64; 3]) -> [f64; 3] {
        let turned = self.direction(point);
        [0, 1, 2].map(|i| turned[i] + self.shift[i])
    }

    /// Where a direction goes.
    pub fn direction(&self, direction: [f64; 3]) -> [f64; 3] {
        self.rows.map(|[a, b, c]| a * direction[0] + b * direction[1] + c * direction[2])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::Pose;

    fn close(found: [f64; 3], expected: [f64; 3]) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}, not {expected:?}");
    }

    #[test]
    fn turns_are_right_handed_and_chain() {
        close(Pose::turn([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], FRAC_PI_2).point([2.0, 0.0, 5.0]), [1.0, 1.0, 5.0]);
        // β alone is about x; α and γ are about z before and after it.
        close(Pose::euler([0.0, FRAC_PI_2, 0.0]).direction([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        close(Pose::euler([FRAC_PI_2, FRAC_PI_2, 0.0]).direction([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
        close(Pose::euler([0.0, FRAC_PI_2, FRAC_PI_2]).direction([1.0, 0.0, 0.0]), [0.0, 0.0, 1.0]);
        let chain = Pose::shift([0.0, 0.0, 1.0]).after(&Pose::euler([FRAC_PI_2, 0.0, 0.0]));
        close(chain.point([1.0, 0.0, 0.0]), [0.0, 1.0, 1.0]);
    }
}
