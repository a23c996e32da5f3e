//! How deep contacts yield in a run: deeper than the gaps of their joints they are no model of parts that touch.

use super::{Mechanism, joint_elements::joints_of_elements};

/// Depth (m) that is never too much, whatever the gaps are.
pub(super) const LEAST: f64 = 1e-4;

/// A contact that yielded deeper than the gaps of its mechanism are wide.
#[derive(Clone, Debug, PartialEq)]
pub struct Sunk {
    /// The joint whose contact it is.
    pub joint: String,
    /// How deep (m) it was at most.
    pub depth: f64,
    /// How deep (m) it may usually be: the widest gap of the mechanism, or of a stop its own.
    pub usual: f64,
}

/// How deep (m) each element of a mechanism has been, as far as they are contacts.
pub(super) struct Depths(Vec<f64>);

impl Depths {
    /// With these `gaps` (m) at the start.
    pub fn new(gaps: Vec<Option<f64>>) -> Self {
        Self(gaps.into_iter().map(|gap| -gap.unwrap_or(0.0)).collect())
    }

    /// Takes note of the `gaps` (m) of all elements.
    pub fn observe(&mut self, gaps: Vec<Option<f64>>) {
        for (deepest, gap) in self.0.iter_mut().zip(gaps) {
            *deepest = deepest.max(-gap.unwrap_or(0.0));
        }
    }

    /// The contact of `mechanism` that was deepest beside what is usual, if it was deeper than that.
    pub fn sunk(&self, mechanism: &Mechanism) -> Option<Sunk> {
        let widest = mechanism.widest_gap();
        let contacts = self.0.iter().zip(joints_of_elements(mechanism)).filter_map(|(depth, joint)| {
            let joint = joint?;
            let of_stop = if joint.kind.is_stop() { mechanism.widest_of(joint) } else { 0.0 };
            let usual = LEAST.max(widest).max(of_stop);
            (*depth > usual).then(|| Sunk { joint: joint.name.clone(), depth: *depth, usual })
        });
        contacts.max_by(|a, b| (a.depth / a.usual).total_cmp(&(b.depth / b.usual)))
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        mechanism::run,
        scene::{Override, SceneFile},
    };

    /// A block of 0.1 kg on an ideal slide, 1 mm before a stop without damping to speak of.
    const BLOCK: &str = r#"
mechanism = { space = "plane", gravity = [0, 0] }
contact = { stiffness = "1000 N/m^1.5", exponent = 1.5, damping = "1e-6 N·s/m", depth = 0.01 }
run = { duration = 80 }
[[body]]
name = "block"
mass = 100
inertia = 1e5
centre = [0, 0]
speed = 1000
[[joint]]
name = "slide"
kind = "prismatic"
between = ["block", "frame"]
at = [0, 0]
axis = [1, 0]
[[joint]]
name = "end"
kind = "stop"
between = ["block", "frame"]
at = [0, 0]
normal = [-1, 0]
clearance = [1, 0]
"#;

    /// The joint that sinks, and its depth (m), of a run with these settings.
    fn sunk(set: &[&str]) -> Option<(String, f64)> {
        let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
        let file = SceneFile::parse("m.toml", BLOCK, &set).unwrap_or_else(|error| panic!("{error}"));
        let mechanism = file.mechanism.unwrap();
        run(&mechanism, &mechanism.gaps_at(&[0.0]).unwrap(), 1e-3).unwrap().sunk.map(|sunk| (sunk.joint, sunk.depth))
    }

    #[test]
    fn a_blow_sinks_as_deep_as_its_energy_says() {
        let deep = |stiffness: f64| libm::pow(0.5 * 0.1 * 2.5 / stiffness, 0.4);
        let (joint, depth) = sunk(&[]).unwrap();
        assert!(joint == "end" && (depth / deep(1e3) - 1.0).abs() < 0.01, "{depth} for {}", deep(1e3));
        // Just deeper than the gap of 1 mm, and just not.
        for (share, sinks) in [(1.1, true), (0.9, false)] {
            let stiffness = 0.5 * 0.1 * 2.5 / libm::pow(share * 1e-3, 2.5);
            let found = sunk(&[&format!("contact.stiffness={stiffness} N/m^1.5"), "run.duration=5"]);
            assert_eq!(found.is_some(), sinks, "{share}: {found:?}");
        }
    }
}
