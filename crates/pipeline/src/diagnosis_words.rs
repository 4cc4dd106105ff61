//! The words of a diagnosis: measurements, places, notes and advice in English, as `diagnosis.json` and the page have them.

use std::fmt::Write as _;

use diagnose::{
    ActsOn, Diagnosis, FlightsOnPurpose, Found, FoundForm, Gap, Insufficient, LeftOutReason,
    LoadingKind, Magnitude, Measurement, Note, OutsideLibrary, Rest, RestKind, Separation, Sweep,
    SweepLoading, Unexplained, Variable, Verdict,
};
use flight::effect::{EffectId, HiddenParameter};

use crate::statistics::NORMAL_95;
use crate::summary::counted;

mod consequence;
mod form;
mod limits;
mod region;

pub use consequence::follows;
pub use form::{applied_form_words, form_name, form_parameters, form_words};
pub(crate) use limits::{LEAST_TOLD, OTHERS_TOLD, SEPARATIONS_TOLD, TOLD_APART};
pub use limits::{NO_CAUSE_STANDS_OUT, is_open, stands_out};
pub(crate) use region::instant as instant_words;
pub use region::{ENGINE_BOUNDS, bounds_name, region_words};

/// What a verdict of no gap means: noise, or more than noise that is no effect.
pub fn silent_words(diagnosis: &Diagnosis) -> &'static str {
    if is_beyond_noise(&diagnosis.gap) {
        "No effect is seen: what exceeds the noise is too small, too different from flight to flight, or within what the model leaves open."
    } else {
        "Nothing beyond the noise: the model fits these flights."
    }
}

fn is_beyond_noise(gap: &Gap) -> bool {
    /// Less probable than that by noise alone, a gap of few flights exceeds it, however little is left in the mean of all; our
    /// choice.
    const BEYOND_NOISE: f64 = 0.001;
    gap.rms_ci95[0] > gap.noise_floor_rms_percent || gap.p_value < BEYOND_NOISE
}

/// What is said of a gap that lies in no place: that it depends on something all the same, where a form without a name says so.
pub fn everywhere_words(diagnosis: &Diagnosis) -> &'static str {
    let outside = &diagnosis.outside;
    let depends = matches!(diagnosis.verdict, Verdict::OutsideLibrary(_))
        && outside.variable.is_some()
        && !outside.forms.first().is_some_and(FoundForm::is_a_level);
    if depends {
        "No part of what was flown stands out by itself, but it is not alike everywhere."
    } else {
        "It has no place: it is everywhere."
    }
}

/// What to do after a verdict: one sentence or two.
pub fn advice(diagnosis: &Diagnosis) -> String {
    match &diagnosis.verdict {
        Verdict::NoGap if is_beyond_noise(&diagnosis.gap) => {
            "Nothing to apply: no effect explains what exceeds the noise.".to_owned()
        }
        Verdict::NoGap => {
            "Nothing. Each effect has a size that would just have been seen.".to_owned()
        }
        Verdict::InsufficientData(reason) => {
            format!("Too little data: {}.", insufficient_words(*reason))
        }
        Verdict::OutsideLibrary(unexplained) => unexplained_words(unexplained),
        Verdict::Effects(found) => found_words(diagnosis, found),
    }
}

fn unexplained_words(unexplained: &Unexplained) -> String {
    let mut words =
        "Apply nothing: look at what these flights have in common where it lies, or record more signals."
            .to_owned();
    if let Some(share) = unexplained.nearest_closes {
        let _ = write!(
            words,
            " The nearest, {}, closes {:.0} % of it.",
            unexplained.nearest,
            100.0 * share.clamp(0.0, 1.0)
        );
    }
    words
}

