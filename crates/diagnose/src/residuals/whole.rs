//! Predictions of a model with everything that it has learnt: drag table, remainder, effects that its fleet shows at all times.

use effects::{
    BetweenNodes, EffectError, EffectModel, EffectPoint, Effects, ExtendedModel, KnownPoint,
    Response,
};
use flight::Segment;
use perf_model::FlightPoint;

use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::baseline::{Baseline, LeftOfSmooth};
use crate::residuals::level::WholeModelOfLevels;
use crate::residuals::predictor::Predictor;
use crate::residuals::reference::Reference;
use crate::residuals::signatures::Difference;
use crate::residuals::whole::places::Places;
use crate::signals::channels::{ByChannel, Channels, MAXIMUM_CHANNELS};
use crate::signals::n2_deck::Deck;
use crate::signals::noise::{NoiseModel, Statistics};
use crate::signals::references::DiagnoseError;
use crate::signals::wander::add_wander;

mod mean;
mod places;

/// Samples of the segment that an interval at a flight point is of.
const SAMPLES_OF_A_SEGMENT: usize = 10;

/// A model with everything that it has learnt. Predictions are ln fuel flow.
#[derive(Debug)]
pub struct WholeModel<'a> {
    extended: &'a ExtendedModel,
    model: EffectModel<'a>,
    /// The same with a bilinear drag table, as everything but what was learnt takes it.
    bilinear: EffectModel<'a>,
    /// The same with a smooth one.
    smooth: EffectModel<'a>,
    baseline: &'a Baseline,
    predictor: Predictor<'a>,
    statistics: Statistics,
    standing: Vec<Difference>,
}

/// A prediction of the whole model at a segment or flight point.
#[derive(Clone, Debug, PartialEq)]
pub struct WholePrediction {
    /// ln of the fuel flow of all engines, kg/s.
    pub ln_fuel_flow: f64,
    /// How it leans on what was learnt, in standard deviations: predictions of one model err together.
    pub loadings: Vec<f64>,
    /// Variance of the model there that is not in the loadings: where nothing was flown.
    pub unflown: f64,
    /// What of it is another from place to place.
    pub(crate) places: Places,
    /// Variance of what all segments of a flight have in common.
    pub of_flight: f64,
    /// Variance of what a segment has of its own.
    pub of_segment: f64,
    /// Whether Mach number, lift coefficient, pressure altitude, corrected thrust, deviation from the ISA or mass lies beyond all
    /// that the flights which taught the model flew: what it says there continues what they showed, with a variance that grows.
    pub beyond_flights: bool,
}

/// What the whole model believes of the fuel flow at a flight point, its drag table and what was learnt of it smooth between the
/// nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothPrediction {
    /// ln of the fuel flow of all engines, kg/s.
    pub ln_fuel_flow: f64,
    /// How it leans on what was learnt, in standard deviations: predictions of one model err together.
    pub loadings: Vec<f64>,
    /// Variance of the model there that is not in the loadings: where nothing was flown.
    pub unflown: f64,
}

impl WholePrediction {
    /// Variance of the model there.
    #[must_use]
    pub fn of_model(&self) -> f64 {
        self.unflown + self.loadings.iter().map(|loading| loading * loading).sum::<f64>()
    }

    /// Variance of ln fuel flow that a new segment of a new flight would show.
    #[must_use]
    pub fn variance(&self) -> f64 {
        self.of_model() + self.of_flight + self.of_segment
    }
}

impl<'a> WholeModel<'a> {
    /// The model from which a baseline was learnt, with it.
    ///
    /// # Errors
    /// [`DiagnoseError`] where the model takes no effects.
    pub fn new(extended: &'a ExtendedModel, baseline: &'a Baseline) -> Result<Self, DiagnoseError> {
        let references = *baseline.references();
        let bilinear = EffectModel::new(extended, extended.drag_table(), references)?;
        let model = bilinear.clone().between_nodes(baseline.between_nodes());
        let smooth = bilinear.clone().between_nodes(BetweenNodes::Smooth);
        let channels = Channels { contrasts: 0, n2: false };
        let deck = baseline.deck().unwrap_or_else(|| Deck::fitted(&[]));
        let reference = Reference::from_baseline(Some(baseline));
        let statistics = reference.statistics(&model);
        let standing = STANDING_EFFECTS
            .iter()
            .map(|effect| {
                let step = 0.5 * references.typical_size(effect.id);
                Difference::new(&model, &Effects::none(), effect.id, effect.hidden, step)
            })
            .collect();
        let predictor = Predictor { channels, deck, baseline: Some(baseline) };
        Ok(Self { extended, model, bilinear, smooth, baseline, predictor, statistics, standing })
    }

