//! A table of segments read back.

use std::sync::Arc;

use flight::{FlightIdentity, MAXIMUM_ENGINES, Segment, SegmentMeans};

use super::{OPTIONAL, REQUIRED, SegmentsTableError};
use crate::csv_cell;

/// Whether a text begins as a table of segments does.
pub fn is_table(bytes: &[u8]) -> bool {
    bytes.starts_with(b"tail,flight,start,time_s,samples,")
}

/// Reads a table of segments back, as [`table`](super::table) wrote it. A model's predictions are left out: they are computed again.
///
/// # Errors
/// A missing column, or a field that is not what its column holds, with line and column name.
pub fn read(bytes: &[u8]) -> Result<Vec<Segment>, SegmentsTableError> {
    let mut reader = csv::ReaderBuilder::new().from_reader(bytes);
    let header = reader.headers()?.clone();
    let places = Places::find(&header)?;
    let mut segments = Vec::new();
    // The flight of the row before, as it is written and as what it is: rows of one flight follow each other.
    let mut last: Option<(csv::StringRecord, Arc<FlightIdentity>)> = None;
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record)? {
        let row = Row { places: &places, record: &record };
        let is_same = |known: &csv::StringRecord| {
            places.identity.iter().all(|&place| known.get(place) == record.get(place))
        };
        let identity = match &last {
            Some((known, identity)) if is_same(known) => Arc::clone(identity),
            _ => {
                let this = Arc::new(FlightIdentity {
                    tail: csv_cell::read(row.text("tail")?).into_owned(),
                    start: row.parse("start", "an instant")?,
                    flight: csv_cell::read(row.text("flight")?).into_owned(),
                });
                last = Some((record.clone(), Arc::clone(&this)));
                this
            }
        };
        segments.push(row.segment(identity)?);
    }
    Ok(segments)
}

/// The names of the columns, in file order, and where those of the engines are.
struct Places {
    names: Vec<String>,
    /// Of tail, flight and START.
    identity: [usize; 3],
    required: [usize; REQUIRED.len()],
    optional: [Option<usize>; OPTIONAL.len()],
    fuel_flow: ByEngine,
    n2: ByEngine,
    n1: ByEngine,
    exhaust_gas_temperature: ByEngine,
}

/// The column of each engine.
type ByEngine = [Option<usize>; MAXIMUM_ENGINES];

impl Places {
    fn find(header: &csv::StringRecord) -> Result<Self, SegmentsTableError> {
        let names: Vec<String> = header.iter().map(str::to_owned).collect();
        let by_engine = |name: fn(usize) -> String| -> ByEngine {
            core::array::from_fn(|k| names.iter().position(|known| *known == name(k + 1)))
        };
        let place = |name: &'static str| {
            let found = names.iter().position(|known| known == name);
            found.ok_or(SegmentsTableError::MissingColumn { column: name })
        };
        let mut required = [0; REQUIRED.len()];
        for (slot, (name, _, _)) in required.iter_mut().zip(REQUIRED) {
            *slot = place(name)?;
        }
        let places = Self {
            identity: [place("tail")?, place("flight")?, place("start")?],
            required,
            optional: OPTIONAL.map(|(name, _, _)| place(name).ok()),
            fuel_flow: by_engine(|k| format!("fuel_flow_{k}_kg_s")),
            n2: by_engine(|k| format!("n2_{k}_percent")),
            n1: by_engine(|k| format!("n1_{k}_percent")),
            exhaust_gas_temperature: by_engine(|k| format!("exhaust_gas_temperature_{k}_k")),
            names,
        };
        for name in ["temperature_assumed", "rows"] {
            if places.index_of(name).is_none() {
                return Err(SegmentsTableError::MissingColumn { column: name });
            }
        }
        Ok(places)
    }

    fn index_of(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }
}

struct Row<'a> {
    places: &'a Places,
    record: &'a csv::StringRecord,
}

