use super::{Ahead, Limits, State, Status};
use crate::{
    drive::SetpointDrive,
    law::{Impact, Pad, ThreeHalves},
    system::{AxisBody, on_axis},
};

type Driven = AxisBody<f64, ThreeHalves<f64>, Pad<f64>, SetpointDrive<f64>>;

const LIMITS: Limits<f64> = Limits { period: 1e-3, tolerance: 1e-4, lead: 0.05, lag: 0.1, attempts: 1 };

const MASS: f64 = 0.1;

/// What the drive gives by a deviation of speed (N·s/m).
const GAIN: f64 = 2.0;

/// A body that is driven away from its pad.
fn body() -> Driven {
    let contact = Impact::new(ThreeHalves::new(3e6).unwrap(), 1000.0, 1e-4).unwrap();
    on_axis(MASS, 0.0, Pad::new(1e-3).unwrap(), contact, SetpointDrive::new(GAIN)).unwrap()
}

fn ahead() -> Ahead<f64, Driven> {
    Ahead::new(body(), LIMITS).unwrap()
}

/// The speed (m/s) that the body has `t` (s) after it was let go at rest, with a command of 0.1 m/s.
fn speed_at(t: f64) -> f64 {
    0.1 * (1.0 - libm::exp(-t.max(0.0) * GAIN / MASS))
}

#[test]
fn a_free_body_follows_its_closed_form_and_keeps_to_its_lead() {
    let (mut ahead, early) = (ahead(), 10);
    let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, early, |_| 0.1);
    let mut greatest = 0.0f64;
    for period in 1..500 {
        let prediction = ahead.step(&mut state);
        let t = f64::from(period - early as i32) * 1e-3;
        assert!(libm::fabs(prediction.time - t) < 1e-15);
        // m·v̇ = K·(V − v).
        let speed = speed_at(t);
        assert!(libm::fabs(prediction.speed - speed) < 1e-5, "{t}: {} {speed}", prediction.speed);
        let position = 1.0 + 0.1 * t.max(0.0) - speed * MASS / GAIN;
        assert!(libm::fabs(prediction.position - position) < 1e-6, "{t}: {} {position}", prediction.position);
        assert!(matches!(prediction.status(), Status::Ahead(lead) if lead <= LIMITS.lead));
        greatest = greatest.max(prediction.lead);
        // What is forecast is what will be.
        if let Some(force) = ahead.forecast(&state, 5) {
            assert!(libm::fabs(force - GAIN * (0.1 - speed_at(t + 5e-3))) < 1e-4 || t < 0.0, "{t}: {force}");
        }
    }
    assert!(greatest > 0.9 * LIMITS.lead, "{greatest}");
    assert!(ahead.forecast(&state, 40).is_some() && ahead.forecast(&state, 51).is_none());
}

/// m·v̇ = K·(A·sin ωt − v) from rest: what is planned is met, however the command goes.
#[test]
fn a_planned_command_is_followed_to_its_closed_form() {
    let (omega, lag) = (30.0, MASS / GAIN);
    let command = |t: f64| 0.1 * libm::sin(omega * t.max(0.0));
    let speed = |t: f64| {
        let (x, decay) = (omega * lag, libm::exp(-t / lag));
        0.1 * (libm::sin(omega * t) - x * libm::cos(omega * t) + x * decay) / (1.0 + x * x)
    };
    let mut ahead = ahead();
    let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, 0, command);
    let horizon = ahead.horizon(&state);
    for period in 1..3000 {
        let time = ahead.time(&state, horizon + 1);
        assert!(ahead.plan(&mut state, horizon, command(time)));
        let prediction = ahead.step(&mut state);
        let t = f64::from(period) * 1e-3;
        if matches!(prediction.status(), Status::Ahead(_)) {
            assert!(libm::fabs(prediction.speed - speed(t)) < 5e-5, "{t}: {} {}", prediction.speed, speed(t));
            assert!(prediction.deviation == 0.0);
        } else {
            assert!(period < 30, "{t}: {prediction:?}");
        }
    }
    // What is predicted already is not planned anew, nor what is beyond the horizon.
    assert!(!ahead.plan(&mut state, 0, 0.0) && !ahead.plan(&mut state, horizon + 1, 0.0));
    ahead.restart(&mut state);
    assert!(ahead.plan(&mut state, 0, 0.0));
}

