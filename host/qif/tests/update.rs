//! A part in a scene follows its model, and nothing that the user wrote is lost.

use proptest::prelude::*;
use slipfit_qif::{
    drawing::{Control, Drawing, Geometric, Limits, Material, Reference, Tolerance, Zone},
    model::read,
    part::{
        update::{UpdateError, Updated, update},
        write,
    },
};

const CTC_01: &str = include_str!("data/nist_ctc_01_asme1_ap242.qif");
const CTC_03: &str = include_str!("data/nist_ctc_03_asme1_ap242.qif");

fn renewed(scene: &str, drawing: &Drawing) -> Updated {
    update(scene, drawing, Some("p"), "a file").expect("a renewed part")
}

/// A scene of the part `p` by a model, with what a user adds before, within and after it.
fn scene(drawing: &Drawing) -> String {
    let file = write(drawing, Some("p"), "a file").file();
    let own = "[[part.plane]]\nname = \"mine\" # a face that the model lacks\nat = [0, 0, 1]\nnormal = \"+z\"\nalong = \"+x\"\n\
               extents = [5, 5]\n\n[[part.axis]]\nname = \"B\"";
    let file = file.replacen("[[part.axis]]\nname = \"B\"", own, 1);
    assert!(file.contains("mine"));
    format!("# My scene.\ntitle = \"Mine\"   # with blanks\n\n[[part]]\nname = \"base\"\n\n{file}\n# The end.\n")
}

/// The model CTC-01 with a text of it changed.
fn changed(from: &str, to: &str) -> Drawing {
    let text = CTC_01.replace(from, to);
    assert_ne!(text, CTC_01, "{from}");
    read(&text).expect("a drawing")
}

/// Lines of one text that the other does not have.
fn only_in<'t>(one: &'t str, other: &str) -> Vec<&'t str> {
    one.lines().filter(|line| !other.lines().any(|l| l == *line)).collect()
}

#[test]
fn the_same_model_changes_nothing() {
    for text in [CTC_01, CTC_03] {
        let drawing = read(text).expect("a drawing");
        let scene = scene(&drawing);
        for scene in [scene.clone(), scene.replace('\n', "\r\n")] {
            let Updated { text, changes, part } = renewed(&scene, &drawing);
            assert_eq!(text, scene);
            assert_eq!((changes, part.name.as_str()), (Vec::new(), "p"));
        }
    }
}

#[test]
fn what_the_model_changes_is_renewed_and_told() {
    let scene = scene(&read(CTC_01).expect("a drawing"));
    // The flatness of A, and the diameter of B, by their limits.
    let drawing = changed("<ToleranceValue linearUnit=\"mm\">0.2<", "<ToleranceValue linearUnit=\"mm\">0.15<");
    let Updated { text, changes, .. } = renewed(&scene, &drawing);
    assert_eq!(changes, ["p.A: flatness is 0.15; it was 0.2"]);
    let [old, new] = [only_in(&scene, &text), only_in(&text, &scene)];
    assert!(old.len() == 1 && new.len() == 1 && new[0].starts_with("flatness = 0.15 #| "), "{old:?} {new:?}");
}

#[test]
fn what_the_user_changes_stays() {
    let drawing = read(CTC_01).expect("a drawing");
    let tighter = changed("<ToleranceValue linearUnit=\"mm\">0.2<", "<ToleranceValue linearUnit=\"mm\">0.15<");
    let scene = scene(&drawing);
    let with = |from: &str, to: &str| {
        let text = scene.replacen(from, to, 1);
        assert_ne!(text, scene, "{from}");
        text
    };
    // A value that the model still has otherwise.
    let edited = with("flatness = 0.2 #|", "flatness = 0.3 #|");
    let Updated { text, changes, .. } = renewed(&edited, &drawing);
    assert_eq!(text, edited);
    assert_eq!(changes, ["p.A: flatness stays 0.3, as you wrote it; the model has 0.2"]);
    // One that is no more of the import, whatever the model says.
    let taken = with("flatness = 0.2 #|", "flatness = 0.3 #");
    assert_eq!(renewed(&taken, &tighter).text, taken);
    // Keys beside what the model states.
    let spread = with("flatness = 0.2 #|", "flatness = { zone = 0.2, distribution = \"uniform\" } #|");
    assert_eq!(renewed(&spread, &drawing).text, spread);
    let Updated { text, changes, .. } = renewed(&spread, &tighter);
    assert!(text.contains("flatness = { zone = 0.15, distribution = \"uniform\" } #| "), "{text}");
    assert_eq!(changes.len(), 1);
    // A feature by another name, and all that refers to it in the part.
    let named = scene.replace("\"A\"", "\"base face\"").replace("\"p.A\"", "\"p.base face\"");
    let Updated { text, changes, .. } = renewed(&named, &drawing);
    assert_eq!((text, changes), (named, Vec::new()));
    // Another place is the model's.
    let moved = with("at = [-325, -175, -50]", "at = [-320, -175, -50]");
    let Updated { text, changes, .. } = renewed(&moved, &drawing);
    assert_eq!(text, scene);
    assert_eq!(changes, ["p.B: at is [-325, -175, -50]; it was [-320, -175, -50]"]);
}

