//! Changes of a scene that change no result: units, names, order, frames, signs.

use slipfit::tolerance::{
    counting::study::Settings,
    failure::tail::Source,
    report::{Defects, MeasureReport, Report},
    sampling::sampler::Method,
};

use super::{
    assembly::Product,
    chance::Chance,
    compare::{Analysed, Deviations, analysed, drawn, is_right_to_refuse},
    expression::{Kind, One, Tree},
    stack::{Measure, Stack, Writing},
};

fn settings(chance: &mut Chance) -> Settings {
    Settings { method: Method::PseudoRandom, samples: 1024, replicates: 1, seed: chance.below(1 << 30) as u64 }
}

/// A figure of a measure: its name, its value, and how far rounding may move it over the measure's width.
fn figures(of: &MeasureReport) -> Vec<(&'static str, f64, f64)> {
    let rss = of.rss.map_or([0.0; 3], |rss| [rss.middle, rss.tolerance, rss.sd]);
    vec![
        ("mean", of.mean, 1.0),
        ("sd", of.sd, 1.0),
        ("min", of.min, 1.0),
        ("max", of.max, 1.0),
        ("worst case, least", of.worst_case[0], 1e3),
        ("worst case, greatest", of.worst_case[1], 1e3),
        ("RSS, middle", rss[0], 1.0),
        ("RSS", rss[1], 1e2),
        ("RSS, sd", rss[2], 1e2),
        ("undefined", of.undefined as f64, 1.0),
    ]
}

/// The reports differ by rounding alone; measure i of the first is measure `to(i)` of the second.
fn same(what: &str, one: &Report, other: &Report, to: &dyn Fn(usize) -> usize, wrong: &mut Deviations) {
    for (i, a) in one.measures.iter().enumerate() {
        let b = &other.measures[to(i)];
        let size = a.min.abs().max(a.max.abs());
        for ((figure, x, factor), (_, y, _)) in figures(a).into_iter().zip(figures(b)) {
            wrong.near(&format!("{what}: {figure} of {}", a.name), y, x, factor * (1e-9 * (size + a.sd) + 1e-12));
        }
        for side in 0..2 {
            let [x, y] = [a, b].map(|of| of.dpm[side].map_or(0.0, |side| side.dpm));
            // Where the search for most probable failures takes another way, the figure is another sample of the same probability.
            let error = |of: &MeasureReport| match of.dpm[side] {
                Some(Defects { source: Source::Counted, .. }) | None => 0.0,
                Some(Defects { error, .. }) => error.unwrap_or(0.0),
            };
            let bound = 1e-3 * (x.abs() + 1.0) + 4.0 * libm::hypot(error(a), error(b));
            wrong.near(&format!("{what}: defects {side} of {}", a.name), y, x, bound);
        }
        wrong.that(a.rss.is_some() == b.rss.is_some(), || format!("{what}: RSS of {} is there or not", a.name));
    }
}

/// The share of each dimension in a measure, in the order of the stack.
fn shares(stack: &Stack, of: &MeasureReport) -> Vec<Option<f64>> {
    let share = |name: &str| of.contributors.iter().find(|share| share.name == name).and_then(|share| share.percent);
    stack.dimensions.iter().map(|dimension| share(&dimension.name)).collect()
}

/// Units, names, and the order of tables and dimensions.
pub fn stack(stack: &Stack, chance: &mut Chance, wrong: &mut Deviations) {
    let mut stack = stack.clone();
    // Negated measures: the mirror image of every figure.
    let straight = stack.measures.len();
    for i in stack.dimensions.len()..straight {
        let Measure { name, kind, limits: [low, high], .. } = stack.measures[i].clone();
        let tree = Tree::One(One::Negate, Box::new(Tree::Measure(i)));
        let limits = [high, low].map(|limit| limit.map(|x| -x));
        stack.measures.push(Measure { name: format!("minus {name}"), kind, tree, limits });
    }
    let kinds: Vec<Kind> = stack.measures.iter().map(|measure| measure.kind).collect();
    let settings = settings(chance);
    let plain = Writing::plain(&stack.dimensions);
    let run = |what: &str, stack: &Stack, writing: &Writing, wrong: &mut Deviations| -> Option<Analysed> {
        let found = analysed(&writing.text(stack), &kinds, settings);
        if let Err(error) = &found
            && !is_right_to_refuse(error, &drawn(stack, &mut Chance::new(settings.seed, 4)), settings.samples as usize)
        {
            wrong.all.push(format!("{what}: {error}"));
        }
        found.ok()
    };
    let Some(first) = run("unchanged", &stack, &plain, wrong) else { return };
    mirrored(&stack, &first.report, straight, wrong);
    let length = chance.one_of(&[("µm", 1e3), ("m", 1e-3), ("cm", 0.1), ("nm", 1e6), ("in", 1.0 / 25.4)]);
    let angle = chance.one_of(&[("rad", 1f64.to_radians()), ("mrad", 1f64.to_radians() * 1e3), ("°", 1.0)]);
    let what = format!("in {} and {}", length.0, angle.0);
    if let Some(other) = run(&what, &stack, &Writing { length, angle, ..plain.clone() }, wrong) {
        same(&what, &first.report, &other.report, &|i| i, wrong);
    }
    let mut named = stack.clone();
    named.dimensions.iter_mut().enumerate().for_each(|(i, dimension)| dimension.name = format!("ein Maß, {i} (neu)"));
    named.measures.iter_mut().enumerate().for_each(|(i, measure)| measure.name = format!("{i}e mesure"));
    if let Some(other) = run("renamed", &named, &Writing { measures_first: true, ..plain.clone() }, wrong) {
        same("renamed", &first.report, &other.report, &|i| i, wrong);
        for (a, b) in first.report.measures.iter().zip(&other.report.measures) {
            wrong.that(shares(&stack, a) == shares(&named, b), || format!("renamed: shares of {}", a.name));
        }
    }
    let order = chance.order(stack.dimensions.len());
    if let Some(other) = run("reordered", &stack, &Writing { order, ..plain }, wrong) {
        reordered(&stack, &first.report, &other.report, wrong);
    }
}

