//! A small writer of SVG documents, in pixels.

use crate::xml::escape;
use std::{collections::BTreeMap, fmt::Write};

use super::palette::{Colour, INK, PAPER, SOFT};

const FONTS: &str = "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";

/// Width (px) of a picture: a phone of 400 px shows its texts of 13 px in 10 px.
pub const WIDTH: f64 = 456.0;

/// A picture under way.
pub struct Svg {
    head: String,
    text: String,
    /// Attributes and colours, for those who read in the dark.
    used: BTreeMap<(&'static str, &'static str), &'static str>,
}

/// The end of a text that stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its start.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// How a text looks.
#[derive(Clone, Copy)]
pub struct Font {
    /// Height (px).
    pub size: f64,
    /// Whether it is bold.
    pub bold: bool,
    /// Its colour.
    pub colour: Colour,
    /// What of it is at its place.
    pub anchor: Anchor,
    /// Turned about its place (°, clockwise).
    pub turned: f64,
    /// The most characters; a longer text is shortened and keeps its full form as a tooltip.
    pub most: usize,
}

/// Labels.
pub const PLAIN: Font =
    Font { size: 13.0, bold: false, colour: INK, anchor: Anchor::Start, turned: 0.0, most: usize::MAX };
/// A picture's title.
pub const TITLE: Font = Font { size: 17.0, bold: true, ..PLAIN };
/// Below the title.
pub const SUBTITLE: Font = Font { size: 13.0, colour: SOFT, ..PLAIN };

/// How a line looks.
#[derive(Clone, Copy)]
pub struct Stroke {
    /// Its colour.
    pub colour: Colour,
    /// Its width (px).
    pub width: f64,
    /// Between 0 and 1.
    pub opacity: f64,
    /// Lengths of dashes and gaps (px); empty for none.
    pub dash: &'static str,
}

impl Stroke {
    /// A plain line.
    pub fn new(colour: Colour, width: f64) -> Self {
        Self { colour, width, opacity: 1.0, dash: "" }
    }
}

impl Svg {
    /// An empty picture of this width and height (px) with a title for readers that do not see it.
    pub fn new([width, height]: [f64; 2], title: &str) -> Self {
        let head = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" style=\"--width: {width}px\" font-family=\"{FONTS}\" \
             stroke-linejoin=\"round\" stroke-linecap=\"butt\">\n<title>{}</title>\n",
            escape(title)
        );
        let mut svg = Self { head, text: String::new(), used: BTreeMap::new() };
        svg.rectangle([0.0, 0.0, width, height], PAPER, 1.0);
        svg
    }

    /// The class of what is filled with `colour`, and the attribute.
    fn filled(&mut self, colour: Colour) -> (String, String) {
        self.painted("fill", colour)
    }

    /// The class of what has an outline of `colour`, and the attribute.
    fn stroked(&mut self, colour: Colour) -> (String, String) {
        self.painted("stroke", colour)
    }

    fn painted(&mut self, attribute: &'static str, Colour { name, light, dark }: Colour) -> (String, String) {
        if light != dark {
            self.used.insert((attribute, name), dark);
        }
        (format!("{}-{name}", &attribute[..1]), format!(" {attribute}=\"{light}\""))
    }

    /// A filled rectangle: left, top, width, height.
    pub fn rectangle(&mut self, [x, y, width, height]: [f64; 4], colour: Colour, opacity: f64) {
        let [x, y, width, height] = [x, y, width, height].map(number);
        let (fill, opacity) = (self.filled(colour), shown("fill-opacity", opacity));
        let _ = writeln!(
            self.text,
            "<rect class=\"{}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"{}{opacity}/>",
            fill.0, fill.1
        );
    }

    /// A line through `points`.
    pub fn line(&mut self, points: &[[f64; 2]], stroke: Stroke) {
        let Stroke { colour, width, opacity, dash } = stroke;
        let (class, paint) = self.stroked(colour);
        let dash = if dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dash}\"") };
        let _ = writeln!(
            self.text,
            "<polyline class=\"{class}\" points=\"{}\" fill=\"none\"{paint} stroke-width=\"{width}\"{}{dash}/>",
            places(points),
            shown("stroke-opacity", opacity),
        );
    }

    /// A filled area within `points`.
    pub fn area(&mut self, points: &[[f64; 2]], colour: Colour) {
        let fill = self.filled(colour);
        let _ = writeln!(self.text, "<polygon class=\"{}\" points=\"{}\"{}/>", fill.0, places(points), fill.1);
    }

    /// A path, filled, stroked or both.
    pub fn path(&mut self, path: &str, inside: Option<Colour>, outline: Option<Stroke>) {
        let (mut classes, mut paint) = (Vec::new(), String::new());
        match inside {
            Some(colour) => {
                let (class, attribute) = self.filled(colour);
                classes.push(class);
                paint.push_str(&attribute);
            }
            None => paint.push_str(" fill=\"none\""),
        }
        if let Some(Stroke { colour, width, .. }) = outline {
            let (class, attribute) = self.stroked(colour);
            classes.push(class);
            let _ = write!(paint, "{attribute} stroke-width=\"{width}\"");
        }
        let _ = writeln!(self.text, "<path class=\"{}\" d=\"{path}\"{paint}/>", classes.join(" "));
    }

    /// A text, its middle at the height y.
    pub fn text(&mut self, [x, y]: [f64; 2], words: &str, font: Font) {
        let Font { size, bold, colour, anchor, turned, most } = font;
        let (class, fill) = self.filled(colour);
        // Half the height of capitals, as the middle of a text is not in every reader's reach.
        let baseline = number(y + if turned == 0.0 { 0.35 * size } else { 0.0 });
        let x = number(x);
        let mut attributes = match anchor {
            Anchor::Start => String::new(),
            Anchor::Middle => " text-anchor=\"middle\"".to_owned(),
            Anchor::End => " text-anchor=\"end\"".to_owned(),
        };
        if bold {
            attributes.push_str(" font-weight=\"bold\"");
        }
        if turned != 0.0 {
            let _ = write!(attributes, " transform=\"rotate({turned} {x} {baseline})\"");
        }
        let short = shortened(words, most);
        let full = if short == words { String::new() } else { format!("<title>{}</title>", escape(words)) };
        let _ = writeln!(
            self.text,
            "<text class=\"{class}\" x=\"{x}\" y=\"{baseline}\" font-size=\"{size}\"{fill}{attributes}>{full}{}</text>",
            escape(&short)
        );
    }

    /// The document, without an XML declaration. As a file of its own it is dark where its reader wants that; on a page these are
    /// the page's own colours.
    pub fn finish(self) -> String {
        let rule = |((attribute, name), dark): (&(&str, &str), &&str)| {
            format!(".{}-{name} {{ {attribute}: {dark}; }}", &attribute[..1])
        };
        let rules: Vec<String> = self.used.iter().map(rule).collect();
        let dark = format!("<style>@media screen and (prefers-color-scheme: dark) {{ {} }}</style>\n", rules.join(" "));
        format!("{}{dark}{}</svg>\n", self.head, self.text)
    }
}

