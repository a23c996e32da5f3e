//! Friction of drives, joints and contacts.

use std::f64::consts::PI;

use super::{MASS, STAGE, columns, follows, planar, ran, stage};

#[test]
fn what_coasts_comes_to_rest_when_its_friction_says() {
    for (coulomb, viscous, offset) in [(1.5, 4.0, 0.0), (1.5, 0.0, 0.3), (0.8, 10.0, -0.4)] {
        let scene = format!(
            "{}[[drive]]\nname = \"motor\"\npushes = \"stage\"\naxis = [1, 0]\ngain = 0\nramp_start = 0\nramp_end = 1\nspeed = 0\n\
             coulomb = {coulomb}\nviscous = \"{viscous} N·s/m\"\noffset = {offset}\nstick_band = 0.001\n",
            STAGE.replace("centre = [0, 0]", "centre = [0, 0]\nspeed = 300")
        );
        let run = planar(&scene, &[]);
        let held = coulomb + offset;
        let speed = |t: f64| match viscous {
            0.0 => 0.3 - held / MASS * t,
            c => (0.3 + held / c) * libm::exp(-c / MASS * t) - held / c,
        };
        let rest = match viscous {
            0.0 => 0.3 * MASS / held,
            c => MASS / c * libm::log(0.3 * c / held + 1.0),
        };
        assert!(rest < 0.9, "{rest}");
        follows(&run, [2e-6, 1e-9], |t| if t < rest - 1e-4 { speed(t) } else { 0.0f64.max(speed(t)) }, |_, _| 0.0);
    }
}

#[test]
fn friction_may_differ_between_both_directions() {
    // Pushed back and forth at constant speed the motor gives 1 + 2·0.05 + 0.25 N one way, −(2 + 2·0.05) + 0.25 N the other.
    let run = stage(
        "coulomb = [1, 2]\nviscous = \"2 N·s/m\"\noffset = 0.25\nstick_band = 0.01\n\
         segment = [{ kind = \"ramp\", speed = 50, duration = 0.1 }, { kind = \"hold\", duration = 0.4 },\n\
         { kind = \"ramp\", speed = -50, duration = 0.1 }, { kind = \"hold\", duration = 0.4 }]\n",
    );
    for [t, v, force] in columns(&run, ["t (s)", "stage.vx (m/s)", "motor.force (N)"]) {
        let expected = match t {
            t if t > 0.45 && t < 0.5 => 1.0 + 2.0 * v + 0.25,
            t if t > 0.95 => -2.0 + 2.0 * v + 0.25,
            _ => continue,
        };
        assert!((force - expected).abs() < 1e-3, "{t} {force} {expected}");
    }
}

/// A block of 1 kg on a floor, pulled by a spring of 100 N/m from a carriage at 20 mm/s: with a static coefficient of 0.3 and a kinetic one
/// of 0.2 it sticks and slips.
fn stick_slip(friction: &str) -> f64 {
    let scene = format!(
        "[run]\nduration = 12000\nerror = 1e-8\n[contact]\nstiffness = 100\nexponent = 1\ndamping = 1\ndepth = 0.01\n[friction]\n{friction}\n\
         [[body]]\nname = \"block\"\nmass = 1000\ninertia = 1e6\ncentre = [0, 0]\n\
         [[body]]\nname = \"carriage\"\nmass = 1000\ninertia = 1e6\ncentre = [100, 0]\nspeed = 20\n\
         [[joint]]\nname = \"rail\"\nkind = \"prismatic\"\nbetween = [\"frame\", \"carriage\"]\nat = [100, 0]\naxis = [1, 0]\n\
         [[joint]]\nname = \"heel\"\nkind = \"stop\"\nbetween = [\"block\", \"frame\"]\nat = [-50, 0]\nnormal = [0, 1]\nclearance = [0, 0]\n\
         [[joint]]\nname = \"toe\"\nkind = \"stop\"\nbetween = [\"block\", \"frame\"]\nat = [50, 0]\nnormal = [0, 1]\nclearance = [0, 0]\n\
         [[spring]]\nname = \"spring\"\nbetween = [\"block\", \"carriage\"]\nends = [[0, 0], [100, 0]]\nstiffness = 0.1\n\
         [[drive]]\nname = \"motor\"\npushes = \"carriage\"\naxis = [1, 0]\ngain = \"1e6 N·s/m\"\nramp_start = -1\nramp_end = 0\nspeed = 20\n"
    );
    let run = planar(&scene, &[]);
    // Slips begin where the speed comes up through 5 mm/s.
    let rows = columns(&run, ["t (s)", "block.vx (m/s)"]);
    let begins: Vec<f64> = rows
        .windows(2)
        .filter(|two| two[0][1] < 5e-3 && two[1][1] >= 5e-3)
        .map(|two| two[0][0] + 1e-3 * (5e-3 - two[0][1]) / (two[1][1] - two[0][1]))
        .collect();
    assert!(begins.len() >= 8, "{begins:?}");
    (begins[begins.len() - 1] - begins[1]) / (begins.len() - 2) as f64
}

