//! Pictures of an analysis: histograms, contributors, correlations. Blue and vermilion (Okabe and Ito) can be told apart by
//! every eye, and every cell has its number, so that a grey print can be read, too.

use slipfit_tolerance::report::{MeasureReport, Report, Share};
use slipfit_tolerance::{
    counting::study::{Study, Tally},
    number::{fixed, typeset},
    statistics::estimate::histogram,
};

use super::{
    bars::{Bar, Block, HEAD, bars, document, longest, sheets},
    chart::{Chart, Look, Panel, Series, outline},
    palette::{Colour, INK, NEGATIVE, ON_NEGATIVE, ON_POSITIVE, POSITIVE, SOFT},
    plot::{PlotError, small_chart},
    svg::{Anchor, Font, PLAIN},
};

/// The share of a colour from which on text on it is dark on dark paper, too.
const STRONG: f64 = 0.65;
/// The share of the negative colour from which on text on it is white on white paper.
const FULL: f64 = 0.92;
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
    /// Whether it is one of many small ones.
    pub small: bool,
}

const CORRELATION: &str = "correlation.svg";

/// The `i`th picture of contributors.
fn contributors_file(i: usize) -> String {
    if i == 0 { "contributors.svg".into() } else { format!("contributors-{}.svg", i + 1) }
}

fn histogram_file(i: usize) -> String {
    format!("histogram-{}.svg", i + 1)
}

/// Names that the files of pictures of `measures` measures can have.
pub fn file_names(measures: usize) -> impl Iterator<Item = String> {
    let of_measures = (0..measures).flat_map(|i| [contributors_file(i), histogram_file(i)]);
    std::iter::once(CORRELATION.to_owned()).chain(of_measures)
}

/// All pictures: contributors, correlations of several measures, and a histogram for every measure.
///
/// # Errors
/// [`PlotError`], if a number is not finite.
pub fn pictures(report: &Report, study: &Study, tallies: &[Tally]) -> Result<Vec<Picture>, PlotError> {
    let picture =
        |file: &str, caption: &str, svg| Picture { file: file.into(), caption: caption.into(), svg, small: false };
    let histogram = |(i, measure): (usize, &MeasureReport)| {
        let svg = histogram_svg(report, study, tallies, i)?;
        let caption = format!("{} over the production.", measure.name);
        Ok(Picture { small: true, ..picture(&histogram_file(i), &caption, svg) })
    };
    let contributors = contributors_svgs(report).into_iter().enumerate();
    let contributors =
        contributors.map(|(i, svg)| picture(&contributors_file(i), "What the measures' variances come from.", svg));
    let correlation = (report.measures.len() > 1)
        .then(|| picture(CORRELATION, "Which measures vary together.", correlation_svg(report)));
    contributors.chain(correlation).map(Ok).chain(report.measures.iter().enumerate().map(histogram)).collect()
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
    let step = factor * frame.scale * width as f64 / slipfit_tolerance::counting::tally::BINS_PER_DEVIATION;
    let classes = classes.iter().map(|(middle, share)| (middle * factor - step / 2.0, share / step));
    let outline = outline(classes, step);
    let top = outline.iter().map(|(_, density)| *density).fold(0.0, f64::max);
    // As far as the limits, so that these stand within the picture.
    let ends = measure.limits.into_iter().flatten().map(|limit| (limit - measure.mean) / measure.sd);
    let [low, high] = ends.fold([-4.0, 4.0], |[low, high]: [f64; 2], z| [low.min(z - 0.25), high.max(z + 0.25)]);
    let normal = (0..=320).map(|k| {
        let z = low + (high - low) * f64::from(k) / 320.0;
        (measure.mean + z * measure.sd, slipfit_tolerance::numeric::normal::density(z) / measure.sd)
    });
    let line = |label: &str, look, points| Series { label: label.into(), look, points };
    let mut series = vec![line("units", Look::Level(0.0), outline)];
    if measure.sd > 0.0 {
        series.push(line("normal", Look::Level(1.0), normal.collect()));
    }
    for limit in measure.limits.into_iter().flatten() {
        series.push(line("", Look::Guide, vec![(limit, 0.0), (limit, 1.05 * top)]));
    }
    let unit = measure.unit;
    let in_unit = |number: &str| match unit {
        "" => number.to_owned(),
        "°" => format!("{number}°"),
        _ => format!("{number} {unit}"),
    };
    let (of_unit, per_unit) = match unit {
        "" => (String::new(), String::new()),
        _ if unit.contains(['/', '·']) => (format!(" ({unit})"), format!(" (1/({unit}))")),
        _ => (format!(" ({unit})"), format!(" (1/{unit})")),
    };
    let limits = if measure.limits == [None; 2] { "" } else { "; grey: limits" };
    let ppk = measure.ppk.map(|ppk| format!(", Ppk {}", fixed(ppk, 3))).unwrap_or_default();
    small_chart(&Chart {
        title: report.title.clone(),
        subtitle: format!(
            "{}: mean {}, σ {}{ppk}; {} units{limits}",
            measure.name,
            in_unit(&typeset(&fixed(measure.mean, 4))),
            in_unit(&fixed(measure.sd, 4)),
            report.samples
        ),
        x_label: format!("{}{of_unit}", measure.name),
        panels: vec![Panel { y_label: format!("density{per_unit}"), series, ..Panel::default() }],
        ..Chart::default()
    })
}

