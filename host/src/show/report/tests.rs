//! The page of a short sweep.

use super::{Clearances, Figure, Flash, ReportInput, report};
use crate::{
    dynamics::{driven::DriveKind, example, sweep::Sweep},
    setup::LevelRange,
    show::figure::{forces, velocities, verdicts},
};

/// The page of a short sweep of a scene with a hostile title.
fn page() -> String {
    let mut scene = example::cd_rom();
    scene.title = "<script>alert(\"slide\")</script> & co".to_owned();
    scene.pins[0].name = "left <back>".to_owned();
    let sweep = example::sweep(LevelRange { first: -1.0, step: 1.75, count: 3 }, 0.1, 0.1);
    let figures = [verdicts, velocities, forces].map(|figure| Figure {
        caption: "caption of <i>a figure</i>".to_owned(),
        svg: figure(&sweep, &scene.title).unwrap(),
    });
    let flash = Some(Flash { bytes: 34_816, worst_force_error: 1.23e-3, worst_velocity_error: 2.1e-5 });
    let notes = ["a < b".to_owned()];
    let page = report(&ReportInput {
        title: &scene.title,
        sweep: &sweep,
        answer: "n = -1 … 2 runs & <b>, 1e-6\n                at - once\nCloses first",
        figures: &figures,
        clearances: Clearances::Pins { scene: &scene, n: 3.43 },
        units: None,
        production: None,
        flash,
        notes: &notes,
    });
    page.into_string()
}

/// The body of a `page` as XML, in which a line break is closed.
fn body(page: &str) -> String {
    let (_, body) = page.split_once("</head>").unwrap();
    body.strip_suffix("</html>").unwrap().replace("<br>", "<br/>")
}

#[test]
fn escapes_stands_alone_and_repeats() {
    let html = page();
    assert_eq!(html, page());
    for absent in ["<script", "<i>a figure", "left <back>", "a < b", "src=", "href=", "url(", "@import", "NaN"] {
        assert!(!html.contains(absent), "{absent}");
    }
    for present in [
        "&lt;script&gt;",
        "left &lt;back&gt;",
        "a &lt; b",
        "&amp; co",
        "n = \u{2212}1 … 2 runs &amp; &lt;b&gt;, 1e-6</span><span class=\"more\">at - once</span><span>Closes first</span></pre>",
    ] {
        assert!(html.contains(present), "{present}");
    }
}

#[test]
fn is_well_formed_and_complete() {
    let html = body(&page());
    let document = roxmltree::Document::parse(&html).unwrap();
    let count = |name| document.descendants().filter(|node| node.tag_name().name() == name).count();
    assert_eq!((count("svg"), count("figure"), count("table"), count("main")), (3, 3, 4, 1));
    let cells: Vec<&str> =
        document.descendants().filter(|node| node.has_tag_name("td")).filter_map(|node| node.text()).collect();
    for expected in ["0.0000", "\u{2212}0.2363", "3.430", "0.0084"] {
        assert!(cells.contains(&expected), "{expected}");
    }
    assert!(html.contains("34816 bytes") && html.contains("0.001230 N in force"));
}

#[test]
fn fits_phones_dark_rooms_and_paper() {
    let html = page();
    for query in ["(max-width: 640px)", "screen and (prefers-color-scheme: dark)", "print"] {
        assert!(html.contains(&format!("@media {query} {{")), "{query}");
    }
    for rule in ["figure { margin: 1.4rem 0; break-inside: avoid; }", "min-width: calc(.75 * var(--width));"] {
        assert!(html.contains(rule), "{rule}");
    }
    // No table may be kept on one sheet: longer ones would leave a blank one before them.
    assert!(!html.split("@media print").nth(1).unwrap().contains("break-inside"));
}

#[test]
fn colours_are_variables() {
    let html = page();
    let style = html.split("<style>").nth(1).and_then(|rest| rest.split("</style>").next()).unwrap();
    for declaration in style.split(['{', '}', ';']).filter(|part| part.contains('#') || part.contains("rgb")) {
        assert!(declaration.trim().starts_with("--"), "{declaration}");
    }
    let document = body(&html);
    let document = roxmltree::Document::parse(&document).unwrap();
    let mut coloured = 0;
    for node in document.descendants() {
        let classes = node.attribute("class").unwrap_or_default();
        for (attribute, short) in [("fill", "f-"), ("stroke", "s-")] {
            if node.attribute(attribute).is_none_or(|value| value == "none") {
                continue;
            }
            let class = classes.split(' ').find(|class| class.starts_with(short)).unwrap();
            assert!(style.contains(&format!(".{class} {{ {attribute}: var(--{}); }}", &class[2..])), "{class}");
            coloured += 1;
        }
    }
    assert!(coloured > 100, "{coloured}");
}

#[test]
fn every_figure_has_a_title_and_a_caption() {
    let html = body(&page());
    let document = roxmltree::Document::parse(&html).unwrap();
    let text = |node: roxmltree::Node<'_, '_>| node.text().unwrap_or_default().trim().len();
    for figure in document.descendants().filter(|node| node.has_tag_name("figure")) {
        let svg = figure.descendants().find(|node| node.tag_name().name() == "svg").unwrap();
        assert_eq!(svg.attribute("role"), Some("img"));
        let title = svg.children().find(|node| node.tag_name().name() == "title").unwrap();
        let caption = figure.children().find(|node| node.has_tag_name("figcaption")).unwrap();
        assert!(text(title) > 0 && text(caption) > 0);
    }
}

#[test]
fn leaves_out_what_there_is_not() {
    let (scene, sweep) = (example::cd_rom(), Sweep { kind: DriveKind::Pushes, gaps: Vec::new(), levels: Vec::new() });
    let (production, flash) = (None, None);
    let input = ReportInput {
        title: &scene.title,
        sweep: &sweep,
        answer: "",
        figures: &[],
        clearances: Clearances::Pins { scene: &scene, n: 0.0 },
        units: None,
        production,
        flash,
        notes: &[],
    };
    let html = report(&input).into_string();
    assert!(!["Figures", "Notes", "Flash table", "NaN", "inf"].iter().any(|absent| html.contains(absent)));
}
