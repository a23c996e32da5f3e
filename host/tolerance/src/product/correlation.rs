//! Whether coefficients of correlation can belong to random variables.

/// Whether the symmetric matrix of `size` rows with ones on its diagonal, the coefficients (row, column, value) off it
/// and zeros elsewhere is positive definite.
pub fn is_positive_definite(size: usize, coefficients: &[(usize, usize, f64)]) -> bool {
    // Only what is correlated at all takes part.
    let mut members: Vec<usize> = coefficients.iter().flat_map(|(row, column, _)| [*row, *column]).collect();
    members.sort_unstable();
    members.dedup();
    debug_assert!(members.iter().all(|member| *member < size));
    let place = |member: &usize| members.binary_search(member).unwrap_or(0);
    let among: Vec<_> = coefficients.iter().map(|(row, column, value)| (place(row), place(column), *value)).collect();
    factor(members.len(), &among).is_some()
}

/// Cholesky's lower factor of the symmetric matrix of `size` rows with ones on its diagonal, the coefficients
/// (row, column, value) off it and zeros elsewhere; `None` if it is not positive definite.
pub fn factor(size: usize, coefficients: &[(usize, usize, f64)]) -> Option<Vec<Vec<f64>>> {
    let mut factor = vec![vec![0.0; size]; size];
    for (i, row) in factor.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for (row, column, value) in coefficients {
        factor[*row.max(column)][*row.min(column)] = *value;
    }
    for column in 0..size {
        for row in column..size {
            let known: f64 = (0..column).map(|k| factor[row][k] * factor[column][k]).sum();
            let rest = factor[row][column] - known;
            if row == column {
                // A pivot that is only rounding is as bad as none.
                if rest < 1e-12 {
                    return None;
                }
                factor[row][row] = libm::sqrt(rest);
            } else {
                factor[row][column] = rest / factor[column][column];
            }
        }
    }
    Some(factor)
}

#[cfg(test)]
mod tests {
    use super::is_positive_definite;

    #[test]
    fn contradictions_are_found() {
        let chain = |a, b, c| is_positive_definite(9, &[(0, 4, a), (8, 4, b), (0, 8, c)]);
        assert!(is_positive_definite(3, &[]) && chain(0.9, 0.9, 0.7) && chain(-0.9, 0.9, -0.7));
        // ρ₁₃ must be at least ρ₁₂ρ₂₃ − √((1 − ρ₁₂²)(1 − ρ₂₃²)) = 0.62.
        assert!(chain(0.9, 0.9, 0.621) && !chain(0.9, 0.9, 0.619) && !chain(0.9, 0.9, -0.9));
        assert!(!is_positive_definite(2, &[(0, 1, 1.0)]) && is_positive_definite(2, &[(1, 0, -0.999)]));
    }
}
