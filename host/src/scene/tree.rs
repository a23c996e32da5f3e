//! A TOML document in which every value knows the text that it came from: the file, or an override.

use std::{borrow::Cow, cell::Cell, ops::Range};

use toml::{
    Spanned,
    de::{DeInteger, DeTable, DeValue},
};

use super::{
    Override, Problem, SceneError,
    diagnostic::{COMMAND_LINE, Found},
};

/// A text and what it is called in messages.
#[derive(Clone, Copy)]
pub struct Source<'s> {
    /// Name, such as a file's.
    pub name: &'s str,
    /// Text.
    pub text: &'s str,
    /// What is found wrong with it.
    pub found: &'s Found,
}

/// Bytes of a source.
#[derive(Clone)]
pub struct Place<'s> {
    source: Source<'s>,
    span: Range<usize>,
}

/// A value and its place; for a table the place of its header.
pub struct Node<'s> {
    /// Where.
    pub place: Place<'s>,
    /// What.
    pub value: Value<'s>,
}

/// A TOML value as far as scenes use it.
pub enum Value<'s> {
    /// An integer or a float.
    Number(f64),
    /// A string.
    Text(Cow<'s, str>),
    /// An array, or an array of tables.
    List(Vec<Node<'s>>),
    /// A table, its entries in the order of the text.
    Table(Vec<Entry<'s>>),
    /// Anything else: what it is, with its article.
    Other(&'static str),
}

/// A key with its value.
pub struct Entry<'s> {
    /// The key.
    pub key: Cow<'s, str>,
    /// Where the key is.
    pub place: Place<'s>,
    /// The value.
    pub node: Node<'s>,
    /// Whether the value has been read.
    pub read: Cell<bool>,
}

impl<'s> Source<'s> {
    fn place(self, span: Range<usize>) -> Place<'s> {
        Place { source: self, span }
    }

    /// `span` without the white space at its ends.
    fn trimmed(self, span: Range<usize>) -> Place<'s> {
        let text = &self.text[span.clone()];
        let start = span.start + text.len() - text.trim_start().len();
        self.place(start..start + text.trim().len())
    }

    /// The whole text as a TOML document.
    pub fn document(self) -> Result<Node<'s>, SceneError> {
        let table = DeTable::parse(self.text).map_err(|error| {
            self.place(error.span().unwrap_or(0..0)).error(Problem::Syntax(error.message().into()), "")
        })?;
        Ok(self.node(Spanned::new(table.span(), DeValue::Table(table.into_inner())), 0))
    }

    /// `value`, parsed from the text that begins `offset` bytes into this one.
    fn node(self, value: Spanned<DeValue<'s>>, offset: usize) -> Node<'s> {
        let place = |span: Range<usize>| self.place(offset + span.start..offset + span.end);
        let span = value.span();
        let value = match value.into_inner() {
            DeValue::Integer(integer) => Value::Number(integer_value(&integer)),
            DeValue::Float(float) => Value::Number(float.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::String(text) => Value::Text(text),
            DeValue::Boolean(_) => Value::Other("a boolean"),
            DeValue::Datetime(_) => Value::Other("a date or time"),
            DeValue::Array(array) => Value::List(array.into_iter().map(|value| self.node(value, offset)).collect()),
            DeValue::Table(table) => {
                let entry = |(key, value): (Spanned<_>, _)| {
                    let place = place(key.span());
                    Entry { place, key: key.into_inner(), node: self.node(value, offset), read: Cell::new(false) }
                };
                let mut entries: Vec<_> = table.into_iter().map(entry).collect();
                entries.sort_by_key(|entry| entry.place.span.start);
                Value::Table(entries)
            }
        };
        Node { place: place(span), value }
    }
}

/// The value of an integer; what does not fit becomes infinite, and is refused as such.
fn integer_value(integer: &DeInteger<'_>) -> f64 {
    match integer.radix() {
        10 => integer.as_str().parse().unwrap_or(f64::INFINITY),
        radix => u64::from_str_radix(integer.as_str(), radix).map_or(f64::INFINITY, |value| value as f64),
    }
}

impl<'s> Place<'s> {
    /// The text at this place.
    pub fn text(&self) -> &'s str {
        self.source.text.get(self.span.clone()).unwrap_or_default()
    }

    /// What is found wrong with the scene.
    pub fn found(&self) -> &'s Found {
        self.source.found
    }

    /// Its bytes in the file, unless it was set on the command line.
    pub fn in_file(&self) -> Option<Range<usize>> {
        (self.source.name != COMMAND_LINE).then(|| self.span.clone())
    }

    /// Where it begins in its text.
    pub fn start(&self) -> usize {
        self.span.start
    }

    /// The bytes `within` of the `text` that was read here: part of this place where the text stands as it is, between
    /// its quotes, else all of it.
    pub fn within(&self, text: &str, within: Range<usize>) -> Self {
        let Some(offset) = self.text().find(text).filter(|_| !text.is_empty()) else { return self.clone() };
        let start = self.span.start + offset;
        Self { source: self.source, span: start + within.start..start + within.end }
    }

    /// File, line and column, as `scene.toml:3:9`; for a setting of the command line its text.
    pub fn position(&self) -> String {
        let Source { name, text, .. } = self.source;
        if name == COMMAND_LINE {
            return text.to_owned();
        }
        let before = text.get(..self.span.start).unwrap_or_default();
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
        format!("{name}:{line}:{column}")
    }

    /// A `problem` at this place, and what is `allowed`.
    pub fn error(&self, problem: Problem, allowed: impl Into<String>) -> SceneError {
        SceneError::new(problem, allowed.into(), self.source.name, self.source.text, self.span.clone())
    }
}

