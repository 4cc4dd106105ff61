//! The truth: drag, thrust and fuel flow with every effect, in forms of its own.

use flight::effect::EffectId;

use super::aircraft::{CD0, G0, K, R, WING_M2, isa, wave};
use super::design::Row;
use super::{Planted, Random};

/// Mean fuel flow that power offtake is stated as a share of.
const FUEL_FLOW_KG_S: f64 = 0.235;
/// Of the Earth, rad/s.
const ROTATION: f64 = 7.292115e-5;

/// A fleet's aircraft and engines with effects.
pub(super) struct Truth {
    effects: Vec<Planted>,
    drag_field: Option<Field>,
    fuel_field: Option<Field>,
    step_years: f64,
    step_drag: bool,
    means: Means,
}

/// Fuel flow of each engine in kg/s, and ln of corrected thrust in N.
pub(super) struct Flown {
    pub(super) flows: [f64; 2],
    pub(super) ln_corrected_thrust: f64,
}

impl Truth {
    /// With smooth errors of an amplitude, relative; 0: none. Draws them, and where a step lies and what it changes.
    pub(super) fn new(
        rows: &[Row],
        effects: Vec<Planted>,
        field: f64,
        random: &mut Random,
    ) -> Self {
        Self {
            effects,
            drag_field: (field > 0.0).then(|| Field::new(random, field)),
            fuel_field: (field > 0.0).then(|| Field::new(random, field)),
            step_years: random.uniform(0.3, 1.3),
            step_drag: random.uniform(0.0, 1.0) < 0.5,
            means: Means::new(rows),
        }
    }

    /// Sum of the sizes of an effect; 0 where it is absent.
    pub(super) fn size(&self, id: EffectId) -> f64 {
        self.effects.iter().filter(|e| e.id == id).map(|e| e.size).sum()
    }

    /// What the engines do at a row, with an ageostrophic slope of the isobaric surface.
    pub(super) fn fly(&self, row: &Row, ageostrophic: f64, anti_ice: bool) -> Flown {
        let (_, p) = isa(row.h);
        let q = 0.7 * p * row.mach * row.mach;
        let n = if self.size(EffectId::LoadFactor) == 0.0 {
            1.0
        } else {
            1.0 / row.roll.to_radians().cos()
        };
        let cl = row.mass * self.gravity(row) * n / (q * WING_M2);
        let mut drag = q * WING_M2 * self.drag_coefficient(row, cl);
        if let Some(field) = &self.drag_field {
            drag *= 1.0 + field.at(row.mach, (cl - 0.33) / 0.08, row.h);
        }
        let coriolis = 2.0 * ROTATION * row.lat.to_radians().sin();
        let mut thrust = drag + row.mass * row.acc;
        let slope = self.size(EffectId::IsobaricSlope);
        if slope != 0.0 {
            thrust += slope * row.mass * G0 * (0.92 * coriolis * row.cross / G0 + ageostrophic);
        }
        let corrected = thrust / (p / 101_325.0);
        let flow = self.fuel_flow(row, thrust, corrected, anti_ice);
        let flows =
            [1_u8, 2].map(|k| 0.5 * flow * (1.0 + 0.01 * self.size(EffectId::TsfcEngine(k))));
        Flown { flows, ln_corrected_thrust: corrected.ln() }
    }

    fn gravity(&self, row: &Row) -> f64 {
        let lat = row.lat.to_radians();
        let mut g = G0;
        if self.size(EffectId::LocalGravity) != 0.0 {
            g = 9.780327 * (1.0 + 0.0053024 * lat.sin().powi(2)) - 3.086e-6 * row.h;
        }
        if self.size(EffectId::RotatingEarth) != 0.0 {
            let east = row.ground_speed * row.track.to_radians().sin();
            g -= 2.0 * ROTATION * east * lat.cos() + row.ground_speed.powi(2) / 6.371e6;
        }
        g
    }

