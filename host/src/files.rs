//! Files that are whole or not there.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use thiserror::Error;

/// A file or folder that cannot be written.
#[derive(Debug, Error)]
#[error("cannot write {}: {source}", path.display())]
pub struct WriteError {
    path: PathBuf,
    #[source]
    source: std::io::Error,
}

fn failed<'a>(path: &'a Path) -> impl FnOnce(std::io::Error) -> WriteError + 'a {
    move |source| WriteError { path: path.into(), source }
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

/// Whether `path` can be written, found out before long work starts. Leaves nothing behind.
///
/// # Errors
/// [`WriteError`] if not.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    if path.is_dir() {
        return Err(failed(path)(std::io::Error::from(std::io::ErrorKind::IsADirectory)));
    }
    temporary_beside(path).map(drop)
}

/// Writes `bytes` under a temporary name beside `path` and renames it.
///
/// # Errors
/// [`WriteError`]; then `path` is as it was.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let mut file = temporary_beside(path)?;
    file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(failed(path))?;
    file.persist(path).map_err(|error| failed(path)(error.error)).map(drop)
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

    #[test]
    fn names_what_it_cannot_write() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        write(&file, b"").unwrap();
        let inside = file.join("deeper");
        assert!(prepare_folder(&inside).unwrap_err().to_string().contains("deeper"));
        assert!(check_writable(folder.path()).is_err());
        assert!(write(&inside, b"x").is_err());
    }
}
