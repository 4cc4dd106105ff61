//! Rows: the hot loop of the reader. Numbers are parsed in place and checked in the unit of the file; a message is
//! composed only after something is wrong.

use flight::column::Column;
use flight::{Finding, Severity};

use super::columns::Field;
use crate::line::{Line, Lines, Word, is_blank};
use crate::number;
use crate::refusal::{Found, Refusal, RefusalKind};

/// A fuel-used counter may fall by this much, pounds or kilograms.
const FUEL_USED_STEP_LB: f64 = 1.0;
const FUEL_USED_STEP_KG: f64 = 0.5;
/// Decimal differences in binary: a fall of exactly one step counts as one step.
const DIFFERENCE_ROUNDING: f64 = 1e-9;

/// Reads all rows into `values`, row by row, in the units of the file (NaN for "not available"), and returns the number
/// of rows.
pub(super) fn read(
    lines: &mut Lines<'_>,
    fields: &[Field],
    values: &mut Vec<f64>,
    findings: &mut Vec<Finding>,
) -> Result<usize, Refusal> {
    values.clear();
    let mut rows = 0;
    let mut series = Series::new(fields);
    for line in lines.by_ref() {
        let filled = values.len();
        values.resize(filled + fields.len(), 0.0);
        let row = &mut values[filled..];
        match read_row(line, fields, row) {
            Ok(true) => {}
            Ok(false) => {
                values.truncate(filled);
                continue;
            }
            Err(problem) => return Err(refusal(problem, line, fields)),
        }
        if !line.is_ended {
            findings.push(accept_last_row(line, fields)?);
        }
        series.check(row, line, fields)?;
        rows += 1;
    }
    Ok(rows)
}

/// What is wrong in a row, and the byte of the line at which it is.
#[derive(Clone, Copy, Debug)]
enum RowProblem {
    WrongLength,
    NotANumber { offset: usize, column: Column },
    OutOfRange { offset: usize, column: Column, field: usize, value: f64 },
}

/// The numbers of one line, one for each field; `false` for a line without content. After a problem `row` holds only part of
/// them and must not be used.
fn read_row(line: Line<'_>, fields: &[Field], row: &mut [f64]) -> Result<bool, RowProblem> {
    // In the text that starts at the line, a number ends at the line end at the latest: nothing needs to be compared
    // with the line's length until something other than a number in its range turns up.
    let onward = line.onward.as_bytes();
    let length = line.text.len();
    let (mut at, mut index) = (0, 0);
    loop {
        let (read, end) = read_short(onward, at, &fields[index..], &mut row[index..]);
        (at, index) = (skip_blanks(onward, end), index + read);
        let Some(field) = fields.get(index) else { break };
        if is_end_of_meaning(onward, at, length) {
            return if index == 0 { Ok(false) } else { Err(RowProblem::WrongLength) };
        }
        (row[index], at) = match number::short_at(onward, at) {
            Some((number, end))
                if field.holds(number) && is_end_of_word(line.text.as_bytes(), end) =>
            {
                (number, end)
            }
            _ => read_field(line.text.as_bytes(), at, index, field)?,
        };
        index += 1;
    }
    if is_end_of_meaning(onward, at, length) { Ok(true) } else { Err(RowProblem::WrongLength) }
}

/// Reads fields as long as they are short numbers inside their ranges with a blank or a line feed behind: how many, and where
/// they end. No number is inside the range of an ignored column: it is empty.
///
/// Not inlined: together with what handles all other fields the loop would not keep its values in registers.
#[inline(never)]
fn read_short(bytes: &[u8], mut at: usize, fields: &[Field], row: &mut [f64]) -> (usize, usize) {
    for (index, (field, value)) in fields.iter().zip(row).enumerate() {
        let start = skip_blanks(bytes, at);
        match number::within_words(bytes, start) {
            Some((number, end, after))
                if field.holds(number) && (is_blank(after) || after == b'\n') =>
            {
                *value = number;
                at = end;
            }
            _ => return (index, at),
        }
    }
    (fields.len(), at)
}

/// Anything that is not a short number inside its range; returns its value and its end.
fn read_field(
    bytes: &[u8],
    at: usize,
    index: usize,
    field: &Field,
) -> Result<(f64, usize), RowProblem> {
    let end = end_of_word(bytes, at);
    let word = &bytes[at..end];
    let column = match field.column {
        Some(column) if word != b"-" || !field.is_optional => column,
        _ => return Ok((f64::NAN, end)),
    };
    let number = number::whole(word).ok_or(RowProblem::NotANumber { offset: at, column })?;
    if field.holds(number) {
        Ok((number, end))
    } else {
        Err(RowProblem::OutOfRange { offset: at, column, field: index, value: number })
    }
}

#[inline]
fn skip_blanks(bytes: &[u8], mut at: usize) -> usize {
    while bytes.get(at).is_some_and(|byte| is_blank(*byte)) {
        at += 1;
    }
    at
}

/// The end of the line, which has this length, or a comment: a word begins at `at`.
fn is_end_of_meaning(bytes: &[u8], at: usize, length: usize) -> bool {
    at >= length || bytes[at] == b'#'
}

fn is_end_of_word(bytes: &[u8], at: usize) -> bool {
    bytes.get(at).is_none_or(|byte| is_blank(*byte))
}

fn end_of_word(bytes: &[u8], mut at: usize) -> usize {
    while !is_end_of_word(bytes, at) {
        at += 1;
    }
    at
}

/// Conditions between rows and on whole rows.
struct Series {
    previous_time_s: f64,
    previous_time: f64,
    fuel_used: Option<usize>,
    fuel_used_step: f64,
    largest_fuel_used: f64,
    anti_ice: Option<usize>,
}

