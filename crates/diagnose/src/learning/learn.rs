//! From clean flights to a baseline.

use effects::ExtendedModel;
use effects::{EffectModel, EffectReferences};
use faer::Mat;

use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::baseline::{Baseline, Parts};
use crate::learning::moments::GramSums;
use crate::library::Library;
use crate::priors::REMAINDER_QUANTILES;
use crate::residuals::reference::Reference;
use crate::residuals::segments::PreparedFlights;
use crate::signals::noise::NoiseFactors;
use crate::signals::record::FlightRecord;
use crate::signals::references::{DiagnoseError, references_of};
use crate::signals::variables::{Hats, Scaled, Variable};
use crate::thresholds::FEWEST_FLIGHTS_OF_A_BASELINE;

/// Variables of the remainder.
const VARIABLES: [Variable; 6] = [
    Variable::Mach,
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::IsaDeviation,
    Variable::Mass,
];
/// Variables that the remainder may bend along differently at each Mach number: drag rises locally, and so does thrust.
const LOCAL_VARIABLES: [Variable; 3] =
    [Variable::LiftCoefficient, Variable::CorrectedThrust, Variable::PressureAltitude];
/// How often the scatter between flights is raised. Our choice: raising it changes the fit that it is judged by, so that once is
/// not enough.
const INFLATIONS: usize = 3;

impl Baseline {
    /// Learns from clean flights against a model and a drag table (its own, or the adapted one).
    ///
    /// # Errors
    /// [`DiagnoseError`] where the model takes no effects, or fewer than five flights are inside the table.
    pub fn learn(
        model: &ExtendedModel,
        drag_table: &lut::Table,
        flights: &[FlightRecord<'_>],
    ) -> Result<Self, DiagnoseError> {
        let references = references_of(model, drag_table, flights)?;
        let effect_model = EffectModel::new(model, drag_table, references)?;
        let (data, _) = PreparedFlights::prepare(
            &effect_model,
            flights,
            Reference::Untaught,
            |points, engines, starts| {
                Library::new(&effect_model, points, engines, starts, |_| false)
            },
        );
        if data.flights.len() < FEWEST_FLIGHTS_OF_A_BASELINE {
            let found = data.flights.len();
            return Err(DiagnoseError::TooFewFlights {
                found,
                needed: FEWEST_FLIGHTS_OF_A_BASELINE,
            });
        }
        let mut baseline = Self::prior(&data, &references);
        let moments = GramSums::new(&baseline, &data);
        baseline.tune(&moments);
        for _ in 0..INFLATIONS {
            baseline.inflate(&moments);
        }
        baseline.fit(&data, &moments)?;
        Ok(baseline)
    }

    /// The baseline before it has learnt.
    fn prior(data: &PreparedFlights<'_>, references: &EffectReferences) -> Self {
        let values = |variable: Variable| -> Option<Vec<f64>> {
            data.segments
                .iter()
                .map(|row| variable.flown(&row.response, references))
                .map(Some)
                .collect()
        };
        let hats: Vec<_> = VARIABLES
            .into_iter()
            .filter_map(|v| Some((v, Hats::at_quantiles(&values(v)?, &REMAINDER_QUANTILES)?)))
            .collect();
        let mut products = Vec::new();
        for (k, a) in VARIABLES.into_iter().enumerate() {
            for b in VARIABLES.into_iter().skip(k + 1) {
                if let (Some(of_a), Some(of_b)) = (values(a), values(b)) {
                    products.push((a, Scaled::from_values(&of_a), b, Scaled::from_values(&of_b)));
                }
            }
        }
        let local: Vec<(Variable, Scaled)> = LOCAL_VARIABLES
            .into_iter()
            .filter_map(|v| Some((v, Scaled::from_values(&values(v)?))))
            .collect();
        let parts = Parts {
            flights: data.flights.len(),
            segments: data.segments.len(),
            references: *references,
            noise: NoiseFactors::default(),
            scales: [1.0; 2],
            hats,
            products,
            local,
            contrasts: data.channels.contrasts,
            deck_known: data.channels.n2,
            deck_centers: data.predictor.deck.centers,
            deck_coefficients: data.predictor.deck.coefficients.to_vec(),
            mean: Vec::new(),
            factor: Vec::new(),
            standing_effects: vec![0.0; STANDING_EFFECTS.len()],
            rms: f64::NAN,
        };
        let mut baseline = Self { parts, factor: Mat::zeros(0, 0) };
        let layout = baseline.layout();
        baseline.parts.mean = vec![0.0; layout.contrasts.end];
        baseline.factor = Mat::zeros(layout.len(), layout.len());
        baseline
    }
}