#[test]
fn features_and_tolerances_come_and_go() {
    let full = read(CTC_01).expect("a drawing");
    let without = |feature: &str| {
        let mut drawing = full.clone();
        let index = drawing.features.iter().position(|f| f.name == feature).expect("a feature");
        drawing.features.remove(index);
        let shift = |list: &mut Vec<usize>| {
            list.retain(|i| *i != index);
            list.iter_mut().filter(|i| **i > index).for_each(|i| *i -= 1);
        };
        drawing.datums.iter_mut().for_each(|datum| shift(&mut datum.features));
        drawing.tolerances.retain(|tolerance| tolerance.features != [index]);
        drawing.tolerances.iter_mut().for_each(|tolerance| shift(&mut tolerance.features));
        drawing
    };
    for name in ["Nominal 2176", "Nominal 2162", "Nominal 2180"] {
        let (less, with) = (without(name), scene(&full));
        let with = with.replace(
            &format!("[[part.axis]]\nname = \"{name}\""),
            &format!("# above {name}\n[[part.axis]]\nname = \"{name}\""),
        );
        let Updated { text, changes, .. } = renewed(&with, &less);
        let expected: &[String] = match name {
            "Nominal 2180" => &[],
            name => &[format!("p.{name} is not in the model, and was removed")],
        };
        assert_eq!(changes, expected);
        assert!(!text.contains(&format!(" {name}\n")) || text.contains(&format!("# above {name}\n")), "{text}");
        // What the import of the smaller model has is all there, in its order, and the rest is the user's.
        let imported = write(&less, Some("p"), "a file");
        let mut lines = text.lines();
        for line in imported.file().lines().filter(|line| !line.is_empty()) {
            assert!(lines.any(|found| found == line), "{line}\n{text}");
        }
        for line in [
            "# My scene.",
            "title = \"Mine\"   # with blanks",
            "name = \"mine\" # a face that the model lacks",
            "# The end.",
        ] {
            assert_eq!(text.matches(line).count(), 1, "{line}");
        }
        // And back.
        let Updated { text: back, changes, .. } = renewed(&text, &full);
        assert_eq!(changes.len(), expected.len(), "{changes:?}");
        let sorted = |text: &str| {
            let mut lines: Vec<_> = text.lines().filter(|line| !line.is_empty()).map(str::to_owned).collect();
            lines.sort();
            lines
        };
        assert_eq!(sorted(&back), sorted(&with));
        toml::from_str::<toml::Table>(&back).expect("valid TOML");
    }
    // A tolerance alone.
    let mut less = full.clone();
    less.tolerances.retain(|tolerance| !tolerance.words.starts_with("Flatness"));
    let Updated { text, changes, .. } = renewed(&scene(&full), &less);
    assert_eq!(changes, ["p.A: flatness is not in the model, and was removed; it was 0.2"]);
    let Updated { text, changes, .. } = renewed(&text, &full);
    assert_eq!((text, changes), (scene(&full), vec!["p.A: flatness = 0.2 is new".to_owned()]));
}

/// What the user wrote into a feature outlives what the model had of it.
#[test]
fn comments_and_keys_of_the_user_outlive_the_model_s() {
    let full = read(CTC_01).expect("a drawing");
    let own = "# mine, above\n[[part.axis]]\nname = \"Nominal 2182\"";
    let scene = scene(&full)
        .replace("[[part.axis]]\nname = \"Nominal 2182\"", own)
        .replace("diameter = { value = 25,", "# mine, within\ndiameter = { value = 25,");
    assert_eq!(scene.matches("# mine,").count(), 2);
    let mut less = full.clone();
    let index = less.features.iter().position(|feature| feature.name == "Nominal 2182").expect("a feature");
    less.tolerances.retain(|tolerance| tolerance.features != [index]);
    let Updated { text, changes, .. } = renewed(&scene, &less);
    assert_eq!(text.matches("# mine,").count(), 2, "{text}");
    assert!(
        changes.len() == 1 && changes[0].starts_with("p.Nominal 2182: diameter is not in the model"),
        "{changes:?}"
    );
    // Without the feature as well, and with a measure that refers to it.
    less.features[index].shape = Err("gone".into());
    let measured = format!("{scene}\n[[measure]]\nname = \"m\"\ndistance = [\"p.A\", \"p.Nominal 2182\"]\n");
    let Updated { text, changes, .. } = renewed(&measured, &less);
    assert_eq!(text.matches("# mine,").count(), 2, "{text}");
    let line = text.lines().position(|line| line.contains("p.Nominal 2182\"")).expect("a line") + 1;
    assert_eq!(changes, [format!("p.Nominal 2182 is not in the model, and was removed; line {line} refers to it")]);
    // With a key of the user's it stays and is the user's.
    let keyed = scene.replace("# mine, within\n", "roundness = 0.01 # mine, within\n");
    let Updated { text, changes, .. } = renewed(&keyed, &less);
    assert!(changes.len() == 1 && changes[0].ends_with("as you added roundness"), "{changes:?}");
    assert!(text.contains("roundness = 0.01 # mine, within\n") && text.contains("diameter = { value = 25,"), "{text}");
    assert_eq!(renewed(&text, &less).text, text);
}

