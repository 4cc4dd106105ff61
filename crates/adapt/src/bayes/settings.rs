//! The assumptions of law `bayes`: sizes, smoothness and noise. Learning never changes them.

use flight::ObservationVariance;
use serde::{Deserialize, Serialize};

/// The patch of lift coefficient × Mach number over which slopes and bends have their stated size: 0.3 × 0.1.
///
/// The energy of the prior is an integral over the plane; this area makes it a number without unit, whatever the grid's
/// step and extent. 0.3 and 0.1 are about the ranges of one airplane's cruise.
pub(super) const PATCH_LIFT_COEFFICIENT: f64 = 0.3;
/// See [`PATCH_LIFT_COEFFICIENT`].
pub(super) const PATCH_MACH: f64 = 0.1;

/// The settings in plain numbers, not checked yet. Standard deviations are relative: 0.01 is 1 % of drag.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "BayesSettings", deny_unknown_fields)]
pub struct SettingValues {
    /// Typical size of the correction: standard deviation of its level over the grid.
    pub correction_std: f64,
    /// Standard deviation of the correction's mean slope over a patch, per unit lift coefficient.
    pub slope_std_per_lift_coefficient: f64,
    /// Standard deviation of the correction's mean slope over a patch, per unit Mach number.
    pub slope_std_per_mach: f64,
    /// Standard deviation of the correction's mean second derivative over a patch, along lift coefficient.
    pub bend_std_per_lift_coefficient_squared: f64,
    /// Standard deviation of the correction's mean mixed second derivative over a patch.
    pub bend_std_per_lift_coefficient_mach: f64,
    /// Standard deviation of the correction's mean second derivative over a patch, along Mach number.
    pub bend_std_per_mach_squared: f64,
    /// Standard deviation of what is common to a flight beyond the sensors' propagated part.
    pub extra_flight_std: f64,
    /// Standard deviation of a segment beyond the sensors' propagated part.
    pub extra_segment_std: f64,
    /// Factor on the standard deviation that the sensors propagate to a segment: a fleet may be quieter or noisier than
    /// the aircraft file says. Not written where it is 1.
    #[serde(
        default = "as_the_aircraft_file_says",
        skip_serializing_if = "is_as_the_aircraft_file_says"
    )]
    pub sensor_segment_factor: f64,
    /// The same for what is common to a flight: mass and heating value.
    #[serde(
        default = "as_the_aircraft_file_says",
        skip_serializing_if = "is_as_the_aircraft_file_says"
    )]
    pub sensor_flight_factor: f64,
    /// Degrees of freedom of the Student distribution of a segment's and of a flight's error.
    pub student_degrees_of_freedom: f64,
    /// Calendar days after which knowledge counts half; `None`: it does not age.
    pub half_life_days: Option<f64>,
}

