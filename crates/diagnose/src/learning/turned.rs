//! What each flight has in common, turned so that its parts do not mix.

use faer::{Mat, Side};

use crate::learning::rows::ChannelRows;

/// Loadings of every flight, whitened, times the eigenvectors of their products. They depend on the noise of its rows alone, whatever is
/// learnt of them, and are found once as long as that stays.
#[derive(Debug, Default)]
pub(super) struct TurnedFlights {
    known: Vec<TurnedFlight>,
}

/// Loadings of one flight, and the eigenvalues: the squares of their lengths.
#[derive(Clone, Debug, Default)]
pub(super) struct TurnedFlight {
    /// One over the standard deviation of each row.
    scales: Vec<f64>,
    pub(super) loadings: Vec<Vec<f64>>,
    pub(super) lengths: Vec<f64>,
}

impl TurnedFlights {
    /// Of a group of rows, whose flight counts whole; `scales` of all rows.
    pub(super) fn flight(
        &mut self,
        rows: &ChannelRows,
        group: usize,
        scales: &[f64],
    ) -> &TurnedFlight {
        if self.known.len() <= group {
            self.known.resize(group + 1, TurnedFlight::default());
        }
        let range = rows.groups[group].clone();
        let scales = &scales[range.clone()];
        let known = &mut self.known[group];
        if known.scales != scales {
            let of = |loading: &Vec<f64>| -> Vec<f64> {
                loading[range.clone()].iter().zip(scales).map(|(u, scale)| u * scale).collect()
            };
            let (loadings, mut lengths) =
                turned(rows.loadings.iter().map(of).collect(), range.len());
            for length in &mut lengths {
                *length = length.max(0.0);
            }
            *known = TurnedFlight { scales: scales.to_vec(), loadings, lengths };
        }
        known
    }
}

/// Loadings times the eigenvectors of their products, and the eigenvalues. Of more loadings than rows as many as there are rows hold
/// all: the eigenvectors of the rows' products, each times the root of its eigenvalue.
fn turned(loadings: Vec<Vec<f64>>, count: usize) -> (Vec<Vec<f64>>, Vec<f64>) {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    if let [only] = &loadings[..] {
        let length = product(only, only);
        return (loadings, vec![length]);
    }
    let rank = loadings.len();
    if rank > count {
        return turned_rows(&loadings, count);
    }
    let gram = Mat::from_fn(rank, rank, |i, j| product(&loadings[i], &loadings[j]));
    if rank == 2 {
        let (rotation, lengths) = of_two(gram[(0, 0)], gram[(1, 0)], gram[(1, 1)]);
        let turned = |by: &[f64; 2]| -> Vec<f64> {
            let pairs = loadings[0].iter().zip(&loadings[1]);
            pairs.map(|(one, other)| one * by[0] + other * by[1]).collect()
        };
        return (rotation.iter().map(turned).collect(), lengths.to_vec());
    }
    // Not to be expected of numbers: then nothing is taken as common, as where nothing is loaded.
    let Ok(eigen) = gram.self_adjoint_eigen(Side::Lower) else {
        return (vec![vec![0.0; count]; rank], vec![0.0; rank]);
    };
    let turned = |r: usize| -> Vec<f64> {
        let sum = |at: usize| (0..rank).map(|k| loadings[k][at] * eigen.U()[(k, r)]).sum();
        (0..count).map(sum).collect()
    };
    let lengths = (0..rank).map(|r| eigen.S().column_vector()[r]).collect();
    ((0..rank).map(turned).collect(), lengths)
}

