//! A mechanism as a picture: bodies, joints and drives in the drawn pose, clearances not to scale.
//!
//! A mechanism in a plane is shown as it lies, one in space from two sides. Joints are numbered; the list below says what they
//! are and how much play they have.

mod symbol;
mod view;

use super::{Action, Joint, JointKind, Mechanism};
use crate::show::{
    number::ten_digits,
    palette::{Colour, KINDS, SOFT},
    svg::{Anchor, Font, PLAIN, SUBTITLE, Stroke, Svg, TITLE},
};
use symbol::Pen;
use view::{Extent, View};

const WIDTH: f64 = 900.0;
const HEADING: f64 = 62.0;
/// Height of a line of the list (px), and how many columns it has.
const LINE: f64 = 19.0;
const COLUMNS: usize = 2;

/// What stands before a line of the list.
enum Mark {
    Colour(Colour),
    Number(usize),
}

/// The colour of a body, and of the frame.
fn colour(body: Option<usize>) -> Colour {
    body.map_or(SOFT, |body| KINDS[body % KINDS.len()])
}

impl Mechanism {
    /// The picture as SVG, 900 pixels wide.
    pub fn drawing(&self) -> String {
        let list = self.list();
        let rows = list.len().div_ceil(COLUMNS);
        let views: &[([usize; 2], &str)] = if self.planar {
            &[([0, 1], "x to the right, y up")]
        } else {
            &[([0, 1], "x to the right, y up"), ([2, 1], "z to the right, y up")]
        };
        let (extent, width) = (Extent::of(self), WIDTH / views.len() as f64);
        let views_height = views.iter().map(|(axes, _)| extent.height(*axes, width)).fold(0.0, f64::max);
        let list_top = HEADING + views_height + 32.0;
        let below = "as drawn; clearances are not to scale";
        let mut svg = Svg::new([WIDTH, list_top + LINE * rows as f64], &format!("{}: {below}", self.title));
        svg.text([16.0, 26.0], &self.title, Font { most: 80, ..TITLE });
        svg.text([16.0, 48.0], below, SUBTITLE);
        for (i, (axes, name)) in views.iter().enumerate() {
            let frame = [width * i as f64, HEADING, width, views_height];
            let note = Font { colour: SOFT, anchor: Anchor::Middle, ..PLAIN };
            svg.text([frame[0] + 0.5 * width, HEADING + views_height], name, note);
            self.draw(&mut svg, &View::of(&extent, *axes, frame));
        }
        for (i, (mark, text)) in list.iter().enumerate() {
            let (column, row) = (i / rows, i % rows);
            let x = 24.0 + column as f64 * (WIDTH - 32.0) / COLUMNS as f64;
            let y = list_top + LINE * row as f64;
            match mark {
                Mark::Colour(colour) => svg.rectangle([x + 2.0, y - 5.0, 10.0, 10.0], *colour, 1.0),
                Mark::Number(number) => svg.text([x, y], &number.to_string(), Font { bold: true, ..PLAIN }),
            }
            svg.text([x + 22.0, y], text, Font { most: 60, ..PLAIN });
        }
        svg.finish()
    }

    /// The list below: bodies, then joints by number, then drives.
    fn list(&self) -> Vec<(Mark, String)> {
        let bodies = self.bodies.iter().enumerate().map(|(i, body)| (Mark::Colour(colour(Some(i))), body.name.clone()));
        let joints = self.joints.iter().enumerate().map(|(i, joint)| {
            let gaps: Vec<_> = joint.kind.gaps().map(|gap| ten_digits(self.gaps[gap].statistics.mean * 1e3)).collect();
            let word = if gaps.len() == 1 { "gap" } else { "gaps" };
            let play = if gaps.is_empty() { String::new() } else { format!(", {word} {} mm", gaps.join(", ")) };
            (Mark::Number(i + 1), format!("{}: {}{play}", joint.name, joint.kind.name()))
        });
        let drives = self.drives.iter().map(|drive| {
            let body = &self.bodies[drive.body].name;
            let does = drive.action.kind().choose("pushes", "turns");
            (Mark::Colour(symbol::DRIVE), format!("{} {does} {body}", drive.name))
        });
        bodies.chain(joints).chain(drives).collect()
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
        for joint in &self.joints {
            pen.joint(joint);
        }
        for (i, body) in self.bodies.iter().enumerate() {
            pen.centre(body.centre, colour(Some(i)));
        }
        for drive in &self.drives {
            let centre = self.bodies[drive.body].centre;
            match drive.action {
                Action::Pushes { axis } => {
                    let at = std::array::from_fn(|k| centre[k] + drive.drive.point_b[k]);
                    pen.arrow(at, axis.map(|x| x * if drive.drive.speed < 0.0 { -1.0 } else { 1.0 }));
                }
                Action::Turns { axis } => pen.turn(self.pivot(drive.body), axis, drive.drive.speed),
            }
        }
        // Where several joints lie behind each other they share a label.
        let mut labels: Vec<([f64; 2], String)> = Vec::new();
        for (i, joint) in self.joints.iter().enumerate() {
            let at = view.at(joint.at);
            match labels.iter_mut().find(|(other, _)| (other[0] - at[0]).hypot(other[1] - at[1]) < 24.0) {
                Some((_, label)) => *label = format!("{label}, {}", i + 1),
                None => labels.push((at, (i + 1).to_string())),
            }
        }
        for ([x, y], label) in labels {
            pen.svg.text([x + 10.0, y - 22.0], &label, Font { bold: true, ..PLAIN });
        }
    }

    /// What a drive turns a body about: the middle of its joints with the frame, if there are any, else its centre of mass.
    fn pivot(&self, body: usize) -> [f64; 3] {
        use JointKind::{Bearing, Journal, PinSlot, Revolute};
        let turns = |joint: &&Joint| matches!(joint.kind, Revolute | PinSlot { .. } | Journal { .. } | Bearing { .. });
        let to_frame = |joint: &&Joint| joint.between.contains(&None) && joint.between.contains(&Some(body));
        let places: Vec<_> = self.joints.iter().filter(turns).filter(to_frame).map(|joint| joint.at).collect();
        if places.is_empty() {
            return self.bodies[body].centre;
        }
        std::array::from_fn(|k| places.iter().map(|place| place[k]).sum::<f64>() / places.len() as f64)
    }
}

impl JointKind {
    /// The gaps of the joint, by their numbers.
    pub fn gaps(&self) -> impl Iterator<Item = usize> + use<> {
        let gaps = match *self {
            Self::Journal { gap, .. }
            | Self::Guide { gap, .. }
            | Self::Bearing { gap, .. }
            | Self::Stop { gap, .. } => [Some(gap), None, None, None],
            Self::Track { gaps } => gaps,
            Self::Fixed | Self::Revolute | Self::Prismatic { .. } | Self::PinSlot { .. } => [None; 4],
        };
        gaps.into_iter().flatten()
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
            // Nothing lies outside the picture.
            for number in svg.split(['"', ' ', ',']).filter_map(|word| word.parse::<f64>().ok()) {
                assert!((-1e3..1e3).contains(&number), "{name}: {number}");
            }
            drawn += 1;
        }
        assert!(drawn >= 7, "{drawn}");
    }
}
