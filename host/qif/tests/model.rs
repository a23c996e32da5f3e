//! Product models: counted by scanning the text, and compared with what the drawing of the model shows.

use std::{collections::BTreeSet, time::Instant};

use slipfit_qif::{
    drawing::{Drawing, Limits},
    model::read,
    part::{Part, write},
};

const CTC_01: &str = include_str!("data/nist_ctc_01_asme1_ap242.qif");
const CTC_03: &str = include_str!("data/nist_ctc_03_asme1_ap242.qif");

fn part(text: &str) -> (Drawing, Part) {
    let drawing = read(text).expect("a drawing");
    let part = write(&drawing, Some("p"), "a file");
    (drawing, part)
}

/// How many elements with an id whose names end so are in a section of the text.
fn count(text: &str, section: &str, ending: &str) -> usize {
    let start = text.find(&format!("<{section} ")).expect("a section");
    let section = text[start..].split(&format!("</{section}>")).next().expect("an end");
    section.matches(&format!("{ending} id=\"")).count()
}

/// The value of a key of a feature of the part.
fn value<'t>(part: &'t toml::Table, feature: &str, key: &str) -> Option<&'t toml::Value> {
    let part = part["part"][0].as_table().expect("a table");
    let features = ["plane", "axis", "point"].iter().filter_map(|kind| part.get(*kind)?.as_array()).flatten();
    let mut own = features.filter(|found| found["name"].as_str() == Some(feature));
    own.next()?.get(key)
}

#[test]
fn everything_is_counted_and_nothing_lost() {
    for (text, listed) in [(CTC_01, 3), (CTC_03, 4)] {
        let (drawing, part) = part(text);
        assert_eq!(drawing.features.len(), count(text, "FeatureNominals", "FeatureNominal"));
        assert_eq!(drawing.tolerances.len(), count(text, "CharacteristicNominals", "CharacteristicNominal"));
        assert_eq!(drawing.datums.len(), count(text, "DatumDefinitions", "<DatumDefinition"));
        assert_eq!(part.listed(), listed);
        let counted = format!("#| {listed} of {} tolerances and dimensions", drawing.tolerances.len());
        let (others, list) = part.left_out.split_once(&counted).expect("a counted list");
        for (stated, tolerance) in part.stated.iter().zip(&drawing.tolerances) {
            let id = format!("[{}]", stated.id);
            let in_part = stated.features.len() == tolerance.features.len() && stated.refused.is_empty();
            assert_ne!(in_part, list.contains(&id), "{id} is in the part or in the list");
            let at_features = part.text.matches(&id).count() + others.matches(&id).count();
            assert_eq!(at_features, tolerance.features.len(), "{id} stands at its features");
        }
        toml::from_str::<toml::Table>(&part.file()).expect("valid TOML");
    }
}

/// Sizes, zones and datums of CTC-01, typed from the texts of the callouts that its file displays (PMIDisplay). The printed drawing
/// was not at hand.
#[test]
fn ctc_01_equals_its_drawing() {
    let (drawing, part) = part(CTC_01);
    let toml: toml::Table = toml::from_str(&part.file()).expect("valid TOML");
    let sizes = [
        ("B", 35.0, [-0.2, 0.0]),
        ("C", 35.0, [0.0, 0.2]),
        ("Nominal 2175", 20.0, [-0.1, 0.05]),
        ("Nominal 2176", 20.0, [-0.05, 0.1]),
        ("Nominal 2177", 35.0, [-0.2, 0.2]),
        ("Nominal 2178", 35.0, [-0.2, 0.2]),
        ("Nominal 2182", 25.0, [-0.15, 0.15]),
    ];
    let number = |value: &toml::Value| value.as_float().or(value.as_integer().map(|i| i as f64)).expect("a number");
    for (feature, nominal, deviations) in sizes {
        let diameter = value(&toml, feature, "diameter").expect("a diameter");
        assert_eq!(number(&diameter["value"]), nominal, "{feature}");
        assert_eq!([0, 1].map(|i| number(&diameter["tolerance"][i])), deviations, "{feature}");
        assert_eq!(value(&toml, feature, "kind").and_then(toml::Value::as_str), Some("hole"));
    }
    assert_eq!(value(&toml, "A", "flatness").map(number), Some(0.2));
    let frames: [(&str, &str, f64, &[&str]); 3] = [
        ("Nominal 2159", "position", 0.75, &["p.A", "p.B", "p.C"]),
        ("Nominal 2161", "position", 0.75, &["p.A", "p.B", "p.C"]),
        ("Nominal 2162", "perpendicularity", 1.5, &["p.A"]),
    ];
    for (feature, key, zone, datums) in frames {
        let callout = value(&toml, feature, key).expect("a callout");
        assert_eq!(number(&callout["zone"]), zone);
        let found: Vec<_> = callout["datum"].as_array().expect("datums").iter().filter_map(|d| d.as_str()).collect();
        assert_eq!(found, datums);
        assert!(callout.get("material").is_none());
    }
    // The zone of each geometric tolerance is the number that its presentation shows.
    for tolerance in &drawing.tolerances {
        if let Limits::Geometric(geometric) = &tolerance.limits {
            assert!(tolerance.words.contains(&format!(" {:.3}", geometric.width)), "{}", tolerance.words);
        }
    }
}

