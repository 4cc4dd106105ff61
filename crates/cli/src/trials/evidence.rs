//! What the diagnosis is given: a model that was denied the effect, and segments. No name of an effect, no size.

use std::sync::Arc;

use diagnose::{
    Baseline, Diagnosis, FlightRecord, GaugeBurn, Input, Options, TableUncertainty, diagnose,
};
use flight::Segment;
use flight::effect::EffectId;
use lut::Table;
use lut::surface::{Basis, Surface};
use perf_model::aircraft::{
    AircraftFile, AxisFile, FlightBias, FuelFlowDrift, MassDeviation, SensorDeviations, TableFile,
    TsfcFile,
};
use perf_model::{Aircraft, PerformanceModel};
use rayon::prelude::*;
use segmenter::TrimCriteria;
use simulate::study::DragError;
use simulate::{
    AircraftTruth, ChannelSensor, DRIFT_TIME_CONSTANT_S, Scatter, Sensors, Simulation,
    SimulationError, TruthPhysics,
};
use units::Mach;
use units::convert::TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR;

use super::case::CaseFailure;
use super::draw::{TAIL, Withheld};
use crate::commands::diagnose::table_uncertainty;
use crate::learning::{self, FlightToLearn, LawChoice};
use crate::model_file::LedgerEntry;

/// Grid of an exact model: chords of it err by less than 0.005 % of drag below the drag rise.
const FINE: [(f64, f64, f64); 2] = [(0.08, 0.75, 0.005), (0.50, 0.95, 0.005)];
/// Grid of an adapted model, as an aircraft file of the paper has it.
const COARSE: [(f64, f64, f64); 2] = [(0.10, 0.75, 0.05), (0.50, 0.95, 0.05)];

/// What the diagnosis is given.
#[derive(Clone, Debug)]
pub struct Evidence {
    model: PerformanceModel,
    /// The adapted drag table; the model's own where nothing was learnt.
    drag_table: Table,
    baseline: Option<Baseline>,
    uncertainty: Option<TableUncertainty>,
    flights: Vec<FlightSegments>,
}

/// One flight, reduced as every command reduces it.
#[derive(Clone, Debug)]
pub(super) struct FlightSegments {
    pub(super) segments: Vec<Segment>,
    gauges: Option<GaugeBurn>,
    samples: usize,
}

impl Evidence {
    /// Flies a case and makes the model that is denied what the case withholds.
    ///
    /// # Errors
    /// What the simulator, the segmenter or the law of adaptation refuses.
    pub fn gather(withheld: &Withheld) -> Result<Self, CaseFailure> {
        let clean = withheld.clean_flights();
        let sensors = withheld.flown().plan().sensors.sensors();
        let flights = fly(withheld.flown(), clean..withheld.flown().len())?;
        if clean == 0 {
            let model =
                denied_model(withheld.aircraft(), withheld.physics(), &sensors, &FINE, None)?;
            let drag_table = model.drag_table().clone();
            return Ok(Self { model, drag_table, baseline: None, uncertainty: None, flights });
        }
        let lessons = fly(withheld.lessons(), 0..clean)?;
        let error = DragError::study();
        let initial =
            denied_model(withheld.aircraft(), withheld.physics(), &sensors, &COARSE, Some(&error))?;
        adapted(initial, &lessons, flights)
    }

    /// The diagnosis; a quick one leaves out closure and places.
    ///
    /// # Errors
    /// What the diagnosis refuses.
    pub fn diagnose(&self, without: &[EffectId], quick: bool) -> Result<Diagnosis, CaseFailure> {
        let records = self.records();
        let options = Options {
            without: without.to_vec(),
            skip_closure: quick,
            skip_where: quick,
            ..Options::default()
        };
        Ok(diagnose(&self.input(&records), &options)?)
    }

    /// The same model held against other flights, for the scorer.
    pub(super) fn against(&self, flights: Vec<FlightSegments>) -> Self {
        Self { flights, ..self.clone() }
    }

    pub(super) fn records(&self) -> Vec<FlightRecord<'_>> {
        self.flights
            .iter()
            .filter(|flight| !flight.segments.is_empty())
            .map(|flight| FlightRecord { segments: &flight.segments, gauges: flight.gauges })
            .collect()
    }

    pub(super) fn input<'a>(&'a self, records: &'a [FlightRecord<'a>]) -> Input<'a> {
        Input {
            model: &self.model,
            drag_table: &self.drag_table,
            flights: records,
            baseline: self.baseline.as_ref(),
            table: self.uncertainty.as_ref(),
            references: self.baseline.as_ref().map(|baseline| *baseline.references()),
        }
    }
}

