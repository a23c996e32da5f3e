//! Where things go in a chart: ticks, thinned lines, labels that do not touch, which of many lines to show.

use std::ops::Range;

/// Least and greatest of `values`; `None` of none.
pub fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.map(|value| (value, value)).reduce(|(low, high), (value, _)| (low.min(value), high.max(value)))
}

/// An interval with round ticks.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    /// Distance between ticks: 1, 2 or 5 times a power of ten.
    pub step: f64,
    /// Digits after the point that tell them apart.
    pub decimals: usize,
}

impl Ticks {
    /// At most `most` intervals over `span`; `None` unless the span is positive, finite and not extreme.
    pub fn over(span: f64, most: f64) -> Option<Self> {
        if !(1e-100..=1e100).contains(&span) {
            return None;
        }
        let power = libm::log10(span / most).floor();
        let decade = libm::pow(10.0, power);
        let (multiple, carry) = [1.0, 2.0, 5.0]
            .into_iter()
            .find(|multiple| multiple * decade * most >= span * (1.0 - 1e-9))
            .map_or((10.0, 1.0), |multiple| (multiple, 0.0));
        Some(Self { step: multiple * decade, decimals: (-power - carry).max(0.0) as usize })
    }

    /// The ticks within `low..=high`.
    pub fn within(&self, low: f64, high: f64) -> Vec<f64> {
        let first = (low / self.step - 1e-6).ceil() as i64;
        let last = (high / self.step + 1e-6).floor() as i64;
        (first..=last).map(|i| i as f64 * self.step).collect()
    }
}

/// The points that a polyline needs to stay within `tolerance` of all (Douglas and Peucker, along the ordinate), at
/// most `most`: beyond that the tolerance doubles. Abscissae ascend.
pub fn thinned(points: &[(f64, f64)], mut tolerance: f64, most: usize) -> Vec<(f64, f64)> {
    loop {
        let kept = needed(points, tolerance);
        if kept.len() <= most.max(2) {
            return kept;
        }
        tolerance *= 2.0;
    }
}

fn needed(points: &[(f64, f64)], tolerance: f64) -> Vec<(f64, f64)> {
    let mut keep = vec![false; points.len()];
    let mut spans = Vec::new();
    if let [_, .., _] = points {
        spans.push((0, points.len() - 1));
    }
    for end in [points.first().and(Some(0)), points.len().checked_sub(1)].into_iter().flatten() {
        keep[end] = true;
    }
    while let Some((a, b)) = spans.pop() {
        let ((xa, ya), (xb, yb)) = (points[a], points[b]);
        let slope = if xb > xa { (yb - ya) / (xb - xa) } else { 0.0 };
        let off = |i: &usize| (points[*i].1 - ya - slope * (points[*i].0 - xa)).abs();
        let farthest = (a + 1..b).max_by(|i, j| off(i).total_cmp(&off(j)));
        if let Some(i) = farthest.filter(|i| off(i) > tolerance) {
            keep[i] = true;
            spans.extend([(a, i), (i, b)]);
        }
    }
    points.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

/// The order from top to bottom in which the labels of lines that end at these `rows` stand. Ends closer than `near` cannot be
/// told apart, so that their labels keep the order of the lines: the last on top, unless it ends below the first.
pub fn stacked(rows: &[f64], near: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|i, j| rows[*i].total_cmp(&rows[*j]));
    for together in order.chunk_by_mut(|i, j| rows[*j] - rows[*i] < near) {
        together.sort_unstable();
        if let [first, .., last] = *together
            && rows[last] < rows[first] + 0.5 * near
        {
            together.reverse();
        }
    }
    order
}

/// `wanted`, from top to bottom, moved as little as possible (least squares) to be `pitch` apart, all within `range` if there is
/// room.
pub fn apart(wanted: &[f64], pitch: f64, range: Range<f64>) -> Vec<f64> {
    // Without the pitch this is a regression that must not descend: pool what does.
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for (i, row) in wanted.iter().enumerate() {
        let mut pool = (row - i as f64 * pitch, 1);
        while let Some((mean, count)) = pools.pop_if(|(mean, _)| *mean > pool.0) {
            let together = count + pool.1;
            pool = ((mean * count as f64 + pool.0 * pool.1 as f64) / together as f64, together);
        }
        pools.push(pool);
    }
    let end = range.end - wanted.len().saturating_sub(1) as f64 * pitch;
    let rows = pools.into_iter().flat_map(|(mean, count)| vec![mean.min(end).max(range.start); count]);
    rows.enumerate().map(|(i, row)| row + i as f64 * pitch).collect()
}

