//! The limits, as a named preset.

use crate::Criterion;

/// Decimal data in binary: what exceeds a limit by no more than this, in the limit's own unit, is on it.
pub(crate) const TOLERANCE: f64 = 1e-9;
/// A count of samples this close to a whole number is that number.
const COUNT_TOLERANCE: f64 = 1e-9;
/// Fewest samples of a segment: a single one has no standard deviation.
const SEGMENT_SAMPLES_FLOOR: usize = 2;

/// When samples are steady, and how many of them make a segment.
///
/// Limits are plain numbers in the unit of their name, because that unit is part of the rule: what exceeds a limit by
/// no more than 1e-9 of its unit is on it. Limits are inclusive. Every value has a meaning: an infinite limit switches
/// a criterion off, a negative one or NaN rejects every sample.
///
/// There is no `Default`: which limits are right is a decision, so presets are named after their source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrimCriteria {
    /// Largest change of pressure altitude between neighbors, ft.
    pub pressure_altitude_ft: f64,
    /// Largest change of vertical speed between neighbors, ft/min.
    pub vertical_speed_ft_min: f64,
    /// Largest change of Mach number between neighbors.
    pub mach: f64,
    /// Largest change of ground speed between neighbors, kt.
    pub ground_speed_kt: f64,
    /// Largest change of static air temperature between neighbors, °C.
    pub static_air_temperature_c: f64,
    /// Largest change of the high-pressure rotor speed of each engine between neighbors, %.
    pub n2_percent: f64,
    /// Largest size of the drift angle, degrees.
    pub drift_deg: f64,
    /// Largest size of the roll angle, degrees.
    pub roll_deg: f64,
    /// How many standard deviations from the mean of its piece a sample may lie.
    pub outlier_standard_deviations: f64,
    /// Longest piece of a stable run, s.
    pub piece_maximum_s: f64,
    /// Shortest segment, s.
    pub segment_minimum_s: f64,
}

impl TrimCriteria {
    /// The criteria of table 4 with pieces of at most ten minutes, segments of at least three and a 2σ filter.
    ///
    /// # Source
    /// Ghazi et al. 2020, table 4 and section on segment detection.
    #[must_use]
    pub const fn ghazi_2020_table_4() -> Self {
        Self {
            pressure_altitude_ft: 20.0,
            vertical_speed_ft_min: 100.0,
            mach: 0.003,
            ground_speed_kt: 1.0,
            static_air_temperature_c: 1.0,
            n2_percent: 1.6,
            drift_deg: 5.0,
            roll_deg: 0.8,
            outlier_standard_deviations: 2.0,
            piece_maximum_s: 600.0,
            segment_minimum_s: 180.0,
        }
    }

    /// The stability limits of an Airbus aircraft condition monitoring unit's cruise performance report, for recordings
    /// in which table 4 finds no segment: real aircraft wander by tens of feet and by knots from minute to minute, and
    /// fly in cross-winds.
    ///
    /// The unit takes the range (largest minus smallest) over 100 s; here the limits are between neighbors 60 s apart.
    /// Drift has no limit (the isobaric slope that comes with a cross-wind is then in the error, some tenths of a per
    /// cent); vertical speed, pieces, segments and filter are those of table 4.
    ///
    /// # Source
    /// Limits of report 02 as remembered in the field (150 ft, 6 kt, 0.8°, 1.1 °C, N2 0.9 %, Mach 0.008): not checked
    /// against the manufacturer's document.
    #[must_use]
    pub const fn airbus_report_02() -> Self {
        Self {
            pressure_altitude_ft: 150.0,
            mach: 0.008,
            ground_speed_kt: 6.0,
            static_air_temperature_c: 1.1,
            n2_percent: 0.9,
            drift_deg: f64::INFINITY,
            roll_deg: 0.8,
            ..Self::ghazi_2020_table_4()
        }
    }

    /// The same limits for short stable frames: a segment is two minutes, which is two samples, the least that has a
    /// scatter.
    ///
    /// For recordings that hold a speed for a few minutes only. A mean of two samples has √(3/2) of the noise of one of
    /// three, and a drift of speed or thrust that two samples cannot show stays in it.
    ///
    /// # Source
    /// The monitoring unit's own frame is 100 s (five parts of 20 s) by the manufacturer's brochure; the limits are those of
    /// [`Self::airbus_report_02`], as little certain; two samples are our choice, as the sampling is by minutes.
    #[must_use]
    pub const fn airbus_report_02_short() -> Self {
        Self { segment_minimum_s: 120.0, ..Self::airbus_report_02() }
    }

    /// The names of all presets, for arguments and files.
    pub const PRESETS: [&str; 3] =
        ["ghazi-2020-table-4", "airbus-report-02", "airbus-report-02-short"];

