//! One tail: its series read, and written down.

mod alerts;

use core::ops::Range;

use flight::Timestamp;
use monitor::airbus;
use monitor::cost::{Cost, CostFactors, FactorError, excess_fuel_kg};
use monitor::{
    AlertRule, Bearing, CONDITIONS, Change, ChangeBeliefs, Estimate, FlightDeviation,
    FlownConditions, FlownFlight, History, KnownSteps, Month, Noise, Series, SeriesError, months,
    weighted_mean_percent, years_between,
};

use super::deviations::{BeforeLearning, TailDeviations};
use super::document::{
    AirbusTerms, AlertDocument, ChangeDocument, CostDocument, EventDocument, Figure,
    FlightDocument, MonthDocument, StepInGapDocument, TailDocument,
};
use super::events::Event;
use super::flights::{MeanConditions, MonitoredFlight};
use crate::statistics::ErrorStatistics;
use crate::summary::counted;

/// What a caller may choose.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MonitorOptions {
    /// Factors by which fuel becomes CO₂ and price.
    pub cost: CostFactors,
    /// Basic factor of the flight management system (its model against the book), %.
    pub basic_performance_factor_percent: Option<f64>,
    /// Rules.
    pub rules: Vec<AlertRule>,
    /// Whether deviations by the model before it learnt each flight are wanted.
    pub before_learning: BeforeLearning,
    /// Only flights that began at or after this instant.
    pub since: Option<Timestamp>,
}

impl MonitorOptions {
    /// The same options, whose factors can be computed with.
    ///
    /// # Errors
    /// [`FactorError`] for a factor that [`CostFactors::checked`] refuses, and for a basic factor that is no finite number.
    pub fn checked(self) -> Result<Self, FactorError> {
        self.cost.checked()?;
        match self.basic_performance_factor_percent {
            Some(value) if !value.is_finite() => Err(FactorError {
                quantity: "basic factor of the flight management system",
                value,
                expected: "a finite number of per cent",
            }),
            _ => Ok(self),
        }
    }

    /// What a run was asked for in words, for the head of its page.
    #[must_use]
    pub fn in_words(&self, events: usize) -> Vec<String> {
        let mut told = vec![match events {
            0 => "no events given".to_owned(),
            events => format!("{} given", counted(events, "event")),
        }];
        let rules: Vec<String> = self.rules.iter().map(ToString::to_string).collect();
        if !rules.is_empty() {
            told.push(format!("alerts at {}", rules.join(", ")));
        }
        let figures = [
            ("CO₂ by", self.cost.co2_kg_per_kg, "kg a kg of fuel"),
            ("fuel at", self.cost.price_per_kg, "a kg"),
            ("", self.cost.flights_per_year, "flights a year"),
            ("basic factor of the FMS", self.basic_performance_factor_percent, "%"),
        ];
        for (what, value, unit) in figures {
            told.extend(value.map(|value| format!("{what} {value} {unit}").trim().to_owned()));
        }
        told.extend(self.since.map(|since| format!("flights since {since}")));
        if self.before_learning == BeforeLearning::LeaveOut {
            told.push("without the deviation by the model before it learnt a flight".to_owned());
        }
        told
    }
}

/// What a tail shows: its document, its flights by the conditions flown, and the rules that fired.
pub type Monitored = (TailDocument, FlownConditions, Vec<AlertDocument>);

/// Monitors a tail; `None`, with a warning, where no segment is inside the table.
///
/// # Errors
/// As for [`MonitoredTail::new`].
pub fn monitor_tail(
    tail: &str,
    deviations: &TailDeviations,
    events: &[Event],
    options: &MonitorOptions,
) -> Result<Option<Monitored>, SeriesError> {
    let Some(found) = MonitoredTail::new(tail, deviations, events)? else {
        tracing::warn!(
            tail,
            "no segment is inside the table{}: there is nothing to monitor",
            options.since.map_or_else(String::new, |since| format!(" since {since}"))
        );
        return Ok(None);
    };
    Ok(Some((found.document(options), found.flown_conditions(), found.alerts(options))))
}

