//! A player for a page: a mechanism that moves on its joints, gaps enlarged, contacts coloured by force.
//!
//! The head of `player.js` says what every field is and in which units; the script draws what it is given, the page needs
//! nothing else.

mod hull;
mod joints;
mod mechanism;
mod slide;

use maud::{Markup, PreEscaped, html};
use serde::{Serialize, Serializer};

use crate::{dynamics::outcome::Outcome, mechanism::Moment};

pub use mechanism::run as of_mechanism;
pub use slide::run as of_slide;

/// The script, once a page.
pub const SCRIPT: PreEscaped<&str> = PreEscaped(include_str!("player.js"));
/// Its style.
pub const STYLE: PreEscaped<&str> = PreEscaped(include_str!("player.css"));

/// Letters of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// A run to be played.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// Title of the picture.
    pub title: String,
    /// Which of the runs it is.
    pub label: String,
    /// Times (ms), ascending, at least two.
    pub t: Series,
    /// From which sides it is seen.
    pub views: Vec<View>,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Joints with play.
    pub joints: Vec<Joint>,
    /// Curves.
    pub plots: Vec<Plot>,
    /// Moments.
    pub events: Vec<Event>,
    /// From when (ms) on the first curve's greatest value is its peak: the ramp's start.
    pub from: f64,
}

/// One number a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series(pub Vec<f64>);

/// A number that never changes stands alone.
impl Serialize for Series {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0.first() {
            Some(first) if self.0.iter().all(|value| value == first) => serializer.serialize_f64(*first),
            _ => self.0.serialize(serializer),
        }
    }
}

/// A number of every moment, with so many decimals.
fn series(moments: &[Moment], digits: i32, of: impl Fn(&Moment) -> f64) -> Series {
    Series(moments.iter().map(|moment| rounded(of(moment), digits)).collect())
}

/// A side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct View {
    /// Its name.
    pub name: &'static str,
    /// The axes to the right and upwards.
    pub axes: [&'static str; 2],
}

/// A body.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Centre of mass (mm) in the drawn pose.
    pub at: [f64; 3],
    /// Closed polygons (mm) in the drawn pose.
    pub outline: Vec<Vec<[f64; 3]>>,
    /// Motion at true scale.
    pub travel: Motion,
    /// Motion that is enlarged.
    pub sway: Motion,
}

/// Displacement (mm) and rotation vector (rad).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Motion {
    #[serde(skip_serializing_if = "Option::is_none")]
    x: Option<Series>,
    #[serde(skip_serializing_if = "Option::is_none")]
    y: Option<Series>,
    #[serde(skip_serializing_if = "Option::is_none")]
    z: Option<Series>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ax: Option<Series>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ay: Option<Series>,
    #[serde(skip_serializing_if = "Option::is_none")]
    az: Option<Series>,
}

/// A joint with play.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// The pin (mm) in the drawn pose.
    pub at: [f64; 3],
    /// The body that carries the pin, and the one that carries the gap.
    pub between: [String; 2],
    /// The axes of the plane in which the gap lies.
    pub axes: [&'static str; 2],
    /// Limits (mm) of the pin's place: left, right, low, high; open where there is none.
    #[serde(rename = "box")]
    pub limits: [Option<f64>; 4],
    /// Whether the gap is the circle in these limits.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub round: bool,
    /// Angle (rad) from the axes in the drawn pose to those of limits and place.
    #[serde(skip_serializing_if = "is_nothing")]
    pub turn: f64,
    /// The pin's place (mm) along the two axes.
    pub pin: [Series; 2],
    /// Its contacts.
    pub contacts: Vec<Contact>,
}

/// A side of a joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// left, right, low or high; around in a circle.
    pub side: &'static str,
    /// What the side is called.
    pub name: &'static str,
    /// How hard (N) it is pressed.
    pub force: Series,
}

/// A curve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plot {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Values.
    pub values: Series,
}

/// Whether an angle need not be written.
fn is_nothing(angle: &f64) -> bool {
    *angle == 0.0
}

/// Millimetres in a metre, and milliseconds in a second.
const MM: f64 = 1e3;

/// What happens in a run, as far as it does.
fn events(outcome: &Outcome) -> Vec<Event> {
    let event = |moment: Option<f64>, name| Some(Event { t: rounded(moment? * MM, 1), name });
    let events = [
        event(outcome.breakaway, "breaks away"),
        event(outcome.tips.map(|tips| tips.t), "tips"),
        event(outcome.stops.map(|stops| stops.t), "stops"),
    ];
    events.into_iter().flatten().collect()
}

/// With so many decimals: a page has no use for more.
fn rounded(value: f64, digits: i32) -> f64 {
    let scale = libm::pow(10.0, f64::from(digits));
    // Without a negative zero.
    libm::round(value * scale) / scale + 0.0
}

/// A moment to mark.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Event {
    /// When (ms).
    pub t: f64,
    /// What happens.
    pub name: &'static str,
}

/// The figure of some `runs` of one mechanism, at least one, below a sentence on it. The player says itself what it shows.
///
/// # Errors
/// If a number is not finite.
pub fn figure(runs: &[Run], caption: &str) -> Result<Markup, serde_json::Error> {
    // Without this character the data can neither end the script's element nor open what hides its end.
    let data = serde_json::to_string(runs)?.replace('<', "\\u003c");
    Ok(html! {
        p { (caption) }
        figure.player {
            script type="application/json" { (PreEscaped(data)) }
            noscript { "The player needs a script, which this page holds but the reader does not run." }
        }
    })
}
