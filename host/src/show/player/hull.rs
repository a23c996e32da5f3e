//! What encloses some points, for the outline of a body of which only its joints are known.

/// Corners that round a point off.
const ROUND: usize = 12;

/// The convex outline at a distance `rim` around `points`, against the clock.
pub fn hull(points: &[[f64; 2]], rim: f64) -> Vec<[f64; 2]> {
    let around = |[x, y]: &[f64; 2]| {
        let (x, y) = (*x, *y);
        (0..ROUND).map(move |k| {
            let angle = 2.0 * std::f64::consts::PI * k as f64 / ROUND as f64;
            [x + rim * libm::cos(angle), y + rim * libm::sin(angle)]
        })
    };
    let mut all: Vec<[f64; 2]> = points.iter().flat_map(around).collect();
    all.sort_by(|one, other| one[0].total_cmp(&other[0]).then(one[1].total_cmp(&other[1])));
    // Andrew's monotone chain: the lower side from left to right, then the upper one back.
    let backwards: Vec<_> = all.iter().rev().copied().collect();
    let mut outline = side(&all);
    outline.pop();
    outline.extend(side(&backwards));
    outline.pop();
    outline
}

/// The points, in their order, that no other is to the right of.
fn side(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for point in points {
        while let [.., one, two] = kept[..]
            && (two[0] - one[0]) * (point[1] - one[1]) <= (two[1] - one[1]) * (point[0] - one[0])
        {
            kept.pop();
        }
        kept.push(*point);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::hull;

    #[test]
    fn outlines_enclose_their_points_at_a_distance() {
        let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 1.0]];
        let outline = hull(&points, 0.5);
        // Perimeter and circle of a 3-4-5 triangle: its area, three strips and a polygon of twelve corners.
        let next = |k: usize| outline[(k + 1) % outline.len()];
        let area: f64 =
            (0..outline.len()).map(|k| outline[k][0] * next(k)[1] - outline[k][1] * next(k)[0]).sum::<f64>() / 2.0;
        let circle = 6.0 * 0.25 * libm::sin(std::f64::consts::PI / 6.0);
        assert!((area - (6.0 + 12.0 * 0.5 + circle)).abs() < 0.06, "{area}");
        assert_eq!(hull(&[[1.0, 1.0]], 1.0).len(), 12);
    }
}
