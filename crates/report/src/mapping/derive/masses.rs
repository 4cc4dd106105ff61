//! Gross masses of a report's rows, and those that no aircraft has between the masses before and behind.

use flight::column::Column;
use units::Mass;

use super::rows::Surplus;
use super::{Part, Series};
use crate::mapping::file::OutOfRange;
use crate::mapping::plan::MassPlan;
use crate::refusal::Refusal;

/// Share of its mass that no aircraft burns within an hour, and by which recorded masses step. Our choice: three times what
/// the thirstiest burns, and more than any recorder's step.
const LARGEST_FALL_PER_HOUR: f64 = 0.3;
const LARGEST_STEP: f64 = 0.05;
/// Rows of which one may be wrong for itself: of more it is the column, or another flight. Our choice.
const ROWS_FOR_ONE: usize = 20;
/// Fewer rows do not tell which of them is wrong.
const FEWEST_ROWS: usize = 5;
/// Stretches of masses that go together, up to which they are compared with each other.
const MOST_STRETCHES: usize = 2000;
const SECONDS_PER_HOUR: f64 = 3600.0;

/// Recorded gross masses of the rows that are used.
pub(super) struct GrossMasses {
    pub(super) masses: Series,
    /// Where the mapping states it.
    pub(super) zero_fuel_mass: Option<Mass>,
    pub(super) largest_rise_kg: f64,
    /// Places among the rows of those that are impossible, where they are not left out.
    pub(super) impossible: Vec<usize>,
}

impl Part<'_> {
    /// The gross masses where they are recorded. Rows with an impossible one are taken out where the mapping leaves out what is out of
    /// range, and given.
    pub(super) fn gross_masses(
        &mut self,
        fewest: usize,
    ) -> Result<(Option<GrossMasses>, Vec<Surplus>), Refusal> {
        let Some(mut found) = self.recorded_masses()? else { return Ok((None, Vec::new())) };
        let mut time_s = Vec::with_capacity(self.rows.len());
        for run in self.rows.runs() {
            time_s.extend_from_slice(&self.recording.time_s[run]);
        }
        let masses_kg = &mut found.masses.values;
        found.impossible = impossible(&time_s, masses_kg, found.largest_rise_kg);
        let left = masses_kg.len() - found.impossible.len();
        if found.impossible.is_empty()
            || self.plan.out_of_range == OutOfRange::Refuse
            || left < fewest
        {
            return Ok((Some(found), Vec::new()));
        }
        let places = core::mem::take(&mut found.impossible);
        let surplus: Vec<Surplus> =
            places.iter().map(|place| (self.rows.at(*place), None)).collect();
        let mut left_out = places.iter().peekable();
        let mut place = 0;
        masses_kg.retain(|_| {
            let is_left_out = left_out.next_if(|next| **next == place).is_some();
            place += 1;
            !is_left_out
        });
        self.rows = self.rows.without(&surplus);
        self.converted.clear();
        Ok((Some(found), surplus))
    }

    fn recorded_masses(&self) -> Result<Option<GrossMasses>, Refusal> {
        let (masses, zero_fuel_mass, largest_rise_kg) = match &self.plan.mass {
            MassPlan::GrossMass { mass, zero_fuel_mass, largest_rise_kg } => {
                let masses = Series::new(self.convert(mass), mass.input);
                (masses, *zero_fuel_mass, *largest_rise_kg)
            }
            MassPlan::ZeroFuelAndTanks { zero_fuel_mass, tanks, largest_rise_kg } => {
                let zero_fuel_mass = self.mass_of(zero_fuel_mass, &|_| 0.0)?;
                let mut values = vec![zero_fuel_mass.to_kilograms(); self.rows.len()];
                for tank in tanks {
                    for (value, fuel_kg) in values.iter_mut().zip(self.convert(tank)) {
                        *value += fuel_kg;
                    }
                }
                let input = tanks.first().map_or(0, |tank| tank.input);
                (Series::new(values, input), Some(zero_fuel_mass), *largest_rise_kg)
            }
            MassPlan::StartMass { .. } | MassPlan::FuelUsed { .. } => return Ok(None),
        };
        let impossible = Vec::new();
        Ok(Some(GrossMasses { masses, zero_fuel_mass, largest_rise_kg, impossible }))
    }

    /// Zero-fuel mass where gross mass and the contents of the tanks are recorded: the difference in the first row that has both.
    pub(super) fn zero_fuel_mass_by_gauges(&self, masses: &Series) -> Option<Mass> {
        let quantity = self.plan.recorded_as(Column::FuelQuantity)?;
        let rows = self.rows.runs().flatten().zip(&masses.values);
        let mut zero_fuel_kg =
            rows.map(|(row, mass_kg)| mass_kg - quantity.apply(&self.recording.numbers, row));
        let first_kg = zero_fuel_kg.find(|zero_fuel_kg| zero_fuel_kg.is_finite())?;
        (first_kg > 0.0).then(|| Mass::kilograms(first_kg))
    }
}

