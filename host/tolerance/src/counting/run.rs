//! Runs of a study that can be split, stopped and gone on with.

use std::{
    ops::Range,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use slipfit_system::files::{self, WriteError};

use super::{
    file::{FormatError, Found, Header, Part, Source},
    study::{Settings, Study, StudyError, Tally},
};
use crate::{model::Model, sampling::sampler};

pub use super::shard::Shard;

/// How often a run saves how far it has come.
const SAVE_EVERY: Duration = Duration::from_secs(2);
/// How long it works before it looks up.
const LOOK_UP_EVERY: Duration = Duration::from_millis(200);

/// Why a run did not end.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A study that cannot be.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A file that cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        error: std::io::Error,
    },
    /// A file that is not a whole part of a study.
    #[error("{}: {error}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Why.
        error: FormatError,
    },
    /// Units that cannot be had.
    #[error("{0}")]
    Work(Box<dyn std::error::Error + Send + Sync>),
    /// A part of something else.
    #[error("{} is of another {what} than {}", path.display(), other.display())]
    Different {
        /// The file.
        path: PathBuf,
        /// What differs.
        what: &'static str,
        /// What it should agree with.
        other: PathBuf,
    },
    /// Shards that are not there.
    #[error("of {count} shards these are missing: {}", list(missing))]
    Missing {
        /// How many there should be.
        count: u64,
        /// Which are missing, from 1 on.
        missing: Vec<u64>,
    },
    /// A shard that is there twice.
    #[error("shard {shard} is there twice: {} and {}", first.display(), second.display())]
    Twice {
        /// Which, from 1 on.
        shard: u64,
        /// One file.
        first: PathBuf,
        /// The other.
        second: PathBuf,
    },
    /// A checkpoint instead of a result.
    #[error("{} is unfinished: {done} of {of} blocks are done", path.display())]
    Unfinished {
        /// The file.
        path: PathBuf,
        /// Blocks done.
        done: u64,
        /// Blocks of the shard.
        of: u64,
    },
    /// What an interrupted run left behind, which this one would replace.
    #[error("{} is there from an interrupted run: --resume goes on with it; remove it to begin anew", .0.display())]
    Left(PathBuf),
    /// Somebody asked to stop.
    #[error("interrupted{}", saved.as_ref().map(|path| format!("; {} is kept, --resume goes on", path.display())).unwrap_or_default())]
    Interrupted {
        /// Where the state was saved.
        saved: Option<PathBuf>,
    },
    /// A file that cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The file's header.
    #[error(transparent)]
    Header(#[from] serde_json::Error),
}

fn list(numbers: &[u64]) -> String {
    let shown: Vec<String> = numbers.iter().take(20).map(u64::to_string).collect();
    let more = if numbers.len() > shown.len() { ", …" } else { "" };
    shown.join(", ") + more
}

/// Where a run keeps its state.
pub struct Keep<'a> {
    /// The file of the result.
    pub out: &'a Path,
    /// Whether to go on where an earlier run stopped.
    pub resume: bool,
}

/// The file that holds how far the run that makes `out` has come.
pub fn checkpoint(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".partial");
    name.into()
}

/// Work on units that comes in blocks.
pub trait Work {
    /// What it finds.
    type Found: Found;

    /// What decides over it, besides the scene.
    fn settings(&self) -> <Self::Found as Found>::Settings;
    /// Nothing found yet.
    fn empty(&self) -> Self::Found;
    /// Whether a file can be of this work.
    fn fits(&self, part: &Part<Self::Found>) -> bool;
    /// Works through `blocks` on all threads of the current pool; `done` is called with units as they come.
    ///
    /// # Errors
    /// [`RunError`]; then nothing is added.
    fn add(&self, blocks: Range<u64>, found: &mut Self::Found, done: &(impl Fn(u64) + Sync)) -> Result<(), RunError>;
}

impl Work for Study<'_> {
    type Found = Vec<Tally>;

    fn settings(&self) -> Settings {
        self.settings
    }

    fn empty(&self) -> Vec<Tally> {
        self.empty()
    }

    fn fits(&self, part: &Part) -> bool {
        part.fits(self.model)
    }

    fn add(&self, blocks: Range<u64>, found: &mut Vec<Tally>, done: &(impl Fn(u64) + Sync)) -> Result<(), RunError> {
        self.add(blocks, found, done);
        Ok(())
    }
}

