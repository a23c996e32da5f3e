//! Which units a production has: gaps and parameters, drawn unit by unit.
//!
//! A unit is a pure function of scene, seed and its number.

use std::{ops::Range, sync::Arc};

use slipfit_core::{sampling::stream::derived, slide::ABSENT};
use slipfit_measured::production::Joint;
use slipfit_tolerance::{
    model::Contributor,
    numeric::lanes::{LANES, Lanes},
    product::Product,
    sampling::draw::DrawError,
};

use super::source::{Columns, Held, Source, Stated, each_itself, of_statistics};
use crate::{
    mechanism::{self, Mechanism},
    setup::{Measured, MeasuredGaps, Scene},
};

pub use super::source::MOST_UNITS;

/// What seeds of gaps and of parameters are derived with.
const STREAMS: [u64; 2] = [3 << 32, 4 << 32];

/// A production of a scene with a slide, or with a mechanism.
pub struct Production<'a> {
    gaps: Vec<Gap>,
    /// Of the measures that gaps are, of the gaps that have statistics of their own, and of parameters.
    sources: Vec<Source<'a>>,
    parameters: usize,
    names: Vec<String>,
    made_of: Ingredients<'a>,
}

/// What a production is made of.
struct Ingredients<'a> {
    /// None where there is no gap.
    gaps: Vec<Option<Stated>>,
    product: Option<&'a Product>,
    /// Of any two gaps with means and deviations that were not measured.
    correlation: f64,
    vary: Vec<Contributor>,
    measured: Option<Arc<Measured>>,
    seed: u64,
}

/// Where a gap comes from.
#[derive(Clone, Copy)]
enum Gap {
    Absent,
    /// Source and measure.
    Drawn(usize, usize),
}

/// Some units, as they were drawn.
pub struct Drawn {
    /// Their numbers.
    pub numbers: Range<u64>,
    /// Gaps (m) of each; [`ABSENT`] for none.
    pub gaps: Vec<Vec<f64>>,
    /// Deviations (SI) of the parameters of each, in the order in which the scene says what varies.
    pub deviations: Vec<Vec<f64>>,
    /// Values of all variables, a column each, in the order of [`Production::contributors`].
    pub variables: Vec<Vec<f64>>,
}

impl<'a> Production<'a> {
    /// Of `scene`, whose gaps are measures of `product` or have means and deviations; any two of the latter have the
    /// `correlation`.
    ///
    /// # Errors
    /// [`DrawError`], if no joint distribution has the correlations.
    pub fn new(scene: &Scene, product: Option<&'a Product>, correlation: f64, seed: u64) -> Result<Self, DrawError> {
        let gaps = scene.pins.iter().flat_map(|pin| pin.gaps);
        let named = gaps.zip(scene.contact_names()).zip(scene.gap_measures.as_flattened());
        let gaps =
            named.map(|((gap, name), measure)| Some(Stated { name, statistics: gap?, measure: *measure })).collect();
        let vary = scene.vary.iter().map(|varied| varied.deviation.clone()).collect();
        Self::of(Ingredients { gaps, product, correlation, vary, measured: scene.measured.clone(), seed })
    }

    /// Of `mechanism`, whose gaps are measures of `product` or have means and deviations; any two of the latter have the
    /// `correlation`.
    ///
    /// # Errors
    /// [`DrawError`], if no joint distribution has the correlations.
    pub fn of_mechanism(
        mechanism: &Mechanism,
        product: Option<&'a Product>,
        correlation: f64,
        seed: u64,
    ) -> Result<Self, DrawError> {
        let stated = |gap: &mechanism::Gap| {
            Some(Stated { name: gap.name.clone(), statistics: gap.statistics, measure: gap.measure })
        };
        let vary = mechanism.vary.iter().map(|varied| varied.deviation.clone()).collect();
        let gaps = mechanism.gaps.iter().map(stated).collect();
        Self::of(Ingredients { gaps, product, correlation, vary, measured: mechanism.measured.clone(), seed })
    }

    /// The likeliest production.
    fn of(made_of: Ingredients<'a>) -> Result<Self, DrawError> {
        let measured = made_of.measured.as_ref();
        let gaps = measured.map(|measured| measured.gaps(measured.production.joint())).unwrap_or_default();
        let model = made_of.product.map(|product| Held::Shared(&product.model));
        Self::made(made_of, model, &gaps)
    }

    /// A production of this `number` that the measured parts leave possible; none where nothing was measured.
    pub fn possible(&self, number: u64) -> Option<Result<Self, DrawError>> {
        let Ingredients { ref gaps, product, correlation, ref vary, ref measured, seed } = self.made_of;
        let own = measured.as_ref()?;
        let drawn = own.production.drawn(number);
        let made = |joint: &Joint| {
            let model = product.map(|product| Held::Own(Box::new(own.model(&product.model, joint))));
            let (gaps, vary, measured) = (gaps.clone(), vary.clone(), measured.clone());
            let made_of = Ingredients { gaps, product, correlation, vary, measured, seed };
            Self::made(made_of, model, &own.gaps(joint))
        };
        // Drawn correlations may contradict those that the scene states; the likeliest do not.
        let likeliest = || Joint { correlations: own.production.joint().correlations.clone(), ..drawn.clone() };
        Some(made(&drawn).or_else(|_| made(&likeliest())))
    }

