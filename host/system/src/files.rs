//! Files that are whole or not there.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use thiserror::Error;

/// A file or folder that cannot be written.
#[derive(Debug, Error)]
#[error("cannot write {}: {cause}", path.display())]
pub struct WriteError {
    path: PathBuf,
    cause: std::io::Error,
}

/// Outputs that would replace an input or each other.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Coincidence {
    /// An output that would replace what the command reads.
    #[error("{output}: cannot write {}: it is {input}", path.display())]
    Input {
        /// What asks for the output.
        output: String,
        /// Its path.
        path: PathBuf,
        /// What the same file is for.
        input: String,
    },
    /// Two outputs of which the second would replace the first.
    #[error("{one} and {other} are one file: {}", path.display())]
    Twice {
        /// What asks for the first.
        one: String,
        /// What asks for the second.
        other: String,
        /// Path of the second.
        path: PathBuf,
    },
}

/// The error of writing to `path`.
pub fn failed<'a>(path: &'a Path) -> impl FnOnce(std::io::Error) -> WriteError + 'a {
    move |error| WriteError { path: path.into(), cause: plain(error) }
}

/// The system's own error, without the temporary name that it may be wrapped with.
fn plain(error: std::io::Error) -> std::io::Error {
    match error.kind() {
        std::io::ErrorKind::NotFound => std::io::Error::other("its folder does not exist"),
        kind if error.get_ref().is_some() => kind.into(),
        _ => error,
    }
}

fn temporary_beside(path: &Path) -> Result<tempfile::NamedTempFile, WriteError> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // What File::create would ask for; the process's umask takes its part.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.prefix(".slipfit-").tempfile_in(folder).map_err(failed(path))
}

/// Whether `path` is there and is neither a file nor a folder: a device or a pipe, which is written to, not replaced.
fn is_stream(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir())
}

/// Where a link leads, so that its target is replaced and not the link.
fn resolved(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.into())
}

/// Whether `path` can be written, found out before long work starts. Leaves nothing behind.
///
/// # Errors
/// [`WriteError`] if not.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    if path.is_dir() {
        return Err(WriteError { path: path.into(), cause: std::io::ErrorKind::IsADirectory.into() });
    }
    if is_stream(path) { Ok(()) } else { temporary_beside(&resolved(path)).map(drop) }
}

/// Whether none of a command's `outputs`, files and folders, is one of its `inputs` or another output, by whatever way
/// their paths lead there. Each comes with what names it to the user, such as `--csv`. Devices and pipes take any number
/// of outputs.
///
/// # Errors
/// [`Coincidence`] names the first two that are one.
pub fn check_distinct(inputs: &[(&str, &Path)], outputs: &[(&str, &Path)]) -> Result<(), Coincidence> {
    let inputs: Vec<_> = inputs.iter().map(|(name, path)| (*name, destination(path))).collect();
    let mut before: Vec<(&str, PathBuf)> = Vec::with_capacity(outputs.len());
    for (name, path) in outputs.iter().filter(|(_, path)| !is_stream(path)) {
        let target = destination(path);
        if let Some((input, _)) = inputs.iter().find(|(_, input)| *input == target) {
            let (output, input) = (name.to_string(), input.to_string());
            return Err(Coincidence::Input { output, path: path.into(), input });
        }
        if let Some((one, _)) = before.iter().find(|(_, other)| *other == target) {
            let (one, other) = (one.to_string(), name.to_string());
            return Err(Coincidence::Twice { one, other, path: path.into() });
        }
        before.push((name, target));
    }
    Ok(())
}

/// Where a path leads, through links and `..`, whether or not anything is there yet.
fn destination(path: &Path) -> PathBuf {
    /// Longer chains of links are loops.
    const MOST_LINKS: usize = 40;
    let mut path = std::path::absolute(path).unwrap_or_else(|_| path.into());
    for _ in 0..MOST_LINKS {
        match std::fs::read_link(&path) {
            // A link that leads nowhere yet.
            Ok(target) if std::fs::canonicalize(&path).is_err() => {
                path = path.parent().unwrap_or(Path::new("/")).join(target);
            }
            _ => break,
        }
    }
    if let Ok(found) = std::fs::canonicalize(&path) {
        return found;
    }
    match (path.parent(), path.components().next_back()) {
        (Some(parent), Some(std::path::Component::ParentDir)) => destination(parent).parent().map(Path::to_path_buf),
        (Some(parent), Some(name)) => Some(destination(parent).join(name)),
        _ => None,
    }
    .unwrap_or(path)
}

/// Writes `bytes` under a temporary name beside `path` and renames it; straight into a device or a pipe.
///
/// # Errors
/// [`WriteError`]; then a file is as it was.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let mut writing = Writing::begin(path)?;
    writing.write_all(bytes).map_err(failed(path))?;
    writing.end(path)
}

/// A file that is being written: it has a temporary name until it is whole, and is gone if it does not become so.
pub enum Writing {
    /// A device or a pipe.
    Stream(std::fs::File),
    /// A file that is to replace another.
    File {
        /// What is written so far.
        file: tempfile::NamedTempFile,
        /// Where it goes.
        target: PathBuf,
    },
}

