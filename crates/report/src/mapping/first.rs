//! A first mapping for a recording, from the names and values of its columns. What is a guess is marked `// ?`.

mod columns;
mod flights;
mod mass;
mod names;
mod points;
mod rules;
mod times;

use core::fmt::Write;

use columns::Columns;
use names::engine_of;
use rules::{
    CALIBRATED, ENGINE_NAMES, GAUGES, HEADING, INDICATED, Kind, ORDINARY, Rule, TEXTS, TOTAL_FLOW,
    TRACK,
};

use crate::decode;
use crate::refusal::Refusal;

/// The text of a mapping file that reads this recording, as far as names and values tell.
///
/// # Errors
/// [`Refusal`] where the bytes are not text, or hold no line of column names.
pub fn first_mapping(bytes: &[u8]) -> Result<String, Refusal> {
    let mut unpacked = Vec::new();
    let text = decode::recording(bytes, &mut unpacked)?;
    let columns = Columns::from_text(&text)?;
    let mut quantities = String::new();
    let known: Vec<&'static str> =
        ORDINARY.iter().filter_map(|rule| columns.ordinary(rule, &mut quantities)).collect();
    columns.ordinary(&GAUGES, &mut quantities);
    columns.engines(&mut quantities);
    columns.air_data(&known, &mut quantities);
    let (texts, time, mass) = (columns.texts(), columns.time(), columns.mass());
    let left_over = columns.left_over(&quantities, &[&texts, &time, &quantities, &mass]);
    let mapping = format!(
        "// Made from the names and values of a recording. Lines with `// ?` are guesses.\n\
         (\n    format: 1,\n{form}    bad_rows: LeaveRowOut,\n    out_of_range: LeaveRowOut,\n\
         {texts}    time: {time}\n    quantities: {{\n{quantities}    }},\n{left_over}    mass: {mass}\n{LEVEL_CRUISE})\n",
        form = columns.form_entries(),
    );
    let mapping = flights::mended(mapping, &text);
    let of_points = points::of_points(&mapping);
    let far_apart = points::are_far_apart(&of_points, &text);
    let of_points_or_samples =
        if far_apart.unwrap_or_else(|| columns.rows_are_far_apart()) { of_points } else { mapping };
    Ok(times::without_day(&mass::without_masses(&of_points_or_samples)))
}

const LEVEL_CRUISE: &str = "    // Level cruise; leave it away where the recording holds nothing else.\n    cruise: (minimum_pressure_altitude_ft: 25000, band_ft: 200, minimum_duration_s: 600, trim_s: 60),\n";

impl Columns {
    /// `column: …, unit: …` of a column, and whether the unit is a guess.
    fn recorded(&self, column: usize, kind: Kind) -> (String, bool) {
        let name = &self.names[column];
        let (unit, is_guess) = match name.unit(kind) {
            Some(unit) => (unit.to_owned(), false),
            None => self.unit_by_value(column, kind),
        };
        let mut fields = format!("column: {:?}, {unit}", name.sent);
        let is_sparse = self.rows.len() > 20
            && 2 * self.texts_of(column).filter(|text| text.is_empty()).count() > self.rows.len();
        if is_sparse {
            fields += ", hold_s: 120";
        }
        let is_vague = name.is_vague() || name.unknown_unit.is_some();
        (fields, is_guess || is_sparse || is_vague)
    }

