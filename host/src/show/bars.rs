//! Named shares as bars, in blocks with a heading each. Blue and vermilion (Okabe and Ito) can be told apart by every eye.

use slipfit_tolerance::number::{fixed, typeset};

use super::{
    palette::{INK, NEGATIVE, POSITIVE},
    svg::{Anchor, Font, PLAIN, SUBTITLE, Stroke, Svg, TITLE, wrapped},
};

/// Height of a title with a subtitle of one line.
pub const HEAD: f64 = 66.0;
/// Height of a further line of the subtitle.
const LINE: f64 = 17.0;
/// About how wide (px) a character of the subtitle is.
const CHARACTER: f64 = 7.8;
/// The most characters of a name.
pub const NAME: usize = 34;
const ROW: f64 = 20.0;
/// Width (px) of the longest bar, and of the number behind it.
const BARS: f64 = 130.0;
const NUMBER: f64 = 64.0;
/// A picture of several blocks is no taller than this (px), so that a sheet of paper holds it in a size that can be read.
const TALL: f64 = 520.0;

/// A share of something, as a bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// Whose.
    pub name: String,
    /// Percent; correlated contributors can have less than nothing.
    pub percent: f64,
    /// Its standard error (percent), if it has one.
    pub error: Option<f64>,
}

/// Bars with a heading.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Heading.
    pub heading: String,
    /// Bars, in order; at least one.
    pub bars: Vec<Bar>,
}

impl Block {
    fn height(&self) -> f64 {
        ROW * (self.bars.len() as f64 + 1.5)
    }
}

/// `blocks` by pictures: as many as it takes for none to be too tall for a sheet of paper.
pub fn sheets(blocks: &[Block]) -> Vec<&[Block]> {
    let mut sheets = Vec::new();
    let mut rest = blocks;
    while !rest.is_empty() {
        let mut height = HEAD;
        let fits = |block: &&Block| {
            height += block.height();
            height <= TALL
        };
        let (sheet, next) = rest.split_at(rest.iter().take_while(fits).count().max(1));
        sheets.push(sheet);
        rest = next;
    }
    sheets
}

/// Bars of `blocks` as an SVG document without XML declaration.
pub fn bars(title: &str, subtitle: &str, blocks: &[Block]) -> String {
    let all = || blocks.iter().flat_map(|block| &block.bars);
    let left = longest(all().map(|bar| bar.name.as_str())).max(100.0) + 32.0;
    let low = all().map(|bar| bar.percent).fold(0.0, f64::min);
    let high = all().map(|bar| bar.percent + bar.error.unwrap_or(0.0)).fold(100.0, f64::max);
    let scale = BARS / (high - low);
    let width = left + BARS + NUMBER;
    let head = head(width, subtitle);
    let height: f64 = head + blocks.iter().map(Block::height).sum::<f64>();
    let mut svg = document([width, height], title, subtitle);
    let name = Font { most: NAME, anchor: Anchor::End, ..PLAIN };
    let (zero, mut y) = (left - scale * low, head);
    for block in blocks {
        svg.text([16.0, y + 10.0], &block.heading, Font { bold: true, most: NAME, ..PLAIN });
        y += ROW;
        for Bar { name: whose, percent, error } in &block.bars {
            svg.text([left - 10.0, y + 10.0], whose, name);
            let bar = [zero + scale * percent.min(0.0), y + 3.0, (scale * percent.abs()).max(0.5), ROW - 6.0];
            svg.rectangle(bar, if *percent < 0.0 { POSITIVE } else { NEGATIVE }, 1.0);
            let mut end = zero + scale * percent.max(0.0);
            if let Some(error) = error {
                let [from, to] = [(percent - error).max(low), percent + error].map(|percent| zero + scale * percent);
                svg.line(&[[from, y + 10.0], [to, y + 10.0]], Stroke::new(INK, 1.5));
                end = end.max(to);
            }
            svg.text([end + 6.0, y + 10.0], &format!("{} %", typeset(&fixed(*percent, 1))), PLAIN);
            y += ROW;
        }
        y += ROW / 2.0;
    }
    svg.finish()
}

/// An empty picture with its heading.
pub fn document([width, height]: [f64; 2], title: &str, subtitle: &str) -> Svg {
    let mut svg = Svg::new([width, height], &format!("{title}: {subtitle}"));
    svg.text([16.0, 26.0], title, Font { most: ((width - 32.0) / 10.2) as usize, ..TITLE });
    for (line, y) in broken(width, subtitle).iter().zip((0..).map(|k| 48.0 + LINE * f64::from(k))) {
        svg.text([16.0, y], line, SUBTITLE);
    }
    svg
}

/// Height of the title of a picture of this `width` (px).
fn head(width: f64, subtitle: &str) -> f64 {
    HEAD + LINE * (broken(width, subtitle).len() as f64 - 1.0).max(0.0)
}

/// The lines of a subtitle.
fn broken(width: f64, subtitle: &str) -> Vec<String> {
    wrapped(subtitle, ((width - 32.0) / CHARACTER) as usize)
}

/// About how wide the longest of some names is.
pub fn longest<'a>(names: impl Iterator<Item = &'a str>) -> f64 {
    names.map(|name| 7.2 * name.chars().count().min(NAME) as f64).fold(0.0, f64::max)
}
