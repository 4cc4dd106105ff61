//! The result of a run as one self-contained page for a performance engineer to read, print and forward.
//!
//! What it is: [`report`] makes the page of an adaptation (fleet, errors over time, polars, envelope), [`diagnosis()`]
//! that of diagnoses (what, where, how sure, what to do, and the charts behind it), [`fleet_diagnosis()`] that of all tails of a
//! type compared, [`plot()`] the charts of one tail as SVG, [`monitoring()`] the page of months and fleets,
//! [`trials()`] that of blind trials. All are strings with charts drawn as SVG; the module `chart` knows axes, bins and dates, and nothing of aviation.
//! What it is not: a file, or a program in the browser. It computes nothing but counts and means for drawing; figures
//! are taken from the results unchanged.
//!
//! The one design decision: one string that loads nothing and does not know the time, so that the same results give the same
//! bytes and a page that was mailed is read in ten years as it is today. All is drawn before the small script of the page
//! runs; it adds values under the pointer, zoom, a surface that turns, sorting, filtering and CSV.
//!
//! Limits:
//! - The page of a large fleet draws a share of the segments, and states so; figures and tables cover all.
//! - A page holds the charts of at most [`TAILS_ON_ONE_PAGE`] tails; the tails of a larger fleet have a page each.
//!
//! ```
//! use pipeline::summary::{ReportsSummary, SCHEMA, Summary};
//!
//! let summary = Summary { schema: SCHEMA, reports: ReportsSummary::default(), tails: vec![] };
//! let html = page::report(&summary, &[], "No flights <yet>");
//! assert!(html.contains("<h1>No flights &lt;yet&gt;</h1>"));
//! ```

mod chart;
mod criteria;
mod diagnosis;
mod envelope;
mod errors;
mod fleet;
mod fleet_diagnosis;
mod frame;
mod matrix;
mod monitoring;
mod performance;
mod picture;
mod place;
mod plot;
mod polars;
mod relief;
mod report;
#[cfg(test)]
mod samples;
mod shade;
mod solid;
mod style;
mod surface;
mod tail;
#[cfg(test)]
mod tests;
mod text;
mod trials;
mod view;
mod waterfall;

pub use diagnosis::diagnosis;
pub use fleet_diagnosis::{FleetRun, fleet_diagnosis};
pub use monitoring::monitoring;
pub use picture::{Picture, PictureError, PictureFormat, pdf, png};
pub use plot::{
    Confusion, DIAGNOSIS_CHARTS, TAIL_CHARTS, TrialConfusion, plot, plot_diagnoses, plot_months,
    plot_trials,
};
pub use report::{
    Anchors, Section, TAILS_ON_ONE_PAGE, fleet_report, report, report_of_sections, section,
    tail_page,
};
pub use trials::{TrialCalibration, TrialGoal, TrialGroup, TrialScore, TrialsPage, trials};
