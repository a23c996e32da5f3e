//! The columns of Table 2 that follow from its gaps at a tolerance level n, and the level that closes each pair.
//!
//! With q = x − n·σ (eq. 9) a pin has two pairs of gaps, *across* (q1 left, q2 right) and *up and down* (q1 rail,
//! q2 wall):
//! - clearance q1 + q2, the whole play of the slide there;
//! - mean (q2 − q1)/2, how far the middle of that play lies off the pin, along the normal of q2's surface from the pin;
//! - n* = (x1 + x2)/(σ1 + σ2), the level at which the clearance is zero. The product's is the least of all pairs.
//!
//! Toe-outs are differences of means, right minus left and front minus back, and the table's last two columns are
//! differences of toe-outs. Everything is subtracted as it is and rounded only when printed.

use std::fmt;

use serde::Serialize;
use slipfit_core::{clearance::GapStatistics, slide::PINS};
use slipfit_tolerance::number::{fixed, level};

use crate::setup::Scene;

/// Table 2's derived columns at one tolerance level. SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Table2 {
    /// The tolerance level.
    pub n: f64,
    /// The pins in the order of the scene.
    pub pins: [Pin; PINS],
    /// Toe-outs of the means across; `None` unless the pins are four corners, all with both gaps.
    pub toes_across: Option<Toes>,
    /// Toe-outs of the means up and down; `None` unless the pins are four corners, all with both gaps.
    pub toes_up_down: Option<Toes>,
}

/// One pin.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pin {
    /// Its name.
    pub name: String,
    /// Left, right, rail and wall gap at n (m); `None` where there is no contact.
    pub gaps: [Option<f64>; 4],
    /// Left and right together, if the pin has both.
    pub across: Option<Pair>,
    /// Rail and wall together, if the pin has both.
    pub up_down: Option<Pair>,
}

/// Two opposite gaps of a pin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// q1 + q2 at n (m).
    pub clearance: f64,
    /// (q2 − q1)/2 at n (m).
    pub mean: f64,
    /// n* = (x1 + x2)/(σ1 + σ2), the level that closes the pair; `None` if nothing varies.
    pub closes_at: Option<f64>,
}

/// Differences of the four means M of one direction (m).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Toes {
    /// Right minus left of the back pins: M(right back) − M(left back).
    pub back: f64,
    /// Right minus left of the front pins: M(right front) − M(left front).
    pub front: f64,
    /// Front minus back of the left pins: M(left front) − M(left back).
    pub left: f64,
    /// Front minus back of the right pins: M(right front) − M(right back).
    pub right: f64,
    /// `front` − `back`.
    pub front_minus_back: f64,
    /// `right` − `left`; equal to `front_minus_back` but for rounding.
    pub right_minus_left: f64,
}

/// The directions in which two gaps face each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Left and right.
    Across,
    /// Rail and wall.
    UpDown,
}

/// A pair and the level that closes it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Closure<'a> {
    /// Name of the pin.
    pub pin: &'a str,
    /// Which of its pairs.
    pub direction: Direction,
    /// n*.
    pub n: f64,
}

/// The derived columns of `scene` at tolerance level `n`.
pub fn derived(scene: &Scene, n: f64) -> Table2 {
    let pins = scene.pins.each_ref().map(|pin| {
        let [left, right, rail, wall] = pin.gaps;
        let gaps = pin.gaps.map(|gap| gap.map(|gap| gap.at(n)));
        Pin { name: pin.name.clone(), gaps, across: pair(left, right, n), up_down: pair(rail, wall, n) }
    });
    let corners = corners(scene);
    let toes = |pair: fn(&Pin) -> Option<Pair>| {
        let [left_back, right_back, left_front, right_front] = corners?.map(|i| pair(&pins[i]).map(|pair| pair.mean));
        Some(Toes::of(left_back?, right_back?, left_front?, right_front?))
    };
    Table2 { n, toes_across: toes(|pin| pin.across), toes_up_down: toes(|pin| pin.up_down), pins }
}