impl Series {
    fn new(fields: &[Field]) -> Self {
        let place = |wanted| fields.iter().position(|field: &Field| field.column == Some(wanted));
        let fuel_used = place(Column::FuelUsed);
        let is_in_pounds = fuel_used.is_some_and(|index| fields[index].unit.name == "lb");
        Self {
            previous_time_s: f64::NEG_INFINITY,
            previous_time: f64::NEG_INFINITY,
            fuel_used,
            fuel_used_step: if is_in_pounds { FUEL_USED_STEP_LB } else { FUEL_USED_STEP_KG },
            largest_fuel_used: f64::NEG_INFINITY,
            anti_ice: place(Column::AntiIce),
        }
    }

    #[inline]
    fn check(&mut self, row: &[f64], line: Line<'_>, fields: &[Field]) -> Result<(), Refusal> {
        let time = row[0];
        let time_s = fields[0].convert(time);
        if time_s <= self.previous_time_s {
            let kind = RefusalKind::TimeNotIncreasing {
                previous: self.previous_time,
                unit: fields[0].unit.name,
            };
            return Err(refuse_field(line, 0, kind));
        }
        self.previous_time_s = time_s;
        self.previous_time = time;
        if let Some(index) = self.anti_ice {
            let value = row[index];
            // A difference of doubles is zero only for equal ones; NaN is "not available".
            if !(value == 0.0 || value - 1.0 == 0.0 || value.is_nan()) {
                let column = Column::AntiIce;
                let kind = RefusalKind::OutOfRange { column, limit: 1.0, unit: "-" };
                return Err(refuse_field(line, index, kind));
            }
        }
        let Some(index) = self.fuel_used else { return Ok(()) };
        let fuel_used = row[index];
        if fuel_used < self.largest_fuel_used - self.fuel_used_step - DIFFERENCE_ROUNDING {
            let kind = RefusalKind::FuelUsedFalls {
                largest: self.largest_fuel_used,
                tolerance: self.fuel_used_step,
                unit: fields[index].unit.name,
                gap_s: None,
            };
            return Err(refuse_field(line, index, kind));
        }
        self.largest_fuel_used = self.largest_fuel_used.max(fuel_used);
        Ok(())
    }
}

/// A last row without line end is complete unless its last word is not a whole number.
fn accept_last_row(line: Line<'_>, fields: &[Field]) -> Result<Finding, Refusal> {
    if ends_in_cut_off_word(line) {
        return Err(refuse_last_row(line, fields));
    }
    Ok(Finding {
        severity: Severity::Warning,
        code: "last-row-without-line-end",
        message: "the last row has no line end: its last number may be cut off".to_owned(),
        line: Some(line.number),
    })
}

fn ends_in_cut_off_word(line: Line<'_>) -> bool {
    let whole_line = Word { offset: 0, text: line.text };
    !line.text.ends_with([' ', '\t'])
        && whole_line.words().last().is_some_and(|word| number::is_cut_off(word.text.as_bytes()))
}

fn refuse_last_row(line: Line<'_>, fields: &[Field]) -> Refusal {
    let kind = RefusalKind::LastRowUnfinished { expected: fields.len() };
    match line.meaning().words().last() {
        Some(word) if ends_in_cut_off_word(line) => line.refuse_word(word, kind),
        _ => line.refuse_end(Found::Fields(line.meaning().words().count()), kind),
    }
}

fn refuse_field(line: Line<'_>, index: usize, kind: RefusalKind) -> Refusal {
    match line.meaning().words().nth(index) {
        Some(word) => line.refuse_word(word, kind),
        None => line.refuse_end(Found::EndOfLine, kind),
    }
}

/// A row of the wrong length is refused for its length, whatever its fields hold: they are shifted.
#[cold]
fn refusal(problem: RowProblem, line: Line<'_>, fields: &[Field]) -> Refusal {
    let expected = fields.len();
    let count = line.meaning().words().count();
    if let Some(surplus) = line.meaning().words().nth(expected) {
        let kind = RefusalKind::TooManyFields { expected };
        return line.refuse(surplus.offset, Found::Fields(count), kind);
    }
    if count < expected && line.is_ended {
        return line.refuse_end(Found::Fields(count), RefusalKind::TooFewFields { expected });
    }
    match problem {
        RowProblem::NotANumber { offset, column } if !is_cut_off_at(line, offset) => {
            refuse_at(line, offset, RefusalKind::NotANumber { column })
        }
        RowProblem::OutOfRange { offset, column, field, value } => {
            let field = &fields[field];
            let limit = if value < field.low { field.minimum } else { field.maximum };
            let limit = without_conversion_rounding(limit);
            let unit = field.unit.name;
            refuse_at(line, offset, RefusalKind::OutOfRange { column, limit, unit })
        }
        RowProblem::NotANumber { .. } | RowProblem::WrongLength => refuse_last_row(line, fields),
    }
}

/// Whether the word at `offset` is where the text was cut off.
fn is_cut_off_at(line: Line<'_>, offset: usize) -> bool {
    !line.is_ended
        && end_of_word(line.text.as_bytes(), offset) == line.text.len()
        && ends_in_cut_off_word(line)
}

fn refuse_at(line: Line<'_>, offset: usize, kind: RefusalKind) -> Refusal {
    let end = end_of_word(line.text.as_bytes(), offset);
    line.refuse_word(Word { offset, text: &line.text[offset..end] }, kind)
}

/// A limit as a person would write it: -100 and not -100.00000000000003.
fn without_conversion_rounding(limit: f64) -> f64 {
    format!("{limit:.11e}").parse().unwrap_or(limit)
}
