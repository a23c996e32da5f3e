use super::{Chart, Look, Markers, Panel, PlotError, Scale, Series, Shape, line_chart};

fn chart(levels: &[f64], value: impl Fn(f64, f64) -> f64) -> Chart {
    let line = |n: &f64| Series {
        label: format!("n = {n}"),
        look: Look::Level(*n),
        points: (0..=1500).map(|i| (f64::from(i), value(f64::from(i), *n))).collect(),
    };
    Chart {
        title: "<slide> & \"pins\"\u{7}".to_owned(),
        subtitle: "drawn & labelled".to_owned(),
        x_label: "time (ms)".to_owned(),
        scale: Scale::Linear,
        panels: vec![Panel {
            y_label: "drive force (N)".to_owned(),
            series: levels.iter().map(line).collect(),
            ..Panel::default()
        }],
    }
}

/// The texts of the drawing, once it is well-formed, finite and the same again.
fn texts(chart: &Chart) -> Vec<String> {
    let svg = line_chart(chart).unwrap();
    assert_eq!(svg, line_chart(chart).unwrap());
    assert!(!svg.contains("NaN") && !svg.contains("inf") && svg.len() < 400_000, "{} bytes", svg.len());
    let document = roxmltree::Document::parse(&svg).unwrap();
    for line in document.descendants().filter(|node| node.has_tag_name("polyline")) {
        let points: Vec<&str> = line.attribute("points").unwrap().split(' ').collect();
        assert!(points.len() <= super::POINTS);
        for (x, y) in points.iter().map(|point| point.split_once(',').unwrap()) {
            assert!((0.0..=900.0).contains(&x.parse::<f64>().unwrap()));
            assert!((0.0..=540.0).contains(&y.parse::<f64>().unwrap()));
        }
    }
    document.descendants().filter(|node| node.is_text()).map(|node| node.text().unwrap().trim().to_owned()).collect()
}

#[test]
fn labels_axes_and_ends() {
    let texts = texts(&chart(&[-1.0, 0.0, 2.5], |t, n| t * n / 1e3));
    for expected in [
        "<slide> & \"pins\"\u{fffd}",
        "time (ms)",
        "drive force (N)",
        "n = -1",
        "n = 0",
        "n = 2.5",
        "1500",
        "\u{2212}1",
    ] {
        assert!(texts.iter().any(|text| text == expected), "{expected} in {texts:?}");
    }
}

#[test]
fn labels_stand_in_the_order_of_their_levels_where_lines_coincide() {
    let labels = |value: &dyn Fn(f64, f64) -> f64| {
        let texts = texts(&chart(&[-2.0, -1.0, 0.0, 1.0, 2.0], value));
        texts.into_iter().filter_map(|text| Some(text.strip_prefix("n = ")?.to_owned())).collect::<Vec<_>>()
    };
    assert_eq!(labels(&|_, n| 1.0 + 1e-6 * libm::sin(9.0 * n)), ["2", "1", "0", "-1", "-2"]);
    assert_eq!(labels(&|_, n| 3.0 - n), ["-2", "-1", "0", "1", "2"]);
    // Of one height, but not the same: the two loosest lie on each other.
    assert_eq!(labels(&|_, n| if n < -0.5 { 0.0 } else { 3.0 - n }), ["0", "1", "2", "-1", "-2"]);
}

#[test]
fn labels_of_kinds_have_their_marks() {
    let mut kinds = chart(&[], |_, _| 0.0);
    let points = vec![(0.0, 1.0), (1.0, 2.0)];
    kinds.panels[0].series = vec![Series { label: "one".into(), look: Look::Kind(2), points }];
    let svg = line_chart(&kinds).unwrap();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let squares =
        document.descendants().filter(|node| node.has_tag_name("path")).filter_map(|node| node.attribute("d"));
    assert_eq!(squares.map(|path| path.matches('M').count()).sum::<usize>(), 3);
}

#[test]
fn constant_single_and_many() {
    texts(&chart(&[0.0], |_, _| 0.0));
    texts(&chart(&[1.0, 2.0], |_, _| 3.0));
    let levels: Vec<f64> = (0..81).map(|i| f64::from(i - 20)).collect();
    let texts = texts(&chart(&levels, |t, n| libm::sin(t / 20.0) * n));
    assert_eq!(texts.iter().filter(|text| text.starts_with("n = ")).count(), 9);
}

#[test]
fn large_and_small_numbers_fit_the_margin() {
    for (scale, label) in [(1e9, "8.0e8"), (1e-9, "8.0e\u{2212}10")] {
        assert!(texts(&chart(&[1.0], |t, _| t / 1500.0 * scale)).contains(&label.to_owned()));
    }
}

#[test]
fn one_point() {
    let points = vec![(1.0, 2.0)];
    let markers = vec![Markers { label: "jammed".to_owned(), shape: Shape::Cross, points }];
    let mut chart = chart(&[], |_, _| 0.0);
    chart.panels[0].markers = markers;
    assert!(texts(&chart).contains(&"jammed".to_owned()));
}

#[test]
fn powers_of_ten() {
    let line = |look, label: &str, points: &[(f64, f64)]| Series { label: label.into(), look, points: points.into() };
    let mut log = chart(&[], |_, _| 0.0);
    log.scale = Scale::Log;
    log.panels[0].note = "blown up".to_owned();
    log.panels[0].series = vec![
        line(Look::Kind(0), "one scheme", &[(0.05, 3.0), (200.0, 2e-6)]),
        line(Look::Variant(0), "unseen", &[(0.04, 3.0), (100.0, 2e-4)]),
        line(Look::Guide, "unseen", &[(0.01, 1e-6), (1000.0, 1e-6)]),
    ];
    let texts = texts(&log);
    for expected in ["one scheme", "blown up", "0.01", "1000", "1e\u{2212}6", "0.0001", "10"] {
        assert!(texts.iter().any(|text| text == expected), "{expected} in {texts:?}");
    }
    assert!(!texts.contains(&"unseen".to_owned()));
    log.panels[0].series[0].points[0].1 = 0.0;
    assert_eq!(line_chart(&log), Err(PlotError::NotFinite("drive force (N)".to_owned())));
}

#[test]
fn refuses_what_it_cannot_draw() {
    assert_eq!(line_chart(&chart(&[], |_, _| 0.0)), Err(PlotError::Empty));
    assert_eq!(line_chart(&Chart::default()), Err(PlotError::Empty));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        let chart = chart(&[1.0], |t, _| if t == 7.0 { bad } else { 0.0 });
        assert_eq!(line_chart(&chart), Err(PlotError::NotFinite("drive force (N)".to_owned())));
    }
}
