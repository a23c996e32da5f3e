//! Stick-slip on a belt: a body on a spring that a belt drags along until it lets go.

use slipfit_core::{
    SVector, Scalar,
    integrator::{Extrapolated, Integrator, Sdirk2},
    kernel::Kernel,
    law::{Friction, StaticKinetic, friction::SlidingContact},
    mechanism::{Balance, Differentiated, Mechanism},
};

/// A body of one degree of freedom on a spring and a belt; unit normal force, so that coefficients are forces.
struct OnBelt {
    mass: f64,
    stiffness: f64,
    belt: f64,
    friction: StaticKinetic<f64>,
}

impl OnBelt {
    fn sliding(&self, velocity: &SVector<f64, 1>, mass_rate: f64, tangent_share: f64) -> SlidingContact<f64> {
        SlidingContact { sliding: [velocity.x - self.belt, 0.0], normal: 1.0, mass_rate, tangent_share }
    }
}

impl Mechanism<f64, 1> for OnBelt {
    type Pose = f64;
    type Internal = [f64; 2];
    type IterationMatrix = f64;
    type Jacobians = f64;

    const STICKS: bool = true;

    fn implicit_update(&self, pose: &f64, velocity: &SVector<f64, 1>, dt: f64) -> f64 {
        pose + velocity.x * dt
    }

    fn explicit_update(&self, pose: &f64, velocity: &SVector<f64, 1>, dt: f64) -> f64 {
        pose + velocity.x * dt
    }

    fn shifted(&self, base: &f64, from: &f64, to: &f64, weight: f64) -> f64 {
        base + (to - from) * weight
    }

    fn remembered(&self, _: &f64, internal: &[f64; 2]) -> [f64; 2] {
        *internal
    }

    fn internal_shifted(&self, base: &[f64; 2], from: &[f64; 2], to: &[f64; 2], weight: f64) -> [f64; 2] {
        StaticKinetic::shifted(base, from, to, weight)
    }

    fn normalised(&self, pose: &f64) -> f64 {
        *pose
    }

    fn fresh(&self) -> [f64; 2] {
        StaticKinetic::<f64>::fresh()
    }

    fn accept(&self, condition: f64, next: (&f64, &[f64; 2]), kept: (&mut f64, &mut [f64; 2])) {
        *kept.0 = next.0.or_old(condition, *kept.0);
        *kept.1 = StaticKinetic::or_old(next.1, condition, kept.1);
    }

    fn finiteness_probe(&self, pose: &f64) -> f64 {
        pose * 0.0
    }

    fn momentum(&self, _: &Self::Pose, velocity: &SVector<f64, 1>) -> SVector<f64, 1> {
        velocity * self.mass
    }

    fn velocity(&self, _: &Self::Pose, momentum: &SVector<f64, 1>) -> SVector<f64, 1> {
        momentum / self.mass
    }

    fn forces(
        &self,
        _: f64,
        pose: &f64,
        internal: &[f64; 2],
        velocity: &SVector<f64, 1>,
        a: f64,
        updated: Option<&mut [f64; 2]>,
    ) -> SVector<f64, 1> {
        let (traction, internal) = self.friction.traction(internal, &self.sliding(velocity, self.mass / a, 1.0));
        if let Some(updated) = updated {
            *updated = internal;
        }
        SVector::<f64, 1>::new(traction.force[0] - self.stiffness * pose)
    }

    fn balance(
        &self,
        t: f64,
        pose: &f64,
        internal: &[f64; 2],
        velocity: &SVector<f64, 1>,
        a: f64,
        tangent_share: f64,
    ) -> Balance<f64, f64, 1> {
        let contact = self.sliding(velocity, self.mass / a, tangent_share);
        Balance {
            force: self.forces(t, pose, internal, velocity, a, None),
            iteration_matrix: self.iteration_matrix(
                &self.friction.traction(internal, &contact).0.impedance[0],
                velocity,
                a,
            ),
        }
    }

    fn solve(&self, iteration_matrix: &f64, residual: &SVector<f64, 1>) -> SVector<f64, 1> {
        residual / *iteration_matrix
    }

    fn impulse(&self, imbalance: &SVector<f64, 1>) -> f64 {
        imbalance.x.abs()
    }

    fn differentiated(
        &self,
        t: f64,
        pose: &f64,
        internal: &[f64; 2],
        velocity: &SVector<f64, 1>,
    ) -> Differentiated<f64, f64, 1> {
        let contact = self.sliding(velocity, 0.0, 1.0);
        Differentiated {
            force: self.forces(t, pose, internal, velocity, 1.0, None),
            per_time: SVector::zeros(),
            jacobians: self.friction.traction(internal, &contact).0.impedance[0],
        }
    }

    fn iteration_matrix(&self, damping: &f64, _: &SVector<f64, 1>, a: f64) -> f64 {
        self.mass / a + damping + a * self.stiffness
    }

    fn pushed(&self, _: &f64, displacement: &SVector<f64, 1>) -> SVector<f64, 1> {
        displacement * -self.stiffness
    }
}

/// The period (s) of the limit cycle, from the instants at which the body lets go, in steps of `h` (s).
fn period<I: Integrator>(body: OnBelt, h: f64, duration: f64) -> f64 {
    let belt = body.belt;
    let kernel = Kernel::<f64, _, I>::new(body, h).unwrap();
    let mut state = kernel.at_rest(0.0);
    state.motion.velocity.x = belt;
    let (mut before, mut turns) = (belt, Vec::new());
    while kernel.time(state.steps) < duration {
        let _ = kernel.step(&mut state);
        let v = state.motion.velocity.x;
        // The body turns back once a period, while it slides: a crossing that is smooth in time.
        if before > 0.0 && v <= 0.0 {
            turns.push(kernel.time(state.steps) - h * v / (v - before));
        }
        before = v;
    }
    let [.., last, end] = turns[..] else { panic!("{turns:?}") };
    end - last
}

#[test]
fn periods_are_the_known_ones() {
    let textbook = || OnBelt { mass: 1.0, stiffness: 2.0, belt: 0.1, friction: StaticKinetic::new(1.5, 1.0).unwrap() };
    let slide_sized = || OnBelt {
        mass: 0.0818,
        stiffness: 1000.0,
        belt: 0.01,
        friction: StaticKinetic::new(0.24075, 0.1605).unwrap(),
    };
    for (name, known, found) in [
        ("textbook, sdirk2", 7.611259, period::<Sdirk2<4>>(textbook(), 2e-4, 40.0)),
        ("textbook, extrapolated", 7.611259, period::<Extrapolated<2, 4>>(textbook(), 2e-4, 40.0)),
        ("slide-sized, sdirk2", 0.059749, period::<Sdirk2<4>>(slide_sized(), 2e-6, 0.4)),
        ("slide-sized, extrapolated", 0.059749, period::<Extrapolated<2, 4>>(slide_sized(), 2e-6, 0.4)),
    ] {
        eprintln!("{name}: {found:.6} s, known {known} s");
        assert!((found / known - 1.0).abs() <= 5e-5, "{name}: {found} {known}");
    }
}
