//! The entry that tells where mass comes from.

use super::columns::Columns;
use super::names::engine_of;
use super::rules::{COMPUTED_FUEL, GAUGES, GROSS, Kind, TAKE_OFF, TANKS, USED, ZERO_FUEL};

/// Where no column holds a mass, while the recording is looked at.
pub(super) const START_MASS: &str = "StartMass(gross_weight: Value(60000, \"kg\")),   // ?";
/// What is then written: a column that no recording has.
const NO_MASS: &str = "GrossMass(column: \"GROSS WEIGHT\", unit: \"kg\", largest_rise_kg: 200),   // ? no column is known for it; from a known take-off mass: StartMass(gross_weight: Value(…, \"kg\"))";
/// The same of a zero-fuel weight where tanks are gauged.
const ANY_ZERO_FUEL_WEIGHT: &str = "Value(10000, \"kg\")";
const NO_ZERO_FUEL_WEIGHT: &str = "Column(\"ZERO FUEL WEIGHT\", \"kg\")";

/// The mapping without the masses that no column holds.
pub(super) fn without_masses(mapping: &str) -> String {
    mapping.replace(START_MASS, NO_MASS).replace(ANY_ZERO_FUEL_WEIGHT, NO_ZERO_FUEL_WEIGHT)
}

impl Columns {
    /// Where mass comes from.
    pub(super) fn mass(&self) -> String {
        let amount = |column: usize| {
            let (fields, is_guess) = self.recorded(column, Kind::Mass);
            (self.names[column].sent.clone(), mass_unit(&fields), is_guess)
        };
        let known = self.find(&GROSS);
        let gross = known.or_else(|| self.find(&TAKE_OFF).filter(|at| self.falls(*at)));
        let [zero, used] = [&ZERO_FUEL, &USED].map(|rule| self.find(rule));
        let tanks = self.find(&GAUGES).or_else(|| self.find(&COMPUTED_FUEL));
        let [left, right, center] = TANKS.each_ref().map(|rule| self.find(rule));
        let found = [gross, zero, tanks, used];
        let of_engines = self.used_by_engines();
        match found {
            [Some(gross), ..] => {
                let (fields, is_guess) = self.recorded(gross, Kind::Mass);
                format!(
                    "GrossMass({fields}, largest_rise_kg: 200),{}",
                    mark(is_guess || known.is_none())
                )
            }
            [None, Some(zero), Some(tanks), Some(used)] => {
                let [zero, tanks, used] = [zero, tanks, used].map(amount);
                format!(
                    "LoadSheet(fuel_used: Column({:?}, {:?}), zero_fuel_weight: Column({:?}, {:?}), fuel_on_board: Column({:?}, {:?})),   // ?",
                    used.0, used.1, zero.0, zero.1, tanks.0, tanks.1
                )
            }
            [None, Some(zero), Some(tanks), None] if of_engines.len() > 1 => {
                let [zero, tanks] = [zero, tanks].map(amount);
                let (_, unit, _) = amount(of_engines[0]);
                let names: Vec<&str> =
                    of_engines.iter().map(|column| self.names[*column].sent.as_str()).collect();
                format!(
                    "LoadSheet(fuel_used: Columns({names:?}, {unit:?}), zero_fuel_weight: Column({:?}, {:?}), fuel_on_board: Column({:?}, {:?})),   // ?",
                    zero.0, zero.1, tanks.0, tanks.1
                )
            }
            [None, Some(zero), Some(tanks), None] => {
                let [zero, tanks] = [zero, tanks].map(amount);
                format!(
                    "ZeroFuelAndTanks(zero_fuel_weight: Column({:?}, {:?}), tanks: [{:?}], unit: {:?}, largest_rise_kg: 500),{}",
                    zero.0,
                    zero.1,
                    tanks.0,
                    tanks.1,
                    mark(zero.2 || tanks.2)
                )
            }
            _ => match (left.zip(right), self.find(&TAKE_OFF)) {
                (Some((left, right)), _) => {
                    let tanks: Vec<usize> = [left, right].into_iter().chain(center).collect();
                    self.mass_of_tanks(&tanks, zero.map(amount))
                }
                (None, Some(start)) => {
                    let (name, unit, _) = amount(start);
                    format!("StartMass(gross_weight: Column({name:?}, {unit:?})),   // ?")
                }
                (None, None) => START_MASS.to_owned(),
            },
        }
    }

    fn mass_of_tanks(&self, tanks: &[usize], zero: Option<(String, &'static str, bool)>) -> String {
        let zero = zero.map_or_else(
            || ANY_ZERO_FUEL_WEIGHT.to_owned(),
            |(name, unit, _)| format!("Column({name:?}, {unit:?})"),
        );
        let unit = mass_unit(&self.recorded(tanks[0], Kind::Mass).0);
        let tanks: Vec<&str> = tanks.iter().map(|tank| self.names[*tank].sent.as_str()).collect();
        format!(
            "ZeroFuelAndTanks(zero_fuel_weight: {zero}, tanks: {tanks:?}, unit: {unit:?}, largest_rise_kg: 500),   // ?"
        )
    }

    /// Counters of fuel used, engine by engine.
    fn used_by_engines(&self) -> Vec<usize> {
        let of_engine = |engine: u8| {
            (0..self.names.len()).find(|&column| {
                engine_of(&self.names[column], USED.names) == Some(engine) && !self.is_empty(column)
            })
        };
        (1..=4).map_while(of_engine).collect()
    }

    /// Whether a column is less at its end than where it begins, and not only from flight to flight.
    fn falls(&self, column: usize) -> bool {
        let numbers: Vec<f64> =
            self.texts_of(column).filter_map(|text| self.number(text)).collect();
        let steps = numbers.windows(2).filter(|pair| (pair[0] - pair[1]).abs() > 0.0).count();
        numbers.last() < numbers.first() && steps >= MANY_STEPS.min(numbers.len() / MANY_STEPS)
    }
}

/// A gross mass changes as often at least in a recording of many rows, and in so many rows. Our choice.
const MANY_STEPS: usize = 20;

/// The unit among the fields of a recorded mass.
fn mass_unit(fields: &str) -> &'static str {
    let named = ["lb", "klb", "t"].into_iter().find(|unit| fields.contains(&format!("{unit:?}")));
    named.unwrap_or("kg")
}

const fn mark(is_guess: bool) -> &'static str {
    if is_guess { "   // ?" } else { "" }
}
