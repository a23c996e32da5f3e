//! How far a run is off a better one.

use serde::Serialize;

/// Samples (1 ms apart) of the release transient, which is judged by itself.
const RELEASE: usize = 50;

/// Deviation of a force from the true one, in % of the true one's greatest magnitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Deviation {
    /// Greatest over the whole run (%).
    pub max: f64,
    /// Root mean square over the whole run (%).
    pub rms: f64,
    /// Greatest for t ≥ 50 ms (%), after the release of stored compression.
    pub late_max: f64,
    /// Root mean square for t ≥ 50 ms (%).
    pub late_rms: f64,
}

impl Deviation {
    /// Of `force` from `truth` (N), both every millisecond from 0 on and equally long.
    pub fn between(force: &[f64], truth: &[f64]) -> Self {
        let peak = truth.iter().fold(0.0f64, |peak, f| peak.max(f.abs()));
        let percent: Vec<f64> = force.iter().zip(truth).map(|(a, b)| (a - b).abs() / peak * 100.0).collect();
        let late = percent.get(RELEASE..).unwrap_or(&[]);
        Self { max: max(&percent), rms: rms(&percent), late_max: max(late), late_rms: rms(late) }
    }

    /// The worse of each.
    pub fn worst(self, other: Self) -> Self {
        Self {
            max: self.max.max(other.max),
            rms: self.rms.max(other.rms),
            late_max: self.late_max.max(other.late_max),
            late_rms: self.late_rms.max(other.late_rms),
        }
    }
}

fn max(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

fn rms(errors: &[f64]) -> f64 {
    libm::sqrt(errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::Deviation;

    #[test]
    fn is_relative_to_the_peak_and_tells_the_release_apart() {
        let truth: Vec<f64> = (0..100).map(|i| if i == 60 { -4.0 } else { 0.0 }).collect();
        let mut force = truth.clone();
        force[10] = 0.4;
        force[99] = -0.04;
        let found = Deviation::between(&force, &truth);
        assert!((found.max - 10.0).abs() < 1e-12 && (found.late_max - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found.rms * found.rms - 101.0 / 100.0).abs() < 1e-12, "{found:?}");
        assert!((found.late_rms * found.late_rms - 1.0 / 50.0).abs() < 1e-12, "{found:?}");
        assert_eq!(Deviation::between(&[1.0], &[1.0]).late_rms, 0.0);
    }
}
