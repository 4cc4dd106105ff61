//! The information that flights carry about nodes: precision matrix and vector, over the nodes that were ever touched.
//!
//! A flight's common error couples all nodes that the flight touched, so no fixed stencil holds the sum exactly. A
//! packed triangle over the nodes of the flown region does: it is exact, it can be added, and it grows with the region,
//! not with the flights. Slots are assigned in order of first touch; every number is a sum over flights in the order
//! learnt, the same whatever its slot.

use std::iter;

use faer::Mat;
use lut::Grid;

/// No slot yet.
const UNTOUCHED: u32 = u32::MAX;

/// Sums over flights, without any prior.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Information {
    /// Slot of each node of the grid.
    slots: Vec<u32>,
    /// Node of each slot.
    nodes: Vec<usize>,
    /// Lower triangle, row by row.
    matrix: Vec<f64>,
    vector: Vec<f64>,
    /// Σ bilinear weight × outlier weight (1 at most) × decay.
    observations: Vec<f64>,
}

/// One located observation with its precision, ready to be added.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) nodes: [usize; 4],
    /// Factors of the four nodes' corrections.
    pub(super) coefficients: [f64; 4],
    /// Bilinear weights, for the count.
    pub(super) bilinear: [f64; 4],
    /// Observed relative excess of drag over the initial table.
    pub(super) residual: f64,
    /// 1 / variance of this segment alone, outlier weight included.
    pub(super) precision: f64,
    /// How many observations it counts for, at most 1.
    pub(super) count: f64,
}

