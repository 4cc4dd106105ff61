//! Made-up fleets whose truth is known: the rows are drawn, no aircraft flies.

use effects::EffectReferences;
use faer::Mat;
use flight::effect::{EffectId, EffectSign, HiddenParameter};

use super::*;
use crate::math::random::RandomStream;
use crate::priors::FLEET_TAIL_NUISANCE;

const IDS: [EffectId; 4] =
    [EffectId::DragFactor, EffectId::TsfcFactor, EffectId::MachBias, EffectId::ZeroFuelMassBias];
const SHARED: usize = 3;
const ROWS: usize = 120;
const TAILS: usize = 12;
/// Fuel flow in noise standard deviations that a typical size makes.
const SIGNATURE: f64 = 1.0;

fn testable(place: usize) -> Testable {
    Testable {
        id: IDS[place],
        typical: 1.0,
        small: 1.0,
        prior_mean: 0.0,
        prior_deviation: 1.0,
        has_known_size: false,
        sign: EffectSign::Either,
        first_column: place,
        columns: 1,
        representative: place,
    }
}

/// A fleet in which all tails have `of_type` and some have effects of their own: (tail, effect, size).
fn fleet(seed: u64, of_type: [f64; 4], own: &[(usize, usize, f64)]) -> Vec<FleetTail> {
    let mut random = RandomStream::new(seed, 0);
    let columns = IDS.len() + SHARED;
    let mut shared = [0.0; SHARED];
    random.fill(&mut shared);
    (0..TAILS)
        .map(|tail| {
            let mut sizes = of_type;
            for (_, effect, size) in own.iter().filter(|(at, ..)| *at == tail) {
                sizes[*effect] += size;
            }
            let mut rows = Mat::<f64>::zeros(ROWS, columns + 1);
            for row in 0..ROWS {
                let mut values = [0.0; IDS.len() + SHARED + 1];
                random.fill(&mut values);
                for (column, value) in values[..columns].iter().enumerate() {
                    rows[(row, column)] = SIGNATURE * value;
                }
                let of_effects: f64 = (0..IDS.len()).map(|k| rows[(row, k)] * sizes[k]).sum();
                let of_shared: f64 =
                    (0..SHARED).map(|c| rows[(row, IDS.len() + c)] * shared[c]).sum();
                rows[(row, columns)] = of_effects + of_shared + values[columns];
            }
            made_up_tail(&rows)
        })
        .collect()
}

fn made_up_tail(rows: &Mat<f64>) -> FleetTail {
    let references = EffectReferences {
        date_s: 0.0,
        mach: 0.8,
        unit_reynolds_number_per_m: 6e6,
        temperature_ratio: 0.75,
        corrected_thrust_n: 5e4,
        fuel_flow_total_kg_s: 0.25,
        mass_kg: 13_000.0,
        center_of_gravity_percent_mac: None,
    };
    FleetTail::made_up(
        TailGram { matrix: rows.transpose() * rows, rows: ROWS as f64 },
        (0..IDS.len()).map(testable).collect(),
        SharedColumns::of_nuisance(SHARED),
        (vec![HiddenParameter::None; IDS.len()], references),
    )
}

/// Tails without effects, whose own share of what is uncertain is as large as what they have in common. Its columns are like
/// those of effects. Believed is another share.
fn unlike_tails(seed: u64, believed: f64) -> Vec<FleetTail> {
    let mut random = RandomStream::new(seed, 0);
    let columns = IDS.len() + SHARED;
    let mut shared = [0.0; SHARED];
    random.fill(&mut shared);
    let tail = |random: &mut RandomStream| {
        let mut own = [0.0; SHARED];
        random.fill(&mut own);
        let mut rows = Mat::<f64>::zeros(ROWS, columns + 1);
        for row in 0..ROWS {
            let mut values = [0.0; IDS.len() + SHARED + 1];
            random.fill(&mut values);
            for c in 0..SHARED {
                let column = IDS.len() + c;
                values[column] = 0.8 * values[c] + 0.6 * values[column];
                values[columns] += values[column] * (shared[c] + own[c]);
            }
            for (column, value) in values.iter().enumerate() {
                rows[(row, column)] = *value;
            }
        }
        let mut made_up = made_up_tail(&rows);
        let all: Vec<usize> = (0..=columns).collect();
        let out = &all[IDS.len()..columns];
        let reduced = integrate_out(&made_up.gram.matrix, &all, out, &[believed; SHARED]).unwrap();
        made_up.gram.matrix = reduced.matrix;
        made_up
    };
    (0..TAILS).map(|_| tail(&mut random)).collect()
}

