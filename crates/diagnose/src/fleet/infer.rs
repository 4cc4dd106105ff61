//! From the tails' Gram matrices to what acts in the type and on each tail.
//!
//! Difficult: what is free on a tail, what is free in the type, and how much everything else may act are chosen in turn, each
//! given the others, until they stay; every choice is by evidence. Probabilities come from the last turn.

use flight::effect::EffectId;

use crate::fleet::false_discoveries::kept;
use crate::fleet::found::{FleetDiagnosis, FleetFinding, FleetLevel};
use crate::fleet::frame::{FleetTail, SharedColumns};
use crate::fleet::joint::{TailGram, TypeGram};
use crate::fleet::levels::{Acting, At, Beliefs, LevelPosterior, Weighed, all_acting};
use crate::fleet::sizes::{Sizes, sizes};
use crate::library::Testable;
use crate::math::eliminate::integrate_out;
use crate::priors::{
    BACKGROUND_SPIKES, FLEET_FREE, FLEET_PRIOR_TAILS, NOISE_FREEDOM, PRIOR_BY_SIZE,
    SMOOTH_AMPLITUDES,
};
use crate::signals::references::DiagnoseError;
use crate::thresholds::{FALSE_DISCOVERIES, FEWEST_TAILS_OF_A_FLEET, FLEET_SWEEPS};

/// Diagnoses all tails of a type together. Takes their Gram matrices, which are most of the memory of a large fleet.
///
/// # Errors
/// [`DiagnoseError::TooFewTails`] below three tails, [`DiagnoseError::Degenerate`] where the numbers are degenerate.
pub fn diagnose_fleet(tails: &mut [&mut FleetTail]) -> Result<FleetDiagnosis, DiagnoseError> {
    if tails.len() < FEWEST_TAILS_OF_A_FLEET {
        return Err(DiagnoseError::TooFewTails {
            found: tails.len(),
            needed: FEWEST_TAILS_OF_A_FLEET,
        });
    }
    Fleet::new(tails).and_then(Fleet::infer).ok_or(DiagnoseError::Degenerate)
}

/// What is being found out.
struct Fleet {
    effects: Vec<Testable>,
    shared: SharedColumns,
    tails: Vec<TailGram>,
    of_type: Beliefs,
    of_tail: Beliefs,
    state: State,
}

/// What is chosen by evidence.
#[derive(Clone, Debug, PartialEq)]
struct State {
    /// Effects that are free on each tail, and in the type.
    free: Vec<Vec<usize>>,
    type_free: Vec<usize>,
    /// How much every other effect may act, of typical size: on a tail, in the type.
    tail_small: f64,
    type_small: f64,
    smooth_amplitude: f64,
    /// Noise of each tail over what was stated.
    noise: Vec<f64>,
}

/// What the last turn says of the type.
struct OfType {
    total: TypeGram,
    acting: Vec<Acting>,
}

impl Fleet {
    fn new(tails: &mut [&mut FleetTail]) -> Option<Self> {
        let shared = tails[0].shared;
        let mut effects: Vec<Testable> = Vec::new();
        for effect in tails.iter().flat_map(|tail| &tail.effects) {
            if !effects.iter().any(|known| known.id == effect.id) {
                effects.push(*effect);
            }
        }
        effects.sort_by_key(|effect| effect.id);
        let spread: Option<Vec<TailGram>> =
            tails.iter_mut().map(|tail| tail.take_spread(&effects, shared)).collect();
        let state = State {
            free: vec![Vec::new(); tails.len()],
            type_free: Vec::new(),
            tail_small: BACKGROUND_SPIKES[1],
            type_small: 0.0,
            smooth_amplitude: 0.0,
            noise: vec![1.0; tails.len()],
        };
        Some(Self {
            of_type: Beliefs::new(&effects, At::Type),
            of_tail: Beliefs::new(&effects, At::Tail),
            shared,
            tails: spread?,
            effects,
            state,
        })
    }

    fn infer(mut self) -> Option<FleetDiagnosis> {
        let mut found = None;
        for sweep in 0..FLEET_SWEEPS {
            let before = self.state.clone();
            let of_type = self.look_at_type()?;
            // At first nothing is known of the type: every effect is left free in it.
            let shared = if sweep == 0 { self.open() } else { self.shared_deviations() };
            let on_tails = self.look_at_tails(&of_type.total, &shared)?;
            let settled = sweep > 0 && before.is_like(&self.state);
            found = Some((of_type.acting, on_tails));
            if settled {
                break;
            }
        }
        let (of_type, on_tails) = found?;
        self.conclude(of_type, on_tails)
    }