/// Flies, derives, segments: what `simulate` and `diagnose` do through files, without the files. A flight that the weather
/// does not allow is left out; the number of flights that were diagnosed is in every result.
pub(super) fn fly(
    simulation: &Simulation,
    indices: std::ops::Range<usize>,
) -> Result<Vec<FlightSegments>, CaseFailure> {
    let criteria = TrimCriteria::ghazi_2020_table_4();
    let planned = indices.len();
    let flown = indices
        .into_par_iter()
        .map(|index| {
            let report = match simulation.fly(index) {
                Ok(flown) => flown.report,
                // A day too warm for the planned level: nobody flies there.
                Err(SimulationError::Flight { .. }) => return Ok(None),
                Err(error) => return Err(error.into()),
            };
            let samples = report.len();
            let track = track::derive(report)?;
            let segments = segmenter::segment(&track, &criteria).segments;
            Ok(Some(FlightSegments { segments, gauges: GaugeBurn::of_track(&track), samples }))
        })
        .collect::<Result<Vec<_>, CaseFailure>>()?;
    let flown: Vec<FlightSegments> = flown.into_iter().flatten().collect();
    if 10 * flown.len() < 9 * planned {
        return Err(CaseFailure::NotFlown { flown: flown.len(), planned });
    }
    Ok(flown)
}

/// The truth's drag at its reference conditions, and its TSFC law at the best part load, as a model's table.
fn denied_model(
    truth: &AircraftTruth,
    physics: TruthPhysics,
    sensors: &Sensors,
    grid: &[(f64, f64, f64); 2],
    error: Option<&DragError>,
) -> Result<PerformanceModel, CaseFailure> {
    let axis = |(from, to, step)| AxisFile::Step { from, to, step };
    let aircraft = Aircraft::new(AircraftFile {
        name: truth.name.clone(),
        type_code: truth.type_code.clone(),
        engines: truth.engine.count,
        wing_area_m2: truth.airframe.wing_area_m2,
        tsfc: TsfcFile {
            static_lb_per_lbf_h: truth.engine.tsfc.static_kg_n_s
                / TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR,
            mach_exponent: truth.engine.tsfc.mach_exponent,
        },
        table: TableFile { lift_coefficient: axis(grid[0]), mach: axis(grid[1]) },
        polynomial: Basis::SeparableQuadratic,
        mean_aerodynamic_chord_m: Some(truth.airframe.mean_aerodynamic_chord_m),
        drag_divergence_mach: None,
        reference_lhv_mj_kg: None,
        sensors: sensor_deviations(sensors, &Scatter::default(), truth),
    })?;
    let at = truth.reference_conditions();
    let grid = Arc::clone(aircraft.grid());
    let values = (0..grid.nodes())
        .map(|node| grid.coordinates(node))
        .map(|(lift, mach)| {
            let drag = truth.drag_coefficient(lift, Mach::new(mach), &at, physics);
            drag * (1.0 + error.map_or(0.0, |error| error.at(mach, lift)))
        })
        .collect();
    let table = Table::new(Arc::clone(&grid), values)?;
    let polynomial = Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] };
    let extrapolated = vec![false; grid.nodes()];
    Ok(PerformanceModel::new(aircraft, polynomial, table, extrapolated)?)
}

