//! Known optima, closed forms, and random programs against all that can be tried.

use slipfit_core::sampling::stream::{Rng, unit_stream};

use super::{
    branch::Solution,
    cost::{Law, Process, Values},
    program::{Power, Program, Row},
};

fn process(fixed: f64, factor: f64, power: f64, values: Values) -> Process {
    Process { name: String::new(), law: Law::Reciprocal { fixed, factor, unit: 1.0, power }, values }
}

fn range(low: f64, high: f64) -> Values {
    Values::Range([low, high])
}

/// RSS: tᵢ ∝ (bᵢ/gᵢ²)^⅓; worst case: tᵢ ∝ √(bᵢ/|gᵢ|).
#[test]
fn closed_forms() {
    let (factors, slopes, limit) = ([0.3, 1.0, 2.5, 0.01], [1.0, -2.0, 0.5, 4.0], 0.35);
    let processes: Vec<_> = factors.iter().map(|b| vec![process(1.0, *b, 1.0, range(1e-6, 1e3))]).collect();
    for (power, shape) in [
        (Power::Two, factors.iter().zip(slopes).map(|(b, g)| libm::cbrt(b / (g * g))).collect::<Vec<_>>()),
        (Power::One, factors.iter().zip(slopes).map(|(b, g): (_, f64)| libm::sqrt(b / g.abs())).collect()),
    ] {
        let weights: Vec<f64> = slopes.iter().map(|g| power.of(g.abs()) / power.of(limit)).collect();
        let row = Row { power, weights };
        let scale = libm::pow(row.usage(&shape), -1.0 / power.exponent());
        let program = Program { processes: processes.iter().map(Vec::as_slice).collect(), rows: vec![row], near: None };
        let found = program.solve().unwrap();
        for (t, shape) in found.tolerances.iter().zip(&shape) {
            assert!((t / (scale * shape) - 1.0).abs() < 1e-9, "{power:?} {found:?}");
        }
        // A price is what the cost falls by.
        let wider = Row { weights: program.rows[0].weights.iter().map(|w| w / 1.0001).collect(), power };
        let cost = Program { rows: vec![wider], ..program.clone() }.solve().unwrap().cost;
        assert!(((found.cost - cost) / 1e-4 / found.prices[0] - 1.0).abs() < 1e-3, "{power:?}");
    }
}

/// Three processes for the hub, two a roller, three for the cage; RSS of the pressure angle's slopes at nominal. Inches,
/// which do not matter here.
#[test]
fn the_clutch_with_a_choice_of_processes() {
    let list = |of: &[(f64, f64, f64, f64)]| -> Vec<Process> {
        of.iter().map(|(a, b, low, high)| process(*a, *b, 1.0, range(*low, *high))).collect()
    };
    let processes = [
        list(&[(10.0, 0.015, 0.015, 0.08), (5.0, 0.5, 0.06, 0.15), (3.5, 0.75, 0.12, 0.25)]),
        list(&[(8.0, 0.25, 0.02, 0.15), (3.0, 0.65, 0.08, 0.3)]),
        list(&[(2.5, 0.3, 0.04, 0.2), (5.0, 0.045, 0.12, 0.25)]),
        list(&[(4.0, 0.56, 0.08, 0.12), (6.0, 0.16, 0.15, 0.25), (0.5, 0.88, 0.2, 0.4)]),
    ];
    let (hub, roller, cage) = (55.29, 22.86, 101.6);
    let ratio = (hub + roller) / (cage - roller);
    let steep = 1.0 / (libm::sqrt(1.0 - ratio * ratio) * (cage - roller));
    let slopes = [steep, 0.5 * steep * (1.0 + ratio), 0.5 * steep * (1.0 + ratio), steep * ratio];
    let weights = slopes.iter().map(|slope| Power::Two.of(slope / 0.035)).collect();
    let found = solve(&processes, &[Row { power: Power::Two, weights }]).unwrap();
    assert!((found.cost - 24.46243).abs() < 1e-4, "{found:?}");
    assert_eq!(found.processes, [2, 1, 0, 2]);
    for (t, expected) in found.tolerances.iter().zip([0.173842, 0.166160, 0.128409, 0.2]) {
        assert!((t - expected).abs() < 1e-6, "{found:?}");
    }
}

