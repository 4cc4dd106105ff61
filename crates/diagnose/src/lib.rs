//! Where a model differs from flight, which effect it lacks, and how far the gap shrinks once the effect is added.
//!
//! What it is: [`diagnose`] takes a performance model, its drag table and flights that the table has not learnt, and returns
//! a [`Diagnosis`], typed to the last field: named effects with probability, size and 95 % interval, the class of effects that this data cannot tell
//! from the first, the measurements and flights on purpose that could, and what the effect leaves on flights it was not
//! fitted to. [`Baseline`] teaches it what clean flights of the same model look like.
//! What it is not: it adapts nothing, opens no file, and has no words: English and JSON are made by whoever prints a diagnosis.
//! The draws of noise behind `where` come from a seed that is an argument. It does not simulate; whoever runs a trial plants
//! the effects.
//!
//! The one design decision: every effect alone and every pair is scored by closed-form evidence over backgrounds in which
//! all other effects may be present in small amounts and the model may be smoothly wrong. Nothing is chosen by
//! cross-validation, which only judges. That costs one pass over the data (linear in segments); all search then happens on
//! matrices of the size of the library.
//!
//! Limits:
//! - Drag and TSFC factors cannot be told apart by fuel flow alone; a class is then reported, never a sure name. The same
//!   holds for one engine's TSFC and its flow meter, and nearly for Mach number and static pressure.
//! - A missing effect that two others imitate is taken for them. The distance to the nearest pair is in
//!   [`Detectable::nearest_pair`]; below about 5 nothing can be done but to measure something else.
//! - Against a bare table everything that no table over lift coefficient and Mach number can hold counts as gap. Teach a
//!   [`Baseline`].
//! - `where` finds places of one or two variables with edges at quintiles; it looks at sums over places, not at causes.
//! - Stabilised segments are flown wings level: `load_factor` and `asymmetry_drag` are hardly visible in them.
//!
//! ```
//! use std::sync::Arc;
//!
//! use diagnose::{FlightRecord, Input, Options, diagnose};
//! use flight::effect::EffectId;
//! use flight::{Cruise, FlightIdentity, Segment, SegmentMeans, Timestamp};
//! use perf_model::{Aircraft, Guide, initial_model};
//! use units::{FuelFlowTotal, Mach, Mass, PressureAltitude};
//!
//! let aircraft = Aircraft::from_ron(
//!     r#"(
//!         name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
//!         tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0),
//!         table: (lift_coefficient: (0.10, 0.80, 0.05), mach: (0.50, 0.95, 0.05)),
//!     )"#,
//! )?;
//! let guide = Guide::from_csv(include_bytes!("../../perf-model/tests/golden/guide.csv"))?;
//! let model = effects::ExtendedModel::from(initial_model(&aircraft, &guide)?.model);
//!
//! // A dozen made-up flights of ten segments: 3 % more fuel flow than predicted, and up to ±0.8 % noise.
//! let mut random = 2026_u64;
//! let mut noise = || {
//!     random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
//!     (random >> 32) as f64 / f64::from(1_u32 << 31) - 1.0
//! };
//! let mut flights = Vec::new();
//! for number in 0..12_u32 {
//!     let start = Timestamp::from_second(86_400 * i64::from(number))?;
//!     let (tail, flight) = ("MADE-UP".to_owned(), number.to_string());
//!     let identity = Arc::new(FlightIdentity { tail, flight, start });
//!     let mut segments = Vec::new();
//!     for index in 0..10_u32 {
//!         let level = 350.0 + 20.0 * f64::from((number + index / 4) % 4);
//!         let pressure_altitude = PressureAltitude::feet(100.0 * level);
//!         let static_air_temperature = atmos::isa::temperature(pressure_altitude)?;
//!         let mach = Mach::new(0.78 + 0.01 * f64::from((2 * number + 3 * index) % 7));
//!         let mass_kg = 34_000.0 - 500.0 * f64::from(number % 5) - 600.0 * f64::from(index);
//!         let mut means = SegmentMeans::cruise(&Cruise {
//!             pressure_altitude,
//!             static_air_temperature,
//!             mach,
//!             true_airspeed: atmos::airspeed::mach_to_true_airspeed(mach, static_air_temperature),
//!             mass: Mass::kilograms(mass_kg),
//!             fuel_flow_total: FuelFlowTotal::kilograms_per_second(0.5),
//!         });
//!         means.time_s = 180.0 * f64::from(index);
//!         means.fuel_used_kg = 600.0 * f64::from(index);
//!         let rows = (180 * index..180 * index + 60).collect();
//!         let identity = Arc::clone(&identity);
//!         let mut segment = Segment { identity, rows, means, temperature_assumed: false };
//!         let predicted = model.predict_segment(&segment, model.drag_table())?.fuel_flow_total;
//!         segment.means.fuel_flow_total_kg_s =
//!             1.03 * predicted.to_kilograms_per_second() * (1.0 + 0.008 * noise());
//!         segments.push(segment);
//!     }
//!     flights.push(segments);
//! }
//!
//! let records: Vec<FlightRecord<'_>> =
//!     flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
//! let found = diagnose(&Input::against(&model, &records), &Options::default())?;
//! // Fuel flow alone cannot say whether drag or TSFC is up: both are in the class.
//! assert!(found.verdict.class().contains(&EffectId::DragFactor));
//! assert!(found.verdict.class().contains(&EffectId::TsfcFactor));
//! // By how much, it can.
//! let first = &found.causes[0];
//! assert!(found.verdict.effects().contains(&first.effect));
//! assert!((first.magnitude.value - 3.0).abs() < 0.5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Floors, from the ground up: a module imports from its own floor or a lower one (`tests/floors.rs`).
mod deciding;
mod priors;
mod thresholds;

