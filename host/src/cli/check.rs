//! `slipfit check`: is the scene sound, what is left free, when does a gap close.

use std::{fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;
use slipfit_core::slide::CONTACTS;
use slipfit_tolerance::{
    number::{fixed, level},
    product::Product,
};

use super::{
    arguments::SceneArguments,
    failure::Failure,
    mechanism,
    self_locking::self_locking,
    terminal::{print, print_json, text_table, warn},
};
use crate::{
    dynamics::sweep::classes,
    mechanism::{
        closing::derived,
        mobility::{contacts, degrees_of_freedom, rank_of_normals},
        self_locking::{DriveSide, Guide, guide},
    },
    setup::Scene,
};

/// Checks a scene: degrees of freedom, gaps at a level, levels that close them, warnings.
///
/// Of a product without a slide or mechanism it prints the nominal values of the measures. Warnings do not change the exit code.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Tolerance level at which the gaps are shown; positive is tighter.
    #[arg(long, default_value_t = 0.0, allow_hyphen_values = true)]
    n: f64,
    /// Draws a mechanism with its joints and gaps as SVG; not for slides.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

#[derive(Serialize)]
struct Findings {
    title: String,
    parts: u32,
    n_cl: u32,
    degrees_of_freedom: i64,
    normal_law: &'static str,
    friction_law: &'static str,
    kernel_why: String,
    n: f64,
    gaps: Vec<GapReport>,
    n_star: Vec<Closing>,
    guide: Option<Guide>,
    warnings: Vec<String>,
}

/// A product without a slide.
#[derive(Serialize)]
struct ProductFindings {
    title: String,
    measures: Vec<Nominal>,
    warnings: Vec<String>,
}

/// A measure at the drawing's nominal values.
#[derive(Serialize)]
struct Nominal {
    name: String,
    nominal: f64,
    unit: &'static str,
}

/// A pair of gaps and the level that closes it.
#[derive(Clone, Serialize)]
struct Closing {
    pin: String,
    pair: String,
    n: f64,
}

/// A gap at a tolerance level.
#[derive(Serialize)]
pub(super) struct GapReport {
    /// Pin and surface.
    pub name: String,
    /// Gap (mm).
    pub mm: f64,
    /// Compressed, zero or free.
    pub class: String,
}

/// The `gaps` (m) that the scene has, with names and classes.
pub(super) fn gap_reports(scene: &Scene, gaps: &[f64; CONTACTS]) -> Vec<GapReport> {
    let named = scene.contact_names().into_iter().zip(gaps).zip(classes(gaps));
    named
        .filter_map(|((name, gap), class)| Some(GapReport { name, mm: gap * 1e3, class: class?.to_string() }))
        .collect()
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        if !self.n.is_finite() {
            return Err(Failure::Input(format!("--n is {}, allowed is any finite number", self.n)));
        }
        let file = self.scene.load_file(&[])?;
        let of_product = file.product.as_ref().map(|product| product.warnings.clone()).unwrap_or_default();
        if let Some(found) = &file.mechanism {
            return mechanism::check(found, self.n, of_product, &self.scene, self.plot.as_deref());
        }
        if self.plot.is_some() {
            return Err(Failure::Input("--plot draws mechanisms of bodies and joints, and this scene has none".into()));
        }
        if let Some(slide) = &file.slide {
            slide.check_gaps(&[self.n; CONTACTS]).map_err(|error| Failure::Input(format!("--n: {error}")))?;
            let mut findings = find(slide, self.n);
            findings.warnings.extend(of_product);
            if self.scene.json {
                return print_json(&findings);
            }
            print(&describe(&findings))?;
            warn(&findings.warnings);
            return Ok(());
        }
        let measures = file.product.map(nominal).unwrap_or_default();
        let findings = ProductFindings { title: file.title, measures, warnings: of_product };
        if self.scene.json {
            return print_json(&findings);
        }
        print(&describe_product(&findings))?;
        warn(&findings.warnings);
        Ok(())
    }
}

