//! Tight, by the table's band for this unit's level.

use super::{Limits, MonitorError, Sample};
use crate::table::{Nodes, Place, Table};

/// Where on a table's axis of levels a unit is, and the tightest that it may be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Band {
    level: Place,
    tightest: Place,
}

impl Band {
    /// The unit of `level`, and one that is tighter by `band`: by less where the axis ends before, or where a unit comes that
    /// ends differently from the ones before it. Forces beyond those are of no unit.
    pub fn of<V: Nodes>(table: &Table<'_, 2, V>, level: f32, band: f32) -> Result<Self, MonitorError> {
        let [levels, _] = table.axes();
        let is_mixed = |place| table.is_mixed(&[place, Place::default()]);
        let place = levels.locate(level);
        if is_mixed(place) {
            let between = [levels.node(place.node), levels.node(place.node + 1)];
            return Err(MonitorError::Mixed { level, between });
        }
        let highest = levels.locate(level + band);
        let changes = (place.node..highest.node).find(|node| is_mixed(Place::after(*node)));
        let tightest = match changes {
            Some(node) => Place::at(node),
            None if is_mixed(highest) => Place::at(highest.node),
            None => Place { outside: 0, ..highest },
        };
        Ok(Self { level: place, tightest })
    }
}

/// Averages of the force beyond the table's (N), along the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TightWatch {
    beyond: f32,
    /// The average of the average, so that the two tell how it rises.
    slower: f32,
    /// Whether the last command that was not zero leads backwards.
    is_backwards: bool,
    /// How long no sample has been compared (s).
    idle: f32,
    /// What the table's force at the last sample made of it.
    last: Tightness,
}

/// Force against the table's band.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tightness {
    /// The force (N) that the table has for this unit now.
    pub expected: f32,
    /// By how much (N) the averaged force may exceed it.
    pub band: f32,
    /// By how much (N) it does, in the direction of the command.
    pub excess: f32,
    /// How fast (N/s) that rises.
    pub rise: f32,
    /// Whether it rises too fast.
    is_fast: bool,
}

impl Tightness {
    /// Whether the averaged force is above the band or leaving it.
    pub fn is_tight(&self) -> bool {
        self.excess > self.band || self.is_fast
    }
}

impl TightWatch {
    /// Whether no sample has been compared for longer than [`Limits::hold`].
    pub(super) fn is_without(&self, limits: &Limits) -> bool {
        self.idle > limits.hold
    }

    /// Compares `sample` with what `table` has for the `band`. Passes over a force that is not finite, and a time at which the
    /// table has none.
    #[inline]
    pub(super) fn step<V: Nodes>(
        &mut self,
        table: &Table<'_, 2, V>,
        band: &Band,
        limits: &Limits,
        sample: &Sample,
    ) -> Tightness {
        let [_, times] = table.axes();
        let time = times.locate(sample.time);
        let [unit, tightest] = [band.level, band.tightest].map(|level| table.lookup_at(&[level, time]));
        self.idle += limits.period;
        if unit.is_unusable() || tightest.is_unusable() {
            return self.last;
        }
        let expected = unit.force;
        let apart = (tightest.force - expected).abs();
        let band = apart + limits.margin;
        if sample.command != 0.0 && sample.command.is_finite() {
            self.is_backwards = sample.command < 0.0;
        }
        let per_step = 1.0 / (limits.smoothing + limits.period);
        let weight = limits.period * per_step;
        if let Some(force) = sample.measured_force() {
            self.idle = 0.0;
            self.beyond += weight * (force - expected - self.beyond);
            self.slower += weight * (self.beyond - self.slower);
        }
        let rise = (self.beyond - self.slower) * per_step;
        let (excess, rise) = if self.is_backwards { (-self.beyond, -rise) } else { (self.beyond, rise) };
        // What the band itself allows within its time is no alarm.
        let is_fast = rise > limits.rise + apart * per_step;
        self.last = Tightness { expected, band, excess, rise, is_fast };
        self.last
    }
}

#[cfg(test)]
mod tests {
    use super::{Band, Limits, Sample, TightWatch, Tightness};
    use crate::table::{AxisKind, Table, example};

    /// 1 N at level 0 and 2 N at level 1, times `factor`, for all of a second.
    fn last(factor: f32, samples: impl Iterator<Item = Sample>) -> Tightness {
        let axes = [(AxisKind::Level, 2, 1.0), (AxisKind::Time, 2, 1.0)];
        let bytes = example::table(&axes, |node| factor * if node < 2 { 1.0 } else { 2.0 });
        let table = Table::<2>::open(&bytes).unwrap();
        let limits = Limits { margin: 0.1, rise: 1e6, ..Limits::for_noise(1e-3, 0.0) };
        let mut watch = TightWatch::default();
        let band = Band::of(&table, 0.0, limits.band).unwrap();
        samples.map(|sample| watch.step(&table, &band, &limits, &sample)).last().unwrap()
    }

    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many samples")]
    fn more_force_is_tight_whichever_way_the_drive_runs() {
        for way in [1.0, -1.0] {
            let stroke = |force: f32, command: f32| {
                let sample = Sample { time: 0.5, force: way * force, speed: way * 0.1, command: way * command };
                last(way, [sample; 500].into_iter())
            };
            for (force, tight) in [(1.0, false), (1.5, false), (1.7, true), (0.2, false), (-1.0, false)] {
                assert_eq!(stroke(force, 0.1).is_tight(), tight, "{way} {force}");
                assert!((stroke(force, 0.1).excess - (force - 1.0)).abs() < 1e-5);
            }
            // Where the command ends, the way stays.
            let sample = |command| Sample { time: 0.5, force: way * 1.7, speed: 0.0, command };
            assert!(last(way, [sample(way * 0.1), sample(0.0)].into_iter().cycle().take(500)).is_tight());
        }
    }

    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many samples")]
    fn no_force_leaves_anything_behind_that_is_not_finite() {
        let sample = |force| Sample { time: 0.5, force, speed: 0.1, command: 0.1 };
        let free = last(1.0, [sample(1.0); 500].into_iter());
        for bad in [f32::MAX, f32::INFINITY, f32::NAN] {
            let glitches = [sample(1.0), sample(bad), sample(-bad), sample(1.0)];
            assert_eq!(last(1.0, glitches.into_iter().cycle().take(500)), free, "{bad}");
        }
        // A sample whose time is unknown is compared with nothing.
        let lost = [f32::NAN, f32::INFINITY].map(|time| Sample { time, ..sample(1.7) });
        assert_eq!(last(1.0, lost.into_iter().cycle().take(500).chain([sample(1.0)])), free);
        let greatest = [sample(1e9), sample(-1e9)].into_iter().cycle().take(500);
        let Tightness { excess, rise, .. } = last(1.0, greatest);
        assert!(excess.is_finite() && rise.is_finite());
    }

