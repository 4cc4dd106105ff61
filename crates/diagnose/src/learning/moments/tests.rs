use faer::Side;
use faer::linalg::solvers::Solve;

use super::*;

const COUNT: usize = 3;
const COLUMNS: usize = 6;

/// Numbers without order, from −½ to ½: the golden ratio's multiples.
fn number(k: &mut f64) -> f64 {
    *k += 1.0;
    (*k * 0.618_033_988_749_895).fract() - 0.5
}

/// Whether the contrast shares noise and columns with fuel flow and N2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Contrast {
    Coupled,
    Apart,
}

/// Segments of three flights with fuel flow, a contrast and N2.
fn rows(contrast: Contrast) -> (Vec<Row>, Vec<Mat<f64>>) {
    let mut k = 0.0;
    let couples = |a: usize, b: usize| contrast == Contrast::Coupled || (a == 1) == (b == 1);
    let mut covariances = Vec::new();
    let rows = (0..11)
        .map(|segment| {
            let root = Mat::from_fn(COUNT, COUNT, |a, b| {
                let value = number(&mut k);
                if a == b {
                    1.0 + value
                } else if couples(a, b) {
                    value
                } else {
                    0.0
                }
            });
            let covariance = &root * root.transpose();
            let inverse = covariance.llt(Side::Lower).unwrap().solve(Mat::<f64>::identity(3, 3));
            let values = |k: &mut f64, of: &dyn Fn(usize) -> bool| {
                let mut values = [0.0; MAXIMUM_CHANNELS];
                for (channel, slot) in values.iter_mut().enumerate().take(COUNT) {
                    *slot = if of(channel) { number(k) } else { 0.0 };
                }
                values
            };
            let row = Row {
                flight: segment / 4,
                raw: vec![
                    values(&mut k, &|channel| channel == 0),
                    values(&mut k, &|channel| channel == 0),
                    values(&mut k, &|channel| channel == 1),
                    values(&mut k, &|channel| channel == 2),
                    values(&mut k, &|channel| couples(channel, 0)),
                    values(&mut k, &|_| true), // the residual
                ],
                inverse: core::array::from_fn(|a| {
                    core::array::from_fn(|b| if a < 3 && b < 3 { inverse[(a, b)] } else { 0.0 })
                }),
                common: vec![
                    values(&mut k, &|channel| channel != 1),
                    values(&mut k, &|channel| channel == 1),
                ],
                ln_noise: core::array::from_fn(|channel| {
                    // Of the covariance as a whole; it is only summed.
                    if channel == 0 { covariance.determinant().ln() } else { 0.0 }
                }),
                is_recorded: [true, true, true, false, false],
            };
            covariances.push(covariance);
            row
        })
        .collect();
    (rows, covariances)
}

/// The same by the covariance of each whole flight, inverted.
fn by_inverse(rows: &[Row], covariances: &[Mat<f64>], noise: &NoiseFactors) -> (Mat<f64>, f64) {
    let mut gram = Mat::<f64>::zeros(COLUMNS, COLUMNS);
    let mut ln_noise = 0.0;
    for flight in 0..3 {
        let of: Vec<usize> = (0..rows.len()).filter(|&s| rows[s].flight == flight).collect();
        let columns = Mat::from_fn(of.len() * COUNT, COLUMNS, |at, column| {
            rows[of[at / COUNT]].raw[column][at % COUNT]
        });
        let loadings = Mat::from_fn(of.len() * COUNT, 2, |at, loading| {
            rows[of[at / COUNT]].common[loading][at % COUNT] * noise.between[at % COUNT]
        });
        let own = Mat::from_fn(of.len() * COUNT, of.len() * COUNT, |i, j| {
            let (a, b) = (i % COUNT, j % COUNT);
            let by = noise.within[a] * noise.within[b];
            if i / COUNT == j / COUNT { by * covariances[of[i / COUNT]][(a, b)] } else { 0.0 }
        });
        let covariance = &own + &loadings * loadings.transpose();
        ln_noise += covariance.determinant().ln();
        gram += columns.transpose() * covariance.llt(Side::Lower).unwrap().solve(&columns);
    }
    (gram, ln_noise)
}

#[test]
fn gram_is_that_of_the_inverse_covariance_at_any_noise() {
    let noise = NoiseFactors { within: [0.3, 1.7, 0.8], between: [1.9, 0.4, 0.6] };
    for (contrast, parts) in [(Contrast::Coupled, 1), (Contrast::Apart, 2)] {
        let (rows, covariances) = rows(contrast);
        let kinds = parts_of(&rows, &[0, 1, 2]);
        assert_eq!(kinds.len(), parts);
        let parts: Vec<CoupledChannels> = kinds
            .iter()
            .map(|kinds| CoupledChannels::new(*kinds, &rows, &[0, 1, 2], 3, COLUMNS))
            .collect();
        let (expected, ln_noise) = by_inverse(&rows, &covariances, &noise);
        let found: f64 = parts.iter().map(|part| part.gram(&noise, None).1).sum();
        assert!((found - ln_noise).abs() < 1e-10, "{found} {ln_noise}");
        let moments =
            GramSums { parts, left_out: Vec::new(), segments: Vec::new(), columns: COLUMNS };
        let all = moments.gram(&noise, None);
        let mut by_folds = Mat::<f64>::zeros(COLUMNS, COLUMNS);
        for fold in 0..LEARNING_FOLDS {
            by_folds += moments.gram(&noise, Some(fold));
        }
        for i in 0..COLUMNS {
            for j in 0..COLUMNS {
                let tolerance = 1e-10 * (expected[(i, i)] * expected[(j, j)]).sqrt();
                assert!((all[(i, j)] - expected[(i, j)]).abs() < tolerance, "{i} {j}");
                assert!((by_folds[(i, j)] - expected[(i, j)]).abs() < tolerance, "{i} {j}");
            }
        }
    }
}