fn nominal(product: Product) -> Vec<Nominal> {
    let values = product.nominal_measures();
    let measures = product.model.measures.into_iter().zip(values);
    let nominal = measures.map(|(measure, value)| Nominal {
        name: measure.name,
        nominal: value * measure.quantity.factor(),
        unit: measure.quantity.unit(),
    });
    nominal.collect()
}

fn describe_product(findings: &ProductFindings) -> String {
    let row = |measure: &Nominal| vec![measure.name.clone(), fixed(measure.nominal, 4), measure.unit.into()];
    let rows: Vec<_> = findings.measures.iter().map(row).collect();
    format!("{}\n\n{}", findings.title, text_table(&["measure", "nominal", "unit"], &rows))
}

fn find(scene: &Scene, n: f64) -> Findings {
    let n_cl = rank_of_normals(&contacts(scene));
    let gaps = scene.gaps_at(&[n; CONTACTS]);
    let table = derived(scene, n);
    let mut n_star: Vec<Closing> =
        table.closures().map(|c| Closing { pin: c.pin.into(), pair: c.direction.to_string(), n: c.n }).collect();
    n_star.sort_by(|a, b| a.n.total_cmp(&b.n));
    let guide = guide(scene, n);
    let (normal_law, friction_law, kernel_why) = kernel(scene);
    Findings {
        title: scene.title.clone(),
        parts: 2,
        n_cl,
        degrees_of_freedom: degrees_of_freedom(2, &[], n_cl),
        normal_law,
        friction_law,
        kernel_why,
        n,
        gaps: gap_reports(scene, &gaps),
        warnings: warnings_of(scene),
        n_star,
        guide,
    }
}

/// The kernel's laws from the menu, and why these.
fn kernel(scene: &Scene) -> (&'static str, &'static str, String) {
    use slipfit_core::menu::{FrictionType, NormalType};
    let (normal, cost) = match scene.contact.normal_type() {
        NormalType::Linear => ("linear", "no root"),
        NormalType::ThreeHalves => ("three-halves", "one square root a contact"),
        NormalType::Power => ("power", "a general power a contact"),
    };
    let (friction, why) = match scene.friction.friction_type() {
        FrictionType::Frictionless => ("none", "no friction code at all"),
        FrictionType::Regularised => ("regularised", "Coulomb friction smoothed over the stick band"),
        FrictionType::Exact => ("exact", "Coulomb friction with true stick"),
    };
    (normal, friction, format!("exponent {} needs {cost}; friction: {why}", scene.contact.exponent))
}

/// What a designer should know of `scene` before trusting a run.
pub(super) fn warnings_of(scene: &Scene) -> Vec<String> {
    let mut warnings = scene.warnings.clone();
    warnings.extend(self::warnings(rank_of_normals(&contacts(scene)), guide(scene, 0.0).as_ref()));
    warnings.extend(clearance_note(scene));
    warnings
}

fn warnings(n_cl: u32, guide: Option<&Guide>) -> Vec<String> {
    let mut warnings = Vec::new();
    match degrees_of_freedom(2, &[], n_cl) {
        1 => {}
        n if n < 1 => warnings.push(format!(
            "{n} degrees of freedom are left: the contacts hold the slide, so that it cannot travel; leave contacts out"
        )),
        n => warnings.push(format!(
            "{n} degrees of freedom are left: more than the travel is free, so that the slide may swing or fall; add contacts"
        )),
    }
    if let Some(guide) = guide.filter(|guide| guide.warn) {
        let critical = guide.critical_friction.unwrap_or(f64::INFINITY);
        let meaning = match guide.side {
            DriveSide::Beyond => "no force moves the slide",
            _ => "the drive passes on the line of the other resistances, so that the least offset outwards locks it",
        };
        let across = (guide.drive_distance > 1e-9).then_some(([guide.length, guide.drive_distance], "beside"));
        let height = guide.height.map(|lever| ([lever.length, lever.distance], "above or below"));
        let levers: Vec<_> = across.into_iter().chain(height).collect();
        warnings.push(self_locking(guide.friction, critical, 0.0, &levers, meaning));
    }
    warnings
}

