//! Mass and fuel used of a report, by each of the routes that a mapping can name.

use flight::column::Column;
use units::Mass;

use super::flow::Burnt;
use super::masses::GrossMasses;
use super::{Load, Part, Series};
use crate::mapping::SHORTEST_GAP_S;
use crate::mapping::plan::{Conversion, Load as LoadSource, MassPlan};
use crate::refusal::{Found, Refusal, RefusalKind};

/// A counter of fuel used may fall by this much.
pub(super) const FUEL_USED_STEP_KG: f64 = 0.5;
const DIFFERENCE_ROUNDING_KG: f64 = 1e-9;

impl Part<'_> {
    pub(super) fn load(&self, masses: Option<&GrossMasses>) -> Result<Load, Refusal> {
        match &self.plan.mass {
            MassPlan::GrossMass { .. } | MassPlan::ZeroFuelAndTanks { .. } => {
                // Either plan has masses.
                let none = RefusalKind::MassNotPositive { mass: "gross mass" };
                let refused = || self.refuse(0, 0, Found::Rows(0), none);
                self.load_of_gross_mass(masses.ok_or_else(refused)?)
            }
            MassPlan::StartMass { gross_mass } => self.load_of_integrated_flow(gross_mass),
            MassPlan::FuelUsed { fuel_used, zero_fuel_mass, fuel_on_board } => {
                let used_kg = |row| self.sum_kg(fuel_used, row);
                let zero_fuel_mass = self.mass_of(zero_fuel_mass, &|_| 0.0)?;
                let fuel_on_board = self.mass_of(fuel_on_board, &used_kg)?;
                let used_rows = self.rows.runs().flatten();
                let series = Series::new(used_rows.map(used_kg).collect(), input_of(fuel_used));
                let maximum = Some(fuel_on_board.to_kilograms());
                self.check_range(Column::FuelUsed, &series, maximum)?;
                self.check_fuel_used_series(&series)?;
                Ok(Load {
                    zero_fuel_mass,
                    fuel_on_board,
                    fuel_used_kg: series.values,
                    largest_rise_kg: None,
                    bridged: 0,
                    doubts: Vec::new(),
                })
            }
        }
    }

    /// A mass of the load sheet: in a column that of the recording's first row. A column that falls is no load sheet, which stays as
    /// it was sent, but what there is at each row (the tanks' contents, gross mass): it lacks the fuel burnt until then.
    #[inline(never)]
    pub(super) fn mass_of(
        &self,
        load: &LoadSource,
        burnt_kg: &dyn Fn(usize) -> f64,
    ) -> Result<Mass, Refusal> {
        let conversions = match load {
            LoadSource::Known(mass) => return Ok(*mass),
            LoadSource::Columns(conversions) => conversions,
        };
        let (first, falls) = self.first_sent(conversions, burnt_kg);
        let value = self.sum_kg(conversions, first) + if falls { burnt_kg(first) } else { 0.0 };
        if value > 0.0 {
            return Ok(Mass::kilograms(value));
        }
        let kind = RefusalKind::MassNotPositive { mass: "mass of the load sheet" };
        let found = Found::Number { value, unit: "kg" };
        Err(self.refuse(0, input_of(conversions), found, kind))
    }

    /// The first row that has a mass of the load sheet, and whether that falls further on.
    #[inline(never)]
    pub(super) fn first_sent(
        &self,
        conversions: &[Conversion],
        burnt_kg: &dyn Fn(usize) -> f64,
    ) -> (usize, bool) {
        let at = |row: usize| self.sum_kg(conversions, row);
        let sent = |row: &usize| at(*row).is_finite() && burnt_kg(*row).is_finite();
        let rows = 0..self.recording.time_s.len();
        let first = rows.clone().find(sent).unwrap_or(self.rows.at(0));
        let last = rows.rev().find(sent).unwrap_or(first);
        (first, at(last) < at(first) - FUEL_USED_STEP_KG)
    }

    /// The sum of columns in a row of the recording. In one piece: the program has no room for each of its uses.
    #[inline(never)]
    pub(super) fn sum_kg(&self, conversions: &[Conversion], row: usize) -> f64 {
        conversions.iter().map(|one| one.apply(&self.recording.numbers, row)).sum()
    }

    /// Gross mass at the recording's first row less the integral of fuel flow (trapezoids) from there, climb included.
    fn load_of_integrated_flow(&self, gross_mass: &LoadSource) -> Result<Load, Refusal> {
        let Burnt { by_row_kg: burnt_by_row_kg, bridged } = self.burnt();
        let last = self.rows.at(self.rows.len() - 1);
        self.check_gaps(&burnt_by_row_kg[..=last])?;
        self.check_start_mass(gross_mass, &burnt_by_row_kg[..=last])?;
        let start_kg = self.mass_of(gross_mass, &|row| burnt_by_row_kg[row])?.to_kilograms();
        let doubts = self.doubts_of_start_mass(gross_mass, &burnt_by_row_kg[..=last], start_kg);
        let last_kg = burnt_by_row_kg[last];
        let zero_fuel_kg = start_kg - last_kg;
        if zero_fuel_kg <= 0.0 || last_kg <= 0.0 {
            let kind = RefusalKind::MassNotPositive { mass: "gross mass" };
            let found = Found::Number { value: zero_fuel_kg, unit: "kg" };
            return Err(self.refuse(0, 0, found, kind));
        }
        let fuel_kg = self.fuel_by_gauges_kg(&burnt_by_row_kg).unwrap_or(last_kg);
        let is_possible = (last_kg..start_kg).contains(&fuel_kg);
        let fuel_kg = if is_possible { fuel_kg } else { last_kg };
        Ok(Load {
            zero_fuel_mass: Mass::kilograms(start_kg - fuel_kg),
            fuel_on_board: Mass::kilograms(fuel_kg),
            fuel_used_kg: self
                .rows
                .runs()
                .flat_map(|run| burnt_by_row_kg[run].iter().copied())
                .collect(),
            largest_rise_kg: None,
            bridged,
            doubts,
        })
    }

    /// Fuel in the tanks at the recording's first row, where the gauges are recorded: what they read first of the rows that are used, and
    /// what was burnt until then.
    fn fuel_by_gauges_kg(&self, burnt_by_row_kg: &[f64]) -> Option<f64> {
        let quantity = self.plan.recorded_as(Column::FuelQuantity)?;
        let at = |row: usize| quantity.apply(&self.recording.numbers, row) + burnt_by_row_kg[row];
        self.rows.runs().flatten().map(at).find(|fuel_kg| fuel_kg.is_finite())
    }

    /// Where flights are parked between them nobody knows what was burnt, nor what was refuelled: a start mass does not reach over
    /// that. Before anything was burnt it does.
    fn check_gaps(&self, burnt_by_row_kg: &[f64]) -> Result<(), Refusal> {
        let longest_s = self.plan.longest_gap_s();
        let time_s = &self.recording.time_s;
        let gaps = time_s.windows(2).zip(burnt_by_row_kg).enumerate();
        let mut gaps = gaps.map(|(row, (pair, burnt_kg))| (row + 1, pair[1] - pair[0], *burnt_kg));
        let behind = |row: usize| burnt_by_row_kg.get(row).copied();
        let found = gaps.find(|(row, gap_s, before_kg)| {
            *gap_s > longest_s
                && behind(*row).is_some_and(|burnt_kg| burnt_kg.max(*before_kg) > 0.0)
        });
        let Some((row, value, _)) = found else { return Ok(()) };
        let kind = RefusalKind::FlowOverGap { longest_s };
        let found = Found::Number { value, unit: "s" };
        Err(self.layout.refuse_time(self.recording, row, found, kind))
    }

    /// As in the text format: a counter never falls by more than its step.
    fn check_fuel_used_series(&self, series: &Series) -> Result<(), Refusal> {
        let mut largest = f64::NEG_INFINITY;
        for (row, value) in series.values.iter().enumerate() {
            if *value < largest - FUEL_USED_STEP_KG - DIFFERENCE_ROUNDING_KG {
                let unit = "kg";
                let gap_s = self.longest_gap_s(row);
                let tolerance = FUEL_USED_STEP_KG;
                let kind = RefusalKind::FuelUsedFalls { largest, tolerance, unit, gap_s };
                let found = Found::Number { value: *value, unit };
                return Err(self.refuse(row, series.input, found, kind));
            }
            largest = largest.max(*value);
        }
        Ok(())
    }

    /// Fuel used is how far gross mass has fallen below its first value: the running maximum of the fall, because
    /// recorded masses come in steps and alternate between two of them.
    fn load_of_gross_mass(&self, masses: &GrossMasses) -> Result<Load, Refusal> {
        let zero_fuel_mass =
            masses.zero_fuel_mass.or_else(|| self.zero_fuel_mass_by_gauges(&masses.masses));
        let admissible_rise_kg = masses.largest_rise_kg;
        if let Some(row) = masses.impossible.first() {
            return Err(self.refuse_impossible_mass(masses, *row));
        }
        let masses = &masses.masses;
        let masses_kg = &masses.values;
        let first_kg = masses_kg[0];
        let mut smallest_kg = first_kg;
        let mut largest_rise_kg = 0.0_f64;
        let mut fuel_used_kg = Vec::with_capacity(masses_kg.len());
        for (row, mass_kg) in masses_kg.iter().enumerate() {
            let found = Found::Number { value: *mass_kg, unit: "kg" };
            if *mass_kg <= 0.0 {
                let kind = RefusalKind::MassNotPositive { mass: "gross mass" };
                return Err(self.refuse(row, masses.input, found, kind));
            }
            smallest_kg = smallest_kg.min(*mass_kg);
            let rise_kg = mass_kg - smallest_kg;
            if rise_kg > admissible_rise_kg {
                let gap_s = self.longest_gap_s(row);
                let kind = RefusalKind::GrossMassRises { smallest_kg, admissible_rise_kg, gap_s };
                return Err(self.refuse(row, masses.input, found, kind));
            }
            largest_rise_kg = largest_rise_kg.max(rise_kg);
            fuel_used_kg.push(first_kg - smallest_kg);
        }
        let burnt_kg = first_kg - smallest_kg;
        let zero_fuel_mass = zero_fuel_mass.unwrap_or(Mass::kilograms(smallest_kg));
        let fuel_on_board = Mass::kilograms(first_kg) - zero_fuel_mass;
        let fuel_on_board_kg = fuel_on_board.to_kilograms();
        // A single point has burnt nothing yet, so that nothing is known of its fuel where no load sheet is.
        let is_single = self.plan.points.is_some() && burnt_kg == 0.0;
        if fuel_on_board_kg < burnt_kg || (fuel_on_board_kg == 0.0 && !is_single) {
            let kind = RefusalKind::MassNotPositive { mass: "fuel on board" };
            let found = Found::Number { value: fuel_on_board_kg - burnt_kg, unit: "kg" };
            return Err(self.refuse(0, masses.input, found, kind));
        }
        let largest_rise_kg = Some(largest_rise_kg);
        let (bridged, doubts) = (0, Vec::new());
        Ok(Load { zero_fuel_mass, fuel_on_board, fuel_used_kg, largest_rise_kg, bridged, doubts })
    }

    /// A gross mass that does not go together with those around it.
    fn refuse_impossible_mass(&self, masses: &GrossMasses, row: usize) -> Refusal {
        let masses_kg = &masses.masses.values;
        let value = masses_kg[row];
        let found = Found::Number { value, unit: "kg" };
        let is_possible = |row: &usize| !masses.impossible.contains(row);
        let around = (0..row).rev().find(is_possible);
        let around = around.or_else(|| (row..masses_kg.len()).find(is_possible));
        let kind = match around {
            Some(around) if value > 0.0 => {
                RefusalKind::GrossMassJumps { around_kg: masses_kg[around] }
            }
            _ => RefusalKind::MassNotPositive { mass: "gross mass" },
        };
        self.refuse(row, masses.masses.input, found, kind)
    }

    /// The longest time without a row between a row and the one used before it, where another flight may have begun meanwhile.
    fn longest_gap_s(&self, row: usize) -> Option<f64> {
        let before = self.rows.at(row.checked_sub(1)?);
        let time_s = &self.recording.time_s[before..=self.rows.at(row)];
        let gaps = time_s.windows(2).map(|pair| pair[1] - pair[0]);
        gaps.reduce(f64::max).filter(|gap_s| *gap_s >= SHORTEST_GAP_S)
    }
}

/// The first of the inputs that are added up.
pub(super) fn input_of(conversions: &[Conversion]) -> usize {
    conversions.first().map_or(0, |conversion| conversion.input)
}