fn found_words(diagnosis: &Diagnosis, found: &Found) -> String {
    if found.effects.first() == Some(&EffectId::DragTable) {
        return table_words(found);
    }
    let titles = |ids: &[EffectId], between: &str| {
        ids.iter().map(|id| title(diagnosis, *id)).collect::<Vec<_>>().join(between)
    };
    let mut words = match found.class.len() {
        0 | 1 => format!("{}.", capital(&titles(&found.effects, ", and "))),
        // A longer list in words hides what is advised.
        _ if are_few(&others_of_class(found)) => {
            format!("One of these: {}; {}.", titles(&found.class, "; "), undecided(found))
        }
        _ => format!("One of {}: {}.", joined(&found.class, ", "), undecided(found)),
    };
    for beside in &found.beside {
        let others = others_beside(found, beside.effect);
        if !others.is_empty() {
            let _ = write!(
                words,
                " In place of {} it may be {}: these flights cannot tell.",
                beside.effect,
                joined(&others, " or ")
            );
        }
    }
    if stands_out(found.probability)
        && let Some(follows) = follows(found)
    {
        let _ = write!(words, " {follows}");
    }
    if let Some(Rest { kind, variable }) = found.rest {
        let variable = variable_or_none(variable);
        let _ = match kind {
            RestKind::OtherForm => {
                write!(words, " Its form differs from the library's in {variable}.")
            }
            RestKind::SomethingElse => {
                write!(words, " Something else acts in addition to it and depends on {variable}.")
            }
        };
    }
    if let Some(best) = found.separations.first() {
        let measurement = measurement_words(&best.measurement);
        let _ = write!(words, " To be sure: {measurement} ({}).", distances_words(best));
    }
    words
}

/// Why the members of a class are named together.
const fn undecided(found: &Found) -> &'static str {
    if found.credible.is_empty() {
        "these flights cannot tell them apart"
    } else {
        "these flights do not decide between them"
    }
}

/// An effect in words at the sign that was found, and its name in files.
fn title(diagnosis: &Diagnosis, id: EffectId) -> String {
    let size = told_size(diagnosis, id).map_or(1.0, |size| size.value);
    format!("{} ({id})", phrase(diagnosis, id, size))
}

/// An effect in words at the sign of its size; of a step of one engine, which.
pub fn phrase(diagnosis: &Diagnosis, id: EffectId, size: f64) -> String {
    let cause = diagnosis.causes.iter().find(|cause| cause.effect == id);
    let engine = cause.and_then(|cause| match cause.hidden {
        HiddenParameter::Step { target, .. } => target.engine(),
        _ => None,
    });
    engine.map_or_else(
        || id.phrase(size),
        |engine| {
            let step = id.phrase(size);
            format!("fuel flow of engine {engine} alone, or what its meter says, takes {step}")
        },
    )
}

pub(crate) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().collect::<String>() + letters.as_str()
    })
}

/// What an effect that acts together with the leading one may be instead.
pub fn others_beside(found: &Found, id: EffectId) -> Vec<EffectId> {
    let of = found.beside.iter().filter(|beside| beside.effect == id);
    of.flat_map(|beside| &beside.class).copied().filter(|other| *other != id).collect()
}

/// A guide whose drag is off: adapting comes first.
fn table_words(found: &Found) -> String {
    let mut words = "The drag of the guide is off, as a table over lift coefficient and Mach number can hold it: adapt \
                     first, then diagnose flights that the adapted model has not learnt."
        .to_owned();
    for beside in &found.beside {
        let _ = if beside.class.len() > 1 {
            write!(
                words,
                " Something that no table can hold acts in addition: one of {}, which these flights cannot distinguish.",
                joined(&beside.class, ", ")
            )
        } else {
            write!(words, " No table can hold what acts in addition: {}.", beside.effect)
        };
    }
    if let Some(best) = found.separations.first() {
        let measurement = measurement_words(&best.measurement);
        let _ = write!(words, " To be sure of it: {measurement} ({}).", distances_words(best));
    }
    words
}

