//! What `monitor` found, as types that become JSON, tables and text.

use monitor::{Estimate, airbus};
use serde::{Deserialize, Serialize};

use super::fleet::{fleet, types_of};
use super::flights::MeanConditions;

/// Name and version of the JSON.
pub const SCHEMA: &str = "cruisefit.monitor/1";

/// A value with its 95 % interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// The value.
    pub value: f64,
    /// Lower and upper end of its 95 % interval.
    pub ci95: [f64; 2],
}

impl From<Estimate> for Figure {
    fn from(estimate: Estimate) -> Self {
        let half = estimate.half_width95();
        Self { value: estimate.value, ci95: [estimate.value - half, estimate.value + half] }
    }
}

impl Figure {
    /// Half width of the interval, in the direction in which it is wider.
    #[must_use]
    pub fn half_width(&self) -> f64 {
        (self.ci95[1] - self.value).max(self.value - self.ci95[0])
    }

    /// The same of a function that rises or falls throughout.
    #[must_use]
    pub fn map(&self, of: impl Fn(f64) -> f64) -> Self {
        let ends = self.ci95.map(&of);
        Self { value: of(self.value), ci95: [ends[0].min(ends[1]), ends[0].max(ends[1])] }
    }
}

/// Everything.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MonitorDocument {
    /// Name and version of this layout.
    pub schema: &'static str,
    /// Tail by tail, in order.
    pub tails: Vec<TailDocument>,
    /// Type by type, in order.
    pub fleet: Vec<FleetDocument>,
    /// Rules that fired, in the order of tails and rules.
    pub alerts: Vec<AlertDocument>,
}

/// A tail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TailDocument {
    /// Tail.
    pub tail: String,
    /// Type code of its aircraft.
    pub aircraft_type: String,
    /// What the tail's model has learnt, in words; empty in documents of older programs.
    #[serde(default)]
    pub model: String,
    /// First flight.
    pub from: String,
    /// Last flight.
    pub to: String,
    /// Conditions that deviations are normalised to.
    pub reference: MeanConditions,
    /// Level at the last flight.
    pub deviation_percent: Figure,
    /// The same at the mean conditions of the tails of its type, by which these are compared; absent of the only one.
    #[serde(default)]
    pub at_type_conditions_percent: Option<Figure>,
    /// Mean of deviations by the model before it learnt each flight; absent where it was not rebuilt.
    pub before_learning_percent: Option<Figure>,
    /// Trend between changes; absent where the flights say next to nothing of it.
    pub trend_percent_per_year: Option<Figure>,
    /// A step, while the aircraft did not fly, that the trend may be in place of.
    #[serde(default)]
    pub step_in_gap: Option<StepInGapDocument>,
    /// Standard deviation of a segment about its flight.
    pub within_flight_percent: f64,
    /// Standard deviation of what a flight keeps.
    pub between_flights_percent: f64,
    /// Correlation of successive flights that was allowed for.
    pub correlation: f64,
    /// In Airbus' terms.
    pub airbus: AirbusTerms,
    /// What the present level costs.
    pub cost: CostDocument,
    /// Changes, of all engines together and engine by engine.
    pub changes: Vec<ChangeDocument>,
    /// Flights without fuel flow of each engine, where others have it: they are in the series of no engine.
    #[serde(default)]
    pub flights_without_engines: usize,
    /// Learnt flights beside these that show nothing: no segment of them is inside the table.
    #[serde(default)]
    pub flights_without_segments: usize,
    /// Recorded events.
    pub events: Vec<EventDocument>,
    /// Months.
    pub months: Vec<MonthDocument>,
    /// Flights.
    pub flights: Vec<FlightDocument>,
}

/// Airbus' terms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AirbusTerms {
    /// DSR, mean over all flights: negative, worse than the book.
    pub specific_range_deviation_percent: f64,
    /// Its standard deviation over flights, as Airbus prints it beside the mean; absent with one flight.
    pub specific_range_deviation_std_percent: Option<f64>,
    /// Number of readings: flights.
    pub readings: usize,
    /// What to plan with: by how much predicted fuel flow is to be raised at the level of the last flight; 0 in documents of
    /// older programs.
    #[serde(default)]
    pub fuel_factor_percent: Figure,
    /// Monitored fuel factor of the last month.
    pub monitored_fuel_factor_percent: Figure,
    /// Mean of the last three months, rounded up to a tenth.
    pub retained_fuel_factor_percent: f64,
    /// Basic factor plus the one to plan with, rounded up to a tenth, where the basic factor is given.
    pub performance_factor_percent: Option<f64>,
}

