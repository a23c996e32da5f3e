//! Reading what a drive is commanded: segments, one after the other.

use std::f64::consts::TAU;

use slipfit_core::drive::Piece;
use slipfit_tolerance::unit::{self, Quantity, Unit};

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

/// Kinds of segments in scene files.
const KINDS: &str = "ramp, hold, sine, chirp";

/// Pieces of a sine in each of its periods.
const PER_PERIOD: f64 = 48.0;

/// Most pieces of a command.
const MOST: usize = 20_000;

const DURATION: Quantity = Quantity { units: unit::SECONDS, range: [1e-6, 1e5] };
const FREQUENCY: Quantity = Quantity { units: unit::FREQUENCY, range: [1e-4, 1e4] };
const CYCLES: Quantity = Quantity { units: unit::ONE, range: [1.0, 1e4] };

/// Units of what a segment commands: of a drive that pushes, or one that turns.
pub struct Commanded {
    /// Of speeds.
    pub speed: Quantity,
    acceleration: Quantity,
    jerk: Quantity,
}

impl Commanded {
    /// Those of a drive that `turns` or pushes.
    pub fn new(turns: bool) -> Self {
        let of = |pushes: &'static [Unit], turned: &'static [Unit], least: f64| Quantity {
            units: if turns { turned } else { pushes },
            range: [least, 1e9],
        };
        Self {
            speed: Quantity { range: [-1e6, 1e6], ..of(unit::SPEED, unit::ROTATION, 0.0) },
            acceleration: of(unit::ACCELERATION, unit::ANGULAR_ACCELERATION, 1e-6),
            jerk: of(unit::JERK, unit::ANGULAR_JERK, 1e-6),
        }
    }
}

/// What is commanded so far.
struct Course {
    pieces: Vec<Piece<f64>>,
    t: f64,
    speed: f64,
}

impl Course {
    /// Goes on for a `duration` (s) with these coefficients; the speed there follows from them.
    fn add(&mut self, duration: f64, [first, second, third]: [f64; 3]) {
        let piece = Piece { start: self.t, coefficients: [self.speed, first, second, third] };
        self.pieces.push(piece);
        self.t += duration;
        self.speed = piece.speed(self.t);
    }

    /// Goes on to `speed` in a `duration` (s) by a cubic with these slopes at its ends.
    fn cubic(&mut self, duration: f64, speed: f64, [from, to]: [f64; 2]) {
        let rise = (speed - self.speed) / duration;
        self.add(
            duration,
            [from, (3.0 * rise - 2.0 * from - to) / duration, (from + to - 2.0 * rise) / (duration * duration)],
        );
        self.speed = speed;
    }
}

/// Reads the `segments` of a drive whose command starts at `start` (s), `cycles` times one after the other.
pub fn pieces(
    segments: &Field,
    cycles: Option<Field>,
    start: f64,
    units: &Commanded,
) -> Result<Vec<Piece<f64>>, SceneError> {
    let Value::List(nodes) = &segments.node.value else { return Err(segments.wrong_type("tables [[drive.segment]]")) };
    let mut course = Course { pieces: Vec::new(), t: start, speed: 0.0 };
    for node in nodes {
        let field = Field { key: segments.key.clone(), node };
        field.expect_table()?;
        segment(&field, units, &mut course)?;
        if course.pieces.len() > MOST {
            return Err(too_many(&field));
        }
    }
    if let Some(field) = cycles {
        let count = field.to_number(&CYCLES)?;
        if count.fract() != 0.0 {
            return Err(field.out_of_range("", "a whole number"));
        }
        let (one, length) = (course.pieces.clone(), course.t - start);
        if one.len() as f64 * count > MOST as f64 {
            return Err(too_many(&field));
        }
        if course.speed != 0.0 && count > 1.0 {
            let what = "cycles of segments that do not end at rest".into();
            return Err(field.error(Problem::Unsupported { what }, "a last segment that ends with speed = 0"));
        }
        for k in 1..count as u32 {
            let later = |piece: &Piece<f64>| Piece { start: piece.start + f64::from(k) * length, ..*piece };
            course.pieces.extend(one.iter().map(later));
        }
        course.t += (count - 1.0) * length;
    }
    // From then on it does not change.
    course.pieces.push(Piece { start: course.t, coefficients: [course.speed, 0.0, 0.0, 0.0] });
    // A kernel adds its pieces up, which leaves no negative zero.
    course.pieces.iter_mut().flat_map(|piece| &mut piece.coefficients).for_each(|of| *of += 0.0);
    Ok(course.pieces)
}

