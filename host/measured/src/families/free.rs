//! Parameters of a family that are free of bounds and of each other, and what is thought of them before any part is
//! measured.
//!
//! Place and scale are those of the middle of the distribution, and their prior is flat (the scale's in its logarithm),
//! as with it the intervals of a normal, a lognormal or a Weibull distribution's quantiles hold in exactly 95 %. The prior
//! of shapes is weakly informative: it is flat near the normal shape and excludes shapes that no production has, such as
//! standard deviations that a few parts in a million make.

use super::{
    family::Family,
    johnson_sb::JohnsonSb,
    johnson_su::JohnsonSu,
    kind::Kind,
    lognormal::Lognormal,
    mixture::TwoNormals,
    normal::Normal,
    sample::{Sample, mean_and_square},
    weibull::Weibull,
};

/// The free parameters of a family for a sample, whose mean and standard deviation are their origin and scale.
pub struct Free {
    kind: Kind,
    /// Mean of the values, or of their logarithms where the family starts at 0.
    mean: f64,
    deviation: f64,
    root_parts: f64,
}

/// Standard deviations of the half normal priors of shapes.
const OF_SIGMA: f64 = 1.0;
const OF_WEIBULL: f64 = 1.0;
const OF_UNBOUNDED: f64 = 1.0;
const OF_BOUNDED: f64 = 1.5;
/// Both parameters of the beta priors of a mixture's shares, and the standard deviation of the logarithm of the ratio of its
/// standard deviations.
const OF_SHARES: f64 = 1.0;
const OF_RATIO: f64 = 1.0;
/// −ln of the middle of an exponential distribution's upper tail, and its slope there by a normal score.
const LN_2: f64 = std::f64::consts::LN_2;
const SLOPE: f64 = 0.797_884_560_802_865_4;

impl Free {
    pub fn new(kind: Kind, sample: &Sample) -> Option<Self> {
        let (mean, deviation) = match kind {
            Kind::Lognormal | Kind::Weibull => {
                if sample.least() <= 0.0 {
                    return None;
                }
                let logarithms: Vec<f64> = sample.sorted.iter().map(|x| libm::log(*x)).collect();
                let (mean, square) = mean_and_square(&logarithms);
                (mean, libm::sqrt(square))
            }
            _ => (sample.mean, sample.deviation),
        };
        Some(Self { kind, mean, deviation, root_parts: libm::sqrt(sample.sorted.len() as f64) })
    }

    /// The distribution of free parameters.
    pub fn family(&self, free: &[f64]) -> Box<dyn Family> {
        let (exp, ln) = (libm::exp, libm::log);
        let place = |u: f64| self.mean + self.deviation * u;
        let scale = |u: f64| self.deviation * exp(u);
        match (self.kind, free) {
            (Kind::Lognormal, &[u, v]) => Box::new(Lognormal { shift: 0.0, mean: place(u), deviation: scale(v) }),
            (Kind::Weibull, &[u, v]) => Box::new(Weibull { shift: 0.0, scale: exp(place(u)), shape: 1.0 / scale(v) }),
            (Kind::ShiftedLognormal, &[u, v, w]) => {
                let sigma = exp(w);
                let length = scale(v) / sigma;
                Box::new(Lognormal { shift: place(u) - length, mean: ln(length), deviation: sigma })
            }
            (Kind::ShiftedWeibull, &[u, v, w]) => {
                let inverse = exp(w);
                let length = scale(v) / (inverse * SLOPE * libm::pow(LN_2, inverse - 1.0));
                let shift = place(u) - length * libm::pow(LN_2, inverse);
                Box::new(Weibull { shift, scale: length, shape: 1.0 / inverse })
            }
            (Kind::JohnsonSu, &[u, v, w, skew]) => {
                let inverse = exp(w);
                let lambda = scale(v) / (inverse * libm::cosh(skew));
                let xi = place(u) + lambda * libm::sinh(skew);
                Box::new(JohnsonSu { gamma: skew / inverse, delta: 1.0 / inverse, xi, lambda })
            }
            (Kind::JohnsonSb, &[u, v, w, skew]) => {
                let inverse = exp(w);
                let below = 1.0 / (1.0 + exp(skew));
                let lambda = scale(v) / (inverse * below * (1.0 - below));
                let xi = place(u) - lambda * below;
                Box::new(JohnsonSb { gamma: skew / inverse, delta: 1.0 / inverse, xi, lambda })
            }
            (Kind::TwoNormals, &[u, v, odds, u_2, v_2]) => {
                let share = 1.0 / (1.0 + exp(-odds));
                let normal = |u, v| Normal { mean: place(u), deviation: scale(v) };
                Box::new(TwoNormals { share, parts: [normal(u, v), normal(u_2, v_2)] })
            }
            (_, free) => {
                let at = |i: usize| free.get(i).copied().unwrap_or_default();
                Box::new(Normal { mean: place(at(0)), deviation: scale(at(1)) })
            }
        }
    }