    /// The preset of this name.
    #[must_use]
    pub fn preset(name: &str) -> Option<Self> {
        match name {
            "ghazi-2020-table-4" => Some(Self::ghazi_2020_table_4()),
            "airbus-report-02" => Some(Self::airbus_report_02()),
            "airbus-report-02-short" => Some(Self::airbus_report_02_short()),
            _ => None,
        }
    }

    /// The limit of a criterion, in [`Criterion::unit`].
    #[must_use]
    pub const fn limit(&self, criterion: Criterion) -> f64 {
        match criterion {
            Criterion::PressureAltitude => self.pressure_altitude_ft,
            Criterion::VerticalSpeed => self.vertical_speed_ft_min,
            Criterion::Mach => self.mach,
            Criterion::GroundSpeed => self.ground_speed_kt,
            Criterion::StaticAirTemperature => self.static_air_temperature_c,
            Criterion::N2 => self.n2_percent,
            Criterion::Drift => self.drift_deg,
            Criterion::Roll => self.roll_deg,
        }
    }

    /// The same with another limit of a criterion.
    #[must_use]
    pub const fn with_limit(mut self, criterion: Criterion, limit: f64) -> Self {
        let place = match criterion {
            Criterion::PressureAltitude => &mut self.pressure_altitude_ft,
            Criterion::VerticalSpeed => &mut self.vertical_speed_ft_min,
            Criterion::Mach => &mut self.mach,
            Criterion::GroundSpeed => &mut self.ground_speed_kt,
            Criterion::StaticAirTemperature => &mut self.static_air_temperature_c,
            Criterion::N2 => &mut self.n2_percent,
            Criterion::Drift => &mut self.drift_deg,
            Criterion::Roll => &mut self.roll_deg,
        };
        *place = limit;
        self
    }

    /// Most samples of a piece, each representing `sample_interval_s`: ⌊maximum/Δt + 1e-9⌋, at least one.
    /// `[steadiness.10]`
    #[must_use]
    pub fn piece_samples_maximum(&self, sample_interval_s: f64) -> usize {
        whole((self.piece_maximum_s / sample_interval_s + COUNT_TOLERANCE).floor()).max(1)
    }

    /// Fewest kept samples of a segment: ⌈minimum/Δt − 1e-9⌉, at least two. `[steadiness.12]`
    #[must_use]
    pub fn segment_samples_minimum(&self, sample_interval_s: f64) -> usize {
        whole((self.segment_minimum_s / sample_interval_s - COUNT_TOLERANCE).ceil())
            .max(SEGMENT_SAMPLES_FLOOR)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a count; negative and NaN become 0, infinity the largest"
)]
const fn whole(count: f64) -> usize {
    count as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_limit_changes_its_criterion_alone() {
        let published = TrimCriteria::ghazi_2020_table_4();
        for changed in Criterion::ALL {
            let other = published.with_limit(changed, 0.125);
            for criterion in Criterion::ALL {
                let expected =
                    if criterion == changed { 0.125 } else { published.limit(criterion) };
                assert!((other.limit(criterion) - expected).abs() < 1e-15, "{criterion}");
            }
        }
    }

    #[test]
    fn counts_of_samples_follow_the_interval() {
        // By hand, (Δt, ⌊600/Δt⌋, max(⌈180/Δt⌉, 2)): 600/75 = 8, 180/75 = 2.4; 600/90 = 6.67, 180/90 = 2;
        // 600/45 = 13.3, 180/45 = 4; 600/59 = 10.17, 180/59 = 3.05; 600/200 = 3, 180/200 = 0.9.
        for (interval_s, maximum, minimum) in [
            (60.0, 10, 3),
            (75.0, 8, 3),
            (90.0, 6, 2),
            (45.0, 13, 4),
            (30.0, 20, 6),
            (59.0, 10, 4),
            (61.0, 9, 3),
            (200.0, 3, 2),
            (600.0, 1, 2),
            (1000.0, 1, 2),
        ] {
            let criteria = TrimCriteria::ghazi_2020_table_4();
            assert_eq!(criteria.piece_samples_maximum(interval_s), maximum, "{interval_s}");
            assert_eq!(criteria.segment_samples_minimum(interval_s), minimum, "{interval_s}");
        }
    }

    #[test]
    fn every_name_of_a_preset_is_one() {
        for name in TrimCriteria::PRESETS {
            assert!(TrimCriteria::preset(name).is_some(), "{name}");
        }
        assert_eq!(TrimCriteria::preset("loose"), None);
    }

    #[test]
    fn a_median_that_is_sixty_but_for_rounding_counts_as_sixty() {
        let criteria = TrimCriteria::ghazi_2020_table_4();
        for interval_s in [60.0 - 1e-12, 60.0 + 1e-12] {
            assert_eq!(criteria.piece_samples_maximum(interval_s), 10);
            assert_eq!(criteria.segment_samples_minimum(interval_s), 3);
        }
    }
}
