//! Line charts as SVG. Lines are thinned to what can be seen, so that a page of charts stays small.

mod axis;
mod mark;

use axis::Axis;

use super::{
    layout::{apart, chosen, stacked, thinned},
    palette::{GRID, GUIDE, KINDS, LEVELS, MARK, SHADE, SOFT},
    svg::{Anchor, Font, PLAIN, SUBTITLE, Stroke, Svg, TITLE, WIDTH, wrapped},
};

pub use super::chart::{Chart, Look, Markers, Panel, PlotError, Scale, Series, Shape};

/// The most lines drawn in full.
pub const LABELLED: usize = LEVELS.len();
/// The most points of a line.
pub const POINTS: usize = 600;

/// Height (px) of a chart, and of one of several side by side.
const LARGE: f64 = 440.0;
const SMALL: f64 = 340.0;
/// Height of a logarithmic chart's panel.
const LOG_PANEL: f64 = 360.0;
/// Heading of the chart with one line below the title, one more such line, heading of a panel, axis below, axis to the left.
const HEADING: f64 = 62.0;
const LINE: f64 = 17.0;
const PANEL_HEADING: f64 = 30.0;
const BELOW: f64 = 28.0;
const LEFT: f64 = 62.0;
/// Right of the axes without labels at the ends of lines, and with them before their first character.
const BLANK: f64 = 24.0;
const LEADER: f64 = 37.0;
/// Least width of the axes: beside long labels the chart is wider than usual.
const ACROSS: f64 = 290.0;
/// About how wide a character is, of labels, of the subtitle, of the title.
const CHARACTER: [f64; 3] = [7.4, 6.7, 10.2];
/// Distance of labels from each other, and of the ends of lines below which these are as good as one.
const LABEL_PITCH: f64 = 16.0;
const NEAR: f64 = 4.0;
/// The most characters of a label.
const LABEL: usize = 24;
/// Deviation of a thinned line (pixels).
const INVISIBLE: f64 = 0.1;

/// Shapes of the marks of kinds by their number.
const SHAPES: [Shape; KINDS.len()] = [
    Shape::Dot,
    Shape::Triangle,
    Shape::Square,
    Shape::Diamond,
    Shape::Cross,
    Shape::Ring,
    Shape::Plus,
    Shape::Star,
    Shape::Wedge,
];
/// Lines of neighbouring levels differ in their dashes, as their colours are alike.
const DASHES: [&str; 4] = ["", "9 4", "2 3", "11 3 2 3"];

/// The chart as an SVG document of the usual width; the same bytes for the same chart.
///
/// # Errors
/// [`PlotError`], if there is nothing to plot or a value is not finite.
pub fn line_chart(chart: &Chart) -> Result<String, PlotError> {
    drawn(chart, LARGE)
}

/// The chart somewhat lower, for several side by side.
///
/// # Errors
/// [`PlotError`], if there is nothing to plot or a value is not finite.
pub fn small_chart(chart: &Chart) -> Result<String, PlotError> {
    drawn(chart, SMALL)
}

fn drawn(chart: &Chart, height: f64) -> Result<String, PlotError> {
    let place = |value: f64| chart.scale.place(value);
    let up = |value: f64| chart.scale.upwards().place(value);
    let finite = |panel: &Panel| panel.points().all(|(x, y)| place(x).is_finite() && up(y).is_finite());
    if let Some(panel) = chart.panels.iter().find(|panel| !finite(panel)) {
        return Err(PlotError::NotFinite(panel.y_label.clone()));
    }
    let room = chart.panels.iter().flat_map(|panel| &panel.series).map(label_room).fold(BLANK, f64::max);
    let width = (LEFT + ACROSS + room).ceil().max(WIDTH);
    let right = width - room;
    let x_axis = Axis::abscissa(chart, (width / 80.0).floor())?;
    let y_axes = chart.panels.iter().map(|panel| Axis::ordinate(chart, panel)).collect::<Result<Vec<_>, _>>()?;
    let characters = |width: f64, of: usize| (width / CHARACTER[of]) as usize;
    let below = wrapped(&chart.subtitle, characters(width - 32.0, 1));
    let heading = HEADING + LINE * below.len().saturating_sub(1) as f64;
    let panels = chart.panels.len() as f64;
    let height = match chart.scale {
        Scale::Linear | Scale::LogAcross => height + heading - HEADING,
        Scale::Log => heading + BELOW + LOG_PANEL * panels,
    };
    let pitch = (height - heading - BELOW) / panels;

    let mut svg = Svg::new([width, height], &format!("{}: {}", chart.title, chart.subtitle));
    svg.text([16.0, 26.0], &chart.title, Font { most: characters(width - 32.0, 2), ..TITLE });
    for (i, line) in below.iter().enumerate() {
        svg.text([16.0, 48.0 + LINE * i as f64], line, SUBTITLE);
    }
    let most = characters(right - LEFT, 1);
    // Below the middle of the axes, as far as the nearer edge of the picture.
    let middle = (LEFT + right) / 2.0;
    let label = Font { anchor: Anchor::Middle, most: characters(2.0 * middle.min(width - middle) - 32.0, 1), ..PLAIN };
    svg.text([middle, height - 14.0], &chart.x_label, label);
    for (i, (panel, y)) in chart.panels.iter().zip(y_axes).enumerate() {
        let top = heading + pitch * i as f64;
        svg.text([16.0, top + 14.0], &panel.y_label, Font { most, ..PLAIN });
        let soft = Font { colour: SOFT, ..PLAIN };
        // Beside the label if there is room, else below it.
        let beside = panel.y_label.chars().count() + panel.note.chars().count() + 4 <= most;
        let below = if beside { Vec::new() } else { wrapped(&panel.note, characters(width - 32.0, 1)) };
        if beside {
            svg.text([right, top + 14.0], &panel.note, Font { anchor: Anchor::End, ..soft });
        }
        for (line, text) in below.iter().enumerate() {
            svg.text([16.0, top + 14.0 + LINE * (line + 1) as f64], text, soft);
        }
        let from = 36.0 + CHARACTER[0] * panel.y_label.chars().count() as f64;
        legend(&mut svg, &panel.markers, [from, top + 14.0]);
        let rows = [top + PANEL_HEADING + LINE * below.len() as f64, top + pitch - BELOW];
        Plot { columns: [LEFT, right], rows, x: &x_axis, y: &y }.draw(&mut svg, panel);
    }
    Ok(svg.finish())
}

