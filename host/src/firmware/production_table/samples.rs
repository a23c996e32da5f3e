//! A stroke as a table of a production sees it: force and speed by time, or by how far it has come.

use crate::population::stroke::Stroke;

/// What such a table is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// Time since the start of the run.
    Time,
    /// Travel.
    Position,
}

/// Samples of a stroke at equal intervals.
#[derive(Clone, Debug)]
pub struct Samples {
    /// By what share its friction differs from the unit's.
    pub friction: f64,
    /// Places, ascending.
    pub at: Vec<f32>,
    /// Force (N).
    pub force: Vec<f32>,
    /// Speed (m/s).
    pub speed: Vec<f32>,
}

impl Samples {
    /// Those of `stroke` over time, or over how far it has come, whose travel is along `sign`.
    pub fn of(friction: f64, stroke: &Stroke, over: Over, sign: f64) -> Self {
        let run = &stroke.trajectory;
        let at = match over {
            Over::Time => run.t.iter().map(|t| *t as f32).collect(),
            Over::Position => {
                let mut farthest = 0.0f64;
                let mut come = |z: &f64| {
                    farthest = farthest.max(sign * z);
                    farthest as f32
                };
                run.z.iter().map(&mut come).collect()
            }
        };
        let single = |values: &[f64]| values.iter().map(|x| *x as f32).collect();
        Self { friction, at, force: single(&run.force), speed: single(&run.vz) }
    }

    /// The last place.
    pub fn end(&self) -> f32 {
        self.at.last().copied().unwrap_or(0.0)
    }

    /// Values between which it is straight, at ascending `places`; beyond its ends those there.
    pub fn at_places(&self, values: &[f32], places: &[f64]) -> Vec<f64> {
        let mut next = 0;
        let value = |place: &f64| {
            while next < self.at.len() && f64::from(self.at[next]) < *place {
                next += 1;
            }
            let last = self.at.len().saturating_sub(1);
            let (low, high) = (next.saturating_sub(1).min(last), next.min(last));
            let [from, to] = [low, high].map(|i| f64::from(self.at[i]));
            let part = if to > from { ((place - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
            f64::from(values[low]) + part * (f64::from(values[high]) - f64::from(values[low]))
        };
        places.iter().map(value).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Samples;

    #[test]
    fn between_samples_it_is_straight() {
        let samples = Samples {
            friction: 0.0,
            at: vec![0.0, 0.0, 1.0, 3.0, 3.0],
            force: vec![5.0, 6.0, 8.0, 10.0, 11.0],
            speed: vec![0.0; 5],
        };
        let found = samples.at_places(&samples.force, &[-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(found, [5.0, 5.0, 7.0, 8.0, 9.0, 10.0, 11.0]);
    }
}
