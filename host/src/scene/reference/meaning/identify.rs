//! What the keys of `[identify]` mean.

/// Keys of what is sought in measured motion, and their meaning.
pub const IDENTIFY: &[(&str, &str)] = &[
    (
        "identify.model",
        "`drive-train`: a drive without a mechanism, whose force is compared along the measured motion. Default: the slide or the mechanism \
         of the scene.",
    ),
    (
        "identify.law",
        "For drive trains: the law that counts, or its terms as a list, such as `[\"mass\", \"coulomb\"]`. Default: the best of all laws.",
    ),
    ("identify.recorded", "For mechanisms: name of the drive that was recorded. Default: the first."),
    (
        "identify.compare",
        "What is compared with the simulated motion: the `force` of the drive, its `speed`, or its `position` from the first sample on. \
         Default: `force`.",
    ),
    (
        "identify.along",
        "`motion`: the drive moves as it was measured, and the force that this takes is compared, so that its controller need not be known. \
         Default: the motion is simulated.",
    ),
    (
        "identify.cutoff",
        "Cut-off frequency of the filter of a measured motion: for drive trains, and with `along`. Default: a tenth of the sampling \
         frequency, at most 100 Hz.",
    ),
    ("identify.time", "Name of the column of the time. Default: `t` or `time`."),
    ("identify.position", "Name of the column of the position. Default: `position` or `z`."),
    ("identify.speed", "Name of the column of the speed. Default: `speed`, `velocity` or `vz`."),
    ("identify.force", "Name of the column of the force, or of the torque of a drive that turns. Default: `force`."),
    (
        "identify.current",
        "Name of the column of the motor's current or voltage, where there is no force. Default: `current` or `voltage`.",
    ),
    ("identify.force_constant", "Force for a current of 1 A or a voltage of 1 V, such as `\"12 N/A\"`."),
    (
        "identify.loss",
        "What a residual costs. `squares`; `huber`: in proportion where it is large; `bisquare`: no more where it is an outlier. \
         Default: `squares` for drive trains, whose spikes are replaced before; else `bisquare`.",
    ),
    (
        "identify.search",
        "`gradient`, or `grid` for at most three parameters where the force jumps with them. Not for drive trains. Default: `gradient`.",
    ),
    (
        "identify.gaps",
        "A list of gaps whose tolerance level is sought, such as `[{ of = \"rail\", n = [-3, 3] }]`; or `\"production\"`: the level of every \
         gap is unknown, and normal about 0 with a deviation of 1, as in the production. Optional.",
    ),
    (
        "identify.gaps.of",
        "Which gaps have this level: `all`; of a slide a surface such as `rail`, the name of a pin, or one gap such as `left front rail`; \
         of a mechanism the name of a joint or of a gap, or such a surface of all tracks.",
    ),
    ("identify.gaps.n", "Bounds of the tolerance level, or a table with `between`, `mean` and `deviation`."),
    (
        "identify.delay",
        "Bounds of the time by which the record lags behind what it shows, such as `[0, 0.01]`; it is sought then. Optional.",
    ),
    (
        "identify.delay.between",
        "The least and the greatest value of what is sought. Required in such a table, which replaces a list of bounds.",
    ),
    (
        "identify.delay.mean",
        "What the value is known to be beforehand, as the mean of a normal distribution. Required there.",
    ),
    ("identify.delay.deviation", "Standard deviation of that. Required there."),
];
