//! `cruisefit evaluate`: the fuel-flow error of a model over reports; nothing is adapted.

use std::sync::Arc;

use flight::{FlightIdentity, Segment};

use crate::args::EvaluateArgs;
use crate::columns;
use crate::commands::{Outcome, check_refused, prepare};
use crate::failure::{Failure, RefusedReport};
use crate::files::outputs::check_not_read;
use crate::models::read_models;
use crate::progress::Progress;
use crate::reading::FlightRead;
use pipeline::evaluation::{BookEffects, TailResult, evaluate_book};
use pipeline::fuel_factor::{self, FuelFactor};
use pipeline::model_file::ModelFile;
use pipeline::residuals::{self, FlightResiduals, GivenFlight};
use pipeline::segments_table::Evaluated;
use pipeline::summary::{RefusedSummary, ReportsSummary, SCHEMA, Summary};
use pipeline::whole_model::Predicts;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &EvaluateArgs, progress: Progress) -> Result<Outcome, Failure> {
    for output in [&arguments.output, &arguments.fuel_factors] {
        for read in arguments.reports.reports.iter().chain(&arguments.models.models) {
            check_not_read(output.as_deref(), read)?;
        }
    }
    let Evaluation { summary, refused, tails } = evaluate(arguments, progress)?;
    let factors = arguments.fuel_factors.as_deref().map(|path| {
        let all: Vec<FuelFactor> = tails.iter().flat_map(EvaluatedTail::fuel_factors).collect();
        (fuel_factor::columns(&all), path)
    });
    if let Some((factors, path)) = &factors {
        columns::check(factors, path)?;
    }
    if let Some(path) = &arguments.output {
        let segments: Vec<Vec<Segment>> = tails.iter().map(EvaluatedTail::segments).collect();
        let mut flights = Vec::new();
        for (tail, segments) in tails.iter().zip(&segments) {
            flights.extend(tail.residuals(segments)?);
        }
        let rows: Vec<(&[Segment], &FlightResiduals)> =
            flights.iter().map(|(segments, residuals)| (*segments, residuals)).collect();
        columns::write(&residuals::columns(&rows), Some(path))?;
    }
    if let Some((factors, path)) = &factors {
        columns::write(factors, Some(path))?;
    }
    Ok(Outcome { refused, ..Outcome::with_json(summary.to_text(), summary.to_json()) })
}

/// What an evaluation came to.
#[derive(Debug)]
pub(crate) struct Evaluation {
    /// The figures.
    pub(crate) summary: Summary,
    refused: Vec<RefusedReport>,
    tails: Vec<EvaluatedTail>,
}

/// The error of the models over the reports, and what was refused.
///
/// # Errors
/// A reason for which there is nothing to evaluate.
pub(crate) fn evaluate(
    arguments: &EvaluateArgs,
    progress: Progress,
) -> Result<Evaluation, Failure> {
    let models = read_models(&arguments.models.models)?;
    let mut reading = prepare(&arguments.reports, progress)?;
    let files = reading.files();
    let by_tail = models.with_flights(&mut reading);
    let mut refused = reading.refused;
    refused.sort_by(|one, other| one.path.cmp(&other.path));
    check_refused(&refused, files, arguments.reports.strict, by_tail.is_empty())?;
    let predicts = Predicts::table_only(arguments.table_only);
    let read = by_tail.values().map(|(_, flights)| flights.len()).sum();
    let tails: Vec<EvaluatedTail> = by_tail
        .into_iter()
        .map(|(tail, (model, flights))| EvaluatedTail::new(tail, model.clone(), flights, predicts))
        .collect();
    let summary = Summary {
        schema: SCHEMA,
        reports: ReportsSummary {
            read,
            already_known: tails.iter().map(EvaluatedTail::learnt_before).sum(),
            copies: reading.copies,
            other_files: reading.other_files,
            refused: refused.iter().map(RefusedSummary::from).collect(),
        },
        tails: tails.iter().map(|tail| tail.result.summary.clone()).collect(),
    };
    Ok(Evaluation { summary, refused, tails })
}

/// A tail with what its model says of it.
#[derive(Debug)]
struct EvaluatedTail {
    result: TailResult,
    /// Identity, content and number of segments of each flight, in the order of the result's rows.
    flights: Vec<(Arc<FlightIdentity>, String, usize)>,
    predicts: Predicts,
}

impl EvaluatedTail {
    fn new(
        tail: String,
        model: ModelFile,
        mut flights: Vec<FlightRead>,
        predicts: Predicts,
    ) -> Self {
        flights.sort_by(FlightRead::order);
        let given = flights
            .iter()
            .map(|flight| {
                let reduced = &flight.reduced;
                (Arc::clone(&reduced.identity), flight.content.clone(), reduced.segments.len())
            })
            .collect();
        let result = TailResult::of_flights(tail, model, flights, predicts);
        Self { result, flights: given, predicts }
    }

    /// How many of the flights taught the model.
    const fn learnt_before(&self) -> usize {
        self.result.summary.flights - self.result.summary.flights_new
    }

    /// All segments, flight by flight.
    fn segments(&self) -> Vec<Segment> {
        self.result.rows.iter().map(|row| row.segment.clone()).collect()
    }

    /// The residuals of each flight, by the model before it learnt it where that can be had.
    fn residuals<'s>(
        &self,
        all: &'s [Segment],
    ) -> Result<Vec<(&'s [Segment], FlightResiduals)>, Failure> {
        let mut given = Vec::new();
        let mut of_flight: Vec<&'s [Segment]> = Vec::new();
        let mut as_given: Vec<Vec<Option<Evaluated>>> = Vec::new();
        let mut first = 0;
        for (identity, content, count) in &self.flights {
            let segments = &all[first..first + count];
            let rows = &self.result.rows[first..first + count];
            given.push(GivenFlight { identity, content, segments });
            of_flight.push(segments);
            as_given.push(rows.iter().map(|row| row.evaluated).collect());
            first += count;
        }
        let found = residuals::before_learning(&self.result.model, &given, as_given, self.predicts)
            .map_err(|error| Failure::BadArgument {
                argument: "--model",
                reason: error.to_string(),
            })?;
        Ok(of_flight.into_iter().zip(found).collect())
    }

    /// The fuel factors of the tail against its book: the drag of the guide's own rows, without effects.
    fn fuel_factors(&self) -> Vec<FuelFactor> {
        let segments = self.segments();
        let evaluated = evaluate_book(&self.result.model, BookEffects::None, &segments);
        fuel_factor::of_tail(&self.result.tail, &segments, &evaluated)
    }
}
