//! ISO 286-1:2010, ISO 286-2:2010: tolerance classes of holes and shafts, such as H7 and g6, up to 500 mm. In µm and mm.

use std::str::FromStr;

/// Greatest size (mm) of each main range; the least is the greatest of the range before.
const MAIN: [f64; 13] = [3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0];
/// The same of the intermediate ranges of deviations that grow faster.
const INTERMEDIATE: [f64; 25] = [
    3.0, 6.0, 10.0, 14.0, 18.0, 24.0, 30.0, 40.0, 50.0, 65.0, 80.0, 100.0, 120.0, 140.0, 160.0, 180.0, 200.0, 225.0,
    250.0, 280.0, 315.0, 355.0, 400.0, 450.0, 500.0,
];

/// Standard tolerances IT1 to IT18 (µm), a row a grade.
const GRADES: [[f64; 13]; 18] = [
    [0.8, 1.0, 1.0, 1.2, 1.5, 1.5, 2.0, 2.5, 3.5, 4.5, 6.0, 7.0, 8.0],
    [1.2, 1.5, 1.5, 2.0, 2.5, 2.5, 3.0, 4.0, 5.0, 7.0, 8.0, 9.0, 10.0],
    [2.0, 2.5, 2.5, 3.0, 4.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 13.0, 15.0],
    [3.0, 4.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0],
    [4.0, 5.0, 6.0, 8.0, 9.0, 11.0, 13.0, 15.0, 18.0, 20.0, 23.0, 25.0, 27.0],
    [6.0, 8.0, 9.0, 11.0, 13.0, 16.0, 19.0, 22.0, 25.0, 29.0, 32.0, 36.0, 40.0],
    [10.0, 12.0, 15.0, 18.0, 21.0, 25.0, 30.0, 35.0, 40.0, 46.0, 52.0, 57.0, 63.0],
    [14.0, 18.0, 22.0, 27.0, 33.0, 39.0, 46.0, 54.0, 63.0, 72.0, 81.0, 89.0, 97.0],
    [25.0, 30.0, 36.0, 43.0, 52.0, 62.0, 74.0, 87.0, 100.0, 115.0, 130.0, 140.0, 155.0],
    [40.0, 48.0, 58.0, 70.0, 84.0, 100.0, 120.0, 140.0, 160.0, 185.0, 210.0, 230.0, 250.0],
    [60.0, 75.0, 90.0, 110.0, 130.0, 160.0, 190.0, 220.0, 250.0, 290.0, 320.0, 360.0, 400.0],
    [100.0, 120.0, 150.0, 180.0, 210.0, 250.0, 300.0, 350.0, 400.0, 460.0, 520.0, 570.0, 630.0],
    [140.0, 180.0, 220.0, 270.0, 330.0, 390.0, 460.0, 540.0, 630.0, 720.0, 810.0, 890.0, 970.0],
    [250.0, 300.0, 360.0, 430.0, 520.0, 620.0, 740.0, 870.0, 1000.0, 1150.0, 1300.0, 1400.0, 1550.0],
    [400.0, 480.0, 580.0, 700.0, 840.0, 1000.0, 1200.0, 1400.0, 1600.0, 1850.0, 2100.0, 2300.0, 2500.0],
    [600.0, 750.0, 900.0, 1100.0, 1300.0, 1600.0, 1900.0, 2200.0, 2500.0, 2900.0, 3200.0, 3600.0, 4000.0],
    [1000.0, 1200.0, 1500.0, 1800.0, 2100.0, 2500.0, 3000.0, 3500.0, 4000.0, 4600.0, 5200.0, 5700.0, 6300.0],
    [1400.0, 1800.0, 2200.0, 2700.0, 3300.0, 3900.0, 4600.0, 5400.0, 6300.0, 7200.0, 8100.0, 8900.0, 9700.0],
];

