//! Which coordinates there are, and which of them move what: as values, chosen at run time, or as types, of which nothing is
//! left at run time.

/// What a coordinate is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// An angle in the frame.
    Turn,
    /// A displacement along an axis that is fixed in the body that the coordinate `on` turns, or in the frame.
    Slide {
        /// Which coordinate turns the axis.
        on: Option<usize>,
    },
}

/// The kinds of `D` coordinates.
pub trait Topology<const D: usize>: Copy {
    /// The kind of the coordinate `k` < `D`.
    fn kind(&self, k: usize) -> Kind;
}

/// Which coordinate turns a body.
pub trait Turns: Copy {
    /// The coordinate; `None` where the body does not turn.
    fn turn(&self) -> Option<usize>;
}

/// Which of `D` coordinates move a body.
pub trait Carrier<const D: usize>: Turns {
    /// Whether the coordinate `k` < `D` does.
    fn moves(&self, k: usize) -> bool;
}

/// A body's carrier that is chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chain<const D: usize> {
    /// The coordinate that turns the body.
    pub turn: Option<usize>,
    /// Which coordinates move it.
    pub moves: [bool; D],
}

/// A body's carrier as a type: bit k of `MOVES` says whether the coordinate k moves it, and `TURN` turns it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Path<const MOVES: u32, const TURN: usize = STRAIGHT>;

/// For [`Path`]: a body that does not turn.
pub const STRAIGHT: usize = usize::MAX;

/// The frame's carrier.
pub type Frame = Path<0>;

impl<const D: usize> Chain<D> {
    /// The frame's.
    pub const FRAME: Self = Self { turn: None, moves: [false; D] };
}

impl<const D: usize> Topology<D> for [Kind; D] {
    #[inline(always)]
    fn kind(&self, k: usize) -> Kind {
        self[k]
    }
}

impl Turns for Option<usize> {
    #[inline(always)]
    fn turn(&self) -> Option<usize> {
        *self
    }
}

impl<const D: usize> Turns for Chain<D> {
    #[inline(always)]
    fn turn(&self) -> Option<usize> {
        self.turn
    }
}

impl<const D: usize> Carrier<D> for Chain<D> {
    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.moves[k]
    }
}

impl<const MOVES: u32, const TURN: usize> Turns for Path<MOVES, TURN> {
    #[inline(always)]
    fn turn(&self) -> Option<usize> {
        if TURN == STRAIGHT { None } else { Some(TURN) }
    }
}

impl<const D: usize, const MOVES: u32, const TURN: usize> Carrier<D> for Path<MOVES, TURN> {
    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        MOVES >> k & 1 == 1
    }
}
