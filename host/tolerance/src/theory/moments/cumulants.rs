//! Cumulants of a quadratic of random variables, in closed form and by quadrature.

use nalgebra::{DMatrix, DVector};

use crate::{
    distribution::quadrature::nodes,
    model::{Distribution, Variation, ZoneRule},
    numeric::{
        gauss::Node,
        shape::{ORDER, cumulants, weighted},
    },
};

/// From the mean on.
pub type Cumulants = [f64; ORDER];

/// Those of b·z + ½ zᵀAz, z independent standard normals: ½ (r − 1)! tr Aʳ + ½ r! bᵀAʳ⁻²b.
pub fn gaussian(b: &DVector<f64>, a: &DMatrix<f64>) -> Cumulants {
    if a.iter().all(|x| *x == 0.0) {
        let mut forms = [0.0; ORDER];
        forms[1] = b.norm_squared();
        return assemble([0.0; ORDER], forms);
    }
    let powers: Vec<_> = std::iter::successors(Some(a.clone()), |power| Some(power * a)).take(ORDER / 2).collect();
    let images: Vec<_> = std::iter::successors(Some(b.clone()), |image| Some(a * image)).take(ORDER / 2).collect();
    // A power's trace and form are products of two powers of half its order.
    let traces = std::array::from_fn(|i| match i + 1 {
        1 => a.trace(),
        order => powers[order / 2 - 1].dot(&powers[order - order / 2 - 1]),
    });
    let forms = std::array::from_fn(|i| match i {
        0 => 0.0,
        _ => images[(i - 1) / 2].dot(&images[(i - 1) - (i - 1) / 2]),
    });
    assemble(traces, forms)
}

/// Those of b·z + ½ a·z², z a standard normal.
pub fn of_one(b: f64, a: f64) -> Cumulants {
    let [mut traces, mut forms] = [[0.0; ORDER]; 2];
    (traces[0], forms[1]) = (a, b * b);
    for r in 1..ORDER {
        traces[r] = traces[r - 1] * a;
    }
    for r in 2..ORDER {
        forms[r] = forms[r - 1] * a;
    }
    assemble(traces, forms)
}

fn assemble(traces: [f64; ORDER], forms: [f64; ORDER]) -> Cumulants {
    // Half of (r − 1)!.
    let mut half = 0.5;
    std::array::from_fn(|i| {
        let r = (i + 1) as f64;
        let cumulant = half * (traces[i] + r * forms[i]);
        half *= r;
        cumulant
    })
}

/// Adds cumulants, those of something independent.
pub fn add(to: &mut Cumulants, from: &Cumulants, factor: f64) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
}

/// A contributor that is not normal: its variables about their means.
pub struct Group {
    /// Its first variable.
    pub at: usize,
    /// How many it has.
    pub count: usize,
    nodes: Vec<Node>,
}

impl Group {
    /// Of a contributor whose first variable is `at`; none of a normal one.
    pub fn new(variation: &Variation, at: usize, means: &[f64]) -> Option<Self> {
        if is_normal(variation) {
            return None;
        }
        let count = variation.variables();
        let mut nodes = nodes(variation);
        for node in &mut nodes {
            node.at.iter_mut().zip(&means[at..at + count]).for_each(|(x, mean)| *x -= mean);
        }
        Some(Self { at, count, nodes })
    }

    /// The cumulants of g·x + ½ xᵀHx; `hessian` gives the entries of H.
    pub fn cumulants(&self, g: &[f64], hessian: impl Fn(usize, usize) -> f64) -> Cumulants {
        let value = |x: &[f64; 4]| {
            let row = |j: usize| x[j] * (g[j] + 0.5 * (0..self.count).map(|k| hessian(j, k) * x[k]).sum::<f64>());
            (0..self.count).map(row).sum::<f64>()
        };
        let (mean, moments) = weighted(self.nodes.iter().map(|node| (node.weight, value(&node.at))));
        cumulants(mean, &moments)
    }
}

/// Whether all variables of a contributor are normal and independent of each other, or do not vary.
pub fn is_normal(variation: &Variation) -> bool {
    if let Variation::Nested(zone) = variation {
        return zone.is_normal();
    }
    matches!(
        variation,
        Variation::Scalar { distribution: Distribution::Normal { .. } | Distribution::Constant(_), .. }
            | Variation::Zone(ZoneRule::SigmaZone | ZoneRule::Translation)
            | Variation::Disc(ZoneRule::SigmaZone | ZoneRule::Translation)
    )
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::{gaussian, of_one};

    #[test]
    fn squares_of_normals_have_the_cumulants_of_chi_squared() {
        // z² has 2^(r−1)·(r − 1)!; b·z adds b² to the variance, and 12·b²·a² and so on above.
        let found = gaussian(&DVector::from_vec(vec![0.0]), &DMatrix::from_vec(1, 1, vec![2.0]));
        for (found, expected) in found.into_iter().zip([1.0, 2.0, 8.0, 48.0, 384.0, 3840.0, 46080.0, 645_120.0]) {
            assert!((found - expected).abs() < 1e-9 * expected, "{found} {expected}");
        }
        for (b, a) in [(0.0, 2.0), (1.5, -0.3), (2.0, 0.0)] {
            let whole = gaussian(&DVector::from_vec(vec![b]), &DMatrix::from_vec(1, 1, vec![a]));
            for (one, other) in of_one(b, a).into_iter().zip(whole) {
                assert!((one - other).abs() <= 1e-12 * other.abs(), "{one} {other}");
            }
        }
    }
}
