//! A mechanism as the comparison knows it, in SI units, and the scene file that describes it to slipfit.

use std::fmt::Write;

use nalgebra::Vector3;

/// A vector in the axes of the frame, or of a body.
pub type Vec3 = Vector3<f64>;

/// A body, or the frame where there is none.
pub type Port = Option<usize>;

/// A mechanism and its run.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Whether it lies in the plane z = 0.
    pub planar: bool,
    /// Gravity (m/s²).
    pub gravity: Vec3,
    pub bodies: Vec<Body>,
    pub joints: Vec<Joint>,
    pub springs: Vec<Spring>,
    pub drives: Vec<Drive>,
    /// Duration of the run (s).
    pub duration: f64,
}

/// A rigid body in the drawn pose, and how it starts.
#[derive(Clone, Debug)]
pub struct Body {
    pub name: String,
    /// Mass (kg).
    pub mass: f64,
    /// Principal moments of inertia (kg·m²), about axes that are those of the frame in the drawn pose.
    pub inertia: Vec3,
    /// Centre of mass (m).
    pub centre: Vec3,
    /// Angle (rad), angular velocity (rad/s) and sliding speed (m/s) at the start.
    pub angle: f64,
    pub spin: f64,
    pub speed: f64,
}

#[derive(Clone, Debug)]
pub struct Joint {
    pub name: String,
    pub between: [Port; 2],
    /// Where it is in the drawn pose (m).
    pub at: Vec3,
    pub kind: Kind,
    /// Laws of its contacts; ideal joints have none.
    pub laws: Option<Laws>,
}

/// Kinds of joints, ideal and with clearance. Axes and normals have unit length.
#[derive(Clone, Debug)]
pub enum Kind {
    Fixed,
    Revolute(Vec3),
    Prismatic(Vec3),
    PinSlot(Vec3),
    Cylindrical(Vec3),
    Spherical,
    Journal {
        gap: f64,
        radius: f64,
    },
    Guide {
        gap: f64,
        axis: Vec3,
        edges: [f64; 2],
    },
    Bearing {
        gap: f64,
        axis: Vec3,
        length: f64,
        radius: f64,
    },
    /// Gaps on the left, on the right, to the rail and to the wall.
    Track([Option<f64>; 4]),
    Stop {
        gap: f64,
        normal: Vec3,
    },
}

impl Kind {
    pub fn is_ideal(&self) -> bool {
        use Kind::{Cylindrical, Fixed, PinSlot, Prismatic, Revolute, Spherical};
        matches!(self, Fixed | Revolute(_) | Prismatic(_) | PinSlot(_) | Cylindrical(_) | Spherical)
    }
}

/// Laws of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Laws {
    /// Stiffness k (N/m^e) and exponent e.
    pub stiffness: f64,
    pub exponent: f64,
    pub loss: Loss,
    /// Coefficient μ and stick band (m/s).
    pub friction: Option<[f64; 2]>,
}

/// What a contact loses along its normal.
#[derive(Clone, Copy, Debug)]
pub enum Loss {
    /// Damping (N·s/m), full at a depth (m).
    Impact { damping: f64, depth: f64 },
    /// Hunt and Crossley's law: restitution, and the approach speed (m/s) that it holds at.
    HuntCrossley { restitution: f64, speed: f64 },
    /// Lankarani and Nikravesh's law, likewise.
    LankaraniNikravesh { restitution: f64, speed: f64 },
}

/// A torsion spring about z: stiffness (N·m/rad) and damping (N·m·s/rad).
#[derive(Clone, Debug)]
pub struct Spring {
    pub between: [Port; 2],
    pub stiffness: f64,
    pub damping: f64,
}

/// A speed-controlled drive from the frame.
#[derive(Clone, Debug)]
pub struct Drive {
    pub body: usize,
    /// Whether it exerts a torque about the axis instead of a force along it.
    pub turns: bool,
    pub axis: Vec3,
    /// Where a force acts (m), from the centre of mass.
    pub point: Vec3,
    /// Whether it controls the speed of the centre of mass, not that of its point.
    pub at_centre: bool,
    /// Gain (N·s/m or N·m·s/rad).
    pub gain: f64,
    /// Start and end of the ramp (s).
    pub ramp: [f64; 2],
    /// Commanded speed (m/s or rad/s).
    pub speed: f64,
}

impl Scene {
    fn name(&self, port: Port) -> &str {
        port.map_or("frame", |body| &self.bodies[body].name)
    }

    fn between(&self, [first, second]: [Port; 2]) -> String {
        format!("[\"{}\", \"{}\"]", self.name(first), self.name(second))
    }

    /// Lengths with their unit.
    fn place(&self, at: &Vec3) -> String {
        let all: Vec<_> = at.iter().take(self.dimensions()).map(|x| format!("\"{x:e} m\"")).collect();
        format!("[{}]", all.join(", "))
    }

    /// Numbers without a unit.
    fn numbers(&self, values: &Vec3) -> String {
        let all: Vec<_> = values.iter().take(self.dimensions()).map(|x| format!("{x:e}")).collect();
        format!("[{}]", all.join(", "))
    }

    fn dimensions(&self) -> usize {
        if self.planar { 2 } else { 3 }
    }

