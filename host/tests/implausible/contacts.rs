//! Damping, its depth, gains and pins that are possible but implausible.

use super::{CD_ROM_SLIDE, LEVER, warned, warnings};
use slipfit::scene::shipped;

/// Critical damping by hand: 2·√(1.5·√d·k·m), here 2·√(1.5·√1e-4·3.162e6·0.0818) = 124.6 N·s/m.
#[test]
fn damping_is_not_a_thousand_times_what_stops_a_part() {
    let times = |damping: f64| format!("damping = {damping}");
    let text = ["`contact.damping` is 125 N·s/mm: 1000 times the 0.125 N·s/mm", "stops 81.8 g without a rebound"];
    warned(CD_ROM_SLIDE, ["damping = 1 ", "damping = 125 ", "125 "], &text);
    assert_eq!(warnings(&CD_ROM_SLIDE.replace("damping = 1 ", &times(124.0)), &[]), [""; 0]);
    // The lever: 2·√(1.5·√1e-5·1e7·0.1) = 137.7 N·s/m.
    warned(LEVER, ["\"10 N·s/m\"", "140", "140, depth"], &["`contact.damping` is 140 N·s/mm: 1020 times"]);
}

#[test]
fn damping_is_reached_within_a_gap() {
    let parts = ["`contact.depth` is 1000 mm, where the widest gap is 0.967 mm"];
    warned(CD_ROM_SLIDE, ["depth = 0.1 ", "depth = 1000 ", "1000 "], &parts);
    assert_eq!(warnings(CD_ROM_SLIDE, &["contact.depth=9"]), [""; 0]);
    assert_eq!(warnings(CD_ROM_SLIDE, &["contact.depth=10"]).len(), 1);
}

#[test]
fn a_drive_without_gain_is_told() {
    let found = warnings(CD_ROM_SLIDE, &["drive.gain=0"]);
    assert!(found.iter().any(|one| one.contains("`drive.gain` is 0: the drive exerts no force")), "{found:?}");
    warned(LEVER, ["gain = 0.1", "gain = 0", "0\nramp_start"], &["`drive.gain` is 0"]);
}

#[test]
fn a_pin_is_larger_than_its_play() {
    let four_bar = shipped("four-bar").unwrap();
    let found = warnings(four_bar, &["joint.rocker pin.radius=0.01"]);
    assert!(matches!(&found[..], [one] if one.contains("is 0.01 mm, less than the radial clearance")), "{found:?}");
    // A pin of no radius rubs without a torque.
    assert_eq!(warnings(four_bar, &["joint.rocker pin.radius=0"]), [""; 0]);
}
