//! `cruisefit show`: what a model file holds, for a person.

use std::fmt::Write;

use crate::args::ShowArgs;
use crate::commands::Outcome;
use crate::failure::Failure;
use crate::model_file::{LawState, Learnt, ModelFile};
use crate::summary::aligned;

/// Runs the command.
///
/// # Errors
/// What leaves nothing done.
pub fn run(arguments: &ShowArgs) -> Result<Outcome, Failure> {
    let model = ModelFile::read(&arguments.model)?;
    let mut text = String::new();
    describe_initial(&model, &mut text);
    match &model.learnt {
        Some(learnt) => describe_learnt(&model, learnt, &mut text),
        None => text.push_str("It has learnt nothing yet.\n"),
    }
    describe_table(&model, &mut text);
    Ok(Outcome::text(text))
}

fn describe_initial(model: &ModelFile, text: &mut String) {
    let aircraft = model.initial.aircraft();
    let _ = writeln!(
        text,
        "{} ({}), {} engines",
        aircraft.name(),
        aircraft.type_code(),
        aircraft.engines()
    );
    let law = aircraft.tsfc_law();
    let _ = writeln!(
        text,
        "wing area {} m², TSFC {:.4} lb/(lbf h) · √θ · (1 + M)^{}",
        aircraft.wing_area().to_square_meters(),
        law.static_tsfc.to_pounds_per_pound_force_hour(),
        law.mach_exponent
    );
    let polynomial = model.initial.polynomial();
    let _ = writeln!(
        text,
        "initial polynomial {:?}: {}",
        polynomial.basis,
        polynomial.coefficients.map(|c| format!("{c:.6e}")).join(", ")
    );
    let guide = &model.guide;
    let _ = writeln!(
        text,
        "from {} points of a guide, lift coefficient {:.3} to {:.3}, Mach number {:.3} to {:.3}, residual {:.2} counts rms",
        guide.points,
        guide.lift_coefficient.0,
        guide.lift_coefficient.1,
        guide.mach.0,
        guide.mach.1,
        1e4 * guide.residual_rms
    );
}

fn describe_learnt(model: &ModelFile, learnt: &Learnt, text: &mut String) {
    let LawState::Paper { settings, .. } = &learnt.law;
    let segments: u64 = learnt.ledger.iter().map(|entry| entry.segments).sum();
    let _ = writeln!(
        text,
        "Learnt from {} flights of tail {} ({segments} segments) by law paper, threshold {} %, criteria {}; {:.0} % of the nodes ever adapted, {} global refits",
        learnt.ledger.len(),
        learnt.tail,
        settings.threshold_percent,
        learnt.criteria,
        100.0 * model.informed_nodes(),
        model.refits().unwrap_or(0)
    );
    if let (Some(first), Some(last)) = (
        learnt.ledger.iter().map(|entry| entry.start.as_str()).min(),
        learnt.ledger.iter().map(|entry| entry.start.as_str()).max(),
    ) {
        let _ = writeln!(text, "flights from {first} to {last}");
    }
    let means: Vec<String> = learnt
        .references
        .iter()
        .map(|(name, reference)| format!("{name} {:.4} (n {})", reference.mean, reference.segments))
        .collect();
    let _ = writeln!(text, "reference means: {}", means.join(", "));
}

fn describe_table(model: &ModelFile, text: &mut String) {
    let grid = model.grid();
    let drag = model.drag_coefficient();
    let confidence = model.confidence();
    let _ = writeln!(
        text,
        "\nDrag coefficient in counts (1e-4), lift coefficient down, Mach number across. \
         ~ extrapolated beyond the guide and not corrected since; * adapted since the last global refit"
    );
    let mut rows = Vec::new();
    let mut head = vec!["CL \\ M".to_owned()];
    head.extend(grid.y().breakpoints().iter().map(|mach| format!("{mach:.3} ")));
    rows.push(head);
    for (i, lift_coefficient) in grid.x().breakpoints().iter().enumerate() {
        let mut row = vec![format!("{lift_coefficient:.3}")];
        for j in 0..grid.y().len() {
            let node = i * grid.y().len() + j;
            let mark = if confidence.is_some_and(|table| table.value_at_node(node) > 1.0) {
                '*'
            } else if model.initial.extrapolated()[node] {
                '~'
            } else {
                ' '
            };
            row.push(format!("{:.1}{mark}", 1e4 * drag.value_at_node(node)));
        }
        rows.push(row);
    }
    text.push_str(&aligned(&rows));
}
