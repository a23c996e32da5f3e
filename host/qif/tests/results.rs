//! Measurement results against values that are found by scanning the text alone.

use slipfit_measured::{table::Column, unit::Unit};
use slipfit_qif::results::read;

const SHEET_METAL: &str = include_str!("data/SheetMetal_QIF_Results_6_samples.QIF");
const WIDGET: &str = include_str!("data/WIDGET_QIF_RESULTS.QIF");
const SAMPLE: &str = include_str!("data/QIF_Results_Sample.QIF");

/// The text between `start` and `end` in each place.
fn between<'t>(text: &'t str, start: &str, end: &str) -> Vec<&'t str> {
    text.split(start).skip(1).filter_map(|rest| rest.split(end).next()).collect()
}

/// Characteristic item and value of each measurement, by part.
fn scanned(text: &str) -> Vec<Vec<(&str, f64)>> {
    let of_part = |part: &'static str| between(part, "CharacteristicMeasurement id=", "CharacteristicMeasurement>");
    let text: &'static str = String::leak(text.to_owned());
    let value = |measurement: &'static str| {
        let item = between(measurement, "<CharacteristicItemId>", "<")[0].trim();
        let value = between(measurement, "<Value", "</Value>")[0].split_once('>').expect("a value").1;
        (item, value.trim().parse().expect("a number"))
    };
    between(text, "<MeasurementResults id=", "</MeasurementResults>")
        .into_iter()
        .map(|part| of_part(part).into_iter().map(value).collect())
        .collect()
}

/// Name of a characteristic item.
fn name_of<'t>(text: &'t str, item: &str) -> &'t str {
    let items = between(text, "<CharacteristicItems", "</CharacteristicItems>")[0];
    let own = between(items, &format!("CharacteristicItem id=\"{item}\""), "CharacteristicItem>")[0];
    between(own, "<Name>", "<")[0]
}

fn column<'t>(columns: &'t [Column], name: &str) -> &'t Column {
    columns.iter().find(|column| column.name == name).unwrap_or_else(|| panic!("no column {name}"))
}

#[test]
fn sheet_metal_has_228_values_with_names_of_their_own() {
    let table = read(SHEET_METAL).expect("a table");
    let scanned = scanned(SHEET_METAL);
    assert_eq!((scanned.len(), scanned.iter().map(Vec::len).sum::<usize>()), (6, 228));
    assert_eq!((table.parts(), table.columns().len()), (6, 38));
    let names: std::collections::BTreeSet<_> = table.columns().iter().map(|column| &column.name).collect();
    assert_eq!(names.len(), 38);
    let mut compared = 0;
    for (part, values) in scanned.iter().enumerate() {
        for (i, (item, value)) in values.iter().enumerate() {
            let number = values[..i].iter().filter(|(other, _)| other == item).count() + 1;
            let own = name_of(SHEET_METAL, item);
            let is_single = values.iter().filter(|(other, _)| other == item).count() == 1;
            let name = if is_single { own.to_owned() } else { format!("{own} ({number})") };
            assert_eq!(column(table.columns(), &name).values[part], Some(*value), "{name} of part {part}");
            compared += 1;
        }
    }
    assert_eq!(compared, 228);
    assert!(table.columns().iter().all(|column| column.missing() == 0 && column.unit == Unit::Millimetre));
    assert_eq!(table.labels().expect("labels")[..2], ["SN5802801", "SN5802802"]);
    // PointProfile 12: 4 mm, equally disposed.
    let first = &table.columns()[0];
    assert_eq!(
        (first.name.as_str(), first.nominal, first.limits),
        ("W1RFTMRA02V (1)", Some(0.0), [Some(-2.0), Some(2.0)])
    );
}

#[test]
fn every_value_of_the_other_files_is_in_the_table() {
    for (text, count) in [(WIDGET, 42), (SAMPLE, 13)] {
        let table = read(text).expect("a table");
        let mut expected: Vec<f64> = scanned(text).concat().into_iter().map(|(_, value)| value).collect();
        let mut found: Vec<f64> = table.columns().iter().flat_map(Column::measured).collect();
        expected.sort_by(f64::total_cmp);
        found.sort_by(f64::total_cmp);
        assert_eq!((found.len(), table.parts()), (count, 1));
        assert_eq!(found, expected);
    }
}

