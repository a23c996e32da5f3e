//! What was found, for tables and for machines.

use serde::Serialize;
use slipfit_tolerance::{
    allocate::{
        check::{Check, Checked},
        confirm::{Confirmed, Counted},
        curve::{LEVELS, Point},
        requirement::{Kind, Requirement, Row},
        search::Found,
    },
    model::Model,
    number::{fixed, three_digits},
    product::{Product, costed::Costed},
};

use super::tolerances::DIGITS;
use crate::{
    population::uncertain::answer::Answer,
    scene::{callout, tolerance},
};

/// Prices below this share of the cost are rounding.
const NOTHING: f64 = 1e-12;
/// How far the cost may be above its bound (share of it) without a warning.
const PROVEN: f64 = 1e-6;
/// How far the middle of a measure may be off that of its limits (share of half their distance) without a warning.
const OFF_CENTRE: f64 = 0.05;

/// The cheapest tolerances.
#[derive(Serialize)]
pub struct Report {
    /// The scene's.
    pub title: String,
    /// Of all tolerances.
    pub cost: f64,
    /// No choice costs less, as far as the last linearisation goes; without one the cost of the widest tolerances.
    pub bound: f64,
    /// Cost of what the scene has now, where processes hold it.
    pub cost_before: Option<f64>,
    /// One a tolerance that was chosen.
    pub tolerances: Vec<Chosen>,
    /// What was required.
    pub requirements: Vec<Required>,
    /// What the cost falls by if all requirements that bind are loosened at once, where several do.
    pub price_together: Option<f64>,
    /// What the full model says of every measure with limits.
    pub check: Vec<Measured>,
    /// Units that were drawn for it.
    pub samples: u64,
    /// Share of these with all measures within their limits.
    pub good: Option<f64>,
    /// Other units that confirm the share of malfunctions, where that is required.
    pub malfunctions: Option<Confirmation>,
    /// What units do over all unknowns, where there are any and malfunction is limited.
    pub uncertain: Option<Unknown>,
    /// Cost against defects; empty unless it was asked for.
    pub curve: Vec<CurvePoint>,
    /// What to know before trusting it.
    pub warnings: Vec<String>,
}

/// What was found of the tolerances besides.
pub struct Checks {
    /// Of the measures.
    pub measures: Check,
    /// Other units that confirm the share of malfunctions, where that is required.
    pub confirmation: Option<Confirmation>,
    /// What units do over all unknowns.
    pub unknown: Option<Unknown>,
}

/// What units do with the tolerances found, over all unknowns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unknown {
    /// The share of them that may malfunction.
    pub allowed: f64,
    /// Whether no more do over the whole interval of 95 %.
    pub holds: bool,
    /// What they do.
    #[serde(flatten)]
    pub answer: Answer,
}

impl Unknown {
    /// Of an `answer`, where this share is `allowed`.
    pub fn new(answer: Answer, allowed: f64) -> Self {
        Self { allowed, holds: answer.malfunctions.interval[1] <= allowed, answer }
    }
}

/// Units that the search has not seen, and that confirm what is required of malfunction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Confirmation {
    /// All.
    pub units: u64,
    /// Those that malfunction.
    pub failed: u64,
    /// Their share.
    pub share: f64,
    /// What the share of the production is at most, with 95 % confidence.
    pub at_most: f64,
    /// The share that the search aimed at.
    pub target: f64,
    /// How many times tolerances were chosen, each counted in other units.
    pub rounds: u32,
}

impl Confirmation {
    /// Of what was confirmed.
    pub fn new(confirmed: &Confirmed<Found>) -> Self {
        let Confirmed { target, counted: Counted { failed, units }, at_most, rounds, .. } = *confirmed;
        Self { units, failed, share: failed as f64 / units as f64, at_most, target, rounds }
    }
}

/// A tolerance that was chosen.
#[derive(Serialize)]
pub struct Chosen {
    /// Name.
    pub name: String,
    /// In mm or degrees.
    pub tolerance: f64,
    /// mm or °.
    pub unit: &'static str,
    /// What the scene had.
    pub before: f64,
    /// Process, if it has a name.
    pub process: Option<String>,
    /// What it costs.
    pub cost: f64,
    /// As it stands in a scene.
    pub written: String,
    /// The part; null of a dimension that is of no part.
    pub part: Option<String>,
    /// The feature, or the dimension.
    pub feature: String,
    /// As it stands on a drawing.
    pub callout: String,
}

