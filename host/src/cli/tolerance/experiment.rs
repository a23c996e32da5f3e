//! Designed experiments.

use serde::Serialize;
use slipfit_tolerance::{
    model::{Measure, Model},
    number::fixed,
    theory::experiment::{Design, Finding, experiment},
};

use crate::cli::{
    failure::Failure,
    terminal::{print, print_json, text_table},
};

/// Makes the experiment and shows it.
pub(super) fn show(title: &str, model: &Model, design: Design, json: bool) -> Result<(), Failure> {
    let made = experiment(model, design).map_err(|error| Failure::Input(error.to_string()))?;
    let scaled = |finding: &Finding, factor: f64| Finding {
        undefined: finding.undefined,
        mean: finding.mean * factor,
        range: finding.range.map(|end| end * factor),
        effects: finding.effects.iter().map(|effect| effect * factor).collect(),
        shares: finding.shares.clone(),
    };
    let quantities = model.measures.iter().map(|measure| measure.quantity);
    let findings: Vec<_> =
        made.findings.iter().zip(quantities).map(|(finding, q)| scaled(finding, q.factor())).collect();
    if json {
        let measures = model.measures.iter().zip(findings).map(|(measure, finding)| Named {
            name: measure.name.clone(),
            unit: measure.quantity.unit(),
            finding,
        });
        let measures = measures.collect();
        return print_json(&Designed { title, design, runs: made.runs, factors: &made.factors, measures });
    }
    let row = |(measure, finding): (&Measure, &Finding)| {
        let mut ranks: Vec<usize> = (0..made.factors.len()).collect();
        ranks.sort_by(|one, other| finding.shares[*other].total_cmp(&finding.shares[*one]));
        let most =
            ranks.into_iter().take(3).map(|k| format!("{} {}", made.factors[k], fixed(finding.shares[k] * 100.0, 1)));
        let [low, high] = finding.range;
        let told = |value: f64| if value.is_finite() { fixed(value, 4) } else { "-".to_owned() };
        let factors = match finding.undefined {
            0 => most.collect::<Vec<_>>().join(", "),
            count => format!("has no value in {count} of {} runs", made.runs),
        };
        vec![measure.name.clone(), told(finding.mean), told(low), told(high), factors]
    };
    let rows: Vec<_> = model.measures.iter().zip(&findings).map(row).collect();
    let table = text_table(&["measure", "mean", "least", "greatest", "factors, %"], &rows);
    print(&format!("{title}\n{} runs\n\n{table}", made.runs))
}

/// An experiment for machines.
#[derive(Serialize)]
struct Designed<'a> {
    title: &'a str,
    design: Design,
    runs: usize,
    factors: &'a [String],
    measures: Vec<Named>,
}

#[derive(Serialize)]
struct Named {
    name: String,
    unit: &'static str,
    #[serde(flatten)]
    finding: Finding,
}