/// Figures by formula do not depend on the order of the dimensions; units do, as others are drawn.
fn reordered(stack: &Stack, one: &Report, other: &Report, wrong: &mut Deviations) {
    for (a, b) in one.measures.iter().zip(&other.measures) {
        let width = a.worst_case[1] - a.worst_case[0];
        let size = a.worst_case[0].abs().max(a.worst_case[1].abs());
        for side in 0..2 {
            let what = format!("reordered: worst case of {}", a.name);
            wrong.near(&what, b.worst_case[side], a.worst_case[side], 1e-3 * width + 1e-9 * size + 1e-12);
        }
        if let (Some(x), Some(y)) = (a.rss, b.rss) {
            wrong.near(
                &format!("reordered: RSS of {}", a.name),
                y.tolerance,
                x.tolerance,
                1e-6 * x.tolerance + 1e-9 * size,
            );
        }
        if let (Some(x), Some(y)) = (a.quadrature, b.quadrature) {
            wrong.near(&format!("reordered: sd by quadrature of {}", a.name), y.sd, x.sd, 1e-5 * x.sd + 1e-9 * size);
        }
        // Where none of the units drawn in one order differs there are no shares.
        if (a.sd == 0.0) != (b.sd == 0.0) {
            continue;
        }
        // Whether slopes describe a measure is tried at points of chance: close to the bound its shares may be withheld, which is said.
        let is_told = |of: &Report| of.notes.iter().any(|note| note.starts_with(&a.name));
        for (x, y) in shares(stack, a).into_iter().zip(shares(stack, b)) {
            if (x.is_none() && is_told(one)) || (y.is_none() && is_told(other)) {
                continue;
            }
            // Sobol' indices are sampled.
            let [x, y] = [x, y].map(|share| share.unwrap_or(0.0));
            wrong.near(&format!("reordered: a share in {}", a.name), y, x, 8.0);
        }
    }
}

/// The figures of −y from those of y.
fn mirrored(stack: &Stack, report: &Report, straight: usize, wrong: &mut Deviations) {
    for i in stack.dimensions.len()..straight {
        let (a, b) = (&report.measures[i], &report.measures[straight + i - stack.dimensions.len()]);
        let size = a.min.abs().max(a.max.abs()) + a.sd;
        let width = a.worst_case[1] - a.worst_case[0];
        let bound = 1e-9 * size + 1e-12;
        let pairs = [("mean", b.mean, -a.mean), ("sd", b.sd, a.sd), ("min", b.min, -a.max), ("max", b.max, -a.min)];
        for (figure, found, expected) in pairs {
            wrong.near(&format!("mirrored: {figure} of {}", a.name), found, expected, bound);
        }
        for side in 0..2 {
            let found = b.worst_case[side];
            wrong.near(
                &format!("mirrored: worst case of {}", a.name),
                found,
                -a.worst_case[1 - side],
                bound + 1e-3 * width,
            );
            let counted = |of: &MeasureReport, side: usize| {
                [of.estimates.dpm_below, of.estimates.dpm_above][side].map(|d| d.value)
            };
            wrong.that(counted(b, side) == counted(a, 1 - side), || format!("mirrored: counted defects of {}", a.name));
        }
    }
}

/// The product turned and shifted.
pub fn assembly(product: &Product, chance: &mut Chance, wrong: &mut Deviations) {
    let settings = settings(chance);
    let writing = Writing::plain(&[]);
    let kinds = product.kinds();
    let straight = analysed(&product.text(&writing, [0.0; 3], [0.0; 3]), &kinds, settings);
    let turned = [0, 1, 2].map(|_| chance.decimal(-180.0, 180.0, 1));
    let shift = [0, 1, 2].map(|_| chance.decimal(-300.0, 300.0, 0));
    let moved = analysed(&product.text(&writing, turned, shift), &kinds, settings);
    match (straight, moved) {
        (Ok(straight), Ok(moved)) => {
            // Contacts are solved for to a hundred-millionth of their size.
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-6 * (1.0 + a.abs());
            for (i, (a, b)) in straight.units.iter().zip(&moved.units).enumerate() {
                let first = a.iter().zip(b).position(|(a, b)| !close(*a, *b));
                if let Some(unit) = first {
                    let name = &product.measures[i].0;
                    wrong
                        .all
                        .push(format!("turned by {turned:?}: {name} of unit {unit} is {}, not {}", b[unit], a[unit]));
                }
            }
            for (a, b) in straight.report.measures.iter().zip(&moved.report.measures) {
                let width = a.worst_case[1] - a.worst_case[0];
                for side in 0..2 {
                    let what = format!("turned by {turned:?}: worst case of {}", a.name);
                    wrong.near(&what, b.worst_case[side], a.worst_case[side], 1e-3 * width + 1e-6);
                }
            }
        }
        (one, other) => wrong.all.extend([one, other].into_iter().filter_map(Result::err)),
    }
}