#[test]
fn a_block_on_a_spring_sticks_and_slips_with_its_textbook_period() {
    let (omega, v) = (10.0f64, 0.02);
    let drop = (0.3 - 0.2) * 9.81 / 100.0;
    let expected = 2.0 * drop / v + 2.0 / omega * (PI - libm::atan(drop * omega / v));
    for (friction, within) in [
        ("law = \"exact\"\ncoefficient = 0.2\nstatic_coefficient = 0.3", 0.002),
        (
            "law = \"regularised\"\ncoefficient = 0.2\nstatic_coefficient = 0.3\nstribeck_speed = 0.05\nstick_band = 0.002",
            0.002,
        ),
    ] {
        let found = stick_slip(friction);
        assert!((found / expected - 1.0).abs() < within, "{friction}: {found} {expected}");
    }
}

#[test]
fn an_ideal_joint_may_have_friction_of_its_own() {
    // Thrown, each slows down evenly and by its viscous part: v = (v₀ + c/d)·exp(−d·t/m) − c/d until it is at rest.
    let body = |what: &str, three: bool, start: &str| {
        let list = |x: &str| if three { format!("[{x}, {x}, {x}]") } else { x.to_owned() };
        let centre = if three { "[0, 0, 0]" } else { "[0, 0]" };
        format!(
            "[[body]]\nname = \"{what}\"\nmass = 2000\ninertia = {}\ncentre = {centre}\n{start}\n",
            list("\"1e-3 kg·m²\"")
        )
    };
    let joint = |kind: &str, three: bool, axis: &str, between: &str, friction: &str| {
        let at = if three { "[0, 0, 0]" } else { "[0, 0]" };
        format!(
            "[[joint]]\nname = \"joint\"\nkind = \"{kind}\"\nbetween = [{between}]\nat = {at}\n{axis}\n{friction}\n"
        )
    };
    let slides = "coulomb = [1.5, 9]\nviscous = \"4 N·s/m\"\nstick_band = 0.001";
    let turns = "coulomb = \"2 N·mm\"\nviscous = \"4e-3 N·m·s/rad\"\nstick_band = 1e-4";
    for (scene, column, [start, inertia, coulomb, viscous]) in [
        (
            body("stage", false, "speed = 300")
                + &joint("prismatic", false, "axis = [1, 0]", "\"stage\", \"frame\"", slides),
            "stage.vx (m/s)",
            [0.3, 2.0, 1.5, 4.0],
        ),
        (
            body("stage", true, "speed = 300")
                + &joint("prismatic", true, "axis = [0, 1, 0]", "\"frame\", \"stage\"", slides),
            "stage.vy (m/s)",
            [0.3, 2.0, 1.5, 4.0],
        ),
        (
            body("wheel", false, "spin = 0.5") + &joint("revolute", false, "", "\"frame\", \"wheel\"", turns),
            "wheel.spin (rad/s)",
            [0.5, 1e-3, 2e-3, 4e-3],
        ),
        (
            body("wheel", true, "spin = 0.5")
                + &joint("revolute", true, "axis = [0, 0, 1]", "\"frame\", \"wheel\"", turns),
            "wheel.wz (rad/s)",
            [0.5, 1e-3, 2e-3, 4e-3],
        ),
    ] {
        let space = if column.contains("vy") || column.contains("wz") { "space" } else { "plane" };
        let run = ran(
            &format!("mechanism = {{ space = \"{space}\" }}\nrun = {{ duration = 500, error = 1e-7 }}\n{scene}"),
            &[],
        );
        let (rate, held) = (viscous / inertia, coulomb / viscous);
        let rest = libm::log(start / held + 1.0) / rate;
        for [t, speed] in columns(&run, ["t (s)", column]) {
            let expected = if t < rest { (start + held) * libm::exp(-rate * t) - held } else { 0.0 };
            assert!((speed - expected).abs() < 3e-5 * start.max(expected), "{column} {t}: {speed} {expected}");
        }
    }
}

#[test]
fn what_friction_differs_by_is_the_motion_not_the_order_of_the_bodies() {
    // Turned from x to y at 10 rad/s the motor gives the first number.
    for (space, axis) in [("plane", ""), ("space", "axis = [0, 0, 1]\n")] {
        for between in ["\"frame\", \"wheel\"", "\"wheel\", \"frame\""] {
            let (at, inertia) = match space {
                "plane" => ("[0, 0]", "\"1e-3 kg·m²\""),
                _ => ("[0, 0, 0]", "[\"1e-3 kg·m²\", \"1e-3 kg·m²\", \"1e-3 kg·m²\"]"),
            };
            let scene = format!(
                "mechanism = {{ space = \"{space}\" }}\nrun = {{ duration = 400 }}\n\
                 [[body]]\nname = \"wheel\"\nmass = 100\ninertia = {inertia}\ncentre = {at}\n\
                 [[joint]]\nname = \"axle\"\nkind = \"revolute\"\nbetween = [{between}]\nat = {at}\n{axis}\
                 coulomb = [\"0.02 N·m\", \"0.05 N·m\"]\nstick_band = 0.1\n\
                 [[drive]]\nname = \"motor\"\nturns = \"wheel\"\n{axis}gain = 5\nramp_start = 0\nramp_end = 0.1\nspeed = 10\n"
            );
            let torque = columns(&ran(&scene, &[]), ["motor.torque (N·m)"]).last().unwrap()[0];
            assert!((torque - 0.02).abs() < 1e-6, "{space} {between}: {torque}");
        }
    }
}
