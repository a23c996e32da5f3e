//! Pictures of an analysis: histograms, contributors, correlations. Blue and vermilion (Okabe and Ito) can be told apart by
//! every eye, and every cell has its number, so that a grey print can be read, too.

use super::{MeasureReport, Report, Share};
use crate::{
    show::{
        bars::{Bar, Block, HEAD, NAME, bars, document, longest},
        chart::{Chart, Look, Panel, Series, outline},
        number::{fixed, typeset},
        palette::{INK, NEGATIVE, ON_NEGATIVE, ON_POSITIVE, POSITIVE},
        plot::{PlotError, small_chart},
        svg::{Anchor, Font, PLAIN},
    },
    tolerance::{
        counting::study::{Study, Tally},
        statistics::estimate::histogram,
    },
};

/// The share of a colour from which on text on it is not in the paper's ink.
const FULL: f64 = 0.6;
/// Bins of a tally in a class of the histogram for each step of the number of units: about as many classes as its cube
/// root.
const CLASSES: [(u64, usize); 4] = [(1_000, 64), (20_000, 32), (500_000, 16), (u64::MAX, 8)];

/// A picture of an analysis.
pub struct Picture {
    /// Name of its file.
    pub file: String,
    /// Plain text below it.
    pub caption: String,
    /// An SVG document without XML declaration.
    pub svg: String,
}

const CONTRIBUTORS: &str = "contributors.svg";
const CORRELATION: &str = "correlation.svg";

fn histogram_file(i: usize) -> String {
    format!("histogram-{}.svg", i + 1)
}

/// Names of the files of all pictures of `measures` measures.
pub fn file_names(measures: usize) -> impl Iterator<Item = String> {
    [CONTRIBUTORS, CORRELATION].map(str::to_owned).into_iter().chain((0..measures).map(histogram_file))
}

/// All pictures: contributors, correlations, and a histogram for every measure.
///
/// # Errors
/// [`PlotError`], if a number is not finite.
pub fn pictures(report: &Report, study: &Study, tallies: &[Tally]) -> Result<Vec<Picture>, PlotError> {
    let picture = |file: &str, caption: &str, svg| Picture { file: file.into(), caption: caption.into(), svg };
    let histogram = |(i, measure): (usize, &MeasureReport)| {
        Ok(picture(
            &histogram_file(i),
            &format!("{} over the production.", measure.name),
            histogram_svg(report, study, tallies, i)?,
        ))
    };
    let all = [
        picture(CONTRIBUTORS, "What the measures' variances come from.", contributors_svg(report)),
        picture(CORRELATION, "Which measures vary together.", correlation_svg(report)),
    ];
    all.into_iter().map(Ok).chain(report.measures.iter().enumerate().map(histogram)).collect()
}

/// The histogram of measure `i` with the normal of the same moments and its limits.
///
/// # Errors
/// [`PlotError`], if a number is not finite.
fn histogram_svg(report: &Report, study: &Study, tallies: &[Tally], i: usize) -> Result<String, PlotError> {
    let (measure, factor) = (&report.measures[i], study.model.measures[i].quantity.factor());
    let width = CLASSES.iter().find(|(units, _)| report.samples <= *units).map_or(8, |(_, width)| *width);
    let classes = histogram(study.frames(), tallies, i, width);
    let frame = study.frames()[i];
    let step = factor * frame.scale * width as f64 / crate::tolerance::counting::tally::BINS_PER_DEVIATION;
    let classes = classes.iter().map(|(middle, share)| (middle * factor - step / 2.0, share / step));
    let outline = outline(classes, step);
    let top = outline.iter().map(|(_, density)| *density).fold(0.0, f64::max);
    // As far as the limits, so that these stand within the picture.
    let ends = measure.limits.into_iter().flatten().map(|limit| (limit - measure.mean) / measure.sd);
    let [low, high] = ends.fold([-4.0, 4.0], |[low, high]: [f64; 2], z| [low.min(z - 0.25), high.max(z + 0.25)]);
    let normal = (0..=320).map(|k| {
        let z = low + (high - low) * f64::from(k) / 320.0;
        (measure.mean + z * measure.sd, crate::tolerance::distribution::normal::density(z) / measure.sd)
    });
    let line = |label: &str, look, points| Series { label: label.into(), look, points };
    let mut series = vec![line("units", Look::Level(0.0), outline)];
    if measure.sd > 0.0 {
        series.push(line("normal", Look::Level(1.0), normal.collect()));
    }
    for limit in measure.limits.into_iter().flatten() {
        series.push(line("", Look::Guide, vec![(limit, 0.0), (limit, 1.05 * top)]));
    }
    let unit = if measure.unit.is_empty() { String::new() } else { format!(" ({})", measure.unit) };
    let limits = if measure.limits == [None; 2] { "" } else { "; grey: limits" };
    let ppk = measure.ppk.map(|ppk| format!(", Ppk {}", fixed(ppk, 3))).unwrap_or_default();
    small_chart(&Chart {
        title: report.title.clone(),
        subtitle: format!(
            "{}: mean {}, σ {}{ppk}; {} units{limits}",
            measure.name,
            typeset(&fixed(measure.mean, 4)),
            fixed(measure.sd, 4),
            report.samples
        ),
        x_label: format!("{}{unit}", measure.name),
        panels: vec![Panel { y_label: "density".into(), series, ..Panel::default() }],
        ..Chart::default()
    })
}

