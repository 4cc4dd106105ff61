//! How a baseline learns: noise and sizes by marginal likelihood, scatter between flights by flights left out, then the
//! posterior. All of it on [`GramSums`]; the flights themselves are looked at once.

use std::collections::BTreeMap;

use faer::Mat;

use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::baseline::{Baseline, lower_triangle};
use crate::learning::moments::{CoupledChannels, GramSums, KINDS, LeftOut};
use crate::math::cholesky::Cholesky;
use crate::priors::{
    DIAL_LIMITS, REMAINDER_SCALE_LN_DEVIATION, USUAL_NOISE, USUAL_NOISE_LN_DEVIATION,
};
use crate::residuals::segments::PreparedFlights;
use crate::signals::noise::NoiseFactors;
use crate::signals::references::DiagnoseError;
use crate::thresholds::LEARNING_FOLDS;

/// Rounds over all hyperparameters, the first of them coarse.
const ROUNDS: usize = 12;
/// Rounds of coarse steps. Our choice: a bound on time.
const COARSE_ROUNDS: usize = 4;
/// Factor of a coarse step. Our choice: five steps are a factor of about ten.
const COARSE_STEP: f64 = 1.6;
/// Factor of a fine step. Our choice: noise need not be known better than to a tenth.
const FINE_STEP: f64 = 1.1;
/// Hyperparameters: noise within flights and between flights of three kinds of channels, sizes of hat functions and of products.
const HYPERPARAMETERS: usize = 8;

/// Where the search is on its grid: for each hyperparameter the number of coarse and of fine steps from its start. Equal
/// positions are equal values, so that likelihoods can be cached by position.
type GridPosition = [(i32, i32); HYPERPARAMETERS];

/// What the search has computed of one part already.
#[derive(Default)]
struct LikelihoodCache {
    /// ln of the marginal likelihood by position; hyperparameters that the part does not feel are 0.
    likelihoods: BTreeMap<GridPosition, f64>,
    /// The Gram matrix formed last, with Σ `ln|C_f|`, and the position of its noise.
    gram: Option<(GridPosition, Mat<f64>, f64)>,
}

impl Baseline {
    /// Noise factors and sizes of the remainder by marginal likelihood: what is left of a flexible remainder is no measure
    /// of the noise, because the remainder has eaten part of it.
    pub(super) fn tune(&mut self, moments: &GramSums) {
        let mut known: Vec<LikelihoodCache> =
            moments.parts.iter().map(|_| LikelihoodCache::default()).collect();
        let mut position = [(0, 0); HYPERPARAMETERS];
        let mut best = self.ln_marginal(moments, &position, &mut known);
        let live: [bool; HYPERPARAMETERS] = core::array::from_fn(|hyperparameter| {
            hyperparameter >= 2 * KINDS
                || moments.parts.iter().any(|part| part.kinds[hyperparameter % KINDS])
        });
        for round in 0..ROUNDS {
            let coarse = round < COARSE_ROUNDS;
            let mut moved = false;
            for hyperparameter in
                (0..HYPERPARAMETERS).filter(|&hyperparameter| live[hyperparameter])
            {
                for up in [true, false] {
                    let by = if coarse { COARSE_STEP } else { FINE_STEP };
                    let by = if up { by } else { 1.0 / by };
                    loop {
                        let mut next = position;
                        let slot = if coarse {
                            &mut next[hyperparameter].0
                        } else {
                            &mut next[hyperparameter].1
                        };
                        *slot += if up { 1 } else { -1 };
                        let before = (self.parts.noise, self.parts.scales);
                        if !self.scale(hyperparameter, by) {
                            break;
                        }
                        let found = self.ln_marginal(moments, &next, &mut known);
                        if found > best + 1e-3 {
                            (best, position, moved) = (found, next, true);
                        } else {
                            (self.parts.noise, self.parts.scales) = before;
                            break;
                        }
                    }
                }
            }
            if !moved && round >= COARSE_ROUNDS {
                break;
            }
        }
    }

    /// Scales a hyperparameter, unless that leaves its limits.
    fn scale(&mut self, hyperparameter: usize, by: f64) -> bool {
        let value = match hyperparameter {
            0..3 => &mut self.parts.noise.within[hyperparameter],
            3..6 => &mut self.parts.noise.between[hyperparameter - 3],
            _ => &mut self.parts.scales[hyperparameter - 6],
        };
        let scaled = *value * by;
        let (low, high) = DIAL_LIMITS;
        let inside = scaled >= low && scaled <= high;
        if inside {
            *value = scaled;
        }
        inside
    }

