//! `deviations/TAIL.csv`: what each flight of a tail shows, so that `monitor` need not read all segments again every night.

use core::num::NonZeroU32;

use flight::{MAXIMUM_ENGINES, Timestamp};
use monitor::FlightDeviation;

use super::flights::{MeanConditions, MonitoredFlight};
use crate::columns::Columns;
use crate::csv_cell;
use crate::learning::Forecast;

/// Columns before those of the engines.
const COLUMNS: usize = 23;
/// The first column of the deviation from the book, the fifth of all.
const BOOK: &str = "book_percent";
/// Columns of a deviation: mean, segments, sum of squared differences.
const OF_A_DEVIATION: usize = 3;

/// The table.
#[must_use]
pub fn flights_to_csv(flights: &[MonitoredFlight]) -> Vec<u8> {
    let mut columns = Columns::default();
    columns.text("flight", flights.iter().map(|flight| &flight.flight));
    columns.text("start", flights.iter().map(|flight| flight.start.to_string()));
    columns.count("segments", flights.iter().map(|flight| flight.segments as u64));
    columns.count("outside_table", flights.iter().map(|flight| flight.outside_table as u64));
    deviation(&mut columns, "book", flights, |flight| flight.book);
    deviation(&mut columns, "learnt", flights, |flight| flight.learnt);
    deviation(&mut columns, "before_learning", flights, |flight| {
        flight.before_learning.map(|forecast| forecast.deviation)
    });
    columns.number(
        "before_learning_error_percent",
        flights.iter().map(|flight| flight.before_learning.map(|of| of.mean_error_percent)),
    );
    let mut number = |name: &str, of: fn(&MonitoredFlight) -> f64| {
        columns.number(name, flights.iter().map(|flight| Some(of(flight))));
    };
    number("learnt_over_book_percent", |flight| flight.learnt_over_book_percent);
    number("cruise_fuel_kg", |flight| flight.cruise_fuel_kg);
    number("pressure_altitude_m", |flight| flight.conditions.pressure_altitude_m);
    number("mach", |flight| flight.conditions.mach);
    number("static_air_temperature_k", |flight| flight.conditions.static_air_temperature_k);
    number("mass_kg", |flight| flight.conditions.mass_kg);
    number("true_airspeed_m_s", |flight| flight.conditions.true_airspeed_m_s);
    number("initial_fuel_flow_kg_s", |flight| flight.conditions.initial_fuel_flow_kg_s);
    columns.count("segments_predicted", flights.iter().map(|f| f.conditions.segments as u64));
    let engines = flights.iter().map(|flight| flight.engines.len()).max().unwrap_or(0);
    for engine in 0..engines {
        let name = format!("engine_{}", engine + 1);
        deviation(&mut columns, &name, flights, |flight| flight.engines.get(engine).copied());
    }
    columns.to_csv()
}

/// Adds a deviation: mean, %, number of segments, sum of their squared differences from the mean, %².
fn deviation(
    columns: &mut Columns,
    name: &str,
    flights: &[MonitoredFlight],
    of: impl Fn(&MonitoredFlight) -> Option<FlightDeviation>,
) {
    let number = |value: fn(FlightDeviation) -> f64| {
        let of = &of;
        flights.iter().map(move |flight| of(flight).map(value))
    };
    columns.number(format!("{name}_percent"), number(|shown| shown.deviation_percent()));
    columns.number(format!("{name}_segments"), number(|shown| f64::from(shown.segments())));
    columns.number(format!("{name}_scatter_percent2"), number(|shown| shown.scatter_percent2()));
}

/// The flights of a table.
///
/// # Errors
/// What a field holds that it cannot, with its line.
pub fn read_flights(bytes: &[u8]) -> Result<Vec<MonitoredFlight>, String> {
    let mut reader = csv::ReaderBuilder::new().from_reader(bytes);
    let header = reader.headers().map_err(|error| error.to_string())?;
    let columns = header.len();
    // Earlier programs counted from the polynomial through the guide's rows.
    if header.get(4) != Some(BOOK) {
        return Err(format!(
            "found {:?}, expected a column {BOOK:?}",
            header.get(4).unwrap_or_default()
        ));
    }
    let engines = columns.saturating_sub(COLUMNS) / OF_A_DEVIATION;
    if columns != COLUMNS + OF_A_DEVIATION * engines || engines > MAXIMUM_ENGINES {
        return Err(format!("found {columns} columns, expected {COLUMNS} and 3 for each engine"));
    }
    let mut flights = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(|error| error.to_string())? {
        let flight = Row { record: &record }.flight(engines).map_err(|field| {
            let line = record.position().map_or(0, csv::Position::line);
            let found = record.get(field).unwrap_or_default();
            format!("line {line}, field {}: found {found:?}", field + 1)
        })?;
        flights.push(flight);
    }
    Ok(flights)
}

