//! What hangs on what by ideal joints: the tree of a mechanism.

use super::{Mechanism, Port};

/// What makes no tree, or too large a one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MountError {
    /// A joint that closes a loop of ideal joints.
    #[error("the joint \"{joint}\" closes a loop of joints without play")]
    Loop {
        /// Its name.
        joint: String,
    },
    /// More coordinates than there is room for.
    #[error("the mechanism has {found} coordinates, allowed are {most}")]
    Coordinates {
        /// How many.
        found: usize,
        /// How many there may be.
        most: usize,
    },
}

/// How a body hangs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hung {
    /// Which body.
    pub body: usize,
    /// On what.
    pub on: Port,
    /// By which joint; `None` for a body that nothing holds without play.
    pub by: Option<usize>,
}

/// The bodies of `mechanism`, each after the one that it hangs on.
///
/// # Errors
/// [`MountError::Loop`].
pub fn hanging(mechanism: &Mechanism) -> Result<Vec<Hung>, MountError> {
    let mut hung: Vec<Hung> = Vec::new();
    let mut used = vec![false; mechanism.joints.len()];
    loop {
        let hangs = |port: Port| port.is_none_or(|body| hung.iter().any(|other| other.body == body));
        let next = mechanism
            .joints
            .iter()
            .enumerate()
            .find(|(i, joint)| !used[*i] && joint.kind.is_ideal() && joint.between.iter().any(|port| hangs(*port)));
        if let Some((i, joint)) = next {
            used[i] = true;
            let found = match (joint.between.map(hangs), joint.between) {
                ([true, false], [on, Some(body)]) | ([false, true], [Some(body), on]) => Hung { body, on, by: Some(i) },
                _ => return Err(MountError::Loop { joint: joint.name.clone() }),
            };
            hung.push(found);
        } else if let Some(body) = (0..mechanism.bodies.len()).find(|body| !hangs(Some(*body))) {
            hung.push(Hung { body, on: None, by: None });
        } else {
            return Ok(hung);
        }
    }
}
