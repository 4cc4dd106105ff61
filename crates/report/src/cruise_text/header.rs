//! Header lines: key and value, until the line whose first word is `TIME`.

use flight::{
    Assumption, Finding, FlightIdentity, MissingColumn, ReportHeader, Severity, Timestamp,
};
use units::Mass;

use crate::line::{Line, Lines, Word};
use crate::number;
use crate::refusal::{Found, Refusal, RefusalKind};

/// Keys that the format defines, the required ones first.
pub(crate) const KEYS: [&str; 9] =
    ["AIRCRAFT", "TAIL", "FLIGHT", "START", "ZFW", "FOB", "LHV", "MISSING", "ASSUMED"];
const NAMES_KEY: &str = "TIME";

/// Largest mass, kg: the heaviest aircraft that flew weighed 640 t. A sum of two such masses is finite too.
const MAXIMUM_MASS_KG: f64 = 1e6;

/// Largest deviation from the ISA that may be assumed, K. Beyond it no temperature of the format's range is left.
const MAXIMUM_ISA_DEVIATION_K: f64 = 120.0;

const TEXT_FORM: &str = "text";
const START_FORM: &str = "an instant like 2018-05-20T14:14:21Z (RFC 3339, with Z or an offset)";
const MASS_FORM: &str = "a number and lb or kg, at most 1000000 kg";
const LHV_FORM: &str = "a number above zero and MJ/kg";
const MISSING_FORM: &str = "one or more of SAT N2 ROLL DRIFT, each once";
const ASSUMED_FORM: &str = "assumptions like SAT=ISA+3, each once";
const ASSUMED_SAT_FORM: &str = "SAT=ISA, SAT=ISA+3 or SAT=ISA-2.5 (at most 120 K from the ISA)";

/// Reads the header and returns it with the line of column names that ends it.
pub(super) fn read<'a>(
    lines: &mut Lines<'a>,
    findings: &mut Vec<Finding>,
) -> Result<(ReportHeader, Line<'a>), Refusal> {
    let mut values = Values::default();
    let mut first_lines: [Option<usize>; KEYS.len()] = [None; KEYS.len()];
    loop {
        let Some(line) = lines.next_of_meaning() else {
            return Err(lines.refuse_end(Found::EndOfText, RefusalKind::ColumnNamesMissing));
        };
        let (key, value) = line.meaning().split_first();
        if key.text == NAMES_KEY {
            return Ok((values.into_header(line)?, line));
        }
        if let Some(index) = KEYS.iter().position(|known| *known == key.text) {
            if let Some(first_line) = first_lines[index].replace(line.number) {
                let kind = RefusalKind::HeaderKeyDoubled { key: KEYS[index], first_line };
                return Err(line.refuse_word(key, kind));
            }
            values.set(&Entry { key: KEYS[index], line, value })?;
        } else {
            findings.extend(misspelt_key(key, line));
            values.notes.push((key.text.to_owned(), value.text.to_owned()));
        }
    }
}

fn misspelt_key(key: Word<'_>, line: Line<'_>) -> Option<Finding> {
    let meant = KEYS.iter().find(|known| known.eq_ignore_ascii_case(key.text))?;
    Some(Finding {
        severity: Severity::Warning,
        code: "header-key-kept-as-note",
        message: format!("{} is kept as a note: the key of the format is {meant}", key.text),
        line: Some(line.number),
    })
}

/// The content of the header lines so far.
#[derive(Default)]
struct Values {
    aircraft_type: Option<String>,
    tail: Option<String>,
    flight: Option<String>,
    start: Option<Timestamp>,
    zero_fuel_mass: Option<Mass>,
    fuel_on_board: Option<Mass>,
    lower_heating_value_mj_kg: Option<f64>,
    missing: Vec<MissingColumn>,
    assumed: Vec<Assumption>,
    notes: Vec<(String, String)>,
}

