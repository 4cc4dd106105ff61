//! Where a model differs from flight, which effect it lacks, and how far the gap shrinks once the effect is added.
//!
//! What it is: [`diagnose`] takes a performance model, its drag table and flights that the table has not learnt, and returns
//! a [`Diagnosis`]: named effects with probability, size and 95 % interval, the class of effects that this data cannot tell
//! from the first, the measurements and flights on purpose that could, and what the effect leaves on flights it was not
//! fitted to. [`Baseline`] teaches it what clean flights of the same model look like.
//! What it is not: it adapts nothing, opens no file. The draws of noise behind `where` come from a seed that is an argument. It does
//! not simulate; whoever runs a trial plants the effects.
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
//! use diagnose::{Input, Options, VerdictKind, diagnose};
//! use perf_model::{Aircraft, Guide, initial_model};
//!
//! let aircraft = Aircraft::from_ron(
//!     r#"(
//!         name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
//!         tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0),
//!         table: (lift_coefficient: (0.30, 0.60, 0.05), mach: (0.76, 0.88, 0.02)),
//!     )"#,
//! )?;
//! let guide = Guide::from_csv(include_bytes!("../../perf-model/tests/golden/guide.csv"))?;
//! let model = effects::ExtendedModel::from(initial_model(&aircraft, &guide)?.model);
//! let input = Input::against(&model, &[]);
//! // No flights, no name.
//! let found = diagnose(&input, &Options::default())?;
//! assert_eq!(found.verdict.kind, VerdictKind::InsufficientData);
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

mod advice;
mod place;

mod diagnosis;
mod judge;
mod numbers;

pub use baseline::{Baseline, BaselineLengthError};
pub use deciding::{Certainty, DecidingNumber};
pub use diagnosis::diagnose;
pub use input::{Input, Options};
pub use numbers::numbers_that_decide;
pub use output::addition::{AddedEffect, Addition, UnknownEffect};
pub use output::{
    Cause, Detectable, Diagnosis, Gap, Magnitude, NotTestable, OutsideLibrary, Separation, Slice,
    Verdict, VerdictKind,
};
pub use place::members::{SliceError, slice_members};
pub use signals::noise::NoiseFactors;
pub use signals::record::{FlightRecord, GaugeBurn};
pub use signals::references::{DiagnoseError, references_of};
pub use signals::table_uncertainty::{TableUncertainty, TableUncertaintyError, visited_nodes};
pub use signals::variables::Variable;
