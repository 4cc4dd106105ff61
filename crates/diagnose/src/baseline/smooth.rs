//! Smooth functions of one variable: a Gaussian process on a few knots.

use effects::Variable;
use serde::{Deserialize, Serialize};

use crate::math::cholesky::Cholesky;
use crate::math::curve::{Curve, Pieces};
use crate::math::lanes::{LANES, Lanes, add, add_product, each, map};
use crate::math::vector_ln_exp::exp;
use crate::priors::{LEAST_SCALE_BEYOND_MACH, SMOOTH_KNOT_DISTANCE, SMOOTH_MOST_KNOTS};
use faer::Mat;

mod mean;

/// Share of a knot's variance that keeps the kernel's matrix positive definite in doubles.
const JITTER: f64 = 1e-6;

/// Growth of what is not known beyond the flown values, per cube of lengths. Arithmetic: an integrated Wiener process whose
/// slope changes over one length by as much as that of the squared exponential kernel, 2/length², has q = 2/length³, and its
/// variance beyond the last value is q·distance³/3.
const GROWTH_BEYOND: f64 = 2.0 / 3.0;

/// Lengths beyond the last flown value that are still that value: it is computed on several ways.
pub(crate) const BEYOND_BY_ROUNDING: f64 = 1e-9;

/// A smooth function of one variable: a slope, and a Gaussian process with a squared exponential kernel on equally distant
/// knots over what was flown. Beyond the knots the process fades to 0 and the slope goes on; what is not known there grows as
/// beyond the data of a cubic smoothing spline, with the cube of the distance.
///
/// ```text
/// f(v) = s·z + φ(z)ᵀc,  φ = L⁻¹k(Z, z),  LLᵀ = k(Z, Z),  k(a, b) = exp(−(a − b)²/2),  z = (v − middle)/length   [baseline.1]
/// ```
///
/// # Source
/// Rasmussen and Williams 2006, sections 4.2 and 8.3 (subset of regressors); beyond the data Wahba 1978,
/// doi 10.1111/j.2517-6161.1978.tb01050.x (the spline as an integrated Wiener process).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SmoothText", into = "SmoothText")]
pub(crate) struct Smooth {
    text: SmoothText,
    /// Lower Cholesky factor of the kernel at the knots.
    root: Mat<f64>,
    /// The same row by row, each row ending in the inverse of its diagonal.
    rows: Vec<f64>,
}

/// A smooth function as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Smooth")]
struct SmoothText {
    variable: Variable,
    middle: f64,
    /// Over which the function bends, in the variable's unit.
    length: f64,
    /// First and last knot, in lengths from the middle.
    knots: (f64, f64),
    count: usize,
    /// How far a guide goes on below and above the flown values, lengths; 0 in files from before it was asked.
    #[serde(default, skip_serializing_if = "is_nowhere")]
    guide: (f64, f64),
    /// Growth of what is not known beyond the flown values, of the process' variance per cube of lengths.
    #[serde(skip, default = "growth_beyond")]
    growth: f64,
}

const fn is_nowhere(reach: &(f64, f64)) -> bool {
    reach.0 <= 0.0 && reach.1 <= 0.0
}

const fn growth_beyond() -> f64 {
    GROWTH_BEYOND
}

impl SmoothText {
    /// Terms: the slope, then the process.
    const fn terms(&self) -> usize {
        1 + self.count
    }

    /// Lengths from the middle.
    fn at(&self, value: f64) -> f64 {
        (value - self.middle) / self.length
    }

    /// Between two knots, lengths.
    fn distance(&self) -> f64 {
        let (first, last) = self.knots;
        (last - first) / (self.count - 1) as f64
    }

    /// How far a value lies beyond the values that were flown, which end one knot inside the last; lengths.
    fn beyond(&self, z: f64) -> f64 {
        let ((first, last), distance) = (self.knots, self.distance());
        (first + distance - z).max(z - last + distance).max(0.0)
    }

    /// Whether a place lies nearer to the last knot than to the first.
    fn is_above(&self, z: f64) -> bool {
        let (first, last) = self.knots;
        z > f64::midpoint(first, last)
    }

    /// Of a distance beyond the flown values, above or below them, how far the guide goes, and what is left.
    fn split_by_guide(&self, is_above: bool, beyond: f64) -> (f64, f64) {
        let (below, above) = self.guide;
        let known = beyond.min(if is_above { above } else { below });
        (known, beyond - known)
    }

