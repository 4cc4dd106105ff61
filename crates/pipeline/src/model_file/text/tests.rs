use super::*;

/// The oracle is `Debug`, which writes the fewest digits that come back: over numbers of every size, and where one of the
/// writers changes to exponents. Of a number half way between two such texts (667082108456853.25) the other one is written.
#[test]
fn numbers_are_written_as_short_as_debug_writes_them() {
    let mut numbers = vec![0.0, -0.0, 1.0, -1.0, 0.1, f64::MIN_POSITIVE, f64::MAX, 5e-324];
    for exponent in -20..=20 {
        for digits in [1.0, 1.5, 9.999_999_999_999_998, 1.234_567_890_123_456_7] {
            numbers.push(digits * 10_f64.powi(exponent));
        }
    }
    let mut bits = 0x9E37_79B9_7F4A_7C15_u64;
    for _ in 0..20_000 {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        numbers.push(f64::from_bits(bits));
        // Sizes that models hold.
        numbers.push(1e-6 * (bits >> 11) as f64 / (1_u64 << 53) as f64);
    }
    for number in numbers.into_iter().filter(|number| number.is_finite()) {
        let mut written = String::new();
        push_debug(number, &mut written);
        let debug = format!("{number:?}");
        assert_eq!(written.parse::<f64>().unwrap().to_bits(), number.to_bits(), "{debug}");
        assert!(written == debug || number.abs() > 1e12, "{written}, {debug}");
        assert_eq!(written.len(), debug.len(), "{written}, {debug}");
    }
}