    /// The averages as a filter of first order and one behind it have them, in f64.
    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many samples")]
    fn averages_are_those_of_two_filters() {
        let axes = [(AxisKind::Level, 3, 1.0), (AxisKind::Time, 2, 1.0)];
        let bytes = example::table(&axes, |node| (1 + node / 2) as f32);
        let table = Table::<2>::open(&bytes).unwrap();
        let limits = Limits { margin: 0.1, rise: 3.0, band: 0.5, smoothing: 0.02, ..Limits::for_noise(1e-3, 0.0) };
        let band = Band::of(&table, 0.25, limits.band).unwrap();
        let mut watch = TightWatch::default();
        let (mut beyond, mut slower) = (0.0, 0.0);
        let weight = 1e-3 / 0.021;
        for i in 0..400 {
            let force = 1.25 + 0.4 * libm::sin(0.05 * f64::from(i)) + 0.002 * f64::from(i);
            let sample = Sample { time: 0.5, force: force as f32, speed: 0.1, command: 0.1 };
            let found = watch.step(&table, &band, &limits, &sample);
            beyond += weight * (force - 1.25 - beyond);
            slower += weight * (beyond - slower);
            let rise = (beyond - slower) / 0.021;
            let near = |found: f32, expected: f64| (f64::from(found) - expected).abs() < 1e-4 * (1.0 + expected.abs());
            assert!(near(found.expected, 1.25) && near(found.band, 0.6), "{i}: {found:?}");
            assert!(near(found.excess, beyond) && near(found.rise, rise), "{i}: {found:?} {beyond} {rise}");
            // Beyond the band, or rising by more than the limit and what the band allows within its time.
            let (over, fast) = (beyond - 0.6, rise - (3.0 + 0.5 / 0.021));
            if over.abs() > 1e-3 && fast.abs() > 1e-2 {
                assert_eq!(found.is_tight(), over > 0.0 || fast > 0.0, "{i}: {over} {fast}");
            }
        }
        // A force that rises is tight before its average is beyond the band.
        let patient = Limits { margin: 2.0, band: 0.0, ..limits };
        let band = Band::of(&table, 0.25, patient.band).unwrap();
        let mut watch = TightWatch::default();
        let sample = Sample { time: 0.5, force: 4.0, speed: 0.1, command: 0.1 };
        let mut found = (0..100).map(|_| watch.step(&table, &band, &patient, &sample));
        let tight = found.position(|found| found.is_tight()).unwrap();
        // 2.75·w and its average give (2.75·w − 2.75·w²)/0.021 > 3 at once, w = 1/21.
        assert!(tight == 0 && found.next().unwrap().excess < 0.5, "{tight}");
    }

    #[test]
    fn without_samples_that_are_compared_it_idles() {
        let axes = [(AxisKind::Level, 2, 1.0), (AxisKind::Time, 2, 1.0)];
        let bytes = example::table(&axes, |_| 1.0);
        let table = Table::<2>::open(&bytes).unwrap();
        let limits = Limits { hold: 0.0035, ..Limits::for_noise(1e-3, 0.0) };
        let band = Band::of(&table, 0.0, 0.5).unwrap();
        let good = Sample { time: 0.5, force: 1.0, speed: 0.1, command: 0.1 };
        for useless in [Sample { time: 1.5, ..good }, Sample { time: -0.1, ..good }, Sample { force: f32::NAN, ..good }]
        {
            let mut watch = TightWatch::default();
            let mut idles = |sample| {
                let _ = watch.step(&table, &band, &limits, &sample);
                watch.is_without(&limits)
            };
            assert_eq!([useless; 5].map(&mut idles), [false, false, false, true, true], "{useless:?}");
            assert_eq!([good, useless, good].map(&mut idles), [false; 3]);
        }
    }

    /// What the last command that was not zero says; a command that is no number says nothing.
    #[test]
    fn the_way_is_that_of_the_last_command() {
        let sample = |command, force| Sample { time: 0.5, force, speed: 0.0, command };
        for (way, bad) in [(1.0, f32::NAN), (1.0, f32::NEG_INFINITY), (-1.0, f32::INFINITY), (-1.0, f32::NAN)] {
            let start = core::iter::once(sample(way * 0.1, 1.0));
            let samples = start.chain([sample(bad, 1.0 + way), sample(0.0, 1.0 + way)].into_iter().cycle().take(100));
            let Tightness { excess, .. } = last(1.0, samples);
            assert!(excess > 0.9, "{way} {bad}: {excess}");
        }
    }
}
