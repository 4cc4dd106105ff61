//! One tail's part of `diagnosis.json`.

mod recorded;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::addition_record::AdditionRecord;
use crate::diagnosed_tail::Compared;
use crate::diagnosis_months::MonthGap;

/// One tail's diagnosis. Field names, their order and meanings are the format's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TailDiagnosis {
    /// Whose; `*` for a pool.
    pub tail: String,
    /// The flights and the model.
    #[serde(default)]
    pub compared: Compared,
    /// Flights that were used.
    pub flights: usize,
    /// Segments that were used.
    pub segments: usize,
    /// The gap before anything is added to the model.
    pub gap: GapRecord,
    /// The gap in each calendar month, the newest last; left out where no segment was used.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub months: Vec<MonthGap>,
    /// Where the gap lies.
    pub r#where: Vec<SliceRecord>,
    /// Causes, the most probable first.
    pub causes: Vec<CauseRecord>,
    /// What each effect makes of the gap, all of the library acting at once; the likeliest largest one first. Left out where no
    /// gap is detected.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contributions: Vec<ContributionRecord>,
    /// Effects that this data cannot test, and what they need.
    pub not_testable: Vec<NotTestableRecord>,
    /// The conclusion.
    pub verdict: VerdictRecord,
    /// What the verdict would add to the model; `null` where it names no effect.
    #[serde(default)]
    pub addition: Option<AdditionRecord>,
    /// For every testable effect the size that would just be seen, and its class.
    pub detectable: Vec<DetectableRecord>,
    /// Probability that something outside the library acts, and the variable that it depends on.
    pub outside: OutsideLibraryRecord,
    /// The gap of each flight by a choice and fit that has not seen it; empty where closure is not measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held_out: Vec<HeldOutRecord>,
    /// Segments left out, by reason.
    pub left_out: BTreeMap<String, usize>,
    /// What was assumed: references of the data at hand, proxies, robust weights.
    pub notes: Vec<String>,
}

/// The gap of one flight that choice and fit have not seen: root mean squares over its segments.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldOutRecord {
    /// Its segments.
    pub segments: usize,
    /// Before anything is added.
    pub before_rms_percent: f64,
    /// With what the other flights would add.
    pub after_rms_percent: f64,
    /// What noise alone is expected to make.
    pub noise_rms_percent: f64,
}

/// The gap: ln recorded − ln predicted fuel flow, in per cent. Where the data were insufficient nothing was computed: numbers
/// are `null`, and no gap is detected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GapRecord {
    /// Mean.
    pub mean_percent: Option<f64>,
    /// Root mean square.
    pub rms_percent: Option<f64>,
    /// 95 % interval of the rms, by flight.
    pub rms_ci95: Option<[f64; 2]>,
    /// Root mean square that noise alone makes: the propagated one.
    pub noise_floor_rms_percent: Option<f64>,
    /// The same by replicates: what differs between like segments of one flight. `null` where closure is not measured, or
    /// for too few of them.
    #[serde(default)]
    pub floor_by_replicates_rms_percent: Option<f64>,
    /// What a flexible model leaves on flights it was not fitted to: an upper bound. `null` where closure is not measured.
    #[serde(default)]
    pub floor_by_held_out_fit_rms_percent: Option<f64>,
    /// Whether there is more than noise.
    pub detected: bool,
    /// Probability of as large a deviation without any effect, all effects looked at.
    pub p_value: Option<f64>,
}

/// A place where the gap lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SliceRecord {
    /// In words.
    pub slice: String,
    /// Bounds by variable.
    pub bounds: BTreeMap<String, [Option<f64>; 2]>,
    /// Segments in it.
    pub segments: usize,
    /// Mean gap.
    pub mean_gap_percent: f64,
    /// 95 % interval by flight.
    pub ci95: [f64; 2],
    /// Share of the explainable gap.
    pub share_of_gap: f64,
    /// Accounts for the search.
    pub p_value: f64,
}

/// A cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CauseRecord {
    /// Name of the effect.
    pub effect: String,
    /// Probability that it is the larger one of what acts.
    pub probability: f64,
    /// The same without the prior sizes of effects: any effect may change fuel flow by any amount within ±5 %.
    #[serde(default)]
    pub probability_flat: f64,
    /// Effects that these data cannot distinguish from it, itself first.
    pub class: Vec<String>,
    /// Its size.
    pub magnitude: MagnitudeRecord,
    /// Root mean square of the gap with it in the model, on flights it was not fitted to; `null` where not computed.
    pub rms_after_percent: Option<f64>,
    /// Share of the explainable gap that it closes on those flights.
    pub closure: Option<f64>,
    /// Interval of the closure.
    pub closure_ci95: Option<[f64; 2]>,
    /// Hidden parameters in words ("from 2019-06-02 on fuel flow"); empty for most effects.
    pub hidden: String,
    /// The instant from which it holds, RFC 3339: of a step its date, of a history that of its last fall, or of its beginning
    /// where it has none. Absent for what has no date.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub since: Option<String>,
    /// With `--fleet` whose it is, were it this effect: `type`, `tail` or `sensor`. Absent where the fleet has no finding whose
    /// class it belongs to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<String>,
}

