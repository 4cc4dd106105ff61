//! Where and closure on the virtual fleet of the tests, for development and for the validation page:
//! `places SEED REPEATS [null | effects | closure | cost] [effect]`; of `cost` REPEATS is the number of flights.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a development tool")]

use diagnose::{Diagnosis, FlightRecord, Input, Options, diagnose, references_of, region_members};
use effects::ExtendedModel;
use effects::{EffectModel, EffectPoint, Effects};
use flight::effect::EffectId;
use pipeline::diagnosis_document::VerdictKind;
use pipeline::diagnosis_words::region_words;
use test_support::fleet::{Background, Fleet, Random, Setup, exact_model, fly, plant};
use trials::places::{names_driver, spread, worst_region_overlap};

/// Effects that vary by less than this, in per cent of fuel flow, are not asked for.
const LOCALISABLE_PERCENT: f64 = 0.35;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let number = |k: usize, default: u64| {
        arguments.get(k).and_then(|text| text.parse().ok()).unwrap_or(default)
    };
    let (seed, repeats) = (number(1, 1), number(2, 1));
    let what = arguments.get(3).map_or("effects", String::as_str);
    let only = arguments.get(4);
    let model = exact_model();
    assert!(repeats > 0, "nothing to measure");
    match what {
        "null" => nulls(&model, seed, repeats),
        "cost" => cost(&model, seed, repeats),
        _ => effects(&model, seed, repeats, what == "closure", only.map(String::as_str)),
    }
}

fn run(model: &ExtendedModel, fleet: &Fleet, closure: bool) -> (Diagnosis, f64) {
    let records = records(fleet);
    let input = input(model, &records);
    let begin = std::time::Instant::now();
    let options = Options { skip_closure: !closure, skip_where: closure, ..Options::default() };
    let found = diagnose(&input, &options).unwrap();
    (found, begin.elapsed().as_secs_f64())
}

fn input<'a>(model: &'a ExtendedModel, records: &'a [diagnose::FlightRecord<'a>]) -> Input<'a> {
    Input::against(model, records)
}

/// ln recorded − ln predicted, segment by segment; `None` outside the table.
fn gaps(model: &ExtendedModel, fleet: &Fleet) -> Vec<Option<f64>> {
    let records = records(fleet);
    let references = references_of(model, model.drag_table(), &records).unwrap();
    let with = EffectModel::new(model, model.drag_table(), references).unwrap();
    fleet
        .flights
        .iter()
        .flatten()
        .map(|segment| {
            let start_s = segment.identity.start_s();
            let point = EffectPoint::from_means(&segment.means, start_s, 2);
            let response = with.response(&point, &Effects::none()).ok()?;
            Some(segment.means.fuel_flow_total_kg_s.ln() - response.ln_fuel_flow_total)
        })
        .collect()
}

fn nulls(model: &ExtendedModel, seed: u64, repeats: u64) {
    let (mut alarms, mut two, mut everywhere, mut seconds) = (0, 0, 0, 0.0);
    for repeat in 0..repeats {
        let fleet = fly(seed * 1_000_000 + repeat, &Setup::default(), &[], &Background::default());
        let (found, took) = run(model, &fleet, false);
        seconds += took;
        if let Some(first) = found.r#where.first() {
            alarms += 1;
            let region = &first.region;
            let conditions = region.conditions.len() + usize::from(region.engine.is_some());
            two += u32::from(conditions == 2);
            everywhere += u32::from(region.is_everywhere());
            println!(
                "{} p {:.4} {:+.2} % {:?}",
                region_words(region),
                first.p_value,
                first.mean_gap_percent,
                VerdictKind::from(&found.verdict)
            );
        }
    }
    println!(
        "nulls {repeats}: alarms {alarms}, two conditions {two}, everywhere {everywhere}; {:.3} s a case",
        seconds / repeats as f64
    );
}

#[derive(Default)]
struct Tally {
    cases: f64,
    significant: f64,
    driver: f64,
    overlap: f64,
}