/// Pixels that the label of `series` needs to the right of the axes.
fn label_room(series: &Series) -> f64 {
    match series.look {
        Look::Guide | Look::Variant(_) => BLANK,
        Look::Level(_) | Look::Kind(_) if series.label.is_empty() => BLANK,
        Look::Level(_) | Look::Kind(_) => LEADER + CHARACTER[0] * series.label.chars().count().min(LABEL) as f64,
    }
}

/// A panel's axes and where they are.
struct Plot<'a> {
    columns: [f64; 2],
    /// Of the greatest ordinate, and of the least.
    rows: [f64; 2],
    x: &'a Axis,
    y: &'a Axis,
}

impl Plot<'_> {
    fn column(&self, x: f64) -> f64 {
        self.columns[0] + self.x.share(x) * (self.columns[1] - self.columns[0])
    }

    fn row(&self, y: f64) -> f64 {
        self.rows[1] - self.y.share(y) * (self.rows[1] - self.rows[0])
    }

    fn at(&self, points: &[(f64, f64)]) -> Vec<[f64; 2]> {
        points.iter().map(|(x, y)| [self.column(*x), self.row(*y)]).collect()
    }

    fn draw(&self, svg: &mut Svg, panel: &Panel) {
        self.shade(svg, &panel.shade);
        self.mesh(svg);
        let levels: Vec<&Series> = panel.series.iter().filter(|series| series.level().is_some()).collect();
        let chosen = chosen(&levels.iter().filter_map(|series| series.level()).collect::<Vec<_>>(), LABELLED);
        let mut ends = Vec::new();
        for series in &panel.series {
            match series.look {
                Look::Level(_) => {}
                Look::Guide => self.line(svg, series, Stroke::new(GUIDE, 1.0), 1),
                Look::Variant(number) => {
                    let stroke = Stroke::new(KINDS[number % KINDS.len()], 0.8);
                    self.line(svg, series, Stroke { opacity: 0.55, ..stroke }, 1);
                    self.marks(svg, series, number, 2.0);
                }
                Look::Kind(number) => {
                    let stroke = Stroke::new(KINDS[number % KINDS.len()], 1.8);
                    self.line(svg, series, stroke, 1);
                    self.marks(svg, series, number, 4.0);
                    ends.push((series, stroke));
                }
            }
        }
        for (i, series) in levels.iter().enumerate().filter(|(i, _)| !chosen.contains(i)) {
            let colour = LEVELS[i * (LEVELS.len() - 1) / (levels.len() - 1)];
            self.line(svg, series, Stroke { opacity: 0.45, ..Stroke::new(colour, 0.6) }, 4);
        }
        for (i, series) in chosen.iter().map(|i| levels[*i]).enumerate() {
            let last = chosen.len() - 1;
            let colour = LEVELS[(i * (LEVELS.len() - 1)).checked_div(last).unwrap_or(LEVELS.len() / 2)];
            let stroke = Stroke { dash: DASHES[i % DASHES.len()], ..Stroke::new(colour, 1.8) };
            self.line(svg, series, stroke, 1);
            ends.push((series, stroke));
        }
        for markers in &panel.markers {
            mark::draw(svg, markers.shape, &self.at(&markers.points), 4.0, MARK);
        }
        self.labels(svg, &ends);
    }

    /// Lines at the ticks, their labels, and the axes.
    fn mesh(&self, svg: &mut Svg) {
        let ([left, right], [top, bottom]) = (self.columns, self.rows);
        let (grid, axis) = (Stroke::new(GRID, 1.0), Stroke::new(SOFT, 1.0));
        for tick in self.x.ticks() {
            let x = self.column(tick);
            svg.line(&[[x, top], [x, bottom]], grid);
            svg.line(&[[x, bottom], [x, bottom + 5.0]], axis);
            svg.text([x, bottom + 13.0], &self.x.label(tick), Font { anchor: Anchor::Middle, ..PLAIN });
        }
        for tick in self.y.ticks() {
            let y = self.row(tick);
            svg.line(&[[left, y], [right, y]], grid);
            svg.line(&[[left - 5.0, y], [left, y]], axis);
            svg.text([left - 8.0, y], &self.y.label(tick), Font { anchor: Anchor::End, ..PLAIN });
        }
        svg.line(&[[left, top], [left, bottom], [right, bottom]], axis);
    }

    /// A distribution behind all else.
    fn shade(&self, svg: &mut Svg, shade: &[(f64, f64)]) {
        let (Some((first, _)), Some((last, _))) = (shade.first(), shade.last()) else { return };
        let [top, bottom] = self.rows;
        let outline = shade.iter().map(|(x, share)| [self.column(*x), bottom - share * (bottom - top)]);
        let [start, end] = [first, last].map(|x| [self.column(*x), bottom]);
        svg.area(&[start].into_iter().chain(outline).chain([end]).collect::<Vec<_>>(), SHADE);
    }

    /// The line of `series`, thinned as far as a line may be that is `coarse` times as rough.
    fn line(&self, svg: &mut Svg, series: &Series, stroke: Stroke, coarse: usize) {
        let points = match self.x.scale {
            Scale::Linear => {
                let pixel = (self.y.high - self.y.low) / (self.rows[1] - self.rows[0]);
                thinned(&series.points, INVISIBLE * pixel * coarse as f64, POINTS / coarse)
            }
            Scale::Log | Scale::LogAcross => series.points.clone(),
        };
        svg.line(&self.at(&points), stroke);
    }

    fn marks(&self, svg: &mut Svg, series: &Series, number: usize, radius: f64) {
        marks_of_kind(svg, number, &self.at(&series.points), radius);
    }

    /// Labels beside the ends of lines, in their order and moved apart where they would touch.
    fn labels(&self, svg: &mut Svg, ends: &[(&Series, Stroke)]) {
        let ends: Vec<([f64; 2], &Series, Stroke)> = ends
            .iter()
            .filter(|(series, _)| !series.label.is_empty())
            .filter_map(|(series, stroke)| Some((self.at(&[*series.points.last()?])[0], *series, *stroke)))
            .collect();
        let order = stacked(&ends.iter().map(|([_, y], ..)| *y).collect::<Vec<_>>(), NEAR);
        let wanted: Vec<f64> = order.iter().map(|i| ends[*i].0[1]).collect();
        let [top, bottom] = self.rows;
        let right = self.columns[1];
        for (i, row) in order.into_iter().zip(apart(&wanted, LABEL_PITCH, top..bottom)) {
            let ([x, y], series, stroke) = ends[i];
            // The line may end far from the edge: what leads from there is not part of it.
            svg.line(&[[x, y], [right + 4.0, y]], Stroke { opacity: 0.4, dash: "1 4", width: 1.0, ..stroke });
            svg.line(&[[right + 4.0, y], [right + 10.0, row]], Stroke { dash: "", width: 1.0, ..stroke });
            svg.line(&[[right + 10.0, row], [right + 26.0, row]], stroke);
            if let Look::Kind(number) = series.look {
                marks_of_kind(svg, number, &[[right + 18.0, row]], 4.0);
            }
            svg.text([right + 29.0, row], &series.label, Font { most: LABEL, ..PLAIN });
        }
    }
}

/// Marks of the kind of that `number`.
fn marks_of_kind(svg: &mut Svg, number: usize, points: &[[f64; 2]], radius: f64) {
    let kind = number % KINDS.len();
    mark::draw(svg, SHAPES[kind], points, radius, KINDS[kind]);
}

/// The legend of `markers` on one line from `x` on: beside the axis, where a phone that shows a part of the chart has it, too.
fn legend(svg: &mut Svg, markers: &[Markers], [mut x, y]: [f64; 2]) {
    for Markers { label, shape, .. } in markers.iter().filter(|one| !one.points.is_empty() && !one.label.is_empty()) {
        mark::draw(svg, *shape, &[[x + 8.0, y]], 4.0, MARK);
        svg.text([x + 17.0, y], label, PLAIN);
        x += 28.0 + CHARACTER[0] * label.chars().count() as f64;
    }
}

#[cfg(test)]
mod tests;
