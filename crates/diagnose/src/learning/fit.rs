//! The channels learnt one after the other, and put together into one baseline.

use faer::Mat;

use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::baseline::{Baseline, lower_triangle};
use crate::learning::channel::{LearntChannel, learn_channel};
use crate::learning::correlation::{Left, correlation_factor};
use crate::learning::guide::Guide;
use crate::learning::physical::Physics;
use crate::learning::rows::{ChannelRows, fuel_flow_columns};
use crate::learning::turned::TurnedFlights;
use crate::learning::unseen::factor_by_unseen;
use crate::math::cholesky::Cholesky;
use crate::math::half_spaces::{Doubt, hold};
use crate::residuals::segments::PreparedFlights;
use crate::signals::references::DiagnoseError;
use crate::thresholds::DOUBTFUL_PHYSICS;

/// Share of a variance that is added to it: a covariance that was computed may miss definiteness by rounding.
const ROUNDING: f64 = 1e-9;

/// Mean and covariance of all coefficients, in their prior standard deviations.
pub(super) struct Joint {
    pub(super) mean: Vec<f64>,
    pub(super) covariance: Mat<f64>,
}

impl Baseline {
    /// Learns every channel.
    pub(super) fn fit(
        &mut self,
        data: &PreparedFlights<'_>,
        (physics, guide): (&Physics, &Guide),
    ) -> Result<(), DiagnoseError> {
        let layout = self.layout();
        let width = layout.len();
        let deviations: Vec<f64> = (0..width).map(|column| self.prior_deviation(column)).collect();
        let mut joint = Joint { mean: vec![0.0; width], covariance: Mat::identity(width, width) };

        let (rows, unheld) = ChannelRows::of_fuel_flow(self, data);
        let columns: Vec<usize> = fuel_flow_columns(self).collect();
        let groups: Vec<usize> = columns.iter().map(|&column| self.scale_group(column)).collect();
        let fuel = learn_channel(&rows, &groups, &mut TurnedFlights::default())
            .ok_or(DiagnoseError::Degenerate)?;
        joint.put(&columns, &fuel);
        self.set_noise(0, &fuel);
        let [smooth, products, _] = fuel.posterior.dials.scales;
        self.parts.scales = [smooth, products];
        self.scale_smooth();
        self.parts.outliers = fuel.weights.outliers();
        let smooth = self.parts.scales[0].powi(2);
        let left_out = |row: usize| unheld[row].smooth * smooth + unheld[row].drag;
        self.parts.interval_factor =
            factor_by_unseen(&rows, &fuel.unseen, (&fuel.posterior.dials, &fuel.weights), left_out);

        for at in 1..=layout.contrasts.len() {
            let rows = ChannelRows::of_contrast(&deviations, &layout, data, at);
            let found = learn_channel(&rows, &[0], &mut TurnedFlights::default());
            if let Some(found) = found.filter(|_| !rows.groups.is_empty()) {
                joint.put(&[layout.contrasts.start + at - 1], &found);
                self.set_noise(1, &found);
            }
        }
        if data.channels.n2 {
            let deck = self.fit_deck(data, &mut joint, &deviations, &rows)?;
            let channels = (Left::of(0, &fuel), Left::of(data.channels.n2_row(), &deck));
            self.parts.noise.fuel_flow_with_n2 = correlation_factor(data, channels.0, channels.1);
        }
        guide.hold(self, &mut joint.mean, &mut joint.covariance, &deviations);
        self.hold_to_physics(physics, &mut joint, &deviations);
        self.keep(data, &joint, &deviations)?;
        self.summarize(data, &fuel.left);
        Ok(())
    }

    /// Holds what is in doubt to physics, the deck as far as it follows from it.
    fn hold_to_physics(&mut self, physics: &Physics, joint: &mut Joint, deviations: &[f64]) {
        let slopes = &physics.slopes;
        let rows =
            Mat::from_fn(slopes.nrows(), slopes.ncols(), |k, j| slopes[(k, j)] * deviations[j]);
        let doubt = Doubt { most: DOUBTFUL_PHYSICS, least: -DOUBTFUL_PHYSICS };
        let Joint { mean, covariance } = joint;
        let held = hold(mean, covariance, &rows, &physics.offsets, doubt);
        self.parts.held_to_physics = held.rows.len();
        self.parts.against_physics = held.against;
    }