    /// The prediction for a recorded segment, acceleration and all; recordings are corrected by what the model contains.
    ///
    /// # Errors
    /// [`EffectError`] for a segment outside the table or a domain.
    pub fn of_segment(&self, segment: &Segment) -> Result<WholePrediction, EffectError> {
        let means = self.model.corrected_means(&segment.means)?;
        let engines = self.model.aircraft().engines();
        let point = EffectPoint::from_means(&means, segment.identity.start_s(), engines);
        self.at(&point, segment.rows.len())
    }

    /// The mean alone of [`of_segment`](Self::of_segment), to the same bits at a fraction of its cost.
    ///
    /// # Errors
    /// As there.
    pub fn ln_fuel_flow_of_segment(&self, segment: &Segment) -> Result<f64, EffectError> {
        let means = self.model.corrected_means(&segment.means)?;
        let engines = self.model.aircraft().engines();
        let point = EffectPoint::from_means(&means, segment.identity.start_s(), engines);
        let (known, response) = self.model.known_point(&point)?;
        let carried = self.carried(&self.model, &point, &known).mean;
        Ok(self.predictor.predict(&response)[0] + carried)
    }

    /// Number of loadings of a prediction.
    #[must_use]
    pub fn directions(&self) -> usize {
        self.baseline.factor().ncols()
    }

    /// The same model for many flight points of which mass, level, Mach number and temperature alone are known; `None` where it
    /// needs more than these.
    #[must_use]
    pub fn of_levels(&self) -> Option<WholeModelOfLevels> {
        WholeModelOfLevels::new(&self.model, self.baseline, SAMPLES_OF_A_SEGMENT)
    }

    /// What the effects that the fleet shows at all times make of ln fuel flow.
    fn carried(&self, model: &EffectModel<'_>, point: &EffectPoint, known: &KnownPoint) -> Carried {
        let mut recorded = [false; MAXIMUM_CHANNELS];
        recorded[0] = true;
        let untaught = self.predictor.untaught();
        let mut carried =
            Carried { mean: 0.0, slopes: [0.0; STANDING_EFFECTS.len()], unknown: 0.0 };
        for (k, effect) in STANDING_EFFECTS.iter().enumerate() {
            let size = self.baseline.standing_effects()[k];
            // As they were learnt: by their slopes.
            let slope = if effect.lacks_input(point) {
                None
            } else {
                let found = self.standing[k].signature(model, known, recorded, &untaught);
                found.ok().map(|slope| slope[0])
            };
            let parts = &self.baseline.parts;
            if let Some(slope) = slope {
                carried.mean += slope * size;
                carried.slopes[k] = slope;
            } else {
                // As on average over the flights that it was learnt from, and as different from that as they were.
                carried.mean += parts.standing_means[k];
                carried.unknown += parts.standing_variances.get(k).copied().unwrap_or(0.0);
            }
        }
        carried
    }

    /// The prediction for a flight point: level, without acceleration. Carried effects whose input the point lacks are as on
    /// average over the flights that taught the model.
    ///
    /// # Errors
    /// [`EffectError`] for a point outside the table or a domain.
    pub fn of_point(&self, point: &FlightPoint) -> Result<WholePrediction, EffectError> {
        let at = self.dated(point)?;
        let mut found = self.at(&at, SAMPLES_OF_A_SEGMENT)?;
        found.ln_fuel_flow += self.undated(point, &at)?;
        Ok(found)
    }

    /// What is believed of a flight point, as in [`of_point`](Self::of_point), with a drag table that is smooth between its nodes, and
    /// what was learnt of it too: for optima, which a bilinear surface has on its grid lines.
    ///
    /// # Errors
    /// As there.
    pub fn smooth_of_point(&self, point: &FlightPoint) -> Result<SmoothPrediction, EffectError> {
        let at = self.dated(point)?;
        let found = self.believed(&at, Tables::Smooth)?;
        Ok(SmoothPrediction {
            ln_fuel_flow: found.ln_fuel_flow + self.undated(point, &at)?,
            loadings: found.loadings,
            unflown: found.unflown,
        })
    }

    /// A flight point at its date, or else at the mean date of what was learnt.
    fn dated(&self, point: &FlightPoint) -> Result<EffectPoint, EffectError> {
        let mut at = EffectPoint::from_flight_point(point, self.model.aircraft().engines())?;
        if point.date.is_none() {
            at.date_s = self.baseline.references().date_s;
        }
        Ok(at)
    }

