//! A scene as source text: a constant and a type for firmware, in Rust against slipfit-core or in C against its library.

use std::fmt::Write;

use slipfit_core::{
    menu::{FrictionData, FrictionType, NormalType},
    scene::SceneData,
    slide::{ABSENT, CONTACTS},
};

use super::guard::{c_name, guarded};
use crate::{dynamics::driven::Driven, mechanism::scheme, setup::Scene};

/// What can be written, by a file's extension.
pub const EXTENSIONS: [&str; 2] = ["rs", "h"];

/// The slide of `scene` over the production, every number rounded once to f32.
pub fn scene_data(scene: &Scene) -> SceneData<f32> {
    let unit = scene.slide_data::<f32>(&scene.gaps_at(&[0.0; CONTACTS]));
    let statistics = || scene.pins.iter().flat_map(|pin| pin.gaps);
    let (mut gap_means, mut gap_deviations) = ([ABSENT as f32; CONTACTS], [0.0; CONTACTS]);
    for ((gap, mean), deviation) in statistics().zip(&mut gap_means).zip(&mut gap_deviations) {
        if let Some(gap) = gap {
            (*mean, *deviation) = (gap.mean as f32, gap.deviation as f32);
        }
    }
    SceneData {
        mass: unit.body.mass,
        inertia_b: unit.body.inertia_b.into(),
        gravity_w: unit.body.gravity_w.into(),
        pins_w: unit.body.pins_w.map(Into::into),
        gap_means,
        gap_deviations,
        contact: unit.contact,
        friction: unit.friction,
        drive_gain: unit.drive.gain,
        drive_ramp: [unit.drive.ramp_start, unit.drive.ramp_end],
        drive_speed: unit.drive.speed,
        drive_point_b: unit.drive.point_b.into(),
    }
}

/// The title as a comment has it: on one line.
fn title(scene: &Scene) -> String {
    scene.title.split_whitespace().collect::<Vec<_>>().join(" ").replace("*/", "* /")
}

/// Why a scene is not written for the C library.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CError {
    /// Another exponent than the library is built for.
    #[error("contact.exponent is {found}, the C library is built for 1.5; .rs knows every exponent")]
    Exponent {
        /// The exponent.
        found: f32,
    },
}

/// A Rust module with the scene as `SCENE`, its kernel's type as `Predictor` and `predictor(n)`, which makes one.
pub fn rust_source(scene: &Scene) -> String {
    let data = scene_data(scene);
    let [elastic, made_elastic, exponent] = elastic(data.contact.normal_type());
    let (friction, friction_type, made_friction, friction_data) = match (data.friction.friction_type(), data.friction) {
        (FrictionType::Regularised, FrictionData::Regularised { coefficient, stick_band }) => (
            "Regularised",
            "Regularised<f32>",
            format!("Regularised::new({coefficient:?}, {stick_band:?})?"),
            format!("FrictionData::Regularised {{ coefficient: {coefficient:?}, stick_band: {stick_band:?} }}"),
        ),
        (FrictionType::Exact, FrictionData::Exact { coefficient }) => (
            "Exact",
            "Exact<f32>",
            format!("Exact::new({coefficient:?})?"),
            format!("FrictionData::Exact {{ coefficient: {coefficient:?} }}"),
        ),
        _ => ("Frictionless", "Frictionless", "Frictionless".into(), "FrictionData::None".into()),
    };
    let (scheme, scheme_type) = scheme(scene.controller.integrator);
    let mut laws = [elastic, friction, "Impact"];
    laws.sort_unstable();
    let laws = laws.join(", ");
    let SceneData {
        mass,
        inertia_b,
        gravity_w,
        pins_w,
        gap_means,
        gap_deviations,
        contact,
        drive_gain,
        drive_ramp,
        drive_speed,
        drive_point_b,
        ..
    } = data;
    let step = scene.controller.step as f32;
    let hash = scene.hash();
    let title = title(scene);
    format!(
        "// {title}: a scene for firmware, to be compiled against slipfit-core. SI units.\n\n\
         use slipfit_core::{{\n    ParameterError,\n    integrator::{scheme},\n    kernel::Kernel,\n    law::{{{laws}}},\n    \
         menu::{{ContactData, FrictionData}},\n    scene::SceneData,\n    slide::Slide,\n}};\n\n\
         /// A unit's type: what the scene does not need leaves no code.\n\
         pub type Unit = Slide<f32, {elastic}<f32>, {friction_type}>;\n\n\
         /// The kernel's type.\npub type Predictor = Kernel<f32, Unit, {scheme_type}>;\n\n\
         /// Step (s).\npub const STEP: f32 = {step:?};\n\n\
         /// What a flash table of this scene is stamped with.\npub const SCENE_HASH: u64 = {hash:#018x};\n\n\
         /// The slide over the production.\n#[rustfmt::skip]\npub const SCENE: SceneData<f32> = SceneData {{\n    \
         mass: {mass:?},\n    inertia_b: {inertia_b:?},\n    gravity_w: {gravity_w:?},\n    pins_w: {pins_w:?},\n    \
         gap_means: {gap_means:?},\n    gap_deviations: {gap_deviations:?},\n    \
         contact: {contact:?},\n    friction: {friction_data},\n    drive_gain: {drive_gain:?},\n    \
         drive_ramp: {drive_ramp:?},\n    drive_speed: {drive_speed:?},\n    drive_point_b: {drive_point_b:?},\n}};\n\n\
         /// The kernel of a unit of tolerance level `n`.\n///\n/// # Errors\n\
         /// If a gap at that level, or `n`, is out of bounds.\n\
         pub fn predictor(n: f32) -> Result<Predictor, ParameterError<f32>> {{\n    let unit = SCENE.at(n)?;\n    \
         let ContactData {{ stiffness, {exponent}damping, depth, .. }} = unit.contact;\n    \
         let contact = Impact::new({made_elastic}, damping, depth)?;\n    \
         Kernel::new(unit.body.slide(contact, {made_friction}, unit.drive)?, STEP)\n}}\n"
    )
}