const fn as_the_aircraft_file_says() -> f64 {
    1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
#[expect(clippy::float_cmp, reason = "exactly the default is not written")]
fn is_as_the_aircraft_file_says(factor: &f64) -> bool {
    *factor == as_the_aircraft_file_says()
}

/// Checked settings of law `bayes`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SettingValues", into = "SettingValues")]
pub struct BayesSettings(SettingValues);

/// A setting out of its limits.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("setting {setting} of law bayes is {value}, outside {minimum} to {maximum}")]
#[non_exhaustive]
pub struct SettingsError {
    /// Which setting.
    pub setting: &'static str,
    /// The value given.
    pub value: f64,
    /// Smallest value that is accepted.
    pub minimum: f64,
    /// Largest value that is accepted.
    pub maximum: f64,
}

impl BayesSettings {
    /// Checks the values.
    ///
    /// # Errors
    /// [`SettingsError`] names the first setting that is out of its limits.
    pub fn new(values: SettingValues) -> Result<Self, SettingsError> {
        for (setting, value, minimum, maximum) in named(&values) {
            if !(value >= minimum && value <= maximum) {
                return Err(SettingsError { setting, value, minimum, maximum });
            }
        }
        Ok(Self(values))
    }

    /// The defaults of 2026. Not one of them was fitted to a fleet; each is a size of known physics.
    ///
    /// - correction 10 %: a guide is 2 to 7 % too optimistic, an airplane and its engines a few per cent off.
    /// - slopes 0.15 per unit lift coefficient and 0.25 per unit Mach number, 4.5 and 2.5 % across a patch: an induced
    ///   drag that is 6 to 18 % off tilts the correction by 0.06 to 0.17; a drag rise 0.006 Mach number early by 0.2 to
    ///   0.4 around the drag-divergence Mach number.
    /// - bends 1.5, 1.5 and 2 (along lift coefficient, mixed, along Mach number): a polar that is not a parabola departs by
    ///   1 to 2 % over half a patch. Along Mach number the grid sets the limit, not the physics: the correction must
    ///   be straight to about 0.1 % inside a cell 0.05 wide, because a table cannot hold what is finer.
    /// - extra 1 % per flight: what is not a function of lift coefficient and Mach number (Reynolds number with
    ///   exponent 0.12 over a spread of 10 %, TSFC with temperature exponent 0.2 over one of 3 %, throttle 0.6 %,
    ///   heating value 0.6 %: about 1.2 % if all act at once).
    /// - extra 0.3 % per segment: the same causes change by about a third of that during a flight.
    /// - factors of 1 on the sensors' part: the aircraft file is taken as stated.
    /// - 4 degrees of freedom: an error of ten standard deviations keeps a twentieth of its weight.
    #[must_use]
    pub const fn physical_2026() -> Self {
        Self(SettingValues {
            correction_std: 0.10,
            slope_std_per_lift_coefficient: 0.15,
            slope_std_per_mach: 0.25,
            bend_std_per_lift_coefficient_squared: 1.5,
            bend_std_per_lift_coefficient_mach: 1.5,
            bend_std_per_mach_squared: 2.0,
            extra_flight_std: 0.010,
            extra_segment_std: 0.003,
            sensor_segment_factor: 1.0,
            sensor_flight_factor: 1.0,
            student_degrees_of_freedom: 4.0,
            half_life_days: None,
        })
    }

    /// The plain numbers.
    #[must_use]
    pub const fn values(&self) -> &SettingValues {
        &self.0
    }

    /// The first setting in which two differ: its name, ours, theirs. A half-life that is off counts as infinite.
    pub(super) fn first_difference(&self, other: &Self) -> Option<(&'static str, f64, f64)> {
        named(&self.0)
            .into_iter()
            .zip(named(&other.0))
            .map(|((setting, ours, ..), (_, theirs, ..))| (setting, ours, theirs))
            .find(|(_, ours, theirs)| ours.to_bits() != theirs.to_bits())
    }

    /// Variance of an error common to a flight: the sensors' part and the extra one.
    pub(super) fn flight_variance(&self, of_sensors: &ObservationVariance) -> f64 {
        let SettingValues { extra_flight_std: extra, sensor_flight_factor: factor, .. } = self.0;
        factor * factor * of_sensors.flight + extra * extra
    }

    /// Variance of a segment alone: the sensors' part and the extra one.
    pub(super) fn segment_variance(&self, of_sensors: &ObservationVariance) -> f64 {
        let SettingValues { extra_segment_std: extra, sensor_segment_factor: factor, .. } = self.0;
        factor * factor * of_sensors.segment + extra * extra
    }

    /// Factor on knowledge after this many days; 1 for a negative age.
    pub(super) fn decay(&self, days: f64) -> f64 {
        self.0.half_life_days.map_or(1.0, |half_life| (-days.max(0.0) / half_life).exp2())
    }
}

impl TryFrom<SettingValues> for BayesSettings {
    type Error = SettingsError;
    fn try_from(values: SettingValues) -> Result<Self, SettingsError> {
        Self::new(values)
    }
}

impl From<BayesSettings> for SettingValues {
    fn from(settings: BayesSettings) -> Self {
        settings.0
    }
}

/// Every setting with its name and limits.
///
/// The lower limits keep the precision matrix far from singular and a segment's variance positive; the upper ones are
/// beyond any airplane.
fn named(values: &SettingValues) -> [(&'static str, f64, f64, f64); 12] {
    let v = values;
    [
        ("correction_std", v.correction_std, 1e-3, 1.0),
        ("slope_std_per_lift_coefficient", v.slope_std_per_lift_coefficient, 1e-3, 100.0),
        ("slope_std_per_mach", v.slope_std_per_mach, 1e-3, 100.0),
        (
            "bend_std_per_lift_coefficient_squared",
            v.bend_std_per_lift_coefficient_squared,
            1e-2,
            1e3,
        ),
        ("bend_std_per_lift_coefficient_mach", v.bend_std_per_lift_coefficient_mach, 1e-2, 1e3),
        ("bend_std_per_mach_squared", v.bend_std_per_mach_squared, 1e-2, 1e3),
        ("extra_flight_std", v.extra_flight_std, 1e-5, 1.0),
        ("extra_segment_std", v.extra_segment_std, 1e-5, 1.0),
        ("sensor_segment_factor", v.sensor_segment_factor, 1e-2, 100.0),
        ("sensor_flight_factor", v.sensor_flight_factor, 1e-2, 100.0),
        ("student_degrees_of_freedom", v.student_degrees_of_freedom, 1.0, 1e6),
        ("half_life_days", v.half_life_days.unwrap_or(f64::INFINITY), 1.0, f64::INFINITY),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By definition of a file: factors of 1 are not written, others are, and either comes back.
    #[test]
    #[expect(clippy::float_cmp, reason = "exactly the default is not written")]
    fn settings_are_read_back_as_they_were_written() {
        let physical = *BayesSettings::physical_2026().values();
        for (segment, flight) in [(1.0, 1.0), (0.5, 1.0), (1.0, 2.0), (0.7, 1.3)] {
            let values = SettingValues {
                sensor_segment_factor: segment,
                sensor_flight_factor: flight,
                half_life_days: Some(400.0),
                ..physical
            };
            let settings = BayesSettings::new(values).unwrap();
            let text = ron::to_string(&settings).unwrap();
            assert_eq!(ron::from_str::<BayesSettings>(&text).unwrap(), settings, "{text}");
            assert_eq!(text.contains("sensor_segment_factor"), segment != 1.0, "{text}");
            assert_eq!(text.contains("sensor_flight_factor"), flight != 1.0, "{text}");
        }
    }
}
