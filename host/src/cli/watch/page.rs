//! The page, whose sections are filled as results arrive.

use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::show::report::head;

/// The page of the file `scene`.
pub fn page(scene: &Path) -> Markup {
    let name = scene.file_name().unwrap_or(scene.as_os_str()).to_string_lossy();
    let more = html! {
        link rel="icon" href="data:,";
        style { (PreEscaped(include_str!("watch.css"))) }
    };
    html! {
        (DOCTYPE)
        html lang="en" {
            (head(&name, true, &more))
            body {
                main {
                    h1 { (name) }
                    p #status role="status" { "connecting …" }
                    pre #error role="alert" tabindex="0" hidden {}
                    form #sliders aria-label="Values" {
                        div #rows {}
                        p {
                            label for="choice" { "Slider for " }
                            select #choice { option value="" { "choose a key" } }
                            " "
                            button #add type="button" { "add" }
                        }
                        p #note role="status" {}
                    }
                    section #unit aria-label="One unit" {}
                    @for (id, heading) in [
                        ("check", "Check"), ("tolerance", "Measures and tolerances"), ("population", "Production"),
                    ] {
                        details id=(id) open { summary { h2 { (heading) } } div {} }
                    }
                }
                script src="player.js" {}
                script src="watch.js" {}
            }
        }
    }
}
