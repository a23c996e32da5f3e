//! Holes on pins, tried out before anything is analysed: does every pin go into its hole, does every mate close?

use slipfit_tolerance::{
    model::Model,
    number::{fixed, ten_digits},
    numeric::lanes::Lanes,
    product::assembly::Assembly,
    theory::moments::drawn,
};

use super::draft::Fit;

/// Units that are tried.
pub(super) const UNITS: usize = 1024;

/// The most units whose contacts may be open. Measures have no value in these units, and the report says in how many; with more of them
/// the scene itself is taken to be wrong.
pub(super) const OPEN_MOST: usize = UNITS / 20;

/// What was found.
pub(super) struct Tried {
    /// Sentences about fits that do not go together.
    pub told: Vec<String>,
    /// Units with contacts that do not close.
    pub open: usize,
}

/// Tries the mates of `assembly` in units of `model`, with holes centred on their pins where these leave them free to be.
pub(super) fn try_out(model: &Model, assembly: &Assembly, fits: &[Fit]) -> Tried {
    let mut counts = vec![0; fits.len()];
    let mut open = 0;
    if !assembly.placements.is_empty() {
        let mut centred = Vec::new();
        drawn(model, UNITS as u64, |variables| {
            centred.clear();
            centred.extend_from_slice(variables);
            fits.iter().for_each(|fit| centred[fit.float.clone()].fill(Lanes::ZERO));
            open += assembly.misfits(&centred, |fit, units| counts[fit] += units);
        });
    }
    let tell = |(fit, count): (&Fit, &usize)| {
        let name = &fit.name;
        if *count > 0 {
            let percent = fixed(*count as f64 / UNITS as f64 * 100.0, 1);
            return Some(format!(
                "{name}: interference in {percent} % of {UNITS} units that were tried; they are analysed without play"
            ));
        }
        let most = ten_digits((-fit.least * 1e12).round() / 1e9);
        (fit.least < 0.0).then(|| format!("{name}: interference of {most} mm at the limits of both diameters"))
    };
    Tried { told: fits.iter().zip(&counts).filter_map(tell).collect(), open }
}
