//! Self-contained pages: figures and tables, and a player where units are simulated; nothing from outside.
//!
//! The same input gives the same bytes; there is no date on the page.

mod clearances;
mod html;
mod production;

use self::html::{figure, list, marked, optional, real, table, tr, typed};
pub use self::production::Production;
use super::{markup::escape, palette::style_sheet, player};
use crate::{
    dynamics::{
        answer::on_the_way,
        driven::DriveKind,
        outcome::Verdict,
        sweep::{Level, Sweep},
    },
    mechanism::Mechanism,
    scene::Scene,
};

/// What a report is made of.
#[derive(Clone, Copy)]
pub struct ReportInput<'a> {
    /// The scene's title.
    pub title: &'a str,
    /// Its sweep.
    pub sweep: &'a Sweep,
    /// What it comes to, as plain lines; empty for none.
    pub answer: &'a str,
    /// Pictures, in order.
    pub figures: &'a [Figure],
    /// The gaps.
    pub clearances: Clearances<'a>,
    /// What units of the production do, if these were simulated.
    pub units: Option<&'a Units>,
    /// How the product's measures vary, if the scene has a product.
    pub production: Option<&'a Production>,
    /// The flash table, if one was made.
    pub flash: Option<Flash>,
    /// What the reader should know, as plain text.
    pub notes: &'a [String],
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Plain text below it.
    pub caption: String,
    /// An SVG document without XML declaration, as [`super::plot`] makes it; it goes onto the page as it is.
    pub svg: String,
}

/// What units drawn one by one do.
#[derive(Clone, Debug, PartialEq)]
pub struct Units {
    /// Pictures, in order.
    pub figures: Vec<Figure>,
    /// A player, as [`super::player::figure`] makes it.
    pub player: Option<String>,
}

/// Whose gaps are shown.
#[derive(Clone, Copy)]
pub enum Clearances<'a> {
    /// Those of a slide's pins.
    Pins {
        /// The slide.
        scene: &'a Scene,
        /// The tolerance level at which their sums and differences are shown.
        n: f64,
    },
    /// Those of a mechanism's joints.
    Joints(&'a Mechanism),
}

/// Figures of a flash table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flash {
    /// Its size.
    pub bytes: usize,
    /// Worst error of an interpolated force (N).
    pub worst_force_error: f64,
    /// Worst error of an interpolated velocity (m/s).
    pub worst_velocity_error: f64,
}

/// The page as HTML.
pub fn report(input: &ReportInput) -> String {
    let (first, others) = input.figures.split_at(input.figures.len().min(1));
    let sections = [
        verdict(input.answer),
        first.iter().map(|Figure { caption, svg }| figure(caption, svg)).collect(),
        notes(input.notes),
        input.units.map(units).unwrap_or_default(),
        figures(others),
        levels(input.sweep),
        summary(input),
        input.production.map(production::section).unwrap_or_default(),
        clearances::section(&input.clearances, input.production.is_some()),
        input.flash.as_ref().map(|of| flash(input.sweep.kind, of)).unwrap_or_default(),
    ];
    page(input.title, &sections.concat(), input.units)
}

/// A page of a population: what it comes to, as plain lines, then pictures and player.
pub fn units_page(title: &str, answer: &str, of: &Units, remarks: &[String]) -> String {
    page(title, &[verdict(answer), notes(remarks), units(of)].concat(), Some(of))
}

/// A page with these sections, and with what moves the player of `units`.
fn page(title: &str, sections: &str, units: Option<&Units>) -> String {
    let title = escape(title);
    let plays = units.is_some_and(|units| units.player.is_some());
    let (style, script) =
        if plays { (player::STYLE, format!("<script>\n{}</script>\n", player::SCRIPT)) } else { ("", String::new()) };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{title}</title>\n\
         <style>\n{}{}{style}</style>\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n\
         {sections}</main>\n{script}</body>\n</html>\n",
        style_sheet(),
        include_str!("page.css"),
    )
}

