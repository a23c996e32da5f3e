//! What strokes show of the friction: how coefficients and weighted forces differ from stroke to stroke of a unit.

use slipfit_core::production::{MODES_MOST, Record};

/// A friction that a stroke tells no better than by this share is not told at all.
const DEVIATION_MOST: f64 = 0.5;

/// Friction of a stroke, and the coefficients and the weighted force that the controller's code finds.
pub type Told = (f64, [f64; MODES_MOST], f64);

/// The variance of each coefficient from stroke to stroke of a unit.
pub fn set_variances(told: &[Vec<Told>], record: &mut Record) {
    let (mut squares, mut count) = ([0.0; MODES_MOST], 0.0);
    for strokes in told {
        for (k, sum) in squares.iter_mut().enumerate() {
            let mean = strokes.iter().map(|(_, coefficients, _)| coefficients[k]).sum::<f64>() / strokes.len() as f64;
            *sum += strokes.iter().map(|(_, c, _)| (c[k] - mean) * (c[k] - mean)).sum::<f64>();
        }
        count += strokes.len() as f64 - 1.0;
    }
    record.variances = squares.map(|sum| (sum / f64::max(count, 1.0)) as f32);
}

/// How the weighted force rises with the friction: of the mean unit, what each mode adds, and how well a stroke tells the friction.
pub fn set_response(told: &[Vec<Told>], record: &mut Record) {
    let slopes = told.iter().map(|strokes| {
        let count = strokes.len() as f64;
        let mean = strokes.iter().map(|(friction, ..)| friction).sum::<f64>() / count;
        let of = |friction: f64| friction - mean;
        let squares: f64 = strokes.iter().map(|(friction, ..)| of(*friction) * of(*friction)).sum();
        let products: f64 = strokes.iter().map(|(friction, _, weighted)| of(*friction) * weighted).sum();
        let coefficients: [f64; MODES_MOST] =
            std::array::from_fn(|k| strokes.iter().map(|(_, c, _)| c[k]).sum::<f64>() / count);
        (squares, products, coefficients)
    });
    // Least squares, weighted by how well each slope is known; coefficients are uncorrelated.
    let slopes: Vec<_> = slopes.collect();
    let whole: f64 = slopes.iter().map(|(squares, ..)| squares).sum();
    if whole == 0.0 {
        return;
    }
    let response = slopes.iter().map(|(_, products, _)| products).sum::<f64>() / whole;
    record.response = response as f32;
    // Of weighted forces about a straight line over the friction.
    let (mut noise, mut count) = (0.0, 0.0);
    for (strokes, (squares, products, _)) in told.iter().zip(&slopes) {
        let mean = strokes.iter().map(|(.., weighted)| weighted).sum::<f64>() / strokes.len() as f64;
        let whole: f64 = strokes.iter().map(|(.., weighted)| (weighted - mean) * (weighted - mean)).sum();
        noise += whole - if *squares > 0.0 { products * products / squares } else { 0.0 };
        count += strokes.len() as f64 - 2.0;
    }
    let noise = noise / f64::max(count, 1.0);
    for k in 0..MODES_MOST {
        let (products, squares) = slopes.iter().fold((0.0, 0.0), |(products, squares), slope| {
            let (square, product, coefficients) = slope;
            let c = coefficients[k];
            (products + c * (product - response * square), squares + square * c * c)
        });
        // What is within three standard deviations of nothing counts as nothing.
        let is_known = products * products > 9.0 * noise * squares;
        record.responses[k] = if is_known { (products / squares) as f32 } else { 0.0 };
    }
    // About each unit's own mean, by its own response.
    let (mut squares, mut count) = (0.0, 0.0);
    for (strokes, (.., coefficients)) in told.iter().zip(&slopes) {
        let Some(own) = record.response_of(&coefficients.map(|c| c as f32)).map(f64::from) else { continue };
        let mean = strokes.iter().map(|(.., weighted)| weighted).sum::<f64>() / strokes.len() as f64;
        squares += strokes.iter().map(|(.., weighted)| (weighted - mean) / own).map(|x| x * x).sum::<f64>();
        count += strokes.len() as f64 - 1.0;
    }
    let deviation = libm::sqrt(squares / f64::max(count, 1.0));
    if deviation > DEVIATION_MOST {
        (record.response, record.responses) = (0.0, [0.0; MODES_MOST]);
    }
    record.deviation = deviation.max(1e-9) as f32;
}

#[cfg(test)]
mod tests {
    use slipfit_core::production::{MODES_MOST, Record};

    use super::{Told, set_response, set_variances};

    /// Strokes of units whose weighted force is `10 + 4·c + (2 + 0.5·c)·friction`, `noise` up and down beside that.
    fn units(noise: f64) -> Vec<Vec<Told>> {
        let unit = |c: f64| {
            let stroke = |(friction, sign): (f64, f64)| {
                let mut coefficients = [0.0; MODES_MOST];
                coefficients[0] = c + 0.1 * sign;
                (friction, coefficients, 10.0 + 4.0 * c + (2.0 + 0.5 * c) * friction + noise * sign)
            };
            [(-0.03, 1.0), (-0.01, -1.0), (0.01, -1.0), (0.03, 1.0)].map(stroke).to_vec()
        };
        [-1.5, -0.5, 0.5, 1.5].map(unit).to_vec()
    }

    #[test]
    fn response_and_deviation_are_those_of_the_straight_lines() {
        let mut record = Record::default();
        set_response(&units(1e-4), &mut record);
        assert!((record.response - 2.0).abs() < 1e-6 && (record.responses[0] - 0.5).abs() < 1e-6, "{record:?}");
        assert_eq!(record.responses[1..], [0.0; MODES_MOST - 1]);
        // The frictions themselves: four of ±1 and ±3 % about a mean of none, by three degrees of freedom.
        assert!((f64::from(record.deviation) - libm::sqrt(20e-4 / 3.0)).abs() < 1e-5, "{record:?}");
        set_variances(&units(0.0), &mut record);
        // ±0.1, by three degrees of freedom of four.
        assert!((f64::from(record.variances[0]) - 0.01 * 4.0 / 3.0).abs() < 1e-8, "{record:?}");
    }

    #[test]
    fn a_friction_that_noise_hides_has_no_response() {
        let mut record = Record::default();
        set_response(&units(2.0), &mut record);
        assert_eq!((record.response, record.responses), (0.0, [0.0; MODES_MOST]));
        // Nor one that does nothing at all.
        let mut record = Record::default();
        let none = |(friction, coefficients, _): &Told| (*friction, *coefficients, 3.0);
        set_response(&units(0.0).iter().map(|unit| unit.iter().map(none).collect()).collect::<Vec<_>>(), &mut record);
        assert_eq!(record.response, 0.0);
    }
}
