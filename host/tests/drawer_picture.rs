//! The moving picture of the README: a drawer that runs beside one that sticks in its groove, as the program simulates them. Written with
//! `INSTA_UPDATE=always`; otherwise the test fails where the picture is not what the program gives.

use std::{fmt::Write, path::Path};

use slipfit::{
    dynamics::{
        driven::Driven,
        film::{Film, Frame, film},
        simulate::{Settings, simulate},
    },
    scene::{SceneFile, shipped},
    setup::Scene,
};

/// Pixels a metre: across, along, and of play, which is too small to see.
const ACROSS: f64 = 700.0;
const ALONG: f64 = 1600.0;
const PLAY: f64 = 1e5;
/// Pixels a newton.
const FORCE: f64 = 3.5;
/// How many times slower than the drawer.
const SLOWER: f64 = 6.0;
/// How long the picture stays at its end (s).
const REST: f64 = 1.2;
/// Radius of a pin (pixels).
const PIN: f64 = 9.0;
/// Half of the drawer's width, and how far it reaches to the back and to the front (pixels): the pins stay in its groove.
const HALF: f64 = 128.0;
const BACK: f64 = -130.0;
const FRONT: f64 = 88.0;
/// Centres of the two drawers in the picture.
const CENTRES: [[f64; 2]; 2] = [[160.0, 145.0], [480.0, 145.0]];