/// Of fewer rows than loadings.
fn turned_rows(loadings: &[Vec<f64>], count: usize) -> (Vec<Vec<f64>>, Vec<f64>) {
    let mut products = Mat::<f64>::zeros(count, count);
    for loading in loadings {
        for column in 0..count {
            let by = loading[column];
            let into = &mut products.col_as_slice_mut(column)[column..];
            for (into, value) in into.iter_mut().zip(&loading[column..]) {
                *into += by * value;
            }
        }
    }
    // As where nothing is loaded, as below.
    let Ok(eigen) = products.self_adjoint_eigen(Side::Lower) else {
        return (vec![vec![0.0; count]; count], vec![0.0; count]);
    };
    let length = |r: usize| eigen.S().column_vector()[r].max(0.0);
    let turned = |r: usize| -> Vec<f64> {
        let root = length(r).sqrt();
        (0..count).map(|at| root * eigen.U()[(at, r)]).collect()
    };
    ((0..count).map(turned).collect(), (0..count).map(length).collect())
}

/// Eigenvectors and eigenvalues of the symmetric matrix `[[a, b], [b, c]]`: by one rotation of Jacobi.
///
/// # Source
/// Golub and Van Loan 2013, Matrix computations, section 8.5.2.
fn of_two(a: f64, b: f64, c: f64) -> ([[f64; 2]; 2], [f64; 2]) {
    if b == 0.0 {
        return ([[1.0, 0.0], [0.0, 1.0]], [a, c]);
    }
    let half = (c - a) / (2.0 * b);
    let tangent = half.signum() / (half.abs() + half.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    ([[cosine, -sine], [sine, cosine]], [a - tangent * b, c + tangent * b])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// faer's decomposition of the same matrices.
    #[test]
    fn two_loadings_are_turned_as_by_faer() {
        for (a, b, c) in [(2.0, 0.3, 1.0), (1.0, -0.9, 1.0), (0.0, 0.0, 3.0), (1e-9, 2e-6, 5.0)] {
            let (vectors, values) = of_two(a, b, c);
            let matrix = Mat::from_fn(2, 2, |i, j| [[a, b], [b, c]][i][j]);
            let eigen = matrix.self_adjoint_eigen(Side::Lower).unwrap();
            let mut sorted = values;
            sorted.sort_by(f64::total_cmp);
            for (k, value) in sorted.iter().enumerate() {
                assert!((value - eigen.S().column_vector()[k]).abs() < 1e-14 * c);
            }
            for (vector, value) in vectors.iter().zip(values) {
                let turned = [a * vector[0] + b * vector[1], b * vector[0] + c * vector[1]];
                for k in 0..2 {
                    assert!((turned[k] - value * vector[k]).abs() < 1e-14 * c, "{a} {b} {c}");
                }
            }
        }
    }

    /// Turned loadings have the squares of the whitened ones, also after the noise of one row has changed.
    #[test]
    fn flights_are_turned_again_where_their_noise_changes() {
        let number = |k: usize| (k as f64 * 0.618_033_988_749_895).fract() - 0.5;
        let rows = ChannelRows {
            columns: Mat::zeros(5, 1),
            variance: vec![1.0; 5],
            loadings: (0..3).map(|r| (0..5).map(|i| number(3 * i + r + 1)).collect()).collect(),
            groups: vec![0..3, 3..5],
            shares: vec![1.0; 2],
        };
        let mut turned = TurnedFlights::default();
        let mut scales = vec![1.0, 0.9, 0.8, 0.7, 0.6];
        let products = |flight: &TurnedFlight| -> f64 {
            flight.loadings.iter().flatten().map(|u| u * u).sum()
        };
        for changed in [4, 1] {
            for group in 0..2 {
                let by_hand = |scales: &[f64]| -> f64 {
                    let of = |row: usize| rows.loadings.iter().map(move |u| (u[row], row));
                    rows.groups[group]
                        .clone()
                        .flat_map(of)
                        .map(|(u, row)| (u * scales[row]).powi(2))
                        .sum()
                };
                let found = products(turned.flight(&rows, group, &scales));
                assert!((found - by_hand(&scales)).abs() < 1e-12, "{group}: {found}");
            }
            scales[changed] *= 1.5;
        }
    }
}
