//! Line charts as SVG; the only file that knows plotters.
//!
//! Its SVG backend has whole coordinates, so a chart is drawn a hundred times too large and shown at its size through
//! the view box: two decimals of a pixel. Lines are thinned to what can be seen, so that a page of charts stays small.

use std::ops::Range;

use plotters::{
    coord::{
        Shift,
        ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter},
    },
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

use crate::{
    layout::{Ticks, apart, chosen, thinned},
    markup::{escape, printable},
    number::{fixed, typeset},
};

pub use crate::chart::{Chart, Markers, Panel, Series, Shape};

/// Why a chart cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlotError {
    /// No point at all.
    #[error("nothing to plot")]
    Empty,
    /// A point that is not finite, or too large to find ticks for.
    #[error("cannot plot {0}: a value is not finite or too large")]
    NotFinite(String),
    /// The backend failed.
    #[error("cannot plot: {0}")]
    Backend(String),
}

/// The most lines drawn in full.
pub const LABELLED: usize = 9;
/// The most points of a line.
pub const POINTS: usize = 600;

/// Units of the drawing in one pixel.
const FINE: i32 = 100;
const SIZE: (i32, i32) = (900, 540);
/// Heading of the chart, heading of a panel, axis below, axis to the left.
const HEADING: i32 = 62;
const PANEL_HEADING: i32 = 30;
const BELOW: i32 = 28;
const LEFT: i32 = 58;
/// Right of the axes, with labels at the ends of lines and without.
const LABELS: i32 = 92;
const PLAIN: i32 = 24;
/// Distance of labels from each other.
const LABEL_PITCH: f64 = 15.0;
/// Deviation of a thinned line (pixels).
const INVISIBLE: f64 = 0.1;

const INK: RGBColor = RGBColor(34, 34, 34);
const SOFT: RGBColor = RGBColor(96, 96, 96);
const GUIDE: RGBColor = RGBColor(150, 150, 150);
const GRID: RGBColor = RGBColor(228, 228, 228);
const MARK: RGBColor = RGBColor(38, 84, 124);
const FONTS: &str = "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The chart as an SVG document, 900 × 540 pixels; the same bytes for the same chart.
///
/// # Errors
/// [`PlotError`], if there is nothing to plot or a value is not finite.
pub fn line_chart(chart: &Chart) -> Result<String, PlotError> {
    let finite = |panel: &Panel| panel.points().all(|(x, y)| x.is_finite() && y.is_finite());
    if let Some(panel) = chart.panels.iter().find(|panel| !finite(panel)) {
        return Err(PlotError::NotFinite(panel.y_label.clone()));
    }
    let x_axis = Axis::abscissa(chart)?;
    let y_axes =
        chart.panels.iter().map(|panel| Axis::ordinate(panel, chart.panels.len())).collect::<Result<Vec<_>, _>>()?;
    let labelled = chart.panels.iter().flat_map(|panel| &panel.series).any(|series| series.n.is_some());
    let right = SIZE.0 - if labelled { LABELS } else { PLAIN };
    let height = (SIZE.1 - HEADING - BELOW) / chart.panels.len() as i32;

    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (fine(SIZE.0), fine(SIZE.1))).into_drawing_area();
        root.fill(&WHITE).map_err(backend)?;
        write(&root, &shortened(&chart.title, 80), (16, 26), &bold(18))?;
        write(&root, &shortened(&chart.subtitle, 130), (16, 48), &text(13, &SOFT, HPos::Left))?;
        write(&root, &chart.x_label, ((LEFT + right) / 2, SIZE.1 - 14), &text(13, &INK, HPos::Center))?;
        for (i, (panel, y_axis)) in chart.panels.iter().zip(&y_axes).enumerate() {
            let top = HEADING + height * i as i32;
            write(&root, &panel.y_label, (16, top + 14), &text(13, &INK, HPos::Left))?;
            draw_legend(&root, &panel.markers, (right, top + 14))?;
            let area = root.clone().shrink((0, fine(top)), (fine(right), fine(height)));
            draw_panel(&root, &area, panel, &x_axis, y_axis)?;
        }
        root.present().map_err(backend)?;
    }
    Ok(finished(&svg, chart))
}

/// The backend's document at its size in pixels, with a title, and with what all texts and lines share said once.
fn finished(svg: &str, chart: &Chart) -> String {
    let body = svg.split_once('\n').map_or("", |(_, body)| body);
    let body = body.replace(" opacity=\"1\"", "").replace(" font-family=\"sans-serif\"", "").replace(" \"/>", "\"/>");
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
         font-family=\"{FONTS}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>{}: {}</title>\n{body}",
        SIZE.0,
        SIZE.1,
        fine(SIZE.0),
        fine(SIZE.1),
        escape(&chart.title),
        escape(&chart.subtitle),
    )
}

