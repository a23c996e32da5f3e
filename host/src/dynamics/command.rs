//! What a drive is commanded in place of a ramp, and where that leads.

use slipfit_core::drive::{Command as _, Drive, Piece};
use slipfit_desk::drive::Pieces;

/// A commanded speed over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Command {
    /// The speed (m/s, rad/s).
    pub pieces: Pieces,
    /// Whether it was recorded. Stretches of constant speed are not meant as such then, and the last speed is rest only to within noise.
    pub is_recorded: bool,
}

impl Command {
    /// The commanded speed (m/s, rad/s) at time `t` (s).
    pub fn at(&self, t: f64) -> f64 {
        self.pieces.piece(t).speed(t)
    }

    /// The same command with all speeds times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let scaled = |piece: &Piece<f64>| Piece { coefficients: piece.coefficients.map(|of| of * factor), ..*piece };
        Self { pieces: Pieces(self.pieces.0.iter().map(scaled).collect()), ..*self }
    }
}

/// The commanded distance from the start: the integral of a commanded speed, or positions that are held.
#[derive(Clone, Debug)]
pub struct Travel {
    pieces: Pieces,
    /// Distance (m, rad) at the start of each piece.
    places: Vec<f64>,
}

impl Travel {
    /// Of a drive's ramp, or of the `command` in place of it; the distances `held` (m, rad) from the start of each of its pieces on, if the
    /// command is of such.
    pub fn new(ramp: &Drive<f64>, command: Option<&Command>, held: Option<&[f64]>) -> Self {
        let pieces = command.map_or_else(|| ramp_of(ramp), |command| command.pieces.clone());
        let places = held.map_or_else(|| integrals(&pieces), <[f64]>::to_vec);
        Self { pieces, places }
    }

    /// The distance (m, rad) at time `t` (s).
    pub fn at(&self, t: f64) -> f64 {
        match self.pieces.0.partition_point(|piece| piece.start <= t) {
            0 => 0.0,
            after => self.places[after - 1] + integral(&self.pieces.0[after - 1], t),
        }
    }
}

/// Eq. 12's ramp, which is a cubic, as pieces.
fn ramp_of(Drive { ramp_start, ramp_end, speed, .. }: &Drive<f64>) -> Pieces {
    let duration = ramp_end - ramp_start;
    let [second, third] = [3.0, -2.0 / duration].map(|factor| factor * speed / (duration * duration));
    let rises = Piece { start: *ramp_start, coefficients: [0.0, 0.0, second, third] };
    Pieces([rises, Piece { start: *ramp_end, coefficients: [*speed, 0.0, 0.0, 0.0] }].into())
}

/// The distance from the start of a `piece` to time `t` (s).
fn integral(piece: &Piece<f64>, t: f64) -> f64 {
    let [a, b, c, d] = piece.coefficients;
    let since = t - piece.start;
    since * (a + since * (b / 2.0 + since * (c / 3.0 + since * d / 4.0)))
}

fn integrals(Pieces(pieces): &Pieces) -> Vec<f64> {
    let mut sum = 0.0;
    let after = pieces.windows(2).map(|two| {
        sum += integral(&two[0], two[1].start);
        sum
    });
    std::iter::once(0.0).chain(after).take(pieces.len()).collect()
}

/// The cubic spline through `values` at equal distances `step`: its coefficients from each value to the next. It has no curvature at its
/// ends, or this slope at its `start`.
pub fn spline(values: &[f64], step: f64, start: Option<f64>) -> Vec<[f64; 4]> {
    let last = values.len() - 1;
    // Second derivatives times step²/6, by elimination of M(i−1) + 4·M(i) + M(i+1) = second difference, zero at both ends.
    let (mut upper, mut second) = (vec![0.0; last + 1], vec![0.0; last + 1]);
    if let Some(slope) = start {
        (upper[0], second[0]) = (0.5, 0.5 * (values[1] - values[0] - slope * step));
    }
    for i in 1..last {
        let pivot = 4.0 - upper[i - 1];
        upper[i] = 1.0 / pivot;
        second[i] = (values[i + 1] - 2.0 * values[i] + values[i - 1] - second[i - 1]) / pivot;
    }
    for i in (0..last).rev() {
        second[i] -= upper[i] * second[i + 1];
    }
    let coefficients = |i: usize| {
        let slope = values[i + 1] - values[i] - 2.0 * second[i] - second[i + 1];
        let [square, cube] = [3.0 * second[i], second[i + 1] - second[i]];
        [values[i], slope / step, square / (step * step), cube / (step * step * step)]
    };
    (0..last).map(coefficients).collect()
}

#[cfg(test)]
mod tests {
    use slipfit_core::{Vector3, drive::Drive};

    use super::{Travel, spline};

    #[test]
    fn a_travel_is_the_integral_of_the_speed() {
        let ramp = Drive { gain: 1.0, ramp_start: 0.1, ramp_end: 0.4, speed: 0.2, point_b: Vector3::zeros() };
        let travel = Travel::new(&ramp, None, None);
        let mut sum = 0.0;
        let h = 1e-4;
        for k in 0..10_000 {
            let t = h * f64::from(k);
            sum += h * ramp.command(t + 0.5 * h);
            assert!((travel.at(t + h) - sum).abs() < 1e-9, "{t}");
        }
        assert_eq!(travel.at(0.05), 0.0);
    }

    #[test]
    fn a_spline_goes_through_its_values_and_is_smooth() {
        let h = 0.05;
        let values: Vec<f64> = (0..100).map(|i| libm::sin(3.0 * h * f64::from(i))).collect();
        let ends = [None, Some(3.0)].map(|start| spline(&values, h, start));
        assert!((ends[1][0][1] - 3.0).abs() < 1e-12);
        let [spline, _] = ends;
        let at = |i: usize, s: f64| {
            let [a, b, c, d] = spline[i];
            [((d * s + c) * s + b) * s + a, (3.0 * d * s + 2.0 * c) * s + b, 6.0 * d * s + 2.0 * c]
        };
        for i in 0..98 {
            for (end, start) in at(i, h).into_iter().zip(at(i + 1, 0.0)) {
                assert!((end - start).abs() < 1e-9, "{i}: {end} {start}");
            }
        }
        // Away from its ends, where it has no curvature.
        for i in 20..80 {
            let t = h * (i as f64 + 0.5);
            let [value, slope, _] = at(i, 0.5 * h);
            assert!((value - libm::sin(3.0 * t)).abs() < 1e-5 && (slope - 3.0 * libm::cos(3.0 * t)).abs() < 1e-4);
        }
    }
}
