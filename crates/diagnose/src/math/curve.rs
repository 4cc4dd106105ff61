//! A smooth function of one number, tabulated: a cubic on each of many equal pieces, a straight line beyond them.

#![expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
#![expect(clippy::needless_range_loop, reason = "loops count, as those over lanes")]

use crate::math::lanes::{LANES, Lanes, WHOLE, lowest_bits, map};

/// Coefficients of a cubic, from the lowest power.
type Cubic = [f64; 4];

/// The cubics of a curve at several places.
#[derive(Clone, Debug)]
pub(crate) struct Fetched {
    cubics: [Cubic; LANES],
    /// Each place in its piece, whose width is 1.
    at: Lanes,
    pieces_per_unit: f64,
}

/// Largest number of pieces: a function that bends more often is asked itself.
const MOST_PIECES: f64 = 16_384.0;

/// Cubics through a function at Chebyshev's points of pieces of width d; off by at most |f⁗|·d⁴/3072.
///
/// # Source
/// Press et al., *Numerical Recipes*, third edition, section 5.8; the bound is that of interpolation at the zeros of Chebyshev's
/// polynomial of degree 4, |f⁗|/4!·(d/2)⁴/2³ (Dahlquist and Björck 2008, section 3.2.3).
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    /// Middle of the first piece.
    first: f64,
    pieces_per_unit: f64,
    /// The first and the last one are straight lines, which go on for ever.
    pieces: Vec<Cubic>,
}

/// Where a function is tabulated, and how finely.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pieces {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) per_unit: f64,
}

impl Pieces {
    /// Pieces for a function whose fourth derivative is at most so large, to this error.
    pub(crate) fn within(from: f64, to: f64, fourth_derivative: f64, error: f64) -> Self {
        let per_unit = (fourth_derivative / (3072.0 * error)).max(1.0).powf(0.25);
        Self { from, to, per_unit }
    }
}

impl Curve {
    /// Of a function that is asked at four places at once; beyond the pieces `value + slope·x`. `None` where that would be very
    /// many pieces.
    pub(crate) fn new(
        pieces: Pieces,
        (value, slope): (f64, f64),
        function: impl Fn(&[f64; 4]) -> [f64; 4],
    ) -> Option<Self> {
        let Pieces { from, to, per_unit } = pieces;
        let count = ((to - from) * per_unit).ceil();
        if !(1.0..=MOST_PIECES).contains(&count) {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "just checked")]
        let count = count as usize;
        // One piece more at each end, of the straight line.
        let first = from - 0.5 / per_unit;
        let middle = |piece: usize| first + piece as f64 / per_unit;
        let line = |piece: usize| [value + slope * middle(piece), slope / per_unit, 0.0, 0.0];
        let inner = (1..=count).map(|piece| {
            let places = NODES.map(|node| middle(piece) + 0.5 * node / per_unit);
            cubic(&function(&places))
        });
        let pieces =
            core::iter::once(line(0)).chain(inner).chain(core::iter::once(line(count + 1)));
        Some(Self { first, pieces_per_unit: per_unit, pieces: pieces.collect() })
    }

    /// The function at places.
    #[inline(always)]
    pub(crate) fn at(&self, places: &Lanes) -> Lanes {
        let mut found = Fetched::default();
        self.fetch(places, &mut found);
        found.values()
    }

    /// Its cubics at places: `found` may be used for many functions one after the other.
    #[inline(always)]
    pub(crate) fn fetch(&self, places: &Lanes, found: &mut Fetched) {
        let last = (self.pieces.len() - 1) as f64;
        let from_first = map(places, |x| (x - self.first) * self.pieces_per_unit);
        let shifted = map(&from_first, |t| if t > 0.0 { t } else { 0.0 });
        let shifted = map(&shifted, |t| if t < last { t } else { last } + WHOLE);
        // First all are fetched, point by point; then all are computed, several in one instruction.
        for lane in 0..LANES {
            found.cubics[lane] = self.pieces[lowest_bits(shifted[lane])];
        }
        found.pieces_per_unit = self.pieces_per_unit;
        for lane in 0..LANES {
            found.at[lane] = from_first[lane] - (shifted[lane] - WHOLE);
        }
    }
}

impl Default for Fetched {
    fn default() -> Self {
        Self { cubics: [[0.0; 4]; LANES], at: [0.0; LANES], pieces_per_unit: 1.0 }
    }
}

impl Fetched {
    /// The function at the places.
    #[inline(always)]
    pub(crate) fn values(&self) -> Lanes {
        let mut values = [0.0; LANES];
        for lane in 0..LANES {
            let ([a, b, c, d], x) = (self.cubics[lane], self.at[lane]);
            values[lane] = a + x * (b + x * (c + x * d));
        }
        values
    }

    /// Its slopes there.
    #[inline(always)]
    pub(crate) fn slopes(&self) -> Lanes {
        let mut slopes = [0.0; LANES];
        for lane in 0..LANES {
            let ([_, b, c, d], x) = (self.cubics[lane], self.at[lane]);
            slopes[lane] = self.pieces_per_unit * (b + x * (2.0 * c + x * (3.0 * d)));
        }
        slopes
    }

