//! All sensors of one flight: fed at every step, read at every sample, combined into a report at the end.

use flight::column::Column;
use flight::{
    FlightIdentity, FuelFlowColumns, OptionalColumn, Report, ReportColumns, ReportDataError,
    ReportHeader,
};
use units::convert::{
    KELVIN_AT_ZERO_CELSIUS, KILOGRAMS_PER_POUND, KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR,
    METERS_PER_FOOT, METERS_PER_SECOND_PER_KNOT,
};
use units::{Mass, OutOfDomain};

use super::air_data::{AirDataInputs, compute, total_pressure_pa};
use super::channel::{Channel, round_to};
use super::{ChannelSensor, Columns, Sensors};
use crate::aircraft::{HEATING_FACTOR, Switch};
use crate::fly::Instant;
use crate::random::{Purpose, Stream, Streams};
use crate::state::TrueState;
use crate::terms::RecordedTerms;

/// Pascals in a hectopascal.
const PASCALS_PER_HECTOPASCAL: f64 = 100.0;

/// Figures of the load sheet and the dispatcher.
#[derive(Clone, Debug)]
pub(crate) struct RecordedLoading {
    pub(crate) aircraft_type: String,
    pub(crate) identity: FlightIdentity,
    pub(crate) zero_fuel_mass_kg: f64,
    pub(crate) fuel_on_board_kg: f64,
    pub(crate) lower_heating_value_mj_kg: f64,
    pub(crate) notes: Vec<(String, String)>,
}

/// The sensors of one flight.
pub(crate) struct SensorBank<'a> {
    sensors: &'a Sensors,
    columns: &'a Columns,
    recorded: &'a RecordedTerms,
    engines: usize,
    random: Stream,
    static_pressure: Channel,
    total_pressure: Channel,
    total_air_temperature: Channel,
    ground_speed: Channel,
    roll: Channel,
    drift: Channel,
    heading: Channel,
    center_of_gravity: Channel,
    fuel_quantity: Channel,
    n2: Vec<Channel>,
    n1: Vec<Channel>,
    exhaust_gas_temperature: Vec<Channel>,
    fuel_flow: Vec<Channel>,
    lagged: Option<Instant>,
    lag_shares: LagShares,
    metered_kg: f64,
    fuel_on_board_kg: f64,
    last_sample_s: Option<f64>,
    rows: ReportColumns,
}

#[derive(Clone, Copy, Debug, Default)]
struct LagShares {
    step_s: f64,
    static_pressure: f64,
    total_pressure: f64,
    total_air_temperature: f64,
    ground_speed: f64,
    roll: f64,
    drift: f64,
    fuel_flow: f64,
}

/// What the sensors of a flight are drawn from.
#[derive(Debug)]
pub(crate) struct BankSetup<'a> {
    /// How large the errors are.
    pub(crate) sensors: &'a Sensors,
    /// Which optional columns are recorded.
    pub(crate) columns: &'a Columns,
    /// Effects of the recording.
    pub(crate) recorded: &'a RecordedTerms,
    /// Number of engines.
    pub(crate) engines: usize,
    /// Random streams of the tail, whose errors stay from flight to flight.
    pub(crate) of_tail: Streams,
    /// Random streams of the flight.
    pub(crate) of_flight: Streams,
    /// Fuel that is truly on board when the load sheet is made.
    pub(crate) fuel_on_board_kg: f64,
}

impl<'a> SensorBank<'a> {
    /// Draws the errors of a flight.
    pub(crate) fn draw(setup: &BankSetup<'a>) -> Self {
        let BankSetup { sensors, columns, recorded, engines, fuel_on_board_kg, .. } = *setup;
        let mut tail = setup.of_tail.stream(Purpose::SensorsOfTail);
        let mut random = setup.of_flight.stream(Purpose::Sensors);
        let mut one = |sensor: &ChannelSensor| Channel::draw(sensor, &mut tail, &mut random);
        let static_pressure = one(&sensors.static_pressure);
        let total_pressure = one(&sensors.total_pressure);
        let total_air_temperature = one(&sensors.total_air_temperature);
        let ground_speed = one(&sensors.ground_speed);
        let roll = one(&sensors.roll);
        let drift = one(&sensors.drift);
        let heading = one(&sensors.heading);
        let center_of_gravity = one(&sensors.center_of_gravity);
        let fuel_quantity = one(&sensors.fuel_quantity);
        let mut each = |sensor: &ChannelSensor| (0..engines).map(|_| one(sensor)).collect();
        let n2 = each(&sensors.n2);
        let n1 = each(&sensors.n1);
        let exhaust_gas_temperature = each(&sensors.exhaust_gas_temperature);
        let fuel_flow = each(&sensors.fuel_flow);
        Self {
            sensors,
            columns,
            recorded,
            engines,
            static_pressure,
            total_pressure,
            total_air_temperature,
            ground_speed,
            roll,
            drift,
            heading,
            center_of_gravity,
            fuel_quantity,
            n2,
            n1,
            exhaust_gas_temperature,
            fuel_flow,
            random,
            lagged: None,
            lag_shares: LagShares::default(),
            metered_kg: 0.0,
            fuel_on_board_kg,
            last_sample_s: None,
            rows: empty_rows(engines, columns),
        }
    }

