//! A run as it is sampled, and how far two of them are apart.

use serde::Serialize;

/// A run sampled at equal intervals, SI units. All vectors have the same length.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Trajectory {
    /// Time (s), from 0 on.
    pub t: Vec<f64>,
    /// Velocity of the centre of mass along z (m/s).
    pub vz: Vec<f64>,
    /// Drive force (N).
    pub force: Vec<f64>,
    /// Displacement of the centre of mass across (m).
    pub x: Vec<f64>,
    /// Displacement of the centre of mass up (m).
    pub y: Vec<f64>,
    /// Displacement of the centre of mass along z (m).
    pub z: Vec<f64>,
}

impl Trajectory {
    /// Adds a sample at time `t` (s): velocity along z (m/s), displacements across, up and along z (m), and force (N).
    pub fn push(&mut self, t: f64, [vz, x, y, z]: [f64; 4], force: f64) {
        self.t.push(t);
        self.vz.push(vz);
        self.force.push(force);
        self.x.push(x);
        self.y.push(y);
        self.z.push(z);
    }

    /// The greatest difference of the drive force from the time `from` (s) on, over the greatest force of `other`, which is
    /// sampled at the same times. Where one of them ends earlier, the rest does not count; a run that is over before that time
    /// while the other is not differs by all of it.
    pub fn greatest_difference(&self, other: &Self, from: f64) -> f64 {
        let reaches = |trajectory: &Self| trajectory.t.last().is_some_and(|t| *t >= from - 1e-9);
        if reaches(other) && !reaches(self) {
            return 1.0;
        }
        let peak = other.force.iter().fold(f64::MIN_POSITIVE, |most, force| most.max(force.abs()));
        let late = self.t.iter().zip(self.force.iter().zip(&other.force)).filter(|(t, _)| **t >= from - 1e-9);
        late.fold(0.0f64, |most, (_, (force, other))| most.max((force - other).abs())) / peak
    }
}

#[cfg(test)]
mod tests {
    use super::Trajectory;

    #[test]
    fn a_run_that_is_over_too_soon_differs_by_all_of_it() {
        let lasting = |milliseconds: u32| {
            let mut trajectory = Trajectory::default();
            (0..=milliseconds).for_each(|k| trajectory.push(f64::from(k) * 1e-3, [0.0; 4], 2.0));
            trajectory
        };
        let [short, long, longer] = [16, 100, 120].map(lasting);
        assert_eq!(short.greatest_difference(&long, 0.05), 1.0);
        assert_eq!(longer.greatest_difference(&long, 0.05), 0.0);
        // Where neither comes that far nothing is said.
        assert_eq!(short.greatest_difference(&short, 0.05), 0.0);
    }
}
