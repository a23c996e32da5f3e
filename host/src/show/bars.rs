//! Named shares as bars, in blocks with a heading each. Blue and vermilion (Okabe and Ito) can be told apart by every eye.

use super::{
    number::{fixed, typeset},
    palette::{INK, NEGATIVE, POSITIVE},
    svg::{Anchor, Font, PLAIN, SUBTITLE, Stroke, Svg, TITLE},
};

/// Height of the title.
pub const HEAD: f64 = 66.0;
/// The most characters of a name.
pub const NAME: usize = 32;
const ROW: f64 = 20.0;
const BARS: f64 = 320.0;
/// Blocks taller than this stand in two columns, so that a sheet of paper holds them all in a size that can be read.
const TALL: f64 = 1000.0;

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

/// Bars of `blocks` as an SVG document without XML declaration.
pub fn bars(title: &str, subtitle: &str, blocks: &[Block]) -> String {
    let tall: f64 = blocks.iter().map(Block::height).sum();
    let columns = if tall > TALL { 2.0 } else { 1.0 };
    let all = || blocks.iter().flat_map(|block| &block.bars);
    let left = longest(all().map(|bar| bar.name.as_str())).max(100.0) + 32.0;
    let low = all().map(|bar| bar.percent).fold(0.0, f64::min);
    let high = all().map(|bar| bar.percent + bar.error.unwrap_or(0.0)).fold(100.0, f64::max);
    let width = BARS / columns;
    let (scale, pitch) = (width / (high - low), left + width + 80.0);
    let tallest = blocks.iter().map(Block::height).fold(0.0, f64::max);
    let height = HEAD + if columns > 1.0 { tall / columns + tallest } else { tall };
    let mut svg = document([columns * pitch, height], title, subtitle);
    let name = Font { most: NAME, anchor: Anchor::End, ..PLAIN };
    let (mut x, mut y) = (0.0, HEAD);
    for block in blocks {
        if y + block.height() > height {
            (x, y) = (x + pitch, HEAD);
        }
        svg.text([x + 16.0, y + 10.0], &block.heading, Font { bold: true, most: NAME, ..PLAIN });
        y += ROW;
        let zero = x + left - scale * low;
        for Bar { name: whose, percent, error } in &block.bars {
            svg.text([x + left - 10.0, y + 10.0], whose, name);
            let bar = [zero + scale * percent.min(0.0), y + 3.0, (scale * percent.abs()).max(0.5), ROW - 6.0];
            svg.rectangle(bar, if *percent < 0.0 { POSITIVE } else { NEGATIVE }, 1.0);
            let mut end = zero + scale * percent.max(0.0);
            if let Some(error) = error {
                let [from, to] = [percent - error, percent + error].map(|percent| zero + scale * percent);
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
    svg.text([16.0, 26.0], title, Font { most: ((width - 32.0) / 10.8) as usize, ..TITLE });
    svg.text([16.0, 48.0], subtitle, SUBTITLE);
    svg
}

/// About how wide the longest of some names is.
pub fn longest<'a>(names: impl Iterator<Item = &'a str>) -> f64 {
    names.map(|name| 6.8 * name.chars().count().min(NAME) as f64).fold(0.0, f64::max)
}
