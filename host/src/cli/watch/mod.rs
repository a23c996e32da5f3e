//! `slipfit watch`: a page in the browser that follows a scene's file.

mod board;
mod knobs;
mod page;
mod preview;
mod request;
mod server;
mod stage;
mod worker;

use std::{ffi::OsString, sync::Arc};

use clap::Args;

use self::{board::Board, server::Server, worker::Worker};
use super::{
    arguments::{SceneArguments, text_of},
    failure::Failure,
    terminal::print,
};

/// Shows a scene as a page in the browser, which follows the file while you edit it.
///
/// Whenever the file is saved, the page shows what is wrong at its line, or the verdict, the motion of one unit and, growing while you
/// look, the production. Sliders try other values; "write back" puts one into the file, and comments stay. The page is served on this
/// machine alone, at the address that the command prints. Ctrl-C ends it.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Port of the page; a free one if not given.
    #[arg(long)]
    port: Option<u16>,
    /// Prints the first part of the page and ends: what the command starts itself with.
    #[arg(long, hide = true, value_name = "N", allow_hyphen_values = true)]
    preview: Option<f64>,
}

impl Arguments {
    /// Runs the command until it is interrupted. `program` is what starts this program again, if not what runs now.
    ///
    /// # Errors
    /// A scene that is no file, a port that is taken.
    pub(super) fn run(self, program: &[OsString]) -> Result<(), Failure> {
        if let Some(n) = self.preview {
            return preview::preview(&self.scene, n);
        }
        if self.scene.json {
            return Err(Failure::Input("--json: a page has none; `slipfit simulate --json` prints the results".into()));
        }
        let path = &self.scene.scene;
        if !path.is_file() {
            text_of(path)?;
            return Err(Failure::Input(format!("{}: only a file can be watched", path.display())));
        }
        let board = Arc::new(Board::default());
        let port = self.port.unwrap_or(0);
        let server = Server::bind(port, path.clone(), board.clone());
        let server = server.map_err(|error| Failure::Input(format!("--port {port}: {error}")))?;
        let url = server.url();
        server.start();
        print(&format!("{url}\nshows {} anew after each save; Ctrl-C ends it", path.display()))?;
        Worker::new(program, self.scene, board).work();
        Ok(())
    }
}
