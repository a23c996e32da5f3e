//! The law of a drive train.

use slipfit_identify::drive_train::{LAWS, Term};

use crate::{
    identify::Law,
    scene::{Problem, SceneError, tree::Value, value::Field},
};

/// A law by its name, or its terms as a list.
pub fn law(field: &Field) -> Result<Law, SceneError> {
    let names = || LAWS.map(|(name, _)| name).join(", ");
    let terms = || Term::ALL.map(Term::name).join(", ");
    let allowed = || format!("{}; or a list of terms: {}", names(), terms());
    let wrong =
        |field: &Field| field.error(Problem::Choice { key: field.key.clone(), written: field.written("") }, allowed());
    match &field.node.value {
        Value::Text(text) => {
            let found = LAWS.iter().find(|(name, _)| name == text).ok_or_else(|| wrong(field))?;
            Ok(Law { name: found.0.into(), terms: found.1.to_vec() })
        }
        Value::List(nodes) if !nodes.is_empty() => {
            let mut found = Vec::new();
            for node in nodes {
                let field = Field { key: field.key.clone(), node };
                let text = field.to_text()?;
                let term = Term::ALL.into_iter().find(|term| term.name() == text).ok_or_else(|| wrong(&field))?;
                if found.contains(&term) {
                    return Err(field.error(Problem::Duplicate { key: field.key.clone(), name: text.into() }, terms()));
                }
                found.push(term);
            }
            Ok(Law { name: found.iter().map(|term| term.name()).collect::<Vec<_>>().join(", "), terms: found })
        }
        _ => Err(field.wrong_type(allowed())),
    }
}