    /// What of the process' variance terms which hold so much of it do not hold: more beyond what was flown.
    fn left_of_variance(&self, z: f64, held: f64) -> LeftOfProcess {
        let beyond = self.beyond(z);
        let (known, rest) = self.split_by_guide(self.is_above(z), beyond);
        let grown = |distance: f64| self.growth * distance * distance * distance;
        let beyond_guide = grown(rest);
        let left = grown(known).max(1.0 - held - beyond_guide).max(0.0);
        let is_beyond = beyond > BEYOND_BY_ROUNDING;
        LeftOfProcess {
            between_knots: if is_beyond { 0.0 } else { left },
            within_guide: if is_beyond { left } else { 0.0 },
            beyond_guide,
        }
    }
}

/// Shares of a process' variance that its terms do not hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LeftOfProcess {
    /// Within what was flown.
    pub(crate) between_knots: f64,
    /// Beyond it, as far as the guide goes.
    pub(crate) within_guide: f64,
    /// Beyond the guide, in addition.
    pub(crate) beyond_guide: f64,
}

impl LeftOfProcess {
    /// All of them.
    pub(crate) const fn total(self) -> f64 {
        self.between_knots + self.within_guide + self.beyond_guide
    }
}

/// Numbers that are not a smooth function.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "a smooth function of {count} knots from {} to {} at a length of {length}, a guide that goes on by {} and {}",
    .knots.0, .knots.1, .guide.0, .guide.1
)]
pub(crate) struct SmoothError {
    count: usize,
    knots: (f64, f64),
    length: f64,
    guide: (f64, f64),
}

impl Smooth {
    /// Over the values that were flown; `None` without any. One value alone is the middle of a short range: what lies beyond it is not
    /// known for that.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number from 1 to the most knots"
    )]
    pub(crate) fn over(variable: Variable, length: f64, values: &[f64]) -> Option<Self> {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if !(low.is_finite() && high.is_finite()) {
            return None;
        }
        let middle = values.iter().sum::<f64>() / values.len() as f64;
        // One knot more on each side: a process of few knots sags between the last one and the end.
        let (first, last) = ((low - middle) / length, (high - middle) / length);
        let intervals = ((last - first) / SMOOTH_KNOT_DISTANCE).ceil().max(1.0);
        let most = (SMOOTH_MOST_KNOTS - 3) as f64;
        // A range of very many lengths bends over a longer one.
        let stretch = (intervals / most).max(1.0);
        let intervals = intervals.min(most);
        let distance = ((last - first) / stretch / intervals).max(SMOOTH_KNOT_DISTANCE / 2.0);
        let center = f64::midpoint(first, last) / stretch;
        let half = distance * (intervals / 2.0 + 1.0);
        let text = SmoothText {
            variable,
            middle,
            length: length * stretch,
            knots: (center - half, center + half),
            count: intervals as usize + 3,
            guide: (0.0, 0.0),
            growth: GROWTH_BEYOND,
        };
        Self::try_from(text).ok()
    }

    /// Tells it the factor that flights found on the process' prior standard deviation. Beyond the Mach numbers that were flown what
    /// is not known grows by that of the prior, if that is more: flights below a drag rise say nothing of where it begins, and
    /// nothing in it of what lies below.
    pub(crate) fn scale_by(&mut self, scale: f64) {
        let least = if self.variable() == Variable::Mach { LEAST_SCALE_BEYOND_MACH } else { 0.0 };
        self.text.growth = GROWTH_BEYOND * (least / scale).max(1.0).powi(2);
    }

    pub(crate) const fn variable(&self) -> Variable {
        self.text.variable
    }

    /// Terms: the slope, then the process.
    pub(crate) const fn len(&self) -> usize {
        self.text.terms()
    }

    /// Lengths from the middle.
    pub(crate) fn at(&self, value: f64) -> f64 {
        self.text.at(value)
    }

    /// The smallest and the largest value that was flown.
    pub(crate) fn flown(&self) -> (f64, f64) {
        let ((first, last), distance) = (self.text.knots, self.text.distance());
        let value = |z: f64| self.text.middle + z * self.text.length;
        (value(first + distance), value(last - distance))
    }

    /// How far a value lies beyond those that were flown, in lengths, below them negative; 0 within them.
    pub(crate) fn beyond(&self, value: f64) -> f64 {
        let z = self.at(value);
        let beyond = self.text.beyond(z);
        if beyond <= BEYOND_BY_ROUNDING {
            0.0
        } else if self.text.is_above(z) {
            beyond
        } else {
            -beyond
        }
    }

    /// Growth of what is not known beyond the flown values, of the process' variance per cube of lengths.
    pub(crate) const fn growth(&self) -> f64 {
        self.text.growth
    }

    /// Tells it how far the guide goes on below and above the flown values, lengths.
    pub(crate) const fn set_reach_of_guide(&mut self, reach: (f64, f64)) {
        self.text.guide = reach;
    }

    /// Of a signed distance beyond the flown values, how far the guide goes, and what is left; lengths.
    pub(crate) fn split_by_guide(&self, distance: f64) -> (f64, f64) {
        self.text.split_by_guide(distance > 0.0, distance.abs())
    }

    /// Whether a value lies beyond those that were flown.
    pub(crate) fn is_beyond(&self, value: f64) -> bool {
        self.beyond(value) != 0.0
    }

    /// Writes the terms at a value; returns the shares of the process' variance that they do not hold.
    pub(crate) fn write(&self, value: f64, into: &mut [f64]) -> LeftOfProcess {
        self.write_at(self.at(value), into)
    }

    /// The same at a place in lengths.
    fn write_at(&self, z: f64, into: &mut [f64]) -> LeftOfProcess {
        into[0] = z;
        let terms = &mut into[1..=self.text.count];
        self.write_kernels(z, terms);
        let (mut held, mut rest) = (0.0, self.rows.as_slice());
        for k in 0..terms.len() {
            let (row, behind) = rest.split_at(k + 1);
            let (below, from_here) = terms.split_at_mut(k);
            let mut term = from_here[0];
            for (l, other) in row.iter().zip(below.iter()) {
                term -= l * other;
            }
            term *= row[k];
            held += term * term;
            from_here[0] = term;
            rest = behind;
        }
        self.text.left_of_variance(z, held)
    }

    /// The kernel at all knots: from knot to knot as far as that holds.
    fn write_kernels(&self, z: f64, into: &mut [f64]) {
        let (from_first, distance) = (z - self.text.knots.0, self.text.distance());
        if from_first.abs() <= REACH {
            let mut now = (-0.5 * from_first * from_first).exp();
            let mut ratio = (from_first * distance - 0.5 * distance * distance).exp();
            let ratio_falls = (-distance * distance).exp();
            for value in into {
                *value = now;
                now *= ratio;
                ratio *= ratio_falls;
            }
        } else {
            for (k, value) in into.iter_mut().enumerate() {
                *value = kernel(z, self.knot(k));
            }
        }
    }

    fn knot(&self, k: usize) -> f64 {
        let (first, last) = self.text.knots;
        first + (last - first) * k as f64 / (self.text.count - 1) as f64
    }
}

