//! Segments made ready for the search: residuals of every channel, signatures of every column, noise.
//!
//! Everything is linear in the number of segments and lies segment by segment.

use std::borrow::Cow;
use std::collections::BTreeMap;

use effects::{AppliedEffects, EffectModel, EffectPoint, Effects, KnownPoint, Response, Trial};
use flight::effect::{EffectId, HiddenParameter, StepTarget};
use flight::{MAXIMUM_ENGINES, SegmentMeans};
use perf_model::aircraft::{FlightDeviations, FuelFlowWander};
use perf_model::variance::mean_acceleration_deviation_m_s2;

use crate::baseline::Baseline;
use crate::deck::{DECK_TERMS, Deck};
use crate::library::Library;
use crate::noise::{
    ByChannel, Channels, HEATING_LOADING, MAXIMUM_CHANNELS, NoiseFactors, SegmentNoise, Statistics,
    add_wander, segment_noise,
};
use crate::record::FlightRecord;

pub(crate) mod planned;

/// An effect that a baseline carries.
pub(crate) struct Carried {
    pub(crate) id: EffectId,
    hidden: HiddenParameter,
    /// Prior standard deviation of its size over the typical size; 1 is all that physics says where the size is known.
    pub(crate) deviation: f64,
}

/// What a fleet shows at all times and no table over lift coefficient and Mach number, and no smooth remainder, can hold: the
/// Earth and its air, and effects of signals that the remainder does not look at, or that bend faster than a table's cells.
/// Whatever of it a baseline was taught is no change. The first three are what older model files hold.
pub(crate) const ENVIRONMENT: [Carried; 10] = [
    carried(EffectId::LocalGravity, 1.0),
    carried(EffectId::RotatingEarth, 1.0),
    carried(EffectId::IsobaricSlope, 2.0),
    carried(EffectId::LoadFactor, 1.0),
    carried(EffectId::TrimDragCg, 1.0),
    carried(EffectId::AsymmetryDrag, 1.0),
    carried(EffectId::AntiIceBleed, 1.0),
    drag_rise(0.82),
    drag_rise(0.88),
    drag_rise(0.94),
];

const fn carried(id: EffectId, deviation: f64) -> Carried {
    Carried { id, hidden: id.entry().hidden, deviation }
}

const fn drag_rise(drag_divergence_mach: f64) -> Carried {
    let hidden = HiddenParameter::DragDivergenceMach(drag_divergence_mach);
    Carried { id: EffectId::WaveDrag, hidden, deviation: 1.0 }
}

/// One segment.
#[derive(Clone, Debug)]
pub(crate) struct SegmentRow {
    pub(crate) point: EffectPoint,
    /// The same with what most effects leave alone.
    pub(crate) known: KnownPoint,
    /// Prediction without any effect.
    pub(crate) response: Response,
    pub(crate) is_recorded: [bool; MAXIMUM_CHANNELS],
    /// Recorded less predicted.
    pub(crate) residual: ByChannel,
    /// ∂channel/∂θ of each column.
    pub(crate) signatures: Vec<ByChannel>,
    pub(crate) noise: SegmentNoise,
    /// ∂channel/∂θ of the effects that a baseline carries; 0 where an input is not recorded.
    pub(crate) environment: [ByChannel; ENVIRONMENT.len()],
    /// Deck terms at the prediction.
    pub(crate) deck: [f64; DECK_TERMS],
    /// ∂(N2 channel)/∂(ln F).
    pub(crate) n2_slope: f64,
    /// Drag over thrust.
    pub(crate) drag_over_thrust: f64,
    /// Mean N2 of the engines, %, where it is recorded.
    pub(crate) n2_percent: Option<f64>,
    /// Standard deviation of the recorded acceleration, m/s².
    pub(crate) acceleration_deviation_m_s2: f64,
    /// Samples that its means are of.
    pub(crate) samples: usize,
    /// Chord errors of the drag table along lift coefficient and Mach number, relative to drag.
    pub(crate) chords: [f64; 2],
}

/// Gauges against meters, of one flight: residual, standard deviation, signature of each column.
#[derive(Clone, Debug)]
pub(crate) struct GaugeRow {
    pub(crate) residual: f64,
    pub(crate) deviation: f64,
    pub(crate) signatures: Vec<f64>,
}