/// What the aircraft file says of the fleet's sensors: what they do within a flight and from flight to flight, as an operator
/// sees it in past reports.
///
/// A slow wander of variance σ² and time constant τ has, over a time T, a mean of variance
///
/// ```text
/// v(T)·σ²,  v(T) = 2τ/T·(1 − τ/T·(1 − e^(−T/τ)))
/// ```
///
/// (Ornstein–Uhlenbeck process): v of a segment less v of a flight is left within the flight, and noise counts with 1/√10
/// (ten samples a segment). What a flow meter keeps through a flight is stated with the fuel's heating value, its wander, with
/// v of a segment, as what it is. Of what air data and rotor speed keep through a flight, σ of the flight and v of a
/// flight of the wander are stated.
///
/// The air-data computer's errors are stated where the fleet cruises, Mach 0.80 and 200 hPa:
///
/// ```text
/// σM = √((σpt/pt)² + (σps/ps)²)·(1 + 0.2 M²)/(1.4 M),  σh = R·T·σps/(g0·ps)
/// ```
///
/// from M² = 5((pt/ps)^(2/7) − 1) and the hydrostatic equation at T = 216.65 K.
fn sensor_deviations(
    sensors: &Sensors,
    scatter: &Scatter,
    truth: &AircraftTruth,
) -> SensorDeviations {
    const SAMPLES: f64 = 10.0;
    const SEGMENT_S: f64 = 600.0;
    const FLIGHT_S: f64 = 7200.0;
    const MACH: f64 = 0.80;
    const STATIC_PRESSURE_HPA: f64 = 200.0;
    const PRESSURE_SCALE_HEIGHT_M: f64 = 287.05287 * 216.65 / 9.80665;
    // The quiet end of what is seen at 60 s in turbulence; the virtual air is turbulent now and then.
    const ACCELERATION_M_S2: f64 = 0.003;
    let of_mean = |over_s: f64| {
        let x = over_s / DRIFT_TIME_CONSTANT_S;
        2.0 / x * (1.0 - (1.0 - (-x).exp()) / x)
    };
    let within = |slow: f64, noise: f64| {
        let wander = (of_mean(SEGMENT_S) - of_mean(FLIGHT_S)).sqrt() * slow;
        wander.hypot(noise / SAMPLES.sqrt())
    };
    let through = |slow: f64, flight: f64| (of_mean(FLIGHT_S).sqrt() * slow).hypot(flight);
    let added = |sensor: &ChannelSensor| within(sensor.drift_sd, sensor.noise_sd);
    let kept = |sensor: &ChannelSensor| through(sensor.drift_sd, sensor.flight_sd);
    let gained = |sensor: &ChannelSensor| within(sensor.gain_drift_sd, sensor.gain_noise_sd);
    let heating = 1.0 + 0.2 * MACH * MACH;
    let of_pressures = |deviation: &dyn Fn(&ChannelSensor) -> f64| {
        let of_static = deviation(&sensors.static_pressure) / STATIC_PRESSURE_HPA;
        let of_total =
            deviation(&sensors.total_pressure) / (STATIC_PRESSURE_HPA * heating.powf(3.5));
        let mach = of_static.hypot(of_total) * heating / (1.4 * MACH);
        (mach, of_static * PRESSURE_SCALE_HEIGHT_M)
    };
    let (mach, pressure_altitude_m) = of_pressures(&added);
    let (mach_kept, pressure_altitude_kept_m) = of_pressures(&kept);
    let meter = &sensors.fuel_flow;
    // Engines err independently; the N2 channel is their mean.
    let engines = f64::from(truth.engine.count).sqrt();
    let kept_by_all = 100.0 * meter.gain_flight_sd / engines;
    let rotor_kept = (100.0 * through(sensors.n2.gain_drift_sd, sensors.n2.gain_flight_sd))
        .hypot(kept(&sensors.n2));
    SensorDeviations {
        fuel_flow_percent: 100.0 * meter.gain_noise_sd / SAMPLES.sqrt(),
        mach,
        static_air_temperature_k: added(&sensors.total_air_temperature) / heating,
        acceleration_m_s2: ACCELERATION_M_S2,
        mass: MassDeviation::Kilograms(
            0.01 * scatter.zero_fuel_mass_percent * truth.masses.maximum_zero_fuel_kg,
        ),
        lower_heating_value_percent: scatter.heating_value_percent.hypot(kept_by_all),
        n2_percent: (100.0 * gained(&sensors.n2)).hypot(added(&sensors.n2)),
        pressure_altitude_m,
        fuel_flow_drift: FuelFlowDrift {
            percent: 100.0 * of_mean(SEGMENT_S).sqrt() * meter.gain_drift_sd,
            time_s: DRIFT_TIME_CONSTANT_S,
        },
        flight_bias: FlightBias {
            mach: mach_kept,
            static_air_temperature_k: kept(&sensors.total_air_temperature) / heating,
            n2_percent: rotor_kept / engines,
            pressure_altitude_m: pressure_altitude_kept_m,
        },
    }
}

/// Law `bayes` on clean flights with its remainder, as `cruisefit adapt` does it.
fn adapted(
    initial: PerformanceModel,
    lessons: &[FlightSegments],
    flights: Vec<FlightSegments>,
) -> Result<Evidence, CaseFailure> {
    let law = LawChoice::Bayes(adapt::bayes::BayesSettings::physical_2026());
    let mut learnt = learning::begin(&initial, TAIL, TrimCriteria::PRESETS[0], law)?;
    let mut all = Vec::new();
    for (index, flight) in lessons.iter().enumerate() {
        let Some(first) = flight.segments.first() else { continue };
        let entry = LedgerEntry {
            tail: TAIL.to_owned(),
            flight: first.identity.flight.clone(),
            start: first.identity.start.to_string(),
            content: format!("flight {index}"),
            samples: flight.samples as u64,
            segments: 0,
            outside_table: 0,
        };
        let lesson = FlightToLearn { entry, segments: &flight.segments };
        learning::learn_flight(&initial, &mut learnt, &lesson)?;
        all.extend(flight.segments.iter().cloned());
    }
    learning::settle(&mut learnt)?;
    learning::remember_remainder(&initial, &mut learnt, &all);
    let uncertainty = match &learnt.law {
        crate::model_file::LawState::Bayes { posterior, .. } => {
            Some(table_uncertainty(posterior, initial.drag_table().grid())?)
        }
        crate::model_file::LawState::Paper { .. } => None,
    };
    Ok(Evidence {
        drag_table: learnt.law.drag_coefficient().clone(),
        baseline: learnt.baseline,
        uncertainty,
        model: initial,
        flights,
    })
}