/// The width (px) that a document of [`Svg`] states.
pub fn width(document: &str) -> Option<f64> {
    let (_, rest) = document.split_once(" width=\"")?;
    rest.split_once('"')?.0.parse().ok()
}

/// `words` with at most `most` characters, the middle left out: names differ at their ends.
pub fn shortened(words: &str, most: usize) -> String {
    let count = words.chars().count();
    if count <= most {
        return words.to_owned();
    }
    let kept = most.saturating_sub(1);
    let (head, tail) = (kept.div_ceil(2), kept / 2);
    words.chars().take(head).chain(['…']).chain(words.chars().skip(count - tail)).collect()
}

/// Lines of at most `most` characters, broken between words.
pub fn wrapped(words: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

fn shown(attribute: &str, opacity: f64) -> String {
    if opacity < 1.0 { format!(" {attribute}=\"{}\"", number(opacity)) } else { String::new() }
}

fn places(points: &[[f64; 2]]) -> String {
    let mut text = String::with_capacity(12 * points.len());
    for (i, [x, y]) in points.iter().enumerate() {
        let space = if i > 0 { " " } else { "" };
        let _ = write!(text, "{space}{},{}", number(*x), number(*y));
    }
    text
}

/// With at most two decimals.
pub fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{Font, PLAIN, Svg, shortened, width, wrapped};

    #[test]
    fn long_texts_keep_their_ends_and_their_full_form() {
        assert_eq!(shortened("left front rail", 9), "left…rail");
        assert_eq!((shortened("short", 5), shortened("short", 4)), ("short".to_owned(), "sh…t".to_owned()));
        let mut svg = Svg::new([100.0, 50.0], "a <picture>");
        svg.text([1.0, 2.0], "left & right", Font { most: 7, ..PLAIN });
        let svg = svg.finish();
        assert_eq!(width(&svg), Some(100.0));
        let document = roxmltree::Document::parse(&svg).unwrap();
        let text = document.descendants().find(|node| node.has_tag_name("text")).unwrap();
        let title = text.children().find(|node| node.has_tag_name("title")).unwrap();
        assert_eq!((title.text(), text.last_child().unwrap().text()), (Some("left & right"), Some("lef…ght")));
    }

    #[test]
    fn lines_break_between_words() {
        assert_eq!(wrapped("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrapped("unbreakable", 4), ["unbreakable"]);
        assert!(wrapped("", 4).is_empty());
    }
}
