//! Rates along a run: forward differences, with an extrapolated rate at the last sample, or rates at the samples' own times.

/// Number of rates through which the line at an end of a run is fitted.
const END_FIT_RATES: usize = 3;

/// Rate of a column at each sample of a run, in the column's unit per second.
///
/// ```text
/// r_i = (x_{i+1} − x_i)/(t_{i+1} − t_i),  i = 1 … N−1
/// r_N = r̄ + (t_N − t̄) Σ (t_i − t̄)(r_i − r̄)/Σ (t_i − t̄)²,  i = N−3 … N−1 (N−2 … N−1 where N = 3)
/// ```
///
/// A forward difference belongs to the start of its step. For regular steps and N ≥ 4 the second line is
///
/// ```text
/// r_N = −⅔ r_{N−3} + ⅓ r_{N−2} + 4⁄3 r_{N−1}
/// ```
///
/// Both slices have the run's length, at least three; time strictly increases.
///
/// # Source
/// `[steadiness.4]` to `[steadiness.6]`; Ghazi et al. 2020, eqs. (17) and (18). The paper states that the last point's
/// value is extrapolated from the three points before it; that the line is one of least squares is our reading.
pub(crate) fn along_run(time_s: &[f64], values: &[f64]) -> Vec<f64> {
    let last = values.len() - 1;
    let mut rates = Vec::with_capacity(values.len());
    for (time, value) in time_s.windows(2).zip(values.windows(2)) {
        rates.push((value[1] - value[0]) / (time[1] - time[0]));
    }
    let first_fitted = last.saturating_sub(END_FIT_RATES);
    rates.push(line_at(time_s[last], &time_s[first_fitted..last], &rates[first_fitted..]));
    rates
}

/// Rate of a column at each sample's own time, in the column's unit per second.
///
/// ```text
/// r_{i+½} = (x_{i+1} − x_i)/(t_{i+1} − t_i) at t_{i+½} = ½(t_i + t_{i+1})
/// r_i = (h_i r_{i−½} + h_{i−1} r_{i+½})/(h_{i−1} + h_i),  h_i = t_{i+1} − t_i,  1 < i < N
/// ```
///
/// The second line is the straight line through the two rates around a sample, at its time; at regular steps it is their
/// mean. The first and the last sample have the value at their time of the straight line by least squares through the
/// nearest three rates (two where N = 3). All of it is exact where the column is a parabola in time.
///
/// A sample that is a mean over a bin is compared with fuel flow over the same bin: half a step later it would be
/// another acceleration, and fuel flow would seem to depend on whatever moves with speed.
///
/// Both slices have the run's length, at least three; time strictly increases.
///
/// # Source
/// `[steadiness.15]`, our choice.
pub(crate) fn at_own_times(time_s: &[f64], values: &[f64]) -> Vec<f64> {
    let last = values.len() - 1;
    let steps = || time_s.windows(2).zip(values.windows(2));
    let rates: Vec<f64> =
        steps().map(|(time, value)| (value[1] - value[0]) / (time[1] - time[0])).collect();
    let middles_s: Vec<f64> = steps().map(|(time, _)| 0.5 * (time[0] + time[1])).collect();
    let fitted = END_FIT_RATES.min(last);
    let mut own = Vec::with_capacity(values.len());
    own.push(line_at(time_s[0], &middles_s[..fitted], &rates[..fitted]));
    for (time, rate) in time_s.windows(3).zip(rates.windows(2)) {
        let (before_s, behind_s) = (time[1] - time[0], time[2] - time[1]);
        own.push((behind_s * rate[0] + before_s * rate[1]) / (before_s + behind_s));
    }
    own.push(line_at(time_s[last], &middles_s[last - fitted..], &rates[last - fitted..]));
    own
}