    /// What effects that the model contains make of ln fuel flow without a date, beyond what they make of it at a date.
    fn undated(&self, point: &FlightPoint, at: &EffectPoint) -> Result<f64, EffectError> {
        let of_table = self.extended.response(point)?;
        let (_, dated) = self.bilinear.known_point(at)?;
        Ok(of_table.ln_fuel_flow_total - dated.ln_fuel_flow_total)
    }

    fn at(&self, point: &EffectPoint, samples: usize) -> Result<WholePrediction, EffectError> {
        let found = self.believed(point, Tables::OfPredictions)?;
        let baseline = self.baseline;
        let predict = |response: &Response| self.predictor.predict(response);
        let mut recorded = [false; MAXIMUM_CHANNELS];
        recorded[0] = true;
        let stated = baseline.interval_factor();
        let mut noise = NoiseModel {
            model: &self.model,
            channels: self.predictor.channels,
            statistics: &self.statistics,
            predict: &predict,
        }
        .segment_noise(&found.known, samples, recorded)?;
        let engines = self.model.aircraft().engines();
        add_wander(&mut [&mut noise], &[0.0], &self.statistics, engines);
        let square = |values: &ByChannel| values[0] * values[0];
        Ok(WholePrediction {
            ln_fuel_flow: found.ln_fuel_flow,
            loadings: found.loadings,
            unflown: found.unflown,
            places: Places::new(baseline, &found.response, found.left),
            of_flight: stated * stated * noise.common.iter().map(square).sum::<f64>()
                + found.carried_unknown,
            of_segment: stated * stated * square(&noise.factor[0]),
            beyond_flights: baseline.is_beyond_flights(&found.response),
        })
    }

    /// What is believed of a point: by the tables of all predictions, in which what was learnt is bilinear between the nodes, or by
    /// smooth ones.
    fn believed(&self, point: &EffectPoint, tables: Tables) -> Result<Believed, EffectError> {
        let model = match tables {
            Tables::OfPredictions => &self.model,
            Tables::Smooth => &self.smooth,
        };
        let (known, response) = model.known_point(point)?;
        let baseline = self.baseline;
        let layout = baseline.layout();
        let mut mean = self.predictor.predict(&response)[0];
        let mut raw = vec![0.0; layout.len()];
        let left = baseline.write_remainder(&response, &mut raw[layout.remainder.clone()]);
        let mut unflown = left.total();
        let drag = &mut raw[layout.drag.clone()];
        match tables {
            Tables::OfPredictions => baseline.write_drag(&response, drag),
            Tables::Smooth => {
                baseline.write_smooth_drag(&response, drag);
                let smooth: f64 = drag.iter().zip(&baseline.parts.drag).map(|(l, m)| l * m).sum();
                mean += response.drag_over_thrust * smooth - baseline.drag_at(&response);
            }
        }
        for loading in drag {
            *loading *= response.drag_over_thrust;
        }
        let thrust_square = response.drag_over_thrust * response.drag_over_thrust;
        unflown += baseline.table.as_ref().map_or(0.0, |t| thrust_square * t.left_out(&response));
        let carried = self.carried(model, point, &known);
        raw[layout.standing_effects].copy_from_slice(&carried.slopes);
        let factor = baseline.factor();
        let stated = baseline.interval_factor();
        let loadings = (0..factor.ncols())
            .map(|column| {
                let values = &factor.col_as_slice(column)[column..];
                let sum: f64 = values.iter().zip(&raw[column..]).map(|(l, raw)| l * raw).sum();
                stated * sum
            })
            .collect();
        Ok(Believed {
            ln_fuel_flow: mean + carried.mean,
            loadings,
            unflown: stated * stated * unflown,
            left,
            carried_unknown: carried.unknown,
            known,
            response,
        })
    }
}

/// How the drag table and what was learnt of it are between the nodes.
#[derive(Clone, Copy)]
enum Tables {
    /// As they were learnt.
    OfPredictions,
    /// Smooth.
    Smooth,
}

/// What is believed of a point, but for the noise of a segment.
struct Believed {
    ln_fuel_flow: f64,
    loadings: Vec<f64>,
    unflown: f64,
    left: LeftOfSmooth,
    carried_unknown: f64,
    known: KnownPoint,
    response: Response,
}

/// What the effects that a fleet shows at all times make of ln fuel flow at a point.
struct Carried {
    mean: f64,
    /// Slopes along their sizes; 0 where an input lacks.
    slopes: [f64; STANDING_EFFECTS.len()],
    /// Variance by the inputs that lack.
    unknown: f64,
}
