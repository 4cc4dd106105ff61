//! The fuel factor of a tail (PERF FACTOR of a flight management system): by how much the book's fuel flow is to be
//! raised, in all and by condition.
//!
//! Two percentages are in use and their signs and sizes differ. An *error* is a share of what was recorded, a *fuel
//! factor* one of what the book predicts, because the flight management system multiplies the book by it; the deviation
//! of specific range has the opposite sign:
//!
//! ```text
//! d = mean over flights of ln(Wf/Ŵf_book)                                                   [fuel_factor.1]
//! fuel factor = 100·(e^d − 1)     error = 100·(1 − e^−d)     DSR = −error                   [fuel_factor.2]
//! ```
//!
//! At 5 % of the predicted fuel flow they are 5.00 and 4.76.

use std::collections::BTreeMap;
use std::sync::Arc;

use flight::{FlightIdentity, Segment};
use monitor::airbus::rounded_up_to_a_tenth;
use units::PressureAltitude;

use crate::columns::Columns;
use crate::segments_table::Evaluated;
use crate::statistics::students_quantile975;

/// Bands of a quantity.
struct Bands {
    width: f64,
    /// Where one begins. Levels are flown in whole thousands of feet and Mach numbers in whole hundredths, give or take a rounding: edges
    /// lie half way between them, lest a steady cruise falls on both sides of one.
    edge: f64,
}

/// Two levels each, ft: FL350 and FL360 are in one.
const LEVEL_BANDS_FT: Bands = Bands { width: 2000.0, edge: 500.0 };
/// Two hundredths each: 0.78 and 0.79 are in one.
const MACH_BANDS: Bands = Bands { width: 0.02, edge: 0.015 };

/// A fuel factor with its interval.
#[derive(Clone, Debug, PartialEq)]
pub struct FuelFactor {
    /// Tail.
    pub tail: String,
    /// `all`, or the quantity whose band it is: `pressure_altitude_ft`, `mach`.
    pub condition: &'static str,
    /// The band, from and below; `None` for all.
    pub band: Option<(f64, f64)>,
    /// Flights.
    pub flights: usize,
    /// Segments.
    pub segments: usize,
    /// Mean over flights of the mean over a flight's segments of ln(recorded/book).
    pub mean_ln_ratio: f64,
    /// Half width of its 95 % interval, Student's, over flights; `None` with one flight.
    pub half_width: Option<f64>,
}

impl FuelFactor {
    /// Per cent of the book's fuel flow: positive, the aircraft burns more.
    #[must_use]
    pub fn percent_of_predicted(&self) -> f64 {
        100.0 * self.mean_ln_ratio.exp_m1()
    }

    /// Per cent of the recorded fuel flow, as errors are stated: positive, the aircraft burns more.
    #[must_use]
    pub fn error_percent_of_recorded(&self) -> f64 {
        -100.0 * (-self.mean_ln_ratio).exp_m1()
    }

    /// Deviation of specific range (DSR): negative, the aircraft is worse.
    #[must_use]
    pub fn specific_range_deviation_percent(&self) -> f64 {
        -self.error_percent_of_recorded()
    }

    /// The 95 % interval of [`percent_of_predicted`](Self::percent_of_predicted).
    #[must_use]
    pub fn interval95(&self) -> Option<[f64; 2]> {
        let half = self.half_width?;
        Some([self.mean_ln_ratio - half, self.mean_ln_ratio + half].map(|ln| 100.0 * ln.exp_m1()))
    }

    /// As it is entered: [`percent_of_predicted`](Self::percent_of_predicted), rounded up to a tenth.
    #[must_use]
    pub fn entered_percent(&self) -> f64 {
        rounded_up_to_a_tenth(self.percent_of_predicted())
    }
}

/// The fuel factors of a tail: all segments, bands of pressure altitude, bands of Mach number. `evaluated` is what the
/// *book* says of each segment; segments outside its table take no part.
#[must_use]
pub fn of_tail(
    tail: &str,
    segments: &[Segment],
    evaluated: &[Option<Evaluated>],
) -> Vec<FuelFactor> {
    let mut groups: BTreeMap<(usize, i64), Group> = BTreeMap::new();
    for (segment, ln_ratio) in ln_ratios(segments, evaluated) {
        let level_ft = PressureAltitude::meters(segment.means.pressure_altitude_m).to_feet();
        let keys =
            [(0, 0), (1, LEVEL_BANDS_FT.of(level_ft)), (2, MACH_BANDS.of(segment.means.mach))];
        for key in keys {
            let flight = Arc::clone(&segment.identity);
            groups.entry(key).or_default().entry(flight).or_default().push(ln_ratio);
        }
    }
    groups.iter().map(|(key, group)| of_group(tail, *key, group)).collect()
}

