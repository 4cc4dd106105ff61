//! What anyone could name: the posterior over single effects for one who knows how everything else varies.
//!
//! Blind trials with clutter plant one effect among small amounts of all others. No search can be right more often than one
//! that knows the size that is planted, how the rest varies and the noise; how often that is right is the ceiling of the
//! score, and not 1.

use flight::effect::{EffectId, EffectSign};

use crate::hypotheses::backgrounds::{Level, TableBelief};
use crate::hypotheses::design::Design;
use crate::input::Input;
use crate::library::dates::DateGrid;
use crate::library::{Library, Testable};
use crate::math::eliminate::{Reduced, integrate_out};
use crate::math::mixture::ln_sum;
use crate::residuals::segments::PreparedFlights;
use crate::search::system::{SmoothTerms, WhitenedSystem};
use crate::signals::references::DiagnoseError;

/// How faults vary of which none is looked for, and how large the one is that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownClutter {
    /// Standard deviation of every effect that is not planted, as a share of its typical size.
    pub share: f64,
    /// Root mean square of smooth errors of fuel flow, %.
    pub smooth_percent: f64,
    /// The size that is planted over the typical size.
    pub times: f64,
}

/// Effects by their probability, most probable first, for one who knows the clutter's variances, the size that is planted
/// but for its sign, and the noise; each effect is as probable beforehand as any other.
///
/// ```text
/// ln p(y | k) = −½ (yᵀy − 2 θ xᵀy + θ² xᵀx) − ½ ln det,  θ = ± planted,  all else integrated out     [diagnosis.54]
/// ```
///
/// # Errors
/// As [`diagnose`](crate::diagnose()).
pub fn attainable(
    input: &Input<'_>,
    clutter: KnownClutter,
) -> Result<Vec<(EffectId, f64)>, DiagnoseError> {
    let references = input.effect_references()?;
    let (reference, model) = (input.reference(), input.effect_model(references)?);
    let (data, library) =
        PreparedFlights::prepare(&model, input.flights, reference, |points, engines, starts| {
            let dates = DateGrid::coarse(starts, input.events_s, None);
            Library::new(&model, points, engines, dates, |_| true)
        });
    let design = Design::new(&data, &references, input.baseline, input.table);
    let system = WhitenedSystem::new(&data, &design);
    let mut found = Vec::with_capacity(library.effects.len() + 1);
    let still = reduced_at(&system, 0.0)?;
    for effect in &library.effects {
        found.push((effect.id, ln_evidence(&still, (&design, &library), effect, clutter)?));
    }
    if library.heating_value {
        let id = EffectId::FuelHeatingValue;
        let scatter = 0.01 * clutter.times * model.references().typical_size(id);
        let scattered = reduced_at(&system, scatter)?;
        let left = without_clutter(&scattered, (&design, &library), None, clutter)?;
        let residual = left.matrix.ncols() - 1;
        found.push((id, -0.5 * (left.matrix[(residual, residual)] + left.ln_determinant)));
    }
    let total = ln_sum(found.iter().map(|(_, ln)| *ln));
    let mut found: Vec<(EffectId, f64)> =
        found.into_iter().map(|(id, ln)| (id, (ln - total).exp())).collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    Ok(found)
}

/// The Gram without nuisance, with this scatter between flights, relative.
pub(crate) fn reduced_at(
    system: &WhitenedSystem<'_>,
    scatter: f64,
) -> Result<Reduced, DiagnoseError> {
    let at = Level { scatter, table: TableBelief::Uncertain, ln_prior: 0.0 };
    let level = system.level(system.gram(None), at, None, SmoothTerms::Kept);
    level.map(|(_, reduced)| reduced).ok_or(DiagnoseError::Degenerate)
}

/// Columns of an effect and the residual, with smooth errors and small amounts of every other effect integrated out.
fn without_clutter(
    reduced: &Reduced,
    (design, library): (&Design<'_>, &Library),
    effect: Option<&Testable>,
    clutter: KnownClutter,
) -> Result<Reduced, DiagnoseError> {
    let residual = reduced.matrix.ncols() - 1;
    let kept: Vec<usize> = effect.map_or(0..0, Testable::all_columns).chain([residual]).collect();
    let others = library
        .effects
        .iter()
        .filter(|other| !other.has_known_size && effect.is_none_or(|effect| effect.id != other.id));
    let (mut out, mut deviations): (Vec<usize>, Vec<f64>) =
        others.map(|other| (other.representative, clutter.share * other.typical)).unzip();
    // Behind the effects come the smooth functions.
    out.extend(design.effects..design.effects + design.smooth.len());
    deviations.resize(out.len(), design.smooth_deviation(0.01 * clutter.smooth_percent));
    let mut left = integrate_out(&reduced.matrix, &kept, &out, &deviations)
        .ok_or(DiagnoseError::Degenerate)?;
    left.ln_determinant += reduced.ln_determinant;
    Ok(left)
}

/// ln of the evidence of an effect of the planted size: the mean over its hidden parameters and over both signs, where it
/// may have either.
pub(crate) fn ln_evidence(
    reduced: &Reduced,
    of: (&Design<'_>, &Library),
    effect: &Testable,
    clutter: KnownClutter,
) -> Result<f64, DiagnoseError> {
    let left = without_clutter(reduced, of, Some(effect), clutter)?;
    let residual = left.matrix.ncols() - 1;
    let has_sign = effect.has_known_size || effect.sign != EffectSign::Either;
    let signs: &[f64] = if has_sign { &[1.0] } else { &[1.0, -1.0] };
    let columns = &of.1.columns[effect.all_columns()];
    let each = columns.iter().enumerate().flat_map(|(place, column)| {
        let (gram, product) = (left.matrix[(place, place)], left.matrix[(place, residual)]);
        let prior = -column.ln_choices - (signs.len() as f64).ln();
        signs.iter().map(move |sign| {
            let size = sign * clutter.times * effect.typical;
            size * (product - 0.5 * size * gram) + prior
        })
    });
    let square = left.matrix[(residual, residual)];
    Ok(ln_sum(each.collect::<Vec<f64>>()) - 0.5 * (square + left.ln_determinant))
}
