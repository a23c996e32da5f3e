//! The limits of a watch over the units of a production, from strokes that the controller's own code sees.

use slipfit_core::{
    monitor::STANDING,
    production::{HOLD, Production as Reader, RATES, Record, Row, Sample, Stroke as Seen, Unit, Watch},
    sampling::{
        normal::{score, upper_score},
        stream::{Rng as _, derived, unit_stream},
    },
    table::I16Nodes,
};
use slipfit_system::parallel;

use super::{
    margin::margin,
    response::{Told, set_response, set_variances},
    rows::Rows,
    samples::Samples,
    tail::limits,
    widths::{root_mean_square, widths},
    wish::{ProductionTableError, Wish},
};
use crate::{
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

/// Share of the alarms of taught units that are those of their friction; the others are those of their samples.
const OF_FRICTION: f64 = 0.7;

/// Share of the strokes that stand for so long after the place from which a jam is reported.
const STANDING_SHARE: f64 = 3e-4;

/// Limits while they are not known: nothing exceeds them.
const NO_LIMIT: f32 = 1e6;

/// What seeds of the noise are derived with.
const STREAM: u64 = 6 << 32;

/// Shares of a whole stroke that are tried.
const DOUBTS: [f64; 6] = [0.003, 0.01, 0.03, 0.1, 1.0, 1e6];

/// The part of the places over which a response is smoothed for weights, to either side.
const SMOOTHED: f64 = 0.05;

/// What limits are made from.
pub struct Basis<'a> {
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

impl Basis<'_> {
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
            untaught: [NO_LIMIT; RATES.len()],
            taught: [NO_LIMIT; RATES.len()],
            drift: [NO_LIMIT; RATES.len()],
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
        set_response(&told, &mut record);

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
        record.untaught = limits(of(0), RATES.map(f64::from)).map(|limit| limit.max(0.0) as f32);
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
        record.taught = limits(of(0), RATES.map(f64::from).map(|rate| (1.0 - OF_FRICTION) * rate))
            .map(|limit| limit.max(0.0) as f32);
        // The last one, two or three strokes, each with a third of it. Frictions are normal from stroke to stroke; what
        // a stroke tells of them may have a longer tail.
        let shares = RATES.map(f64::from).map(|rate| OF_FRICTION * rate / 3.0);
        let told = limits(of(1), shares);
        record.drift = std::array::from_fn(|k| upper_score::<f64>(shares[k]).max(told[k]) as f32);
        record.margin = margin(self.subject, self.production, &chosen, self.wish.period, done)?;
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
        let least = f64::from(STANDING) * drive.speed.abs();
        let stands = |speed: &f32| f64::from(*speed) * self.sign < least;
        let stood = |samples: &Samples| {
            let mut last = 0.0;
            let mut count = 0u32;
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
}
