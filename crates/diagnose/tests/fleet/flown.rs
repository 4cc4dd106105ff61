//! A virtual fleet on the level of segments: design, truth, sensors. Dev-only; it shares no physics with the library.
//!
//! The truth's forms are not the library's: Prandtl–Schlichting friction for a power law, saturating ageing for a rate,
//! two half-parabolas for one, bent trim drag, a hidden anti-ice switch, ageostrophic wind, exact sensor errors.
#![allow(dead_code, reason = "each test uses its part")]
#![allow(
    clippy::unwrap_used,
    reason = "tests and examples only; in the library's own tests the lint is off"
)]

use std::sync::Arc;

use diagnose::{FlightRecord, GaugeBurn};
use effects::ExtendedModel;
use flight::effect::{EffectId, TypicalSize};
use flight::{FlightIdentity, Segment, SegmentMeans};
use lut::surface::{Basis, Surface};
use perf_model::{Aircraft, PerformanceModel};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

const WING_M2: f64 = 48.96;
const G0: f64 = 9.80665;
const R: f64 = 287.05287;
const YEAR_S: f64 = 365.25 * 86_400.0;
const EPOCH_S: f64 = 1.55e9;
const CD0: f64 = 0.0188;
const K: f64 = 0.056;
const MASS_KG: f64 = 13_300.0;
const FUEL_FLOW_KG_S: f64 = 0.235;

pub(crate) fn isa(h: f64) -> (f64, f64) {
    if h < 11_000.0 {
        let t = 288.15 - 0.0065 * h;
        (t, 101_325.0 * (t / 288.15).powf(G0 / (0.0065 * R)))
    } else {
        (216.65, 22_632.06 * (-G0 * (h - 11_000.0) / (R * 216.65)).exp())
    }
}

fn wave(mach: f64, lift: f64) -> f64 {
    20.0 * (mach - (0.797 - 0.085 * (lift - 0.35))).max(0.0).powi(4)
        + 0.0010 * ((mach - 0.60) / 0.3).max(0.0).powi(3)
}

/// The model that the diagnosis gets: the truth without any effect on a fine grid ("exact").
pub(crate) fn exact_model() -> ExtendedModel {
    let aircraft = Aircraft::from_ron(
        r#"(
            name: "virtual", type_code: "VIRT", engines: 2, wing_area_m2: 48.96,
            tsfc: (static_lb_per_lbf_h: 0.48, mach_exponent: 0.8),
            table: (lift_coefficient: (0.08, 0.72, 0.005), mach: (0.50, 0.95, 0.005)),
            sensors: (
                fuel_flow_percent: 0.7071,
                mass: Percent(0.6),
                // These sensors keep nothing through a flight.
                through_flight: (mach: 0, static_air_temperature_k: 0, n2_percent: 0, pressure_altitude_m: 0),
            ),
        )"#,
    )
    .unwrap();
    let grid = Arc::clone(aircraft.grid());
    let values = (0..grid.nodes())
        .map(|node| grid.coordinates(node))
        .map(|(lift, mach)| CD0 + K * lift * lift + wave(mach, lift))
        .collect();
    let table = lut::Table::new(Arc::clone(&grid), values).unwrap();
    let polynomial = Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] };
    let marks = vec![false; grid.nodes()];
    PerformanceModel::new(aircraft, polynomial, table, marks).unwrap().into()
}

pub(crate) struct Random(ChaCha8Rng);

impl Random {
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&stream.to_le_bytes());
        Self(ChaCha8Rng::from_seed(key))
    }

    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.0.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64);
        low + unit * (high - low)
    }

    pub(crate) fn normal(&mut self, mean: f64, deviation: f64) -> f64 {
        let z: f64 = StandardNormal.sample(&mut self.0);
        mean + deviation * z
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a number from 0 to n, rounded down"
    )]
    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.uniform(0.0, n as f64) as usize).min(n - 1)
    }
}