/// A tail with its series read.
#[derive(Clone, Debug)]
pub struct MonitoredTail<'a> {
    tail: &'a str,
    aircraft_type: &'a str,
    model: &'a str,
    flights: Vec<&'a MonitoredFlight>,
    reference: MeanConditions,
    of_level: &'a [([f64; CONDITIONS], f64)],
    /// Flights a year, those without a segment too; `None` over less than a month.
    recorded_per_year: Option<f64>,
    /// Flights that show nothing.
    without_segments: usize,
    events: Vec<&'a Event>,
    history: History,
    /// Deviations with the flights' weights; what changed is read from the normalised ones.
    before_learning: Option<(Series, Vec<f64>)>,
    engines: EngineSeries,
}

/// The series of engines that are recorded apart.
#[derive(Clone, Debug, Default)]
struct EngineSeries {
    /// The flights in which they are, by their places among all, in order.
    flights: Vec<usize>,
    /// One series for each engine.
    of_each: Vec<History>,
}

impl EngineSeries {
    /// Whether a change of an engine belongs to this event.
    fn show(&self, event: usize) -> bool {
        let mut changes = self.of_each.iter().flat_map(|history| &history.changes);
        changes.any(|change| change.event == Some(event))
    }

    /// The first flights after changes of single engines, by their places among all.
    fn steps(&self) -> impl Iterator<Item = usize> {
        let changes = self.of_each.iter().flat_map(|history| &history.changes);
        changes.map(|change| self.flights[change.first_flight])
    }

    /// Which of its flights are among these of all.
    fn range(&self, of_all: &Range<usize>) -> Range<usize> {
        let place = |flight: usize| self.flights.partition_point(|known| *known < flight);
        place(of_all.start)..place(of_all.end)
    }
}

/// Engine by engine, what the flights show in which each is recorded: the others have only the flow of all together.
fn engines_of(
    all: &[&MonitoredFlight],
    (level_percent, reference): (f64, &MeanConditions),
    events: &[&Event],
) -> Result<EngineSeries, SeriesError> {
    let count = all.iter().map(|flight| flight.engines.len()).max().unwrap_or(0);
    let beliefs = ChangeBeliefs::of_2026().of_an_engine(count);
    let flights: Vec<usize> =
        (0..all.len()).filter(|&place| all[place].engines.len() == count && count > 0).collect();
    let mut of_each = Vec::with_capacity(count);
    for engine in 0..count {
        let shown = flights.iter().map(|&place| all[place].engines[engine].raised(level_percent));
        let conditions: Vec<_> =
            flights.iter().map(|&place| all[place].conditions.to_monitor(reference)).collect();
        let series = Series::new(shown.collect())?.under(&conditions)?;
        let bearing = |event: &&Event| (event.time, event.bearing_on_engine(engine + 1));
        let bears = |event: &&&Event| bearing(event).1 != Bearing::None && event.is_to_burn_less();
        let to_burn_less = events.iter().filter(bears).map(|event| event.time).collect();
        let steps = KnownSteps { to_burn_less, ..KnownSteps::default() };
        let events: Vec<_> = events.iter().map(bearing).collect();
        let history = History::fit_with_steps(&series, &events, &steps, &beliefs);
        of_each.extend(history);
    }
    Ok(EngineSeries { flights, of_each })
}

/// Rate of flights in order of flying. One flight more than intervals; over less than a month it is no rate.
fn recorded_per_year(flights: &[MonitoredFlight]) -> Option<f64> {
    const LEAST_YEARS: f64 = 1.0 / 12.0;
    let span = years_between(flights.first()?.start, flights.last()?.start);
    (span > LEAST_YEARS).then(|| (flights.len() as f64 - 1.0) / span)
}

