//! What the comparison of one scene finds.

use slipfit::{mechanism::confirmed, scene::SceneFile};

use super::{
    forces::Forces,
    integration::integrate,
    motion::{Column, Row, differences, worst},
    scene::Scene,
    transform::{self, Transform},
};

/// What the desk may err by in a step, as a share of the mechanism's own speed: its default.
pub const ERROR: f64 = 3e-7;
/// Time (s) between two rows.
const EVERY: f64 = 1e-3;
/// What a column may differ by, as a share of its peak.
const ALLOWED: f64 = 5e-3;
/// Tolerance of the independent integration, and the finer one that shows its error.
const TOLERANCE: [f64; 2] = [1e-9, 1e-11];
/// Changes of the start, as a share of 10 mm, 1 rad, 0.1 m/s and 1 rad/s.
const NUDGES: [f64; 3] = [1e-9, 1e-6, -1e-6];
/// From where the independent integration, nudged, differs by this share of a peak, a motion counts as too sensitive to compare.
const SENSITIVE: f64 = 1e-3;
/// What the energy of a mechanism without a drive may grow by, as a share of its greatest kinetic energy.
const ENERGY: f64 = 1e-3;
/// Momenta (N·s, N·m·s) below this are none.
const LEAST_MOMENTUM: f64 = 1e-9;

/// What the comparison of a scene found.
pub struct Verdict {
    pub seed: u64,
    /// How often a contact closes in the independent integration.
    pub closed: usize,
    /// Share of the time before the motion gets too sensitive to its start.
    pub compared: f64,
    /// Worst differences, as shares of the peaks.
    pub differences: Vec<(Column, f64)>,
    /// What is wrong.
    pub failure: Option<String>,
}

/// Compares slipfit's motion of the scene of a `seed`, and of another description of it, with the independent integration.
pub fn compared(scene: &Scene, seed: u64) -> Verdict {
    let mut verdict = Verdict { seed, closed: 0, compared: 1.0, differences: Vec::new(), failure: None };
    verdict.failure = found(scene, &Forces::of(scene), &mut verdict).err();
    verdict
}

fn found(scene: &Scene, forces: &Forces, verdict: &mut Verdict) -> Result<(), String> {
    let Some(expected) = integrate(scene, EVERY, TOLERANCE[0], 0.0) else {
        return Err("the independent integration takes too many steps".into());
    };
    verdict.closed = expected.closed;
    let expected = expected.rows;
    let mut sensitive = Horizon { scene, expected: &expected, rows: None };
    let own = slipfit(scene, EVERY)?;
    let transform = transform::ALL[verdict.seed as usize % transform::ALL.len()];
    let (other, order) = transform.scene(scene, verdict.seed);
    let interval = transform.interval(EVERY);
    let moved = slipfit(&other, interval).map_err(|error| format!("{transform:?}: {error}"))?;
    if transform == Transform::Renamed && format!("{moved:?}") != format!("{own:?}") {
        return Err("other names change bits".into());
    }
    let to_meet = transform.rows(scene, &expected, &order);
    let comparisons =
        [(scene, &expected, &own, "slipfit".to_owned()), (&other, &to_meet, &moved, format!("{transform:?}"))];
    for (scene, expected, found, name) in comparisons {
        verdict.differences.extend(sensitive.differences(scene, expected, found, &name)?);
    }
    verdict.compared = sensitive.rows.map_or(1.0, |rows| rows as f64 / expected.len() as f64);
    if scene.drives.is_empty() {
        energy(scene, forces, &own)?;
    }
    momentum(scene, &own)
}

/// slipfit's motion of `scene`, as `simulate` gives it.
fn slipfit(scene: &Scene, every: f64) -> Result<Vec<Row>, String> {
    let text = scene.toml(ERROR);
    let file = SceneFile::parse("random.toml", &text, &[]).map_err(|error| format!("refused: {error}"))?;
    let mechanism = file.mechanism.ok_or("no mechanism")?;
    let gaps = mechanism.gaps_at(&[0.0]).map_err(|error| error.to_string())?;
    let [run, _] = confirmed(&mechanism, &gaps, every).map_err(|error| error.to_string())?;
    let rows: Vec<Row> = run.samples.rows.iter().map(|numbers| Row::of(scene, numbers)).collect();
    match rows.iter().find(|row| !row.is_finite()) {
        Some(row) => Err(format!("not finite at {} s", row.t)),
        None => Ok(rows),
    }
}

