//! The terms of Airbus' "Getting to Grips with Aircraft Performance Monitoring" (SCM1-D388, December 2002), from deviations
//! of fuel flow as this crate has them, 100·ln(recorded/predicted).

use crate::months::Month;

/// Months over which a monitored fuel factor is averaged (chapter G, figure G3).
pub const MONTHS_OF_A_FUEL_FACTOR: i32 = 3;
/// Tenths of a per cent: what a flight-planning system takes.
const STEPS_A_PERCENT: f64 = 10.0;
/// Tenths by which a factor may exceed a tenth and still be that tenth: decimals of recorded fuel flows and of masses leave less
/// than a ten-thousandth of a per cent, and nobody knows a factor as well. Our choice.
const TENTH_TOLERANCE: f64 = 1e-3;

/// Deviation of specific range, DSR, %: negative, the aircraft is worse than the book.
///
/// ```text
/// DSR = 100·(SR/SR_book − 1) = 100·(exp(−d/100) − 1)                                         [monitoring.12]
/// ```
#[must_use]
pub fn specific_range_deviation_percent(deviation_percent: f64) -> f64 {
    100.0 * (-deviation_percent / 100.0).exp_m1()
}

/// Monitored fuel factor, %: what predicted fuel flow is to be raised by.
///
/// ```text
/// factor = 100·(Wf/Wf_book − 1) = 100·(exp(d/100) − 1)                                       [monitoring.13]
/// ```
///
/// Airbus takes it as −DSR, which is lower by the square: 0.01 at 1 %, 0.24 at 5 %.
#[must_use]
pub fn monitored_fuel_factor_percent(deviation_percent: f64) -> f64 {
    100.0 * (deviation_percent / 100.0).exp_m1()
}

/// The fuel factor retained after a month: the mean of the monthly factors of the last three calendar months, as many of
/// them as there are, rounded up to a tenth of a per cent (figure G3). `None` without a factor in those months.
#[must_use]
pub fn retained_fuel_factor_percent(after: Month, monthly_percent: &[(Month, f64)]) -> Option<f64> {
    let recent: Vec<f64> = monthly_percent
        .iter()
        .filter(|(month, _)| {
            (0..MONTHS_OF_A_FUEL_FACTOR).contains(&(after.number() - month.number()))
        })
        .map(|(_, factor)| *factor)
        .collect();
    let mean = recent.iter().sum::<f64>() / recent.len() as f64;
    (!recent.is_empty()).then(|| rounded_up_to_a_tenth(mean))
}

/// PERF FACTOR of the flight management system, %: the basic factor (its model against the book) and the monitored fuel
/// factor (the aircraft against the book) added, as the guide adds them (page 57).
#[must_use]
pub fn performance_factor_percent(basic_percent: f64, monitored_fuel_factor_percent: f64) -> f64 {
    basic_percent + monitored_fuel_factor_percent
}

/// Upwards, so that no fuel is missing: 2.45 becomes 2.5, −0.45 becomes −0.4.
#[must_use]
pub fn rounded_up_to_a_tenth(percent: f64) -> f64 {
    let tenths = (percent * STEPS_A_PERCENT - TENTH_TOLERANCE).ceil();
    // Adding 0 makes −0 a 0.
    tenths / STEPS_A_PERCENT + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: figure G3 and the text below it: monthly factors of 2.4, 2.5, 2.7, 2.8 from September 2001 on retain 2.4, 2.5,
    /// 2.6, 2.7.
    #[test]
    fn three_months_as_airbus_prints_them() {
        let month = |k: i8| Month { year: 2001, month: 9 + k };
        let monthly: Vec<(Month, f64)> =
            [2.4, 2.5, 2.7, 2.8].iter().zip(0..).map(|(factor, k)| (month(k), *factor)).collect();
        for (count, expected) in [2.4, 2.5, 2.6, 2.7].into_iter().enumerate() {
            let retained = retained_fuel_factor_percent(monthly[count].0, &monthly[..=count]);
            assert_eq!(retained, Some(expected));
        }
        // A month without a flight is not in the mean, and three months later nothing is left.
        assert_eq!(
            retained_fuel_factor_percent(Month { year: 2002, month: 2 }, &monthly),
            Some(2.8)
        );
        assert_eq!(retained_fuel_factor_percent(Month { year: 2002, month: 3 }, &monthly), None);
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "rounded to a tenth: exact")]
    fn rounding_by_hand() {
        for (percent, expected) in
            [(2.45, 2.5), (2.5, 2.5), (0.1 + 0.2, 0.3), (-0.45, -0.4), (-0.04, 0.0), (5.001, 5.1)]
        {
            assert_eq!(rounded_up_to_a_tenth(percent), expected, "{percent}");
        }
        // 1.05 times the model, recorded in decimals.
        assert_eq!(rounded_up_to_a_tenth(5.000_000_006_497_888), 5.0);
    }

    /// By hand: 5 % more fuel flow than the book is a deviation of 4.879 %, a specific range of 1/1.05.
    #[test]
    #[expect(clippy::float_cmp, reason = "rounded to a tenth: exact")]
    fn signs_and_sizes() {
        let deviation = 100.0 * 1.05_f64.ln();
        assert!((monitored_fuel_factor_percent(deviation) - 5.0).abs() < 1e-12);
        assert!(
            (specific_range_deviation_percent(deviation) - (100.0 / 1.05 - 100.0)).abs() < 1e-12
        );
        assert_eq!(performance_factor_percent(1.5, -0.5), 1.0);
    }
}
