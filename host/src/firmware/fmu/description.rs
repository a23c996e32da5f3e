//! `modelDescription.xml`.

use std::fmt::Write;

use super::{
    Unit,
    variable::{Causality, UNITS, Variable},
};
use crate::xml::escape;

/// The version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fmi {
    /// 2.0.
    Two,
    /// 3.0.
    Three,
}

/// A model's identifier from the name that the unit is given: what C takes.
pub fn identifier(name: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let first = if name.starts_with(|c: char| c.is_ascii_alphabetic()) { "" } else { "_" };
    first.chars().chain(name.chars().map(letter)).collect()
}

/// The description of `unit`, whose library is called `identifier`.
pub fn description(unit: &Unit, fmi: Fmi, identifier: &str) -> String {
    let Unit { title, token, step, duration, variables, .. } = unit;
    let (title, token, version) = (escape(title), escape(token), env!("CARGO_PKG_VERSION"));
    let (number, called, shared) = match fmi {
        Fmi::Two => (
            "2.0",
            "guid",
            r#"canGetAndSetFMUstate="true" canSerializeFMUstate="true" canNotUseMemoryManagementFunctions="true""#
                .to_owned(),
        ),
        Fmi::Three => (
            "3.0",
            "instantiationToken",
            format!(r#"canGetAndSetFMUState="true" canSerializeFMUState="true" fixedInternalStepSize="{step}""#),
        ),
    };
    let mut text = format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="{number}" modelName="{title}" {called}="{token}" description="The controller's kernel in steps of {step} s" generationTool="slipfit {version}" variableNamingConvention="flat">
  <CoSimulation modelIdentifier="{identifier}" canHandleVariableCommunicationStepSize="true" {shared}/>
  <UnitDefinitions>
"#
    );
    for (name, exponents) in UNITS {
        let parts = ["kg", "m", "s", "rad"].into_iter().zip(exponents).filter(|(_, exponent)| *exponent != 0);
        let parts: String = parts.map(|(base, exponent)| format!(" {base}=\"{exponent}\"")).collect();
        let _ = writeln!(text, "    <Unit name=\"{name}\"><BaseUnit{parts}/></Unit>");
    }
    text.push_str("  </UnitDefinitions>\n");
    if fmi == Fmi::Three {
        // A type for each unit: there are importers that read the unit of types alone.
        text.push_str("  <TypeDefinitions>\n");
        for (name, _) in UNITS {
            let _ = writeln!(text, "    <Float64Type name=\"{name}\" unit=\"{name}\"/>");
        }
        text.push_str("  </TypeDefinitions>\n");
    }
    let _ = write!(
        text,
        "  <LogCategories>\n    \
         <Category name=\"logStatusError\" description=\"Why a call was refused\"/>\n  </LogCategories>\n  \
         <DefaultExperiment startTime=\"0\" stopTime=\"{duration}\" stepSize=\"{step}\"/>\n  <ModelVariables>\n"
    );
    let time = Variable {
        name: "time".into(),
        causality: Causality::Output,
        unit: "s",
        description: "time; the kernel's begins where the simulation starts".into(),
        start: None,
    };
    text.push_str(&variable(fmi, 0, &time, ["independent", "continuous"]));
    for (reference, one) in (1..).zip(variables) {
        let of = match one.causality {
            Causality::Fixed => ["parameter", "fixed"],
            Causality::Tunable => ["parameter", "tunable"],
            Causality::Input => ["input", "continuous"],
            Causality::Output => ["output", "continuous"],
        };
        text.push_str(&variable(fmi, reference, one, of));
    }
    text.push_str("  </ModelVariables>\n  <ModelStructure>\n");
    let outputs =
        (1..).zip(variables).filter(|(_, one)| one.causality == Causality::Output).map(|(reference, _)| reference);
    let outputs: Vec<usize> = outputs.collect();
    match fmi {
        Fmi::Three => {
            for kind in ["Output", "InitialUnknown"] {
                for reference in &outputs {
                    let _ = writeln!(text, "    <{kind} valueReference=\"{reference}\"/>");
                }
            }
        }
        Fmi::Two => {
            for kind in ["Outputs", "InitialUnknowns"] {
                let _ = writeln!(text, "    <{kind}>");
                for reference in &outputs {
                    // The index counts the time as 1.
                    let _ = writeln!(text, "      <Unknown index=\"{}\"/>", reference + 1);
                }
                let _ = writeln!(text, "    </{kind}>");
            }
        }
    }
    text + "  </ModelStructure>\n</fmiModelDescription>\n"
}

fn variable(fmi: Fmi, reference: usize, variable: &Variable, [causality, variability]: [&str; 2]) -> String {
    let Variable { name, unit, description, start, .. } = variable;
    let (name, description) = (escape(name), escape(description));
    let start = start.map(|start| format!(" start=\"{start:?}\"")).unwrap_or_default();
    let common = format!(
        "name=\"{name}\" valueReference=\"{reference}\" description=\"{description}\" causality=\"{causality}\" \
         variability=\"{variability}\""
    );
    match fmi {
        Fmi::Three => format!("    <Float64 {common} declaredType=\"{unit}\"{start}/>\n"),
        Fmi::Two => {
            format!("    <ScalarVariable {common}>\n      <Real unit=\"{unit}\"{start}/>\n    </ScalarVariable>\n")
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{Fmi, description, identifier};
    use crate::{
        dynamics::example,
        firmware::fmu::{Causality, UNITS, slide_unit},
    };

    #[test]
    fn identifiers_are_those_of_c() {
        for (name, expected) in
            [("slide", "slide"), ("big-end 2", "big_end_2"), ("2nd", "_2nd"), ("", "_"), ("ä", "__")]
        {
            assert_eq!(identifier(name), expected);
        }
    }

    #[test]
    fn every_variable_has_its_reference_and_a_known_unit() {
        let unit = slide_unit(&example::cd_rom(), Path::new("../core"));
        let last = |causality| unit.variables.iter().rposition(|one| one.causality == causality).unwrap();
        let order = [Causality::Fixed, Causality::Tunable, Causality::Input, Causality::Output].map(last);
        assert!(order.is_sorted(), "{order:?}");
        assert!(unit.variables.iter().all(|one| UNITS.iter().any(|(name, _)| *name == one.unit)));
        for (fmi, of_one) in [(Fmi::Three, "<Float64 "), (Fmi::Two, "<ScalarVariable ")] {
            let text = description(&unit, fmi, "slide");
            let document = roxmltree::Document::parse(&text).unwrap();
            let references: Vec<usize> = document
                .descendants()
                .filter_map(|node| node.attribute("causality").and(node.attribute("valueReference")))
                .map(|reference| reference.parse().unwrap())
                .collect();
            assert_eq!(references, (0..=unit.variables.len()).collect::<Vec<_>>());
            assert_eq!(text.matches(of_one).count(), references.len());
            assert_eq!(document.root_element().attribute("modelName"), Some(&*unit.title));
        }
    }
}