impl Values {
    fn set(&mut self, entry: &Entry<'_>) -> Result<(), Refusal> {
        match entry.key {
            "AIRCRAFT" => self.aircraft_type = Some(free_text(entry)?),
            "TAIL" => self.tail = Some(free_text(entry)?),
            "FLIGHT" => self.flight = Some(free_text(entry)?),
            "START" => self.start = Some(instant(entry)?),
            "ZFW" => self.zero_fuel_mass = Some(mass(entry)?),
            "FOB" => self.fuel_on_board = Some(mass(entry)?),
            "LHV" => self.lower_heating_value_mj_kg = Some(lower_heating_value(entry)?),
            "MISSING" => self.missing = missing_columns(entry)?,
            _ => self.assumed = assumptions(entry)?,
        }
        Ok(())
    }

    fn into_header(self, names: Line<'_>) -> Result<ReportHeader, Refusal> {
        let absent = |key| {
            let time = names.meaning().split_first().0;
            names.refuse_word(time, RefusalKind::HeaderKeyMissing { key })
        };
        Ok(ReportHeader {
            aircraft_type: self.aircraft_type.ok_or_else(|| absent("AIRCRAFT"))?,
            identity: FlightIdentity {
                tail: self.tail.ok_or_else(|| absent("TAIL"))?,
                flight: self.flight.ok_or_else(|| absent("FLIGHT"))?,
                start: self.start.ok_or_else(|| absent("START"))?,
            },
            zero_fuel_mass: self.zero_fuel_mass.ok_or_else(|| absent("ZFW"))?,
            fuel_on_board: self.fuel_on_board.ok_or_else(|| absent("FOB"))?,
            lower_heating_value_mj_kg: self.lower_heating_value_mj_kg,
            missing: self.missing,
            assumed: self.assumed,
            notes: self.notes,
        })
    }
}

/// A header line whose key the format defines.
#[derive(Clone, Copy, Debug)]
struct Entry<'a> {
    key: &'static str,
    line: Line<'a>,
    value: Word<'a>,
}

impl<'a> Entry<'a> {
    fn malformed(&self, form: &'static str) -> Refusal {
        self.malformed_at(self.value, form)
    }

    fn malformed_at(&self, word: Word<'a>, form: &'static str) -> Refusal {
        let kind = RefusalKind::HeaderValueMalformed { key: self.key, form };
        if word.text.is_empty() {
            self.line.refuse_end(Found::EndOfLine, kind)
        } else {
            self.line.refuse_word(word, kind)
        }
    }

    /// The words of a list; a comma separates as well as a blank.
    fn items(&self) -> impl Iterator<Item = Word<'a>> {
        self.value.words().flat_map(|word| {
            word.text.split(',').filter(|text| !text.is_empty()).map(move |text| Word {
                offset: word.offset + (text.as_ptr() as usize - word.text.as_ptr() as usize),
                text,
            })
        })
    }
}

fn free_text(entry: &Entry<'_>) -> Result<String, Refusal> {
    if entry.value.text.is_empty() {
        return Err(entry.malformed(TEXT_FORM));
    }
    Ok(entry.value.text.to_owned())
}

fn instant(entry: &Entry<'_>) -> Result<Timestamp, Refusal> {
    parse_instant(entry.value.text).ok_or_else(|| entry.malformed(START_FORM))
}

/// RFC 3339 and nothing else: jiff also reads forms without punctuation, with a blank, with seconds of the offset and
/// with a zone in brackets.
pub(crate) fn parse_instant(text: &str) -> Option<Timestamp> {
    const DATE_TIME: &[u8] = b"0000-00-00T00:00:00";
    let bytes = text.as_bytes();
    let shape = |pattern: &[u8], bytes: &[u8]| {
        pattern.len() == bytes.len()
            && pattern.iter().zip(bytes).all(|(expected, byte)| match expected {
                b'0' => byte.is_ascii_digit(),
                _ => expected == byte,
            })
    };
    let (date_time, rest) = bytes.split_at_checked(DATE_TIME.len())?;
    if !shape(DATE_TIME, &date_time.to_ascii_uppercase()) {
        return None;
    }
    let rest = match rest.strip_prefix(b".") {
        None => rest,
        Some(fraction) => {
            let digits = fraction.iter().take_while(|byte| byte.is_ascii_digit()).count();
            if digits == 0 {
                return None;
            }
            &fraction[digits..]
        }
    };
    let is_offset = matches!(rest, b"Z" | b"z") || shape(b"+00:00", rest) || shape(b"-00:00", rest);
    if is_offset { text.parse().ok() } else { None }
}

