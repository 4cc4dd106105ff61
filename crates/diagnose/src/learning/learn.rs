//! From clean flights to a baseline.

use effects::{BetweenNodes, EffectModel, EffectReferences, ExtendedModel, Variable};
use faer::Mat;
use units::convert::SECONDS_PER_DAY;

use crate::baseline::smooth::Smooth;
use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::baseline::{Baseline, BaselineRecord};
use crate::learning::guide::Guide;
use crate::learning::physical::Physics;
use crate::library::Library;
use crate::library::dates::DateGrid;
use crate::priors::REMAINDER_LENGTHS;
use crate::residuals::gauges::level_of;
use crate::residuals::reference::Reference;
use crate::residuals::rows::{FlightRows, SegmentRow};
use crate::residuals::segments::PreparedFlights;
use crate::signals::noise::NoiseFactors;
use crate::signals::record::FlightRecord;
use crate::signals::references::{DiagnoseError, references_of};
use crate::signals::table_uncertainty::TableUncertainty;
use crate::signals::variables::flown;

/// Least share of a flight that counts. Our choice: nothing, and no division by zero.
const LEAST_SHARE: f64 = 1e-9;

/// Variables of the remainder, in the order of their lengths.
const VARIABLES: [Variable; 6] = [
    Variable::Mach,
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::IsaDeviation,
    Variable::Mass,
];

