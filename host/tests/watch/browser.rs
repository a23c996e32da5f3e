//! The page as a person uses it, in headless Chromium driven by a script.

use std::{path::Path, process::Command};

use super::{SCENE, Watched, with_friction};

/// Packages from npm that the script needs.
const PACKAGES: [&str; 2] = ["puppeteer-core@24", "axe-core@4"];

#[test]
fn a_person_uses_the_page() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("browser");
    std::fs::create_dir_all(&folder).unwrap();
    if !folder.join("node_modules/axe-core").exists() || !folder.join("node_modules/puppeteer-core").exists() {
        let installed = Command::new("npm")
            .args(["install", "--no-save", "--ignore-scripts", "--prefix"])
            .arg(&folder)
            .args(PACKAGES)
            .output()
            .expect("npm is needed: on Debian, apt-get install npm");
        assert!(installed.status.success(), "{}", String::from_utf8_lossy(&installed.stderr));
    }
    let page = Watched::start(SCENE);
    let script = folder.join("drive.mjs");
    std::fs::write(&script, include_str!("drive.mjs")).unwrap();
    let driven = Command::new("node").arg(&script).args([page.url.as_str(), &page.scene.to_string_lossy()]).output();
    let driven = driven.expect("Node.js is needed: on Debian, apt-get install nodejs");
    let printed = String::from_utf8_lossy(&driven.stdout);
    assert!(driven.status.success(), "{printed}{}", String::from_utf8_lossy(&driven.stderr));
    println!("{printed}");
    // What was written back by the keyboard alone.
    let text = std::fs::read_to_string(&page.scene).unwrap();
    assert!(text != SCENE && text != with_friction(0.1), "nothing was written back");
    assert_eq!(text.lines().count(), SCENE.lines().count() + 1);
}
