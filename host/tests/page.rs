//! Pages in a browser: no error on the console, every figure there, and a player that moves.

mod common;

use std::{path::Path, process::Command};

use common::{slipfit, stdout};

/// What watches for errors from the first line of the page on.
const WATCH: &str = "<script>window.wrong = []; addEventListener('error', event => window.wrong.push(event.message)); \
    console.error = (...words) => window.wrong.push(words.join(' ')); console.warn = console.error;</script>";

/// What tries the player and writes what it saw into the page: how many frames look different, how many runs there are and
/// whether another looks different, what went wrong, whether anything is wider than the page.
const TRY: &str = "<script>addEventListener('load', () => {
const figure = document.querySelector('figure.player');
const runs = JSON.parse(figure.querySelector('script').textContent).length;
const seen = () => [...figure.querySelectorAll('svg')].map(svg => svg.outerHTML).join();
const pictures = new Set();
for (let frame = 0; frame < 60; frame += 5) { figure.player.show(frame); pictures.add(seen()); }
figure.player.choose(0); figure.player.show(30); const first = seen();
figure.player.choose(runs - 1); figure.player.show(30);
const result = {
  pictures: pictures.size, frame: figure.dataset.frame, run: Number(figure.dataset.run), runs, differ: first !== seen(),
  figures: document.querySelectorAll('figure').length, drawn: document.querySelectorAll('figure svg').length,
  wide: document.documentElement.scrollWidth <= innerWidth, wrong: window.wrong.join('; '),
};
document.title = JSON.stringify(result);
});</script>";

/// The page as the browser has it after its scripts have run, in a window of this width.
fn opened(page: &Path, width: u32) -> String {
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new("chromium")
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--no-first-run",
            "--virtual-time-budget=5000",
        ])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("--window-size={width},1000"))
        .arg("--dump-dom")
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("a browser is needed: on Debian, apt-get install chromium");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn result(dom: &str) -> serde_json::Value {
    let title = dom.split_once("<title>").unwrap().1.split_once("</title>").unwrap().0;
    serde_json::from_str(&title.replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">")).unwrap()
}

/// Opens the `page` at two widths: it has so many `runs` to play and so many `figures`.
#[track_caller]
fn moves(page: &Path, runs: u64, figures: u64) {
    let text = std::fs::read_to_string(page).unwrap();
    let outside = text.split("src=\"").skip(1).chain(text.split("href=\"").skip(1)).next();
    assert!(outside.is_none_or(|link| link.starts_with('#')), "{outside:?}");
    let text = text.replacen("<head>", &format!("<head>{WATCH}"), 1).replacen("</body>", &format!("{TRY}</body>"), 1);
    let tried = page.with_extension("tried.html");
    std::fs::write(&tried, text).unwrap();
    for width in [1400, 500] {
        let found = result(&opened(&tried, width));
        let number = |key: &str| found[key].as_u64().unwrap();
        assert_eq!(found["wrong"], "", "{found}");
        assert_eq!((number("runs"), number("figures"), number("run")), (runs, figures, runs - 1), "{found}");
        assert!(number("drawn") >= figures && number("pictures") >= 10 && found["frame"] == "30", "{found}");
        assert_eq!(found["differ"], runs > 1, "{found}");
        assert!(found["wide"] == true, "wider than a window of {width}: {found}");
    }
}

#[test]
fn the_page_of_a_population_moves_without_an_error() {
    let folder = tempfile::tempdir().unwrap();
    stdout(&slipfit(folder.path(), &["population", "cd-rom-slide-drawing", "--units", "128", "--page", "units.html"]));
    // Of so few units chance could explain the share of any tolerance, so that there is no picture of shares.
    moves(&folder.path().join("units.html"), 3, 5);
}

#[test]
fn so_does_that_of_a_level_and_of_a_unit() {
    let folder = tempfile::tempdir().unwrap();
    for (options, title) in [(["--n", "2.5"], "n = +2.5: runs"), (["--unit", "17"], "unit 17: ")] {
        let command = ["simulate", "cd-rom-slide-drawing", "--stroke", "--page", "one.html"];
        stdout(&slipfit(folder.path(), &[&command[..], &options].concat()));
        let page = folder.path().join("one.html");
        let text = std::fs::read_to_string(&page).unwrap();
        assert!(text.contains(title) && text.contains("What this unit does"), "{title}");
        moves(&page, 1, 2);
    }
}

#[test]
fn so_does_the_report_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    stdout(&slipfit(folder.path(), &["run", "cd-rom-slide", "--n", "0:4:1"]));
    // The player, four pictures of units, five of the sweep.
    moves(&folder.path().join("slipfit-out/cd-rom-slide/report.html"), 3, 10);
}

#[test]
fn so_do_the_pages_of_mechanisms() {
    let folder = tempfile::tempdir().unwrap();
    let page = |arguments: &[&str]| {
        stdout(&slipfit(folder.path(), &[arguments, &["--page", "page.html"]].concat()));
        folder.path().join("page.html")
    };
    // The player, forces over tightness, their histogram, the hypothesis: no unit malfunctions.
    moves(&page(&["population", "telescopic-drawer", "--units", "24"]), 1, 4);
    // A guide, points before walls and no drive, rings and collars in space.
    for scene in ["slider-crank-guide", "woodpecker-toy", "hatch"] {
        moves(&page(&["simulate", scene, "--set", "run.duration=300"]), 1, 2);
    }
    stdout(&slipfit(folder.path(), &["run", "four-bar", "--n", "-1:1:1", "--units", "24"]));
    moves(&folder.path().join("slipfit-out/four-bar/report.html"), 1, 7);
}
