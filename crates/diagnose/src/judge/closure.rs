//! How far the gap shrinks: choice and fit on four fifths of the flights, judged on the rest.

use flight::effect::HiddenParameter;

use crate::judge::table::{FittedTable, is_table_off};
use crate::math::bootstrap::interval_95;
use crate::math::random::RandomStream;
use crate::output::HeldOutFlight;
use crate::search::analyse::{Analysis, analyse};
use crate::search::folds::fold_of;
use crate::search::refine::{effects_of, refine};
use crate::search::system::{Problem, WhitenedSystem};
use crate::thresholds::{CLEAN_PROBABILITY, CLOSURE_FOLDS, SMALLEST_GAP};

/// Stream of random numbers behind the interval of closure.
const CLOSURE_STREAM: u64 = 3;
/// The same behind a comparison of two explanations.
const COMPARISON_STREAM: u64 = 4;

/// Sums of squares of the gap, flight by flight: before, after, and expected of the noise.
#[derive(Clone, Debug)]
pub(crate) struct Shrinkage {
    pub(crate) before: Vec<f64>,
    pub(crate) after: Vec<f64>,
    pub(crate) floor: Vec<f64>,
    /// Sum of the segments' weights in these squares.
    pub(crate) weights: Vec<f64>,
    segments: Vec<usize>,
    /// What is left of the gap, segment by segment.
    pub(crate) left: Vec<f64>,
    seed: u64,
}

impl Shrinkage {
    /// Before and after a change of each segment's predicted ln fuel flow, by the numbers of flight and segment.
    pub(crate) fn of_changes(
        system: &WhitenedSystem<'_>,
        noise_scale: f64,
        seed: u64,
        change: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let data = system.data;
        let mut found = Self {
            before: vec![],
            after: vec![],
            floor: vec![],
            weights: vec![],
            segments: data.flights.iter().map(|flight| flight.segments.len()).collect(),
            left: Vec::with_capacity(data.segments.len()),
            seed,
        };
        for (index, flight) in data.flights.iter().enumerate() {
            let (mut before, mut after, mut floor, mut weights) = (0.0, 0.0, 0.0, 0.0);
            for segment in flight.segments.clone() {
                let row = &data.segments[segment];
                let gap = row.residual[0];
                let left = gap - change(index, segment);
                let weight = row.weight * row.weight;
                weights += weight;
                before += weight * gap * gap;
                after += weight * left * left;
                found.left.push(left);
                let own = row.noise.factor[0][0] * row.noise.factor[0][0];
                let common: f64 = row.noise.common.iter().map(|u| u[0] * u[0]).sum();
                floor += weight * noise_scale * (own + common);
            }
            found.before.push(before);
            found.after.push(after);
            found.floor.push(floor);
            found.weights.push(weights);
        }
        found
    }

    /// Sum of the weights of all segments.
    pub(crate) fn weight(&self) -> f64 {
        self.weights.iter().sum()
    }

    fn mean(&self, sums: &[f64]) -> f64 {
        sums.iter().sum::<f64>() / self.weight()
    }

    pub(crate) fn before(&self) -> f64 {
        self.mean(&self.before)
    }

    pub(crate) fn after(&self) -> f64 {
        self.mean(&self.after)
    }

    pub(crate) fn floor(&self) -> f64 {
        self.mean(&self.floor)
    }

    /// Mean square of the gap above the noise floor; `None` where it is too small to ask how far it shrinks.
    pub(crate) fn explainable(&self) -> Option<f64> {
        let (before, floor) = (self.before(), self.floor());
        (before - floor >= SMALLEST_GAP * floor).then_some(before - floor)
    }

    /// Root mean squares of every flight, %.
    pub(crate) fn by_flight(&self) -> Vec<HeldOutFlight> {
        let flights = self.segments.iter().zip(&self.weights).enumerate();
        flights
            .map(|(flight, (&segments, &weights))| {
                let rms = |squares: &[f64]| 100.0 * (squares[flight] / weights).sqrt();
                HeldOutFlight {
                    segments,
                    before_rms_percent: rms(&self.before),
                    after_rms_percent: rms(&self.after),
                    noise_rms_percent: rms(&self.floor),
                }
            })
            .collect()
    }