fn too_many(field: &Field) -> SceneError {
    field.out_of_range("", format!("no more than {MOST} pieces in all; a sine has {PER_PERIOD} a period"))
}

fn segment(table: &Field, units: &Commanded, course: &mut Course) -> Result<(), SceneError> {
    let kind = table.require("kind", KINDS)?;
    match kind.to_text()? {
        "ramp" => ramp(table, units, course),
        "hold" => {
            let duration = table.number("duration", &DURATION)?;
            course.add(duration, [0.0; 3]);
            Ok(())
        }
        "sine" => {
            let frequency = table.number("frequency", &FREQUENCY)?;
            wave(table, units, course, [frequency; 2])
        }
        "chirp" => {
            let frequencies = table.require("frequency", "a list of 2 frequencies, from and to")?;
            wave(table, units, course, frequencies.to_numbers(&FREQUENCY)?)
        }
        _ => Err(kind.error(Problem::Choice { key: kind.key.clone(), written: kind.written("") }, KINDS)),
    }
}

/// A ramp to another speed: in a time by the cubic STEP, by a constant acceleration, or by a limited acceleration and jerk.
fn ramp(table: &Field, units: &Commanded, course: &mut Course) -> Result<(), SceneError> {
    let speed = table.number("speed", &units.speed)?;
    let rise = speed - course.speed;
    let (duration, acceleration, jerk) = (table.get("duration"), table.get("acceleration"), table.get("jerk"));
    let (duration, most) = match (duration, acceleration) {
        (Some(duration), None) => {
            let duration = duration.to_number(&DURATION)?;
            if let Some(jerk) = jerk {
                return Err(jerk.no_effect("without `acceleration`", "duration, or acceleration with or without jerk"));
            }
            course.cubic(duration, speed, [0.0; 2]);
            return Ok(());
        }
        (None, Some(acceleration)) => {
            let most = acceleration.to_number(&units.acceleration)?;
            (rise.abs() / most, most)
        }
        (Some(_), Some(acceleration)) => {
            return Err(acceleration.no_effect("beside `duration`", "one of duration and acceleration"));
        }
        (None, None) => {
            let allowed = "duration, or acceleration with or without jerk";
            return Err(table.error(Problem::Missing("drive.segment.duration".into()), allowed));
        }
    };
    if rise == 0.0 {
        return Err(table
            .get("speed")
            .unwrap_or_else(|| table.clone())
            .no_effect("where the drive already has that speed", "another speed, or a segment of the kind \"hold\""));
    }
    let sign = rise.signum();
    match jerk {
        None => course.add(duration, [sign * most, 0.0, 0.0]),
        Some(jerk) => {
            let jerk = jerk.to_number(&units.jerk)?;
            // The acceleration is reached only where the speeds differ enough.
            let peak = most.min(libm::sqrt(rise.abs() * jerk));
            let build = peak / jerk;
            let middle = rise.abs() / peak - build;
            course.add(build, [0.0, 0.5 * sign * jerk, 0.0]);
            if middle > 1e-9 * build {
                course.add(middle, [sign * peak, 0.0, 0.0]);
            }
            course.add(build, [sign * peak, -0.5 * sign * jerk, 0.0]);
        }
    }
    // Not to within rounding.
    course.speed = speed;
    Ok(())
}

/// A sine about the speed that there is, whose frequency (Hz) goes evenly from the first to the last.
fn wave(table: &Field, units: &Commanded, course: &mut Course, [from, to]: [f64; 2]) -> Result<(), SceneError> {
    let amplitude = table.number("amplitude", &units.speed)?;
    let field = table.require("duration", &DURATION.units())?;
    let duration = field.to_number(&DURATION)?;
    let count = libm::ceil(duration * from.max(to) * PER_PERIOD).max(1.0);
    if count > MOST as f64 {
        return Err(too_many(&field));
    }
    let (base, each) = (course.speed, duration / count);
    let growth = (to - from) / duration;
    let at = |t: f64| {
        let phase = TAU * (from + 0.5 * growth * t) * t;
        (base + amplitude * libm::sin(phase), amplitude * libm::cos(phase) * TAU * (from + growth * t))
    };
    for k in 0..count as u32 {
        let [(_, before), (speed, after)] = [f64::from(k), f64::from(k + 1)].map(|k| at(k * each));
        course.cubic(each, speed, [before, after]);
    }
    // Whole periods end where they began; what rounding leaves is removed.
    if (course.speed - base).abs() < 1e-9 * amplitude.abs() {
        course.speed = base;
    }
    Ok(())
}