/// The other effects of a verdict's class, which its flights cannot tell from those that it names.
pub fn others_of_class(found: &Found) -> Vec<EffectId> {
    found.class.iter().copied().filter(|id| !found.effects.contains(id)).collect()
}

/// What is stated of effects that probabilities leave open though they are not like what was named.
pub const NOT_RULED_OUT: &str = "Not ruled out, alone or together with another effect";

/// Those of them that these flights cannot tell from what was named, and those that only the probabilities leave open.
pub fn near_and_far(found: &Found) -> [Vec<EffectId>; 2] {
    let (far, near) =
        others_of_class(found).into_iter().partition(|id| found.credible.contains(id));
    [near, far]
}

/// Other effects that are named in the sentence of the cause itself, at most. Our choice: a longer list hides it.
const FEW_OTHERS: usize = 3;

/// Whether so many others are named in the sentence of the cause itself.
pub fn are_few(others: &[EffectId]) -> bool {
    (1..=FEW_OTHERS).contains(&others.len())
}

/// The size of an effect that is named, with its 95 % interval: as it was found together with the other effects of the verdict,
/// else alone.
pub fn told_size(diagnosis: &Diagnosis, id: EffectId) -> Option<Magnitude> {
    let cause = diagnosis.causes.iter().find(|cause| cause.effect == id).map(|c| c.magnitude);
    let mut added = diagnosis.addition.iter().flat_map(|addition| &addition.effects);
    let added = added.find(|added| added.effect == id).map(|added| {
        let half = NORMAL_95 * added.standard_deviation;
        Magnitude { value: added.size, ci95: [added.size - half, added.size + half] }
    });
    // Of one hypothesis both are the same number, and the cause's interval covers the other hypotheses too.
    match (added, cause) {
        (Some(added), Some(cause)) if added.value.total_cmp(&cause.value).is_ne() => Some(added),
        (added, cause) => cause.or(added),
    }
}

/// Names of effects, one after the other.
pub fn joined(effects: &[EffectId], between: &str) -> String {
    effects.iter().map(ToString::to_string).collect::<Vec<_>>().join(between)
}

/// Why the data is too little.
pub fn insufficient_words(reason: Insufficient) -> String {
    match reason {
        Insufficient::NothingInside { segments: 0 } => {
            "no stabilised segment was found (`cruisefit segment` with --explain tells why)"
                .to_owned()
        }
        Insufficient::NothingInside { segments } => {
            format!("none of {segments} segments is inside the drag table")
        }
        Insufficient::Flights { found, needed } => {
            format!("{}, at least {needed} are needed", counted(found, "flight"))
        }
        Insufficient::Segments { found, needed } => {
            format!("{}, at least {needed} are needed", counted(found, "segment"))
        }
        Insufficient::NothingTestable => "no effect of the library can be tested".to_owned(),
        Insufficient::OneCondition => "all segments were flown at the same conditions".to_owned(),
        Insufficient::ComputedFuelFlow => {
            "the residuals of all segments are equal: fuel flow was computed, not measured"
                .to_owned()
        }
    }
}

/// The distances of a separation: "3.1 to 5.2 standard deviations from `wave_drag`; six ordinary flights 3.3", without the
/// backticks.
pub fn distances_words(separation: &Separation) -> String {
    let ordinary = separation
        .distance_ordinary_flights
        .map_or_else(String::new, |distance| format!("; with six ordinary flights {distance:.1}"));
    format!(
        "{} is then {:.1} standard deviations away, now {:.1}{ordinary}",
        separation.from, separation.distance_then, separation.distance_now
    )
}