/// Flights in order, with the range of their segments.
#[derive(Clone, Debug)]
pub(crate) struct FlightRows {
    pub(crate) segments: core::ops::Range<usize>,
    pub(crate) gauge: Option<GaugeRow>,
}

/// What flights are held against, and with it where their noise is known from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Against<'a> {
    /// A table alone: the aircraft file states the noise.
    Table,
    /// A table whose remainder and noise are about to be learnt.
    NothingYet,
    /// A table and what it was taught of clean flights, noise included.
    Baseline(&'a Baseline),
}

impl<'a> Against<'a> {
    /// What was taught, where there is something; else the table.
    pub(crate) fn taught_or_table(baseline: Option<&'a Baseline>) -> Self {
        baseline.map_or(Self::Table, Self::Baseline)
    }

    fn baseline(self) -> Option<&'a Baseline> {
        match self {
            Self::Table | Self::NothingYet => None,
            Self::Baseline(baseline) => Some(baseline),
        }
    }

    fn statistics(self, model: &EffectModel<'_>) -> Statistics {
        let sensors = model.aircraft().sensors();
        let stated = matches!(self, Self::Table);
        Statistics {
            factors: self.baseline().map_or_else(NoiseFactors::default, |b| *b.noise()),
            // What a flight keeps is learnt as a factor on mass, heating value and split, what wanders as one on the rest.
            through_flight: if stated { sensors.through_flight } else { FlightDeviations::none() },
            fuel_flow_wander: if stated {
                sensors.fuel_flow_wander
            } else {
                FuelFlowWander::default()
            },
        }
    }
}

/// Everything ready.
#[derive(Clone, Debug)]
pub(crate) struct Data<'a> {
    pub(crate) channels: Channels,
    pub(crate) predictor: Predictor<'a>,
    pub(crate) flights: Vec<FlightRows>,
    pub(crate) segments: Vec<SegmentRow>,
    /// Segments that were left out, by reason.
    pub(crate) left_out: BTreeMap<String, usize>,
}

/// Contrasts between engines, normalized like ln(Wf1/Wf2): the mean of the first k engines less engine k + 1.
fn contrasts(ln_flows: &[f64], into: &mut [f64]) {
    for (k, slot) in into.iter_mut().enumerate() {
        let first = (k + 1) as f64;
        let mean = ln_flows[..=k].iter().sum::<f64>() / first;
        *slot = (mean - ln_flows[k + 1]) * (2.0 * first / (first + 1.0)).sqrt();
    }
}

/// What turns a response into the prediction of every channel: deck, and what a baseline was taught.
#[derive(Clone, Debug)]
pub(crate) struct Predictor<'a> {
    pub(crate) channels: Channels,
    pub(crate) deck: Deck,
    pub(crate) baseline: Option<&'a Baseline>,
}

impl Predictor<'_> {
    pub(crate) fn predict(&self, response: &Response) -> ByChannel {
        let channels = self.channels;
        let mut predicted = [0.0; MAXIMUM_CHANNELS];
        predicted[0] = response.ln_fuel_flow_total;
        contrasts(&response.ln_fuel_flow_engine, &mut predicted[1..=channels.contrasts]);
        if channels.n2 {
            predicted[channels.n2_row()] = self.deck.value(response);
        }
        if let Some(baseline) = self.baseline {
            predicted[0] += baseline.mean_at(response);
            #[expect(
                clippy::needless_range_loop,
                reason = "a contrast is a channel and a number of the baseline"
            )]
            for contrast in 1..=channels.contrasts.min(baseline.contrasts()) {
                predicted[contrast] += baseline.split_mean(contrast);
            }
        }
        predicted
    }
}

/// A segment that the model can predict, before signatures.
struct Inside<'a> {
    /// Corrected by what the model contains.
    means: Cow<'a, SegmentMeans>,
    rows: &'a [u32],
    point: EffectPoint,
    known: KnownPoint,
    response: Response,
}

impl Inside<'_> {
    /// Says what thrust the recorded N2 stands for.
    fn look_up_n2(&mut self, deck: &Deck) {
        let by_n2_n = mean_n2_percent(&self.means)
            .and_then(|percent| deck.corrected_thrust_n(percent, &self.response));
        self.point.corrected_thrust_by_n2_n = by_n2_n;
        self.known = self.known.with_corrected_thrust_by_n2(by_n2_n);
    }
}

