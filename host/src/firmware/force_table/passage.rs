//! A run as a function of position: the force with which the slide first passes each place.

use crate::dynamics::trajectory::Trajectory;

/// What a slide does at each place it comes to. Places count along the drive's direction from the start; forces and
/// velocities along the frame's z, as over time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Passage {
    /// Force (N) and velocity (m/s) where the slide first passes 0, 1, 2, … steps.
    ///
    /// A slide stands at 0 while the force rises; there it is the greatest one until the first step is passed, which is
    /// what a drive needs to get going, and the velocity is 0.
    pub passed: Vec<[f64; 2]>,
    /// The farthest place (m).
    pub reach: f64,
    /// Force (N) at the run's end.
    pub last_force: f64,
}

impl Passage {
    /// Of a `run` commanded to `speed` (m/s), at every `step` up to `most` (m); linear between its samples.
    pub fn of(run: &Trajectory, speed: f64, step: f64, most: f64) -> Self {
        let along = if speed < 0.0 { -1.0 } else { 1.0 };
        let (mut reach, mut breakaway) = (0.0f64, 0.0);
        let greater = |one: f64, other: f64| if other * along > one * along { other } else { one };
        let mut passed = vec![[0.0; 2]];
        for (i, z) in run.z.iter().map(|z| z * along).enumerate() {
            // First passage: the sample before lies short of every place that is still to be passed.
            let next = |passed: &[[f64; 2]]| passed.len() as f64 * step;
            while i > 0 && z >= next(&passed) && next(&passed) < most + 0.5 * step {
                let from = run.z[i - 1] * along;
                let part = (next(&passed) - from) / (z - from);
                let at = |values: &[f64]| values[i - 1] + part * (values[i] - values[i - 1]);
                passed.push([at(&run.force), at(&run.vz)]);
            }
            if passed.len() == 1 {
                breakaway = greater(breakaway, run.force[i]);
            }
            reach = reach.max(z);
        }
        passed[0][0] = passed.get(1).map_or(breakaway, |[force, _]| greater(breakaway, *force));
        Self { passed, reach, last_force: run.force.last().copied().unwrap_or_default() }
    }
}

#[cfg(test)]
mod tests {
    use super::Passage;
    use crate::dynamics::trajectory::Trajectory;

    fn passage(samples: &[[f64; 3]], speed: f64) -> Passage {
        let column = |k: usize| samples.iter().map(|sample| sample[k]).collect::<Vec<f64>>();
        let run = Trajectory { z: column(0), force: column(1), vz: column(2), ..Trajectory::default() };
        Passage::of(&run, speed, 1.0, 3.0)
    }

    #[test]
    fn linear_between_samples_and_many_places_in_one_of_them() {
        let found = passage(&[[0.0, 0.0, 0.0], [0.5, 8.0, 1.0], [3.0, 3.0, 6.0], [4.5, 2.0, 6.0]], 0.1);
        // The greatest force before place 1 is left behind, at rest.
        assert_eq!(found.passed, [[8.0, 0.0], [7.0, 2.0], [5.0, 4.0], [3.0, 6.0]]);
        assert_eq!((found.reach, found.last_force), (4.5, 2.0));
    }

    #[test]
    fn the_first_passage_counts_and_what_is_never_reached_is_not_there() {
        // To 1.5, back to 0.5, on to 2.2, and there it stands.
        let found = passage(
            &[[0.0, 1.0, 0.0], [1.5, 4.0, 1.0], [0.5, 9.0, -1.0], [1.5, 6.0, 1.0], [2.2, 7.4, 0.0], [2.2, 8.0, 0.0]],
            0.1,
        );
        let expected = [[3.0, 0.0], [3.0, 2.0 / 3.0], [6.0 + 1.4 * 0.5 / 0.7, 1.0 - 0.5 / 0.7]];
        for (found, expected) in found.passed.iter().zip(expected) {
            assert!((found[0] - expected[0]).abs() < 1e-12 && (found[1] - expected[1]).abs() < 1e-12, "{found:?}");
        }
        assert_eq!((found.passed.len(), found.reach, found.last_force), (3, 2.2, 8.0));
        // A slide that only goes backwards passes nothing.
        let found = passage(&[[0.0, 1.0, 0.0], [-5.0, 2.0, -1.0]], 0.1);
        assert_eq!((found.passed, found.reach), (vec![[2.0, 0.0]], 0.0));
    }

    #[test]
    fn places_count_along_the_drive_and_values_along_z() {
        let found = passage(&[[0.0, -1.0, 0.0], [-0.5, -2.0, -0.125], [-1.5, -1.0, -0.375]], -0.1);
        assert_eq!(found.passed, [[-2.0, 0.0], [-1.5, -0.25]]);
        assert_eq!(found.reach, 1.5);
    }
}
