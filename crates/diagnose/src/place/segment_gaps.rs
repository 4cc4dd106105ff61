//! The gap segment by segment, before and after effects are added: what a chart is drawn from.

use effects::{Effects, Trial, Variable};

use crate::input::Input;
use crate::library::Library;
use crate::library::dates::DateGrid;
use crate::output::addition::Addition;
use crate::output::note::LeftOutReason;
use crate::output::region::Region;
use crate::place::told::engines_apart;
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::signals::references::DiagnoseError;

/// The gap at one segment: ln recorded − ln predicted total fuel flow, in per cent, as [`crate::diagnose()`] counts it.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentGap {
    /// Its flight, numbered from 0 among the flights that were used.
    pub flight: usize,
    /// Instant, s since 1970.
    pub date_s: f64,
    /// Mach number.
    pub mach: f64,
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// The variable that was asked for; `None` where it is not recorded.
    pub driver: Option<f64>,
    /// Whether it lies in the region that was asked for.
    pub in_region: bool,
    /// Before anything is added.
    pub before_percent: f64,
    /// With the first effect of the addition, with the first two, and so on; as long as the addition has effects.
    pub after_percent: Vec<f64>,
    /// Each engine's gap less the mean of all, before and with all effects of the addition; empty where engines are not
    /// recorded separately.
    pub engines_apart_percent: Vec<[f64; 2]>,
}

/// What charts of a diagnosis show beside the gap.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shown<'a> {
    /// The effects that are added, one after the other.
    pub addition: Option<&'a Addition>,
    /// The place that is marked.
    pub region: Option<&'a Region>,
    /// The variable over which the gap is drawn.
    pub driver: Option<Variable>,
    /// Outliers that the diagnosis left out, and charts do too.
    pub outliers: &'a [usize],
}

/// The gap at every segment that a diagnosis of the same input uses, in its order. The sizes of the addition were fitted to
/// these flights: how far the gap shrinks on unseen ones is the diagnosis' closure, not what these add up to.
///
/// # Errors
/// [`DiagnoseError`] for a model that takes no effects, or that knows none of the flights.
pub fn segment_gaps(input: &Input<'_>, shown: Shown<'_>) -> Result<Vec<SegmentGap>, DiagnoseError> {
    let references = input.effect_references()?;
    let (reference, model) = (input.reference(), input.effect_model(references)?);
    // No column of the library is needed: residuals do not depend on what is searched.
    let (mut data, _) =
        PreparedFlights::prepare(&model, input.flights, reference, |points, engines, starts| {
            Library::new(&model, points, engines, DateGrid::coarse(starts, &[], None), |_| false)
        });
    let is_outlier = |place: usize| shown.outliers.binary_search(&place).is_ok();
    let refused: Vec<bool> = (0..data.segments.len()).map(is_outlier).collect();
    data.leave_out(&refused, LeftOutReason::Outlier);
    let value = |row: &SegmentRow, variable: Variable| match variable {
        Variable::N2 => row.n2_percent,
        Variable::Date => Some(row.point.date_s),
        other => other.value(&row.point, &row.response, &references),
    };
    let steps = steps(shown.addition);
    let trials: Vec<_> = steps.iter().map(|effects| model.trial(effects)).collect();
    let mut gaps = Vec::with_capacity(data.segments.len());
    for (flight, rows) in data.flights.iter().enumerate() {
        for row in &data.segments[rows.segments.clone()] {
            let channels = 1 + data.channels.contrasts;
            let without = data.predictor.predict(&row.response);
            let left = |trial: &Trial| {
                let with = model.response_at(&row.known, trial);
                let with = with.map_or(without, |with| data.predictor.predict(&with));
                let mut left = row.residual;
                for channel in 0..channels {
                    left[channel] -= with[channel] - without[channel];
                }
                left
            };
            let after: Vec<_> = trials.iter().map(left).collect();
            let last = after.last().unwrap_or(&row.residual);
            gaps.push(SegmentGap {
                flight,
                date_s: row.point.date_s,
                mach: row.point.mach,
                lift_coefficient: row.response.lift_coefficient,
                driver: shown.driver.and_then(|variable| value(row, variable)),
                in_region: shown.region.is_some_and(|region| {
                    region.conditions.iter().all(|condition| {
                        value(row, condition.variable).is_some_and(|value| condition.holds(value))
                    })
                }),
                before_percent: 100.0 * row.residual[0],
                after_percent: after.iter().map(|left| 100.0 * left[0]).collect(),
                engines_apart_percent: apart(&row.residual[1..channels], &last[1..channels]),
            });
        }
    }
    Ok(gaps)
}

/// Each engine's gap less the mean of all, before and after, %.
fn apart(before: &[f64], after: &[f64]) -> Vec<[f64; 2]> {
    let engines = if before.is_empty() { 0 } else { before.len() + 1 };
    let (before, after) = (engines_apart(before), engines_apart(after));
    (0..engines).map(|engine| [100.0 * before[engine], 100.0 * after[engine]]).collect()
}

/// The first effect, the first two, and so on.
fn steps(addition: Option<&Addition>) -> Vec<Effects> {
    let mut effects = Effects::none();
    addition
        .into_iter()
        .flat_map(|addition| &addition.effects)
        .map(|added| {
            effects = effects
                .clone()
                .with(added.effect, added.size)
                .with_hidden(added.effect, added.hidden);
            effects.clone()
        })
        .collect()
}
