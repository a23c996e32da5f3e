//! What a line chart shows.

/// Panels above each other over one abscissa.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Heading; long ones are cut.
    pub title: String,
    /// Smaller line below it.
    pub subtitle: String,
    /// Name and unit of the abscissa, as in `time (ms)`.
    pub x_label: String,
    /// From top to bottom, at least one.
    pub panels: Vec<Panel>,
}

/// One pair of axes. The ordinate always shows zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// Name and unit of the ordinate, as in `drive force (N)`.
    pub y_label: String,
    /// Lines.
    pub series: Vec<Series>,
    /// Points with a legend.
    pub markers: Vec<Markers>,
}

/// A line.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What stands at the line's end, if `n` is given.
    pub label: String,
    /// Tolerance level, which gives the colour. Of many such lines at most [`LABELLED`](crate::plot::LABELLED) are drawn in full, spread
    /// evenly, the first, the last and the one nearest zero among them; the others are faint. `None`: a grey guide.
    pub n: Option<f64>,
    /// The points, x ascending.
    pub points: Vec<(f64, f64)>,
}

/// Points of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Markers {
    /// Entry in the legend of the panel; none if empty.
    pub label: String,
    /// How they look.
    pub shape: Shape,
    /// Where they are. Without points there is no entry either.
    pub points: Vec<(f64, f64)>,
}

/// Shapes that differ without colour, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Filled disc.
    Dot,
    /// Open circle.
    Ring,
    /// Filled triangle.
    Triangle,
    /// Oblique cross.
    Cross,
}

impl Panel {
    /// Every point of its lines and markers.
    pub(crate) fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let lines = self.series.iter().flat_map(|series| &series.points);
        lines.chain(self.markers.iter().flat_map(|markers| &markers.points)).copied()
    }
}
