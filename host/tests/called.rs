//! Commands as functions of another program.

use std::process::Command;

use slipfit::cli::{
    self,
    call::{Call, Want},
};

/// Another program gets what the command line prints, and columns with all digits instead of a file.
#[test]
fn a_called_command_returns_what_it_would_print() {
    let arguments = ["population", "cd-rom-slide-drawing", "--units", "300", "--threads", "2", "--json"];
    let call = Call::new(arguments.map(Into::into).into(), None, vec![Want::Columns]);
    let answer = cli::answer(&call).unwrap();
    let printed = Command::new(env!("CARGO_BIN_EXE_slipfit")).args(arguments).output().unwrap();
    assert_eq!(answer.text, String::from_utf8(printed.stdout).unwrap());
    let columns = answer.columns.unwrap();
    assert_eq!((columns.rows(), columns.0[0].name.as_str()), (300, "unit"));
    let progress = call.progress().unwrap();
    assert_eq!((progress.what.as_str(), progress.done, progress.of), ("simulating", 300, Some(300)));
    // The scene's text takes the place of a file, and a mistake in it is at its line.
    let call =
        Call::new(["check", "mine.toml"].map(Into::into).into(), Some("title = \"x\"\nmas = 1\n".into()), Vec::new());
    let message = cli::answer(&call).unwrap_err().to_string();
    assert!(message.contains("mine.toml:2"), "{message}");
    let watch = Call::new(["watch", "mine.toml"].map(Into::into).into(), None, Vec::new());
    assert!(cli::answer(&watch).unwrap_err().to_string().starts_with("watch: it serves"), "a call returns");
}
