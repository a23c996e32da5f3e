//! Which file formats options write: a name that promises another one is refused.

use std::path::Path;

use super::failure::Failure;

/// Options that write one format, and the endings of its file names.
const ENDINGS: [(&str, &[&str]); 6] = [
    ("--csv", &["csv"]),
    ("--draws", &["csv"]),
    ("--plot", &["svg"]),
    ("--plot-distance", &["svg"]),
    ("--page", &["html", "htm"]),
    ("--write", &["toml"]),
];

/// Whether the paths of all `outputs` end as the format does that their option writes. A name without an ending promises nothing.
///
/// # Errors
/// [`Failure::Input`] names the first that does not, and what is allowed.
pub fn check(outputs: &[(&str, &Path)]) -> Result<(), Failure> {
    for (option, path) in outputs {
        if let Some((_, allowed)) = ENDINGS.iter().find(|(name, _)| name == option) {
            check_one(option, path, allowed)?;
        }
    }
    Ok(())
}

/// Endings of formats that the file of a shard is not in.
const OTHERS: [&str; 12] = ["csv", "tsv", "xls", "xlsx", "json", "toml", "svg", "png", "pdf", "html", "htm", "txt"];

/// Whether the name that `option` gives the file of a shard, which has a format of its own, promises another one.
///
/// # Errors
/// [`Failure::Input`] if it does.
pub fn check_part(option: &str, path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    let ending = path.extension().map(|ending| ending.to_string_lossy()).unwrap_or_default();
    if OTHERS.iter().any(|other| ending.eq_ignore_ascii_case(other)) {
        let message =
            format!("{option} writes a file for `slipfit merge`, such as .part, not .{ending}: {}", path.display());
        return Err(Failure::Input(message));
    }
    Ok(())
}

/// Whether the ending of `path`, if it has one, is among those `allowed` for what `option` writes.
///
/// # Errors
/// [`Failure::Input`] if it is not.
pub fn check_one(option: &str, path: &Path, allowed: &[&str]) -> Result<(), Failure> {
    let Some(ending) = path.extension().map(|ending| ending.to_string_lossy()) else { return Ok(()) };
    if allowed.iter().any(|one| ending.eq_ignore_ascii_case(one)) {
        return Ok(());
    }
    let allowed = allowed.join(" or .");
    Err(Failure::Input(format!("{option} writes .{allowed}, not .{ending}: {}", path.display())))
}
