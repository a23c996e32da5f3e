//! The contact law at single points and over single bounces, against values computed elsewhere.

use slipfit_core::{
    SVector, Scalar, Vector2,
    integrator::{Extrapolated, ImplicitEuler, Integrator, Rodas4, Sdirk2},
    kernel::Kernel,
    law::{self, Frictionless, HuntCrossley, Impact, LankaraniNikravesh, Linear, Normal, ThreeHalves, fit::SlotForce},
    pose::Pose,
    system::{
        Element, System,
        law::{Contact, Pad},
        on_axis,
        planar::{Across, Coordinate, PlanarTree, Point, Rigid},
    },
};
use slipfit_problems::{
    cd_rom::{self, STIFFNESS},
    laws::{BOUNCE_MASS, BOUNCES, Bounce, IMPACT_VALUES},
};

fn contact<S: Scalar + PartialOrd>() -> Impact<S, ThreeHalves<S>> {
    let s = S::from_f64;
    Impact::new(ThreeHalves::new(s(STIFFNESS)).unwrap(), s(1000.0), s(1e-4)).unwrap()
}

/// The closed form of the law, in mm and N, written here once more on purpose.
fn closed_form(p: f64, w: f64) -> f64 {
    let s = (p / 0.1).min(1.0);
    (100.0 * p * libm::sqrt(p) + s * s * (3.0 - 2.0 * s) * w).max(0.0)
}

#[test]
fn impact_meets_the_closed_form() {
    for [p, w, rounded] in IMPACT_VALUES {
        let exact = closed_form(p, w);
        assert!((exact - rounded).abs() <= 5e-8, "{p} {w}");
        let double = contact::<f64>().response(p * 1e-3, w * 1e-3).force;
        assert!((double - exact).abs() <= 1e-12 * exact, "{p} {w}: {double} {exact}");
        let single = contact::<f32>().response((p * 1e-3) as f32, (w * 1e-3) as f32).force;
        assert!((f64::from(single) - exact).abs() <= 1e-5 * exact, "{p} {w}: {single} {exact}");
    }
}

/// Eq. 10 with the four faults of its print, as a fixture that shows why the law deviates: a negative base under a
/// fractional power, a damper that vanishes beyond `d` and has the wrong sign, a sum that may pull.
fn as_printed(p: f64, w: f64) -> f64 {
    let s = (p / 0.1).min(1.0);
    let fade = s * s * (3.0 - 2.0 * s) * if p > 0.1 { 0.0 } else { 1.0 };
    100.0 * libm::pow(p, 1.5) - fade * w
}

#[test]
fn the_printed_law_is_not_usable() {
    // (a) No number outside contact, (b) no damping beyond the depth d, (c) it pulls, (d) approach weakens it.
    assert!(as_printed(-0.01, 0.0).is_nan());
    assert_eq!(as_printed(0.2, 100.0), as_printed(0.2, 0.0));
    assert!(as_printed(0.05, 100.0) < 0.0);
    assert!(as_printed(0.05, 1.0) < as_printed(0.05, -1.0));
    let law = contact::<f64>();
    assert_eq!(law.response(-1e-5, 0.0).force, 0.0);
    assert!(law.response(2e-4, 0.1).force > law.response(2e-4, 0.0).force);
    assert!(law.response(5e-5, 0.1).force > law.response(5e-5, 0.0).force);
}

#[test]
fn impact_never_pulls_and_is_zero_outside() {
    let law = contact::<f64>();
    for i in -50..200 {
        for w in [-10.0, -0.1, 0.0, 0.1, 10.0] {
            let p = f64::from(i) * 1e-6;
            let response = law.response(p, w);
            assert!(response.force >= 0.0);
            let exact = closed_form(p.max(0.0) * 1e3, w * 1e3) * if p > 0.0 { 1.0 } else { 0.0 };
            assert!((response.force - exact).abs() <= 1e-11 * (1.0 + exact), "{p} {w}");
        }
    }
}

