//! How large noise and remainder are: the marginal likelihood of one channel over a few factors, its largest value, and the
//! points over which the posterior is averaged.
//!
//! Flights say these sizes within some tens of per cent only. The likeliest sizes alone would make every interval too narrow,
//! so that the posterior is averaged over what the flights leave open.

use faer::Mat;

use crate::learning::by_scales::ByScales;
use crate::learning::dials::{Dials, MOST_DIALS, NOISE_DIALS, SCALES};
use crate::learning::prior::Prior;
use crate::learning::sums::{ChannelSums, right_side};
use crate::math::lower::{Lower, dot};
use crate::priors::{
    PRIOR_LEVEL_ALONE, SCALE_LN_DEVIATIONS, USUAL_NOISE, USUAL_NOISE_LN_DEVIATION,
};

/// Gain of ln likelihood that is not looked for. Our choice: a fifth of a standard deviation of a factor.
const WORTH_A_LOOK: f64 = 0.02;
/// Step of the curvature at the largest likelihood. Our choice: wide enough to feel the slope of the sides.
const CURVATURE_STEP: f64 = 0.25;
/// Most of what flights may leave open of a factor, in ln. Our choice: as wide as the widest belief before them.
const WIDEST: f64 = 2.0;
/// Steps of the search for noise where factors are given. Our choice: as where all are sought, after outliers are weighed.
const NOISE_STEPS: [f64; 3] = [0.35, 0.15, 0.06];
/// Weight below which a point is left out. Our choice: it would change nothing that is printed.
const NEGLIGIBLE: f64 = 1e-6;

/// One of the points that the posterior is averaged over.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weighted {
    pub(super) dials: Dials,
    pub(super) weight: f64,
}

/// The marginal likelihood of a channel.
pub(super) struct Evidence<'a> {
    sums: &'a ChannelSums,
    prior: &'a Prior,
    /// The Gram matrix formed last, with Σ ln(1 + ρ²λ), and its ratio.
    gram: Option<GramAt>,
    /// The prior precision formed last, with `ln|K|`, and its scales.
    precision: Option<([f64; SCALES], Lower, f64)>,
    /// Cholesky factor of the posterior precision that was looked at last.
    factor: Lower,
    /// What makes scales cheap to move, at a ratio.
    by_scales: Option<ByScales>,
}

/// A Gram matrix at a ratio.
struct GramAt {
    ratio: f64,
    /// Of the columns alone.
    columns: Lower,
    /// Products of the columns with the residual, and its square.
    right: Vec<f64>,
    square: f64,
    ln_common: f64,
}

/// Posterior of the columns at one point: mean, and a root of the covariance.
pub(super) struct Solved {
    pub(super) mean: Mat<f64>,
    pub(super) root: Mat<f64>,
}

impl<'a> Evidence<'a> {
    pub(super) fn new(sums: &'a ChannelSums, prior: &'a Prior) -> Self {
        let factor = Lower::default();
        Self { sums, prior, gram: None, precision: None, factor, by_scales: None }
    }

    /// Factors that this channel has.
    fn dimensions(&self) -> usize {
        NOISE_DIALS + self.scales()
    }

    /// Scales among them: the first part of the prior covariance has none.
    fn scales(&self) -> usize {
        self.prior.parts.len() - 1
    }

    /// ln of the marginal likelihood and of the prior of the factors, up to a constant.
    ///
    /// ```text
    /// −½ Σ_f ln|C_f| − ½ ln|K| − ½ ln|K⁻¹ + G| − ½ (y² − gᵀ(K⁻¹ + G)⁻¹g),   K the prior covariance     [diagnosis.17]
    /// ```
    pub(super) fn ln_evidence(&mut self, dials: &Dials) -> f64 {
        if dials.is_allowed() { self.ln_density(dials) } else { f64::NEG_INFINITY }
    }

