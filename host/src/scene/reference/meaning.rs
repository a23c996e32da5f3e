//! What the keys of a scene mean, a few sentences each. A star stands for any part of a path; of several that fit, the first counts.

/// Keys and their meaning.
pub const MEANINGS: &[(&str, &str)] = &[
    ("title", "Title of plots and reports. Default: the file's name without its ending."),
    ("slide", "The moving body of a slide on pins. Something that moves is a `[slide]` or a `[mechanism]`."),
    (
        "contact",
        "The law of the force normal to the touching surfaces. Required by a slide, and by a mechanism with play.",
    ),
    (
        "friction",
        "The law of the friction between touching surfaces. Required by a slide; default for a mechanism: none.",
    ),
    (
        "drive",
        "The motor with its speed controller. A slide has one, `[drive]`. A mechanism has a list `[[drive]]`, or none.",
    ),
    ("mechanism", "Marks a scene of bodies and joints."),
    ("body", "A list `[[body]]`: the moving bodies of a mechanism, at least one."),
    ("joint", "A list `[[joint]]`: what connects two bodies, or a body and the frame. Optional."),
    ("spring", "A list `[[spring]]`: torsion springs, each between two bodies. For mechanisms in a plane. Optional."),
    ("run", "How long a run lasts, and how exactly the desk computes it. Required by slides and mechanisms."),
    (
        "controller",
        "Step, integration scheme and number type of the controller, the solver for firmware. Default: the defaults of its keys.",
    ),
    (
        "sweep",
        "The tolerance levels of `run`, `sweep` and `table`. Required by a slide; default for a mechanism: `n = \"-3:3:0.5\"`.",
    ),
    ("drawing", "Nominal clearances of the drawing, which `check` compares with the gaps. Optional."),
    ("pin", "A list `[[pin]]` of the one to four pins of the frame on which the slide moves. Required by a slide."),
    ("tolerance", "Defaults for the tolerances of dimensions and features. Optional."),
    ("dimension", "A list `[[dimension]]`: toleranced numbers that expressions use. Optional."),
    (
        "part",
        "A list `[[part]]`: parts with toleranced features. The first one stays in place, and a `[[mate]]` places each other one. Optional.",
    ),
    ("mate", "A list `[[mate]]`: each places one part by contacts between features. One for each part but the first."),
    (
        "measure",
        "A list `[[measure]]`: the results of the tolerance analysis. At least one where there are dimensions or parts.",
    ),
    (
        "allocate",
        "What `slipfit allocate` has to reach for all measures together, or for the units of a slide. Optional.",
    ),
    (
        "sum",
        "A list `[[sum]]`: sums of measures. `slipfit tolerance` estimates how many units have a negative sum. Optional.",
    ),
    ("correlation", "A list `[[correlation]]`: pairs of contributors that do not vary independently. Optional."),
    (
        "vary",
        "Parameters of the slide that vary from unit to unit, besides the gaps, in `slipfit population`. Each takes a \
         tolerance, around the scene's value. Optional.",
    ),
    // The slide and its run.
    ("slide.mass", "Mass."),
    (
        "slide.inertia_box",
        "Edges along x, y, z of a uniform box of the same mass. Its moments of inertia are the slide's.",
    ),
    ("slide.gravity", "Acceleration of gravity along x, y, z of the frame, such as `[0, -9.81, 0]`."),
    (
        "contact.law",
        "Force F for a penetration δ > 0 and its rate δ̇. `impact`: k·δ^e + c·S(δ/d)·δ̇, at least 0, with S(s) = s²·(3 − 2s) \
         up to s = 1, then 1. `hunt-crossley` and `lankarani-nikravesh`: k·δ^e·(1 + a·δ̇), where a follows from \
         `restitution` and `speed`; for mechanisms only. Default: `impact`.",
    ),
    (
        "contact.stiffness",
        "Stiffness k. Its unit contains the exponent e: for e = 2 it is N/mm^2 or N/m^2, and a bare number is in N/mm^2.",
    ),
    ("contact.exponent", "Exponent e of the penetration δ, such as 1.5."),
    (
        "contact.damping",
        "Damping c, reached at the penetration `depth`. Required by `impact`; the other laws do not have it.",
    ),
    (
        "contact.depth",
        "Penetration d from which on the damping is c. Required by `impact`; the other laws do not have it.",
    ),
    (
        "contact.restitution",
        "Speed of rebound over speed of impact, at the impact speed `speed`. Required by `hunt-crossley` and \
         `lankarani-nikravesh`; `impact` does not have it.",
    ),
    (
        "contact.speed",
        "Speed of impact at which `restitution` holds. Required by `hunt-crossley` and `lankarani-nikravesh`; `impact` does \
         not have it.",
    ),
    (
        "friction.law",
        "Coulomb friction. `regularised`: fades to zero below the speed `stick_band`, so that a loaded part creeps. `exact`: \
         holds a part at rest. `none`: no friction.",
    ),
    ("friction.coefficient", "Coefficient of friction. Required unless the law is `none`."),
    (
        "friction.stick_band",
        "Sliding speed below which regularised friction fades to zero. Required by the law `regularised`.",
    ),
    (
        "drive.gain",
        "Force for each unit of speed that the body is slower than commanded: force = gain · (command − speed). For a drive \
         that turns, torque for each unit of angular velocity, in N·m·s/rad.",
    ),
    ("drive.ramp_start", "When the commanded speed begins to rise from zero."),
    ("drive.ramp_end", "When the commanded speed reaches `speed`, at least 1 µs after `ramp_start`."),
    ("drive.speed", "Commanded speed after the ramp. For a drive that turns, in rad/s."),
    ("drive.point", "Where the force acts, measured from the centre of mass. Default: the centre of mass."),
    ("drive.name", "Name of the drive. Required in a mechanism."),
    (
        "drive.pushes",
        "For mechanisms: the body that the drive pushes along `axis`. Each drive has either `pushes` or `turns`.",
    ),
    (
        "drive.turns",
        "For mechanisms: the body that the drive turns about `axis`. Each drive has either `pushes` or `turns`.",
    ),
    (
        "drive.axis",
        "For mechanisms: direction of the force, or axis of the torque. Required, except for a torque in a plane.",
    ),
    (
        "run.duration",
        "How long a run lasts: of a slide its opening, of a mechanism the whole run. A slide's run of the whole stroke lasts \
         at most until the ramp's end plus `stroke` over the commanded speed.",
    ),
    (
        "run.stroke",
        "Travel at which a run ends. Of a mechanism it is the travel of the first drive's body, an angle in ° where that \
         drive turns. Default: no limit; `--stroke` and the stroke's part of `slipfit run` need it.",
    ),
    (
        "run.error",
        "Error that one step of the desk may make. Of a slide it is a share of the drive's greatest force, gain · speed, or of \
         the slide's weight where that is 0. Of a mechanism it is a share of its own speed: the greatest commanded or \
         starting speed, else one that follows from gravity. A smaller value is more exact and takes longer. Default: 3e-7.",
    ),
    ("controller.step", "Length of the controller's steps. Default: 1 ms."),
    (
        "controller.integrator",
        "Integration scheme of the controller. `semi-implicit-euler` and `rk4` are explicit and need finer steps; exact \
         friction needs an implicit scheme. Default: `implicit-euler`.",
    ),
    ("controller.scalar", "Number type of the controller. `kernel` and `fmu` need f32. Default: f32."),
    (
        "sweep.n",
        "Tolerance levels. At the level n every gap is its mean − n · its standard deviation: positive n is tighter.",
    ),
    (
        "drawing.clearance",
        "Nominal clearances across, and up and down. `check` prints a note where they differ from the sums of the gaps. No \
         simulation uses them.",
    ),
    ("pin.name", "Name of the pin."),
    (
        "pin.position",
        "Place of the pin, measured from the slide's centre of mass before the slide moves. x is across, y up, z the opening direction.",
    ),
    (
        "pin.left",
        "Gap between the pin's left side (towards −x) and the slide: mean and standard deviation, or the name of a measure. \
         Leave the key out where the slide has no such surface.",
    ),
    ("pin.right", "As `left`, for the pin's right side (towards +x)."),
    ("pin.rail", "As `left`, for the slide's rail, which lies on top of the pin."),
    ("pin.wall", "As `left`, for the slide's wall below the pin."),
    // Mechanisms.
    (
        "mechanism.space",
        "`plane`: bodies move in the plane of x and y, and places and directions are lists of 2. `space`: lists of 3. \
         Default: `space`.",
    ),
    ("mechanism.gravity", "Acceleration of gravity. Default: none."),
    ("body.name", "Name of the body; not `frame`."),
    ("body.mass", "Mass."),
    (
        "body.inertia",
        "Moments of inertia about the centre of mass. In space a list of three, about x, y and z; in a plane one number.",
    ),
    ("body.centre", "Centre of mass in the pose in which the mechanism is drawn."),
    ("body.angle", "In a plane: rotation from the drawn pose at the start. Default: 0."),
    ("body.spin", "In a plane: angular velocity at the start. Default: 0."),
    ("body.speed", "In a plane: speed at the start along the axis of the body's joint. Default: 0."),
    ("joint.name", "Name of the joint."),
    (
        "joint.kind",
        "What the joint is. In a plane: `fixed`, `revolute`, `prismatic`, `pin-slot`, `stop`. In space: `cylindrical`, \
         `track`, `stop`. The column *takes* shows those in space.",
    ),
    (
        "joint.between",
        "The two bodies; `frame` is the body at rest. Their order matters where a joint has play: a hole (`revolute`), \
         rectangle (`prismatic`), bearing (`cylindrical`), pin (`track`) or point (`stop`) is the first body's, and the pin, \
         rod or walls that it meets are the second's.",
    ),
    ("joint.at", "Place of the joint in the drawn pose."),
    (
        "joint.axis",
        "Direction of the sliding or of the bearing. Required by `prismatic`, `pin-slot` and `cylindrical`.",
    ),
    (
        "joint.normal",
        "Outward normal of a stop's wall: the direction in which the wall pushes the first body. In space along x, y or z. \
         Required by `stop`.",
    ),
    (
        "joint.clearance",
        "Gap: mean and standard deviation, or the name of a measure. Of `revolute` and `cylindrical` it is radial, of \
         `prismatic` on either side, of `stop` the distance to the wall. Required by `cylindrical` and `stop`. `revolute` and \
         `prismatic` without it are ideal, without play.",
    ),
    ("joint.radius", "Radius of the pin or rod. Required by `cylindrical`, and by `revolute` with a clearance."),
    ("joint.length", "Length along the axis. Required by `cylindrical`, and by `prismatic` with a clearance."),
    ("joint.width", "Width across the axis. Required by `prismatic` with a clearance."),
    (
        "joint.left",
        "Of a track: gap between the pin's left side (towards −x) and the second body. Leave the key out where there is no \
         such surface.",
    ),
    ("joint.right", "As `left`, for the pin's right side (towards +x)."),
    ("joint.rail", "As `left`, for the rail, which lies on top of the pin."),
    ("joint.wall", "As `left`, for the wall below the pin."),
    ("joint.contact", "The joint's own contact law. Default: the scene's `[contact]`."),
    ("joint.friction", "The joint's own friction law. Default: the scene's `[friction]`."),
    ("spring.name", "Name of the spring."),
    ("spring.between", "The two bodies; `frame` is the body at rest. The spring is relaxed in the drawn pose."),
    ("spring.stiffness", "Torque for each unit of angle."),
    ("spring.damping", "Torque for each unit of angular velocity. Default: 0."),
    // Products.
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
    ("dimension.sigma", "How many standard deviations half the tolerance is. Default: `tolerance.sigma`."),
    ("part.*.offset.sigma", "How many standard deviations half the tolerance is. Default: `tolerance.sigma`."),
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
        "Of an angle: length of its shorter side, by which ISO 2768-1 tolerates it. Required where a class of ISO 2768-1 tolerates an angle.",
    ),
    ("part.*.offset.side", "Of no use here: only angles have it."),
    (
        "dimension.edge",
        "`broken` marks an external radius or a chamfer, for which ISO 2768-1 has a table of its own. Default: an ordinary length.",
    ),
    (
        "part.*.offset.edge",
        "`broken` marks an external radius or a chamfer, for which ISO 2768-1 has a table of its own. Default: an ordinary length.",
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
    ("*.distribution.mean", "Of `lognormal`: mean deviation from `value`."),
    ("*.distribution.deviation", "Of `lognormal`: standard deviation."),
    ("*.distribution.of", "Of `mixture`: its components, such as two machines that make the same part."),
    ("*.distribution.of.weight", "Share of the component, relative to the weights of the others. Default: 1."),
    ("*.distribution.of.tolerance", "Limits of the component's deviation."),
    ("*.distribution.of.sigma", "How many standard deviations half the tolerance is. Default: `tolerance.sigma`."),
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
         process has either `reciprocal` or `exponential`.",
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
    ("part.*.*.pattern", "Composite position: name of the pattern, the same for all its axes. It goes with `within`."),
    ("part.*.*.rule", "How the feature varies in this zone. Default: `tolerance.rule`."),
    ("part.*.vectorial.position", "Tolerances of the position. Optional."),
    ("part.*.vectorial.orientation", "Tolerances of the orientation, a unit vector; they have no unit. Optional."),
    ("part.*.vectorial.*.*", "Deviation of this component: a tolerance alone, or a table. Optional."),
    ("part.*.vectorial.*.*.tolerance", "Limits of the deviation from the nominal value, in its unit."),
    (
        "part.*.vectorial.*.*.sigma",
        "How many standard deviations half the tolerance is. Default: `tolerance.sigma`; in `[vary]` 3.",
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
    ("vary.friction", "What varies of the friction. Optional."),
    ("vary.contact", "What varies of the contacts. Optional."),
    ("vary.slide", "What varies of the slide. Optional."),
    ("vary.drive", "What varies of the drive. Optional."),
    ("vary.friction.coefficient", "Deviation of the coefficient of friction: a number without a unit. Optional."),
    ("vary.contact.stiffness", "Deviation of the stiffness as a share of the stiffness: 0.1 is ±10 %. Optional."),
    ("vary.contact.damping", "Deviation of the damping, in N·s/mm. Optional."),
    ("vary.slide.mass", "Deviation of the mass, in g. The moments of inertia follow. Optional."),
    ("vary.slide.tilt_x", "Rotation of gravity about the frame's x, in °. Optional."),
    ("vary.slide.tilt_z", "Rotation of gravity about the frame's z, in °. Optional."),
    ("vary.drive.gain", "Deviation of the drive's gain, in N·s/mm. Optional."),
    ("vary.drive.ramp_end", "Deviation of the ramp's end, in s. Optional."),
];

/// Distributions and what they are.
pub const DISTRIBUTIONS: &[(&str, &str)] = &[
    (
        "normal",
        "Normal. Half the tolerance is `sigma` standard deviations, and some units lie outside the limits. The default.",
    ),
    ("truncated-normal", "The same without the units outside the limits."),
    ("uniform", "Every value between the limits is equally probable."),
    ("triangular", "The density is a triangle over the limits, highest at `mode` or in the middle."),
    ("trapezoidal", "The density is a trapezium over the limits, constant between its `shoulders`."),
    ("beta", "A beta distribution over the limits, with two `shapes`."),
    (
        "skewed",
        "A shifted lognormal distribution with the mean and the standard deviation of `normal` and a stated `skewness`.",
    ),
    ("lognormal", "Lognormal with a `mean` and a standard `deviation`, above a `location`."),
    ("weibull", "Weibull with a `shape` and a `scale`, above a `location`."),
    ("gumbel", "Gumbel's distribution of the greatest of many values, with a `mode` and a `scale`."),
    ("gumbel-smallest", "Gumbel's distribution of the least of many values, with a `mode` and a `scale`."),
    ("mixture", "A unit is of one of several distributions, each with a `weight`, such as two machines or two lots."),
    ("table", "Measured `deviations`, with linear interpolation between them and without a tolerance."),
    ("constant", "Does not vary: always `value`, without a tolerance."),
];