/// A datum stands above what refers to it also where the model has a new reference.
#[test]
fn datums_stand_above_what_refers_to_them() {
    let full = read(CTC_01).expect("a drawing");
    let mut other = full.clone();
    let of = |label: &str| full.datums.iter().position(|datum| datum.label == label).expect("a datum");
    other.tolerances.push(Tolerance {
        id: "1".into(),
        name: String::new(),
        words: "Perpendicularity B".into(),
        features: full.datums[of("A")].features.clone(),
        limits: Limits::Geometric(Geometric {
            control: Control::Perpendicularity,
            width: 0.3,
            zone: Zone::Natural,
            material: Material::None,
            frame: vec![Reference { datums: vec![of("B")], material: Material::None }],
            within: None,
        }),
    });
    let scene = scene(&full);
    let place = |text: &str, name: &str| text.find(&format!("name = \"{name}\" #|")).expect("a feature");
    assert!(place(&scene, "A") < place(&scene, "B"));
    let Updated { text, changes, .. } = renewed(&scene, &other);
    assert_eq!(changes, ["p.A: perpendicularity = { zone = 0.3, datum = [\"p.B\"] } is new"]);
    assert!(place(&text, "B") < place(&text, "A") && place(&text, "A") < place(&text, "Nominal 2159"), "{text}");
    assert_eq!(only_in(&scene, &text), ["#| 3 of 14 tolerances and dimensions of the file"]);
    toml::from_str::<toml::Table>(&text).expect("valid TOML");
}

#[test]
fn scenes_without_the_part_are_errors() {
    let drawing = read(CTC_01).expect("a drawing");
    let of = |text: &str| update(text, &drawing, Some("p"), "a file").expect_err("no part");
    let bad = of("title = \"x\"\n[[part]]\nname = 1 2\n");
    assert!(matches!(bad, UpdateError::Toml { line: 3, column: 8, .. }), "{bad:?}");
    let absent = of("[[part]]\nname = \"q\"\n[[part]]\nname = \"r\"\n").to_string();
    assert!(absent.contains("\"p\"") && absent.contains("q, r"), "{absent}");
    let typed = of("[[part]]\nname = \"p\"\n[[part.plane]]\nname = \"A\" # mine\n").to_string();
    assert!(typed.contains("was imported"), "{typed}");
    assert!(of("").to_string().contains("no [[part]]"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// A damaged scene is an error or another scene, but no panic.
    #[test]
    fn damaged_scenes_do_not_panic(cuts in prop::collection::vec((0.0..1.0_f64, 0_usize..80, "[\\[\\]{}=\"#|a.\n ]{0,8}"), 1..5)) {
        let drawing = read(CTC_01).expect("a drawing");
        let mut text = scene(&drawing);
        for (place, length, with) in &cuts {
            let boundary = |at: usize| (0..=at).rev().find(|i| text.is_char_boundary(*i)).unwrap_or(0);
            let at = boundary((place * text.len() as f64) as usize);
            let end = boundary((at + length).min(text.len())).max(at);
            text.replace_range(at..end, with);
        }
        if let Ok(found) = update(&text, &drawing, Some("p"), "a file") {
            prop_assert!(toml::from_str::<toml::Table>(&found.text).is_ok(), "{text}");
        }
    }

    /// Lines that a user puts anywhere stay there, each once, while the model changes.
    #[test]
    fn lines_of_the_user_stay(places in prop::collection::vec(0.0..1.0_f64, 1..12)) {
        let drawing = read(CTC_01).expect("a drawing");
        let changed = changed("<ToleranceValue linearUnit=\"mm\">0.2<", "<ToleranceValue linearUnit=\"mm\">0.15<");
        let mut lines: Vec<String> = scene(&drawing).lines().map(str::to_owned).collect();
        for (number, place) in places.iter().enumerate() {
            let at = (place * lines.len() as f64) as usize;
            lines.insert(at, format!("# mine {number};"));
        }
        let before = lines.join("\n") + "\n";
        let after = renewed(&before, &changed).text;
        for number in 0..places.len() {
            prop_assert_eq!(after.matches(&format!("# mine {number};\n")).count(), 1, "{}", &after);
        }
        prop_assert!(after.contains("flatness = 0.15"));
        prop_assert!(toml::from_str::<toml::Table>(&after).is_ok());
        // Once more changes nothing.
        prop_assert_eq!(&renewed(&after, &changed).text, &after);
    }
}
