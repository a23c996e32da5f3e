//! A mechanism as a picture: bodies, joints and drives in the drawn pose, clearances not to scale.
//!
//! A mechanism in a plane is shown as it lies, one in space from two sides. Bodies have letters beside their centres, so that
//! grey prints tell them apart, and joints numbers; the list below says what they are and how much play they have.

mod symbol;
mod view;

use crate::mechanism::{Action, Joint, JointKind, Mechanism, NamedDrive, Spring};
use crate::{
    setup::SURFACES,
    show::{
        palette::{Colour, PAPER, SOFT},
        svg::{Anchor, Font, PLAIN, SUBTITLE, Stroke, Svg, TITLE, WIDTH},
    },
};
use slipfit_tolerance::number::ten_digits;
use symbol::{Pen, colour};
use view::{Extent, View};

const HEADING: f64 = 62.0;
/// Height of the line below a view (px).
const NOTE: f64 = 20.0;
/// Height of a line of the list (px).
const LINE: f64 = 20.0;

/// Half of the square (px) that a symbol fills.
const SYMBOL: f64 = 13.0;

/// Whether two rectangles (left, top, width, height) share anything.
fn overlap(one: [f64; 4], other: [f64; 4]) -> bool {
    (0..2).all(|k| one[k] < other[k] + other[k + 2] && other[k] < one[k] + one[k + 2])
}

/// What stands before a line of the list.
enum Mark {
    Colour(Colour),
    Number(usize),
}

/// The letter of body `i`: A to Z, then A2 and so on.
fn letter(i: usize) -> String {
    let letter = char::from(b'A' + (i % 26) as u8);
    if i < 26 { letter.to_string() } else { format!("{letter}{}", i / 26 + 1) }
}

impl Mechanism {
    /// The picture as SVG.
    pub fn drawing(&self) -> String {
        let list = self.list();
        let views: &[([usize; 2], &str)] = if self.planar {
            &[([0, 1], "x to the right, y up")]
        } else {
            &[([0, 1], "x to the right, y up"), ([2, 1], "z to the right, y up")]
        };
        let extent = Extent::of(self);
        let heights: Vec<f64> = views.iter().map(|(axes, _)| extent.height(*axes, WIDTH) + NOTE).collect();
        let list_top = HEADING + heights.iter().sum::<f64>() + 12.0;
        let below = "as drawn; clearances are not to scale";
        let mut svg = Svg::new([WIDTH, list_top + LINE * list.len() as f64], &format!("{}: {below}", self.title));
        svg.text([16.0, 26.0], &self.title, Font { most: 44, ..TITLE });
        svg.text([16.0, 48.0], below, SUBTITLE);
        let mut top = HEADING;
        for ((axes, name), height) in views.iter().zip(heights) {
            let note = Font { colour: SOFT, anchor: Anchor::Middle, ..PLAIN };
            svg.text([0.5 * WIDTH, top + height - NOTE], name, note);
            self.draw(&mut svg, &View::of(&extent, *axes, [0.0, top, WIDTH, height - NOTE]));
            top += height;
        }
        for (row, (mark, text)) in list.iter().enumerate() {
            let (x, y) = (16.0, list_top + LINE * row as f64);
            match mark {
                Mark::Colour(colour) => svg.rectangle([x + 2.0, y - 5.0, 10.0, 10.0], *colour, 1.0),
                Mark::Number(number) => svg.text([x, y], &number.to_string(), Font { bold: true, ..PLAIN }),
            }
            svg.text([x + 24.0, y], text, Font { most: 68, ..PLAIN });
        }
        svg.finish()
    }

