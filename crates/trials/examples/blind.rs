//! Blind trials on the virtual fleet of the tests, for development: `blind SEED REPEATS [times] [clutter] [what]`.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a development tool")]

use diagnose::{FlightRecord, Input, Options, diagnose};
use flight::effect::EffectId;
use pipeline::diagnosis_document::VerdictKind;
use pipeline::diagnosis_words::joined;
use test_support::fleet::{Background, Fleet, Random, Setup, exact_model, fly, plant};
use trials::{Case, Planted, Scores};

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts typed by hand")]
fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let number = |k: usize, default: f64| {
        arguments.get(k).and_then(|text| text.parse().ok()).unwrap_or(default)
    };
    let seed = number(1, 1.0) as u64;
    let repeats = number(2, 1.0) as u64;
    let times = number(3, 1.0);
    let clutter = number(4, 0.0);
    let what = arguments.get(5).map_or("single", String::as_str);
    let only = arguments.get(6).cloned();
    let model = exact_model();
    let background = Background { clutter, field: if clutter > 0.0 { 0.0025 } else { 0.0 } };
    let setup = Setup::default();
    let mut cases = Vec::new();
    let effects: Vec<EffectId> = EffectId::library(2);
    let begin = std::time::Instant::now();
    let mut count = 0_u32;
    for (k, &id) in effects.iter().enumerate() {
        if only.as_ref().is_some_and(|name| *name != id.to_string()) {
            continue;
        }
        for repeat in 0..repeats {
            let case = seed * 1_000_000 + k as u64 * 1000 + repeat;
            let planted = match what {
                "null" => vec![],
                _ => vec![plant(id, times, &mut Random::new(case, 9))],
            };
            let fleet = fly(case, &setup, &planted, &background);
            let records = records(&fleet);
            let input = Input::against(&model, &records);
            let options = Options {
                without: if what == "struck" { vec![id] } else { vec![] },
                ..Options::default()
            };
            let found = diagnose(&input, &options).unwrap();
            count += 1;
            let top = found.causes.first().map_or_else(String::new, |c| c.effect.to_string());
            let p = found.causes.first().map_or(0.0, |c| c.probability);
            let size = planted.first().map_or(0.0, |p| p.size);
            let own = found.causes.iter().find(|c| c.effect == id);
            let whole = (what == "struck").then(|| {
                diagnose(&input, &Options { skip_closure: true, ..Options::default() }).unwrap()
            });
            let mut case = Case::from_diagnosis(
                Planted {
                    effects: planted.iter().map(|p| (p.id.to_string(), p.size)).collect(),
                    struck: options.without.iter().map(ToString::to_string).collect(),
                },
                &found,
            );
            if let Some(whole) = &whole {
                case.take_distance(whole);
            }
            cases.push(case);
            println!(
                "{:<26} {:+.4} | {:?} top {:<24} p {:.3} est {:+.4} pout {:.2} {:?} closure {:?} gap {:.2}/{:.2} pval {:.1e} class {:?} | {} | ci {:?} near {:?} closures {:?}",
                id.to_string(),
                size,
                VerdictKind::from(&found.verdict),
                top,
                p,
                own.map_or(f64::NAN, |c| c.magnitude.value),
                found.outside.probability,
                found.outside.variable,
                found.verdict.closure().map(|closure| closure.share),
                found.gap.rms_percent,
                found.gap.noise_floor_rms_percent,
                found.gap.p_value,
                found.verdict.class(),
                joined(found.verdict.effects(), "+"),
                found.verdict.closure().map(|closure| closure.ci95),
                found
                    .detectable
                    .iter()
                    .find(|d| d.effect == id)
                    .map(|d| (d.nearest_other, d.nearest_pair)),
                cases.last().and_then(|case| case.nearest),
            );
        }
    }
    println!("{}", serde_json::to_string_pretty(&Scores::from_cases(&cases)).unwrap());
    assert_eq!(cases.len(), count as usize, "a case came to nothing");
    println!("{count} cases, {:.3} s per case", begin.elapsed().as_secs_f64() / f64::from(count));
}

/// What the fleet recorded, as the diagnosis takes it.
fn records(fleet: &Fleet) -> Vec<FlightRecord<'_>> {
    fleet.flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect()
}