    /// Prior standard deviations of what is shared as the type is known, and with every effect free.
    fn shared_deviations(&self) -> Vec<f64> {
        let state = &self.state;
        let mut all = self.of_type.deviations(state.type_small, &state.type_free);
        all.extend(self.shared.deviations(state.smooth_amplitude));
        all
    }

    fn open(&self) -> Vec<f64> {
        let mut all: Vec<f64> =
            self.effects.iter().map(|effect| FLEET_FREE * effect.prior_deviation).collect();
        all.extend(self.shared.deviations(self.state.smooth_amplitude));
        all
    }

    fn own_deviations(&self, tail: usize) -> Vec<f64> {
        self.of_tail.deviations(self.state.tail_small, &self.state.free[tail])
    }

    /// What the tails together say of the type; its free effects, the small ones and the smooth discrepancy are chosen.
    fn look_at_type(&mut self) -> Option<OfType> {
        let effects = self.effects.len();
        let columns = effects + self.shared.columns() + 1;
        let mut total = TypeGram::zero(columns);
        for (place, tail) in self.tails.iter().enumerate() {
            total.add(&tail.of_shared(&self.own_deviations(place))?, tail.rows);
        }
        let kept: Vec<usize> = (0..effects).chain([columns - 1]).collect();
        let mut grams = Vec::new();
        let amplitudes = if self.shared.columns() > 0 { &SMOOTH_AMPLITUDES[..] } else { &[0.0] };
        for &amplitude in amplitudes {
            let deviations = self.shared.deviations(amplitude);
            let (out, deviations): (Vec<usize>, Vec<f64>) =
                (effects..columns - 1).zip(deviations).filter(|(_, d)| *d > 0.0).unzip();
            let left = integrate_out(&total.matrix, &kept, &out, &deviations)?;
            let ln_weight = -0.5 * left.ln_determinant;
            grams.push((amplitude, Weighed { matrix: left.matrix, ln_weight }));
        }
        let mut chosen = None;
        let acting = all_acting(|free| {
            let mut best: Option<(LevelPosterior, f64, f64)> = None;
            for (amplitude, gram) in &grams {
                for small in BACKGROUND_SPIKES {
                    let found = self.of_type.posterior(gram, total.rows, small, free)?;
                    if best.as_ref().is_none_or(|(known, ..)| found.ln > known.ln) {
                        best = Some((found, *amplitude, small));
                    }
                }
            }
            let (posterior, amplitude, small) = best?;
            chosen = Some((amplitude, small));
            Some(posterior)
        })?;
        (self.state.smooth_amplitude, self.state.type_small) = chosen?;
        self.state.type_free = acting.iter().map(|one| one.effect).collect();
        Some(OfType { total, acting })
    }

    /// Each tail against the others; returns what acts on each.
    fn look_at_tails(&mut self, total: &TypeGram, shared: &[f64]) -> Option<Vec<Vec<Acting>>> {
        let effects = self.effects.len();
        let mut grams = Vec::with_capacity(self.tails.len());
        for (place, tail) in self.tails.iter().enumerate() {
            let own = tail.of_shared(&self.own_deviations(place))?;
            let others = total.without(&own, shared)?;
            grams.push(Weighed { matrix: tail.of_own(effects, &others)?, ln_weight: 0.0 });
        }
        // One amount of small effects for all tails, by the evidence of all.
        let mut best: Option<(f64, f64, f64)> = None;
        for small in BACKGROUND_SPIKES {
            let (mut ln, mut none) = (0.0, 0.0);
            for (tail, gram) in self.tails.iter().zip(&grams) {
                let found = self.of_tail.posterior(gram, tail.rows, small, &[])?;
                ln += found.ln;
                none += found.none();
            }
            if best.is_none_or(|(known, ..)| ln > known) {
                best = Some((ln, small, none));
            }
        }
        let (_, small, none) = best?;
        self.state.tail_small = small;
        self.of_tail.by_size = by_size(none, self.tails.len());
        let mut acting = Vec::with_capacity(self.tails.len());
        for (place, gram) in grams.iter_mut().enumerate() {
            let rows = self.tails[place].rows;
            let on_tail = all_acting(|free| self.of_tail.posterior(gram, rows, small, free))?;
            self.state.free[place] = on_tail.iter().map(|one| one.effect).collect();
            self.rescale(place, gram)?;
            acting.push(on_tail);
        }
        Some(acting)
    }

    /// Divides the noise of a tail out, as what is left beside its effects has it.
    fn rescale(&mut self, place: usize, gram: &mut Weighed) -> Option<()> {
        let effects = self.effects.len();
        let deviations = self.own_deviations(place);
        let out: Vec<usize> = (0..effects).filter(|&k| deviations[k] > 0.0).collect();
        let of_out: Vec<f64> = out.iter().map(|&k| deviations[k]).collect();
        let left = integrate_out(&gram.matrix, &[effects], &out, &of_out)?.matrix[(0, 0)];
        let rows = self.tails[place].rows;
        let square = (NOISE_FREEDOM + left) / (NOISE_FREEDOM + rows);
        self.tails[place].rescale(square);
        self.state.noise[place] *= square.sqrt();
        gram.matrix *= faer::Scale(1.0 / square);
        Some(())
    }