/// Collects what the model can predict, flight by flight.
fn inside<'a>(
    model: &EffectModel<'_>,
    flights: &[FlightRecord<'a>],
    left_out: &mut BTreeMap<String, usize>,
) -> Vec<(Vec<Inside<'a>>, Option<crate::GaugeBurn>)> {
    let engines = model.aircraft().engines();
    let mut all = Vec::with_capacity(flights.len());
    for flight in flights {
        let mut kept = Vec::with_capacity(flight.segments.len());
        for segment in flight.segments {
            let start_s = segment.identity.start_s();
            let found = model.corrected_means(&segment.means).and_then(|means| {
                let point = EffectPoint::from_means(&means, start_s, engines);
                let (known, response) = model.known_point(&point)?;
                Ok(Inside { means, rows: &segment.rows, point, known, response })
            });
            let flow_kg_s = segment.means.fuel_flow_total_kg_s;
            match found {
                Ok(inside) if flow_kg_s.is_finite() && flow_kg_s > 0.0 => kept.push(inside),
                Ok(_) => *left_out.entry("fuel flow not positive".to_owned()).or_default() += 1,
                Err(error) => *left_out.entry(reason(&error).to_owned()).or_default() += 1,
            }
        }
        if !kept.is_empty() {
            all.push((kept, flight.gauges));
        }
    }
    all
}

fn reason(error: &effects::EffectError) -> &'static str {
    use effects::EffectError;
    match error {
        EffectError::OutsideTable { .. } => "outside the drag table",
        EffectError::OutOfDomain(_) => "a mean outside its domain",
        EffectError::ThrustNotPositive { .. } => "no thrust left",
        _ => "not predictable",
    }
}

fn recorded_channels(
    means: &SegmentMeans,
    channels: Channels,
) -> (ByChannel, [bool; MAXIMUM_CHANNELS]) {
    let mut values = [0.0; MAXIMUM_CHANNELS];
    let mut present = [false; MAXIMUM_CHANNELS];
    values[0] = means.fuel_flow_total_kg_s.ln();
    present[0] = true;
    let flows = &means.fuel_flow_engine_kg_s;
    if channels.contrasts > 0
        && flows.len() == channels.contrasts + 1
        && flows.iter().all(|flow| flow.is_finite() && *flow > 0.0)
    {
        let mut ln = [0.0; MAXIMUM_ENGINES];
        for (slot, flow) in ln.iter_mut().zip(flows) {
            *slot = flow.ln();
        }
        contrasts(&ln, &mut values[1..=channels.contrasts]);
        present[1..=channels.contrasts].fill(true);
    }
    if let Some(mean) = mean_n2_percent(means).filter(|_| channels.n2) {
        values[channels.n2_row()] = (mean / 100.0).ln();
        present[channels.n2_row()] = true;
    }
    (values, present)
}

/// Mean N2 of the engines, %, where all are recorded.
pub(crate) fn mean_n2_percent(means: &SegmentMeans) -> Option<f64> {
    has_n2(means).then(|| means.n2_percent.iter().sum::<f64>() / means.n2_percent.len() as f64)
}

fn has_n2(means: &SegmentMeans) -> bool {
    !means.n2_percent.is_empty() && means.n2_percent.iter().all(|n2| n2.is_finite() && *n2 > 1.0)
}

