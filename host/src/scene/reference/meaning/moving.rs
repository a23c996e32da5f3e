//! What the keys of slides and mechanisms mean.

/// Keys of the slide and its run, and their meaning.
pub const SLIDE: &[(&str, &str)] = &[
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
    (
        "friction.static_coefficient",
        "Coefficient that has to be overcome to move, not below `coefficient`. Default: `coefficient`.",
    ),
    (
        "friction.stribeck_speed",
        "Speed v_S at which regularised friction has fallen halfway from static to kinetic: μ(s) = μ_k + (μ_s − \
         μ_k)/(1 + (s/v_S)²). Not below `stick_band`. Required by `regularised` with a `static_coefficient`; in `exact` the fall is sudden.",
    ),
    (
        "friction.viscous",
        "By how much the coefficient of regularised friction grows with the sliding speed. Default: 0.",
    ),
    (
        "friction.coefficient",
        "Coefficient of friction; with a `static_coefficient` that of parts which slide. Required unless the law is `none`.",
    ),
    (
        "friction.stick_band",
        "Sliding speed below which regularised friction fades to zero. Required by the law `regularised`.",
    ),
    (
        "drive.gain",
        "Force for each unit of speed that the body is slower than commanded: force = gain · (command − speed). For a drive \
         that turns, torque for each unit of angular velocity, in N·m·s/rad.",
    ),
    (
        "drive.ramp_start",
        "When the commanded speed begins to rise from zero. With segments, when the first of them starts; default 0 there.",
    ),
    (
        "drive.ramp_end",
        "When the commanded speed reaches `speed`, at least 1 µs after `ramp_start`. Not with segments.",
    ),
    ("drive.speed", "Commanded speed after the ramp. For a drive that turns, in rad/s. Not with segments."),
    (
        "drive.controls",
        "Of a drive that pushes: the speed of its `point` or of the body's `centre` of mass. Default: `point`; of a slide `centre`.",
    ),
    (
        "drive.segment",
        "What is commanded in place of the ramp, one segment after the other, from rest. After the last one the \
         command is constant.",
    ),
    (
        "drive.segment.kind",
        "`ramp`: to another `speed`. `hold`: stay at the speed. `sine`, `chirp`: a sine about the speed, of one frequency, or of one that \
         changes evenly from the first to the second.",
    ),
    (
        "drive.segment.speed",
        "Speed at the end of a ramp; negative to reverse, 0 to stop. In rad/s for a drive that turns.",
    ),
    (
        "drive.segment.duration",
        "How long the segment lasts. A ramp has either this, and is smooth like the paper's, or `acceleration`.",
    ),
    ("drive.segment.acceleration", "Constant, or with `jerk` the greatest, acceleration of a ramp."),
    ("drive.segment.jerk", "How fast the acceleration of a ramp changes: an S-curve. Default: at once."),
    ("drive.segment.amplitude", "Amplitude of the speed of a sine or chirp."),
    ("drive.segment.frequency", "Frequency of a sine; of a chirp a list of two, from and to."),
    ("drive.cycles", "How often the segments are run; more than once, they have to end at rest. Default: 1."),
    (
        "drive.record",
        "A recorded command in place of the ramp: a column of a CSV file whose first row names the columns with their units, sampled at \
         equal intervals from 0 s or later. After the last sample the command keeps its speed; positions that are not `cubic` rest there.",
    ),
    ("drive.record.file", "The CSV file; relative to the folder of the scene."),
    ("drive.record.time", "Heading of the column of the time. Default: `t` or `time`."),
    (
        "drive.record.position",
        "Heading of the column of positions; only how they differ from the first one counts. For a position loop or a prescribed motion.",
    ),
    ("drive.record.speed", "Heading of the column of speeds."),
    (
        "drive.record.interpolation",
        "What is commanded between two samples: `linear` and `cubic` (a spline) interpolate, `held` keeps the last sample. Default: \
         `linear`; of a prescribed motion, whose speed must not jump, `cubic`.",
    ),
    (
        "drive.motion",
        "`controlled`: a controller pushes or turns the body with its `gain`. `prescribed`: the body moves as commanded, whatever that \
         takes; the reported force is what it takes. Default: `controlled`.",
    ),
    (
        "drive.sampling",
        "Period of a controller that samples: it measures at equal intervals and holds its force in between. Simulated in runs, sweeps, \
         populations and tables, and not available in kernels. Default: the controller acts continuously.",
    ),
    (
        "drive.position_gain",
        "Gain k of a position loop around the speed loop: force = gain · (k · (commanded − measured distance) − speed). The commanded \
         distance is that which the commanded speed leads to. With `sampling`. Default: no position loop.",
    ),
    (
        "drive.measures",
        "What a controller that samples measures: the `speed`; or the `position` alone, whose change over the last period is its speed. \
         Default: `speed`.",
    ),
    ("drive.limit", "The most that the motor gives, either way; a torque for a drive that turns. Default: no limit."),
    (
        "drive.coulomb",
        "Coulomb friction of the drive train; of two numbers the first is that of motion along the axis, the second of \
         motion against it. It acts on the body and is not part of the reported force. Default: none.",
    ),
    ("drive.stick_band", "Speed below which `coulomb` fades to zero. Required with it."),
    ("drive.viscous", "Viscous friction of the drive train. Default: none."),
    (
        "drive.offset",
        "What the motor has to give more along the axis than against it. With `gain = 0` a negative offset is a constant \
         force. Default: 0.",
    ),
    (
        "drive.rotor",
        "Moment of inertia of what turns with the motor. The body feels it times the square of the gear; it has no weight \
         there. What is pushed has to be on an ideal prismatic joint of the frame along the axis. Default: none.",
    ),
    ("drive.gear", "Turns of the rotor for each of the body. Required with `rotor` by a drive that turns."),
    ("drive.travel", "Travel of the body for each turn of the rotor. Required with `rotor` by a drive that pushes."),
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
        "Travel from the start at which a run ends. Of a mechanism it is the travel of the first drive's body, an angle in ° \
         where that drive turns. Default: no limit; `--stroke` and the stroke's part of `slipfit run` need it.",
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
    (
        "pin.slope",
        "By how much the slide's gaps at this pin narrow towards +z of the slide; see `joint.slope`. A slide with it is computed as a \
         mechanism. Default: 0.",
    ),
    (
        "pin.bow",
        "How the slide's surfaces at this pin bow; see `joint.bow`. A slide with it is computed as a mechanism. Default: straight.",
    ),
    (
        "pin.along",
        "In place of `slope` and `bow`: the gaps of this pin at one or two other places of the travel; see `joint.along`. A slide with it is \
         computed as a mechanism.",
    ),
    ("pin.along.at", "How far (mm) the place is towards +z of the slide from where the pin is drawn."),
    ("pin.along.left", "The gap there, as `left`."),
    ("pin.along.right", "The gap there, as `right`."),
    ("pin.along.rail", "The gap there, as `rail`."),
    ("pin.along.wall", "The gap there, as `wall`."),
];