/// A smooth function prepared for many values: the kernel at all knots from two exponentials, and the mean as a sum over
/// knots.
///
/// ```text
/// k(z, Z₀ + j·d) = k(z, Z₀)·r·(r·q)·(r·q²)…,  r = exp((z − Z₀)·d − d²/2),  q = exp(−d²);   f(z) = s·z + k(Z, z)ᵀL⁻ᵀc
/// ```
#[derive(Clone, Debug)]
pub(crate) struct Prepared {
    text: SmoothText,
    distance: f64,
    /// exp(−d²).
    ratio_falls: f64,
    slope: f64,
    /// Of the kernel at each knot.
    weights: Vec<f64>,
    /// Rows of the lower Cholesky factor, each ending in the inverse of its diagonal.
    root: Vec<f64>,
}

impl Smooth {
    /// With the means of its terms.
    pub(crate) fn prepared(&self, means: impl Iterator<Item = f64>) -> Prepared {
        let count = self.text.count;
        let mut means = means.chain(core::iter::repeat(0.0));
        let slope = means.next().unwrap_or(0.0);
        let mut weights: Vec<f64> = means.take(count).collect();
        for k in (0..count).rev() {
            for j in k + 1..count {
                weights[k] -= self.root[(j, k)] * weights[j];
            }
            weights[k] /= self.root[(k, k)];
        }
        let distance = self.text.distance();
        let ratio_falls = (-distance * distance).exp();
        let root = self.rows.clone();
        Prepared { text: self.text, distance, ratio_falls, slope, weights, root }
    }
}

/// Largest error of a tabulated mean, of ln fuel flow. Our choice: of eight functions less than 1e-9, far below what is printed.
const CURVE_ERROR: f64 = 1e-10;

/// Fourth derivative of the share of the variance that one knot holds, k²: 12 at the knot, by hand.
const BENDS_OF_VARIANCE: f64 = 12.0;

