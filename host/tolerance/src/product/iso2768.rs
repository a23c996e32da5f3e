//! General tolerances: what ISO 2768-1 (sizes and angles) and ISO 2768-2 (geometry) say where a drawing says nothing.
//!
//! A band is "over … up to and including"; the first band of sizes begins at 0.5 mm. Lengths in m, angles in rad.

use std::{f64::consts::PI, str::FromStr};

use crate::number::ten_digits;

/// What a user of ISO 2768-2 should know.
pub const WITHDRAWN: &str = "ISO 2768-2 was withdrawn in 2021 in favour of ISO 22081, which has no tables of values: \
                             agree on the general geometrical tolerances with the supplier";

/// Class of ISO 2768-1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SizeClass {
    /// f.
    Fine,
    /// m.
    Medium,
    /// c.
    Coarse,
    /// v.
    VeryCoarse,
}

/// Class of ISO 2768-2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GeometryClass {
    /// H.
    H,
    /// K.
    K,
    /// L.
    L,
}

/// The general tolerances that a drawing names, such as "ISO 2768-mH".
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct General {
    /// Of sizes and angles.
    pub size: Option<SizeClass>,
    /// Of geometry.
    pub geometry: Option<GeometryClass>,
}

/// A length for which a table has no value.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("ISO 2768 class {class} has no {of} for {} mm", ten_digits(length * 1e3))]
pub struct BandError {
    /// Class letter.
    pub class: char,
    /// What was looked up.
    pub of: &'static str,
    /// The length (m).
    pub length: f64,
    /// The lengths (mm) that have a value: from the first on (over it, unless it is 0.5) up to the second.
    pub allowed: [f64; 2],
}

impl SizeClass {
    /// Its letter.
    pub fn letter(self) -> char {
        ['f', 'm', 'c', 'v'][self as usize]
    }
}

impl GeometryClass {
    /// Its letter.
    pub fn letter(self) -> char {
        ['H', 'K', 'L'][self as usize]
    }
}

impl FromStr for General {
    type Err = ();

    /// Reads "m", "H" or "mH".
    fn from_str(text: &str) -> Result<Self, ()> {
        let mut general = Self::default();
        for letter in text.chars() {
            match letter {
                'f' | 'm' | 'c' | 'v' if general == Self::default() => {
                    general.size = Some(match letter {
                        'f' => SizeClass::Fine,
                        'm' => SizeClass::Medium,
                        'c' => SizeClass::Coarse,
                        _ => SizeClass::VeryCoarse,
                    });
                }
                'H' | 'K' | 'L' if general.geometry.is_none() => {
                    general.geometry = Some(match letter {
                        'H' => GeometryClass::H,
                        'K' => GeometryClass::K,
                        _ => GeometryClass::L,
                    });
                }
                _ => return Err(()),
            }
        }
        if general == Self::default() { Err(()) } else { Ok(general) }
    }
}

/// No value in the standard.
const NONE: f64 = f64::NAN;

const SIZES: [f64; 8] = [3.0, 6.0, 30.0, 120.0, 400.0, 1000.0, 2000.0, 4000.0];
const SIZE_TOLERANCES: [[f64; 8]; 4] = [
    [0.05, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, NONE],
    [0.1, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0],
    [0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 4.0],
    [NONE, 0.5, 1.0, 1.5, 2.5, 4.0, 6.0, 8.0],
];
const EDGES: [f64; 3] = [3.0, 6.0, f64::INFINITY];
const EDGE_TOLERANCES: [[f64; 3]; 2] = [[0.2, 0.5, 1.0], [0.4, 1.0, 2.0]];
const SIDES: [f64; 5] = [10.0, 50.0, 120.0, 400.0, f64::INFINITY];
/// Minutes of arc.
const ANGLE_TOLERANCES: [[f64; 5]; 3] =
    [[60.0, 30.0, 20.0, 10.0, 5.0], [90.0, 60.0, 30.0, 15.0, 10.0], [180.0, 120.0, 60.0, 30.0, 20.0]];

const FACES: [f64; 6] = [10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0];
const FLATNESS: [[f64; 6]; 3] =
    [[0.02, 0.05, 0.1, 0.2, 0.3, 0.4], [0.05, 0.1, 0.2, 0.4, 0.6, 0.8], [0.1, 0.2, 0.4, 0.8, 1.2, 1.6]];
const LEGS: [f64; 4] = [100.0, 300.0, 1000.0, 3000.0];
const PERPENDICULARITY: [[f64; 4]; 3] = [[0.2, 0.3, 0.4, 0.5], [0.4, 0.6, 0.8, 1.0], [0.6, 1.0, 1.5, 2.0]];
const SYMMETRY: [[f64; 4]; 3] = [[0.5; 4], [0.6, 0.6, 0.8, 1.0], [0.6, 1.0, 1.5, 2.0]];
const RUN_OUT: [f64; 3] = [0.1, 0.2, 0.5];

