//! Names of bodies, and the tables that have a name of their own.

use crate::{
    mechanism::Port,
    scene::{Problem, SceneError, tree::Value, value::Field},
};

/// What the frame is called where bodies are named.
const FRAME: &str = "frame";

/// Names of bodies.
pub(super) struct Names {
    pub names: Vec<String>,
}

impl Names {
    /// The body that `field` names, or the frame.
    pub fn port(&self, field: &Field) -> Result<Port, SceneError> {
        let name = field.to_text()?;
        if name == FRAME {
            return Ok(None);
        }
        self.find(name).map(Some).ok_or_else(|| {
            let problem = Problem::UnknownName { of: "body".into(), name: name.into() };
            field.error(problem, format!("{FRAME}, {}", self.names.join(", ")))
        })
    }

    /// The moving body that `field` names.
    pub fn body(&self, field: &Field) -> Result<usize, SceneError> {
        let name = field.to_text()?;
        self.find(name).ok_or_else(|| {
            let (key, of, name) = (field.key.clone(), "body".into(), name.into());
            let problem =
                if name == FRAME { Problem::Choice { key, written: name } } else { Problem::UnknownName { of, name } };
            field.error(problem, format!("a body that moves: {}", self.names.join(", ")))
        })
    }

    fn find(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|one| one == name)
    }

    /// The two bodies of a joint or spring.
    pub fn between(&self, table: &Field) -> Result<[Port; 2], SceneError> {
        const ALLOWED: &str = "a list of two bodies, such as [\"frame\", \"crank\"]";
        let field = table.require("between", ALLOWED)?;
        let Value::List(nodes) = &field.node.value else { return Err(field.wrong_type(ALLOWED)) };
        let [first, second] = &nodes[..] else {
            return Err(field.error(Problem::Length { key: field.key.clone(), found: nodes.len() }, ALLOWED));
        };
        let port = |node| self.port(&Field { key: field.key.clone(), node });
        let between = [port(first)?, port(second)?];
        if between[0] == between[1] {
            let name = between[0].map_or(FRAME, |body| &self.names[body]).to_owned();
            return Err(field.error(Problem::JoinedToItself { key: field.key.clone(), name }, "two different bodies"));
        }
        Ok(between)
    }
}

/// Reads a list of tables, each with a name of its own.
pub(super) fn tables<'t, 's>(root: &Field<'t, 's>, key: &str) -> Result<Vec<(String, Field<'t, 's>)>, SceneError> {
    let Some(list) = root.get(key) else { return Ok(Vec::new()) };
    let allowed = format!("tables [[{}]]", list.key);
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(allowed)) };
    let mut named: Vec<(String, Field)> = Vec::new();
    for node in nodes {
        let table = Field { key: list.key.clone(), node };
        table.expect_table()?;
        let field = table.require("name", "a text in quotes")?;
        let name = field.to_text()?;
        if name == FRAME {
            let problem = Problem::Choice { key: field.key.clone(), written: name.into() };
            return Err(field.error(problem, "another name: this is what the frame is called, which does not move"));
        }
        if named.iter().any(|(other, _)| other == name) {
            let problem = Problem::Duplicate { key: field.key.clone(), name: name.into() };
            return Err(field.error(problem, "a name of its own for each"));
        }
        named.push((name.into(), table));
    }
    Ok(named)
}
