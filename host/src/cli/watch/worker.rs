//! What follows the file: looks at it, and computes one stage after another until it changes.

use std::{
    ffi::OsString,
    path::PathBuf,
    sync::Arc,
    time::{Duration, SystemTime},
};

use serde_json::json;
use slipfit_system::interrupt;

use super::{
    board::{Board, Wanted},
    knobs::{knobs, settings},
    stage::{Done, Stage},
};
use crate::{
    cli::arguments::{SceneArguments, text_of},
    scene::SceneFile,
};

/// How often the file is looked at. Looking is what works with every editor: some write in place, others rename or link.
const INTERVAL: Duration = Duration::from_millis(10);
/// Units of the samples of the production, one sample after the other.
const UNITS: [u32; 3] = [64, 512, 4096];

/// Follows a scene.
pub struct Worker {
    program: Vec<OsString>,
    scene: SceneArguments,
    board: Arc<Board>,
    seen: Option<Seen>,
    /// What runs, and what has not yet begun.
    running: Option<(Task, Stage)>,
    waiting: Vec<Task>,
    /// Why there is no unit, until the check says whether the scene is sound.
    no_unit: Option<String>,
}

/// All that a result depends on.
#[derive(Clone, PartialEq)]
struct Seen {
    text: Result<String, String>,
    /// Files that the scene refers to, each with its time and length.
    others: Vec<(PathBuf, Option<(SystemTime, u64)>)>,
    wanted: Wanted,
}

/// A stage's section on the page, and the command that computes it.
struct Task {
    section: &'static str,
    arguments: Vec<String>,
    /// The page that it writes; otherwise it prints.
    page: Option<tempfile::TempDir>,
}

impl Worker {
    /// Of this `scene`, whose results go to the `board`. `program` is what starts this program again.
    pub fn new(program: &[OsString], scene: SceneArguments, board: Arc<Board>) -> Self {
        Self { program: program.to_vec(), scene, board, seen: None, running: None, waiting: Vec::new(), no_unit: None }
    }

    /// Works until the process is asked to stop. Then no stage is left behind.
    pub fn work(mut self) {
        while !interrupt::requested() {
            let now = self.look();
            if self.seen.as_ref() != Some(&now) {
                self.begin(now);
            }
            self.advance();
            std::thread::sleep(INTERVAL);
        }
    }

    fn look(&self) -> Seen {
        let wanted = self.board.state().wanted.clone();
        let text = text_of(&self.scene.scene).map_err(|error| error.to_string());
        let others: Vec<PathBuf> = match &self.seen {
            // What the scene refers to is in its text.
            Some(seen) if seen.text == text => seen.others.iter().map(|(path, _)| path.clone()).collect(),
            _ => {
                let name = self.scene.scene.to_string_lossy();
                let files = text.as_ref().map(|text| SceneFile::files(&name, text, &self.scene.overrides(&[])));
                files.unwrap_or_default().into_iter().map(|(_, path)| path).collect()
            }
        };
        let stamp = |path: PathBuf| {
            let about = std::fs::metadata(&path).ok().and_then(|about| Some((about.modified().ok()?, about.len())));
            (path, about)
        };
        Seen { text, others: others.into_iter().map(stamp).collect(), wanted }
    }

    /// Drops stale work and begins anew.
    fn begin(&mut self, now: Seen) {
        self.running = None;
        self.waiting.clear();
        self.no_unit = None;
        let text = now.text.as_deref().unwrap_or_default();
        let known = knobs(text);
        let mut set = self.scene.set.clone();
        set.extend(settings(text, &known, &now.wanted.set));
        let mut state = self.board.state();
        state.text = now.text.as_ref().ok().cloned();
        drop(state);
        match &now.text {
            Err(why) => {
                self.board.show("problem", why.as_str());
                self.board.show("status", "waits for a scene that can be read");
            }
            Ok(_) => {
                self.board.show("knobs", json!({ "knobs": known, "wanted": now.wanted }));
                self.board.show("status", "computes …; what has a bar on its left is not yet current");
                self.waiting = self.tasks(&set, now.wanted.n);
            }
        }
        self.seen = Some(now);
    }