    /// Of a `model` of the product and `measured` gaps.
    fn made(made_of: Ingredients<'a>, model: Option<Held<'a>>, measured: &MeasuredGaps) -> Result<Self, DrawError> {
        let Ingredients { gaps: ref stated, product, correlation, ref vary, seed, .. } = made_of;
        let mut sources = Vec::new();
        let mut gaps = vec![Gap::Absent; stated.len()];
        let measure = |gap: &Option<Stated>| gap.as_ref()?.measure;
        if let Some(model) = model.filter(|_| stated.iter().any(|gap| measure(gap).is_some())) {
            for (gap, stated) in gaps.iter_mut().zip(stated) {
                if let Some(measure) = measure(stated) {
                    *gap = Gap::Drawn(sources.len(), measure);
                }
            }
            sources.push(Source::new(model, derived(seed, STREAMS[0]))?);
        }
        let own = stated.iter().enumerate().filter_map(|(i, gap)| Some((i, gap.as_ref()?)));
        let own: Vec<(usize, &Stated)> = own.filter(|(_, gap)| product.is_none() || gap.measure.is_none()).collect();
        if !own.is_empty() {
            for (measure, (i, _)) in own.iter().enumerate() {
                gaps[*i] = Gap::Drawn(sources.len(), measure);
            }
            let model = of_statistics(&own, correlation, measured);
            sources.push(Source::new(Held::Own(Box::new(model)), derived(seed, STREAMS[0] + 1))?);
        }
        let parameters = vary.len();
        if parameters > 0 {
            sources.push(Source::new(Held::Own(Box::new(each_itself(vary.clone()))), derived(seed, STREAMS[1]))?);
        }
        let contributors = sources.iter().flat_map(|source| &source.model.contributors);
        let names = contributors.map(|contributor| contributor.name.clone()).collect();
        Ok(Self { gaps, sources, parameters, names, made_of })
    }

    /// What varies: name, and which of the variables are its own.
    pub fn contributors(&self) -> Vec<(&str, Range<usize>)> {
        let counts = self.sources.iter().flat_map(|source| &source.model.contributors);
        let ranges = counts.scan(0, |at, contributor| {
            let start = *at;
            *at += contributor.variation.variables();
            Some(start..*at)
        });
        self.names.iter().map(String::as_str).zip(ranges).collect()
    }

    /// The units `numbers`.
    pub fn draw(&self, numbers: Range<u64>) -> Drawn {
        let columns = self.sources.iter().map(|source| source.draw(&numbers)).collect();
        self.assembled(numbers, columns)
    }

    /// Units among which is that of this `number`, and its place among them.
    pub fn draw_one(&self, number: u64) -> (Drawn, usize) {
        let first = number - number % LANES as u64;
        (self.draw(first..number + 1), (number - first) as usize)
    }

    /// How many independent standard normal scores a unit has.
    pub fn scores(&self) -> usize {
        self.sources.iter().map(|source| source.draw.dimensions()).sum()
    }

    /// The units at `points` of the space of scores, and which of them are made: those with all truncated zones inside.
    pub fn at(&self, points: &[Vec<f64>]) -> (Drawn, Vec<bool>) {
        let mut made = vec![true; points.len()];
        let mut first = 0;
        let columns = self.sources.iter().map(|source| {
            let own = first..first + source.draw.dimensions();
            first = own.end;
            source.at(points, own, &mut made)
        });
        let columns = columns.collect();
        (self.assembled(0..points.len() as u64, columns), made)
    }

    /// By how much a unit is more probable because truncated zones are inside.
    pub fn factor(&self) -> f64 {
        let of = |source: &Source| source.draw.is_inside(&vec![Lanes::ZERO; source.draw.dimensions()]).1;
        self.sources.iter().map(of).product()
    }

    /// Units from what each source has drawn.
    fn assembled(&self, numbers: Range<u64>, sources: Vec<Columns>) -> Drawn {
        let count = (numbers.end - numbers.start) as usize;
        let mut gaps = vec![vec![ABSENT; self.gaps.len()]; count];
        let mut deviations = vec![Vec::with_capacity(self.parameters); count];
        let mut variables = Vec::new();
        for (s, Columns { variables: columns, measures }) in sources.into_iter().enumerate() {
            for (i, gap) in self.gaps.iter().enumerate() {
                if let Gap::Drawn(of, measure) = gap
                    && *of == s
                {
                    gaps.iter_mut().zip(&measures[*measure]).for_each(|(gaps, value)| gaps[i] = *value);
                }
            }
            if self.parameters > 0 && s + 1 == self.sources.len() {
                for measure in &measures {
                    deviations.iter_mut().zip(measure).for_each(|(unit, value)| unit.push(*value));
                }
            }
            variables.extend(columns);
        }
        Drawn { numbers, gaps, deviations, variables }
    }
}

