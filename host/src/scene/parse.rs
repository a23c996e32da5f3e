//! From the text of a scene file to a scene.

use std::path::Path;

use slipfit_core::{
    drive::Drive,
    menu::{ContactData, FrictionData},
    slide::{CONTACTS, PINS, box_inertia},
};
use slipfit_tolerance::unit::{self, Quantity};

use crate::{
    dynamics::scheme::{IntegratorKind, ScalarKind},
    mechanism::{SlidingData, mobility::SURFACE_NORMALS},
};

use super::{
    Override, Problem, SceneError,
    contact::impact,
    diagnostic::{COMMAND_LINE, Found},
    friction::coulomb,
    parse_levels,
    plausible::{self, Loads},
    quantity::{GAIN, LEAST_RAMP, MASS, POINT, RAMP, SPEED},
    slide_parameters,
    tree::{Source, Value},
    uncertain::uncertain,
    value::Field,
    vary::vary,
};
use crate::setup::{ControllerSpec, GapMeasures, LevelRange, PinSpec, RunSpec, SURFACES, Scene, SlideSpec};

pub(super) const EDGE: Quantity = Quantity { units: unit::LENGTH, range: [0.001, 1e5] };
const GRAVITY: Quantity = Quantity { units: unit::ACCELERATION, range: [-1e4, 1e4] };
const CLEARANCE: Quantity = Quantity { units: unit::LENGTH, range: [0.0, 100.0] };
pub(super) const DURATION: Quantity = Quantity { units: unit::MILLISECONDS, range: [0.001, 1e6] };
pub(super) const STROKE: Quantity = Quantity { units: unit::LENGTH, range: [0.001, 1e5] };
const TURN: Quantity = Quantity { units: unit::ANGLE, range: [0.001, 1e7] };
const ERROR: Quantity = Quantity { units: unit::ONE, range: [1e-10, 0.1] };
const STEP: Quantity = Quantity { units: unit::MICROSECONDS, range: [0.002, 1e4] };

/// The desk's error where a scene states none. With it every reference run of the CD-ROM slide errs by at most 0.02 % of its
/// peak force.
const DEFAULT_ERROR: f64 = 3e-7;
/// What a controller computes where a scene states nothing else.
const DEFAULT_CONTROLLER: ControllerSpec =
    ControllerSpec { step: 1e-3, integrator: IntegratorKind::ImplicitEuler, scalar: ScalarKind::F32 };

/// kg·m²: what the slide's kernel takes.
const LEAST_MOMENT: f64 = 1e-12;
/// Reads the slide and its run around the `pins`.
pub(super) fn scene(
    root: &Field,
    title: String,
    pins: [PinSpec; PINS],
    gap_measures: GapMeasures,
) -> Result<Scene, SceneError> {
    let found = root.found();
    let nothing = SlideSpec { mass: 1.0, inertia_box: [1.0; 3], gravity: [0.0; 3] };
    let slide = found.recover(root.table("slide").and_then(|table| slide(&table)), nothing);
    let nothing = ContactData { stiffness: 1.0, exponent: 1.0, damping: 0.0, depth: 1.0 };
    let contact = found.recover(root.table("contact").and_then(|table| impact(&table)), nothing);
    let friction = found.recover(root.table("friction").and_then(|table| coulomb(&table)), FrictionData::None);
    let controller =
        found.recover(controller(root, matches!(friction, FrictionData::Exact { .. })), DEFAULT_CONTROLLER);
    let nothing = RunSpec { duration: 1.0, stroke: None, error: DEFAULT_ERROR };
    let run = found.recover(root.table("run").and_then(|table| run(&table, false)), nothing);
    let nothing = Drive { gain: 1.0, ramp_start: 0.0, ramp_end: 1.0, speed: 0.0, point_b: [0.0; 3].into() };
    let drive = found.recover(root.table("drive").and_then(|table| drive(&table)), nothing);
    let nothing = LevelRange { first: 0.0, step: 1.0, count: 1 };
    let levels = found.recover(root.table("sweep").and_then(|table| sweep(&table)), nothing);
    let nominal_clearance = found.recover(nominal_clearance(root), None);
    let scene = Scene {
        title,
        slide,
        contact,
        friction,
        drive,
        pins,
        nominal_clearance,
        run,
        controller,
        sweep: levels,
        vary: Vec::new(),
        uncertain: Vec::new(),
        gap_measures,
        measured: None,
        warnings: Vec::new(),
    };
    let named = |table| slide_parameters::named(root, table, &scene);
    let varied = found.recover(named("vary").and_then(vary), Vec::new());
    let unknown = found.recover(named("uncertain").and_then(|named| uncertain(root, named, &scene)), Vec::new());
    let scene = Scene { vary: varied, uncertain: unknown, ..scene };
    for i in [0, scene.sweep.count - 1] {
        scene.check_gaps(&[scene.sweep.level(i); CONTACTS]).map_err(|error| {
            let table = root.get("sweep").unwrap_or(root.clone());
            table.get("n").unwrap_or(table).error(Problem::Gap(error), "")
        })?;
    }
    // With values that stand for wrong ones, or a weight that is doubtful itself, there is nothing to judge.
    let SlideSpec { mass, inertia_box, gravity } = scene.slide;
    let weighs =
        plausible::is_gravity(gravity) && plausible::is_body(mass, false, box_inertia(mass, inertia_box).into());
    if weighs && !found.any() {
        doubt(root, &scene);
    }
    Ok(scene)
}

