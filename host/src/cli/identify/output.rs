//! An estimate as a table of a scene.

use std::fmt::Write;

use slipfit_identify::estimate::{Estimate, Estimated};
use slipfit_tolerance::number::ten_digits;

/// The table `[uncertain]` of an `estimate`: means, deviations and, as a comment, correlations and what a scene has no key for, such as
/// levels of gaps. Stiffnesses have the contact's `exponent`, of a slide.
pub fn table(title: &str, model: &str, estimate: &Estimate, exponent: Option<f64>) -> String {
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
    // Tables of a body and a drive, whose names are those of the scene that takes them.
    let mut of_train = Vec::new();
    for (_, parameter) in known {
        let Some(deviation) = parameter.deviation else { continue };
        let unit = exponent.map(|exponent| parameter.unit.replace("^e", &format!("^{exponent}")));
        let unit = unit.as_deref().unwrap_or(parameter.unit);
        let number = |value: f64| match unit {
            "" => ten_digits(value),
            unit => format!("\"{} {unit}\"", ten_digits(value)),
        };
        let [mean, deviation] = [parameter.value, deviation].map(number);
        let _ = match (model, parameter.name.strip_prefix("n of ")) {
            ("slide", Some(gaps)) => writeln!(text, "# n of {gaps}: mean {mean}, deviation {deviation}"),
            ("slide", None) => writeln!(text, "{} = {{ mean = {mean}, deviation = {deviation} }}", parameter.name),
            _ => {
                let table = match parameter.name.as_str() {
                    "mass" if unit == "kg" => "body = [{ name = \"stage\"",
                    "coulomb" | "viscous" | "offset" if unit.starts_with("N") => "drive = [{ name = \"motor\"",
                    // What no key of a scene says, such as a ratio of two or one direction's friction.
                    name => {
                        let _ = writeln!(text, "# {name}: mean {mean}, deviation {deviation}");
                        continue;
                    }
                };
                of_train.push((table, format!("{} = {{ mean = {mean}, deviation = {deviation} }}", parameter.name)));
                Ok(())
            }
        };
    }
    for table in ["body = [{ name = \"stage\"", "drive = [{ name = \"motor\""] {
        let keys: Vec<_> = of_train.iter().filter(|(of, _)| *of == table).map(|(_, key)| key.as_str()).collect();
        if !keys.is_empty() {
            let _ = writeln!(text, "{table}, {} }}]", keys.join(", "));
        }
    }
    text
}