    /// All stages, the last first.
    fn tasks(&self, set: &[String], n: f64) -> Vec<Task> {
        let task = |section, command: &str, options: &[String]| {
            let mut arguments = vec![command.to_owned()];
            arguments.extend(set.iter().map(|setting| format!("--set={setting}")));
            arguments.extend(options.iter().cloned());
            arguments.extend(["--".into(), self.scene.scene.to_string_lossy().into_owned()]);
            Task { section, arguments, page: None }
        };
        let mut tasks = vec![
            task("unit", "watch", &[format!("--preview={n}")]),
            task("check", "check", &[format!("--n={n}")]),
            task("tolerance", "tolerance", &[]),
        ];
        tasks.extend(UNITS.map(|units| task("population", "population", &[format!("--units={units}")])));
        tasks.reverse();
        tasks
    }

    /// Starts the next stage, or takes what one has come to.
    fn advance(&mut self) {
        let Some((task, stage)) = &mut self.running else {
            let Some(mut task) = self.waiting.pop() else { return };
            match start(&self.program, &mut task) {
                Ok(stage) => self.running = Some((task, stage)),
                Err(error) => self.failed(&format!("cannot compute: {error}")),
            }
            return;
        };
        match stage.done() {
            Ok(None) => {}
            Ok(Some(done)) => {
                let page = task.page.as_ref().map(|folder| std::fs::read_to_string(folder.path().join(PAGE)));
                let section = task.section;
                self.running = None;
                match page.transpose() {
                    Err(error) if done.success => self.failed(&format!("cannot read a result: {error}")),
                    page => self.take(section, &done, page.unwrap_or_default()),
                }
            }
            Err(error) => {
                self.running = None;
                self.failed(&format!("cannot compute: {error}"));
            }
        }
    }

    /// Shows what the stage of a `section` has come to.
    fn take(&mut self, section: &'static str, done: &Done, page: Option<String>) {
        match (section, done.success) {
            // A product without motion has no unit; the check says whether the scene is sound.
            ("unit", true) => {
                self.board.show("problem", "");
                self.board.show("unit", json!({ "html": done.stdout }));
            }
            ("unit", false) => {
                self.board.show("problem", done.stderr.as_str());
                self.no_unit = Some(done.stderr.clone());
            }
            ("check", false) => return self.failed(&done.stderr),
            // Only products have measures.
            ("tolerance", false) => self.board.show(section, json!({ "text": "" })),
            (section, _) => {
                if let (Some(why), "check") = (&self.no_unit, section) {
                    self.board.show("problem", "");
                    self.board.show("unit", json!({ "text": why }));
                }
                let main = page.as_deref().and_then(main_of);
                let text = if done.success { &done.stdout } else { &done.stderr };
                self.board.show(section, main.map_or_else(|| json!({ "text": text }), |html| json!({ "html": html })));
            }
        }
        if self.waiting.is_empty() {
            self.board.show("status", "up to date");
        } else if section == "population" && !done.success {
            // More units would fail likewise.
            self.waiting.clear();
            self.board.show("status", "up to date");
        }
    }

    /// Shows why nothing more is computed until the file changes.
    fn failed(&mut self, why: &str) {
        self.waiting.clear();
        self.board.show("problem", why);
        self.board.show("status", "waits for a change");
    }
}

/// The name of a page in its folder.
const PAGE: &str = "page.html";

/// Starts the stage of a `task`; that of a population writes a page.
fn start(program: &[OsString], task: &mut Task) -> std::io::Result<Stage> {
    if task.section == "population" {
        let folder = tempfile::tempdir()?;
        let page = folder.path().join(PAGE);
        task.arguments.insert(1, format!("--page={}", page.display()));
        task.page = Some(folder);
    }
    Stage::start(program, &task.arguments)
}

/// What is on a page below its title.
fn main_of(page: &str) -> Option<&str> {
    let (_, main) = page.split_once("</h1>")?;
    main.rsplit_once("</main>").map(|(main, _)| main)
}

#[cfg(test)]
mod tests {
    use super::main_of;

    #[test]
    fn a_page_is_cut_below_its_title() {
        assert_eq!(main_of("<main><h1>x</h1><p>y</p></main><script></script>"), Some("<p>y</p>"));
        assert_eq!(main_of(""), None);
    }
}
