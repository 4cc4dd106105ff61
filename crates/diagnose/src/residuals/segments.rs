//! Segments made ready for the search: residuals of every channel, signatures of every column, noise.
//!
//! Everything is linear in the number of segments and lies segment by segment.

use std::borrow::Cow;
use std::collections::BTreeMap;

use effects::{AppliedEffects, EffectModel, EffectPoint, KnownPoint, Response};
use flight::SegmentMeans;
use flight::effect::{EffectId, HiddenParameter, StepTarget};
use perf_model::variance::mean_acceleration_deviation_m_s2;

use crate::baseline::Baseline;
use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::library::Library;
use crate::library::engine_changes::SingleEngines;
use crate::output::note::{LeftOutReason, Note};
use crate::residuals::chords::chord_errors;
use crate::residuals::gauges::{calibrate, gauge_row};
use crate::residuals::predictor::Predictor;
use crate::residuals::reference::Reference;
use crate::residuals::rows::{FlightRows, SegmentRow};
use crate::residuals::signatures::Differences;
use crate::signals::channels::{
    ByChannel, Channels, MAXIMUM_CHANNELS, has_n2, mean_n2_percent, recorded_channels,
};
use crate::signals::n2_deck::Deck;
use crate::signals::noise::{HEATING_VALUE_LOADING, NoiseModel, SegmentNoise, Statistics};
use crate::signals::record::FlightRecord;
use crate::signals::record::GaugeBurn;
use crate::signals::wander::add_wander;

/// Everything ready.
#[derive(Clone, Debug)]
pub(crate) struct PreparedFlights<'a> {
    pub(crate) channels: Channels,
    pub(crate) predictor: Predictor<'a>,
    pub(crate) flights: Vec<FlightRows>,
    pub(crate) segments: Vec<SegmentRow>,
    /// Whether what an engine burns beside the others is another before and after some date.
    pub(crate) engines_change: bool,
    /// Whether they are of other aircraft than the one that taught the model.
    pub(crate) of_other_aircraft: bool,
    /// Segments that were left out, by reason.
    pub(crate) left_out: BTreeMap<LeftOutReason, usize>,
}

/// What several sets of flights have in common: recorded channels and N2 deck.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    channels: Channels,
    deck: Deck,
}

/// A segment that the model can predict, before signatures.
pub(crate) struct Inside<'a> {
    /// Corrected by what the model contains.
    pub(crate) means: Cow<'a, SegmentMeans>,
    pub(crate) rows: &'a [u32],
    pub(crate) point: EffectPoint,
    pub(crate) known: KnownPoint,
    pub(crate) response: Response,
    /// Its place among all segments that were given.
    pub(crate) place: usize,
}

impl Inside<'_> {
    /// Looks up the thrust that belongs to the recorded N2.
    pub(crate) fn look_up_n2(&mut self, predictor: &Predictor<'_>) {
        let by_n2_n = mean_n2_percent(&self.means)
            .and_then(|percent| predictor.corrected_thrust_by_n2_n(percent, &self.response));
        self.point.corrected_thrust_by_n2_n = by_n2_n;
        self.known = self.known.with_corrected_thrust_by_n2(by_n2_n);
    }
}

/// A flight's segments that the model can predict, and its gauges.
type FlightInside<'a> = (Vec<Inside<'a>>, Option<GaugeBurn>);