/// Lists of tables that have names.
const LISTS: [&str; 8] = ["body", "dimension", "joint", "measure", "part", "pin", "spring", "sum"];

impl<'s> Node<'s> {
    /// What this is, with its article.
    pub fn kind(&self) -> &'static str {
        match self.value {
            Value::Number(_) => "a number",
            Value::Text(_) => "a text",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
            Value::Other(kind) => kind,
        }
    }

    /// The value of a key, if this is a table that has it.
    pub fn get(&self, key: &str) -> Option<&Self> {
        self.entry(key).map(|entry| &entry.node)
    }

    /// The entry of a key, if this is a table that has it.
    pub fn entry(&self, key: &str) -> Option<&Entry<'s>> {
        let Value::Table(entries) = &self.value else { return None };
        entries.iter().find(|entry| entry.key == key)
    }

    /// Replaces or adds the key that `change` names. The value is TOML, else a bare text.
    pub fn set(&mut self, change: &'s Override) -> Result<(), SceneError> {
        let source = Source { name: COMMAND_LINE, text: &change.text, found: self.place.source.found };
        let text = source.text;
        let start = text.find(' ').map_or(text.len(), |space| space + 1);
        let (key, place, value) = match change.key {
            Some(key) => (key, source.trimmed(0..start), source.trimmed(start..text.len())),
            None => {
                let Some(equals) = text[start..].find('=').map(|at| start + at) else {
                    let place = source.trimmed(start..text.len());
                    return Err(place.error(Problem::Override, "key=value, such as slide.mass=90"));
                };
                let key = source.trimmed(start..equals);
                (key.text(), key, source.trimmed(equals + 1..text.len()))
            }
        };
        let bare = || Node { place: value.clone(), value: Value::Text(value.text().into()) };
        let value = match DeValue::parse(value.text()) {
            // 10:20:05 is a range of levels here, not a time of the day.
            Ok(parsed) if !parsed.get_ref().is_datetime() => source.node(parsed, value.span.start),
            _ => bare(),
        };

        if let Some((list, name)) = key.trim().split_once('.').filter(|(list, _)| LISTS.contains(list))
            && self.get(list).is_none()
        {
            let name = name.rsplit_once('.').map_or(name, |(name, _)| name);
            let problem = Problem::UnknownName { of: list.into(), name: name.into() };
            return Err(place.error(problem, format!("a key of the scene: it has no [[{list}]]")));
        }
        let mut node = self;
        let mut rest = Some(key.trim());
        // What the names of a list are of: its own key.
        let mut list = "";
        while let Some(path) = rest {
            let part = node.first_part(path);
            node = node.child(part.trim(), list, &place)?;
            list = part.trim();
            rest = path[part.len()..].strip_prefix('.');
        }
        *node = value;
        Ok(())
    }

    /// The part of the `path` that names a child: up to the next dot, or a name in a list, which may have dots.
    fn first_part<'p>(&self, path: &'p str) -> &'p str {
        let Value::List(nodes) = &self.value else { return path.split('.').next().unwrap_or(path) };
        let names = nodes.iter().filter_map(Self::name);
        let named =
            names.filter(|name| path.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')));
        match named.map(str::len).max() {
            Some(length) => &path[..length],
            None => path.split('.').next().unwrap_or(path),
        }
    }

    /// The entry `key` of a table, made if it is not there, or the table of that name in a list called `list`.
    fn child(&mut self, key: &'s str, list: &str, place: &Place<'s>) -> Result<&mut Self, SceneError> {
        let unknown = Problem::UnknownKey { key: place.text().into(), similar: None };
        match &mut self.value {
            Value::Table(entries) => {
                let at = entries.iter().position(|entry| entry.key == key).unwrap_or(entries.len());
                if at == entries.len() {
                    let node = Node { place: place.clone(), value: Value::Table(Vec::new()) };
                    entries.push(Entry { key: key.into(), place: place.clone(), node, read: Cell::new(false) });
                }
                Ok(&mut entries[at].node)
            }
            Value::List(nodes) => {
                let names: Vec<_> = nodes.iter().filter_map(Self::name).collect();
                let Some(at) = nodes.iter().position(|node| node.name() == Some(key)) else {
                    let problem = Problem::UnknownName { of: list.into(), name: key.into() };
                    return Err(place.error(problem, names.join(", ")));
                };
                Ok(&mut nodes[at])
            }
            _ => Err(place.error(unknown, "a key of the scene file, such as slide.mass")),
        }
    }

    /// By which a table in a list is found: its own name, a mate's that of its part.
    fn name(&self) -> Option<&str> {
        match &self.get("name").or_else(|| self.get("part"))?.value {
            Value::Text(name) => Some(name),
            _ => None,
        }
    }
}