impl Row<'_> {
    fn text(&self, name: &str) -> Result<&str, SegmentsTableError> {
        self.places
            .index_of(name)
            .and_then(|place| self.record.get(place))
            .ok_or_else(|| self.wrong(name, "nothing", "a field"))
    }

    fn wrong(&self, name: &str, found: &str, expected: &'static str) -> SegmentsTableError {
        SegmentsTableError::Field {
            line: self.record.position().map_or(0, csv::Position::line),
            column: name.to_owned(),
            found: found.to_owned(),
            expected,
        }
    }

    fn parse<T: std::str::FromStr>(
        &self,
        name: &str,
        expected: &'static str,
    ) -> Result<T, SegmentsTableError> {
        let text = self.text(name)?;
        text.parse().map_err(|_| self.wrong(name, text, expected))
    }

    /// The number in a column; `None` where there is no such column, or nothing in it.
    fn at(&self, place: Option<usize>) -> Result<Option<f64>, SegmentsTableError> {
        let Some(place) = place else { return Ok(None) };
        match self.record.get(place) {
            None | Some("") => Ok(None),
            Some(text) => match text.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(Some(value)),
                _ => Err(self.wrong(&self.places.names[place], text, "a finite number")),
            },
        }
    }

    fn engines(&self, places: &ByEngine) -> Result<Vec<f64>, SegmentsTableError> {
        let mut values = Vec::new();
        for place in places {
            match self.at(*place)? {
                Some(value) => values.push(value),
                None => break,
            }
        }
        Ok(values)
    }

    fn each_engine(
        &self,
        places: &ByEngine,
    ) -> Result<[Option<f64>; MAXIMUM_ENGINES], SegmentsTableError> {
        let mut values = [None; MAXIMUM_ENGINES];
        for (value, place) in values.iter_mut().zip(places) {
            *value = self.at(*place)?;
        }
        Ok(values)
    }

    fn segment(&self, identity: Arc<FlightIdentity>) -> Result<Segment, SegmentsTableError> {
        let mut means = SegmentMeans {
            time_s: 0.0,
            pressure_altitude_m: 0.0,
            static_air_temperature_k: 0.0,
            mach: 0.0,
            true_airspeed_m_s: 0.0,
            ground_speed_m_s: 0.0,
            acceleration_m_s2: 0.0,
            vertical_speed_m_s: 0.0,
            mass_kg: 0.0,
            fuel_flow_total_kg_s: 0.0,
            fuel_flow_engine_kg_s: self.engines(&self.places.fuel_flow)?,
            fuel_used_kg: 0.0,
            drift_deg: None,
            roll_deg: None,
            roll_squared_deg2: None,
            n2_percent: self.engines(&self.places.n2)?,
            latitude_deg: None,
            longitude_deg: None,
            true_heading_deg: None,
            center_of_gravity_percent_mac: None,
            total_air_temperature_k: None,
            n1_percent: self.each_engine(&self.places.n1)?,
            exhaust_gas_temperature_k: self.each_engine(&self.places.exhaust_gas_temperature)?,
            fuel_quantity_kg: None,
            anti_ice: None,
        };
        for ((name, _, set), place) in REQUIRED.iter().zip(self.places.required) {
            let value = self.at(Some(place))?;
            set(&mut means, value.ok_or_else(|| self.wrong(name, "", "a finite number"))?);
        }
        for ((_, _, set), place) in OPTIONAL.iter().zip(self.places.optional) {
            set(&mut means, self.at(place)?);
        }
        let rows = self.text("rows")?;
        let rows = rows
            .split(';')
            .map(|row| row.parse().map_err(|_| self.wrong("rows", rows, "numbers and semicolons")))
            .collect::<Result<Vec<u32>, SegmentsTableError>>()?;
        Ok(Segment {
            identity,
            rows,
            means,
            temperature_assumed: self.text("temperature_assumed")? == "1",
        })
    }
}
