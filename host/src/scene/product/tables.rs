//! Lists of tables, their names, and lists of texts.

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

/// The tables of the list `key`; none if it is not there.
pub(super) fn tables<'t, 's>(root: &Field<'t, 's>, key: &str) -> Result<Vec<Field<'t, 's>>, SceneError> {
    let Some(list) = root.get(key) else { return Ok(Vec::new()) };
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(format!("tables [[{}]]", list.key))) };
    let tables: Vec<_> = nodes.iter().map(|node| Field { key: list.key.clone(), node }).collect();
    tables.iter().try_for_each(Field::expect_table)?;
    Ok(tables)
}

/// The name of the table.
pub(super) fn name<'t, 's>(table: &Field<'t, 's>) -> Result<(&'t str, Field<'t, 's>), SceneError> {
    const ALLOWED: &str = "a text in quotes, without single quotes in it";
    let field = table.require("name", ALLOWED)?;
    let name = field.to_text()?;
    if name.trim().is_empty() || name.contains('\'') {
        return Err(field.error(Problem::Choice { key: field.key.clone(), written: field.written("") }, ALLOWED));
    }
    Ok((name, field))
}

/// The texts of the list `key` in the `table`, each with its field.
pub(super) fn texts<'t, 's>(
    table: &Field<'t, 's>,
    key: &str,
    allowed: &str,
) -> Result<Vec<(&'t str, Field<'t, 's>)>, SceneError> {
    let list = table.require(key, allowed)?;
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(allowed)) };
    nodes.iter().map(|node| Field { key: list.key.clone(), node }).map(|field| Ok((field.to_text()?, field))).collect()
}
