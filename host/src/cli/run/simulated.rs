//! What `run` simulates: every level of the table, the whole stroke where that is longer, and units of the production.

use slipfit_tolerance::product::Product;

use super::{Arguments, UNITS, advice::Units};
use crate::{
    cli::{
        by_one_drive::ByOneDrive,
        failure::Failure,
        population::{
            page::{self, UNKNOWN_FIGURE, unknown_figure},
            uncertain,
        },
        terminal::progress,
        tolerance::DEFAULT,
    },
    dynamics::sweep::{Keep, Sweep, sweep},
    firmware::force_table::{self, Demand, ForceTable},
    population::{study::Population, tally::Duty, uncertain::answer::Answer},
    show::report::Units as UnitsShown,
};

/// All that was simulated.
pub struct Simulated {
    pub table: ForceTable,
    /// The runs that the table is made of.
    pub tabled: Sweep,
    /// The whole stroke, where the scene states one that those do not come to the end of.
    pub stroke: Option<Sweep>,
    /// Units of the production over the same run; none where nothing varies.
    pub production: Option<OfProduction>,
}

/// What units of the production did.
pub struct OfProduction {
    pub population: Population,
    /// For the page, and the names of its pictures' files.
    pub shown: (UnitsShown, Vec<&'static str>),
    /// What the unknowns leave open, if there are any.
    pub unknown: Option<Answer>,
}

impl Simulated {
    /// What verdicts are given by.
    pub fn judged(&self) -> &Sweep {
        self.stroke.as_ref().unwrap_or(&self.tabled)
    }

    /// The units, as advice needs them.
    pub fn units(&self) -> Option<Units<'_>> {
        let OfProduction { population: Population { statistics, of_malfunction, .. }, unknown, .. } =
            self.production.as_ref()?;
        Some(Units { statistics, of_malfunction, unknown: unknown.as_ref() })
    }
}

impl Arguments {
    pub(super) fn simulate(&self, of: &ByOneDrive, product: Option<&Product>) -> Result<Simulated, Failure> {
        let subject = of.subject();
        let longer = of.longer();
        let whole = of.or_longer(&longer);
        let judged = whole.subject();
        let varies = subject.has_levels() || subject.parameters() > 0 || of.has_unknowns();
        let units = if varies { self.units.unwrap_or(UNITS) } else { 0 };
        let production = of.production(product, 0.0, DEFAULT.seed)?;
        let design = uncertain::design(of.has_unknowns(), units, DEFAULT.seed)?;
        let levels = subject.levels().levels();
        let runs = force_table::levels(subject.levels()).count + longer.as_ref().map_or(0, |_| levels.len());
        let all = units + design.map_or(0, |design| design.units());
        let bar = progress("simulating", runs + all as usize);
        let made = self.threads.install(|| {
            let (table, tabled) = force_table::make(subject, Demand::Full, || bar.inc(1))?;
            let unit = |n| judged.level(n, judged.motion(1e-3));
            let stroke = longer.as_ref().map(|_| sweep(judged, &levels, Keep::Samples, unit, || bar.inc(1)));
            let of_production = || {
                let duty = Duty { limit: None, stroke: judged.run().stroke };
                let population = Population::study(judged, &production, units, duty, |units| bar.inc(units))?;
                let answer = |design| whole.answer(&production, design, duty, |units| bar.inc(units));
                let unknown = design.map(answer).transpose()?;
                let mut shown = page::units(&whole, &production, &population, None)?;
                if let Some(figure) = unknown_figure(judged.title(), unknown.as_ref())? {
                    shown.0.figures.push(figure);
                    shown.1.push(UNKNOWN_FIGURE);
                }
                Ok::<_, Failure>(OfProduction { population, shown, unknown })
            };
            let production = varies.then(of_production).transpose()?;
            Ok::<_, Failure>(Simulated { table, tabled, stroke: stroke.transpose()?, production })
        })??;
        bar.finish_and_clear();
        Ok(made)
    }
}
