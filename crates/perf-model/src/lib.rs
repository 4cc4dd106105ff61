//! The performance model of one aircraft type in level cruise: the drag that corresponds to a recorded fuel flow, the
//! fuel flow that a drag table predicts, and the first table, from a flight-planning guide.
//!
//! What it is: equations as small free functions ([`forces`], [`mod@tsfc`], [`fuel_flow`], [`mod@specific_range`]); the
//! [`Aircraft`] with its file; a public model of 68 types ([`poll_schumann`]); the [`Guide`] and [`FlightPoints`] files; [`initial_model`]; and [`PerformanceModel`],
//! which turns a segment into an observation with its [`variance`] and a flight point into a prediction.
//! What it is not: it adapts nothing, diagnoses nothing and opens no file: text in, text out.
//!
//! The one design decision: every disagreement between fuel flow and model is charged to the drag coefficient. One
//! table over lift coefficient and Mach number is then all there is to learn, and an observation needs neither engine
//! nor atmosphere. The price: a worn engine and a dirty airframe look alike here; distinguishing them is left to the
//! diagnosis, with more than fuel flow.
//!
//! Limits:
//! - Level flight at standard gravity. Along-path acceleration is in the balance; climb, turn and the earth's rotation
//!   are not.
//! - It knows no effect: what a model may lack, and models that contain effects, are in the crate `effects`.
//! - The TSFC law depends on temperature and Mach number, not on throttle or altitude.
//! - A factor on drag by level ([`GuideLevels`]), where a model has one, is the guide's: nothing here learns it.
//! - Outside the table there is an error and no value. Inside the table but outside the guide's range a value is marked
//!   as extrapolated.
//! - A guide that does not determine the polynomial within its own range is refused, with the reason in words.
//!
//! ```
//! use perf_model::{Aircraft, FlightPoint, Guide, initial_model};
//! use units::{Mach, Mass, PressureAltitude};
//!
//! let aircraft = Aircraft::from_ron(
//!     r#"(
//!         name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
//!         tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0),
//!         table: (lift_coefficient: (0.30, 0.60, 0.05), mach: (0.76, 0.88, 0.02)),
//!     )"#,
//! )?;
//! let guide = Guide::from_csv(include_bytes!("../tests/golden/guide.csv"))?;
//! let initial = initial_model(&aircraft, &guide)?;
//!
//! let cruise = FlightPoint::new(Mass::pounds(66_000.0), PressureAltitude::feet(41_000.0), Mach::new(0.80));
//! let prediction = initial.model.predict(&cruise)?;
//! assert!((prediction.fuel_flow_total.to_pounds_per_hour() - 3585.0).abs() < 50.0);
//! assert!(!prediction.extrapolated);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod aircraft;
mod columns;
mod csv_text;
pub mod forces;
pub mod fuel_flow;
mod guide;
pub mod initial;
mod levels;
pub mod model;
mod points;
pub mod poll_schumann;
pub mod specific_range;
pub mod state;
pub mod tsfc;
pub mod variance;

pub use aircraft::{Aircraft, AircraftError};
pub use csv_text::{CsvColumn, CsvError, CsvErrorReason, open_quote};
pub use guide::{Guide, GuidePoint};
pub use initial::{InitialModel, InitialModelError, initial_model};
pub use levels::{GuideLevel, GuideLevelError, GuideLevels, GuidePlace, guide_terms};
pub use model::{
    LevelBlock, LevelFlights, LevelPrediction, ModelError, ObserveError, OutsideTable,
    PerformanceModel, PredictError, Prediction, SegmentPrediction,
};
pub use points::{
    FlightPoint, FlightPointRow, FlightPoints, LevelColumns, PREDICTED_COLUMNS, PointCell,
    PointTable,
};
pub use state::SegmentState;
