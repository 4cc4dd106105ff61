//! From the gap to the noise as a drawing, of a diagnosis as a file has it.

use maud::{Markup, html};
use pipeline::diagnosis_document::TailDiagnosis;

use crate::chart::{Axis, Chart};

/// Width of a step: its words, some 30 characters, stand under it; and of the margins of a chart.
const STEP: f64 = 190.0;
const MARGINS: f64 = 76.0;

/// Steps of one diagnosis: words, root mean square in %, class. None of one without a gap: of insufficient data.
fn steps(diagnosis: &TailDiagnosis) -> Vec<(String, f64, &'static str)> {
    let gap = &diagnosis.gap;
    let (Some(rms_percent), Some(floor)) = (gap.rms_percent, gap.noise_floor_rms_percent) else {
        return Vec::new();
    };
    let mut steps = vec![("gap".to_owned(), rms_percent, "more4")];
    let first = diagnosis.causes.iter().find_map(|cause| Some((cause, cause.rms_after_percent?)));
    steps
        .extend(first.map(|(cause, left)| (format!("with {} added", cause.effect), left, "less5")));
    steps.push(("noise of the sensors".to_owned(), floor, "even"));
    let floors = [
        ("noise of like segments", gap.floor_by_replicates_rms_percent),
        ("flexible model", gap.floor_by_held_out_fit_rms_percent),
    ];
    steps.extend(
        floors.into_iter().filter_map(|(words, floor)| Some((words.to_owned(), floor?, "even"))),
    );
    steps
}

/// The drawing: a bar for each step, its words and number below it.
pub(crate) fn waterfall(diagnosis: &TailDiagnosis, number: usize) -> Markup {
    let steps = steps(diagnosis);
    if steps.is_empty() {
        return html! {};
    }
    let largest = steps.iter().map(|step| step.1).fold(0.0, f64::max);
    let chart = Chart {
        id: format!("waterfall-{number}"),
        title: format!("{}: from the gap to the noise", diagnosis.tail),
        description: "Root mean square of the gap, what the first cause leaves on flights that it was not fitted to, noise.".to_owned(),
        width: MARGINS + STEP * steps.len() as f64,
        height: 300.0,
        x: Axis::of_names(&steps.iter().map(|step| format!("{}: {:.2}", step.0, step.1)).collect::<Vec<_>>()),
        y: Axis::around(0.0, largest, 6),
        x_label: String::new(),
        y_label: "gap, % rms".to_owned(),
    };
    chart.draw(&html! {
        @for (k, (words, value, class)) in steps.iter().enumerate() {
            @let at = k as f64;
            (chart.cell((at + 0.2, at + 0.8), (0.0, *value), class, &format!("{words}: {value:.2} %")))
        }
    })
}
