//! The limits of a watch over the units of a production, from strokes that the controller's own code sees.

use slipfit_core::{
    production::{MODES_MOST, Production as Reader, RATES, Record, Row, Sample, Stroke as Seen, Unit, Watch},
    sampling::{
        normal::{score, upper_score},
        stream::{Rng as _, derived, unit_stream},
    },
    table::I16Nodes,
};
use slipfit_system::parallel;

use super::{
    rows::Rows,
    samples::Samples,
    tail::limits,
    wish::{ProductionTableError, Wish},
};
use crate::{
    dynamics::simulate::SimulateError,
    firmware::flash,
    population::{production::Production, stroke::Stroke, strokes::Strokes, subject::Subject},
};

/// Units that are taught, for the limits of taught units.
pub const TAUGHT_UNITS: usize = 3000;

/// Strokes of a unit that is taught: those that it learns from, and as many that it is judged by.
pub const STROKES: u64 = 6;

/// Strokes of every unit, before these.
pub const FIRSTS: u64 = 2;

/// Those that it learns from.
const LEARNED: usize = 3;

/// Units whose friction is raised until they do not complete their stroke.
pub const MARGIN_UNITS: u64 = 400;

/// By what shares it is raised: whole percents, up to twice itself.
const RISES: usize = 100;
const RISE: f64 = 0.01;

/// A friction that a stroke tells no better than by this share is not told at all.
const DEVIATION_MOST: f64 = 0.5;

/// Rates of false alarms in a stroke that limits are stored for.
const ALARMS: [f64; RATES] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// Share of the alarms of taught units that are those of their friction; the others are those of their samples.
const OF_FRICTION: f64 = 0.7;

/// Part of the speed commanded below which a drive stands, and the samples after which a watch tells a jam.
const STANDING: f64 = 0.1;
const HOLD: usize = 10;

/// Share of the strokes that stand for so long where a jam is told.
const STANDING_SHARE: f64 = 3e-4;

/// Limits while they are not known: nothing exceeds them.
const NO_LIMIT: f32 = 1e6;

/// What seeds of the noise are derived with.
const STREAM: u64 = 6 << 32;

/// Differences that this share of the strokes exceeds at a place make the width there.
const BEYOND: f64 = 0.005;

/// The part of the places over which the greatest width counts, to either side: events come sooner in one unit than in another.
const WIDENED: f64 = 0.01;

/// Widths below this part of the mean one count as that: i16 would not keep them.
const WIDTH_LEAST: f64 = 0.05;

/// Shares of a whole stroke that are tried.
const DOUBTS: [f64; 6] = [0.003, 0.01, 0.03, 0.1, 1.0, 1e6];

/// The part of the places over which a response is smoothed for weights, to either side.
const SMOOTHED: f64 = 0.05;

/// What limits are made from.
pub struct Learned<'a> {
    pub subject: &'a dyn Subject,
    pub production: &'a Production<'a>,
    pub wish: &'a Wish,
    /// Noise (N).
    pub noise: f64,
    /// Direction of the drive.
    pub sign: f64,
    /// The greatest mean force (N).
    pub greatest: f64,
    /// Numbers of the units that complete their stroke.
    pub complete: &'a [u64],
    /// Strokes of units that complete them.
    pub firsts: &'a [Samples],
    pub rows: &'a Rows,
}

/// What calibration finds.
pub struct Calibration {
    /// Widths (N) at the nodes: of strokes above and below the mean, and of taught units beyond what is expected of them.
    pub widths: [Vec<f64>; 3],
    /// Weights (N) at the nodes.
    pub weight: Vec<f64>,
    pub record: Record,
    /// Root mean squares (N) of what strokes differ by: from the mean, from what is expected of a taught unit before the stroke, and within it.
    pub differences: [f64; 3],
}

/// A table that is read while it is being made.
struct Draft(Vec<u8>);

impl Draft {
    fn watch(&self) -> Watch<'_, I16Nodes<'_>> {
        let production = Reader::open(&self.0).ok().and_then(Reader::i16).expect("the encoder's own table");
        Watch::new(production, 1e-3).expect("the rate is in bounds")
    }
}

