//! Which combinations of parameters a record determines, in words.

use nalgebra::DVector;

use super::covariance::Linearised;
use crate::model::Parameter;

/// A parameter that changes nothing in the record.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{name} has no influence on this record: it changes the output by less than a millionth; leave it out, or record a motion that depends on it"
)]
pub struct NoInfluence {
    /// The parameter.
    pub name: String,
}

/// Share of the output's size by which a parameter, moved across its scale, has to change it.
const LEAST_INFLUENCE: f64 = 1e-6;
/// Share of the greatest part in a combination below which a parameter has no part in it.
const NO_PART: f64 = 0.02;

/// Whether each of the `parameters`, at these `values`, has an influence on the `output`. The derivatives by one that has none, but is known
/// beforehand, become 0: they are rounding.
///
/// # Errors
/// [`NoInfluence`] names the first that has none and is not known beforehand.
pub fn check_influence(
    parameters: &[Parameter],
    values: &[f64],
    output: &[f64],
    sensitivities: &mut [Vec<f64>],
) -> Result<(), NoInfluence> {
    let size = |column: &[f64]| libm::sqrt(column.iter().map(|value| value * value).sum::<f64>());
    let whole = size(output).max(f64::MIN_POSITIVE);
    for ((parameter, value), column) in parameters.iter().zip(values).zip(sensitivities) {
        let is_small = size(column) * parameter.scale(*value) < LEAST_INFLUENCE * whole;
        if is_small && parameter.prior.is_none() {
            return Err(NoInfluence { name: parameter.name.clone() });
        }
        if is_small {
            column.fill(0.0);
        }
    }
    Ok(())
}

/// A combination of parameters that the record does not determine.
#[derive(Clone, Debug, PartialEq)]
pub struct Undetermined {
    /// Indices of the parameters that have a part in it.
    pub parameters: Vec<usize>,
    /// In words.
    pub words: String,
}

/// What `linearised` does not determine of the `parameters`, which have these `values`.
pub fn undetermined(parameters: &[Parameter], values: &[f64], linearised: &Linearised) -> Vec<Undetermined> {
    let of = |direction: &DVector<f64>| {
        let greatest = direction.iter().fold(0.0f64, |most, part| most.max(part.abs()));
        let part = |i: &usize| direction[*i].abs() > NO_PART * greatest;
        let taking: Vec<usize> = (0..parameters.len()).filter(part).collect();
        // How much each moves along the direction, in SI units.
        let moves: Vec<f64> = taking.iter().map(|i| direction[*i] * linearised.units[*i]).collect();
        let words = words(parameters, values, &taking, &moves);
        Undetermined { parameters: taking, words }
    };
    linearised.undetermined.iter().map(of).collect()
}

fn words(parameters: &[Parameter], values: &[f64], taking: &[usize], moves: &[f64]) -> String {
    let name = |i: &usize| parameters[*i].name.as_str();
    let close = |a: f64, b: f64| (a - b).abs() < 0.02 * (a.abs() + b.abs());
    if let ([a, b], [by_a, by_b]) = (taking, moves) {
        let (one, other) = (name(a), name(b));
        let same_unit = parameters[*a].unit == parameters[*b].unit;
        // What is kept while both move is what is known.
        if same_unit && close(*by_a, -by_b) {
            return format!("{one} and {other} only as a sum");
        }
        if same_unit && close(*by_a, *by_b) {
            return format!("{one} and {other} only as a difference");
        }
        if close(by_a * values[*b], by_b * values[*a]) {
            return format!("{one} and {other} only as a ratio");
        }
        if close(by_a * values[*b], -by_b * values[*a]) {
            return format!("{one} and {other} only as a product");
        }
    }
    let names: Vec<&str> = taking.iter().map(name).collect();
    match &names[..] {
        [] => "nothing".into(),
        [only] => format!("{only} not at all"),
        [first @ .., last] => {
            let ratios: Vec<String> =
                taking.iter().zip(moves).map(|(i, by)| parameters[*i].written(&format!("{:+.2e}", by))).collect();
            format!("{} and {last} only together: moved by {} they change nothing", first.join(", "), ratios.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Linearised, Parameter, check_influence, undetermined};

    fn parameter(name: &str) -> Parameter {
        Parameter { name: name.into(), unit: "N", bounds: [0.0, 10.0], start: 1.0, prior: None }
    }

    fn words(columns: &[Vec<f64>], values: &[f64]) -> Vec<String> {
        let parameters = [parameter("a"), parameter("b"), parameter("c")];
        let linearised = Linearised::new(columns, vec![0.0; columns[0].len()], vec![columns[0].len()]);
        let found = undetermined(&parameters[..columns.len()], values, &linearised);
        found.into_iter().map(|found| found.words).collect()
    }

    #[test]
    fn combinations_are_named() {
        let [x, y]: [Vec<f64>; 2] = [(0..50).map(f64::from).collect(), (0..50).map(|i| f64::from(i * i % 7)).collect()];
        let times = |column: &[f64], factor: f64| column.iter().map(|value| factor * value).collect::<Vec<_>>();
        assert_eq!(words(&[x.clone(), y.clone()], &[1.0, 1.0]), Vec::<String>::new());
        assert_eq!(words(&[x.clone(), x.clone()], &[1.0, 5.0]), ["a and b only as a sum"]);
        assert_eq!(words(&[x.clone(), times(&x, -1.0)], &[1.0, 5.0]), ["a and b only as a difference"]);
        assert_eq!(words(&[times(&x, 5.0), x.clone()], &[1.0, 5.0]), ["a and b only as a product"]);
        assert_eq!(words(&[times(&x, -5.0), x.clone(), y], &[1.0, 5.0, 1.0]), ["a and b only as a ratio"]);
    }

    #[test]
    fn a_parameter_without_influence_is_an_error() {
        let mut columns = [vec![1.0; 9], vec![1e-12; 9]];
        let error = check_influence(&[parameter("a"), parameter("b")], &[1.0, 1.0], &[2.0; 9], &mut columns);
        assert_eq!(error.expect_err("no influence").name, "b");
        let known = Parameter { prior: Some([0.0, 1.0]), ..parameter("b") };
        check_influence(&[parameter("a"), known], &[1.0, 1.0], &[2.0; 9], &mut columns)
            .expect("it is known beforehand");
        assert_eq!(columns[1], [0.0; 9]);
    }
}