/// That of all segments of a tail alone; `None` where none has a ratio. As [`of_tail`].
#[must_use]
pub fn of_all(
    tail: &str,
    segments: &[Segment],
    evaluated: &[Option<Evaluated>],
) -> Option<FuelFactor> {
    let mut group = Group::new();
    for (segment, ln_ratio) in ln_ratios(segments, evaluated) {
        group.entry(Arc::clone(&segment.identity)).or_default().push(ln_ratio);
    }
    (!group.is_empty()).then(|| of_group(tail, (0, 0), &group))
}

/// Segments that the book predicts, with ln(recorded/book).
fn ln_ratios<'s>(
    segments: &'s [Segment],
    evaluated: &'s [Option<Evaluated>],
) -> impl Iterator<Item = (&'s Segment, f64)> {
    segments.iter().zip(evaluated).filter_map(|(segment, evaluated)| {
        let predicted_kg_s = evaluated.as_ref()?.predicted_fuel_flow_kg_s?;
        let ln_ratio = (segment.means.fuel_flow_total_kg_s / predicted_kg_s).ln();
        ln_ratio.is_finite().then_some((segment, ln_ratio))
    })
}

/// Ln ratios by flight.
type Group = BTreeMap<Arc<FlightIdentity>, Vec<f64>>;

fn of_group(tail: &str, (condition, band): (usize, i64), group: &Group) -> FuelFactor {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let flights: Vec<f64> = group.values().map(|segments| mean(segments)).collect();
    let mean_ln_ratio = mean(&flights);
    let (condition, band) = match condition {
        0 => ("all", None),
        1 => ("pressure_altitude_ft", Some(LEVEL_BANDS_FT.edges(band))),
        _ => ("mach", Some(MACH_BANDS.edges(band))),
    };
    FuelFactor {
        tail: tail.to_owned(),
        condition,
        band,
        flights: flights.len(),
        segments: group.values().map(Vec::len).sum(),
        mean_ln_ratio,
        half_width: half_width95(&flights, mean_ln_ratio),
    }
}

/// Half width of the 95 % interval of a mean by Student's distribution; `None` with fewer than two.
fn half_width95(values: &[f64], mean: f64) -> Option<f64> {
    let freedom = values.len().checked_sub(1).filter(|freedom| *freedom > 0)? as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let of_mean = (squares / freedom / values.len() as f64).sqrt();
    Some(students_quantile975(freedom)? * of_mean)
}

impl Bands {
    /// Number of the band; a value within rounding of an edge belongs to the band above it.
    fn of(&self, value: f64) -> i64 {
        #[expect(clippy::cast_possible_truncation, reason = "levels and Mach numbers are small")]
        let band = ((value - self.edge) / self.width + 1e-9).floor() as i64;
        band
    }

    /// From and below, as the decimals that they are.
    fn edges(&self, band: i64) -> (f64, f64) {
        let at = |band: i64| (1e3 * (self.edge + band as f64 * self.width)).round() / 1e3;
        (at(band), at(band + 1))
    }
}