    fn drag_coefficient(&self, row: &Row, cl: f64) -> f64 {
        let t = |id| self.size(id);
        let mut cd0 = CD0;
        let r = t(EffectId::ReynoldsNumber);
        if r != 0.0 {
            let law = |re: f64| 0.455 / (re * 2.75).log10().powf(2.58);
            let at = self.means.reynolds;
            let e0 = 2.58 / (at * 2.75).ln();
            let (_, p) = isa(row.h);
            cd0 *= 1.0 + r / e0 * (law(reynolds(p, row.sat, row.mach)) / law(at) - 1.0);
        }
        cd0 += t(EffectId::ZeroLiftDrag) * 1e-4;
        cd0 *= 1.0 + 0.01 * t(EffectId::AirframeAgeing) * (aged(row.years) - self.means.age);
        cd0 *= 1.0 + 0.01 * t(EffectId::AirframeHistory) * self.gathered(row.years);
        let induced = K * cl * cl * (1.0 + 0.01 * t(EffectId::InducedDrag));
        let mut cd = cd0 + induced + wave(row.mach + t(EffectId::WaveDrag), cl);
        cd *= 1.0 + 0.01 * t(EffectId::DragFactor);
        let x = (self.means.cg - row.cg) / 10.0;
        cd += t(EffectId::TrimDragCg) * 1e-4 * (x + 0.15 * x * x.abs()) * cl / 0.4;
        if row.roll.abs() < 5.0 {
            cd += t(EffectId::AsymmetryDrag) * 1e-4 * row.roll * row.roll;
        }
        if row.years >= self.step_years && self.step_drag {
            cd *= 1.0 + 0.01 * t(EffectId::StepChange);
        }
        cd
    }

    /// Years of a deterioration from the first day on, of which three quarters are taken back on the date of a step.
    fn gathered(&self, years: f64) -> f64 {
        if years >= self.step_years { years - 0.75 * self.step_years } else { years }
    }

    /// Of both engines, before what tells them apart, kg/s.
    fn fuel_flow(&self, row: &Row, thrust: f64, corrected: f64, anti_ice: bool) -> f64 {
        let t = |id| self.size(id);
        let means = &self.means;
        let theta = row.sat / 288.15;
        let mut factor = 1.0 + 0.01 * t(EffectId::TsfcFactor);
        // A power of Mach number, and a straight line in temperature, with the library's slopes at the mean.
        let power = t(EffectId::TsfcMachExponent) * means.mach / (1.0 + means.mach);
        factor *= (row.mach / means.mach).powf(power);
        factor *= 1.0 + t(EffectId::TsfcTemperatureExponent) * (theta / means.theta - 1.0);
        let z = (corrected / means.corrected_thrust - 1.0) / 0.25;
        let half = if z < 0.0 { 1.15 } else { 0.70 };
        factor *= 1.0 + 0.01 * t(EffectId::TsfcThrottle) * half * (z * z).min(6.0);
        factor *= 1.0 + 0.01 * t(EffectId::EngineAgeing) * (aged(row.years) - means.age);
        factor *= 1.0 + 0.01 * t(EffectId::EngineHistory) * self.gathered(row.years);
        let mut flow =
            0.48 / (3600.0 * G0) * theta.sqrt() * (1.0 + row.mach).powf(0.8) * thrust * factor;
        if let Some(field) = &self.fuel_field {
            let x = (corrected / means.corrected_thrust - 1.0) / 0.2;
            flow *= 1.0 + field.at(row.mach, x, row.h);
        }
        flow += 0.01 * t(EffectId::PowerOfftake) * FUEL_FLOW_KG_S;
        if anti_ice {
            flow *= 1.0 + 0.01 * t(EffectId::AntiIceBleed);
        }
        if row.years >= self.step_years && !self.step_drag {
            flow *= 1.0 + 0.01 * t(EffectId::StepChange);
        }
        flow
    }
}

/// Means over the design: what sizes are stated at.
struct Means {
    age: f64,
    reynolds: f64,
    mach: f64,
    theta: f64,
    corrected_thrust: f64,
    cg: f64,
}

impl Means {
    fn new(rows: &[Row]) -> Self {
        let count = rows.len() as f64;
        let mean = |value: &dyn Fn(&Row) -> f64| rows.iter().map(value).sum::<f64>() / count;
        Self {
            age: mean(&|r| aged(r.years)),
            reynolds: mean(&|r| reynolds(isa(r.h).1, r.sat, r.mach)),
            mach: mean(&|r| r.mach),
            theta: mean(&|r| r.sat / 288.15),
            corrected_thrust: mean(&|r| {
                let (_, p) = isa(r.h);
                let q = 0.7 * p * r.mach * r.mach;
                let cl = r.mass * G0 / (q * WING_M2);
                q * WING_M2 * (CD0 + K * cl * cl + wave(r.mach, cl)) / (p / 101_325.0)
            }),
            cg: mean(&|r| r.cg),
        }
    }
}

/// A smooth random function of Mach number, one more variable, and altitude.
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

/// Ageing saturates; 1 after a year, about.
fn aged(years: f64) -> f64 {
    1.3 * (1.0 - (-years / 1.3).exp()) * 1.25
}

/// Per length, 1/m.
fn reynolds(p: f64, sat: f64, mach: f64) -> f64 {
    let v = mach * (1.4 * R * sat).sqrt();
    p / (R * sat) * v / (1.458e-6 * sat.powf(1.5) / (sat + 110.4))
}