    /// The list below: bodies, then joints by number, then drives.
    fn list(&self) -> Vec<(Mark, String)> {
        let bodies = self.bodies.iter().enumerate();
        let bodies = bodies.map(|(i, body)| (Mark::Colour(colour(Some(i))), format!("{}: {}", letter(i), body.name)));
        let joints = self.joints.iter().enumerate().map(|(i, joint)| {
            let named = |name: &str, gap: usize| format!("{name} {}", ten_digits(self.gaps[gap].statistics.mean * 1e3));
            let gaps: Vec<String> = match &joint.kind {
                JointKind::Track { gaps } => {
                    gaps.iter().zip(SURFACES).filter_map(|(gap, surface)| Some(named(surface, (*gap)?))).collect()
                }
                kind => kind.gaps().map(|gap| named("gap", gap)).collect(),
            };
            let play = if gaps.is_empty() { String::new() } else { format!(", {} mm", gaps.join(" ")) };
            let contour = if joint.walls.is_parallel() { "" } else { ", not parallel" };
            (Mark::Number(i + 1), format!("{}: {}{play}{contour}", joint.name, joint.kind.name()))
        });
        let springs = self.springs.iter().map(|spring| {
            let [one, other] = spring.between.map(|port| self.name_of(port));
            let kind = if spring.ends().is_some() { "spring" } else { "torsion spring" };
            (Mark::Colour(SOFT), format!("{}: {kind}, {one} to {other}", spring.name))
        });
        let drives = self.drives.iter().map(|drive| {
            let body = &self.bodies[drive.body].name;
            let does = drive.action.kind().choose("pushes", "turns");
            (Mark::Colour(symbol::DRIVE), format!("{} {does} {body}", drive.name))
        });
        bodies.chain(joints).chain(springs).chain(drives).collect()
    }

    fn draw(&self, svg: &mut Svg, view: &View) {
        for (i, body) in self.bodies.iter().enumerate() {
            let centre = view.at(body.centre);
            let look = Stroke { opacity: 0.55, ..Stroke::new(colour(Some(i)), 6.0) };
            // One line to and fro, so that it is equally dark where it lies on itself.
            let own = self.joints.iter().filter(|joint| joint.between.contains(&Some(i)));
            let places: Vec<_> = own.flat_map(|joint| [centre, view.at(joint.at)]).collect();
            svg.line(&places, look);
        }
        let mut pen = Pen { svg, view };
        self.springs.iter().filter_map(Spring::ends).for_each(|ends| pen.spring(ends));
        for joint in &self.joints {
            pen.joint(joint);
        }
        for (i, body) in self.bodies.iter().enumerate() {
            pen.centre(body.centre, colour(Some(i)));
        }
        for drive in &self.drives {
            match drive.action {
                Action::Pushes { axis } => {
                    let sense = if drive.drive.speed < 0.0 { -1.0 } else { 1.0 };
                    pen.arrow(self.drive_point(drive), axis.map(|x| x * sense));
                }
                Action::Turns { axis } => pen.turn(self.pivot(drive.body), axis, drive.drive.speed),
            }
        }
        let joints = self.joints.iter().enumerate().map(|(i, joint)| (view.at(joint.at), (i + 1).to_string()));
        let bodies = self.bodies.iter().enumerate().map(|(i, body)| (view.at(body.centre), letter(i)));
        let named: Vec<([f64; 2], String)> = joints.chain(bodies).collect();
        // Where several lie behind each other they share a label.
        let mut labels: Vec<([f64; 2], String)> = Vec::new();
        for (at, own) in &named {
            match labels.iter_mut().find(|(other, _)| (other[0] - at[0]).hypot(other[1] - at[1]) < 24.0) {
                Some((_, label)) => *label = format!("{label}, {own}"),
                None => labels.push((*at, own.clone())),
            }
        }
        let turns = self.drives.iter().filter(|drive| matches!(drive.action, Action::Turns { .. }));
        let arcs: Vec<[f64; 2]> = turns.map(|drive| view.at(self.pivot(drive.body))).collect();
        // What no label may hide: the symbols, then the other labels.
        let symbol = |([x, y], _): &([f64; 2], String)| [x - SYMBOL, y - SYMBOL, 2.0 * SYMBOL, 2.0 * SYMBOL];
        let mut taken: Vec<[f64; 4]> = named.iter().map(symbol).collect();
        for ([x, y], label) in labels {
            let width = 8.0 * label.chars().count() as f64;
            // Beyond the arc of a drive that turns.
            let out = if arcs.iter().any(|arc| (arc[0] - x).hypot(arc[1] - y) < 24.0) { 7.0 } else { 0.0 };
            let room = |[dx, dy]: [f64; 2]| [x + dx, y + dy - 8.0, width, 16.0];
            // The first place beside the joint that is free.
            let free = |offset: &&[f64; 2]| !taken.iter().any(|other| overlap(*other, room(**offset)));
            let places = [
                [10.0 + out, -22.0 - out],
                [10.0 + out, 24.0 + out],
                [-10.0 - out - width, -22.0 - out],
                [-10.0 - out - width, 24.0 + out],
                [17.0, 0.0],
                [-17.0 - width, 0.0],
                [10.0, -40.0],
                [10.0, 42.0],
            ];
            let [dx, dy] = *places.iter().find(free).unwrap_or(&places[0]);
            let [left, above, ..] = room([dx, dy]);
            // So that a line does not strike the number through.
            pen.svg.rectangle([left, above + 2.0, width, 12.0], PAPER, 0.8);
            taken.push(room([dx, dy]));
            pen.svg.text([x + dx, y + dy], &label, Font { bold: true, ..PLAIN });
        }
    }

