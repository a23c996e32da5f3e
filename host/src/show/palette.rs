//! The colours of pictures, each with a form for dark pages.
//!
//! A picture names every colour twice: by an attribute, which a file on its own shows, and by a class. A style sheet wins over
//! attributes, so that the classes of [`style_sheet`] give the same picture the colours of the page it stands on.

use std::fmt::Write;

/// A colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour {
    /// Its name in classes and variables.
    pub name: &'static str,
    /// On white.
    pub light: &'static str,
    /// On a dark page.
    pub dark: &'static str,
}

const fn colour(name: &'static str, light: &'static str, dark: &'static str) -> Colour {
    Colour { name, light, dark }
}

/// What a picture is drawn on.
pub const PAPER: Colour = colour("paper", "#ffffff", "#15181c");
/// Text.
pub const INK: Colour = colour("ink", "#222222", "#e6e6e6");
/// Secondary text, axes.
pub const SOFT: Colour = colour("soft", "#606060", "#a8adb4");
/// Lines without a label.
pub const GUIDE: Colour = colour("guide", "#969696", "#7d848c");
/// Lines of a grid.
pub const GRID: Colour = colour("grid", "#e4e4e4", "#2d3238");
/// A distribution behind all else.
pub const SHADE: Colour = colour("shade", "#ecf0f5", "#222b35");
/// Marks of verdicts.
pub const MARK: Colour = colour("mark", "#26547c", "#8fc1ea");
/// Negative numbers.
pub const NEGATIVE: Colour = colour("negative", "#0072b2", "#56b4e9");
/// Text on the full colour of negative numbers.
pub const ON_NEGATIVE: Colour = colour("on-negative", "#ffffff", "#10141a");
/// Positive numbers.
pub const POSITIVE: Colour = colour("positive", "#d55e00", "#f0803c");
/// Text on the full colour of positive numbers.
pub const ON_POSITIVE: Colour = colour("on-positive", "#000000", "#10141a");

/// Kinds by their number (Okabe and Ito's, an indigo and a dark red: told apart by every eye).
pub const KINDS: [Colour; 9] = [
    colour("kind-0", "#0072b2", "#4aa3df"),
    colour("kind-1", "#d55e00", "#f0803c"),
    colour("kind-2", "#009e73", "#2bc79a"),
    colour("kind-3", "#cc79a7", "#e39ac4"),
    colour("kind-4", "#e69f00", "#e69f00"),
    colour("kind-5", "#222222", "#e6e6e6"),
    colour("kind-6", "#56b4e9", "#8fd0f5"),
    colour("kind-7", "#332288", "#7766ee"),
    colour("kind-8", "#b0002a", "#d03050"),
];

/// Tolerance levels from low to high: viridis without the end that the paper swallows.
pub const LEVELS: [Colour; 9] = [
    colour("level-0", "#440154", "#2c738e"),
    colour("level-1", "#482072", "#25868d"),
    colour("level-2", "#423e83", "#219989"),
    colour("level-3", "#39578b", "#26ab82"),
    colour("level-4", "#2e6e8e", "#41bd72"),
    colour("level-5", "#26848d", "#68cb5b"),
    colour("level-6", "#219a89", "#98d73e"),
    colour("level-7", "#2caf7e", "#cbe126"),
    colour("level-8", "#4fc36a", "#fde725"),
];

fn all() -> impl Iterator<Item = Colour> {
    let single = [PAPER, INK, SOFT, GUIDE, GRID, SHADE, MARK, NEGATIVE, ON_NEGATIVE, POSITIVE, ON_POSITIVE].into_iter();
    single.chain(KINDS).chain(LEVELS)
}

/// The style sheet of a page with pictures: a variable for every colour, dark where the reader wants it and not on paper, and
/// the classes that use them.
pub fn style_sheet() -> String {
    let variables = |of: fn(Colour) -> &'static str| {
        all().map(|colour| format!("--{}: {};", colour.name, of(colour))).collect::<Vec<_>>().join(" ")
    };
    let mut sheet = format!(
        ":root {{ {} }}\n@media screen and (prefers-color-scheme: dark) {{ :root {{ {} }} }}\n",
        variables(|colour| colour.light),
        variables(|colour| colour.dark)
    );
    for Colour { name, .. } in all() {
        let _ = writeln!(sheet, ".f-{name} {{ fill: var(--{name}); }} .s-{name} {{ stroke: var(--{name}); }}");
    }
    sheet
}

