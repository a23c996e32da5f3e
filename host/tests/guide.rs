//! The commands of the README and the guide, as they stand there, with what they print.
//!
//! - A block `toml FILE` or `csv FILE` is appended to that file; of a block `diff FILE` each line `-` is replaced by the line `+` after it.
//! - Commands of a `sh` block are run, and what they print is compared with a snapshot.
//! - A `console` block with lines `$ slipfit …` shows what they print. `[..]` stands for any characters of a line, a line
//!   `...` for any lines. Blocks without such lines need the repository, a target or minutes, and are not run.
//!
//! The gallery has a test of its own, which writes it.

use std::{
    fmt::Write,
    path::{Path, PathBuf},
    process::Command,
};

/// The README and the guide's pages, in the order of their names.
fn pages() -> Vec<PathBuf> {
    let host = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut pages = vec![host.join("../README.md")];
    for folder in ["guide/src", "guide/src/notes"] {
        let files = std::fs::read_dir(host.join(folder)).unwrap().map(|entry| entry.unwrap().path());
        pages.extend(
            files.filter(|path| path.extension().is_some_and(|ext| ext == "md") && !path.ends_with("gallery.md")),
        );
    }
    pages.sort();
    pages
}

/// The code blocks of a page: what stands behind the fence, and the lines.
fn blocks(page: &str) -> impl Iterator<Item = (&str, &str)> {
    page.split("```").skip(1).step_by(2).filter_map(|block| block.split_once('\n'))
}

