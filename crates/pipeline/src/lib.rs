//! The chain from cruise reports to an adapted, evaluated and diagnosed model, as a library.
//!
//! What it is: the pieces between the stages. [`reading`] takes the bytes of a report to its stabilised segments
//! ([`reduction`]), [`models`] chooses the model of a report, [`adaptation`] lets a tail learn its flights one after the
//! other ([`learning`]), [`evaluation`] compares segments with a table, [`prediction`] predicts at flight points,
//! [`diagnosis_groups`] diagnoses, [`model_file`] is a model with what it has learnt, as text and back; [`check`] finds
//! what is wrong with recorded data, [`plausibility`] sets aside what is absurd. Around them: tables of segments
//! ([`segments_table`]) and of a model ([`model_table`]), the results of a run ([`summary`], [`diagnosis_document`]), and a
//! diagnosis in words ([`diagnosis_text`], [`diagnosis_words`]).
//! What it is not: it opens no file, starts no thread, reads no clock and prints nothing. It computes no drag, no fuel flow
//! and no verdict; those are the stages'.
//!
//! The one design decision: text in, text out. JSON, CSV, RON and English are made here from the stages' typed results, and
//! nowhere below; the caller decides where the bytes come from and where they go. That costs a copy of every file in
//! memory.
//!
//! Limits:
//! - A model file is read whole: one of a thousand nodes by law `bayes` has some 10 MB.
//! - [`learning`] takes flights in the order of flying; law `paper` learns something else in another order.
//! - Words are English.
//!
//! ```
//! use perf_model::{Aircraft, Guide, initial_model};
//! use pipeline::model_file::ModelFile;
//!
//! let aircraft = Aircraft::from_ron(
//!     r#"(
//!         name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
//!         tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0),
//!         table: (lift_coefficient: (0.30, 0.60, 0.05), mach: (0.76, 0.88, 0.02)),
//!     )"#,
//! )?;
//! let guide = Guide::from_csv(include_bytes!("../../perf-model/tests/golden/guide.csv"))?;
//! let initial = initial_model(&aircraft, &guide)?;
//! let text = ModelFile::from_initial(&initial, &guide).to_text()?;
//! assert_eq!(ModelFile::from_text(&text)?.initial, initial.model.into());
//! // One digit that a disk or an editor changed is noticed.
//! let damaged = text.replacen("94.94690688", "94.94690689", 1);
//! assert!(ModelFile::from_text(&damaged).is_err());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod adaptation;
pub mod addition_record;
pub mod check;
pub mod checksum;
pub mod columns;
pub mod condition_means;
pub mod criteria_costs;
pub mod csv_cell;
pub mod dates;
pub mod diagnosed_tail;
pub mod diagnosis_document;
pub mod diagnosis_figures;
pub mod diagnosis_groups;
pub mod diagnosis_months;
pub mod diagnosis_text;
pub mod diagnosis_words;
pub mod difference;
pub mod distinct;
pub mod evaluation;
pub mod export;
pub mod file_names;
pub mod fleet_diagnosis;
pub mod flights_table;
pub mod folder_state;
pub mod fuel_factor;
pub mod gaps_table;
pub mod known_flights;
pub mod learning;
pub mod learnt_flights;
pub mod merging;
pub mod model_file;
pub mod model_table;
pub mod models;
pub mod monitoring;
pub mod not_evaluated;
pub mod optimum;
pub mod plausibility;
pub mod prediction;
pub mod public_guide;
pub mod reading;
pub mod reduction;
pub mod residuals;
pub mod segments_table;
pub mod statistics;
pub mod summary;
pub mod table_uncertainty;
pub mod topics;
pub mod whole_model;
