//! What the keys of products mean.

/// Keys of products and of what varies, and their meaning.
pub const PRODUCT: &[(&str, &str)] = &[
    (
        "tolerance.general",
        "General tolerances for what states none: a class of ISO 2768-1 for sizes, a class of ISO 2768-2 for geometry, or \
         both. Default: none, so that every dimension has to state its tolerance.",
    ),
    (
        "tolerance.rule",
        "How features vary in their tolerance zones. `sigma-zone`: place and tilts are normal, with a sixth of the zone as \
         standard deviation at a face's corner, and some features lie outside. `truncated`: the same without those outside. \
         `uniform-in-zone`: every place in the zone is equally probable. `translation`: faces shift and do not tilt. Default: \
         `sigma-zone`.",
    ),
    ("tolerance.sigma", "How many standard deviations half the tolerance of a size is. Default: 3."),
    (
        "tolerance.datums",
        "How a frame of several datums turns where a secondary or tertiary datum does not fit it in place and direction. \
         `least-squares`: by a fit of both. `iso-5459`: the secondary datum by its orientation, the tertiary one by its \
         location alone. Default: `least-squares`.",
    ),
    (
        "tolerance.correlation",
        "Whether the coefficients of `[[correlation]]` are of values or of ranks. Default: `pearson`.",
    ),
    (
        "dimension.name",
        "Name, by which expressions call the dimension. A name with blanks stands in single quotes there.",
    ),
    (
        "part.*.offset.value",
        "Nominal size: of an offset the distance along the normal, of a diameter the diameter. `at` is where the feature lies at this size. Default for an offset: 0, so that `tolerance` is a deviation from `at`.",
    ),
    ("*.value", "Nominal value. Its unit follows from `quantity`."),
    ("dimension.quantity", "Kind of number. Default: what the unit of `value` says; a length if `value` has no unit."),
    (
        "dimension.tolerance",
        "Limits around `value`, as ± or as [lower, upper] deviations, or a class. H7 takes its size from `value`. Default: \
         the class in `tolerance.general`. Not needed by distributions with a width of their own.",
    ),
    (
        "part.*.offset.tolerance",
        "Limits around the nominal size, as ± or as [lower, upper] deviations. Beside a `value` also a class: f, m, c, v of \
         ISO 2768-1, or of ISO 286, such as \"H7\". Default, where there is a `value`: the class in `tolerance.general`.",
    ),
    (
        "dimension.sigma",
        "How many standard deviations half the tolerance is, with `normal`, `truncated-normal` or `skewed`. Default: \
         `tolerance.sigma`.",
    ),
    (
        "part.*.offset.sigma",
        "How many standard deviations half the tolerance is, with `normal`, `truncated-normal` or `skewed`. Default: \
         `tolerance.sigma`.",
    ),
    (
        "dimension.distribution",
        "How the number varies: a name, or a table with the name as its `kind`. Default: `normal`.",
    ),
    (
        "part.*.offset.distribution",
        "How the size varies: a name, or a table with the name as its `kind`. Default: `normal`.",
    ),
    (
        "dimension.side",
        "Of an angle: length of its shorter side, by which ISO 2768-1 tolerates it. Required where a class of ISO 2768-1 tolerates an angle, else an error.",
    ),
    (
        "dimension.edge",
        "`broken` marks an external radius or a chamfer, for which ISO 2768-1 has a table of its own. Only where a class of ISO 2768-1 tolerates a length. Default: an ordinary length.",
    ),
    (
        "part.*.offset.edge",
        "`broken` marks an external radius or a chamfer, for which ISO 2768-1 has a table of its own. Only where a class of ISO 2768-1 tolerates a length. Default: an ordinary length.",
    ),
    (
        "dimension.cost",
        "Cost of the tolerance, for `slipfit allocate`: one process, or a list of processes to choose from. Default: the tolerance stays as it is.",
    ),
    (
        "part.*.*.cost",
        "Cost of the tolerance, for `slipfit allocate`: one process, or a list of processes to choose from. Default: the tolerance stays as it is.",
    ),
    ("*.distribution.of.distribution.kind", "Which distribution; a component cannot be a mixture itself."),
    ("*.distribution.kind", "Which distribution: see [distributions](#distributions)."),
    (
        "*.distribution.mode",
        "Of `triangular` and the two Gumbel distributions: most probable deviation from `value`. Default: the middle of the limits for `triangular`, else 0.",
    ),
    ("*.distribution.shoulders", "Of `trapezoidal`: the two deviations between which the density is constant."),
    ("*.distribution.skewness", "Of `skewed`: skewness, not 0."),
    ("*.distribution.deviations", "Of `table`: measured deviations from `value`, in ascending order."),
    ("*.distribution.shape", "Of `weibull`: shape parameter; 1 is exponential, 2 is Rayleigh's."),
    (
        "*.distribution.shapes",
        "Of `beta`: a and b of the density u^(a−1)·(1−u)^(b−1), where u runs from 0 at the lower limit to 1 at the upper one.",
    ),
    ("*.distribution.scale", "Of `weibull` and the two Gumbel distributions: scale parameter."),
    ("*.distribution.location", "Of `lognormal` and `weibull`: least deviation from `value`. Default: 0."),
    (
        "*.distribution.mean",
        "Of `normal`, `truncated-normal`, `skewed` and `lognormal`: deviation of the mean from `value`. Required by \
         `lognormal`. Default: the middle of the limits.",
    ),
    (
        "*.distribution.shift",
        "Of `normal`, `truncated-normal` and `skewed`, instead of `mean`: deviation of the mean from the middle of the \
         limits. Default: 0.",
    ),
    (
        "*.distribution.deviation",
        "Of `normal`, `truncated-normal`, `skewed` and `lognormal`: standard deviation. Required by `lognormal`. Default: what \
         `sigma` says.",
    ),
    (
        "*.distribution.cpk",
        "Of `normal`, `truncated-normal` and `skewed`, instead of `deviation`: Cpk of the process, the distance of the mean \
         from the nearer limit over three standard deviations. Default: what `sigma` says.",
    ),
    ("*.distribution.of", "Of `mixture`: its components, such as two machines that make the same part."),
    ("*.distribution.of.weight", "Share of the component, relative to the weights of the others. Default: 1."),
    ("*.distribution.of.tolerance", "Limits of the component's deviation."),
    (
        "*.distribution.of.sigma",
        "How many standard deviations half the tolerance is; 1 or more of a normal distribution. Default: `tolerance.sigma`.",
    ),
    (
        "*.distribution.of.distribution",
        "How the component varies: a name, or a table with the name as its `kind`. Default: `normal`.",
    ),
    ("*.distribution.of.distribution.*", "As in [`dimension.distribution`](#dimensiondistribution)."),
    ("*.cost.name", "Name of the process, for the output. Default: none."),
    ("*.cost.fixed", "Cost that does not depend on the tolerance. Default: 0."),
    (
        "*.cost.reciprocal",
        "B of the cost `fixed` + B·(`at`/t)^`power`. t is half the distance of the limits, or the width of a zone. Each \
         process has `reciprocal`, `exponential`, or `fixed` alone: a price for any tolerance that it holds.",
    ),
    ("*.cost.exponential", "B of the cost `fixed` + B·exp(−t/`at`), with t as for `reciprocal`."),
    (
        "*.cost.at",
        "Reference tolerance in the cost, more than 0. Default: 1 in the first unit of the quantity, such as 1 mm or 1°.",
    ),
    ("*.cost.power", "Exponent of the reciprocal cost. Default: 1."),
    (
        "*.cost.range",
        "Tightest and widest tolerance t that the process holds. Each process has either `range` or `grades`.",
    ),
    (
        "*.cost.step",
        "Increment, more than 0: only tolerances at whole steps from the tightest one can be chosen. Default: any tolerance in the range.",
    ),
    (
        "*.cost.grades",
        "Finest and coarsest grade of ISO 286 that the process holds, such as [6, 11], instead of a range.",
    ),
    ("part.name", "Name of the part. Its features are called PART.FEATURE elsewhere."),
    ("part.at", "Origin of the part's own frame, in the frame of the product. Default: the origin."),
    ("part.turned", "Rotation of the part's own frame: three Euler angles, about z, x and z. Default: none."),
    ("part.plane", "A list of flat faces. Optional."),
    ("part.point", "A list of points on faces. Optional."),
    ("part.axis", "A list of axes of pins and holes. Optional."),
    ("part.*.name", "Name of the feature. It is called PART.FEATURE elsewhere."),
    ("part.plane.at", "Middle of the face, in the part's own frame."),
    ("part.point.at", "Place of the point, in the part's own frame."),
    ("part.axis.at", "Middle of the axis, in the part's own frame."),
    ("part.*.normal", "Normal of the face, out of the material: three numbers, or an axis such as \"+z\"."),
    (
        "part.plane.along",
        "Direction of the first of the two `extents`, at a right angle to `normal`: three numbers, or an axis such as \"+x\".",
    ),
    ("part.axis.along", "Direction of the axis: three numbers, or an axis such as \"+z\"."),
    ("part.plane.extents", "Sizes of the face: along `along`, and at a right angle to it."),
    (
        "part.point.extents",
        "Sizes of the face on which the point lies, by which general tolerances of flatness go. Required only for those.",
    ),
    ("part.*.length", "Length of the axis."),
    (
        "part.*.diameter",
        "Diameter of the pin or hole: a number under the general tolerance, or a table with `value` and `tolerance`. Default: none, and a mate has no play there.",
    ),
    (
        "part.*.kind",
        "Whether the axis is of a `hole` or of a `pin`. Default: what the letter of an ISO 286 class says; in a mate the larger one is the hole.",
    ),
    (
        "part.*.offset",
        "Tolerance of the place along the normal: a deviation, or a table. `none`: not even the general tolerance. Default: the general tolerance of the distance from the part's origin, unless another tolerance holds the place.",
    ),
    (
        "part.*.flatness",
        "Tolerance of flatness. `none`: not even the general tolerance. Default: the general tolerance, unless the feature has another geometric tolerance.",
    ),
    ("part.plane.straightness", "Tolerance of straightness along the first extent. Optional."),
    ("part.axis.straightness", "Tolerance of the axis's straightness. Optional."),
    ("part.*.parallelism", "Tolerance of the direction, for a feature parallel to its datum. Optional."),
    ("part.*.perpendicularity", "Tolerance of the direction, for a feature at a right angle to its datum. Optional."),
    ("part.*.angularity", "Tolerance of the direction, for a feature at any other angle to its datum. Optional."),
    ("part.*.position", "Tolerance of the place relative to datums. Optional."),
    ("part.*.profile", "Tolerance of the place and direction of the face relative to datums. Optional."),
    (
        "part.*.roundness",
        "Tolerance of roundness. It shifts the axis that mates find, by up to half the zone. Optional.",
    ),
    ("part.*.cylindricity", "Tolerance of cylindricity. It shifts and tilts the axis that mates find. Optional."),
    ("part.*.coaxiality", "Tolerance of place and direction of the axis relative to a datum axis. Optional."),
    ("part.*.concentricity", "Tolerance of the place of the axis's middle relative to a datum axis. Optional."),
    ("part.*.symmetry", "Tolerance of place and direction relative to the datum's middle plane. Optional."),
    (
        "part.*.run_out",
        "Tolerance of circular run-out: how much a gauge may show in a turn about the datum axis. Optional.",
    ),
    (
        "part.*.total_run_out",
        "Tolerance of total run-out: how much a gauge may show over the whole surface, in turns about the datum axis. Optional.",
    ),
    (
        "part.*.vectorial",
        "Vectorial tolerances: one for each component of the position and of the orientation vector. Optional.",
    ),
    (
        "part.*.*.zone",
        "Width of the tolerance zone; of an axis's zone the diameter. Default: the general tolerance, where ISO 2768-2 has one.",
    ),
    (
        "part.*.*.datum",
        "One datum, or a list of up to three, the primary first. Features that are one common datum are written in one text \
         with a dash, \"PART.A-PART.B\". \"PART.B (M)\" is a datum at its maximum material condition.",
    ),
    (
        "part.*.*.material",
        "Material condition: the zone grows by the difference between the actual diameter and that limit (the bonus). For \
         position, coaxiality, perpendicularity, parallelism and angularity of an axis with a diameter. Default: no bonus.",
    ),
    ("part.*.*.within", "Composite position: zone of each axis within its pattern. It goes with `pattern`."),
    (
        "part.*.*.within_datum",
        "Composite position: datums of the zone of each axis, the first of `datum` in their order. Two or more keep the pattern from \
         turning. Default: none.",
    ),
    ("part.*.*.pattern", "Composite position: name of the pattern, the same for all its axes. It goes with `within`."),
    ("part.*.*.rule", "How the feature varies in this zone. Default: `tolerance.rule`."),
    ("part.*.vectorial.position", "Tolerances of the position. Optional."),
    ("part.*.vectorial.orientation", "Tolerances of the orientation, a unit vector; they have no unit. Optional."),
    ("part.*.vectorial.*.*", "Deviation of this component: a tolerance alone, or a table. Optional."),
    ("part.*.vectorial.*.*.tolerance", "Limits of the deviation from the nominal value, in its unit."),
    (
        "part.*.vectorial.*.*.sigma",
        "How many standard deviations half the tolerance is; 1 or more of a normal distribution. Default: `tolerance.sigma`; \
         in `[vary]` 3.",
    ),
    (
        "part.*.vectorial.*.*.distribution",
        "How the deviation varies: a name, or a table with the name as its `kind`. Default: `normal`.",
    ),
    ("mate.part", "The part that is placed."),
    (
        "mate.contacts",
        "Pairs of features: one of the part, one that it meets. They count in this order, as datums do: the first pair holds \
         as many freedoms as it can, the next ones what is left. Together with `move` or `turn` they must hold all six.",
    ),
    (
        "mate.float",
        "How a hole lies in its play on a pin: a rule as in `tolerance.rule`, or `none` for centred. Default: `tolerance.rule`.",
    ),
    (
        "mate.move",
        "A table: a displacement of the part by a known length, along a freedom that the contacts leave. Optional; not with `turn`.",
    ),
    (
        "mate.turn",
        "A table: a rotation of the part by a known angle, about an axis that the contacts leave free. Optional; not with `move`.",
    ),
    ("mate.move.along", "Direction of the displacement: three numbers, or an axis such as \"+z\"."),
    ("mate.move.by", "Length of the displacement."),
    ("mate.turn.about", "Direction of the rotation's axis: three numbers, or an axis such as \"+z\"."),
    ("mate.turn.at", "A place on the rotation's axis. Default: the origin."),
    ("mate.turn.by", "Angle of the rotation."),
    ("measure.name", "Name of the measure."),
    (
        "measure.is",
        "An [expression](#expressions) of dimensions, diameters and measures further up in the file. Instead of it a measure may have `distance` or `angle`.",
    ),
    (
        "measure.distance",
        "Instead of `is`: distance between two features. From a point to a plane it is positive outside the material.",
    ),
    ("measure.angle", "Instead of `is`: angle between two planes or axes."),
    ("measure.lower", "Lower limit, in the unit of the measure's quantity: mm, °, N and so on. Default: no limit."),
    ("measure.upper", "Upper limit, in the unit of the measure's quantity. Default: no limit."),
    (
        "measure.require",
        "What `slipfit allocate` has to reach for this measure, which needs a limit. `rss`: the root of the sum of squares is \
         at most half the distance of the limits. `rss-off-centre`: the middle ± that root lies within the limits. \
         `worst-case`: no combination lies outside. Or a table with `ppm` or `ppk`. Optional.",
    ),
    ("measure.loss", "Taguchi's loss: a cost that grows with the square of the distance from the target. Optional."),
    (
        "measure.require.ppm",
        "At most so many units in a million are outside the limits. The table has either `ppm` or `ppk`.",
    ),
    ("measure.require.ppk", "Ppk is at least this. The table has either `ppm` or `ppk`."),
    ("measure.loss.cost", "Cost of a unit that is off the target by `at`, in any currency."),
    (
        "measure.loss.at",
        "Distance from the target that costs `cost`, in the measure's unit. Default: half the distance of the limits.",
    ),
    ("measure.loss.target", "Best value, in the measure's unit. Default: the middle of the limits."),
    ("measure.loss.repair", "Cost of a repair. A unit costs at most this. Default: no such limit."),
    (
        "allocate.force_limit",
        "The motor's greatest force, in N or as a text with its unit. Units that need more force count as malfunctioning. \
         Only together with `malfunction`. Default: no limit.",
    ),
    (
        "allocate.malfunction",
        "Permitted share of malfunctioning units: units that crawl or jam over the whole stroke, or need more than \
         `force_limit`. The units are simulated. Optional.",
    ),
    ("allocate.yield", "Required share of units with all measures within their limits. Optional."),
    ("sum.name", "Name of the sum."),
    ("sum.of", "The measures that are added, all of one quantity."),
    (
        "correlation.of",
        "Two contributors, by the names that `slipfit tolerance` prints: dimensions, diameters and others of one variable.",
    ),
    ("correlation.coefficient", "Coefficient of correlation."),
    (
        "measured.file",
        "A file of measured parts, CSV or QIF results, or a list of such files with the same columns. Paths are relative to \
         the scene's folder.",
    ),
    (
        "measured.group",
        "Column of a CSV file whose texts divide the parts, such as a cavity or a machine. Required by `only`.",
    ),
    ("measured.only", "The group, or a list of the groups, whose parts count. Default: all parts."),
    (
        "measured.distribution",
        "`smoothed`: the distribution of the values themselves, from 50 parts on. A family, such as `normal` or \
         `weibull`: its likeliest distribution. `chosen`: the family that fits best, from 30 parts on. Default: `smoothed`.",
    ),
    (
        "measured.column",
        "A list `[[measured.column]]`: what was measured, at least one. Columns are correlated as their parts are.",
    ),
    (
        "measured.column.of",
        "Name of a dimension, an offset or a diameter, as `slipfit tolerance` prints it, or of a gap, as `slipfit check` does.",
    ),
    ("measured.column.heading", "Name of the column in the file. Default: the same as `of`."),
    ("measured.column.distribution", "As `measured.distribution`, for this column."),
    (
        "measured.column.least",
        "Least value that a part can have: smoothed values are reflected there. Default: no limit.",
    ),
    ("measured.column.most", "Greatest value that a part can have. Default: no limit."),
];