    /// The free parameters of a distribution.
    pub fn of(&self, family: &dyn Family) -> Vec<f64> {
        let parameters: Vec<f64> = family.parameters().into_iter().map(|(_, value)| value).collect();
        let ln = libm::log;
        let place = |x: f64| (x - self.mean) / self.deviation;
        let scale = |x: f64| ln(x / self.deviation);
        match (self.kind, parameters.as_slice()) {
            (Kind::Lognormal, [_, mean, sd]) => vec![place(*mean), scale(*sd)],
            (Kind::Weibull, [_, scale_of, shape]) => vec![place(ln(*scale_of)), scale(1.0 / shape)],
            (Kind::ShiftedLognormal, [_, mean, sd]) => {
                vec![place(family.value(0.0)), scale(sd * libm::exp(*mean)), ln(*sd)]
            }
            (Kind::ShiftedWeibull, [_, length, shape]) => {
                let inverse = 1.0 / shape;
                let slope = length * inverse * SLOPE * libm::pow(LN_2, inverse - 1.0);
                vec![place(family.value(0.0)), scale(slope), ln(inverse)]
            }
            (Kind::JohnsonSu, [gamma, delta, _, lambda]) => {
                let skew = gamma / delta;
                vec![place(family.value(0.0)), scale(lambda * libm::cosh(skew) / delta), -ln(*delta), skew]
            }
            (Kind::JohnsonSb, [gamma, delta, _, lambda]) => {
                let skew = gamma / delta;
                let below = 1.0 / (1.0 + libm::exp(skew));
                vec![place(family.value(0.0)), scale(lambda * below * (1.0 - below) / delta), -ln(*delta), skew]
            }
            (Kind::TwoNormals, [share, mean_1, sd_1, mean_2, sd_2]) => {
                vec![place(*mean_1), scale(*sd_1), ln(share / (1.0 - share)), place(*mean_2), scale(*sd_2)]
            }
            (_, parameters) => {
                let at = |i: usize| parameters.get(i).copied().unwrap_or_default();
                vec![place(at(0)), scale(at(1))]
            }
        }
    }

    /// The logarithm of the prior's density of free parameters, up to a constant.
    pub fn ln_prior(&self, free: &[f64]) -> f64 {
        // Of a shape whose logarithm is `w`, half normal.
        let half_normal = |w: f64, deviation: f64| w - 0.5 * libm::pow(libm::exp(w) / deviation, 2.0);
        // Of a variable whose hyperbolic tangent is uniform.
        let uniform = |skew: f64| -2.0 * libm::log(libm::cosh(skew.clamp(-300.0, 300.0)));
        // Of the logarithm of odds of a share.
        let beta = |odds: f64| -OF_SHARES * (libm::log1p(libm::exp(-odds)) + libm::log1p(libm::exp(odds)));
        match (self.kind, free) {
            (Kind::ShiftedLognormal, &[_, _, w]) => half_normal(w, OF_SIGMA),
            (Kind::ShiftedWeibull, &[_, _, w]) => half_normal(w, OF_WEIBULL),
            (Kind::JohnsonSu, &[_, _, w, skew]) => half_normal(w, OF_UNBOUNDED) + uniform(skew),
            (Kind::JohnsonSb, &[_, _, w, skew]) => half_normal(w, OF_BOUNDED) + uniform(0.5 * skew),
            (Kind::TwoNormals, &[u, v, odds, u_2, v_2]) => {
                // Flat in the mean and the logarithm of the standard deviation of all, uniform in the share of the variance
                // between the two; the last term turns that into a density of means and logarithms of standard deviations.
                let (share, apart, ratio) = (1.0 / (1.0 + libm::exp(-odds)), u_2 - u, v - v_2);
                if apart <= 0.0 {
                    return f64::NEG_INFINITY;
                }
                let within = share * libm::exp(2.0 * v) + (1.0 - share) * libm::exp(2.0 * v_2);
                let between = libm::log(share * (1.0 - share) * apart * apart / within);
                beta(odds) + beta(between) - 0.5 * libm::pow(ratio / OF_RATIO, 2.0) - libm::log(apart)
            }
            _ => 0.0,
        }
    }

    /// Free parameters near the likeliest ones, from a `fit` if there is one, and by how much they may be off.
    pub fn start(&self, fit: Option<&dyn Family>) -> (Vec<f64>, Vec<f64>) {
        let middle = match self.kind {
            Kind::ShiftedLognormal => vec![0.0, 0.0, -1.5],
            Kind::ShiftedWeibull => vec![0.0, 0.0, -1.0],
            Kind::JohnsonSu | Kind::JohnsonSb => vec![0.0, 0.0, -0.5, 0.0],
            Kind::TwoNormals => vec![-0.7, -0.5, 0.0, 0.7, -0.5],
            _ => vec![0.0; 2],
        };
        let near: Vec<f64> = match fit.map(|fit| self.of(fit)) {
            // The likeliest shapes can be where the prior has nothing.
            Some(fit) => fit.iter().zip(&middle).map(|(x, middle)| x.clamp(middle - 5.0, middle + 5.0)).collect(),
            None => middle,
        };
        let of_shape = (4.0 / self.root_parts).min(0.7);
        let widths = (0..near.len()).map(|i| if i < 2 { 1.5 / self.root_parts } else { of_shape }).collect();
        (near, widths)
    }
}

#[cfg(test)]
mod tests {
    use super::{super::tests::examples, Free};
    use crate::families::sample::Sample;

    #[test]
    fn free_parameters_are_those_of_the_distribution() {
        let sample = Sample::new(&[1.1, 2.0, 2.5, 2.9]).expect("a sample");
        for (kind, family) in examples() {
            let free = Free::new(kind, &sample).expect("positive values");
            let again = free.family(&free.of(family.as_ref()));
            for ((_, expected), (_, found)) in family.parameters().into_iter().zip(again.parameters()) {
                assert!((expected - found).abs() < 1e-9 * (1.0 + expected.abs()), "{kind}: {family:?} {again:?}");
            }
        }
    }
}
