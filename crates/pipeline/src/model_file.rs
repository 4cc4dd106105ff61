//! `MODEL.ron`: what an aircraft's model is and what it has learnt.
//!
//! BE ADVISED: other programs, and older and newer versions of this one, read these files. `format` counts up when the
//! meaning of a field changes; a field may be added with a default. Every number is written with the shortest decimals
//! that read back to the same bits. The last field is a checksum of all bytes before it: a digit that a disk, a mail
//! program or an editor changed is noticed before anybody acts on it.

mod applied;
mod differences;
mod error;
mod guide_drag;
mod guide_levels;
mod text;

pub use applied::{AppliedRecord, DiagnosisRecord};
use differences::told_against;
pub use error::{ModelTextError, ModelValueError};

use std::borrow::Cow;
use std::sync::Arc;

use adapt::bayes::{BayesSettings, BayesState, Posterior};
use adapt::paper::State as PaperState;
use diagnose::{Baseline, GaugeBurn};
use effects::ExtendedModel;
use flight::FlightIdentity;
use lut::Table;
use perf_model::{Guide, GuidePoint, InitialModel};
use serde::{Deserialize, Serialize};

use crate::condition_means::ConditionMeans;

/// The format that this program writes.
///
/// 2: a baseline is one posterior over drag table and remainder; the remainder of format 1 is not read. Models without a
/// baseline are written as format 1. 3: factors of the noise multiply what the aircraft file states of flights and of drift, too;
/// those of format 2 stand for it. 4: a baseline refers to the drag of the guide's rows, where the file has it; models without that drag
/// are written as format 3 or 1. 5: a baseline has a term for the force along the path. 6: the drag of the guide's rows has a factor by
/// level.
pub const FORMAT: u32 = 6;

/// A model, and what it has learnt.
#[derive(Clone, Debug)]
pub struct ModelFile {
    /// The initial model: aircraft, polynomial, drag table, extrapolated nodes, and the effects of `applied`.
    pub initial: ExtendedModel,
    /// What the guide was like from which the initial model comes.
    pub guide: GuideRecord,
    /// Settings of the laws, fixed when the initial model is made.
    pub settings: LawSettings,
    /// What was learnt; `None` in an initial model.
    pub learnt: Option<Learnt>,
    /// Diagnoses whose effects the model contains, in the order in which they were applied.
    pub applied: Vec<AppliedRecord>,
    /// The initial model with the drag of the guide's own rows; see [`reference`](Self::reference).
    pub by_guide: Option<Box<ExtendedModel>>,
}

/// What the initial model's guide was like, and how well the polynomial fits it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GuideRecord {
    /// Rows.
    pub points: u64,
    /// Smallest and largest lift coefficient.
    pub lift_coefficient: (f64, f64),
    /// Smallest and largest Mach number.
    pub mach: (f64, f64),
    /// Smallest and largest gross mass; `None` in files of programs that did not keep it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<(f64, f64)>,
    /// Lowest and highest pressure altitude; `None` in files of programs that did not keep it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_altitude_m: Option<(f64, f64)>,
    /// Root mean square of the fit's residuals in drag coefficient.
    pub residual_rms: f64,
    /// Condition number of the fit's design.
    pub condition_number: f64,
}

/// Settings of the adaptation laws.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LawSettings {
    /// Of law `paper`.
    pub paper: PaperSettings,
    /// Of law `bayes`; the defaults where the file does not state them.
    #[serde(default = "BayesSettings::physical_2026")]
    pub bayes: BayesSettings,
}

impl LawSettings {
    /// The settings that the laws were published with.
    pub const fn published() -> Self {
        Self {
            paper: PaperSettings {
                threshold_percent: adapt::paper::PaperLaw::ghazi_2020().threshold_percent(),
            },
            bayes: BayesSettings::physical_2026(),
        }
    }
}

/// Settings of law `paper`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaperSettings {
    /// A segment adapts the table where its absolute error exceeds this.
    pub threshold_percent: f64,
}

/// What a model has learnt from one tail.
#[derive(Clone, Debug)]
pub struct Learnt {
    /// Whose flights.
    pub tail: String,
    /// Name of the trim criteria by which its segments were found.
    pub criteria: String,
    /// The law and its state.
    pub law: LawState,
    /// Mean conditions.
    pub references: ConditionMeans,
    /// One posterior over everything that the flights say: drag table, smooth remainder, rotor-speed deck, noise levels
    /// (law `bayes`).
    pub baseline: Option<Baseline>,
    /// Flights, in the order in which they were learnt.
    pub ledger: Vec<LedgerEntry>,
}