/// A number and its unit, and nothing more.
fn number_and_unit<'a>(entry: &Entry<'a>) -> Option<(f64, Word<'a>)> {
    let mut words = entry.value.words();
    let value = number::whole(words.next()?.text.as_bytes())?;
    let unit = words.next()?;
    if words.next().is_some() { None } else { Some((value, unit)) }
}

fn mass(entry: &Entry<'_>) -> Result<Mass, Refusal> {
    let (value, unit) = number_and_unit(entry).ok_or_else(|| entry.malformed(MASS_FORM))?;
    let mass = match unit.text {
        "lb" => Mass::pounds(value),
        "kg" => Mass::kilograms(value),
        _ => return Err(entry.malformed_at(unit, MASS_FORM)),
    };
    if mass.to_kilograms() > MAXIMUM_MASS_KG {
        return Err(entry.malformed(MASS_FORM));
    }
    if mass.to_kilograms() <= 0.0 {
        return Err(entry
            .line
            .refuse_word(entry.value, RefusalKind::MassNotPositive { mass: entry.key }));
    }
    Ok(mass)
}

fn lower_heating_value(entry: &Entry<'_>) -> Result<f64, Refusal> {
    match number_and_unit(entry) {
        Some((value, unit)) if unit.text == "MJ/kg" && value > 0.0 => Ok(value),
        _ => Err(entry.malformed(LHV_FORM)),
    }
}

fn missing_columns(entry: &Entry<'_>) -> Result<Vec<MissingColumn>, Refusal> {
    let mut missing = Vec::new();
    for item in entry.items() {
        match MissingColumn::ALL.into_iter().find(|column| column.name() == item.text) {
            Some(column) if !missing.contains(&column) => missing.push(column),
            _ => return Err(entry.malformed_at(item, MISSING_FORM)),
        }
    }
    if missing.is_empty() {
        return Err(entry.malformed(MISSING_FORM));
    }
    missing.sort_unstable();
    Ok(missing)
}

fn assumptions(entry: &Entry<'_>) -> Result<Vec<Assumption>, Refusal> {
    let mut assumed: Vec<Assumption> = Vec::new();
    for item in entry.items() {
        let (key, value) = match item.text.split_once('=') {
            Some((key, value)) if !key.is_empty() && !value.is_empty() => (key, value),
            _ => return Err(entry.malformed_at(item, ASSUMED_FORM)),
        };
        if assumed.iter().any(|other| key_of(other) == key) {
            return Err(entry.malformed_at(item, ASSUMED_FORM));
        }
        assumed.push(if key == MissingColumn::StaticAirTemperature.name() {
            let isa_deviation_k =
                isa_deviation_k(value).ok_or_else(|| entry.malformed_at(item, ASSUMED_SAT_FORM))?;
            Assumption::StaticAirTemperatureIsa { isa_deviation_k }
        } else {
            Assumption::Other { key: key.to_owned(), value: value.to_owned() }
        });
    }
    if assumed.is_empty() {
        return Err(entry.malformed(ASSUMED_FORM));
    }
    Ok(assumed)
}

fn key_of(assumption: &Assumption) -> &str {
    match assumption {
        Assumption::StaticAirTemperatureIsa { .. } => MissingColumn::StaticAirTemperature.name(),
        Assumption::Other { key, .. } => key,
    }
}

/// `ISA`, `ISA+3`, `ISA-2.5`: deviation in K.
pub(crate) fn isa_deviation_k(text: &str) -> Option<f64> {
    let deviation = text.strip_prefix("ISA")?;
    if deviation.is_empty() {
        return Some(0.0);
    }
    if !deviation.starts_with(['+', '-']) {
        return None;
    }
    number::whole(deviation.as_bytes()).filter(|value| value.abs() <= MAXIMUM_ISA_DEVIATION_K)
}
