//! What the glue knows of a scene: the file `model.rs` of the compiled crate.

use std::fmt::Write;

use super::variable::{Causality, Variable};

/// The constants that go before the type `Model`.
pub(super) fn constants(token: &str, step: f64, variables: &[Variable]) -> String {
    let set: Vec<_> = variables.iter().filter(|variable| variable.causality != Causality::Output).collect();
    let fixed = set.iter().filter(|variable| variable.causality == Causality::Fixed).count();
    let (values, outputs) = (set.len(), variables.len() - set.len());
    let start: Vec<_> = set.iter().map(|variable| format!("{:?}", variable.start.unwrap_or_default())).collect();
    let names: Vec<_> = set.iter().map(|variable| format!("{:?}", variable.name)).collect();
    let mut text = "//! The kernel of the scene, by the values that an importer sets.\n\n".to_owned();
    let _ = write!(
        text,
        "/// What an importer has to know to instantiate the unit.\npub const TOKEN: &str = {token:?};\n\n\
         /// Step of the kernel (s).\npub const STEP: f64 = {step:?};\n\n\
         /// Number of parameters and inputs.\npub const VALUES: usize = {values};\n\n\
         /// How many of them, the first, are fixed.\npub const FIXED: usize = {fixed};\n\n\
         /// Their names.\npub const NAMES: [&str; VALUES] = [{}];\n\n\
         /// What they are unless they are set.\npub const START: [f64; VALUES] = [{}];\n\n\
         /// Number of outputs.\npub const OUTPUTS: usize = {outputs};\n\n\
         pub use kernel::State;\n\n",
        names.join(", "),
        start.join(", ")
    );
    text
}

/// A gap's expression at the level that is set: `mean` is what it is at level 0, `deviation` an expression; from the least to the greatest that
/// is `allowed` (m).
pub(super) fn gap(name: &str, mean: &str, deviation: &str, allowed: [f64; 2]) -> String {
    format!("gap({name:?}, {mean}, {deviation}, values[0], {allowed:?})?")
}

/// What the description says of a command whose start value is the end of the scene's ramp.
pub(super) const COMMAND: &str = "commanded speed; as it is when initialization ends it is the end of the scene's ramp, and set after \
                                  that it is the command at once";

/// Statements that give the `drive` its command `value`, an expression of what is set.
pub(super) fn command(drive: &str, value: &str) -> String {
    format!(
        "        if {} {{\n            slipfit_core::drive::Commandable::set_command(&mut {drive}, {value} as f32);\n        }} else {{\n            \
         {drive}.speed = {value} as f32;\n        }}\n",
        value.replace("values", "set_while_stepping")
    )
}

/// The friction law's name in core and its value for an expression of its coefficient.
pub(super) fn friction(
    data: slipfit_core::menu::FrictionData<f64>,
    coefficient: Option<&str>,
) -> (&'static str, String) {
    use slipfit_core::menu::FrictionData::{Exact, Regularised};
    match (data, coefficient) {
        (Regularised { stick_band, .. }, Some(value)) => {
            ("Regularised", format!("Regularised::new({value} as f32, {stick_band:?}f64 as f32)?"))
        }
        (Exact { .. }, Some(value)) => ("Exact", format!("Exact::new({value} as f32)?")),
        _ => ("Frictionless", "Frictionless".into()),
    }
}
