//! Parts of drawings that are stated here, without a file.

use proptest::prelude::*;
use slipfit_qif::{
    drawing::{
        Axis, Control, Datum, Drawing, Feature, Geometric, Limits, Material, Plane, Range, Reference, Shape, Size,
        Tolerance, Zone,
    },
    model,
    part::{Part, write},
    results,
};

fn feature(name: &str, shape: Shape) -> Feature {
    Feature { id: name.into(), name: name.into(), kind: "Feature".into(), shape: Ok(shape) }
}

fn face(z: f64) -> Shape {
    let [along, normal] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    Shape::Plane(Plane { at: [0.0, 0.0, z], normal, along, extents: [80.0, 40.0], width: None })
}

fn hole(x: f64) -> Shape {
    let (at, along) = ([x, 0.0, -5.0], [0.0, 0.0, 1.0]);
    Shape::Axis(Axis { at, along, length: 10.0, diameter: 8.0, is_hole: Some(true) })
}

fn tolerance(id: &str, features: &[usize], limits: Limits) -> Tolerance {
    Tolerance { id: id.into(), name: String::new(), words: String::new(), features: features.to_vec(), limits }
}

fn geometric(control: Control, width: f64, zone: Zone, datums: &[usize]) -> Geometric {
    let frame = datums.iter().map(|i| Reference { datums: vec![*i], material: Material::None }).collect();
    Geometric { control, width, zone, material: Material::None, frame, within: None }
}

/// A plate with a top A, a parallel face B and two holes, C the first of them.
fn plate(tolerances: Vec<Tolerance>) -> Drawing {
    let features = vec![
        feature("top", face(0.0)),
        feature("bottom", face(-10.0)),
        feature("one", hole(-20.0)),
        feature("two", hole(20.0)),
    ];
    let datum =
        |(i, label): (usize, &str)| Datum { id: label.into(), label: label.into(), features: vec![i], targets: 0 };
    let datums = ["A", "B", "C"].into_iter().enumerate().map(datum).collect();
    Drawing { name: "plate".into(), features, datums, tolerances, remarks: Vec::new() }
}

fn of(part: &Part, id: &str) -> (Vec<String>, String) {
    let stated = part.stated.iter().find(|stated| stated.id == id).expect("a tolerance");
    (stated.features.clone(), stated.refused.join("; "))
}

#[test]
fn a_composite_position_is_stated_for_its_whole_pattern() {
    let lower = vec![Reference { datums: vec![0], material: Material::None }];
    let upper = geometric(Control::Position, 0.8, Zone::Cylinder, &[0]);
    let composite = Geometric { within: Some((0.2, lower)), ..upper };
    let part = write(&plate(vec![tolerance("1", &[2, 3], Limits::Geometric(composite.clone()))]), None, "x");
    let value =
        "position = { zone = 0.8, datum = [\"plate.A\"], within = 0.2, within_datum = [\"plate.A\"], pattern = \"1\" }";
    assert_eq!(part.text.matches(value).count(), 2, "{}", part.text);
    // A pattern of one axis is none.
    let part = write(&plate(vec![tolerance("1", &[2], Limits::Geometric(composite))]), None, "x");
    assert!(of(&part, "1").1.contains("composite"));
}

#[test]
fn tolerances_that_a_scene_refuses_are_listed() {
    let limits = Limits::Geometric;
    let size = |range| Limits::Diameter(Size { nominal: Some(8.0), range });
    let at_maximum =
        Geometric { material: Material::Maximum, ..geometric(Control::Position, 0.1, Zone::Cylinder, &[0]) };
    let part = write(
        &plate(vec![
            tolerance("fit", &[2], size(Range::Class("H7".into()))),
            tolerance("reversed", &[3], size(Range::Deviations([0.1, -0.1]))),
            tolerance(
                "inch",
                &[3],
                Limits::Diameter(Size { nominal: Some(0.315), range: Range::Deviations([0.0, 0.1]) }),
            ),
            tolerance("bonus", &[2, 3], limits(at_maximum)),
            tolerance("parallel datums", &[3], limits(geometric(Control::Position, 0.1, Zone::Cylinder, &[0, 1]))),
            tolerance("slab", &[3], limits(geometric(Control::Perpendicularity, 0.1, Zone::Slab(None), &[0]))),
            tolerance("itself", &[0], limits(geometric(Control::Parallelism, 0.1, Zone::Natural, &[0]))),
            tolerance("wide", &[1], limits(geometric(Control::Flatness, 0.2, Zone::Natural, &[]))),
            tolerance("narrow", &[1], limits(geometric(Control::Flatness, 0.1, Zone::Natural, &[]))),
            tolerance("to each other", &[0], limits(geometric(Control::Parallelism, 0.1, Zone::Natural, &[1]))),
            tolerance("and back", &[1], limits(geometric(Control::Parallelism, 0.1, Zone::Natural, &[0]))),
        ]),
        None,
        "x",
    );
    assert!(part.text.contains("diameter = { value = 8, tolerance = \"H7\" }"), "{}", part.text);
    assert_eq!(of(&part, "fit"), (vec!["C".to_owned()], String::new()));
    assert_eq!(of(&part, "bonus").0, ["C"]);
    assert_eq!(of(&part, "narrow").0, ["B"]);
    assert_eq!(of(&part, "and back").0, ["B"]);
    for id in ["reversed", "inch", "parallel datums", "slab", "itself", "wide", "to each other"] {
        let (features, reason) = of(&part, id);
        assert!(features.is_empty() && !reason.is_empty(), "{id}: {features:?} {reason}");
    }
    assert!(part.left_out.contains(" 8 of 11 tolerances"), "{}", part.left_out);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// A damaged file is an error or something else, but no panic.
    #[test]
    fn damaged_files_do_not_panic(cuts in prop::collection::vec((0.0..1.0_f64, 0_usize..60, "[<>/ a\"0-9.]{0,8}"), 1..4)) {
        for text in [include_str!("data/QIF_Results_Sample.QIF"), include_str!("data/WIDGET_QIF_RESULTS.QIF")] {
            let mut bytes = text.as_bytes().to_vec();
            for (place, length, with) in &cuts {
                let at = (place * bytes.len() as f64) as usize;
                let end = (at + length).min(bytes.len());
                bytes.splice(at..end, with.bytes());
            }
            let text = String::from_utf8_lossy(&bytes);
            let _ = results::read(&text);
            let _ = model::read(&text).map(|drawing| write(&drawing, None, "x"));
        }
    }
}