    /// The scene file, with a desk that may err by `error` of the mechanism's own speed.
    pub fn toml(&self, error: f64) -> String {
        let mut text = format!(
            "[mechanism]\nspace = \"{}\"\ngravity = {}\n",
            if self.planar { "plane" } else { "space" },
            self.numbers(&self.gravity)
        );
        for body in &self.bodies {
            let Body { name, mass, inertia, centre, angle, spin, speed } = body;
            let moments = if self.planar {
                format!("\"{:e} kg·m²\"", inertia.z)
            } else {
                format!("[{}]", inertia.iter().map(|i| format!("\"{i:e} kg·m²\"")).collect::<Vec<_>>().join(", "))
            };
            text += &format!("\n[[body]]\nname = \"{name}\"\nmass = \"{mass:e} kg\"\ninertia = {moments}\n");
            text += &format!("centre = {}\n", self.place(centre));
            for (key, value, unit) in [("angle", angle, "rad"), ("spin", spin, "rad/s"), ("speed", speed, "m/s")] {
                if *value != 0.0 {
                    text += &format!("{key} = \"{value:e} {unit}\"\n");
                }
            }
        }
        self.joints.iter().for_each(|joint| self.write_joint(joint, &mut text));
        for (i, Spring { between, stiffness, damping }) in self.springs.iter().enumerate() {
            let between = self.between(*between);
            text += &format!("\n[[spring]]\nname = \"spring {i}\"\nbetween = {between}\n");
            text += &format!("stiffness = {stiffness:e}\ndamping = {damping:e}\n");
        }
        for (i, drive) in self.drives.iter().enumerate() {
            let Drive { body, turns, axis, point, at_centre, gain, ramp: [start, end], speed } = drive;
            let (verb, of_gain, of_speed) =
                if *turns { ("turns", "N·m·s/rad", "rad/s") } else { ("pushes", "N·s/m", "m/s") };
            text += &format!("\n[[drive]]\nname = \"drive {i}\"\n{verb} = \"{}\"\n", self.bodies[*body].name);
            if !self.planar || !turns {
                text += &format!("axis = {}\n", self.numbers(axis));
            }
            if !turns && point.norm() > 0.0 {
                text += &format!("point = {}\n", self.place(point));
                text += if *at_centre { "controls = \"centre\"\n" } else { "" };
            }
            text += &format!("gain = \"{gain:e} {of_gain}\"\nspeed = \"{speed:e} {of_speed}\"\n");
            text += &format!("ramp_start = {start:e}\nramp_end = {end:e}\n");
        }
        text + &format!("\n[run]\nduration = \"{:e} s\"\nerror = {error:e}\n", self.duration)
    }

    fn write_joint(&self, joint: &Joint, text: &mut String) {
        let Joint { name, between, at, kind, laws } = joint;
        let mm = |gap: &f64| format!("[{:e}, 0]", gap * 1e3);
        let (kind, keys) = match kind {
            Kind::Fixed => ("fixed", String::new()),
            Kind::Revolute(_) if self.planar => ("revolute", String::new()),
            Kind::Revolute(axis) => ("revolute", format!("axis = {}\n", self.numbers(axis))),
            Kind::Prismatic(axis) => ("prismatic", format!("axis = {}\n", self.numbers(axis))),
            Kind::PinSlot(axis) => ("pin-slot", format!("axis = {}\n", self.numbers(axis))),
            Kind::Cylindrical(axis) => ("cylindrical", format!("axis = {}\n", self.numbers(axis))),
            Kind::Spherical => ("spherical", String::new()),
            Kind::Journal { gap, radius } => {
                ("revolute", format!("clearance = {}\nradius = \"{radius:e} m\"\n", mm(gap)))
            }
            Kind::Guide { gap, axis, edges: [length, width] } => {
                let edges = format!("length = \"{length:e} m\"\nwidth = \"{width:e} m\"\n");
                ("prismatic", format!("clearance = {}\naxis = {}\n{edges}", mm(gap), self.numbers(axis)))
            }
            Kind::Bearing { gap, axis, length, radius } => {
                let sizes = format!("length = \"{length:e} m\"\nradius = \"{radius:e} m\"\n");
                ("cylindrical", format!("clearance = {}\naxis = {}\n{sizes}", mm(gap), self.numbers(axis)))
            }
            Kind::Track(gaps) => {
                let names = ["left", "right", "rail", "wall"];
                let gap = |(name, gap): (&str, &Option<f64>)| gap.map(|gap| format!("{name} = {}\n", mm(&gap)));
                ("track", names.into_iter().zip(gaps).filter_map(gap).collect())
            }
            Kind::Stop { gap, normal } => {
                ("stop", format!("clearance = {}\nnormal = {}\n", mm(gap), self.numbers(normal)))
            }
        };
        let (between, at) = (self.between(*between), self.place(at));
        let _ =
            write!(text, "\n[[joint]]\nname = \"{name}\"\nkind = \"{kind}\"\nbetween = {between}\nat = {at}\n{keys}");
        let Some(Laws { stiffness, exponent, loss, friction }) = laws else { return };
        let loss = match loss {
            Loss::Impact { damping, depth } => format!("damping = \"{damping:e} N·s/m\", depth = \"{depth:e} m\""),
            Loss::HuntCrossley { restitution, speed } => {
                format!("law = \"hunt-crossley\", restitution = {restitution:e}, speed = \"{speed:e} m/s\"")
            }
            Loss::LankaraniNikravesh { restitution, speed } => {
                format!("law = \"lankarani-nikravesh\", restitution = {restitution:e}, speed = \"{speed:e} m/s\"")
            }
        };
        let _ = writeln!(
            text,
            "contact = {{ stiffness = \"{stiffness:e} N/m^{exponent}\", exponent = {exponent}, {loss} }}"
        );
        if let Some([coefficient, band]) = friction {
            let _ = writeln!(
                text,
                "friction = {{ law = \"regularised\", coefficient = {coefficient:e}, stick_band = \"{band:e} m/s\" }}"
            );
        }
    }
}
