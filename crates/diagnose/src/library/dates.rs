//! Dates that are tried: of steps, and of what histories take back. First coarse, then closer about what leads.

use flight::effect::{EffectId, HiddenParameter, History, MAXIMUM_FALLS, StepTarget};
use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

use crate::priors::{HISTORY_DATES, MOST_USUAL_RATE, RECOVERED_COARSE, RECOVERED_FINE, STEP_DATES};

/// Dates on either side of a leading one that are tried next.
const NEIGHBOURS: usize = 4;

/// Whether an effect begins, or is taken back, at dates.
pub(crate) fn is_dated(id: EffectId) -> bool {
    matches!(id.entry().hidden, HiddenParameter::Step { .. } | HiddenParameter::History(_))
}

/// Hidden parameters of the dated effects, and between how many they choose.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DateGrid {
    /// Instants between consecutive flights, s since 1970, in order.
    between_s: Vec<f64>,
    /// Instants of known events among the flights.
    events_s: Vec<f64>,
    /// When histories begin to gather, and how many years the flights last.
    since_s: f64,
    span_years: f64,
    /// What a step may be of.
    targets: Vec<StepTarget>,
    steps: Course,
    engine: Course,
    airframe: Course,
}

/// What is tried of one dated effect, and how far the search for its dates is.
#[derive(Clone, Debug, PartialEq)]
struct Course {
    tried: Vec<HiddenParameter>,
    /// Number of flights between neighbouring dates; dates cannot be closer than 1.
    spacing: usize,
    stage: Stage,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Dates over all flights.
    Coarse,
    /// Dates about a leading one.
    Closer,
    /// So many falls, of which the last is new.
    OneMoreFall(usize),
    /// One more fall was not needed.
    Settled,
}

impl DateGrid {
    /// For flights that start at these instants. `reference_s` is the date at which the model is right, where it has learnt;
    /// `events_s` are instants at which something is known to have been done.
    pub(crate) fn coarse(starts_s: &[f64], events_s: &[f64], reference_s: Option<f64>) -> Self {
        let mut starts = starts_s.to_vec();
        starts.sort_by(f64::total_cmp);
        let between_s: Vec<f64> = starts
            .windows(2)
            .filter(|pair| pair[1] > pair[0])
            .map(|pair| f64::midpoint(pair[0], pair[1]))
            .collect();
        let (first, last) =
            (starts.first().copied().unwrap_or(0.0), starts.last().copied().unwrap_or(0.0));
        let among = |instant: &&f64| **instant > first && **instant < last;
        let nothing = Course { tried: vec![], spacing: 1, stage: Stage::Coarse };
        let mut grid = Self {
            events_s: events_s.iter().filter(among).copied().collect(),
            since_s: reference_s.map_or(first, |reference| reference.min(first)),
            span_years: (last - first) / (DAYS_PER_YEAR * SECONDS_PER_DAY),
            targets: vec![StepTarget::FuelFlow, StepTarget::Drag],
            steps: nothing.clone(),
            engine: nothing.clone(),
            airframe: nothing,
            between_s,
        };
        let course =
            |tried, dates| Course { tried, spacing: grid.spacing_of(dates), stage: Stage::Coarse };
        let steps = course(grid.steps_at(&grid.with_events(STEP_DATES)), STEP_DATES);
        let histories = grid.coarse_histories(&grid.with_events(HISTORY_DATES));
        let histories = course(histories, HISTORY_DATES);
        grid.steps = steps;
        grid.engine = histories.clone();
        grid.airframe = histories;
        grid
    }

    /// The same with steps of each of the first `engines` engines alone.
    pub(crate) fn with_single_engines(mut self, engines: usize) -> Self {
        self.targets.extend(StepTarget::ENGINES.into_iter().take(engines));
        self.steps.tried = self.steps_at(&self.with_events(STEP_DATES));
        self
    }

    /// Hidden parameters of an effect that are tried.
    pub(crate) fn hidden(&self, id: EffectId) -> &[HiddenParameter] {
        &self.course(id).tried
    }

