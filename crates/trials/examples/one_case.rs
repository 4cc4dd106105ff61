//! One case from plan to score: drawn, sealed, flown, diagnosed, opened, scored.
//!
//! `cargo run --release -p cruisefit-trials --example one_case`

#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use trials::{DiagnosedCase, DrawnCase, ScoreName, Scores, Seal, TrialPlan};

const PLAN: &str = r#"(
    seed: 7, flights: 20, effects: ["drag_factor"],
    parts: [(denied: exact, background: clean, kind: single, times: 3, repeats: 1)],
)"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let plan = TrialPlan::from_ron(PLAN)?;
    let cases = plan.cases(2);
    let spec = cases.first().ok_or("the plan has one case")?;

    let sealed = DrawnCase::draw(&plan, spec)?.truth().to_text()?;
    let seal = Seal::of_texts([sealed.as_str()]);
    println!("truth sealed: sha256 {}", seal.hash());

    let diagnosed = DiagnosedCase::run(&plan, spec)?;
    println!("verdict: {:?}", diagnosed.diagnosis().verdict.effects());

    let truth = seal.open(spec.number, sealed.as_bytes())?;
    let result = diagnosed.score(&truth, seal.hash_of(spec.number))?;
    let scores = Scores::from_cases(&[result.scored]);
    for name in [ScoreName::Reported, ScoreName::Class, ScoreName::PlantedClosureMedian] {
        println!("{}: {:?}", name.score().words, scores.reached(name).value());
    }
    // Three times the typical size of more drag everywhere cannot be overlooked.
    assert_eq!(scores.reached(ScoreName::Reported).value(), Some(1.0));
    Ok(())
}
