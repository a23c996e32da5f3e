//! Tables of a production, judged by units that they were not made of: the controller's own code sees their strokes.
//!
//! The whole judgement takes a minute: `cargo test --release -p slipfit --test production_table -- --ignored --nocapture`.

use slipfit::{
    dynamics::{driven::Driven as _, outcome::Verdict},
    firmware::production_table::{Over, ProductionTable, Wish, make},
    mechanism::{ByDrive, Mechanism},
    population::{production::Production, stroke::Stroke, strokes::Strokes, subject::Subject},
    scene::{SceneFile, shipped},
    setup::Scene,
    system::parallel,
};
use slipfit_core::{
    monitor::Verdict as Said,
    production::{Production as Reader, Sample, StrokeEnd, Unit, Watch},
    sampling::{
        normal::score,
        stream::{Rng as _, unit_stream},
    },
    table::AnyNodes,
};

/// The friction and the noise of the strokes that judge.
const SEED: u64 = 77;

const PERIOD: f64 = 1e-3;

fn wish(units: u64) -> Wish {
    Wish { over: Over::Time, units, seed: 1, noise: 0.02, friction: 0.03, period: PERIOD, bytes: 16_384 }
}

fn slide(name: &str) -> Scene {
    let text = shipped(name).unwrap();
    let (mut scene, _) = SceneFile::parse(name, text, &[]).unwrap().into_slide(name, text).unwrap();
    scene.run.duration = scene.stroke_duration().unwrap();
    scene
}

fn mechanism(name: &str) -> Mechanism {
    SceneFile::parse(name, shipped(name).unwrap(), &[]).unwrap().mechanism.unwrap()
}

/// What judges a table.
struct Judge<'a> {
    subject: &'a dyn Subject,
    production: &'a Production<'a>,
    table: &'a ProductionTable,
    over: Over,
}

/// What is measured of a stroke at one time.
struct Moment {
    t: f64,
    force: f64,
    own: f64,
    expected: f64,
    said: Said,
}

impl Judge<'_> {
    fn watch(&self, rate: f32) -> Watch<'_, AnyNodes<'_>> {
        Watch::new(Reader::open(&self.table.bytes).unwrap(), rate).unwrap()
    }

    /// Lets `watch` see a stroke with noise; `see` gets every sample.
    fn seen(
        &self,
        watch: &Watch<'_, AnyNodes<'_>>,
        unit: &mut Unit,
        stroke: &Stroke,
        noise_of: u64,
        see: &mut dyn FnMut(Moment),
    ) -> StrokeEnd {
        let mut noise = unit_stream(SEED, noise_of);
        let mut state = watch.start();
        let run = &stroke.trajectory;
        for (i, t) in run.t.iter().enumerate() {
            let measured = run.force[i] + self.table.noise * score::<f64>(noise.next_u64());
            let sample = Sample {
                at: if self.over == Over::Time { *t } else { run.z[i].max(0.0) } as f32,
                force: measured as f32,
                speed: run.vz[i] as f32,
                command: self.subject.drive().command(*t) as f32,
            };
            let report = watch.step(unit, &mut state, &sample);
            assert!(!report.damaged);
            see(Moment {
                t: *t,
                force: run.force[i],
                own: report.own.into(),
                expected: report.expected.into(),
                said: report.verdict,
            });
        }
        watch.finish(unit, &state)
    }

    /// Strokes `numbers` of each of the `units` that complete the first of them.
    fn strokes(&self, units: std::ops::Range<u64>, numbers: std::ops::Range<u64>) -> Vec<(u64, Vec<(f64, Stroke)>)> {
        let strokes = Strokes { seed: SEED, numbers, friction: 0.03, every: PERIOD };
        let units: Vec<u64> = units.collect();
        let keep = |unit: u64, strokes: Vec<(f64, Stroke)>| {
            strokes.first().is_some_and(|(_, stroke)| stroke.is_complete()).then_some((unit, strokes))
        };
        let found = strokes.simulate(self.subject, self.production, &units, keep, || {}).unwrap();
        found.into_iter().flatten().collect()
    }

    /// Share of strokes without noise that stay within the band.
    fn band(&self, firsts: &[(u64, Vec<(f64, Stroke)>)]) -> f64 {
        let reader = Reader::open(&self.table.bytes).unwrap();
        let axis = reader.places();
        let is_within = |(_, strokes): &&(u64, Vec<(f64, Stroke)>)| {
            let run = &strokes[0].1.trajectory;
            let at = |i: usize| if self.over == Over::Time { run.t[i] } else { run.z[i] } as f32;
            let inside = (0..run.t.len()).filter(|i| at(*i) >= axis.first() && at(*i) <= axis.last());
            let mut inside = inside.map(|i| (reader.band(at(i)), run.force[i]));
            inside.all(|([low, high], force)| force >= low.into() && force <= high.into())
        };
        firsts.iter().filter(is_within).count() as f64 / firsts.len() as f64
    }

    /// False alarms of `units` that are not taught, and how many strokes they are of.
    fn untaught(&self, firsts: &[(u64, Vec<(f64, Stroke)>)], rate: f32) -> [usize; 2] {
        let watch = self.watch(rate);
        let alarms = parallel::map(firsts, |(number, strokes)| {
            let end = self.seen(&watch, &mut Unit::default(), &strokes[0].1, *number, &mut |_| {});
            end.verdict != Said::Free
        });
        [alarms.iter().filter(|alarm| **alarm).count(), alarms.len()]
    }
}