    /// Share of the explainable gap that is closed, with a 95 % interval; `None` where the gap is too small.
    ///
    /// ```text
    /// closure = (rms²_before − rms²_after)/(rms²_before − floor²)                      [diagnosis.23]
    /// ```
    ///
    /// The interval is of a bootstrap over flights, with the floor as propagated; `None` too where resamples leave nothing
    /// explainable, so that the ratio has no bound.
    pub(crate) fn closure(&self) -> Option<(f64, [f64; 2])> {
        let closure = (self.before() - self.after()) / self.explainable()?;
        let by_flight: Vec<(f64, f64)> = (0..self.before.len())
            .map(|k| (self.before[k] - self.after[k], self.before[k] - self.floor[k]))
            .collect();
        let mut stream = RandomStream::new(self.seed, CLOSURE_STREAM);
        // Where as good as nothing is explainable, the ratio says nothing: it counts as unbounded.
        let [low, high] = interval_95(&by_flight, &mut stream, |closed, explainable| {
            if explainable > 0.0 { closed / explainable } else { f64::INFINITY.copysign(closed) }
        });
        (low.is_finite() && high.is_finite()).then_some((closure, [low, high]))
    }

    /// Of the resamples.
    pub(crate) const fn seed(&self) -> u64 {
        self.seed
    }

    /// The same gap with another change of each segment's predicted ln fuel flow.
    pub(crate) fn with_change(&self, system: &WhitenedSystem<'_>, change: &[f64]) -> Self {
        // What is expected of the noise is proportional to its scale, and not asked for here.
        Self::of_changes(system, 1.0, self.seed, |_, segment| change[segment])
    }

    /// Whether it surely shrinks the gap: by an interval of 95 % over flights.
    ///
    /// ```text
    /// Σ_f (S_before,f − S_after,f) > 0                                                       [diagnosis.53]
    /// ```
    pub(crate) fn closes(&self) -> bool {
        let nothing = Self { after: self.before.clone(), ..self.clone() };
        self.leaves_less_than(&nothing)
    }

    /// Whether it surely leaves less of the gap than another explanation of the same flights: by an interval of 95 % over flights.
    ///
    /// ```text
    /// Σ_f (S_other,f − S_f) > 0,   S_f  squares of what is left in flight f                         [diagnosis.52]
    /// ```
    pub(crate) fn leaves_less_than(&self, other: &Self) -> bool {
        let differences = other.after.iter().zip(&self.after).map(|(other, own)| other - own);
        let groups: Vec<(f64, f64)> = differences.zip(self.weights.iter().copied()).collect();
        let mut stream = RandomStream::new(self.seed, COMPARISON_STREAM);
        interval_95(&groups, &mut stream, |sum, weights| sum / weights)[0] > 0.0
    }
}

/// Before and after with a model that is given: not judged on unseen flights.
pub(crate) fn in_sample(
    problem: Problem<'_>,
    columns: &[usize],
    sizes: &[f64],
    noise_scale: f64,
    seed: u64,
) -> Shrinkage {
    let choice = Choice { columns: vec![columns.to_vec()], sizes: sizes.to_vec(), table: None };
    shrinkage(problem, noise_scale, seed, |_| &choice)
}

/// Before and after on flights that neither choice nor fit has seen. Where the size of the gap alone shows that it is one
/// (`is_certain`), the other flights name what explains them best, however probable no effect is.
pub(crate) fn nested(
    problem: Problem<'_>,
    is_certain: bool,
    noise_scale: f64,
    seed: u64,
) -> Shrinkage {
    let choices: Vec<Choice> = (0..CLOSURE_FOLDS)
        .map(|fold| chosen(problem, fold, is_certain).unwrap_or_default())
        .collect();
    shrinkage(problem, noise_scale, seed, |fold| &choices[fold])
}