    /// The same, of factors beyond their limits too.
    fn ln_density(&mut self, dials: &Dials) -> f64 {
        let by_scales = self.by_scales.as_mut().filter(|by| by.is_at(dials.ratio()));
        let found = match by_scales.and_then(|by| by.seen(dials)) {
            Some(found) => Some(found),
            None => self.seen_by_precision(dials),
        };
        let Some((ln_determinants, explained)) = found else { return f64::NEG_INFINITY };
        let Some(GramAt { square: of_residual, ln_common, .. }) = &self.gram else {
            return f64::NEG_INFINITY;
        };
        let square = dials.within * dials.within;
        let left = (of_residual - explained) / square;
        let ln_noise = self.sums.values * square.ln() + ln_common;
        let likelihood = -0.5 * (ln_noise + ln_determinants + left);
        likelihood + self.ln_prior(dials)
    }

    /// ln|K| + ln|K⁻¹ + G/w²| and gᵀ(K⁻¹ + G/w²)⁻¹g/w², by the precision.
    fn seen_by_precision(&mut self, dials: &Dials) -> Option<(f64, f64)> {
        self.factor(dials)?;
        let (gram, (.., ln_prior)) = (self.gram.as_ref()?, self.precision.as_ref()?);
        let mut projected = gram.right.clone();
        self.factor.solve_lower(&mut projected);
        let explained = dot(&projected, &projected) / (dials.within * dials.within);
        Some((ln_prior + self.factor.ln_determinant(), explained))
    }

    /// Gets ready for moves of the scales at the ratio of these factors; where that cannot be, they are moved by the precision.
    fn prepare_scales(&mut self, dials: &Dials) {
        let ratio = dials.ratio();
        if self.by_scales.as_ref().is_some_and(|by| by.is_at(ratio)) {
            return;
        }
        self.form_gram(ratio);
        let gram = self.gram.as_ref();
        self.by_scales =
            gram.and_then(|gram| ByScales::new(ratio, (&gram.columns, &gram.right), self.prior));
    }

    /// The Gram matrix at a ratio.
    fn form_gram(&mut self, ratio: f64) {
        if self.gram.as_ref().is_none_or(|gram| gram.ratio.to_bits() != ratio.to_bits()) {
            let (gram, ln_common) = self.sums.gram(ratio);
            let width = gram.nrows() - 1;
            let mut columns = Lower::zeros(width);
            columns.add(1.0, &gram);
            let square = gram[(width, width)];
            let right = right_side(&gram);
            self.gram = Some(GramAt { ratio, columns, right, square, ln_common });
            self.by_scales = None;
        }
    }

    /// Factors the posterior precision K⁻¹ + G/w²; Gram matrix and prior are then at hand.
    fn factor(&mut self, dials: &Dials) -> Option<()> {
        self.form_gram(dials.ratio());
        let bits = |scales: [f64; SCALES]| scales.map(f64::to_bits);
        if self.precision.as_ref().is_none_or(|(at, ..)| bits(*at) != bits(dials.scales)) {
            let mut factor = self.prior.covariance(dials.scales);
            if !factor.factor() {
                return None;
            }
            let precision = factor.inverse().transposed_times_itself();
            self.precision = Some((dials.scales, precision, factor.ln_determinant()));
        }
        let (gram, (_, prior, _)) = (self.gram.as_ref()?, self.precision.as_ref()?);
        self.factor.set_sum(prior, 1.0 / (dials.within * dials.within), &gram.columns);
        self.factor.factor().then_some(())
    }

    /// Factors are log-normal about what is usual: a few flights do not make noise vanish.
    fn ln_prior(&self, dials: &Dials) -> f64 {
        ln_log_normal(dials.within, USUAL_NOISE[0], USUAL_NOISE_LN_DEVIATION)
            + ln_log_normal(dials.between, USUAL_NOISE[1], USUAL_NOISE_LN_DEVIATION)
            + self.ln_prior_of_scales(dials)
    }

    fn ln_prior_of_scales(&self, dials: &Dials) -> f64 {
        let scales = dials.scales.iter().zip(SCALE_LN_DEVIATIONS).take(self.scales());
        scales.map(|(scale, deviation)| ln_log_normal(*scale, 1.0, deviation)).sum()
    }