fn draw_panel(root: &Area, area: &Area, panel: &Panel, x: &Axis, y: &Axis) -> Result<(), PlotError> {
    let mut chart = ChartBuilder::on(area)
        .margin_top(fine(PANEL_HEADING))
        .x_label_area_size(fine(BELOW))
        .y_label_area_size(fine(LEFT))
        .build_cartesian_2d(x.clone(), y.clone())
        .map_err(backend)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID.stroke_width(fine(1)))
        .axis_style(SOFT.stroke_width(fine(1)))
        .label_style(text(12, &INK, HPos::Center))
        .set_all_tick_mark_size(fine(5))
        .draw()
        .map_err(backend)?;

    let plot = chart.plotting_area();
    let tolerance = INVISIBLE * (y.high - y.low) * f64::from(FINE) / f64::from(plot.dim_in_pixel().1);
    let line = |series: &Series, coarse: usize, style: ShapeStyle| {
        let points = thinned(&series.points, tolerance * coarse as f64, POINTS / coarse);
        plot.draw(&PathElement::new(points, style)).map_err(backend)
    };
    let levels: Vec<&Series> = panel.series.iter().filter(|series| series.n.is_some()).collect();
    let chosen = chosen(&levels.iter().filter_map(|series| series.n).collect::<Vec<_>>(), LABELLED);
    let colours = Colours::over(&levels);
    for guide in panel.series.iter().filter(|series| series.n.is_none()) {
        line(guide, 1, GUIDE.stroke_width(fine(1)))?;
    }
    for (_, series) in levels.iter().enumerate().filter(|(i, _)| !chosen.contains(i)) {
        line(series, 4, colours.of(series).mix(0.45).stroke_width(fine(1) * 6 / 10))?;
    }
    let mut ends = Vec::new();
    for series in chosen.iter().map(|i| levels[*i]) {
        line(series, 1, colours.of(series).stroke_width(fine(2) * 9 / 10))?;
        ends.extend(series.points.last().map(|end| (plot.map_coordinate(end), series)));
    }
    for markers in &panel.markers {
        for point in &markers.points {
            draw_mark(root, markers.shape, plot.map_coordinate(point))?;
        }
    }
    let (_, rows) = plot.get_pixel_range();
    draw_labels(root, ends, f64::from(rows.start) / f64::from(FINE)..f64::from(rows.end) / f64::from(FINE), &colours)
}

/// Labels beside the ends of lines, in their order and moved apart where they would touch.
fn draw_labels(
    root: &Area,
    mut ends: Vec<((i32, i32), &Series)>,
    rows: Range<f64>,
    colours: &Colours,
) -> Result<(), PlotError> {
    ends.sort_by_key(|((_, y), _)| *y);
    let wanted: Vec<f64> = ends.iter().map(|((_, y), _)| f64::from(*y) / f64::from(FINE)).collect();
    for (((x, y), series), row) in ends.into_iter().zip(apart(&wanted, LABEL_PITCH, rows)) {
        let row = (row * f64::from(FINE)) as i32;
        let right = root.dim_in_pixel().0 as i32 - px(LABELS);
        let leader = vec![(x, y), (right + px(4), y), (right + px(14), row), (right + px(20), row)];
        root.draw(&PathElement::new(leader, colours.of(series).stroke_width(fine(1)))).map_err(backend)?;
        let style = text(12, &INK, HPos::Left);
        root.draw(&Text::new(printable(&series.label), (right + px(24), row), style)).map_err(backend)?;
    }
    Ok(())
}

/// The legend of `markers` on one line that ends at `right`.
fn draw_legend(root: &Area, markers: &[Markers], (right, y): (i32, i32)) -> Result<(), PlotError> {
    let width = |label: &str| 28 + 7 * label.chars().count() as i32;
    let shown = || markers.iter().filter(|markers| !markers.points.is_empty() && !markers.label.is_empty());
    let mut x = right - shown().map(|markers| width(&markers.label)).sum::<i32>();
    for Markers { label, shape, .. } in shown() {
        draw_mark(root, *shape, (px(x + 8), px(y)))?;
        write(root, label, (x + 17, y), &text(12, &INK, HPos::Left))?;
        x += width(label);
    }
    Ok(())
}

