//! Numbers side by side, one for each of a few points: sums and functions of them all, compiled for the vectors of the caller.
//!
//! Loops count instead of going through iterators: those are calls of their own in a function that is compiled for other vectors
//! than the rest of the program.

#![expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
#![expect(clippy::needless_range_loop, reason = "as above")]

/// Numbers side by side: so many that the code of a step, which is long, is fetched once for them all, and so few that a step's
/// numbers stay in a near cache. Measured on predictions of a whole model: 8 took longer.
pub(crate) const LANES: usize = 32;

/// A quantity at each point.
pub(crate) type Lanes = [f64; LANES];

/// 2⁵²: a positive number that it is added to is rounded to a whole number, in its last bits.
pub(crate) const WHOLE: f64 = 4_503_599_627_370_496.0;

/// The whole number, below 2³², that [`WHOLE`] was added to.
#[expect(clippy::cast_possible_truncation, reason = "the lowest bits are what is wanted")]
#[inline(always)]
pub(crate) const fn lowest_bits(shifted: f64) -> usize {
    shifted.to_bits() as u32 as usize
}

/// A function of every number.
#[inline(always)]
pub(crate) fn map<const N: usize>(values: &[f64; N], of: impl Fn(f64) -> f64) -> [f64; N] {
    let mut found = *values;
    for lane in 0..N {
        found[lane] = of(found[lane]);
    }
    found
}

/// A function of two numbers each.
#[inline(always)]
pub(crate) fn each<const N: usize>(
    a: &[f64; N],
    b: &[f64; N],
    of: impl Fn(f64, f64) -> f64,
) -> [f64; N] {
    let mut found = *a;
    for lane in 0..N {
        found[lane] = of(found[lane], b[lane]);
    }
    found
}

/// `a += share·b`.
#[inline(always)]
pub(crate) fn add<const N: usize>(a: &mut [f64; N], share: f64, b: &[f64; N]) {
    for lane in 0..N {
        a[lane] += share * b[lane];
    }
}

/// `a += share·b·c`.
#[inline(always)]
pub(crate) fn add_product<const N: usize>(
    a: &mut [f64; N],
    share: f64,
    b: &[f64; N],
    c: &[f64; N],
) {
    for lane in 0..N {
        a[lane] += share * b[lane] * c[lane];
    }
}