    /// What is believed before the flights.
    pub(super) const fn prior(&self) -> &'a Prior {
        self.prior
    }

    /// The likeliest factors, from a start in ever smaller steps.
    pub(super) fn likeliest(&mut self, start: Dials, steps: &[f64]) -> Dials {
        self.likeliest_of(self.dimensions(), start, steps)
    }

    /// The likeliest noise, with all scales as they are.
    pub(super) fn likeliest_noise(&mut self, start: Dials, steps: &[f64]) -> Dials {
        self.likeliest_of(NOISE_DIALS, start, steps)
    }

    /// The same of the first few factors; the others stay.
    fn likeliest_of(&mut self, coordinates: usize, start: Dials, steps: &[f64]) -> Dials {
        let mut best = (start.coordinates(), self.ln_evidence(&start));
        for &step in steps {
            for coordinate in 0..coordinates {
                if coordinate == NOISE_DIALS {
                    self.prepare_scales(&Dials::at(&best.0));
                }
                self.move_along(&mut best, coordinate, step);
            }
        }
        Dials::at(&best.0)
    }

    /// One coordinate: to the vertex of the parabola through three values, or on while it rises.
    fn move_along(&mut self, best: &mut ([f64; MOST_DIALS], f64), coordinate: usize, step: f64) {
        let mut value_at = |by: f64| {
            let mut moved = best.0;
            moved[coordinate] += by;
            (moved, self.ln_evidence(&Dials::at(&moved)))
        };
        let (up, down) = (value_at(step), value_at(-step));
        let mut found = *best;
        for one in [up, down] {
            if one.1 > found.1 {
                found = one;
            }
        }
        let curvature = up.1 + down.1 - 2.0 * best.1;
        let slope = 0.5 * (up.1 - down.1);
        if curvature < 0.0 && slope.is_finite() {
            let vertex = (-slope / curvature).clamp(-3.0, 3.0);
            let expected = best.1 + vertex * (slope + 0.5 * vertex * curvature);
            if expected > found.1 + WORTH_A_LOOK {
                let one = value_at(step * vertex);
                if one.1 > found.1 {
                    found = one;
                }
            }
        }
        *best = found;
    }

    /// The points that the posterior is averaged over: those about the likeliest factors, and one of a model of which nothing but
    /// the level is off.
    ///
    /// ```text
    /// p(level alone | y)/(1 − p) = P/(1 − P)·exp(ln p(y | level alone) − ln p(y)),
    /// ln p(y) = ln p(y | likeliest) + Σ_scales (ln p(scale) + ½ ln 2πσ²)                                    [baseline.5]
    /// ```
    ///
    /// P is [`PRIOR_LEVEL_ALONE`], σ what flights leave open of ln scale; noise is as open either way.
    ///
    /// # Source
    /// Tierney and Kadane 1986, doi 10.1080/01621459.1986.10478240 (Laplace's approximation); Kass and Raftery 1995, doi
    /// 10.1080/01621459.1995.10476572 (probabilities of two models).
    pub(super) fn points(&mut self, likeliest: Dials) -> Vec<Weighted> {
        let (mut points, deviations) = self.averaged(&likeliest);
        let scales = self.scales();
        if scales == 0 {
            return points;
        }
        let of_all = self.ln_evidence(&likeliest);
        let of_level_alone = likeliest.of_level_alone();
        let by_itself = self.likeliest_of(NOISE_DIALS, of_level_alone, &NOISE_STEPS);
        // Scatter between flights stays: were it three times as large, as the likeliest of a level alone may have it, errors of
        // mass would make up for trends within flights, and the level would lie outside what any flight has shown.
        let level_alone = Dials { within: by_itself.within, ..of_level_alone };
        let of_level = self.ln_evidence(&level_alone) - self.ln_prior_of_scales(&level_alone);
        let open = deviations[NOISE_DIALS..].iter().zip(SCALE_LN_DEVIATIONS).take(scales);
        let volume: f64 = open.map(|(deviation, prior)| (deviation / prior).ln()).sum();
        let prior = (PRIOR_LEVEL_ALONE / (1.0 - PRIOR_LEVEL_ALONE)).ln();
        let ln_odds = prior + of_level - of_all - volume;
        // No number where neither has a density: then the points stand as they are.
        let probability = if ln_odds.is_nan() { 0.0 } else { 1.0 / (1.0 + (-ln_odds).exp()) };
        for point in &mut points {
            point.weight *= 1.0 - probability;
        }
        points.push(Weighted { dials: level_alone, weight: probability });
        points.retain(|point| point.weight > NEGLIGIBLE);
        points
    }

    /// Points about the likeliest factors whose mean and spread are those of the posterior, and what flights leave open of each
    /// factor: its standard deviation in ln.
    ///
    /// ```text
    /// ln factor ± √d·σ along each of d factors,  σ⁻² = −∂² ln p,   each with the weight p/p₀·e^{d/2}          [baseline.3]
    /// ```
    ///
    /// # Source
    /// The points: Arasaratnam and Haykin 2009, doi 10.1109/TAC.2009.2019800 (third-degree spherical-radial rule). The
    /// averaging and its weights: Rue, Martino and Chopin 2009, doi 10.1111/j.1467-9868.2008.00700.x, section 6.5.
    fn averaged(&mut self, likeliest: &Dials) -> (Vec<Weighted>, [f64; MOST_DIALS]) {
        let center = likeliest.coordinates();
        let highest = self.ln_evidence(likeliest);
        let dimensions = self.dimensions();
        let mut points = Vec::with_capacity(2 * dimensions + 1);
        let mut deviations = [0.0; MOST_DIALS];
        for coordinate in 0..dimensions {
            if coordinate == NOISE_DIALS {
                self.prepare_scales(&Dials::at(&center));
            }
            let moved = |by: f64| {
                let mut moved = center;
                moved[coordinate] += by;
                Dials::at(&moved)
            };
            // A limit nearby is no curvature: flights would leave nothing open.
            let mut fall = |by: f64| highest - self.ln_density(&moved(by));
            let curvature =
                (fall(CURVATURE_STEP) + fall(-CURVATURE_STEP)) / (CURVATURE_STEP * CURVATURE_STEP);
            let deviation = (1.0 / curvature.max(1e-12).sqrt()).min(WIDEST);
            deviations[coordinate] = deviation;
            let far = (dimensions as f64).sqrt() * deviation;
            for by in [far, -far] {
                let dials = moved(by);
                let ln_ratio = self.ln_evidence(&dials) - highest;
                let weight = (ln_ratio + 0.5 * dimensions as f64).min(1.0).exp();
                if weight > NEGLIGIBLE {
                    points.push(Weighted { dials, weight });
                }
            }
        }
        let sum: f64 = points.iter().map(|point| point.weight).sum();
        if sum <= 0.0 {
            return (vec![Weighted { dials: *likeliest, weight: 1.0 }], deviations);
        }
        for point in &mut points {
            point.weight /= sum;
        }
        (points, deviations)
    }

    /// The posterior mean at one point; `None` where matrices are not positive definite.
    pub(super) fn mean(&mut self, dials: &Dials) -> Option<Mat<f64>> {
        self.factor(dials)?;
        let gram = self.gram.as_ref()?;
        let square = dials.within * dials.within;
        let mut mean = gram.right.clone();
        for value in &mut mean {
            *value /= square;
        }
        self.factor.solve_lower(&mut mean);
        self.factor.solve_upper(&mut mean);
        Some(Mat::from_fn(mean.len(), 1, |k, _| mean[k]))
    }

    /// The same with the covariance.
    pub(super) fn mean_and_covariance(&mut self, dials: &Dials) -> Option<(Mat<f64>, Lower)> {
        let mean = self.mean(dials)?;
        Some((mean, self.factor.inverse().transposed_times_itself()))
    }

    /// The posterior at one point; `None` as for [`mean`](Self::mean).
    pub(super) fn solved(&mut self, dials: &Dials) -> Option<Solved> {
        let mean = self.mean(dials)?;
        let inverse = self.factor.inverse();
        let size = inverse.size();
        let entry = |row, column| if row <= column { inverse.at(column, row) } else { 0.0 };
        Some(Solved { mean, root: Mat::from_fn(size, size, entry) })
    }
}

/// ln of the density of a factor relative to that at the center of its distribution, over ln of the factor.
fn ln_log_normal(value: f64, center: f64, ln_deviation: f64) -> f64 {
    let z = (value / center).ln() / ln_deviation;
    -0.5 * z * z
}

#[cfg(test)]
mod tests;