/// State of the law by which a model learns.
#[derive(Clone, Debug)]
pub enum LawState {
    /// The local law of Ghazi et al. 2020 with its global refit.
    Paper {
        /// Settings in force.
        settings: PaperSettings,
        /// Drag and confidence tables.
        state: PaperState,
        /// Nodes that a segment ever adapted (the refit sets confidences back).
        ever_adapted: Vec<bool>,
        /// Global refits so far.
        refits: u32,
    },
    /// The Gaussian law, with the initial model's settings.
    Bayes {
        /// What was learnt.
        state: Box<BayesState>,
        /// Its solution.
        posterior: Box<Posterior>,
    },
}

impl LawState {
    /// The law's name in arguments and files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Paper { .. } => "paper",
            Self::Bayes { .. } => "bayes",
        }
    }

    /// The current drag table.
    pub const fn drag_coefficient(&self) -> &Table {
        match self {
            Self::Paper { state, .. } => state.drag_coefficient(),
            Self::Bayes { posterior, .. } => posterior.drag(),
        }
    }

    /// How much was learnt at each node: the confidence λ of law `paper`, the effective number of observations of law
    /// `bayes`.
    pub fn confidence(&self) -> &[f64] {
        match self {
            Self::Paper { state, .. } => state.confidence().values(),
            Self::Bayes { posterior, .. } => posterior.observations(),
        }
    }

    /// Which nodes were ever informed by a segment.
    pub fn informed(&self) -> Vec<bool> {
        match self {
            Self::Paper { ever_adapted, .. } => ever_adapted.clone(),
            Self::Bayes { posterior, .. } => {
                posterior.observations().iter().map(|count| *count >= 1.0).collect()
            }
        }
    }

    /// The law and its settings in words.
    pub fn told(&self) -> String {
        match self {
            Self::Paper { settings, .. } => {
                format!("law paper, threshold {} %", settings.threshold_percent)
            }
            Self::Bayes { .. } => "law bayes".to_owned(),
        }
    }
}

/// A flight that was learnt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LedgerEntry {
    /// Tail as sent.
    pub tail: String,
    /// Flight as sent.
    pub flight: String,
    /// START, an instant.
    pub start: String,
    /// SHA-256 of the report's bytes (uncompressed).
    pub content: String,
    /// Samples of the report.
    pub samples: u64,
    /// Stabilised segments.
    pub segments: u64,
    /// Segments that the grid refused.
    pub outside_table: u64,
    /// Fuel burned by gauges and by meters, where fuel quantity is recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gauges: Option<GaugeBurn>,
}

/// Smallest and largest value of a guide's rows; `None` of a guide without any.
fn range(guide: &Guide, of: impl Fn(&GuidePoint) -> f64) -> Option<(f64, f64)> {
    let values = || guide.points().iter().map(&of);
    values().reduce(f64::min).zip(values().reduce(f64::max))
}

impl ModelFile {
    /// The model file of a fresh initial model, with the laws' published settings.
    pub fn from_initial(initial: &InitialModel, guide: &Guide) -> Self {
        let record = GuideRecord {
            points: guide.points().len() as u64,
            lift_coefficient: initial.fit.lift_coefficients,
            mach: initial.fit.machs,
            mass_kg: range(guide, |point| point.mass.to_kilograms()),
            pressure_altitude_m: range(guide, |point| point.pressure_altitude.to_meters()),
            residual_rms: initial.fit.residual_rms,
            condition_number: initial.fit.condition_number,
        };
        let by_guide = guide_drag::with_drag_of_guide(initial, guide, &record);
        if by_guide.is_none() {
            tracing::warn!(
                "the guide's rows make no drag table of their own: what is learnt refers to the polynomial"
            );
        }
        Self {
            initial: initial.model.clone().into(),
            guide: record,
            settings: LawSettings::published(),
            learnt: None,
            applied: Vec::new(),
            by_guide: by_guide.map(|model| Box::new(model.into())),
        }
    }

    /// What everything learnt beside a law's table refers to, and the book that fuel factors, monitors and savings are counted from: the initial model with the drag of the guide's own rows, which six
    /// coefficients do not hold, and its factor by level; the initial model itself in files of programs that did not keep it.
    /// `[bayes.14]`, `[bayes.16]`
    pub fn reference(&self) -> &ExtendedModel {
        self.by_guide.as_deref().unwrap_or(&self.initial)
    }

