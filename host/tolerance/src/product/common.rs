//! Common datums: two coaxial axes, or two faces in one plane, that are one datum together (A-B on a drawing).

use crate::numeric::lanes::Lanes;

use super::{
    contact::cross,
    feature::{Feature, Located, Shape},
};

/// How far (m) two features may lie off a common plane or line on the drawing.
const OFF: f64 = 1e-9;

/// Two features that are one datum, which is a feature of its own.
#[derive(Clone, Copy, Debug)]
pub struct Common {
    /// Index of the datum.
    index: usize,
    pair: [usize; 2],
    shape: Shape,
    /// Which way from the first to the second along the datum's axis: 1 or −1; 0 if they share their middle.
    way: f64,
    /// Which way the direction of the second points, seen from that of the first.
    same: f64,
    /// Distance (m) of their middles.
    apart: f64,
}

/// Why two features are no common datum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CommonError {
    /// A point, or two of different kinds.
    #[error("a common datum of {} and {}", .0.article(), .1.article())]
    Shapes(Shape, Shape),
    /// Not in one plane or on one line.
    #[error("a common datum of features that do not lie {0}")]
    Apart(&'static str),
}

impl Common {
    /// The datum of two `features` and the feature that stands for it, which will be number `index`.
    ///
    /// # Errors
    /// [`CommonError`], if they are not two faces in one plane or two coaxial axes.
    pub fn new(features: &[Feature], pair: [usize; 2], index: usize) -> Result<(Self, Feature), CommonError> {
        let [one, two] = pair.map(|i| &features[i]);
        if one.shape != two.shape || one.shape == Shape::Point {
            return Err(CommonError::Shapes(one.shape, two.shape));
        }
        let ([at, direction], [other, second]) = (one.nominal, two.nominal);
        let between = [0, 1, 2].map(|i| other[i] - at[i]);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let length = |vector: [f64; 3]| libm::sqrt(dot(vector, vector));
        let parallel = length(cross(direction, second)) <= 1e-9;
        let (off, place) = match one.shape {
            Shape::Plane => (dot(between, direction).abs(), "in one plane and face the same way"),
            _ => (length(cross(between, direction)), "on one line"),
        };
        let same = dot(direction, second);
        if !parallel || off > OFF || (one.shape == Shape::Plane && same < 0.0) {
            return Err(CommonError::Apart(place));
        }
        let apart = length(between);
        let along = if apart > OFF { dot(between, direction) / apart } else { 0.0 };
        let middle = [0, 1, 2].map(|i| 0.5 * (at[i] + other[i]));
        let reach = 0.5 * apart + 0.5 * (one.reach + two.reach);
        let feature =
            Feature { shape: one.shape, nominal: [middle, direction], terms: Vec::new(), widened: Vec::new(), reach };
        let apart = if apart > OFF { apart } else { 0.0 };
        Ok((Self { index, pair, shape: one.shape, way: along, same: same.signum(), apart }, feature))
    }

    /// Puts the datum where its features are: through both middles; what these leave open is the mean of both directions.
    #[inline(always)]
    pub fn locate(&self, located: &mut [Located]) {
        let [one, two] = self.pair.map(|i| located[i]);
        let half = Lanes::splat(0.5);
        let mean = (one.direction + two.direction * Lanes::splat(self.same)) * half;
        let between = two.place - one.place;
        let direction = match self.shape {
            _ if self.apart == 0.0 => mean,
            Shape::Plane => mean - between * (mean.dot(between) / between.dot(between)),
            _ => between * Lanes::splat(self.way.signum() / self.apart),
        };
        located[self.index] = Located { place: (one.place + two.place) * half, direction };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::product::vector::Vector;

    fn feature(shape: Shape, at: [f64; 3], direction: [f64; 3]) -> Feature {
        Feature { shape, nominal: [at, direction], terms: Vec::new(), widened: Vec::new(), reach: 0.01 }
    }

    fn direction(common: &Common, located: &mut [Located]) -> [f64; 3] {
        common.locate(located);
        located[2].direction.0.map(|lanes| lanes.0[0])
    }

    #[test]
    fn journals_make_one_axis_and_faces_one_plane() {
        let z = [0.0, 0.0, 1.0];
        let axes = [feature(Shape::Axis, [0.0; 3], z), feature(Shape::Axis, [0.0, 0.0, 0.2], [0.0, 0.0, -1.0])];
        let (common, datum) = Common::new(&axes, [0, 1], 2).unwrap();
        assert_eq!(datum.nominal, [[0.0, 0.0, 0.1], z]);
        let mut located: Vec<_> = axes.iter().chain([&datum]).map(Feature::perfect).collect();
        // The second journal is 0.1 mm off: the axis leans by that over 200 mm.
        located[1].place = Vector::splat([1e-4, 0.0, 0.2]);
        let found = direction(&common, &mut located);
        assert!((found[0] - 5e-4).abs() < 1e-15 && (found[2] - 1.0).abs() < 1e-15, "{found:?}");
        let faces = [feature(Shape::Plane, [0.0; 3], z), feature(Shape::Plane, [0.1, 0.0, 0.0], z)];
        let (common, datum) = Common::new(&faces, [0, 1], 2).unwrap();
        let mut located: Vec<_> = faces.iter().chain([&datum]).map(Feature::perfect).collect();
        // One face is 0.1 mm higher than the other, and both lean about x.
        located[1].place = Vector::splat([0.1, 0.0, 1e-4]);
        located.iter_mut().for_each(|face| face.direction = Vector::splat([0.0, 2e-3, 1.0]));
        let found = direction(&common, &mut located);
        assert!((found[0] + 1e-3).abs() < 1e-8 && (found[1] - 2e-3).abs() < 1e-15, "{found:?}");
        let wrong = |pair: [Feature; 2]| Common::new(&pair, [0, 1], 2).unwrap_err().to_string();
        assert!(wrong([faces[0].clone(), axes[0].clone()]).contains("a plane and an axis"));
        assert!(wrong([faces[0].clone(), feature(Shape::Plane, [0.1, 0.0, 1e-3], z)]).contains("one plane"));
        assert!(wrong([axes[0].clone(), feature(Shape::Axis, [0.1, 0.0, 0.0], z)]).contains("on one line"));
    }
}