    /// Which scale multiplies a column's prior standard deviation: 0 none, that of the level, of the force along the path and of
    /// effects whose size physics knows.
    fn scale_group(&self, column: usize) -> usize {
        let layout = self.layout();
        let standing = layout.standing_effects.clone();
        // How far a model is off says nothing of the Earth.
        let is_known = |column: usize| STANDING_EFFECTS[column - standing.start].id.is_known();
        if column == 0 || (standing.contains(&column) && is_known(column)) {
            return 0;
        }
        if !layout.remainder.contains(&column) {
            return 3;
        }
        let mut start = 1;
        for one in &self.parts.smooth {
            if column == start {
                return 3;
            }
            start += one.len();
            if column < start {
                return 1;
            }
        }
        if column < self.products_end() { 2 } else { 0 }
    }

    pub(super) fn set_noise(&mut self, kind: usize, of: &LearntChannel) {
        self.parts.noise.within[kind] = of.posterior.dials.within;
        self.parts.noise.between[kind] = of.posterior.dials.between;
    }

    /// Keeps means and covariance in the units of the coefficients.
    fn keep(
        &mut self,
        data: &PreparedFlights<'_>,
        joint: &Joint,
        deviations: &[f64],
    ) -> Result<(), DiagnoseError> {
        let layout = self.layout();
        let found = |column: usize| joint.mean[column] * deviations[column];
        self.parts.mean = layout.remainder.chain(layout.contrasts).map(found).collect();
        let deck = layout.deck.zip(&data.predictor.deck.coefficients);
        self.parts.deck_coefficients =
            deck.map(|(column, coefficient)| coefficient + found(column)).collect();
        self.parts.standing_effects = layout.standing_effects.map(found).collect();
        self.parts.drag = layout.drag.map(found).collect();
        let width = deviations.len();
        let covariance = Mat::from_fn(width, width, |i, j| {
            let value = joint.covariance[(i, j)] + if i == j { ROUNDING } else { 0.0 };
            value * deviations[i] * deviations[j]
        });
        let lower = Cholesky::new(&covariance).ok_or(DiagnoseError::Degenerate)?;
        self.factor = lower.lower().to_owned();
        self.parts.factor = lower_triangle(&self.factor);
        Ok(())
    }

    /// What is left of the flights that it was learnt from, and what carried effects were worth in them.
    fn summarize(&mut self, data: &PreparedFlights<'_>, left: &[f64]) {
        let count = data.segments.len().max(1) as f64;
        let mut means = vec![0.0; STANDING_EFFECTS.len()];
        let mut squares = vec![0.0; STANDING_EFFECTS.len()];
        for row in &data.segments {
            let carried = row.standing_effects.iter().zip(&self.parts.standing_effects);
            for ((mean, square), (slope, size)) in means.iter_mut().zip(&mut squares).zip(carried) {
                let worth = slope[0] * size;
                *mean += worth / count;
                *square += worth * worth / count;
            }
        }
        let variances = means.iter().zip(&squares).map(|(mean, square)| square - mean * mean);
        self.parts.standing_variances = variances.map(|variance| variance.max(0.0)).collect();
        self.parts.standing_means = means;
        self.parts.rms = (left.iter().map(|value| value * value).sum::<f64>() / count).sqrt();
    }
}

impl Joint {
    /// Puts what a channel says of some columns in place.
    pub(super) fn put(&mut self, columns: &[usize], found: &LearntChannel) {
        for (i, &row) in columns.iter().enumerate() {
            self.mean[row] = found.posterior.mean[i];
            for (j, &column) in columns.iter().enumerate() {
                self.covariance[(row, column)] = found.posterior.covariance[(i, j)];
            }
        }
    }
}
