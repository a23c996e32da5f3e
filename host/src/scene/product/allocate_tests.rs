//! Requirements by the full model, of scenes.

use slipfit_core::sampling::{
    normal::score,
    stream::{Rng, unit_stream},
};
use slipfit_tolerance::{
    allocate::{
        AllocateError,
        cost::{Law, Process, Values},
        figures::Figures,
        requirement::{Kind, OfMeasures, Requirement},
        search::{Found, search},
    },
    model::Model,
    numeric::normal,
    product::costed::Costed,
};

use crate::scene::{SceneFile, shipped, with_tolerances};

/// The cheapest tolerances of a scene, whose processes `choose` may narrow.
pub(super) fn cheapest(
    text: &str,
    requirements: &[Requirement],
    choose: impl Fn(usize, &[Process]) -> Vec<Process>,
) -> Result<Found, AllocateError> {
    let costed = costed(text);
    let model = model_of(text, &costed);
    let processes: Vec<Vec<Process>> =
        costed.iter().enumerate().map(|(item, costed)| choose(item, &costed.processes)).collect();
    let processes: Vec<&[Process]> = processes.iter().map(Vec::as_slice).collect();
    let start: Vec<f64> = costed.iter().map(|costed| costed.stated).collect();
    search(&processes, &start, &OfMeasures::new(requirements, &model, &start, 1)?)
}

/// The model of a scene with other tolerances.
pub(super) fn model_of(text: &str, costed: &[Costed]) -> impl Fn(&[f64]) -> Result<Model, AllocateError> + Sync {
    move |tolerances| {
        let text = with_tolerances(text, costed, tolerances, 17);
        Ok(SceneFile::parse("x.toml", &text, &[]).unwrap().product.unwrap().model)
    }
}

pub(super) fn costed(text: &str) -> Vec<Costed> {
    SceneFile::parse("x.toml", text, &[]).unwrap_or_else(|error| panic!("{error}")).product.unwrap().costed
}

pub(super) fn all(_: usize, processes: &[Process]) -> Vec<Process> {
    processes.to_vec()
}

pub(super) fn of_first(kind: Kind) -> [Requirement; 1] {
    [Requirement { measure: Some(0), kind }]
}

/// Processes are chosen by linearised figures: no other choice of them is cheaper by the full model.
#[test]
#[ignore = "takes 15 s; `cargo verify --all` runs it"]
fn no_other_processes_are_cheaper_by_the_full_model() {
    let text = shipped("clutch-processes").unwrap();
    let costed = costed(text);
    let counts: Vec<usize> = costed.iter().map(|costed| costed.processes.len()).collect();
    for kind in [Kind::WorstCase, Kind::Ppk(1.2), Kind::Defects(3e-4)] {
        let found = cheapest(text, &of_first(kind), all).unwrap();
        for choice in 0..counts.iter().product() {
            let mut rest: usize = choice;
            let digits: Vec<usize> = counts.iter().map(|count| (rest % count, rest /= count).0).collect();
            // What costs more with the widest tolerances need not be tried.
            let chosen = costed.iter().zip(&digits).map(|(costed, digit)| &costed.processes[*digit]);
            let least: f64 = chosen.map(|process| process.law.cost(process.values.ends()[1])).sum();
            if least >= found.solution.cost {
                continue;
            }
            match cheapest(text, &of_first(kind), |item, processes| vec![processes[digits[item]].clone()]) {
                Ok(other) => {
                    let [other, found] = [other, found.clone()].map(|found| found.solution.cost);
                    assert!(other > found * (1.0 - 1e-5), "{kind:?} {digits:?} {other} {found}");
                }
                Err(AllocateError::Infeasible { .. }) => {}
                Err(error) => panic!("{kind:?} {digits:?}: {error}"),
            }
        }
    }
}