/// What to measure or to fly, as an order.
pub fn measurement_words(measurement: &Measurement) -> String {
    match measurement {
        Measurement::Weighing => "weigh the aircraft (to 0.3 % of its mass)".to_owned(),
        Measurement::TankGauges => {
            "compare with the fuel uplifted, or with tank gauges held against it (to 0.15 %)"
                .to_owned()
        }
        Measurement::TemperatureReanalysis => "compare SAT with a reanalysis (to 0.5 K)".to_owned(),
        Measurement::AirspeedByGps => {
            "compare true airspeed with GPS and wind (to Mach 0.0015)".to_owned()
        }
        Measurement::AltitudeByGps => {
            "compare pressure altitude with GPS height and a reanalysis (to 0.05 % of p)".to_owned()
        }
        Measurement::N2Deck => "measure an N2 deck (to 0.1 %)".to_owned(),
        Measurement::Flights(FlightsOnPurpose::OneSort(sweep)) => {
            format!("six flights with {}", sweep_words(sweep))
        }
        Measurement::Flights(FlightsOnPurpose::TwoSorts([one, other])) => {
            format!(
                "three flights with {}, and three with {}",
                sweep_words(one),
                sweep_words(other)
            )
        }
    }
}

/// "a Mach sweep 0.72 to 0.88 at FL370, heavy (from 14.2 t)".
fn sweep_words(sweep: &Sweep) -> String {
    match *sweep {
        Sweep::Mach { hundredths: [low, high], below_slowest_flown, level, loading } => {
            let slower = below_slowest_flown.map_or_else(String::new, |slowest| {
                format!(" (slower than any flown, {})", mach_words(slowest))
            });
            format!(
                "a Mach sweep {} to {}{slower} at FL{level}, {}",
                mach_words(low),
                mach_words(high),
                loading_words(loading)
            )
        }
        Sweep::Level { levels: [lowest, highest], mach_hundredths, loading } => format!(
            "levels from FL{lowest} to FL{highest} at Mach {}, {}",
            mach_words(mach_hundredths),
            loading_words(loading)
        ),
    }
}

fn mach_words(hundredths: u32) -> String {
    format!("{:.2}", f64::from(hundredths) / 100.0)
}

fn loading_words(loading: SweepLoading) -> String {
    let name = match loading.kind {
        LoadingKind::Heavy => "heavy",
        LoadingKind::Usual => "of usual mass",
        LoadingKind::Light => "light",
    };
    format!("{name} (from {:.1} t)", loading.mass_kg / 1000.0)
}

/// What was assumed, without a final stop.
pub fn note_words(note: &Note) -> String {
    match *note {
        Note::N2WithoutThrust { silent, recorded } => format!(
            "N2 of {silent} of {recorded} segments stands for no thrust near the predicted one: \
             tsfc_throttle is over corrected thrust there"
        ),
        Note::AntiIceByTemperature { segments, of_segments } => format!(
            "anti-ice bleed is not recorded in {segments} of {of_segments} segments: there anti_ice_bleed assumes it on where the \
             static air temperature is above −40 °C"
        ),
        Note::BeyondFlights { segments, of_segments } => format!(
            "{segments} of {of_segments} segments lie beyond what the learnt flights flew: a gap there may be what those flights \
             did not show"
        ),
        Note::HeavyTails => "whitened residuals have heavy tails: segments are weighed".to_owned(),
        Note::Outliers { segments, of_segments, flights } => {
            let whole = match flights {
                0 => String::new(),
                flights => format!(", among them all of {}", counted(flights, "flight")),
            };
            format!("unlike all others and left out: {segments} of {of_segments} segments{whole}")
        }
        Note::ReferencesAreMeans => {
            "references of effects are the means of these flights".to_owned()
        }
        Note::TableInColumns { nodes, columns, missing_share } => format!(
            "the drag table has {nodes} nodes: its uncertainty is kept in {columns} columns for the nodes that these flights visit \
             (up to {:.2} % of a node's variance left out), and advice on flights elsewhere counts the rest as known",
            100.0 * missing_share
        ),
        Note::LikeALevel(id) => format!(
            "these flights differ from the model's reference in what {id} depends on by more than they vary: nothing \
             distinguishes it from a level"
        ),
        Note::Rest(Rest { kind: RestKind::OtherForm, variable }) => {
            format!("the form of the effect differs in {}", variable_or_none(variable))
        }
        Note::Rest(Rest { kind: RestKind::SomethingElse, variable }) => {
            let variable = variable_or_none(variable);
            format!("something else acts in addition to the effect; it depends on {variable}")
        }
    }
}

