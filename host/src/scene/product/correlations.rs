//! Reads correlations of contributors.

use slipfit_tolerance::{
    model::{Contributor, Distribution, Variation},
    number::fixed,
    product::correlation,
    sampling::copula::{self, Coefficient},
    unit::{self, Quantity},
};

use crate::scene::{Problem, SceneError, value::Field};

use super::tables::{tables, texts};

const COEFFICIENT: Quantity = Quantity { units: unit::ONE, range: [-1.0, 1.0] };

/// The `[[correlation]]` of contributors, beside those that are `measured`: their numbers and the correlation of their scores.
pub(super) fn correlations(
    root: &Field,
    contributors: &[Contributor],
    measured: Vec<(usize, usize, f64)>,
) -> Result<Vec<(usize, usize, f64)>, SceneError> {
    const ALLOWED: &str = "a list of two contributors, such as [\"a\", \"b\"]";
    let kind = match root.get("tolerance").and_then(|table| table.get("correlation")) {
        None => Coefficient::Values,
        Some(field) => match field.to_text()? {
            "pearson" => Coefficient::Values,
            "spearman" => Coefficient::Ranks,
            _ => {
                let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
                return Err(field.error(problem, "pearson: of the values, or spearman: of their ranks"));
            }
        },
    };
    let first = measured.len();
    let mut correlations = measured;
    let mut fields = Vec::new();
    let tables = tables(root, "correlation")?;
    for table in &tables {
        let mut pair = Vec::new();
        for (name, field) in texts(table, "of", ALLOWED)? {
            let scalar = |c: &&Contributor| matches!(c.variation, Variation::Scalar { .. });
            let at = contributors.iter().position(|contributor| contributor.name == name && scalar(&contributor));
            pair.push(at.ok_or_else(|| {
                let names: Vec<_> = contributors.iter().filter(scalar).map(|c| c.name.as_str()).collect();
                let problem = Problem::UnknownName { of: "contributor of one variable".into(), name: name.into() };
                field.error(problem, names.join(", "))
            })?);
        }
        let of = table.require("of", ALLOWED)?;
        let &[row, column] = &pair[..] else {
            return Err(of.error(Problem::Length { key: of.key.clone(), found: pair.len() }, ALLOWED));
        };
        let same = |(a, b, _): &(usize, usize, f64)| [*a, *b] == [row, column] || [*a, *b] == [column, row];
        if row == column || correlations.iter().any(same) {
            let problem = Problem::Duplicate { key: of.key.clone(), name: contributors[column].name.clone() };
            let allowed =
                "two different contributors, every pair once; measured ones are correlated as their parts are";
            return Err(of.error(problem, allowed));
        }
        let fixed_at = |i: &&usize| {
            matches!(contributors[**i].variation, Variation::Scalar { distribution: Distribution::Constant(_), .. })
        };
        if let Some(fixed) = [row, column].iter().find(fixed_at) {
            let written = format!("{}, of which \"{}\" is constant", of.written(""), contributors[*fixed].name);
            let problem = Problem::OutOfRange { key: of.key.clone(), written };
            return Err(of.error(problem, "two contributors that vary"));
        }
        let field = table.require("coefficient", "a number from -1 to 1")?;
        let stated = field.to_number(&COEFFICIENT)?;
        let of = [row, column].map(|i| match &contributors[i].variation {
            Variation::Scalar { distribution, .. } => Some(distribution),
            Variation::Zone(_) | Variation::Disc(_) | Variation::Nested(_) => None,
        });
        let scores = match of {
            [Some(one), Some(other)] => copula::of_scores(one, other, kind, stated).map_err(|[least, greatest]| {
                if !(least.is_finite() && greatest.is_finite()) {
                    let what =
                        "a correlation of values of which one does not vary, or has no finite standard deviation"
                            .into();
                    return field.error(
                        Problem::Unsupported { what },
                        "correlation = \"spearman\" under [tolerance], of ranks",
                    );
                }
                let [least, greatest] = [least, greatest].map(|end| fixed(end, 3));
                field.out_of_range("", format!("between {least} and {greatest} for these two distributions"))
            })?,
            _ => stated,
        };
        correlations.push((row, column, scores));
        fields.push(field);
    }
    // As a whole: a part of a possible matrix with nothing beside it need not be one.
    if !correlation::is_positive_definite(contributors.len(), &correlations) {
        let greatest = correlations[first..].iter().zip(&fields).max_by(|a, b| a.0.2.abs().total_cmp(&b.0.2.abs()));
        if let Some((_, field)) = greatest {
            return Err(field.error(Problem::NotPositiveDefinite, "coefficients nearer to 0"));
        }
    }
    Ok(correlations)
}
