//! Sizes of effects in the type and on each tail, shrunk, with intervals.

use crate::fleet::joint::{Shared, TailGram, TypeGram};
use crate::output::Magnitude;
use crate::thresholds::NORMAL_95;

/// Sizes of every effect.
#[derive(Clone, Debug)]
pub(crate) struct Sizes {
    pub(crate) of_type: Vec<Magnitude>,
    /// Of each tail, that of the type included.
    pub(crate) of_tails: Vec<Vec<Magnitude>>,
    /// By how much each tail differs from its type.
    pub(crate) own: Vec<Vec<Magnitude>>,
}

/// From the tails' Grams, the prior standard deviations of each tail's own effects and those of what is shared.
pub(crate) fn sizes(tails: &[TailGram], own: &[Vec<f64>], shared: &[f64]) -> Option<Sizes> {
    let effects = own.first()?.len();
    let columns = tails.first()?.matrix.ncols();
    let mut total = TypeGram::zero(columns);
    let of_shared: Option<Vec<_>> =
        tails.iter().zip(own).map(|(tail, own)| tail.of_shared(own)).collect();
    let of_shared = of_shared?;
    for (tail, of_tail) in tails.iter().zip(&of_shared) {
        total.add(of_tail, tail.rows);
    }
    let moments = Shared::new(&total.matrix, shared)?.moments(effects)?;
    let mut found = Sizes {
        of_type: moments.into_iter().map(magnitude).collect(),
        of_tails: Vec::with_capacity(tails.len()),
        own: Vec::with_capacity(tails.len()),
    };
    for ((tail, own), of_tail) in tails.iter().zip(own).zip(&of_shared) {
        let others = total.without(of_tail, shared)?;
        let (mean, covariance) = tail.together(&others, own)?;
        let own_places = (0..effects).filter(|&k| own[k] > 0.0);
        let place_own: Vec<(usize, usize)> =
            own_places.enumerate().map(|(at, k)| (k, others.columns.len() + at)).collect();
        let mut all = Vec::with_capacity(effects);
        let mut of_own = Vec::with_capacity(effects);
        for effect in 0..effects {
            let in_type = others.columns.iter().position(|&column| column == effect);
            let on_tail = place_own.iter().find(|(k, _)| *k == effect).map(|(_, at)| *at);
            let sum = |places: &[Option<usize>]| {
                let places: Vec<usize> = places.iter().flatten().copied().collect();
                let value = places.iter().map(|&a| mean[a]).sum::<f64>();
                let pairs = places.iter().flat_map(|&a| places.iter().map(move |&b| (a, b)));
                let variance: f64 = pairs.map(|(a, b)| covariance[(a, b)]).sum();
                magnitude((value, variance.max(0.0).sqrt()))
            };
            all.push(sum(&[in_type, on_tail]));
            of_own.push(sum(&[on_tail]));
        }
        found.of_tails.push(all);
        found.own.push(of_own);
    }
    Some(found)
}

fn magnitude((value, deviation): (f64, f64)) -> Magnitude {
    Magnitude { value, ci95: [value - NORMAL_95 * deviation, value + NORMAL_95 * deviation] }
}
