//! How far two runs of one unit agree, in every column that is written.

use super::{Action, Mechanism, MechanismRun, NamedDrive};

/// The greatest difference between two runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// As a share of the greatest value of its kind: of the column itself for a drive, of all columns of a place, an orientation, a
    /// velocity or an angular velocity for a body.
    pub share: f64,
    /// The column, with its unit; none of a mechanism that does not move.
    pub column: Option<String>,
    /// What the share is one of, in words.
    pub whole: &'static str,
}

/// What a share of a drive's column is one of.
const PEAK: &str = "the peak";

/// What shares of a body's columns are one of: those of places, orientations, velocities and angular velocities.
const GREATEST: [&str; 4] = [
    "the body's greatest displacement",
    "the body's greatest turn",
    "the body's greatest speed",
    "the body's greatest spin",
];

impl MechanismRun {
    /// How far this run of `mechanism` agrees with a `better` one, sampled at the same times. Where one of them ends earlier, its last
    /// sample counts for the rest.
    pub fn agreement(&self, better: &Self, mechanism: &Mechanism) -> Agreement {
        let (rows, better_rows) = (&self.samples.rows, &better.samples.rows);
        let count = rows.len().max(better_rows.len());
        let at = |rows: &[Vec<f64>], i: usize, k: usize| rows.get(i).or(rows.last()).map_or(0.0, |row| row[k]);
        let duration = better_rows.last().map_or(0.0, |row| row[0]);
        let mut worst = Agreement { share: 0.0, column: None, whole: PEAK };
        for Group { columns, least, whole } in groups(mechanism, better.tolerance, duration) {
            let greatest = |rows: &[Vec<f64>]| {
                rows.iter().flat_map(|row| &row[columns.clone()]).fold(0.0f64, |most, x| most.max(x.abs()))
            };
            let peak = greatest(better_rows).max(least);
            for k in columns {
                let difference = |i: usize| (at(rows, i, k) - at(better_rows, i, k)).abs();
                // What is not a number differs by all there is.
                let share =
                    (0..count).map(difference).fold(0.0, |most: f64, x| if x > most || x.is_nan() { x } else { most });
                // Of nothing at all nothing differs.
                let share = if share == 0.0 { 0.0 } else { share / peak };
                if share > worst.share || share.is_nan() {
                    worst = Agreement { share, column: Some(self.samples.columns[k].clone()), whole };
                }
            }
        }
        worst
    }
}

/// Columns of one kind, and the least value (in their unit) that counts as motion.
struct Group {
    columns: std::ops::Range<usize>,
    least: f64,
    /// What a share of it is one of.
    whole: &'static str,
}

/// The groups of the columns of `mechanism`, for a run of `duration` (s). A `speed` (m/s) that a step may err by is not told apart from
/// rest, nor is what it moves over the run.
fn groups(mechanism: &Mechanism, speed: f64, duration: f64) -> Vec<Group> {
    let drives = mechanism.drives.iter().enumerate().map(|(k, named)| Group {
        columns: 1 + k..2 + k,
        least: mechanism.effort_of(named, speed).max(f64::MIN_POSITIVE),
        whole: PEAK,
    });
    let sizes: [usize; 4] = if mechanism.planar { [2, 1, 2, 1] } else { [3; 4] };
    let first = 1 + mechanism.drives.len();
    let bodies = mechanism.bodies.iter().enumerate().flat_map(|(i, body)| {
        let gyration = libm::sqrt(body.inertia.iter().fold(0.0f64, |most, inertia| most.max(*inertia)) / body.mass);
        let least = [speed * duration, speed * duration / gyration, speed, speed / gyration];
        let mut from = first + i * sizes.iter().sum::<usize>();
        sizes.into_iter().zip(least).zip(GREATEST).map(move |((size, least), whole)| {
            let columns = from..from + size;
            from += size;
            Group { columns, least, whole }
        })
    });
    drives.chain(bodies).collect()
}

impl Mechanism {
    /// The force (N) or torque (N·m) that stops the drive's body within a second from a `speed` (m/s): smaller ones are not told apart
    /// from zero.
    fn effort_of(&self, named: &NamedDrive, speed: f64) -> f64 {
        let inertia = self.least_inertia(named);
        match named.action {
            Action::Pushes { .. } => inertia * speed,
            Action::Turns { .. } => libm::sqrt(inertia * self.bodies[named.body].mass) * speed,
        }
    }
}