impl Learned<'_> {
    fn draft(&self, widths: &[Vec<f64>; 3], weight: &[f64], record: Record) -> Result<Draft, ProductionTableError> {
        let spec = self.rows.spec(self.subject.hash(), widths.clone(), weight.to_vec(), record);
        Ok(Draft(flash::encode(&spec)?))
    }

    /// The limits; `done` is called after each unit.
    pub fn calibrated(&self, done: &(impl Fn() + Sync)) -> Result<Calibration, ProductionTableError> {
        let count = self.rows.grid.count;
        let places = self.rows.grid.places();
        let mut record = Record {
            moving: self.moving(),
            period: self.wish.period as f32,
            noise: self.noise as f32,
            friction: self.wish.friction as f32,
            completing: (self.firsts.len() as f64 / (FIRSTS * self.wish.units) as f64) as f32,
            units: self.complete.len() as f32,
            untaught: [NO_LIMIT; RATES],
            taught: [NO_LIMIT; RATES],
            drift: [NO_LIMIT; RATES],
            deviation: 1.0,
            doubt: 1e30,
            ..Record::default()
        };
        record.norms.iter_mut().zip(&self.rows.modes.norms).for_each(|(to, norm)| *to = *norm as f32);

        // How far strokes are from the mean.
        let at_nodes = |samples: &Samples| samples.at_places(&samples.force, &places);
        let mean = &self.rows.modes.mean[0];
        let apart = |samples: &Samples| at_nodes(samples).iter().zip(mean).map(|(x, mean)| x - mean).collect();
        let apart: Vec<Vec<f64>> = self.firsts.iter().map(apart).collect();
        let [above, below] = [1.0, -1.0].map(|sign| widths(&apart, sign));
        let from_mean = root_mean_square(&apart);

        // Several strokes of some of the units.
        let step = self.complete.len().div_ceil(TAUGHT_UNITS);
        let chosen: Vec<u64> = self.complete.iter().step_by(step).copied().collect();
        let (friction, every) = (self.wish.friction, self.wish.period);
        let strokes = Strokes { seed: self.wish.seed, numbers: FIRSTS..FIRSTS + STROKES, friction, every };
        let keep = |unit: u64, strokes: Vec<(f64, Stroke)>| {
            let complete = strokes.iter().filter(|(_, stroke)| stroke.is_complete());
            let samples = complete.map(|(friction, stroke)| Samples::of(*friction, stroke, self.wish.over, self.sign));
            (unit, samples.collect::<Vec<_>>())
        };
        let mut units = strokes.simulate(self.subject, self.production, &chosen, keep, done)?;
        units.retain(|(_, strokes)| strokes.len() > LEARNED);

        let draft_widths = [above.clone(), below.clone(), above.clone()];
        // What a stroke's force is weighted with: how it rises with the friction.
        let weight = self.weight(&units, &at_nodes);
        let draft = self.draft(&draft_widths, &weight, record)?;
        let watch = draft.watch();
        let told = parallel::map(&units, |(number, strokes)| self.told(&watch, &Unit::default(), *number, strokes));
        set_variances(&told, &mut record);

        // Taught by three strokes, judged by the others.
        let draft = self.draft(&draft_widths, &weight, record)?;
        let taught = self.taught(&draft.watch(), &units);
        let mut strokes_of_taught = Vec::new();
        for ((_, strokes), unit) in units.iter().zip(&taught) {
            let coefficients = unit.coefficients(&record.variances);
            let modes = || self.rows.modes.modes.iter().zip(coefficients);
            let own = |i: usize| mean[i] + modes().map(|([force, _], c)| f64::from(c) * force[i]).sum::<f64>();
            let own: Vec<f64> = (0..count).map(own).collect();
            strokes_of_taught.extend(
                strokes
                    .iter()
                    .skip(LEARNED)
                    .map(|samples| at_nodes(samples).iter().zip(&own).map(|(x, own)| x - own).collect::<Vec<f64>>()),
            );
        }
        let before = root_mean_square(&strokes_of_taught);
        let (doubt, differences) = self.told_within(&weight, &strokes_of_taught);
        record.doubt = doubt as f32;
        let taught_width = widths(&differences, self.sign);
        let residual = root_mean_square(&differences);
        record.residual = residual as f32;

        let widths = [above, below, taught_width];

        // What a stroke tells of the friction, events cut off.
        let draft = self.draft(&widths, &weight, record)?;
        let watch = draft.watch();
        let both: Vec<_> = units.iter().zip(&taught).collect();
        let told = parallel::map(&both, |((number, strokes), unit)| self.told(&watch, unit, *number, strokes));
        self.set_response(&told, &mut record);

        // Limits, as what the watch computes exceeds them.
        let draft = self.draft(&widths, &weight, record)?;
        let watch = draft.watch();
        let taught = self.taught(&watch, &units);
        let all: Vec<(usize, &Samples)> = self.firsts.iter().enumerate().collect();
        let most = parallel::map(&all, |(i, samples)| {
            let (mut tight, mut band) = (f64::NEG_INFINITY, 0.0f64);
            let (unit, noise) = (Unit::default(), [u64::MAX, *i as u64]);
            self.seen(&watch, &unit, samples, noise, true, &mut |_, excess, _| tight = tight.max(excess));
            self.seen(&watch, &unit, samples, noise, false, &mut |at, _, force| {
                let row =
                    |row: Row| f64::from(watch.production().row(row as usize, at).map_or(0.0, |[force, _]| force));
                let beyond = force - row(Row::Mean);
                let side = if beyond > 0.0 { Row::Above } else { Row::Below };
                band = band.max(beyond.abs() / row(side).max(f64::MIN_POSITIVE));
            });
            [tight, band]
        });
        let of = |k: usize| most.iter().map(|found| found[k]).collect::<Vec<f64>>();
        record.untaught = limits(of(0), ALARMS).map(|limit| limit.max(0.0) as f32);
        record.band = limits(of(1), [0.01])[0] as f32;
        let both: Vec<_> = units.iter().zip(&taught).collect();
        let most = parallel::map(&both, |((number, strokes), unit)| {
            let mut unit = **unit;
            let judged = strokes.iter().enumerate().skip(LEARNED).map(|(k, samples)| {
                let mut tight = f64::NEG_INFINITY;
                let seen = self.seen(&watch, &unit, samples, [*number, k as u64 + 1], true, &mut |_, excess, _| {
                    tight = tight.max(excess);
                });
                let end = watch.finish(&mut unit, &seen);
                [tight, f64::from(end.rise / end.deviation)]
            });
            judged.collect::<Vec<[f64; 2]>>()
        });
        let of = |k: usize| most.iter().flatten().map(|found| found[k]).collect::<Vec<f64>>();
        record.taught = limits(of(0), ALARMS.map(|rate| (1.0 - OF_FRICTION) * rate)).map(|limit| limit.max(0.0) as f32);
        // The last one, two or three strokes, each with a third of it. Frictions are normal from stroke to stroke; what
        // a stroke tells of them may have a longer tail.
        let shares = ALARMS.map(|rate| OF_FRICTION * rate / 3.0);
        let told = limits(of(1), shares);
        record.drift = std::array::from_fn(|k| upper_score::<f64>(shares[k]).max(told[k]) as f32);
        record.margin = self.margin(&chosen, done)?;
        Ok(Calibration { widths, weight, record, differences: [from_mean, before, residual] })
    }

    /// How much of a stroke has to be seen before what it tells of its friction is believed by half, such that what is expected errs least; and
    /// what the strokes, which are `before` (N) from what is expected before them, then differ by.
    fn told_within(&self, weight: &[f64], before: &[Vec<f64>]) -> (f64, Vec<Vec<f64>>) {
        let step = self.rows.grid.step;
        let whole = weight.iter().map(|w| step * w * w).sum::<f64>().max(f64::from(f32::MIN_POSITIVE));
        let within = |doubt: f64, stroke: &Vec<f64>| {
            let (mut above, mut squared) = (0.0, 0.0);
            let told = stroke.iter().zip(weight).map(|(x, w)| {
                let left = x - w * above / (squared + doubt);
                above += step * w * x;
                squared += step * w * w;
                left
            });
            told.collect::<Vec<f64>>()
        };
        let tried = DOUBTS.map(|share| {
            let doubt = whole * share;
            let left: Vec<Vec<f64>> = parallel::map(before, |stroke| within(doubt, stroke));
            (doubt, left)
        });
        let error = |(_, left): &(f64, Vec<Vec<f64>>)| root_mean_square(left);
        let best = tried.into_iter().min_by(|one, other| error(one).total_cmp(&error(other)));
        best.unwrap_or((whole, before.to_vec()))
    }

    /// Lets `watch` see a stroke of `unit`, the `k`-th of unit `number`, with or without noise; `see` gets each place from the drive's start on, the
    /// excess as a multiple of its width and the force.
    fn seen(
        &self,
        watch: &Watch<'_, I16Nodes<'_>>,
        unit: &Unit,
        samples: &Samples,
        [number, k]: [u64; 2],
        has_noise: bool,
        see: &mut dyn FnMut(f32, f64, f64),
    ) -> Seen {
        let mut noise = unit_stream(derived(derived(self.wish.seed, STREAM), number), k);
        let axis = watch.production().places();
        let mut stroke = watch.start();
        for (i, at) in samples.at.iter().enumerate() {
            let own = f64::from(samples.force[i]);
            let noise = if has_noise { self.noise * score::<f64>(noise.next_u64()) } else { 0.0 };
            let force = own + noise;
            let speed = samples.speed[i];
            // Only its direction counts: whether it stands is not asked here.
            let command = (self.sign * 1e-30) as f32;
            let report = watch.step(unit, &mut stroke, &Sample { at: *at, force: force as f32, speed, command });
            if *at >= axis.first() && *at <= axis.last() {
                see(
                    *at,
                    f64::from(NO_LIMIT) * f64::from(report.excess) / f64::from(report.limit).max(f64::MIN_POSITIVE),
                    own,
                );
            }
        }
        stroke
    }

    /// The place from which units move: few of the strokes stand for longer than a watch waits there or later.
    fn moving(&self) -> f32 {
        let drive = self.subject.drive();
        let least = STANDING * drive.speed.abs();
        let stands = |speed: &f32| f64::from(*speed) * self.sign < least;
        let stood = |samples: &Samples| {
            let mut last = 0.0;
            let mut count = 0;
            for (speed, at) in samples.speed.iter().zip(&samples.at) {
                count = if stands(speed) { count + 1 } else { 0 };
                last = if count >= HOLD { *at } else { last };
            }
            last
        };
        let mut places: Vec<f32> = self.firsts.iter().map(stood).collect();
        places.sort_by(f32::total_cmp);
        let beyond = (STANDING_SHARE * places.len() as f64) as usize;
        places.get(places.len().saturating_sub(1 + beyond)).copied().unwrap_or(0.0)
    }

    /// Weights at the nodes: the response of the force to the friction, smoothed, its greatest as great as the greatest mean force.
    fn weight(&self, units: &[(u64, Vec<Samples>)], at_nodes: &dyn Fn(&Samples) -> Vec<f64>) -> Vec<f64> {
        let count = self.rows.grid.count;
        let (mut response, mut squares) = (vec![0.0; count], 0.0);
        for (_, strokes) in units {
            let mean = strokes.iter().map(|samples| samples.friction).sum::<f64>() / strokes.len() as f64;
            for samples in strokes {
                let apart = samples.friction - mean;
                squares += apart * apart;
                response.iter_mut().zip(at_nodes(samples)).for_each(|(sum, x)| *sum += apart * x);
            }
        }
        if squares == 0.0 {
            return response;
        }
        let reach = (SMOOTHED * count as f64) as usize;
        let smoothed: Vec<f64> = (0..count)
            .map(|i| {
                let near = &response[i.saturating_sub(reach)..(i + reach + 1).min(count)];
                near.iter().sum::<f64>() / near.len() as f64
            })
            .collect();
        let most = smoothed.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let scale = if most > 0.0 { self.greatest / most } else { 0.0 };
        smoothed.into_iter().map(|x| scale * x).collect()
    }

    /// What `watch` tells of each of the `strokes` of `unit`.
    fn told(&self, watch: &Watch<'_, I16Nodes<'_>>, unit: &Unit, number: u64, strokes: &[Samples]) -> Vec<Told> {
        let told = (1..).zip(strokes).map(|(k, samples)| {
            let seen = self.seen(watch, unit, samples, [number, k], true, &mut |_, _, _| {});
            (samples.friction, watch.coefficients(&seen).map(f64::from), f64::from(watch.weighted(&seen)))
        });
        told.collect()
    }

    /// The units, each taught by its first strokes.
    fn taught(&self, watch: &Watch<'_, I16Nodes<'_>>, units: &[(u64, Vec<Samples>)]) -> Vec<Unit> {
        parallel::map(units, |(number, strokes)| {
            let mut unit = Unit::default();
            for (k, samples) in (1..).zip(strokes.iter().take(LEARNED)) {
                let seen = self.seen(watch, &unit, samples, [*number, k], true, &mut |_, _, _| {});
                let _ = watch.finish(&mut unit, &seen);
            }
            unit
        })
    }

    /// How the weighted force rises with the friction: of the mean unit, what each mode adds, and how well a stroke tells the friction.
    fn set_response(&self, told: &[Vec<Told>], record: &mut Record) {
        let slopes = told.iter().map(|strokes| {
            let count = strokes.len() as f64;
            let mean = strokes.iter().map(|(friction, ..)| friction).sum::<f64>() / count;
            let of = |friction: f64| friction - mean;
            let squares: f64 = strokes.iter().map(|(friction, ..)| of(*friction) * of(*friction)).sum();
            let products: f64 = strokes.iter().map(|(friction, _, weighted)| of(*friction) * weighted).sum();
            let coefficients: [f64; MODES_MOST] =
                std::array::from_fn(|k| strokes.iter().map(|(_, c, _)| c[k]).sum::<f64>() / count);
            (squares, products, coefficients)
        });
        // Least squares, weighted by how well each slope is known; coefficients are uncorrelated.
        let slopes: Vec<_> = slopes.collect();
        let whole: f64 = slopes.iter().map(|(squares, ..)| squares).sum();
        if whole == 0.0 {
            return;
        }
        let response = slopes.iter().map(|(_, products, _)| products).sum::<f64>() / whole;
        record.response = response as f32;
        // Of weighted forces about a straight line over the friction.
        let (mut noise, mut count) = (0.0, 0.0);
        for (strokes, (squares, products, _)) in told.iter().zip(&slopes) {
            let mean = strokes.iter().map(|(.., weighted)| weighted).sum::<f64>() / strokes.len() as f64;
            let whole: f64 = strokes.iter().map(|(.., weighted)| (weighted - mean) * (weighted - mean)).sum();
            noise += whole - if *squares > 0.0 { products * products / squares } else { 0.0 };
            count += strokes.len() as f64 - 2.0;
        }
        let noise = noise / f64::max(count, 1.0);
        for k in 0..self.rows.modes.modes.len() {
            let (products, squares) = slopes.iter().fold((0.0, 0.0), |(products, squares), slope| {
                let (square, product, coefficients) = slope;
                let c = coefficients[k];
                (products + c * (product - response * square), squares + square * c * c)
            });
            // What is within three standard deviations of nothing counts as nothing.
            let is_known = products * products > 9.0 * noise * squares;
            record.responses[k] = if is_known { (products / squares) as f32 } else { 0.0 };
        }
        // About each unit's own mean, by its own response.
        let (mut squares, mut count) = (0.0, 0.0);
        for (strokes, (.., coefficients)) in told.iter().zip(&slopes) {
            let own = response
                + coefficients.iter().zip(record.responses).map(|(c, response)| c * f64::from(response)).sum::<f64>();
            if own.abs() < 0.1 * response.abs() {
                continue;
            }
            let mean = strokes.iter().map(|(.., weighted)| weighted).sum::<f64>() / strokes.len() as f64;
            squares += strokes.iter().map(|(.., weighted)| (weighted - mean) / own).map(|x| x * x).sum::<f64>();
            count += strokes.len() as f64 - 1.0;
        }
        let deviation = libm::sqrt(squares / f64::max(count, 1.0));
        if deviation > DEVIATION_MOST {
            (record.response, record.responses) = (0.0, [0.0; MODES_MOST]);
        }
        record.deviation = deviation.max(1e-9) as f32;
    }

    /// The rise of the friction with which one in a hundred units does not complete its stroke any more; the greatest that is tried if fewer do
    /// not.
    fn margin(&self, chosen: &[u64], done: &(impl Fn() + Sync)) -> Result<f32, ProductionTableError> {
        let step = chosen.len().div_ceil(MARGIN_UNITS as usize);
        let few: Vec<u64> = chosen.iter().step_by(step).copied().collect();
        let found = parallel::try_map(&few, |number| {
            let (drawn, i) = self.production.draw_one(*number);
            let completes = |rise: usize| {
                let friction = RISE * rise as f64;
                match self.subject.stroke(&drawn, i, friction, self.wish.period.max(1e-2)) {
                    Ok(stroke) => Ok(stroke.is_complete()),
                    Err(interrupted @ SimulateError::Interrupted) => Err(interrupted),
                    Err(_) => Ok(false),
                }
            };
            // Half and half: what does not complete with some friction does not with more.
            let (mut good, mut bad) = (0, RISES + 1);
            while bad - good > 1 {
                let middle = usize::midpoint(good, bad);
                if completes(middle)? { good = middle } else { bad = middle }
            }
            done();
            Ok::<_, SimulateError>(bad)
        })?;
        let mut found = found;
        found.sort_unstable();
        let first = found.get(found.len() / 100).copied().unwrap_or(RISES);
        Ok((RISE * first.min(RISES) as f64) as f32)
    }
}