    /// Where the force of a drive acts (m), in the drawn pose.
    fn drive_point(&self, drive: &NamedDrive) -> [f64; 3] {
        let centre = self.bodies[drive.body].centre;
        std::array::from_fn(|k| centre[k] + drive.drive.point_b[k])
    }

    /// What a drive turns a body about: the middle of its joints with the frame, if there are any, else its centre of mass.
    fn pivot(&self, body: usize) -> [f64; 3] {
        use JointKind::{Bearing, Cylindrical, Journal, PinSlot, Revolute, Spherical};
        let turns = |joint: &&Joint| {
            let ideal = matches!(joint.kind, Revolute { .. } | PinSlot { .. } | Cylindrical { .. } | Spherical);
            ideal || matches!(joint.kind, Journal { .. } | Bearing { .. })
        };
        let to_frame = |joint: &&Joint| joint.between.contains(&None) && joint.between.contains(&Some(body));
        let places: Vec<_> = self.joints.iter().filter(turns).filter(to_frame).map(|joint| joint.at).collect();
        if places.is_empty() {
            return self.bodies[body].centre;
        }
        std::array::from_fn(|k| places.iter().map(|place| place[k]).sum::<f64>() / places.len() as f64)
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::{SHIPPED, SceneFile};

    #[test]
    fn every_shipped_mechanism_has_a_picture_with_all_that_it_is_made_of() {
        let mut drawn = 0;
        for (name, text) in SHIPPED {
            let file = SceneFile::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error}"));
            let Some(mechanism) = file.mechanism else { continue };
            let svg = mechanism.drawing();
            let document = roxmltree::Document::parse(&svg).unwrap();
            let texts: Vec<_> = document.descendants().filter_map(|node| node.text()).collect();
            let bodies = mechanism.bodies.iter().map(|body| &body.name);
            for named in bodies.chain(mechanism.joints.iter().map(|joint| &joint.name)) {
                assert!(texts.iter().any(|text| text.contains(named.as_str())), "{name}: {named}");
            }
            // Nothing lies outside the picture, no line and no arrow.
            let size =
                |side| document.root_element().attribute(side).and_then(|size| size.parse::<f64>().ok()).unwrap();
            for points in document.descendants().filter_map(|node| node.attribute("points")) {
                for [x, y] in points.split(' ').map(|point| point.split_once(',').unwrap()).map(|(x, y)| [x, y]) {
                    let within = |at: &str, side| (0.0..=size(side)).contains(&at.parse::<f64>().unwrap());
                    assert!(within(x, "width") && within(y, "height"), "{name}: {x}, {y}");
                }
            }
            let greatest = size("width").max(size("height")).ceil();
            for number in svg.split(['"', ' ', ',']).filter_map(|word| word.parse::<f64>().ok()) {
                assert!((-greatest..=greatest).contains(&number), "{name}: {number}");
            }
            drawn += 1;
        }
        assert!(drawn >= 8, "{drawn}");
    }
}