const STYLE: &str = "\
.paper { fill: #ffffff } .ink { fill: #222222 } .soft { fill: #606060 } .shade { fill: #ecf0f5 } .pin { fill: #969696 }
.line { stroke: #222222 } .good { fill: #0072b2; stroke: #0072b2 } .bad { fill: #d55e00; stroke: #d55e00 }
@media (prefers-color-scheme: dark) {
.paper { fill: #15181c } .ink { fill: #e6e6e6 } .soft { fill: #a8adb4 } .shade { fill: #222b35 } .pin { fill: #565d66 }
.line { stroke: #e6e6e6 } .good { fill: #56b4e9; stroke: #56b4e9 } .bad { fill: #f0803c; stroke: #f0803c }
}";

/// One of the drawers: its run, and the force of its motor at the moments of the film (N).
struct Played {
    film: Film,
    force: Vec<f64>,
    /// The gap beside the back pin (m).
    gap: f64,
}

fn played(scene: &Scene, n: f64) -> Played {
    let gaps = scene.gaps_at(&[n; slipfit_core::slide::CONTACTS]);
    let film = film(scene, &gaps, 48).unwrap();
    let run = simulate(scene, &gaps, &Settings::desk(scene, 1e-3)).unwrap().trajectory;
    let at = |frame: &Frame| run.force[run.t.partition_point(|t| *t < frame.t).min(run.t.len() - 1)];
    let force = film.frames.iter().map(at).collect();
    Played { film, force, gap: gaps[0] }
}

/// The values of an attribute over the whole picture, and the last of them.
fn animated(played: &Played, whole: f64, value: impl Fn(&Frame, f64) -> String) -> (String, String) {
    let frames = played.film.frames.iter().zip(&played.force);
    let mut values: Vec<String> = frames.map(|(frame, force)| value(frame, *force)).collect();
    let mut times: Vec<String> =
        played.film.frames.iter().map(|frame| format!("{:.4}", frame.t * SLOWER / whole)).collect();
    let last = values.last().unwrap().clone();
    values.push(last.clone());
    times.push("1".into());
    let text = format!(
        "values=\"{}\" keyTimes=\"{}\" dur=\"{whole:.1}s\" repeatCount=\"indefinite\"",
        values.join(";"),
        times.join(";")
    );
    (text, last)
}

fn drawer(svg: &mut String, played: &Played, [x, y]: [f64; 2], whole: f64, class: &str, words: [&str; 2]) {
    let pins = [[-0.15, -0.04], [-0.15, 0.04], [0.15, -0.04], [0.15, 0.04]].map(|[x, z]| [x * ACROSS, z * ALONG]);
    let (shift, at_end) = animated(played, whole, |frame, _| {
        format!("{:.1} {:.1}", frame.displacement[0] * PLAY, frame.displacement[2] * ALONG)
    });
    // Seen from above, where y points to the reader and z down.
    let (turn, turned) =
        animated(played, whole, |frame, _| format!("{:.2}", -frame.turn[1].to_degrees() * PLAY / ALONG));
    let _ = write!(svg, "<g transform=\"translate({x} {y})\">\n<g transform=\"translate({at_end})\">");
    let _ = writeln!(svg, "<animateTransform attributeName=\"transform\" type=\"translate\" {shift}/>");
    let _ = writeln!(
        svg,
        "<g transform=\"rotate({turned})\"><animateTransform attributeName=\"transform\" type=\"rotate\" {turn}/>"
    );
    let _ = writeln!(
        svg,
        "<rect class=\"shade line\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"5\"/>",
        -HALF,
        BACK,
        2.0 * HALF,
        FRONT - BACK
    );
    for side in [-1.0, 1.0] {
        let at = pins[0][0] + side * (PIN + played.gap * PLAY);
        let _ = writeln!(
            svg,
            "<line class=\"line\" stroke-width=\"2\" x1=\"{at:.1}\" y1=\"{}\" x2=\"{at:.1}\" y2=\"{}\"/>",
            BACK + 6.0,
            FRONT - 6.0
        );
    }
    let (length, force) = animated(played, whole, |_, force| format!("{:.1}", -8.0 - FORCE * force));
    let _ = writeln!(
        svg,
        "<line class=\"{class}\" stroke-width=\"7\" x1=\"{0}\" y1=\"-8\" x2=\"{0}\" y2=\"{force}\"><animate attributeName=\"y2\" {length}/></line>",
        -0.02 * ACROSS
    );
    let _ = writeln!(svg, "<polygon class=\"{class}\" points=\"{0},4 {1},-9 {2},-9\"/></g></g>", -14.0, -23.0, -5.0);
    for [x, y] in pins {
        let _ = writeln!(svg, "<circle class=\"pin line\" cx=\"{x}\" cy=\"{y}\" r=\"{PIN}\"/>");
    }
    let [first, second] = words;
    let _ = writeln!(
        svg,
        "<text class=\"ink\" y=\"172\" font-size=\"17\" font-weight=\"bold\" text-anchor=\"middle\">{first}</text>\
         <text class=\"soft\" y=\"193\" font-size=\"14\" text-anchor=\"middle\">{second}</text></g>"
    );
}

fn picture() -> String {
    let mut scene = SceneFile::parse("drawer", shipped("drawer").unwrap(), &[]).unwrap().slide.unwrap();
    scene.run.duration = scene.stroke_duration().unwrap();
    let [runs, jams] = [0.0, 3.5].map(|n| played(&scene, n));
    let verdicts = [&runs, &jams].map(|one| one.film.outcome.verdict.to_string());
    assert_eq!(verdicts, ["runs", "crawls"]);
    let whole = scene.run.duration * SLOWER + REST;
    let newtons = |played: &Played| played.force.iter().copied().fold(0.0, f64::max);
    let way = |played: &Played| played.film.frames.last().unwrap().displacement[2] * 1e3;
    let title = "Two drawers of one production, seen from above: one runs, the other sticks in its groove";
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"640\" height=\"352\" viewBox=\"0 0 640 352\" \
         font-family=\"system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif\">\n<title>{title}</title>\n\
         <style>\n{STYLE}\n</style>\n<rect class=\"paper\" width=\"640\" height=\"352\"/>\n"
    );
    let said = [&runs, &jams].map(|played| {
        let text = format!("play {:+.2} mm: {:.0} mm far with {:.1} N", played.gap * 1e3, way(played), newtons(played));
        text.replace('-', "−")
    });
    drawer(&mut svg, &runs, CENTRES[0], whole, "good", [&verdicts[0], &said[0]]);
    drawer(&mut svg, &jams, CENTRES[1], whole, "bad", [&verdicts[1], &said[1]]);
    svg + "</svg>\n"
}

#[test]
fn the_readme_shows_what_the_program_simulates() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/drawer.svg");
    let svg = picture();
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(&path, &svg).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == svg, "{} is not current; INSTA_UPDATE=always writes it", path.display());
}
