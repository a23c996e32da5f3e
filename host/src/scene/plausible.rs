//! Values that are possible but implausible. A warning at their line gives the usual value, and the unit that may be meant.

use std::f64::consts::PI;

use slipfit_core::menu::ContactData;
use slipfit_tolerance::number::{ten_digits, three_digits};
use slipfit_tolerance::unit::{self, Unit};

use super::value::Field;

/// Earth's gravity (m/s²).
const EARTH: f64 = 9.81;
/// Gravities (m/s²) that are usual, from a hundredth of Earth's to ten times it.
const GRAVITY: [f64; 2] = [EARTH / 100.0, 10.0 * EARTH];
/// The greatest coefficient of friction of dry solids; rubber has about 1.5.
const FRICTION: f64 = 2.0;
/// Density of the densest solid, osmium (kg/m³).
const DENSEST: f64 = 22_590.0;
/// A rod of this density (kg/m³) and slenderness has the greatest moment of inertia that is usual for its mass.
const ROD: [f64; 2] = [1000.0, 1000.0];
/// How many times less than a ball of the densest solid a body's radius of gyration about one axis may be: a needle of steel has
/// a third about its own axis.
const NEEDLE: f64 = 5.0;
/// How many times more than it takes to stop all that moves without a rebound a contact's damping may be.
const OVERDAMPED: f64 = 1000.0;
/// How many times deeper than the widest gap the penetration of full damping may be.
const DEEP: f64 = 10.0;
/// How many times greater than weight and drive force together the force of a joint pressed at the start may be.
const PRESSED: f64 = 10.0;

/// Length of a vector.
fn length(of: [f64; 3]) -> f64 {
    libm::sqrt(of.iter().map(|x| x * x).sum())
}

/// Whether a planet has this `gravity` (m/s²), or there is none.
pub(super) fn is_gravity(gravity: [f64; 3]) -> bool {
    let length = length(gravity);
    length == 0.0 || (GRAVITY[0]..=GRAVITY[1]).contains(&length)
}

/// Warns about a `gravity` (m/s²) that is stated by `field` and that no planet has.
pub(super) fn gravity(field: &Field, gravity: [f64; 3]) {
    let length = length(gravity);
    let is_usual = |length: f64| (GRAVITY[0]..=GRAVITY[1]).contains(&length);
    if is_gravity(gravity) {
        return;
    }
    let units = [("mm/s²", length / 1e3), ("m/s²", length * 1e3)];
    let meant = units.iter().find(|(_, length)| is_usual(*length));
    let meant = meant.map_or_else(String::new, |(unit, _)| format!("; {unit} may be meant"));
    let key = &field.key;
    field.warn(&format!("`{key}` is {} m/s² long, usual is {EARTH} m/s²{meant}", ten_digits(length)));
}

/// Warns about a `coefficient` of friction that no pair of materials has.
pub(super) fn friction(field: &Field, coefficient: f64) {
    if coefficient > FRICTION {
        let (key, value, share) = (&field.key, ten_digits(coefficient), ten_digits(coefficient / 100.0));
        field.warn(&format!("`{key}` is {value}, usual is 0.05 to 1; {share} if per cent is meant"));
    }
}

/// Warns about a stick band, stated by `field`, that is wider than the commanded `speed` (m/s): all sliding is then
/// inside it, where friction acts as a damper.
pub(super) fn stick_band(field: &Field, stick_band: Option<f64>, speed: f64) {
    let Some(stick_band) = stick_band else { return };
    if speed == 0.0 || stick_band <= speed {
        return;
    }
    let [band, speed] = [stick_band * 1e3, speed * 1e3].map(ten_digits);
    field.warn(&format!(
        "`{}` is {band} mm/s, more than the commanded {speed} mm/s: inside the band friction grows with speed as a damper's does, and \
         holds nothing; usual is a hundredth of the speed or less",
        field.key
    ));
}

/// The least and the greatest radius of gyration (m) about one axis that are usual for a `mass` (kg), and the least that three
/// equal ones can be of any solid: that of a ball of the densest.
fn gyrations(mass: f64) -> [f64; 3] {
    let ball = libm::cbrt(3.0 * mass / (4.0 * PI * DENSEST)) * libm::sqrt(0.4);
    let [density, slenderness] = ROD;
    let rod = libm::cbrt(4.0 * mass * slenderness * slenderness / (PI * density)) / libm::sqrt(12.0);
    [ball / NEEDLE, rod, ball]
}