    fn conclude(&self, of_type: Vec<Acting>, on_tails: Vec<Vec<Acting>>) -> Option<FleetDiagnosis> {
        let state = &self.state;
        let of_type = of_type.into_iter().map(|one| (None, one));
        let on_tails = on_tails.into_iter().enumerate();
        let on_tails =
            on_tails.flat_map(|(at, found)| found.into_iter().map(move |one| (Some(at), one)));
        let acting: Vec<(Option<usize>, Acting)> = of_type.chain(on_tails).collect();
        let mut probabilities: Vec<f64> =
            acting.iter().map(|(_, acting)| acting.probability).collect();
        let count = kept(&mut probabilities, FALSE_DISCOVERIES);
        let least = count.checked_sub(1).map_or(f64::INFINITY, |last| probabilities[last]);
        let false_share =
            probabilities[..count].iter().fold(0.0, |sum, p| sum + (1.0 - p)) / count.max(1) as f64;
        let found = self.sizes()?;
        let findings = acting
            .into_iter()
            .filter(|(_, acting)| acting.probability >= least)
            .map(|(tail, acting)| self.finding(tail, &acting, &found))
            .collect();
        Some(FleetDiagnosis {
            effects: self.effects.iter().map(|effect| effect.id).collect(),
            findings,
            false_share,
            of_type: found.of_type,
            of_tails: found.of_tails,
            spread_of_typical: state.tail_small,
            smooth_amplitude: state.smooth_amplitude,
            noise: state.noise.clone(),
        })
    }

    fn sizes(&self) -> Option<Sizes> {
        let own: Vec<Vec<f64>> =
            (0..self.tails.len()).map(|tail| self.own_deviations(tail)).collect();
        sizes(&self.tails, &own, &self.shared_deviations())
    }

    fn finding(&self, tail: Option<usize>, acting: &Acting, sizes: &Sizes) -> FleetFinding {
        let id = |effect: usize| self.effects[effect].id;
        let level =
            |effect: usize| tail.map_or(FleetLevel::Type, |_| FleetLevel::on_tail(id(effect)));
        let mut levels: Vec<FleetLevel> = Vec::new();
        for level in acting.class.iter().map(|&effect| level(effect)) {
            if !levels.contains(&level) {
                levels.push(level);
            }
        }
        let mut class: Vec<EffectId> = acting.class.iter().map(|&k| id(k)).collect();
        let unasked = tail.map_or(&[][..], |_| unasked_rivals(id(acting.effect)));
        let among = 1 + unasked.len();
        class.extend(unasked);
        FleetFinding {
            level: level(acting.effect),
            levels,
            tail,
            effect: id(acting.effect),
            class,
            probability: acting.probability,
            effect_probability: acting.own_probability / among as f64,
            magnitude: tail.map_or_else(
                || sizes.of_type[acting.effect],
                |tail| sizes.own[tail][acting.effect],
            ),
        }
    }
}

impl State {
    /// Whether the same effects are free.
    fn is_like(&self, other: &Self) -> bool {
        self.free == other.free && self.type_free == other.type_free
    }
}

/// What else may make a tail change with time. A fleet's tails are compared without dates: what began at one, or gathered and was taken
/// back, is taken for a steady ageing, and nothing here tells them apart.
const fn unasked_rivals(effect: EffectId) -> &'static [EffectId] {
    match effect {
        EffectId::EngineAgeing => &[EffectId::StepChange, EffectId::EngineHistory],
        EffectId::AirframeAgeing => &[EffectId::StepChange, EffectId::AirframeHistory],
        _ => &[],
    }
}

/// Prior probabilities of none, one and two effects on a tail, from how many tails have none: effects come to a tail
/// independently of each other, so that their number is a Poisson number.
fn by_size(none: f64, tails: usize) -> [f64; 3] {
    let total: f64 = PRIOR_BY_SIZE.iter().sum();
    let prior = PRIOR_BY_SIZE[0] / total;
    let tails = tails as f64;
    let first = FLEET_PRIOR_TAILS.mul_add(prior, none) / (FLEET_PRIOR_TAILS + tails);
    let mean = -first.ln();
    let all = 1.0 + mean + 0.5 * mean * mean;
    [1.0, mean, 0.5 * mean * mean].map(|share| share / all)
}

#[cfg(test)]
mod tests;
