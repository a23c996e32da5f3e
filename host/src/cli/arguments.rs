//! Arguments that several commands share: the scene, the drive, the threads.

use std::{
    borrow::Cow,
    io::Read,
    path::{Path, PathBuf},
};

use clap::{
    Args,
    builder::{PossibleValuesParser, TypedValueParser},
};
use slipfit_system::files;
use slipfit_tolerance::product::Product;

use super::{
    call, encoding, endings,
    failure::{Failure, refused},
    terminal::warn,
};
use crate::{
    mechanism::{ByDrive, Mechanism},
    scene::{Override, SHIPPED, SceneError, SceneFile, shipped},
    setup::Scene,
};

/// A parser of the names of `all`.
pub fn one_of<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(all.map(name)).try_map(move |given| {
        all.into_iter().find(|one| name(*one) == given).ok_or_else(|| format!("{given} is none of them"))
    })
}

/// The shipped scene that commands work on: the paper's slide with Table 2 as given.
const TABLE_2: &str = "cd-rom-slide";
/// The shipped scene of the commands that start from a drawing: the same slide, Table 2 following from its parts.
pub const DRAWING: &str = "cd-rom-slide-drawing";

/// What every command takes.
#[derive(Args)]
pub struct SceneArguments {
    /// Scene file (TOML), or the name of a shipped scene.
    #[arg(default_value = TABLE_2)]
    pub scene: PathBuf,
    /// Sets a key of the scene, such as contact.stiffness=1000 or "slide.mass=90 g"; may be repeated.
    ///
    /// A table of a list goes by its name: "pin.left front.left=[0.01, 0.05]".
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Prints JSON instead of text.
    #[arg(long)]
    pub json: bool,
}

/// What moves in a scene.
pub enum Moving {
    /// A slide on pins.
    Slide(Box<Scene>),
    /// Bodies and joints.
    Mechanism(Box<Mechanism>),
}

impl Moving {
    /// What moves in the scene `text` of the file `name`, and the product it belongs to, if there is one.
    pub fn parse(name: &str, text: &str, set: &[Override]) -> Result<(Self, Option<Product>), SceneError> {
        let mut file = SceneFile::parse(name, text, set)?;
        if let Some(mechanism) = file.mechanism.take() {
            return Ok((Self::Mechanism(Box::new(mechanism)), file.product));
        }
        let (scene, product) = file.into_slide(name, text)?;
        Ok((Self::Slide(Box::new(scene)), product))
    }
}

/// The longest scene file (bytes).
const SCENE_MOST: u64 = 1 << 20;

impl SceneArguments {
    /// Whether all `outputs`, each with the option that asks for it, can be written, and none is the scene or another.
    pub fn check_outputs(&self, outputs: &[(&str, &Path)]) -> Result<(), Failure> {
        endings::check(outputs)?;
        let inputs = if outputs.is_empty() { Vec::new() } else { self.inputs() };
        let inputs: Vec<_> = inputs.iter().map(|(name, path)| (*name, path.as_path())).collect();
        files::check_distinct(&inputs, outputs)?;
        outputs.iter().try_for_each(|(_, path)| files::check_writable(path).map_err(refused))
    }

    /// The scene and the files that it refers to, each with what it is.
    pub fn inputs(&self) -> Vec<(&'static str, PathBuf)> {
        let mut inputs = vec![("the scene", self.scene.clone())];
        // A stream is read once; reading the scene reports what is wrong with its file.
        if let (true, Ok((name, text))) = (self.scene.is_file(), self.text()) {
            inputs.extend(SceneFile::files(&name, &text, &self.overrides(&[])));
        }
        inputs
    }

    /// Reads the scene file, with `options` as further settings.
    pub fn load_file(&self, options: &[Override]) -> Result<SceneFile, Failure> {
        let (name, text) = self.text()?;
        Ok(SceneFile::parse(&name, &text, &self.overrides(options))?)
    }

    /// Reads what moves in the scene, with `options` as further settings, and warns about what is implausible in it: for commands
    /// whose result has no place for warnings.
    pub fn load_moving(&self, options: &[Override]) -> Result<Moving, Failure> {
        let (moving, _) = self.load_moving_with_product(options)?;
        warn(match &moving {
            Moving::Slide(scene) => &scene.warnings,
            Moving::Mechanism(found) => &found.warnings,
        });
        Ok(moving)
    }