/// Three points on which a plate lies: its far corner is B + C − A. Zones cost b/t: t ∝ ∛b, and √Σ(t/2)² is the limit.
#[test]
fn zones_have_costs_too() {
    let mut text = shipped("three-locators").unwrap().to_owned();
    for (name, cost) in [("A", "1"), ("B", "8"), ("C", "27")] {
        let from = format!("name = \"{name}\"");
        let at = text.find(&from).unwrap();
        let zone = format!("profile = {{ zone = 0.06, cost = {{ reciprocal = {cost}, range = [0.001, 1] }} }}");
        let tail = text[at..].replacen("profile = 0.06", &zone, 1);
        text.replace_range(at.., &tail);
    }
    text += "lower = -0.05\nupper = 0.05\nrequire = \"rss\"\n";
    let requirement = Requirement { measure: Some(1), kind: Kind::Rss };
    let found = cheapest(&text, &[requirement], all).unwrap();
    let scale = 2.0 * 0.05e-3 / libm::sqrt(1.0 + 4.0 + 9.0);
    for (t, root) in found.solution.tolerances.iter().zip([1.0, 2.0, 3.0]) {
        assert!((t / (scale * root) - 1.0).abs() < 1e-6, "{found:?}");
    }
    assert_eq!(costed(&text)[0].name, "fixture.A profile");
}

/// Two gaps of one stack, and both together: the yield needs tighter tolerances than either alone, and less than if the
/// failures of both added up without overlap.
#[test]
fn a_yield_of_several_measures() {
    let text = "
        [[dimension]]
        name = 'a'
        value = 10
        tolerance = 0.1
        cost = { reciprocal = 1, range = [0.01, 1] }
        [[dimension]]
        name = 'b'
        value = 10
        tolerance = 0.1
        cost = { reciprocal = 1, range = [0.01, 1] }
        [[measure]]
        name = 'one'
        is = 'a'
        lower = 9.9
        upper = 10.1
        [[measure]]
        name = 'two'
        is = 'b'
        lower = 9.9
        upper = 10.1
    "
    .replace('\'', "\"");
    let share = 1e-3;
    let found = cheapest(&text, &[Requirement { measure: None, kind: Kind::Defects(share) }], all).unwrap();
    // Independent: 1 − (1 − p)² of both, p = 2Φ(−z) with z = 3 · 0.1/t.
    let p = 1.0 - libm::sqrt(1.0 - share);
    let z = -normal::quantile(0.5 * p);
    for t in &found.solution.tolerances {
        assert!((t / (0.3e-3 / z) - 1.0).abs() < 0.01, "{found:?} {z}");
    }
}

/// A requirement of each of two measures: each tolerance is bound by its own. Steps and grades are kept to.
#[test]
fn several_requirements_steps_and_grades() {
    let text = "
        [[dimension]]
        name = 'a'
        value = 40
        tolerance = 'm'
        cost = { fixed = 1, exponential = 5, at = 0.1, range = [0.02, 0.2], step = 0.015 }
        [[dimension]]
        name = 'b'
        value = 20
        tolerance = [-0.02, 0.04]
        cost = { reciprocal = 1, grades = [6, 11] }
        [[measure]]
        name = 'sum'
        is = 'a + b'
        lower = 59.9
        upper = 60.12
        [[measure]]
        name = 'b alone'
        is = 'b'
        lower = 19.98
    "
    .replace('\'', "\"");
    let worst = |measure| Requirement { measure: Some(measure), kind: Kind::WorstCase };
    let found = cheapest(&text, &[worst(0), worst(1)], all).unwrap();
    // IT7 of 20 mm is 21 µm, IT8 33, IT9 52; b has 0.03 below its middle, so 26 µm at most. The rest is for a: 0.11 − 0.026.
    let [a, b] = [found.solution.tolerances[0], found.solution.tolerances[1]].map(|t| t * 1e3);
    assert!((b - 0.026).abs() < 1e-12 && (a - 0.08).abs() < 1e-12, "{found:?}");
    let written = with_tolerances(&text, &costed(&text), &found.solution.tolerances, 6);
    assert!(written.contains("tolerance = 0.08\n") && written.contains("tolerance = [-0.016, 0.036]"), "{written}");
    assert!(SceneFile::parse("x.toml", &written, &[]).is_ok());
}