    /// One step of the flight: sensors follow, meters integrate, and where a sample falls a row is written.
    pub(crate) fn observe(
        &mut self,
        instant: &Instant,
        step_s: f64,
        sample: Option<&TrueState>,
    ) -> Result<(), OutOfDomain> {
        let seen = self.follow(instant, step_s);
        if let Some(state) = sample {
            if self.last_sample_s.is_none() {
                self.metered_kg = self.metered_before(state.fuel_used_kg);
            }
            self.write_row(&seen, state)?;
            self.last_sample_s = Some(state.time_s);
        }
        // After the row: the meters show what flowed before the sample.
        self.metered_kg += step_s * self.metered_flow_kg_s(&seen);
        Ok(())
    }

    /// The report, with faults.
    pub(crate) fn finish(
        mut self,
        loading: RecordedLoading,
        streams: Streams,
    ) -> Result<Report, ReportDataError> {
        let mut random = streams.stream(Purpose::Faults);
        super::faults::apply(&mut self.rows, &self.sensors.faults, &mut random);
        let pounds = |kg: f64| {
            // Load sheets are made in whole pounds; perfect sensors do not round.
            let resolution = if self.sensors.fuel_used_resolution_lb > 0.0 { 1.0 } else { 0.0 };
            Mass::pounds(round_to(kg / KILOGRAMS_PER_POUND, resolution))
        };
        let header = ReportHeader {
            aircraft_type: loading.aircraft_type,
            identity: loading.identity,
            zero_fuel_mass: pounds(loading.zero_fuel_mass_kg),
            fuel_on_board: pounds(loading.fuel_on_board_kg),
            lower_heating_value_mj_kg: match self.columns.lower_heating_value {
                Switch::On => Some(round_to(loading.lower_heating_value_mj_kg, 0.01)),
                Switch::Off => None,
            },
            missing: Vec::new(),
            assumed: Vec::new(),
            notes: loading.notes,
        };
        Report::new(header, self.rows)
    }

    /// First-order lags.
    fn follow(&mut self, instant: &Instant, step_s: f64) -> Instant {
        if self.lag_shares.step_s.to_bits() != step_s.to_bits() {
            self.lag_shares = LagShares {
                step_s,
                static_pressure: self.static_pressure.lag_share(step_s),
                total_pressure: self.total_pressure.lag_share(step_s),
                total_air_temperature: self.total_air_temperature.lag_share(step_s),
                ground_speed: self.ground_speed.lag_share(step_s),
                roll: self.roll.lag_share(step_s),
                drift: self.drift.lag_share(step_s),
                fuel_flow: self.fuel_flow.first().map_or(1.0, |channel| channel.lag_share(step_s)),
            };
        }
        let mut seen = self.lagged.unwrap_or(*instant);
        let shares = &self.lag_shares;
        seen.static_pressure_pa +=
            (instant.static_pressure_pa - seen.static_pressure_pa) * shares.static_pressure;
        seen.mach += (instant.mach - seen.mach) * shares.total_pressure;
        seen.total_air_temperature_k += (instant.total_air_temperature_k
            - seen.total_air_temperature_k)
            * shares.total_air_temperature;
        seen.ground_speed_m_s +=
            (instant.ground_speed_m_s - seen.ground_speed_m_s) * shares.ground_speed;
        seen.roll_deg += (instant.roll_deg - seen.roll_deg) * shares.roll;
        seen.drift_deg += (instant.drift_deg - seen.drift_deg) * shares.drift;
        for (lagged, flow) in seen.fuel_flow_kg_s.iter_mut().zip(&instant.fuel_flow_kg_s) {
            *lagged += (flow - *lagged) * shares.fuel_flow;
        }
        self.lagged = Some(seen);
        seen
    }