/// −es of shafts with a clearance by main ranges; the standard has the shorter rows up to 10 mm only.
const CLEARANCE: [(&str, &[f64]); 7] = [
    ("cd", &[34.0, 46.0, 56.0]),
    ("d", &[20.0, 30.0, 40.0, 50.0, 65.0, 80.0, 100.0, 120.0, 145.0, 170.0, 190.0, 210.0, 230.0]),
    ("e", &[14.0, 20.0, 25.0, 32.0, 40.0, 50.0, 60.0, 72.0, 85.0, 100.0, 110.0, 125.0, 135.0]),
    ("ef", &[10.0, 14.0, 18.0]),
    ("f", &[6.0, 10.0, 13.0, 16.0, 20.0, 25.0, 30.0, 36.0, 43.0, 50.0, 56.0, 62.0, 68.0]),
    ("fg", &[4.0, 6.0, 8.0]),
    ("g", &[2.0, 4.0, 5.0, 6.0, 7.0, 9.0, 10.0, 12.0, 14.0, 15.0, 17.0, 18.0, 20.0]),
];
/// The same by intermediate ranges.
const WIDE_CLEARANCE: [(&str, [f64; 25]); 3] = [
    (
        "a",
        [
            270.0, 270.0, 280.0, 290.0, 290.0, 300.0, 300.0, 310.0, 320.0, 340.0, 360.0, 380.0, 410.0, 460.0, 520.0,
            580.0, 660.0, 740.0, 820.0, 920.0, 1050.0, 1200.0, 1350.0, 1500.0, 1650.0,
        ],
    ),
    (
        "b",
        [
            140.0, 140.0, 150.0, 150.0, 150.0, 160.0, 160.0, 170.0, 180.0, 190.0, 200.0, 220.0, 240.0, 260.0, 280.0,
            310.0, 340.0, 380.0, 420.0, 480.0, 540.0, 600.0, 680.0, 760.0, 840.0,
        ],
    ),
    (
        "c",
        [
            60.0, 70.0, 80.0, 95.0, 95.0, 110.0, 110.0, 120.0, 130.0, 140.0, 150.0, 170.0, 180.0, 200.0, 210.0, 230.0,
            240.0, 260.0, 280.0, 300.0, 330.0, 360.0, 400.0, 440.0, 480.0,
        ],
    ),
];
/// ei of shafts by main ranges; that of k is for IT4 to IT7.
const TRANSITION: [(&str, [f64; 13]); 4] = [
    ("k", [0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0, 5.0]),
    ("m", [2.0, 4.0, 6.0, 7.0, 8.0, 9.0, 11.0, 13.0, 15.0, 17.0, 20.0, 21.0, 23.0]),
    ("n", [4.0, 8.0, 10.0, 12.0, 15.0, 17.0, 20.0, 23.0, 27.0, 31.0, 34.0, 37.0, 40.0]),
    ("p", [6.0, 12.0, 15.0, 18.0, 22.0, 26.0, 32.0, 37.0, 43.0, 50.0, 56.0, 62.0, 68.0]),
];
/// ei of shafts by intermediate ranges; 0 where the standard has none.
const INTERFERENCE: [(&str, [f64; 25]); 10] = [
    (
        "r",
        [
            10.0, 15.0, 19.0, 23.0, 23.0, 28.0, 28.0, 34.0, 34.0, 41.0, 43.0, 51.0, 54.0, 63.0, 65.0, 68.0, 77.0, 80.0,
            84.0, 94.0, 98.0, 108.0, 114.0, 126.0, 132.0,
        ],
    ),
    (
        "s",
        [
            14.0, 19.0, 23.0, 28.0, 28.0, 35.0, 35.0, 43.0, 43.0, 53.0, 59.0, 71.0, 79.0, 92.0, 100.0, 108.0, 122.0,
            130.0, 140.0, 158.0, 170.0, 190.0, 208.0, 232.0, 252.0,
        ],
    ),
    (
        "t",
        [
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 41.0, 48.0, 54.0, 66.0, 75.0, 91.0, 104.0, 122.0, 134.0, 146.0, 166.0, 180.0,
            196.0, 218.0, 240.0, 268.0, 294.0, 330.0, 360.0,
        ],
    ),
    (
        "u",
        [
            18.0, 23.0, 28.0, 33.0, 33.0, 41.0, 48.0, 60.0, 70.0, 87.0, 102.0, 124.0, 144.0, 170.0, 190.0, 210.0,
            236.0, 258.0, 284.0, 315.0, 350.0, 390.0, 435.0, 490.0, 540.0,
        ],
    ),
    (
        "v",
        [
            0.0, 0.0, 0.0, 0.0, 39.0, 47.0, 55.0, 68.0, 81.0, 102.0, 120.0, 146.0, 172.0, 202.0, 228.0, 252.0, 284.0,
            310.0, 340.0, 385.0, 425.0, 475.0, 530.0, 595.0, 660.0,
        ],
    ),
    (
        "x",
        [
            20.0, 28.0, 34.0, 40.0, 45.0, 54.0, 64.0, 80.0, 97.0, 122.0, 146.0, 178.0, 210.0, 248.0, 280.0, 310.0,
            350.0, 385.0, 425.0, 475.0, 525.0, 590.0, 660.0, 740.0, 820.0,
        ],
    ),
    (
        "y",
        [
            0.0, 0.0, 0.0, 0.0, 0.0, 63.0, 75.0, 94.0, 114.0, 144.0, 174.0, 214.0, 254.0, 300.0, 340.0, 380.0, 425.0,
            470.0, 520.0, 580.0, 650.0, 730.0, 820.0, 920.0, 1000.0,
        ],
    ),
    (
        "z",
        [
            26.0, 35.0, 42.0, 50.0, 60.0, 73.0, 88.0, 112.0, 136.0, 172.0, 210.0, 258.0, 310.0, 365.0, 415.0, 465.0,
            520.0, 575.0, 640.0, 710.0, 790.0, 900.0, 1000.0, 1100.0, 1250.0,
        ],
    ),
    (
        "za",
        [
            32.0, 42.0, 52.0, 64.0, 77.0, 98.0, 118.0, 148.0, 180.0, 226.0, 274.0, 335.0, 400.0, 470.0, 535.0, 600.0,
            670.0, 740.0, 820.0, 920.0, 1000.0, 1150.0, 1300.0, 1450.0, 1600.0,
        ],
    ),
    (
        "zb",
        [
            40.0, 50.0, 67.0, 90.0, 108.0, 136.0, 160.0, 200.0, 242.0, 300.0, 360.0, 445.0, 525.0, 620.0, 700.0, 780.0,
            880.0, 960.0, 1050.0, 1200.0, 1300.0, 1500.0, 1650.0, 1850.0, 2100.0,
        ],
    ),
];
const ZC: [f64; 25] = [
    60.0, 80.0, 97.0, 130.0, 150.0, 188.0, 218.0, 274.0, 325.0, 405.0, 480.0, 585.0, 690.0, 800.0, 900.0, 1000.0,
    1150.0, 1250.0, 1350.0, 1550.0, 1700.0, 1900.0, 2100.0, 2400.0, 2600.0,
];
/// ei of j5 and j6, of j7; ES of J6, J7, J8.
const J: [[f64; 13]; 2] = [
    [-2.0, -2.0, -2.0, -3.0, -4.0, -5.0, -7.0, -9.0, -11.0, -13.0, -16.0, -18.0, -20.0],
    [-4.0, -4.0, -5.0, -6.0, -8.0, -10.0, -12.0, -15.0, -18.0, -21.0, -26.0, -28.0, -32.0],
];
const J_HOLES: [[f64; 13]; 3] = [
    [2.0, 5.0, 5.0, 6.0, 8.0, 10.0, 13.0, 16.0, 18.0, 22.0, 25.0, 29.0, 33.0],
    [4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 18.0, 22.0, 26.0, 30.0, 36.0, 39.0, 43.0],
    [6.0, 10.0, 12.0, 15.0, 20.0, 24.0, 28.0, 34.0, 41.0, 47.0, 55.0, 60.0, 66.0],
];