/// Why segments were left out.
pub const fn left_out_words(reason: LeftOutReason) -> &'static str {
    match reason {
        LeftOutReason::FuelFlowNotPositive => "fuel flow not positive",
        LeftOutReason::OutsideTable => "outside the drag table",
        LeftOutReason::OutOfDomain => "a mean outside its domain",
        LeftOutReason::NoThrust => "no thrust left",
        LeftOutReason::NotPredictable => "not predictable",
        LeftOutReason::Outlier => "unlike all other segments",
    }
}

/// A gap without a name in words: how surely nothing in the library explains it, what it depends on and acts on.
pub fn outside_words(outside: &OutsideLibrary) -> String {
    let looked_for = if outside.looked_for_all {
        "effect of the library"
    } else {
        "effect of those that were looked for"
    };
    // What is described best by a level depends on nothing, and is what effects of the library make.
    if outside.forms.first().is_some_and(FoundForm::is_a_level) {
        return format!(
            "A real gap that is alike everywhere, and no single {looked_for} stands out"
        );
    }
    let mut words = no_effect_words(outside.probability, looked_for);
    if let Some(variable) = outside.variable {
        let _ = write!(words, "; it depends on {}", variable_words(variable));
    }
    if let Some(acts_on) = outside.acts_on {
        let _ = write!(words, " and acts on {}", acts_on_words(acts_on));
    }
    words
}

/// What is said of a gap that no effect explains, with this probability.
fn no_effect_words(probability: f64, looked_for: &str) -> String {
    /// From here on it is said without reserve; our choice, as for every name.
    const SURE: f64 = 0.9;
    if probability >= SURE {
        format!("A real gap that no {looked_for} explains")
    } else if probability > 0.5 {
        format!("A real gap, and more probably than not no {looked_for} explains it")
    } else {
        format!("A real gap, and no {looked_for} is more probable than not")
    }
}

/// What a cause outside the library acts on.
pub const fn acts_on_words(acts_on: ActsOn) -> &'static str {
    match acts_on {
        ActsOn::FuelFlow => "fuel flow",
        ActsOn::Thrust => "thrust",
        ActsOn::OneEngine => "one engine",
    }
}

/// A variable in the words of the field.
pub const fn variable_words(variable: Variable) -> &'static str {
    match variable {
        Variable::Mach => "Mach number",
        Variable::LiftCoefficient => "lift coefficient",
        Variable::PressureAltitude => "pressure altitude",
        Variable::CorrectedThrust => "corrected thrust",
        Variable::IsaDeviation => "ISA deviation",
        Variable::StaticAirTemperature => "SAT",
        Variable::Date => "date",
        Variable::FuelUsed => "fuel used",
        Variable::Roll => "roll",
        Variable::Acceleration => "acceleration",
        Variable::CrossWind => "cross-wind",
        Variable::Latitude => "latitude",
        Variable::EastwardSpeed => "eastward speed",
        Variable::CenterOfGravity => "CG",
        Variable::Mass => "mass",
        Variable::LatitudeCrossWind => "latitude with cross-wind",
        Variable::CenterOfGravityLift => "CG with lift coefficient",
        Variable::MachLift => "Mach number with lift coefficient",
        Variable::MachExcess => "high Mach number",
        Variable::Engine => "engine",
        Variable::N2 => "N2",
        Variable::AntiIce => "anti-ice",
    }
}

fn variable_or_none(variable: Option<Variable>) -> &'static str {
    variable.map_or("no variable", variable_words)
}