/// Works through a `shard` of `work`, on the current pool, and writes the result to `keep`'s file if there is one; `done`
/// is called with units as they come. The bytes of the result depend neither on threads nor on interruptions.
///
/// # Errors
/// [`RunError`].
pub fn run<W: Work>(
    work: &W,
    source: &Source,
    shard: Shard,
    keep: Option<&Keep>,
    done: impl Fn(u64) + Sync,
) -> Result<W::Found, RunError> {
    let settings = work.settings();
    let blocks = shard.blocks(W::Found::blocks(&settings));
    let shard = [shard.number, shard.count];
    let header = Header { sampler: sampler::VERSION, source: source.clone(), settings, shard, done: 0 };
    let mut part = Part { header, tallies: work.empty() };
    if let Some(Keep { out, resume: true }) = keep {
        for path in [out.to_path_buf(), checkpoint(out)] {
            if path.exists() {
                part = read_again(&path, &part, work)?;
                break;
            }
        }
    }
    if let Some(left) = keep.filter(|keep| !keep.resume).map(|keep| checkpoint(keep.out)).filter(|path| path.exists()) {
        return Err(RunError::Left(left));
    }
    done(part.tallies.units());
    let save =
        |part: &Part<W::Found>, path: &Path| -> Result<(), RunError> { Ok(files::write(path, &part.encode()?)?) };
    let mut saved = Instant::now();
    // What is long enough to be stopped saves early for the first time.
    let mut due = LOOK_UP_EVERY;
    let mut round = rayon::current_num_threads() as u64;
    while part.header.done < blocks.end - blocks.start {
        let begin = Instant::now();
        let start = blocks.start + part.header.done;
        let end = (start + round).min(blocks.end);
        let added = work.add(start..end, &mut part.tallies, &done);
        let asked = slipfit_system::interrupt::requested();
        if added.is_ok() {
            part.header.done = end - blocks.start;
        } else if !asked {
            added?;
        }
        if begin.elapsed() < LOOK_UP_EVERY {
            round *= 2;
        }
        let stop = asked && part.header.done < blocks.end - blocks.start;
        if let Some(Keep { out, .. }) = keep.filter(|_| stop || (saved.elapsed() >= due && end < blocks.end)) {
            save(&part, &checkpoint(out))?;
            (saved, due) = (Instant::now(), SAVE_EVERY);
        }
        if stop {
            return Err(RunError::Interrupted { saved: keep.map(|keep| checkpoint(keep.out)) });
        }
    }
    if let Some(Keep { out, .. }) = keep {
        // On disk for good, its folder too, before the checkpoint goes. What is left of that would do no harm.
        save(&part, out)?;
        let _ = std::fs::remove_file(checkpoint(out));
    }
    Ok(part.tallies)
}

/// Reads a part of a study.
///
/// # Errors
/// [`RunError`], if it cannot be read or is not whole.
pub fn read<F: Found>(path: &Path) -> Result<Part<F>, RunError> {
    let bytes = std::fs::read(path).map_err(|error| RunError::Read { path: path.into(), error })?;
    Part::decode(&bytes).map_err(|error| RunError::Format { path: path.into(), error })
}

fn read_again<W: Work>(path: &Path, expected: &Part<W::Found>, work: &W) -> Result<Part<W::Found>, RunError> {
    let part = read(path)?;
    agrees(&part, path, &expected.header, Path::new("this run"))?;
    if part.header.shard != expected.header.shard {
        let what = "shard";
        return Err(RunError::Different { path: path.into(), what, other: "this run".into() });
    }
    if work.fits(&part) { Ok(part) } else { Err(damaged(path)) }
}

fn damaged(path: &Path) -> RunError {
    RunError::Format { path: path.into(), error: FormatError::Damaged }
}

fn agrees<F: Found>(part: &Part<F>, path: &Path, header: &Header<F::Settings>, other: &Path) -> Result<(), RunError> {
    let scene = (!part.header.source.is_same(&header.source)).then_some("scene");
    match scene.or_else(|| F::difference(&part.header.settings, &header.settings)) {
        Some(what) => Err(RunError::Different { path: path.into(), what, other: other.into() }),
        None => Ok(()),
    }
}

/// The shards of one study, in any order, joined: a part that is the whole.
///
/// # Errors
/// [`RunError`], if they are not all of one study, each once and finished.
pub fn merge<F: Found>(paths: &[PathBuf]) -> Result<Part<F>, RunError> {
    let mut whole: Option<(Part<F>, Vec<Option<&PathBuf>>)> = None;
    for path in paths {
        let part: Part<F> = read(path)?;
        let [number, count] = part.header.shard;
        if number == 0 || number > count || count > 1 << 20 {
            return Err(damaged(path));
        }
        let blocks = Shard { number, count }.blocks(F::blocks(&part.header.settings));
        if part.header.done != blocks.end - blocks.start {
            let of = blocks.end - blocks.start;
            return Err(RunError::Unfinished { path: path.clone(), done: part.header.done, of });
        }
        match &mut whole {
            None => {
                let mut seen = vec![None; count as usize];
                seen[number as usize - 1] = Some(path);
                whole = Some((part, seen));
            }
            Some((joined, seen)) => {
                let first = seen.iter().flatten().next().map_or(path, |first| *first);
                agrees(&part, path, &joined.header, first)?;
                if seen.len() as u64 != count || !joined.tallies.fits(&part.tallies) {
                    let what = "number of shards";
                    return Err(RunError::Different { path: path.clone(), what, other: first.clone() });
                }
                if let Some(first) = seen[number as usize - 1].replace(path) {
                    return Err(RunError::Twice { shard: number, first: first.clone(), second: path.clone() });
                }
                joined.tallies.join(part.tallies);
            }
        }
    }
    let Some((mut part, seen)) = whole else { return Err(RunError::Missing { count: 1, missing: vec![1] }) };
    let missing: Vec<u64> = (1..).zip(&seen).filter(|(_, path)| path.is_none()).map(|(number, _)| number).collect();
    if !missing.is_empty() {
        return Err(RunError::Missing { count: seen.len() as u64, missing });
    }
    part.header.shard = [1, 1];
    part.header.done = F::blocks(&part.header.settings);
    Ok(part)
}

/// Whether a merged part is of `model`.
///
/// # Errors
/// [`RunError::Format`] if not.
pub fn check(part: &Part, path: &Path, model: &Model) -> Result<(), RunError> {
    if part.fits(model) { Ok(()) } else { Err(damaged(path)) }
}