/// A requirement.
#[derive(Serialize)]
pub struct Required {
    /// The measure; null for all together.
    pub measure: Option<String>,
    /// What is required.
    pub requirement: &'static str,
    /// lower or upper, where each limit has a figure.
    pub side: Option<&'static str>,
    /// What was found: a tolerance or an extreme, ppm, Ppk, percent.
    pub found: f64,
    /// What is allowed.
    pub allowed: f64,
    /// Of both.
    pub unit: &'static str,
    /// What the cost falls by for what `price_of` says.
    pub price: f64,
    /// 1 % wider limits, or 10 % more defects.
    pub price_of: &'static str,
}

/// A measure by the full model.
#[derive(Serialize)]
pub struct Measured {
    /// Its name.
    pub name: String,
    /// mm, ° or none.
    pub unit: &'static str,
    /// Lowest and highest.
    pub worst_case: [f64; 2],
    /// Root sum of squares.
    pub rss: Option<f64>,
    /// Defects that this promises.
    pub rss_ppm: Option<f64>,
    /// Defects by importance sampling or subset simulation.
    pub ppm: Option<f64>,
    /// Its standard error.
    pub ppm_error: Option<f64>,
    /// Defects among the drawn units.
    pub counted_ppm: f64,
    /// Their 95 % interval.
    pub counted_interval: [f64; 2],
    /// Of the drawn units.
    pub ppk: Option<f64>,
}

/// A point of the curve.
#[derive(Serialize)]
pub struct CurvePoint {
    /// Units with any measure outside.
    pub ppm: f64,
    /// Cost of all tolerances.
    pub cost: f64,
    /// These, in the order of `tolerances`.
    pub tolerances: Vec<f64>,
}

/// As it is reported.
fn unit(costed: &Costed) -> (f64, &'static str) {
    (costed.quantity.factor(), costed.quantity.unit())
}

impl Report {
    /// Of what was `found` and `checked` of a product.
    pub fn new(
        title: &str,
        product: &Product,
        rows: &[Row],
        found: &Found,
        checks: Checks,
        points: Vec<Point>,
    ) -> Self {
        let Checks { measures: checked, confirmation, unknown } = checks;
        let solution = &found.solution;
        let tightest = points.last().filter(|_| points.len() < LEVELS.len());
        let out_of_reach = tightest.map(|point| format!("fewer defects than {} ppm are out of reach", point.ppm));
        let chosen = product.costed.iter().zip(&solution.tolerances).zip(&solution.processes);
        let chosen = chosen.map(|((costed, t), process)| {
            let (factor, unit) = unit(costed);
            let process = &costed.processes[*process];
            Chosen {
                name: costed.name.clone(),
                tolerance: t * factor,
                unit,
                before: costed.stated * factor,
                process: (!process.name.is_empty()).then(|| process.name.clone()),
                cost: process.law.cost(*t),
                written: format!("{} = {}", costed.written.key, tolerance(costed, *t, DIGITS)),
                part: costed.callout.part.clone(),
                feature: costed.callout.feature.clone(),
                callout: callout(costed, *t, DIGITS),
            }
        });
        let in_units = |tolerances: &[f64]| {
            product.costed.iter().zip(tolerances).map(|(costed, t)| t * unit(costed).0).collect::<Vec<_>>()
        };
        let required = rows.iter().zip(&found.figures).zip(&solution.prices);
        let required = required.map(|((row, figure), price)| {
            let price = price * row.relief();
            let price = if price > NOTHING * solution.cost { price } else { 0.0 };
            Required::new(&product.model, row, *figure, price)
        });
        Self {
            title: title.into(),
            cost: solution.cost,
            bound: solution.bound,
            cost_before: product.costed.iter().map(before).sum(),
            tolerances: chosen.collect(),
            requirements: required.collect(),
            price_together: found.together,
            check: checked.measures.iter().map(|of| Measured::new(&product.model, of, checked.units)).collect(),
            samples: checked.units,
            good: checked.good.map(|good| good.value),
            malfunctions: confirmation,
            uncertain: unknown,
            curve: points
                .into_iter()
                .map(|point| CurvePoint { ppm: point.ppm, cost: point.cost, tolerances: in_units(&point.tolerances) })
                .collect(),
            warnings: product
                .warnings
                .iter()
                .cloned()
                .chain(off_centre(&product.model, rows))
                .chain(unproven(rows, found))
                .chain(out_of_reach)
                .collect(),
        }
    }
}