#[test]
fn what_cannot_be_met_or_is_not_linear_is_told() {
    let text = shipped("clutch-processes").unwrap().replace("0.087 rad", "0.1219 rad");
    match cheapest(&text, &of_first(Kind::WorstCase), all) {
        Err(AllocateError::Infeasible { tightest, figures }) => {
            assert!(figures[0] > 1.0 && figures[1] < 1.0 && (tightest[0] - 0.015e-3).abs() < 1e-12, "{figures:?}");
        }
        other => panic!("{other:?}"),
    }
    let folded = shipped("clutch-processes")
        .unwrap()
        .replace("acos(", "abs(0.122 rad - acos(")
        .replace(") / 2))\"", ") / 2)))\"");
    assert!(matches!(cheapest(&folded, &of_first(Kind::Rss), all), Err(AllocateError::NotLinear(_))));
}

/// Units malfunction where the sum of three normal deviations (a third of each tolerance) is beyond a limit: the share that
/// is counted among 4,096 units depends on Σt² alone, so that the optimum of RSS is theirs, t ∝ ∛b.
#[test]
fn shares_that_are_counted_lead_near_the_closed_form() {
    const LIMIT: f64 = 0.1;
    const ALLOWED: f64 = 0.02;
    let weights = [1.0, 8.0, 27.0];
    let law = |factor| Law::Reciprocal { fixed: 0.0, factor, unit: 1.0, power: 1.0 };
    let processes: Vec<Vec<Process>> = weights
        .iter()
        .map(|b| vec![Process { name: String::new(), law: law(*b), values: Values::Range([1e-3, 1.0]) }])
        .collect();
    let processes: Vec<&[Process]> = processes.iter().map(Vec::as_slice).collect();
    let mut random = unit_stream(3, 0);
    let units: Vec<[f64; 3]> = (0..4096).map(|_| std::array::from_fn(|_| score(random.next_u64()))).collect();
    let malfunctions = |tolerances: &[f64], limit: Option<f64>| {
        assert_eq!(limit, Some(3.0));
        let sum = |unit: &[f64; 3]| unit.iter().zip(tolerances).map(|(z, t)| z * t / 3.0).sum::<f64>();
        Ok(units.iter().filter(|unit| sum(unit).abs() > LIMIT).count() as f64 / units.len() as f64)
    };
    let model =
        |_: &[f64]| Ok(SceneFile::parse("x.toml", shipped("clutch").unwrap(), &[]).unwrap().product.unwrap().model);
    let kind = Kind::Malfunction { allowed: ALLOWED, force_limit: Some(3.0) };
    let requirement = Requirement { measure: None, kind };
    let figures = OfMeasures::new(&[requirement], &model, &[], 1).unwrap().with_malfunctions(&malfunctions);
    let found = search(&processes, &[0.1, 0.1, 0.1], &figures).unwrap();
    assert!(malfunctions(&found.solution.tolerances, Some(3.0)).unwrap() <= ALLOWED);
    // σ of the sum is the limit over the score of half the share; cost at t = k·∛b with k = 3σ/√Σb^⅔.
    let deviation = LIMIT / -normal::quantile(0.5 * ALLOWED);
    let k = 3.0 * deviation / libm::sqrt(1.0 + 4.0 + 9.0);
    let cost = (1.0 + 4.0 + 9.0) / k;
    assert!((found.solution.cost / cost - 1.0).abs() < 0.03, "{} {cost}", found.solution.cost);
    for (t, root) in found.solution.tolerances.iter().zip([1.0, 2.0, 3.0]) {
        assert!((t / (k * root) - 1.0).abs() < 0.2, "{:?}", found.solution.tolerances);
    }
}