/// Up to which row a motion can be compared: looked for only where a difference asks for it.
struct Horizon<'a> {
    scene: &'a Scene,
    expected: &'a [Row],
    rows: Option<usize>,
}

impl Horizon<'_> {
    /// The differences of `found` from `expected`, up to the horizon where they are too large beyond.
    fn differences(
        &mut self,
        scene: &Scene,
        expected: &[Row],
        found: &[Row],
        name: &str,
    ) -> Result<Vec<(Column, f64)>, String> {
        if expected.len() != found.len() {
            return Err(format!("{name}: {} rows for {}", found.len(), expected.len()));
        }
        let upto = |rows: usize| differences(scene, expected, &found[..rows]);
        let all_rows = self.rows.unwrap_or(expected.len());
        let all = upto(all_rows);
        if worst(&all).1 <= ALLOWED {
            return Ok(all);
        }
        let from = (1..=all_rows).find(|rows| worst(&upto(*rows)).1 > ALLOWED).unwrap_or(all_rows);
        let rows = horizon(self.scene, self.expected, from);
        self.rows = Some(rows);
        let before = upto(rows);
        let ((column, of), share) = worst(&before);
        if share <= ALLOWED {
            return Ok(before);
        }
        let t = self.expected[from - 1].t;
        Err(format!("{name}: {column} of {of} differs by {:.3} % of its peak at {t} s", 100.0 * share))
    }
}

/// How many of the first `rows` of the independent integration depend little enough on its start and its tolerance.
fn horizon(scene: &Scene, expected: &[Row], mut rows: usize) -> usize {
    let mut scene = scene.clone();
    scene.duration = EVERY * (rows - 1) as f64;
    let finer = std::iter::once((TOLERANCE[1], 0.0));
    let nudged = NUDGES.into_iter().map(|nudge| (TOLERANCE[0], nudge));
    for (tolerance, nudge) in finer.chain(nudged) {
        let Some(other) = integrate(&scene, EVERY, tolerance, nudge) else { continue };
        let differs = |rows: &usize| worst(&differences(&scene, expected, &other.rows[..*rows])).1 > SENSITIVE;
        rows = (1..=rows).find(differs).map_or(rows, |first| first - 1);
        scene.duration = EVERY * rows.saturating_sub(1) as f64;
    }
    rows
}

/// Whether the energy of slipfit's motion falls only.
fn energy(scene: &Scene, forces: &Forces, rows: &[Row]) -> Result<(), String> {
    let energies: Vec<[f64; 2]> = rows.iter().map(|row| row.energies(scene, forces)).collect();
    let kinetic = energies.iter().map(|energies| energies[0]).fold(0.0, f64::max);
    let mut least = f64::INFINITY;
    for (row, [kinetic_now, stored]) in rows.iter().zip(&energies) {
        let now = kinetic_now + stored;
        if now > least + ENERGY * kinetic {
            return Err(format!(
                "the energy grows by {:.2e} of the kinetic one at {} s",
                (now - least) / kinetic,
                row.t
            ));
        }
        least = least.min(now);
    }
    Ok(())
}

/// Whether slipfit's motion keeps the momentum where nothing is joined to the frame.
fn momentum(scene: &Scene, rows: &[Row]) -> Result<(), String> {
    let held = scene.joints.iter().map(|joint| joint.between).chain(scene.springs.iter().map(|spring| spring.between));
    if !scene.drives.is_empty() || held.into_iter().any(|between| between.contains(&None)) {
        return Ok(());
    }
    let momenta: Vec<_> = rows.iter().map(|row| row.momenta(scene)).collect();
    for k in 0..2 {
        let part = |row: &Row| {
            let of = |(body, moved): (&super::scene::Body, &super::motion::Moved)| {
                [body.mass * moved.velocity.norm(), body.inertia.max() * moved.spin.norm()][k]
            };
            scene.bodies.iter().zip(&row.bodies).map(of).fold(0.0, f64::max)
        };
        let peak = rows.iter().map(part).fold(0.0, f64::max);
        let drift = momenta.iter().map(|momentum| (momentum[k] - momenta[0][k]).norm()).fold(0.0, f64::max);
        if drift > ENERGY * peak.max(LEAST_MOMENTUM) {
            return Err(format!("{} drifts by {drift:.2e} of {peak:.2e}", ["momentum", "angular momentum"][k]));
        }
    }
    Ok(())
}