/// A gap of 0.020 ± 0.015 in; three bought parts have tolerances of their own.
#[test]
fn the_shaft_and_its_housing() {
    let laws = [(0.15997, 0.43899), (0.07202, 0.46823), (0.12576, 0.46537), (0.07202, 0.46823)];
    let processes = laws.map(|(b, k)| vec![process(1.0, b, k, range(1e-4, 0.1))]);
    let bought: f64 = [0.0015, 0.0025, 0.0025].iter().map(|t| t * t).sum();
    let budget = 0.015 * 0.015 - bought;
    let found = solve(&processes, &[Row { power: Power::Two, weights: vec![1.0 / budget; 4] }]).unwrap();
    assert!((found.cost - 8.05361).abs() < 1e-4, "{found:?}");
    for (t, expected) in found.tolerances.iter().zip([0.00811423, 0.00638180, 0.00793439, 0.00638180]) {
        assert!((t - expected).abs() < 1e-8, "{found:?}");
    }
}

/// A random program: up to three processes a tolerance; `lists` gives them few values instead of ranges.
fn random(number: u64, items: usize, rows: usize, lists: bool) -> (Vec<Vec<Process>>, Vec<Row>) {
    let mut stream = unit_stream(7, number);
    let mut uniform = |low: f64, high: f64| low + (high - low) * (stream.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let mut processes = Vec::new();
    for _ in 0..items {
        // Few enough values for all combinations to be tried.
        let most: f64 = if !lists {
            4.0
        } else if items > 7 {
            1.5
        } else {
            3.0
        };
        let count = uniform(1.0, most) as usize;
        let mut low = uniform(0.01, 0.1);
        let mut of_item = Vec::new();
        for k in 0..count {
            let high = low * uniform(1.5, 4.0);
            let values = if lists { Values::List(vec![low, high]) } else { range(low, high) };
            low = uniform(0.5, 1.2) * high;
            let fixed = uniform(0.0, 5.0) + 2.0 * (count - k) as f64;
            let (factor, power) = (uniform(0.01, 0.6), uniform(0.4, 2.0));
            let law = match uniform(0.0, 4.0) as usize {
                0 => Law::Exponential { fixed, factor: 5.0 * factor, unit: uniform(0.03, 0.3) },
                1 => Law::Reciprocal { fixed, factor, unit: 1.0, power },
                _ => Law::Reciprocal { fixed, factor, unit: 1.0, power: 1.0 },
            };
            of_item.push(Process { name: String::new(), law, values });
        }
        processes.push(of_item);
    }
    let rows = (0..rows).map(|_| {
        let power = if uniform(0.0, 2.0) < 1.0 { Power::One } else { Power::Two };
        let mut row = Row { power, weights: (0..items).map(|_| power.of(uniform(0.1, 2.0))).collect() };
        let [tight, wide] = [0, 1].map(|end| row.usage(&ends(&processes, end)));
        let budget = tight + uniform(-0.08, 0.8) * (wide - tight);
        row.weights.iter_mut().for_each(|weight| *weight /= budget);
        row
    });
    let rows = rows.collect();
    (processes, rows)
}

/// The tightest (0) or widest (1) tolerances.
fn ends(processes: &[Vec<Process>], end: usize) -> Vec<f64> {
    let of = |list: &Vec<Process>| {
        let ends = list.iter().map(|process| process.values.ends()[end]);
        if end == 0 { ends.fold(f64::INFINITY, f64::min) } else { ends.fold(0.0, f64::max) }
    };
    processes.iter().map(of).collect()
}

fn solve(processes: &[Vec<Process>], rows: &[Row]) -> Option<Solution> {
    let found = Program { processes: processes.iter().map(Vec::as_slice).collect(), rows: rows.to_vec(), near: None }
        .solve()?;
    // It is what it says, and can be made.
    let cost: f64 = (0..processes.len()).map(|i| processes[i][found.processes[i]].law.cost(found.tolerances[i])).sum();
    assert!((cost / found.cost - 1.0).abs() < 1e-12);
    for (i, t) in found.tolerances.iter().enumerate() {
        match &processes[i][found.processes[i]].values {
            Values::Range([low, high]) => assert!((low..=high).contains(&t)),
            Values::List(values) => assert!(values.contains(t)),
        }
    }
    assert!(rows.iter().all(|row| row.usage(&found.tolerances) <= 1.0 + 1e-11), "{found:?}");
    assert!(found.bound <= found.cost && found.bound >= found.cost * (1.0 - 2e-8), "not the cheapest: {found:?}");
    Some(found)
}

/// The least cost of all combinations of listed values.
fn by_enumeration(processes: &[Vec<Process>], rows: &[Row]) -> Option<f64> {
    let candidates: Vec<Vec<(f64, f64)>> = processes
        .iter()
        .map(|list| {
            let values = |process: &Process| match &process.values {
                Values::List(values) => values.iter().map(|t| (*t, process.law.cost(*t))).collect::<Vec<_>>(),
                Values::Range(_) => unreachable!("only lists are enumerated"),
            };
            list.iter().flat_map(values).collect()
        })
        .collect();
    let (mut digits, mut best) = (vec![0; candidates.len()], f64::INFINITY);
    loop {
        let chosen = || candidates.iter().zip(&digits).map(|(list, digit): (&Vec<(f64, f64)>, &usize)| list[*digit]);
        let tolerances: Vec<f64> = chosen().map(|(t, _)| t).collect();
        if rows.iter().all(|row| row.usage(&tolerances) <= 1.0 + 1e-12) {
            best = best.min(chosen().map(|(_, cost)| cost).sum());
        }
        let Some(next) = (0..digits.len()).find(|i| digits[*i] + 1 < candidates[*i].len()) else { break };
        digits[..next].fill(0);
        digits[next] += 1;
    }
    best.is_finite().then_some(best)
}

/// A lower and an upper bound of the least cost under one row, by dynamic programming over cells of tolerances and of the
/// budget: a cell costs what its wide end does and uses what its tight end does, rounded down; and the other way round.
fn by_grid(processes: &[Vec<Process>], row: &Row) -> [f64; 2] {
    const CELLS: usize = 400;
    const PARTS: usize = 24;
    let mut least = [vec![0.0; CELLS + 1], vec![0.0; CELLS + 1]];
    for (item, list) in processes.iter().enumerate() {
        let mut next = [vec![f64::INFINITY; CELLS + 1], vec![f64::INFINITY; CELLS + 1]];
        for process in list {
            let [low, high] = process.values.ends();
            for part in 0..PARTS {
                let [tight, wide] = [part, part + 1].map(|part| low + (high - low) * part as f64 / PARTS as f64);
                let used = |t: f64| row.weights[item] * row.power.of(t) * CELLS as f64;
                let pairs = [
                    (process.law.cost(wide), libm::floor(used(tight) * (1.0 - 1e-12)) as usize),
                    (process.law.cost(tight), libm::ceil(used(tight)) as usize),
                ];
                for ((next, least), (cost, cells)) in next.iter_mut().zip(&least).zip(pairs) {
                    for at in cells..=CELLS {
                        next[at] = next[at].min(least[at - cells] + cost);
                    }
                }
            }
        }
        least = next;
    }
    least.map(|least| least[CELLS])
}

/// A thousand programs of 1 to 12 tolerances: one row and ranges against a grid, several rows and lists of values against all
/// combinations; those with ranges under several rows have their bound to show, as all have.
#[test]
fn a_thousand_random_programs() {
    let (mut infeasible, mut widths) = (0, Vec::new());
    for number in 0..1000 {
        let items = 1 + (number % 12) as usize;
        match number % 3 {
            0 => {
                let (processes, rows) = random(number, items, 1 + (number % 4) as usize, true);
                match (solve(&processes, &rows), by_enumeration(&processes, &rows)) {
                    (None, None) => infeasible += 1,
                    (Some(found), Some(best)) => assert!((found.cost / best - 1.0).abs() < 1e-7, "{number}"),
                    (found, best) => panic!("{number}: {found:?} {best:?}"),
                }
            }
            1 => {
                let (processes, rows) = random(number, items, 1, false);
                let [lower, upper] = by_grid(&processes, &rows[0]);
                let Some(found) = solve(&processes, &rows) else {
                    assert!(upper.is_infinite() && rows[0].usage(&ends(&processes, 0)) > 1.0, "{number}");
                    infeasible += 1;
                    continue;
                };
                assert!(
                    lower <= found.cost && found.cost <= upper * (1.0 + 1e-12),
                    "{number}: {lower} {found:?} {upper}"
                );
                if upper.is_finite() {
                    widths.push(upper / lower - 1.0);
                }
            }
            _ => {
                let (processes, rows) = random(number, items, 2 + (number % 3) as usize, false);
                let within = rows.iter().all(|row| row.usage(&ends(&processes, 0)) <= 1.0);
                assert_eq!(solve(&processes, &rows).is_some(), within, "{number}");
            }
        }
    }
    let width = widths.iter().sum::<f64>() / widths.len() as f64;
    assert!(infeasible > 40 && widths.len() > 250 && width < 0.05, "{infeasible} {} {width}", widths.len());
}
