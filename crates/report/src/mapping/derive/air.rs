//! Pressure altitude, Mach number, SAT and TAS of a part: recorded, or derived from each other.

use atmos::{airspeed, isa, temperature};
use flight::column::Column;
use units::{CalibratedAirspeed, Mach, PressureAltitude, Temperature, TrueAirspeed};

use super::super::plan::{Conversion, MachSource, TemperatureSource, TrueAirspeedSource};
use super::{Part, Series};
use crate::refusal::{Found, Refusal, RefusalKind};

pub(super) struct AirData {
    pub(super) pressure_altitude_m: Series,
    pub(super) mach: Series,
    pub(super) static_air_temperature_k: Series,
    pub(super) true_airspeed_m_s: Series,
}

impl Part<'_> {
    /// Recorded or derived, each in an order in which it comes after its inputs: the plan has excluded circles.
    pub(super) fn air_data(&mut self) -> Result<AirData, Refusal> {
        let pressure_altitude_m = self.required(Column::PressureAltitude)?;
        let mut mach = match &self.plan.mach {
            MachSource::Recorded => Some(self.required(Column::Mach)?),
            MachSource::CalibratedAirspeed(conversion) => {
                Some(self.mach_of_calibrated_airspeed(conversion, &pressure_altitude_m)?)
            }
            MachSource::TrueAirspeed => None,
        };
        let static_air_temperature_k = match self.plan.temperature {
            TemperatureSource::Recorded => self.required(Column::StaticAirTemperature)?,
            TemperatureSource::Isa { deviation_k } => {
                self.isa_temperature(deviation_k, &pressure_altitude_m)?
            }
            TemperatureSource::TotalTemperature { recovery_factor } => {
                self.temperature_of_total_temperature(recovery_factor, mach.as_ref())?
            }
            TemperatureSource::TrueAirspeed => self.temperature_of_airspeed(mach.as_ref())?,
        };
        let temperatures =
            || static_air_temperature_k.values.iter().map(|value| Temperature::kelvin(*value));
        let true_airspeed_m_s = match (self.plan.true_airspeed, &mach) {
            (TrueAirspeedSource::Mach, Some(mach)) => {
                let values = mach.values.iter().zip(temperatures()).map(|(mach, sat)| {
                    airspeed::mach_to_true_airspeed(Mach::new(*mach), sat).to_meters_per_second()
                });
                let series = Series::new(values.collect(), mach.input);
                self.check_range(Column::TrueAirspeed, &series, None)?;
                series
            }
            _ => self.required(Column::TrueAirspeed)?,
        };
        if mach.is_none() {
            let values = true_airspeed_m_s.values.iter().zip(temperatures()).map(|(speed, sat)| {
                airspeed::true_airspeed_to_mach(TrueAirspeed::meters_per_second(*speed), sat)
                    .value()
            });
            let series = Series::new(values.collect(), true_airspeed_m_s.input);
            self.check_range(Column::Mach, &series, None)?;
            mach = Some(series);
        }
        let mach = mach.unwrap_or(Series::EMPTY);
        Ok(AirData { pressure_altitude_m, mach, static_air_temperature_k, true_airspeed_m_s })
    }

    fn mach_of_calibrated_airspeed(
        &self,
        conversion: &Conversion,
        pressure_altitude_m: &Series,
    ) -> Result<Series, Refusal> {
        let mut values = self.convert(conversion);
        for (row, (value, altitude)) in
            values.iter_mut().zip(&pressure_altitude_m.values).enumerate()
        {
            let pressure = isa::pressure(PressureAltitude::meters(*altitude))
                .map_err(|error| self.outside_atmosphere(row, pressure_altitude_m, error))?;
            let speed = CalibratedAirspeed::meters_per_second(*value);
            *value = airspeed::calibrated_airspeed_to_mach(speed, pressure).value();
        }
        let series = Series::new(values, conversion.input);
        self.check_range(Column::Mach, &series, None)?;
        Ok(series)
    }

    fn isa_temperature(
        &self,
        deviation_k: f64,
        pressure_altitude_m: &Series,
    ) -> Result<Series, Refusal> {
        let mut values = Vec::with_capacity(pressure_altitude_m.values.len());
        for (row, altitude) in pressure_altitude_m.values.iter().enumerate() {
            let temperature = isa::temperature(PressureAltitude::meters(*altitude))
                .map_err(|error| self.outside_atmosphere(row, pressure_altitude_m, error))?;
            values.push(temperature.to_kelvin() + deviation_k);
        }
        let series = Series::new(values, pressure_altitude_m.input);
        self.check_range(Column::StaticAirTemperature, &series, None)?;
        Ok(series)
    }

    fn temperature_of_total_temperature(
        &mut self,
        recovery_factor: f64,
        mach: Option<&Series>,
    ) -> Result<Series, Refusal> {
        let mut series = self.required(Column::TotalAirTemperature)?;
        for (value, mach) in series.values.iter_mut().zip(mach.iter().flat_map(|m| &m.values)) {
            let total = Temperature::kelvin(*value);
            *value =
                temperature::total_to_static(total, Mach::new(*mach), recovery_factor).to_kelvin();
        }
        self.check_range(Column::StaticAirTemperature, &series, None)?;
        Ok(series)
    }

    fn temperature_of_airspeed(&mut self, mach: Option<&Series>) -> Result<Series, Refusal> {
        let mut series = self.required(Column::TrueAirspeed)?;
        for (value, mach) in series.values.iter_mut().zip(mach.iter().flat_map(|m| &m.values)) {
            let speed = TrueAirspeed::meters_per_second(*value);
            *value = airspeed::static_air_temperature(speed, Mach::new(*mach)).to_kelvin();
        }
        let series = Series::new(series.values, series.input);
        self.check_range(Column::StaticAirTemperature, &series, None)?;
        Ok(series)
    }

    fn outside_atmosphere(
        &self,
        row: usize,
        series: &Series,
        error: units::OutOfDomain,
    ) -> Refusal {
        let found = Found::Number { value: error.value, unit: error.unit };
        let limit = if error.value < error.minimum { error.minimum } else { error.maximum };
        let column = Column::PressureAltitude;
        self.refuse(row, series.input, found, RefusalKind::OutOfRange { column, limit, unit: "m" })
    }
}
