//! An estimate as a table of a scene.

use std::fmt::Write;

use slipfit_identify::estimate::{Estimate, Estimated};
use slipfit_tolerance::number::ten_digits;

/// The table `[uncertain]` of an `estimate`: means, deviations and, as a comment, correlations.
pub fn table(title: &str, model: &str, estimate: &Estimate) -> String {
    let mut text =
        format!("# {model} of {title:?}, identified from {} samples by slipfit identify.\n", estimate.samples);
    if let Some(verdict) = &estimate.lack.verdict {
        let _ = writeln!(text, "# Lack of fit: {verdict}.");
    }
    for words in &estimate.undetermined {
        let _ = writeln!(text, "# Not determined: {words}.");
    }
    let known: Vec<(usize, &Estimated)> =
        estimate.parameters.iter().enumerate().filter(|(_, parameter)| parameter.deviation.is_some()).collect();
    if known.len() > 1 {
        let _ = writeln!(text, "# Correlations, in the order of the keys:");
        for (i, _) in &known {
            let row: Vec<_> = known.iter().map(|(k, _)| format!("{:+.4}", estimate.correlation[*i][*k])).collect();
            let _ = writeln!(text, "#   {}", row.join(" "));
        }
    }
    text += "\n[uncertain]\n";
    for (_, parameter) in known {
        let Some(deviation) = parameter.deviation else { continue };
        let number = |value: f64| match parameter.unit {
            "" => ten_digits(value),
            unit => format!("\"{} {unit}\"", ten_digits(value)),
        };
        let _ = writeln!(
            text,
            "{} = {{ mean = {}, deviation = {} }}",
            key(&parameter.name, model),
            number(parameter.value),
            number(deviation)
        );
    }
    text
}

/// The key of a parameter; that of a drive train is below its own table.
fn key(name: &str, model: &str) -> String {
    let is_plain = |part: &str| part.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if name.split('.').all(is_plain) && model == "slide" {
        return name.to_owned();
    }
    match name.strip_prefix("n of ") {
        Some(gaps) => format!("gaps.{gaps:?}"),
        None => format!("drive_train.{}", name.replace(" / ", "_by_").replace(' ', "_")),
    }
}
