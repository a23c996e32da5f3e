//! What the keys of parameters mean that vary or are not known.

/// Keys of `[vary]` and `[uncertain]`, and their meaning.
pub const PARAMETERS: &[(&str, &str)] = &[
    ("vary.friction", "Parameters of the friction. Optional."),
    ("vary.contact", "Parameters of the contacts. Optional."),
    ("vary.slide", "Parameters of the slide. Optional."),
    ("vary.mechanism", "Parameters of a mechanism's gravity. Optional."),
    ("vary.body", "A list `[[vary.body]]`: bodies of a mechanism with their parameters. Optional."),
    ("vary.drive", "Parameters of the drive; for a mechanism a list `[[vary.drive]]`. Optional."),
    ("vary.friction.coefficient", "Coefficient of friction: a number without a unit. Optional."),
    ("vary.friction.stick_band", "Stick band of regularised friction, in mm/s. Optional."),
    (
        "vary.contact.stiffness",
        "Stiffness. In `[vary]` a share of the stiffness: 0.1 is ±10 %. In `[uncertain]` in the unit of `contact.stiffness`. \
         Optional.",
    ),
    ("vary.contact.damping", "Damping, in N·s/mm. Optional."),
    ("vary.contact.depth", "Penetration from which on the damping is full, in mm. Optional."),
    ("vary.mechanism.tilt_x", "Rotation of gravity about the frame's x, in °. Only in space. Optional."),
    ("vary.mechanism.tilt_z", "Rotation of gravity about the frame's z, in °; in a plane within it. Optional."),
    ("vary.body.name", "Name of a body."),
    ("vary.body.mass", "Its mass, in g. The moments of inertia follow. Optional."),
    ("vary.drive.name", "Name of a drive of a mechanism. A slide has one drive, without a name."),
    ("vary.slide.mass", "Mass, in g. The moments of inertia follow. Optional."),
    ("vary.slide.tilt_x", "Rotation of gravity about the frame's x, in °. Optional."),
    ("vary.slide.tilt_z", "Rotation of gravity about the frame's z, in °. Optional."),
    ("vary.drive.gain", "Gain of the drive, in N·s/mm; in N·m·s/rad for a drive that turns. Optional."),
    ("vary.drive.ramp_end", "End of the ramp, in s. Optional."),
    ("vary.drive.limit", "Limit of a mechanism's motor, in N; in N·m for a drive that turns. Optional."),
    (
        "vary.drive.coulomb",
        "Coulomb friction of a mechanism's drive train, likewise; of both directions by as much. Optional.",
    ),
    ("vary.drive.viscous", "Viscous friction of a mechanism's drive train, in N·s/mm or N·m·s/rad. Optional."),
    ("vary.drive.offset", "Offset of a mechanism's drive train, in N or N·m. Optional."),
    ("vary.joint", "A list `[[vary.joint]]`: joints of a mechanism with their parameters. Optional."),
    ("vary.joint.name", "Name of a joint."),
    ("vary.joint.slope", "Slope of those of its walls that have one. Optional."),
    (
        "uncertain.correlation",
        "A list `[[uncertain.correlation]]`: pairs of unknowns by the names that reports have for them, whose values are not independent. \
         Optional.",
    ),
    (
        "uncertain.*.*.mean",
        "Mean of a normal distribution of the value, in the key's unit. It is cut off at four standard deviations.",
    ),
    ("uncertain.*.*.deviation", "Standard deviation of that, in the same unit. Required beside `mean`."),
    ("uncertain.*.*.median", "Median of a lognormal distribution of the value, in the key's unit."),
    (
        "uncertain.*.*.factor",
        "With 95 % the value is between median / factor and median · factor. Required beside `median`.",
    ),
];