impl<'a> Data<'a> {
    /// Prepares the flights against a model. `effects` are already part of the model (none, as a rule).
    pub(crate) fn prepare(
        model: &EffectModel<'_>,
        flights: &[FlightRecord<'_>],
        against: Against<'a>,
        library_of: impl FnOnce(&[EffectPoint], bool, &[f64]) -> Library,
    ) -> (Self, Library) {
        let mut left_out = BTreeMap::new();
        let mut inside = inside(model, flights, &mut left_out);
        let channels = channels_of(model, &inside);
        let baseline = against.baseline();
        let deck = deck_of(&inside, channels, baseline);
        if channels.n2 {
            for kept in inside.iter_mut().flat_map(|(segments, _)| segments) {
                kept.look_up_n2(&deck);
            }
        }
        let points: Vec<EffectPoint> =
            inside.iter().flat_map(|(segments, _)| segments).map(|kept| kept.point).collect();
        let starts: Vec<f64> =
            inside.iter().map(|(segments, _)| segments[0].point.date_s).collect();
        let library = library_of(&points, channels.contrasts > 0, &starts);
        let statistics = against.statistics(model);

        let mut data = Self {
            channels,
            predictor: Predictor { channels, deck, baseline },
            flights: Vec::with_capacity(inside.len()),
            segments: Vec::with_capacity(points.len()),
            left_out,
        };
        let differences = Differences::of(model, &library, baseline.is_some());
        for (segments, gauges) in inside {
            let first = data.segments.len();
            for segment in segments {
                match data.row(model, &segment, &library, &differences, &statistics) {
                    Ok(row) => data.segments.push(row),
                    Err(error) => {
                        *data.left_out.entry(reason(&error).to_owned()).or_default() += 1;
                    }
                }
            }
            add_wander_to(&mut data.segments[first..], &statistics, model);
            if data.segments.len() > first {
                let gauge =
                    gauges.map(|burn| gauge_row(burn, model, &library, &data.segments[first..]));
                data.flights.push(FlightRows { segments: first..data.segments.len(), gauge });
            }
        }
        (data, library)
    }

    fn row(
        &self,
        model: &EffectModel<'_>,
        kept: &Inside<'_>,
        library: &Library,
        differences: &Differences,
        statistics: &Statistics,
    ) -> Result<SegmentRow, effects::EffectError> {
        let channels = self.channels;
        let deck = &self.predictor.deck;
        let predict = |response: &Response| self.predictor.predict(response);
        let (recorded, is_recorded) = recorded_channels(&kept.means, channels);
        let predicted = predict(&kept.response);
        let mut residual = [0.0; MAXIMUM_CHANNELS];
        for channel in 0..channels.count() {
            if is_recorded[channel] {
                residual[channel] = recorded[channel] - predicted[channel];
            }
        }
        let mut noise = segment_noise(
            model,
            &kept.point,
            &Effects::none(),
            kept.rows,
            0.0,
            is_recorded,
            channels,
            statistics,
            &predict,
        )?;
        // Scatter between flights that the model contains is no gap: it adds to what a flight has in common.
        let scatter = model.applied().map_or(0.0, AppliedEffects::fuel_heating_value_deviation);
        if let Some(heating) = noise.common.get_mut(HEATING_LOADING) {
            heating[0] = heating[0].hypot(scatter);
        }
        let mut row = SegmentRow {
            point: kept.point,
            known: kept.known,
            response: kept.response,
            environment: [[0.0; MAXIMUM_CHANNELS]; ENVIRONMENT.len()],
            is_recorded,
            residual,
            signatures: Vec::with_capacity(library.columns.len()),
            noise,
            deck: deck.terms(&kept.response),
            n2_slope: if channels.n2 { deck.slope(&kept.response) } else { 0.0 },
            drag_over_thrust: kept.response.drag_over_thrust,
            n2_percent: mean_n2_percent(&kept.means),
            acceleration_deviation_m_s2: statistics.factors.within[0]
                * mean_acceleration_deviation_m_s2(
                    model.aircraft().sensors().acceleration_m_s2,
                    kept.rows.len(),
                ),
            samples: kept.rows.len(),
            chords: chord_errors(model, &kept.response),
        };
        for (slot, carried) in row.environment.iter_mut().zip(&differences.environment) {
            *slot = carried
                .signature(model, &row.known, row.is_recorded, &self.predictor)
                .unwrap_or([0.0; MAXIMUM_CHANNELS]);
        }
        if let Some(baseline) = self.predictor.baseline {
            for (slope, carried) in row.environment.iter().zip(baseline.environment()) {
                #[expect(clippy::needless_range_loop, reason = "channels of two vectors")]
                for channel in 0..channels.count() {
                    row.residual[channel] -= carried * slope[channel];
                }
            }
        }
        // A step is the same whenever it began, and nothing before.
        let mut steps: BTreeMap<StepTarget, ByChannel> = BTreeMap::new();
        for (column, difference) in library.columns.iter().zip(&differences.columns) {
            let step = match column.hidden {
                HiddenParameter::Step { from_s, target } => Some((from_s, target)),
                _ => None,
            };
            if step.is_some_and(|(from_s, _)| row.point.date_s < from_s) {
                row.signatures.push([0.0; MAXIMUM_CHANNELS]);
                continue;
            }
            if let Some(known) = step.and_then(|(_, target)| steps.get(&target)) {
                row.signatures.push(*known);
                continue;
            }
            let found = difference.signature(model, &row.known, row.is_recorded, &self.predictor);
            // A segment that lacks the effect's input, or cannot be flown with it, says nothing about it.
            let found = found.unwrap_or([0.0; MAXIMUM_CHANNELS]);
            if let Some((_, target)) = step {
                steps.insert(target, found);
            }
            row.signatures.push(found);
        }
        Ok(row)
    }

    /// Where N2 is recorded but stands for no thrust near the predicted one: how often.
    pub(crate) fn thrust_by_n2_note(&self, library: &Library) -> Option<String> {
        let recorded = self.segments.iter().filter(|row| row.n2_percent.is_some()).count();
        let silent = |row: &&SegmentRow| {
            row.n2_percent.is_some() && row.point.corrected_thrust_by_n2_n.is_none()
        };
        let silent = self.segments.iter().filter(silent).count();
        let looked_for = library.effects.iter().any(|e| e.id == EffectId::TsfcThrottle);
        (self.channels.n2 && looked_for && silent > 0).then(|| {
            format!(
                "N2 of {silent} of {recorded} segments stands for no thrust near the predicted one: \
                 tsfc_throttle is over corrected thrust there"
            )
        })
    }

    pub(crate) fn columns(&self) -> usize {
        self.segments.first().map_or(0, |row| row.signatures.len())
    }
}

/// Central difference of every channel with an effect, made ready for many segments.
pub(crate) struct Difference {
    up: Trial,
    down: Trial,
    /// In the effect's unit.
    step: f64,
}

impl Difference {
    /// About `at`, whose other effects stay.
    pub(crate) fn of(
        model: &EffectModel<'_>,
        at: &Effects,
        id: EffectId,
        hidden: HiddenParameter,
        step: f64,
    ) -> Self {
        let size = at.size(id);
        let trial = |size: f64| model.trial(&at.clone().with(id, size).with_hidden(id, hidden));
        Self { up: trial(size + step), down: trial(size - step), step }
    }