    fn unit_by_value(&self, column: usize, kind: Kind) -> (String, bool) {
        let largest = self.largest(column).unwrap_or(0.0);
        let median = self.median(column).unwrap_or(0.0);
        let (unit, is_guess) = match kind {
            Kind::Altitude if largest > 17_000.0 => ("unit: \"ft\"", false),
            Kind::Altitude if largest < 650.0 => ("unit: \"FL\"", true),
            Kind::Altitude => ("unit: \"m\"", true),
            Kind::Temperature if median > 150.0 => ("unit: \"K\"", false),
            Kind::Temperature => ("unit: \"degC\"", true),
            Kind::Mach if largest > 100.0 => ("unit: \"-\", scale: 0.001", true),
            Kind::Mach if largest > 1.5 => ("unit: \"-\", scale: 0.01", true),
            Kind::Mach => ("unit: \"-\"", false),
            Kind::Speed if largest > 330.0 => ("unit: \"kt\"", true),
            // 180 m/s is 350 kt: more than an airliner's limit.
            Kind::CalibratedSpeed if largest > 180.0 => ("unit: \"kt\"", true),
            Kind::Speed | Kind::CalibratedSpeed => ("unit: \"m/s\"", true),
            Kind::Angle => ("unit: \"deg\"", false),
            Kind::Mass if largest < 700.0 => ("unit: \"t\"", true),
            Kind::Mass => ("unit: \"kg\"", true),
            Kind::Percent => ("unit: \"%MAC\"", false),
            Kind::Discrete => {
                let is_text = self.texts_of(column).any(|text| text == "ON" || text == "OFF");
                if is_text {
                    ("unit: \"-\", values: [(\"ON\", 1), (\"OFF\", 0)]", false)
                } else {
                    ("unit: \"-\"", true)
                }
            }
        };
        (unit.to_owned(), is_guess)
    }