/// Indices of at most `most` (3 or more) of the ascending `levels`: every so manyth from the one nearest zero, the
/// first and the last.
pub fn chosen(levels: &[f64], most: usize) -> Vec<usize> {
    let Some(last) = levels.len().checked_sub(1) else { return Vec::new() };
    let nearest = (0..=last).min_by(|i, j| levels[*i].abs().total_cmp(&levels[*j].abs())).unwrap_or(0);
    (1..=last.max(1))
        .map(|stride| {
            (0..=last).filter(|i| i % stride == nearest % stride || *i == 0 || *i == last).collect::<Vec<_>>()
        })
        .find(|chosen| chosen.len() <= most)
        .unwrap_or_else(|| vec![0, last])
}

#[cfg(test)]
mod tests {
    use super::{Ticks, apart, chosen, stacked, thinned};

    #[test]
    fn ticks_are_round() {
        let ticks = |span, most| Ticks::over(span, most).map(|ticks| (ticks.step, ticks.decimals));
        assert_eq!(ticks(200.0, 10.0), Some((20.0, 0)));
        assert_eq!(ticks(1500.0, 10.0), Some((200.0, 0)));
        assert_eq!(ticks(0.24, 6.0).map(|(_, decimals)| decimals), Some(2));
        assert_eq!(ticks(9.0, 10.0), Some((1.0, 0)));
        assert_eq!(ticks(6.0, 10.0), Some((1.0, 0)));
        assert_eq!(ticks(5.5, 10.0).unwrap().1, 0);
        assert_eq!([ticks(0.0, 6.0), ticks(f64::NAN, 6.0), ticks(f64::INFINITY, 6.0)], [None, None, None]);
        let ticks = Ticks::over(0.24, 6.0).unwrap();
        assert_eq!(ticks.within(-0.01, 0.24).len(), 5);
    }

    #[test]
    fn thinning_keeps_corners_and_drops_what_cannot_be_seen() {
        let straight: Vec<_> = (0..1000).map(|i| (f64::from(i), 2.0 * f64::from(i))).collect();
        assert_eq!(thinned(&straight, 1e-6, 600), [straight[0], straight[999]]);
        let spike: Vec<_> = (0..1000).map(|i| (f64::from(i), f64::from(u8::from(i == 500)))).collect();
        assert!(thinned(&spike, 1e-6, 600).contains(&(500.0, 1.0)));
        let noise: Vec<_> = (0..5000).map(|i| (f64::from(i), f64::from(i * 7919 % 101))).collect();
        assert!(thinned(&noise, 1e-6, 600).len() <= 600);
        assert_eq!((thinned(&[], 1.0, 600), thinned(&[(1.0, 1.0)], 1.0, 600)), (vec![], vec![(1.0, 1.0)]));
    }

    #[test]
    fn labels_do_not_touch() {
        assert_eq!(apart(&[20.0, 22.0, 50.0], 10.0, 0.0..60.0), [16.0, 26.0, 50.0]);
        assert_eq!(apart(&[0.0, 1.0, 50.0], 10.0, 0.0..60.0), [0.0, 10.0, 50.0]);
        assert_eq!(apart(&[58.0, 59.0, 60.0], 10.0, 0.0..60.0), [40.0, 50.0, 60.0]);
    }

    #[test]
    fn labels_of_lines_that_coincide_keep_their_order() {
        assert_eq!(stacked(&[30.0, 10.0, 20.0], 4.0), [1, 2, 0]);
        // Two groups: what differs by a hair does not count, what falls from line to line does.
        assert_eq!(stacked(&[50.0, 50.1, 49.9, 10.0, 12.0, 14.0], 4.0), [3, 4, 5, 2, 1, 0]);
        assert_eq!(stacked(&[5.0; 4], 4.0), [3, 2, 1, 0]);
        assert_eq!(apart(&[50.2, 50.0, 49.9], 10.0, 0.0..100.0).windows(2).filter(|two| two[0] < two[1]).count(), 2);
    }

    #[test]
    fn few_lines_of_many() {
        let levels: Vec<f64> = (0..81).map(|i| -2.0 + 0.1 * f64::from(i)).collect();
        assert_eq!(chosen(&levels, 9), [0, 10, 20, 30, 40, 50, 60, 70, 80]);
        let halves: Vec<f64> = (0..11).map(|i| 0.5 * f64::from(i)).collect();
        assert_eq!(chosen(&halves, 9), [0, 2, 4, 6, 8, 10]);
        assert_eq!((chosen(&[], 9), chosen(&[1.0], 9), chosen(&[1.0, 2.0], 9)), (vec![], vec![0], vec![0, 1]));
        for count in 1..200 {
            let levels: Vec<f64> = (0..count).map(|i| f64::from(i) - 7.0).collect();
            let chosen = chosen(&levels, 9);
            assert!(chosen.len() <= 9 && chosen.contains(&0) && chosen.contains(&(levels.len() - 1)));
            assert!(count <= 7 || chosen.contains(&7));
        }
    }
}