/// The value (in the table's unit) of the band that holds `length` (m), which begins `from` (mm).
fn lookup(
    (class, of): (char, &'static str),
    bands: &[f64],
    values: &[f64],
    from: f64,
    length: f64,
) -> Result<f64, BandError> {
    // A band's edge is divided as the scene's number is, so that 30 mm is up to and including 30 mm.
    let band = bands.iter().position(|edge| length <= edge / 1e3);
    let begins = if from > 0.0 { length >= from / 1e3 } else { length > 0.0 };
    let value = band.filter(|_| begins).map(|band| values[band]).filter(|value| !value.is_nan());
    value.ok_or_else(|| {
        let known = |(value, _): &(&f64, _)| !value.is_nan();
        let gap = values.iter().take_while(|value| value.is_nan()).count();
        let least = if gap == 0 { from } else { bands[gap - 1] };
        let greatest = values.iter().zip(bands).filter(known).map(|(_, edge)| *edge).fold(0.0, f64::max);
        BandError { class, of, length, allowed: [least, greatest] }
    })
}

/// ± tolerance (m) of a size of nominal `length` (m), broken edges excepted.
///
/// # Errors
/// [`BandError`] outside 0.5 to 4000 mm (f: to 2000 mm; v: over 3 mm).
pub fn linear(class: SizeClass, length: f64) -> Result<f64, BandError> {
    let name = (class.letter(), "tolerance of a size");
    lookup(name, &SIZES, &SIZE_TOLERANCES[class as usize], 0.5, length).map(|t| t / 1e3)
}

/// ± tolerance (m) of a broken edge: an external radius or a chamfer of height `length` (m).
///
/// # Errors
/// [`BandError`] below 0.5 mm.
pub fn broken_edge(class: SizeClass, length: f64) -> Result<f64, BandError> {
    let row = usize::from(matches!(class, SizeClass::Coarse | SizeClass::VeryCoarse));
    lookup((class.letter(), "tolerance of a broken edge"), &EDGES, &EDGE_TOLERANCES[row], 0.5, length).map(|t| t / 1e3)
}

/// ± tolerance (rad) of an angle whose shorter `side` (m) this is.
///
/// # Errors
/// [`BandError`] unless `side` is positive.
pub fn angle(class: SizeClass, side: f64) -> Result<f64, BandError> {
    let row = (class as usize).saturating_sub(1);
    let minutes = lookup((class.letter(), "tolerance of an angle"), &SIDES, &ANGLE_TOLERANCES[row], 0.0, side)?;
    Ok(minutes * PI / 10_800.0)
}

/// Zone width (m) of flatness, by the `longer` side (m) of the face, and of straightness, by the length of the line.
///
/// # Errors
/// [`BandError`] outside 0 to 3000 mm.
pub fn flatness(class: GeometryClass, longer: f64) -> Result<f64, BandError> {
    lookup((class.letter(), "flatness"), &FACES, &FLATNESS[class as usize], 0.0, longer).map(|t| t / 1e3)
}

/// Zone width (m) of perpendicularity, by the `shorter` leg (m).
///
/// # Errors
/// [`BandError`] outside 0 to 3000 mm.
pub fn perpendicularity(class: GeometryClass, shorter: f64) -> Result<f64, BandError> {
    lookup((class.letter(), "perpendicularity"), &LEGS, &PERPENDICULARITY[class as usize], 0.0, shorter)
        .map(|t| t / 1e3)
}

/// Zone width (m) of symmetry, by the `shorter` feature's length (m).
///
/// # Errors
/// [`BandError`] outside 0 to 3000 mm.
pub fn symmetry(class: GeometryClass, shorter: f64) -> Result<f64, BandError> {
    lookup((class.letter(), "symmetry"), &LEGS, &SYMMETRY[class as usize], 0.0, shorter).map(|t| t / 1e3)
}

/// Circular run-out (m).
pub fn run_out(class: GeometryClass) -> f64 {
    RUN_OUT[class as usize] / 1e3
}

/// Zone width (m) of parallelism: the larger of the whole tolerance of the `size` and the `flatness` (m).
pub fn parallelism(size: f64, flatness: f64) -> f64 {
    size.max(flatness)
}

#[cfg(test)]
mod tests {
    use super::*;
    use GeometryClass::{H, K, L};
    use SizeClass::{Coarse, Fine, Medium, VeryCoarse};

    /// The tables as text, so that a typing error would have to be made twice.
    fn cells(row: &str) -> Vec<Option<f64>> {
        row.split_whitespace().map(|cell| cell.parse().ok()).collect()
    }

    /// Both sides of every edge of `bands` (mm): the value of the band up to and including, then that of the next.
    fn check(bands: &str, row: &str, first: f64, value: impl Fn(f64) -> Result<f64, BandError>) {
        let (bands, cells) = (cells(bands), cells(row));
        let close = |found: Option<f64>, expected: Option<f64>| match (found, expected) {
            (Some(found), Some(expected)) => (found - expected).abs() <= 1e-15 * expected.abs(),
            (found, expected) => found == expected,
        };
        let at = |mm: f64, expected: Option<f64>| {
            let found = value(mm / 1e3).ok();
            assert!(close(found, expected), "{mm} mm: {found:?}, not {expected:?}");
        };
        let mut from = first;
        for (i, cell) in cells.iter().enumerate() {
            at(if i == 0 && first > 0.0 { first } else { from + 1e-9 }, *cell);
            let Some(edge) = bands.get(i).copied().flatten() else {
                at(1e7, *cell);
                return;
            };
            at((from + edge) / 2.0, *cell);
            at(edge, *cell);
            at(edge + 1e-9, cells.get(i + 1).copied().flatten());
            from = edge;
        }
        at(from * 2.0, None);
        at(if first > 0.0 { first - 1e-9 } else { 0.0 }, None);
        at(-1.0, None);
        at(f64::NAN, None);
    }

    fn millimetres(f: impl Fn(f64) -> Result<f64, BandError>) -> impl Fn(f64) -> Result<f64, BandError> {
        move |length| f(length).map(|t| t * 1e3)
    }

    #[test]
    fn sizes() {
        let bands = "3 6 30 120 400 1000 2000 4000";
        for (class, row) in [
            (Fine, "0.05 0.05 0.1 0.15 0.2 0.3 0.5 -"),
            (Medium, "0.1 0.1 0.2 0.3 0.5 0.8 1.2 2"),
            (Coarse, "0.2 0.3 0.5 0.8 1.2 2 3 4"),
            (VeryCoarse, "- 0.5 1 1.5 2.5 4 6 8"),
        ] {
            check(bands, row, 0.5, millimetres(|length| linear(class, length)));
        }
        assert_eq!(linear(Fine, 2.5).unwrap_err().allowed, [0.5, 2000.0]);
        let error = linear(VeryCoarse, 0.002).unwrap_err();
        assert_eq!((error.class, error.allowed), ('v', [3.0, 4000.0]));
        assert_eq!(error.to_string(), "ISO 2768 class v has no tolerance of a size for 2 mm");
    }

    #[test]
    fn broken_edges_and_angles() {
        for (class, edges, angles) in [
            (Fine, "0.2 0.5 1", "60 30 20 10 5"),
            (Medium, "0.2 0.5 1", "60 30 20 10 5"),
            (Coarse, "0.4 1 2", "90 60 30 15 10"),
            (VeryCoarse, "0.4 1 2", "180 120 60 30 20"),
        ] {
            check("3 6", edges, 0.5, millimetres(|length| broken_edge(class, length)));
            check("10 50 120 400", angles, 0.0, |side| angle(class, side).map(|a| a.to_degrees() * 60.0));
        }
        assert!(angle(Fine, 0.0).is_err() && broken_edge(Fine, 0.0004).is_err());
    }

    #[test]
    fn geometry() {
        let (faces, legs) = ("10 30 100 300 1000 3000", "100 300 1000 3000");
        for (class, flat, square, middle, run) in [
            (H, "0.02 0.05 0.1 0.2 0.3 0.4", "0.2 0.3 0.4 0.5", "0.5 0.5 0.5 0.5", 0.1),
            (K, "0.05 0.1 0.2 0.4 0.6 0.8", "0.4 0.6 0.8 1", "0.6 0.6 0.8 1", 0.2),
            (L, "0.1 0.2 0.4 0.8 1.2 1.6", "0.6 1 1.5 2", "0.6 1 1.5 2", 0.5),
        ] {
            check(faces, flat, 0.0, millimetres(|length| flatness(class, length)));
            check(legs, square, 0.0, millimetres(|length| perpendicularity(class, length)));
            check(legs, middle, 0.0, millimetres(|length| symmetry(class, length)));
            assert_eq!(run_out(class), run / 1e3);
        }
        assert_eq!((parallelism(0.2, 0.1), parallelism(0.1, 0.2)), (0.2, 0.2));
    }

    #[test]
    fn classes_of_a_drawing() {
        let general = |size, geometry| Ok(General { size, geometry });
        assert_eq!("mH".parse(), general(Some(Medium), Some(H)));
        assert_eq!("v".parse(), general(Some(VeryCoarse), None));
        assert_eq!("L".parse(), general(None, Some(L)));
        for wrong in ["", "Hm", "mm", "HK", "h", "M", "mH "] {
            assert_eq!(wrong.parse::<General>(), Err(()), "{wrong}");
        }
        let letters: String = [Fine, Medium, Coarse, VeryCoarse].map(SizeClass::letter).iter().collect();
        assert_eq!(letters + &[H, K, L].map(GeometryClass::letter).iter().collect::<String>(), "fmcvHKL");
    }
}
