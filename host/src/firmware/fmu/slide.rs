//! A slide on pins as a co-simulation unit.

use std::{fmt::Write, path::Path};

use slipfit_core::menu::FrictionType;

use super::{
    Unit, model,
    variable::{Causality, Variables},
};
use crate::{
    dynamics::driven::Driven,
    firmware::{
        kernel_crate::slide_crate,
        kernel_source::{elastic, scene_data},
    },
    setup::{GAP_MOST, Scene},
};

/// The unit of `scene`; `core` is where slipfit-core lies.
pub fn slide_unit(scene: &Scene, core: &Path) -> Unit {
    use Causality::{Fixed, Input, Tunable};
    let token = super::token(scene.hash(), &scene.controller);
    let mut variables = Variables::default();
    variables.set(Fixed, "n", "1", 0.0, super::LEVEL);
    let (mut body, mut outputs) = (String::new(), String::new());
    let names = scene.contact_names();
    let statistics = scene.pins.iter().flat_map(|pin| pin.gaps);
    let gaps: Vec<_> =
        names.iter().zip(statistics).enumerate().filter_map(|(i, (name, gap))| Some((i, name, gap?))).collect();
    for (i, name, gap) in &gaps {
        let what = format!("gap {name} at level 0 in the nominal pose; negative is preload");
        let mean = variables.set(Fixed, format!("gap.{name}"), "m", gap.mean, what);
        let deviation = format!("SCENE.gap_deviations[{i}]");
        let allowed = [-GAP_MOST, GAP_MOST];
        let _ = writeln!(body, "        unit.body.gaps[{i}] = {};", model::gap(name, &mean, &deviation, allowed));
    }
    let has_friction = scene.friction.friction_type() != FrictionType::Frictionless;
    let coefficient = has_friction.then(|| {
        let start = scene.friction.coefficient();
        variables.set(Tunable, "friction.coefficient", "1", start, "coefficient of friction")
    });
    let gain = variables.set(Tunable, "drive.gain", "N.s/m", scene.drive.gain, "gain of the drive");
    let _ = writeln!(body, "        unit.drive.gain = {gain} as f32;");
    let speed = variables.set(Input, "command", "m/s", scene.drive.speed, model::COMMAND);
    body.push_str(&model::command("unit.drive", &speed));
    for axis in ["x", "y", "z"] {
        let load = format!("external force on the slide along {axis}, at its centre of mass");
        let load = variables.set(Input, format!("load.{axis}"), "N", 0.0, load);
        // Nothing is added for no force, so that not even the sign of a zero changes.
        let _ = writeln!(
            body,
            "        if {load} != 0.0 {{\n            unit.body.gravity_w.{axis} += {load} as f32 / unit.body.mass;\n        }}"
        );
    }
    for (name, unit, what, value) in [
        ("force", "N", "force of the drive", "kernel::force(&self.0, state)"),
        ("speed", "m/s", "speed of the slide along the drive", "kernel::velocity(state)"),
        ("travel", "m", "displacement of the centre of mass along the drive, z", "state.motion.pose.displacement_w.z"),
        ("x", "m", "displacement of the centre of mass across", "state.motion.pose.displacement_w.x"),
        ("y", "m", "displacement of the centre of mass upwards", "state.motion.pose.displacement_w.y"),
    ] {
        variables.output(name, unit, what);
        let _ = writeln!(outputs, "            f64::from({value}),");
    }
    for (i, name, _) in &gaps {
        variables.output(
            format!("distance.{name}"),
            "m",
            format!("gap {name} now; negative where the parts penetrate"),
        );
        let _ = writeln!(outputs, "            f64::from(gaps[{i}]),");
    }
    super::add_report(&mut variables, &mut outputs);

    let [elastic, made_elastic, exponent] = elastic(scene_data(scene).contact.normal_type());
    let (friction, made_friction) = model::friction(scene.friction, coefficient.as_deref());
    let variables = variables.all();
    let constants = model::constants(&token, scene.controller.step, &variables);
    let model = format!(
        "{constants}use kernel::{{Predictor, SCENE, STEP as KERNEL_STEP}};\n\
         use slipfit_core::{{kernel::{{Kernel, Report}}, law::{{{elastic}, {friction}, Impact}}, menu::ContactData, slide::Slide}};\n\n\
         use crate::instance::{{Trouble, gap}};\n\n\
         /// The kernel of some values.\n#[derive(Clone, Copy)]\npub struct Model(Predictor);\n\n\
         impl Model {{\n    pub fn new(values: &[f64; VALUES], set_while_stepping: &[bool; VALUES]) -> Result<Self, Trouble> {{\n        \
         let mut unit = SCENE.at(values[0] as f32)?;\n{body}        \
         let ContactData {{ stiffness, {exponent}damping, depth, .. }} = unit.contact;\n        \
         let contact = Impact::new({made_elastic}, damping, depth)?;\n        \
         Ok(Self(Kernel::new(unit.body.slide(contact, {made_friction}, unit.drive)?, KERNEL_STEP)?))\n    }}\n\n    \
         /// Where it starts.\n    pub fn start(&self) -> State {{\n        kernel::at_rest(&self.0)\n    }}\n\n    \
         pub fn step(&self, state: &mut State) -> Report<f32> {{\n        kernel::step(&self.0, state)\n    }}\n\n    \
         pub fn outputs(&self, state: &State, report: &Report<f32>) -> [f64; OUTPUTS] {{\n        \
         let gaps = self.0.mechanism().gaps(&state.motion.pose);\n        [\n{outputs}        ]\n    }}\n}}\n"
    );
    Unit {
        title: scene.title.clone(),
        token,
        step: scene.controller.step,
        duration: scene.run.duration,
        variables,
        kernel: slide_crate(scene, "kernel", Some(core)),
        model,
    }
}