#[cfg(test)]
mod tests {
    use perf_model::effects::{EffectModel, EffectPoint, EffectReferences, Effects};
    use simulate::{Earth, FleetDesign, Plan, SensorChoice, Weather};

    use super::*;

    fn residuals(plan: Plan) -> Vec<f64> {
        let simulation = Simulation::new(plan).unwrap();
        let model = denied_model(
            simulation.aircraft(),
            TruthPhysics::plain(),
            &Sensors::transport(),
            &FINE,
            None,
        )
        .unwrap();
        let flights = fly(&simulation, 0..simulation.len()).unwrap();
        let segments: Vec<Segment> = flights.into_iter().flat_map(|f| f.segments).collect();
        let points: Vec<EffectPoint> = segments
            .iter()
            .map(|s| EffectPoint::of_means(&s.means, s.identity.start.as_second() as f64, 2))
            .collect();
        let references =
            EffectReferences::mean_of(model.aircraft(), model.drag_table(), &points).unwrap();
        let of = EffectModel::new(&model, model.drag_table(), references).unwrap();
        segments
            .iter()
            .zip(&points)
            .map(|(segment, point)| {
                let response = of.response(point, &Effects::none()).unwrap();
                segment.means.fuel_flow_total_kg_s.ln() - response.ln_fuel_flow_total
            })
            .collect()
    }

    fn plan(flights: usize) -> Plan {
        let design = FleetDesign { flights, ..FleetDesign::default() };
        Plan {
            physics: TruthPhysics::plain(),
            earth: Earth::plain(),
            sensors: SensorChoice::Perfect,
            scatter: Scatter::none(),
            ..Plan::of_one_tail(5, TAIL, design)
        }
    }

    #[test]
    fn an_exact_model_is_exact() {
        // The oracle is the simulator, whose physics is its own: without effect, noise and weather nothing may be left.
        let all = residuals(Plan { weather: Weather::still(), ..plan(6) });
        assert!(all.len() > 40, "{}", all.len());
        let rms = (all.iter().map(|r| r * r).sum::<f64>() / all.len() as f64).sqrt();
        // 0.02 % is left where the speed changes within a segment.
        assert!(rms < 5e-4, "{rms}");
        // With weather 0.1 %, against 0.2 to 0.5 % of noise.
        let all = residuals(plan(6));
        let rms = (all.iter().map(|r| r * r).sum::<f64>() / all.len() as f64).sqrt();
        assert!(rms < 2e-3, "{rms}");
    }

    #[test]
    fn the_aircraft_file_states_the_virtual_sensors() {
        // By hand: means of a wander of 1 200 s keep 0.852245 of its variance over 600 s and 0.277915 over 7 200 s. Then
        // 100·0.0030/√10, 100·√0.852245·0.0020, √(0.57433·0.10² + 0.05²/10)/1.128 and
        // √(0.3² + 100²·0.0015²/2). Through a flight: TAT √(0.277915·0.10² + 0.20²)/1.128 = 0.183361,
        // N2 0.03/√2, static pressure √(0.277915·0.03² + 0.10²)/200 = 5.0622e-4 of p, total pressure
        // √(0.277915·0.05² + 0.15²)/(200·1.128^3.5) = 4.9955e-4; Mach √(5.0622² + 4.9955²)e-4·1.128/1.12, altitude 5.0622e-4·6341.6.
        let truth = AircraftTruth::preset(simulate::Preset::CitationX).unwrap();
        let stated = sensor_deviations(&Sensors::transport(), &Scatter::default(), &truth);
        assert!((stated.fuel_flow_percent - 0.094868).abs() < 1e-5, "{stated:?}");
        assert!((stated.fuel_flow_drift.percent - 0.184634).abs() < 1e-5, "{stated:?}");
        assert!((stated.static_air_temperature_k - 0.068632).abs() < 1e-5, "{stated:?}");
        assert!((stated.lower_heating_value_percent - 0.318198).abs() < 1e-5, "{stated:?}");
        assert_eq!(stated.mass, MassDeviation::Kilograms(0.01 * 0.7 * 11_068.0));
        let kept = stated.flight_bias;
        assert!((kept.static_air_temperature_k - 0.183361).abs() < 1e-5, "{kept:?}");
        assert!((kept.n2_percent - 0.021213).abs() < 1e-5, "{kept:?}");
        assert!((kept.mach - 7.1630e-4).abs() < 1e-6, "{kept:?}");
        assert!((kept.pressure_altitude_m - 3.2103).abs() < 1e-3, "{kept:?}");
    }
}