fn effects(model: &ExtendedModel, seed: u64, repeats: u64, closure: bool, only: Option<&str>) {
    let (mut large, mut all) = (Tally::default(), Tally::default());
    for (k, &id) in EffectId::library(2).iter().enumerate() {
        if only.is_some_and(|name| name != id.to_string()) {
            continue;
        }
        for repeat in 0..repeats {
            let case = seed * 1_000_000 + k as u64 * 1000 + repeat;
            let planted = plant(id, 1.0, &mut Random::new(case, 9));
            let setup = Setup::default();
            let fleet = fly(case, &setup, &[planted], &Background::default());
            let clean = fly(case, &setup, &[], &Background::default());
            let (found, took) = run(model, &fleet, closure);
            // What the effect alone does to the gap: the same flights with the same noise without it.
            let (with, without) = (gaps(model, &fleet), gaps(model, &clean));
            let effect: Vec<Option<f64>> =
                with.iter().zip(&without).map(|(a, b)| Some((*a)? - (*b)?)).collect();
            if closure {
                closed(id, &found, &with, &without, took);
                continue;
            }
            let records = records(&fleet);
            let inside: Vec<f64> = effect.iter().flatten().copied().collect();
            let spread_percent = 100.0 * spread(&inside);
            let first = found.r#where.first();
            let members: Option<Vec<bool>> = first.map(|first| {
                region_members(&input(model, &records), &first.region)
                    .unwrap()
                    .into_iter()
                    .flatten()
                    .zip(&effect)
                    .filter(|(_, effect)| effect.is_some())
                    .map(|(inside, _)| inside)
                    .collect()
            });
            let overlap = members.and_then(|m| worst_region_overlap(&inside, &m)).unwrap_or(0.0);
            let significant = first.is_some_and(|first| !first.region.is_everywhere());
            let driver = first.is_some_and(|first| names_driver(id, &first.region));
            println!(
                "{:<26} spread {:.2} % driver {} overlap {:.2} gap {:.2} % | {} | {:.3} s",
                id.to_string(),
                spread_percent,
                u8::from(driver),
                overlap,
                found.gap.rms_percent,
                found
                    .r#where
                    .iter()
                    .map(|s| format!(
                        "{} ({:+.2} [{:+.2}, {:+.2}] %, share {:.2}, p {:.3})",
                        region_words(&s.region),
                        s.mean_gap_percent,
                        s.ci95[0],
                        s.ci95[1],
                        s.share_of_gap,
                        s.p_value
                    ))
                    .collect::<Vec<_>>()
                    .join("; "),
                took,
            );
            for tally in
                [Some(&mut all), (spread_percent >= LOCALISABLE_PERCENT).then_some(&mut large)]
                    .into_iter()
                    .flatten()
            {
                tally.cases += 1.0;
                tally.significant += f64::from(u8::from(significant));
                tally.driver += f64::from(u8::from(driver));
                tally.overlap += overlap;
            }
        }
    }
    for (name, tally) in [("localisable", large), ("all", all)] {
        println!(
            "{name}: {} cases, significant {:.3}, driver {:.3}, overlap {:.3}",
            tally.cases,
            tally.significant / tally.cases,
            tally.driver / tally.cases,
            tally.overlap / tally.cases
        );
    }
}

/// Closure as found, with the truth: same noise, effect off.
fn closed(
    id: EffectId,
    found: &Diagnosis,
    with: &[Option<f64>],
    without: &[Option<f64>],
    took: f64,
) {
    let pairs: Vec<(f64, f64)> =
        with.iter().zip(without).filter_map(|(a, b)| Some(((*a)?, (*b)?))).collect();
    let count = pairs.len() as f64;
    let before = pairs.iter().map(|(a, _)| a * a).sum::<f64>() / count;
    let floor = pairs.iter().map(|(_, b)| b * b).sum::<f64>() / count;
    let after = found.causes.iter().find_map(|c| c.rms_after_percent).map(|p| (p / 100.0).powi(2));
    let oracle = after.map(|after| (before - after) / (before - floor));
    println!(
        "{:<26} closure {:?} {:?} oracle {:?} before {:.3} floor {:.3} oracle floor {:.3} replicates {:?} held out {:?} | {:?} | {took:.3} s",
        id.to_string(),
        found.verdict.closure().map(|closure| closure.share),
        found.verdict.closure().map(|closure| closure.ci95),
        oracle,
        100.0 * before.sqrt(),
        found.gap.noise_floor_rms_percent,
        100.0 * floor.sqrt(),
        found.gap.floor_by_replicates_rms_percent.map(rounded),
        found.gap.floor_by_held_out_fit_rms_percent.map(rounded),
        VerdictKind::from(&found.verdict),
    );
}

fn rounded(percent: f64) -> f64 {
    (1000.0 * percent).round() / 1000.0
}

/// Seconds with and without the search for places.
fn cost(model: &ExtendedModel, seed: u64, flights: u64) {
    let flights = usize::try_from(flights).unwrap();
    let setup = Setup { flights, ..Setup::default() };
    let planted = plant(EffectId::WaveDrag, 1.0, &mut Random::new(seed, 9));
    let fleet = fly(seed, &setup, &[planted], &Background::default());
    let records = records(&fleet);
    for (skip_where, skip_closure) in [(true, true), (false, true), (true, false)] {
        let options = Options { skip_closure, skip_where, ..Options::default() };
        let begin = std::time::Instant::now();
        let found = diagnose(&input(model, &records), &options).unwrap();
        println!(
            "{} segments: where {}, closure {}: {:.2} s",
            found.segments,
            !skip_where,
            !skip_closure,
            begin.elapsed().as_secs_f64()
        );
    }
}

/// What the fleet recorded, as the diagnosis takes it.
fn records(fleet: &Fleet) -> Vec<FlightRecord<'_>> {
    fleet.flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect()
}