#[derive(Clone, Debug)]
struct Row {
    flight: usize,
    mach: f64,
    h: f64,
    sat: f64,
    mass: f64,
    fuel_used: f64,
    lat: f64,
    track: f64,
    roll: f64,
    acc: f64,
    cg: f64,
    years: f64,
    anti_ice_flight: bool,
    /// Wind to the left of the track, and ground speed.
    cross: f64,
    ground_speed: f64,
}

/// A planted effect with what hides in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planted {
    pub(crate) id: EffectId,
    pub(crate) size: f64,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Background {
    /// Size of every other effect, of its typical size.
    pub(crate) clutter: f64,
    /// Amplitude of the smooth table errors.
    pub(crate) field: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Setup {
    pub(crate) flights: usize,
    pub(crate) segments: usize,
    pub(crate) gauges: bool,
    pub(crate) outliers: f64,
    pub(crate) noise: f64,
}

impl Default for Setup {
    fn default() -> Self {
        Self { flights: 60, segments: 10, gauges: false, outliers: 0.0, noise: 1.0 }
    }
}

pub(crate) struct Fleet {
    pub(crate) flights: Vec<Vec<Segment>>,
    pub(crate) gauges: Vec<Option<GaugeBurn>>,
}

impl Fleet {
    pub(crate) fn records(&self) -> Vec<FlightRecord<'_>> {
        self.flights
            .iter()
            .zip(&self.gauges)
            .map(|(segments, &gauges)| FlightRecord { segments, gauges })
            .collect()
    }
}

pub(crate) fn typical(id: EffectId) -> f64 {
    match id.entry().typical {
        TypicalSize::Absolute(size) => size,
        TypicalSize::ShareOfMass(share) => share * MASS_KG,
        TypicalSize::Known => 1.0,
    }
}

/// An effect at a multiple of its typical size, sign drawn where physics leaves it open.
pub(crate) fn plant(id: EffectId, times: f64, random: &mut Random) -> Planted {
    let size = typical(id) * if id.is_known() { 1.0 } else { times };
    let sign = if id.is_one_sided() || id.is_known() || random.uniform(0.0, 1.0) < 0.5 {
        1.0
    } else {
        -1.0
    };
    Planted { id, size: sign * size }
}

fn design(random: &mut Random, setup: &Setup) -> Vec<Row> {
    let mut rows = Vec::new();
    for flight in 0..setup.flights {
        let low = random.uniform(0.0, 1.0) < 0.30;
        let zfw = random.uniform(9950.0, 11_300.0);
        let ramp = random.uniform(3200.0, 5800.0_f64).min(16_300.0 - zfw);
        let mut level =
            if low { random.uniform(250.0, 370.0) } else { random.uniform(370.0, 450.0) };
        let m0 = if low { random.uniform(0.56, 0.78) } else { random.uniform(0.78, 0.895) };
        let deviation = random.normal(0.0, 5.0);
        let years = 1.6 * (flight as f64 + random.uniform(0.0, 1.0)) / setup.flights as f64;
        let mut lat = random.uniform(25.0, 58.0);
        let mut track: f64 = random.uniform(0.0, 360.0);
        let cg0 = random.uniform(19.0, 33.0);
        let mut wind = [random.normal(18.0, 14.0), random.normal(0.0, 12.0)];
        let anti_ice_flight = random.uniform(0.0, 1.0) < 0.8;
        let mut used = random.uniform(350.0, 700.0);
        for s in 0..setup.segments {
            if s > 0 && random.uniform(0.0, 1.0) < 0.22 {
                level = (level + 20.0_f64).min(470.0);
            }
            let jump = if random.uniform(0.0, 1.0) < 0.15 { random.normal(0.0, 0.04) } else { 0.0 };
            let mut mach = (m0 + random.normal(0.0, 0.018) + jump).clamp(0.55, 0.90);
            used += random.uniform(120.0, (ramp - 900.0) / setup.segments as f64 * 1.4);
            used = used.min(ramp - 500.0);
            let h = level * 30.48;
            let (t, p) = isa(h);
            let mass = zfw + ramp - used;
            let lift = |mach: f64| mass * G0 / (0.7 * p * mach * mach * WING_M2);
            while lift(mach) > 0.60 {
                mach += 0.02;
            }
            mach = mach.min(0.905);
            lat = (lat + track.to_radians().cos() * random.uniform(0.3, 1.2)).clamp(15.0, 65.0);
            wind = [wind[0] + random.normal(0.0, 5.0), wind[1] + random.normal(0.0, 5.0)];
            if random.uniform(0.0, 1.0) < 0.15 {
                track = (track + random.normal(0.0, 35.0)).rem_euclid(360.0);
            }
            let roll = if random.uniform(0.0, 1.0) > 0.06 {
                random.normal(0.0, 0.45)
            } else {
                random.uniform(8.0, 25.0) * if random.uniform(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 }
            };
            let sat = t + deviation + random.normal(0.0, 1.2);
            let tr = track.to_radians();
            let tas = mach * (1.4 * R * sat).sqrt();
            rows.push(Row {
                flight,
                mach,
                h,
                sat,
                mass,
                fuel_used: used,
                lat,
                track,
                roll,
                acc: random.normal(0.0, 0.0045),
                cg: cg0 + 2.0 * (used / 3000.0 - 0.5) + random.normal(0.0, 0.3),
                years,
                anti_ice_flight,
                cross: -(wind[0] * tr.cos() - wind[1] * tr.sin()),
                ground_speed: tas + wind[0] * tr.sin() + wind[1] * tr.cos(),
            });
        }
    }
    rows
}