/// Warns about what is implausible in a `scene` as a whole, which was read from `root`.
fn doubt(root: &Field, scene: &Scene) {
    let loads = Loads::new(scene.slide.mass, scene.slide.gravity, (scene.drive.gain * scene.drive.speed).abs());
    let gaps = || scene.pins.iter().flat_map(|pin| pin.gaps).flatten();
    let widest = gaps().map(|gap| gap.mean.abs() + 3.0 * gap.deviation).fold(0.0, f64::max);
    // The pins on which the slide lies: gravity points out of the surface that meets them.
    let carry = |normal: [f64; 3]| normal.iter().zip(scene.slide.gravity).map(|(n, g)| n * g).sum::<f64>() > 0.0;
    let carries =
        |pin: &&PinSpec| SURFACE_NORMALS.iter().zip(pin.gaps).any(|(normal, gap)| gap.is_some() && carry(*normal));
    let contacts = scene.pins.iter().filter(carries).count();
    let law = [scene.contact.stiffness, scene.contact.exponent];
    if let Some(field) = root.get("contact").and_then(|contact| contact.get("stiffness")) {
        let is_soft = plausible::stiffness(&field, law, loads, contacts, widest);
        if let Some(table) = root.get("contact").filter(|_| !is_soft) {
            plausible::damping(&table, &scene.contact, scene.slide.mass, widest);
        }
    }
    if let Some(field) = root.get("drive").and_then(|drive| drive.get("gain")) {
        plausible::gain(&field, scene.drive.gain);
    }
    if let Some(field) = root.get("friction").and_then(|friction| friction.get("stick_band")) {
        plausible::stick_band(&field, SlidingData::Coulomb(scene.friction).stick_band(), scene.drive.speed.abs());
    }
    let Some(Value::List(nodes)) = root.get("pin").map(|pins| &pins.node.value) else { return };
    for (node, pin) in nodes.iter().zip(&scene.pins) {
        let table = Field { key: "pin".into(), node };
        for (surface, gap) in SURFACES.into_iter().zip(pin.gaps) {
            if let Some((field, gap)) = table.get(surface).zip(gap) {
                let name = format!("{} {surface}", pin.name);
                plausible::pressed(&field, &name, false, gap.mean, law, loads);
            }
        }
    }
}

/// Reads the interval (s) between samples from what follows `--every`: a number in ms or with its unit.
///
/// # Errors
/// [`SceneError`] points into the option.
pub fn parse_every(text: &str) -> Result<f64, SceneError> {
    let change = Override::option("--every", "every", text);
    let found = Found::default();
    let mut tree = Source { name: COMMAND_LINE, text: "", found: &found }.document()?;
    tree.set(&change)?;
    found.conclude(Field { key: String::new(), node: &tree }.number("every", &DURATION))
}

pub(super) fn title(root: &Field, file_name: &str) -> Result<String, SceneError> {
    if let Some(title) = root.get("title") {
        return title.to_text().map(str::to_owned);
    }
    let stem = Path::new(file_name).file_stem().unwrap_or_default().to_string_lossy();
    // It is printed as it is; control characters would steer the terminal.
    Ok(stem.chars().map(|c| if c.is_control() { ' ' } else { c }).collect())
}

fn slide(table: &Field) -> Result<SlideSpec, SceneError> {
    let mass = table.number("mass", &MASS)?;
    let edges = table.require("inertia_box", "a list of 3 lengths in mm")?;
    let inertia_box = edges.to_numbers(&EDGE)?;
    let moments = box_inertia(mass, inertia_box);
    if moments.min() < LEAST_MOMENT {
        return Err(edges.out_of_range("mm", format!("moments of inertia of at least {LEAST_MOMENT:e} kg·m²")));
    }
    let gravity = table.numbers("gravity", &GRAVITY)?;
    if let Some((of_mass, of_gravity)) = table.get("mass").zip(table.get("gravity")) {
        plausible::gravity(&of_gravity, gravity);
        plausible::slide(&of_mass, mass, moments.into());
    }
    Ok(SlideSpec { mass, inertia_box, gravity })
}

