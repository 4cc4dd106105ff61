//! What the trim criteria cost.

use maud::{Markup, html};
use pipeline::criteria_costs::CriteriaCosts;

use crate::text::percent;
use pipeline::summary::counted;

/// What became of the samples, in a sentence, and criterion by criterion in a folded table.
pub(crate) fn costs(costs: &CriteriaCosts) -> Markup {
    let share =
        |count: usize| percent((costs.samples > 0).then(|| count as f64 / costs.samples as f64));
    let dearest = costs.criteria.iter().max_by_key(|one| one.unsteady_alone);
    html! {
        h4 { "What the trim criteria cost" }
        p {
            "Of " (counted(costs.samples, "sample")) " in the " (counted(costs.flights, "flight")) " of this run "
            (share(costs.kept)) " are in segments; " (share(costs.unsteady)) " were not steady, " (share(costs.outlying))
            " were discarded as outliers, " (share(costs.in_dropped_pieces)) " lay in pieces too short."
            @if let Some(one) = dearest.filter(|one| one.unsteady_alone > 0) {
                " The criterion that alone costs most is that on " (one.name) ": " (counted(one.unsteady_alone, "sample")) "."
            }
        }
        details.more {
            summary { "Criterion by criterion" }
            div.scroll tabindex="0" role="region" aria-label="Cost of each criterion" {
                table.small.data data-name="trim-criteria" {
                    thead { tr {
                        th scope="col" { "criterion" } th scope="col" { "samples not steady" } th scope="col" { "by it alone" }
                        th scope="col" { "outliers" } th scope="col" { "flights not judged" }
                    } }
                    tbody { @for one in &costs.criteria { tr {
                        th scope="row" { (one.name) }
                        td { (one.unsteady) } td { (one.unsteady_alone) } td { (one.outliers) } td { (one.not_evaluated) }
                    } } }
                }
            }
        }
    }
}