/// The figures of requirements with the tolerances that a scene states.
fn figures(text: &str, requirements: &[Requirement]) -> Vec<f64> {
    let model = |_: &[f64]| Ok(SceneFile::parse("x.toml", text, &[]).unwrap().product.unwrap().model);
    OfMeasures::new(requirements, &model, &[], 1).unwrap().values(&[]).unwrap()
}

/// The worst case that is required is the one that is reported: of the clutch 5.9574 to 7.9385 degrees, below its lower limit.
#[test]
fn a_required_worst_case_is_that_of_corners_and_a_search() {
    let middle = 7.018_389_8;
    let found = figures(shipped("clutch").unwrap(), &of_first(Kind::WorstCase));
    for (found, [end, limit]) in found.iter().zip([[5.957_364_5, 6.0184], [7.938_469_3, 8.0184]]) {
        let expected = (end - middle) / (limit - middle);
        assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
    }
    assert!(found[0] > 1.0 && found[1] < 1.0);
    let text = "[[dimension]]\nname = 'L'\nvalue = 100\ntolerance = 0.1\n\
                [[dimension]]\nname = 'tilt'\nvalue = '0°'\ntolerance = '3°'\n\
                [[measure]]\nname = 'm'\nis = 'L - L*cos(tilt)'\nupper = 0.1\n";
    let found = figures(text, &of_first(Kind::WorstCase));
    assert!((found[0] - 1001.0 * (1.0 - libm::cos(3f64.to_radians()))).abs() < 1e-6, "{found:?}");
}

/// √x with x 1.5 standard deviations above 0 has no value in 6.68 % of the units: all of them are defects.
#[test]
fn units_without_a_value_are_defects() {
    let text = "[[dimension]]\nname = 'x'\nvalue = 0.1\ntolerance = 0.2\n\
                [[dimension]]\nname = 'y'\nvalue = 1\ntolerance = 0.1\n\
                [[measure]]\nname = 'm'\nis = 'y + sqrt(x * 1 mm)'\nupper = 9\n\
                [[measure]]\nname = 'n'\nis = 'y'\nupper = 9\n";
    let expected = normal::tail(1.5);
    for measure in [Some(0), None] {
        let requirement = Requirement { measure, kind: Kind::Defects(expected) };
        let found = figures(text, &[requirement])[0];
        // The figure is 1 for as many defects as are allowed.
        assert!((found - 1.0).abs() < 2e-3, "{measure:?}: {found}");
    }
    let none = figures(text, &[Requirement { measure: Some(1), kind: Kind::Defects(expected) }]);
    assert!(none[0] < 0.1, "{none:?}");
    let unbounded =
        figures(text, &[Kind::Ppk(1.0), Kind::WorstCase].map(|kind| Requirement { measure: Some(0), kind }));
    assert_eq!(unbounded, [f64::INFINITY; 2]);
}