/// What is added to the model for the flights of a fold.
#[derive(Clone, Debug, Default)]
struct Choice {
    /// Columns of its effects; more than one set of them where the other flights do not tell dates apart, each as likely.
    columns: Vec<Vec<usize>>,
    sizes: Vec<f64>,
    /// A guide's table as the other flights have it.
    table: Option<FittedTable>,
}

fn chosen(problem: Problem<'_>, fold: usize, is_certain: bool) -> Option<Choice> {
    let analysis = analyse(problem, Some(fold))?;
    let Problem { system, library, .. } = problem;
    if system.is_book() && is_table_off(&analysis) {
        // The table is off for sure; what acts beside it is what the leading hypothesis names, be it nothing.
        let leading = analysis.models.iter().map(|(scored, _)| scored);
        let best =
            leading.into_iter().find(|scored| scored.hypothesis.flight_scatter_percent.is_none());
        let named = best.map_or(&[][..], |best| &best.hypothesis.columns);
        let gram = system.gram(Some(fold));
        let table = FittedTable::new(system, library, gram, (&analysis, named))?;
        let columns = dates_alike(problem, fold, &table.columns);
        return Some(Choice { columns, sizes: table.sizes.clone(), table: Some(table) });
    }
    let Analysis { scorer, backgrounds, space, models, clean, .. } = analysis;
    // The verdict's own rule: where nothing at all is improbable, or the gap too large for it, the best named set, be it no more
    // probable than none.
    let named = models.iter().map(|(scored, _)| scored).find(|s| !s.hypothesis.columns.is_empty());
    let Some(best) = named.filter(|_| is_certain || clean <= CLEAN_PROBABILITY) else {
        return Some(Choice::default());
    };
    let at = &backgrounds[best.background];
    let mut found = refine(problem, &scorer, &space, &[(best, at)], Some(fold));
    let found = found.pop().flatten();
    let sizes = found.map_or_else(|| best.sizes.clone(), |found| found.scored.sizes);
    let columns = dates_alike(problem, fold, &best.hypothesis.columns);
    Some(Choice { columns, sizes, table: None })
}

/// Columns of a set of effects, and the same with every other date of a step that the flights outside a fold do not tell from its
/// own: a flight that was left out may lie on either side of it.
fn dates_alike(problem: Problem<'_>, fold: usize, columns: &[usize]) -> Vec<Vec<usize>> {
    let Problem { system, library, .. } = problem;
    let data = system.data;
    let flights = data.flights.iter().enumerate().filter(|(flight, _)| fold_of(*flight) != fold);
    let kept_s: Vec<f64> = flights
        .filter_map(|(_, flight)| Some(data.segments.get(flight.segments.start)?.point.date_s))
        .collect();
    let step_of = |column: usize| match library.columns[column].hidden {
        HiddenParameter::Step { from_s, target } => Some((from_s, target)),
        _ => None,
    };
    let mut all = vec![columns.to_vec()];
    for (place, &column) in columns.iter().enumerate() {
        let Some((from_s, target)) = step_of(column) else { continue };
        let are_alike = |other: &usize| {
            step_of(*other).is_some_and(|(other_s, of)| {
                let between = from_s.min(other_s)..from_s.max(other_s);
                of == target && !kept_s.iter().any(|date_s| between.contains(date_s))
            })
        };
        let effect = &library.effects[library.columns[column].effect];
        let others = effect.all_columns().filter(|other| *other != column).filter(are_alike);
        all.extend(others.map(|other| {
            let mut with_other = columns.to_vec();
            with_other[place] = other;
            with_other
        }));
    }
    all
}