fn diagnosed(mut tails: Vec<FleetTail>) -> FleetDiagnosis {
    diagnose_fleet(&mut tails.iter_mut().collect::<Vec<_>>()).unwrap()
}

#[test]
fn every_effect_is_found_at_its_level_with_its_size() {
    // All burn a typical size more; tail 3 has 0.7 of a typical drag beside it, tail 7 a probe that reads 0.8 of one low.
    let tails = fleet(1, [0.0, 1.0, 0.0, 0.0], &[(3, 0, 0.7), (7, 2, -0.8)]);
    let found = diagnosed(tails);
    let place = |id: EffectId| found.effects.iter().position(|known| *known == id).unwrap();
    let told: Vec<_> = found.findings.iter().map(|f| (f.level, f.tail, f.effect)).collect();
    assert_eq!(
        told,
        [
            (FleetLevel::Type, None, EffectId::TsfcFactor),
            (FleetLevel::Tail, Some(3), EffectId::DragFactor),
            (FleetLevel::Sensor, Some(7), EffectId::MachBias),
        ],
        "{:?}",
        found.findings
    );
    // Standard deviation of a size from 120 rows: 0.09; of all tails together 0.03.
    let of_type = found.of_type[place(EffectId::TsfcFactor)];
    assert!((of_type.value - 1.0).abs() < 0.12, "{of_type:?}");
    let of_tail = found.of_tails[7][place(EffectId::MachBias)];
    assert!((of_tail.value + 0.8).abs() < 0.35, "{of_tail:?}");
    assert!(of_tail.ci95[0] < of_tail.value && of_tail.ci95[1] < 0.0);
    assert!(found.false_share <= FALSE_DISCOVERIES);
    assert!(found.noise.iter().all(|noise| (noise - 1.0).abs() < 0.3), "{:?}", found.noise);
}

/// Of forty fleets without any effect at most two have a finding: 5 % of them.
#[test]
fn nothing_is_found_where_nothing_acts() {
    let with_finding =
        (100..140).filter(|&seed| !diagnosed(fleet(seed, [0.0; 4], &[])).findings.is_empty());
    let with_finding: Vec<u64> = with_finding.collect();
    assert!(with_finding.len() <= 2, "{with_finding:?}");
}

/// What a model does not know may differ from tail to tail as much as it is uncertain. Believed to be a tenth of that, it is
/// given the names of effects.
#[test]
fn what_the_model_does_not_know_is_no_effect_of_a_tail() {
    let findings = |believed: f64| -> usize {
        (200..210).map(|seed| diagnosed(unlike_tails(seed, believed)).findings.len()).sum()
    };
    let (believed_whole, believed_tenth) = (findings(FLEET_TAIL_NUISANCE), findings(0.1));
    // Of 120 tails; 5 % false discoveries of at most a few findings.
    assert!(believed_whole <= 2, "{believed_whole}");
    assert!(believed_tenth >= 20, "{believed_tenth}");
}

/// One tail's noise, twice what is stated, is no effect.
#[test]
fn a_noisy_tail_is_no_finding() {
    let mut tails = fleet(3, [0.0; 4], &[]);
    tails[5].gram.rescale(0.25);
    let found = diagnosed(tails);
    assert!(found.findings.is_empty(), "{:?}", found.findings);
    assert!((found.noise[5] - 2.0).abs() < 0.4, "{:?}", found.noise);
}

#[test]
fn two_tails_are_no_fleet() {
    let mut tails = fleet(4, [0.0; 4], &[]);
    tails.truncate(2);
    let found = diagnose_fleet(&mut tails.iter_mut().collect::<Vec<_>>());
    assert_eq!(found, Err(DiagnoseError::TooFewTails { found: 2, needed: 3 }));
}

/// By hand: what grows with time on a tail may be a step or a history as well, which a comparison without dates does not ask.
#[test]
fn what_grows_with_time_may_have_begun_at_a_date() {
    let expected = [
        (EffectId::EngineAgeing, EffectId::EngineHistory),
        (EffectId::AirframeAgeing, EffectId::AirframeHistory),
    ];
    for (ageing, history) in expected {
        assert_eq!(unasked_rivals(ageing), [EffectId::StepChange, history]);
    }
    assert!(unasked_rivals(EffectId::DragFactor).is_empty());
}
