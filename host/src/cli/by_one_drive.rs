//! What moves in a scene, by the drive that is meant: a slide on pins, or a mechanism.

use slipfit_tolerance::{number::ten_digits, product::Product};

use super::{
    arguments::{DriveArguments, Moving},
    check,
    failure::Failure,
    mechanism,
};
use crate::{
    dynamics::{
        driven::Driven,
        film::{MOMENTS, film as film_of_slide},
        simulate::SimulateError,
    },
    mechanism::{
        ByDrive, Mechanism,
        closing::{closing_level, derived},
        film,
        self_locking::{DriveSide, guide, locked},
    },
    population::{
        Unit,
        mechanism::mechanism_of,
        production::Production,
        slide::scene_of,
        subject::Subject,
        tally::Duty,
        uncertain::{answer::Answer, design::Design, study},
    },
    setup::{RunSpec, Scene},
    show::{player, report::Clearances},
};

/// What moves, by one drive.
#[derive(Clone, Copy)]
pub enum ByOneDrive<'a> {
    /// A slide on pins, which has one.
    Slide(&'a Scene),
    /// Bodies and joints.
    Mechanism(ByDrive<'a>),
}

impl<'a> ByOneDrive<'a> {
    /// By the drive that the command line names.
    pub fn new(moving: &'a Moving, drive: &DriveArguments) -> Result<Self, Failure> {
        match moving {
            Moving::Slide(scene) => drive.refuse().map(|()| Self::Slide(scene)),
            Moving::Mechanism(mechanism) => Ok(Self::Mechanism(drive.of(mechanism)?)),
        }
    }

    /// By the drive of that number; `None` if there is none.
    pub fn numbered(moving: &'a Moving, drive: usize) -> Option<Self> {
        match moving {
            Moving::Slide(scene) => Some(Self::Slide(scene)),
            Moving::Mechanism(mechanism) => ByDrive::new(mechanism, drive).map(Self::Mechanism),
        }
    }

    /// What populations are of.
    pub fn subject(&self) -> &dyn Subject {
        match self {
            Self::Slide(scene) => *scene,
            Self::Mechanism(driven) => driven,
        }
    }

    fn mechanism(&self) -> Option<&'a Mechanism> {
        match self {
            Self::Slide(_) => None,
            Self::Mechanism(driven) => Some(driven.mechanism()),
        }
    }

    /// Which of the drives it is.
    pub fn drive(&self) -> usize {
        match self {
            Self::Slide(_) => 0,
            Self::Mechanism(driven) => driven.index(),
        }
    }

    /// The drive's name.
    pub fn drive_name(&self) -> &'a str {
        match self {
            Self::Slide(_) => "drive",
            Self::Mechanism(driven) => driven.name(),
        }
    }

    /// Whether it is one of several.
    pub fn has_other_drives(&self) -> bool {
        self.mechanism().is_some_and(|mechanism| mechanism.drives.len() > 1)
    }

    /// Whether a value or distribution of the whole production is unknown.
    pub fn has_unknowns(&self) -> bool {
        match self {
            Self::Slide(scene) => scene.has_unknowns(),
            Self::Mechanism(driven) => driven.mechanism().has_unknowns(),
        }
    }

    /// What a designer should know before trusting a run.
    pub fn warnings(&self) -> Result<Vec<String>, Failure> {
        match self {
            Self::Slide(scene) => Ok(check::warnings_of(scene)),
            Self::Mechanism(driven) => mechanism::warnings_of(driven.mechanism()),
        }
    }

    /// The production, any two gaps with means and deviations of this `correlation`.
    pub fn production<'p>(
        &self,
        product: Option<&'p Product>,
        correlation: f64,
        seed: u64,
    ) -> Result<Production<'p>, Failure> {
        let production = match self {
            Self::Slide(scene) => Production::new(scene, product, correlation, seed),
            Self::Mechanism(driven) => Production::of_mechanism(driven.mechanism(), product, correlation, seed),
        };
        production.map_err(|error| Failure::Input(error.to_string()))
    }

    /// What the `production` does with the values of a `design` of the unknowns.
    pub fn answer(
        &self,
        production: &Production,
        design: Design,
        duty: Duty,
        done: impl Fn(u64) + Sync,
    ) -> Result<Answer, SimulateError> {
        match self {
            Self::Slide(scene) => study::of_slide(scene, production, design, duty, done),
            Self::Mechanism(driven) => study::of_mechanism(driven, production, design, duty, done),
        }
    }

    /// The same over the whole stroke, where its run is an opening and ends before.
    pub fn longer(&self) -> Option<Moving> {
        let Self::Slide(scene) = self else { return None };
        let duration = scene.stroke_duration().filter(|duration| *duration > scene.run.duration)?;
        let run = RunSpec { duration, ..scene.run };
        Some(Moving::Slide(Box::new(Scene { run, ..(*scene).clone() })))
    }

    /// What is meant by `longer`, or the same where there is nothing longer.
    pub fn or_longer<'b>(&self, longer: &'b Option<Moving>) -> ByOneDrive<'b>
    where
        'a: 'b,
    {
        longer.as_ref().and_then(|moving| ByOneDrive::numbered(moving, self.drive())).unwrap_or(*self)
    }

    /// The title of the scene, with the drive where there are several.
    pub fn title(&self) -> String {
        let title = self.subject().title();
        if self.has_other_drives() { format!("{title}, by {}", self.drive_name()) } else { title.to_owned() }
    }

    /// Whether a run is an opening, if a stroke is stated.
    pub fn has_opening(&self) -> bool {
        matches!(self, Self::Slide(_))
    }

    /// How runs come to verdicts that end before.
    pub fn how_to_run_longer(&self) -> &'static str {
        if self.has_opening() { "state a stroke, such as run.stroke = 80" } else { "take a longer run.duration" }
    }

    /// The level that closes the first of all gaps, or a pair of them, and which.
    pub fn first_to_close(&self) -> Option<(f64, String)> {
        match self {
            Self::Slide(scene) => derived(scene, 0.0).first_to_close(),
            Self::Mechanism(driven) => driven.mechanism().first_to_close().map(|(joint, n)| (n, joint)),
        }
    }

    /// What locks itself at the stated friction: that, the critical one, and where the drive passes.
    pub fn locks(&self) -> Option<(f64, f64, DriveSide)> {
        match self {
            Self::Slide(scene) => {
                let guide = guide(scene, 0.0).filter(|guide| guide.warn)?;
                Some((guide.friction, guide.critical_friction?, guide.side))
            }
            Self::Mechanism(driven) => {
                let locked = locked(driven.mechanism()).into_iter().find(|found| found.drive == driven.name())?;
                Some((locked.friction, locked.critical_friction, locked.side))
            }
        }
    }

    /// Its clearances, for a page.
    pub fn clearances(&self) -> Clearances<'a> {
        match self {
            Self::Slide(scene) => Clearances::Pins { scene, n: closing_level(scene) },
            Self::Mechanism(driven) => Clearances::Joints(driven.mechanism()),
        }
    }

    /// Bodies and joints, drawn.
    pub fn drawing(&self) -> Option<String> {
        self.mechanism().map(Mechanism::drawing)
    }

    /// A `unit` of the `production` for the player, with this label.
    pub fn played(&self, production: &Production, unit: &Unit, label: String) -> Result<player::Run, Failure> {
        let (drawn, i) = production.draw_one(unit.number);
        let gaps = &drawn.gaps[i];
        match self {
            Self::Slide(scene) => {
                let film = film_of_slide(&scene_of(scene, &drawn, i), gaps, MOMENTS)?;
                Ok(player::of_slide(scene, label, &film))
            }
            Self::Mechanism(driven) => {
                let own = mechanism_of(driven.mechanism(), &drawn, i);
                let film = film(&own, gaps, MOMENTS)?;
                Ok(player::of_mechanism(&own, ByDrive::new(&own, driven.index()).as_ref(), gaps, label, &film))
            }
        }
    }
}

/// How a run is made finer.
pub const FINER: &str = "take a tenth of run.error";

/// A remark behind units that come to no verdict; `longer` is how they run longer, if there is an option for it, and `finer` how they run
/// finer.
pub fn why_undecided(driven: &dyn Driven, longer: Option<&str>, finer: &str) -> String {
    let (duration, setpoint) = (driven.run().duration, driven.setpoint());
    let [ends, command] = [duration, setpoint.end()].map(|t| ten_digits(t * 1e3));
    if duration < setpoint.end() {
        let settled = ten_digits((setpoint.end() + 0.5) * 1e3);
        let longer = longer.map_or_else(|| format!("--set run.duration={settled} runs on"), str::to_owned);
        format!(": the run ends at {ends} ms, what is commanded at {command} ms; {longer}")
    } else if setpoint.settled_at(duration) == 0.0 {
        ": nothing is commanded at the end of the run".into()
    } else {
        format!(": a finer run came to another verdict; {finer}")
    }
}