fn shrinkage<'c>(
    problem: Problem<'_>,
    noise_scale: f64,
    seed: u64,
    choice: impl Fn(usize) -> &'c Choice,
) -> Shrinkage {
    let Problem { system, model, library } = problem;
    let trials: Vec<Vec<_>> = (0..CLOSURE_FOLDS)
        .map(|fold| {
            let Choice { columns, sizes, .. } = choice(fold);
            let trial = |columns: &Vec<usize>| model.trial(&effects_of(library, columns, sizes));
            columns.iter().map(trial).collect()
        })
        .collect();
    Shrinkage::of_changes(system, noise_scale, seed, |flight, segment| {
        let fold = fold_of(flight);
        let row = &system.data.segments[segment];
        let predictor = &system.data.predictor;
        let closed: f64 = trials[fold]
            .iter()
            .map(|trial| {
                model.response_at(&row.known, trial).map_or(0.0, |with| {
                    predictor.predict(&with)[0] - predictor.predict(&row.response)[0]
                })
            })
            .sum();
        let of_table = choice(fold).table.as_ref().map_or(0.0, |table| table.drag_at(system, row));
        closed / trials[fold].len().max(1) as f64 + of_table * row.drag_over_thrust
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shrinkage(before: &[f64], after: &[f64], floor: &[f64]) -> Shrinkage {
        Shrinkage {
            before: before.to_vec(),
            after: after.to_vec(),
            floor: floor.to_vec(),
            weights: vec![1.0; before.len()],
            segments: vec![1; before.len()],
            left: vec![],
            seed: 7,
        }
    }

    #[test]
    fn closure_by_hand() {
        // (5 − 2)/(5 − 1) = 0.75; all flights alike: no interval to speak of.
        let sure = shrinkage(&[5.0; 8], &[2.0; 8], &[1.0; 8]);
        let (closure, [low, high]) = sure.closure().unwrap();
        assert!((closure - 0.75).abs() < 1e-15);
        assert!((low - 0.75).abs() < 1e-12 && (high - 0.75).abs() < 1e-12);
        // 400 flights, every other one with 1 more left: closed 3 ± 0.5 of 4, standard error 0.5/√400/4 = 0.00625.
        let after: Vec<f64> = (0..400).map(|k| if k % 2 == 0 { 1.5 } else { 2.5 }).collect();
        let unsure = shrinkage(&[5.0; 400], &after, &[1.0; 400]);
        let (_, [low, high]) = unsure.closure().unwrap();
        assert!((low - (0.75 - 0.01225)).abs() < 0.0015, "{low}");
        assert!((high - (0.75 + 0.01225)).abs() < 0.0015, "{high}");
    }

    #[test]
    fn a_gap_within_the_floor_has_no_closure() {
        // 1.14 is less than 15 % above 1; 1.16 is more.
        assert!(shrinkage(&[1.14; 8], &[1.0; 8], &[1.0; 8]).closure().is_none());
        assert!(shrinkage(&[1.16; 8], &[1.0; 8], &[1.0; 8]).closure().is_some());
    }
    /// `[diagnosis.52]`, by hand: 0.1 less in the mean, with a standard deviation of 1 from flight to flight, is sure after
    /// (1.96/0.1)² = 384 flights.
    #[test]
    fn less_is_left_where_the_mean_is_beyond_its_scatter() {
        let left = |after: Vec<f64>| shrinkage(&vec![5.0; after.len()], &after, &[1.0]);
        for (flights, is_sure) in [(40, false), (4000, true)] {
            let one = left(vec![2.0; flights]);
            let other = left((0..flights).map(|k| if k % 2 == 0 { 3.1 } else { 1.1 }).collect());
            assert_eq!(one.leaves_less_than(&other), is_sure, "{flights}");
            assert!(!other.leaves_less_than(&one), "{flights}");
        }
        let same = left(vec![2.0; 8]);
        assert!(!same.leaves_less_than(&same));
    }

    /// `[diagnosis.53]`, by hand, as above: of a gap of 2.1 each flight keeps 3 or 1, 0.1 less in the mean.
    #[test]
    fn a_gap_surely_shrinks_where_the_mean_is_beyond_its_scatter() {
        let of = |flights: usize| {
            let after: Vec<f64> =
                (0..flights).map(|k| if k % 2 == 0 { 3.0 } else { 1.0 }).collect();
            shrinkage(&vec![2.1; flights], &after, &[1.0])
        };
        assert!(!of(40).closes());
        assert!(of(4000).closes());
        let same = shrinkage(&[2.0; 8], &[2.0; 8], &[1.0]);
        assert!(!same.closes());
    }
}
