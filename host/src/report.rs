//! One self-contained page: figures and tables of a sweep, without scripts or anything from outside.
//!
//! The same input gives the same bytes; there is no date on the page.

mod production;

use std::fmt::Write;

pub use production::Production;
use slipfit_core::clearance::GapStatistics;

use crate::{
    figure::word,
    markup::escape,
    number::{fixed, level, typeset},
    outcome::Verdict,
    scene::{SURFACES, Scene},
    sweep::{Level, Sweep},
    table2::{Pair, Pin, Table2, Toes, derived},
};

/// What a report is made of.
#[derive(Clone, Copy)]
pub struct ReportInput<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its sweep.
    pub sweep: &'a Sweep,
    /// Pictures, in order.
    pub figures: &'a [Figure],
    /// The tolerance level of Table 2's derived columns; 3.43 in the paper.
    pub n: f64,
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
    /// An SVG document without XML declaration, as [`crate::plot`] makes it; it goes onto the page as it is.
    pub svg: String,
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
    let title = escape(&input.scene.title);
    let table = derived(input.scene, input.n);
    let sections = [
        summary(input, &table),
        notes(input.notes),
        figures(input.figures),
        levels(input.sweep),
        input.production.map(production::section).unwrap_or_default(),
        given(input.scene, input.production.is_some()),
        derived_columns(&table),
        input.flash.as_ref().map(flash).unwrap_or_default(),
    ];
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{title}</title>\n\
         <style>\n{}</style>\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n\
         <p class=\"lead\">Tolerance levels, drive force and clearances of the mechanism</p>\n{}</main>\n</body>\n</html>\n",
        include_str!("report.css"),
        sections.concat(),
    )
}

fn summary(input: &ReportInput, table: &Table2) -> String {
    let ReportInput { scene, sweep, .. } = input;
    let mut facts = Vec::new();
    if let (Some(first), Some(last)) = (sweep.levels.first(), sweep.levels.last()) {
        let range = format!("{} levels, n = {} to {}", sweep.levels.len(), typed(first.n), typed(last.n));
        facts.push(("Sweep", range));
        let peaks = || sweep.levels.iter().filter_map(|level| level.outcome.peak_force);
        if let (Some(low), Some(high)) = (peaks().reduce(f64::min), peaks().reduce(f64::max)) {
            facts.push(("Peak drive force", format!("{} to {} N", real(low, 3), real(high, 3))));
        }
        facts.push(("Verdicts", verdicts(sweep)));
    }
    facts.push((
        "Time",
        format!("{} ms in steps of {} µs", plain(scene.run.duration * 1e3), plain(scene.run.step * 1e6)),
    ));
    facts.push(("Integrator", scene.run.integrator.name().to_owned()));
    if let Some(tightest) = table.tightest() {
        let (n, pin) = (real(tightest.n, 4), escape(tightest.pin));
        facts.push(("First pair to close", format!("{pin}, {}, at n* = {n}", tightest.direction)));
    }
    let facts: String = facts.iter().map(|(name, fact)| format!("<dt>{name}</dt><dd>{fact}</dd>\n")).collect();
    format!("<dl>\n{facts}</dl>\n")
}

fn verdicts(sweep: &Sweep) -> String {
    let count = |verdict| sweep.levels.iter().filter(|level| level.outcome.verdict == verdict).count();
    let counted = [Verdict::Runs, Verdict::Crawls, Verdict::Jammed, Verdict::Undecided].map(|v| (v, count(v)));
    let words = counted.iter().filter(|(_, count)| *count > 0).map(|(v, count)| format!("{count} {}", marked(*v)));
    words.collect::<Vec<_>>().join(", ")
}

fn notes(notes: &[String]) -> String {
    if notes.is_empty() {
        return String::new();
    }
    let items: String = notes.iter().map(|note| format!("<li>{}</li>\n", escape(note))).collect();
    format!("<h2>Notes</h2>\n<ul class=\"notes\">\n{items}</ul>\n")
}

fn figures(figures: &[Figure]) -> String {
    let figure = |Figure { caption, svg }: &Figure| figure(caption, svg);
    if figures.is_empty() {
        String::new()
    } else {
        format!("<h2>Figures</h2>\n{}", figures.iter().map(figure).collect::<String>())
    }
}

fn figure(caption: &str, svg: &str) -> String {
    format!("<figure>\n{svg}<figcaption>{}</figcaption>\n</figure>\n", escape(caption))
}

