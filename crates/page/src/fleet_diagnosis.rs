//! `fleet.html`: what all tails of a type share, which tails and sensors differ, how sure that is and what would tell more.

use std::collections::BTreeMap;

use maud::{Markup, html};
use pipeline::diagnosis_document::{MagnitudeRecord, TailDiagnosis};
use pipeline::diagnosis_figures::DiagnosisFigures;
use pipeline::fleet_diagnosis::{FleetFindingRecord, FleetRecord, FleetTailRecord};
use pipeline::summary::{ReportsSummary, counted};

use crate::chart::dates;
use crate::frame::framed;

mod chart;
mod tables;
mod words;

/// What a fleet's page is made of.
#[derive(Clone, Copy, Debug)]
pub struct FleetRun<'a> {
    /// What became of the reports.
    pub reports: &'a ReportsSummary,
    /// The fleets, one for each type.
    pub fleets: &'a [FleetRecord],
    /// The diagnosis of each tail alone: what would tell effects apart. In the order of `diagnosis.html`, which is linked to.
    pub diagnoses: &'a [TailDiagnosis],
    /// What the charts of those are drawn from, in the same order: model and period.
    pub figures: &'a [DiagnosisFigures],
    /// Options of the run in words.
    pub options: &'a [String],
}

/// The page of all tails of each type compared with each other.
#[must_use]
pub fn fleet_diagnosis(run: &FleetRun<'_>) -> String {
    let body = html! {
        p.run { (head(run)) }
        p.note {
            "Sizes are shrunk: what one tail alone leaves open is taken from its type. ± is half a 95 % interval; 0 without one is \
             believed where tails do not differ beyond what was found. A finding is what acts with so high a probability that of \
             all findings at most 5 % are expected to be false."
        }
        @for (number, record) in run.fleets.iter().enumerate() {
            (section(run, &Fleet::new(record, number)))
        }
    };
    framed("Fleets compared", &body)
}

/// Version, period, counts and options, in a line.
fn head(run: &FleetRun<'_>) -> String {
    let mut told = vec![format!("cruisefit {}", env!("CARGO_PKG_VERSION"))];
    let dates = || run.figures.iter().flat_map(|tail| &tail.segments).map(|one| one.date_s);
    if let (Some(first), Some(last)) =
        (dates().min_by(f64::total_cmp), dates().max_by(f64::total_cmp))
    {
        told.push(format!("flown {}", dates::period(first, last)));
    }
    let types: Vec<String> = run
        .fleets
        .iter()
        .map(|fleet| format!("{} ({})", counted(fleet.tails.len(), "tail"), fleet.aircraft_type))
        .collect();
    told.extend((!types.is_empty()).then(|| types.join(", ")));
    told.push(format!(
        "{} read, {} refused",
        counted(run.reports.read, "report"),
        run.reports.refused.len()
    ));
    told.extend(run.options.iter().cloned());
    format!("{}.", told.join("; "))
}

fn section(run: &FleetRun<'_>, fleet: &Fleet<'_>) -> Markup {
    let record = fleet.record;
    let links = links(run);
    html! {
        section id=(format!("fleet-{}", fleet.number)) {
            h2 { (record.aircraft_type) }
            p.run {
                (counted(record.tails.len(), "tail")) ", "
                (counted(record.tails.iter().map(|tail| tail.flights).sum::<usize>(), "flight")) ", "
                (counted(record.tails.iter().map(|tail| tail.segments).sum::<usize>(), "segment")) "; "
                @if record.model_of == "type" { "one model for all" } @else { "each tail against its own model" }
                @if let Some(model) = model(run, fleet) { ": " (model) }
                "."
            }
            (words::card(fleet))
            (words::apart(fleet, run.diagnoses))
            (chart::panels(fleet))
            (tables::tails(fleet, &links))
            (tables::more(fleet, &links))
        }
    }
}

/// The model of the type, where all tails have one.
fn model<'a>(run: &FleetRun<'a>, fleet: &Fleet<'_>) -> Option<&'a str> {
    let models = run.diagnoses.iter().zip(run.figures);
    let mut models = models
        .filter(|(one, _)| fleet.record.tails.iter().any(|tail| tail.tail == one.tail))
        .map(|(_, figures)| figures.model.as_str());
    let first = models.next().filter(|model| !model.is_empty())?;
    models.all(|model| model == first).then_some(first)
}

