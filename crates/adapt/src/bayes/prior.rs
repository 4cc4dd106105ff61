//! The prior precision of the correction: size, slopes and bends, integrated over the plane.
//!
//! ```text
//! −2 ln p(x) = 1/A ∫ (x/σ)² dA + 1/A0 ∫ (x_c/s_c)² + (x_m/s_m)² + (x_cc/k_cc)² + 2 (x_cm/k_cm)² + (x_mm/k_mm)² dA
//! ```
//!
//! c lift coefficient, m Mach number, A the grid's area, A0 the patch's. Derivatives are finite differences on the axes
//! as they are, even or not, and every difference represents its share of the area: refining the grid refines the
//! integral and changes nothing else.

use lut::{Axis, Grid};

use super::BayesSettings;
use super::settings::{PATCH_LIFT_COEFFICIENT, PATCH_MACH};

/// Calls `add(i, j, value)` for contributions to the precision of nodes i and j; each pair once, in either order.
///
/// # Source
/// Book `[bayes.2]`; the penalty is a thin-plate spline's (Wahba 1990, section 2.4) with terms of lower order.
pub(super) fn visit(grid: &Grid, settings: &BayesSettings, mut add: impl FnMut(usize, usize, f64)) {
    let values = settings.values();
    let (c, m) = (Line::new(grid.x()), Line::new(grid.y()));
    let patch = PATCH_LIFT_COEFFICIENT * PATCH_MACH;
    let precision = |std: f64, area: f64| 1.0 / (area * std * std);
    let size = precision(values.correction_std, c.length * m.length);
    let slope_c = precision(values.slope_std_per_lift_coefficient, patch);
    let slope_m = precision(values.slope_std_per_mach, patch);
    let bend_cc = precision(values.bend_std_per_lift_coefficient_squared, patch);
    let bend_cm = precision(values.bend_std_per_lift_coefficient_mach, patch);
    let bend_mm = precision(values.bend_std_per_mach_squared, patch);

    let node = |i: usize, j: usize| i * m.shares.len() + j;
    for (i, &share_c) in c.shares.iter().enumerate() {
        for (j, &share_m) in m.shares.iter().enumerate() {
            square(&[(node(i, j), 1.0)], size * share_c * share_m, &mut add);
        }
    }
    for (i, &width) in c.widths.iter().enumerate() {
        for (j, &share_m) in m.shares.iter().enumerate() {
            let slope = [(node(i, j), -1.0 / width), (node(i + 1, j), 1.0 / width)];
            square(&slope, slope_c * width * share_m, &mut add);
        }
    }
    for (i, &share_c) in c.shares.iter().enumerate() {
        for (j, &width) in m.widths.iter().enumerate() {
            let slope = [(node(i, j), -1.0 / width), (node(i, j + 1), 1.0 / width)];
            square(&slope, slope_m * width * share_c, &mut add);
        }
    }
    for bend in &c.bends {
        for (j, &share_m) in m.shares.iter().enumerate() {
            let terms = [0, 1, 2].map(|k| (node(bend.first + k, j), bend.coefficients[k]));
            square(&terms, bend_cc * bend.share * share_m, &mut add);
        }
    }
    for (i, &share_c) in c.shares.iter().enumerate() {
        for bend in &m.bends {
            let terms = [0, 1, 2].map(|k| (node(i, bend.first + k), bend.coefficients[k]));
            square(&terms, bend_mm * bend.share * share_c, &mut add);
        }
    }
    for (i, &width_c) in c.widths.iter().enumerate() {
        for (j, &width_m) in m.widths.iter().enumerate() {
            let area = width_c * width_m;
            let twist = [
                (node(i, j), 1.0 / area),
                (node(i, j + 1), -1.0 / area),
                (node(i + 1, j), -1.0 / area),
                (node(i + 1, j + 1), 1.0 / area),
            ];
            square(&twist, 2.0 * bend_cm * area, &mut add);
        }
    }
}

/// How many rows of nodes along an axis a difference of the prior couples.
pub(super) fn reach(axis: &Axis) -> usize {
    if axis.len() > 2 { 2 } else { 1 }
}

/// The precision of `weight · (Σ coefficient·x_node)²`.
fn square(terms: &[(usize, f64)], weight: f64, add: &mut impl FnMut(usize, usize, f64)) {
    for (k, &(node, coefficient)) in terms.iter().enumerate() {
        for &(earlier, other) in &terms[..=k] {
            add(node, earlier, weight * coefficient * other);
        }
    }
}

/// An axis ready for integrals of values, slopes and second derivatives.
struct Line {
    length: f64,
    widths: Vec<f64>,
    /// How much of the axis each node represents.
    shares: Vec<f64>,
    bends: Vec<Bend>,
}

/// A second derivative from three neighbors, and how much of the axis it represents.
struct Bend {
    first: usize,
    coefficients: [f64; 3],
    share: f64,
}

impl Line {
    fn new(axis: &Axis) -> Self {
        let widths: Vec<f64> =
            axis.breakpoints().windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mut shares = vec![0.0; axis.len()];
        for (i, width) in widths.iter().enumerate() {
            shares[i] += width / 2.0;
            shares[i + 1] += width / 2.0;
        }
        let last = widths.len().saturating_sub(2);
        let bends = widths
            .windows(2)
            .enumerate()
            .map(|(first, pair)| {
                let (a, b) = (pair[0], pair[1]);
                // The first and the last also represent the half cells beyond them, so that shares fill the axis.
                let beyond_low = if first == 0 { a / 2.0 } else { 0.0 };
                let beyond_high = if first == last { b / 2.0 } else { 0.0 };
                Bend {
                    first,
                    coefficients: [2.0 / (a * (a + b)), -2.0 / (a * b), 2.0 / (b * (a + b))],
                    share: a.midpoint(b) + beyond_low + beyond_high,
                }
            })
            .collect();
        Self { length: axis.last() - axis.first(), widths, shares, bends }
    }
}