#[test]
fn bistop_is_the_same_law_at_both_ends() {
    let slot = contact::<f64>().slot(1e-4, 2e-4, 2.5e-4, -0.01);
    let (force, normal) = (slot.force(), slot.normal());
    let end = contact::<f64>().response(2.5e-4 - 2e-4, 0.01).force;
    assert_eq!((force, normal), (end, end));
    let mirrored = contact::<f64>().slot(2e-4, 1e-4, -2.5e-4, 0.01);
    assert_eq!(mirrored.force(), -end);
}

/// What a bounce did, from a run in steps of `h` (s) that ends `duration` (s) after the start in contact.
fn bounce<I: Integrator>(speed: f64, h: f64, duration: f64) -> Bounce {
    let body = on_axis(BOUNCE_MASS, 0.0, law::Pad::new(0.0).unwrap(), contact::<f64>(), ()).unwrap();
    let kernel = Kernel::<f64, _, I>::new(body, h).unwrap();
    let mut state = kernel.at_rest(0.0);
    state.motion.velocity = SVector::<f64, 1>::new(-speed);
    let (mut peak_penetration, mut peak_force, mut contact_time) = (0.0f64, 0.0f64, 0.0);
    for _ in 0..(duration / h) as u32 {
        let _ = kernel.step(&mut state);
        let (x, v) = (state.motion.pose, state.motion.velocity.x);
        peak_penetration = peak_penetration.max(-x);
        peak_force = peak_force.max(kernel.mechanism().stop_force(x, v));
        if x < 0.0 {
            // The crossing inside the step that leaves is at most one step away; velocity is steady there.
            contact_time = kernel.time(state.steps) - x / v;
        }
    }
    let restitution = state.motion.velocity.x / speed;
    Bounce { speed, restitution, peak_penetration, peak_force, contact_time }
}

/// The greatest relative deviation of a bounce's figures.
fn deviation(found: &Bounce, known: &Bounce) -> f64 {
    [
        found.restitution / known.restitution,
        found.peak_penetration / known.peak_penetration,
        found.peak_force / known.peak_force,
        found.contact_time / known.contact_time,
    ]
    .iter()
    .fold(0.0, |worst, ratio| worst.max((ratio - 1.0).abs()))
}

/// What steps of 50 µs are worth: deviations from the known figures, the same on every machine.
#[test]
fn bounces_in_steps_of_50_microseconds() {
    const STEP: f64 = 50e-6;
    let mut table = format!("extrapolated in steps of {} µs\n", STEP * 1e6);
    for known in BOUNCES {
        let found = bounce::<Extrapolated<2, 4>>(known.speed, STEP, 0.05);
        table += &format!("{:4} m/s: worst figure off by {:.3} %\n", known.speed, deviation(&found, &known) * 100.0);
    }
    insta::assert_snapshot!(table);
}

#[test]
fn bounces_converge_to_the_known_figures() {
    for known in BOUNCES {
        // The printed figures carry four digits, restitution as few as three.
        let rounding = 0.000_005 / known.restitution + 2e-4;
        let errors = [5e-5, 5e-6, 5e-7].map(|h| deviation(&bounce::<Sdirk2<5>>(known.speed, h, 0.05), &known));
        eprintln!("{} m/s: {errors:.6?}", known.speed);
        assert!(errors[2] <= rounding, "{} m/s: {errors:?}", known.speed);
        let euler = [5e-6, 5e-7].map(|h| deviation(&bounce::<ImplicitEuler<4>>(known.speed, h, 0.05), &known));
        assert!(euler[1] <= 0.3 * euler[0] + rounding, "{} m/s: {euler:?}", known.speed);
    }
}

