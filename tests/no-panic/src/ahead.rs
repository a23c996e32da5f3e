//! As the other image, for predicting the slide ahead of the clock, for bodies in space on ideal joints and for tables of a production:
//! all together would not fit the flash.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image;

#[cfg(not(target_os = "none"))]
fn main() {
    uses::all();
}

/// Every use a controller makes of it, with inputs that the optimiser knows nothing about.
mod uses {
    use core::hint::black_box;

    use slipfit_core::{
        ParameterError,
        ahead::{Ahead, Limits, State},
        drive::SetpointDrive,
        law::{Impact, Regularised, ThreeHalves},
        pose::Pose,
        production::{self, Production, SAVED_SIZE, Unit},
        table::{AxisKind, Table, TableError},
    };
    use slipfit_problems::{cd_rom, mechanisms::ball_rod};

    /// All uses.
    pub fn all() {
        let _ = black_box(predict());
        let _ = black_box(on_joints());
        static REGION: [u8; 256] = [0; 256];
        let _ = black_box(production(black_box(&REGION)));
        let _ = black_box(in_integers(black_box(&REGION)));
    }

    /// Makes and steps the shipped mechanism in space that has ideal joints.
    fn on_joints() -> Result<(), ParameterError<f32>> {
        let (kernel, mut state) = black_box(ball_rod::predictor(black_box(0.0))?);
        let _ = black_box(kernel.step(&mut state));
        Ok(())
    }

    /// Looks up in integers.
    fn in_integers(region: &[u8]) -> Result<(), TableError> {
        let table = Table::<2>::open(region)?.i16().ok_or(TableError::Magic)?;
        if let Ok(integers) = table.integers(black_box(0.0), black_box(1e-3)) {
            black_box((integers.lookup(black_box(7)), integers.scales()));
        }
        Ok(())
    }

    /// Watches a unit by a table of its production, and saves what is known of it.
    fn production(region: &[u8]) -> Result<(), TableError> {
        let production =
            Production::open(region)?.expect_over(black_box(AxisKind::Time))?.expect_scene(black_box(0))?;
        black_box((production.band(black_box(0.0)), production.row(black_box(0), black_box(0.0))));
        let mut unit = Unit::from_bytes(black_box(&[0; SAVED_SIZE]), black_box(0)).unwrap_or_default();
        if let Ok(watch) = production::Watch::new(production, black_box(1e-3)) {
            let mut stroke = watch.start();
            let sample = black_box(production::Sample { at: 0.0, force: 0.0, speed: 0.0, command: 0.0 });
            let _ = black_box(watch.step(&unit, &mut stroke, &sample));
            let _ = black_box(watch.finish(&mut unit, &stroke));
        }
        if let Some(line) = unit.drift().trend().line(black_box(0.03)) {
            black_box(line.strokes_until(black_box(0.1)));
        }
        black_box(unit.to_bytes(black_box(0)));
        Ok(())
    }

    fn predict() -> Result<(), ParameterError<f32>> {
        let data = black_box(cd_rom::data(black_box(0.0)));
        let contact = Impact::new(ThreeHalves::new(black_box(3e6))?, black_box(1e3), black_box(1e-4))?;
        let friction = Regularised::new(black_box(0.3), black_box(1e-4))?;
        let limits = black_box(Limits { period: 1e-3, tolerance: 7e-5, lead: 0.2, lag: 0.2, attempts: 2 });
        let slide = data.body.slide(contact, friction, data.drive)?.driven_by(SetpointDrive::new(data.drive.gain))?;
        let mut ahead = black_box(Ahead::new(slide, limits)?);
        let command = |t| data.drive.command(t);
        let mut state: State<f32, _, 6, 256> = black_box(ahead.at_rest(Pose::nominal(), black_box(70), command));
        black_box(ahead.plan(&mut state, black_box(3), black_box(0.1)));
        ahead.plan_all(&mut state, command);
        ahead.follow(&mut state, black_box(0.1));
        black_box(black_box(ahead.step(&mut state)).status());
        black_box(ahead.forecast(&state, black_box(20)));
        ahead.restart(black_box(&mut state));
        black_box(&state);
        Ok(())
    }
}