/// A followed command: the body lags behind it, so that a wrong extrapolation changes its motion little.
#[test]
fn an_unknown_command_is_followed_nearly() {
    let (omega, x) = (10.0, 10.0 * MASS / GAIN);
    for (lead, most) in [(0.02, 0.01), (0.05, 0.06)] {
        let mut ahead = Ahead::new(body(), Limits { lead, ..LIMITS }).unwrap();
        let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, 0, |_| 0.0);
        let mut worst = 0.0f64;
        for period in 1..2000 {
            let t = f64::from(period) * 1e-3;
            let commanded = 0.1 * libm::sin(omega * t);
            ahead.follow(&mut state, commanded);
            let found = ahead.step(&mut state);
            let speed = 0.1 * (libm::sin(omega * t) - x * libm::cos(omega * t)) / (1.0 + x * x);
            if period > 500 {
                worst = worst.max(libm::fabs(found.speed - speed));
                assert!(found.lead > 0.5 * lead && libm::fabs(found.deviation) < 0.1 * most, "{found:?}");
            }
        }
        // Third differences over the horizon and the span.
        assert!(worst < 0.1 * most && worst > 1e-5, "{lead}: {worst}");
    }
}

/// After a jump the motion goes on from where it is, by what the command is now.
#[test]
fn a_command_that_jumps_is_followed_after_a_restart() {
    let mut ahead = Ahead::new(body(), Limits { lead: 0.02, ..LIMITS }).unwrap();
    let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, 0, |_| 0.0);
    let mut step = |state: &mut _, speed| {
        ahead.follow(state, speed);
        ahead.step(state)
    };
    let before = (0..300).map(|_| step(&mut state, 0.1)).last().unwrap();
    assert!(libm::fabs(before.speed - 0.1) < 2e-3 && libm::fabs(before.deviation) < 2e-3, "{before:?}");
    let jumped = step(&mut state, 0.02);
    assert!(libm::fabs(jumped.deviation + 0.08) < 2e-3, "{jumped:?}");
    Ahead::new(body(), LIMITS).unwrap().restart(&mut state);
    let last = (0..60).map(|_| step(&mut state, 0.02)).last().unwrap();
    let speed = 0.02 + 0.08 * libm::exp(-0.06 * GAIN / MASS);
    assert!(libm::fabs(last.speed - speed) < 2e-3 && last.lead > 0.0, "{last:?} {speed}");
}

/// The first speed that is planned after a restart holds until others are; nothing of the plan before is left.
#[test]
fn a_plan_after_a_restart_is_the_whole_plan() {
    let mut ahead = ahead();
    let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, 0, |_| 0.1);
    (0..200).for_each(|_| _ = ahead.step(&mut state));
    let horizon = ahead.horizon(&state);
    // What is refused changes nothing.
    let before = state.clone();
    assert!(!ahead.plan(&mut state, 0, 0.0) && !ahead.plan(&mut state, horizon + 1, 0.0) && state == before);
    ahead.restart(&mut state);
    assert!(ahead.plan(&mut state, 0, 0.0));
    let mut last = f64::INFINITY;
    for _ in 0..400 {
        let said = ahead.step(&mut state);
        let assumed = said.force / GAIN + said.speed;
        assert!(said.lead < 0.0 || libm::fabs(assumed) < 1e-12, "{said:?}");
        last = said.speed;
        assert!(ahead.plan(&mut state, horizon, 0.0));
    }
    assert!(libm::fabs(last) < 1e-4, "{last}");
}

/// Where a command is followed, every value that is current says by which command it was assumed: force/gain + speed + deviation is
/// the command.
#[test]
fn what_is_followed_and_what_is_assumed_differ_by_the_deviation() {
    for (lead, attempts) in [(0.004, 1), (0.01, 1), (0.02, 2), (0.05, 4)] {
        let mut ahead = Ahead::new(body(), Limits { lead, attempts, ..LIMITS }).unwrap();
        let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, 3, |_| 0.0);
        let mut current = 0;
        for period in 0..3000 {
            let t = f64::from(period) * 1e-3;
            // With corners, at which the lead is lost, and a restart on the way.
            let commanded = 0.1 * libm::sin(9.0 * t) + if period % 700 > 350 { 0.05 } else { 0.0 };
            if period == 1500 {
                ahead.restart(&mut state);
            }
            ahead.follow(&mut state, commanded);
            let said = ahead.step(&mut state);
            if said.lead >= 0.0 && period > 3 {
                current += 1;
                let assumed = said.force / GAIN + said.speed + said.deviation;
                assert!(libm::fabs(assumed - commanded) < 1e-9, "{lead} {period}: {assumed} {commanded} {said:?}");
            }
        }
        assert!(current > 1000, "{lead}: {current}");
    }
}

/// A mechanism that is restarted before its release is released when it should be.
#[test]
fn a_restart_before_the_release_does_not_bring_it_forward() {
    let mut ahead = ahead();
    for at in [1, 5, 39] {
        let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, 40, |_| 0.1);
        for period in 1..=140 {
            if period == at {
                ahead.restart(&mut state);
                // What is commanded before the release does not matter, and may be planned.
                assert!(ahead.plan(&mut state, 0, 0.1));
            }
            let said = ahead.step(&mut state);
            let speed = speed_at(f64::from(period - 40) * 1e-3);
            let is_current = matches!(said.status(), Status::Ahead(_));
            assert!(!is_current || libm::fabs(said.speed - speed) < 1e-4, "{at} {period}: {said:?} {speed}");
            assert!(is_current || period < 60, "{at} {period}: {said:?}");
        }
    }
}

