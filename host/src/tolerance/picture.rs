//! Pictures of an analysis: histograms, contributors, correlations. Blue and vermilion (Okabe and Ito) can be told apart by
//! every eye, and every cell has its number, so that a grey print can be read, too.

use std::fmt::Write;

use super::{
    estimate::histogram,
    report::{MeasureReport, Report},
    study::{Study, Tally},
};
use crate::{
    chart::{Chart, Look, Panel, Series},
    markup::escape,
    number::{fixed, typeset},
    plot::{PlotError, line_chart},
};

const HEAD: f64 = 66.0;
const ROW: f64 = 20.0;
const BLUE: [f64; 3] = [0.0, 114.0, 178.0];
const VERMILION: [f64; 3] = [213.0, 94.0, 0.0];
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
    let step = factor * frame.scale * width as f64 / super::tally::BINS_PER_DEVIATION;
    let mut outline = Vec::new();
    for (middle, share) in &classes {
        let (middle, density) = (middle * factor, share / step);
        let left = middle - step / 2.0;
        if outline.is_empty() {
            outline.push((left, 0.0));
        }
        outline.extend([(left, density), (left + step, density)]);
    }
    if let Some((right, _)) = outline.last().copied() {
        outline.push((right, 0.0));
    }
    let top = outline.iter().map(|(_, density)| *density).fold(0.0, f64::max);
    // As far as the limits, so that these stand within the picture.
    let ends = measure.limits.into_iter().flatten().map(|limit| (limit - measure.mean) / measure.sd);
    let [low, high] = ends.fold([-4.0, 4.0], |[low, high]: [f64; 2], z| [low.min(z - 0.25), high.max(z + 0.25)]);
    let normal = (0..=320).map(|k| {
        let z = low + (high - low) * f64::from(k) / 320.0;
        (measure.mean + z * measure.sd, super::normal::density(z) / measure.sd)
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
    line_chart(&Chart {
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
    let shown = |m: &MeasureReport| -> Vec<(String, f64)> {
        let shares = m.contributors.iter().filter_map(|share| Some((share.name.clone(), share.percent?)));
        shares.filter(|(_, percent)| percent.abs() >= 0.05).take(MOST).collect()
    };
    let blocks: Vec<_> = report.measures.iter().map(|m| (m, shown(m))).filter(|(_, s)| !s.is_empty()).collect();
    let height = HEAD + blocks.iter().map(|(_, shares)| ROW * (shares.len() as f64 + 1.5)).sum::<f64>();
    let names = blocks.iter().flat_map(|(_, shares)| shares).map(|(name, _)| name.as_str());
    let left = longest(names).max(200.0) + 32.0;
    // Correlated contributors can have less than nothing, and others then more than all.
    let percents = || blocks.iter().flat_map(|(_, shares)| shares).map(|(_, percent)| *percent);
    let (low, high) = (percents().fold(0.0, f64::min), percents().fold(100.0, f64::max));
    let scale = 520.0 / (high - low);
    let zero = left - scale * low;
    let mut svg = document(left + 600.0, height, &report.title, "contributors, % of the variance");
    let mut y = HEAD;
    for (measure, shares) in blocks {
        text(&mut svg, [16.0, y + 14.0], "start", "font-weight=\"bold\"", &measure.name);
        y += ROW;
        for (name, percent) in shares {
            text(&mut svg, [left - 10.0, y + 14.0], "end", "", &name);
            let colour = if percent < 0.0 { VERMILION } else { BLUE };
            rectangle(
                &mut svg,
                [zero + scale * percent.min(0.0), y + 3.0, (scale * percent.abs()).max(0.5), ROW - 6.0],
                colour,
            );
            let end = zero + scale * percent.max(0.0) + 6.0;
            text(&mut svg, [end, y + 14.0], "start", "", &format!("{} %", typeset(&fixed(percent, 1))));
            y += ROW;
        }
        y += ROW / 2.0;
    }
    svg + "</svg>\n"
}

/// The correlation matrix of the measures as coloured cells with numbers.
fn correlation_svg(report: &Report) -> String {
    const CELL: f64 = 42.0;
    // Names stand up at 60°: the last one leans out to the right.
    const LEAN: [f64; 2] = [0.5, 0.866];
    let names = longest(report.measures.iter().map(|measure| measure.name.as_str()));
    let (left, top) = (names + 22.0, HEAD + LEAN[1] * names + 16.0);
    let across = CELL * report.measures.len() as f64;
    let (width, height) = ((left + across + LEAN[0] * names + 8.0).max(420.0), top + across + 16.0);
    let mut svg = document(width, height, &report.title, "correlation of the measures: blue negative, orange positive");
    for (i, measure) in report.measures.iter().enumerate() {
        let place = (i as f64 + 0.5) * CELL;
        text(&mut svg, [left - 6.0, top + place + 4.0], "end", "", &measure.name);
        let (x, y) = (left + place + 4.0, top - 6.0);
        let turn = format!("transform=\"rotate(-60 {x:.1} {y:.1})\"");
        text(&mut svg, [x, y], "start", &turn, &measure.name);
        for (j, rho) in report.correlation[i].iter().enumerate() {
            let (x, y) = (left + j as f64 * CELL, top + i as f64 * CELL);
            let strength = rho.abs().min(1.0);
            let full = if *rho < 0.0 { BLUE } else { VERMILION };
            rectangle(&mut svg, [x, y, CELL - 1.0, CELL - 1.0], full.map(|c| 255.0 + (c - 255.0) * strength));
            // White reads better than black on nothing but the full blue.
            let ink = if *rho < -0.85 { "fill=\"#fff\"" } else { "" };
            let number = typeset(&fixed(*rho, 2));
            text(&mut svg, [x + CELL / 2.0, y + CELL / 2.0 + 4.0], "middle", ink, &number);
        }
    }
    svg + "</svg>\n"
}

fn document(width: f64, height: f64, title: &str, subtitle: &str) -> String {
    let title = escape(title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"system-ui, 'Segoe UI', Arial, 'Liberation Sans', sans-serif\" \
         font-size=\"12\" fill=\"#222\">\n<title>{title}: {subtitle}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n\
         <text x=\"16\" y=\"26\" font-size=\"18\" font-weight=\"bold\">{title}</text>\n\
         <text x=\"16\" y=\"48\" font-size=\"13\" fill=\"#606060\">{subtitle}</text>\n"
    )
}

/// About how wide the longest of some words is.
fn longest<'a>(words: impl Iterator<Item = &'a str>) -> f64 {
    words.map(|word| 6.8 * word.chars().count() as f64).fold(0.0, f64::max)
}

fn rectangle(svg: &mut String, [x, y, width, height]: [f64; 4], colour: [f64; 3]) {
    let [r, g, b] = colour.map(|c| c.round() as u8);
    let _ = writeln!(
        svg,
        "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"#{r:02x}{g:02x}{b:02x}\"/>"
    );
}

fn text(svg: &mut String, [x, y]: [f64; 2], anchor: &str, extra: &str, words: &str) {
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" {extra}>{}</text>", escape(words));
}

#[cfg(test)]
mod tests {
    use super::{contributors_svg, correlation_svg, histogram_svg};
    use crate::tolerance::{
        analysis::conclude,
        examples::left_front,
        report::report,
        sampler::Method,
        study::{Settings, Study},
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
}