/// What one effect makes of the gap, all effects acting at once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContributionRecord {
    /// Name of the effect.
    pub effect: String,
    /// Its size.
    pub magnitude: MagnitudeRecord,
    /// Root mean square of the change of fuel flow that it makes, %.
    pub rms_percent: f64,
    /// 95 % interval of that.
    pub rms_ci95: [f64; 2],
    /// Probability that it makes the largest change of all.
    pub leads: f64,
}

/// Size with unit and interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MagnitudeRecord {
    /// Size in the effect's unit.
    pub value: f64,
    /// The unit.
    pub unit: String,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// An effect that cannot be tested.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NotTestableRecord {
    /// Name of the effect.
    pub effect: String,
    /// Columns it needs.
    pub needs: Vec<String>,
}

/// Kind of a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VerdictKind {
    /// Nothing beyond the noise.
    NoGap,
    /// One effect, or a set acting together.
    Effects,
    /// A gap that is real and that no library effect explains.
    OutsideLibrary,
    /// Too few data for a result.
    InsufficientData,
}

/// The verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VerdictRecord {
    /// Kind.
    pub kind: VerdictKind,
    /// Effects that act.
    pub effects: Vec<String>,
    /// Effects that these data cannot distinguish from the first, and those that its probabilities leave open all the same.
    pub class: Vec<String>,
    /// Probability of the first effect.
    pub probability: f64,
    /// What acts beside a guide's table that is off, the most probable first; absent where there is nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub beside: Vec<BesideRecord>,
    /// Share of the explainable gap closed on unseen flights; `null` where the gap is too small.
    pub closure: Option<f64>,
    /// Its 95 % interval.
    pub closure_ci95: Option<[f64; 2]>,
    /// One sentence or two: what to do.
    pub advice: String,
    /// Measurements and flights on purpose that would separate the class, the best first.
    pub separations: Vec<SeparationRecord>,
}

/// What acts beside a guide's table that is off, and no table can hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BesideRecord {
    /// The effect.
    pub effect: String,
    /// Effects that these data cannot distinguish from it.
    pub class: Vec<String>,
    /// Probability that it acts.
    pub probability: f64,
}

/// A measurement, or flights on purpose, that separate two effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SeparationRecord {
    /// The effect that would be distinguished from the first.
    pub from: String,
    /// What to measure or to fly.
    pub measurement: String,
    /// Distance between them now, in standard deviations.
    pub distance_now: f64,
    /// And with the measurement or the flights.
    pub distance_then: f64,
    /// Of flights on purpose: with as many ordinary flights instead.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance_ordinary_flights: Option<f64>,
}

/// What an effect would have to be to be seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DetectableRecord {
    /// Name of the effect.
    pub effect: String,
    /// Smallest size seen with about 60 % probability; `null` where the data do not determine it.
    pub smallest: Option<f64>,
    /// Unit of the size.
    pub unit: String,
    /// Effects that these data cannot distinguish from it at typical sizes, itself included.
    pub class: Vec<String>,
    /// Distance at the typical size from the nearest single other effect, in noise standard deviations.
    pub nearest_other: f64,
    /// Distance at the typical size from the nearest pair of others.
    pub nearest_pair: f64,
    /// Measurements and advised flights that would distinguish it, at the typical size, from the nearest other effect of its
    /// class, the best first; empty where none is nearer than three noise standard deviations.
    #[serde(default)]
    pub separations: Vec<SeparationRecord>,
}

/// Probability of a cause outside the library.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutsideLibraryRecord {
    /// Probability.
    pub probability: f64,
    /// The variable that what is left depends on.
    pub variable: Option<String>,
    /// Whether it acts on thrust (drag, weight), fuel flow or one engine.
    pub acts_on: Option<String>,
    /// Functions of single variables that describe it, the most probable first; left out where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forms: Vec<FormRecord>,
}

/// A function that describes a cause outside the library.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FormRecord {
    /// offset, linear, square, power, `hinge_above`, `hinge_below`, step, logistic, bump, product.
    pub form: String,
    /// Its variable, by the name of its bounds.
    pub variable: String,
    /// The second variable of a product.
    pub with: Option<String>,
    /// Its mean and standard deviation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub with_scale: Option<[f64; 2]>,
    /// Fuel flow, or thrust (drag).
    pub acts_on: String,
    /// Change of fuel flow in %, or of the drag coefficient in counts, where the function is 1.
    pub size: f64,
    /// 95 % interval of the size.
    pub size_ci95: [f64; 2],
    /// Where a hinge, step, logistic or bump lies, in the variable's unit.
    pub place: Option<f64>,
    /// 95 % interval of that.
    pub place_ci95: Option<[f64; 2]>,
    /// Width of a logistic or bump.
    pub width: Option<f64>,
    /// Exponent of a power.
    pub exponent: Option<f64>,
    /// Mean and standard deviation of the variable: linear forms are in these.
    pub scale: [f64; 2],
    /// Probability among all forms that were tried.
    pub probability: f64,
    /// Share of the explainable gap that it closes on flights that it was not fitted to.
    pub closure: Option<f64>,
    /// 95 % interval of the closure.
    pub closure_ci95: Option<[f64; 2]>,
    /// In words.
    pub statement: String,
}
