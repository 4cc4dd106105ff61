//! How far the gap shrinks: choice and fit on four fifths of the flights, judged on the rest.

use perf_model::effects::EffectModel;

use crate::analysis::{Analysis, Stacked, analyse};
use crate::gram::{FOLDS, fold_of};
use crate::library::Library;
use crate::refine::{effects_of, refine};

/// A gap whose excess over the noise floor is less than this share of the floor is too small to measure closure.
const SMALLEST_GAP: f64 = 0.15;

/// Mean squares of the gap, flight by flight: before, after, and of the noise.
#[derive(Clone, Debug)]
pub(crate) struct Shrinkage {
    pub(crate) before: Vec<f64>,
    pub(crate) after: Vec<f64>,
    pub(crate) floor: Vec<f64>,
    pub(crate) segments: Vec<f64>,
}

impl Shrinkage {
    fn total(values: &[f64], segments: &[f64]) -> f64 {
        let count: f64 = segments.iter().sum();
        values.iter().sum::<f64>() / count
    }

    pub(crate) fn before(&self) -> f64 {
        Self::total(&self.before, &self.segments)
    }

    pub(crate) fn after(&self) -> f64 {
        Self::total(&self.after, &self.segments)
    }

    pub(crate) fn floor(&self) -> f64 {
        Self::total(&self.floor, &self.segments)
    }

    /// Share of the explainable gap that is closed, with a 95 % interval by flight (linearised ratio); `None` where the
    /// gap is too small.
    ///
    /// ```text
    /// closure = (rms²_before − rms²_after)/(rms²_before − floor²)                      [diagnosis.23]
    /// ```
    pub(crate) fn closure(&self) -> Option<(f64, [f64; 2])> {
        let (before, after, floor) = (self.before(), self.after(), self.floor());
        if before - floor < SMALLEST_GAP * floor {
            return None;
        }
        let closure = (before - after) / (before - floor);
        let denominator: f64 = self.before.iter().zip(&self.floor).map(|(b, f)| b - f).sum();
        let flights = self.before.len() as f64;
        let spread: f64 = (0..self.before.len())
            .map(|k| {
                let numerator = self.before[k] - self.after[k];
                (numerator - closure * (self.before[k] - self.floor[k])).powi(2)
            })
            .sum::<f64>()
            * flights
            / (flights - 1.0).max(1.0);
        let half = 1.96 * spread.sqrt() / denominator.abs();
        Some((closure, [closure - half, closure + half]))
    }
}

/// Before and after with a model that is given: not judged on unseen flights.
pub(crate) fn in_sample(
    stacked: &Stacked<'_>,
    model: &EffectModel<'_>,
    library: &Library,
    columns: &[usize],
    sizes: &[f64],
    noise_scale: f64,
) -> Shrinkage {
    shrinkage(stacked, model, library, noise_scale, |_| (columns.to_vec(), sizes.to_vec()))
}

/// Before and after on flights that neither choice nor fit has seen.
pub(crate) fn nested(
    stacked: &Stacked<'_>,
    model: &EffectModel<'_>,
    library: &Library,
    noise_scale: f64,
) -> Shrinkage {
    let choices: Vec<(Vec<usize>, Vec<f64>)> =
        (0..FOLDS).map(|fold| chosen(stacked, model, library, fold).unwrap_or_default()).collect();
    shrinkage(stacked, model, library, noise_scale, |fold| choices[fold].clone())
}

fn chosen(
    stacked: &Stacked<'_>,
    model: &EffectModel<'_>,
    library: &Library,
    fold: usize,
) -> Option<(Vec<usize>, Vec<f64>)> {
    let Analysis { scorer, backgrounds, models, .. } =
        analyse(stacked, model, library, Some(fold), false)?;
    let (best, _) = models.first()?;
    if best.model.columns.is_empty() {
        return Some((vec![], vec![]));
    }
    let at = &backgrounds[best.background];
    let found = refine(stacked, model, library, &scorer, best, at, Some(fold));
    let sizes = found.map_or_else(|| best.sizes.clone(), |found| found.scored.sizes);
    Some((best.model.columns.clone(), sizes))
}

fn shrinkage(
    stacked: &Stacked<'_>,
    model: &EffectModel<'_>,
    library: &Library,
    noise_scale: f64,
    choice: impl Fn(usize) -> (Vec<usize>, Vec<f64>),
) -> Shrinkage {
    let data = stacked.data;
    let mut found = Shrinkage { before: vec![], after: vec![], floor: vec![], segments: vec![] };
    for (index, flight) in data.flights.iter().enumerate() {
        let (columns, sizes) = choice(fold_of(index));
        let effects = effects_of(library, &columns, &sizes);
        let (mut before, mut after, mut floor) = (0.0, 0.0, 0.0);
        for row in &data.segments[flight.segments.clone()] {
            let gap = row.residual[0];
            let closed = model.response(&row.point, &effects).map_or(0.0, |with| {
                data.predictor.predict(&with)[0] - data.predictor.predict(&row.response)[0]
            });
            before += gap * gap;
            after += (gap - closed) * (gap - closed);
            let own = row.noise.factor[0][0] * row.noise.factor[0][0];
            let common: f64 = row.noise.common.iter().map(|u| u[0] * u[0]).sum();
            floor += noise_scale * (own + common);
        }
        found.before.push(before);
        found.after.push(after);
        found.floor.push(floor);
        found.segments.push(flight.segments.len() as f64);
    }
    found
}
