//! Line charts as SVG; the only module that knows plotters.
//!
//! Its SVG backend has whole coordinates, so a chart is drawn a hundred times too large and shown at its size through
//! the view box: two decimals of a pixel. Lines are thinned to what can be seen, so that a page of charts stays small.

mod axis;

use std::ops::Range;

use plotters::{
    coord::{Shift, cartesian::Cartesian2d},
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

use axis::Axis;

use crate::{
    layout::{apart, chosen, thinned},
    markup::{escape, printable},
};

pub use crate::chart::{Chart, Look, Markers, Panel, Scale, Series, Shape};

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
const WIDTH: i32 = 900;
/// Height of a linear chart, and of a logarithmic one's panel.
const HEIGHT: i32 = 540;
const LOG_PANEL: i32 = 400;
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
const SHADE: RGBColor = RGBColor(236, 240, 245);
const MARK: RGBColor = RGBColor(38, 84, 124);
/// Kinds by their number (Okabe and Ito: told apart by every eye), with the shapes of their marks.
const KINDS: [(RGBColor, Shape); 8] = [
    (RGBColor(0, 114, 178), Shape::Dot),
    (RGBColor(213, 94, 0), Shape::Triangle),
    (RGBColor(0, 158, 115), Shape::Square),
    (RGBColor(204, 121, 167), Shape::Diamond),
    (RGBColor(230, 159, 0), Shape::Cross),
    (RGBColor(34, 34, 34), Shape::Ring),
    (RGBColor(86, 180, 233), Shape::Plus),
    (RGBColor(102, 51, 153), Shape::Star),
];
const FONTS: &str = "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Plot<'a> = DrawingArea<SVGBackend<'a>, Cartesian2d<Axis, Axis>>;

/// The chart as an SVG document, 900 pixels wide; the same bytes for the same chart.
///
/// # Errors
/// [`PlotError`], if there is nothing to plot or a value is not finite.
pub fn line_chart(chart: &Chart) -> Result<String, PlotError> {
    let place = |value: f64| chart.scale.place(value);
    let finite = |panel: &Panel| panel.points().all(|(x, y)| place(x).is_finite() && place(y).is_finite());
    if let Some(panel) = chart.panels.iter().find(|panel| !finite(panel)) {
        return Err(PlotError::NotFinite(panel.y_label.clone()));
    }
    let x_axis = Axis::abscissa(chart)?;
    let y_axes = chart.panels.iter().map(|panel| Axis::ordinate(chart, panel)).collect::<Result<Vec<_>, _>>()?;
    let right = WIDTH - chart.panels.iter().flat_map(|panel| &panel.series).map(label_room).fold(PLAIN, i32::max);
    let size = (WIDTH, total_height(chart));
    let height = (size.1 - HEADING - BELOW) / chart.panels.len() as i32;

    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (fine(size.0), fine(size.1))).into_drawing_area();
        root.fill(&WHITE).map_err(backend)?;
        write(&root, &shortened(&chart.title, 80), (16, 26), &bold(18))?;
        write(&root, &shortened(&chart.subtitle, 130), (16, 48), &text(13, &SOFT, HPos::Left))?;
        write(&root, &chart.x_label, ((LEFT + right) / 2, size.1 - 14), &text(13, &INK, HPos::Center))?;
        for (i, (panel, y_axis)) in chart.panels.iter().zip(&y_axes).enumerate() {
            let top = HEADING + height * i as i32;
            write(&root, &panel.y_label, (16, top + 14), &text(13, &INK, HPos::Left))?;
            write(&root, &panel.note, (right, top + 14), &text(12, &SOFT, HPos::Right))?;
            draw_legend(&root, &panel.markers, (right, top + 14))?;
            let area = root.clone().shrink((0, fine(top)), (fine(right), fine(height)));
            draw_panel(&root, &area, panel, &x_axis, y_axis)?;
        }
        root.present().map_err(backend)?;
    }
    Ok(finished(&svg, chart, size))
}