/// Where `diagnosis.html` has the tails.
fn links<'a>(run: &FleetRun<'a>) -> BTreeMap<&'a str, String> {
    let link = |(number, one): (usize, &'a TailDiagnosis)| {
        (one.tail.as_str(), format!("diagnosis.html#{}", crate::diagnosis::anchor(number)))
    };
    run.diagnoses.iter().enumerate().map(link).collect()
}

/// A fleet with its effects and tails in the order of the page.
struct Fleet<'a> {
    number: usize,
    record: &'a FleetRecord,
    /// Effects that were found anywhere, those found most often first.
    effects: Vec<Found<'a>>,
    /// Its tails, those that differ most first.
    tails: Vec<&'a FleetTailRecord>,
}

/// An effect that was found in the type, on a tail, or both.
struct Found<'a> {
    /// Its name in files.
    id: &'a str,
    /// Its place among the effects of a tail.
    place: usize,
    /// Its size in the type.
    of_type: &'a MagnitudeRecord,
    /// That of the type first.
    findings: Vec<&'a FleetFindingRecord>,
    /// The largest difference that was found on a tail; none where only the type has it.
    largest: Option<f64>,
}

impl<'a> Fleet<'a> {
    fn new(record: &'a FleetRecord, number: usize) -> Self {
        let names = record.tails.first().map_or(&[][..], |tail| &tail.effects);
        let found = names.iter().enumerate().filter_map(|(place, one)| {
            let findings: Vec<_> =
                record.findings.iter().filter(|found| found.effect == one.effect).collect();
            let on_tails = findings.iter().filter(|found| found.tail.is_some());
            Some(Found {
                id: &one.effect,
                place,
                of_type: &record.effects.iter().find(|of| of.effect == one.effect)?.magnitude,
                largest: on_tails.map(|found| found.magnitude.value.abs()).reduce(f64::max),
                findings,
            })
        });
        let mut effects: Vec<Found<'a>> = found.collect();
        // Stable sorts: what is equal stays in the library's order, and tails in that of their names.
        effects.sort_by_key(|found| core::cmp::Reverse(found.findings.len()));
        let mut tails: Vec<&FleetTailRecord> = record.tails.iter().collect();
        let key = |tail: &FleetTailRecord| {
            let found = effects.iter().filter(|effect| effect.finding(&tail.tail).is_some());
            let is_found = found.count() > 0;
            (is_found, effects.iter().map(|effect| effect.share(tail).abs()).fold(0.0, f64::max))
        };
        tails.sort_by(|one, other| {
            let (one, other) = (key(one), key(other));
            other.0.cmp(&one.0).then(other.1.total_cmp(&one.1))
        });
        Self { number, record, effects, tails }
    }
}

impl Found<'_> {
    fn size<'t>(&self, tail: &'t FleetTailRecord) -> Option<&'t MagnitudeRecord> {
        tail.effects.get(self.place).map(|effect| &effect.magnitude)
    }

    /// What was found of it on this tail.
    fn finding(&self, tail: &str) -> Option<&FleetFindingRecord> {
        self.findings.iter().find(|found| found.tail.as_deref() == Some(tail)).copied()
    }

    /// By how much a tail differs from its type, of the largest difference that was found; 0 where none was.
    fn share(&self, tail: &FleetTailRecord) -> f64 {
        let (Some(largest), Some(size)) = (self.largest, self.size(tail)) else { return 0.0 };
        if largest > 0.0 { (size.value - self.of_type.value) / largest } else { 0.0 }
    }
}

/// Whose a finding on a tail is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Whose {
    Aircraft,
    Sensor,
    /// Not distinguished.
    Open,
}

impl Whose {
    fn of(found: &FleetFindingRecord) -> Self {
        match (found.levels.len(), found.level.as_str()) {
            (2.., _) => Self::Open,
            (_, "sensor") => Self::Sensor,
            _ => Self::Aircraft,
        }
    }

    const fn words(self) -> &'static str {
        match self {
            Self::Aircraft => "the aircraft",
            Self::Sensor => "a sensor",
            Self::Open => "the aircraft or a sensor",
        }
    }
}

#[cfg(test)]
mod tests;