/// a ± t and b ± u cost 1/t and 4/u: at t + u = T the least cost is 9/T, and 1 % wider limits save what that falls by. Neither limit alone
/// brings anything, nor more than until the other binds.
#[test]
fn limits_that_bind_together_have_a_price_together() {
    let scene = |upper: f64| {
        format!(
            "[[dimension]]\nname = 'a'\nvalue = 10\ntolerance = 0.1\ncost = {{ reciprocal = 1, range = [0.001, 1] }}\n\
             [[dimension]]\nname = 'b'\nvalue = 5\ntolerance = 0.1\ncost = {{ reciprocal = 4, range = [0.001, 1] }}\n\
             [[measure]]\nname = 'm'\nis = 'a - b'\nlower = 4.7\nupper = {upper}\n"
        )
    };
    let both = cheapest(&scene(5.3), &of_first(Kind::WorstCase), all).unwrap();
    let cost = 9.0 / 0.3;
    assert!((both.solution.cost / cost - 1.0).abs() < 1e-6, "{both:?}");
    let saved = |wider: f64| cost * wider / (1.0 + wider);
    assert!((both.together.unwrap() / saved(0.01) - 1.0).abs() < 1e-3, "{both:?}");
    assert!(both.solution.prices.iter().all(|price| price.abs() < 1e-6 * cost), "{both:?}");
    // With an upper limit that is a little farther.
    for wider in [1e-6, 1e-5, 1e-4, 1e-3, 5e-3, 9e-3] {
        let found = cheapest(&scene(5.0 + 0.3 * (1.0 + wider)), &of_first(Kind::WorstCase), all).unwrap();
        let prices = found.solution.prices.iter().map(|price| 0.01 * price).collect::<Vec<_>>();
        // The program counts on what is met to 1e-6.
        assert!((prices[0] - saved(wider)).abs() < 2e-6 * cost && prices[1].abs() < 1e-6 * cost, "{wider}: {prices:?}");
        assert!((found.together.unwrap() / saved(0.01) - 1.0).abs() < 1e-3, "{wider}: {found:?}");
    }
    // Where the lower limit alone binds it has the whole price.
    let one = cheapest(&scene(5.5), &of_first(Kind::WorstCase), all).unwrap();
    assert!(one.together.is_none() && one.solution.prices[1] == 0.0);
    assert!((one.solution.prices[0] / cost - 1.0).abs() < 1e-3, "{one:?}");
}

/// Two measures that share a dimension bind together, each with a price of its own: a ± t costs 1/t in both, b and c 1/u and 1/v
/// in one each. With t + u ≤ T and t + v ≤ S the prices are those of the stationary point, and together they add up.
#[test]
fn prices_of_two_measures_add_up() {
    let dimension = |name: &str| {
        format!(
            "[[dimension]]\nname = '{name}'\nvalue = 10\ntolerance = 0.1\ncost = {{ reciprocal = 1, range = [0.001, 1] }}\n"
        )
    };
    let text = ["a", "b", "c"].map(dimension).concat()
        + "[[measure]]\nname = 'm'\nis = 'a + b'\nupper = 20.3\n[[measure]]\nname = 'n'\nis = 'a + c'\nupper = 20.2\n";
    let requirements = [0, 1].map(|i| Requirement { measure: Some(i), kind: Kind::WorstCase });
    let found = cheapest(&text, &requirements, all).unwrap();
    // 1/t + 1/(T − t) + 1/(S − t) is least where 1/t² = 1/(T − t)² + 1/(S − t)².
    let least = |[long, short]: [f64; 2]| {
        let (mut low, mut high): (f64, f64) = (1e-3, 0.199);
        for _ in 0..100 {
            let t = 0.5 * (low + high);
            let slope = 1.0 / ((long - t) * (long - t)) + 1.0 / ((short - t) * (short - t)) - 1.0 / (t * t);
            if slope > 0.0 { high = t } else { low = t }
        }
        1.0 / low + 1.0 / (long - low) + 1.0 / (short - low)
    };
    let saved = |limits| least([0.3, 0.2]) - least(limits);
    for (price, expected) in found.solution.prices.iter().zip([saved([0.303, 0.2]), saved([0.3, 0.202])]) {
        assert!((0.01 * price / expected - 1.0).abs() < 1e-3, "{price} {expected}");
    }
    assert!((found.together.unwrap() / saved([0.303, 0.202]) - 1.0).abs() < 1e-3, "{found:?}");
}

#[test]
fn a_process_may_have_a_fixed_price() {
    let text = "[[dimension]]\nname = 'a'\nvalue = 10\ntolerance = 0.1\ncost = [{ fixed = 3, range = [0.05, 0.2] }, { fixed = 7, range = [0.01, 0.05] }]\n\
                [[measure]]\nname = 'm'\nis = 'a'\nlower = 9.9\nupper = 10.1\n";
    let found = cheapest(text, &of_first(Kind::WorstCase), all).unwrap();
    assert_eq!((found.solution.cost, found.solution.processes.as_slice()), (3.0, &[0][..]));
    for (key, allowed) in [("at = 0.1", false), ("power = 2", false), ("name = 'p'", true)] {
        let text = text.replace("fixed = 3,", &format!("fixed = 3, {key},"));
        assert_eq!(SceneFile::parse("x.toml", &text, &[]).is_ok(), allowed, "{key}");
    }
}