    fn ordinary(&self, rule: &Rule, text: &mut String) -> Option<&'static str> {
        let column = self.find(rule)?;
        let (fields, is_guess) = self.recorded(column, rule.kind);
        line(text, rule.quantity, &format!("Recorded({fields})"), is_guess);
        Some(rule.quantity)
    }

    /// Columns of single engines, and the flow of all where there is none.
    fn engines(&self, text: &mut String) {
        for (quantity, names) in ENGINE_NAMES {
            let mut found = false;
            for engine in 1..=4_u8 {
                let is_of_engine = |&column: &usize| {
                    engine_of(&self.names[column], names) == Some(engine) && !self.is_empty(column)
                };
                let column = (0..self.names.len()).find(is_of_engine);
                let Some(column) = column else { break };
                found = true;
                let (unit, is_guess) = self.engine_unit(quantity, column);
                let source = format!("Recorded(column: {:?}, {unit})", self.names[column].sent);
                line(text, &format!("{quantity}({engine})"), &source, is_guess);
            }
            let total = self.named(names).or_else(|| self.named(&TOTAL_FLOW));
            if let (false, "WF", Some(column)) = (found, quantity, total) {
                let (unit, _) = self.engine_unit(quantity, column);
                let source = format!("Recorded(column: {:?}, {unit})", self.names[column].sent);
                // Whether it is of all engines no name tells: `cruisefit check` does.
                line(text, quantity, &source, true);
            }
        }
    }

    fn engine_unit(&self, quantity: &str, column: usize) -> (String, bool) {
        let name = &self.names[column];
        let (unit, is_guess) = match quantity {
            "WF" => match name.flow_unit() {
                Some(unit) => unit,
                None if self.largest(column).is_some_and(|flow| flow < 20.0) => {
                    ("unit: \"kg/s\"".to_owned(), true)
                }
                None => ("unit: \"kg/h\"".to_owned(), true),
            },
            "EGT" => match name.unit(Kind::Temperature) {
                Some(unit) => (unit.to_owned(), false),
                None => ("unit: \"degC\"".to_owned(), true),
            },
            _ => ("unit: \"%\"".to_owned(), false),
        };
        (unit, is_guess || name.unknown_unit.is_some())
    }

    /// What of MACH, SAT, VTAS and DRIFT has to be derived.
    fn air_data(&self, known: &[&str], text: &mut String) {
        let has = |quantity: &str| known.contains(&quantity);
        // Indicated airspeed has an error of position, which true airspeed is corrected for.
        let has_better =
            |column: &usize| self.names[*column].is(INDICATED) && has("VTAS") && has("SAT");
        let calibrated = self.find(&CALIBRATED).filter(|column| !has_better(column));
        let derived = !has("MACH") && calibrated.is_none();
        if let (false, Some(column)) = (has("MACH"), calibrated) {
            let (fields, _) = self.recorded(column, Kind::CalibratedSpeed);
            line(text, "MACH", &format!("FromCalibratedAirspeed({fields})"), true);
        } else if derived {
            line(text, "MACH", "FromTrueAirspeed", true);
        }
        if !has("SAT") {
            let source = if has("TAT") && !derived {
                "FromTotalTemperature(recovery_factor: 1.0)"
            } else if has("VTAS") && has("MACH") {
                "FromTrueAirspeed"
            } else {
                "Isa(deviation_k: 0.0)"
            };
            line(text, "SAT", source, true);
            if source.starts_with("Isa") {
                self.say_of_temperatures(has("TAT"), text);
            }
        }
        if !has("VTAS") && !derived {
            line(text, "VTAS", "FromMach", true);
        }
        if let (false, Some(track)) = (has("DRIFT"), self.find(&TRACK))
            && let Some(heading) = self.find(&HEADING)
            // The difference of two columns is in degrees.
            && [track, heading].iter().all(|column| self.names[*column].may_be_in_degrees())
        {
            let source = format!(
                "Difference(column: {:?}, minus: {:?}, unit: \"deg\")",
                self.names[track].sent, self.names[heading].sent
            );
            line(text, "DRIFT", &source, false);
        }
    }

    /// At a temperature of the standard atmosphere: a column that may hold the real one.
    fn say_of_temperatures(&self, has_total: bool, text: &mut String) {
        let is_candidate =
            |&column: &usize| self.names[column].may_be_air_temperature() && !self.is_empty(column);
        let candidate = (0..self.names.len()).find(is_candidate);
        let words = match (candidate, has_total) {
            (Some(column), _) => format!(
                "{:?} may hold it: Recorded(column: {0:?}, unit: \"degC\") (or \"degF\", \"K\")",
                self.names[column].sent
            ),
            (None, true) => {
                "TAT would give it with a Mach number, which no column holds".to_owned()
            }
            (None, false) => return,
        };
        let end = text.trim_end().len();
        text.truncate(end);
        let _ = writeln!(text, " no column is known for it; {words}");
    }

    fn texts(&self) -> String {
        let mut text = String::new();
        for (key, names, otherwise) in TEXTS {
            let source = self.named(names).map_or_else(
                || otherwise.to_owned(),
                |column| format!("Column({:?}),", self.names[column].sent),
            );
            let _ = writeln!(text, "    {key}: {source}");
        }
        text
    }

    /// The column of the first of these names that is there.
    fn named(&self, names: &[&str]) -> Option<usize> {
        names.iter().find_map(|wanted| self.names.iter().position(|name| name.is(wanted)))
    }

    /// Columns that no part of the mapping takes, with a value of each, and quantities that are missing: as comments.
    fn left_over(&self, quantities: &str, parts: &[&str]) -> String {
        let mut text = String::new();
        let missing: Vec<&str> = ["ALT", "GSPD", "WF"]
            .into_iter()
            .filter(|quantity| !quantities.contains(&format!("        \"{quantity}")))
            .collect();
        if !missing.is_empty() {
            let _ = writeln!(text, "    // No column found for: {}.", missing.join(", "));
        }
        let unknown: Vec<String> = (self.names.iter())
            .filter_map(|name| Some((&name.sent, name.unknown_unit.as_ref()?)))
            .filter(|(name, _)| parts[2..].iter().any(|part| part.contains(&format!("{name:?}"))))
            .map(|(name, unit)| format!("{name:?} ({})", one_line(unit)))
            .collect();
        if !unknown.is_empty() {
            let _ = writeln!(
                text,
                "    // Stated in units that are not known, and guessed: {}.",
                unknown.join(", ")
            );
        }
        let unused: Vec<String> = (0..self.names.len())
            .filter(|&column| {
                let name = format!("{:?}", self.names[column].sent);
                !parts.iter().any(|part| part.contains(&name))
            })
            .map(|column| {
                let value = self.texts_of(column).find(|text| !text.is_empty()).unwrap_or_default();
                format!("{:?} ({})", self.names[column].sent, one_line(value))
            })
            .collect();
        if !unused.is_empty() {
            let _ = writeln!(text, "    // Columns that are not used: {}.", unused.join(", "));
        }
        text
    }
}

/// Without what would end a comment.
fn one_line(value: &str) -> String {
    value.chars().filter(|letter| !letter.is_control()).take(24).collect()
}

fn line(text: &mut String, quantity: &str, source: &str, is_guess: bool) {
    let mark = if is_guess { "   // ?" } else { "" };
    let _ = writeln!(text, "        {quantity:?}: {source},{mark}");
}