fn units(Units { figures, player }: &Units) -> String {
    let figures: String = figures.iter().map(|Figure { caption, svg }| figure(caption, svg)).collect();
    format!("<h2>What units do</h2>\n{}{figures}", player.as_deref().unwrap_or_default())
}

/// The answer, line by line.
fn verdict(answer: &str) -> String {
    if answer.is_empty() {
        return String::new();
    }
    // Line by line: what escapes a text takes control characters out of it.
    let lines: String = answer.lines().map(|line| format!("<span>{}</span>", escape(line))).collect();
    format!("<pre class=\"answer\">{lines}</pre>\n")
}

fn summary(input: &ReportInput) -> String {
    let ReportInput { sweep, .. } = input;
    let mut facts = Vec::new();
    if let (Some(first), Some(last)) = (sweep.levels.first(), sweep.levels.last()) {
        let range = format!("{} levels, n = {} to {}", sweep.levels.len(), typed(first.n), typed(last.n));
        facts.push(("Sweep", range));
        let peaks = || sweep.levels.iter().filter_map(|level| level.outcome.peak_force);
        if let (Some(low), Some(high)) = (peaks().reduce(f64::min), peaks().reduce(f64::max)) {
            let (name, unit) = (sweep.kind.choose("Peak drive force", "Peak drive torque"), sweep.kind.effort_unit());
            facts.push((name, format!("{} to {} {unit}", real(low, 3), real(high, 3))));
        }
        facts.push(("Verdicts", verdicts(sweep)));
    }
    if let Some(level) = sweep.levels.first() {
        facts.push(("Computed by", level.solved.describe() + ", each level held against a run at a tenth of that"));
    }
    facts.extend(clearances::first_to_close(&input.clearances));
    let facts: String = facts.iter().map(|(name, fact)| format!("<dt>{name}</dt><dd>{fact}</dd>\n")).collect();
    format!("<h2>What was done</h2>\n<dl>\n{facts}</dl>\n")
}

fn verdicts(sweep: &Sweep) -> String {
    let count = |verdict| sweep.levels.iter().filter(|level| level.outcome.verdict == verdict).count();
    let counted = [Verdict::Runs, Verdict::Crawls, Verdict::Jammed, Verdict::Undecided].map(|v| (v, count(v)));
    let words = counted.iter().filter(|(_, count)| *count > 0).map(|(v, count)| format!("{count} {}", marked(*v)));
    words.collect::<Vec<_>>().join(", ")
}

fn notes(notes: &[String]) -> String {
    if notes.is_empty() { String::new() } else { format!("<h2>Notes</h2>\n{}", list(notes)) }
}

fn figures(figures: &[Figure]) -> String {
    let figure = |Figure { caption, svg }: &Figure| figure(caption, svg);
    if figures.is_empty() {
        String::new()
    } else {
        format!("<h2>Figures</h2>\n{}", figures.iter().map(figure).collect::<String>())
    }
}

fn levels(sweep: &Sweep) -> String {
    let row = |level: &Level| {
        let Level { n, outcome, .. } = level;
        let [compressed, zero, free] = level.class_counts().map(|count| count.to_string());
        let cells = [
            typed(*n),
            marked(outcome.verdict),
            optional(outcome.breakaway.map(|t| t * 1e3), 1),
            optional(outcome.peak_force, 4),
            optional(outcome.settled_force, 4),
            real(sweep.kind.speed(outcome.final_velocity), 2),
            real(sweep.kind.travel(outcome.end.z), 1),
            compressed,
            zero,
            free,
            on_the_way(sweep.kind, outcome),
        ];
        tr("", &cells)
    };
    let (effort, unit) = (sweep.kind.effort(), sweep.kind.effort_unit());
    let (speed, travel) = (sweep.kind.speed_unit(), sweep.kind.travel_unit());
    let head = format!(
        "<tr><th scope=\"col\" rowspan=\"2\">n</th><th scope=\"col\" rowspan=\"2\">verdict</th>\
        <th scope=\"col\" rowspan=\"2\">breakaway<br/>(ms)</th><th scope=\"col\" rowspan=\"2\">peak {effort}<br/>({unit})</th><th scope=\"col\" rowspan=\"2\">settled {effort}<br/>({unit})</th>\
        <th scope=\"col\" rowspan=\"2\">final velocity<br/>({speed})</th>\
        <th scope=\"col\" rowspan=\"2\">travel<br/>({travel})</th>\
        <th scope=\"colgroup\" colspan=\"3\">gaps</th><th scope=\"col\" rowspan=\"2\">on the way</th></tr>\n\
        <tr class=\"sub\"><th scope=\"col\">compressed</th><th scope=\"col\">zero</th><th scope=\"col\">free</th></tr>\n"
    );
    let caption =
        "n &gt; 0 tightens every gap, n &lt; 0 loosens it. A dash: no breakaway, or a force that has not settled.";
    let table = table(caption, &head, &sweep.levels.iter().map(row).collect::<String>());
    format!("<h2>Levels</h2>\n<details>\n<summary>All {} levels</summary>\n{table}</details>\n", sweep.levels.len())
}