/// What a command prints, errors and warnings included, and whether it succeeded. What a run took is another time every time.
fn printed(folder: &Path, command: &str) -> (String, bool) {
    let program = Path::new(env!("CARGO_BIN_EXE_slipfit")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let output =
        Command::new("sh").current_dir(folder).env("PATH", path).args(["-c", &format!("{command} 2>&1")]).output();
    let output = output.unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let lines = text.lines().map(|line| match line.rsplit_once(") in ") {
        Some((start, took)) if line.starts_with("Computed by") && took.ends_with("ms") => {
            format!("{start}) in [..] ms")
        }
        _ => line.trim_end().to_owned(),
    });
    (lines.map(|line| line + "\n").collect(), output.status.success())
}

/// Whether `line` is as `expected`, in which `[..]` stands for any characters.
fn is_line(expected: &str, line: &str) -> bool {
    match expected.split_once("[..]") {
        None => expected == line,
        Some((start, rest)) => line.strip_prefix(start).is_some_and(|line| {
            line.char_indices().map(|(at, _)| at).chain([line.len()]).any(|at| is_line(rest, &line[at..]))
        }),
    }
}

/// Whether `lines` are as `expected`, in which a line `...` stands for any lines.
fn are_lines(expected: &[&str], lines: &[&str]) -> bool {
    match expected {
        [] => lines.is_empty(),
        ["...", rest @ ..] => (0..=lines.len()).any(|skipped| are_lines(rest, &lines[skipped..])),
        [first, rest @ ..] => {
            lines.split_first().is_some_and(|(line, others)| is_line(first, line) && are_lines(rest, others))
        }
    }
}

/// Lines without empty ones at the end.
fn lines_of(text: &str) -> Vec<&str> {
    text.trim_end().lines().collect()
}

/// Replaces each line `-` of a `diff` by the line `+` after it, or by nothing.
fn edit(path: &Path, diff: &str) {
    let mut text = std::fs::read_to_string(path).unwrap();
    let mut lines = diff.lines().peekable();
    while let Some(line) = lines.next() {
        let Some(old) = line.strip_prefix('-') else { continue };
        let new = lines.next_if(|line| line.starts_with('+')).map_or("", |line| &line[1..]);
        assert_eq!(text.matches(old).count(), 1, "{}: {old}", path.display());
        text = text.replacen(old, new, 1);
    }
    std::fs::write(path, text).unwrap();
}

/// The file of a shipped scene.
fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

/// Appends a block of a file to it, or changes it as a `diff` says; other blocks belong to no file.
fn write(folder: &Path, kind: &str, file: &str, block: &str) {
    let path = folder.join(file);
    match kind {
        "toml" | "csv" if !file.is_empty() => {
            let before = std::fs::read_to_string(&path).unwrap_or_default();
            std::fs::write(path, before + block).unwrap();
        }
        "diff" if !file.is_empty() => edit(&path, block),
        _ => {}
    }
}

/// Does what the blocks of a page say, in a folder of its own; the outputs of its `sh` blocks. What is printed otherwise than a `console`
/// block says is added to `wrong`.
fn follow(page: &Path, wrong: &mut Vec<String>) -> String {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(page).unwrap();
    // What a reader has copied from the shipped scene.
    std::fs::copy(shipped("cd-rom-slide.toml"), folder.path().join("my-slide.toml")).unwrap();
    let mut outputs = String::new();
    for (fence, block) in blocks(&text) {
        match fence.split_once(' ').unwrap_or((fence, "")) {
            ("sh", _) => {
                for line in block.lines() {
                    let command = line.split("  #").next().unwrap_or(line).trim();
                    // Installing and testing take cargo.
                    if !command.is_empty() && !command.starts_with("cargo ") {
                        assert!(command.starts_with("slipfit "), "{}: {command}", page.display());
                        let (printed, succeeded) = printed(folder.path(), command);
                        assert!(succeeded, "{}: {command}: {printed}", page.display());
                        let _ = write!(outputs, "$ {command}\n{printed}\n");
                    }
                }
            }
            ("console", _) if block.contains("$ slipfit ") => {
                for shown in block.split("$ ").skip(1) {
                    let (command, expected) = shown.split_once('\n').unwrap();
                    let (printed, succeeded) = printed(folder.path(), command.split("  #").next().unwrap().trim());
                    let is_right = succeeded != expected.starts_with("error")
                        && are_lines(&lines_of(expected), &lines_of(&printed));
                    if !is_right {
                        let page = page.display();
                        wrong.push(format!("{page}: {command}\nprints\n{printed}\nand not\n{expected}"));
                    }
                }
            }
            (kind, file) => write(folder.path(), kind, file, block),
        }
    }
    outputs
}

#[test]
fn every_command_of_the_guide_prints_what_it_says() {
    let mut wrong = Vec::new();
    for page in pages() {
        let outputs = follow(&page, &mut wrong);
        if !outputs.is_empty() {
            let name = page.file_stem().unwrap().to_str().unwrap().to_lowercase();
            insta::with_settings!({ prepend_module_to_snapshot => true, omit_expression => true }, {
                insta::assert_snapshot!(name, outputs);
            });
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn wildcards_stand_for_what_they_say() {
    assert!(is_line("in [..] ms", "in 1.06 ms") && !is_line("in [..] ms", "in 1.06 s"));
    assert!(are_lines(&["a", "...", "c"], &["a", "b", "b", "c"]) && !are_lines(&["a", "...", "c"], &["a", "b"]));
    assert!(are_lines(&["a", "...", "c"], &["a", "c"]) && !are_lines(&["a", "c"], &["a", "b", "c"]));
}

#[test]
fn the_shipped_drawer_is_that_of_the_tutorial() {
    let folder = tempfile::tempdir().unwrap();
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("guide/src/tutorial.md");
    for (fence, block) in blocks(&std::fs::read_to_string(page).unwrap()) {
        let (kind, file) = fence.split_once(' ').unwrap_or((fence, ""));
        write(folder.path(), kind, file, block);
    }
    let [made, shipped] = ["drawer.toml", "drawer"].map(|scene| {
        let closer = "--set dimension.groove.tolerance=0.06";
        printed(folder.path(), &format!("slipfit population {scene} --units 64 {closer} --json"))
    });
    assert!(made.1 && made == shipped, "{}", made.0);
}