fn draw_mark(root: &Area, shape: Shape, (x, y): (i32, i32)) -> Result<(), PlotError> {
    let (r, line) = (px(4), MARK.stroke_width(fine(1) * 3 / 2));
    match shape {
        Shape::Dot => root.draw(&Circle::new((x, y), r, MARK.filled())),
        Shape::Ring => root
            .draw(&Circle::new((x, y), r, WHITE.filled()))
            .and_then(|()| root.draw(&Circle::new((x, y), r - px(1) / 2, line))),
        Shape::Triangle => root.draw(&Polygon::new([(x - r, y + r), (x, y - r), (x + r, y + r)], MARK.filled())),
        Shape::Cross => root
            .draw(&PathElement::new([(x - r, y - r), (x + r, y + r)], line))
            .and_then(|()| root.draw(&PathElement::new([(x - r, y + r), (x + r, y - r)], line))),
    }
    .map_err(backend)
}

fn write(root: &Area, words: &str, (x, y): (i32, i32), style: &TextStyle<'_>) -> Result<(), PlotError> {
    root.draw(&Text::new(printable(words), (px(x), px(y)), style)).map_err(backend)
}

fn font(size: i32) -> FontDesc<'static> {
    // The backend divides by 1.24.
    ("sans-serif", f64::from(px(size)) * 1.24).into_font()
}

fn text(size: i32, colour: &'static RGBColor, h_pos: HPos) -> TextStyle<'static> {
    TextStyle::from(font(size)).color(colour).pos(Pos::new(h_pos, VPos::Center))
}

fn bold(size: i32) -> TextStyle<'static> {
    TextStyle::from(font(size).style(FontStyle::Bold)).color(&INK).pos(Pos::new(HPos::Left, VPos::Center))
}

fn px(pixels: i32) -> i32 {
    pixels * FINE
}

fn fine(pixels: i32) -> u32 {
    px(pixels).unsigned_abs()
}

fn backend(error: impl std::fmt::Display) -> PlotError {
    PlotError::Backend(error.to_string())
}

fn shortened(words: &str, most: usize) -> String {
    if words.chars().count() <= most {
        return words.to_owned();
    }
    words.chars().take(most - 1).chain(['…']).collect()
}

/// Viridis over the levels, without its light end.
struct Colours {
    low: f64,
    high: f64,
}

impl Colours {
    fn over(levels: &[&Series]) -> Self {
        let n = || levels.iter().filter_map(|series| series.n);
        Self { low: n().fold(f64::INFINITY, f64::min), high: n().fold(f64::NEG_INFINITY, f64::max) }
    }

    fn of(&self, series: &Series) -> RGBColor {
        let n = series.n.unwrap_or(self.low);
        let share = if self.high > self.low { (n - self.low) / (self.high - self.low) } else { 0.5 };
        ViridisRGB.get_color(0.8 * share)
    }
}

/// An axis from `low` to `high` with its ticks.
#[derive(Clone)]
struct Axis {
    low: f64,
    high: f64,
    ticks: Ticks,
}

impl Axis {
    /// From the first to the last abscissa, with room for markers.
    fn abscissa(chart: &Chart) -> Result<Self, PlotError> {
        let points = || chart.panels.iter().flat_map(Panel::points);
        let (low, high) = extent(points().map(|(x, _)| x)).ok_or(PlotError::Empty)?;
        let marked = chart.panels.iter().any(|panel| panel.markers.iter().any(|markers| !markers.points.is_empty()));
        let room = match high - low {
            0.0 => 0.5f64.max(0.05 * high.abs()),
            span if marked => 0.02 * span,
            _ => 0.0,
        };
        let (low, high) = (low - room, high + room);
        let ticks = Ticks::over(high - low, 10.0).ok_or_else(|| PlotError::NotFinite(chart.x_label.clone()))?;
        Ok(Self { low, high, ticks })
    }

    /// Around all values and zero, with a little room.
    fn ordinate(panel: &Panel, panels: usize) -> Result<Self, PlotError> {
        let error = || PlotError::NotFinite(panel.y_label.clone());
        let (low, high) = extent(panel.points().map(|(_, y)| y).chain([0.0])).ok_or_else(error)?;
        let high = if high > low { high } else { 1.0 };
        let ticks = Ticks::over(high - low, if panels > 1 { 4.0 } else { 8.0 }).ok_or_else(error)?;
        let room = 0.04 * (high - low);
        Ok(Self { low: if low < 0.0 { low - room } else { low }, high: high + room, ticks })
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        let share = (value - self.low) / (self.high - self.low);
        start + (share * f64::from(end - start)).round() as i32
    }

