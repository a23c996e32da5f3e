//! The shipped scenes, every kind of bad input, and that no text panics.

use proptest::prelude::*;
use slipfit_core::slide::ABSENT;
use slipfit_problems::cd_rom;

use crate::dynamics::scheme::{IntegratorKind, ScalarKind};

use super::{CD_ROM_SLIDE, Override, Problem, SceneError, SceneFile, shipped};
use crate::setup::{ControllerSpec, LevelRange, RunSpec, Scene};

const FAST: &str = include_str!("../../scenes/cd-rom-slide-fast.toml");

fn parse(text: &str, overrides: &[&str]) -> Result<Scene, SceneError> {
    let overrides: Vec<_> = overrides.iter().map(|text| Override::set(text)).collect();
    Scene::parse("scene.toml", text, &overrides)
}

/// The message for the paper's scene with `from` replaced by `to`.
fn message(from: &str, to: &str) -> String {
    assert!(CD_ROM_SLIDE.contains(from), "{from}");
    match parse(&CD_ROM_SLIDE.replacen(from, to, 1), &[]) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("accepted: {to}"),
    }
}

/// Where in `text` the bar in `marked` stands.
fn line_and_column(text: &str, marked: &str) -> String {
    let at = text.find(&marked.replace('|', "")).unwrap() + marked.find('|').unwrap();
    let before = &text[..at];
    let column = before.chars().rev().take_while(|character| *character != '\n').count() + 1;
    format!("{}:{column}", before.matches('\n').count() + 1)
}

