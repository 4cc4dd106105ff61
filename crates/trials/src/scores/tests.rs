use super::*;
use crate::scored_case::Planted;

fn case(truth: &str, top: &str, probability: f64) -> Case {
    Case {
        planted: Planted { effects: vec![(truth.to_owned(), 1.0)], struck: vec![] },
        verdict: VerdictKind::Effects,
        of_table: false,
        top: Some((top.to_owned(), probability)),
        top_three: vec![top.to_owned()],
        class: vec![top.to_owned()],
        credible: vec![top.to_owned()],
        named: vec![top.to_owned()],
        planted_closure: None,
        located: None,
        size_error: None,
        interval_holds: None,
        size_position: None,
        closure: Some(0.9),
        gap_rms_percent: 1.0,
        nearest: Some((10.0, 10.0)),
        largest: Some(top.to_owned()),
        attainable: None,
    }
}

#[test]
fn scores_by_hand() {
    let [a, b] = ["drag_factor", "tsfc_factor"];
    let cases = [case(a, a, 0.95), case(a, b, 0.95), case(b, b, 0.55)];
    let scores = Scores::from_cases(&cases);
    let of = |name| scores.reached(name).share().map(|share| (share.count, share.of)).unwrap();
    assert_eq!(of(ScoreName::TopOne), (2, 3));
    assert_eq!(of(ScoreName::SureAndWrong), (1, 3));
    // Bins: 0.9…1.0 states 1.9 for one right of two, 0.5…0.6 states 0.55 for one right: (0.9 + 0.45)/3.
    let calibration = scores.reached(ScoreName::CalibrationError).value().unwrap();
    assert!((calibration - 0.45).abs() < 1e-12);
    let bins: Vec<_> =
        scores.calibration.iter().map(|bin| (bin.right.count, bin.right.of)).collect();
    assert_eq!(bins, [(1, 1), (1, 2)]);
    assert_eq!(scores.confusion[a][b], 1);
    assert_eq!(scores.reached(ScoreName::ClosureMedian).value(), Some(0.9));
}

/// Of three cases one abstains with the right effect in the lead, and for two it is known what could be named.
#[test]
fn a_ceiling_counts_where_it_is_known_and_a_lead_whatever_the_verdict() {
    let [a, b] = ["drag_factor", "tsfc_factor"];
    let known = |name: &str, case: Case| Case { attainable: Some(name.to_owned()), ..case };
    let abstains = Case { verdict: VerdictKind::OutsideLibrary, ..case(a, a, 0.3) };
    let cases = [known(a, abstains), known(b, case(a, b, 0.9)), case(b, b, 0.8)];
    let scores = Scores::from_cases(&cases);
    let of = |name| scores.reached(name).share().map(|share| (share.count, share.of)).unwrap();
    assert_eq!(of(ScoreName::TopOne), (1, 3));
    assert_eq!(of(ScoreName::LeadsCauses), (2, 3));
    assert_eq!(of(ScoreName::AttainableTopOne), (1, 2));
}

#[test]
fn planted_sizes_by_tenths() {
    // 1.96 times: −1.96 is in the first tenth, −0.02 in the fifth, 0.59 in the eighth, 3.9 in the last.
    let cases = [-1.0, -0.01, 0.3, 2.0].map(|position| Case {
        size_position: Some(position),
        ..case("drag_factor", "drag_factor", 0.95)
    });
    let tenths = Scores::from_cases(&cases).size_tenths;
    assert_eq!(tenths, [1, 0, 0, 0, 1, 0, 0, 1, 0, 1]);
}

#[test]
fn every_kind_of_case_counts_where_it_belongs() {
    let [a, b] = ["drag_factor", "tsfc_factor"];
    let mut pair = case(a, a, 0.95);
    pair.planted.effects.push((b.to_owned(), 1.0));
    pair.named = vec![b.to_owned(), a.to_owned()];
    let half = Case { named: vec![a.to_owned()], ..pair.clone() };
    let mut null = case(a, a, 0.95);
    null.planted.effects.clear();
    let silent = Case { verdict: VerdictKind::NoGap, ..null.clone() };
    let mut struck = case(a, b, 0.95);
    struck.planted.struck = vec![a.to_owned()];
    let imitable = Case { nearest: Some((10.0, 4.9)), ..struck.clone() };
    let outside =
        Case { verdict: VerdictKind::OutsideLibrary, ..case("outside_mach_bump", a, 0.3) };
    let place =
        Located { spread_percent: 0.4, significant: true, driver_named: false, overlap: 0.7 };
    let placed = Case { located: Some(place.clone()), ..case("wave_drag", a, 0.95) };
    // Scatter between flights depends on no variable.
    let nowhere = Case { located: Some(place), ..case("fuel_heating_value", a, 0.95) };
    let scores =
        Scores::from_cases(&[pair, half, null, silent, struck, imitable, outside, placed, nowhere]);
    let of = |name| scores.reached(name).share().map(|share| (share.count, share.of)).unwrap();
    assert_eq!(of(ScoreName::PairExact), (1, 2));
    assert_eq!(of(ScoreName::PairClass), (1, 2));
    assert_eq!(of(ScoreName::PairTop), (2, 2));
    assert_eq!(of(ScoreName::Silent), (1, 2));
    assert_eq!(of(ScoreName::NullAndSure), (1, 2));
    // Only one of the struck effects cannot be imitated.
    assert_eq!(of(ScoreName::Abstained), (0, 1));
    assert_eq!(of(ScoreName::StruckAndSure), (1, 1));
    assert_eq!(of(ScoreName::Outside), (1, 1));
    assert_eq!(of(ScoreName::TopOne), (0, 2));
    assert_eq!(of(ScoreName::PlaceSignificant), (1, 1));
    assert_eq!(of(ScoreName::PlaceDriver), (0, 1));
    assert_eq!(scores.reached(ScoreName::PlaceOverlapMedian).value(), Some(0.7));
}