/// A command that is no number says nothing, and leaves nothing behind.
#[test]
fn a_followed_command_that_is_no_number_is_passed_over() {
    let mut ahead = Ahead::new(body(), Limits { lead: 0.02, ..LIMITS }).unwrap();
    let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, 0, |_| 0.0);
    for period in 0..600 {
        ahead.follow(&mut state, if period % 100 == 50 { f64::NAN } else { 0.1 });
        let said = ahead.step(&mut state);
        assert!(said.speed.is_finite() && said.force.is_finite() && said.deviation.is_finite(), "{period}: {said:?}");
        assert!(period < 300 || (said.lead > 0.0 && libm::fabs(said.speed - 0.1) < 1e-2), "{period}: {said:?}");
    }
}

#[test]
fn goes_on_from_the_present_instant_with_another_command() {
    let mut ahead = ahead();
    let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, 0, |_| 0.1);
    let before = (0..60).map(|_| ahead.step(&mut state).speed).last().unwrap();
    ahead.restart(&mut state);
    ahead.plan_all(&mut state, |_| 0.04);
    for period in 1..200 {
        let prediction = ahead.step(&mut state);
        let t = f64::from(period) * 1e-3;
        let speed = 0.04 + (before - 0.04) * libm::exp(-t * GAIN / MASS);
        // In its first periods it may be behind, and says of which time its value is. The command needs the first of them to change.
        if matches!(prediction.status(), Status::Ahead(_)) {
            assert!(libm::fabs(prediction.speed - speed) < 2e-3, "{t}: {} {speed}", prediction.speed);
        } else {
            assert!(period < 20 && prediction.time < t + 0.06);
        }
    }
}

#[test]
fn limits_are_checked() {
    for (limits, parameter) in [
        (Limits { period: f64::NAN, ..LIMITS }, "ahead.period"),
        (Limits { tolerance: 0.0, ..LIMITS }, "ahead.tolerance"),
        (Limits { lead: 1e-4, ..LIMITS }, "ahead.lead"),
        (Limits { lag: 2.0, ..LIMITS }, "ahead.lag"),
        (Limits { attempts: 0, ..LIMITS }, "ahead.attempts"),
        (Limits { attempts: 17, ..LIMITS }, "ahead.attempts"),
    ] {
        assert_eq!(Ahead::new(body(), limits).unwrap_err().parameter, parameter);
    }
}

#[test]
fn a_full_ring_waits() {
    let mut ahead = ahead();
    let mut state: State<_, _, 1, 8> = ahead.at_rest(1.0, 6, |_| 0.1);
    for period in 1..300 {
        let prediction = ahead.step(&mut state);
        let speed = speed_at(f64::from(period - 6) * 1e-3);
        if matches!(prediction.status(), Status::Ahead(_)) {
            assert!(libm::fabs(prediction.speed - speed) < 1e-4, "{period}: {} {speed}", prediction.speed);
        }
        assert!(prediction.lead < 0.02);
    }
}

#[test]
#[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
fn a_motion_held_for_however_long_stays_the_last_one() {
    // Half of the wrap of the ticks' differences are 2,048 periods.
    for held in [100, 2040, 2100, 4200, 9000] {
        // A command that is not a number.
        let during = [0.1, 0.1 + 1e-3 * f64::from(held)];
        let command = |t: f64| if t >= during[0] && t < during[1] { f64::NAN } else { 0.1 };
        let mut ahead = ahead();
        let early = 10;
        let mut state: State<_, _, 1, 256> = ahead.at_rest(1.0, early, command);
        let horizon = ahead.horizon(&state);
        let mut last = 0.0;
        for period in 1..400 + held {
            let t = 1e-3 * f64::from(period - early as i32);
            let time = ahead.time(&state, horizon + 1);
            assert!(ahead.plan(&mut state, horizon, command(time)));
            let prediction = ahead.step(&mut state);
            assert!(prediction.lead > -0.102 && prediction.speed >= last - 1e-12, "{held} {period}: {prediction:?}");
            last = prediction.speed;
            if t < 0.0 {
                assert_eq!(prediction.speed, 0.0);
            } else if t < 0.095 {
                assert!(libm::fabs(prediction.speed - speed_at(t)) < 1e-4, "{held} {period}: {prediction:?}");
            } else if t < during[1] + 0.095 {
                // Known until the command broke, and its cubics some periods before that, a forced step included.
                let known = speed_at(0.095)..speed_at(0.102);
                assert!(known.contains(&prediction.speed), "{held} {period}: {prediction:?}");
            }
        }
        // Goes on when it can, from where it was held.
        assert!(matches!(ahead.step(&mut state).status(), Status::Ahead(_)) && last > speed_at(0.3), "{held}: {last}");
    }
}