impl<'a> MonitoredTail<'a> {
    /// Reads a tail's series; `None` where no segment is inside the table.
    ///
    /// # Errors
    /// Flights that are not in order.
    pub fn new(
        tail: &'a str,
        deviations: &'a TailDeviations,
        events: &'a [Event],
    ) -> Result<Option<Self>, SeriesError> {
        let beliefs = ChangeBeliefs::of_2026();
        let events: Vec<&Event> = events.iter().filter(|event| event.tail == tail).collect();
        let flights: Vec<&MonitoredFlight> =
            deviations.flights.iter().filter(|flight| flight.learnt.is_some()).collect();
        let level = deviations.level_percent;
        let learnt = flights.iter().filter_map(|flight| Some(flight.learnt?.raised(level)));
        let reference = deviations.reference;
        let conditions: Vec<_> =
            flights.iter().map(|flight| flight.conditions.to_monitor(&reference)).collect();
        let series = Series::new(learnt.collect())?.under(&conditions)?;
        // First engine by engine: what one of them shows of its own is no wash of the airframe.
        let engines = engines_of(&flights, (level, &reference), &events)?;
        let bearing = |(place, event): (usize, &&Event)| {
            let is_shown = event.names_engines() && engines.show(place);
            (event.time, if is_shown { Bearing::Likely } else { Bearing::Possible })
        };
        let bearings: Vec<_> = events.iter().enumerate().map(bearing).collect();
        // An engine that stepped by itself takes all of them along, by its share of the flow.
        let to_burn_less = events.iter().filter(|event| event.is_to_burn_less());
        let steps = KnownSteps {
            of_a_part: engines.steps().map(|flight| flights[flight].start).collect(),
            to_burn_less: to_burn_less.map(|event| event.time).collect(),
        };
        let Some(history) = History::fit_with_steps(&series, &bearings, &steps, &beliefs) else {
            return Ok(None);
        };
        let known: Option<Vec<FlightDeviation>> =
            flights.iter().map(|flight| Some(flight.before_learning?.deviation)).collect();
        let before_learning = known.map(Series::new).transpose()?.map(|series| {
            let weights = Noise::estimate(&series).weights(&series);
            (series, weights)
        });
        Ok(Some(Self {
            tail,
            aircraft_type: &deviations.aircraft_type,
            model: &deviations.model,
            without_segments: deviations.flights.len() - flights.len(),
            flights,
            reference,
            of_level: &deviations.of_level,
            recorded_per_year: recorded_per_year(&deviations.flights),
            events,
            history,
            before_learning,
            engines,
        }))
    }

    /// Everything found of the tail.
    #[must_use]
    pub fn document(&self, options: &MonitorOptions) -> TailDocument {
        let months = self.months();
        let level = self.history.levels.last_level_percent(self.series());
        let noise = &self.history.noise;
        let date = |flight: Option<&&MonitoredFlight>| {
            flight.map_or_else(String::new, |flight| flight.start.to_string())
        };
        TailDocument {
            tail: self.tail.to_owned(),
            aircraft_type: self.aircraft_type.to_owned(),
            model: self.model.to_owned(),
            from: date(self.flights.first()),
            to: date(self.flights.last()),
            reference: self.reference,
            deviation_percent: level.into(),
            at_type_conditions_percent: None,
            before_learning_percent: self.before_learning_mean(0..self.flights.len()),
            trend_percent_per_year: self
                .history
                .levels
                .measured_trend_percent_per_year()
                .map(Figure::from),
            step_in_gap: self.step_in_gap(),
            within_flight_percent: noise.within_flight_percent,
            between_flights_percent: noise.between_flights_percent,
            correlation: noise.correlation,
            airbus: self.airbus(level.into(), &months, options),
            cost: self.cost(level, options),
            changes: self.all_changes(),
            flights_without_engines: match self.engines.flights.len() {
                0 => 0,
                recorded => self.flights.len() - recorded,
            },
            flights_without_segments: self.without_segments,
            events: self.event_documents(),
            flights: (0..self.flights.len()).map(|index| self.flight(index)).collect(),
            months,
        }
    }

    /// Its flights by the conditions flown: what each deviates by the book there, less what the level has changed since.
    #[must_use]
    pub fn flown_conditions(&self) -> FlownConditions {
        let levels = &self.history.levels;
        let now = levels.last_level_percent(self.series()).value;
        let flown = |(index, flight): (usize, &&MonitoredFlight)| {
            let then = levels.level_percent(index, self.series().years(flight.start)).value;
            Some(FlownFlight {
                conditions: flight.conditions.to_monitor(&self.reference),
                deviation_percent: flight.book?.deviation_percent() - (then - now),
                weight: self.history.weights[index],
            })
        };
        FlownConditions {
            flights: self.flights.iter().enumerate().filter_map(flown).collect(),
            of_level: self.of_level.to_vec(),
        }
    }

