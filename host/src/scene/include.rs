//! `include`: other files whose keys count as the scene's own.

use std::io::Read;

use super::{
    Problem, SceneError,
    measured::folder,
    tree::{Entry, Node, Source, Value},
    value::Field,
};

const ALLOWED: &str = "a TOML file with keys of a scene, or a list of such files, relative to the folder of the scene";
/// The longest file (bytes).
const MOST: u64 = 1 << 20;

/// An included file.
pub struct Included {
    /// What it is called in messages.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// The paths that the scene `tree` of the file `file_name` includes, each with the field that says so.
pub fn paths<'t, 's>(tree: &'t Node<'s>, file_name: &str) -> Result<Vec<(Field<'t, 's>, String)>, SceneError> {
    let Some(entry) = tree.entry("include") else { return Ok(Vec::new()) };
    entry.read.set(true);
    let field = Field { key: "include".into(), node: &entry.node };
    let fields = match &entry.node.value {
        Value::List(nodes) if !nodes.is_empty() => {
            nodes.iter().map(|node| Field { key: field.key.clone(), node }).collect()
        }
        Value::Text(_) => vec![field],
        _ => return Err(field.wrong_type(ALLOWED)),
    };
    let path = |field: Field<'t, 's>| {
        let path = folder(file_name).join(field.to_text()?).display().to_string();
        Ok((field, path))
    };
    fields.into_iter().map(path).collect()
}

/// Reads the files that the scene `tree` of the file `file_name` includes.
///
/// # Errors
/// A file that cannot be read, at the place where it is named.
pub fn read(tree: &Node, file_name: &str) -> Result<Vec<Included>, SceneError> {
    let read = |(field, name): (Field, String)| {
        let mut text = String::new();
        let opened = std::fs::File::open(&name).and_then(|file| file.take(MOST + 1).read_to_string(&mut text));
        match opened {
            Ok(_) if text.len() as u64 <= MOST => Ok(Included { name, text }),
            Ok(_) => Err(field.error(Problem::Include { why: format!("{name} has more than {MOST} bytes") }, ALLOWED)),
            Err(error) => Err(field.error(Problem::Include { why: format!("{name}: {error}") }, ALLOWED)),
        }
    };
    paths(tree, file_name)?.into_iter().map(read).collect()
}

/// Adds the keys of an `included` file to the scene `tree`: to its tables and lists, too.
///
/// # Errors
/// A file that is no TOML, includes others, or states a value that the scene states.
pub fn add<'s>(tree: &mut Node<'s>, included: &'s Included) -> Result<(), SceneError> {
    let source = Source { name: &included.name, text: &included.text, found: tree.place.found() };
    let document = source.document()?;
    if let Some(entry) = document.entry("include") {
        let what = "an included file that includes others".into();
        return Err(entry.place.error(Problem::Unsupported { what }, "all files in the scene itself"));
    }
    merge(tree, document, "")
}

/// Adds `more` to `node`, which has the key `path`.
fn merge<'s>(node: &mut Node<'s>, more: Node<'s>, path: &str) -> Result<(), SceneError> {
    let place = more.place.clone();
    match (&mut node.value, more.value) {
        (Value::Table(entries), Value::Table(added)) => {
            for Entry { key, place, node, read } in added {
                let path = super::keys::join(path, &key);
                match entries.iter_mut().find(|entry| entry.key == key) {
                    Some(entry) => merge(&mut entry.node, node, &path)?,
                    None => entries.push(Entry { key, place, node, read }),
                }
            }
            Ok(())
        }
        (Value::List(nodes), Value::List(added)) if added.iter().all(|node| matches!(node.value, Value::Table(_))) => {
            nodes.extend(added);
            Ok(())
        }
        _ => {
            let problem = Problem::Duplicate { key: path.to_owned(), name: node.place.position() };
            Err(place.error(problem, "a key that the scene does not state itself"))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::{CD_ROM_SLIDE, Override, SceneFile};

    fn read(text: &str, included: &str, set: &[&str]) -> Result<SceneFile, String> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("more.toml"), included).unwrap();
        let name = folder.path().join("scene.toml").display().to_string();
        let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
        SceneFile::parse(&name, text, &set).map_err(|error| error.to_string())
    }

    fn including(rest: &str) -> String {
        format!("include = \"more.toml\"\n{CD_ROM_SLIDE}\n{rest}")
    }

    #[test]
    fn included_keys_are_the_scenes_own() {
        let more = "[uncertain]\nfriction.coefficient = { mean = 0.25, deviation = 0.01 }\nslide.mass = { mean = 80, deviation = 1 }\n\
                    [[uncertain.correlation]]\nof = [\"friction.coefficient\", \"slide.mass\"]\ncoefficient = -0.9\n";
        let scene = read(&including(""), more, &["uncertain.slide.mass.mean=81"]).unwrap().slide.unwrap();
        assert_eq!(scene.uncertain.len(), 2);
        assert_eq!(scene.uncertain[1].belief.bounds().map(|bound| (bound * 1e4).round()), [770.0, 850.0]);
        assert!((scene.uncertain[1].weights[0] + 0.9).abs() < 1e-15 && scene.uncertain[0].weights == [1.0]);
        let beside = including("[uncertain]\ndrive.gain = [0.03, 0.05]\n");
        assert_eq!(read(&beside, more, &[]).unwrap().slide.unwrap().uncertain.len(), 3);
    }

    #[test]
    fn mistakes_are_shown_in_their_file() {
        for (included, told) in [
            ("[slide]\nmass = 3\n", "more.toml:2:8"),
            ("[uncertain]\nfriction.coefficeint = [0.1, 0.2]\n", "more.toml:2:10"),
            ("include = \"other.toml\"\n", "more.toml:1:1"),
            ("[uncertain\n", "more.toml:1:"),
            (
                "[uncertain]\nfriction.coefficient = [0.1, 0.2]\n[[uncertain.correlation]]\nof = [\"friction.coefficient\", \"x\"]\ncoefficient = 1\n",
                "there is no unknown `x`",
            ),
        ] {
            let Err(error) = read(&including(""), included, &[]) else { panic!("{included}") };
            assert!(error.contains(told), "{told}\n{error}");
        }
        let Err(error) = read(&format!("include = [\"none.toml\"]\n{CD_ROM_SLIDE}"), "", &[]) else {
            panic!("accepted")
        };
        assert!(error.contains("scene.toml:1:12") && error.contains("none.toml"), "{error}");
    }
}