    pub(crate) fn signature(
        &self,
        model: &EffectModel<'_>,
        point: &KnownPoint,
        is_recorded: [bool; MAXIMUM_CHANNELS],
        predictor: &Predictor<'_>,
    ) -> Result<ByChannel, effects::EffectError> {
        let up = predictor.predict(&model.response_at(point, &self.up)?);
        let down = predictor.predict(&model.response_at(point, &self.down)?);
        let mut slope = [0.0; MAXIMUM_CHANNELS];
        for channel in 0..predictor.channels.count() {
            if is_recorded[channel] {
                slope[channel] = (up[channel] - down[channel]) / (2.0 * self.step);
            }
        }
        Ok(slope)
    }
}

/// Adds what wanders within a flight to the noise of its segments.
fn add_wander_to(segments: &mut [SegmentRow], statistics: &Statistics, model: &EffectModel<'_>) {
    let times_s: Vec<f64> = segments.iter().map(|row| row.point.date_s).collect();
    let mut noises: Vec<&mut SegmentNoise> =
        segments.iter_mut().map(|row| &mut row.noise).collect();
    let engines = model.aircraft().engines();
    add_wander(&mut noises, &times_s, statistics.fuel_flow_wander, engines);
}

/// Differences of every column of a library, and of what a baseline carries.
struct Differences {
    columns: Vec<Difference>,
    environment: Vec<Difference>,
}

impl Differences {
    fn of(model: &EffectModel<'_>, library: &Library, has_baseline: bool) -> Self {
        let none = Effects::none();
        let columns = library
            .columns
            .iter()
            .map(|column| {
                let effect = &library.effects[column.effect];
                let hidden = column.hidden;
                Difference::of(model, &none, effect.id, hidden, 0.5 * effect.typical)
            })
            .collect();
        // Only where there is a baseline to carry them, or one to be taught (then there is no library).
        let carries = has_baseline || library.columns.is_empty();
        let environment = ENVIRONMENT
            .iter()
            .filter(|_| carries)
            .map(|carried| {
                let step = 0.5 * model.references().typical_size(carried.id);
                Difference::of(model, &none, carried.id, carried.hidden, step)
            })
            .collect();
        Self { columns, environment }
    }
}

fn channels_of(
    model: &EffectModel<'_>,
    inside: &[(Vec<Inside<'_>>, Option<crate::GaugeBurn>)],
) -> Channels {
    let engines = model.aircraft().engines();
    let segments = || inside.iter().flat_map(|(segments, _)| segments);
    let total = segments().count();
    let half = |count: usize| 2 * count > total;
    let split = segments().filter(|kept| kept.means.fuel_flow_engine_kg_s.len() == engines).count();
    let n2 = segments().filter(|kept| has_n2(&kept.means)).count();
    Channels { contrasts: if engines > 1 && half(split) { engines - 1 } else { 0 }, n2: half(n2) }
}

/// The deck that a baseline learnt, else least squares over the data at hand.
fn deck_of(
    inside: &[(Vec<Inside<'_>>, Option<crate::GaugeBurn>)],
    channels: Channels,
    baseline: Option<&Baseline>,
) -> Deck {
    if let Some(deck) = baseline.and_then(Baseline::deck) {
        return deck;
    }
    let segments = inside.iter().flat_map(|(segments, _)| segments).filter(|_| channels.n2);
    let recorded: Vec<(&Response, f64)> =
        segments.filter_map(|kept| Some((&kept.response, mean_n2_percent(&kept.means)?))).collect();
    Deck::fitted(&recorded)
}

fn gauge_row(
    burn: crate::GaugeBurn,
    model: &EffectModel<'_>,
    library: &Library,
    segments: &[SegmentRow],
) -> GaugeRow {
    let count = segments.len().max(1) as f64;
    // Meter errors that the model contains are undone here as they are in the segments' fuel flow.
    let metered_too_much: f64 =
        segments.iter().map(|row| model.metered_over_burnt(&row.point).ln()).sum::<f64>() / count;
    let share = |engine: u8| {
        let index = usize::from(engine).wrapping_sub(1);
        segments
            .iter()
            .map(|row| row.point.fuel_flow_share.get(index).copied().unwrap_or(0.0))
            .sum::<f64>()
            / count
    };
    let signatures = library
        .columns
        .iter()
        .map(|column| match library.effects[column.effect].id {
            EffectId::FuelFlowGain => -0.01,
            EffectId::FuelFlowGainEngine(engine) => -0.01 * share(engine),
            _ => 0.0,
        })
        .collect();
    GaugeRow {
        residual: (burn.gauged_kg / burn.metered_kg).ln() + metered_too_much,
        deviation: (burn.deviation_kg / burn.metered_kg).max(1e-6),
        signatures,
    }
}

/// How far a chord of the drag table may be off, relative to drag: ½·u(1 − u)·Δ², Δ² the mean of the second differences
/// at the cell's ends, along each axis. `[diagnosis.15]`
fn chord_errors(model: &EffectModel<'_>, response: &Response) -> [f64; 2] {
    let table = model.drag_table();
    let grid = table.grid();
    let Ok(cell) = grid.locate(response.lift_coefficient, response.mach, lut::Outside::Hold) else {
        return [0.0; 2];
    };
    let drag = table.interpolate(&cell);
    let [low, _, _, _] = cell.nodes();
    let (columns, rows) = (grid.y().len(), grid.x().len());
    let (i, j) = (low / columns, low % columns);
    let value = |i: usize, j: usize| table.value_at_node(i * columns + j);
    let second = |at: usize, of: usize, get: &dyn Fn(usize) -> f64| {
        if at == 0 || at + 1 >= of { None } else { Some(get(at - 1) - 2.0 * get(at) + get(at + 1)) }
    };
    let mean = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => 0.0,
    };
    let (u, v) = cell.local();
    let along_lift = mean(
        second(i, rows, &|k| value(k, j) * (1.0 - v) + value(k, j + 1) * v),
        second(i + 1, rows, &|k| value(k, j) * (1.0 - v) + value(k, j + 1) * v),
    );
    let along_mach = mean(
        second(j, columns, &|k| value(i, k) * (1.0 - u) + value(i + 1, k) * u),
        second(j + 1, columns, &|k| value(i, k) * (1.0 - u) + value(i + 1, k) * u),
    );
    [-0.5 * u * (1.0 - u) * along_lift / drag, -0.5 * v * (1.0 - v) * along_mach / drag]
}