    /// The step that its trend may be in place of.
    fn step_in_gap(&self) -> Option<StepInGapDocument> {
        let step = self.history.step_in_gap?;
        let start = |flight: usize| self.flights[flight].start.to_string();
        Some(StepInGapDocument {
            after: start(step.first_flight - 1),
            until: start(step.first_flight),
            step_percent: step.step_percent.into(),
        })
    }

    /// What its flights would have shown at their mean conditions.
    const fn series(&self) -> &Series {
        &self.history.at_mean_conditions
    }

    fn before_learning_mean(&self, flights: Range<usize>) -> Option<Figure> {
        let (series, weights) = self.before_learning.as_ref()?;
        weighted_mean_percent(series, weights, flights).map(Figure::from)
    }

    fn fuel_flow_kg_s(&self, deviation_percent: f64) -> f64 {
        self.reference.initial_fuel_flow_kg_s * (deviation_percent / 100.0).exp()
    }

    fn specific_range_m_kg(&self, deviation_percent: f64) -> f64 {
        self.reference.true_airspeed_m_s / self.fuel_flow_kg_s(deviation_percent)
    }

    fn months(&self) -> Vec<MonthDocument> {
        let mut factors: Vec<(Month, f64)> = Vec::new();
        let mut documents = Vec::new();
        for (month, flights) in months(self.series()) {
            let Some(mean) = self.history.mean_percent(self.series(), flights.clone()) else {
                continue;
            };
            let deviation_percent = Figure::from(mean);
            let monitored = deviation_percent.map(airbus::monitored_fuel_factor_percent);
            factors.push((month, monitored.value));
            let recorded = self.engines.range(&flights);
            let engines = self.engines.of_each.iter().filter_map(|history| {
                let series = &history.at_mean_conditions;
                history.mean_percent(series, recorded.clone()).map(Figure::from)
            });
            let segments = self.series().flights()[flights.clone()].iter();
            documents.push(MonthDocument {
                month: month.to_string(),
                flights: flights.len(),
                segments: segments.map(|flight| u64::from(flight.segments())).sum(),
                deviation_percent,
                before_learning_percent: self.before_learning_mean(flights.clone()),
                fuel_flow_kg_s: deviation_percent.map(|percent| self.fuel_flow_kg_s(percent)),
                specific_range_m_kg: deviation_percent
                    .map(|percent| self.specific_range_m_kg(percent)),
                specific_range_deviation_percent: deviation_percent
                    .map(airbus::specific_range_deviation_percent),
                monitored_fuel_factor_percent: monitored,
                retained_fuel_factor_percent: airbus::retained_fuel_factor_percent(month, &factors)
                    .unwrap_or_else(|| airbus::rounded_up_to_a_tenth(monitored.value)),
                engines_percent: engines.collect(),
            });
        }
        documents
    }

    /// The factor to plan with is that of the level, which every flight since the last change has a share in: a month may be one
    /// flight.
    fn airbus(
        &self,
        level_percent: Figure,
        months: &[MonthDocument],
        options: &MonitorOptions,
    ) -> AirbusTerms {
        let each: Vec<f64> = self
            .series()
            .flights()
            .iter()
            .map(|flight| airbus::specific_range_deviation_percent(flight.deviation_percent()))
            .collect();
        let statistics = ErrorStatistics::from_errors(&each);
        let last = months.last();
        let fuel_factor = level_percent.map(airbus::monitored_fuel_factor_percent);
        let entered = airbus::rounded_up_to_a_tenth(fuel_factor.value);
        AirbusTerms {
            specific_range_deviation_percent: statistics.mean.unwrap_or(0.0),
            specific_range_deviation_std_percent: statistics.std,
            readings: statistics.n,
            fuel_factor_percent: fuel_factor,
            monitored_fuel_factor_percent: last
                .map_or_else(Figure::default, |month| month.monitored_fuel_factor_percent),
            retained_fuel_factor_percent: last
                .map_or(0.0, |month| month.retained_fuel_factor_percent),
            performance_factor_percent: options
                .basic_performance_factor_percent
                .map(|basic| airbus::performance_factor_percent(basic, entered)),
        }
    }

