//! What a residual costs.

use serde::Serialize;

/// What a residual costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Loss {
    /// Its square: best with normal noise, and one outlier can spoil the estimate.
    Squares,
    /// P. J. Huber's (1964): beyond 1.345 standard deviations it grows in proportion.
    Huber,
    /// J. W. Tukey's bisquare: beyond 4.685 standard deviations it grows no more, so that outliers do not count.
    #[default]
    Bisquare,
}

/// Residuals, in deviations, from which on the losses differ from squares: 95 % efficient with normal noise.
const HUBER: f64 = 1.345;
const BISQUARE: f64 = 4.685;

impl Loss {
    /// Every loss.
    pub const ALL: [Self; 3] = [Self::Squares, Self::Huber, Self::Bisquare];

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Squares => "squares",
            Self::Huber => "huber",
            Self::Bisquare => "bisquare",
        }
    }

    /// ρ(u), which is u²/2 for small u.
    fn rho(self, u: f64) -> f64 {
        match self {
            Self::Squares => 0.5 * u * u,
            Self::Huber if u.abs() <= HUBER => 0.5 * u * u,
            Self::Huber => HUBER * (u.abs() - 0.5 * HUBER),
            Self::Bisquare => {
                let rest = (1.0 - (u / BISQUARE) * (u / BISQUARE)).max(0.0);
                BISQUARE * BISQUARE / 6.0 * (1.0 - rest * rest * rest)
            }
        }
    }

    /// ψ(u) = ρ′(u).
    pub fn psi(self, u: f64) -> f64 {
        match self {
            Self::Squares => u,
            Self::Huber => u.clamp(-HUBER, HUBER),
            Self::Bisquare => {
                let rest = (1.0 - (u / BISQUARE) * (u / BISQUARE)).max(0.0);
                u * rest * rest
            }
        }
    }

    /// ψ′(u).
    pub fn psi_slope(self, u: f64) -> f64 {
        match self {
            Self::Squares => 1.0,
            Self::Huber => f64::from(u.abs() <= HUBER),
            Self::Bisquare => {
                let share = (u / BISQUARE) * (u / BISQUARE);
                if share < 1.0 { (1.0 - share) * (1.0 - 5.0 * share) } else { 0.0 }
            }
        }
    }

    /// A number whose square is 2·ρ(u), with the sign of `u`, and its derivative: the residual of a sum of squares that is this loss.
    pub fn root(self, u: f64) -> [f64; 2] {
        let root = libm::sqrt(2.0 * self.rho(u));
        if root < 1e-9 { [u, 1.0] } else { [root * u.signum(), self.psi(u) * u.signum() / root] }
    }
}

/// The standard deviation of normal `residuals` by the median of their amounts; by their squares for [`Loss::Squares`].
pub fn scale(residuals: &[f64], loss: Loss) -> f64 {
    if loss == Loss::Squares {
        let sum: f64 = residuals.iter().map(|residual| residual * residual).sum();
        return libm::sqrt(sum / residuals.len().max(1) as f64);
    }
    let mut amounts: Vec<f64> = residuals.iter().map(|residual| residual.abs()).collect();
    1.4826 * crate::signal::spikes::median(&mut amounts)
}

#[cfg(test)]
mod tests {
    use super::Loss;

    #[test]
    fn derivatives_are_those_of_the_loss() {
        for loss in Loss::ALL {
            for u in [-7.0, -3.0, -1.0, -1e-3, 0.2, 1.3, 2.0, 4.0, 6.0] {
                let h = 1e-6;
                let psi = (loss.rho(u + h) - loss.rho(u - h)) / (2.0 * h);
                assert!((psi - loss.psi(u)).abs() < 1e-8, "{loss:?} {u}");
                let slope = (loss.psi(u + h) - loss.psi(u - h)) / (2.0 * h);
                assert!((slope - loss.psi_slope(u)).abs() < 1e-7, "{loss:?} {u}");
                let [root, derivative] = loss.root(u);
                assert!((root * root - 2.0 * loss.rho(u)).abs() < 1e-12);
                let numeric = (loss.root(u + h)[0] - loss.root(u - h)[0]) / (2.0 * h);
                assert!((numeric - derivative).abs() < 1e-6, "{loss:?} {u}: {numeric} {derivative}");
            }
        }
    }
}
