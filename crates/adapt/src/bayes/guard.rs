//! Drag stays physical: positive, and rising with lift coefficient above its minimum.

use lut::{Grid, Table};

/// Least share of the initial drag that a correction may leave. Our choice: no aircraft has a tenth of its guide's drag.
const MINIMUM_SHARE: f64 = 0.1;

/// Report of the guard's action.
#[derive(Clone, Debug, PartialEq)]
pub struct GuardReport {
    /// The nodes it changed, ascending.
    pub nodes: Vec<GuardedNode>,
}

/// A node that the guard changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardedNode {
    /// The node.
    pub node: usize,
    /// Drag coefficient that the solution asked for.
    pub before: f64,
    /// Drag coefficient in the table.
    pub after: f64,
    /// The reason.
    pub reason: GuardReason,
}

/// What was unphysical.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GuardReason {
    /// Less than a tenth of the initial drag, or negative.
    NotPositive,
    /// Falling with lift coefficient where the initial table rises.
    NotRising,
}

/// Projects corrected drag onto physical drag: the nearest, in the sense of `precisions`, that keeps the initial
/// table's shape where it rises.
///
/// The initial table decides where drag must rise: along lift coefficient, at every Mach number, between neighbors
/// above its minimum. Where the initial table itself falls, there is no constraint. The projection is an isotonic
/// regression by pooling adjacent violators (Ayer et al. 1955): it ends in a flat stretch, never in a wiggle.
pub(super) fn project(
    initial: &Table,
    drag: &mut [f64],
    precisions: &[f64],
) -> Option<GuardReport> {
    let before = drag.to_vec();
    let mut reasons = vec![None; drag.len()];
    for (node, value) in drag.iter_mut().enumerate() {
        let least = MINIMUM_SHARE * initial.value_at_node(node);
        if *value < least {
            *value = least;
            reasons[node] = Some(GuardReason::NotPositive);
        }
    }
    let grid = initial.grid();
    for column in 0..grid.y().len() {
        for chain in rising_chains(grid, initial, column) {
            let values: Vec<f64> = chain.iter().map(|&node| drag[node]).collect();
            if values.windows(2).all(|pair| pair[0] <= pair[1]) {
                continue;
            }
            let weights: Vec<f64> = chain.iter().map(|&node| precisions[node]).collect();
            for (&node, value) in chain.iter().zip(isotonic(&values, &weights)) {
                if drag[node].to_bits() != value.to_bits() {
                    drag[node] = value;
                    reasons[node].get_or_insert(GuardReason::NotRising);
                }
            }
        }
    }
    let nodes: Vec<GuardedNode> = reasons
        .into_iter()
        .enumerate()
        .filter_map(|(node, reason)| {
            Some(GuardedNode { node, before: before[node], after: drag[node], reason: reason? })
        })
        .collect();
    (!nodes.is_empty()).then_some(GuardReport { nodes })
}

/// Runs of nodes along lift coefficient, from the minimum of the initial drag up, in which it never falls.
fn rising_chains(grid: &Grid, initial: &Table, column: usize) -> Vec<Vec<usize>> {
    let count = grid.y().len();
    let node = |row: usize| row * count + column;
    let drag = |row: usize| initial.value_at_node(node(row));
    let rows = grid.x().len();
    let lowest = (0..rows).min_by(|&a, &b| drag(a).total_cmp(&drag(b))).unwrap_or(0);
    let mut chains: Vec<Vec<usize>> = vec![vec![node(lowest)]];
    for row in lowest + 1..rows {
        if drag(row) < drag(row - 1) {
            chains.push(Vec::new());
        }
        if let Some(chain) = chains.last_mut() {
            chain.push(node(row));
        }
    }
    chains
}

/// The non-decreasing sequence nearest to `values` in weighted squares.
fn isotonic(values: &[f64], weights: &[f64]) -> Vec<f64> {
    // Pools: mean, weight, length.
    let mut pools: Vec<(f64, f64, usize)> = Vec::with_capacity(values.len());
    for (&value, &weight) in values.iter().zip(weights) {
        let mut pool = (value, weight, 1);
        while let Some(&(mean, total, length)) = pools.last() {
            if mean <= pool.0 {
                break;
            }
            pools.pop();
            let sum = total + pool.1;
            pool = ((total * mean + pool.1 * pool.0) / sum, sum, length + pool.2);
        }
        pools.push(pool);
    }
    pools.iter().flat_map(|&(mean, _, length)| std::iter::repeat_n(mean, length)).collect()
}