impl Baseline {
    /// Learns from clean flights against a model and a drag table. `table` is what is believed of that table before the
    /// flights; without it the table is taken as exact. With a half-life a flight counts by its age at the newest one,
    /// 2^(−age/half-life).
    ///
    /// # Errors
    /// [`DiagnoseError`] where the model takes no effects, or no flight is inside the table.
    pub fn learn(
        model: &ExtendedModel,
        drag_table: &lut::Table,
        table: Option<TableUncertainty>,
        flights: &[FlightRecord<'_>],
        half_life_days: Option<f64>,
    ) -> Result<Self, DiagnoseError> {
        let (baseline, _) = Self::learnt(model, drag_table, table, flights, half_life_days)?;
        Ok(baseline)
    }

    /// The same with ln of the fuel flow, kg/s, that the model with all of it predicts for each segment, in the order of flights:
    /// the bits of [`WholeModel::ln_fuel_flow_of_segment`](crate::WholeModel::ln_fuel_flow_of_segment) at a fraction of its cost,
    /// because learning has looked at every segment already. `None` of those that were left out.
    ///
    /// # Errors
    /// As for [`learn`](Self::learn).
    pub fn learn_and_predict(
        model: &ExtendedModel,
        drag_table: &lut::Table,
        table: Option<TableUncertainty>,
        flights: &[FlightRecord<'_>],
        half_life_days: Option<f64>,
    ) -> Result<(Self, Vec<Option<f64>>), DiagnoseError> {
        let (baseline, rows) = Self::learnt(model, drag_table, table, flights, half_life_days)?;
        let mut predicted = vec![None; flights.iter().map(|flight| flight.segments.len()).sum()];
        for row in &rows {
            predicted[row.place] = Some(baseline.ln_fuel_flow_of(row));
        }
        Ok((baseline, predicted))
    }

    /// What the model with all of it predicts for a segment that it was learnt from: ln of fuel flow.
    fn ln_fuel_flow_of(&self, row: &SegmentRow) -> f64 {
        let mut carried = 0.0;
        for (k, effect) in STANDING_EFFECTS.iter().enumerate() {
            let lacks = row.standing_unknown[k] || effect.lacks_input(&row.point);
            carried += if lacks {
                self.parts.standing_means[k]
            } else {
                row.standing_effects[k][0] * self.parts.standing_effects[k]
            };
        }
        let learnt = self.drag_at(&row.response) + self.mean_at(&row.response);
        row.response.ln_fuel_flow_total + learnt + carried
    }

    fn learnt(
        model: &ExtendedModel,
        drag_table: &lut::Table,
        table: Option<TableUncertainty>,
        flights: &[FlightRecord<'_>],
        half_life_days: Option<f64>,
    ) -> Result<(Self, Vec<SegmentRow>), DiagnoseError> {
        let references = references_of(model, drag_table, flights)?;
        let effect_model =
            EffectModel::new(model, drag_table, references)?.between_nodes(BetweenNodes::Smooth);
        let (mut data, _) = PreparedFlights::prepare(
            &effect_model,
            flights,
            Reference::Untaught,
            |points, engines, starts| {
                Library::new(
                    &effect_model,
                    points,
                    engines,
                    DateGrid::coarse(starts, &[], None),
                    |_| false,
                )
            },
        );
        if data.flights.is_empty() {
            return Err(DiagnoseError::NoFlights);
        }
        count_by_age(&mut data.flights, half_life_days);
        let mut baseline = Self::prior(&data, &references, table);
        let physics = Physics::of(&effect_model, &baseline, &data);
        let guide = Guide::of(&effect_model, &baseline, &data, model.extrapolated());
        baseline.set_reach_of_guide(guide.reaches());
        baseline.fit(&data, (&physics, &guide))?;
        Ok((baseline, data.segments))
    }

    /// The baseline before it has learnt.
    fn prior(
        data: &PreparedFlights<'_>,
        references: &EffectReferences,
        table: Option<TableUncertainty>,
    ) -> Self {
        let rank = table.as_ref().map_or(0, TableUncertainty::rank);
        let parts = BaselineRecord {
            flights: data.flights.len(),
            segments: data.segments.len(),
            references: *references,
            noise: NoiseFactors::default(),
            scales: [1.0; 2],
            smooth: smooth_functions(data, references),
            contrasts: data.channels.contrasts,
            deck_known: data.channels.n2,
            deck_centers: data.predictor.deck.centers,
            deck_coefficients: data.predictor.deck.coefficients.to_vec(),
            mean: Vec::new(),
            drag_nodes: table.as_ref().map_or_else(Vec::new, |table| table.pivots().to_vec()),
            drag: vec![0.0; rank],
            factor: Vec::new(),
            standing_effects: vec![0.0; STANDING_EFFECTS.len()],
            standing_means: vec![0.0; STANDING_EFFECTS.len()],
            standing_variances: Vec::new(),
            smooth_table: true,
            path_force: true,
            thrust_share: 0.0,
            outliers: 0,
            held_to_physics: 0,
            against_physics: 0,
            interval_factor: 1.0,
            rms: f64::NAN,
            gauges: level_of(&data.flights),
        };
        let mut baseline = Self { parts, table, factor: Mat::zeros(0, 0), of_another: false };
        let layout = baseline.layout();
        baseline.parts.mean = vec![0.0; layout.contrasts.end];
        baseline.factor = Mat::zeros(layout.len(), layout.len());
        baseline
    }
}

/// What counts of every flight.
fn count_by_age(flights: &mut [FlightRows], half_life_days: Option<f64>) {
    let Some(days) = half_life_days else { return };
    let newest = flights.iter().map(|flight| flight.start_s).fold(f64::NEG_INFINITY, f64::max);
    for flight in flights {
        let age_days = (newest - flight.start_s) / SECONDS_PER_DAY;
        flight.share = (-age_days / days).exp2().max(LEAST_SHARE);
    }
}

/// One for every variable that differs among the segments.
fn smooth_functions(data: &PreparedFlights<'_>, references: &EffectReferences) -> Vec<Smooth> {
    let of = |(variable, length): (Variable, f64)| {
        let values: Vec<f64> =
            data.segments.iter().map(|row| flown(variable, &row.response, references)).collect();
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let length = if variable == Variable::Mass { length * mean } else { length };
        Smooth::over(variable, length, &values)
    };
    VARIABLES.into_iter().zip(REMAINDER_LENGTHS).filter_map(of).collect()
}
