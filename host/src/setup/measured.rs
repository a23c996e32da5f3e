//! What of a scene was measured: which dimensions and gaps have the distribution of measured parts.

use slipfit_measured::production::{Joint, Production};
use slipfit_tolerance::{
    model::{Distribution, Model, Variation},
    product::Product,
};

use super::hash::Digest;

/// What a measured characteristic is in its scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The contributor of this number of the product.
    Contributor(usize),
    /// The gap of this number of the mechanism.
    Gap(usize),
}

/// Measured characteristics of a scene.
#[derive(Debug)]
pub struct Measured {
    /// Their production.
    pub production: Production,
    /// What each of them is.
    pub places: Vec<Place>,
    /// Names in the scene.
    pub names: Vec<String>,
}

/// Gaps that have the distribution of measured parts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredGaps {
    /// Number of each gap and its distribution (m).
    pub distributions: Vec<(usize, Distribution)>,
    /// Correlations of their normal scores: places in `distributions`, and the coefficient.
    pub correlations: Vec<(usize, usize, f64)>,
}

impl MeasuredGaps {
    /// The correlation of the normal scores of two of the `distributions`.
    pub fn correlation(&self, one: usize, other: usize) -> f64 {
        let is_of = |(row, column, _): &&(usize, usize, f64)| {
            [*row, *column] == [one, other] || [*row, *column] == [other, one]
        };
        self.correlations.iter().find(is_of).map_or(0.0, |(.., r)| *r)
    }
}

impl PartialEq for Measured {
    fn eq(&self, other: &Self) -> bool {
        self.places == other.places && self.names == other.names && self.production.joint() == other.production.joint()
    }
}

impl Measured {
    /// Of the characteristics that are places of one kind: their numbers there and distributions, and their correlations.
    fn of_kind(&self, joint: &Joint, number: impl Fn(Place) -> Option<usize>) -> MeasuredGaps {
        let among: Vec<usize> = (0..self.places.len()).filter(|i| number(self.places[*i]).is_some()).collect();
        let of = |i: &usize| Some((number(self.places[*i])?, joint.distributions.get(*i)?.clone()));
        let at = |i: usize| among.iter().position(|own| *own == i);
        let pair = |(row, column, r): &(usize, usize, f64)| Some((at(*row)?, at(*column)?, *r));
        MeasuredGaps {
            distributions: among.iter().filter_map(of).collect(),
            correlations: joint.correlations.iter().filter_map(pair).collect(),
        }
    }

    /// Hash of the measured values and of what they are in the scene.
    pub fn hash(&self) -> u64 {
        let mut digest = Digest::new();
        for (name, of) in self.names.iter().zip(self.production.characteristics()) {
            digest.bytes(name.as_bytes());
            digest.counts(of.values.iter().map(|value| usize::from(value.is_some())));
            digest.numbers(of.values.iter().copied().flatten().chain(of.bounds));
        }
        digest.finish()
    }

    /// The gaps among the characteristics, as `joint` has them.
    pub fn gaps(&self, joint: &Joint) -> MeasuredGaps {
        self.of_kind(joint, |place| match place {
            Place::Gap(gap) => Some(gap),
            Place::Contributor(_) => None,
        })
    }

    /// Whether some of the characteristics are contributors of a product.
    pub fn has_contributors(&self) -> bool {
        self.places.iter().any(|place| matches!(place, Place::Contributor(_)))
    }

    /// Whether some of the characteristics are gaps and others contributors, which are drawn apart from each other.
    pub fn is_divided(&self) -> bool {
        self.places.iter().any(|place| matches!(place, Place::Gap(_)))
            && self.places.iter().any(|place| matches!(place, Place::Contributor(_)))
    }

    /// `model` with its measured contributors as `joint` has them. Limits stay those of the drawing.
    pub fn model(&self, model: &Model, joint: &Joint) -> Model {
        let own = self.of_kind(joint, |place| match place {
            Place::Contributor(contributor) => Some(contributor),
            Place::Gap(_) => None,
        });
        let mut contributors = model.contributors.clone();
        for (number, drawn) in &own.distributions {
            if let Variation::Scalar { distribution, .. } = &mut contributors[*number].variation {
                *distribution = drawn.clone();
            }
        }
        let number = |i: usize| own.distributions[i].0;
        let is_measured = |i: usize| own.distributions.iter().any(|(number, _)| *number == i);
        let stated = model.correlations.iter().filter(|(row, column, _)| !(is_measured(*row) && is_measured(*column)));
        let measured = own.correlations.iter().map(|(row, column, r)| (number(*row), number(*column), *r));
        Model {
            correlations: stated.copied().chain(measured).collect(),
            contributors,
            measures: model.measures.clone(),
            sums: model.sums.clone(),
            function: model.function.clone(),
        }
    }

    /// `product` with its measured contributors as `joint` has them.
    pub fn product(&self, product: &Product, joint: &Joint) -> Product {
        Product {
            model: self.model(&product.model, joint),
            nominal: product.nominal.clone(),
            costed: product.costed.clone(),
            requirements: product.requirements.clone(),
            warnings: product.warnings.clone(),
        }
    }
}
