//! Whether a slide tips: a pin that was above its wall comes to rest on it.

use slipfit_core::slide::CONTACTS;

/// The walls below the pins, as they were.
#[derive(Default)]
pub struct Tipping {
    were_free: [bool; CONTACTS / 4],
}

impl Tipping {
    /// Whether one of the walls, free until now, meets its pin at these `gaps` (m).
    pub fn begins(&mut self, gaps: &[f64; CONTACTS]) -> bool {
        let walls = gaps.iter().skip(3).step_by(4);
        let mut meets = false;
        for (was_free, gap) in self.were_free.iter_mut().zip(walls) {
            meets |= *was_free && *gap <= 0.0;
            *was_free = *gap > 0.0;
        }
        meets
    }
}

#[cfg(test)]
mod tests {
    use super::Tipping;
    use slipfit_core::slide::CONTACTS;

    #[test]
    fn a_wall_counts_that_was_free() {
        let mut tipping = Tipping::default();
        let gaps = |wall: f64| {
            let mut gaps = [-1e-6; CONTACTS];
            gaps[7] = wall;
            gaps
        };
        // Pressed from the start; then free; then met; then still there.
        assert_eq!([-1e-6, 1e-6, -1e-6, -1e-6].map(|wall| tipping.begins(&gaps(wall))), [false, false, true, false]);
    }
}
