//! The warning of a guide that locks itself, of slides and mechanisms.

use slipfit_tolerance::number::fixed;

/// Angles (rad) to the travel that count as none.
const ALONG: f64 = 1e-6;

/// The warning of a guide that locks, pushed at an `angle` (rad) to its travel, with the `levers` of its drive: length of the guide and
/// distance of the drive (m), and where it is.
pub fn self_locking(friction: f64, critical: f64, angle: f64, levers: &[([f64; 2], &str)], meaning: &str) -> String {
    let lever = |([length, distance], whence): &([f64; 2], &str)| {
        let [length, distance] = [length, distance].map(|x| fixed(x.abs() * 1e3, 1));
        format!("a guide {length} mm long, driven {distance} mm {whence} it")
    };
    let oblique = (angle > ALONG).then(|| format!("a guide pushed at {}° to its travel", fixed(angle.to_degrees(), 1)));
    let along = if oblique.is_some() { "Drive along the travel and" } else { "Drive" };
    let causes = oblique.into_iter().chain(levers.iter().map(lever)).collect::<Vec<_>>().join(", and ");
    format!(
        "self-locking: friction {friction} is not below the critical {critical:.4} of {causes}: {meaning}. {along} nearer to the \
         guide, lengthen the guide, or lower the friction"
    )
}