/// The standard tolerance (µm) of a grade, 1 to 18, for a size (mm) above 0 up to 500.
pub fn standard_tolerance(size: f64, grade: usize) -> Option<f64> {
    let range = MAIN.iter().position(|greatest| size <= *greatest).filter(|_| size > 0.0)?;
    Some(GRADES.get(grade.checked_sub(1)?)?[range])
}

/// A tolerance class: a fundamental deviation with a standard tolerance grade.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Class {
    /// In small letters.
    deviation: String,
    hole: bool,
    grade: usize,
}

/// What every tolerance class looks like, for messages.
pub const ALLOWED: &str = "ISO 286 classes, such as H7 or g6: a to zc with IT1 to IT18, up to 500 mm";

/// Why a class gives no limits.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ClassError {
    /// Not from the standard's ranges.
    #[error("ISO 286 classes are for sizes above 0 up to 500 mm, not {0} mm")]
    Size(f64),
    /// The standard has no such deviation there.
    #[error("ISO 286-2 has no class {class} for {size} mm")]
    None {
        /// The class as written.
        class: String,
        /// The size (mm).
        size: f64,
    },
}

impl FromStr for Class {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let digits = text.find(|c: char| c.is_ascii_digit()).ok_or(())?;
        let (letters, grade) = text.split_at(digits);
        let hole = letters.chars().all(|c| c.is_ascii_uppercase());
        let deviation = letters.to_ascii_lowercase();
        let known = deviation == "h"
            || deviation == "j"
            || deviation == "js"
            || deviation == "zc"
            || CLEARANCE.iter().any(|(known, _)| *known == deviation)
            || WIDE_CLEARANCE.iter().chain(&INTERFERENCE).any(|(known, _)| *known == deviation)
            || TRANSITION.iter().any(|(known, _)| *known == deviation);
        let grade = grade
            .parse()
            .ok()
            .filter(|grade| (1..=GRADES.len()).contains(grade) && grade.to_string() == text[digits..]);
        match grade {
            Some(grade) if known && (hole || letters == deviation) => Ok(Self { deviation, hole, grade }),
            _ => Err(()),
        }
    }
}

