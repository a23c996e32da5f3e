//! Rare malfunction, for people.

use std::fmt::Write;

use crate::population::{
    finding::{Estimate, Finding},
    limit_state::{Kind, Side},
    rare::{Part, Rare},
};

/// By kind and side, beginning with all.
pub fn describe(rare: &Rare) -> String {
    let mut text = format!("Rare malfunction  {}\n", finding(&rare.malfunction));
    for Part { kind, side, finding: found } in &rare.parts {
        let kind = match kind {
            Kind::Crawls => "crawls",
            Kind::Overruns => "overruns",
            Kind::Jams => "jams",
            Kind::OverLimit => "over limit",
        };
        let side = match side {
            Side::Tight => ", tight",
            Side::Loose => ", loose",
            Side::Any => "",
        };
        let _ = writeln!(text, "  {:18}{}", format!("{kind}{side}"), finding(found));
    }
    let unknown = match rare.unknown {
        0 => String::new(),
        units => format!("; {units} of them come to no verdict: the upper ends count them as malfunctions"),
    };
    let _ = writeln!(text, "  by subset simulation, {} units{unknown}", rare.simulated);
    text
}

fn finding(finding: &Finding) -> String {
    match finding {
        Finding::Probability(Estimate { probability, interval: [low, high], .. }) => {
            format!("{probability:.2e}  ({low:.2e} to {high:.2e})")
        }
        Finding::Rarer { rarer_than, searched_to, searches } => {
            format!("none found by {searches} searches down to {searched_to:.0e}; by count below {rarer_than:.1e}")
        }
        Finding::Unknown { reason } => format!("no figure: {reason}"),
    }
}