#[cfg(test)]
pub(crate) mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::{Colour, INK, KINDS, LEVELS, MARK, NEGATIVE, ON_NEGATIVE, ON_POSITIVE, PAPER, POSITIVE, SOFT};

    /// Red, green and blue by their light, 0 to 1.
    fn linear(colour: &str) -> Vector3<f64> {
        Vector3::new(1, 3, 5).map(|i: usize| {
            let c = f64::from(u8::from_str_radix(&colour[i..i + 2], 16).unwrap()) / 255.0;
            if c <= 0.040_45 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
        })
    }

    /// Relative luminance (WCAG 2).
    fn luminance(colour: &str) -> f64 {
        Vector3::new(0.2126, 0.7152, 0.0722).dot(&linear(colour))
    }

    /// What eyes make of linear red, green and blue: all cones, no long-wave ones, no medium-wave ones (Machado, Oliveira and
    /// Fernandes 2009, table 1, severity 1).
    #[rustfmt::skip]
    const EYES: [Matrix3<f64>; 3] = [
        Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        Matrix3::new(0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998),
        Matrix3::new(0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881),
    ];

    /// CIE L*a*b* of a `colour` as an eye sees it, D65.
    fn lab(colour: &str, eye: &Matrix3<f64>) -> Vector3<f64> {
        let to_xyz = Matrix3::new(0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505);
        let xyz = to_xyz * (eye * linear(colour)).map(|c| c.clamp(0.0, 1.0));
        let f = |t: f64| if t > 216.0 / 24389.0 { libm::cbrt(t) } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
        let [x, y, z] = [f(xyz.x / 0.95047), f(xyz.y), f(xyz.z / 1.08883)];
        Vector3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
    }

    /// All `colours` differ by at least 14 (CIE 1976), six times what is just noticeable, for every kind of eye.
    pub(crate) fn told_apart(colours: &[&str]) {
        for eye in &EYES {
            for (i, one) in colours.iter().enumerate() {
                for other in &colours[..i] {
                    let difference = (lab(one, eye) - lab(other, eye)).norm();
                    assert!(difference >= 14.0, "{one} and {other}: {difference}");
                }
            }
        }
    }

    #[test]
    fn kinds_and_signs_are_told_apart_by_every_eye() {
        told_apart(&KINDS.map(|colour| colour.light));
        told_apart(&KINDS.map(|colour| colour.dark));
        told_apart(&[NEGATIVE.light, POSITIVE.light]);
        told_apart(&[NEGATIVE.dark, POSITIVE.dark]);
    }

    fn contrast(one: &str, other: &str) -> f64 {
        let [one, other] = [one, other].map(|colour| luminance(colour) + 0.05);
        one.max(other) / one.min(other)
    }

    /// Contrast at least `least` on white and on a dark page.
    fn legible(colour: Colour, on: Colour, least: f64) {
        for [colour, on] in [[colour.light, on.light], [colour.dark, on.dark]] {
            assert!(contrast(colour, on) >= least, "{colour} on {on}: {}", contrast(colour, on));
        }
    }

    #[test]
    fn text_and_lines_stand_out() {
        for (text, on) in [(INK, PAPER), (SOFT, PAPER), (ON_NEGATIVE, NEGATIVE), (ON_POSITIVE, POSITIVE)] {
            legible(text, on, 4.5);
        }
        legible(MARK, PAPER, 4.5);
        LEVELS.into_iter().chain(KINDS).for_each(|line| legible(line, PAPER, 2.0));
    }

    #[test]
    fn levels_grow_lighter_so_that_grey_prints_keep_their_order() {
        for of in [|colour: &Colour| colour.light, |colour: &Colour| colour.dark] {
            assert!(LEVELS.iter().map(of).map(luminance).is_sorted());
        }
    }
}