fn total_height(chart: &Chart) -> i32 {
    match chart.scale {
        Scale::Linear => HEIGHT,
        Scale::Log => HEADING + BELOW + LOG_PANEL * chart.panels.len() as i32,
    }
}

/// Pixels that the label of `series` needs to the right of the axes.
fn label_room(series: &Series) -> i32 {
    match series.look {
        Look::Guide | Look::Variant(_) => PLAIN,
        Look::Level(_) => LABELS,
        Look::Kind(_) => 32 + 7 * series.label.chars().count() as i32,
    }
}

/// The backend's document at its size in pixels, with a title, and with what all texts and lines share said once.
fn finished(svg: &str, chart: &Chart, (width, height): (i32, i32)) -> String {
    let body = svg.split_once('\n').map_or("", |(_, body)| body);
    let body = body.replace(" opacity=\"1\"", "").replace(" font-family=\"sans-serif\"", "").replace(" \"/>", "\"/>");
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
         font-family=\"{FONTS}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>{}: {}</title>\n{body}",
        width,
        height,
        fine(width),
        fine(height),
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
        let points = match x.scale {
            Scale::Linear => thinned(&series.points, tolerance * coarse as f64, POINTS / coarse),
            Scale::Log => series.points.clone(),
        };
        plot.draw(&PathElement::new(points, style)).map_err(backend)
    };
    if let (Some((first, _)), Some((last, _))) = (panel.shade.first(), panel.shade.last()) {
        let height = |share: f64| y.low + share * (y.high - y.low);
        let outline = panel.shade.iter().map(|(x, share)| (*x, height(*share)));
        let outline = std::iter::once((*first, y.low)).chain(outline).chain([(*last, y.low)]).collect::<Vec<_>>();
        plot.draw(&Polygon::new(outline, SHADE.filled())).map_err(backend)?;
    }
    let levels: Vec<&Series> = panel.series.iter().filter(|series| series.level().is_some()).collect();
    let chosen = chosen(&levels.iter().filter_map(|series| series.level()).collect::<Vec<_>>(), LABELLED);
    let colours = Colours::over(&levels);
    let mut ends = Vec::new();
    for series in &panel.series {
        match series.look {
            Look::Level(_) => {}
            Look::Guide => line(series, 1, GUIDE.stroke_width(fine(1)))?,
            Look::Variant(_) => {
                line(series, 1, colours.of(series).mix(0.55).stroke_width(fine(1) * 8 / 10))?;
                draw_marks(root, plot, series, 2)?;
            }
            Look::Kind(_) => {
                line(series, 1, colours.of(series).stroke_width(fine(2) * 9 / 10))?;
                draw_marks(root, plot, series, 4)?;
                ends.extend(series.points.last().map(|end| (plot.map_coordinate(end), series)));
            }
        }
    }
    for (_, series) in levels.iter().enumerate().filter(|(i, _)| !chosen.contains(i)) {
        line(series, 4, colours.of(series).mix(0.45).stroke_width(fine(1) * 6 / 10))?;
    }
    for series in chosen.iter().map(|i| levels[*i]) {
        line(series, 1, colours.of(series).stroke_width(fine(2) * 9 / 10))?;
        ends.extend(series.points.last().map(|end| (plot.map_coordinate(end), series)));
    }
    for markers in &panel.markers {
        for point in &markers.points {
            draw_mark(root, markers.shape, plot.map_coordinate(point), px(4), MARK)?;
        }
    }
    let (columns, rows) = plot.get_pixel_range();
    let rows = f64::from(rows.start) / f64::from(FINE)..f64::from(rows.end) / f64::from(FINE);
    draw_labels(root, ends, (columns.end, rows), &colours)
}