/// What taught units are judged by.
#[derive(Default)]
struct Taught {
    /// Squared differences from what is expected of the mean, and of the unit, and how many.
    squares: [f64; 3],
    count: f64,
    alarms: usize,
    /// Those of the friction.
    of_friction: usize,
    strokes: usize,
}

impl Judge<'_> {
    /// Units taught by three strokes, and what the next `later` ones say, between the `times` (s).
    fn taught(&self, units: std::ops::Range<u64>, later: u64, times: [f64; 2], rate: f32) -> Taught {
        let watch = self.watch(rate);
        let all = self.strokes(units, 0..3 + later);
        let each = parallel::map(&all, |(number, strokes)| {
            let (mut unit, mut found) = (Unit::default(), Taught::default());
            let reader = Reader::open(&self.table.bytes).unwrap();
            let mut of_three = unit;
            for (k, (_, stroke)) in strokes.iter().filter(|(_, stroke)| stroke.is_complete()).enumerate() {
                let noise = number * 64 + k as u64 + 1_000_000;
                if !unit.is_taught() {
                    let _ = self.seen(&watch, &mut unit, stroke, noise, &mut |_| {});
                    of_three = unit;
                    continue;
                }
                // What three strokes have told is expected, whatever the later ones tell.
                let _ = self.seen(&watch, &mut of_three.clone(), stroke, noise, &mut |at| {
                    if at.t >= times[0] && at.t <= times[1] {
                        let [mean, _] = reader.row(0, at.t as f32).unwrap();
                        for (sum, expected) in found.squares.iter_mut().zip([mean.into(), at.own, at.expected]) {
                            *sum += (at.force - expected) * (at.force - expected);
                        }
                        found.count += 1.0;
                    }
                });
                let end = self.seen(&watch, &mut unit, stroke, noise, &mut |_| {});
                found.strokes += 1;
                found.alarms += usize::from(end.verdict != Said::Free);
                found.of_friction += usize::from(end.rise > 3.0 * end.deviation && end.verdict == Said::Tight);
            }
            found
        });
        let mut sum = Taught::default();
        for one in each {
            (0..3).for_each(|k| sum.squares[k] += one.squares[k]);
            sum.count += one.count;
            sum.alarms += one.alarms;
            sum.of_friction += one.of_friction;
            sum.strokes += one.strokes;
        }
        sum
    }

    /// In what shares of the units a rise of the friction is found within three strokes, after a reference of twenty and two more: by the
    /// watch, and by a detector that knows the unit: the mean of its frictions since the rise, beside what they differ by from stroke to
    /// stroke.
    fn power(&self, units: std::ops::Range<u64>, rise: f64, rate: f32) -> [f64; 2] {
        let watch = self.watch(rate);
        let plan = Strokes { seed: SEED, numbers: 0..25, friction: 0.03, every: PERIOD };
        let most = slipfit_core::sampling::normal::upper_score::<f64>(rate.into());
        let units: Vec<u64> = units.collect();
        let found = parallel::map(&units, |number| {
            let (drawn, i) = self.production.draw_one(*number);
            let mut unit = Unit::default();
            let (mut is_found, mut is_known, mut sum) = (false, false, 0.0);
            for k in 0..25 {
                let own = plan.friction_of(*number, k);
                let is_risen = k >= 22;
                let friction = if is_risen { (1.0 + own) * (1.0 + rise) - 1.0 } else { own };
                let stroke = self.subject.stroke(&drawn, i, friction, PERIOD).ok()?;
                if !is_risen && !stroke.is_complete() {
                    return None;
                }
                let end = self.seen(&watch, &mut unit, &stroke, number * 64 + k + 9_000_000, &mut |_| {});
                if is_risen {
                    is_found |= matches!(end.verdict, Said::Tight | Said::Jam);
                    sum += rise + own;
                    let count = (k - 21) as f64;
                    is_known |= sum / count > most * 0.03 / libm::sqrt(count);
                }
            }
            Some([is_found, is_known])
        });
        let found: Vec<[bool; 2]> = found.into_iter().flatten().collect();
        [0, 1].map(|k| found.iter().filter(|each| each[k]).count() as f64 / found.len() as f64)
    }

    /// How long (s) after a drive was stopped by force the watch reports a jam, at worst of the `units`.
    fn jam(&self, units: std::ops::Range<u64>, times: &[f64]) -> f64 {
        let watch = self.watch(1e-3);
        let mut worst = 0.0f64;
        for (number, strokes) in self.strokes(units, 0..1) {
            for stop in times {
                let mut stroke = strokes[0].1.clone();
                let run = &mut stroke.trajectory;
                let drive = *self.subject.drive();
                let from = run.t.iter().position(|t| t >= stop).unwrap();
                let at = run.z[from];
                for i in from..run.t.len() {
                    (run.z[i], run.vz[i]) = (at, 0.0);
                    run.force[i] = drive.force(run.t[i], 0.0);
                }
                let mut told = None;
                let _ = self.seen(&watch, &mut Unit::default(), &stroke, number, &mut |moment| {
                    if moment.said == Said::Jam {
                        told.get_or_insert(moment.t);
                    }
                });
                worst = worst.max(told.unwrap_or(f64::INFINITY) - stop);
            }
        }
        worst
    }
}