/// Whether a body of this `mass` (kg) usually has these `moments` of inertia (kg·m²), of which in a plane the last alone counts.
pub(super) fn is_body(mass: f64, planar: bool, moments: [f64; 3]) -> bool {
    let [least, greatest, ball] = gyrations(mass);
    if planar {
        let gyration = libm::sqrt(moments[2] / mass);
        return (least..=greatest).contains(&gyration);
    }
    // Of all bodies of one mass and density a ball has the least sum.
    let mean = libm::sqrt(moments.iter().sum::<f64>() / 3.0 / mass);
    (0.95 * ball..=greatest).contains(&mean)
}

/// Warns about `moments` of inertia (kg·m²), stated by `field`, that no body of this `mass` (kg) has.
pub(super) fn inertia(field: &Field, mass: f64, planar: bool, moments: [f64; 3]) {
    if is_body(mass, planar, moments) {
        return;
    }
    let [least, greatest, ball] = gyrations(mass).map(|gyration| gyration * 1e3).map(three_digits);
    let mean = if planar { moments[2] } else { moments.iter().sum::<f64>() / 3.0 };
    let gyration = three_digits(1e3 * libm::sqrt(mean / mass));
    let (key, written) = (&field.key, field.written(""));
    let mass_g = ten_digits(mass * 1e3);
    let least = if planar { least } else { ball };
    field.warn(&format!(
        "`{key}` is {written}: with a mass of {mass_g} g a radius of gyration of {gyration} mm, usual is {least} to {greatest} mm\
         {}",
        inertia_meant(field, mass, planar, moments)
    ));
}

/// The unit in which the moments of inertia that `field` states would be those of a body of this `mass` (kg).
pub(super) fn inertia_meant(field: &Field, mass: f64, planar: bool, moments: [f64; 3]) -> String {
    // A bare number is in the first unit, so that its value in another is this many times as great.
    let times = |unit: &Unit| unit.to_si(1.0) / unit::INERTIA[0].to_si(1.0);
    let fits = |unit: &&Unit| is_body(mass, planar, moments.map(|moment| moment * times(unit)));
    let is_bare = !field.node.place.text().contains('"');
    let meant = unit::INERTIA.iter().skip(1).find(fits).filter(|_| is_bare);
    meant.map_or_else(String::new, |unit| {
        format!("; a bare number is in {}, {} may be meant", unit::INERTIA[0].symbol, unit.symbol)
    })
}

/// Warns about the mass of a slide, stated by `field`, and the edges of its box where no body of that `mass` (kg) has the `moments`
/// of inertia (kg·m²) of that box.
pub(super) fn slide(field: &Field, mass: f64, moments: [f64; 3]) {
    if is_body(mass, false, moments) {
        return;
    }
    let [_, greatest, ball] = gyrations(mass).map(|gyration| three_digits(gyration * 1e3));
    let mean = three_digits(1e3 * libm::sqrt(moments.iter().sum::<f64>() / 3.0 / mass));
    let (key, written) = (&field.key, field.written("g"));
    field.warn(&format!(
        "`{key}` is {written}: in the box of slide.inertia_box that is a radius of gyration of {mean} mm, usual is {ball} to \
         {greatest} mm; a bare mass is in g, a bare length in mm"
    ));
}

/// What presses the parts of a scene together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loads {
    /// Weight of all that moves (N).
    pub weight: f64,
    /// The greatest force of all drives that push (N).
    pub drives: f64,
}

impl Loads {
    /// Those of a `mass` (kg) in `gravity` (m/s²) and of `drives` (N).
    pub(super) fn new(mass: f64, gravity: [f64; 3], drives: f64) -> Self {
        Self { weight: mass * length(gravity), drives }
    }
}

/// How deep (m) a contact of a `stiffness` (N/m^e) yields to a `load` (N).
pub(super) fn sink_depth(stiffness: f64, exponent: f64, load: f64) -> f64 {
    libm::pow(load / stiffness, 1.0 / exponent)
}