/// Labels beside the ends of lines, in their order and moved apart where they would touch.
fn draw_labels(
    root: &Area,
    mut ends: Vec<((i32, i32), &Series)>,
    (right, rows): (i32, Range<f64>),
    colours: &Colours,
) -> Result<(), PlotError> {
    ends.sort_by_key(|((_, y), _)| *y);
    let wanted: Vec<f64> = ends.iter().map(|((_, y), _)| f64::from(*y) / f64::from(FINE)).collect();
    for (((x, y), series), row) in ends.into_iter().zip(apart(&wanted, LABEL_PITCH, rows)) {
        let row = (row * f64::from(FINE)) as i32;
        let colour = colours.of(series);
        // The line may end far from the edge: what leads from there is not part of it.
        let across = vec![(x, y), (right + px(4), y)];
        root.draw(&PathElement::new(across, colour.mix(0.3).stroke_width(fine(1)))).map_err(backend)?;
        let leader = vec![(right + px(4), y), (right + px(14), row), (right + px(20), row)];
        root.draw(&PathElement::new(leader, colour.stroke_width(fine(1)))).map_err(backend)?;
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
        draw_mark(root, *shape, (px(x + 8), px(y)), px(4), MARK)?;
        write(root, label, (x + 17, y), &text(12, &INK, HPos::Left))?;
        x += width(label);
    }
    Ok(())
}

fn draw_marks(root: &Area, plot: &Plot<'_>, series: &Series, radius: i32) -> Result<(), PlotError> {
    if let Look::Kind(number) | Look::Variant(number) = series.look {
        let (colour, shape) = KINDS[number % KINDS.len()];
        for point in &series.points {
            draw_mark(root, shape, plot.map_coordinate(point), px(radius), colour)?;
        }
    }
    Ok(())
}

/// A mark within `r` around a point.
fn draw_mark(root: &Area, shape: Shape, (x, y): (i32, i32), r: i32, colour: RGBColor) -> Result<(), PlotError> {
    let (filled, line) = (colour.filled(), colour.stroke_width(fine(1) * 3 / 2));
    let stroke = |a: (i32, i32), b: (i32, i32)| root.draw(&PathElement::new([a, b], line));
    let cross = || stroke((x - r, y - r), (x + r, y + r)).and_then(|()| stroke((x - r, y + r), (x + r, y - r)));
    let plus = || stroke((x - r, y), (x + r, y)).and_then(|()| stroke((x, y - r), (x, y + r)));
    match shape {
        Shape::Dot => root.draw(&Circle::new((x, y), r, filled)),
        Shape::Ring => root
            .draw(&Circle::new((x, y), r, WHITE.filled()))
            .and_then(|()| root.draw(&Circle::new((x, y), r - px(1) / 2, line))),
        Shape::Triangle => root.draw(&Polygon::new([(x - r, y + r), (x, y - r), (x + r, y + r)], filled)),
        Shape::Square => {
            root.draw(&Polygon::new([(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)], filled))
        }
        Shape::Diamond => {
            let r = r * 5 / 4;
            root.draw(&Polygon::new([(x - r, y), (x, y - r), (x + r, y), (x, y + r)], filled))
        }
        Shape::Cross => cross(),
        Shape::Plus => plus(),
        Shape::Star => cross().and_then(|()| plus()),
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

/// Viridis over the levels, without its light end; kinds by their number.
struct Colours {
    low: f64,
    high: f64,
}

impl Colours {
    fn over(levels: &[&Series]) -> Self {
        let n = || levels.iter().filter_map(|series| series.level());
        Self { low: n().fold(f64::INFINITY, f64::min), high: n().fold(f64::NEG_INFINITY, f64::max) }
    }

    fn of(&self, series: &Series) -> RGBColor {
        let n = match series.look {
            Look::Level(n) => n,
            Look::Kind(number) | Look::Variant(number) => return KINDS[number % KINDS.len()].0,
            Look::Guide => return GUIDE,
        };
        let share = if self.high > self.low { (n - self.low) / (self.high - self.low) } else { 0.5 };
        ViridisRGB.get_color(0.8 * share)
    }
}

#[cfg(test)]
mod tests;
