//! What image and host both run: a unit is taught by some strokes and watched, all sums of their bits printed.

use core::hint::black_box;

use slipfit_core::{
    production::{Production, Report, Row, SAVED_SIZE, Sample, Stroke, StrokeEnd, Unit, Watch},
    table::{AxisKind, Nodes},
};

use slipfit_firmware::{
    count::Count,
    fingerprint::Fingerprint,
    machine::{Machine, print},
};

/// Strokes of the unit; the friction of the last ones has risen.
const STROKES: u32 = 16;
const RISEN: u32 = 14;

/// By what share.
const RISE: f32 = 0.2;

/// Interval of the samples (s).
const PERIOD: f32 = 1e-3;

/// What the unit differs by from the mean, in standard deviations of each mode.
const COEFFICIENTS: [f32; 8] = [0.7, -0.4, 1.1, -0.9, 0.2, 0.5, -1.3, 0.8];

/// The speed commanded (m/s).
const COMMAND: f32 = 0.1;

/// Teaches and watches a unit on `machine` by the table at the start of `flash`.
pub fn run(machine: &mut impl Machine, flash: &[u8]) -> bool {
    let opened = black_box(Production::open(flash).and_then(|production| production.expect_over(AxisKind::Time)));
    let watch = match opened.map(|production| production.i16().map(|production| Watch::new(production, 1e-3))) {
        Ok(Some(Ok(watch))) => watch,
        _ => {
            print(machine, format_args!("no table of a production over time in i16"));
            return false;
        }
    };
    let production = watch.production();
    let (bytes, modes) = (production.table().length(), production.modes());
    print(machine, format_args!("production of {bytes} bytes, {modes} modes"));

    let (mut unit, mut samples, mut ends) = (Unit::default(), Count::default(), Count::default());
    let last = production.places().last();
    for number in 0..STROKES {
        let (mut stroke, mut seen) = (watch.start(), Fingerprint::default());
        let mut i = 0u16;
        loop {
            let at = f32::from(i) * PERIOD;
            if at > last {
                break;
            }
            let force = force(&watch, at) * if number < RISEN { 1.0 } else { 1.0 + RISE };
            let sample = Sample { at, force, speed: COMMAND, command: COMMAND };
            let mut report = Report::default();
            samples.add(machine.instructions(|| report = step(&watch, &unit, &mut stroke, &sample)));
            let Report { expected, own, speed, excess, limit, .. } = report;
            [expected, own, speed, excess, limit].into_iter().for_each(|number| seen.add(number));
            i += 1;
        }
        let mut end = StrokeEnd::default();
        ends.add(machine.instructions(|| end = finish(&watch, &mut unit, &stroke)));
        let saved = unit.to_bytes(0);
        let taken = Unit::from_bytes(&saved, 0).is_ok_and(|loaded| loaded == unit);
        let (rise, verdict) = (end.rise, end.verdict);
        print(machine, format_args!("stroke {number}: {verdict:?}, rise {rise:.5}, all samples {seen}, saved {taken}"));
    }
    print(machine, format_args!(""));
    for (what, count) in [("a sample", samples), ("a stroke's end", ends)] {
        if let Some(range) = count.range() {
            print(machine, format_args!("instructions of {what}: {range}"));
        }
    }
    let mut stroke = watch.start();
    let sample = Sample { at: 0.5, force: 1.0, speed: COMMAND, command: COMMAND };
    if let Some(bytes) = machine.stack(|| _ = black_box(step(&watch, &unit, &mut stroke, &sample))) {
        print(machine, format_args!("stack of a sample: {bytes} bytes"));
    }
    if let Some(bytes) = machine.stack(|| _ = black_box(finish(&watch, &mut unit, &stroke))) {
        print(machine, format_args!("stack of a stroke's end: {bytes} bytes"));
    }
    print(machine, format_args!("unit {} bytes, stroke {} bytes", size_of::<Unit>(), size_of::<Stroke>()));
    print(machine, format_args!("saved unit {SAVED_SIZE} bytes"));
    print(machine, format_args!("done"));
    true
}

/// The force of the unit (N).
fn force<V: Nodes>(watch: &Watch<'_, V>, at: f32) -> f32 {
    let production = watch.production();
    let row = |row: usize| production.row(row, at).map_or(0.0, |[force, _]| force);
    let modes = COEFFICIENTS.iter().take(production.modes()).enumerate();
    modes.fold(row(Row::Mean as usize), |sum, (k, coefficient)| sum + coefficient * row(Row::Mode as usize + k))
}

/// A sample as a controller passes it on, once in the image.
#[inline(never)]
fn step<V: Nodes>(watch: &Watch<'_, V>, unit: &Unit, stroke: &mut Stroke, sample: &Sample) -> Report {
    watch.step(unit, stroke, sample)
}

/// The end of a stroke, likewise.
#[inline(never)]
fn finish<V: Nodes>(watch: &Watch<'_, V>, unit: &mut Unit, stroke: &Stroke) -> StrokeEnd {
    watch.finish(unit, stroke)
}