fn levels(sweep: &Sweep) -> String {
    let row = |level: &Level| {
        let Level { n, outcome, .. } = level;
        let [compressed, zero, free] = level.class_counts().map(|count| count.to_string());
        let cells = [
            typed(*n),
            optional(outcome.breakaway.map(|t| t * 1e3), 1),
            optional(outcome.peak_force, 4),
            optional(outcome.settled_force, 4),
            real(outcome.final_velocity * 1e3, 2),
            marked(outcome.verdict),
            compressed,
            zero,
            free,
        ];
        tr("", &cells)
    };
    let head = "<tr><th scope=\"col\" rowspan=\"2\">n</th><th scope=\"col\" rowspan=\"2\">breakaway<br/>(ms)</th>\
        <th scope=\"col\" rowspan=\"2\">peak force<br/>(N)</th><th scope=\"col\" rowspan=\"2\">settled force<br/>(N)</th>\
        <th scope=\"col\" rowspan=\"2\">final velocity<br/>(mm/s)</th><th scope=\"col\" rowspan=\"2\">verdict</th>\
        <th scope=\"colgroup\" colspan=\"3\">gaps</th></tr>\n\
        <tr class=\"sub\"><th scope=\"col\">compressed</th><th scope=\"col\">zero</th><th scope=\"col\">free</th></tr>\n";
    let caption =
        "n &gt; 0 tightens every gap, n &lt; 0 loosens it. A dash: no breakaway, or a force that has not settled.";
    format!("<h2>Levels</h2>\n{}", table(caption, head, &sweep.levels.iter().map(row).collect::<String>()))
}

fn given(scene: &Scene, computed: bool) -> String {
    let mut head = "<tr><th scope=\"col\" rowspan=\"2\">pin</th>".to_owned();
    head.extend(SURFACES.map(|surface| format!("<th scope=\"colgroup\" colspan=\"2\">{surface}</th>")));
    head.push_str("</tr>\n<tr class=\"sub\">");
    head.push_str(&"<th scope=\"col\">mean</th><th scope=\"col\">sd</th>".repeat(SURFACES.len()));
    head.push_str("</tr>\n");
    let cells = |gap: &Option<GapStatistics<f64>>| [gap.map(|gap| gap.mean), gap.map(|gap| gap.deviation)].map(mm);
    let rows: String = scene
        .pins
        .iter()
        .map(|pin| tr(&escape(&pin.name), &pin.gaps.iter().flat_map(cells).collect::<Vec<_>>()))
        .collect();
    let source =
        if computed { ": moments of second order of the product's measures, which the dynamics use" } else { "" };
    let caption = format!("The gaps of every pin over the production (mm){source}.");
    format!("<h2>Clearances</h2>\n{}", table(&caption, &head, &rows))
}

fn derived_columns(derived: &Table2) -> String {
    let n = typed(derived.n);
    let pair = "<th scope=\"col\">clearance</th><th scope=\"col\">mean</th><th scope=\"col\">n*</th>";
    let head = format!(
        "<tr><th scope=\"col\" rowspan=\"2\">pin</th><th scope=\"colgroup\" colspan=\"4\">gap</th>\
         <th scope=\"colgroup\" colspan=\"3\">across</th><th scope=\"colgroup\" colspan=\"3\">up-down</th></tr>\n\
         <tr class=\"sub\">{}{pair}{pair}</tr>\n",
        SURFACES.map(|surface| format!("<th scope=\"col\">{surface}</th>")).concat()
    );
    let pair = |pair: Option<Pair>| {
        let closes_at = optional(pair.and_then(|pair| pair.closes_at), 3);
        [mm(pair.map(|pair| pair.clearance)), mm(pair.map(|pair| pair.mean)), closes_at]
    };
    let row =
        |pin: &Pin| tr(&escape(&pin.name), &[&pin.gaps.map(mm)[..], &pair(pin.across), &pair(pin.up_down)].concat());
    let first = derived.tightest().map_or_else(String::new, |tightest| {
        let (n, pin) = (real(tightest.n, 4), escape(tightest.pin));
        format!(" The product's is the least, {n}: {pin}, {}.", tightest.direction)
    });
    let caption = format!(
        "At n = {n} (mm): clearance is the sum of a pair's gaps, mean half their difference; n* is the level that closes \
         the pair.{first}"
    );
    let toes = toe_outs(&n, [("across", derived.toes_across), ("up-down", derived.toes_up_down)]);
    table(&caption, &head, &derived.pins.iter().map(row).collect::<String>()) + &toes
}

