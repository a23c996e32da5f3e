//! The short form of a slide on pins, written out as the mechanism that it is.
//!
//! `[slide]`, `[[pin]]` and `[drive]` describe one body on tracks, pushed along z. Where such a scene states what the slide's own types do
//! not have, such as a limit of the drive, it is read as that mechanism.

use std::cell::Cell;

use slipfit_core::slide::box_inertia;

use super::{
    SceneError,
    parse::{DURATION, EDGE, STROKE},
    quantity::{MASS, RAMP, SPEED},
    tree::{Entry, Node, Place, Value},
    value::Field,
};

/// What the body and its drive are called.
const BODY: &str = "slide";
const DRIVE: &str = "drive";

/// Keys that make a mechanism of a slide.
const BEYOND: [(&str, &[&str]); 4] = [
    ("friction", &["static_coefficient", "stribeck_speed", "viscous"]),
    (
        "drive",
        &[
            "controls",
            "segment",
            "cycles",
            "record",
            "motion",
            "sampling",
            "position_gain",
            "measures",
            "limit",
            "coulomb",
            "stick_band",
            "viscous",
            "offset",
            "rotor",
            "gear",
            "travel",
        ],
    ),
    ("pin", &["slope", "bow", "along"]),
    ("identify", &["along"]),
];

/// Whether the scene `root` is a slide with what only mechanisms have.
fn is_beyond(root: &Node) -> bool {
    let states = |table: &Node, keys: &[&str]| keys.iter().any(|key| table.get(key).is_some());
    let in_any = |node: &Node, keys| match &node.value {
        Value::List(nodes) => nodes.iter().any(|table| states(table, keys)),
        _ => states(node, keys),
    };
    let keys = BEYOND.iter().any(|(table, keys)| root.get(table).is_some_and(|table| in_any(table, keys)));
    root.get("slide").is_some() && (keys || root.get("spring").is_some())
}

/// Writes the scene `root` out if it is such a slide, and has no bodies of its own.
///
/// # Errors
/// If the mass or the box of inertia is none.
pub(super) fn write_out(root: &mut Node) -> Result<(), SceneError> {
    let is_mechanism = ["mechanism", "body", "joint"].iter().any(|key| root.get(key).is_some());
    if is_mechanism || !is_beyond(root) {
        return Ok(());
    }
    let (inertia, stroke) = (inertia(root)?, stroke_duration(root)?);
    let Value::Table(entries) = &mut root.value else { return Ok(()) };
    // A note of the drawing's clearances, which nothing is computed from.
    take(entries, "drawing");
    let mut written = Vec::new();
    for entry in std::mem::take(entries) {
        let at = entry.node.place.clone();
        match &*entry.key {
            "slide" => written.extend(bodies(entry.node, inertia, &at)),
            "pin" => written.push(new("joint", &at, Node { value: tracks(entry.node.value), place: at.clone() })),
            "drive" => written.push(new("drive", &at, Node { value: drives(entry.node, &at), place: at.clone() })),
            "vary" | "uncertain" | "identify" => {
                let Node { value, place } = entry.node;
                written.push(Entry { node: Node { value: parameters(value), place }, ..entry });
            }
            "run" => written.push(Entry { node: run(entry.node, stroke), ..entry }),
            _ => written.push(entry),
        }
    }
    *entries = written;
    Ok(())
}

/// The moments of inertia (kg·m²) of the box.
fn inertia(root: &Node) -> Result<[f64; 3], SceneError> {
    let node = |key: &str| root.get("slide").and_then(|slide| slide.get(key));
    let field = |key: &str| node(key).map(|node| Field { key: format!("slide.{key}"), node });
    let (Some(mass), Some(edges)) = (field("mass"), field("inertia_box")) else { return Ok([1.0; 3]) };
    Ok(box_inertia(mass.to_number(&MASS)?, edges.to_numbers(&EDGE)?).into())
}

/// How long (s) a run of the whole stroke lasts at most, and when the ramp ends (s); `None` where one of them is not stated.
fn stroke_duration(root: &Node) -> Result<Option<[f64; 2]>, SceneError> {
    let field = |table: &str, key: &str| {
        root.get(table).and_then(|of| of.get(key)).map(|node| Field { key: format!("{table}.{key}"), node })
    };
    let all = [field("drive", "ramp_end"), field("drive", "speed"), field("run", "stroke")];
    let [Some(end), Some(speed), Some(stroke)] = all else { return Ok(None) };
    let [end, speed, stroke] = [end.to_number(&RAMP)?, speed.to_number(&SPEED)?, stroke.to_number(&STROKE)?];
    Ok((speed != 0.0).then(|| [end.max(0.0) + stroke / speed.abs(), end]))
}