/// Looks up the thrust that belongs to every recorded N2.
fn look_up_n2(inside: &mut [FlightInside<'_>], predictor: &Predictor<'_>) {
    if predictor.channels.n2 {
        for kept in inside.iter_mut().flat_map(|(segments, _)| segments) {
            kept.look_up_n2(predictor);
        }
    }
}

/// Collects what the model can predict, flight by flight.
fn inside<'a>(
    model: &EffectModel<'_>,
    flights: &[FlightRecord<'a>],
    left_out: &mut BTreeMap<LeftOutReason, usize>,
) -> Vec<FlightInside<'a>> {
    let engines = model.aircraft().engines();
    let mut all = Vec::with_capacity(flights.len());
    let mut places = 0..;
    for flight in flights {
        let mut kept = Vec::with_capacity(flight.segments.len());
        for (segment, place) in flight.segments.iter().zip(&mut places) {
            let start_s = segment.identity.start_s();
            let found = model.corrected_means(&segment.means).and_then(|means| {
                let point = EffectPoint {
                    is_temperature_assumed: segment.temperature_assumed,
                    ..EffectPoint::from_means(&means, start_s, engines)
                };
                let (known, response) = model.known_point(&point)?;
                Ok(Inside { means, rows: &segment.rows, point, known, response, place })
            });
            let flow_kg_s = segment.means.fuel_flow_total_kg_s;
            match found {
                Ok(inside) if flow_kg_s.is_finite() && flow_kg_s > 0.0 => kept.push(inside),
                Ok(_) => *left_out.entry(LeftOutReason::FuelFlowNotPositive).or_default() += 1,
                Err(error) => *left_out.entry(reason(&error)).or_default() += 1,
            }
        }
        if !kept.is_empty() {
            all.push((kept, flight.gauges));
        }
    }
    all
}

const fn reason(error: &effects::EffectError) -> LeftOutReason {
    use effects::EffectError;
    match error {
        EffectError::OutsideTable { .. } => LeftOutReason::OutsideTable,
        EffectError::OutOfDomain(_) => LeftOutReason::OutOfDomain,
        EffectError::ThrustNotPositive { .. } => LeftOutReason::NoThrust,
        _ => LeftOutReason::NotPredictable,
    }
}