impl Class {
    /// Lower and upper deviation (mm) of a `size` (mm).
    ///
    /// # Errors
    /// [`ClassError`], if the standard has none.
    pub fn deviations(&self, size: f64) -> Result<[f64; 2], ClassError> {
        let range = |ends: &[f64]| ends.iter().position(|end| size <= *end).filter(|_| size > 0.0);
        let (main, fine) = range(&MAIN).zip(range(&INTERMEDIATE)).ok_or(ClassError::Size(size))?;
        let width = GRADES[self.grade - 1][main];
        let lower = self.lower(size, main, fine, width).ok_or_else(|| ClassError::None { class: self.name(), size })?;
        Ok([lower, lower + width].map(|micrometres| micrometres / 1e3))
    }

    /// Whether it is a hole's: capital letters.
    pub fn is_hole(&self) -> bool {
        self.hole
    }

    /// As the drawing has it.
    pub fn name(&self) -> String {
        let letters = if self.hole { self.deviation.to_ascii_uppercase() } else { self.deviation.clone() };
        format!("{letters}{}", self.grade)
    }

    /// The lower deviation (µm).
    fn lower(&self, size: f64, main: usize, fine: usize, width: f64) -> Option<f64> {
        let (letters, grade) = (self.deviation.as_str(), self.grade);
        // Neither the coarse grades nor the largest clearances are for the smallest sizes.
        if size <= 1.0 && (grade >= 14 || matches!(letters, "a" | "b")) {
            return None;
        }
        if letters == "js" {
            return Some(-width / 2.0);
        }
        if letters == "j" {
            return if self.hole {
                Some(J_HOLES[grade.checked_sub(6).filter(|row| *row < 3)?][main] - width)
            } else {
                let row = match grade {
                    5 | 6 => 0,
                    7 => 1,
                    _ => return None,
                };
                Some(J[row][main])
            };
        }
        if let Some(clearance) = clearance(letters, main, fine) {
            return clearance.map(|clearance| if self.hole { clearance } else { -clearance - width });
        }
        let deviation = interference(letters, main, fine)?;
        if !self.hole {
            let is_k = letters == "k";
            return Some(if is_k && !(4..=7).contains(&grade) { 0.0 } else { deviation });
        }
        // A hole of a fine grade gives up less, so that its fit is that of the shaft a grade finer.
        let finer = |grade: usize| GRADES[grade - 1][main] - GRADES[grade - 2][main];
        let delta = |last: usize| if size > 3.0 && (3..=last).contains(&grade) { finer(grade) } else { 0.0 };
        let upper = match letters {
            "k" if grade > 8 => (size <= 3.0).then_some(0.0)?,
            "n" if grade > 8 && size > 3.0 => 0.0,
            // The one exception of the standard.
            "m" if grade == 6 && main == 10 => -9.0,
            "k" | "m" | "n" => delta(8) - deviation,
            _ => delta(7) - deviation,
        };
        Some(upper - width)
    }
}

/// −es of a shaft; `None` for no clearance at all, none within for one that the standard does not have there.
fn clearance(letters: &str, main: usize, fine: usize) -> Option<Option<f64>> {
    if letters == "h" {
        return Some(Some(0.0));
    }
    let of_main = CLEARANCE.iter().find(|(known, _)| *known == letters).map(|(_, row)| row.get(main).copied());
    of_main.or_else(|| WIDE_CLEARANCE.iter().find(|(known, _)| *known == letters).map(|(_, row)| Some(row[fine])))
}

/// ei of a shaft from k on.
fn interference(letters: &str, main: usize, fine: usize) -> Option<f64> {
    if let Some((_, row)) = TRANSITION.iter().find(|(known, _)| *known == letters) {
        return Some(row[main]);
    }
    let row = INTERFERENCE.iter().find(|(known, _)| *known == letters).map_or(&ZC, |(_, row)| row);
    Some(row[fine]).filter(|deviation| *deviation > 0.0)
}

#[cfg(test)]
mod tests {
    use super::{Class, ClassError, GRADES, INTERFERENCE, WIDE_CLEARANCE};