/// The counts that a share of `count` has with a probability of 99.9 %, by the normal distribution with half a count on either side.
fn likely(share: f64, count: usize) -> [f64; 2] {
    let mean = share * count as f64;
    let reach = 3.29 * libm::sqrt(mean) + 0.5;
    [mean - reach, mean + reach]
}

/// Whether so many are `found`.
fn is_likely(share: f64, found: usize, count: usize) -> bool {
    let [least, most] = likely(share, count);
    (least..=most).contains(&(found as f64))
}

#[test]
#[ignore = "takes a minute in a release build"]
fn ten_thousand_units_of_the_slide_by_a_table_of_ten_thousand_others() {
    let scene = slide("cd-rom-slide");
    let production = Production::new(&scene, None, 0.0, 1).unwrap();
    let table = make(&scene, &production, &wish(10_000), || {}).unwrap();
    let judge = Judge { subject: &scene, production: &production, table: &table, over: Over::Time };
    assert!(table.bytes.len() <= 16_384);

    let firsts = judge.strokes(10_000..20_000, 0..1);
    let band = judge.band(&firsts);
    println!("band: {:.4} of {} strokes", band, firsts.len());
    for rate in [1e-2, 1e-3] {
        let [alarms, strokes] = judge.untaught(&firsts, rate);
        println!("not taught, at {rate}: {alarms} of {strokes} strokes, likely {:?}", likely(rate.into(), strokes));
        assert!(is_likely(rate.into(), alarms, strokes), "{rate} {alarms} {strokes}");
    }
    drop(firsts);
    let taught = judge.taught(20_000..24_000, 10, [0.2, 1.45], 1e-3);
    let [mean, own, within] = taught.squares.map(|sum| libm::sqrt(sum / taught.count));
    println!("force by the mean {mean:.4} N, after teach-in {own:.4} N, within the stroke {within:.4} N");
    println!(
        "taught, at 1e-3: {} of {} strokes, likely {:?}",
        taught.alarms,
        taught.strokes,
        likely(1e-3, taught.strokes)
    );
    let powers = [0.2, 0.1].map(|rise| judge.power(30_000..30_600, rise, 1e-3));
    println!("rises of 20 and 10 %, found and by who knows: {powers:?}");
    let jam = judge.jam(10_000..10_040, &[0.35, 0.6, 0.77, 1.0, 1.3]);
    println!("a jam is reported after {jam:.4} s");

    assert!(is_likely(1e-3, taught.alarms, taught.strokes), "{} {}", taught.alarms, taught.strokes);
    assert!((0.987..=0.993).contains(&band), "{band}");
    // Before the stroke 0.030 N were asked for: 0.0303 N are left, of which the stroke's own friction, which nothing before it tells, is
    // the greater part. Within the stroke it is known.
    assert!(mean <= 0.105 && own <= 0.0305 && within <= 0.030, "{mean} {own} {within}");
    for [found, known] in powers {
        assert!(found >= 0.9 * known, "{found} {known}");
    }
    assert!(jam <= 0.020, "{jam}");
}