    /// By how much the function is higher `above` the places than `below` them, both signed: by the cubics of the places, which go on.
    /// A distance s from a place is off by |f⁗|·(s + d)⁴/24 at most, d the width of a piece.
    #[inline(always)]
    pub(crate) fn rises(&self, above: &Lanes, below: &Lanes) -> Lanes {
        let mut rises = [0.0; LANES];
        for lane in 0..LANES {
            let ([_, b, c, d], x) = (self.cubics[lane], self.at[lane]);
            let (up, down) =
                (self.pieces_per_unit * above[lane], self.pieces_per_unit * below[lane]);
            let (up, down) = (x + up, x + down);
            rises[lane] = up * (b + up * (c + up * d)) - down * (b + down * (c + down * d));
        }
        rises
    }
}

/// Chebyshev's points: cos((2i + 1)·π/8).
const NODES: [f64; 4] = [
    0.923_879_532_511_286_7,
    0.382_683_432_365_089_8,
    -0.382_683_432_365_089_8,
    -0.923_879_532_511_286_7,
];

/// The cubic through values at [`NODES`], over half of what they are places in.
fn cubic(values: &[f64; 4]) -> Cubic {
    let [p, q, r, s] = *values;
    let [far, near, _, _] = NODES;
    // Coefficients of Chebyshev's polynomials, from sums and differences of opposite points.
    let (outer, inner) = (0.5 * (p - s), 0.5 * (q - r));
    let t0 = 0.25 * ((p + s) + (q + r));
    let t1 = far * outer + near * inner;
    let t2 = 0.5 * core::f64::consts::FRAC_1_SQRT_2 * ((p + s) - (q + r));
    let t3 = near * outer - far * inner;
    [t0 - t2, 2.0 * (t1 - 3.0 * t3), 8.0 * t2, 32.0 * t3]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The oracle is the standard library; the bound is that of the documentation.
    #[test]
    fn a_curve_is_its_function_within_the_bound() {
        let sine = |x: &[f64; 4]| x.map(f64::sin);
        for error in [1e-6, 1e-9, 1e-11] {
            let pieces = Pieces::within(-2.0, 3.0, 1.0, error);
            let curve = Curve::new(pieces, (0.25, -0.5), sine).unwrap();
            let mut worst: f64 = 0.0;
            for step in 0..=10_000 {
                let x = -2.0 + 0.0005 * f64::from(step);
                worst = worst.max((curve.at(&[x; LANES])[3] - x.sin()).abs());
            }
            assert!(worst <= error * (1.0 + 1e-3) && worst > 0.1 * error, "{error}: {worst}");
        }
    }

    /// The oracle is the standard library again; a cubic that goes on is off by the next term of Taylor's series.
    #[test]
    fn slopes_and_rises_are_those_of_the_function() {
        let pieces = Pieces::within(-2.0, 3.0, 1.0, 1e-10);
        let curve = Curve::new(pieces, (0.25, -0.5), |x| x.map(f64::sin)).unwrap();
        let (above, below) = (0.05, -0.08);
        let mut fetched = Fetched::default();
        let (mut worst, mut farthest): (f64, f64) = (0.0, 0.0);
        for step in 0..=1000 {
            let x = -1.9 + 0.0048 * f64::from(step);
            curve.fetch(&[x; LANES], &mut fetched);
            worst = worst.max((fetched.slopes()[1] - x.cos()).abs());
            let rise = fetched.rises(&[above; LANES], &[below; LANES])[1];
            farthest = farthest.max((rise - ((x + above).sin() - (x + below).sin())).abs());
        }
        // What a cubic is off by is Chebyshev's polynomial, whose slope is 16 at the ends of half a piece.
        let width = 1.0 / pieces.per_unit;
        assert!(worst < 16.0 * 1e-10 / (0.5 * width) * 1.01 && worst > 1e-9, "{worst}");
        let bound = |distance: f64| (distance.abs() + width).powi(4) / 24.0;
        assert!(farthest < bound(above) + bound(below) && farthest > 1e-9, "{farthest}");
    }

    #[test]
    fn beyond_its_pieces_it_is_a_straight_line() {
        let pieces = Pieces { from: -2.0, to: 3.0, per_unit: 10.0 };
        let curve = Curve::new(pieces, (0.25, -0.5), |x| x.map(f64::sin)).unwrap();
        let at = |x: f64| curve.at(&[x; LANES])[LANES - 1];
        for x in [-1e6, -2.5, 3.5, 1e6] {
            let (known, found): (f64, f64) = (0.25 - 0.5 * x, at(x));
            assert!((found - known).abs() < 1e-12 * known.abs().max(1.0), "{x}: {found}");
        }
        assert!(!at(f64::INFINITY).is_finite() && at(f64::NAN).is_nan());
        let many = Pieces { from: 0.0, to: 1.0, per_unit: 1e9 };
        assert!(Curve::new(many, (0.0, 0.0), |x| *x).is_none());
        let none = Pieces { from: 0.0, to: f64::NAN, per_unit: 1.0 };
        assert!(Curve::new(none, (0.0, 0.0), |x| *x).is_none());
    }
}