    /// Reads what moves in the scene and the product it belongs to, if there is one, with `options` as further settings.
    pub fn load_moving_with_product(&self, options: &[Override]) -> Result<(Moving, Option<Product>), Failure> {
        let (name, text) = self.text()?;
        Ok(Moving::parse(&name, &text, &self.overrides(options))?)
    }

    /// Reads the slide of the scene and the product it belongs to, if there is one, with `options` as further settings.
    pub fn load_with_product(&self, options: &[Override]) -> Result<(Scene, Option<Product>), Failure> {
        let (name, text) = self.text()?;
        Ok(SceneFile::parse_with_slide(&name, &text, &self.overrides(options))?)
    }

    pub fn overrides(&self, options: &[Override]) -> Vec<Override> {
        self.set.iter().map(|assignment| Override::set(assignment)).chain(options.iter().cloned()).collect()
    }

    /// The scene's name without folder and ending.
    pub fn stem(&self) -> &std::ffi::OsStr {
        self.scene.file_stem().unwrap_or("scene".as_ref())
    }

    /// Its name for messages, and its text: of a file, or of a shipped one by its name.
    pub fn text(&self) -> Result<(String, Cow<'static, str>), Failure> {
        let path = &self.scene;
        let name = path.to_string_lossy();
        if let Some(text) = call::scene() {
            return Ok((name.into_owned(), text.into()));
        }
        // A folder is no scene: where there is one of that name, the shipped one is meant.
        if let Some(text) = shipped(&name).filter(|_| !path.exists() || path.is_dir()) {
            return Ok((format!("{name}.toml"), text.into()));
        }
        Ok((path.display().to_string(), text_of(path)?.into()))
    }
}

/// The text of a scene's file.
pub fn text_of(path: &Path) -> Result<String, Failure> {
    let unreadable =
        |why: &dyn std::fmt::Display| Failure::Input(format!("cannot read the scene {}: {why}", path.display()));
    let file = std::fs::File::open(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            let names: Vec<_> = SHIPPED.iter().map(|(name, _)| *name).collect();
            unreadable(&format!("{error}; shipped scenes are {}", names.join(", ")))
        }
        _ => unreadable(&error),
    })?;
    let mut bytes = Vec::new();
    file.take(SCENE_MOST + 1).read_to_end(&mut bytes).map_err(|error| unreadable(&error))?;
    if bytes.len() as u64 > SCENE_MOST {
        return Err(unreadable(&format!("it is longer than {SCENE_MOST} bytes")));
    }
    encoding::text_of(bytes).map_err(|error| unreadable(&error))
}

/// Which drive of a mechanism.
#[derive(Args)]
pub struct DriveArguments {
    /// Name of the drive, where a mechanism has several.
    #[arg(long, value_name = "NAME")]
    pub drive: Option<String>,
}

impl DriveArguments {
    /// The drive of `mechanism` that is meant.
    pub fn of<'m>(&self, mechanism: &'m Mechanism) -> Result<ByDrive<'m>, Failure> {
        let names: Vec<_> = mechanism.drives.iter().map(|drive| drive.name.as_str()).collect();
        let found = match (&self.drive, &names[..]) {
            (_, []) => {
                Err("the mechanism has no [[drive]], which this command is about; simulate tells how it moves".into())
            }
            (None, [_]) => Ok(0),
            (None, _) => {
                Err(format!("the mechanism has several drives: --drive says which, one of {}", names.join(", ")))
            }
            (Some(name), _) => names
                .iter()
                .position(|one| one == name)
                .ok_or_else(|| format!("--drive: there is no drive {name:?}, there is {}", names.join(", "))),
        };
        let index = found.map_err(Failure::Input)?;
        Ok(ByDrive::new(mechanism, index).expect("a drive's index"))
    }

    /// An error if a drive is named for a slide.
    pub fn refuse(&self) -> Result<(), Failure> {
        let given = self.drive.is_some();
        if given { Err(Failure::Input("--drive is for mechanisms, a slide has one drive".into())) } else { Ok(()) }
    }
}

/// Number of threads of the commands that work on many units.
#[derive(Args)]
pub struct ThreadArguments {
    /// Number of threads; all cores if not given. The result does not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

impl ThreadArguments {
    /// Runs `work` on a pool of that many threads.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
        let threads = self.threads.map_or(0, usize::from);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(anyhow::Error::from)?;
        let call = call::current();
        Ok(pool.install(|| call::within(call, work)))
    }
}
