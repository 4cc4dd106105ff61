use super::*;
use crate::piece::Piece;

fn filtered(beliefs: ChangeBeliefs, y: &[f64], event: Option<usize>) -> ChangeFilter {
    let mut filter = ChangeFilter::new(beliefs);
    for (index, &deviation_percent) in y.iter().enumerate() {
        let event_before =
            if event == Some(index) { EventBefore::Recorded } else { EventBefore::None };
        let years = 0.01 * index as f64;
        filter.push(&FilteredFlight { years, deviation_percent, weight: 4.0, event_before });
    }
    filter
}

fn log_evidence(piece: &Piece, beliefs: &ChangeBeliefs) -> f64 {
    let evidence = piece.evidence(beliefs);
    evidence.factor.ln() + evidence.exponent
}

/// Every division of the flights into pieces, with its ln prior times evidence.
fn all_divisions(
    beliefs: &ChangeBeliefs,
    y: &[f64],
    event: Option<usize>,
) -> Vec<(Vec<usize>, f64)> {
    let mut sums = RunningSums::new();
    for (index, value) in y.iter().enumerate() {
        sums.push(0.01 * index as f64, *value, 4.0);
    }
    (0..1_usize << (y.len() - 1))
        .map(|bits| {
            let mut log = 0.0;
            let mut starts = vec![0];
            for flight in 1..y.len() {
                let change = if event == Some(flight) {
                    beliefs.change_at_event
                } else {
                    beliefs.change_within(0.01)
                };
                if bits >> (flight - 1) & 1 == 1 {
                    log += change.ln();
                    starts.push(flight);
                } else {
                    log += (1.0 - change).ln();
                }
            }
            for (piece, start) in starts.iter().enumerate() {
                let end = starts.get(piece + 1).copied().unwrap_or(y.len());
                log += log_evidence(&sums.piece(*start, end), beliefs);
            }
            (starts, log)
        })
        .collect()
}

/// Oracle: the sum over all 2¹¹ divisions of a dozen flights, one by one.
#[test]
fn density_probabilities_and_best_division_by_brute_force() {
    let beliefs = ChangeBeliefs { changes_per_year: 10.5, ..ChangeBeliefs::of_2026() };
    let y = [0.1, -0.4, 0.3, 0.0, 1.6, 1.1, 1.9, 1.4, 0.2, -0.3, 0.4, 0.1];
    for event in [None, Some(8)] {
        let filter = filtered(beliefs, &y, event);
        let divisions = all_divisions(&beliefs, &y, event);
        let total: f64 = divisions.iter().map(|(_, log)| log.exp()).sum();
        assert!((filter.log_density() - total.ln()).abs() < 1e-9);
        let probabilities = filter.probabilities();
        for (flight, probability) in probabilities.iter().enumerate() {
            let with = divisions.iter().filter(|(starts, _)| starts.contains(&flight));
            let expected = with.map(|(_, log)| log.exp()).sum::<f64>() / total;
            assert!((probability - expected).abs() < 1e-8, "flight {flight}");
        }
        let best = divisions.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert_eq!(filter.best_division(), best.0[1..]);
        assert_eq!(best.0, [0, 4, 8]);
    }
}

/// What is forgotten of a long history is too little to matter. Oracle: the same sums over all starts, none forgotten.
#[test]
fn forgetting_does_not_matter() {
    let beliefs = ChangeBeliefs::of_2026();
    let mut random = 7_u64;
    let mut noise = || {
        random =
            random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 40) as f64 / f64::from(1_u32 << 23) - 1.0
    };
    let y: Vec<f64> = (0..600).map(|k| if k < 350 { noise() } else { 0.8 + noise() }).collect();
    let filter = filtered(beliefs, &y, None);
    let mut sums = RunningSums::new();
    let change = beliefs.change_within(0.01);
    let stay = (1.0 - change).ln();
    let mut density = vec![0.0_f64];
    let mut shares: Vec<Vec<f64>> = Vec::new();
    for (index, value) in y.iter().enumerate() {
        sums.push(0.01 * index as f64, *value, 4.0);
        let summand = |start: usize| {
            let change = if start > 0 { change.ln() } else { 0.0 };
            density[start]
                + change
                + stay * (index - start) as f64
                + log_evidence(&sums.piece(start, index + 1), &beliefs)
        };
        let summands: Vec<f64> = (0..=index).map(summand).collect();
        let largest = summands.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = summands.iter().map(|summand| (summand - largest).exp()).sum();
        density.push(largest + sum.ln());
        shares.push(summands.iter().map(|s| (s - density[index + 1]).exp()).collect());
    }
    let mut exact = vec![0.0; y.len() + 1];
    exact[y.len()] = 1.0;
    for end in (1..=y.len()).rev() {
        for start in 0..end {
            exact[start] += exact[end] * shares[end - 1][start];
        }
    }
    for (flight, probability) in filter.probabilities().iter().enumerate() {
        assert!(
            (probability - exact[flight]).abs() < 1e-3,
            "flight {flight}: {probability} {}",
            exact[flight]
        );
    }
    assert_eq!(filter.best_division(), [350]);
    assert!(filter.starts.len() <= MOST_STARTS);
}

/// Where nothing changes, as many starts are remembered as may be, the first among them, and they share all probability.
#[test]
fn the_least_probable_start_goes() {
    let beliefs = ChangeBeliefs::of_2026();
    let y: Vec<f64> = (0..500).map(|k| [0.3, -0.2, 0.1, -0.3, 0.2, -0.1][k * 7 % 6]).collect();
    let filter = filtered(beliefs, &y, None);
    assert_eq!(filter.starts.len(), MOST_STARTS);
    assert_eq!(filter.starts[0].index, 0);
    let sum: f64 = filter.starts.iter().map(|start| start.share).sum();
    assert!((sum - 1.0).abs() < 1e-12, "{sum}");
    assert!(filter.starts.windows(2).all(|pair| pair[0].index < pair[1].index));
}

/// By hand: a year of one change a year, 1 − 1/e; a stand of ten years is no more than an event; the same instant is possible.
#[test]
fn changes_come_with_time() {
    let beliefs = ChangeBeliefs::of_2026();
    let a_day = beliefs.change_within(1.0 / 365.25);
    assert!((a_day - 0.002_734_098).abs() < 1e-8, "{a_day}");
    assert!((beliefs.change_within(0.5) - 0.393_469_340).abs() < 1e-8);
    assert!((beliefs.change_within(10.0) - 0.5).abs() < 1e-15);
    let same = beliefs.change_within(0.0);
    assert!(0.0 < same && same < 1e-5, "{same}");
}
