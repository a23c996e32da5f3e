//! Contacts of features, and which freedoms a row of contacts leaves a part.

use nalgebra::{Matrix4, Matrix6, SMatrix, SymmetricEigen, Vector6};

use crate::numeric::lanes::Lanes;

use super::{
    feature::{Located, Shape},
    vector::Vector,
};

/// The most conditions of one contact.
pub const CONDITIONS: usize = 4;

/// Two features that meet, the first of the part that is placed.
#[derive(Clone, Debug)]
pub struct Contact {
    kind: Kind,
    /// Two directions (units) in the other plane, or across the other axis.
    across: [[f64; 3]; 2],
    reach: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    PointOnPlane,
    PlaneOnPoint,
    Planes,
    Axes,
    Points,
}

impl Contact {
    /// A contact of two features of these shapes; `direction` is the other's, `reach` (m) half of the own one's size.
    /// `None` if such features cannot meet.
    pub fn new(own: Shape, other: Shape, direction: [f64; 3], reach: f64) -> Option<Self> {
        let kind = match (own, other) {
            (Shape::Point, Shape::Plane) => Kind::PointOnPlane,
            (Shape::Plane, Shape::Point) => Kind::PlaneOnPoint,
            (Shape::Plane, Shape::Plane) => Kind::Planes,
            (Shape::Axis, Shape::Axis) => Kind::Axes,
            (Shape::Point, Shape::Point) => Kind::Points,
            (Shape::Axis, _) | (_, Shape::Axis) => return None,
        };
        Some(Self { kind, across: across(direction), reach })
    }

    /// Whether both features are planes.
    pub fn is_of_planes(&self) -> bool {
        self.kind == Kind::Planes
    }

    /// What has to be zero (m) for the features to meet. A body that lies on a plane already turns about the normal of that alone: planes
    /// have to be parallel `about` it.
    #[inline(always)]
    pub fn conditions(&self, own: &Located, other: &Located, about: Option<&Vector>) -> [Lanes; CONDITIONS] {
        let apart = own.place - other.place;
        let zero = Lanes::ZERO;
        match self.kind {
            Kind::PointOnPlane => [apart.dot(other.direction), zero, zero, zero],
            Kind::PlaneOnPoint => [apart.dot(own.direction), zero, zero, zero],
            Kind::Planes => {
                let off = apart.dot(other.direction);
                if let Some(normal) = about {
                    return [off, own.direction.cross(other.direction).dot(*normal) * self.reach, zero, zero];
                }
                let [p, r] = self.tilts(own, other);
                [off, p, r, zero]
            }
            Kind::Axes => {
                let along = apart.dot(other.direction) / other.direction.dot(other.direction);
                let off = apart - other.direction * along;
                let ([a, b], [p, r]) = (self.across, self.tilts(own, other));
                [off.along(a), off.along(b), p, r]
            }
            Kind::Points => {
                let Vector([x, y, z]) = apart;
                [x, y, z, zero]
            }
        }
    }
}

impl Contact {
    /// How many of its conditions are of places; the others are of directions.
    pub fn places(&self) -> usize {
        match self.kind {
            Kind::PointOnPlane | Kind::PlaneOnPoint | Kind::Planes => 1,
            Kind::Axes => 2,
            Kind::Points => 3,
        }
    }

    /// How far from parallel the directions are, times the reach.
    #[inline(always)]
    fn tilts(&self, own: &Located, other: &Located) -> [Lanes; 2] {
        let tilt = own.direction.cross(other.direction);
        let [a, b] = self.across;
        [tilt.along(a) * self.reach, tilt.along(b) * self.reach]
    }
}

/// Two unit vectors that with the unit vector `direction` make a right angle each.
pub fn across(direction: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).min_by(|i, j| direction[*i].abs().total_cmp(&direction[*j].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let first = unit(cross(direction, axis)).unwrap_or(axis);
    [first, cross(direction, first)]
}

/// Vector product.
pub fn cross([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// The length of a vector.
pub fn norm(vector: [f64; 3]) -> f64 {
    libm::sqrt(vector.iter().map(|x| x * x).sum())
}

/// The vector over its length; `None` if it has none.
pub fn unit(vector: [f64; 3]) -> Option<[f64; 3]> {
    let greatest = vector.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if greatest == 0.0 || !greatest.is_finite() {
        return None;
    }
    let scaled = vector.map(|x| x / greatest);
    let length = norm(scaled);
    Some(scaled.map(|x| x / length))
}

/// The freedoms of a part: three shifts (m), three rotations times a length of reference (m).
pub struct Freedoms {
    /// Projects a motion on those that are left.
    left: Matrix6<f64>,
    held: Vec<([f64; CONDITIONS], Vector6<f64>)>,
}

/// Derivatives of the conditions of one contact by a part's freedoms.
pub type Rows = SMatrix<f64, CONDITIONS, 6>;

impl Freedoms {
    /// Below this part of a condition's own size a motion does not change it.
    const NONE: f64 = 1e-6;

    /// All six.
    pub fn all() -> Self {
        Self { left: Matrix6::identity(), held: Vec::new() }
    }

    /// Takes the freedoms that a contact with these `rows` holds: of its conditions the combinations that what came
    /// before it leaves open, so that the first contact has precedence, as a first datum has. Gives these
    /// combinations; none if the contact holds nothing more.
    pub fn hold(&mut self, rows: &Rows) -> Vec<[f64; CONDITIONS]> {
        let size = (rows * rows.transpose()).diagonal().max();
        let open: Matrix4<f64> = rows * self.left * rows.transpose();
        let eigen = SymmetricEigen::new(open);
        let mut combinations = Vec::new();
        for i in 0..CONDITIONS {
            if eigen.eigenvalues[i] > Self::NONE * size {
                let combination = eigen.eigenvectors.column(i).into_owned();
                let row: Vector6<f64> = rows.transpose() * combination;
                let free = self.left * row;
                self.left -= free * free.transpose() / free.dot(&row);
                self.held.push((combination.into(), row));
                combinations.push(combination.into());
            }
        }
        combinations
    }

    /// Holds what is left as it is: a body turns only as far as its contacts turn it, and then shifts only as far.
    pub fn hold_the_rest(&mut self) {
        for first in [3, 0] {
            self.hold(&Rows::from_fn(|row, component| if row < 3 && component == first + row { 1.0 } else { 0.0 }));
        }
    }

    /// The motions that are left, of length 1 and at right angles to each other.
    pub fn rest(&self) -> Vec<Vector6<f64>> {
        let mut others = Self { left: self.left, held: Vec::new() };
        std::iter::from_fn(|| {
            let motion = others.one()?;
            others.left -= motion * motion.transpose();
            Some(motion)
        })
        .collect()
    }

    /// How many are left.
    pub fn count(&self) -> usize {
        libm::round(self.left.trace()) as usize
    }

    /// One motion that is left, of length 1.
    pub fn one(&self) -> Option<Vector6<f64>> {
        if self.count() == 0 {
            return None;
        }
        let longest = self.left.column_iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
        Some(longest.into_owned() / libm::sqrt(longest.norm_squared()))
    }

    /// Motions per condition, combination by combination in the order in which they were held; `None` unless all six
    /// freedoms are.
    pub fn inverse(&self) -> Option<Matrix6<f64>> {
        if self.held.len() != 6 {
            return None;
        }
        let mut matrix = Matrix6::zeros();
        for (i, (_, row)) in self.held.iter().enumerate() {
            matrix.set_row(i, &row.transpose());
        }
        matrix.try_inverse()
    }
}