#[test]
fn limits_are_sizes_whatever_the_file_states() {
    let table = read(SAMPLE).expect("a table");
    let of = |name: &str| {
        let column = column(table.columns(), name);
        (column.nominal, column.limits)
    };
    // Deviations ±0.2 of 774.269897460938; sizes; a profile of 1.5 of which 1 is outside.
    assert_eq!(of("2"), (Some(774.269897460938), [Some(774.069897461), Some(774.469897461)]));
    assert_eq!(of("3"), (None, [Some(944.802746582031), Some(945.2027465820311)]));
    assert_eq!(of("4 (1)").1, [Some(-0.5), Some(1.0)]);
}

#[test]
fn units_stand_on_values_in_inch() {
    let text = SAMPLE
        .replace("<Value>9.499476</Value>", "<Value linearUnit=\"inch\">0.374</Value>")
        .replace("</PrimaryUnits>", "</PrimaryUnits><OtherUnits n=\"1\"><LinearUnit><SIUnitName>meter</SIUnitName><UnitName>inch</UnitName><UnitConversion><Factor>0.0254</Factor></UnitConversion></LinearUnit></OtherUnits>");
    let table = read(&text).expect("a table");
    let inch: Vec<_> = table.columns().iter().filter(|column| column.unit == Unit::Inch).collect();
    assert_eq!(inch.len(), 1);
    assert_eq!(inch[0].values, [Some(0.374)]);
    // 10 ± 0.4 mm.
    assert_eq!(inch[0].nominal, Some(0.393700787402));
    assert_eq!(inch[0].limits, [Some(0.377952755906), Some(0.409448818898)]);
}

#[test]
fn damaged_files_are_errors_with_a_place() {
    for at in (0..SAMPLE.len()).step_by(997).filter(|at| SAMPLE.is_char_boundary(*at)) {
        let error = read(&SAMPLE[..at]).expect_err("a truncated file");
        assert!(error.line >= 1 && error.column >= 1);
    }
    let error = read(&SAMPLE.replace("<Value>9.499476</Value>", "<Value>NaN</Value>")).expect_err("not a number");
    assert_eq!(error.to_string().split_once(": ").expect("a place").1, "`NaN` is not a finite number");
    let error = read(include_str!("data/nist_ctc_01_asme1_ap242.qif")).expect_err("no results");
    assert!(error.to_string().contains("no measurement results"), "{error}");
}

/// A part that lacks one of two values of an item does not say which of them it lacks.
#[test]
fn a_value_without_its_pair_is_not_guessed() {
    let parts: Vec<&str> = SHEET_METAL.split("<MeasurementResults id=").collect();
    let third = parts[3];
    let scanned = scanned(SHEET_METAL);
    let repeated = |item: &str| scanned[2].iter().filter(|(other, _)| *other == item).count() > 1;
    let measurement = third
        .split("<PointProfileCharacteristicMeasurement ")
        .skip(1)
        .find(|text| repeated(between(text, "<CharacteristicItemId>", "<")[0].trim()))
        .expect("an item with two values");
    let end = "</PointProfileCharacteristicMeasurement>";
    let whole =
        format!("<PointProfileCharacteristicMeasurement {}{end}", measurement.split(end).next().expect("an end"));
    let without = third.replacen(&whole, "", 1);
    let less = [&parts[..3], &[without.as_str()], &parts[4..]].concat();
    let less = less.join("<MeasurementResults id=");
    assert!(less.len() < SHEET_METAL.len());
    let error = read(&less).expect_err("a value without its pair");
    let line =
        less[..less.match_indices("<MeasurementResults id=").nth(2).expect("the third").0].matches('\n').count() + 1;
    assert_eq!(error.line as usize, line);
    assert!(error.to_string().contains("1 of the 2 values"), "{error}");
}

#[test]
fn units_that_are_not_declared_are_told_at_their_value() {
    let text = SHEET_METAL.replacen("<Value>", "<Value linearUnit=\"furlong\">", 1);
    let error = read(&text).expect_err("a unit that is nowhere");
    let line = text[..text.find("furlong").expect("it")].matches('\n').count() + 1;
    assert!(error.line as usize == line && error.to_string().contains("`furlong`"), "{error}");
}
