//! Blind trials on the virtual fleet of the tests, for development: `blind SEED REPEATS [times] [clutter] [what]`.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a development tool")]

use std::collections::BTreeMap;

use diagnose::{Input, Options, VerdictKind, diagnose};
use flight::effect::EffectId;

#[path = "../tests/fleet/flown.rs"]
mod flown;
use flown::{Background, Random, Setup, exact_model, fly, plant};

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let number = |k: usize, default: f64| {
        arguments.get(k).and_then(|text| text.parse().ok()).unwrap_or(default)
    };
    let seed = number(1, 1.0) as u64;
    let repeats = number(2, 2.0) as u64;
    let times = number(3, 1.0);
    let clutter = number(4, 0.0);
    let what = arguments.get(5).map_or("single", String::as_str);
    let only = arguments.get(6).cloned();
    let model = exact_model();
    let background = Background { clutter, field: if clutter > 0.0 { 0.0025 } else { 0.0 } };
    let setup = Setup::default();
    let mut lines = Vec::new();
    let effects: Vec<EffectId> = EffectId::library(2);
    let begin = std::time::Instant::now();
    let mut count = 0;
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
            let records = fleet.records();
            let input = Input {
                model: &model,
                drag_table: model.drag_table(),
                flights: &records,
                baseline: None,
                table: None,
                references: None,
            };
            let options = Options {
                without: if what == "struck" { vec![id] } else { vec![] },
                ..Options::default()
            };
            let found = diagnose(&input, &options).unwrap();
            count += 1;
            let top = found.causes.first().map_or(String::new(), |c| c.effect.clone());
            let p = found.causes.first().map_or(0.0, |c| c.probability);
            let class = found
                .detectable
                .iter()
                .find(|d| d.effect == top)
                .map_or_else(Vec::new, |d| d.class.clone());
            let size = planted.first().map_or(0.0, |p| p.size);
            let own = found.causes.iter().find(|c| c.effect == id.to_string());
            lines.push((id, found.verdict.kind, top.clone(), p, class.clone(), found.clone()));
            println!(
                "{:<26} {:+.4} | {:?} top {:<24} p {:.3} est {:+.4} pout {:.2} {:?} closure {:?} gap {:.2}/{:.2} pval {:.1e} class {:?} | {}",
                id.to_string(),
                size,
                found.verdict.kind,
                top,
                p,
                own.map_or(f64::NAN, |c| c.magnitude.value),
                found.outside.probability,
                found.outside.variable,
                found.verdict.closure,
                found.gap.rms_percent,
                found.gap.noise_floor_rms_percent,
                found.gap.p_value,
                found.verdict.class,
                found.verdict.effects.join("+"),
            );
        }
    }
    let mut sums: BTreeMap<&str, usize> = BTreeMap::new();
    for (id, kind, top, p, class, _) in &lines {
        let name = id.to_string();
        let mut add = |key: &'static str, yes: bool| *sums.entry(key).or_default() += usize::from(yes);
        add("1 no gap", *kind == VerdictKind::NoGap);
        add("2 outside", *kind == VerdictKind::OutsideLibrary);
        let named = *kind == VerdictKind::Effects;
        add("3 effects", named);
        add("4 top-1", named && *top == name);
        add("5 class", named && (*top == name || class.contains(&name)));
        add("6 sure", named && *p >= 0.9);
        add("7 sure and wrong", named && *p >= 0.9 && *top != name);
    }
    for (key, value) in sums {
        println!("{key:<20} {value:5} {:.3}", value as f64 / count as f64);
    }
    println!("{count} cases, {:.3} s a case", begin.elapsed().as_secs_f64() / f64::from(count));
}