/// Why cheaper tolerances may exist.
fn unproven(rows: &[Row], Found { solution, traded, .. }: &Found) -> Option<String> {
    // Among units that are counted nothing is proven.
    if rows.iter().any(|row| matches!(row.requirement.kind, Kind::Malfunction { .. })) {
        return None;
    }
    if *traded {
        return Some(
            "a measure with kinks or much curvature: tolerances were traded against each other until no trade saved anything; others, \
             far from these, may be cheaper"
                .into(),
        );
    }
    (solution.bound < solution.cost * (1.0 - PROVEN)).then(|| {
        let least = three_digits(solution.bound);
        format!("too many processes and steps to try them all: tolerances for {least} or more may be cheaper")
    })
}

/// Cost of what the scene has now, by the cheapest process that holds it.
fn before(costed: &Costed) -> Option<f64> {
    let holds = costed.processes.iter().filter(|process| {
        let [low, high] = process.values.ends();
        low * (1.0 - 1e-12) <= costed.stated && costed.stated <= high * (1.0 + 1e-12)
    });
    holds.map(|process| process.law.cost(costed.stated)).reduce(f64::min)
}

/// RSS takes for granted that the middle of a measure is that of its limits.
fn off_centre(model: &Model, rows: &[Row]) -> Vec<String> {
    let of = |row: &Row| {
        let Requirement { measure: Some(i), kind: Kind::Rss } = row.requirement else { return None };
        let [Some(lower), Some(upper)] = model.measures[i].limits else { return None };
        let off = (row.middle() - 0.5 * (lower + upper)).abs() / (0.5 * (upper - lower));
        (off > OFF_CENTRE).then(|| {
            let (name, percent) = (&model.measures[i].name, fixed(off * 100.0, 0));
            format!(
                "the middle of {name} is off that of its limits by {percent} % of half their distance, which rss does not \
                 count: rss-off-centre does"
            )
        })
    };
    rows.iter().filter_map(of).collect()
}

impl Required {
    /// Of a figure.
    pub fn new(model: &Model, row: &Row, figure: f64, price: f64) -> Self {
        let of = row.requirement.measure.map(|i| &model.measures[i]);
        let shown = row.shown(figure);
        let (factor, unit) = match (row.requirement.kind, of) {
            (Kind::Defects(_), _) => (1.0, "ppm"),
            (Kind::Malfunction { .. }, _) => (1.0, "%"),
            (Kind::Ppk(_), _) | (_, None) => (1.0, ""),
            (_, Some(measure)) => (measure.quantity.factor(), measure.quantity.unit()),
        };
        Self {
            measure: of.map(|measure| measure.name.clone()),
            requirement: match row.requirement.kind {
                Kind::WorstCase => "worst-case",
                Kind::Rss => "rss",
                Kind::RssOffCentre => "rss-off-centre",
                Kind::Defects(_) => "ppm",
                Kind::Ppk(_) => "ppk",
                Kind::Malfunction { .. } => "malfunction",
            },
            side: row.side.map(|side| ["lower", "upper"][side]),
            found: shown.found * factor,
            allowed: shown.allowed * factor,
            unit,
            price,
            price_of: match row.requirement.kind {
                Kind::Defects(_) => "10 % more ppm",
                Kind::Malfunction { .. } => "10 % more malfunctions",
                _ => "1 % wider limits",
            },
        }
    }
}

impl Measured {
    fn new(model: &Model, checked: &Checked, units: u64) -> Self {
        let measure = &model.measures[checked.measure];
        let (factor, unit) = (measure.quantity.factor(), measure.quantity.unit());
        Self {
            name: measure.name.clone(),
            unit,
            worst_case: checked.worst_case.map(|value| value * factor),
            rss: checked.rss.map(|rss| rss * factor),
            rss_ppm: checked.by_rss.map(|share| share * 1e6),
            ppm: checked.by_tails.map(|[share, _]| share * 1e6),
            ppm_error: checked.by_tails.map(|[_, error]| error * 1e6),
            counted_ppm: checked.counted as f64 / units as f64 * 1e6,
            counted_interval: checked.interval.map(|end| end * 1e6),
            ppk: checked.ppk.map(|ppk| ppk.value),
        }
    }
}
