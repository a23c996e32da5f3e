//! Contacts that steps could pass over, against closed forms and an independent integration.

use super::{
    Mechanism,
    motion_tests::{column, greatest, independent, scene, simulated},
};

/// A ball of 100 g on a rail along `axis`, thrown at `speed` (m/s), with stops `ahead` and `behind` (mm).
pub(super) fn ball(
    axis: [i32; 2],
    speed: f64,
    [ahead, behind]: [f64; 2],
    exponent: f64,
    stiffness: f64,
    error: f64,
) -> Mechanism {
    scene(&ball_text(axis, speed, [ahead, behind], exponent, stiffness, error))
}

/// The scene of [`ball`].
fn ball_text(
    [x, y]: [i32; 2],
    speed: f64,
    [ahead, behind]: [f64; 2],
    exponent: f64,
    stiffness: f64,
    error: f64,
) -> String {
    format!(
        r#"
title = "Ball between two stops"
[mechanism]
space = "plane"
gravity = [0, -9.81]
[contact]
stiffness = "{stiffness} N/m^{exponent}"
exponent = {exponent}
damping = 0
depth = 0.1
[friction]
law = "none"
[[body]]
name = "ball"
mass = 100
inertia = "1e-6 kg·m²"
centre = [0, 0]
speed = "{speed} m/s"
[[joint]]
name = "rail"
kind = "prismatic"
between = ["frame", "ball"]
at = [0, 0]
axis = [{x}, {y}]
[[joint]]
name = "ahead"
kind = "stop"
between = ["ball", "frame"]
at = [0, 0]
normal = [{}, {}]
clearance = [{ahead}, 0]
[[joint]]
name = "behind"
kind = "stop"
between = ["ball", "frame"]
at = [0, 0]
normal = [{x}, {y}]
clearance = [{behind}, 0]
[run]
duration = 200
error = {error}
"#,
        -x, -y
    )
}

/// A ball that leaves a stop faster than its spring can follow is not pushed until damping, which fades out with the depth, is small
/// enough. A step that begins where nothing pushes must not end beyond all of it.
#[test]
fn a_ball_that_leaves_a_damped_stop_is_pushed_at_last() {
    // Depth at the start and depth of full damping (m), damping (N·s/m), stiffness (N/m), speed (m/s).
    let starts = [
        [63.2e-6, 43.7e-6, 3520.0, 2.80e6, 0.0618],
        [275e-6, 99.5e-6, 4270.0, 1.63e6, 0.106],
        [224e-6, 165e-6, 2810.0, 2.52e6, 0.343],
        [32.8e-6, 58.1e-6, 5820.0, 4.92e6, 0.181],
        [69.4e-6, 41.9e-6, 282.0, 6.68e5, 0.219],
        [156e-6, 90.6e-6, 1550.0, 5.16e6, 0.700],
        [493e-6, 128e-6, 1650.0, 1.19e5, 0.0394],
        [40.6e-6, 16.1e-6, 3580.0, 6.80e6, 0.0934],
    ];
    for [start, full, damping, stiffness, speed] in starts {
        let text = ball_text([1, 0], speed, [99.0, -1e3 * start], 1.0, stiffness, 3e-7);
        let text = text.replace("damping = 0", &format!("damping = \"{damping} N·s/m\""));
        let run = simulated(&scene(&text.replace("depth = 0.1", &format!("depth = {}", 1e3 * full))), 1e-3);
        let acceleration = |x: f64, v: f64| {
            let depth = (start - x).max(0.0);
            let s = (depth / full).min(1.0);
            (stiffness * depth - damping * s * s * (3.0 - 2.0 * s) * v).max(0.0) / 0.1
        };
        let gained = independent(acceleration, speed, 1e-3, 20)[20][1] - speed;
        let error = column(&run, "ball.vx (m/s)")[20] - speed - gained;
        assert!(gained > 1e-3 * speed && error.abs() < 1e-2 * gained, "{start} m, {speed} m/s: {error} of {gained}");
    }
}

