//! The gaps: those of a slide with what follows from them at a tolerance level, those of a mechanism by their joints.

use slipfit_core::clearance::GapStatistics;

use super::{
    Clearances,
    html::{mm, optional, real, table, tr, typed},
};
use crate::{
    mechanism::{
        Gap, Mechanism,
        closing::{Pair, Pin, Table2, Toes, derived},
    },
    scene::{SURFACES, Scene},
    show::markup::escape,
};

/// The section of the page; `computed` if the gaps follow from a product.
pub fn section(clearances: &Clearances, computed: bool) -> String {
    match clearances {
        Clearances::Pins { scene, n } => given(scene, computed) + &derived_columns(&derived(scene, *n)),
        Clearances::Joints(mechanism) => of_joints(mechanism),
    }
}

/// What closes first, if anything does.
pub fn first_to_close(clearances: &Clearances) -> Option<(&'static str, String)> {
    match clearances {
        Clearances::Pins { scene, n } => {
            let (n, pairs) = derived(scene, *n).first_to_close()?;
            Some(("First pair to close", format!("{}, at n* = {}", escape(&pairs), real(n, 4))))
        }
        Clearances::Joints(mechanism) => {
            let (joint, n) = mechanism.first_to_close()?;
            Some(("First to lose its play", format!("{}, at n* = {}", escape(&joint), real(n, 4))))
        }
    }
}

/// The gaps of a mechanism's joints.
fn of_joints(mechanism: &Mechanism) -> String {
    let head = "<tr><th scope=\"col\">gap</th><th scope=\"col\">mean</th><th scope=\"col\">σ</th>\
        <th scope=\"col\">n*</th></tr>\n";
    let row = |gap: &Gap| {
        let GapStatistics { mean, deviation } = gap.statistics;
        tr(&escape(&gap.name), &[mm(Some(mean)), mm(Some(deviation)), optional(gap.closes_at(), 3)])
    };
    let caption = "The gaps of every joint with play over the production (mm); n* is the level that closes it.";
    let rows: String = mechanism.gaps.iter().map(row).collect();
    if rows.is_empty() { rows } else { format!("<h2>Clearances</h2>\n{}", table(caption, head, &rows)) }
}

/// The gaps as the dynamics use them; `computed` if they follow from a product.
fn given(scene: &Scene, computed: bool) -> String {
    let mut head = "<tr><th scope=\"col\" rowspan=\"2\">pin</th>".to_owned();
    head.extend(SURFACES.map(|surface| format!("<th scope=\"colgroup\" colspan=\"2\">{surface}</th>")));
    head.push_str("</tr>\n<tr class=\"sub\">");
    head.push_str(&"<th scope=\"col\">mean</th><th scope=\"col\">σ</th>".repeat(SURFACES.len()));
    head.push_str("</tr>\n");
    let cells = |gap: &Option<GapStatistics<f64>>| [gap.map(|gap| gap.mean), gap.map(|gap| gap.deviation)].map(mm);
    let rows: String = scene
        .pins
        .iter()
        .map(|pin| tr(&escape(&pin.name), &pin.gaps.iter().flat_map(cells).collect::<Vec<_>>()))
        .collect();
    let source =
        if computed { ": moments of second order of the product's measures, which the dynamics use" } else { "" };
    let caption = format!("The gaps of every pin over the production (mm){source}.");
    format!("<h2>Clearances</h2>\n{}", table(&caption, &head, &rows))
}

/// Table 2's derived columns and toe-outs.
fn derived_columns(derived: &Table2) -> String {
    let n = typed(derived.n);
    let pair = "<th scope=\"col\">clearance</th><th scope=\"col\">mean</th><th scope=\"col\">n*</th>";
    let head = format!(
        "<tr><th scope=\"col\" rowspan=\"2\">pin</th><th scope=\"colgroup\" colspan=\"4\">gap</th>\
         <th scope=\"colgroup\" colspan=\"3\">across</th><th scope=\"colgroup\" colspan=\"3\">up-down</th></tr>\n\
         <tr class=\"sub\">{}{pair}{pair}</tr>\n",
        SURFACES.map(|surface| format!("<th scope=\"col\">{surface}</th>")).concat()
    );
    let pair = |pair: Option<Pair>| {
        let closes_at = optional(pair.and_then(|pair| pair.closes_at), 3);
        [mm(pair.map(|pair| pair.clearance)), mm(pair.map(|pair| pair.mean)), closes_at]
    };
    let row =
        |pin: &Pin| tr(&escape(&pin.name), &[&pin.gaps.map(mm)[..], &pair(pin.across), &pair(pin.up_down)].concat());
    let first = derived.first_to_close().map_or_else(String::new, |(n, pairs)| {
        format!(" The product's is the least, {}: {}.", real(n, 4), escape(&pairs))
    });
    let caption = format!(
        "At n = {n} (mm): clearance is the sum of a pair's gaps, mean half their difference; n* is the level that closes \
         the pair.{first}"
    );
    let toes = toe_outs(&n, [("across", derived.toes_across), ("up-down", derived.toes_up_down)]);
    table(&caption, &head, &derived.pins.iter().map(row).collect::<String>()) + &toes
}

fn toe_outs(n: &str, directions: [(&str, Option<Toes>); 2]) -> String {
    let head = "<tr><th scope=\"col\" rowspan=\"2\">toe-out</th><th scope=\"colgroup\" colspan=\"3\">right − left</th>\
        <th scope=\"colgroup\" colspan=\"3\">front − back</th></tr>\n\
        <tr class=\"sub\"><th scope=\"col\">back</th><th scope=\"col\">front</th><th scope=\"col\">front − back</th>\
        <th scope=\"col\">left</th><th scope=\"col\">right</th><th scope=\"col\">right − left</th></tr>\n";
    let row = |(name, toes): (&str, Option<Toes>)| {
        let Toes { back, front, left, right, front_minus_back, right_minus_left } = toes?;
        Some(tr(name, &[back, front, front_minus_back, left, right, right_minus_left].map(|toe| mm(Some(toe)))))
    };
    let rows: String = directions.into_iter().filter_map(row).collect();
    let caption = format!("Toe-outs at n = {n} (mm): differences of the means, subtracted before rounding.");
    if rows.is_empty() { rows } else { table(&caption, head, &rows) }
}