/// `[run]`, whose duration is that of a slide's opening: where it ends before the ramp, there would be no verdict, and it becomes that of
/// the `stroke`.
fn run(Node { place, value }: Node<'_>, stroke: Option<[f64; 2]>) -> Node<'_> {
    let Some([stroke, ramp_end]) = stroke else { return Node { place, value } };
    let Value::Table(mut entries) = value else { return Node { place, value } };
    for entry in entries.iter_mut().filter(|entry| entry.key == "duration") {
        let stated = Field { key: "run.duration".into(), node: &entry.node }.as_number(&DURATION);
        if stated.is_ok_and(|stated| stated < ramp_end) {
            entry.node.value = Value::Number(stroke * 1e3);
        }
    }
    Node { place, value: Value::Table(entries) }
}

fn take<'s>(entries: &mut Vec<Entry<'s>>, key: &str) -> Option<Entry<'s>> {
    let at = entries.iter().position(|entry| entry.key == key)?;
    Some(entries.remove(at))
}

fn new<'s>(key: &'static str, at: &Place<'s>, node: Node<'s>) -> Entry<'s> {
    Entry { key: key.into(), place: at.clone(), node, read: Cell::new(false) }
}

fn text<'s>(key: &'static str, at: &Place<'s>, text: &'static str) -> Entry<'s> {
    new(key, at, Node { place: at.clone(), value: Value::Text(text.into()) })
}

fn list<'s>(key: &'static str, at: &Place<'s>, values: impl IntoIterator<Item = Value<'s>>) -> Entry<'s> {
    let nodes = values.into_iter().map(|value| Node { place: at.clone(), value }).collect();
    new(key, at, Node { place: at.clone(), value: Value::List(nodes) })
}

/// A table in a list of its own.
fn alone<'s>(key: &'static str, at: &Place<'s>, entries: Vec<Entry<'s>>) -> Entry<'s> {
    list(key, at, [Value::Table(entries)])
}

/// `[slide]` as a body, and what it says of gravity.
fn bodies<'s>(slide: Node<'s>, inertia: [f64; 3], at: &Place<'s>) -> Vec<Entry<'s>> {
    let Value::Table(mut entries) = slide.value else { return vec![new("slide", at, slide)] };
    let mut mechanism = vec![text("space", at, "space")];
    mechanism.extend(take(&mut entries, "gravity"));
    if let Some(edges) = take(&mut entries, "inertia_box") {
        let moments = inertia.map(|moment| Value::Text(format!("{moment:e} kg·m²").into()));
        entries.push(list("inertia", &edges.node.place, moments));
    }
    entries.push(text("name", at, BODY));
    entries.push(list("centre", at, [0.0; 3].map(Value::Number)));
    let mechanism = new("mechanism", at, Node { place: at.clone(), value: Value::Table(mechanism) });
    vec![mechanism, alone("body", at, entries)]
}

/// `[[pin]]` as tracks of the slide around pins of the frame.
fn tracks(pins: Value) -> Value {
    match pins {
        Value::List(nodes) => Value::List(nodes.into_iter().map(track).collect()),
        other => other,
    }
}

fn track(Node { place, value }: Node) -> Node {
    let Value::Table(mut entries) = value else { return Node { place, value } };
    if let Some(position) = take(&mut entries, "position") {
        entries.push(Entry { key: "at".into(), ..position });
    }
    entries.push(text("kind", &place, "track"));
    entries.push(list("between", &place, ["frame", BODY].map(|name| Value::Text(name.into()))));
    Node { place, value: Value::Table(entries) }
}

/// `[drive]` as the one drive of a mechanism.
fn drives<'s>(drive: Node<'s>, at: &Place<'s>) -> Value<'s> {
    let Value::Table(mut entries) = drive.value else { return drive.value };
    if !entries.iter().any(|entry| entry.key == "controls") {
        entries.push(text("controls", at, "centre"));
    }
    entries.extend([text("name", at, DRIVE), text("pushes", at, BODY)]);
    entries.push(list("axis", at, [0.0, 0.0, 1.0].map(Value::Number)));
    Value::List(vec![Node { place: at.clone(), value: Value::Table(entries) }])
}

