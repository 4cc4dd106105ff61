//! Where a gap lies, on the virtual fleet: planted effects by their place, engines and dates, and what has no place.
#![expect(clippy::unwrap_used, reason = "a test")]

use diagnose::{
    Diagnosis, FlightRecord, Input, Options, Region, Shown, Variable, diagnose, region_members,
    segment_gaps,
};
use flight::effect::EffectId;
use test_support::fleet::{Background, Fleet, Planted, Setup, exact_model, fly};

/// What the fleet recorded, as the diagnosis takes it.
fn records(fleet: &Fleet) -> Vec<FlightRecord<'_>> {
    fleet.flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect()
}

fn place(fleet: &Fleet, options: &Options) -> Diagnosis {
    let model = exact_model();
    let records = records(fleet);
    let input = Input::against(&model, &records);
    let found = diagnose(&input, options).unwrap();
    for slice in &found.r#where {
        let members = region_members(&input, &slice.region).unwrap();
        let count = members.iter().flatten().filter(|&&inside| inside).count();
        assert_eq!(count, slice.segments, "bounds and segments of {:?}", slice.region);
    }
    found
}

fn with(seed: u64, id: EffectId, size: f64) -> Fleet {
    fly(seed, &Setup::default(), &[Planted { id, size }], &Background::default())
}

fn options() -> Options {
    Options { skip_closure: true, ..Options::default() }
}

#[test]
fn an_engine_is_a_place() {
    // Engine 2 alone burns 3 % more; both engines together 1.5 %.
    let found = place(&with(401, EffectId::TsfcEngine(2), 3.0), &options());
    let first = &found.r#where[0];
    assert_eq!(first.region, Region { engine: Some(2), conditions: vec![] });
    assert!(first.ci95[0] < 3.0 && first.ci95[1] > 3.0, "{first:?}");
    assert!((first.share_of_gap - 1.0).abs() < 0.15, "{first:?}");
}

#[test]
fn a_level_lies_everywhere() {
    let found = place(&with(402, EffectId::TsfcFactor, 2.0), &options());
    let first = &found.r#where[0];
    assert!(first.region.is_everywhere() && found.r#where.len() == 1);
    assert_eq!(first.segments, found.segments);
    assert!(first.ci95[0] < 2.0 && first.ci95[1] > 2.0, "{first:?}");
}

#[test]
fn a_drag_rise_lies_at_high_mach_number() {
    let fleet = with(403, EffectId::WaveDrag, 0.008);
    let found = place(&fleet, &options());
    let first = &found.r#where[0];
    // By the truth's formula the drag rise starts at M 0.80 and grows with the third power above.
    let conditions = &first.region.conditions;
    let fast = conditions.iter().find(|one| one.variable == Variable::Mach).unwrap();
    assert!(fast.from.unwrap().value > 0.82 && fast.to.is_none());
    assert!(first.p_value <= 0.01 && first.mean_gap_percent > 0.5, "{first:?}");
    // The same seed finds the same to the last bit.
    assert_eq!(place(&fleet, &options()).r#where, found.r#where);
}

#[test]
fn without_gap_no_place() {
    // Of four clean fleets at most one may alarm: at 5 % each, two would have a probability of 1.4 %.
    let alarms = (410..414)
        .map(|seed| fly(seed, &Setup::default(), &[], &Background::default()))
        .filter(|fleet| !place(fleet, &options()).r#where.is_empty())
        .count();
    assert!(alarms <= 1, "{alarms}");
}

/// What a chart shows is what the diagnosis counted: its mean, its root mean square, its place.
#[test]
fn gaps_of_segments_are_those_of_the_diagnosis() {
    let fleet = with(404, EffectId::WaveDrag, 0.008);
    let model = exact_model();
    let records = records(&fleet);
    let input = Input::against(&model, &records);
    let found = diagnose(&input, &options()).unwrap();
    let addition = found.addition.as_ref().unwrap();
    let shown = Shown {
        outliers: &found.outliers,
        addition: Some(addition),
        region: Some(&found.r#where[0].region),
        driver: Some(Variable::Mach),
    };
    let gaps = segment_gaps(&input, shown).unwrap();
    assert_eq!(gaps.len(), found.segments);
    assert_eq!(gaps.last().unwrap().flight + 1, found.flights);
    let count = gaps.len() as f64;
    let mean = gaps.iter().map(|one| one.before_percent).sum::<f64>() / count;
    assert!((mean - found.gap.mean_percent).abs() < 1e-9, "{mean}");
    let square =
        |of: &dyn Fn(usize) -> f64| (0..gaps.len()).map(|k| of(k).powi(2)).sum::<f64>() / count;
    let before = square(&|k| gaps[k].before_percent).sqrt();
    assert!((before - found.gap.rms_percent).abs() < 1e-9, "{before}");
    let inside = gaps.iter().filter(|one| one.in_region).count();
    assert_eq!(inside, found.r#where[0].segments);
    for gap in &gaps {
        assert_eq!((gap.driver, gap.after_percent.len()), (Some(gap.mach), addition.effects.len()));
    }
    // The planted drag rise is most of the gap: with it in the model less is left.
    let after = square(&|k| gaps[k].after_percent[addition.effects.len() - 1]).sqrt();
    assert!(after < before, "{after} of {before}");
}