    /// The meters' count of the fuel used before the recording, engines alike.
    fn metered_before(&self, fuel_used_kg: f64) -> f64 {
        let each = fuel_used_kg / self.engines as f64;
        (0..self.engines)
            .map(|k| {
                // Without the bias: a meter's zero is not known before it runs.
                let gain = self.fuel_flow[k].steady(1.0) - self.fuel_flow[k].steady(0.0);
                each * gain * self.recorded.fuel_flow_factor[k]
            })
            .sum()
    }

    fn metered_flow_kg_s(&self, seen: &Instant) -> f64 {
        (0..self.engines)
            .map(|k| {
                let flow_lb_h = seen.fuel_flow_kg_s[k] / KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR;
                self.fuel_flow[k].steady(flow_lb_h)
                    * self.recorded.fuel_flow_factor[k]
                    * KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR
            })
            .sum()
    }

    fn write_row(&mut self, seen: &Instant, state: &TrueState) -> Result<(), OutOfDomain> {
        if let Some(last_s) = self.last_sample_s {
            self.advance_drift(state.time_s - last_s);
        }
        self.rows.time_s.push(state.time_s);
        self.write_air_data(seen)?;
        let random = &mut self.random;
        let rows = &mut self.rows;

        let knots =
            self.ground_speed.measure(seen.ground_speed_m_s / METERS_PER_SECOND_PER_KNOT, random);
        rows.ground_speed_m_s.push(self.ground_speed.round(knots) * METERS_PER_SECOND_PER_KNOT);
        let roll = self.roll.measure(seen.roll_deg, random);
        push(&mut rows.roll_deg, self.roll.round(roll));
        let drift = self.drift.measure(seen.drift_deg, random);
        push(&mut rows.drift_deg, self.drift.round(drift));

        let mut total_lb_h = 0.0;
        for (engine, k) in (1..).zip(0..self.engines) {
            let n2 = self.n2[k].measure(state.n2_percent[k], random);
            let n1 = self.n1[k].measure(state.n1_percent[k], random);
            let egt =
                self.exhaust_gas_temperature[k].measure(state.exhaust_gas_temperature_k[k], random);
            let flow = self.fuel_flow[k]
                .measure(seen.fuel_flow_kg_s[k] / KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR, random)
                * self.recorded.fuel_flow_factor[k];
            if let Some(engines) = &mut rows.n2_percent {
                engines[k].push(self.n2[k].round(n2));
            }
            push_optional(rows, Column::N1(engine), self.n1[k].round(n1));
            let egt_celsius = self.exhaust_gas_temperature[k].round(egt - KELVIN_AT_ZERO_CELSIUS);
            push_optional(
                rows,
                Column::ExhaustGasTemperature(engine),
                egt_celsius + KELVIN_AT_ZERO_CELSIUS,
            );
            total_lb_h += flow;
            if let FuelFlowColumns::PerEngine(engines) = &mut rows.fuel_flow {
                engines[k]
                    .push(self.fuel_flow[k].round(flow) * KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR);
            }
        }
        if let FuelFlowColumns::Total(total) = &mut rows.fuel_flow {
            let resolution = self.sensors.fuel_flow.resolution;
            total.push(round_to(total_lb_h, resolution) * KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR);
        }

        let used_lb = self.metered_kg * self.recorded.fuel_used_factor / KILOGRAMS_PER_POUND;
        rows.fuel_used_kg
            .push(round_to(used_lb, self.sensors.fuel_used_resolution_lb) * KILOGRAMS_PER_POUND);
        let left_lb = (self.fuel_on_board_kg - state.fuel_used_kg) / KILOGRAMS_PER_POUND;
        // A gauge does not indicate less than empty.
        let gauge_lb = self.fuel_quantity.measure(left_lb, random).max(0.0);
        push_optional(
            rows,
            Column::FuelQuantity,
            self.fuel_quantity.round(gauge_lb) * KILOGRAMS_PER_POUND,
        );

        let degrees = self.sensors.position_resolution_deg;
        push_optional(rows, Column::Latitude, round_to(state.latitude_deg, degrees));
        push_optional(rows, Column::Longitude, round_to(state.longitude_deg, degrees));
        let heading = self.heading.measure(state.true_heading_deg, random);
        push_optional(rows, Column::TrueHeading, self.heading.round(heading).rem_euclid(360.0));
        let center = self.center_of_gravity.measure(state.center_of_gravity_percent_mac, random);
        push_optional(rows, Column::CenterOfGravity, self.center_of_gravity.round(center));
        push_optional(rows, Column::AntiIce, if state.anti_ice { 1.0 } else { 0.0 });
        Ok(())
    }