struct Field {
    weights: Vec<([f64; 3], f64, f64)>,
}

impl Field {
    fn new(random: &mut Random, amplitude: f64) -> Self {
        let weights = (0..12)
            .map(|_| {
                let w = [random.normal(0.0, 1.0), random.normal(0.0, 1.0), random.normal(0.0, 1.0)];
                let phase = random.uniform(0.0, core::f64::consts::TAU);
                (w, phase, amplitude * (2.0_f64 / 12.0).sqrt() * random.normal(0.0, 1.0))
            })
            .collect();
        Self { weights }
    }

    fn at(&self, mach: f64, other: f64, h: f64) -> f64 {
        let z = [(mach - 0.8) / 0.08, other, (h - 12_000.0) / 1800.0];
        self.weights
            .iter()
            .map(|(w, phase, a)| a * (w[0] * z[0] + w[1] * z[1] + w[2] * z[2] + phase).cos())
            .sum()
    }
}

struct Truth<'a> {
    effects: &'a [Planted],
    drag_field: Option<Field>,
    fuel_field: Option<Field>,
    step_years: f64,
    step_drag: bool,
    /// Means over the design: what sizes are stated at.
    mean_age: f64,
    mean_reynolds: f64,
    mean_mach: f64,
    mean_theta: f64,
    mean_x: f64,
    mean_cg: f64,
}

fn aged(years: f64) -> f64 {
    1.3 * (1.0 - (-years / 1.3).exp()) * 1.25
}

fn reynolds(p: f64, sat: f64, mach: f64) -> f64 {
    let v = mach * (1.4 * R * sat).sqrt();
    p / (R * sat) * v / (1.458e-6 * sat.powf(1.5) / (sat + 110.4))
}

struct Flown {
    flows: [f64; 2],
    ln_corrected_thrust: f64,
}

