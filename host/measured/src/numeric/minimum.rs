//! The minimum of a function of a few variables without its derivatives.

/// Evaluations that a search may take.
const MOST: usize = 4000;

/// The lowest point that the simplex of J. Nelder and R. Mead ("A simplex method for function minimization", The Computer
/// Journal 7, 1965) finds from `start`, whose first steps are `steps`: restarted until it no longer gains 1e-10. Values
/// that are not finite count as highest.
pub fn minimise<const N: usize>(
    start: [f64; N],
    steps: [f64; N],
    function: impl Fn(&[f64; N]) -> f64,
) -> ([f64; N], f64) {
    let value = |point: &[f64; N]| {
        let value = function(point);
        if value.is_nan() { f64::INFINITY } else { value }
    };
    let mut best = (start, value(&start));
    let mut steps = steps;
    for _ in 0..6 {
        let before = best.1;
        best = simplex(best, steps, &value);
        if before.is_finite() && before - best.1 <= 1e-10 * before.abs().max(1.0) {
            break;
        }
        steps = steps.map(|step| 0.3 * step);
    }
    best
}

fn simplex<const N: usize>(
    start: ([f64; N], f64),
    steps: [f64; N],
    value: &impl Fn(&[f64; N]) -> f64,
) -> ([f64; N], f64) {
    let mut corners = vec![start];
    for (i, step) in steps.iter().enumerate() {
        let mut point = start.0;
        point[i] += step;
        corners.push((point, value(&point)));
    }
    for _ in 0..MOST {
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (best, worst) = (corners[0], corners[N]);
        let size = (0..N).map(|i| ((worst.0[i] - best.0[i]) / steps[i]).abs()).fold(0.0, f64::max);
        if size < 1e-9 || (worst.1 - best.1).abs() <= 1e-13 * best.1.abs() && size < 1e-5 {
            break;
        }
        let mut middle = [0.0; N];
        for corner in &corners[..N] {
            middle.iter_mut().zip(corner.0).for_each(|(sum, x)| *sum += x / N as f64);
        }
        let along = |factor: f64| {
            let mut point = middle;
            point.iter_mut().zip(worst.0).for_each(|(x, from)| *x += factor * (*x - from));
            (point, value(&point))
        };
        let reflected = along(1.0);
        if reflected.1 < best.1 {
            let farther = along(2.0);
            corners[N] = if farther.1 < reflected.1 { farther } else { reflected };
        } else if reflected.1 < corners[N - 1].1 {
            corners[N] = reflected;
        } else {
            let nearer = if reflected.1 < worst.1 { along(0.5) } else { along(-0.5) };
            if nearer.1 < worst.1.min(reflected.1) {
                corners[N] = nearer;
            } else {
                for corner in &mut corners[1..] {
                    corner.0.iter_mut().zip(best.0).for_each(|(x, to)| *x = 0.5 * (*x + to));
                    corner.1 = value(&corner.0);
                }
            }
        }
    }
    corners.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(start)
}

#[cfg(test)]
mod tests {
    use super::minimise;

    #[test]
    fn a_curved_valley_ends_at_its_lowest_point() {
        // H. Rosenbrock's function (1960).
        let valley = |[x, y]: &[f64; 2]| 100.0 * (y - x * x) * (y - x * x) + (1.0 - x) * (1.0 - x);
        let ([x, y], low) = minimise([-1.2, 1.0], [0.5, 0.5], valley);
        assert!((x - 1.0).abs() < 1e-4 && (y - 1.0).abs() < 1e-4 && low < 1e-8, "{x} {y} {low}");
        let (_, nowhere) = minimise([0.0], [1.0], |_| f64::NAN);
        assert_eq!(nowhere, f64::INFINITY);
    }
}