/// The share of its `speed` (m/s) that a body on `law` keeps in a bounce, by steps of `h` (s): a slider that meets a pad.
fn rebound<N: Normal<f64>>(law: N, speed: f64, h: f64) -> f64 {
    let coordinate = Coordinate::Slide { on: None, axis: Vector2::x() };
    let point = Point::<f64, 1>::fixed(Vector2::zeros()).on(0, &coordinate);
    let body = Rigid { mass: BOUNCE_MASS, inertia: 0.0, centre: point };
    let tree = PlanarTree::new([coordinate], &[body], Vector2::zeros()).unwrap();
    let pose = tree.pose([0.0], |_| [1.0, 0.0]);
    let link = Across { point, seat: Point::fixed(Vector2::zeros()), normal: Vector2::x() };
    let law = Pad { gap: 0.0, contact: Contact { normal: law, friction: Frictionless } };
    let kernel = Kernel::<f64, _, Rodas4>::new(System::new(tree, Element::<_, _, 2> { link, law }), h).unwrap();
    let mut state = kernel.at_rest(pose);
    state.motion.velocity.x = -speed;
    while state.motion.velocity.x < 0.0 || state.motion.pose[0][0] < 0.0 {
        let _ = kernel.step(&mut state);
    }
    state.motion.velocity.x / speed
}

/// Speed after over before of F = k·δ^e·(1 + a·δ̇), for a times the speed before: x − ln(1 + x) is kept, whatever the mass and the
/// spring are.
fn kept(before: f64) -> f64 {
    let lost = before - libm::log1p(before);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if -middle - libm::log1p(-middle) < lost { &mut low } else { &mut high }) = middle;
    }
    low / before
}

/// What laws with a restitution keep of what they promise. Both promise to first order in what is lost: they are livelier by
/// about its square.
#[test]
fn bounces_have_the_restitution_they_promise() {
    let mut table = String::from("promised   Hunt-Crossley   Lankarani-Nikravesh\n");
    for promised in [1.0, 0.95, 0.9, 0.8, 0.5] {
        let speed = 0.25;
        let hunt_crossley = |speed_before| {
            let law = HuntCrossley::new(ThreeHalves::new(STIFFNESS).unwrap(), promised, speed).unwrap();
            let found = rebound(law, speed_before, 1e-7);
            let expected = if promised == 1.0 { 1.0 } else { kept(1.5 * (1.0 - promised) * speed_before / speed) };
            assert!((found - expected).abs() < 1e-6, "{promised} {speed_before} {found} {expected}");
            found
        };
        let lankarani = || {
            let law = LankaraniNikravesh::new(Linear::new(2e5).unwrap(), promised, speed).unwrap();
            let found = rebound(law, speed, 1e-7);
            let expected = if promised == 1.0 { 1.0 } else { kept(0.75 * (1.0 - promised * promised)) };
            assert!((found - expected).abs() < 1e-6, "{promised} {found} {expected}");
            found
        };
        let (hunt_crossley_at, lankarani_at) = (hunt_crossley(speed), lankarani());
        table += &format!("{promised:8.2}{hunt_crossley_at:16.4}{lankarani_at:22.4}\n");
        let lost = 1.0 - promised;
        assert!((-1e-6..=lost * lost + 1e-6).contains(&(hunt_crossley_at - promised)), "{table}");
        assert!((-1e-6..=1.5 * lost * lost + 1e-6).contains(&(lankarani_at - promised)), "{table}");
        // The restitution goes by the speed: half the speed, half the loss.
        assert!((1.0 - hunt_crossley(0.5 * speed) - 0.5 * lost).abs() <= 0.5 * lost * lost + 1e-6);
    }
    insta::assert_snapshot!(table);
}

/// Forces of a penetration beyond reason overflow when squared; what a step reports of itself must not be NaN then.
#[test]
fn reports_are_never_nan() {
    fn check<I: Integrator>() {
        for k in 0..1600u16 {
            let mut data = cd_rom::data(0.0f32);
            data.body.gaps[usize::from(k % 16)] = -f32::from(k / 16) / 100.0;
            let kernel = Kernel::<f32, _, I>::new(cd_rom::with_friction(&data, Frictionless), 1e-3).unwrap();
            let mut state = kernel.at_rest(Pose::nominal());
            for _ in 0..20 {
                let report = kernel.step(&mut state);
                assert!(!report.residual.is_nan() && !report.error.is_nan(), "{} at {k}", I::NAME);
            }
        }
    }
    check::<ImplicitEuler<4>>();
    check::<Extrapolated<2, 4>>();
}