/// Lengths from the first knot up to which the kernel is computed from knot to knot: e^(−37²/2) is a normal number yet.
const REACH: f64 = 37.0;

/// Over many places at once, compiled for the vectors of the caller.
impl Prepared {
    pub(crate) const fn variable(&self) -> Variable {
        self.text.variable
    }

    /// Terms: the slope, then the process.
    pub(crate) const fn len(&self) -> usize {
        self.text.terms()
    }

    /// Lengths from the middle.
    #[expect(clippy::inline_always, reason = "as the others")]
    #[inline(always)]
    pub(crate) fn at<const N: usize>(&self, values: &[f64; N]) -> [f64; N] {
        let (middle, per_unit) = (self.text.middle, 1.0 / self.text.length);
        map(values, |value| (value - middle) * per_unit)
    }

    /// Lengths in a unit of the variable.
    pub(crate) const fn per_length(&self) -> f64 {
        1.0 / self.text.length
    }

    /// Raises each number to how far a place in lengths lies beyond what was flown, as [`Smooth::is_beyond`] measures it.
    #[expect(clippy::inline_always, reason = "as the others")]
    #[inline(always)]
    pub(crate) fn add_beyond(&self, z: &Lanes, farthest: &mut Lanes) {
        let ((first, last), distance) = (self.text.knots, self.distance);
        let (middle, half) = (f64::midpoint(first, last), 0.5 * (last - first) - distance);
        for lane in 0..LANES {
            let beyond = (z[lane] - middle).abs() - half;
            farthest[lane] = if beyond > farthest[lane] { beyond } else { farthest[lane] };
        }
    }

    /// First and last knot, in lengths.
    pub(crate) const fn knots(&self) -> (f64, f64) {
        self.text.knots
    }

    /// Adds what is left of a process of this variance where its terms leave such shares of it: what is not beyond the guide, and what
    /// is, as [`Smooth::write`] has them.
    #[expect(clippy::inline_always, reason = "as the others")]
    #[inline(always)]
    pub(crate) fn add_left(
        &self,
        (z, left): (&Lanes, &Lanes),
        variance: f64,
        [known, beyond_guide]: &mut [Lanes; 2],
    ) {
        let ((first, last), (below, above)) = (self.text.knots, self.text.guide);
        let (middle, half) = (f64::midpoint(first, last), 0.5 * (last - first) - self.distance);
        let growth = variance * self.text.growth;
        for lane in 0..LANES {
            let from_middle = z[lane] - middle;
            let beyond = from_middle.abs() - half;
            let beyond = if beyond > 0.0 { beyond } else { 0.0 };
            let reach = if from_middle > 0.0 { above } else { below };
            let within = if beyond < reach { beyond } else { reach };
            let rest = beyond - within;
            let outside = growth * rest * rest * rest;
            let grown = growth * within * within * within;
            let of_terms = variance * left[lane] - outside;
            let inside = if of_terms > grown { of_terms } else { grown };
            known[lane] += if inside > 0.0 { inside } else { 0.0 };
            beyond_guide[lane] += outside;
        }
    }

    /// The function's mean as a curve, within [`CURVE_ERROR`]; `None` where that would be very many pieces.
    pub(crate) fn curve(&self) -> Option<Curve> {
        let sizes: f64 = self.weights.iter().map(|weight| weight.abs()).sum();
        // The kernel's fourth derivative is largest at its knot: 3.
        let pieces = self.pieces(3.0 * sizes, sizes);
        Curve::new(pieces, (0.0, self.slope), |z| self.mean(z))
    }

    /// Share of the process' variance that its terms leave, but for what grows beyond the values that were flown, as a curve.
    pub(crate) fn left_curve(&self) -> Option<Curve> {
        Curve::new(self.pieces(BENDS_OF_VARIANCE, 1.0), (1.0, 0.0), |z| {
            let mut terms = [[0.0; 4]; 1 + SMOOTH_MOST_KNOTS];
            let held = self.held(z, &mut terms[..self.len()]);
            map(&held, |held| 1.0 - held)
        })
    }

    /// Pieces of a curve that bends so much, as far as the kernel of weights of this sum is worth its error.
    fn pieces(&self, fourth_derivative: f64, sizes: f64) -> Pieces {
        let tail = (2.0 * (sizes / CURVE_ERROR).max(2.0).ln()).sqrt();
        let (first, last) = self.text.knots;
        Pieces::within(first - tail, last + tail, fourth_derivative, CURVE_ERROR)
    }