/// The closed form of the highest point: a ball that reaches a ceiling with some speed presses into it until the spring holds its energy.
#[test]
fn a_ball_thrown_at_a_ceiling_does_not_pass_through_it() {
    let (mass, stiffness) = (0.1, 1e8);
    for ceiling in [50.9, 50.96, 50.967, 40.0, 50.97] {
        let speed = 1.0 - 2.0 * 9.81 * ceiling * 1e-3;
        let pressed = if speed > 0.0 { libm::pow(1.25 * mass * speed / stiffness, 0.4) } else { 0.0 };
        let highest = (ceiling * 1e-3 + pressed).min(1.0 / (2.0 * 9.81));
        for error in [1e-3, 1e-5, 3e-7, 1e-9] {
            let run = simulated(&ball([0, 1], 1.0, [ceiling, 99.0], 1.5, stiffness, error), 1e-4);
            let top = column(&run, "ball.y (m)").into_iter().fold(0.0, f64::max);
            assert!(top <= highest + 1e-8 && top > highest - 3e-6, "{ceiling} mm, {error}: {top}, not {highest}");
        }
    }
}

/// Late bounces in a play of 0.129 mm, from the middle at a small speed; every axis and both directions.
#[test]
fn bounces_within_play_are_all_there() {
    for (axis, speed) in [([1, 0], 0.03), ([-1, 0], 0.03), ([1, 0], -0.03), ([1, 0], 0.004)] {
        for (exponent, stiffness) in [(1.5, 1e8), (2.0, 1e10), (1.0, 1e6)] {
            let mechanism = ball(axis, speed, [0.129, 0.129], exponent, stiffness, 3e-7);
            let run = simulated(&mechanism, 1e-3);
            let along = f64::from(axis[0]);
            let force = |depth: f64| if depth > 0.0 { stiffness * libm::pow(depth, exponent) } else { 0.0 };
            let acceleration = |x: f64, _: f64| (force(-0.129e-3 - x) - force(x - 0.129e-3)) / 0.1;
            let expected = independent(acceleration, speed, 1e-3, 200);
            let peak = greatest(&expected.iter().map(|state| state[0]).collect::<Vec<_>>());
            let x = column(&run, "ball.x (m)");
            let worst = x.iter().zip(&expected).fold(0.0f64, |most, (x, state)| most.max((along * x - state[0]).abs()));
            assert!(worst < 2e-3 * peak, "{axis:?} {speed} e = {exponent}: {worst} of {peak}");
        }
    }
}

/// The tip of a lever that turns freely sweeps past a wall that it overlaps by micrometres, rubs and loses speed.
#[test]
fn a_lever_that_sweeps_past_a_wall_touches_it() {
    for (overlap, spin) in [(0.01, 40.0), (0.01, -40.0), (0.002, -12.0), (-0.001, 40.0), (0.05, 120.0)] {
        let mechanism = scene(&format!(
            r#"
title = "Lever past a wall"
[mechanism]
space = "plane"
gravity = [0, 0]
[contact]
stiffness = "1e8 N/m^1.5"
exponent = 1.5
damping = 0
depth = 0.1
[friction]
law = "regularised"
coefficient = 0.3
stick_band = 1
[[body]]
name = "lever"
mass = 100
inertia = "1e-4 kg·m²"
centre = [0, 0]
spin = {spin}
[[joint]]
name = "pivot"
kind = "revolute"
between = ["frame", "lever"]
at = [0, 0]
[[joint]]
name = "wall"
kind = "stop"
between = ["lever", "frame"]
at = [0, 80]
normal = [-1, 0]
clearance = [{}, 0]
[run]
duration = 160
"#,
            80.0 - overlap
        ));
        let run = simulated(&mechanism, 1e-3);
        // The tip is at 0.08·(−sin φ, cos φ), and the wall at 0.08 − overlap along x.
        let wall = 0.08 - overlap * 1e-3;
        let acceleration = |angle: f64, rate: f64| {
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            let depth = -0.08 * sin - wall;
            let force = if depth > 0.0 { 1e8 * libm::pow(depth, 1.5) } else { 0.0 };
            let sliding = -0.08 * sin * rate;
            let w = (sliding.abs() / 1e-3).min(1.0);
            let rubbing = -0.3 * w * (3.0 - w * w) / 2.0 * force * sliding.signum();
            // Moment of (−force, rubbing) at the tip.
            (0.08 * cos * force - 0.08 * sin * rubbing) / 1e-4
        };
        let expected = independent(acceleration, spin, 1e-3, 160);
        let [_, at_end] = expected[160];
        let found = *column(&run, "lever.spin (rad/s)").last().unwrap();
        assert!((found - at_end).abs() < 5e-3 * spin.abs(), "{overlap} mm {spin}: {found}, not {at_end}");
        assert_eq!(overlap > 0.0, (at_end - spin).abs() > 1e-3 * spin.abs(), "the test says something: {at_end}");
    }
}