    /// The model with which to plan: before any segment has taught it, what the guide's own rows say, in place of the polynomial
    /// through them, whose optima are up to 0.03 in Mach number slower or faster at a drag rise.
    #[must_use]
    pub fn to_plan_with(&self) -> Cow<'_, Self> {
        match self.untaught_rows() {
            Some(rows) => {
                Cow::Owned(Self { initial: rows.clone(), by_guide: None, ..self.clone() })
            }
            None => Cow::Borrowed(self),
        }
    }

    /// The drag of the guide's rows, where no segment has taught a table and the file keeps it.
    pub(crate) fn untaught_rows(&self) -> Option<&ExtendedModel> {
        self.by_guide.as_deref().filter(|_| !self.has_learnt_segments())
    }

    /// A model from the text of its file.
    ///
    /// # Errors
    /// A text that is not a model, is of a newer format, or whose checksum does not match.
    pub fn from_text(text: &str) -> Result<Self, ModelTextError> {
        text::parse(text)
    }

    /// The file's text.
    ///
    /// # Errors
    /// None that is known: what RON refuses to write.
    pub fn to_text(&self) -> Result<String, ron::Error> {
        text::print(self)
    }

    /// The current drag table: learnt, or initial.
    pub fn drag_coefficient(&self) -> &Table {
        self.learnt
            .as_ref()
            .map_or(self.initial.drag_table(), |learnt| learnt.law.drag_coefficient())
    }

    /// How much was learnt at each node, where something was learnt.
    pub fn confidence(&self) -> Option<&[f64]> {
        self.learnt.as_ref().map(|learnt| learnt.law.confidence())
    }

    /// Whether any segment has taught the table: of a flight outside it nothing is learnt.
    pub fn has_learnt_segments(&self) -> bool {
        match self.learnt.as_ref().map(|learnt| &learnt.law) {
            Some(LawState::Bayes { state, .. }) => state.segments() > 0,
            Some(LawState::Paper { .. }) => true,
            None => false,
        }
    }

    /// Whether a flight taught it, in whatever tail's folder.
    pub fn has_learnt(&self, flight: &FlightIdentity) -> bool {
        let start = flight.start.to_string();
        self.learnt.iter().flat_map(|learnt| &learnt.ledger).any(|entry| {
            entry.start == start && entry.flight == flight.flight && entry.tail == flight.tail
        })
    }

    /// The solution of law `bayes`, where that is the law.
    pub fn posterior(&self) -> Option<&Posterior> {
        match &self.learnt {
            Some(Learnt { law: LawState::Bayes { posterior, .. }, .. }) => Some(posterior),
            _ => None,
        }
    }

    /// The model that predicts: the initial one with the learnt table in its place.
    ///
    /// # Errors
    /// A learnt table with a drag coefficient that is not positive (law `paper` takes what it is given).
    pub fn current(&self) -> Result<ExtendedModel, effects::EffectModelError> {
        self.initial.with_drag_table(self.drag_coefficient().clone())
    }

    /// Global refits, where the law makes them.
    pub fn refits(&self) -> Option<u32> {
        match &self.learnt {
            Some(Learnt { law: LawState::Paper { refits, .. }, .. }) => Some(*refits),
            _ => None,
        }
    }

    /// Share of nodes ever adapted (law `paper`), or with at least one effective observation (law `bayes`).
    pub fn informed_nodes(&self) -> f64 {
        self.learnt.as_ref().map_or(0.0, |learnt| {
            let informed = learnt.law.informed();
            let count = informed.iter().filter(|informed| **informed).count();
            count as f64 / informed.len() as f64
        })
    }

    /// Whether two files hold the same initial model and settings; if not, what differs and how.
    pub fn difference_of_initial(&self, other: &Self) -> Option<(&'static str, String)> {
        if self.initial.aircraft() != other.initial.aircraft() {
            let (own, other) = (self.initial.aircraft().file(), other.initial.aircraft().file());
            return Some(("aircraft file", told_against(other, own)));
        }
        if self.initial.effects() != other.initial.effects() {
            return Some((
                "set of applied effects",
                format!("{} against {}", other.told_effects(), self.told_effects()),
            ));
        }
        if self.initial == other.initial && self.reference() != other.reference() {
            let told = |model: &Self| if model.by_guide.is_some() { "other rows" } else { "none" };
            let difference = format!("{} against {}", told(other), told(self));
            return Some(("drag of the guide's rows beside the polynomial", difference));
        }
        if self.initial != other.initial {
            return Some((
                "initial model",
                format!(
                    "polynomial {:?} against {:?}",
                    other.initial.polynomial().coefficients,
                    self.initial.polynomial().coefficients
                ),
            ));
        }
        if self.settings != other.settings {
            return Some(("setting", told_against(&other.settings, &self.settings)));
        }
        None
    }

    /// Whether two files learn by the same law with the same settings; if not, how they differ.
    pub fn difference_of_law(&self, other: &Self) -> Option<String> {
        let told = |model: &Self| {
            model
                .learnt
                .as_ref()
                .map(|learnt| format!("{}, criteria {}", learnt.law.told(), learnt.criteria))
        };
        let (one, other) = (told(self)?, told(other)?);
        (one != other).then(|| format!("{other} against {one}"))
    }

    /// The law by which it learns and the trim criteria of its segments; `None` of a model that has no tail.
    pub fn learns_by(&self) -> Option<(&'static str, &str)> {
        self.learnt.as_ref().map(|learnt| (learnt.law.name(), learnt.criteria.as_str()))
    }

    /// A grid shared by the model's tables.
    pub fn grid(&self) -> &Arc<lut::Grid> {
        self.initial.drag_table().grid()
    }
}