fn flash(kind: DriveKind, flash: &Flash) -> String {
    format!(
        "<h2>Flash table</h2>\n<dl>\n<dt>Size</dt><dd>{} bytes</dd>\n<dt>Worst interpolation error</dt>\
         <dd>{} m{} in {}, {} {} in velocity</dd>\n</dl>\n",
        flash.bytes,
        real(flash.worst_force_error * 1e3, 3),
        kind.effort_unit(),
        kind.effort(),
        real(kind.speed(flash.worst_velocity_error), 4),
        kind.speed_unit()
    )
}

#[cfg(test)]
mod tests {
    use super::{Clearances, Figure, Flash, ReportInput, report};
    use crate::{
        dynamics::{driven::DriveKind, example, sweep::Sweep},
        scene::LevelRange,
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
        report(&ReportInput {
            title: &scene.title,
            sweep: &sweep,
            answer: "n = 1 … 2 runs & <b>\nCloses first",
            figures: &figures,
            clearances: Clearances::Pins { scene: &scene, n: 3.43 },
            units: None,
            production: None,
            flash,
            notes: &notes,
        })
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
            "runs &amp; &lt;b&gt;</span><span>Closes first</span></pre>",
        ] {
            assert!(html.contains(present), "{present}");
        }
    }

    #[test]
    fn is_well_formed_and_complete() {
        let html = page().replace("<!DOCTYPE html>", "");
        let document = roxmltree::Document::parse(&html).unwrap();
        let count = |name| document.descendants().filter(|node| node.tag_name().name() == name).count();
        assert_eq!((count("svg"), count("figure"), count("table"), count("main")), (3, 3, 4, 1));
        let cells: Vec<&str> =
            document.descendants().filter(|node| node.has_tag_name("td")).filter_map(|node| node.text()).collect();
        for expected in ["0.0000", "\u{2212}0.2363", "3.430", "0.0084"] {
            assert!(cells.contains(&expected), "{expected}");
        }
        assert!(html.contains("34816 bytes") && html.contains("1.230 mN"));
    }

    #[test]
    fn fits_phones_dark_rooms_and_paper() {
        let html = page();
        for query in ["(max-width: 640px)", "screen and (prefers-color-scheme: dark)", "print"] {
            assert!(html.contains(&format!("@media {query} {{")), "{query}");
        }
        for rule in
            ["figure { margin: 1.4rem 0; break-inside: avoid; }", "min-width: min(calc(.62 * var(--width)), 350px)"]
        {
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
        let document = html.replace("<!DOCTYPE html>", "");
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
        let html = page().replace("<!DOCTYPE html>", "");
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
        let (scene, sweep) =
            (example::cd_rom(), Sweep { kind: DriveKind::Pushes, gaps: Vec::new(), levels: Vec::new() });
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
        let html = report(&input);
        assert!(!["Figures", "Notes", "Flash table", "NaN", "inf"].iter().any(|absent| html.contains(absent)));
    }
}