/// What a measure never is: below the value that it has in the middle. Its lower limit may be there.
#[test]
fn a_limit_that_is_touched_and_never_passed_is_met() {
    let cases = [
        ("max(10 mm - d, 0 mm)", "lower = 0\nupper = 0.1", 0.1),
        ("(d - 10 mm)^2/(1 mm)", "lower = 0\nupper = 0.01", 0.1),
        ("100 mm - (d - 10 mm)^2/(1 mm)", "lower = 99.99\nupper = 100", 0.1),
        ("abs(d - 10 mm)", "lower = 0\nupper = 0.05", 0.05),
    ];
    for (is, limits, tolerance) in cases {
        let text = format!(
            "[[dimension]]\nname = 'd'\nvalue = 10\ntolerance = 0.05\ncost = {{ reciprocal = 1, range = [0.005, 0.5] }}\n\
             [[measure]]\nname = 'm'\nis = '{is}'\n{limits}\n"
        );
        let found = cheapest(&text, &of_first(Kind::WorstCase), all).unwrap();
        assert!((found.solution.tolerances[0] / (tolerance * 1e-3) - 1.0).abs() < 1e-5, "{is}: {found:?}");
    }
    let beyond = "[[dimension]]\nname = 'd'\nvalue = 10\ntolerance = 0.05\ncost = { reciprocal = 1, range = [0.005, 0.5] }\n\
                  [[measure]]\nname = 'm'\nis = 'd'\nlower = 10\n";
    assert!(matches!(cheapest(beyond, &of_first(Kind::WorstCase), all), Err(AllocateError::Infeasible { .. })));
}

/// max(0, p − h) is level where the pin goes into the hole: P(p − h > limit) by the normal of their difference.
#[test]
fn tails_beyond_a_level_part_are_found() {
    let text = |t: f64, upper: f64| {
        format!(
            "[[dimension]]\nname = 'pin'\nvalue = 10\ntolerance = {t}\n[[dimension]]\nname = 'hole'\nvalue = 10.05\ntolerance = {t}\n\
             [[measure]]\nname = 'm'\nis = 'max(0 mm, pin - hole)'\nupper = {upper}\n"
        )
    };
    for (t, upper) in [(0.05, 0.04), (0.042, 0.04), (0.05, 0.02), (0.06, 0.1), (0.08, 0.1)] {
        let expected = normal::tail((0.05 + upper) * 3.0 / (t * std::f64::consts::SQRT_2));
        let requirement = Requirement { measure: Some(0), kind: Kind::Defects(expected) };
        let found = figures(&text(t, upper), &[requirement])[0];
        let share = Kind::Defects(expected);
        // The figure is the square of a ratio of scores: 1 for as many as there are.
        assert!((found - 1.0).abs() < 0.02, "{t} {upper}: {share:?} {found}");
    }
}

/// Measures without limits have no units outside of them, but units without a value.
#[test]
fn a_yield_counts_units_without_a_value() {
    let text = "[[dimension]]\nname = 'x'\nvalue = 0.1\ntolerance = 0.2\n[[dimension]]\nname = 'y'\nvalue = 1\ntolerance = 0.1\n\
                [[measure]]\nname = 'm'\nis = 'y + sqrt(x * 1 mm)'\n";
    let more = "[[measure]]\nname = 'n'\nis = 'y'\nupper = 9\n";
    let requirement = Requirement { measure: None, kind: Kind::Defects(normal::tail(1.5)) };
    for text in [text.to_owned(), text.to_owned() + more] {
        let found = figures(&text, &[requirement])[0];
        assert!((found - 1.0).abs() < 0.01, "{text}: {found}");
    }
}
