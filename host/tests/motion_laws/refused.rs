//! Drives, springs, friction and walls that make no sense are refused at their place.

use super::{STAGE, wedge};
use slipfit::scene::SceneFile;

/// What is wrong with a scene, with the place that the message shows.
fn refused(scene: &str) -> String {
    match SceneFile::parse("scene.toml", scene, &[]) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("accepted:\n{scene}"),
    }
}

#[test]
fn what_makes_no_sense_is_refused_at_its_place() {
    let drive = |rest: &str| {
        format!(
            "mechanism = {{ space = \"plane\" }}\n{STAGE}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = 1\n{rest}"
        )
    };
    let ramp = "ramp_start = 0\nramp_end = 1\nspeed = 10\n";
    for (scene, needle) in [
        (drive("segment = [{ kind = \"jump\" }]\n"), "ramp, hold, sine, chirp"),
        (drive("segment = [{ kind = \"ramp\", speed = 1 }]\n"), "duration, or acceleration"),
        (drive("segment = [{ kind = \"ramp\", speed = 1, duration = 1, acceleration = 1 }]\n"), "beside `duration`"),
        (drive("segment = [{ kind = \"hold\", duration = 1 }]\n"), "a speed other than 0"),
        (
            drive(
                "segment = [{ kind = \"hold\", duration = 1, speed = 3 }, { kind = \"ramp\", speed = 1, duration = 1 }]\n",
            ),
            "has no effect",
        ),
        (drive("segment = [{ kind = \"sine\", amplitude = 1, frequency = 1000, duration = 1 }]\n"), "pieces"),
        (drive("segment = [{ kind = \"ramp\", speed = 1, duration = 1 }]\ncycles = 2\n"), "end at rest"),
        (drive("segment = [{ kind = \"ramp\", speed = 1, duration = 1 }]\nspeed = 3\n"), "beside segments"),
        (drive(&format!("{ramp}cycles = 2\n")), "without segments"),
        (drive(&format!("{ramp}limit = -1\n")), "drive.limit"),
        (drive(&format!("{ramp}limit = \"1 N·m\"\n")), "unit"),
        (drive(&format!("{ramp}coulomb = 1\n")), "drive.stick_band"),
        (drive(&format!("{ramp}stick_band = 1\n")), "has no effect"),
        (drive(&format!("{ramp}rotor = 100\n")), "drive.travel"),
        (drive(&format!("{ramp}gear = 3\n")), "without `rotor`"),
        (
            drive(&format!("{ramp}rotor = 100\ntravel = 8\n")).replace("axis = [1, 0]\ngain", "axis = [0, 1]\ngain"),
            "a rotor that moves",
        ),
        (
            drive(&format!(
                "{ramp}[[spring]]\nname = \"s\"\nbetween = [\"stage\", \"frame\"]\nends = [[0, 0], [0, 0]]\nstiffness = 1\n"
            )),
            "1 µm apart",
        ),
        (
            drive(&format!(
                "{ramp}[[spring]]\nname = \"s\"\nbetween = [\"stage\", \"frame\"]\nstiffness = 0\npreload = 1\n"
            )),
            "without stiffness",
        ),
        (
            drive(&format!(
                "{ramp}[[spring]]\nname = \"s\"\nbetween = [\"stage\", \"frame\"]\nstiffness = 1\nfree_length = 1\n"
            )),
            "has no effect",
        ),
        (drive(ramp).replace("[[drive]]", "slope = 0.1\n[[drive]]"), "`joint.slope`"),
        (wedge(0.01, 0.2, ramp).replace("slope = 0.01", "slope = [0.1, 0.2, 0.3]"), "a list of 2"),
        (wedge(0.01, 0.2, ramp).replace("slope = 0.01", "bow = 0.1"), "over a length"),
        (
            wedge(0.01, 0.2, ramp).replace("[[drive]]", "along = [{ at = 9, clearance = [1, 0] }]\n[[drive]]"),
            "beside `slope`",
        ),
        (wedge(0.01, 0.2, ramp).replace("slope = 0.01", "along = [{ at = 9 }]"), "clearance"),
        (wedge(0.01, 0.2, ramp).replace("slope = 0.01", "along = [{ at = 0, clearance = [1, 0] }]"), "0.1 mm or more"),
        (wedge(0.01, 0.2, ramp).replace("slope = 0.01", "along = []"), "one or two tables"),
        (
            wedge(0.01, 0.2, ramp).replace("slope = 0.01", "along = [{ at = 1, clearance = [5, 0] }]"),
            "gaps that give a slope of 0.5 at most",
        ),
        (
            wedge(0.01, 0.2, ramp).replace("slope = 0.01", "along = [{ at = 99, clearance = [1, 0], left = [1, 0] }]"),
            "has no effect at a joint of this kind",
        ),
        // At −20 mm the lines have come together by 2.8 mm on either side, however wide they are far away.
        (
            wedge(0.01, 0.2, ramp).replace("slope = 0.01", "along = [{ at = -100, clearance = [-18.8, 0] }]"),
            "tears `guide` open",
        ),
        // At ± 20 mm the lines have come together by 4 mm on either side, of a gap of 1.2 mm.
        (wedge(0.2, 0.2, ramp), "tears `guide` open"),
        (wedge(0.0, 0.2, ramp).replace("slope = 0", "bow = [-100, 100]"), "tears `guide` open"),
        (wedge(0.01, 0.2, ramp).replace("stick_band = 0.001", "stick_band = 0.001\nstatic_coefficient = 0.1"), "0.2"),
        (
            wedge(0.01, 0.2, ramp).replace("stick_band = 0.001", "stick_band = 0.001\nstatic_coefficient = 0.3"),
            "stribeck_speed",
        ),
        (
            wedge(0.01, 0.2, ramp).replace("stick_band = 0.001", "stick_band = 0.001\nstribeck_speed = 0.3"),
            "has no effect",
        ),
        (wedge(0.01, 0.2, ramp).replace("\"regularised\"", "\"exact\"\nviscous = 1"), "has no effect"),
    ] {
        let scene =
            if scene.contains("mechanism =") { scene } else { format!("mechanism = {{ space = \"plane\" }}\n{scene}") };
        let message = refused(&scene);
        assert!(message.contains(needle) && message.contains("scene.toml:"), "{needle} in\n{message}");
    }
}