fn pair(one: Option<GapStatistics<f64>>, two: Option<GapStatistics<f64>>, n: f64) -> Option<Pair> {
    let (one, two) = (one?, two?);
    let (q1, q2) = (one.at(n), two.at(n));
    let deviation = one.deviation + two.deviation;
    let closes_at = (deviation > 0.0).then(|| (one.mean + two.mean) / deviation);
    Some(Pair { clearance: q1 + q2, mean: (q2 - q1) / 2.0, closes_at })
}

/// Which pin is left back, right back, left front and right front, seen from the middle of all; `None` if two share a
/// corner.
fn corners(scene: &Scene) -> Option<[usize; PINS]> {
    let middle = |axis: usize| scene.pins.iter().map(|pin| pin.position[axis]).sum::<f64>() / PINS as f64;
    let (x, z) = (middle(0), middle(2));
    let corner_of = |[px, _, pz]: [f64; 3]| usize::from(px > x) + 2 * usize::from(pz > z);
    let at = |corner| scene.pins.iter().position(|pin| corner_of(pin.position) == corner);
    Some([at(0)?, at(1)?, at(2)?, at(3)?])
}

impl Toes {
    fn of(left_back: f64, right_back: f64, left_front: f64, right_front: f64) -> Self {
        let (back, front) = (right_back - left_back, right_front - left_front);
        let (left, right) = (left_front - left_back, right_front - right_back);
        Self { back, front, left, right, front_minus_back: front - back, right_minus_left: right - left }
    }
}

impl Table2 {
    /// Every pair that some level closes, pin by pin.
    pub fn closures(&self) -> impl Iterator<Item = Closure<'_>> {
        self.pins.iter().flat_map(|pin| {
            [(Direction::Across, pin.across), (Direction::UpDown, pin.up_down)]
                .into_iter()
                .filter_map(|(direction, pair)| Some(Closure { pin: &pin.name, direction, n: pair?.closes_at? }))
        })
    }

    /// The level n* at which the first pair closes, and every pair that closes there, in words.
    pub fn first_to_close(&self) -> Option<(f64, String)> {
        let n = self.tightest()?.n;
        let together = |closure: &Closure| (closure.n - n).abs() <= 1e-9 * n.abs().max(1.0);
        let pairs: Vec<_> =
            self.closures().filter(together).map(|pair| format!("{} {}", pair.pin, pair.direction)).collect();
        Some((n, pairs.join(" and ")))
    }

    /// The pair that closes first: its n* is the product's.
    pub fn tightest(&self) -> Option<Closure<'_>> {
        self.closures().min_by(|a, b| a.n.total_cmp(&b.n))
    }
}

/// The tolerance level that closes the first pair of gaps of `scene`, to a hundredth; 0 if none closes one.
pub fn closing_level(scene: &Scene) -> f64 {
    derived(scene, 0.0).tightest().map_or(0.0, |tightest| (tightest.n * 100.0).round() / 100.0)
}

/// A length (m) in mm with four decimals, as Table 2 prints it; a dash for none.
pub fn millimetres(length: Option<f64>) -> String {
    length.map_or_else(|| "-".to_owned(), |length| fixed(length * 1e3, 4))
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Across => "across",
            Self::UpDown => "up-down",
        })
    }
}

