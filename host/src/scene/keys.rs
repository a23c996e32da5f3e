//! The keys of a scene file.

use slipfit_tolerance::product::feature::Shape;

/// A key, and the keys of the table (or the tables of the list) that it may hold.
#[derive(Clone, Copy)]
pub(super) struct Key {
    pub name: &'static str,
    pub below: &'static [Key],
}

const fn key(name: &'static str) -> Key {
    Key { name, below: &[] }
}

const fn table(name: &'static str, below: &'static [Key]) -> Key {
    Key { name, below }
}

/// Keys of a distribution alone.
const SHAPE: [Key; 13] = [
    key("kind"),
    key("mode"),
    key("shoulders"),
    key("skewness"),
    key("deviations"),
    key("shape"),
    key("shapes"),
    key("scale"),
    key("location"),
    key("mean"),
    key("shift"),
    key("deviation"),
    key("cpk"),
];
/// The same, and the parts of a mixture.
const MIXED: &[Key] = &[key("weight"), key("tolerance"), key("sigma"), table("distribution", &SHAPE)];
const MIXTURE: [Key; SHAPE.len() + 1] = joined(&SHAPE, &[table("of", MIXED)]);
const DISTRIBUTION: Key = table("distribution", &MIXTURE);

const COST: Key = table(
    "cost",
    &[
        key("name"),
        key("fixed"),
        key("reciprocal"),
        key("exponential"),
        key("at"),
        key("power"),
        key("range"),
        key("step"),
        key("grades"),
    ],
);
const TOLERANCED: &[Key] = &[key("value"), key("tolerance"), key("sigma"), DISTRIBUTION, key("edge"), COST];
const DEVIATION: &[Key] = &[key("tolerance"), key("sigma"), DISTRIBUTION];
const BELIEF: &[Key] = &[key("mean"), key("deviation"), key("median"), key("factor")];
/// Parameters of what moves, each with the keys `below` it.
macro_rules! parameters {
    ($below:expr) => {
        &[
            table("friction", &[table("coefficient", $below), table("stick_band", $below)]),
            table("contact", &[table("stiffness", $below), table("damping", $below), table("depth", $below)]),
            table("slide", &[table("mass", $below), table("tilt_x", $below), table("tilt_z", $below)]),
            table("mechanism", &[table("tilt_x", $below), table("tilt_z", $below)]),
            table("body", &[key("name"), table("mass", $below)]),
            table("joint", &[key("name"), table("slope", $below)]),
            table(
                "drive",
                &[
                    key("name"),
                    table("gain", $below),
                    table("ramp_end", $below),
                    table("limit", $below),
                    table("coulomb", $below),
                    table("viscous", $below),
                    table("offset", $below),
                ],
            ),
        ]
    };
}
/// Bounds of a value that is sought, and what is known of it.
const SOUGHT: &[Key] = &[key("between"), key("mean"), key("deviation")];
const SOUGHT_PARAMETERS: &[Key] = parameters!(SOUGHT);
const RECORD: [Key; 16] = [
    key("model"),
    key("law"),
    key("recorded"),
    key("compare"),
    key("along"),
    key("cutoff"),
    key("time"),
    key("position"),
    key("speed"),
    key("force"),
    key("current"),
    key("force_constant"),
    key("loss"),
    key("search"),
    table("gaps", &[key("of"), table("n", SOUGHT)]),
    table("delay", SOUGHT),
];
const IDENTIFY: [Key; RECORD.len() + SOUGHT_PARAMETERS.len()] = joined(SOUGHT_PARAMETERS, &RECORD);
const BELIEFS: &[Key] = parameters!(BELIEF);
const UNCERTAIN: [Key; BELIEFS.len() + 1] = joined(BELIEFS, &[table("correlation", &[key("of"), key("coefficient")])]);

/// The keys of two lists, of `N` in all.
const fn joined<const N: usize>(first: &'static [Key], second: &'static [Key]) -> [Key; N] {
    let mut keys = [first[0]; N];
    let mut i = 0;
    while i < N {
        keys[i] = if i < first.len() { first[i] } else { second[i - first.len()] };
        i += 1;
    }
    keys
}

const VECTORIAL: Key = table("vectorial", &[table("position", VECTOR), table("orientation", VECTOR)]);
const VECTOR: &[Key] = &[table("x", DEVIATION), table("y", DEVIATION), table("z", DEVIATION)];
const ZONE: &[Key] = &[
    key("zone"),
    key("datum"),
    key("material"),
    key("within"),
    key("within_datum"),
    key("pattern"),
    key("rule"),
    COST,
];

const PLANE: &[Key] = &[
    key("name"),
    key("at"),
    key("normal"),
    key("along"),
    key("extents"),
    table("offset", TOLERANCED),
    table("flatness", ZONE),
    table("straightness", ZONE),
    table("parallelism", ZONE),
    table("perpendicularity", ZONE),
    table("angularity", ZONE),
    table("position", ZONE),
    table("profile", ZONE),
    table("symmetry", ZONE),
    table("run_out", ZONE),
    table("total_run_out", ZONE),
    VECTORIAL,
];
const POINT: &[Key] = &[
    key("name"),
    key("at"),
    key("normal"),
    key("extents"),
    table("offset", TOLERANCED),
    table("flatness", ZONE),
    table("position", ZONE),
    table("profile", ZONE),
    table("run_out", ZONE),
    table("total_run_out", ZONE),
    VECTORIAL,
];
const AXIS: &[Key] = &[
    key("name"),
    key("at"),
    key("along"),
    key("length"),
    table("diameter", TOLERANCED),
    key("kind"),
    table("straightness", ZONE),
    table("parallelism", ZONE),
    table("perpendicularity", ZONE),
    table("angularity", ZONE),
    table("position", ZONE),
    table("roundness", ZONE),
    table("cylindricity", ZONE),
    table("coaxiality", ZONE),
    table("concentricity", ZONE),
    table("symmetry", ZONE),
    table("run_out", ZONE),
    table("total_run_out", ZONE),
    VECTORIAL,
];

