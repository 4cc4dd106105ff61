use super::named::figure;
use super::*;

#[test]
fn every_effect_has_words_for_both_signs() {
    for id in EffectId::library(flight::MAXIMUM_ENGINES) {
        for size in [-1.0, 1.0] {
            let words = id.phrase(size);
            assert!(words.len() > 10 && !words.contains('_'), "{id}: {words}");
        }
    }
    assert_eq!(EffectId::TsfcEngine(2).phrase(3.0), "engine 2 burns more");
    assert_eq!(EffectId::MachBias.phrase(-0.004), "Mach number reads low");
}

#[test]
fn the_newest_month_is_said_where_there_are_others() {
    let month = |month: &str, after_percent: Option<f64>| MonthGap {
        month: month.to_owned(),
        flights: 3,
        segments: 20,
        mean_gap_percent: 1.234,
        ci95: Some([0.9, 1.6]),
        after_percent,
        after_ci95: after_percent.map(|_| [-0.4, 0.3]),
    };
    assert_eq!(newest_month(&[month("2026-01", None)]), None);
    assert_eq!(
        newest_month(&[month("2026-01", Some(0.2)), month("2026-02", Some(-0.004))]).unwrap(),
        "In the newest month, 2026-02 with 3 flights, the mean gap is +1.23 % (+0.90 to +1.60); +0.00 % (-0.40 to +0.30) \
         with what is named in the model."
    );
}

#[test]
fn figures_have_three_digits() {
    assert_eq!(digits(199.5), "200");
    assert_eq!(digits(12.34), "12.3");
    assert_eq!(digits(5.246), "5.25");
    assert_eq!(digits(0.336), "0.336");
    assert_eq!(digits(0.004), "0.0040");
    assert_eq!(figure(-0.336), "−0.336");
}