#[cfg(test)]
mod tests {
    use super::Production;
    use crate::{
        dynamics::example,
        scene::{SceneFile, shipped},
        setup::Scene,
    };
    use slipfit_tolerance::numeric::{lanes::LANES, normal::Scores};

    fn moments(values: impl Iterator<Item = f64>) -> [f64; 2] {
        let values: Vec<f64> = values.collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / values.len() as f64;
        [mean, libm::sqrt(square)]
    }

    #[test]
    fn gaps_have_the_moments_and_the_correlation_that_the_scene_states() {
        let scene = example::cd_rom();
        let drawn = Production::new(&scene, None, 0.5, 7).unwrap().draw(0..20_000);
        for (i, gap) in scene.pins.iter().flat_map(|pin| pin.gaps).enumerate() {
            let gap = gap.unwrap();
            let [mean, deviation] = moments(drawn.gaps.iter().map(|gaps| gaps[i]));
            assert!((mean - gap.mean).abs() < 4.0 * gap.deviation / libm::sqrt(20_000.0));
            assert!((deviation / gap.deviation - 1.0).abs() < 0.02);
        }
        let product =
            drawn.gaps.iter().map(|gaps| (gaps[0] - 0.0064e-3) / 0.0404e-3 * (gaps[9] - 0.4037e-3) / 0.0488e-3);
        assert!((product.sum::<f64>() / 20_000.0 - 0.5).abs() < 0.04);
    }

    #[test]
    fn a_unit_is_the_same_whatever_is_drawn_with_it() {
        let file = SceneFile::parse("drawing", shipped("cd-rom-slide-drawing").unwrap(), &[]).unwrap();
        let (scene, product) = (file.slide.unwrap(), file.product.unwrap());
        let production = Production::new(&scene, Some(&product), 0.0, 1).unwrap();
        let all = production.draw(0..512);
        let part = production.draw(256..300);
        assert_eq!(all.gaps[256..300], part.gaps);
        assert_eq!(all.variables[3][256..300], part.variables[3]);
        // The units' moments are those that the scene's levels are made of.
        let gap = scene.pins[1].gaps[0].unwrap();
        let [mean, deviation] = moments(production.draw(0..20_224).gaps.iter().map(|gaps| gaps[4]));
        assert!((mean - gap.mean).abs() < 4.0 * gap.deviation / libm::sqrt(2e4), "{mean} {gap:?}");
        assert!((deviation / gap.deviation - 1.0).abs() < 0.03, "{deviation} {gap:?}");
    }

    /// The same units from the scores that random bits stand for.
    #[test]
    fn units_at_points_are_those_that_are_drawn_there() {
        let scene = example::cd_rom();
        let production = Production::new(&scene, None, 0.5, 7).unwrap();
        let source = &production.sources[0];
        let points: Vec<Vec<f64>> = (0..21)
            .map(|unit| {
                let mut bits = vec![[0; LANES]; production.scores()];
                source.sampler.fill(unit, &mut bits);
                bits.iter().map(|bits| Scores::table().score(bits[0])).collect()
            })
            .collect();
        let (found, made) = production.at(&points);
        let drawn = production.draw(0..21);
        assert_eq!((found.gaps, found.variables), (drawn.gaps, drawn.variables));
        assert!(made.iter().all(|made| *made) && production.factor() == 1.0);
    }

    #[test]
    fn parameters_vary_as_the_scene_says() {
        let text = format!(
            "{}\n[vary]\nfriction.coefficient = 0.03\nslide.tilt_x = {{ tolerance = \"2°\", distribution = \"uniform\" }}\n\
             slide.mass = {{ distribution = {{ kind = \"weibull\", shape = 1, scale = \"2 g\" }} }}\n",
            shipped("cd-rom-slide").unwrap()
        );
        let scene = Scene::parse("varied", &text, &[]).unwrap();
        let drawn = Production::new(&scene, None, 0.0, 3).unwrap().draw(0..4096);
        let [_, friction] = moments(drawn.deviations.iter().map(|unit| unit[0]));
        let [mean, mass] = moments(drawn.deviations.iter().map(|unit| unit[1]));
        let [_, tilt] = moments(drawn.deviations.iter().map(|unit| unit[2]));
        assert!((friction / 0.01 - 1.0).abs() < 0.05, "{friction}");
        // Exponential: the mean is the standard deviation.
        assert!((mean / 2e-3 - 1.0).abs() < 4.0 / 64.0 && (mass / 2e-3 - 1.0).abs() < 0.1, "{mean} {mass}");
        assert!((tilt / (2f64.to_radians() / libm::sqrt(3.0)) - 1.0).abs() < 0.05, "{tilt}");
    }
}
