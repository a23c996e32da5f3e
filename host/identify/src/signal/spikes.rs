//! Single wrong samples, found by their distance from a running median: F. R. Hampel's identifier (1971).

/// Samples on either side of the one that is judged.
const HALF: usize = 3;
/// Distance, in standard deviations of its neighbourhood, beyond which a sample is wrong.
const FAR: f64 = 6.0;
/// Samples among which the deviation is estimated.
const NEIGHBOURHOOD: usize = 200;

/// Replaces the spikes of a `signal` by the median about them; how many there were.
///
/// A spike is far from the running median, which keeps jumps, and from the middle between its neighbours, which keeps slopes.
pub fn remove(signal: &mut [f64]) -> usize {
    let n = signal.len();
    if n < 2 * HALF + 1 {
        return 0;
    }
    let medians: Vec<f64> = (0..n)
        .map(|i| {
            let start = i.saturating_sub(HALF).min(n - 2 * HALF - 1);
            median(&mut signal[start..=start + 2 * HALF].to_vec())
        })
        .collect();
    let from_middle: Vec<f64> = (0..n)
        .map(|i| {
            let reach = HALF.min(i).min(n - 1 - i);
            let middles = (1..=reach).map(|k| 0.5 * (signal[i - k] + signal[i + k]));
            let mut middles: Vec<f64> = middles.collect();
            if middles.is_empty() { 0.0 } else { (signal[i] - median(&mut middles)).abs() }
        })
        .collect();
    let scales: Vec<f64> =
        from_middle.chunks(NEIGHBOURHOOD).map(|chunk| 1.4826 * median(&mut chunk.to_vec())).collect();
    // The neighbourhood before and after counts as well, as motion starts and ends between them.
    let scale = |i: usize| {
        let block = i / NEIGHBOURHOOD;
        scales[block.saturating_sub(1)..(block + 2).min(scales.len())].iter().fold(0.0, |most: f64, one| most.max(*one))
    };
    let mut count = 0;
    for i in 0..n {
        let far = FAR * scale(i);
        if far > 0.0 && (signal[i] - medians[i]).abs() > far && from_middle[i] > far {
            signal[i] = medians[i];
            count += 1;
        }
    }
    count
}

/// The median of `values`, of which there is at least one.
pub fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use slipfit_core::sampling::stream::unit_stream;
    use slipfit_tolerance::failure::subset::normals;

    use super::remove;

    #[test]
    fn spikes_go_and_noise_stays() {
        let clean: Vec<f64> = normals(&mut unit_stream(1, 0), 5000);
        let mut signal = clean.clone();
        assert_eq!(remove(&mut signal), 0);
        assert_eq!(signal, clean);
        for i in (10..5000).step_by(20) {
            signal[i] += 12.0;
        }
        assert_eq!(remove(&mut signal), 250);
        assert!(signal.iter().all(|value| value.abs() < 6.0));
    }

    #[test]
    fn a_jump_stays() {
        let mut jump: Vec<f64> = normals(&mut unit_stream(2, 0), 1000);
        jump.iter_mut().skip(500).for_each(|value| *value += 100.0);
        assert_eq!(remove(&mut jump), 0);
    }
}