impl Information {
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            slots: vec![UNTOUCHED; nodes],
            nodes: Vec::new(),
            matrix: Vec::new(),
            vector: Vec::new(),
            observations: Vec::new(),
        }
    }

    /// Adds a flight: Wᵀ·V⁻¹·W and Wᵀ·V⁻¹·y with V = D + s²·1·1ᵀ, all times `share`.
    ///
    /// V⁻¹ = D⁻¹ − D⁻¹·1·1ᵀ·D⁻¹/(1/s² + 1ᵀ·D⁻¹·1), after Sherman and Morrison.
    pub(super) fn add_flight(&mut self, rows: &[Row], flight_variance: f64, share: f64) {
        // The flight's sums Σ precision·row, over the slots it touched.
        let mut common: Vec<(usize, f64)> = Vec::with_capacity(4 * rows.len().min(16));
        let (mut precision_sum, mut residual_sum) = (0.0, 0.0);
        for row in rows {
            let precision = share * row.precision;
            // A node without weight (the point lies on a grid line) is not touched.
            let mut slots = [0; 4];
            for k in (0..4).filter(|&k| row.coefficients[k] != 0.0) {
                slots[k] = self.slot(row.nodes[k]);
                let pull = precision * row.coefficients[k];
                for other in (0..=k).filter(|&other| row.coefficients[other] != 0.0) {
                    self.add(slots[k], slots[other], pull * row.coefficients[other]);
                }
                self.vector[slots[k]] += pull * row.residual;
                self.observations[slots[k]] += share * row.count * row.bilinear[k];
                let own = row.precision * row.coefficients[k];
                match common.iter_mut().find(|(slot, _)| *slot == slots[k]) {
                    Some((_, sum)) => *sum += own,
                    None => common.push((slots[k], own)),
                }
            }
            precision_sum += row.precision;
            residual_sum += row.precision * row.residual;
        }
        let factor = share / (1.0 / flight_variance + precision_sum);
        for (k, &(slot, sum)) in common.iter().enumerate() {
            let pull = -factor * sum;
            for &(other, other_sum) in &common[..=k] {
                self.add(slot, other, pull * other_sum);
            }
            self.vector[slot] += pull * residual_sum;
        }
    }

    /// Scales all information.
    pub(super) fn scale(&mut self, factor: f64) {
        let numbers = [&mut self.matrix, &mut self.vector, &mut self.observations];
        for number in numbers.into_iter().flatten() {
            *number *= factor;
        }
    }

    /// Adds the information of another sum over the same grid.
    pub(super) fn merge(&mut self, other: &Self) {
        let slots: Vec<usize> = other.nodes.iter().map(|&node| self.slot(node)).collect();
        let mut entries = other.matrix.iter();
        for (row, &slot) in slots.iter().enumerate() {
            for (&column, &value) in slots[..=row].iter().zip(entries.by_ref()) {
                self.add(slot, column, value);
            }
            self.vector[slot] += other.vector[row];
            self.observations[slot] += other.observations[row];
        }
    }

    /// Nodes ever touched, in the order of slots.
    pub(super) fn touched(&self) -> &[usize] {
        &self.nodes
    }

    /// The whole matrix and the vector over [`touched`](Self::touched).
    pub(super) fn of_touched(&self) -> (Mat<f64>, &[f64]) {
        let count = self.nodes.len();
        let matrix = Mat::from_fn(count, count, |row, column| self.matrix[packed(row, column)]);
        (matrix, &self.vector)
    }

    /// (node, other node, entry) of the precision's lower triangle.
    pub(super) fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let pairs = self
            .nodes
            .iter()
            .enumerate()
            .flat_map(|(row, &node)| iter::repeat(node).zip(&self.nodes[..=row]));
        pairs.zip(&self.matrix).map(|((node, &other), &value)| (node, other, value))
    }

    /// How many rows of nodes along x and y are coupled by non-zero entries.
    pub(super) fn reach(&self, grid: &Grid) -> (usize, usize) {
        let count = grid.y().len();
        self.entries().filter(|entry| entry.2 != 0.0).fold((0, 0), |(x, y), (node, other, _)| {
            let along_x = (node / count).abs_diff(other / count);
            let along_y = (node % count).abs_diff(other % count);
            (x.max(along_x), y.max(along_y))
        })
    }

    /// The vector in node order.
    pub(super) fn vector(&self) -> Vec<f64> {
        self.in_node_order(&self.vector)
    }

    /// Effective observations in node order.
    pub(super) fn observations(&self) -> Vec<f64> {
        self.in_node_order(&self.observations)
    }

    fn in_node_order(&self, of_slots: &[f64]) -> Vec<f64> {
        let value = |&slot: &u32| of_slots.get(slot as usize).copied().unwrap_or(0.0);
        self.slots.iter().map(value).collect()
    }

    /// Everything in the order of nodes, leading zeros of rows left out: what a file keeps.
    pub(super) fn to_parts(&self) -> Parts {
        let mut order: Vec<usize> = (0..self.nodes.len()).collect();
        order.sort_by_key(|&slot| self.nodes[slot]);
        let pick = |values: &[f64]| order.iter().map(|&slot| values[slot]).collect();
        let row = |rank: usize| -> Vec<f64> {
            let entry = |&other: &usize| self.matrix[packed(order[rank], other)];
            order[..=rank].iter().map(entry).skip_while(|value| *value == 0.0).collect()
        };
        Parts {
            nodes: order.iter().map(|&slot| self.nodes[slot]).collect(),
            rows: (0..order.len()).map(row).collect(),
            vector: pick(&self.vector),
            observations: pick(&self.observations),
        }
    }

    /// Restores it from [`to_parts`](Self::to_parts); the caller has checked lengths and nodes.
    pub(super) fn from_parts(nodes_of_grid: usize, parts: &Parts) -> Self {
        let mut information = Self::new(nodes_of_grid);
        for (rank, &node) in parts.nodes.iter().enumerate() {
            let slot = information.slot(node);
            let row = &parts.rows[rank];
            let start = packed(slot, slot) + 1 - row.len();
            information.matrix[start..].copy_from_slice(row);
            information.vector[slot] = parts.vector[rank];
            information.observations[slot] = parts.observations[rank];
        }
        information
    }

    /// The node's slot, created where there is none.
    fn slot(&mut self, node: usize) -> usize {
        if self.slots[node] == UNTOUCHED {
            let slot = self.nodes.len();
            #[expect(
                clippy::cast_possible_truncation,
                reason = "a grid has at most 10^12 nodes in \
                theory, and a triangle over 2^32 of them fits no memory"
            )]
            let short = slot as u32;
            self.slots[node] = short;
            self.nodes.push(node);
            self.matrix.resize(packed(slot, slot) + 1, 0.0);
            self.vector.push(0.0);
            self.observations.push(0.0);
        }
        self.slots[node] as usize
    }

    fn add(&mut self, slot: usize, other: usize, value: f64) {
        self.matrix[packed(slot, other)] += value;
    }
}

/// [`Information`] as it is written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parts {
    pub(super) nodes: Vec<usize>,
    pub(super) rows: Vec<Vec<f64>>,
    pub(super) vector: Vec<f64>,
    pub(super) observations: Vec<f64>,
}

/// Index of an entry in the packed lower triangle.
const fn packed(slot: usize, other: usize) -> usize {
    if slot >= other { slot * (slot + 1) / 2 + other } else { other * (other + 1) / 2 + slot }
}