/// One row; what is wrong is told by the place of its field.
struct Row<'r> {
    record: &'r csv::StringRecord,
}

impl Row<'_> {
    fn flight(&self, engines: usize) -> Result<MonitoredFlight, usize> {
        let start: Timestamp = self.text(1).parse().map_err(|_| 1_usize)?;
        let mut own = Vec::with_capacity(engines);
        for engine in 0..engines {
            own.extend(self.deviation(COLUMNS + OF_A_DEVIATION * engine, start)?);
        }
        Ok(MonitoredFlight {
            flight: csv_cell::read(self.text(0)).into_owned(),
            start,
            segments: self.count(2)?,
            outside_table: self.count(3)?,
            book: self.deviation(4, start)?,
            learnt: self.deviation(7, start)?,
            before_learning: match self.deviation(10, start)? {
                Some(deviation) => {
                    Some(Forecast { deviation, mean_error_percent: self.number(13)? })
                }
                None => None,
            },
            engines: own,
            learnt_over_book_percent: self.number(14)?,
            cruise_fuel_kg: self.number(15)?,
            conditions: MeanConditions {
                pressure_altitude_m: self.number(16)?,
                mach: self.number(17)?,
                static_air_temperature_k: self.number(18)?,
                mass_kg: self.number(19)?,
                true_airspeed_m_s: self.number(20)?,
                initial_fuel_flow_kg_s: self.number(21)?,
                segments: self.count(22)?,
            },
        })
    }

    fn text(&self, field: usize) -> &str {
        self.record.get(field).unwrap_or_default()
    }

    fn count(&self, field: usize) -> Result<usize, usize> {
        self.text(field).parse().map_err(|_| field)
    }

    fn number(&self, field: usize) -> Result<f64, usize> {
        let number: f64 = self.text(field).parse().map_err(|_| field)?;
        if number.is_finite() { Ok(number) } else { Err(field) }
    }

    /// The deviation in three fields from this one on; `None` where they are empty.
    fn deviation(&self, field: usize, start: Timestamp) -> Result<Option<FlightDeviation>, usize> {
        if (field..field + OF_A_DEVIATION).all(|field| self.text(field).is_empty()) {
            return Ok(None);
        }
        let segments: NonZeroU32 = self.text(field + 1).parse().map_err(|_| field + 1)?;
        let (mean, scatter) = (self.number(field)?, self.number(field + 2)?);
        FlightDeviation::of_mean(start, mean, segments, scatter).map(Some).ok_or(field + 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flight(name: &str, engines: usize) -> MonitoredFlight {
        let start = "2024-03-01T10:00:00Z".parse().unwrap();
        let shown =
            |mean: f64| FlightDeviation::of_segments(start, &[mean, mean + 0.1, mean + 0.3]);
        MonitoredFlight {
            flight: name.to_owned(),
            start,
            segments: 3,
            outside_table: 1,
            book: shown(4.0),
            learnt: shown(0.1),
            before_learning: shown(6.0)
                .filter(|_| engines > 0)
                .map(|deviation| Forecast { deviation, mean_error_percent: 5.9 }),
            engines: (0..engines).filter_map(|engine| shown(engine as f64)).collect(),
            learnt_over_book_percent: 3.9,
            cruise_fuel_kg: 1234.5,
            conditions: MeanConditions {
                pressure_altitude_m: 11_000.0,
                mach: 0.78,
                static_air_temperature_k: 216.65,
                mass_kg: 60_000.0,
                true_airspeed_m_s: 230.0,
                initial_fuel_flow_kg_s: 0.6,
                segments: 3,
            },
        }
    }

    #[test]
    fn flights_read_back_to_the_bit() {
        for engines in [0, 2, 4] {
            let flights = [flight("a, \"b\"", engines), flight("=1+1", engines)];
            let csv = flights_to_csv(&flights);
            assert_eq!(read_flights(&csv).unwrap(), flights, "{engines} engines");
        }
        assert_eq!(read_flights(&flights_to_csv(&[])).unwrap(), []);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let csv = String::from_utf8(flights_to_csv(&[flight("1", 2)])).unwrap();
        for (from, to, place) in [
            (",1234.5,", ",many,", "line 2, field 16: found \"many\""),
            (",1234.5,", ",inf,", "line 2, field 16: found \"inf\""),
            ("2024-03-01T10:00:00Z", "noon", "line 2, field 2: found \"noon\""),
        ] {
            let error = read_flights(csv.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert!(error.contains(place), "{error}");
        }
        let error = read_flights(csv.replace(",mach,", ",").as_bytes()).unwrap_err();
        assert!(error.contains("28 columns"), "{error}");
    }
}
