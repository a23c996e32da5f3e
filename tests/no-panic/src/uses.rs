//! Every use a controller makes of the library, with inputs that the optimiser knows nothing about.

use core::hint::black_box;

use slipfit_core::{
    ParameterError, Vector2,
    integrator::{Extrapolated, ImplicitEuler, Integrator, Sdirk2},
    kernel::Kernel,
    law::{Elastic, Exact, Friction, Impact, Slot, ThreeHalves},
    menu::SlideVisitor,
    monitor::{JamWatch, LevelBank, Limits, Monitor, Sample, Watch},
    pose::Pose,
    slide::Slide,
    system::{
        Element, System,
        law::{Contact, Journal, Pusher, Slot as PlanarSlot},
        on_axis,
        planar::{Floating, Hole, Pin, PlanarPose, Pull},
    },
    table::{AxisKind, Scrubber, Slots, Table, TableError, Word},
};
use slipfit_problems::{cd_rom, mechanisms};

/// All uses; every input may be anything, so that every error is reached too.
pub fn all() {
    let _ = black_box(every_slide());
    let _ = black_box(smaller_scenes());
    let _ = black_box(planar_mechanisms());
    let _ = black_box(look_up());
}

/// Makes the slide and steps it, whatever laws its data ask for.
fn every_slide() -> Result<(), ParameterError<f32>> {
    black_box(cd_rom::data(black_box(0.0))).visit(Stepped)?
}

struct Stepped;

impl SlideVisitor<f32> for Stepped {
    type Output = Result<(), ParameterError<f32>>;

    fn visit<E: Elastic<f32>, F: Friction<f32>>(self, slide: Slide<f32, E, F>) -> Self::Output {
        step::<E, F, ImplicitEuler<4>>(slide)?;
        step::<E, F, Sdirk2<3>>(slide)?;
        step::<E, F, Extrapolated<2, 4>>(slide)
    }
}

fn step<E: Elastic<f32>, F: Friction<f32>, I: Integrator>(slide: Slide<f32, E, F>) -> Result<(), ParameterError<f32>> {
    let kernel = Kernel::<f32, _, I>::new(slide, black_box(1e-3))?;
    let mut state = black_box(kernel.at_rest(Pose::nominal()));
    let _ = black_box(kernel.step(&mut state));
    black_box(kernel.mechanism().gaps(&state.motion.pose));
    black_box(kernel.mechanism().drive().force(kernel.time(state.steps), state.motion.velocity.z));
    Ok(())
}

/// Makes and steps a planar body and one on an axis.
fn smaller_scenes() -> Result<(), ParameterError<f32>> {
    let data = black_box(cd_rom::data(black_box(0.0)));
    let normal = Impact::new(ThreeHalves::new(black_box(3e6))?, black_box(1e3), black_box(1e-4))?;
    let slot = Slot::new(black_box(0.0), black_box(1e-4))?;
    let body = Floating::new(
        data.body.mass,
        data.body.inertia_b.y,
        black_box(Vector2::zeros()),
        black_box(&[Vector2::zeros(); 4]),
    )?;
    let pull =
        Element { link: black_box(Pull { point: Vector2::zeros(), axis: Vector2::y() }), law: Pusher(data.drive) };
    let contact = Contact { normal, friction: Exact::new(black_box(0.3))? };
    let pin = Element { link: Pin { place: Vector2::zeros() }, law: PlanarSlot { gaps: [0.0, 1e-4], contact } };
    let flat = System::new(body, black_box(([pin; 4], pull)));
    let kernel = Kernel::<f32, _, Extrapolated<2, 4>>::new(flat, black_box(1e-3))?;
    let _ = black_box(kernel.step(&mut black_box(kernel.at_rest::<3>(PlanarPose::nominal()))));
    let hole =
        Element { link: Hole { centre: Vector2::zeros() }, law: Journal { clearance: 1e-5, radius: 5e-3, contact } };
    let swing = System::new(body, black_box(([hole; 4], pull)));
    let kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(swing, black_box(1e-3))?;
    let _ = black_box(kernel.step(&mut black_box(kernel.at_rest::<3>(PlanarPose::nominal()))));
    let driven = on_axis(black_box(1.0), black_box(0.0), slot, normal, data.drive)?;
    let kernel = Kernel::<f32, _, ImplicitEuler<4>>::new(driven, black_box(1e-3))?;
    let _ = black_box(kernel.step(&mut black_box(kernel.at_rest::<1>(0.0))));
    Ok(())
}

/// Makes and steps every shipped mechanism in a plane.
fn planar_mechanisms() -> Result<(), ParameterError<f32>> {
    macro_rules! step {
        ($($name:ident)*) => {$({
            let (kernel, mut state) = black_box(mechanisms::$name::predictor(black_box(0.0))?);
            let _ = black_box(kernel.step(&mut state));
        })*};
    }
    step!(four_bar slider_crank slider_crank_guide woodpecker_toy);
    Ok(())
}

/// Opens a table and looks it up.
fn look_up() -> Result<(), TableError> {
    static REGION: [u8; 256] = [0; 256];
    let region: &[u8] = black_box(&REGION);
    let axes = black_box([AxisKind::Level, AxisKind::Time]);
    let plane = Table::<2>::open(region)?.expect_axes(axes)?.expect_scene(black_box(0))?;
    black_box(plane.lookup(black_box([0.0; 2])));
    let space = Table::<3>::open(region)?;
    black_box(space.lookup(black_box([0.0; 3])));
    let word = Word::of(black_box(16)).ok_or(TableError::Unreadable)?;
    let slots = Slots::<2>::open(black_box([Some(region), Some(region)]), word, axes, black_box(0));
    black_box(slots.spare());
    black_box(word.record(black_box(0)).bytes());
    black_box(Scrubber::new(slots.newest()?).check(region, black_box(64)))?;
    watch(&plane);
    Ok(())
}

/// Watches a drive, for jams alone and by a table.
fn watch(table: &Table<'_>) {
    let limits = black_box(Limits::for_noise(1e-3, 0.0));
    let sample = black_box(Sample { time: 0.0, force: 0.0, speed: 0.0, command: 0.0 });
    black_box(black_box(JamWatch::default()).step(&limits, &sample));
    if let Ok(monitor) = Monitor::new(*table, black_box(0.0), limits) {
        let _ = black_box(monitor.step(&mut black_box(Watch::default()), &sample));
    }
    if let Ok(mut bank) = LevelBank::<_, 96>::new(*table) {
        bank.add(black_box(0.0), black_box(0.0));
        black_box(black_box(&bank).estimate());
    }
}