    fn cost(&self, level: Estimate, options: &MonitorOptions) -> CostDocument {
        let fuel: f64 = self.flights.iter().map(|flight| flight.cruise_fuel_kg).sum();
        let flights = self.flights.len() as f64;
        let flights_per_year = options.cost.flights_per_year.or(self.recorded_per_year);
        let cost = Cost::new(
            level.value,
            fuel / flights.max(1.0),
            flights_per_year.unwrap_or(0.0),
            &options.cost,
        );
        CostDocument {
            flights_per_year,
            fuel_kg_per_flight: cost.fuel_kg_per_flight,
            fuel_kg_per_year: flights_per_year.map(|_| cost.fuel_kg_per_year),
            co2_kg_per_year: flights_per_year.and(cost.co2_kg_per_year),
            price_per_year: flights_per_year.and(cost.price_per_year),
        }
    }

    /// Those of all engines together, then engine by engine.
    fn all_changes(&self) -> Vec<ChangeDocument> {
        let mut changes = self.changes(None, &self.history);
        for (engine, history) in self.engines.of_each.iter().enumerate() {
            changes.extend(self.changes(Some(engine + 1), history));
        }
        changes
    }

    fn changes(&self, engine: Option<usize>, history: &History) -> Vec<ChangeDocument> {
        let flights = history.at_mean_conditions.flights();
        let start = |flight: usize| flights[flight].time().to_string();
        let kind = |event: usize| self.events[event].kind.clone();
        let document = |change: &Change| {
            let near = change.event.into_iter().chain(change.other_events.iter().copied());
            let may_be = |event: &usize| {
                engine.is_none() || self.changes_every_engine_so(*event, &change.step_percent)
            };
            let mut events = near.filter(may_be).map(kind);
            ChangeDocument {
                engine,
                since: start(change.first_flight),
                since_ci95: [start(change.earliest), start(change.latest)],
                probability: change.probability,
                step_percent: change.step_percent.into(),
                event: events.next(),
                other_events: events.collect(),
            }
        };
        history.changes.iter().map(document).collect()
    }

    /// Whether an event can have changed an engine's fuel flow by this step: one of the airframe changes every engine as it
    /// changes all together, which a change of one engine alone is not.
    fn changes_every_engine_so(&self, event: usize, step_percent: &Estimate) -> bool {
        let of_all = self.history.events[event].effect_percent;
        let differs =
            |all: Estimate| (all.value - step_percent.value).abs() > step_percent.half_width95();
        !self.events[event].is_of_airframe() || !of_all.is_some_and(differs)
    }

    fn event_documents(&self) -> Vec<EventDocument> {
        let found = self.events.iter().zip(&self.history.events);
        found
            .map(|(event, effect)| EventDocument {
                time: event.time.to_string(),
                kind: event.kind.clone(),
                note: event.note.clone(),
                effect_percent: effect.effect_percent.map(Figure::from),
                together_with: effect
                    .together_with
                    .iter()
                    .map(|other| self.events[*other].kind.clone())
                    .collect(),
            })
            .collect()
    }

    fn flight(&self, index: usize) -> FlightDocument {
        let flight = self.flights[index];
        let shown = &self.series().flights()[index];
        let percent = shown.deviation_percent();
        let variance = self.history.noise.flight_variance_percent2(shown.segments());
        let years = self.series().years(flight.start);
        let of = |deviation: Option<FlightDeviation>| deviation.map(|d| d.deviation_percent());
        let recorded = self.engines.range(&(index..index + 1));
        FlightDocument {
            flight: flight.flight.clone(),
            start: flight.start.to_string(),
            segments: flight.segments,
            outside_table: flight.outside_table,
            deviation_percent: Estimate { value: percent, deviation: variance.sqrt() }.into(),
            initial_deviation_percent: of(flight.book).unwrap_or(percent),
            before_learning_percent: of(flight.before_learning.map(|known| known.deviation)),
            level_percent: self.history.levels.level_percent(index, years).into(),
            fuel_flow_kg_s: self.fuel_flow_kg_s(percent),
            specific_range_m_kg: self.specific_range_m_kg(percent),
            specific_range_deviation_percent: airbus::specific_range_deviation_percent(percent),
            engines_percent: self
                .engines
                .of_each
                .iter()
                .flat_map(|history| &history.at_mean_conditions.flights()[recorded.clone()])
                .map(FlightDeviation::deviation_percent)
                .collect(),
            excess_fuel_kg: excess_fuel_kg(flight.cruise_fuel_kg, percent),
        }
    }
}
