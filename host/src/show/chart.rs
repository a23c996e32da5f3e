//! What a line chart shows.

/// How numbers become places along the axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// In proportion; the ordinate always shows zero.
    #[default]
    Linear,
    /// By powers of ten, for positive numbers.
    Log,
    /// The abscissa by powers of ten, the ordinate in proportion.
    LogAcross,
}

impl Scale {
    /// That of the ordinate.
    pub(crate) fn upwards(self) -> Self {
        if self == Self::LogAcross { Self::Linear } else { self }
    }

    /// Where `value` stands on the abscissa; not finite for what the scale cannot show.
    pub(crate) fn place(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Log | Self::LogAcross => libm::log10(value),
        }
    }
}

/// Panels above each other over one abscissa.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Heading; long ones are cut.
    pub title: String,
    /// Smaller line below it.
    pub subtitle: String,
    /// Name and unit of the abscissa, as in `time (ms)`.
    pub x_label: String,
    /// Of all axes.
    pub scale: Scale,
    /// From top to bottom, at least one.
    pub panels: Vec<Panel>,
}

/// One pair of axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// Name and unit of the ordinate, as in `drive force (N)`.
    pub y_label: String,
    /// A remark at the right of the heading, where there is no legend.
    pub note: String,
    /// Lines.
    pub series: Vec<Series>,
    /// Points with a legend.
    pub markers: Vec<Markers>,
    /// A distribution behind all else: places along the abscissa, ascending, and heights between 0 and 1 of the panel.
    pub shade: Vec<(f64, f64)>,
}

/// A line.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What stands at the line's end; a guide has none.
    pub label: String,
    /// How it looks.
    pub look: Look,
    /// The points, x ascending.
    pub points: Vec<(f64, f64)>,
}

/// How a line looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Look {
    /// Grey, without a label.
    Guide,
    /// By tolerance level, which gives the colour. Of many such lines at most [`LABELLED`](super::plot::LABELLED) are
    /// drawn in full, spread evenly, the first, the last and the one nearest zero among them; the others are faint.
    Level(f64),
    /// One of several kinds, by its number: a colour, and a shape that marks every point.
    Kind(usize),
    /// Belongs to the kind of that number: the same but thin, and without a label.
    Variant(usize),
}

impl Series {
    /// The tolerance level that gives the colour.
    pub(crate) fn level(&self) -> Option<f64> {
        match self.look {
            Look::Level(n) => Some(n),
            _ => None,
        }
    }
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
    /// Filled triangle on its corner.
    Wedge,
    /// Oblique cross.
    Cross,
    /// Filled square.
    Square,
    /// Filled square on its corner.
    Diamond,
    /// Upright cross.
    Plus,
    /// Both crosses.
    Star,
}

impl Panel {
    /// Every point of its lines and markers.
    pub(crate) fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let lines = self.series.iter().flat_map(|series| &series.points);
        lines.chain(self.markers.iter().flat_map(|markers| &markers.points)).copied()
    }
}

/// The outline of a histogram: `classes` of one `width`, ascending and side by side, each with its left end and its height.
pub(crate) fn outline(classes: impl Iterator<Item = (f64, f64)>, width: f64) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for (left, height) in classes {
        if points.is_empty() {
            points.push((left, 0.0));
        }
        points.extend([(left, height), (left + width, height)]);
    }
    points.extend(points.last().map(|(right, _)| (*right, 0.0)));
    points
}

/// Why a chart cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlotError {
    /// No point at all.
    #[error("nothing to plot")]
    Empty,
    /// A point that is not finite, or too large to find ticks for.
    #[error("cannot plot {0}: a value is not finite or too large")]
    NotFinite(String),
}