mod math;
mod signals;

mod baseline;
mod library;

mod input;
mod output;

mod learning;
mod residuals;

mod hypotheses;
mod search;

mod fleet;

mod advice;
mod place;

mod attainable;
mod diagnosis;
mod judge;
mod numbers;

#[cfg(test)]
mod oracles;

pub use effects::{Form, Variable};

pub use attainable::{KnownClutter, attainable};
pub use baseline::gauge_level::GaugeLevel;
pub use baseline::{Baseline, BaselineError, BaselineRecord};
pub use deciding::{Certainty, DecidingNumber};
pub use diagnosis::diagnose;
pub use fleet::found::{FleetDiagnosis, FleetFinding, FleetLevel};
pub use fleet::frame::{FleetFrame, FleetTail, ModelOf};
pub use fleet::infer::diagnose_fleet;
pub use input::{Input, Options};
pub use numbers::numbers_that_decide;
pub use output::addition::{AddedEffect, Addition};
pub use output::form::{ActsOn, FoundForm};
pub use output::measurement::{
    FlightsOnPurpose, LoadingKind, Measurement, Separation, Sweep, SweepLoading,
};
pub use output::note::{LeftOutReason, Note};
pub use output::region::{Condition, Edge, Region};
pub use output::verdict::{
    Beside, Closure, Found, Insufficient, Rest, RestKind, Unexplained, Verdict,
};
pub use output::{
    Cause, Contribution, Detectable, Diagnosis, Gap, HeldOutFlight, Magnitude, NotTestable,
    OutsideLibrary, Slice,
};
pub use place::members::region_members;
pub use place::segment_gaps::{SegmentGap, Shown, segment_gaps};
pub use residuals::level::{LevelAnswers, LevelQuestion, WholeModelOfLevels};
pub use residuals::whole::{SmoothPrediction, WholeModel, WholePrediction};
pub use signals::noise::NoiseFactors;
pub use signals::record::{FlightRecord, GaugeBurn};
pub use signals::references::{DiagnoseError, references_of};
pub use signals::table_uncertainty::{
    GuideStates, TableOrigin, TableUncertainty, TableUncertaintyError, visited_nodes,
};