/// Name of a normal law in core, its value, and what of the contact's data that takes beside the stiffness.
pub(crate) fn elastic(normal: NormalType) -> [&'static str; 3] {
    match normal {
        NormalType::Linear => ["Linear", "Linear::new(stiffness)?", ""],
        NormalType::ThreeHalves => ["ThreeHalves", "ThreeHalves::new(stiffness)?", ""],
        NormalType::Power => ["Power", "Power::new(stiffness, exponent)?", "exponent, "],
    }
}

/// A C header with the scene, to be included after `slipfit.h`. Its names follow the `stem` of its file's name: in `scene.h` the scene
/// is `slipfit_this_scene` and its hash `SLIPFIT_SCENE_HASH`. Its scheme is the C library's, implicit Euler, whichever `scene` names.
///
/// # Errors
/// [`CError`] names what the library cannot do.
pub fn c_header(scene: &Scene, stem: &str) -> Result<String, CError> {
    let data = scene_data(scene);
    if data.contact.normal_type() != NormalType::ThreeHalves {
        return Err(CError::Exponent { found: data.contact.exponent });
    }
    let list = |values: &[f32]| {
        let texts: Vec<_> = values.iter().map(|value| format!("{value:?}f")).collect();
        format!("{{{}}}", texts.join(", "))
    };
    let pins: Vec<_> = data.pins_w.iter().map(|pin| list(pin)).collect();
    let (law, coefficient, stick_band) = match data.friction {
        FrictionData::None => ("SLIPFIT_FRICTION_REGULARISED", 0.0, 1e-4),
        FrictionData::Regularised { coefficient, stick_band } => {
            ("SLIPFIT_FRICTION_REGULARISED", coefficient, stick_band)
        }
        FrictionData::Exact { coefficient } => ("SLIPFIT_FRICTION_EXACT", coefficient, 0.0),
    };
    let name = c_name(stem);
    let upper = name.to_uppercase();
    let mut text = format!(
        "/* {}: a scene for firmware, to be included after slipfit.h. SI units. */\n\
         /* What a flash table of this scene is stamped with. */\n\
         #define SLIPFIT_{upper}_HASH {:#018x}ull\n\nstatic const slipfit_scene slipfit_this_{name} = {{\n",
        title(scene),
        scene.hash()
    );
    // In the order of slipfit.h: C++17 knows no names here.
    let mut field = |name: &str, value: &str| {
        let _ = writeln!(text, "    {value}, /* {name} */");
    };
    let number = |value: f32| format!("{value:?}f");
    field("scheme", "SLIPFIT_SCHEME_IMPLICIT_EULER");
    field("step", &number(scene.controller.step as f32));
    field("mass", &number(data.mass));
    field("inertia", &list(&data.inertia_b));
    field("gravity", &list(&data.gravity_w));
    field("pins", &format!("{{{}}}", pins.join(", ")));
    field("gap_means", &list(&data.gap_means));
    field("gap_deviations", &list(&data.gap_deviations));
    field("stiffness", &number(data.contact.stiffness));
    field("exponent", &number(data.contact.exponent));
    field("damping", &number(data.contact.damping));
    field("depth", &number(data.contact.depth));
    field("friction_law", law);
    field("friction_coefficient", &number(coefficient));
    field("friction_stick_band", &number(stick_band));
    field("drive_gain", &number(data.drive_gain));
    field("drive_ramp", &list(&data.drive_ramp));
    field("drive_speed", &number(data.drive_speed));
    field("drive_point", &list(&data.drive_point_b));
    Ok(guarded(&format!("SLIPFIT_{upper}_H"), &(text + "};\n")))
}
#[cfg(test)]
mod tests {
    use slipfit_core::slide::CONTACTS;

