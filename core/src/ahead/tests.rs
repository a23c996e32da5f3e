use super::{Ahead, Limits, State, Status};
use crate::{
    ParameterError, SVector, Vector3,
    drive::{Drive, Push, Pushed},
    law::{Impact, Pad, ThreeHalves},
    mechanism::Driven as _,
    system::{AxisBody, on_axis},
};

type Driven = AxisBody<f64, ThreeHalves<f64>, Pad<f64>, Drive<f64>>;

const LIMITS: Limits<f64> = Limits { period: 1e-3, tolerance: 1e-4, lead: 0.05, lag: 0.1 };

const MASS: f64 = 0.1;

/// A body that is driven away from its pad, by a ramp that is over when the body is let go.
fn body(speed: f64) -> Driven {
    let contact = Impact::new(ThreeHalves::new(3e6).unwrap(), 1000.0, 1e-4).unwrap();
    let drive = Drive { gain: 2.0, ramp_start: -2.0, ramp_end: -1.0, speed, point_b: Vector3::zeros() };
    on_axis(MASS, 0.0, Pad::new(1e-3).unwrap(), contact, drive).unwrap()
}

fn ahead(speed: f64) -> Ahead<f64, Driven> {
    Ahead::new(body(speed), LIMITS).unwrap()
}

#[test]
fn a_free_body_follows_its_closed_form_and_keeps_to_its_lead() {
    let (ahead, early) = (ahead(0.1), 10);
    let mut state: State<_, _, 1, 64> = ahead.at_rest(1.0, early);
    let mut greatest = 0.0f64;
    for period in 1..500 {
        let prediction = ahead.step(&mut state);
        let t = f64::from(period - early as i32) * 1e-3;
        assert!(libm::fabs(prediction.time - t) < 1e-15);
        // m·v̇ = K·(V − v).
        let speed = if t > 0.0 { 0.1 * (1.0 - libm::exp(-t * 2.0 / MASS)) } else { 0.0 };
        assert!(libm::fabs(prediction.speed - speed) < 1e-5, "{t}: {} {speed}", prediction.speed);
        assert!(matches!(prediction.status(), Status::Ahead(lead) if lead <= LIMITS.lead));
        greatest = greatest.max(prediction.lead);
    }
    assert!(greatest > 0.9 * LIMITS.lead, "{greatest}");
}

#[test]
fn goes_on_from_the_present_instant_with_another_command() {
    let (first, second) = (ahead(0.1), ahead(0.04));
    let mut state: State<_, _, 1, 64> = first.at_rest(1.0, 0);
    let before = (0..60).map(|_| first.step(&mut state).speed).last().unwrap();
    second.restart(&mut state);
    for period in 1..200 {
        let prediction = second.step(&mut state);
        let t = f64::from(period) * 1e-3;
        let speed = 0.04 + (before - 0.04) * libm::exp(-t * 2.0 / MASS);
        // In its first periods it may be behind, and says of which time its value is.
        if matches!(prediction.status(), Status::Ahead(_)) {
            assert!(libm::fabs(prediction.speed - speed) < 1e-5, "{t}: {} {speed}", prediction.speed);
        } else {
            assert!(period < 10 && prediction.time < t + 0.06);
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
    ] {
        assert_eq!(Ahead::new(body(0.1), limits).unwrap_err().parameter, parameter);
    }
}

#[test]
fn a_full_ring_waits() {
    let ahead = ahead(0.1);
    let mut state: State<_, _, 1, 8> = ahead.at_rest(1.0, 0);
    for period in 1..300 {
        let prediction = ahead.step(&mut state);
        let speed = 0.1 * (1.0 - libm::exp(-f64::from(period) * 1e-3 * 2.0 / MASS));
        if matches!(prediction.status(), Status::Ahead(_)) {
            assert!(libm::fabs(prediction.speed - speed) < 1e-4, "{period}: {} {speed}", prediction.speed);
        }
        assert!(prediction.lead < 0.02);
    }
}

/// A drive whose force is not finite in an interval of time (s).
#[derive(Clone, Copy, Debug)]
struct Breaks {
    drive: Drive<f64>,
    during: [f64; 2],
}

impl Push<f64> for Breaks {
    fn checked(self) -> Result<Self, ParameterError<f64>> {
        Ok(self)
    }

    fn effort(&self, t: f64, v: f64) -> f64 {
        let [from, to] = self.during;
        if t >= from && t < to { f64::NAN } else { self.drive.force(t, v) }
    }

    fn pushed(&self, t: f64, v: f64) -> Pushed<f64> {
        Pushed { force: self.effort(t, v), per_speed: self.drive.gain, per_time: 0.0 }
    }
}

type Breaking = AxisBody<f64, ThreeHalves<f64>, Pad<f64>, Breaks>;

impl crate::mechanism::Driven<f64, 1> for Breaking {
    fn drive(&self) -> &Drive<f64> {
        &self.elements().1.law.0.drive
    }

    fn mass(&self) -> f64 {
        MASS
    }

    fn speed(&self, velocity: &SVector<f64, 1>) -> f64 {
        velocity.x
    }
}

#[test]
#[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
fn a_motion_held_for_however_long_stays_the_last_one() {
    let contact = Impact::new(ThreeHalves::new(3e6).unwrap(), 1000.0, 1e-4).unwrap();
    // Half of the wrap of the ticks' differences are 2,048 periods.
    for held in [100, 2040, 2100, 4200, 9000] {
        let during = [0.1, 0.1 + 1e-3 * f64::from(held)];
        let push = Breaks { drive: *body(0.1).drive(), during };
        let body: Breaking = on_axis(MASS, 0.0, Pad::new(1e-3).unwrap(), contact, push).unwrap();
        let ahead = Ahead::new(body, LIMITS).unwrap();
        let early = 10;
        let mut state: State<_, _, 1, 256> = ahead.at_rest(1.0, early);
        let at = |t: f64| 0.1 * (1.0 - libm::exp(-t * 2.0 / MASS));
        let mut last = 0.0;
        for period in 1..400 + held {
            let t = 1e-3 * f64::from(period - early as i32);
            let prediction = ahead.step(&mut state);
            assert!(prediction.lead > -0.102 && prediction.speed >= last - 1e-12, "{held} {period}: {prediction:?}");
            last = prediction.speed;
            if t < 0.0 {
                assert_eq!(prediction.speed, 0.0);
            } else if t < 0.099 {
                assert!(libm::fabs(prediction.speed - at(t)) < 1e-4, "{held} {period}: {prediction:?}");
            } else if t < during[1] + 0.099 {
                // Known until the force broke, a forced step included.
                assert!((at(0.099)..at(0.102)).contains(&prediction.speed), "{held} {period}: {prediction:?}");
            }
        }
        // Goes on when it can, from where it was held.
        assert!(matches!(ahead.step(&mut state).status(), Status::Ahead(_)) && last > at(0.3), "{held}: {last}");
    }
}