    fn write_air_data(&mut self, seen: &Instant) -> Result<(), OutOfDomain> {
        let random = &mut self.random;
        let total_pa = total_pressure_pa(seen.static_pressure_pa, seen.mach);
        let static_hpa =
            self.static_pressure.measure(seen.static_pressure_pa / PASCALS_PER_HECTOPASCAL, random)
                * (1.0 + self.recorded.static_pressure_relative);
        let total_hpa = self.total_pressure.measure(total_pa / PASCALS_PER_HECTOPASCAL, random);
        let reference = self.recorded.temperature_bias_mach;
        let probe_bias_k =
            self.recorded.temperature_bias_k * (1.0 + HEATING_FACTOR * reference * reference);
        let total_air_temperature_k =
            self.total_air_temperature.measure(seen.total_air_temperature_k, random) + probe_bias_k;
        let computed = compute(&AirDataInputs {
            static_pressure_pa: static_hpa * PASCALS_PER_HECTOPASCAL,
            total_pressure_pa: total_hpa * PASCALS_PER_HECTOPASCAL,
            total_air_temperature_k,
            mach_bias: self.recorded.mach_bias,
        })?;
        let rows = &mut self.rows;
        let feet = self.static_pressure.round(computed.pressure_altitude_m / METERS_PER_FOOT);
        rows.pressure_altitude_m.push(feet * METERS_PER_FOOT);
        rows.mach.push(self.total_pressure.round(computed.mach));
        let celsius = |kelvin: f64| {
            self.total_air_temperature.round(kelvin - KELVIN_AT_ZERO_CELSIUS)
                + KELVIN_AT_ZERO_CELSIUS
        };
        push(&mut rows.static_air_temperature_k, celsius(computed.static_air_temperature_k));
        push_optional(rows, Column::TotalAirTemperature, celsius(total_air_temperature_k));
        let knots = computed.true_airspeed_m_s / METERS_PER_SECOND_PER_KNOT;
        rows.true_airspeed_m_s.push(
            round_to(knots, self.sensors.true_airspeed_resolution_kt) * METERS_PER_SECOND_PER_KNOT,
        );
        Ok(())
    }

    fn advance_drift(&mut self, interval_s: f64) {
        let random = &mut self.random;
        for channel in [
            &mut self.static_pressure,
            &mut self.total_pressure,
            &mut self.total_air_temperature,
            &mut self.ground_speed,
            &mut self.roll,
            &mut self.drift,
            &mut self.heading,
            &mut self.center_of_gravity,
            &mut self.fuel_quantity,
        ] {
            channel.advance_drift(interval_s, random);
        }
        for channels in
            [&mut self.n2, &mut self.n1, &mut self.exhaust_gas_temperature, &mut self.fuel_flow]
        {
            for channel in channels {
                channel.advance_drift(interval_s, random);
            }
        }
    }
}

fn push(column: &mut Option<Vec<f64>>, value: f64) {
    if let Some(values) = column {
        values.push(value);
    }
}

fn push_optional(rows: &mut ReportColumns, column: Column, value: f64) {
    if let Some(values) = rows.optional.get_mut(column) {
        values.push(Some(value));
    }
}

fn empty_rows(engines: usize, columns: &Columns) -> ReportColumns {
    let recorded = Column::optional_ones(engines).filter(|column| columns.has(*column));
    ReportColumns {
        time_s: Vec::new(),
        pressure_altitude_m: Vec::new(),
        static_air_temperature_k: Some(Vec::new()),
        mach: Vec::new(),
        true_airspeed_m_s: Vec::new(),
        ground_speed_m_s: Vec::new(),
        roll_deg: Some(Vec::new()),
        drift_deg: Some(Vec::new()),
        n2_percent: Some(vec![Vec::new(); engines]),
        fuel_flow: if columns.fuel_flow_per_engine.is_on() {
            FuelFlowColumns::PerEngine(vec![Vec::new(); engines])
        } else {
            FuelFlowColumns::Total(Vec::new())
        },
        fuel_used_kg: Vec::new(),
        optional: recorded.map(|column| (column, OptionalColumn::new())).collect(),
    }
}
