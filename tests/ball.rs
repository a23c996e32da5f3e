//! A ball on an undamped spring: event-heavy, and exactly known.

use slipfit_core::{
    SVector,
    integrator::{Extrapolated, ImplicitEuler, Integrator, RungeKutta4, Sdirk2, SemiImplicitEuler},
    kernel::Kernel,
    law::{Impact, Linear, Pad},
    system::on_axis,
};
use slipfit_problems::laws::{BALL, BALL_HEIGHTS};

/// Height of the centre (m) after `duration` (s) in steps of `h` (s), and the relative drift of the energy.
fn run<I: Integrator>(duration: f64, h: f64) -> (f64, f64) {
    let contact = Impact::new(Linear::new(BALL.stiffness).unwrap(), 0.0, 1e-3).unwrap();
    // Positions count from where the ball touches.
    let body = on_axis(BALL.mass, BALL.gravity, Pad::new(0.0).unwrap(), contact, ()).unwrap();
    let kernel = Kernel::<f64, _, I>::new(body, h).unwrap();
    let mut state = kernel.at_rest(BALL.height - BALL.radius);
    state.motion.velocity = SVector::<f64, 1>::new(BALL.velocity);
    for _ in 0..(duration / h).round() as u32 {
        let _ = kernel.step(&mut state);
    }
    let height = BALL.radius + state.motion.pose;
    let energy = BALL.energy(height, state.motion.velocity.x);
    (height, energy / BALL.energy(BALL.height, BALL.velocity) - 1.0)
}

#[test]
fn second_order_follows_the_bounces() {
    let [[short, early], [long, late]] = BALL_HEIGHTS;
    let mut table = String::from("steps of 10 µs         error at 0.5 s (m)   at 5 s (m)   energy drift at 5 s\n");
    let mut report = |name: &str, run: fn(f64, f64) -> (f64, f64)| {
        let (at_short, _) = run(short, 1e-5);
        let (at_long, drift) = run(long, 1e-5);
        let errors = [(at_short - early).abs(), (at_long - late).abs()];
        table += &format!("{name:22} {:18.1e} {:12.1e} {drift:21.1e}\n", errors[0], errors[1]);
        errors
    };
    let second = report("sdirk2", run::<Sdirk2<4>>);
    report("extrapolated", run::<Extrapolated<2, 4>>);
    report("implicit-euler", run::<ImplicitEuler<4>>);
    report("semi-implicit-euler", run::<SemiImplicitEuler>);
    report("rk4", run::<RungeKutta4>);
    eprintln!("{table}");
    assert!(second[0] <= 1e-6 && second[1] <= 1e-4, "{second:?}");
    insta::assert_snapshot!(table);
}