    /// ln of the number of hidden parameters that one of an effect is chosen from: every flight may be the first after a date,
    /// however few of them are tried. `None` where all that are tried are alike and stand for the rest.
    pub(crate) fn ln_choices(&self, id: EffectId, hidden: HiddenParameter) -> Option<f64> {
        let (falls, others) = match hidden {
            HiddenParameter::Step { .. } => (1, self.targets.len()),
            HiddenParameter::History(history) => (history.falls_s().count(), RECOVERED_FINE.len()),
            _ => return None,
        };
        let course = self.course(id);
        if course.stage == Stage::Coarse {
            return None;
        }
        // One date stands for its neighbours, as many as lie between two that are tried.
        let dates = self.between_s.len().max(1) as f64;
        let orders: f64 = (1..=falls).map(|k| (k as f64).ln()).sum();
        let chosen = falls as f64 * dates.ln() - orders;
        Some((chosen + (others as f64).ln() - (course.spacing.max(1) as f64).ln()).max(0.0))
    }

    /// The usual rate of a history whose entry says `typical`, %/year: at least what gathers in half of the flights' time to
    /// as much as a usual fall takes back, as far as there are such rates.
    pub(crate) fn typical_rate(&self, typical: f64, usual_fall_percent: f64) -> f64 {
        if self.span_years > 0.0 {
            typical.max((usual_fall_percent / (0.5 * self.span_years)).min(MOST_USUAL_RATE))
        } else {
            typical
        }
    }

    /// Closer dates about a leading hidden parameter; where they cannot be closer, one more fall for a history. `None` where
    /// nothing is left to try. `rival` is the most probable history of an effect, whatever its probability.
    pub(crate) fn closer(
        &self,
        id: EffectId,
        leading: HiddenParameter,
        rival: impl Fn(EffectId) -> Option<History>,
    ) -> Option<Self> {
        let course = self.course(id);
        let spacing = course.spacing.div_ceil(NEIGHBOURS);
        let next = match leading {
            HiddenParameter::Step { from_s, .. } if course.spacing > 1 => Course {
                tried: self.steps_at(&self.about(from_s, spacing)),
                spacing,
                stage: Stage::Closer,
            },
            HiddenParameter::History(history) => {
                let falls = history.falls_s().count();
                match course.stage {
                    Stage::Settled => return None,
                    Stage::OneMoreFall(tried) if falls < tried => Course {
                        tried: self.histories_about(&history, 1),
                        spacing: 1,
                        stage: Stage::Settled,
                    },
                    _ if course.spacing > 1 => Course {
                        tried: self.histories_about(&history, spacing),
                        spacing,
                        stage: Stage::Closer,
                    },
                    _ if falls < MAXIMUM_FALLS => Course {
                        tried: self.with_one_more_fall(&history),
                        spacing: self.spacing_of(HISTORY_DATES),
                        stage: Stage::OneMoreFall(falls + 1),
                    },
                    _ => return None,
                }
            }
            _ => return None,
        };
        let mut grid = self.clone();
        if let HiddenParameter::Step { from_s, target } = leading {
            grid.bring_histories_along(from_s, target, next.spacing, rival);
        }
        *grid.course_mut(id) = next;
        Some(grid)
    }

    /// Histories from dates as close as those of a step that leads: the one that falls where the step is (a steady
    /// deterioration beside a step back is a history in other words), and of each effect the best so far about its own falls
    /// (a deterioration that a late fall ends is a step up, somewhere before). A step would win by its closer date alone.
    fn bring_histories_along(
        &mut self,
        from_s: f64,
        target: StepTarget,
        spacing: usize,
        rival: impl Fn(EffectId) -> Option<History>,
    ) {
        for (id, of) in [
            (EffectId::EngineHistory, StepTarget::FuelFlow),
            (EffectId::AirframeHistory, StepTarget::Drag),
        ] {
            let course = self.course(id);
            let is_behind = matches!(course.stage, Stage::Coarse | Stage::Closer);
            if !is_behind || course.spacing <= spacing {
                continue;
            }
            let there = (of == target)
                .then(|| History::new(self.since_s, RECOVERED_FINE[0], &[from_s]).ok())
                .flatten();
            let mut tried = Vec::new();
            for history in there.into_iter().chain(rival(id)) {
                for hidden in self.histories_about(&history, spacing) {
                    if !tried.contains(&hidden) {
                        tried.push(hidden);
                    }
                }
            }
            if !tried.is_empty() {
                *self.course_mut(id) = Course { tried, spacing, stage: Stage::Closer };
            }
        }
    }