#[test]
fn ctc_03_is_converted_from_inch_with_its_modifiers() {
    let (drawing, part) = part(CTC_03);
    let toml: toml::Table = toml::from_str(&part.file()).expect("valid TOML");
    let of = |feature: &str, key: &str| value(&toml, feature, key).expect("a callout").clone();
    let is = |written: &str| toml::from_str::<toml::Table>(&format!("is = {written}")).expect("TOML")["is"].clone();
    assert_eq!(of("B", "diameter"), is("{ value = 11.1252, tolerance = [-0.127, 0.127] }"));
    for hole in ["Nominal 3054", "Nominal 3055"] {
        let datums = "[\"p.A\", \"p.B (M)\", \"p.C (M)\"]";
        let expected = format!("{{ zone = 0.05, material = \"maximum\", datum = {datums} }}");
        assert_eq!(of(hole, "position"), is(&expected));
    }
    for hole in 3057..=3060 {
        let datums = "[\"p.D\", \"p.B\", \"p.C\"]";
        let expected = format!("{{ zone = 0.05, material = \"maximum\", datum = {datums} }}");
        assert_eq!(of(&format!("Nominal {hole}"), "position"), is(&expected));
    }
    assert_eq!(of("E", "angularity"), is("{ zone = 0.04, datum = [\"p.A\"] }"));
    assert_eq!(of("E", "profile"), is("{ zone = 0.06, datum = [\"p.A\", \"p.B\", \"p.C\"] }"));
    assert_eq!(of("A", "profile"), is("0.01"));
    // The faces state the same Location; their boundaries tell them apart.
    let places: BTreeSet<_> = (3073..=3076).map(|face| of(&format!("Nominal {face}"), "at").to_string()).collect();
    assert_eq!(places.len(), 4);
    assert!(drawing.remarks.iter().any(|remark| remark.contains("inch")));
}

#[test]
fn what_is_not_understood_is_refused() {
    let refused = |from: &str, to: &str, id: &str| {
        let text = CTC_03.replacen(from, to, 1);
        assert_ne!(text, CTC_03, "{from}");
        let (_, part) = part(&text);
        part.stated.into_iter().find(|stated| stated.id == id).expect("a tolerance").refused.join("; ")
    };
    let zone = "<ToleranceValue\n          linearUnit=\"mm\">0.02</ToleranceValue>";
    let zone = if CTC_03.contains(zone) { zone } else { "<DatumReferenceFrameId>2052</DatumReferenceFrameId>" };
    let with = |element: &str| format!("{zone}{element}");
    let projected = refused(zone, &with("<ProjectedToleranceZoneValue>5</ProjectedToleranceZoneValue>"), "2055");
    assert!(projected.contains("Projected"), "{projected}");
    let free = refused(zone, &with("<FreeState>true</FreeState>"), "2055");
    assert!(free.contains("FreeState"), "{free}");
    assert_eq!(refused(zone, &with("<FreeState>false</FreeState>"), "2055"), "");
    let condition = "<MaterialModifier>MAXIMUM</MaterialModifier>";
    let reciprocal = refused(condition, "<MaterialModifier>MAXIMUM_RPR</MaterialModifier>", "2068");
    assert!(reciprocal.contains("MAXIMUM_RPR"), "{reciprocal}");
}

#[test]
fn damaged_models_are_errors_or_drawings_in_bounded_time() {
    let start = Instant::now();
    for at in (0..CTC_01.len()).step_by(40_009).filter(|at| CTC_01.is_char_boundary(*at)) {
        let error = read(&CTC_01[..at]).expect_err("a truncated file");
        assert!(error.line >= 1 && error.column >= 1);
    }
    for (from, to) in [("<Id>2154</Id>", "<Id>9</Id>"), ("0 0 1</Normal>", "0 0 0</Normal>"), (">35.2<", ">x<")] {
        let error = read(&CTC_01.replace(from, to)).expect_err(from);
        assert!(error.line > 1, "{error}");
    }
    assert!(start.elapsed().as_secs() < 20);
}

/// A model of more than 3 MB: that of CTC-03 with its geometry six times, the first of which counts.
#[test]
fn a_large_model_is_read_in_time_and_memory() {
    let from = CTC_03.find("<GeometrySet").expect("its start");
    let to = CTC_03.find("</GeometrySet>").expect("its end") + "</GeometrySet>".len();
    let text = format!("{}{}", &CTC_03[..to], CTC_03[from..to].repeat(5)) + &CTC_03[to..];
    assert!(text.len() > 3_000_000, "{}", text.len());
    let expected = part(CTC_03).1.text;
    let start = Instant::now();
    let (drawing, part) = part(&text);
    let (seconds, status) =
        (start.elapsed().as_secs_f64(), std::fs::read_to_string("/proc/self/status").expect("Linux"));
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("a peak").trim();
    println!("{} bytes, {seconds:.3} s, peak {peak}, {} tolerances", text.len(), drawing.tolerances.len());
    assert_eq!(part.text, expected);
    assert!(seconds < 2.0);
    let kilobytes: f64 = peak.trim_end_matches(" kB").trim().parse().expect("a number");
    assert!(kilobytes * 1024.0 < 20.0 * text.len() as f64);
}
