//! The guide's gallery: every shipped scene with its picture, its question and the program's own answer. Written with
//! `INSTA_UPDATE=always`; otherwise the test fails where page or pictures are not what the program gives.

use std::{
    fmt::Write,
    path::{Path, PathBuf},
    process::Command,
};

use slipfit::scene::{SHIPPED, SceneFile};

/// What the program prints in `folder`.
fn printed(folder: &Path, arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_slipfit")).current_dir(folder).args(arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

const INTRODUCTION: &str = "# Gallery

Every scene that slipfit ships, with a question, a picture, and the program's answer. Take the scene that is nearest to your product
and change it. The word behind the command is the scene's name; its file is `host/scenes/NAME.toml`.

- Slides on pins: `drawer`, `cd-rom-slide`, `cd-rom-slide-fast`, `cd-rom-slide-drawing`, `slide-processes`.
- Dimensions that add up: `three-part-stack`, `clutch`, `clutch-processes`, `shaft-housing`, `linear-chain`, `worn-tool`.
- Parts with geometric tolerances: `three-locators`, `lid-on-pins`, `cd-rom-slide-drawing`.
- Mechanisms in a plane: `slider-crank`, `slider-crank-guide`, `four-bar`, `woodpecker-toy`.
- Mechanisms in space: `linear-guide`, `telescopic-drawer`, `hatch`, `ball-rod`.

How to read the answers:

- **Levels.** A line has a range of tolerance levels n and their verdict: runs, crawls or jammed ([concepts](concepts.md)). n = 0 is
  the mean unit, positive n is tighter, negative n looser. In the picture of a slide the grey hill is the normal distribution of a single gap over n. It is no distribution of
  units, because the gaps of a real unit vary one by one: [populations](population.md) count those.
- **Pictures of mechanisms** show the pose in which the scene file draws them; play is not to scale. In a *track* a point of one body
  moves between four surfaces of another; its four gaps are left, right, rail and wall.
- **Measures.** Mean and standard deviation σ; the other columns of the table are left out here.
- **Contributors.** Each line names a measure and the share of its variance, in %, that comes from each contributor. Listed are the six
  largest of at least 1 %. `(Sobol')` marks a measure that is not nearly linear; its shares are total Sobol' indices
  ([glossary](glossary.md#statistics)).
- **Yield.** The share of the units drawn that have all measures within their limits; the brackets hold its 95 % interval.
- **Tolerances of `allocate`.** `new line` is the line to paste, `before` the tolerance that it replaces, in mm. The costs
  are in the currency of the scene.
";

/// What is asked, and what of the output is the answer.
struct Shown {
    command: Vec<&'static str>,
    /// The picture's options and the file that they write.
    picture: Option<(Vec<&'static str>, &'static str)>,
    /// Lines from the first that begins so to the next empty one.
    from: &'static str,
}

/// Units of a product's analysis.
const UNITS: [&str; 2] = ["--samples", "20000"];

fn shown(name: &'static str, file: &SceneFile) -> Shown {
    if let Some(mechanism) = &file.mechanism {
        let drawing = Some((vec!["check", name, "--plot", "picture.svg"], "picture.svg"));
        return match mechanism.drives.is_empty() {
            false => Shown { command: vec!["sweep", name], picture: drawing, from: "n = " },
            true => Shown { command: vec!["simulate", name], picture: drawing, from: " at the end" },
        };
    }
    if file.slide.is_some() {
        let command = vec!["sweep", name, "--stroke"];
        let picture = [&command[..], &["--plot", "picture.svg"]].concat();
        return Shown { command, picture: Some((picture, "picture.svg")), from: "n = " };
    }
    let analysis = [&["tolerance", name][..], &UNITS].concat();
    let picture = Some(([&analysis[..], &["--plots", "."]].concat(), "histogram-1.svg"));
    if ["clutch-processes", "shaft-housing"].contains(&name) {
        let command = [&["allocate", name][..], &UNITS].concat();
        return Shown { command, picture, from: " tolerance of" };
    }
    Shown { command: analysis, picture, from: "Largest contributors" }
}

/// The first paragraph of the comment that a scene begins with.
fn question(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("# "));
    lines.collect::<Vec<_>>().join(" ")
}

/// The answer among the lines of `output`; a product's yield as well.
fn answer(output: &str, from: &str) -> String {
    let lines = output.lines().skip_while(|line| !line.starts_with(from)).take_while(|line| !line.trim().is_empty());
    let of_yield = output.lines().filter(|line| line.starts_with("yield "));
    lines.chain(of_yield).map(|line| format!("{}\n", line.trim_end())).collect()
}

/// Mean and standard deviation of the measures, the first columns of the first table.
fn measures(output: &str) -> String {
    let mut lines = output.lines().skip_while(|line| !line.starts_with(" measure")).peekable();
    let width =
        lines.peek().map_or(0, |line| line.split(" skew").next().unwrap_or_default().trim_end().chars().count());
    let table = lines.take_while(|line| !line.is_empty());
    let cut = table.map(|line| format!("{}\n", line.chars().take(width).collect::<String>().trim_end()));
    cut.collect::<String>() + "\n"
}

/// The page, and pictures by the names of their files.
fn gallery() -> (String, Vec<(String, String)>) {
    let mut page = INTRODUCTION.to_owned();
    let mut pictures = Vec::new();
    for (name, text) in SHIPPED {
        let file = SceneFile::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let Shown { command, picture, from } = shown(name, &file);
        let folder = tempfile::tempdir().unwrap();
        let _ = write!(page, "\n## {}\n\n{}\n\n", file.title, question(text));
        if let Some((options, written)) = picture {
            printed(folder.path(), &options);
            pictures.push((format!("{name}.svg"), std::fs::read_to_string(folder.path().join(written)).unwrap()));
            let _ = write!(page, "![{}](gallery/{name}.svg)\n\n", file.title);
        }
        let output = printed(folder.path(), &command);
        let measures = if command[0] == "tolerance" { measures(&output) } else { String::new() };
        let found = measures + &answer(&output, from);
        assert!(!found.is_empty(), "{name}");
        let _ = write!(page, "```console\n$ slipfit {}\n{found}```\n", command.join(" "));
    }
    (page, pictures)
}

#[test]
fn every_shipped_scene_is_in_the_gallery_as_the_program_has_it() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("guide/src");
    let (page, pictures) = gallery();
    let named = pictures.into_iter().map(|(name, svg)| (folder.join("gallery").join(name), svg));
    let all: Vec<(PathBuf, String)> = std::iter::once((folder.join("gallery.md"), page)).chain(named).collect();
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::create_dir_all(folder.join("gallery")).unwrap();
        all.iter().for_each(|(path, text)| std::fs::write(path, text).unwrap());
    }
    for (path, text) in all {
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(committed == text, "{} is not current; INSTA_UPDATE=always writes it", path.display());
    }
}
