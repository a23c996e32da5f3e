//! What the keys of `[identify]` mean.

/// Keys of what is sought in measured motion, and their meaning.
pub const IDENTIFY: &[(&str, &str)] = &[
    (
        "identify.model",
        "`slide`: the slide of the scene is simulated, and the force of its drive compared. `drive-train`: a drive without a mechanism, \
         whose force is compared along the measured motion. Default: `slide`.",
    ),
    (
        "identify.law",
        "For drive trains: the law that counts, or its terms as a list, such as `[\"mass\", \"coulomb\"]`. Default: the best of all laws.",
    ),
    (
        "identify.cutoff",
        "For drive trains: cut-off frequency of the filter of the motion. Default: a tenth of the sampling frequency, at most 100 Hz.",
    ),
    ("identify.time", "Name of the column of the time. Default: `t` or `time`."),
    ("identify.position", "For drive trains: name of the column of the position. Default: `position` or `z`."),
    ("identify.speed", "For drive trains: name of the column of the speed. Default: `speed`, `velocity` or `vz`."),
    ("identify.force", "Name of the column of the force. Default: `force`."),
    (
        "identify.current",
        "Name of the column of the motor's current or voltage, where there is no force. Default: `current` or `voltage`.",
    ),
    ("identify.force_constant", "Force for a current of 1 A or a voltage of 1 V, such as `\"12 N/A\"`."),
    (
        "identify.loss",
        "What a residual costs. `squares`; `huber`: in proportion where it is large; `bisquare`: no more where it is an outlier. \
         Default: `bisquare` for slides, `squares` for drive trains, whose spikes are replaced before.",
    ),
    (
        "identify.search",
        "For slides: `gradient`, or `grid` for at most three parameters where the force jumps with them. Default: `gradient`.",
    ),
    ("identify.friction", "What is sought of the friction. Optional."),
    ("identify.friction.coefficient", "Bounds of the coefficient of friction, such as `[0.1, 0.5]`. Optional."),
    ("identify.contact", "What is sought of the contacts. Optional."),
    ("identify.contact.stiffness", "Bounds of the stiffness, a list of two. Optional."),
    ("identify.slide", "What is sought of the slide. Optional."),
    ("identify.slide.mass", "Bounds of the mass, such as `[60, 120]`. The moments of inertia follow. Optional."),
    (
        "identify.gaps",
        "A list of gaps whose tolerance level is sought, such as `[{ of = \"rail\", n = [-3, 3] }]`. Optional.",
    ),
    (
        "identify.gaps.of",
        "Which gaps have this level: `all`, a surface such as `rail`, the name of a pin, or one gap such as `left front rail`.",
    ),
    ("identify.gaps.n", "Bounds of the tolerance level."),
];
