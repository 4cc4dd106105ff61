//! The options of `monitor`.

use std::path::PathBuf;

use clap::Args;

use super::JsonFlag;

/// `monitor`
#[derive(Debug, Args)]
pub(crate) struct MonitorArgs {
    /// Folder that `adapt` wrote
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// Events to measure: date,tail,kind,note (wash, `engine_change`, …)
    #[arg(long, value_name = "EVENTS.csv")]
    pub(crate) events: Option<PathBuf>,
    /// Only flights that began on or after this date (2026-03-02, or an instant with its offset): what is shown of a tail is then
    /// of these flights, at the mean conditions of all of its flights, and a night takes no longer for the years before them
    #[arg(long, value_name = "DATE", value_parser = date)]
    pub(crate) since: Option<flight::Timestamp>,
    /// Print a row for each month instead of one for each tail
    #[arg(long)]
    pub(crate) month: bool,
    /// Folder to write to: monitor.html, monitor.json, and tails, months, flights, changes, events, fleet, alerts as .csv
    #[arg(long, short, value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
    /// Exit with status 3 where a rule fires; may be given several times. deviation=PCT: present level; trend=PCT: per
    /// year; change=PCT or change=PCT/DAYSd: a step (in the last DAYS days). Either sign, and only where the 95 %
    /// interval does not hold 0
    #[arg(long, value_name = "RULE")]
    pub(crate) alert: Vec<monitor::AlertRule>,
    /// Newest diagnosis.json, or its folder: alerts name the causes that stand out there
    #[arg(long, value_name = "DIAGNOSIS")]
    pub(crate) diagnosis: Option<PathBuf>,
    /// kg of CO₂ from a kg of fuel, to print CO₂ a year
    #[arg(long, value_name = "KG", allow_negative_numbers = true)]
    pub(crate) co2_factor: Option<f64>,
    /// Price of a kg of fuel in any currency, to print the price a year
    #[arg(long, value_name = "PRICE", allow_negative_numbers = true)]
    pub(crate) fuel_price: Option<f64>,
    /// Flights a year [default: as many as were recorded]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) flights_per_year: Option<f64>,
    /// Basic factor of the flight management system, %: adds the PERF FACTOR, basic plus that of the present level
    #[arg(long, value_name = "PCT", allow_negative_numbers = true)]
    pub(crate) basic_perf_factor: Option<f64>,
    /// Leave out the deviation by the model before it learnt each flight, for which a model whose folder an older program wrote
    /// is rebuilt flight by flight
    #[arg(long)]
    pub(crate) quick: bool,
}

fn date(text: &str) -> Result<flight::Timestamp, String> {
    pipeline::monitoring::instant(text).ok_or_else(|| {
        "expected a date like 2026-03-02, or an instant like 2026-03-02T10:00:00Z".to_owned()
    })
}