impl AirbusTerms {
    /// The factor to plan with as it is entered: rounded up to a tenth, so that no fuel is missing.
    #[must_use]
    pub fn entered_fuel_factor_percent(&self) -> f64 {
        airbus::rounded_up_to_a_tenth(self.fuel_factor_percent.value)
    }
}

/// What a deviation costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CostDocument {
    /// Flights a year that are counted with.
    pub flights_per_year: Option<f64>,
    /// Fuel a flight, between its first and its last segment, kg.
    pub fuel_kg_per_flight: f64,
    /// Fuel a year, kg.
    pub fuel_kg_per_year: Option<f64>,
    /// CO₂ a year, kg.
    pub co2_kg_per_year: Option<f64>,
    /// Price a year.
    pub price_per_year: Option<f64>,
}

/// A step in a time without flights, which explains the flights about as well as a trend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepInGapDocument {
    /// Start of the last flight before that time.
    pub after: String,
    /// Start of the first flight since.
    pub until: String,
    /// Size.
    pub step_percent: Figure,
}

/// A change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChangeDocument {
    /// Engine, from 1; absent for all together.
    pub engine: Option<usize>,
    /// Start of the first flight after it.
    pub since: String,
    /// The 95 % interval of that flight.
    pub since_ci95: [String; 2],
    /// Probability that there is a change about here.
    pub probability: f64,
    /// Size.
    pub step_percent: Figure,
    /// Kind of the event that it belongs to.
    pub event: Option<String>,
    /// Kinds of other events within the interval, to which it could belong as well.
    #[serde(default)]
    pub other_events: Vec<String>,
}

impl ChangeDocument {
    /// The event that it belongs to, and those to which it could belong as well, in words; `None` without one.
    #[must_use]
    pub fn event_in_words(&self) -> Option<String> {
        let event = self.event.as_ref()?;
        Some(match &self.other_events[..] {
            [] => event.clone(),
            others => format!("{event} (or {}, in the same interval)", others.join(", ")),
        })
    }
}

/// An event.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EventDocument {
    /// When.
    pub time: String,
    /// What.
    pub kind: String,
    /// In the operator's words.
    pub note: String,
    /// What it did; absent without a flight before or after.
    pub effect_percent: Option<Figure>,
    /// Kinds of other events between the same two flights, whose effect is in it too.
    pub together_with: Vec<String>,
}

/// A month.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MonthDocument {
    /// Year and month.
    pub month: String,
    /// Flights.
    pub flights: usize,
    /// Segments.
    pub segments: u64,
    /// Mean deviation.
    pub deviation_percent: Figure,
    /// By the model before it learnt the flights; absent where it was not rebuilt.
    pub before_learning_percent: Option<Figure>,
    /// Fuel flow at reference conditions.
    pub fuel_flow_kg_s: Figure,
    /// Specific range at reference conditions.
    pub specific_range_m_kg: Figure,
    /// DSR.
    pub specific_range_deviation_percent: Figure,
    /// Monitored fuel factor.
    pub monitored_fuel_factor_percent: Figure,
    /// Mean of three months, rounded up to a tenth.
    pub retained_fuel_factor_percent: f64,
    /// Of each engine that is recorded.
    pub engines_percent: Vec<Figure>,
}

/// A flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlightDocument {
    /// Its name.
    pub flight: String,
    /// START.
    pub start: String,
    /// Segments inside the table.
    pub segments: usize,
    /// Segments outside.
    pub outside_table: usize,
    /// Deviation at reference conditions.
    pub deviation_percent: Figure,
    /// At the conditions flown, against the book.
    pub initial_deviation_percent: f64,
    /// By the model before it learnt the flight; absent where it was not rebuilt.
    pub before_learning_percent: Option<f64>,
    /// Level at its date.
    pub level_percent: Figure,
    /// Fuel flow at reference conditions.
    pub fuel_flow_kg_s: f64,
    /// Specific range at reference conditions.
    pub specific_range_m_kg: f64,
    /// DSR.
    pub specific_range_deviation_percent: f64,
    /// Of each engine that is recorded.
    pub engines_percent: Vec<f64>,
    /// Fuel beyond what the book says, first to last segment, kg.
    pub excess_fuel_kg: f64,
}