fn toe_outs(n: &str, directions: [(&str, Option<Toes>); 2]) -> String {
    let head = "<tr><th scope=\"col\" rowspan=\"2\">toe-out</th><th scope=\"colgroup\" colspan=\"3\">right − left</th>\
        <th scope=\"colgroup\" colspan=\"3\">front − back</th></tr>\n\
        <tr class=\"sub\"><th scope=\"col\">back</th><th scope=\"col\">front</th><th scope=\"col\">front − back</th>\
        <th scope=\"col\">left</th><th scope=\"col\">right</th><th scope=\"col\">right − left</th></tr>\n";
    let row = |(name, toes): (&str, Option<Toes>)| {
        let Toes { back, front, left, right, front_minus_back, right_minus_left } = toes?;
        Some(tr(name, &[back, front, front_minus_back, left, right, right_minus_left].map(|toe| mm(Some(toe)))))
    };
    let rows: String = directions.into_iter().filter_map(row).collect();
    let caption = format!("Toe-outs at n = {n} (mm): differences of the means, subtracted before rounding.");
    if rows.is_empty() { rows } else { table(&caption, head, &rows) }
}

fn flash(flash: &Flash) -> String {
    format!(
        "<h2>Flash table</h2>\n<dl>\n<dt>Size</dt><dd>{} bytes</dd>\n<dt>Worst interpolation error</dt>\
         <dd>{} mN in force, {} mm/s in velocity</dd>\n</dl>\n",
        flash.bytes,
        real(flash.worst_force_error * 1e3, 3),
        real(flash.worst_velocity_error * 1e3, 4)
    )
}

/// A table with a caption; `head` and `body` are rows.
fn table(caption: &str, head: &str, body: &str) -> String {
    format!(
        "<div class=\"scroll\"><table>\n<caption>{caption}</caption>\n<thead>\n{head}</thead>\n<tbody>\n{body}</tbody>\n</table></div>\n"
    )
}

/// A row with `name` as its heading, or with its first cell if there is no name.
fn tr(name: &str, cells: &[String]) -> String {
    let (name, cells) = match cells {
        [first, rest @ ..] if name.is_empty() => (first.as_str(), rest),
        _ => (name, cells),
    };
    let mut row = format!("<tr><th scope=\"row\">{name}</th>");
    for cell in cells {
        let _ = write!(row, "<td>{cell}</td>");
    }
    row + "</tr>\n"
}

fn marked(verdict: Verdict) -> String {
    let word = word(verdict);
    format!("<span class=\"{word}\">{word}</span>")
}

fn typed(n: f64) -> String {
    typeset(&level(n))
}

fn real(value: f64, decimals: usize) -> String {
    typeset(&fixed(value, decimals))
}

fn optional(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| real(value, decimals))
}

fn mm(length: Option<f64>) -> String {
    optional(length.map(|length| length * 1e3), 4)
}

/// Without trailing zeros.
fn plain(value: f64) -> String {
    let digits = fixed(value, 3);
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::{Figure, Flash, ReportInput, report};
    use crate::{
        example,
        figure::{figure_8, figure_9, required_force},
        scene::LevelRange,
        sweep::Sweep,
    };

    /// The page of a short sweep of a scene with a hostile title.
    fn page() -> String {
        let mut scene = example::cd_rom();
        scene.title = "<script>alert(\"slide\")</script> & co".to_owned();
        scene.pins[0].name = "left <back>".to_owned();
        let sweep = example::sweep(LevelRange { first: -1.0, step: 1.75, count: 3 }, 0.1, 0.1);
        let figures = [figure_8, figure_9, required_force].map(|figure| Figure {
            caption: "caption of <i>a figure</i>".to_owned(),
            svg: figure(&sweep, &scene.title).unwrap(),
        });
        let flash = Some(Flash { bytes: 34_816, worst_force_error: 1.23e-3, worst_velocity_error: 2.1e-5 });
        let notes = ["a < b".to_owned()];
        report(&ReportInput {
            scene: &scene,
            sweep: &sweep,
            figures: &figures,
            n: 3.43,
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
        for present in ["&lt;script&gt;", "left &lt;back&gt;", "a &lt; b", "&amp; co"] {
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
    fn leaves_out_what_there_is_not() {
        let (scene, sweep) = (example::cd_rom(), Sweep { levels: Vec::new() });
        let (production, flash) = (None, None);
        let html =
            report(&ReportInput { scene: &scene, sweep: &sweep, figures: &[], n: 0.0, production, flash, notes: &[] });
        assert!(!["Figures", "Notes", "Flash table", "NaN", "inf"].iter().any(|absent| html.contains(absent)));
    }
}
