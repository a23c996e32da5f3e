//! The gaps: those of a slide with what follows from them at a tolerance level, those of a mechanism by their joints.

use maud::{Markup, html};
use slipfit_core::clearance::GapStatistics;

use super::html::{columns, group, mm, optional, real, row, table, tall, typed};
use crate::{
    mechanism::{
        Gap, JointKind, Mechanism,
        closing::{Pair, Pin, Table2, Toes, derived},
    },
    setup::{SURFACES, Scene},
};

/// Whose gaps are shown.
#[derive(Clone, Copy)]
pub enum Clearances<'a> {
    /// Those of a slide's pins.
    Pins {
        /// The slide.
        scene: &'a Scene,
        /// The tolerance level at which their sums and differences are shown.
        n: f64,
    },
    /// Those of a mechanism's joints.
    Joints(&'a Mechanism),
}

/// The section of the page; `computed` if the gaps follow from a product.
pub fn section(clearances: &Clearances, computed: bool) -> Markup {
    let tables = match clearances {
        Clearances::Pins { scene, n } => html! { (given(scene, computed)) (derived_columns(&derived(scene, *n))) },
        Clearances::Joints(mechanism) if mechanism.gaps.is_empty() => return Markup::default(),
        Clearances::Joints(mechanism) => of_joints(mechanism),
    };
    html! { h2 { "Clearances" } (tables) }
}

/// What closes first, if anything does.
pub fn first_to_close(clearances: &Clearances) -> Option<(&'static str, String)> {
    let (what, name, n) = match clearances {
        Clearances::Pins { scene, n } => {
            let (n, pairs) = derived(scene, *n).first_to_close()?;
            ("First pair to close", pairs, n)
        }
        Clearances::Joints(mechanism) => {
            let (joint, n) = mechanism.first_to_close()?;
            ("First to lose its play", joint, n)
        }
    };
    Some((what, format!("{name}, at n* = {}", real(n, 4))))
}

/// The gaps of a mechanism's joints.
fn of_joints(mechanism: &Mechanism) -> Markup {
    let of = |gap: &Gap| {
        let GapStatistics { mean, deviation } = gap.statistics;
        row(&gap.name, [mm(Some(mean)), mm(Some(deviation)), optional(gap.closes_at(), 3)])
    };
    // Only in a track do two gaps face each other.
    let pairs = mechanism.joints.iter().any(|joint| matches!(joint.kind, JointKind::Track { .. }));
    let of_pairs = if pairs { " alone; a pair closes when both are gone" } else { "" };
    let caption = format!(
        "The gaps of every joint with play over the production (mm); n* is the level that closes it{of_pairs}."
    );
    let head = html! { tr { (columns(&["gap", "mean", "σ", "n*"])) } };
    table(&caption, head, mechanism.gaps.iter().map(of))
}

/// The gaps as the dynamics use them; `computed` if they follow from a product.
fn given(scene: &Scene, computed: bool) -> Markup {
    let head = html! {
        tr { (tall("pin")) @for surface in SURFACES { (group(surface, 2)) } }
        tr.sub { @for _ in SURFACES { (columns(&["mean", "σ"])) } }
    };
    let cells = |gap: &Option<GapStatistics<f64>>| [gap.map(|gap| gap.mean), gap.map(|gap| gap.deviation)].map(mm);
    let rows = scene.pins.iter().map(|pin| row(&pin.name, pin.gaps.iter().flat_map(cells)));
    let source =
        if computed { ": moments of second order of the product's measures, which the dynamics use" } else { "" };
    table(&format!("The gaps of every pin over the production (mm){source}."), head, rows)
}

/// Table 2's derived columns and toe-outs.
fn derived_columns(derived: &Table2) -> Markup {
    let n = typed(derived.n);
    let of_pair = ["clearance", "mean", "n*"];
    let head = html! {
        tr { (tall("pin")) (group("gap", SURFACES.len())) (group("across", 3)) (group("up-down", 3)) }
        tr.sub { (columns(&SURFACES)) (columns(&of_pair)) (columns(&of_pair)) }
    };
    let pair = |pair: Option<Pair>| {
        let closes_at = optional(pair.and_then(|pair| pair.closes_at), 3);
        [mm(pair.map(|pair| pair.clearance)), mm(pair.map(|pair| pair.mean)), closes_at]
    };
    let of = |pin: &Pin| row(&pin.name, pin.gaps.map(mm).into_iter().chain(pair(pin.across)).chain(pair(pin.up_down)));
    let first = derived
        .first_to_close()
        .map_or_else(String::new, |(n, pairs)| format!(" The product's is the least, {}: {pairs}.", real(n, 4)));
    let caption = format!(
        "At n = {n} (mm): clearance is the sum of a pair's gaps, mean half their difference; n* is the level that closes \
         the pair.{first}"
    );
    html! {
        (table(&caption, head, derived.pins.iter().map(of)))
        (toe_outs(&n, [("across", derived.toes_across), ("up-down", derived.toes_up_down)]))
    }
}

fn toe_outs(n: &str, directions: [(&str, Option<Toes>); 2]) -> Markup {
    let head = html! {
        tr { (tall("toe-out")) (group("right − left", 3)) (group("front − back", 3)) }
        tr.sub { (columns(&["back", "front", "front − back", "left", "right", "right − left"])) }
    };
    let of = |(name, toes): (&str, Option<Toes>)| {
        let Toes { back, front, left, right, front_minus_back, right_minus_left } = toes?;
        Some(row(name, [back, front, front_minus_back, left, right, right_minus_left].map(|toe| mm(Some(toe)))))
    };
    let rows: Vec<_> = directions.into_iter().filter_map(of).collect();
    let caption = format!("Toe-outs at n = {n} (mm): differences of the means, subtracted before rounding.");
    html! { @if !rows.is_empty() { (table(&caption, head, rows)) } }
}
