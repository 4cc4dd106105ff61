//! The rows of one flight, slow parameters filled, rows that lack a number left out.

use std::borrow::Cow;
use std::sync::Arc;

use flight::Timestamp;

use super::ahead::Ahead;
use super::line_numbers::LineNumbers;
use crate::mapping::numbers::{Numbers, retain};
use crate::mapping::pieces::Piece;
use crate::mapping::plan::{Fill, Plan};
use crate::refusal::Refusal;

/// The rows of one flight that have every number the report needs.
#[derive(Debug)]
pub(in crate::mapping) struct Recording {
    /// Aircraft, tail, flight.
    pub(in crate::mapping) texts: Arc<[String; 3]>,
    /// The text that holds its rows.
    pub(super) pieces: Vec<Piece>,
    /// Length of that text.
    pub(super) kept_bytes: usize,
    /// The instant from which `time_s` counts.
    pub(in crate::mapping) origin: Timestamp,
    /// Strictly increasing.
    pub(in crate::mapping) time_s: Vec<f64>,
    /// NaN where an optional number is not available.
    pub(in crate::mapping) numbers: Numbers,
    /// Physical line of each row.
    pub(in crate::mapping) lines: LineNumbers,
    /// Rows that lack a number that the report needs.
    pub(in crate::mapping) left_out: usize,
    pub(in crate::mapping) first_left_out: Option<usize>,
    /// The column that most of them lack.
    pub(in crate::mapping) lacking: Option<String>,
    /// Values that were held or interpolated, by column.
    pub(in crate::mapping) filled: Vec<(String, usize)>,
    /// Rows that could not be read, and the first refusal.
    pub(in crate::mapping) bad: usize,
    pub(in crate::mapping) first_bad: Option<Refusal>,
    /// Midnights passed, and the last time of day.
    pub(in crate::mapping) days: f64,
    pub(in crate::mapping) last_time_of_day_s: f64,
    /// Rows that are ahead of the last ones; these are undecided.
    pub(super) ahead: Option<Ahead>,
}

impl Recording {
    pub(super) fn new(texts: Arc<[String; 3]>, inputs: usize) -> Box<Self> {
        Box::new(Self {
            texts,
            pieces: Vec::new(),
            kept_bytes: 0,
            origin: Timestamp::UNIX_EPOCH,
            time_s: Vec::new(),
            numbers: Numbers::new(inputs),
            lines: LineNumbers::default(),
            left_out: 0,
            first_left_out: None,
            lacking: None,
            filled: Vec::new(),
            bad: 0,
            first_bad: None,
            days: 0.0,
            last_time_of_day_s: f64::NEG_INFINITY,
            ahead: None,
        })
    }

    pub(super) fn is_of(&self, texts: &[String; 3]) -> bool {
        *self.texts == *texts
    }

    /// Name of the flight.
    pub(in crate::mapping) fn flight(&self) -> &str {
        &self.texts[2]
    }

    /// The text of a line that holds one of its rows.
    pub(super) fn line(&self, line: usize) -> Cow<'_, str> {
        let later = self.pieces.partition_point(|piece| piece.first_line <= line);
        later.checked_sub(1).map_or(Cow::Borrowed(""), |piece| self.pieces[piece].line(line))
    }

    /// Fills slow parameters, then leaves out the rows that lack a number.
    pub(in crate::mapping) fn settle(&mut self, plan: &Plan) {
        let asked = |input: usize| {
            plan.inputs[input].is_required || !matches!(plan.inputs[input].fill, Fill::Not)
        };
        if !self.numbers.may_lack(asked) {
            return;
        }
        let columns = self.numbers.make_own();
        for (input, numbers) in plan.inputs.iter().zip(&mut *columns) {
            let filled = match input.fill {
                Fill::Not => 0,
                Fill::Hold(age_s) => hold(&self.time_s, numbers, age_s),
                Fill::Line(span_s) => interpolate(&self.time_s, numbers, span_s),
            };
            if filled > 0 {
                self.filled.push((input.name.clone(), filled));
            }
        }
        let required = || plan.inputs.iter().zip(&*columns).filter(|(input, _)| input.is_required);
        if !required().any(|(_, numbers)| numbers.iter().any(|number| number.is_nan())) {
            return;
        }
        let lacks = |row: usize| {
            plan.inputs
                .iter()
                .zip(&*columns)
                .position(|(input, numbers)| input.is_required && numbers[row].is_nan())
        };
        let missing: Vec<Option<usize>> = (0..self.time_s.len()).map(lacks).collect();
        let mut counts = vec![0_usize; plan.inputs.len()];
        for input in missing.iter().flatten() {
            counts[*input] += 1;
        }
        self.left_out += counts.iter().sum::<usize>();
        if let Some(row) = missing.iter().position(Option::is_some) {
            self.first_left_out = Some(self.lines.at(row));
            let most = (0..counts.len()).max_by_key(|input| (counts[*input], usize::MAX - input));
            self.lacking = most.map(|input| plan.inputs[input].name.clone());
        }
        let keep: Vec<bool> = missing.iter().map(Option::is_none).collect();
        self.numbers.retain(&keep);
        retain(&mut self.time_s, &keep);
        self.lines.retain(&keep);
    }
}

/// The last value, where it is no older than `age_s`; how many rows it stands in.
fn hold(time_s: &[f64], numbers: &mut [f64], age_s: f64) -> usize {
    let mut last: Option<(f64, f64)> = None;
    let mut filled = 0;
    for (time, number) in time_s.iter().zip(numbers) {
        if !number.is_nan() {
            last = Some((*time, *number));
        } else if let Some((since, value)) = last
            && time - since <= age_s
        {
            *number = value;
            filled += 1;
        }
    }
    filled
}

/// A straight line between values no farther apart than `span_s`; how many rows it stands in.
pub(in crate::mapping) fn interpolate(time_s: &[f64], numbers: &mut [f64], span_s: f64) -> usize {
    let mut before: Option<usize> = None;
    let mut filled = 0;
    for row in 0..numbers.len() {
        if numbers[row].is_nan() {
            continue;
        }
        if let Some(first) = before
            && time_s[row] - time_s[first] <= span_s
        {
            let slope = (numbers[row] - numbers[first]) / (time_s[row] - time_s[first]);
            let start = numbers[first];
            for between in first + 1..row {
                numbers[between] = start + slope * (time_s[between] - time_s[first]);
                filled += 1;
            }
        }
        before = Some(row);
    }
    filled
}
