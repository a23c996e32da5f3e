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

/// The histogram of measure `i` with the normal of the same moments and its limits.
///
/// # Errors
/// [`PlotError`], if a number is not finite.
pub fn histogram_svg(report: &Report, study: &Study, tallies: &[Tally], i: usize) -> Result<String, PlotError> {
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
    let normal = (-160..=160).map(|k| {
        let z = f64::from(k) / 40.0;
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
    let ppk = measure.ppk.map(|ppk| format!(", Ppk {}", fixed(ppk, 3))).unwrap_or_default();
    line_chart(&Chart {
        title: report.title.clone(),
        subtitle: format!(
            "{}: mean {}, σ {}{ppk}; {} units; grey: limits",
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
pub fn contributors_svg(report: &Report) -> String {
    const MOST: usize = 8;
    let shown = |m: &MeasureReport| -> Vec<(String, f64)> {
        let shares = m.contributors.iter().filter(|share| share.percent.abs() >= 0.05).take(MOST);
        shares.map(|share| (share.name.clone(), share.percent)).collect()
    };
    let blocks: Vec<_> = report.measures.iter().map(|m| (m, shown(m))).filter(|(_, s)| !s.is_empty()).collect();
    let height = HEAD + blocks.iter().map(|(_, shares)| ROW * (shares.len() as f64 + 1.5)).sum::<f64>();
    let mut svg = document(900.0, height, &report.title, "contributors, % of the variance of first order");
    let mut y = HEAD;
    for (measure, shares) in blocks {
        text(&mut svg, [16.0, y + 14.0], "start", "font-weight=\"bold\"", &measure.name);
        y += ROW;
        for (name, percent) in shares {
            text(&mut svg, [300.0, y + 14.0], "end", "", &name);
            let (from, width) = (percent.min(0.0), percent.abs());
            let colour = if percent < 0.0 { VERMILION } else { BLUE };
            rectangle(&mut svg, [310.0 + 5.2 * from.max(-8.0), y + 3.0, (5.2 * width).max(0.5), ROW - 6.0], colour);
            let end = 310.0 + 5.2 * percent.max(0.0) + 6.0;
            text(&mut svg, [end, y + 14.0], "start", "", &format!("{} %", typeset(&fixed(percent, 1))));
            y += ROW;
        }
        y += ROW / 2.0;
    }
    svg + "</svg>\n"
}

/// The correlation matrix of the measures as coloured cells with numbers.
pub fn correlation_svg(report: &Report) -> String {
    const CELL: f64 = 42.0;
    const NAMES: f64 = 170.0;
    let count = report.measures.len() as f64;
    let (width, height) = ((NAMES + CELL * count + 24.0).max(420.0), HEAD + NAMES + CELL * count + 16.0);
    let mut svg = document(width, height, &report.title, "correlation of the measures: blue negative, orange positive");
    for (i, measure) in report.measures.iter().enumerate() {
        let place = (i as f64 + 0.5) * CELL;
        text(&mut svg, [NAMES - 6.0, HEAD + NAMES + place + 4.0], "end", "", &measure.name);
        let (x, y) = (NAMES + place + 4.0, HEAD + NAMES - 6.0);
        let turn = format!("transform=\"rotate(-60 {x:.1} {y:.1})\"");
        text(&mut svg, [x, y], "start", &turn, &measure.name);
        for (j, rho) in report.correlation[i].iter().enumerate() {
            let (x, y) = (NAMES + j as f64 * CELL, HEAD + NAMES + i as f64 * CELL);
            let strength = rho.abs().min(1.0);
            let full = if *rho < 0.0 { BLUE } else { VERMILION };
            rectangle(&mut svg, [x, y, CELL - 1.0, CELL - 1.0], full.map(|c| 255.0 + (c - 255.0) * strength));
            let ink = if strength > 0.6 { "fill=\"#fff\"" } else { "" };
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