    /// Raises the scatter between flights to what flights show that were not learnt from.
    ///
    /// A remainder that fits the flights it has seen says too little about the next one. For flights left out by folds, the
    /// mean residual must be as large as announced:
    ///
    /// ```text
    /// Σ_f e_f²/(v_model + v_within + κ² v_between) = number of flights
    /// ```
    pub(super) fn inflate(&mut self, moments: &GramSums) {
        let mut errors: [Vec<[f64; 3]>; KINDS] = [vec![], vec![], vec![]]; // squared error, known variance, between
        let all = moments.gram(&self.parts.noise, None);
        for fold in 0..LEARNING_FOLDS {
            let judged: Vec<&LeftOut> =
                moments.left_out.iter().filter(|flight| flight.fold == fold).collect();
            if judged.is_empty() {
                continue;
            }
            let others = &all - moments.gram(&self.parts.noise, Some(fold));
            let Some((solution, factor)) = self.posterior(&others) else { return };
            let width = self.factor.nrows();
            let mut loadings =
                Mat::from_fn(width, judged.len(), |k, flight| judged[flight].loading[k]);
            let expected = loadings.transpose() * &solution;
            factor.solve_lower(&mut loadings);
            for (k, flight) in judged.into_iter().enumerate() {
                let error = flight.residual - expected[(k, 0)];
                let of_model: f64 =
                    loadings.col_as_slice(k).iter().map(|value| value * value).sum();
                let (within, between) =
                    (self.parts.noise.within[flight.kind], self.parts.noise.between[flight.kind]);
                errors[flight.kind].push([
                    error * error,
                    within * within * flight.within + of_model,
                    between * between * flight.between,
                ]);
            }
        }
        let (low, high) = DIAL_LIMITS;
        for (kind, errors) in errors.iter().enumerate() {
            if errors.is_empty() {
                continue;
            }
            let excess = |factor: f64| {
                errors
                    .iter()
                    .map(|[square, known, between]| square / (known + factor * factor * between))
                    .sum::<f64>()
                    - errors.len() as f64
            };
            let now = self.parts.noise.between[kind];
            if excess(1.0) <= 0.0 {
                continue;
            }
            let (mut below, mut above) = (1.0, high / now);
            for _ in 0..60 {
                let middle = f64::midpoint(below, above);
                if excess(middle) > 0.0 { below = middle } else { above = middle }
            }
            self.parts.noise.between[kind] = (now * above).clamp(low, high);
        }
    }

    /// Coefficients and precision factor from a Gram matrix and the prior.
    pub(super) fn posterior(&self, gram: &Mat<f64>) -> Option<(Mat<f64>, Cholesky)> {
        let width = self.factor.nrows();
        let mut precision = gram.submatrix(0, 0, width, width).to_owned();
        for k in 0..width {
            let deviation = self.prior_deviation(k);
            precision[(k, k)] += 1.0 / (deviation * deviation);
        }
        let factor = Cholesky::new(&precision)?;
        let mut solution = Mat::from_fn(width, 1, |i, _| gram[(i, width)]);
        factor.solve(&mut solution);
        Some((solution, factor))
    }

    /// Posterior of all coefficients at the present noise.
    pub(super) fn fit(
        &mut self,
        data: &PreparedFlights<'_>,
        moments: &GramSums,
    ) -> Result<(), DiagnoseError> {
        let width = self.factor.nrows();
        let gram = moments.gram(&self.parts.noise, None);
        let (solution, factor) = self.posterior(&gram).ok_or(DiagnoseError::Degenerate)?;
        let mut covariance = Mat::<f64>::identity(width, width);
        factor.solve(&mut covariance);
        let layout = self.layout();
        let found = |column: usize| solution[(column, 0)];
        let means = layout.remainder.chain(layout.contrasts);
        self.parts.mean = means.map(found).collect();
        let deck = layout.deck.zip(&data.predictor.deck.coefficients);
        self.parts.deck_coefficients =
            deck.map(|(column, coefficient)| coefficient + found(column)).collect();
        self.parts.standing_effects = layout.standing_effects.map(found).collect();
        self.parts.drag = layout.drag.map(found).collect();
        // A covariance inverted in floating point may miss definiteness by rounding; a hair on the diagonal mends it.
        for k in 0..width {
            covariance[(k, k)] *= 1.0 + 1e-12;
        }
        let lower = Cholesky::new(&covariance).ok_or(DiagnoseError::Degenerate)?;
        self.factor = lower.lower().to_owned();
        self.parts.factor = lower_triangle(&self.factor);
        self.summarize(data);
        Ok(())
    }

