//! What the sensors make of what was flown: errors exactly, noise, drift of a flight.
#![expect(clippy::unwrap_used, reason = "times of the fleet are inside the calendar")]

use std::sync::Arc;

use flight::effect::EffectId;
use flight::{FlightIdentity, Segment, SegmentMeans};

use super::aircraft::{G0, R, isa};
use super::design::Row;
use super::truth::{Flown, Truth};
use super::{Random, Setup};

const YEAR_S: f64 = 365.25 * 86_400.0;
/// Start of the fleet's first flight, s since 1970.
const EPOCH_S: f64 = 1.55e9;

/// Flies a flight and records it, segment by segment.
pub(super) fn record_flight(
    truth: &Truth,
    setup: &Setup,
    flight: usize,
    rows: &[&Row],
    random: &mut Random,
) -> Vec<Segment> {
    let recorder = Recorder::new(truth, setup.noise, random);
    let start_s = EPOCH_S + rows.first().map_or(0.0, |row| row.years) * YEAR_S;
    #[expect(clippy::cast_possible_truncation, reason = "whole seconds")]
    let identity = Arc::new(FlightIdentity {
        tail: "V-001".into(),
        start: flight::Timestamp::from_second(start_s as i64).unwrap(),
        flight: format!("{flight:04}"),
    });
    rows.iter()
        .enumerate()
        .map(|(index, row)| {
            let on = row.anti_ice_flight && row.sat > 233.0 + random.normal(0.0, 2.0);
            let flown = truth.fly(row, random.normal(0.0, 1.0e-4), on);
            let outlier = if random.uniform(0.0, 1.0) < setup.outliers {
                random.normal(0.0, 0.04)
            } else {
                0.0
            };
            let mut means = recorder.record(row, &flown, outlier, random);
            means.time_s = 720.0 * index as f64;
            #[expect(clippy::cast_possible_truncation, reason = "counts of a few")]
            let rows = (0..10).map(|k| 12 * index as u32 + k).collect();
            Segment { identity: Arc::clone(&identity), rows, means, temperature_assumed: false }
        })
        .collect()
}

/// The sensors during one flight, with the errors that last through it.
struct Recorder<'a> {
    truth: &'a Truth,
    /// Factor on all noise.
    noise: f64,
    /// Error of the recorded mass, kg.
    loading: f64,
    /// Relative error of the heating value.
    heating: f64,
    /// Relative difference between the engines.
    split: f64,
}

impl<'a> Recorder<'a> {
    fn new(truth: &'a Truth, noise: f64, random: &mut Random) -> Self {
        let loading = random.normal(0.0, 80.0 * noise);
        let scatter = 0.01 * truth.size(EffectId::FuelHeatingValue);
        let heating = random.normal(0.0, 0.003 * noise) + random.normal(0.0, 1.0) * scatter;
        let split = random.normal(0.0, 0.010 * noise);
        Self { truth, noise, loading, heating, split }
    }

    /// Relative error of each engine's fuel flow meter.
    fn gains(&self) -> [f64; 2] {
        let t = |id| self.truth.size(id);
        [1_u8, 2].map(|k| 0.01 * (t(EffectId::FuelFlowGain) + t(EffectId::FuelFlowGainEngine(k))))
    }

