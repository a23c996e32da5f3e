//! How far strokes are from what is expected of them, place by place.

/// Differences that this share of the strokes exceeds at a place make the width there.
const BEYOND: f64 = 0.005;

/// The part of the places over which the greatest width counts, to either side: events come sooner in one unit than in another.
const WIDENED: f64 = 0.01;

/// Widths below this part of the mean one count as that: i16 would not keep them.
const WIDTH_LEAST: f64 = 0.05;

/// Widths at the nodes, of which `all` holds the differences (N) of each stroke: what few of them exceed there or near it in the direction
/// of `sign`.
pub fn widths(all: &[Vec<f64>], sign: f64) -> Vec<f64> {
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
pub fn root_mean_square(all: &[Vec<f64>]) -> f64 {
    let count = all.iter().map(Vec::len).sum::<usize>();
    libm::sqrt(all.iter().flatten().map(|x| x * x).sum::<f64>() / count.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::{root_mean_square, widths};

    #[test]
    fn few_strokes_exceed_a_width_there_or_near_it() {
        // A thousand strokes from −1 to nearly 1 at each of 200 places, ten times as far at the hundredth.
        let stroke = |k: i32| {
            let one = f64::from(k - 500) / 500.0;
            (0..200).map(|i| if i == 100 { 10.0 * one } else { one }).collect()
        };
        let all: Vec<Vec<f64>> = (0..1000).map(stroke).collect();
        let above = widths(&all, 1.0);
        for (i, width) in above.iter().enumerate() {
            // The greatest within one hundredth of the places.
            let expected = if (98..=102).contains(&i) { 9.9 } else { 0.99 };
            assert!((width - expected).abs() < 0.021, "{i} {width}");
        }
        assert!(widths(&all, -1.0)[0] > above[0]);
        // None is much smaller than the mean one.
        let half = |k: i32| (0..200).map(|i| if i < 100 && k < 500 { 1.0 } else { 0.0 }).collect();
        let half: Vec<Vec<f64>> = (0..1000).map(half).collect();
        assert_eq!(widths(&half, 1.0)[199], 0.05 * 0.5);
        assert!((root_mean_square(&[vec![3.0, 0.0], vec![0.0, 4.0]]) - 2.5).abs() < 1e-12);
    }
}