    const fn course(&self, id: EffectId) -> &Course {
        match id {
            EffectId::EngineHistory => &self.engine,
            EffectId::AirframeHistory => &self.airframe,
            _ => &self.steps,
        }
    }

    const fn course_mut(&mut self, id: EffectId) -> &mut Course {
        match id {
            EffectId::EngineHistory => &mut self.engine,
            EffectId::AirframeHistory => &mut self.airframe,
            _ => &mut self.steps,
        }
    }

    /// Number of flights between so many dates.
    fn spacing_of(&self, dates: usize) -> usize {
        self.between_s.len().div_ceil(dates)
    }

    /// So many dates with equally many flights between, and those of events.
    fn with_events(&self, dates: usize) -> Vec<f64> {
        self.evenly(dates).into_iter().chain(self.events_s.iter().copied()).collect()
    }

    /// So many dates, with equally many flights between.
    fn evenly(&self, dates: usize) -> Vec<f64> {
        let flights = self.between_s.len() + 1;
        let mut found: Vec<f64> = (1..=dates)
            .map(|k| k * flights / (dates + 1))
            .filter(|at| *at > 0 && *at < flights)
            .map(|at| self.between_s[at - 1])
            .collect();
        found.dedup();
        found
    }

    /// Dates on both sides of one, so many flights apart.
    fn about(&self, date_s: f64, spacing: usize) -> Vec<f64> {
        let at = self.between_s.partition_point(|between| *between < date_s);
        let mut found: Vec<f64> = (0..=2 * NEIGHBOURS)
            .filter_map(|k| (at + k * spacing).checked_sub(NEIGHBOURS * spacing))
            .filter_map(|index| self.between_s.get(index).copied())
            .collect();
        if self.events_s.contains(&date_s) {
            found.push(date_s);
        }
        found
    }

    /// One fall at each date, and one at every event.
    fn coarse_histories(&self, dates_s: &[f64]) -> Vec<HiddenParameter> {
        let one = dates_s.iter().map(std::slice::from_ref);
        let all = (self.events_s.len() > 1 && self.events_s.len() <= MAXIMUM_FALLS)
            .then_some(&self.events_s[..]);
        one.chain(all).flat_map(|falls| self.histories(falls, &RECOVERED_COARSE)).collect()
    }

    /// The last fall that was found moved, every share that is taken back.
    fn histories_about(&self, history: &History, spacing: usize) -> Vec<HiddenParameter> {
        let falls: Vec<f64> = history.falls_s().collect();
        let mut tried = Vec::new();
        for moved in 0..falls.len() {
            if self.events_s.contains(&falls[moved]) && falls.len() > 1 {
                continue;
            }
            for date_s in self.about(falls[moved], spacing) {
                let mut falls = falls.clone();
                falls[moved] = date_s;
                tried.extend(self.histories(&falls, &RECOVERED_FINE));
            }
        }
        tried
    }

    /// A history, and the same with one more fall.
    fn with_one_more_fall(&self, history: &History) -> Vec<HiddenParameter> {
        let falls: Vec<f64> = history.falls_s().collect();
        let mut tried = vec![HiddenParameter::History(*history)];
        for date_s in self.evenly(HISTORY_DATES) {
            let more: Vec<f64> = falls.iter().copied().chain([date_s]).collect();
            tried.extend(self.histories(&more, &[history.recovered()]));
        }
        tried
    }

    fn steps_at(&self, dates_s: &[f64]) -> Vec<HiddenParameter> {
        let at = |&from_s: &f64| {
            self.targets.iter().map(move |&target| HiddenParameter::Step { from_s, target })
        };
        dates_s.iter().flat_map(at).collect()
    }

    fn histories(&self, falls_s: &[f64], recovered: &[f64]) -> Vec<HiddenParameter> {
        let histories = recovered.iter().map(|share| History::new(self.since_s, *share, falls_s));
        histories.flatten().map(HiddenParameter::History).collect()
    }
}

#[cfg(test)]
mod tests;
