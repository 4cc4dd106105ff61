//! What is wrong, or may be, with a mass that is followed from a start mass by fuel flow.

use flight::column::Column;
use units::convert::METERS_PER_FOOT;

use super::Part;
use super::load::{FUEL_USED_STEP_KG, input_of};
use crate::mapping::plan::Load as LoadSource;
use crate::mapping::{LOW_M, SHORTEST_GAP_S};
use crate::refusal::{Found, Refusal, RefusalKind};

/// A mass that differs by a larger share, beside what was burnt, is that of another flight: meters are good to less. Our choice.
const ANOTHER_MASS_SHARE: f64 = 0.02;
/// As many rows hold it: fewer are wrong numbers.
const FEWEST_ROWS: usize = 3;
/// Fuel that was burnt without a row is worth a word from this share of mass on: as much is the half of 1 % of fuel flow. Our choice.
const WORTH_A_WORD_SHARE: f64 = 0.005;

impl Part<'_> {
    /// A start mass that is another one further on is another flight's; what falls with the fuel that is burnt is gross mass.
    #[inline(never)]
    pub(super) fn check_start_mass(
        &self,
        start_mass: &LoadSource,
        burnt_by_row_kg: &[f64],
    ) -> Result<(), Refusal> {
        let LoadSource::Columns(conversions) = start_mass else { return Ok(()) };
        // Values, each with the row from which on it is sent, and how many rows send it.
        let mut runs: Vec<(f64, usize, usize)> = Vec::new();
        for row in 0..burnt_by_row_kg.len() {
            let sent_kg = self.sum_kg(conversions, row);
            match runs.last_mut() {
                _ if sent_kg.is_nan() => {}
                Some((value_kg, _, rows)) if (sent_kg - *value_kg).abs() <= FUEL_USED_STEP_KG => {
                    *rows += 1;
                }
                _ => runs.push((sent_kg, row, 1)),
            }
        }
        runs.retain(|(_, _, rows)| *rows >= FEWEST_ROWS);
        let is_another = |pair: &&[(f64, usize, usize)]| {
            let [start_kg, other_kg] = [pair[0], pair[1]].map(|one| one.0 + burnt_by_row_kg[one.1]);
            (other_kg - start_kg).abs() > ANOTHER_MASS_SHARE * start_kg
        };
        let Some(pair) = runs.windows(2).find(is_another) else { return Ok(()) };
        let kind = RefusalKind::StartMassChanges { before_kg: pair[0].0 };
        let found = Found::Number { value: pair[1].0, unit: "kg" };
        Err(self.layout.refuse(self.recording, (pair[1].1, input_of(conversions)), found, kind))
    }

    /// Code and words of what is not known of a mass that is followed to the last of these rows.
    #[inline(never)]
    pub(super) fn doubts_of_start_mass(
        &self,
        start_mass: &LoadSource,
        burnt_by_row_kg: &[f64],
        start_kg: f64,
    ) -> Vec<(&'static str, String)> {
        let mut doubts = Vec::new();
        let altitude = self.plan.recorded_as(Column::PressureAltitude);
        let first_m = altitude.map(|altitude| altitude.apply(&self.recording.numbers, 0));
        let falls = match start_mass {
            LoadSource::Known(_) => false,
            LoadSource::Columns(conversions) => self.first_sent(conversions, &|_| 0.0).1,
        };
        if let Some(first_m) = first_m.filter(|first_m| *first_m > LOW_M)
            && !falls
        {
            let message = format!(
                "the start mass is taken for that of the first row, at {:.0} ft: a take-off mass lacks what was burnt before",
                first_m / METERS_PER_FOOT
            );
            doubts.push(("mapped-start-in-flight", message));
        }
        let steps = self.recording.time_s.windows(2).zip(burnt_by_row_kg.windows(2));
        let gaps = steps.filter(|(time_s, _)| time_s[1] - time_s[0] >= SHORTEST_GAP_S / 4.0);
        let (count, burnt_kg) = gaps.fold((0, 0.0), |(count, sum_kg), (_, burnt_kg)| {
            (count + 1, sum_kg + burnt_kg[1] - burnt_kg[0])
        });
        if burnt_kg > WORTH_A_WORD_SHARE * start_kg {
            let message = format!(
                "{burnt_kg:.0} kg are taken as burnt in gaps of the rows ({count}), at the fuel flow around them: mass is wrong by what was not"
            );
            doubts.push(("mapped-flow-over-gap", message));
        }
        doubts
    }
}