const CONTACT: &[Key] =
    &[key("law"), key("stiffness"), key("exponent"), key("damping"), key("depth"), key("restitution"), key("speed")];
const FRICTION: &[Key] = &[
    key("law"),
    key("coefficient"),
    key("stick_band"),
    key("static_coefficient"),
    key("stribeck_speed"),
    key("viscous"),
];
const SEGMENT: &[Key] =
    &[key("kind"), key("speed"), key("duration"), key("acceleration"), key("jerk"), key("amplitude"), key("frequency")];

/// The keys of a feature of this shape.
pub(super) fn of_feature(shape: Shape) -> &'static [Key] {
    match shape {
        Shape::Plane => PLANE,
        Shape::Point => POINT,
        Shape::Axis => AXIS,
    }
}

/// Every key of a scene.
pub(super) const ROOT: &[Key] = &[
    key("title"),
    key("include"),
    table("slide", &[key("mass"), key("inertia_box"), key("gravity")]),
    table("contact", CONTACT),
    table("friction", FRICTION),
    table(
        "drive",
        &[
            key("gain"),
            key("ramp_start"),
            key("ramp_end"),
            key("speed"),
            key("point"),
            key("name"),
            key("pushes"),
            key("turns"),
            key("axis"),
            key("controls"),
            table("segment", SEGMENT),
            key("cycles"),
            table("record", &[key("file"), key("time"), key("position"), key("speed"), key("interpolation")]),
            key("motion"),
            key("sampling"),
            key("position_gain"),
            key("measures"),
            key("limit"),
            key("coulomb"),
            key("stick_band"),
            key("viscous"),
            key("offset"),
            key("rotor"),
            key("gear"),
            key("travel"),
        ],
    ),
    table("mechanism", &[key("space"), key("gravity")]),
    table(
        "body",
        &[
            key("name"),
            key("mass"),
            key("inertia"),
            key("centre"),
            key("angle"),
            key("spin"),
            key("speed"),
            key("displaced"),
        ],
    ),
    table(
        "joint",
        &[
            key("name"),
            key("kind"),
            key("between"),
            key("at"),
            key("axis"),
            key("normal"),
            key("clearance"),
            key("radius"),
            key("length"),
            key("width"),
            key("left"),
            key("right"),
            key("rail"),
            key("wall"),
            key("slope"),
            key("bow"),
            table("along", &[key("at"), key("clearance"), key("left"), key("right"), key("rail"), key("wall")]),
            key("coulomb"),
            key("stick_band"),
            key("viscous"),
            table("contact", CONTACT),
            table("friction", FRICTION),
        ],
    ),
    table(
        "spring",
        &[
            key("name"),
            key("between"),
            key("stiffness"),
            key("damping"),
            key("preload"),
            key("ends"),
            key("free_length"),
        ],
    ),
    table("run", &[key("duration"), key("stroke"), key("error")]),
    table("controller", &[key("step"), key("integrator"), key("scalar")]),
    table("sweep", &[key("n")]),
    table("drawing", &[key("clearance")]),
    table(
        "pin",
        &[
            key("name"),
            key("position"),
            key("left"),
            key("right"),
            key("rail"),
            key("wall"),
            key("slope"),
            key("bow"),
            table("along", &[key("at"), key("left"), key("right"), key("rail"), key("wall")]),
        ],
    ),
    table("tolerance", &[key("general"), key("rule"), key("sigma"), key("datums"), key("correlation")]),
    table(
        "dimension",
        &[
            key("name"),
            key("value"),
            key("quantity"),
            key("tolerance"),
            key("sigma"),
            DISTRIBUTION,
            key("side"),
            key("edge"),
            COST,
        ],
    ),
    table(
        "part",
        &[key("name"), key("at"), key("turned"), table("plane", PLANE), table("point", POINT), table("axis", AXIS)],
    ),
    table(
        "mate",
        &[
            key("part"),
            key("contacts"),
            key("float"),
            table("move", &[key("along"), key("by")]),
            table("turn", &[key("about"), key("at"), key("by")]),
        ],
    ),
    table(
        "measure",
        &[
            key("name"),
            key("is"),
            key("distance"),
            key("angle"),
            key("lower"),
            key("upper"),
            table("require", &[key("ppm"), key("ppk")]),
            table("loss", &[key("cost"), key("at"), key("target"), key("repair")]),
        ],
    ),
    table("allocate", &[key("yield"), key("malfunction"), key("force_limit")]),
    table("sum", &[key("name"), key("of")]),
    table(
        "measured",
        &[
            key("file"),
            key("group"),
            key("only"),
            key("distribution"),
            table("column", &[key("of"), key("heading"), key("distribution"), key("least"), key("most")]),
        ],
    ),
    table("correlation", &[key("of"), key("coefficient")]),
    table("vary", parameters!(DEVIATION)),
    table("uncertain", &UNCERTAIN),
    table("identify", &IDENTIFY),
];

/// The full name of the key `name` below `path`.
pub(super) fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.into() } else { format!("{path}.{name}") }
}
