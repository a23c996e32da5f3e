//! An estimate as a table of a scene.

use std::fmt::Write;

use slipfit_identify::{between::Between, estimate::Estimate};
use slipfit_tolerance::number::ten_digits;

use super::found::Written;

/// A parameter to be written: mean and deviation (SI).
struct Row<'a> {
    name: &'a str,
    unit: &'a str,
    mean: f64,
    deviation: f64,
}

/// The table `[uncertain]` of the `estimate` of one unit: means, deviations, correlations and, as comments, what a scene has no key for, such
/// as levels of gaps.
pub fn of_one(title: &str, written: &Written, estimate: &Estimate) -> String {
    let mut text = format!(
        "# {} of {title:?}, identified from {} samples by slipfit identify.\n",
        written.model, estimate.samples
    );
    if let Some(verdict) = &estimate.lack.verdict {
        let _ = writeln!(text, "# Lack of fit: {verdict}.");
    }
    for words in &estimate.undetermined {
        let _ = writeln!(text, "# Not determined: {words}.");
    }
    let known: Vec<usize> =
        (0..estimate.parameters.len()).filter(|i| estimate.parameters[*i].deviation.is_some()).collect();
    let rows = known.into_iter().filter_map(|i| {
        let own = &estimate.parameters[i];
        Some((i, Row { name: &own.name, unit: own.unit, mean: own.value, deviation: own.deviation? }))
    });
    let (keys, names) = table(written, rows);
    text + &keys + &correlations(&estimate.correlation, &names)
}

/// The correlations of the parameters that are unknowns of the scene: the number of each, and its name there.
fn correlations(correlation: &[Vec<f64>], names: &[(usize, String)]) -> String {
    let mut text = String::new();
    for (k, (column, other)) in names.iter().enumerate() {
        for (row, name) in &names[..k] {
            let coefficient = LESS * correlation[*row][*column];
            if coefficient.abs() >= SMALL {
                let _ = writeln!(
                    text,
                    "\n[[uncertain.correlation]]\nof = [{name:?}, {other:?}]\ncoefficient = {coefficient:.6}"
                );
            }
        }
    }
    text
}

/// By which correlations are less than found, so that rounded ones cannot contradict each other.
const LESS: f64 = 0.9999;
/// Correlation below which there is none.
const SMALL: f64 = 1e-3;

/// The same of several units: the mean of all is the unknown. How much the units differ is written as comments.
pub fn of_several(title: &str, written: &Written, pooled: &[Between]) -> String {
    let units = pooled.iter().map(|of| of.units).max().unwrap_or_default();
    let mut text =
        format!("# {} of {title:?}: the mean of {units} units, identified by slipfit identify.\n", written.model);
    for of in pooled {
        let spread = format!("{} {}", ten_digits(of.spread), of.unit);
        let _ =
            writeln!(text, "# {} differs from unit to unit by a standard deviation of {}.", of.name, spread.trim_end());
    }
    let rows = pooled.iter().enumerate();
    let rows = rows.map(|(i, of)| (i, Row { name: &of.name, unit: of.unit, mean: of.mean, deviation: of.deviation }));
    text + &table(written, rows).0
}

/// Names of a body and a drive of the scene that takes what is found of a drive train.
const OF_TRAIN: [(&str, &str); 2] = [("body", "stage"), ("drive", "motor")];

/// The table of the `rows` that the scene has keys for, and the number and name there of each; the others are comments.
fn table<'a>(written: &Written, rows: impl Iterator<Item = (usize, Row<'a>)>) -> (String, Vec<(usize, String)>) {
    let mut text = "\n[uncertain]\n".to_owned();
    // Keys of a table in a list, by list and name of the table.
    let mut names = Vec::new();
    let mut listed: Vec<([String; 2], Vec<String>)> = Vec::new();
    for (i, Row { name, unit, mean, deviation }) in rows {
        let unit =
            written.exponent.map_or_else(|| unit.to_owned(), |exponent| unit.replace("^e", &format!("^{exponent}")));
        let number = |value: f64| match &unit[..] {
            "" => ten_digits(value),
            unit => format!("\"{} {unit}\"", ten_digits(value)),
        };
        let [mean, deviation] = [mean, deviation].map(number);
        let place = match (written.model, written.lists.get(i).copied().flatten(), name.rsplit_once('.')) {
            ("drive-train", ..) => match name {
                "mass" if unit == "kg" => Some((OF_TRAIN[0], name)),
                "coulomb" | "viscous" | "offset" if unit.starts_with('N') => Some((OF_TRAIN[1], name)),
                // What no key of a scene says, such as a ratio of two or one direction's friction.
                _ => None,
            },
            (_, Some(Some(list)), Some((table, key))) => Some(((list, table), key)),
            (_, Some(None), Some(_)) => {
                names.push((i, name.to_owned()));
                let _ = writeln!(text, "{name} = {{ mean = {mean}, deviation = {deviation} }}");
                continue;
            }
            _ => None,
        };
        match place {
            None => {
                let _ = writeln!(text, "# {name}: mean {mean}, deviation {deviation}");
            }
            Some(((list, table), key)) => {
                names.push((i, format!("{table}.{key}")));
                let (at, line) = (
                    [list.to_owned(), table.to_owned()],
                    format!("{key} = {{ mean = {mean}, deviation = {deviation} }}"),
                );
                match listed.iter_mut().find(|(other, _)| *other == at) {
                    Some((_, lines)) => lines.push(line),
                    None => listed.push((at, vec![line])),
                }
            }
        }
    }
    for list in ["body", "joint", "drive"] {
        let of_list = listed.iter().filter(|([other, _], _)| other == list);
        let tables: Vec<_> =
            of_list.map(|([_, table], lines)| format!("{{ name = {table:?}, {} }}", lines.join(", "))).collect();
        if !tables.is_empty() {
            let _ = writeln!(text, "{list} = [{}]", tables.join(", "));
        }
    }
    (text, names)
}
