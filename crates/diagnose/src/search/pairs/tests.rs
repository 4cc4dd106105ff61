use flight::effect::EffectGroup;

use super::*;
use crate::hypotheses::evidence::Prior;
use crate::math::mixture::Mixture;

/// An effect of usual and of larger sizes, with a thin tail of very large ones.
fn prior(mean: f64, deviation: f64, sign: EffectSign) -> Prior {
    Prior {
        mean,
        scales: [
            (deviation, 0.45_f64.ln()),
            (3.0 * deviation, 0.45_f64.ln()),
            (10.0 * deviation, 0.1_f64.ln()),
        ],
        count: 3,
        sign,
    }
}

/// Against the evidence of one pair at a time, which has its own test against numerical integration.
#[test]
fn same_as_one_pair_at_a_time() {
    let columns = 4;
    let scorer = Scorer {
        priors: vec![
            prior(0.0, 1.0, EffectSign::Positive),
            prior(1.0, 0.15, EffectSign::Either),
            prior(0.0, 2.0, EffectSign::Positive),
            prior(0.0, 0.5, EffectSign::Either),
        ],
        effect_of: vec![0, 1, 2, 2],
        ln_choices: vec![0.0, 0.0, 2.0_f64.ln(), 2.0_f64.ln()],
        effects: 3,
        age_of: vec![None; 3],
        held: vec![false; 3],
        rows: 60.0,
    };
    let background = |small_effects_scale: f64| {
        let shrink = 1.0 / (1.0 + small_effects_scale);
        // A Gram and a product of whole numbers, positive definite by its diagonal.
        let gram = [
            [40.0, 10.0, -5.0, 3.0],
            [10.0, 30.0, 8.0, -6.0],
            [-5.0, 8.0, 25.0, 20.0],
            [3.0, -6.0, 20.0, 35.0],
        ];
        let product = [21.0, 17.0, -9.0, 4.0];
        let mut matrix = faer::Mat::<f64>::zeros(columns + 1, columns + 1);
        for i in 0..columns {
            for j in 0..columns {
                matrix[(i, j)] = shrink * gram[i][j];
            }
            matrix[(i, columns)] = shrink * product[i];
        }
        matrix[(columns, columns)] = 75.0;
        let mut at = Background::small(&matrix, &[0, 1, 2, 3], columns, 3.0 * small_effects_scale);
        at.small_effects_scale = small_effects_scale;
        at.ln_prior = if small_effects_scale > 0.0 { 0.4_f64.ln() } else { 0.6_f64.ln() };
        at
    };
    let backgrounds = [background(0.0), background(0.3)];
    let context = Context {
        uncertain_table: &[false, true],
        large: &[true; 4],
        best: f64::NEG_INFINITY,
        negligible: NEGLIGIBLE,
    };
    let found = search(&scorer, &backgrounds, context);
    assert_eq!(found.len(), 5, "the two columns of one effect make no pair");
    for scored in &found {
        let (a, b) = (scored.hypothesis.columns[0], scored.hypothesis.columns[1]);
        let prior = scorer.ln_prior(&scored.hypothesis);
        let mut sum = Mixture::<2>::new();
        for at in &backgrounds {
            let one = scorer.two(at, [a, b], [0.0; 2]);
            sum.add(one.ln + prior + at.ln_prior, one.sizes, one.deviations);
        }
        let last = scorer.two(&backgrounds[1], [a, b], [0.0; 2]).ln + prior;
        let share = (last + backgrounds[1].ln_prior - sum.mean().ln).exp();
        assert!((scored.table_share - share).abs() < 1e-10, "{a} {b}");
        let mean = sum.mean();
        assert!((scored.ln_weight - mean.ln).abs() < 1e-10, "{a} {b}");
        for k in 0..2 {
            assert!((scored.sizes[k] - mean.sizes[k]).abs() < 1e-12, "{a} {b}");
            assert!((scored.deviations[k] - mean.deviations[k]).abs() < 1e-12, "{a} {b}");
        }
    }
    // Only what is negligible against a better model is left out.
    let best = found.iter().map(|m| m.ln_weight).fold(f64::NEG_INFINITY, f64::max);
    assert!(
        search(&scorer, &backgrounds, Context { best: best + 2.0 * NEGLIGIBLE, ..context })
            .is_empty()
    );
    assert_eq!(search(&scorer, &backgrounds, Context { best, ..context }).len(), found.len());
}

/// Two effects of a column each, and the parts that get worse with age by them.
fn scorer_of_two(priors: [Prior; 2], age_of: [Option<EffectGroup>; 2]) -> Scorer {
    Scorer {
        priors: priors.to_vec(),
        effect_of: vec![0, 1],
        ln_choices: vec![0.0; 2],
        effects: 2,
        age_of: age_of.to_vec(),
        held: vec![false; 2],
        rows: 60.0,
    }
}

fn pair_of_sizes(sizes: [f64; 2]) -> ScoredHypothesis {
    ScoredHypothesis {
        hypothesis: Hypothesis { columns: vec![0, 1], flight_scatter_percent: None },
        ln_weight: 0.0,
        sizes: sizes.to_vec(),
        deviations: vec![0.1; 2],
        background: 0,
        table_share: 0.0,
    }
}

/// By hand: eleven typical sizes of one of two are more than ten, nine are not; of a known coefficient, mean 1 and deviation
/// 0.15, 2.4 is within ten deviations.
#[test]
fn a_pair_with_an_impossible_size_is_not_believed() {
    let of = |mean: f64, deviation: f64| Prior {
        mean,
        scales: [(deviation, 0.0); 3],
        count: 1,
        sign: EffectSign::Either,
    };
    let scorer = scorer_of_two([of(0.0, 2.0), of(1.0, 0.15)], [None; 2]);
    let with = pair_of_sizes;
    assert!(is_possible(&scorer, &with([-18.0, 2.4])));
    assert!(!is_possible(&scorer, &with([-22.0, 1.0])));
    assert!(!is_possible(&scorer, &with([1.0, 2.6])));
}

/// Two slopes of one part are one effect; of two parts, one against the other, a step: −4.7 and +4.6 % a year from dates a year apart
/// are 4.65 % at once.
#[test]
fn two_slopes_make_no_step() {
    let prior = Prior { mean: 0.0, scales: [(1.2, 0.0); 3], count: 1, sign: EffectSign::Positive };
    let of = |parts: [Option<EffectGroup>; 2]| scorer_of_two([prior; 2], parts);
    let sized = pair_of_sizes;
    let (airframe, engine) = (Some(EffectGroup::Airframe), Some(EffectGroup::Engine));
    assert!(of([airframe, airframe]).is_one_history(0, 1));
    assert!(!of([airframe, engine]).is_one_history(0, 1));
    assert!(!of([None, None]).is_one_history(0, 1));
    assert!(is_possible(&of([airframe, engine]), &sized([1.0, 0.8])));
    assert!(!is_possible(&of([airframe, engine]), &sized([-4.7, 4.6])));
    assert!(is_possible(&of([airframe, None]), &sized([-4.7, 4.6])));
}