/// Where the scene's clearances are not those that its gaps add up to.
fn clearance_note(scene: &Scene) -> Option<String> {
    let nominal = scene.nominal_clearance?;
    let pins = derived(scene, 0.0).pins;
    let across: Vec<f64> = pins.iter().filter_map(|pin| Some(pin.across?.clearance)).collect();
    let up_down: Vec<f64> = pins.iter().filter_map(|pin| Some(pin.up_down?.clearance)).collect();
    let contradicts = |(pair, nominal, sums): (&str, f64, Vec<f64>)| {
        let [least, greatest] = [f64::min, f64::max].map(|pick| sums.iter().copied().reduce(pick).unwrap_or(nominal));
        let off = (least - nominal).abs().max((greatest - nominal).abs());
        let [nominal, least, greatest] = [(nominal, 2), (least, 4), (greatest, 4)].map(|(x, n)| fixed(x * 1e3, n));
        (off > 0.005e-3).then(|| format!("{nominal} mm {pair} where its gaps add up to {least} to {greatest} mm"))
    };
    let found: Vec<String> = [("across", nominal[0], across), ("up-down", nominal[1], up_down)]
        .into_iter()
        .filter_map(contradicts)
        .collect();
    let stated = found.join(", and ");
    (!found.is_empty()).then(|| format!("the scene states a clearance of {stated}: the simulation uses the gaps"))
}

/// Whether the slide locks, in words.
fn locking(guide: &Guide) -> String {
    let friction = guide.friction;
    let Some(critical) = guide.critical_friction else {
        return "Self-locking: no, the drive passes through the guide line.".into();
    };
    let [critical, locks] = [fixed(critical, 4), if guide.warn { "yes" } else { "no" }.to_owned()];
    let reaches = if guide.height.is_some() { "1/(2·Σ b/L)" } else { "L/(2b)" };
    match guide.side {
        DriveSide::Beyond => format!(
            "Self-locking: {locks}, the drive passes beyond the other resistances and locks where friction reaches \
             {reaches} = {critical}; here it is {friction}."
        ),
        DriveSide::Edge => format!(
            "Self-locking: on the edge, the drive passes on the line of the other resistances; any offset outwards locks \
             it where friction reaches {reaches} = {critical}; here it is {friction}."
        ),
        DriveSide::Short => "Self-locking: no, the drive passes short of the other resistances and never locks.".into(),
    }
}

fn describe(findings: &Findings) -> String {
    let mut text = String::new();
    let n_cl = findings.n_cl;
    let freedom = findings.degrees_of_freedom;
    let _ = writeln!(text, "{}\n", findings.title);
    let _ = writeln!(text, "Degrees of freedom  6·(2 − 1) − 0 − {n_cl} = {freedom}   (n_cl = {n_cl}, n = {freedom})");
    let _ = writeln!(text, "Kernel              {}", findings.kernel_why);
    let rows: Vec<_> =
        findings.gaps.iter().map(|gap| vec![gap.name.clone(), fixed(gap.mm, 4), gap.class.clone()]).collect();
    let heading = format!("gap at n = {}", level(findings.n));
    let _ = writeln!(text, "\n{}", text_table(&[&heading, "mm", "class"], &rows));
    let rows: Vec<_> = findings.n_star.iter().map(|c| vec![format!("{} {}", c.pin, c.pair), fixed(c.n, 4)]).collect();
    let _ = writeln!(text, "{}", text_table(&["pair", "closes at n*"], &rows));
    if let Some(closing) = findings.n_star.first() {
        let _ = writeln!(text, "The product closes at n* = {}: {} {}", fixed(closing.n, 4), closing.pin, closing.pair);
    }
    if let Some(guide) = &findings.guide {
        let _ = writeln!(
            text,
            "Guide line at x = {} mm, {} mm long, driven {} mm beside it{}.\n{}",
            fixed(guide.line_x * 1e3, 1),
            fixed(guide.length * 1e3, 1),
            fixed(guide.drive_distance * 1e3, 1),
            guide.height.map_or_else(String::new, |lever| format!(
                " and {} mm above or below guides {} mm long",
                fixed(lever.distance.abs() * 1e3, 1),
                fixed(lever.length * 1e3, 1)
            )),
            locking(guide)
        );
    }
    text
}