/// Warns about a `stiffness` (N/m^e), stated by `field`, to which the weight, or where there is none the drive's force, presses the parts
/// deeper than their `widest` gap (m), shared evenly by a number of contacts. Whether it does.
pub(super) fn stiffness(
    field: &Field,
    [stiffness, exponent]: [f64; 2],
    loads: Loads,
    contacts: usize,
    widest: f64,
) -> bool {
    let (load, whose) = if loads.weight > 0.0 { (loads.weight, "weight") } else { (loads.drives, "drive's force") };
    let share = load / contacts.max(1) as f64;
    let depth = |stiffness: f64| sink_depth(stiffness, exponent, share);
    let deep = depth(stiffness);
    // Less than a hundredth of a millimetre is no play to compare with.
    if load == 0.0 || deep <= widest.max(1e-5) {
        return false;
    }
    let other = stiffness * libm::pow(1e3, exponent);
    let is_per_metre = field.written("").contains("N/m^") || field.written("").ends_with("N/m");
    let meant = if is_per_metre && depth(other) <= widest.max(1e-5) {
        format!("; N/mm^{exponent} may be meant")
    } else {
        String::new()
    };
    let (key, written) = (&field.key, field.written(&format!("N/mm^{exponent}")));
    let [load, deep, widest] = [load, deep * 1e3, widest * 1e3].map(three_digits);
    let shared = if contacts > 1 { format!(", shared by {contacts} contacts,") } else { String::new() };
    field.warn(&format!(
        "`{key}` is {written}: under the {whose} of {load} N{shared} the parts sink {deep} mm into each other, where their widest gap \
         is {widest} mm; usual is a small share of a gap{meant}"
    ));
    true
}

/// Warns where `contact`, the law in a `table`, damps a `mass` (kg) far more than it takes to stop it without a rebound, or reaches its
/// damping only at a penetration that is far deeper than the `widest` gap (m).
pub(super) fn damping(table: &Field, contact: &ContactData<f64>, mass: f64, widest: f64) {
    let ContactData { stiffness, exponent, damping, depth } = *contact;
    let tangent = exponent * stiffness * libm::pow(depth, exponent - 1.0);
    let critical = 2.0 * libm::sqrt(tangent * mass);
    if let Some(field) = table.get("damping").filter(|_| damping > OVERDAMPED * critical) {
        let [times, critical] = [damping / critical, critical / 1e3].map(three_digits);
        field.warn(&format!(
            "`{}` is {}: {times} times the {critical} N·s/mm at which a contact of this stiffness stops {} g without a rebound; \
             usual is a share of that to ten times",
            field.key,
            field.written("N·s/mm"),
            ten_digits(mass * 1e3)
        ));
    }
    // Less than a tenth of a millimetre is no play to compare with.
    let most = DEEP * widest.max(1e-4);
    if let Some(field) = table.get("depth").filter(|_| depth > most) {
        field.warn(&format!(
            "`{}` is {}, where the widest gap is {} mm: contacts this shallow are hardly damped; usual is a share of a gap",
            field.key,
            field.written("mm"),
            three_digits(widest * 1e3)
        ));
    }
}

/// Warns about a `gain` of 0, with which a drive exerts no force.
pub(super) fn gain(field: &Field, gain: f64) {
    if gain == 0.0 {
        field.warn(&format!("`{}` is 0: the drive exerts no force, whatever it commands", field.key));
    }
}

/// Warns about a pin, whose `radius` (m) is stated by `field`, that is smaller than its radial clearance `gap` (m). A radius of 0 means friction without a torque.
pub(super) fn radius(field: &Field, radius: f64, gap: f64) {
    if radius > 0.0 && radius < gap {
        let [radius, gap] = [radius * 1e3, gap * 1e3].map(ten_digits);
        field.warn(&format!(
            "`{}` is {radius} mm, less than the radial clearance of {gap} mm: a pin is usually a hundred times larger than its play",
            field.key
        ));
    }
}

/// Warns about a `gap` (m), stated by `field`, that presses a joint called `name` at the start far harder than weight and drives.
pub(super) fn pressed(
    field: &Field,
    name: &str,
    is_stop: bool,
    gap: f64,
    [stiffness, exponent]: [f64; 2],
    loads: Loads,
) {
    let load = loads.weight + loads.drives;
    if gap >= 0.0 || load == 0.0 {
        return;
    }
    let force = stiffness * libm::pow(-gap, exponent);
    if force <= PRESSED * load {
        return;
    }
    let [depth, load] = [-gap * 1e3, load].map(three_digits);
    let force = ten_digits(force.round());
    let why = if is_stop {
        "the normal points from the wall to the point, and a point that is free has a positive clearance: is one of the two reversed?"
    } else {
        "a gap of parts that are free is positive"
    };
    field.warn(&format!(
        "`{}` presses \"{name}\" {depth} mm deep at the start, with {force} N, where weight and drive have {load} N: {why}",
        field.key
    ));
}

/// Whether moments of inertia can be those of a rigid body: none is greater than the other two together. They may be rounded to three
/// digits.
pub(super) fn are_moments(moments: [f64; 3]) -> bool {
    const ROUNDED: f64 = 1e-3;
    let sum: f64 = moments.iter().sum();
    moments.iter().all(|moment| *moment <= (sum - moment) * (1.0 + ROUNDED))
}