    use super::{CError, c_header, rust_source, scene_data};
    use crate::{
        dynamics::driven::Driven,
        scene::{CD_ROM_SLIDE, Override},
        setup::Scene,
    };

    fn scene(settings: &[&str]) -> Scene {
        let overrides: Vec<_> = settings.iter().map(|setting| Override::set(setting)).collect();
        Scene::parse("scene.toml", CD_ROM_SLIDE, &overrides).unwrap()
    }

    #[test]
    fn a_unit_is_the_one_that_the_host_simulates() {
        let scene = scene(&[]);
        let data = scene_data(&scene);
        for n in [-3.0f32, 0.0, 2.5] {
            let gaps = scene.gaps_in::<f32>(&[n.into(); CONTACTS]).map(f64::from);
            assert_eq!(data.at(n).unwrap(), scene.slide_data(&gaps), "{n}");
        }
    }

    #[test]
    fn laws_decide_what_is_written() {
        for (setting, unit) in [
            ("contact.exponent=1.5", "Slide<f32, ThreeHalves<f32>, Regularised<f32>>"),
            ("contact.exponent=1", "Slide<f32, Linear<f32>, Regularised<f32>>"),
            ("contact.exponent=1.7", "Slide<f32, Power<f32>, Regularised<f32>>"),
            ("friction.law=exact", "Slide<f32, ThreeHalves<f32>, Exact<f32>>"),
            ("friction.law=none", "Slide<f32, ThreeHalves<f32>, Frictionless>"),
        ] {
            let text = rust_source(&scene(&[setting]));
            assert!(text.contains(&format!("pub type Unit = {unit};")), "{text}");
            assert_eq!(text, rust_source(&scene(&[setting])));
        }
        assert!(c_header(&scene(&[]), "scene").unwrap().contains("    0.0818f, /* mass */\n"));
    }

    #[test]
    fn c_gets_what_its_library_does() {
        for (exponent, setting) in
            [(2.0, "contact.exponent=2"), (1.0, "contact.exponent=1"), (1.7, "contact.exponent=1.7")]
        {
            assert_eq!(c_header(&scene(&[setting]), "scene"), Err(CError::Exponent { found: exponent }));
        }
        let text = c_header(&scene(&[]), "scene").unwrap();
        assert!(text.contains("    SLIPFIT_SCHEME_IMPLICIT_EULER, /* scheme */\n"));
        assert!(text.contains(&format!("#define SLIPFIT_SCENE_HASH {:#018x}ull\n", scene(&[]).hash())));
        for law in ["exact", "regularised", "none"] {
            assert!(c_header(&scene(&[&format!("friction.law={law}")]), "scene").is_ok());
        }
    }
}