    fn limits(class: &str, size: f64) -> [f64; 2] {
        let class: Class = class.parse().unwrap();
        class.deviations(size).unwrap().map(|mm| (mm * 1e4).round() / 10.0)
    }

    /// Lower and upper deviations (µm) as tables of ISO 286-2 print them.
    #[test]
    fn published_limits() {
        for (class, size, expected) in [
            ("H7", 10.0, [0.0, 15.0]),
            ("g6", 10.0, [-14.0, -5.0]),
            ("H8", 50.0, [0.0, 39.0]),
            ("f7", 50.0, [-50.0, -25.0]),
            ("h6", 30.0, [-13.0, 0.0]),
            ("H11", 100.0, [0.0, 220.0]),
            ("c11", 100.0, [-390.0, -170.0]),
            ("d9", 40.0, [-142.0, -80.0]),
            ("e8", 3.0, [-28.0, -14.0]),
            ("k6", 25.0, [2.0, 15.0]),
            ("k8", 25.0, [0.0, 33.0]),
            ("m6", 60.0, [11.0, 30.0]),
            ("n6", 60.0, [20.0, 39.0]),
            ("p6", 25.0, [22.0, 35.0]),
            ("r6", 70.0, [43.0, 62.0]),
            ("s6", 25.0, [35.0, 48.0]),
            ("t6", 45.0, [54.0, 70.0]),
            ("u6", 25.0, [48.0, 61.0]),
            ("x6", 16.0, [45.0, 56.0]),
            ("zc8", 100.0, [585.0, 639.0]),
            ("js6", 25.0, [-6.5, 6.5]),
            ("JS9", 25.0, [-26.0, 26.0]),
            ("j6", 25.0, [-4.0, 9.0]),
            ("J7", 25.0, [-9.0, 12.0]),
            ("K7", 25.0, [-15.0, 6.0]),
            ("M7", 25.0, [-21.0, 0.0]),
            ("N7", 25.0, [-28.0, -7.0]),
            ("N9", 25.0, [-52.0, 0.0]),
            ("P7", 25.0, [-35.0, -14.0]),
            ("R7", 25.0, [-41.0, -20.0]),
            ("S7", 25.0, [-48.0, -27.0]),
            ("P9", 25.0, [-74.0, -22.0]),
            ("P7", 2.0, [-16.0, -6.0]),
            ("M6", 300.0, [-41.0, -9.0]),
            ("F8", 18.0, [16.0, 43.0]),
            ("G7", 500.0, [20.0, 83.0]),
            ("A11", 475.0, [1650.0, 2050.0]),
        ] {
            assert_eq!(limits(class, size), expected, "{size} {class}");
        }
    }

    #[test]
    fn what_the_standard_does_not_have_is_refused() {
        for text in ["", "7", "H", "H0", "H19", "H07", "Hg7", "hG7", "q6", "IT7", "i6", "o7", "w6", "H7.5"] {
            assert!(text.parse::<Class>().is_err(), "{text}");
        }
        let refused = |class: &str, size: f64| class.parse::<Class>().unwrap().deviations(size).unwrap_err();
        assert_eq!(refused("H7", 500.1), ClassError::Size(500.1));
        assert_eq!(refused("H7", 0.0), ClassError::Size(0.0));
        for (class, size) in
            [("t6", 20.0), ("v6", 12.0), ("y6", 10.0), ("cd7", 20.0), ("j8", 20.0), ("K9", 20.0), ("a11", 1.0)]
        {
            assert!(matches!(refused(class, size), ClassError::None { .. }), "{class} {size}");
        }
    }

    /// Misprints show as steps back: every row grows with the size, every grade and letter is wider than the one before.
    #[test]
    fn tables_grow() {
        for grades in GRADES.windows(2) {
            assert!(grades[0].is_sorted() && grades[0].iter().zip(&grades[1]).all(|(fine, coarse)| fine < coarse));
        }
        // From IT6 on, five grades are a factor of ten.
        for (fine, coarse) in GRADES[5..13].iter().zip(&GRADES[10..18]) {
            assert!(
                fine.iter().zip(coarse).all(|(fine, coarse)| (coarse / fine / 10.0 - 1.0).abs() < 0.07),
                "{fine:?}"
            );
        }
        for (letters, row) in WIDE_CLEARANCE.iter().chain(&INTERFERENCE) {
            assert!(row.is_sorted(), "{letters}");
        }
        for letters in INTERFERENCE.windows(2) {
            let pairs = letters[0].1.iter().zip(&letters[1].1);
            assert!(pairs.filter(|(_, next)| **next > 0.0).all(|(one, next)| one < next), "{}", letters[1].0);
        }
    }
}