/// Shares of the contributors in the variance of every measure that varies, largest first.
fn contributors_svg(report: &Report) -> String {
    const MOST: usize = 8;
    let bar = |share: &Share| Some(Bar { name: share.name.clone(), percent: share.percent?, error: None });
    let shown = |m: &MeasureReport| Block {
        heading: m.name.clone(),
        bars: m.contributors.iter().filter_map(bar).filter(|bar| bar.percent.abs() >= 0.05).take(MOST).collect(),
    };
    let blocks: Vec<Block> = report.measures.iter().map(shown).filter(|block| !block.bars.is_empty()).collect();
    bars(&report.title, "contributors, % of the variance", &blocks)
}

/// The correlation matrix of the measures as coloured cells with numbers.
fn correlation_svg(report: &Report) -> String {
    const CELL: f64 = 42.0;
    // Names stand up at 60°: the last one leans out to the right.
    const LEAN: [f64; 2] = [0.5, 0.866];
    let names = longest(report.measures.iter().map(|measure| measure.name.as_str()));
    let (left, top) = (names + 22.0, HEAD + LEAN[1] * names + 16.0);
    let across = CELL * report.measures.len() as f64;
    let (width, height) = ((left + across + LEAN[0] * names + 8.0).max(460.0), top + across + 16.0);
    let heading = "correlation of the measures: blue negative, orange positive";
    let mut svg = document([width, height], &report.title, heading);
    let name = Font { most: NAME, ..PLAIN };
    for (i, measure) in report.measures.iter().enumerate() {
        let place = (i as f64 + 0.5) * CELL;
        svg.text([left - 6.0, top + place], &measure.name, Font { anchor: Anchor::End, ..name });
        svg.text([left + place + 4.0, top - 6.0], &measure.name, Font { turned: -60.0, ..name });
        for (j, rho) in report.correlation[i].iter().enumerate() {
            let (x, y) = (left + j as f64 * CELL, top + i as f64 * CELL);
            let strength = rho.abs().min(1.0);
            let (full, on_full) = if *rho < 0.0 { (NEGATIVE, ON_NEGATIVE) } else { (POSITIVE, ON_POSITIVE) };
            svg.rectangle([x, y, CELL - 1.0, CELL - 1.0], full, strength);
            let colour = if strength < FULL { INK } else { on_full };
            let number = typeset(&fixed(*rho, 2));
            svg.text([x + CELL / 2.0, y + CELL / 2.0], &number, Font { colour, anchor: Anchor::Middle, ..PLAIN });
        }
    }
    svg.finish()
}

#[cfg(test)]
mod tests {
    use super::{contributors_svg, correlation_svg, histogram_svg};
    use crate::tolerance::{
        analysis::conclude,
        counting::study::{Settings, Study},
        examples::left_front,
        report::report,
        sampling::sampler::Method,
    };

    #[test]
    fn pictures_are_well_formed() {
        let mut model = left_front(-0.4);
        model.measures[0].limits = [Some(-1e-4), Some(2e-4)];
        let settings = Settings { method: Method::PseudoRandom, samples: 5000, replicates: 1, seed: 2 };
        let study = Study::new(&model, settings).unwrap();
        let mut tallies = study.empty();
        study.add(0..settings.blocks(), &mut tallies, |_| ());
        let report = report("<slide>", &model, &conclude(&study, &tallies).unwrap());
        let histogram = histogram_svg(&report, &study, &tallies, 0).unwrap();
        for (name, svg) in [
            ("histogram", histogram),
            ("contributors", contributors_svg(&report)),
            ("correlation", correlation_svg(&report)),
        ] {
            let document = roxmltree::Document::parse(&svg).unwrap();
            assert!(document.descendants().filter(|node| node.has_tag_name("text")).count() > 3, "{name}");
            assert!(!svg.contains("NaN") && svg.contains("&lt;slide&gt;"), "{name}");
            if let Some(folder) = std::env::var_os("SLIPFIT_PICTURES") {
                std::fs::write(std::path::Path::new(&folder).join(format!("{name}.svg")), &svg).unwrap();
            }
        }
    }

    #[test]
    fn long_names_widen_no_picture() {
        let name = "the very long name of a measure ".repeat(8);
        let mut model = left_front(-0.4);
        model.measures[0].name.clone_from(&name);
        let settings = Settings { method: Method::PseudoRandom, samples: 1000, replicates: 1, seed: 2 };
        let study = Study::new(&model, settings).unwrap();
        let mut tallies = study.empty();
        study.add(0..settings.blocks(), &mut tallies, |_| ());
        let conclusion = conclude(&study, &tallies).unwrap();
        let width = |svg: &str| {
            let document = roxmltree::Document::parse(svg).unwrap();
            document.root_element().attribute("width").unwrap().parse::<f64>().unwrap()
        };
        let report = report("a part", &model, &conclusion);
        for svg in [contributors_svg(&report), correlation_svg(&report)] {
            assert!(width(&svg) <= 900.0, "{}", width(&svg));
            assert!(svg.contains(&format!("<title>{name}</title>")));
        }
        let histogram = histogram_svg(&report, &study, &tallies, 0).unwrap();
        assert!(width(&histogram) < 500.0 && histogram.contains(&format!("<title>{name}")));
    }
}