#[test]
#[ignore = "takes a minute in a release build"]
fn mechanisms_are_judged_likewise() {
    for name in ["slider-crank", "linear-guide"] {
        let mechanism = mechanism(name);
        let driven = ByDrive::new(&mechanism, 0).unwrap();
        let production = Production::of_mechanism(&mechanism, None, 0.0, 1).unwrap();
        let table = make(&driven, &production, &wish(4000), || {}).unwrap();
        let judge = Judge { subject: &driven, production: &production, table: &table, over: Over::Time };
        let firsts = judge.strokes(10_000..14_000, 0..1);
        let band = judge.band(&firsts);
        let [alarms, strokes] = judge.untaught(&firsts, 1e-3);
        let taught = judge.taught(20_000..20_400, 10, [0.0, 10.0], 1e-3);
        let [mean, own, within] = taught.squares.map(|sum| libm::sqrt(sum / taught.count));
        let powers = [0.2, 0.1].map(|rise| judge.power(30_000..30_200, rise, 1e-3));
        println!(
            "{name}: greatest {:.4}, band {band:.4}, by the mean {mean:.5}, own {own:.5}, within {within:.5}, not taught {alarms} of {strokes}, taught {} \
             of {}, rises of 20 and 10 %: {powers:?}",
            table.greatest, taught.alarms, taught.strokes
        );
        assert!(own <= 1.05 * mean && within <= 1.05 * own, "{name}");
        assert!(is_likely(1e-3, alarms, strokes) && is_likely(1e-3, taught.alarms, taught.strokes), "{name}");
        // Within what the two samples, that of the table and this one, leave open.
        assert!((band - 0.99).abs() < 3.0 * libm::sqrt(0.99 * 0.01 / strokes as f64) * 1.5, "{name} {band}");
    }
}

/// The same on few units, as they are seen in seconds.
#[test]
fn a_table_of_few_units_teaches_and_watches_others() {
    let scene = slide("cd-rom-slide");
    let production = Production::new(&scene, None, 0.0, 1).unwrap();
    let small = Wish { period: 2e-3, ..wish(600) };
    let table = make(&scene, &production, &small, || {}).unwrap();
    let again = make(&scene, &production, &small, || {}).unwrap();
    assert_eq!(table.bytes, again.bytes);
    let reader = Reader::open(&table.bytes).unwrap();
    assert_eq!(reader.record(), &table.record);
    assert!(table.differences[2] < 0.6 * table.differences[0], "{:?}", table.differences);
    assert!(table.differences[2] < table.differences[1]);
    // A flipped bit anywhere is refused.
    for bit in (0..table.bytes.len() * 8).step_by(997) {
        let mut bytes = table.bytes.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert!(Reader::open(&bytes).is_err(), "{bit}");
    }
    let jammed = Strokes { seed: SEED, numbers: 0..1, friction: 0.03, every: 2e-3 };
    let is_jammed = |_: u64, strokes: Vec<(f64, Stroke)>| {
        strokes.into_iter().next().filter(|(_, stroke)| stroke.outcome.verdict == Verdict::Jammed)
    };
    let units: Vec<u64> = (1000..1060).collect();
    let jammed = jammed.simulate(&scene, &production, &units, is_jammed, || {}).unwrap();
    let judge = Judge { subject: &scene, production: &production, table: &table, over: Over::Time };
    let watch = judge.watch(1e-3);
    let mut count = 0;
    for (_, stroke) in jammed.into_iter().flatten() {
        count += 1;
        let end = judge.seen(&watch, &mut Unit::default(), &stroke, 1, &mut |_| {});
        assert_eq!(end.verdict, Said::Jam);
    }
    assert!(count > 5, "{count}");
}
