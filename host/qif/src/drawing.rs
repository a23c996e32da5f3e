//! Features with tolerances, whatever file they come from. Lengths are in mm, places and directions in the frame of the part.

/// A part with its features, datums and tolerances.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Name of the part.
    pub name: String,
    /// Features in the order of the file.
    pub features: Vec<Feature>,
    /// Datums in the order of the file.
    pub datums: Vec<Datum>,
    /// Sizes and geometric tolerances in the order of the file, also those that are not understood.
    pub tolerances: Vec<Tolerance>,
    /// What else the user should know.
    pub remarks: Vec<String>,
}

/// A feature.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    /// Its id in the file.
    pub id: String,
    /// Its name in the file.
    pub name: String,
    /// Its kind in the words of the file.
    pub kind: String,
    /// Its shape, or why it has none here.
    pub shape: Result<Shape, String>,
}

/// A shape of a feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A flat face, or the middle plane between two of them.
    Plane(Plane),
    /// A full cylinder.
    Axis(Axis),
    /// A point on a face.
    Point(Point),
}

/// A flat face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Middle of the rectangle around the face (mm).
    pub at: [f64; 3],
    /// Unit normal, out of the material.
    pub normal: [f64; 3],
    /// Unit direction of the first extent.
    pub along: [f64; 3],
    /// Sides of the rectangle around the face (mm).
    pub extents: [f64; 2],
    /// Distance (mm) of the two faces in the middle of which the plane lies, which then is no face itself.
    pub width: Option<f64>,
}

/// A hole or a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Middle of the axis (mm).
    pub at: [f64; 3],
    /// Unit direction.
    pub along: [f64; 3],
    /// Length (mm).
    pub length: f64,
    /// Diameter of the model (mm).
    pub diameter: f64,
    /// Whether it is a hole, if that is known.
    pub is_hole: Option<bool>,
}

/// A point on a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Place (mm).
    pub at: [f64; 3],
    /// Unit normal of the face, out of the material.
    pub normal: [f64; 3],
}

/// A datum.
#[derive(Clone, Debug, PartialEq)]
pub struct Datum {
    /// Its id in the file.
    pub id: String,
    /// Its letter.
    pub label: String,
    /// Indices of its features.
    pub features: Vec<usize>,
    /// Number of its datum targets.
    pub targets: usize,
}

/// A size or a geometric tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    /// Its id in the file.
    pub id: String,
    /// Its name in the file.
    pub name: String,
    /// All of it in the words of the file.
    pub words: String,
    /// Indices of the features that it holds for.
    pub features: Vec<usize>,
    /// What it limits.
    pub limits: Limits,
}

/// What a tolerance limits.
#[derive(Clone, Debug, PartialEq)]
pub enum Limits {
    /// The diameter of a cylinder.
    Diameter(Size),
    /// A geometric tolerance.
    Geometric(Geometric),
    /// Something that is not understood, and why.
    NotRead(String),
    /// Nothing: a reference or basic dimension.
    Nothing(String),
}

/// A toleranced size.
#[derive(Clone, Debug, PartialEq)]
pub struct Size {
    /// Nominal size (mm); that of the feature where it is not stated.
    pub nominal: Option<f64>,
    /// Its limits.
    pub range: Range,
}

/// The limits of a size.
#[derive(Clone, Debug, PartialEq)]
pub enum Range {
    /// Lower and upper deviation from the nominal size (mm).
    Deviations([f64; 2]),
    /// Least and greatest size (mm).
    Sizes([f64; 2]),
    /// A class of ISO 286, such as `H7`.
    Class(String),
}

/// Which geometric tolerance (ISO 1101, ASME Y14.5).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say all")]
pub enum Control {
    Flatness,
    Straightness,
    Roundness,
    Cylindricity,
    Parallelism,
    Perpendicularity,
    Angularity,
    Position,
    Profile,
    Coaxiality,
    Concentricity,
    Symmetry,
    RunOut,
    TotalRunOut,
}

/// Condition of material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Material {
    /// Regardless of feature size.
    #[default]
    None,
    /// Maximum material, Ⓜ.
    Maximum,
    /// Least material, Ⓛ.
    Least,
}

/// Shape of a zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Zone {
    /// Not stated, or the only one that the tolerance can have.
    Natural,
    /// Between two planes with this normal, where that is stated.
    Slab(Option<[f64; 3]>),
    /// A cylinder.
    Cylinder,
    /// A sphere.
    Sphere,
}

/// A geometric tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometric {
    /// Which one.
    pub control: Control,
    /// Width or diameter of its zone (mm).
    pub width: f64,
    /// Shape of its zone.
    pub zone: Zone,
    /// Condition of material of the zone.
    pub material: Material,
    /// Its datums, the primary first.
    pub frame: Vec<Reference>,
    /// The lower segment of a composite position: its width (mm) and its datums.
    pub within: Option<(f64, Vec<Reference>)>,
}

/// A datum in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reference {
    /// Indices of the datums that are one datum together: one, or two of a common datum A-B.
    pub datums: Vec<usize>,
    /// Condition of material at which it is referenced.
    pub material: Material,
}