impl Truth<'_> {
    fn size(&self, id: EffectId) -> f64 {
        self.effects.iter().filter(|e| e.id == id).map(|e| e.size).sum()
    }

    fn fly(&self, row: &Row, ageostrophic: f64, anti_ice: bool) -> Flown {
        let t = |id| self.size(id);
        let (_, p) = isa(row.h);
        let mut g = G0;
        let lat = row.lat.to_radians();
        if t(EffectId::LocalGravity) != 0.0 {
            g = 9.780327 * (1.0 + 0.0053024 * lat.sin().powi(2)) - 3.086e-6 * row.h;
        }
        if t(EffectId::RotatingEarth) != 0.0 {
            let east = row.ground_speed * row.track.to_radians().sin();
            g -= 2.0 * 7.292115e-5 * east * lat.cos() + row.ground_speed.powi(2) / 6.371e6;
        }
        let n =
            if t(EffectId::LoadFactor) == 0.0 { 1.0 } else { 1.0 / row.roll.to_radians().cos() };
        let q = 0.7 * p * row.mach * row.mach;
        let cl = row.mass * g * n / (q * WING_M2);
        let mut cd0 = CD0;
        let r = t(EffectId::ReynoldsNumber);
        if r != 0.0 {
            let law = |re: f64| 0.455 / (re * 2.75).log10().powf(2.58);
            let at = self.mean_reynolds;
            let e0 = 2.58 / (at * 2.75).ln();
            cd0 *= 1.0 + r / e0 * (law(reynolds(p, row.sat, row.mach)) / law(at) - 1.0);
        }
        cd0 += t(EffectId::ZeroLiftDrag) * 1e-4;
        let age = aged(row.years) - self.mean_age;
        cd0 *= 1.0 + 0.01 * t(EffectId::AirframeAgeing) * age;
        let induced = K * cl * cl * (1.0 + 0.01 * t(EffectId::InducedDrag));
        let mut cd = cd0 + induced + wave(row.mach + t(EffectId::WaveDrag), cl);
        cd *= 1.0 + 0.01 * t(EffectId::DragFactor);
        let x = (self.mean_cg - row.cg) / 10.0;
        cd += t(EffectId::TrimDragCg) * 1e-4 * (x + 0.15 * x * x.abs()) * cl / 0.4;
        if row.roll.abs() < 5.0 {
            cd += t(EffectId::AsymmetryDrag) * 1e-4 * row.roll * row.roll;
        }
        let stepped = row.years >= self.step_years;
        if stepped && self.step_drag {
            cd *= 1.0 + 0.01 * t(EffectId::StepChange);
        }
        let mut drag = q * WING_M2 * cd;
        if let Some(field) = &self.drag_field {
            drag *= 1.0 + field.at(row.mach, (cl - 0.33) / 0.08, row.h);
        }
        let coriolis = 2.0 * 7.292115e-5 * lat.sin();
        let mut thrust = drag + row.mass * row.acc;
        let slope = t(EffectId::IsobaricSlope);
        if slope != 0.0 {
            thrust += slope * row.mass * G0 * (0.92 * coriolis * row.cross / G0 + ageostrophic);
        }
        let theta = row.sat / 288.15;
        let delta = p / 101_325.0;
        let corrected = thrust / delta;
        let mut factor = 1.0 + 0.01 * t(EffectId::TsfcFactor);
        // A power of Mach number, and a straight line in temperature, with the library's slopes at the mean.
        let power = t(EffectId::TsfcMachExponent) * self.mean_mach / (1.0 + self.mean_mach);
        factor *= (row.mach / self.mean_mach).powf(power);
        factor *= 1.0 + t(EffectId::TsfcTemperatureExponent) * (theta / self.mean_theta - 1.0);
        let z = (corrected / self.mean_x - 1.0) / 0.25;
        let half = if z < 0.0 { 1.15 } else { 0.70 };
        factor *= 1.0 + 0.01 * t(EffectId::TsfcThrottle) * half * (z * z).min(6.0);
        factor *= 1.0 + 0.01 * t(EffectId::EngineAgeing) * age;
        let mut flow =
            0.48 / (3600.0 * G0) * theta.sqrt() * (1.0 + row.mach).powf(0.8) * thrust * factor;
        if let Some(field) = &self.fuel_field {
            flow *= 1.0 + field.at(row.mach, (corrected / self.mean_x - 1.0) / 0.2, row.h);
        }
        flow += 0.01 * t(EffectId::PowerOfftake) * FUEL_FLOW_KG_S;
        if anti_ice {
            flow *= 1.0 + 0.01 * t(EffectId::AntiIceBleed);
        }
        if stepped && !self.step_drag {
            flow *= 1.0 + 0.01 * t(EffectId::StepChange);
        }
        let flows = [1_u8, 2].map(|k| 0.5 * flow * (1.0 + 0.01 * t(EffectId::TsfcEngine(k))));
        Flown { flows, ln_corrected_thrust: corrected.ln() }
    }
}