/// Keys of mechanisms, and their meaning.
pub const MECHANISM: &[(&str, &str)] = &[
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
    (
        "body.angle",
        "Rotation from the drawn pose at the start, in space about the axis of the body's ideal joint. In space without ideal joints a \
         list: the rotation vector. Default: 0.",
    ),
    (
        "body.spin",
        "Angular velocity at the start, in space about the axis of the body's ideal joint. In space without ideal joints a list, about \
         x, y and z. Default: 0.",
    ),
    (
        "body.speed",
        "Speed at the start along the axis of the body's ideal joint. Of a body that no ideal joint holds a list: its velocity. Default: 0.",
    ),
    (
        "body.displaced",
        "In space without ideal joints: how far from the drawn pose the centre of mass starts. Default: `[0, 0, 0]`.",
    ),
    ("joint.name", "Name of the joint."),
    (
        "joint.kind",
        "What the joint is. In a plane: `fixed`, `revolute`, `prismatic`, `pin-slot`, `stop`. In space: `fixed`, \
         `revolute`, `prismatic`, `cylindrical`, `spherical`, `track`, `stop`. The column *takes* shows those in space.",
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
        "Direction of the sliding, or axis of the turning. Required by `prismatic`, `pin-slot` and `cylindrical`, in space also by \
         `revolute`.",
    ),
    (
        "joint.normal",
        "Outward normal of a stop's wall: the direction in which the wall pushes the first body. In space along x, y or z. \
         Required by `stop`.",
    ),
    (
        "joint.clearance",
        "Gap: mean and standard deviation, or the name of a measure. Of `revolute` and `cylindrical` it is radial, of \
         `prismatic` on either side, of `stop` the distance to the wall. Required by `stop`. `revolute`, `prismatic` and \
         `cylindrical` without it are ideal, without play; in space `revolute` and `prismatic` always are.",
    ),
    ("joint.radius", "Radius of the pin or rod. Required by `cylindrical` and `revolute` with a clearance."),
    ("joint.length", "Length along the axis. Required by `cylindrical` and `prismatic` with a clearance."),
    ("joint.width", "Width across the axis. Required by `prismatic` with a clearance."),
    (
        "joint.left",
        "Of a track: gap between the pin's left side (towards −x) and the second body. Leave the key out where there is no \
         such surface.",
    ),
    ("joint.right", "As `left`, for the pin's right side (towards +x)."),
    ("joint.rail", "As `left`, for the rail, which lies on top of the pin."),
    ("joint.wall", "As `left`, for the wall below the pin."),
    (
        "joint.slope",
        "By how much each gap narrows over the travel, 1 for 45°: of a `track` towards +z of the second body from the drawn pose, of \
         `prismatic` with a clearance along the axis from `at`. One number for all walls, or a list: left and right of the axis; left, right, \
         rail, wall. Default: 0, parallel.",
    ),
    (
        "joint.bow",
        "`[height, length]`: the walls bow towards the gap by this height in the middle of this length, which is at the same place; \
         away from it where the height is negative. One for all walls, or a list as for `slope`. Default: straight.",
    ),
    (
        "joint.along",
        "In place of `slope` and `bow`: the gaps at one or two other places of the travel, such as \
         `[{ at = 300, clearance = \"play at the end\" }]`. With one the walls are straight, with two they bow.",
    ),
    (
        "joint.along.at",
        "How far (mm) the place is along the travel from where the joint is drawn, in the direction of `slope`.",
    ),
    ("joint.along.clearance", "Of a `prismatic` joint in a plane: the gap there, as `clearance`."),
    ("joint.along.left", "Of a track: the gap there, as `left`."),
    ("joint.along.right", "The same, as `right`."),
    ("joint.along.rail", "The same, as `rail`."),
    ("joint.along.wall", "The same, as `wall`."),
    (
        "joint.coulomb",
        "Of an ideal joint with the frame, `revolute` or `prismatic`, or a `revolute` one of any bodies in a plane: friction against its \
         motion, whatever it carries. Of two numbers the first is that of motion along or about the axis, in a plane from x to y; of two \
         moving bodies the second counts against the first. Default: none.",
    ),
    ("joint.stick_band", "Speed below which `coulomb` fades to zero. Required with it."),
    ("joint.viscous", "Of the same joints: friction that grows with the speed. Default: none."),
    ("joint.contact", "The joint's own contact law. Default: the scene's `[contact]`."),
    ("joint.friction", "The joint's own friction law. Default: the scene's `[friction]`."),
    ("spring.name", "Name of the spring."),
    ("spring.between", "The two bodies; `frame` is the body at rest."),
    ("spring.stiffness", "Torque for each unit of angle; with `ends` force for each unit of length."),
    (
        "spring.damping",
        "Torque for each unit of angular velocity; with `ends` force for each unit of speed. Default: 0.",
    ),
    (
        "spring.ends",
        "A place on either body in the drawn pose: the spring acts along the line between them. Without it the spring turns about the \
         plane's normal. Required in space.",
    ),
    (
        "spring.preload",
        "Force with which it pulls the ends together in the drawn pose, pushes if negative; of a torsion spring the torque on the first \
         body, from x to y. Default: 0, unless `free_length` is stated.",
    ),
    ("spring.free_length", "Distance of the ends without force, in place of `preload`."),
];