impl fmt::Display for Table2 {
    /// Plain text for the terminal, lengths in mm.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.pins.iter().map(|pin| pin.name.chars().count()).max().unwrap_or(0).max(12);
        writeln!(f, "At n = {}, lengths in mm", level(self.n))?;
        writeln!(f, "{:width$}  {:^38}  {:^28}  {:>16}", "", "gap", "across", "up-down")?;
        write!(f, "{:width$}", "pin")?;
        for heading in ["left", "right", "rail", "wall", "clearance", "mean", "n*", "clearance", "mean", "n*"] {
            write!(f, " {heading:>9}")?;
        }
        writeln!(f)?;
        for pin in self.pins.iter().filter(|pin| pin.gaps.iter().any(Option::is_some)) {
            write!(f, "{:width$}", pin.name)?;
            for gap in pin.gaps {
                write!(f, " {:>9}", millimetres(gap))?;
            }
            for pair in [pin.across, pin.up_down] {
                let closes_at = pair.and_then(|pair| pair.closes_at).map_or_else(|| "-".to_owned(), |n| fixed(n, 3));
                let (clearance, mean) = (pair.map(|pair| pair.clearance), pair.map(|pair| pair.mean));
                write!(f, " {:>9} {:>9} {closes_at:>9}", millimetres(clearance), millimetres(mean))?;
            }
            writeln!(f)?;
        }
        for (name, toes) in [("across", self.toes_across), ("up-down", self.toes_up_down)] {
            let Some(toes) = toes else { continue };
            let mm = |length| millimetres(Some(length));
            writeln!(f, "\ntoe-out {name}")?;
            writeln!(f, "  right - left: back {}, front {}", mm(toes.back), mm(toes.front))?;
            writeln!(f, "  front - back: left {}, right {}", mm(toes.left), mm(toes.right))?;
            writeln!(f, "  front - back of right - left: {}", mm(toes.front_minus_back))?;
            writeln!(f, "  right - left of front - back: {}", mm(toes.right_minus_left))?;
        }
        if let Some((n, pairs)) = self.first_to_close() {
            writeln!(f, "\nn* = {} closes {pairs} first", fixed(n, 4))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Direction, derived, millimetres};
    use crate::dynamics::example;

    #[test]
    fn closing_levels_of_the_paper() {
        let table = derived(&example::cd_rom(), 3.43);
        let n: Vec<f64> = table.closures().map(|closure| closure.n).collect();
        let expected = [6.554, 9.433, 9.333, 9.061, 3.4299, 7.597, 7.011, 7.646];
        for (n, expected) in n.iter().zip(expected) {
            assert!((n - expected).abs() < 5.1e-4, "{n} {expected}");
        }
        let tightest = table.tightest().unwrap();
        assert_eq!((tightest.pin, tightest.direction), ("left front", Direction::Across));
        assert!((tightest.n - 0.3814 / 0.1112).abs() < 1e-12);
    }

    #[test]
    fn subtracts_before_rounding() {
        let table = derived(&example::cd_rom(), 3.43);
        let clearance = table.pins[2].across.unwrap().clearance;
        assert!((clearance + 1.6e-8).abs() < 1e-15);
        assert_eq!(millimetres(Some(clearance)), "0.0000");
        let toes = table.toes_across.unwrap();
        for (toe, mm) in [
            (toes.back, 0.0650255),
            (toes.front, 0.073457),
            (toes.left, -0.000493),
            (toes.right, 0.0079385),
            (toes.front_minus_back, 0.0084315),
            (toes.right_minus_left, 0.0084315),
        ] {
            assert!((toe * 1e3 - mm).abs() < 1e-12, "{toe} {mm}");
        }
        assert!((table.toes_up_down.unwrap().front_minus_back * 1e3 - 0.0043875).abs() < 1e-12);
    }

    #[test]
    fn missing_gaps_and_shared_corners_leave_columns_out() {
        let mut scene = example::cd_rom();
        scene.pins[1].gaps[3] = None;
        let table = derived(&scene, 0.0);
        assert_eq!((table.pins[1].up_down, table.toes_up_down), (None, None));
        assert!(table.toes_across.is_some());
        scene.pins[0].position = scene.pins[1].position;
        assert_eq!(derived(&scene, 0.0).toes_across, None);
        scene.pins.swap(0, 3);
        scene.pins[2].gaps[0].as_mut().unwrap().deviation = 0.0;
        scene.pins[2].gaps[1].as_mut().unwrap().deviation = 0.0;
        assert_eq!(derived(&scene, 0.0).pins[2].across.unwrap().closes_at, None);
    }

    #[test]
    fn text() {
        insta::assert_snapshot!(derived(&example::cd_rom(), 3.43).to_string());
    }
}