impl<'a> PreparedFlights<'a> {
    /// Prepares the flights against a model. `effects` are already part of the model (none, as a rule).
    pub(crate) fn prepare(
        model: &EffectModel<'_>,
        flights: &[FlightRecord<'_>],
        reference: Reference<'a>,
        library_of: impl FnOnce(&[EffectPoint], SingleEngines, &[f64]) -> Library,
    ) -> (Self, Library) {
        let mut left_out = BTreeMap::new();
        let mut inside = inside(model, flights, &mut left_out);
        let channels = channels_of(model, &inside);
        let deck = deck_of(&inside, channels, reference.baseline());
        let predictor = Predictor { channels, deck, baseline: reference.baseline() };
        look_up_n2(&mut inside, &predictor);
        let points: Vec<EffectPoint> =
            inside.iter().flat_map(|(segments, _)| segments).map(|kept| kept.point).collect();
        let starts: Vec<f64> =
            inside.iter().map(|(segments, _)| segments[0].point.date_s).collect();
        let engines = SingleEngines::of(flights, channels.contrasts > 0);
        let library = library_of(&points, engines, &starts);
        let mut data = Self::of_inside(model, (inside, left_out), reference, predictor, &library);
        data.engines_change = engines == SingleEngines::Change;
        (data, library)
    }

    /// Prepares flights in the frame and with the library of others.
    pub(crate) fn prepare_in(
        model: &EffectModel<'_>,
        flights: &[FlightRecord<'_>],
        reference: Reference<'a>,
        frame: &Frame,
        library: &Library,
    ) -> Self {
        let mut left_out = BTreeMap::new();
        let mut inside = inside(model, flights, &mut left_out);
        let Frame { channels, deck } = frame.clone();
        let predictor = Predictor { channels, deck, baseline: reference.baseline() };
        look_up_n2(&mut inside, &predictor);
        Self::of_inside(model, (inside, left_out), reference, predictor, library)
    }

    /// Channels and deck, for [`prepare_in`](Self::prepare_in).
    pub(crate) fn frame(&self) -> Frame {
        Frame { channels: self.channels, deck: self.predictor.deck.clone() }
    }

    fn of_inside(
        model: &EffectModel<'_>,
        (inside, left_out): (Vec<FlightInside<'_>>, BTreeMap<LeftOutReason, usize>),
        reference: Reference<'a>,
        predictor: Predictor<'a>,
        library: &Library,
    ) -> Self {
        let statistics = reference.statistics(model);
        let differences = Differences::new(model, library, predictor.baseline);
        let mut data = Self {
            channels: predictor.channels,
            predictor,
            flights: Vec::with_capacity(inside.len()),
            segments: Vec::new(),
            engines_change: false,
            of_other_aircraft: false,
            left_out,
        };
        for (segments, gauges) in inside {
            let first = data.segments.len();
            let start_s = segments[0].point.date_s;
            for segment in segments {
                match data.row(model, &segment, library, &differences, &statistics) {
                    Ok(row) => data.segments.push(row),
                    Err(error) => {
                        *data.left_out.entry(reason(&error)).or_default() += 1;
                    }
                }
            }
            add_wander_to(&mut data.segments[first..], &statistics, model);
            if data.segments.len() > first {
                let gauge =
                    gauges.map(|burn| gauge_row(burn, model, library, &data.segments[first..]));
                let segments = first..data.segments.len();
                data.flights.push(FlightRows { segments, gauge, start_s, share: 1.0 });
            }
        }
        // Learning finds level and scatter itself.
        if !matches!(reference, Reference::Untaught) {
            calibrate(&mut data.flights, reference.baseline().and_then(Baseline::gauges));
        }
        data
    }

    pub(crate) fn row(
        &self,
        model: &EffectModel<'_>,
        kept: &Inside<'_>,
        library: &Library,
        differences: &Differences,
        statistics: &Statistics,
    ) -> Result<SegmentRow, effects::EffectError> {
        let channels = self.channels;
        let deck = &self.predictor.deck;
        let at_thrust = self.predictor.at_learnt_thrust(&kept.response);
        let predict = |response: &Response| self.predictor.predict(response);
        let (recorded, is_recorded) = recorded_channels(&kept.means, channels);
        let predicted = predict(&kept.response);
        let mut residual = [0.0; MAXIMUM_CHANNELS];
        for channel in 0..channels.count() {
            if is_recorded[channel] {
                residual[channel] = recorded[channel] - predicted[channel];
            }
        }
        let noise_model = NoiseModel { model, channels, statistics, predict: &predict };
        let mut noise = noise_model.segment_noise(&kept.known, kept.rows.len(), is_recorded)?;
        // Scatter between flights that the model contains is no gap: it adds to what a flight has in common.
        let scatter = model.applied().map_or(0.0, AppliedEffects::fuel_heating_value_deviation);
        if let Some(heating) = noise.common.get_mut(HEATING_VALUE_LOADING) {
            heating[0] = heating[0].hypot(scatter);
        }
        let mut row = SegmentRow {
            point: kept.point,
            known: kept.known,
            response: kept.response,
            standing_effects: [[0.0; MAXIMUM_CHANNELS]; STANDING_EFFECTS.len()],
            standing_unknown: [false; STANDING_EFFECTS.len()],
            place: kept.place,
            is_recorded,
            residual,
            signatures: vec![],
            noise,
            deck: deck.terms(&at_thrust),
            n2_slope: if channels.n2 { deck.slope(&at_thrust) } else { 0.0 },
            drag_over_thrust: kept.response.drag_over_thrust,
            n2_percent: mean_n2_percent(&kept.means),
            acceleration_deviation_m_s2: statistics.factors.within[0]
                * mean_acceleration_deviation_m_s2(
                    model.aircraft().sensors().acceleration_m_s2,
                    kept.rows.len(),
                ),
            weight: 1.0,
            samples: kept.rows.len(),
            chords: chord_errors(model, &kept.response),
        };
        let untaught = self.predictor.untaught();
        let standing = row.standing_effects.iter_mut().zip(&mut row.standing_unknown);
        for ((slot, unknown), carried) in standing.zip(&differences.standing_effects) {
            match carried.signature(model, &row.known, row.is_recorded, &untaught) {
                Ok(slope) => *slot = slope,
                Err(_) => *unknown = true,
            }
        }
        if let Some(baseline) = self.predictor.baseline {
            for (slope, carried) in row.standing_effects.iter().zip(baseline.standing_effects()) {
                #[expect(clippy::needless_range_loop, reason = "channels of two vectors")]
                for channel in 0..channels.count() {
                    row.residual[channel] -= carried * slope[channel];
                }
            }
        }
        row.signatures = self.signatures(model, &row, library, differences);
        Ok(row)
    }

    /// Signatures of every column of the library at a segment.
    fn signatures(
        &self,
        model: &EffectModel<'_>,
        row: &SegmentRow,
        library: &Library,
        differences: &Differences,
    ) -> Vec<ByChannel> {
        let mut signatures = Vec::with_capacity(library.columns.len());
        // A step is the same whenever it began, and nothing before.
        let mut steps: BTreeMap<StepTarget, ByChannel> = BTreeMap::new();
        for (column, difference) in library.columns.iter().zip(&differences.columns) {
            let step = match column.hidden {
                HiddenParameter::Step { from_s, target } => Some((from_s, target)),
                _ => None,
            };
            if step.is_some_and(|(from_s, _)| row.point.date_s < from_s) {
                signatures.push([0.0; MAXIMUM_CHANNELS]);
                continue;
            }
            if let Some(known) = step.and_then(|(_, target)| steps.get(&target)) {
                signatures.push(*known);
                continue;
            }
            let found = difference.signature(model, &row.known, row.is_recorded, &self.predictor);
            // A segment that lacks the effect's input, or cannot be flown with it, says nothing about it.
            let found = found.unwrap_or([0.0; MAXIMUM_CHANNELS]);
            if let Some((_, target)) = step {
                steps.insert(target, found);
            }
            signatures.push(found);
        }
        signatures
    }

    /// Where N2 is recorded but indicates no thrust near the predicted one: how often.
    fn thrust_by_n2_note(&self, library: &Library) -> Option<Note> {
        let recorded = self.segments.iter().filter(|row| row.n2_percent.is_some()).count();
        let silent = |row: &&SegmentRow| {
            row.n2_percent.is_some() && row.point.corrected_thrust_by_n2_n.is_none()
        };
        let silent = self.segments.iter().filter(silent).count();
        let looked_for = library.effects.iter().any(|e| e.id == EffectId::TsfcThrottle);
        (self.channels.n2 && looked_for && silent > 0)
            .then_some(Note::N2WithoutThrust { silent, recorded })
    }

    /// Where it is not recorded whether bleed is on, and its effect is looked for.
    fn anti_ice_note(&self, library: &Library) -> Option<Note> {
        let of_segments = self.segments.len();
        let segments = self.segments.iter().filter(|row| row.point.anti_ice.is_none()).count();
        let looked_for = library.effects.iter().any(|e| e.id == EffectId::AntiIceBleed);
        (looked_for && segments > 0).then_some(Note::AntiIceByTemperature { segments, of_segments })
    }

    /// What is to be known of what the segments recorded, and of where they lie.
    pub(crate) fn notes(
        &self,
        library: &Library,
        baseline: Option<&Baseline>,
    ) -> impl Iterator<Item = Note> {
        let beyond = baseline.and_then(|baseline| self.beyond_flights_note(baseline));
        [self.thrust_by_n2_note(library), self.anti_ice_note(library), beyond].into_iter().flatten()
    }

    /// Where the flights that taught a baseline did not fly.
    fn beyond_flights_note(&self, baseline: &Baseline) -> Option<Note> {
        let of_segments = self.segments.len();
        let is_beyond = |row: &&SegmentRow| baseline.is_beyond_flights(&row.response);
        let segments = self.segments.iter().filter(is_beyond).count();
        (segments > 0).then_some(Note::BeyondFlights { segments, of_segments })
    }

    /// Values that were recorded in a flight: channels of its segments, and gauges. A channel that is not recorded in a
    /// segment has a row of zeros, which is no value. Values of a segment count by the square of its weight: that much of
    /// their squares is left, and the noise would seem smaller than it is if they counted whole.
    pub(crate) fn recorded_values(&self, flight: &FlightRows) -> f64 {
        let segments = &self.segments[flight.segments.clone()];
        let recorded = |row: &SegmentRow| {
            row.weight.powi(2) * row.is_recorded.iter().filter(|&&is| is).count() as f64
        };
        let gauge = if flight.gauge.is_some() { 1.0 } else { 0.0 };
        segments.iter().map(recorded).sum::<f64>() + gauge
    }

    /// Root mean square of the segments' weights.
    pub(crate) fn mean_weight(&self) -> f64 {
        let square: f64 = self.segments.iter().map(|row| row.weight * row.weight).sum();
        (square / self.segments.len().max(1) as f64).sqrt()
    }

    /// Weighs the segments.
    pub(crate) fn weigh(&mut self, weights: &[f64]) {
        for (row, weight) in self.segments.iter_mut().zip(weights) {
            row.weight = *weight;
        }
    }

    /// Leaves segments out, and flights of which none is left.
    pub(crate) fn leave_out(&mut self, refused: &[bool], reason: LeftOutReason) {
        let mut kept = 0;
        for flight in &mut self.flights {
            let own = refused[flight.segments.clone()].iter().filter(|refused| !**refused).count();
            flight.segments = kept..kept + own;
            kept += own;
        }
        self.flights.retain(|flight| !flight.segments.is_empty());
        *self.left_out.entry(reason).or_default() += self.segments.len() - kept;
        let mut refused = refused.iter();
        self.segments.retain(|_| refused.next() == Some(&false));
    }

    pub(crate) fn columns(&self) -> usize {
        self.segments.first().map_or(0, |row| row.signatures.len())
    }
}

/// Adds what wanders within a flight to the noise of its segments.
pub(crate) fn add_wander_to(
    segments: &mut [SegmentRow],
    statistics: &Statistics,
    model: &EffectModel<'_>,
) {
    let times_s: Vec<f64> = segments.iter().map(|row| row.point.date_s).collect();
    let mut noises: Vec<&mut SegmentNoise> =
        segments.iter_mut().map(|row| &mut row.noise).collect();
    let engines = model.aircraft().engines();
    add_wander(&mut noises, &times_s, statistics, engines);
}

fn channels_of(model: &EffectModel<'_>, inside: &[FlightInside<'_>]) -> Channels {
    let engines = model.aircraft().engines();
    let segments = || inside.iter().flat_map(|(segments, _)| segments);
    let total = segments().count();
    let half = |count: usize| 2 * count > total;
    let split = segments().filter(|kept| kept.means.fuel_flow_engine_kg_s.len() == engines).count();
    let n2 = segments().filter(|kept| has_n2(&kept.means)).count();
    Channels { contrasts: if engines > 1 && half(split) { engines - 1 } else { 0 }, n2: half(n2) }
}

/// The deck that a baseline learnt, else least squares over the data at hand.
fn deck_of(inside: &[FlightInside<'_>], channels: Channels, baseline: Option<&Baseline>) -> Deck {
    if let Some(deck) = baseline.and_then(Baseline::deck) {
        return deck;
    }
    let segments = inside.iter().flat_map(|(segments, _)| segments).filter(|_| channels.n2);
    let recorded: Vec<(&Response, f64)> =
        segments.filter_map(|kept| Some((&kept.response, mean_n2_percent(&kept.means)?))).collect();
    Deck::fitted(&recorded)
}