impl Writing {
    /// Beside `path`.
    ///
    /// # Errors
    /// [`WriteError`], if it cannot be begun.
    pub fn begin(path: &Path) -> Result<Self, WriteError> {
        if is_stream(path) {
            return std::fs::OpenOptions::new().write(true).open(path).map(Self::Stream).map_err(failed(path));
        }
        let target = resolved(path);
        Ok(Self::File { file: temporary_beside(&target)?, target })
    }

    /// Whole: from now on it is `path`, which messages name.
    ///
    /// # Errors
    /// [`WriteError`]; then a file is as it was.
    pub fn end(self, path: &Path) -> Result<(), WriteError> {
        if let Self::File { file, target } = self {
            file.as_file().sync_all().map_err(failed(path))?;
            file.persist(&target).map_err(|error| failed(path)(error.error))?;
            sync_folder(&target);
        }
        Ok(())
    }
}

impl Write for Writing {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match self {
            // Who closes a pipe has read what it wants.
            Self::Stream(stream) => match stream.write(bytes) {
                Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(bytes.len()),
                written => written,
            },
            Self::File { file, .. } => file.write(bytes),
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match self {
            Self::Stream(stream) => stream.flush(),
            Self::File { file, .. } => file.flush(),
        }
    }
}

/// Makes a new name last through a power cut, where the system can: not all can open a folder.
fn sync_folder(file: &Path) {
    if let Some(folder) = file.parent() {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let _ = std::fs::File::open(folder).and_then(|folder| folder.sync_all());
    }
}

/// Makes the folder `path`, its parents too, and checks that files can be written there.
///
/// # Errors
/// [`WriteError`] if it cannot be made or written to.
pub fn prepare_folder(path: &Path) -> Result<(), WriteError> {
    std::fs::create_dir_all(path).map_err(failed(path))?;
    temporary_beside(&path.join("x")).map(drop).map_err(|error| WriteError { path: path.into(), ..error })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_whole_files_and_leaves_no_temporaries() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.bin");
        write(&path, b"one").unwrap();
        write(&path, b"two").unwrap();
        check_writable(&path).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn follows_links_and_leaves_devices_alone() {
        let folder = tempfile::tempdir().unwrap();
        let [file, link] = ["file", "link"].map(|name| folder.path().join(name));
        write(&file, b"old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&file).unwrap(), b"new");
        // A stream that takes everything, through a link so that nothing real is at stake.
        let null = folder.path().join("null");
        std::os::unix::fs::symlink("/dev/null", &null).unwrap();
        write(&null, b"gone").unwrap();
        assert!(null.is_symlink() && !std::fs::metadata(&null).unwrap().is_file());
    }

    #[test]
    fn outputs_that_coincide_are_found_by_whatever_way() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        write(&at("scene"), b"x").unwrap();
        let check = |inputs: &[&str], outputs: &[&str]| {
            let [inputs, outputs] =
                [inputs, outputs].map(|names| names.iter().map(|name| at(name)).collect::<Vec<_>>());
            let named = |paths: &'_ [PathBuf]| paths.iter().map(|path| ("x", path.clone())).collect::<Vec<_>>();
            let (inputs, outputs) = (named(&inputs), named(&outputs));
            let [inputs, outputs] = [&inputs, &outputs]
                .map(|all| all.iter().map(|(name, path)| (*name, path.as_path())).collect::<Vec<_>>());
            check_distinct(&inputs, &outputs)
        };
        assert!(check(&["scene"], &["a", "b"]).is_ok());
        assert!(matches!(check(&["scene"], &["a", "./scene"]), Err(Coincidence::Input { .. })));
        assert!(matches!(check(&[], &["new", "./new"]), Err(Coincidence::Twice { .. })));
        std::fs::create_dir(at("below")).unwrap();
        assert!(matches!(check(&[], &["new", "below/../new"]), Err(Coincidence::Twice { .. })));
        assert!(matches!(check(&[], &["new", "none/../new"]), Err(Coincidence::Twice { .. })));
        #[cfg(unix)]
        {
            for (to, link) in
                [("scene", "to scene"), ("later", "to later"), ("below", "to below"), ("/dev/null", "null")]
            {
                std::os::unix::fs::symlink(to, at(link)).unwrap();
            }
            assert!(matches!(check(&["scene"], &["to scene"]), Err(Coincidence::Input { .. })));
            assert!(matches!(check(&["to scene"], &["scene"]), Err(Coincidence::Input { .. })));
            assert!(matches!(check(&[], &["to later", "later"]), Err(Coincidence::Twice { .. })));
            assert!(matches!(check(&[], &["to below/new", "below/new"]), Err(Coincidence::Twice { .. })));
            assert!(check(&[], &["null", "null"]).is_ok());
        }
    }

    #[test]
    fn names_what_it_cannot_write() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        write(&file, b"").unwrap();
        let inside = file.join("deeper");
        assert!(prepare_folder(&inside).unwrap_err().to_string().contains("deeper"));
        assert!(check_writable(folder.path()).is_err());
        assert!(write(&inside, b"x").is_err());
        let nowhere = check_writable(&folder.path().join("missing/file")).unwrap_err().to_string();
        assert!(nowhere.ends_with("missing/file: its folder does not exist"), "{nowhere}");
    }
}