    /// The kernel at the first knot.
    #[expect(clippy::inline_always, reason = "as the others")]
    #[inline(always)]
    fn kernels<const N: usize>(&self, z: &[f64; N]) -> Kernels<N> {
        let (first, distance) = (self.text.knots.0, self.distance);
        Kernels {
            now: map(z, |z| exp(-0.5 * (z - first) * (z - first))),
            ratio: map(z, |z| exp((z - first) * distance - 0.5 * distance * distance)),
            ratio_falls: self.ratio_falls,
        }
    }

    /// The function's mean.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    pub(crate) fn mean<const N: usize>(&self, z: &[f64; N]) -> [f64; N] {
        let mut sums = map(z, |z| self.slope * z);
        let mut kernels = self.kernels(z);
        for weight in &self.weights {
            add(&mut sums, *weight, &kernels.now);
            kernels.step();
        }
        sums
    }

    /// As [`Smooth::write`].
    #[expect(clippy::inline_always, reason = "as the others")]
    #[inline(always)]
    pub(crate) fn write<const N: usize>(&self, z: &[f64; N], into: &mut [[f64; N]]) -> [f64; N] {
        let held = self.held(z, into);
        each(z, &held, |z, held| self.text.left_of_variance(z, held).total())
    }

    /// Writes the terms; returns the share of the process' variance that they hold.
    #[expect(clippy::inline_always, reason = "as the others")]
    #[inline(always)]
    fn held<const N: usize>(&self, z: &[f64; N], into: &mut [[f64; N]]) -> [f64; N] {
        into[0] = *z;
        let terms = &mut into[1..=self.text.count];
        let mut kernels = self.kernels(z);
        for term in terms.iter_mut() {
            *term = kernels.now;
            kernels.step();
        }
        let (mut held, mut rest) = ([0.0; N], self.root.as_slice());
        for k in 0..terms.len() {
            let (row, behind) = rest.split_at(k + 1);
            let (below, from_here) = terms.split_at_mut(k);
            let mut term = from_here[0];
            for (l, other) in row.iter().zip(below.iter()) {
                add(&mut term, -l, other);
            }
            let term = map(&term, |term| term * row[k]);
            add_product(&mut held, 1.0, &term, &term);
            from_here[0] = term;
            rest = behind;
        }
        held
    }
}

/// The kernel between places and one knot after the other.
struct Kernels<const N: usize> {
    now: [f64; N],
    ratio: [f64; N],
    ratio_falls: f64,
}

impl<const N: usize> Kernels<N> {
    /// On to the next knot.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn step(&mut self) {
        self.now = each(&self.now, &self.ratio, |kernel, ratio| kernel * ratio);
        self.ratio = map(&self.ratio, |ratio| ratio * self.ratio_falls);
    }
}

impl TryFrom<SmoothText> for Smooth {
    type Error = SmoothError;
    fn try_from(text: SmoothText) -> Result<Self, SmoothError> {
        let SmoothText { count, knots, length, middle, guide, .. } = text;
        let wrong = SmoothError { count, knots, length, guide };
        let finite = knots.0.is_finite() && knots.1.is_finite() && middle.is_finite();
        let reaches = [guide.0, guide.1].iter().all(|reach| (0.0..f64::INFINITY).contains(reach));
        let spread = knots.1 > knots.0 && length > 0.0 && length.is_finite();
        if !finite || !spread || !reaches || !(2..=SMOOTH_MOST_KNOTS).contains(&count) {
            return Err(wrong);
        }
        let mut smooth = Self { text, root: Mat::zeros(0, 0), rows: Vec::new() };
        let kernel = Mat::from_fn(count, count, |a, b| {
            let own = if a == b { JITTER } else { 0.0 };
            kernel(smooth.knot(a), smooth.knot(b)) + own
        });
        smooth.root = Cholesky::new(&kernel).ok_or(wrong)?.lower().to_owned();
        for k in 0..count {
            smooth.rows.extend((0..k).map(|j| smooth.root[(k, j)]));
            smooth.rows.push(1.0 / smooth.root[(k, k)]);
        }
        Ok(smooth)
    }
}

impl From<Smooth> for SmoothText {
    fn from(smooth: Smooth) -> Self {
        smooth.text
    }
}

fn kernel(a: f64, b: f64) -> f64 {
    (-0.5 * (a - b) * (a - b)).exp()
}

#[cfg(test)]
mod tests;