/// Rows that follow each other, whose masses go together, or are no masses.
#[derive(Clone, Copy)]
struct Stretch {
    first: usize,
    last: usize,
    /// Rows of it and of those before that go together with it.
    rows: usize,
    /// The stretch before it.
    before: Option<usize>,
}

/// The places of masses that go together neither with those before nor with those behind: of all choices of rows whose masses fall as
/// fuel is burnt, those that the one of most rows leaves out. None where more are wrong than one in twenty.
fn impossible(time_s: &[f64], masses_kg: &[f64], largest_rise_kg: f64) -> Vec<usize> {
    let rows = masses_kg.len();
    let is_mass = |row: usize| masses_kg[row] > 0.0;
    let follows = |earlier: usize, later: usize| {
        let (before_kg, after_kg) = (masses_kg[earlier], masses_kg[later]);
        let hours = (time_s[later] - time_s[earlier]) / SECONDS_PER_HOUR;
        let fall = LARGEST_STEP + LARGEST_FALL_PER_HOUR * hours;
        after_kg <= before_kg + largest_rise_kg && after_kg >= before_kg * (1.0 - fall)
    };
    // What rises and falls back is a stretch of its own, though the fall alone is one that masses have.
    let is_smooth = |earlier: usize, later: usize| {
        let hours = (time_s[later] - time_s[earlier]) / SECONDS_PER_HOUR;
        let fall_kg = masses_kg[earlier] - masses_kg[later];
        fall_kg <= largest_rise_kg + LARGEST_FALL_PER_HOUR * hours * masses_kg[earlier]
    };
    let most = (rows / ROWS_FOR_ONE).max(1);
    let most_stretches = (2 * most + 1).min(MOST_STRETCHES);
    let mut stretches: Vec<Stretch> = Vec::new();
    for row in 0..rows {
        let is_full = stretches.len() == most_stretches;
        match stretches.last_mut() {
            Some(last) if is_mass(row) && follows(last.last, row) && is_smooth(last.last, row) => {
                last.last = row;
                last.rows += 1;
            }
            _ if is_full => return Vec::new(),
            _ => stretches.push(Stretch { first: row, last: row, rows: 1, before: None }),
        }
    }
    if rows < FEWEST_ROWS || (stretches.len() == 1 && is_mass(0)) {
        return Vec::new();
    }
    for later in 0..stretches.len() {
        if !is_mass(stretches[later].first) {
            stretches[later].rows = 0;
            continue;
        }
        let earlier = (0..later)
            .filter(|earlier| {
                let earlier = &stretches[*earlier];
                earlier.rows > 0 && follows(earlier.last, stretches[later].first)
            })
            .max_by_key(|earlier| stretches[*earlier].rows);
        if let Some(earlier) = earlier {
            stretches[later].rows += stretches[earlier].rows;
            stretches[later].before = Some(earlier);
        }
    }
    let mut is_kept = vec![false; rows];
    let mut next = (0..stretches.len()).max_by_key(|stretch| stretches[*stretch].rows);
    while let Some(stretch) = next.map(|stretch| stretches[stretch]) {
        is_kept[stretch.first..=stretch.last].fill(true);
        next = stretch.before.filter(|_| stretch.rows > 0);
    }
    let wrong: Vec<usize> = (0..rows).filter(|row| !is_kept[*row]).collect();
    if wrong.len() > most { Vec::new() } else { wrong }
}
