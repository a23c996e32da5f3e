//! What the keys of a scene mean, a few sentences each. A star stands for any part of a path; of several that fit, the first counts.

mod identify;
mod moving;
mod parameters;
mod product;

use std::sync::LazyLock;

/// Keys and their meaning, in the order in which they are looked for.
pub static MEANINGS: LazyLock<Vec<(&str, &str)>> = LazyLock::new(|| {
    [WHOLE, identify::IDENTIFY, moving::SLIDE, moving::MECHANISM, product::PRODUCT, parameters::PARAMETERS].concat()
});

/// Keys of the whole scene, and their meaning.
const WHOLE: &[(&str, &str)] = &[
    (
        "include",
        "A TOML file, or a list of files, whose keys count as the scene's own, such as what `slipfit identify -o` writes. Paths are relative \
         to the folder of the scene. No value may be stated twice. Optional.",
    ),
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
    (
        "spring",
        "A list `[[spring]]`: springs between two bodies, along a line or, in a plane, about its normal. For mechanisms. Optional.",
    ),
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
        "measured",
        "Dimensions and gaps whose distribution is that of measured parts. Limits stay those of the drawing. Optional.",
    ),
    (
        "vary",
        "Parameters that vary from unit to unit, besides the gaps, in `slipfit population`. Each takes a tolerance, around \
         the scene's value. Optional.",
    ),
    (
        "uncertain",
        "The same parameters where one value holds for all units, but is unknown: `[least, greatest]`, `{ mean, deviation }` \
         or `{ median, factor }` of the value itself. `population`, `run` and `allocate` answer for all of it. Optional.",
    ),
    (
        "identify",
        "What `slipfit identify` seeks in measured motion. Where `model` is `drive-train` it is the only table of the scene. Optional.",
    ),
];

/// Distributions and what they are.
pub const DISTRIBUTIONS: &[(&str, &str)] = &[
    (
        "normal",
        "Normal. Half the tolerance is `sigma` standard deviations, unless `deviation` or `cpk` says otherwise, and some units lie outside the limits. The default.",
    ),
    ("truncated-normal", "The same without the units outside the limits."),
    ("uniform", "Every value between the limits is equally probable."),
    ("triangular", "The density is a triangle over the limits, highest at `mode` or in the middle."),
    ("trapezoidal", "The density is a trapezium over the limits, constant between its `shoulders`."),
    ("beta", "A beta distribution over the limits, with two `shapes`."),
    (
        "skewed",
        "A shifted lognormal distribution with the mean and the standard deviation of `normal`, with the same keys, and a stated `skewness`.",
    ),
    ("lognormal", "Lognormal with a `mean` and a standard `deviation`, above a `location`."),
    ("weibull", "Weibull with a `shape` and a `scale`, above a `location`."),
    ("gumbel", "Gumbel's distribution of the greatest of many values, with a `mode` and a `scale`."),
    ("gumbel-smallest", "Gumbel's distribution of the least of many values, with a `mode` and a `scale`."),
    ("mixture", "A unit is of one of several distributions, each with a `weight`, such as two machines or two lots."),
    ("table", "Measured `deviations`, with linear interpolation between them and without a tolerance."),
    ("constant", "Does not vary: always `value`, without a tolerance."),
];
