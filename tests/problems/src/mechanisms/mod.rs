//! Mechanisms as composed types: the shipped ones, and two with what drives, springs, friction and walls can have. What
//! `slipfit kernel SCENE -o FILE.rs` writes of them, kept current by a test.

/// Four-bar with play between coupler and rocker.
#[rustfmt::skip]
pub mod four_bar;
/// Hatch on two hinges with play.
#[rustfmt::skip]
pub mod hatch;
/// Linear guide on two rods.
#[rustfmt::skip]
pub mod linear_guide;
/// What drives, springs, friction and walls can have in a plane.
#[rustfmt::skip]
pub mod motion_plane;
/// Walls whose gaps are stated at three places.
#[rustfmt::skip]
pub mod motion_rails;
/// What they can have in space.
#[rustfmt::skip]
pub mod motion_space;
/// Slider-crank with play in its big end.
#[rustfmt::skip]
pub mod slider_crank;
/// Slider-crank with play in its guide.
#[rustfmt::skip]
pub mod slider_crank_guide;
/// Telescopic drawer of two members.
#[rustfmt::skip]
pub mod telescopic_drawer;
/// Crank, ball rod and slide.
#[rustfmt::skip]
pub mod ball_rod;
/// Woodpecker toy.
#[rustfmt::skip]
pub mod woodpecker_toy;
