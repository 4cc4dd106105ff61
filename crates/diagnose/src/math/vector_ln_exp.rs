//! Logarithm and exponential for many numbers at once: no branch, no table, so that compilers make vectors of them.
//!
//! Difficult: the search over pairs needs some hundred thousand of each, and the library's take most of its time. These are
//! as exact as theirs where they are used, and the same on every machine.

#![expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
#![expect(clippy::excessive_precision, reason = "constants as published")]

/// ln 2 in two parts, the first with 32 zero bits at its end.
const LN_2: [f64; 2] = [6.931_471_803_691_238_164_90e-1, 1.908_214_929_270_587_700_02e-10];

/// Of the polynomial of ln.
const LN: [f64; 7] = [
    6.666_666_666_666_735_13e-1,
    3.999_999_999_940_941_908e-1,
    2.857_142_874_366_239_149e-1,
    2.222_219_843_214_978_396e-1,
    1.818_357_216_161_805_012e-1,
    1.531_383_769_920_937_332e-1,
    1.479_819_860_511_658_591e-1,
];
/// Of the polynomial of exp.
const EXP: [f64; 5] = [
    1.666_666_666_666_660_19e-1,
    -2.777_777_777_701_559_338e-3,
    6.613_756_321_437_934_361e-5,
    -1.653_390_220_546_525_153e-6,
    4.138_136_797_057_238_460e-8,
];
/// 1.5·2⁵²: what is added to it is rounded to a whole number, in its last bits.
const ROUNDING: f64 = 6_755_399_441_055_744.0;
/// 2⁵².
const WHOLE: f64 = 4_503_599_627_370_496.0;
/// Below, [`exp`] holds: e⁻⁷⁰⁰ is the last that needs no subnormal number.
const SMALLEST_EXPONENT: f64 = -700.0;

/// ln x of a positive normal number; anything for others.
///
/// ```text
/// x = 2^k·(1 + f),  √½ ≤ 1 + f < √2,  s = f/(2 + f),  ln(1 + f) = f − f²/2 + s·(f²/2 + R(s²))
/// ```
///
/// # Source
/// Sun Microsystems, fdlibm 5.3, `e_log.c`: algorithm and constants; error below one unit in the last place.
#[inline(always)]
pub(crate) fn ln(x: f64) -> f64 {
    /// Bits of √½, so that the mantissa is of √½ to √2.
    const HALF_ROOT: u64 = 0x3fe6_a09e_667f_3bcd;
    let shifted = x.to_bits().wrapping_sub(HALF_ROOT);
    // Of 0 or more where x is at least √½, else negative: made positive by 2048, then a number by its bits.
    let biased = shifted.wrapping_add(2048 << 52) >> 52;
    let exponent = f64::from_bits(WHOLE.to_bits() | (biased & 0xfff)) - (WHOLE + 2048.0);
    let mantissa = f64::from_bits((shifted & 0x000f_ffff_ffff_ffff).wrapping_add(HALF_ROOT));
    let f = mantissa - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let [a, b, c, d, e, g, h] = LN;
    let r = z * (a + z * (b + z * (c + z * (d + z * (e + z * (g + z * h))))));
    let half = 0.5 * f * f;
    exponent * LN_2[0] - ((half - (s * (half + r) + exponent * LN_2[1])) - f)
}

/// Largest |t| of [`ln_of_near`]: t¹²/13 is below a hundredth of the last place.
pub(crate) const NEAR: f64 = 0.02;

/// ln((1 + t)/(1 − t)) for |t| up to [`NEAR`]: a third of the work of [`ln`]; anything for others.
///
/// ```text
/// 2·(t + t³/3 + t⁵/5 + t⁷/7 + t⁹/9 + t¹¹/11)
/// ```
///
/// # Source
/// The series of 2 artanh t; Abramowitz and Stegun 1964, equation 4.6.33.
#[inline(always)]
pub(crate) fn ln_of_near(t: f64) -> f64 {
    let z = t * t;
    let odd = 1.0 / 3.0 + z * (1.0 / 5.0 + z * (1.0 / 7.0 + z * (1.0 / 9.0 + z * (1.0 / 11.0))));
    2.0 * (t + t * (z * odd))
}

/// eˣ for x from −700 to 700; below −700 what it is there.
///
/// ```text
/// x = k·ln 2 + r,  c = r − r²·P(r²),  eʳ = 1 + (r·c/(2 − c) + r)
/// ```
///
/// # Source
/// Sun Microsystems, fdlibm 5.3, `e_exp.c`: algorithm and constants; error below one unit in the last place.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    let x = if x < SMALLEST_EXPONENT { SMALLEST_EXPONENT } else { x };
    let rounded = x * core::f64::consts::LOG2_E + ROUNDING;
    let k = rounded - ROUNDING;
    let (high, low) = (x - k * LN_2[0], k * LN_2[1]);
    let r = high - low;
    let t = r * r;
    let [a, b, c, d, e] = EXP;
    let c = r - t * (a + t * (b + t * (c + t * (d + t * e))));
    let one = 1.0 - ((low - r * c / (2.0 - c)) - high);
    one * f64::from_bits(rounded.to_bits().wrapping_add(1023) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the standard library's.
    #[test]
    fn as_exact_as_the_library() {
        let mut worst: [f64; 2] = [0.0; 2];
        for k in 0..200_000 {
            let x = (f64::from(k) * 0.001 - 100.0).exp();
            let expected = x.ln();
            worst[0] = worst[0].max((ln(x) - expected).abs() / expected.abs().max(1e-3));
            let x = 700.0 - f64::from(k) * 0.007;
            worst[1] = worst[1].max((exp(x) / x.exp() - 1.0).abs());
        }
        assert!(worst[0] < 4e-16, "{worst:?}");
        assert!(worst[1] < 4e-16, "{worst:?}");
        for x in [1.0, 0.999_999, 1.000_001, 0.5_f64.sqrt(), 2.0_f64.sqrt(), 1e300, 1e-300] {
            assert!((ln(x) - x.ln()).abs() <= 3e-16 * x.ln().abs(), "{x}");
        }
        assert!(ln(1.0).abs() < 1e-300 && (exp(0.0) - 1.0).abs() < 1e-300);
        for k in -1000..=1000 {
            let t = NEAR * f64::from(k) / 1000.0;
            let expected = 2.0 * t.atanh();
            assert!((ln_of_near(t) - expected).abs() <= 4e-16 * expected.abs(), "{t}");
        }
        assert!(exp(-1e9) < 1e-303 && exp(f64::NEG_INFINITY) < 1e-303);
    }
}