/// Flies a fleet with effects.
#[expect(clippy::too_many_lines, reason = "one row from truth to sensors, step by step")]
#[expect(clippy::cast_possible_truncation, reason = "whole seconds, and counts of a few")]
pub(crate) fn fly(seed: u64, setup: &Setup, effects: &[Planted], background: &Background) -> Fleet {
    let mut random = Random::new(seed, 1);
    let rows = design(&mut random, setup);
    let mut random = Random::new(seed, 2);
    let mut all = effects.to_vec();
    if background.clutter > 0.0 {
        for id in EffectId::library(2) {
            if id == EffectId::StepChange || effects.iter().any(|e| e.id == id) {
                continue;
            }
            let v = random.normal(0.0, background.clutter) * typical(id);
            all.push(Planted { id, size: if id.is_one_sided() { v.abs() } else { v } });
        }
    }
    let count = rows.len() as f64;
    let mean = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).sum::<f64>() / count;
    let mut truth = Truth {
        effects: &all,
        drag_field: (background.field > 0.0).then(|| Field::new(&mut random, background.field)),
        fuel_field: (background.field > 0.0).then(|| Field::new(&mut random, background.field)),
        step_years: random.uniform(0.3, 1.3),
        step_drag: random.uniform(0.0, 1.0) < 0.5,
        mean_age: mean(&|r| aged(r.years)),
        mean_reynolds: mean(&|r| reynolds(isa(r.h).1, r.sat, r.mach)),
        mean_mach: mean(&|r| r.mach),
        mean_theta: mean(&|r| r.sat / 288.15),
        mean_x: 1.0,
        mean_cg: mean(&|r| r.cg),
    };
    truth.mean_x = mean(&|r| {
        let (_, p) = isa(r.h);
        let q = 0.7 * p * r.mach * r.mach;
        let cl = r.mass * G0 / (q * WING_M2);
        q * WING_M2 * (CD0 + K * cl * cl + wave(r.mach, cl)) / (p / 101_325.0)
    });
    let t = |id| truth.size(id);
    let noise = setup.noise;
    let mut random = Random::new(seed, 3);
    let mut fleet = Fleet { flights: vec![Vec::new(); setup.flights], gauges: vec![] };
    for flight in 0..setup.flights {
        let loading = random.normal(0.0, 80.0 * noise);
        let scatter = 0.01 * t(EffectId::FuelHeatingValue);
        let heating = random.normal(0.0, 0.003 * noise) + random.normal(0.0, 1.0) * scatter;
        let split = random.normal(0.0, 0.010 * noise);
        let start_s =
            EPOCH_S + rows.iter().find(|r| r.flight == flight).map_or(0.0, |r| r.years) * YEAR_S;
        let identity = Arc::new(FlightIdentity {
            tail: "V-001".into(),
            start: flight::Timestamp::from_second(start_s as i64).unwrap(),
            flight: format!("{flight:04}"),
        });
        for (index, row) in rows.iter().filter(|r| r.flight == flight).enumerate() {
            let on = row.anti_ice_flight && row.sat > 233.0 + random.normal(0.0, 2.0);
            let flown = truth.fly(row, random.normal(0.0, 1.0e-4), on);
            let outlier = if random.uniform(0.0, 1.0) < setup.outliers {
                random.normal(0.0, 0.04)
            } else {
                0.0
            };
            let meter = 0.005 * core::f64::consts::SQRT_2 * noise;
            let gain = [1_u8, 2]
                .map(|k| 0.01 * (t(EffectId::FuelFlowGain) + t(EffectId::FuelFlowGainEngine(k))));
            let flows: Vec<f64> = (0..2)
                .map(|k| {
                    let half = if k == 0 { 0.5 } else { -0.5 } * split;
                    let e = heating + half + random.normal(0.0, meter) + outlier;
                    flown.flows[k] * (1.0 + gain[k]) * e.exp()
                })
                .collect();
            // Sensors, exactly: static pressure with total pressure kept, Mach number, SAT with TAS.
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
            let tas = mach * (1.4 * R * sat).sqrt();
            let counted = row.fuel_used * (1.0 + 0.5 * (gain[0] + gain[1]))
                / (1.0 - 0.01 * t(EffectId::FuelQuantityGain));
            let mass =
                row.mass - (counted - row.fuel_used) - t(EffectId::ZeroFuelMassBias) - loading;
            let lx = flown.ln_corrected_thrust - 60e3_f64.ln();
            let theta_t = row.sat / 288.15 * (1.0 + 0.2 * row.mach * row.mach);
            let n2 = 0.16 * lx - 0.05 * lx * lx + 0.04 * (row.mach - 0.8) + 0.5 * theta_t.ln();
            let n2 = 100.0 * (n2 + random.normal(0.0, 0.0008 * noise)).exp();
            let true_tas = row.mach * (1.4 * R * row.sat).sqrt();
            let roll = row.roll + random.normal(0.0, 0.1);
            fleet.flights[flight].push(Segment {
                identity: Arc::clone(&identity),
                rows: (0..10).map(|k| 12 * index as u32 + k).collect(),
                means: SegmentMeans {
                    time_s: 720.0 * index as f64,
                    pressure_altitude_m: h,
                    static_air_temperature_k: sat,
                    mach,
                    true_airspeed_m_s: tas,
                    ground_speed_m_s: row.ground_speed,
                    acceleration_m_s2: row.acc + random.normal(0.0, 0.001 * noise),
                    vertical_speed_m_s: 0.0,
                    mass_kg: mass,
                    fuel_flow_total_kg_s: flows[0] + flows[1],
                    fuel_flow_engine_kg_s: flows,
                    fuel_used_kg: counted,
                    drift_deg: Some(-(row.cross / true_tas).clamp(-0.4, 0.4).asin().to_degrees()),
                    roll_deg: Some(roll),
                    roll_squared_deg2: Some(roll * roll),
                    n2_percent: vec![n2 * (1.0 + 0.08 * split), n2 * (1.0 - 0.08 * split)],
                    latitude_deg: Some(row.lat),
                    longitude_deg: None,
                    true_heading_deg: Some(
                        row.track + (row.cross / true_tas).clamp(-0.4, 0.4).asin().to_degrees(),
                    ),
                    center_of_gravity_percent_mac: Some(row.cg),
                    total_air_temperature_k: None,
                    n1_percent: [None; flight::MAXIMUM_ENGINES],
                    exhaust_gas_temperature_k: [None; flight::MAXIMUM_ENGINES],
                    fuel_quantity_kg: None,
                    anti_ice: None,
                },
                temperature_assumed: false,
            });
        }
        let of_flight: Vec<&Row> = rows.iter().filter(|r| r.flight == flight).collect();
        let burn = of_flight[of_flight.len() - 1].fuel_used - of_flight[0].fuel_used;
        let gain = 0.01
            * (t(EffectId::FuelFlowGain)
                + 0.5 * (t(EffectId::FuelFlowGainEngine(1)) + t(EffectId::FuelFlowGainEngine(2))));
        fleet.gauges.push((setup.gauges && burn > 400.0).then(|| GaugeBurn {
            gauged_kg: burn + random.normal(0.0, 25.0),
            metered_kg: burn * (1.0 + gain),
            deviation_kg: 25.0,
        }));
    }
    fleet
}