/// The paper's scene with overrides.
fn with(overrides: &[&str]) -> Scene {
    parse(CD_ROM_SLIDE, overrides).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_shipped_scene_is_the_paper_s_to_the_last_bit() {
    let scene = with(&[]);
    for n in [0.0, 1.0, 2.5, -3.0] {
        assert_eq!(scene.slide_data::<f64>(&scene.gaps_at(&[n; 16])), cd_rom::data(n));
    }
    assert_eq!(scene.title, "CD-ROM slide");
    assert_eq!(scene.pins[2].name, "left front");
    assert_eq!(scene.nominal_clearance, Some([0.4 / 1000.0; 2]));
    assert_eq!(scene.run, RunSpec { duration: 0.2, stroke: Some(0.08), error: 3e-7 });
    let controller = ControllerSpec { step: 1e-3, integrator: IntegratorKind::ImplicitEuler, scalar: ScalarKind::F32 };
    assert_eq!(scene.controller, controller);
    assert_eq!(scene.sweep, LevelRange { first: -3.0, step: 0.1, count: 81 });

    let mut fast = parse(FAST, &[]).unwrap();
    assert_eq!((fast.drive.ramp_end, fast.title.as_str()), (0.1, "CD-ROM slide, fast ramp"));
    (fast.drive.ramp_end, fast.title) = (1.0, scene.title.clone());
    assert_eq!(fast, scene);
}

#[test]
fn units_mean_the_same() {
    for set in [
        "slide.mass=0.0818 kg",
        "slide.mass = \"81.8g\"",
        "slide.inertia_box=['13 cm', '0.012 m', 150]",
        "slide.gravity=[0, '-9810 mm/s^2', 0]",
        "contact.stiffness=\"100 N/mm^1.5\"",
        "contact.stiffness=100.0 N/mm^1.5",
        "contact.damping=1000 N*s/m",
        "contact.damping=1 Ns/mm",
        "contact.depth=100 um",
        "friction.law=regularised",
        "drive.ramp_start=50 ms",
        "drive.speed=0.1 m/s",
        "run.duration=0.2 s",
        "run.stroke=8 cm",
        "controller.step=1 ms",
        "controller.scalar=f32",
        "pin.left front.left=['-22.3 µm', 0.0624]",
        "sweep.n=-3:5:0.1",
        "drawing={clearance = [0.4, 0.4]}",
    ] {
        assert_eq!(with(&[set]), with(&[]), "{set}");
    }
}

#[test]
fn overrides_apply_in_order() {
    let scene = with(&["slide.mass=1", "slide.mass=90 g", "friction.law=none", "sweep.n=2.5", "slide.gravity=[0,0,1]"]);
    assert_eq!((scene.slide.mass, scene.slide.gravity), (0.09, [0.0, 0.0, 1.0]));
    assert_eq!(scene.sweep.levels(), [2.5]);
    assert_eq!(with(&["sweep.n=10:10:05"]).sweep.count, 1);
    assert_eq!(with(&["contact.exponent=1", "contact.stiffness=7 N/mm"]).contact.stiffness, 7000.0);
    assert_eq!(with(&["contact.exponent=2", "contact.stiffness=7 N/m^2"]).contact.stiffness, 7.0);
    assert_eq!(with(&["title=a b"]).title, "a b");
}

#[test]
fn what_may_be_left_out() {
    let without = |line: &str| parse(&CD_ROM_SLIDE.replacen(line, "", 1), &[]).unwrap();
    assert_eq!(without("title = \"CD-ROM slide\"").title, "scene");
    assert_eq!(without("point = [0, 0, 0]"), with(&[]));
    assert_eq!(without("clearance = [0.4, 0.4]").nominal_clearance, None);
    assert_eq!(without("wall = [0.5757, 0.0465]").gaps_at(&[0.0; 16])[3], ABSENT);
    assert_eq!(without("stroke = 80 ").run.stroke, None);
    let (before, rest) = CD_ROM_SLIDE.split_once("[controller]").unwrap();
    let (_, after) = rest.split_once("[sweep]").unwrap();
    assert_eq!(parse(&format!("{before}[sweep]{after}"), &[]).unwrap().controller, with(&[]).controller);
    let (front, _) = CD_ROM_SLIDE.rsplit_once("[[pin]]").unwrap();
    let three = parse(front, &[]).unwrap();
    assert_eq!((three.pins[3].gaps, three.pins[3].position), ([None; 4], [0.0; 3]));
}

#[test]
fn every_bad_value_is_shown_with_its_place_and_what_is_allowed() {
    let gap = "left = [0.0064, 0.0404]";
    for (from, to, [marked, problem, allowed]) in [
        (
            "mass = 81.8 ",
            "mas = 81.8 ",
            ["|mas = ", "unknown key `slide.mas`, did you mean `slide.mass`", "inertia_box"],
        ),
        (
            "[sweep]",
            "[swep]",
            ["[|swep]", "unknown key `swep`, did you mean `sweep`?", "title, include, slide, contact"],
        ),
        ("wall = [0.5757", "floor = [0.5757", ["|floor = ", "unknown key `pin.floor`", "rail, wall"]),
        ("mass = 81.8 ", "", ["|[slide]", "`slide.mass` is missing", "a number in g, or a text with its unit: g, kg"]),
        ("law = \"regularised\"", "", ["|[friction]", "`friction.law` is missing", "regularised, exact, none"]),
        ("mass = 81.8 ", "mass = true ", ["mass = |true", "`slide.mass` is a boolean", "a number in g"]),
        (
            "gravity = [0, -9.81, 0]",
            "gravity = 9.81",
            ["gravity = |9.81", "`slide.gravity` is a number", "a list of 3"],
        ),
        (
            "gravity = [0, -9.81, 0]",
            "gravity = [0]",
            ["gravity = |[0]", "`slide.gravity` is a list of 1", "a list of 3"],
        ),
        ("law = \"regularised\"", "law = 3", ["law = |3", "`friction.law` is a number", "a text in quotes"]),
        ("mass = 81.8 ", "mass = \"81.8\" ", ["mass = |\"81.8\"", "\"81.8\", whose unit does not fit", "g, kg"]),
        ("mass = 81.8 ", "mass = \"81.8 mm\" ", ["mass = |\"81.8 mm", "\"81.8 mm\", whose unit does not fit", "g, kg"]),
        (
            "mass = 81.8 ",
            "mass = \"heavy\" ",
            ["mass = |\"heavy", "\"heavy\", which is not a number with its unit", "g, kg"],
        ),
        ("= 100      ", "= \"100 N/mm^2\"", ["stiffness = |\"100 N/mm^2", "but `contact.exponent` is 1.5", "N/mm^1.5"]),
        ("= 100      ", "= \"100 N/mm\"", ["stiffness = |\"100 N/mm\"", "but `contact.exponent` is 1.5", "N/mm^1.5"]),
        ("= 100      ", "= \"100 N/s\"", ["stiffness = |\"100 N/s", "whose unit does not fit", "N/mm^1.5"]),
        ("mass = 81.8 ", "mass = nan ", ["mass = |nan", "`slide.mass` is nan, which is not finite", "a number in g"]),
        ("mass = 81.8 ", "mass = \"1e999 g\"", ["mass = |\"1e999", "1e999 g, which is not finite", "a number in g"]),
        (
            "gravity = [0, -9.81",
            "gravity = [0, -inf",
            ["gravity = [0, |-inf", "-inf, which is not finite", "a number in m/s²"],
        ),
        ("mass = 81.8 ", "mass = -81.8 ", ["mass = |-81.8", "`slide.mass` is -81.8 g", "0.001 to 10000000 g"]),
        ("mass = 81.8 ", "mass = 0xffffffffffffffffffff ", ["mass = |0xff", "which is not finite", "a number in g"]),
        ("[130, 12, 150]", "[130, 0, 150]", ["[130, |0, 150]", "`slide.inertia_box` is 0 mm", "0.001 to 100000 mm"]),
        ("[130, 12, 150]", "[0.005, 0.005, 0.005]", ["|[0.005", "`slide.inertia_box`", "at least 1e-12 kg·m²"]),
        ("= 100      ", "= -100", ["stiffness = |-100", "`contact.stiffness` is -100 N/mm^1.5", "to 1e20 N/m^1.5"]),
        ("exponent = 1.5", "exponent = 0.9", ["exponent = |0.9", "`contact.exponent` is 0.9", "1 to 4"]),
        ("damping = 1 ", "damping = -1 ", ["damping = |-1", "is -1 N·s/mm", "0 to 1000000 N·s/mm"]),
        ("depth = 0.1", "depth = 0", ["depth = |0", "`contact.depth` is 0 mm", "0.000001 to 1000 mm"]),
        (
            "\"regularised\"",
            "\"sticky\"",
            ["law = |\"sticky", "`friction.law` is \"sticky\"", "regularised, exact, none"],
        ),
        ("\"regularised\"", "\"wet\"", ["law = |\"wet", "`friction.law` is \"wet\"", "regularised, exact, none"]),
        (
            "coefficient = 0.3",
            "coefficient = -0.3",
            ["coefficient = |-0.3", "`friction.coefficient` is -0.3", "0 to 100"],
        ),
        (
            "stick_band = 0.1",
            "stick_band = 0",
            ["stick_band = |0", "`friction.stick_band` is 0 mm/s", "0.0000001 to 1000 mm/s"],
        ),
        (
            "ramp_end = 1.0",
            "ramp_end = 0.05",
            ["ramp_end = |0.05", "`drive.ramp_end` is 0.05 s", "more than drive.ramp_start, 0.05 s"],
        ),
        ("step = 1000 ", "step = 0 ", ["step = |0 ", "`controller.step` is 0 µs", "0.002 to 10000 µs"]),
        ("step = 1000 ", "step = \"20 ms\" ", ["step = |\"20 ms", "`controller.step` is 20 ms", "0.002 to 10000 µs"]),
        ("stroke = 80 ", "stroke = 0 ", ["stroke = |0 ", "`run.stroke` is 0 mm", "0.001 to 100000 mm"]),
        ("error = 3e-7 ", "error = 1 ", ["error = |1 ", "`run.error` is 1", "0.0000000001 to 0.1"]),
        ("\"f32\"", "\"f16\"", ["scalar = |\"f16", "`controller.scalar` is \"f16\"", "f32, f64"]),
        (
            "\"implicit-euler\"",
            "\"radau\"",
            ["integrator = |\"radau", "`controller.integrator` is \"radau\"", "implicit-euler, rodas4, sdirk2"],
        ),
        ("\"-3:5:0.1\"", "\"\"", ["n = |\"\"", "is neither FIRST:LAST:STEP", "-3:5:0.1"]),
        ("\"-3:5:0.1\"", "\"5:-3:0.1\"", ["n = |\"5:-3", "`sweep.n`: the last, -3, is below the first, 5", "-3:5:0.1"]),
        ("\"-3:5:0.1\"", "\"0:5:1e-9\"", ["n = |\"0:5:1e-9", "makes more than 100000 values", "at most 100000 levels"]),
        (gap, "left = [0.0064, -0.0404]", ["[0.0064, |-0.0404]", "`pin.left` is -0.0404 mm", "0 to 100 mm"]),
        (gap, "left = [200, 0]", ["[|200", "`pin.left` is 200 mm", "-100 to 100 mm"]),
        (gap, "left = [0.0064]", ["left = |[0.0064]", "`pin.left` is a list of 1", "[mean, standard deviation] in mm"]),
        ("[[pin]]", "[[pin]]\n[[pin]]", ["|[[pin]]", "`pin.name` is missing", "such as \"left front\""]),
        ("mass = 81.8 ", "mass = 81.8\nmass = 2", ["|mass = 2", "not valid TOML: duplicate key", "mass = 2"]),
        ("mass = 81.8 ", "mass = ~", ["mass = |~", "not valid TOML", "mass = ~"]),
        ("[sweep]", "[sweep", ["[sweep|", "not valid TOML: unclosed table", "[sweep"]),
    ] {
        let message = message(from, to);
        let text = CD_ROM_SLIDE.replacen(from, to, 1);
        let place = format!(" scene.toml:{}\n", line_and_column(&text, marked));
        for part in [place.as_str(), problem, allowed] {
            assert!(message.contains(part), "{part} is not in\n{message}");
        }
    }
}

#[test]
fn all_mistakes_are_told_at_once_and_none_that_follows_from_another() {
    let text = CD_ROM_SLIDE
        .replacen("mass = 81.8 ", "mas = 81.8 ", 1)
        .replacen("coefficient = 0.3", "coefficient = -0.3", 1)
        .replacen("\"regularised\"", "\"sticky\"", 1)
        .replacen("ramp_end = 1.0 ", "ramp_end = \"1 mm\" ", 1)
        .replacen("stroke = 80 ", "stroke = nan ", 1)
        .replacen("left = [0.0064, 0.0404]", "left = [0.0064, -1]", 1);
    let error = parse(&text, &["slide.gravity=[0,0]"]).unwrap_err();
    let message = error.to_string();
    let expected = [
        "unknown key `slide.mas`",
        "`friction.law` is \"sticky\"",
        "`drive.ramp_end` is \"1 mm\", whose unit does not fit",
        "`run.stroke` is nan, which is not finite",
        "`pin.left` is -1 mm",
        "`slide.gravity` is a list of 2",
    ];
    for part in expected {
        assert!(message.contains(part), "{part} is not in\n{message}");
    }
    // The law is not known, so that its coefficient cannot be judged.
    assert_eq!(error.problems().count(), expected.len(), "{message}");
    let places: Vec<_> = expected.iter().map(|part| message.find(part).unwrap()).collect();
    assert!(places.is_sorted_by_key(|place| *place) || places[0] > places[1], "in the order of the text\n{message}");
}

#[test]
fn two_pins_cannot_be_in_one_place() {
    let message = parse(CD_ROM_SLIDE, &["pin.left back.position=[62, 0, -18]"]).unwrap_err().to_string();
    assert!(message.contains("where the pin \"left back\" is") && message.contains("place of its own"), "{message}");
}

#[test]
fn a_scene_has_one_to_four_pins() {
    let five = format!("{CD_ROM_SLIDE}\n[[pin]]\nname = \"fifth\"\nposition = [0, 0, 0]\n");
    let message = parse(&five, &[]).unwrap_err().to_string();
    assert!(message.contains("`pin` is a list of 5") && message.contains("one to four"), "{message}");
    let (none, _) = CD_ROM_SLIDE.split_once("[[pin]]").unwrap();
    assert!(parse(none, &[]).unwrap_err().to_string().contains("`pin` is missing"));
    assert!(parse(none, &["pin=[]"]).unwrap_err().to_string().contains("`pin` is a list of 0"));
    assert!(parse("", &[]).unwrap_err().to_string().contains("`slide` is missing"));
}

#[test]
fn errors_in_overrides_point_into_them() {
    for (set, part) in [
        ("contact.stiffness=abc", "1:25"),
        ("slide.mas=3", "unknown key `slide.mas`, did you mean `slide.mass`?"),
        ("mass=3", "unknown key `mass`, did you mean `slide.mass`?"),
        ("slide.mass.x=3", "unknown key `slide.mass.x`"),
        ("a.b.c.d.e=3", "unknown key `a`"),
        ("slide=3", "`slide` is a number"),
        ("slide.mass", "`--set` needs a key and a value"),
        ("", "`--set` needs a key and a value"),
        ("=3", "unknown key ``"),
        ("slide.mass=", "1:18"),
        ("slide.gravity=[0, -9.81", "`slide.gravity` is a text"),
        ("slide.gravity=[0, nan, 0]", "1:25"),
        ("pin.middle.left=[0, 1]", "there is no pin `middle`"),
        ("dimension.x.value=3", "there is no dimension `x`"),
        ("pin.left front.left=[0, -1]", "1:31"),
        ("title=3", "`title` is a number"),
    ] {
        let error = parse(CD_ROM_SLIDE, &["slide.mass=90 g", set]).unwrap_err().to_string();
        assert!(error.contains(part) && error.contains("command line:1:"), "{set}\n{error}");
        assert!(error.contains(format!("1 | --set {set}").trim_end()), "{set}\n{error}");
    }
    let error = parse(CD_ROM_SLIDE, &["friction.law=none", "friction.coefficient=-1"]).unwrap_err().to_string();
    assert!(error.contains("`friction.coefficient` is -1"), "{error}");
}

/// An escape sequence at the start of each text of every kind of scene in turn.
#[test]
fn texts_with_control_characters_are_refused_where_they_stand() {
    let shown = "\\u{1b}[31m";
    for name in ["cd-rom-slide", "cd-rom-slide-drawing", "clutch-processes", "slider-crank-guide", "ball-rod"] {
        let (text, mut start, mut texts) = (shipped(name).unwrap(), 0, 0);
        for (row, line) in text.split_inclusive('\n').enumerate() {
            let values = line.split('#').next().unwrap_or_default();
            for (quote, _) in values.match_indices('"').step_by(2) {
                let (before, after) = text.split_at(start + quote + 1);
                let spoilt = format!("{before}\\u001b[31m{after}");
                let error = SceneFile::parse("x.toml", &spoilt, &[]).err().unwrap_or_else(|| panic!("{line}"));
                let of_text = |problem: &&Problem| matches!(problem, Problem::ControlCharacter { .. });
                let [Problem::ControlCharacter { key, .. }] = error.problems().filter(of_text).collect::<Vec<_>>()[..]
                else {
                    panic!("{line}: {error}")
                };
                let last = key.rsplit('.').next().unwrap_or_default();
                assert!(line.contains(last), "{line}: {error}");
                let column = values[..quote].chars().count() + 1;
                let said = error.to_string();
                for part in [
                    format!("`{key}` is \"{shown}"),
                    format!("x.toml:{}:{column}", row + 1),
                    "= allowed: a text of one line, without tabs and other control characters".to_owned(),
                ] {
                    assert!(said.contains(&part), "{line}: {part}: {said}");
                }
                assert!(!said.contains('\u{1b}'), "{line}: {said}");
                texts += 1;
            }
            start += line.len();
        }
        assert!(texts > 5, "{name}: {texts}");
    }
}

#[test]
fn so_are_settings_on_the_command_line() {
    for (set, key, shown) in [
        ("title=a\u{1b}[31m", "title", "a\\u{1b}[31m"),
        ("title=\"a\\u001b[31m\"", "title", "a\\u{1b}[31m"),
        ("pin.left front.name=one\nother", "pin.name", "one\\nother"),
        ("friction.law=no\u{9b}ne", "friction.law", "no\\u{9b}ne"),
    ] {
        let error = parse(CD_ROM_SLIDE, &[set]).unwrap_err().to_string();
        let told = format!("`{key}` is \"{shown}\", which has a control character");
        assert!(error.contains(&told) && error.contains("command line:1:"), "{error}");
        assert!(!error.contains(['\u{1b}', '\u{9b}']), "{error:?}");
    }
}

/// Nobody prints an expression.
#[test]
fn an_expression_may_go_over_several_lines() {
    let text = "[[dimension]]\nname = \"a\"\nvalue = 30\ntolerance = 0.1\n\
                [[measure]]\nname = \"m\"\nis = \"\"\"a\n\t+ 2 * a\"\"\"\n";
    let file = SceneFile::parse("x.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!((file.product.unwrap().nominal_measures()[0] - 0.09).abs() < 1e-15);
    let error = SceneFile::parse("x.toml", &text.replace("\n\t+", "\\u001b+"), &[]).err().unwrap().to_string();
    assert!(error.contains("`measure.is` is \"a\\u{1b}+ 2 * a\""), "{error}");
}

#[test]
fn messages_are_for_people() {
    insta::assert_snapshot!(message("mass = 81.8 ", "mas = 81.8 "), @r#"
    error: unknown key `slide.mas`, did you mean `slide.mass`?
      --> scene.toml:12:1
       |
    12 | mas = 81.8                       # g
       | ^^^
       |
       = allowed: mass, inertia_box, gravity
    "#);
    insta::assert_snapshot!(parse(CD_ROM_SLIDE, &["contact.stiffness=1 kN"]).unwrap_err(), @r#"
    error: `contact.stiffness` is "1 kN", whose unit does not fit
     --> command line:1:25
      |
    1 | --set contact.stiffness=1 kN
      |                         ^^^^
      |
      = allowed: a number in N/mm^1.5, or a text with its unit: N/mm^1.5, N/m^1.5
    "#);
    let error = parse("title = 3", &[]).unwrap_err();
    assert!(error.render(true).contains("\u{1b}[") && !error.render(false).contains('\u{1b}'));
}

proptest! {
    #[test]
    fn no_text_panics(text in any::<String>(), set in any::<String>()) {
        let _ = parse(&text, &[&set]).map_err(|error| (error.render(true), error.to_string()));
    }

    /// Whatever is accepted also makes a kernel.
    #[test]
    fn no_change_of_the_shipped_scene_panics(
        at in 0..CD_ROM_SLIDE.len(),
        length in 0..12usize,
        insert in "[-0-9.e\"\\[\\]=a-zµ\t\r\n]{0,4}",
    ) {
        let mut text = CD_ROM_SLIDE.to_owned().into_bytes();
        text.splice(at..(at + length).min(CD_ROM_SLIDE.len()), insert.into_bytes());
        match parse(&String::from_utf8_lossy(&text), &[]) {
            Ok(scene) => {
                let kernel = scene.slide_data::<f64>(&[0.0; 16]).visit(Accept);
                prop_assert!(kernel.is_ok(), "{:?}", kernel);
            }
            Err(error) => prop_assert!(error.to_string().contains("scene.toml:")),
        }
    }
}

struct Accept;

impl slipfit_core::menu::SlideVisitor<f64> for Accept {
    type Output = ();

    fn visit<E: slipfit_core::law::Elastic<f64>, F: slipfit_core::law::Friction<f64>>(
        self,
        _: slipfit_core::slide::Slide<f64, E, F>,
    ) {
    }
}