/// Friction of a stroke, and the coefficients and the weighted force that the controller's code finds.
type Told = (f64, [f64; MODES_MOST], f64);

/// The variance of each coefficient from stroke to stroke of a unit.
fn set_variances(told: &[Vec<Told>], record: &mut Record) {
    let (mut squares, mut count) = ([0.0; MODES_MOST], 0.0);
    for strokes in told {
        for (k, sum) in squares.iter_mut().enumerate() {
            let mean = strokes.iter().map(|(_, coefficients, _)| coefficients[k]).sum::<f64>() / strokes.len() as f64;
            *sum += strokes.iter().map(|(_, c, _)| (c[k] - mean) * (c[k] - mean)).sum::<f64>();
        }
        count += strokes.len() as f64 - 1.0;
    }
    record.variances = squares.map(|sum| (sum / f64::max(count, 1.0)) as f32);
}

/// Widths at the nodes, of which `all` holds the differences (N) of each stroke: what few of them exceed there or near it in the direction
/// of `sign`.
fn widths(all: &[Vec<f64>], sign: f64) -> Vec<f64> {
    let (count, strokes) = (all.first().map_or(0, Vec::len), all.len());
    let beyond = |i: usize| {
        let mut here: Vec<f64> = all.iter().map(|one| sign * one[i]).collect();
        let place = ((1.0 - BEYOND) * strokes as f64) as usize;
        here.select_nth_unstable_by(place.min(strokes - 1), f64::total_cmp).1.max(0.0)
    };
    let widths: Vec<f64> = (0..count).map(beyond).collect();
    let least = WIDTH_LEAST * widths.iter().sum::<f64>() / count.max(1) as f64;
    let reach = (WIDENED * count as f64).ceil() as usize;
    let near =
        |i: usize| widths[i.saturating_sub(reach)..(i + reach + 1).min(count)].iter().copied().fold(least, f64::max);
    (0..count).map(near).collect()
}

/// The root mean square of the differences `all`.
fn root_mean_square(all: &[Vec<f64>]) -> f64 {
    let count = all.iter().map(Vec::len).sum::<usize>();
    libm::sqrt(all.iter().flatten().map(|x| x * x).sum::<f64>() / count.max(1) as f64)
}