    /// The means of one segment, at time 0.
    fn record(&self, row: &Row, flown: &Flown, outlier: f64, random: &mut Random) -> SegmentMeans {
        let flows = self.fuel_flows(flown, outlier, random);
        let (h, mach, sat) = self.air_data(row, random);
        let (counted, mass) = self.fuel_used_and_mass(row);
        let n2 = self.n2(row, flown, random);
        let roll = row.roll + random.normal(0.0, 0.1);
        let true_tas = row.mach * (1.4 * R * row.sat).sqrt();
        let crab_deg = (row.cross / true_tas).clamp(-0.4, 0.4).asin().to_degrees();
        SegmentMeans {
            time_s: 0.0,
            pressure_altitude_m: h,
            static_air_temperature_k: sat,
            mach,
            true_airspeed_m_s: mach * (1.4 * R * sat).sqrt(),
            ground_speed_m_s: row.ground_speed,
            acceleration_m_s2: row.acc + random.normal(0.0, 0.001 * self.noise),
            vertical_speed_m_s: 0.0,
            mass_kg: mass,
            fuel_flow_total_kg_s: flows[0] + flows[1],
            fuel_flow_engine_kg_s: flows,
            fuel_used_kg: counted,
            drift_deg: Some(-crab_deg),
            roll_deg: Some(roll),
            roll_squared_deg2: Some(roll * roll),
            n2_percent: n2,
            latitude_deg: Some(row.lat),
            longitude_deg: None,
            true_heading_deg: Some(row.track + crab_deg),
            center_of_gravity_percent_mac: Some(row.cg),
            total_air_temperature_k: None,
            n1_percent: [None; flight::MAXIMUM_ENGINES],
            exhaust_gas_temperature_k: [None; flight::MAXIMUM_ENGINES],
            fuel_quantity_kg: None,
            anti_ice: None,
        }
    }

    fn fuel_flows(&self, flown: &Flown, outlier: f64, random: &mut Random) -> Vec<f64> {
        let meter = 0.005 * core::f64::consts::SQRT_2 * self.noise;
        let gain = self.gains();
        (0..2)
            .map(|k| {
                let half = if k == 0 { 0.5 } else { -0.5 } * self.split;
                let e = self.heating + half + random.normal(0.0, meter) + outlier;
                flown.flows[k] * (1.0 + gain[k]) * e.exp()
            })
            .collect()
    }

    /// Pressure altitude, Mach number and SAT, exactly: an error of static pressure keeps total pressure.
    fn air_data(&self, row: &Row, random: &mut Random) -> (f64, f64, f64) {
        let (t, noise) = (|id| self.truth.size(id), self.noise);
        let (_, p) = isa(row.h);
        let error = 1.0 + 0.01 * t(EffectId::StaticPressureBias);
        let read = p * error;
        let mut h = if read > 22_632.06 {
            (288.15 - 288.15 * (read / 101_325.0).powf(0.0065 * R / G0)) / 0.0065
        } else {
            11_000.0 - R * 216.65 / G0 * (read / 22_632.06).ln()
        };
        h += random.normal(0.0, 8.0 * noise);
        let total = (1.0 + 0.2 * row.mach * row.mach) * error.powf(-2.0 / 7.0);
        let mach = ((total - 1.0) / 0.2).sqrt()
            + t(EffectId::MachBias)
            + random.normal(0.0, 0.001 * noise);
        let sat = row.sat + t(EffectId::TemperatureBias) + random.normal(0.0, 0.3 * noise);
        (h, mach, sat)
    }

    fn fuel_used_and_mass(&self, row: &Row) -> (f64, f64) {
        let t = |id| self.truth.size(id);
        let gain = self.gains();
        let counted = row.fuel_used * (1.0 + 0.5 * (gain[0] + gain[1]))
            / (1.0 - 0.01 * t(EffectId::FuelQuantityGain));
        let mass =
            row.mass - (counted - row.fuel_used) - t(EffectId::ZeroFuelMassBias) - self.loading;
        (counted, mass)
    }

    /// Rotor speeds follow the true corrected thrust, percent.
    fn n2(&self, row: &Row, flown: &Flown, random: &mut Random) -> Vec<f64> {
        let lx = flown.ln_corrected_thrust - 60e3_f64.ln();
        let theta_t = row.sat / 288.15 * (1.0 + 0.2 * row.mach * row.mach);
        let n2 = 0.16 * lx - 0.05 * lx * lx + 0.04 * (row.mach - 0.8) + 0.5 * theta_t.ln();
        let n2 = 100.0 * (n2 + random.normal(0.0, 0.0008 * self.noise)).exp();
        vec![n2 * (1.0 + 0.08 * self.split), n2 * (1.0 - 0.08 * self.split)]
    }
}
