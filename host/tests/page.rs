//! Pages in a browser: no error on the console, every figure there, and a player that moves.

mod common;

use std::{path::Path, process::Command};

use common::{slipfit, stdout};

/// What watches for errors from the first line of the page on.
const WATCH: &str = "<script>window.wrong = []; addEventListener('error', event => window.wrong.push(event.message)); \
    console.error = (...words) => window.wrong.push(words.join(' ')); console.warn = console.error;</script>";

/// What tries the player and writes what it saw into the page: how many frames look different, whether the curves' marker and
/// the choice of a run change the picture, what went wrong, whether anything is wider than the page.
const TRY: &str = "<script>addEventListener('load', () => {
const figure = document.querySelector('figure.player');
const seen = () => [...figure.querySelectorAll('svg')].map(svg => svg.outerHTML).join();
const pictures = new Set();
for (let frame = 0; frame < 60; frame += 5) { figure.player.show(frame); pictures.add(seen()); }
figure.player.choose(0); figure.player.show(30); const first = seen();
figure.player.choose(1); figure.player.show(30);
const result = {
  pictures: pictures.size, frame: figure.dataset.frame, run: figure.dataset.run, runs: first !== seen(),
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

#[test]
fn the_page_of_a_population_moves_without_an_error() {
    let folder = tempfile::tempdir().unwrap();
    stdout(&slipfit(folder.path(), &["population", "cd-rom-slide-drawing", "--units", "64", "--page", "units.html"]));
    let page = std::fs::read_to_string(folder.path().join("units.html")).unwrap();
    let outside = page.split("src=\"").skip(1).chain(page.split("href=\"").skip(1)).next();
    assert!(outside.is_none_or(|link| link.starts_with('#')), "{outside:?}");
    let page = page.replacen("<head>", &format!("<head>{WATCH}"), 1).replacen("</body>", &format!("{TRY}</body>"), 1);
    let path = folder.path().join("tried.html");
    std::fs::write(&path, page).unwrap();
    for width in [1400, 500] {
        let found = result(&opened(&path, width));
        assert_eq!(found["wrong"], "", "{found}");
        assert_eq!(found["figures"], 6, "{found}");
        assert!(found["drawn"].as_u64() >= Some(6) && found["pictures"].as_u64() >= Some(10), "{found}");
        assert!(found["runs"] == true && found["run"] == "1" && found["frame"] == "30", "{found}");
        assert!(found["wide"] == true, "wider than a window of {width}: {found}");
    }
}