    /// What is left of the flights that it was learnt from, and what carried effects were worth in them.
    fn summarize(&mut self, data: &PreparedFlights<'_>) {
        let count = data.segments.len().max(1) as f64;
        let mut means = vec![0.0; STANDING_EFFECTS.len()];
        let mut squares = 0.0;
        for row in &data.segments {
            let left = self.left_of_fuel_flow(row);
            let carried = row.standing_effects.iter().zip(&self.parts.standing_effects);
            for (mean, (slope, size)) in means.iter_mut().zip(carried) {
                *mean += slope[0] * size / count;
            }
            squares += left * left;
        }
        self.parts.standing_means = means;
        self.parts.rms = (squares / count).sqrt();
    }

    /// ln of the marginal likelihood, up to a constant.
    ///
    /// ```text
    /// −½ Σ_f ln|C_f| − ½ ln|1 + S G S| − ½ (y² − bᵀ S (1 + S G S)⁻¹ S b)                  [diagnosis.17]
    /// ```
    fn ln_marginal(
        &self,
        moments: &GramSums,
        position: &GridPosition,
        known: &mut [LikelihoodCache],
    ) -> f64 {
        let parts = moments.parts.iter().zip(known);
        let likelihood: f64 =
            parts.map(|(part, known)| self.ln_marginal_of(part, position, known)).sum();
        self.ln_prior_of_hyperparameters() + likelihood
    }

    /// The same of kinds of channels that no other kind is coupled with.
    fn ln_marginal_of(
        &self,
        part: &CoupledChannels,
        position: &GridPosition,
        known: &mut LikelihoodCache,
    ) -> f64 {
        // Sizes of the remainder concern fuel flow alone.
        let feels = |hyperparameter: usize| {
            part.kinds[if hyperparameter < 2 * KINDS { hyperparameter % KINDS } else { 0 }]
        };
        let felt: GridPosition = core::array::from_fn(|hyperparameter| {
            if feels(hyperparameter) { position[hyperparameter] } else { (0, 0) }
        });
        if let Some(&likelihood) = known.likelihoods.get(&felt) {
            return likelihood;
        }
        let of_noise: GridPosition = core::array::from_fn(|hyperparameter| {
            if hyperparameter < 2 * KINDS { felt[hyperparameter] } else { (0, 0) }
        });
        let (gram, ln_noise) = match known.gram.take() {
            Some((at, gram, ln_noise)) if at == of_noise => (gram, ln_noise),
            _ => part.gram(&self.parts.noise, None),
        };
        let likelihood = self.ln_marginal_at(part, &gram, ln_noise);
        known.gram = Some((of_noise, gram, ln_noise));
        known.likelihoods.insert(felt, likelihood);
        likelihood
    }

    fn ln_marginal_at(&self, part: &CoupledChannels, gram: &Mat<f64>, ln_noise: f64) -> f64 {
        let width = part.columns.len() - 1; // the residual is the last
        let deviations: Vec<f64> =
            part.columns[..width].iter().map(|&column| self.prior_deviation(column)).collect();
        // Only the lower triangle is read.
        let mut inner = Mat::<f64>::zeros(width, width);
        for j in 0..width {
            let from = &gram.col_as_slice(j)[j..width];
            let into = &mut inner.col_as_slice_mut(j)[j..];
            for ((into, from), deviation) in into.iter_mut().zip(from).zip(&deviations[j..]) {
                *into = from * deviation * deviations[j];
            }
            into[0] += 1.0;
        }
        let Some(factor) = Cholesky::new(&inner) else { return f64::NEG_INFINITY };
        let mut projected = Mat::from_fn(width, 1, |k, _| gram[(width, k)] * deviations[k]);
        factor.solve_lower(&mut projected);
        let explained: f64 = projected.col_as_slice(0).iter().map(|value| value * value).sum();
        -0.5 * (ln_noise + factor.ln_determinant() + gram[(width, width)] - explained)
    }

    /// Hyperparameters are log-normal about what is usual: a few flights do not make noise vanish.
    fn ln_prior_of_hyperparameters(&self) -> f64 {
        let NoiseFactors { within, between } = self.parts.noise;
        let of = |value: f64, center: f64, ln_deviation: f64| {
            let z = (value / center).ln() / ln_deviation;
            -0.5 * z * z
        };
        let noise = within.into_iter().chain(between);
        noise.map(|factor| of(factor, USUAL_NOISE, USUAL_NOISE_LN_DEVIATION)).sum::<f64>()
            + self
                .parts
                .scales
                .into_iter()
                .map(|scale| of(scale, 1.0, REMAINDER_SCALE_LN_DEVIATION))
                .sum::<f64>()
    }
}