/// One row per tail and condition.
#[must_use]
pub fn columns(factors: &[FuelFactor]) -> Columns {
    let mut columns = Columns::default();
    columns.text("tail", factors.iter().map(|factor| factor.tail.clone()));
    columns.text("condition", factors.iter().map(|factor| factor.condition.to_owned()));
    columns.number("from", factors.iter().map(|factor| factor.band.map(|(from, _)| from)));
    columns.number("to", factors.iter().map(|factor| factor.band.map(|(_, to)| to)));
    columns.count("flights", factors.iter().map(|factor| factor.flights as u64));
    columns.count("segments", factors.iter().map(|factor| factor.segments as u64));
    let number = |of: fn(&FuelFactor) -> Option<f64>| factors.iter().map(of);
    columns.number("perf_factor_percent", number(|f| Some(f.entered_percent())));
    columns.number("fuel_factor_percent_of_predicted", number(|f| Some(f.percent_of_predicted())));
    columns.number("fuel_factor_ci95_low", number(|f| f.interval95().map(|[low, _]| low)));
    columns.number("fuel_factor_ci95_high", number(|f| f.interval95().map(|[_, high]| high)));
    columns.number("error_percent_of_recorded", number(|f| Some(f.error_percent_of_recorded())));
    columns.number(
        "specific_range_deviation_percent",
        number(|f| Some(f.specific_range_deviation_percent())),
    );
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(mean_ln_ratio: f64) -> FuelFactor {
        FuelFactor {
            tail: "T".to_owned(),
            condition: "all",
            band: None,
            flights: 1,
            segments: 1,
            mean_ln_ratio,
            half_width: None,
        }
    }

    /// By hand: 1.05 times the book's fuel flow is 5 % of predicted, 0.05/1.05 = 4.7619 % of recorded.
    #[test]
    fn both_percentages_and_both_signs() {
        let worse = factor(1.05_f64.ln());
        assert!((worse.percent_of_predicted() - 5.0).abs() < 1e-12);
        assert!((worse.error_percent_of_recorded() - 100.0 * 0.05 / 1.05).abs() < 1e-12);
        assert!((worse.specific_range_deviation_percent() + 100.0 * 0.05 / 1.05).abs() < 1e-12);
        assert!((worse.entered_percent() - 5.0).abs() < 1e-12);
        let better = factor(0.98_f64.ln());
        assert!((better.percent_of_predicted() + 2.0).abs() < 1e-12);
        assert!((better.error_percent_of_recorded() + 100.0 * 0.02 / 0.98).abs() < 1e-12);
    }

    /// Oracle: the means and retained factors that Airbus prints (figure G3).
    #[test]
    #[expect(clippy::float_cmp, reason = "rounded by the same rule: exact")]
    fn rounded_as_airbus_does() {
        let means = [f64::midpoint(2.4, 2.5), (2.4 + 2.5 + 2.7) / 3.0, (2.5 + 2.7 + 2.8) / 3.0];
        assert_eq!(means.map(rounded_up_to_a_tenth), [2.5, 2.6, 2.7]);
        assert_eq!(
            [2.5, 0.1 + 0.2, -0.45, -0.04].map(rounded_up_to_a_tenth),
            [2.5, 0.3, -0.4, 0.0]
        );
    }

    /// Student's 0.975 quantile with 2 degrees of freedom is 4.303 (any table); values 1, 2, 3 have a standard deviation
    /// of 1, the mean of three one of 1/√3.
    #[test]
    fn interval_by_hand() {
        let half = half_width95(&[1.0, 2.0, 3.0], 2.0).unwrap();
        assert!((half - 4.3027 / 3.0_f64.sqrt()).abs() < 1e-3, "{half}");
        assert_eq!(half_width95(&[1.0], 1.0), None);
    }

    /// A steady cruise that is a rounding below or above what is flown is in one band.
    #[test]
    fn flown_levels_and_mach_numbers_are_within_a_band() {
        for level in 200..=450 {
            let feet = f64::from(level) * 100.0;
            if level % 10 == 0 {
                let [below, above] = [feet - 300.0, feet + 300.0].map(|ft| LEVEL_BANDS_FT.of(ft));
                assert_eq!(below, above, "FL{level}");
            }
        }
        for hundredths in 60..=92 {
            let mach = f64::from(hundredths) / 100.0;
            let [below, above] = [mach - 0.004, mach + 0.004].map(|mach| MACH_BANDS.of(mach));
            assert_eq!(below, above, "Mach {mach}");
        }
    }

    #[test]
    fn bands_are_half_open_decimals() {
        let of_mach = |mach: f64| MACH_BANDS.edges(MACH_BANDS.of(mach));
        assert_eq!(of_mach(0.78), (0.775, 0.795));
        assert_eq!(of_mach(0.775), (0.775, 0.795));
        assert_eq!(of_mach(0.7749), (0.755, 0.775));
        let level_ft = PressureAltitude::meters(10_668.0).to_feet();
        assert_eq!(LEVEL_BANDS_FT.edges(LEVEL_BANDS_FT.of(level_ft)), (34_500.0, 36_500.0));
    }
}