/// Value at `x` of the straight line fitted by least squares through the points.
fn line_at(x: f64, xs: &[f64], ys: &[f64]) -> f64 {
    let count = xs.len() as f64;
    let x_mean = xs.iter().sum::<f64>() / count;
    let y_mean = ys.iter().sum::<f64>() / count;
    let (mut products, mut squares) = (0.0, 0.0);
    for (xi, yi) in xs.iter().zip(ys) {
        products += (xi - x_mean) * (yi - y_mean);
        squares += (xi - x_mean) * (xi - x_mean);
    }
    y_mean + (x - x_mean) * products / squares
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(time_s: &[f64], values: &[f64], expected: &[f64]) {
        close(&along_run(time_s, values), expected);
    }

    fn close(rates: &[f64], expected: &[f64]) {
        assert_eq!(rates.len(), expected.len());
        for (rate, expected) in rates.iter().zip(expected) {
            assert!((rate - expected).abs() < 1e-12, "{rates:?}");
        }
    }

    /// By hand: rates 1, 2, 4 per second at 30, 90, 150 s. In between their means 3/2 and 3; the line by least squares is
    /// 7/3 + 3/2 · (t − 90)/60: at 0 s 7/3 − 9/4 = 1/12, at 180 s 7/3 + 9/4 = 55/12.
    #[test]
    fn rates_at_the_own_times_of_four_regular_samples() {
        let rates = at_own_times(&[0.0, 60.0, 120.0, 180.0], &[0.0, 60.0, 180.0, 420.0]);
        close(&rates, &[1.0 / 12.0, 1.5, 3.0, 55.0 / 12.0]);
    }

    /// Oracle: the derivative of t² is 2 t, at steps of any length, in the middle and at both ends.
    #[test]
    fn rates_at_own_times_are_exact_of_a_parabola() {
        for time_s in [
            vec![0.0, 40.0, 100.0],
            vec![0.0, 60.0, 110.0, 170.0],
            vec![-30.0, 0.0, 60.0, 125.0, 170.0, 240.0],
        ] {
            let of =
                |value: &dyn Fn(f64) -> f64| time_s.iter().map(|t| value(*t)).collect::<Vec<_>>();
            close(&at_own_times(&time_s, &of(&|t| t * t)), &of(&|t| 2.0 * t));
        }
    }

    #[test]
    fn last_of_four_regular_samples() {
        // Rates 1, 2, 4 per second; by the closed form −2/3·1 + 1/3·2 + 4/3·4 = 16/3.
        check(&[0.0, 60.0, 120.0, 180.0], &[0.0, 60.0, 180.0, 420.0], &[1.0, 2.0, 4.0, 16.0 / 3.0]);
    }

    #[test]
    fn only_the_last_three_rates_count() {
        // As above, after two wild steps.
        check(
            &[-120.0, -60.0, 0.0, 60.0, 120.0, 180.0],
            &[900.0, -300.0, 0.0, 60.0, 180.0, 420.0],
            &[-20.0, 5.0, 1.0, 2.0, 4.0, 16.0 / 3.0],
        );
    }

    #[test]
    fn last_of_three_samples_lies_on_the_line_through_two() {
        check(&[0.0, 60.0, 120.0], &[0.0, 60.0, 180.0], &[1.0, 2.0, 3.0]);
        // Irregular steps: rates 1 at 0 s and 3 at 40 s, so 1 + 2/40·100 = 6 at 100 s.
        check(&[0.0, 40.0, 100.0], &[0.0, 40.0, 220.0], &[1.0, 3.0, 6.0]);
    }

    #[test]
    fn irregular_steps_by_hand() {
        // Rates 0, 3, 3 at t = 0, 30, 90: t̄ = 40, r̄ = 2, Σ(t−t̄)(r−r̄) = 80 − 10 + 50 = 120,
        // Σ(t−t̄)² = 1600 + 100 + 2500 = 4200; at 150 s: 2 + 110·120/4200 = 36/7.
        check(&[0.0, 30.0, 90.0, 150.0], &[7.0, 7.0, 187.0, 367.0], &[0.0, 3.0, 3.0, 36.0 / 7.0]);
    }

    #[test]
    fn constant_values_and_ramps_are_exact() {
        let time_s = [0.0, 60.0, 120.0, 180.0, 240.0];
        assert_eq!(along_run(&time_s, &[12_801.6; 5]), [0.0; 5]);
        check(&time_s, &[0.0, 30.0, 60.0, 90.0, 120.0], &[0.5; 5]);
    }
}