/// Parameters of a slide, which `[vary]`, `[uncertain]` or `[identify]` names, as those of the mechanism.
fn parameters(table: Value) -> Value {
    let Value::Table(entries) = table else { return table };
    let mut written = Vec::new();
    for entry in entries {
        let at = entry.node.place.clone();
        match (&*entry.key, entry.node.value) {
            ("slide", Value::Table(of_slide)) => {
                let (tilts, mut own): (Vec<_>, Vec<_>) =
                    of_slide.into_iter().partition(|entry| entry.key.starts_with("tilt"));
                if !tilts.is_empty() {
                    written.push(new("mechanism", &at, Node { place: at.clone(), value: Value::Table(tilts) }));
                }
                if !own.is_empty() {
                    own.push(text("name", &at, BODY));
                    written.push(alone("body", &at, own));
                }
            }
            ("drive", Value::Table(mut own)) => {
                own.push(text("name", &at, DRIVE));
                written.push(alone("drive", &at, own));
            }
            (_, value) => written.push(Entry { node: Node { place: at, value }, ..entry }),
        }
    }
    Value::Table(written)
}

#[cfg(test)]
mod tests {
    use crate::scene::{Override, SceneFile, shipped};

    fn read(set: &[&str]) -> SceneFile {
        let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
        let text = shipped("cd-rom-slide").unwrap();
        SceneFile::parse("cd-rom-slide", text, &set).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn a_slide_is_the_mechanism_that_it_is_written_out_as() {
        let (slide, written) = (read(&[]).slide.unwrap(), read(&["drive.limit=1000"]).mechanism.unwrap());
        assert_eq!((written.bodies.len(), written.joints.len(), written.gaps.len()), (1, 4, 16));
        assert_eq!(written.bodies[0].mass, slide.slide.mass);
        assert_eq!(written.gravity, slide.slide.gravity);
        for (pin, joint) in slide.pins.iter().zip(&written.joints) {
            assert_eq!((&pin.name, pin.position), (&joint.name, joint.at));
        }
        let statistics: Vec<_> = written.gaps.iter().map(|gap| Some(gap.statistics)).collect();
        assert_eq!(statistics, slide.pins.iter().flat_map(|pin| pin.gaps).collect::<Vec<_>>());
        let names: Vec<_> = written.gaps.iter().map(|gap| gap.name.clone()).collect();
        assert_eq!(names, slide.contact_names());
    }

    /// The shipped slide's opening ends before its ramp: as a mechanism it runs its stroke.
    #[test]
    fn a_run_that_would_have_no_verdict_is_that_of_the_stroke() {
        let duration = |set: &[&str]| read(set).mechanism.unwrap().run.duration;
        // 1 s of ramp, then 80 mm at 0.1 m/s.
        assert!((duration(&["drive.limit=5"]) - 1.8).abs() < 1e-12);
        assert_eq!(duration(&["drive.limit=5", "run.duration=1200"]), 1.2);
    }

    #[test]
    fn what_varies_goes_along() {
        let set = [
            "drive.limit=5",
            "vary.slide.mass.tolerance=2",
            "vary.slide.tilt_x.tolerance=3",
            "vary.drive.gain.tolerance=0.002",
            "vary.drive.limit.tolerance=0.5",
            "vary.friction.coefficient.tolerance=0.05",
        ];
        let names: Vec<_> =
            read(&set).mechanism.unwrap().vary.iter().map(|varied| varied.deviation.name.clone()).collect();
        let expected = ["friction.coefficient", "mechanism.tilt_x", "slide.mass", "drive.gain", "drive.limit"];
        assert_eq!(names, expected);
    }

    #[test]
    fn a_mistake_is_shown_where_it_is_written() {
        let text = shipped("cd-rom-slide").unwrap().replace("[drive]", "[drive]\nlimit = \"5 kg\"");
        let Err(error) = SceneFile::parse("s.toml", &text, &[]) else { panic!("accepted") };
        let line = text.lines().position(|line| line.contains("5 kg")).unwrap() + 1;
        assert!(error.to_string().contains(&format!("s.toml:{line}:")), "{error}");
    }
}