fn drive(table: &Field) -> Result<Drive<f64>, SceneError> {
    let ramp_start = table.number("ramp_start", &RAMP)?;
    let end = table.require("ramp_end", &RAMP.units())?;
    let ramp_end = end.to_number(&RAMP)?;
    if ramp_end - ramp_start < LEAST_RAMP {
        return Err(end.out_of_range("s", format!("more than drive.ramp_start, {ramp_start} s, by 1 µs or more")));
    }
    let point: [f64; 3] = table.get("point").map(|point| point.to_numbers(&POINT)).transpose()?.unwrap_or_default();
    Ok(Drive {
        gain: table.number("gain", &GAIN)?,
        ramp_start,
        ramp_end,
        speed: table.number("speed", &SPEED)?,
        point_b: point.into(),
    })
}

fn nominal_clearance(root: &Field) -> Result<Option<[f64; 2]>, SceneError> {
    let Some(drawing) = root.get("drawing") else { return Ok(None) };
    drawing.expect_table()?;
    drawing.get("clearance").map(|field| field.to_numbers(&CLEARANCE)).transpose()
}

/// Reads the table `run`, whose stroke is a length, or an angle where the drive `turns`.
pub(super) fn run(table: &Field, turns: bool) -> Result<RunSpec, SceneError> {
    let stroke = if turns { &TURN } else { &STROKE };
    Ok(RunSpec {
        duration: table.number("duration", &DURATION)?,
        stroke: table.get("stroke").map(|field| field.to_number(stroke)).transpose()?,
        error: table.get("error").map(|field| field.to_number(&ERROR)).transpose()?.unwrap_or(DEFAULT_ERROR),
    })
}

/// Reads the optional table `controller`, of which every key is optional. Friction that `sticks` needs an implicit scheme.
pub(super) fn controller(root: &Field, sticks: bool) -> Result<ControllerSpec, SceneError> {
    let Some(table) = root.get("controller") else { return Ok(DEFAULT_CONTROLLER) };
    table.expect_table()?;
    let step = table.get("step").map(|field| field.to_number(&STEP)).transpose()?;
    let integrator = table.get("integrator").map(|field| integrator(&field, sticks)).transpose()?;
    let scalar = table.get("scalar").map(|field| choice(&field, ScalarKind::ALL, ScalarKind::name)).transpose()?;
    Ok(ControllerSpec {
        step: step.unwrap_or(DEFAULT_CONTROLLER.step),
        integrator: integrator.unwrap_or(DEFAULT_CONTROLLER.integrator),
        scalar: scalar.unwrap_or(DEFAULT_CONTROLLER.scalar),
    })
}

/// The one of `all` whose `name` is the text of `field`.
pub(super) fn choice<T: Copy, const N: usize>(
    field: &Field,
    all: [T; N],
    name: fn(T) -> &'static str,
) -> Result<T, SceneError> {
    let text = field.to_text()?;
    all.into_iter().find(|one| name(*one) == text).ok_or_else(|| {
        let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
        field.error(problem, all.map(name).join(", "))
    })
}

fn integrator(field: &Field, sticks: bool) -> Result<IntegratorKind, SceneError> {
    let kind = choice(field, IntegratorKind::ALL, IntegratorKind::name)?;
    if sticks && !kind.is_implicit() {
        let implicit: Vec<_> = IntegratorKind::ALL.into_iter().filter(|kind| kind.is_implicit()).collect();
        let names = implicit.into_iter().map(IntegratorKind::name).collect::<Vec<_>>().join(", ");
        return Err(field.error(Problem::ExplicitFriction(kind.name().into()), names));
    }
    Ok(kind)
}

pub(super) fn sweep(table: &Field) -> Result<LevelRange, SceneError> {
    const ALLOWED: &str = "a text \"FIRST:LAST:STEP\", such as \"-3:5:0.1\", of at most 100000 levels, or one level";
    let field = table.require("n", ALLOWED)?;
    let levels = match &field.node.value {
        Value::Text(text) => parse_levels(text),
        Value::Number(level) => parse_levels(&level.to_string()),
        _ => return Err(field.wrong_type(ALLOWED)),
    };
    levels.map_err(|error| field.error(Problem::Levels { key: field.key.clone(), error }, ALLOWED))
}
