//! Which holds of a motion have a verdict.

use super::{GAIN, MASS, STAGE, columns, planar, stage};
use slipfit::mechanism::confirmed;
use slipfit::scene::{Override, SceneFile};

#[test]
fn cycles_repeat_and_a_verdict_looks_at_each_hold() {
    let cycle = "cycles = 2\nsegment = [{ kind = \"ramp\", speed = 100, duration = 0.1 }, { kind = \"hold\", duration = 0.15 },\n\
                 { kind = \"ramp\", speed = -100, duration = 0.1 }, { kind = \"hold\", duration = 0.1 },\n\
                 { kind = \"ramp\", speed = 0, duration = 0.05 }]\n";
    let run = stage(cycle);
    let rows = columns(&run, ["t (s)", "stage.vx (m/s)"]);
    for k in 0..450 {
        // The first cycle starts at rest, the second with what is left of its last ramp.
        let left = rows[500][1] * libm::exp(-(k as f64) * 1e-3 * GAIN / MASS);
        assert!((rows[k][1] + left - rows[500 + k][1]).abs() < 1e-7, "{k}");
    }
    assert_eq!(run.outcomes[0].verdict.to_string(), "runs");
    // A wall on the way back: the way out runs, the way back does not.
    let blocked = |normal: f64, gap: f64| {
        let wall = format!(
            "[[joint]]\nname = \"wall\"\nkind = \"stop\"\nbetween = [\"stage\", \"frame\"]\nat = [0, 0]\nnormal = [{normal}, 0]\n\
             clearance = [{gap}, 0]\ncontact = {{ stiffness = 1000, exponent = 1, damping = 1, depth = 0.01 }}\n"
        );
        let drive = "[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = \"50 N·s/m\"\n\
                     segment = [{ kind = \"ramp\", speed = 100, duration = 0.1 }, { kind = \"hold\", duration = 0.15 },\n\
                     { kind = \"ramp\", speed = -100, duration = 0.1 }, { kind = \"hold\", duration = 0.4 },\n\
                     { kind = \"ramp\", speed = 0, duration = 0.05 }]\n";
        planar(&format!("{STAGE}{wall}{drive}"), &[]).outcomes[0].verdict.to_string()
    };
    assert_eq!([blocked(-1.0, 3.0), blocked(1.0, 1.0), blocked(1.0, 30.0)], ["jammed", "jammed", "runs"]);
}

/// The verdict of the stage that a finer run confirms, and whether there is one at all.
fn confirmed_verdict(drive: &str, set: &[&str]) -> String {
    let scene = format!(
        "mechanism = {{ space = \"plane\" }}\n{STAGE}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\n{drive}"
    );
    let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    let mechanism =
        SceneFile::parse("scene.toml", &scene, &set).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap();
    confirmed(&mechanism, &[], 1e-3).unwrap()[0].outcomes[0].verdict.to_string()
}

#[test]
fn a_motion_that_ends_at_rest_or_where_it_began_has_a_verdict() {
    let there = "segment = [{ kind = \"ramp\", speed = 100, acceleration = 2 }, { kind = \"hold\", duration = 0.2 },\n\
                 { kind = \"ramp\", speed = 0, acceleration = 2 }]\n";
    let and_back = "segment = [{ kind = \"ramp\", speed = 100, acceleration = 2 }, { kind = \"hold\", duration = 0.2 },\n\
                    { kind = \"ramp\", speed = -100, acceleration = 2 }, { kind = \"hold\", duration = 0.2 },\n\
                    { kind = \"ramp\", speed = 0, acceleration = 2 }]\n";
    for (segments, length) in [(there, 300.0), (and_back, 600.0)] {
        for duration in [length, length + 1.0, length + 20.0, 1000.0, 3000.0] {
            let drive = format!("gain = 1\n{segments}");
            let verdict = confirmed_verdict(&drive, &[&format!("run.duration={duration}")]);
            assert_eq!(verdict, "runs", "{duration}: {segments}");
        }
    }
    // What does not come back is jammed, and so is what never moved, whenever the run ends after it should have.
    let sticks = |coulomb: &str| format!("gain = 0.2\nlimit = 5\ncoulomb = {coulomb}\nstick_band = 0.1\n{and_back}");
    assert_eq!(confirmed_verdict(&sticks("[0.5, 6]"), &["run.duration=1500"]), "jammed");
    for duration in [260, 400, 550, 700] {
        assert_eq!(confirmed_verdict(&sticks("6"), &[&format!("run.duration={duration}")]), "jammed", "{duration}");
    }
    // A wave about zero commands no speed to be judged by.
    let wave = "gain = 1\nsegment = [{ kind = \"sine\", amplitude = 50, frequency = 5, duration = 1 }]\n";
    assert_eq!(confirmed_verdict(wave, &[]), "undecided");
    assert_eq!(confirmed_verdict(&format!("cycles = 2\n{wave}"), &["run.duration=2000"]), "undecided");
}
