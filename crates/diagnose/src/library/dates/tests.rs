use super::*;

const DAY_S: f64 = SECONDS_PER_DAY;

/// A flight a day, at midnight.
fn days(count: usize) -> Vec<f64> {
    (0..count).map(|day| day as f64 * DAY_S).collect()
}

fn falls(hidden: &HiddenParameter) -> Vec<f64> {
    match hidden {
        HiddenParameter::History(history) => {
            history.falls_s().map(|fall_s| fall_s / DAY_S).collect()
        }
        HiddenParameter::Step { from_s, .. } => vec![from_s / DAY_S],
        _ => vec![],
    }
}

/// The tried parameter with the nearest falls leads, again and again.
fn lead(mut grid: DateGrid, id: EffectId, truth: &[f64]) -> Vec<f64> {
    let distance = |hidden: &HiddenParameter| {
        let found = falls(hidden);
        let off = |wanted: &f64| {
            let nearest = found.iter().map(|fall| (fall - wanted).abs());
            nearest.fold(1e3, f64::min)
        };
        truth.iter().map(off).sum::<f64>() + 1e-3 * found.len() as f64
    };
    for _ in 0..20 {
        let tried = grid.hidden(id).iter();
        let best = *tried.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
        match grid.closer(id, best, |_| None) {
            Some(closer) => grid = closer,
            None => return falls(&best),
        }
    }
    panic!("no end");
}

#[test]
fn dates_are_found_to_the_flight() {
    let grid = DateGrid::coarse(&days(1000), &[], None);
    assert_eq!(lead(grid.clone(), EffectId::StepChange, &[616.5]), [616.5]);
    assert_eq!(lead(grid.clone(), EffectId::EngineHistory, &[233.5]), [233.5]);
    assert_eq!(lead(grid, EffectId::AirframeHistory, &[120.5, 700.5]), [120.5, 700.5]);
}

/// A deterioration with a step back is a history: where a step has been found to the flight, the history that falls there has
/// too, and the other has not.
#[test]
fn a_history_is_tried_as_closely_as_a_step() {
    let mut grid = DateGrid::coarse(&days(1000), &[], None);
    let step = |grid: &DateGrid| {
        let tried = grid.hidden(EffectId::StepChange).iter();
        let on_drag = tried.filter(|hidden| {
            matches!(hidden, HiddenParameter::Step { target: StepTarget::Drag, .. })
        });
        let off = |hidden: &HiddenParameter| (falls(hidden)[0] - 616.5).abs();
        *on_drag.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap()
    };
    while let Some(closer) = grid.closer(EffectId::StepChange, step(&grid), |_| None) {
        grid = closer;
    }
    let finds = |id| grid.hidden(id).iter().any(|hidden| falls(hidden) == [616.5]);
    assert!(finds(EffectId::AirframeHistory));
    assert!(!finds(EffectId::EngineHistory));
}

/// A deterioration that falls late is a step up before: the history with the late fall is tried as closely.
#[test]
fn a_history_with_a_fall_elsewhere_is_tried_as_closely() {
    let mut grid = DateGrid::coarse(&days(1000), &[], None);
    let nearest = |grid: &DateGrid, id, day: f64| {
        let off = |hidden: &HiddenParameter| (falls(hidden)[0] - day).abs();
        let mut tried = grid.hidden(id).to_vec();
        tried.sort_by(|a, b| off(a).total_cmp(&off(b)));
        tried[0]
    };
    loop {
        let best = nearest(&grid, EffectId::AirframeHistory, 903.5);
        let rival = |id| match best {
            HiddenParameter::History(history) if id == EffectId::AirframeHistory => Some(history),
            _ => None,
        };
        let step = nearest(&grid, EffectId::StepChange, 306.5);
        let Some(closer) = grid.closer(EffectId::StepChange, step, rival) else { break };
        grid = closer;
    }
    assert_eq!(falls(&nearest(&grid, EffectId::AirframeHistory, 903.5)), [903.5]);
    assert_eq!(falls(&nearest(&grid, EffectId::StepChange, 306.5)), [306.5]);
}

#[test]
fn a_known_event_is_tried_at_its_very_instant() {
    let event_s = 17.2 * DAY_S;
    let grid = DateGrid::coarse(&days(40), &[event_s, -5.0 * DAY_S], None);
    for id in [EffectId::StepChange, EffectId::EngineHistory] {
        assert!(grid.hidden(id).iter().any(|hidden| falls(hidden) == [17.2]), "{id}");
        // What was done before the first flight is no date of these flights.
        assert!(grid.hidden(id).iter().all(|hidden| falls(hidden).iter().all(|day| *day > 0.0)));
    }
}

/// By hand: 40 flights have 39 dates; once they are tried flight by flight, each is one of 39, times the two targets.
#[test]
fn a_date_found_among_many_costs_what_they_are() {
    let id = EffectId::StepChange;
    let grid = DateGrid::coarse(&days(40), &[], None);
    let step = grid.hidden(id)[0];
    assert_eq!(grid.ln_choices(id, step), None);
    let closer = grid.closer(id, step, |_| None).unwrap();
    let found = closer.ln_choices(id, step).unwrap();
    assert!((found - f64::ln(78.0)).abs() < 1e-12, "{found}");
}

/// By hand: 1.5 % in half of a year are 3 % a year; in half of ten years less than the usual 0.8; in half of 0.2 years they would
/// be 15 % a year, more than there is.
#[test]
fn a_short_record_is_believed_to_hold_a_usual_fall() {
    let of = |years: f64| {
        let grid = DateGrid::coarse(&[0.0, years * DAYS_PER_YEAR * DAY_S], &[], None);
        grid.typical_rate(0.8, 1.5)
    };
    assert!((of(1.0) - 3.0).abs() < 1e-9);
    assert!((of(0.2) - MOST_USUAL_RATE).abs() < 1e-12);
    assert!((of(10.0) - 0.8).abs() < 1e-12);
    assert!((DateGrid::coarse(&[], &[], None).typical_rate(0.8, 1.5) - 0.8).abs() < 1e-12);
}