/// A fleet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FleetDocument {
    /// Type code.
    pub aircraft_type: String,
    /// Tails.
    pub tails: usize,
    /// Mean conditions of its tails, each counted alike, at which these are compared.
    pub reference: TypeConditions,
    /// Mean of the tails' present levels there.
    pub deviation_percent: Figure,
    /// Standard deviation between tails beyond the uncertainty of each.
    pub between_tails_percent: f64,
    /// Mean of the trends of the tails whose flights show one; absent where none does.
    pub trend_percent_per_year: Option<Figure>,
    /// Months: means over the tails that flew in them.
    pub months: Vec<FleetMonthDocument>,
}

/// Conditions at which the tails of a type are compared.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TypeConditions {
    /// Mean pressure altitude, m.
    pub pressure_altitude_m: f64,
    /// Mean Mach number.
    pub mach: f64,
    /// Mean static air temperature, K.
    pub static_air_temperature_k: f64,
    /// Mean gross mass, kg.
    pub mass_kg: f64,
}

/// A month of a fleet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FleetMonthDocument {
    /// Year and month.
    pub month: String,
    /// Tails that flew.
    pub tails: usize,
    /// Mean deviation.
    pub deviation_percent: Figure,
}

/// A rule that fired.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AlertDocument {
    /// Tail.
    pub tail: String,
    /// Engine, from 1; absent for all together.
    #[serde(default)]
    pub engine: Option<usize>,
    /// The rule as it was given.
    pub rule: String,
    /// What it looked at.
    pub size: Figure,
    /// Unit of the size.
    pub unit: String,
    /// Since when.
    pub since: String,
    /// Of a trend: the step that it may be in place of.
    #[serde(default)]
    pub step_in_gap: Option<StepInGapDocument>,
    /// Effects that the newest diagnosis of the tail names, where one is given and a cause stands out there.
    pub likely_causes: Vec<String>,
    /// The same in words for a person, each at the sign that was found.
    #[serde(skip)]
    pub likely_causes_in_words: Vec<String>,
    /// Why that diagnosis names none, in words for a person.
    #[serde(skip)]
    pub no_likely_cause: Option<String>,
}

impl MonitorDocument {
    /// The document of these tails, in their order, with the fleets that they make up.
    #[must_use]
    pub fn new(tails: Vec<TailDocument>, alerts: Vec<AlertDocument>) -> Self {
        let fleet = types_of(&tails).iter().filter_map(|of_type| fleet(of_type, &tails)).collect();
        Self { schema: SCHEMA, tails, fleet, alerts }
    }

    /// The document that [`to_json`](Self::to_json) wrote; fleets are formed anew from its tails.
    ///
    /// # Errors
    /// Text that is not such a document.
    pub fn from_json(text: &str) -> Result<Self, serde_json::Error> {
        let mut read: Written = serde_json::from_str(text)?;
        for tail in &mut read.tails {
            // Documents of older programs do not have it.
            tail.airbus.fuel_factor_percent =
                tail.deviation_percent.map(airbus::monitored_fuel_factor_percent);
        }
        Ok(Self::new(read.tails, read.alerts))
    }

    /// As JSON, with a final line end.
    #[must_use]
    pub fn to_json(&self) -> Vec<u8> {
        let mut text = Vec::new();
        // Memory takes everything.
        let _ = self.write_json(&mut text);
        text
    }

    /// Writes the same; of a large fleet it is hundreds of megabytes.
    ///
    /// # Errors
    /// Those of what is written to.
    pub fn write_json(&self, to: &mut dyn std::io::Write) -> std::io::Result<()> {
        serde_json::to_writer_pretty(&mut *to, self)?;
        to.write_all(b"\n")
    }
}

/// What is read of a document.
#[derive(Deserialize)]
struct Written {
    tails: Vec<TailDocument>,
    alerts: Vec<AlertDocument>,
}
