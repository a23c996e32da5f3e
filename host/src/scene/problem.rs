//! The problems of a scene.

use slipfit_tolerance::number::ten_digits;
use slipfit_tolerance::product::{
    contacts::PlacementError, dimension::ShapeError, expression::Fault, iso286::ClassError, iso2768::BandError,
};

use super::LevelError;
use crate::setup::GapError;

/// What is wrong with a scene. Keys are written in full, such as `slide.mass`; values as they were typed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// The text is not TOML.
    #[error("not valid TOML: {0}")]
    Syntax(String),
    /// An override is not of the form `key=value`.
    #[error("`--set` needs a key and a value")]
    Override,
    /// A key that no scene has.
    #[error("unknown key `{key}`{}", similar.as_ref().map(|key| format!(", did you mean `{key}`?")).unwrap_or_default())]
    UnknownKey {
        /// The key.
        key: String,
        /// A key that is spelt alike.
        similar: Option<String>,
    },
    /// A name that nothing in the scene has.
    #[error("there is no {of} `{name}`")]
    UnknownName {
        /// What it should be, such as "pin".
        of: String,
        /// The name.
        name: String,
    },
    /// A key that every scene needs.
    #[error("`{0}` is missing")]
    Missing(String),
    /// A value of another type.
    #[error("`{key}` is {found}")]
    Type {
        /// The key.
        key: String,
        /// What the value is, with its article.
        found: &'static str,
    },
    /// A list of another length.
    #[error("`{key}` is a list of {found}")]
    Length {
        /// The key.
        key: String,
        /// Elements found.
        found: usize,
    },
    /// A text that does not begin with a number.
    #[error("`{key}` is \"{written}\", which is not a number with its unit")]
    NotANumber {
        /// The key.
        key: String,
        /// The value.
        written: String,
    },
    /// A unit that does not fit the key.
    #[error("`{key}` is \"{written}\", whose unit does not fit")]
    Unit {
        /// The key.
        key: String,
        /// The value.
        written: String,
    },
    /// A stiffness in a unit with an exponent other than the contact's.
    #[error("`{key}` is \"{written}\", but `contact.exponent` is {exponent}")]
    Exponent {
        /// The key.
        key: String,
        /// The value.
        written: String,
        /// The contact's exponent.
        exponent: f64,
    },
    /// NaN, infinite, or too large for a number.
    #[error("`{key}` is {written}, which is not finite")]
    NotFinite {
        /// The key.
        key: String,
        /// The value.
        written: String,
    },
    /// A text with a character that is not printed, but steers what prints it.
    #[error("`{key}` is {written:?}, which has a control character")]
    ControlCharacter {
        /// The key.
        key: String,
        /// The value.
        written: String,
    },
    /// A number outside its range.
    #[error("`{key}` is {written}")]
    OutOfRange {
        /// The key.
        key: String,
        /// The value with its unit.
        written: String,
    },
    /// A text that is none of the choices.
    #[error("`{key}` is \"{written}\"")]
    Choice {
        /// The key.
        key: String,
        /// The value.
        written: String,
    },
    /// A key that changes nothing where it is written.
    #[error("`{key}` has no effect {place}")]
    NoEffect {
        /// The key.
        key: String,
        /// Where, such as "with a uniform distribution".
        place: String,
    },
    /// Measured parts that make no distribution.
    #[error("`{of}` cannot be measured: {why}")]
    Measured {
        /// The characteristic, or the file.
        of: String,
        /// Why.
        why: String,
    },
    /// An included file that cannot be read.
    #[error("the file cannot be included: {why}")]
    Include {
        /// Why.
        why: String,
    },
    /// A record that cannot be commanded.
    #[error("the record cannot be commanded: {why}")]
    Record {
        /// Why.
        why: String,
    },
    /// Exact friction with a scheme that does not solve for forces.
    #[error("`controller.integrator` is \"{0}\", which cannot do exact friction")]
    ExplicitFriction(String),
    /// A name that is taken.
    #[error("`{key}` is \"{name}\" again")]
    Duplicate {
        /// The key.
        key: String,
        /// The name.
        name: String,
    },
    /// A tolerance without width, or a distribution that does not fit its tolerance.
    #[error("`{key}`: {error}")]
    Shape {
        /// The key.
        key: String,
        /// Why not.
        error: ShapeError,
    },
    /// A length without a general tolerance.
    #[error("`{key}`: {error}")]
    Band {
        /// The key.
        key: String,
        /// Which.
        error: BandError,
    },
    /// A class of ISO 286 that gives no limits.
    #[error("`{key}`: {error}")]
    Class {
        /// The key.
        key: String,
        /// Why.
        error: ClassError,
    },
    /// An expression that cannot be read or computed.
    #[error("`{key}`: {fault}")]
    Expression {
        /// The key.
        key: String,
        /// Why not.
        fault: Fault,
    },
    /// A lower limit that is not below the upper one.
    #[error("`{key}` is {written}, which is not above the lower limit, {lower}")]
    Limits {
        /// The key of the upper limit.
        key: String,
        /// The upper limit.
        written: String,
        /// The lower limit.
        lower: String,
    },
    /// Coefficients that no set of random variables can have.
    #[error(
        "the correlations leave a number nothing of its own (±1), or contradict each other: their matrix is not positive definite"
    )]
    NotPositiveDefinite,
    /// Something that drawings have and this program does not.
    #[error("{what} is not supported")]
    Unsupported {
        /// What.
        what: String,
    },
    /// A part, or a system of datums, without one definite place.
    #[error("`{part}`: {error}")]
    Placement {
        /// Part or feature.
        part: String,
        /// Why.
        error: PlacementError,
    },
    /// A part without a mate.
    #[error("no mate places the part `{0}`: it is under-constrained")]
    NotPlaced(String),
    /// A part with two mates, or the first part with one.
    #[error("the part `{0}` is placed already: it is over-constrained")]
    PlacedTwice(String),
    /// Mates that rest on each other.
    #[error("the mates form a loop: {0}")]
    Loop(String),
    /// A scene of tolerances alone where motion is asked for.
    #[error("the scene has neither a slide on pins nor bodies and joints: there is nothing to move")]
    NoSlide,
    /// A mechanism of bodies and joints where a slide on pins is asked for.
    #[error("the scene is a mechanism of bodies and joints, and this command works on slides on pins")]
    NotASlide,
    /// A joint, spring or pair of bodies that is one body.
    #[error("`{key}` joins \"{name}\" to itself")]
    JoinedToItself {
        /// The key.
        key: String,
        /// The body.
        name: String,
    },
    /// A body that nothing holds.
    #[error("nothing joins the body \"{body}\" to another")]
    Floating {
        /// The body.
        body: String,
    },
    /// Joints without play that hold each other.
    #[error("the joint \"{joint}\" closes a loop of joints without play")]
    IdealLoop {
        /// The joint.
        joint: String,
    },
    /// A joint that is nowhere near its bodies.
    #[error("the joint \"{joint}\" is {} mm from the centre of the nearer body that it joins", ten_digits(away.round()))]
    Far {
        /// The joint.
        joint: String,
        /// How far (mm).
        away: f64,
    },
    /// A mechanism as a whole.
    #[error("{0}")]
    Mechanism(String),
    /// Not a range of tolerance levels.
    #[error("`{key}`: {error}")]
    Levels {
        /// The key.
        key: String,
        /// Why not.
        error: LevelError,
    },
    /// Tolerance levels at which a gap is out of bounds.
    #[error("`sweep.n`: {0}")]
    Gap(GapError),
    /// The same of a mechanism.
    #[error("`sweep.n`: {0}")]
    Play(crate::mechanism::GapError),
}

impl Problem {
    /// Whether the problem lies in one value or key alone, so that it stands whatever else is wrong.
    pub(super) fn stands_alone(&self) -> bool {
        !matches!(
            self,
            Self::OutOfRange { .. }
                | Self::Exponent { .. }
                | Self::Limits { .. }
                | Self::NotPositiveDefinite
                | Self::Placement { .. }
                | Self::NotPlaced(_)
                | Self::PlacedTwice(_)
                | Self::Loop(_)
                | Self::IdealLoop { .. }
                | Self::Mechanism(_)
                | Self::Gap(_)
        )
    }
}