/// Shares of the contributors in the variance of every measure that varies, largest first.
fn contributors_svgs(report: &Report) -> Vec<String> {
    const MOST: usize = 8;
    let bar = |share: &Share| Some(Bar { name: share.name.clone(), percent: share.percent?, error: None });
    let shown = |m: &MeasureReport| Block {
        heading: m.name.clone(),
        bars: m.contributors.iter().filter_map(bar).filter(|bar| bar.percent.abs() >= 0.05).take(MOST).collect(),
    };
    let blocks: Vec<Block> = report.measures.iter().map(shown).filter(|block| !block.bars.is_empty()).collect();
    let drawn = |sheet: &[Block]| bars(&report.title, "contributors, % of the variance", sheet);
    sheets(&blocks).into_iter().map(drawn).collect()
}

/// The correlation matrix of the measures as coloured cells with numbers.
fn correlation_svg(report: &Report) -> String {
    const CELL: f64 = 29.0;
    // What numbers of rows and columns take.
    const NUMBER: f64 = 26.0;
    const SHORT: usize = 24;
    let names = longest(report.measures.iter().map(|measure| measure.name.as_str())).min(7.2 * SHORT as f64);
    let (left, top) = (16.0 + NUMBER + names + 8.0, HEAD + NUMBER);
    let across = CELL * report.measures.len() as f64;
    let (width, height) = ((left + across + 16.0).max(460.0), top + across + 16.0);
    let heading = "correlation of the measures in %: blue negative, orange positive";
    let mut svg = document([width, height], &report.title, heading);
    let middle = Font { anchor: Anchor::Middle, ..PLAIN };
    for (i, measure) in report.measures.iter().enumerate() {
        let place = (i as f64 + 0.5) * CELL;
        let number = (i + 1).to_string();
        svg.text([16.0, top + place], &number, Font { colour: SOFT, ..PLAIN });
        svg.text([left + place, top - 10.0], &number, Font { colour: SOFT, ..middle });
        svg.text([left - 8.0, top + place], &measure.name, Font { anchor: Anchor::End, most: SHORT, ..PLAIN });
        for (j, rho) in report.correlation[i].iter().enumerate() {
            let (x, y) = (left + j as f64 * CELL, top + i as f64 * CELL);
            let strength = rho.abs().min(1.0);
            let full = if *rho < 0.0 { NEGATIVE } else { POSITIVE };
            svg.rectangle([x, y, CELL - 1.0, CELL - 1.0], full, strength);
            let font = Font { colour: ink_on(*rho), size: 12.0, ..middle };
            svg.text([x + (CELL - 1.0) / 2.0, y + CELL / 2.0], &typeset(&fixed(100.0 * rho, 0)), font);
        }
    }
    svg.finish()
}

/// The colour of the number `rho` on its cell. That on positive cells is dark on either paper, as negative cells want it that
/// are not yet full.
fn ink_on(rho: f64) -> Colour {
    if rho.abs() < STRONG {
        INK
    } else if rho < -FULL {
        ON_NEGATIVE
    } else {
        ON_POSITIVE
    }
}

#[cfg(test)]
mod tests {
    use super::{contributors_svgs, correlation_svg, histogram_svg};
    use slipfit_tolerance::{
        analysis::conclude,
        counting::study::{Settings, Study},
        model::{Model, Sum},
        report::report,
        sampling::sampler::Method,
    };

    use crate::scene::SceneFile;

    /// Two gaps that vary together.
    fn left_front() -> Model {
        let text = "[[dimension]]\nname = 'a'\nvalue = '-0.0223 mm'\ntolerance = 0.1872\n\
                    [[dimension]]\nname = 'b'\nvalue = 0.4037\ntolerance = 0.1464\n\
                    [[correlation]]\nof = ['a', 'b']\ncoefficient = -0.4\n\
                    [[measure]]\nname = 'left'\nis = 'a'\n[[measure]]\nname = 'right'\nis = 'b'\n";
        let product = SceneFile::parse("test", text, &[]).unwrap_or_else(|error| panic!("{error}")).product.unwrap();
        let sums = vec![Sum { name: "left front across".into(), measures: vec![0, 1] }];
        Model { sums, ..product.model }
    }

    #[test]
    fn pictures_are_well_formed() {
        let mut model = left_front();
        model.measures[0].limits = [Some(-1e-4), Some(2e-4)];
        let settings = Settings { method: Method::PseudoRandom, samples: 5000, replicates: 1, seed: 2 };
        let study = Study::new(&model, settings).unwrap();
        let mut tallies = study.empty();
        study.add(0..settings.blocks(), &mut tallies, |_| ());
        let report = report("<slide>", &model, &conclude(&study, &tallies).unwrap());
        let histogram = histogram_svg(&report, &study, &tallies, 0).unwrap();
        assert!(
            histogram.contains("density (1/mm)") && histogram.contains(&format!("σ {:.4} mm", report.measures[0].sd))
        );
        for (name, svg) in [
            ("histogram", histogram),
            ("contributors", contributors_svgs(&report).swap_remove(0)),
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
        let mut model = left_front();
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
        for svg in [contributors_svgs(&report).swap_remove(0), correlation_svg(&report)] {
            assert!(width(&svg) <= 900.0, "{}", width(&svg));
            assert!(svg.contains(&format!("<title>{name}</title>")));
        }
        let histogram = histogram_svg(&report, &study, &tallies, 0).unwrap();
        assert!(width(&histogram) < 500.0 && histogram.contains(&format!("<title>{name}")));
    }
}
