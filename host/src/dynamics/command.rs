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

#[cfg(test)]
mod tests {
    use slipfit_core::{Vector3, drive::Drive};

    use super::Travel;

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
}
