use super::*;
use crate::math::random::RandomStream;

/// Dense algebra as oracle: `Aᵀ(1 + O S² Oᵀ)⁻¹A` of each flight, summed.
#[test]
fn what_flights_have_of_their_own_is_integrated_out() {
    let (rows, columns, flights) = (9, 5, 3);
    let deviations = [0.7, 0.0, 0.3];
    let mut random = RandomStream::new(11, 0);
    let mut gram = Mat::<f64>::zeros(columns, columns);
    let mut dense = Mat::<f64>::zeros(columns, columns);
    let mut dense_ln_determinant = 0.0;
    let mut products = Vec::new();
    for _ in 0..flights {
        let mut of_flight = Mat::<f64>::zeros(rows, columns);
        let mut own = Mat::<f64>::zeros(rows, deviations.len());
        for column in 0..columns {
            random.fill(of_flight.col_as_slice_mut(column));
        }
        for column in 0..deviations.len() {
            random.fill(own.col_as_slice_mut(column));
        }
        gram += of_flight.transpose() * &of_flight;
        products.push((of_flight.transpose() * &own, own.transpose() * &own));
        let covariance = Mat::from_fn(rows, rows, |i, j| {
            let scatter = |k: usize| own[(i, k)] * deviations[k] * deviations[k] * own[(j, k)];
            let of_own: f64 = (0..deviations.len()).map(scatter).sum();
            of_own + if i == j { 1.0 } else { 0.0 }
        });
        let factor = Cholesky::new(&covariance).unwrap();
        dense_ln_determinant += factor.ln_determinant();
        let mut solved = of_flight.clone();
        factor.solve(&mut solved);
        dense += of_flight.transpose() * solved;
    }
    let (matrix, ln_determinant) = without_scatter(&gram, &products, &deviations).unwrap();
    assert!((ln_determinant - dense_ln_determinant).abs() < 1e-10);
    for i in 0..columns {
        for j in 0..columns {
            assert!((matrix[(i, j)] - dense[(i, j)]).abs() < 1e-10, "{i} {j}");
        }
    }
}
