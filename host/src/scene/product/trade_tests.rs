//! Tolerances that are traded against each other, of scenes whose measures have kinks or turn.

use slipfit_tolerance::allocate::{
    figures::Figures,
    requirement::{Kind, OfMeasures},
};

use super::allocate_tests::{all, cheapest, costed, model_of, of_first};

/// Of kinked and folded measures, which no program around some tolerances describes, against all pairs of tolerances on a grid.
#[test]
#[ignore = "takes 20 s; `cargo verify --all` runs it"]
fn kinked_measures_have_no_cheaper_tolerances_on_a_grid() {
    const STEP: f64 = 1.12;
    let cases = [
        (
            "(min((-0.5*d0) + (5.3 mm), (0.5*d0) + (-1*d1) + (15.0 mm)) + ((((2*d1) + (-0.5*d0) + (-34.95 mm))^2/(0.5 mm))))",
            "lower = -0.0422285\nupper = 0.407804",
            Kind::Defects(1e-4),
        ),
        ("max(min(d1 - 0.5*d0 - 15 mm, d0 - 10 mm), 10 mm - d0)", "lower = -0.03\nupper = 0.08", Kind::Defects(1e-3)),
        ("max(min(d1 - 0.5*d0 - 15 mm, d0 - 10 mm), 10 mm - d0)", "lower = -0.03\nupper = 0.08", Kind::WorstCase),
        ("abs(d1 - 2*d0) + max(d0 - 10.02 mm, 0 mm)", "upper = 0.15", Kind::WorstCase),
        ("abs(d1 - 2*d0) + max(d0 - 10.02 mm, 0 mm)", "upper = 0.15", Kind::Ppk(1.0)),
    ];
    for (is, limits, kind) in cases {
        let dimension = |name: &str, value: f64| {
            format!(
                "[[dimension]]\nname = '{name}'\nvalue = {value}\ntolerance = 0.05\ncost = {{ reciprocal = 1, range = [0.005, 0.2] }}\n"
            )
        };
        let text = dimension("d0", 10.0)
            + &dimension("d1", 20.0)
            + &format!("[[measure]]\nname = 'm'\nis = '{is}'\n{limits}\n");
        let requirements = of_first(kind);
        let costed = costed(&text);
        let model = model_of(&text, &costed);
        let figures = OfMeasures::new(&requirements, &model, &[5e-5; 2], 1).unwrap();
        let meets = |t: &[f64; 2]| figures.values(t).unwrap().iter().all(|figure| *figure <= 1.0);
        let found = cheapest(&text, &requirements, all);
        let count = (libm::log(40.0) / libm::log(STEP)) as i32;
        let grid: Vec<f64> = (0..=count).map(|k| 5e-6 * libm::pow(STEP, f64::from(k))).collect();
        let mut least = f64::INFINITY;
        for t in &grid {
            // Wider ones of the other tolerance first, and only what would be cheaper.
            let cost = |u: f64| 1e-3 / t + 1e-3 / u;
            let cheaper = grid.iter().rev().copied().take_while(|u| cost(*u) < least).find(|u| meets(&[*t, *u]));
            least = cheaper.map_or(least, cost);
        }
        let cost = found.map(|found| found.solution.cost);
        println!("{is} {kind:?}: {cost:?}, {least} on the grid");
        assert!(cost.is_ok_and(|cost| cost < least * 1.002), "{is} {kind:?}: {least}");
    }
}

/// A product of two factors has its least value, at d = 4.95 mm, within the tolerance: wider ones come no nearer to the lower limit. Beyond
/// 5 mm + t the product reaches the upper limit.
#[test]
fn tolerances_are_widened_beyond_where_a_measure_turns() {
    let text = "[[dimension]]\nname = 'd'\nvalue = 5\ntolerance = 0.05\ncost = { reciprocal = 1, range = [0.005, 0.2] }\n\
                [[measure]]\nname = 'm'\nis = '(2*d - 10.1 mm)*(2*d - 9.7 mm)/(1 mm)'\nlower = -0.04\nupper = 0.0624585\n";
    let found = cheapest(text, &of_first(Kind::WorstCase), all).unwrap();
    // (2t − 0.1)·(2t + 0.3) = 0.0624585.
    let t = (-0.4 + libm::sqrt(0.16 + 16.0 * (0.03 + 0.0624585))) / 8.0;
    assert!((found.solution.tolerances[0] / (t * 1e-3) - 1.0).abs() < 3e-3 && found.traded, "{found:?} {t}");
}

/// Trades reach processes and steps that lie far from each other: a fixed price up to 0.05 mm and one from there on, and a list of two.
#[test]
fn trades_reach_tolerances_far_apart() {
    let dimension = |name: &str, cost: &str| {
        format!("[[dimension]]\nname = '{name}'\nvalue = 10\ntolerance = 0.02\ncost = {cost}\n")
    };
    for (cost, expected) in [
        ("[{ fixed = 7, range = [0.01, 0.015] }, { fixed = 3, range = [0.1, 0.15] }]", [3.0, 7.0]),
        ("{ reciprocal = 1, range = [0.01, 0.16], step = 0.15 }", [6.25, 100.0]),
    ] {
        // Only one of both may be wide: |a − 10| and |b − 10| add up.
        let text = dimension("a", cost)
            + &dimension("b", cost)
            + "[[measure]]\nname = 'm'\nis = 'abs(a - 10 mm) + abs(b - 10 mm)'\nupper = 0.18\n";
        let found = cheapest(&text, &of_first(Kind::WorstCase), all).unwrap();
        assert!((found.solution.cost - expected.iter().sum::<f64>()).abs() < 1e-9, "{cost}: {found:?}");
    }
}
