//! The stability map as a picture: a strip a factor and scheme, a cell a value. Colours that the colour-blind can tell
//! apart (Okabe and Ito), and a letter in every cell that is not sound.

use std::fmt::Write;

use crate::{
    markup::escape,
    number::{fixed, typeset},
    stability::{FACTORS, Grade, Point, SCHEMES, tally},
};

const LEFT: f64 = 190.0;
const WIDTH: f64 = 900.0;
const TOP: f64 = 92.0;
const ROW: f64 = 13.0;
const LABELS: f64 = 15.0;
const GAP: f64 = 9.0;
const NAME: f64 = 96.0;

/// Colour, letter and meaning.
fn look(grade: Grade) -> (&'static str, &'static str, &'static str) {
    match grade {
        Grade::Sound => ("#9fd3f0", "", "right, no warning"),
        Grade::Cautious => ("#f0e442", "c", "right from 50 ms on, warns"),
        Grade::Warned => ("#e69f00", "w", "off by more than 5 %, warns"),
        Grade::Stopped => ("#999999", "x", "stopped: not finite"),
        Grade::Silent => ("#b02a00", "S", "off by more than 5 %, silent"),
    }
}

/// The map of `single`, with the tally of `random` below, as an SVG document.
pub fn stability_map(single: &[Point], random: &[Point], title: &str) -> String {
    let block = ROW * SCHEMES.len() as f64 + LABELS + GAP;
    let height = TOP + block * FACTORS.len() as f64 + if random.is_empty() { 10.0 } else { 64.0 };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{WIDTH}\" height=\"{height}\" \
         viewBox=\"0 0 {WIDTH} {height}\" font-family=\"system-ui, 'Segoe UI', Arial, 'Liberation Sans', sans-serif\" \
         font-size=\"11\" fill=\"#222\">\n<title>{0}: stability map</title>\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#fff\"/>\n\
         <text x=\"16\" y=\"26\" font-size=\"18\" font-weight=\"bold\">{0}</text>\n\
         <text x=\"16\" y=\"48\" font-size=\"13\" fill=\"#606060\">stability: one factor at a time, opening of 200 ms, \
         against a quarter of the step</text>\n",
        escape(title)
    );
    let mut x = 16.0;
    for grade in [Grade::Sound, Grade::Cautious, Grade::Warned, Grade::Stopped, Grade::Silent] {
        cell(&mut svg, [x, 62.0, 14.0], grade);
        text(&mut svg, [x + 19.0, 73.0], "start", look(grade).2);
        x += 34.0 + 5.7 * look(grade).2.len() as f64;
    }
    for (i, factor) in FACTORS.iter().enumerate() {
        let top = TOP + block * i as f64;
        text(&mut svg, [16.0, top + ROW * 0.8], "start", &typeset(factor.name));
        let values = factor.range.values();
        let pitch = (WIDTH - 16.0 - LEFT - NAME) / values.len() as f64;
        for (row, scheme) in SCHEMES.iter().enumerate() {
            let y = top + ROW * row as f64;
            text(&mut svg, [LEFT + NAME - 6.0, y + ROW * 0.8], "end", scheme.name());
            let found = single.iter().filter(|point| point.factor == factor.name && point.integrator == scheme.name());
            for (column, point) in found.enumerate() {
                cell(&mut svg, [LEFT + NAME + pitch * column as f64, y, pitch - 1.0], point.grade());
            }
        }
        for (column, value) in values.iter().enumerate() {
            let x = LEFT + NAME + pitch * (column as f64 + 0.5) - 0.5;
            text(&mut svg, [x, top + ROW * SCHEMES.len() as f64 + 11.0], "middle", &short(*value));
        }
    }
    if !random.is_empty() {
        let y = height - 44.0;
        text(&mut svg, [16.0, y - 6.0], "start", &format!("{} random combinations of all factors", random.len()));
        let mut x = 16.0;
        let mut few = Vec::new();
        for (grade, count) in tally(random) {
            let width = (WIDTH - 32.0) * count as f64 / random.len() as f64;
            if count > 0 {
                cell(&mut svg, [x, y, width], grade);
            }
            if width > 40.0 {
                text(&mut svg, [x + width / 2.0, y + 26.0], "middle", &count.to_string());
            } else if count > 0 {
                few.push(format!("{count} {}", look(grade).1));
            }
            x += width;
        }
        // Beside the heading, because there is no room below.
        text(&mut svg, [WIDTH - 16.0, y - 6.0], "end", &few.join(", "));
    }
    svg + "</svg>\n"
}

fn cell(svg: &mut String, [x, y, width]: [f64; 3], grade: Grade) {
    let (colour, letter, _) = look(grade);
    let height = ROW - 1.0;
    let _ =
        writeln!(svg, "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height}\" fill=\"{colour}\"/>");
    if !letter.is_empty() && width > 8.0 {
        let ink = if grade == Grade::Silent { "#fff" } else { "#222" };
        let (x, y) = (x + width / 2.0, y + 9.5);
        let _ = writeln!(
            svg,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" font-size=\"10\" fill=\"{ink}\">{letter}</text>"
        );
    }
}

fn text(svg: &mut String, [x, y]: [f64; 2], anchor: &str, words: &str) {
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>", escape(words));
}

/// Few digits: powers of ten as such, others with at most two decimals.
fn short(value: f64) -> String {
    let text = if value != 0.0 && !(0.01..1e5).contains(&value.abs()) {
        format!("{value:.0e}")
    } else {
        let decimals = if value.abs() >= 10.0 { 0 } else { 2 };
        let text = fixed(value, decimals);
        if decimals > 0 { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    };
    typeset(&text)
}