    fn key_points<H: KeyPointHint>(&self, _: H) -> Vec<f64> {
        self.ticks.within(self.low, self.high)
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        let wide = self.high.max(-self.low) >= 1e6 || self.ticks.decimals > 5;
        typeset(&if wide && *value == 0.0 {
            "0".to_owned()
        } else if wide {
            format!("{value:.1e}")
        } else {
            fixed(*value, self.ticks.decimals)
        })
    }
}

/// Least and greatest.
fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.map(|value| (value, value)).reduce(|(low, high), (value, _)| (low.min(value), high.max(value)))
}

#[cfg(test)]
mod tests {
    use super::{Chart, Markers, Panel, PlotError, Series, Shape, line_chart};

    fn chart(levels: &[f64], value: impl Fn(f64, f64) -> f64) -> Chart {
        let line = |n: &f64| Series {
            label: format!("n = {n}"),
            n: Some(*n),
            points: (0..=1500).map(|i| (f64::from(i), value(f64::from(i), *n))).collect(),
        };
        Chart {
            title: "<slide> & \"pins\"\u{7}".to_owned(),
            subtitle: "drawn & labelled".to_owned(),
            x_label: "time (ms)".to_owned(),
            panels: vec![Panel {
                y_label: "drive force (N)".to_owned(),
                series: levels.iter().map(line).collect(),
                markers: Vec::new(),
            }],
        }
    }

    /// The texts of the drawing, once it is well-formed, finite and the same again.
    fn texts(chart: &Chart) -> Vec<String> {
        let svg = line_chart(chart).unwrap();
        assert_eq!(svg, line_chart(chart).unwrap());
        assert!(!svg.contains("NaN") && !svg.contains("inf") && svg.len() < 400_000, "{} bytes", svg.len());
        let document = roxmltree::Document::parse(&svg).unwrap();
        for line in document.descendants().filter(|node| node.has_tag_name("polyline")) {
            let points: Vec<&str> = line.attribute("points").unwrap().split(' ').collect();
            assert!(points.len() <= super::POINTS);
            for (x, y) in points.iter().map(|point| point.split_once(',').unwrap()) {
                assert!((0..=90_000).contains(&x.parse::<i32>().unwrap()));
                assert!((0..=54_000).contains(&y.parse::<i32>().unwrap()));
            }
        }
        document
            .descendants()
            .filter(|node| node.is_text())
            .map(|node| node.text().unwrap().trim().to_owned())
            .collect()
    }

    #[test]
    fn labels_axes_and_ends() {
        let texts = texts(&chart(&[-1.0, 0.0, 2.5], |t, n| t * n / 1e3));
        for expected in [
            "<slide> & \"pins\"\u{fffd}",
            "time (ms)",
            "drive force (N)",
            "n = -1",
            "n = 0",
            "n = 2.5",
            "1400",
            "\u{2212}1",
        ] {
            assert!(texts.iter().any(|text| text == expected), "{expected} in {texts:?}");
        }
    }

    #[test]
    fn constant_single_and_many() {
        texts(&chart(&[0.0], |_, _| 0.0));
        texts(&chart(&[1.0, 2.0], |_, _| 3.0));
        let levels: Vec<f64> = (0..81).map(|i| f64::from(i - 20)).collect();
        let texts = texts(&chart(&levels, |t, n| libm::sin(t / 20.0) * n));
        assert_eq!(texts.iter().filter(|text| text.starts_with("n = ")).count(), 9);
    }

    #[test]
    fn large_and_small_numbers_fit_the_margin() {
        for (scale, label) in [(1e9, "8.0e8"), (1e-9, "8.0e\u{2212}10")] {
            assert!(texts(&chart(&[1.0], |t, _| t / 1500.0 * scale)).contains(&label.to_owned()));
        }
    }

    #[test]
    fn one_point() {
        let points = vec![(1.0, 2.0)];
        let markers = vec![Markers { label: "jammed".to_owned(), shape: Shape::Cross, points }];
        let mut chart = chart(&[], |_, _| 0.0);
        chart.panels[0].markers = markers;
        assert!(texts(&chart).contains(&"jammed".to_owned()));
    }

    #[test]
    fn refuses_what_it_cannot_draw() {
        assert_eq!(line_chart(&chart(&[], |_, _| 0.0)), Err(PlotError::Empty));
        assert_eq!(line_chart(&Chart::default()), Err(PlotError::Empty));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
            let chart = chart(&[1.0], |t, _| if t == 7.0 { bad } else { 0.0 });
            assert_eq!(line_chart(&chart), Err(PlotError::NotFinite("drive force (N)".to_owned())));
        }
    }
}
