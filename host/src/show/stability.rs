//! The stability map as a picture: a strip a factor and scheme, a cell a value. Colours that the colour-blind can tell
//! apart (Okabe and Ito), and a letter in every cell that is not sound.

use slipfit_tolerance::number::typeset;

use crate::quality::stability::{FACTORS, Grade, Point, SCHEMES, tally};
use crate::show::{
    palette::Colour,
    svg::{Anchor, Font, PLAIN, SUBTITLE, Svg, TITLE},
};

/// Width (px) of the map: a strip has up to forty cells.
const WIDTH: f64 = 560.0;
/// Left end of the cells.
const LEFT: f64 = 112.0;
const ROW: f64 = 16.0;
/// Height of a strip's name and of the labels below it.
const HEADING: f64 = 20.0;
const LABELS: f64 = 18.0;
const GAP: f64 = 8.0;
/// Least distance of labels from each other.
const LABEL_PITCH: f64 = 46.0;

/// A colour that is the same on white and on dark pages.
const fn fixed(name: &'static str, shade: &'static str) -> Colour {
    Colour { name, light: shade, dark: shade }
}

/// Letters, on light cells and on dark ones.
const DARK: Colour = fixed("dark-letter", "#222222");
const WHITE: Colour = fixed("white-letter", "#ffffff");

/// Colour, letter and meaning.
fn look(grade: Grade) -> (Colour, &'static str, &'static str) {
    match grade {
        Grade::Sound => (fixed("sound", "#9fd3f0"), "", "right, no warning"),
        Grade::Cautious => (fixed("cautious", "#f0e442"), "c", "right from 50 ms on, warns"),
        Grade::Warned => (fixed("warned", "#e69f00"), "w", "off by more than 5 %, warns"),
        Grade::Stopped => (fixed("stopped", "#999999"), "x", "stopped: not finite"),
        Grade::Silent => (fixed("silent", "#b02a00"), "S", "off by more than 5 %, silent"),
    }
}

/// The map of `single`, with the tally of `random` below, as an SVG document.
pub fn stability_map(single: &[Point], random: &[Point], title: &str) -> String {
    let block = HEADING + ROW * SCHEMES.len() as f64 + LABELS + GAP;
    let grades = [Grade::Sound, Grade::Cautious, Grade::Warned, Grade::Stopped, Grade::Silent];
    let top = 64.0 + ROW * grades.len() as f64 + 10.0;
    let height = top + block * FACTORS.len() as f64 + if random.is_empty() { 6.0 } else { 74.0 };
    let mut svg = Svg::new([WIDTH, height], &format!("{title}: stability map"));
    svg.text([16.0, 26.0], title, Font { most: 50, ..TITLE });
    let what = "stability: one factor at a time, opening of 200 ms, against a quarter of the step";
    svg.text([16.0, 48.0], what, SUBTITLE);
    let (middle, end) = (Font { anchor: Anchor::Middle, ..PLAIN }, Font { anchor: Anchor::End, ..PLAIN });
    for (i, grade) in grades.into_iter().enumerate() {
        let y = 64.0 + ROW * i as f64;
        cell(&mut svg, [16.0, y, 16.0], grade);
        svg.text([40.0, y + 0.5 * ROW], look(grade).2, PLAIN);
    }
    for (i, factor) in FACTORS.iter().enumerate() {
        let heading = top + block * i as f64;
        svg.text([16.0, heading + 0.5 * HEADING], &typeset(factor.name), Font { bold: true, ..PLAIN });
        let values = factor.range.values();
        let pitch = (WIDTH - 16.0 - LEFT) / values.len() as f64;
        let first = heading + HEADING;
        for (row, scheme) in SCHEMES.iter().enumerate() {
            let y = first + ROW * row as f64;
            svg.text([LEFT - 6.0, y + 0.5 * ROW], scheme.name(), end);
            let found = single.iter().filter(|point| point.factor == factor.name && point.integrator == scheme.name());
            for (column, point) in found.enumerate() {
                cell(&mut svg, [LEFT + pitch * column as f64, y, pitch - 1.0], point.grade());
            }
        }
        let every = (LABEL_PITCH / pitch).ceil() as usize;
        for (column, value) in values.iter().enumerate().step_by(every) {
            let x = LEFT + pitch * (column as f64 + 0.5) - 0.5;
            let below = first + ROW * SCHEMES.len() as f64 + 0.5 * LABELS;
            svg.text([x, below], &typeset(&(factor.label)(*value)), middle);
        }
    }
    if !random.is_empty() {
        let y = height - 46.0;
        svg.text([16.0, y - 14.0], &format!("{} random combinations of all factors", random.len()), PLAIN);
        let mut x = 16.0;
        let mut few = Vec::new();
        for (grade, count) in tally(random) {
            let width = (WIDTH - 32.0) * count as f64 / random.len() as f64;
            if count > 0 {
                cell(&mut svg, [x, y, width], grade);
            }
            if width > 40.0 {
                svg.text([x + width / 2.0, y + ROW + 9.0], &count.to_string(), middle);
            } else if count > 0 {
                few.push(format!("{count} {}", look(grade).1));
            }
            x += width;
        }
        // Beside the heading, because there is no room below.
        svg.text([WIDTH - 16.0, y - 14.0], &few.join(", "), end);
    }
    svg.finish()
}

fn cell(svg: &mut Svg, [x, y, width]: [f64; 3], grade: Grade) {
    let (colour, letter, _) = look(grade);
    svg.rectangle([x, y, width, ROW - 1.0], colour, 1.0);
    if !letter.is_empty() && width > 8.0 {
        let colour = if grade == Grade::Silent { WHITE } else { DARK };
        let font = Font { colour, anchor: Anchor::Middle, ..PLAIN };
        svg.text([x + width / 2.0, y + 0.5 * (ROW - 1.0)], letter, font);
    }
}

#[cfg(test)]
mod tests {
    use super::{Grade, look};
    use crate::show::palette::tests::told_apart;

    #[test]
    fn grades_are_told_apart_by_every_eye() {
        let grades = [Grade::Sound, Grade::Cautious, Grade::Warned, Grade::Stopped, Grade::Silent];
        told_apart(&grades.map(|grade| look(grade).0.light));
    }
}
