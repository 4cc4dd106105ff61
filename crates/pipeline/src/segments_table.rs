//! `segments/TAIL.csv`: every segment with its mean state, and back.

use std::rc::Rc;
use std::sync::Arc;

use flight::{FlightIdentity, MAXIMUM_ENGINES, Segment, SegmentMeans};

use crate::columns::{Columns, Texts};
use crate::csv_cell;

/// What a model predicts for a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluated {
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Observed drag coefficient.
    pub drag_coefficient: f64,
    /// Predicted fuel flow of all engines, kg/s; `None` outside the table.
    pub predicted_fuel_flow_kg_s: Option<f64>,
    /// 100 (recorded − predicted)/recorded; `None` outside the table.
    pub error_percent: Option<f64>,
}

/// A row: a segment and, with a model, what the model predicts.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentRow {
    /// The segment.
    pub segment: Segment,
    /// With a model.
    pub evaluated: Option<Evaluated>,
}

/// Why a text is not a table of segments.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SegmentsTableError {
    /// Not a table of comma-separated values.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// A column that every table of segments has is missing.
    #[error("column {column} is missing")]
    MissingColumn {
        /// Its name.
        column: &'static str,
    },
    /// A field that is not what its column holds.
    #[error("line {line}, column {column}: found {found:?}, expected {expected}")]
    Field {
        /// Physical line from 1.
        line: u64,
        /// Name of the column.
        column: String,
        /// The field as it is.
        found: String,
        /// What such a field holds.
        expected: &'static str,
    },
}

type RequiredGetter = fn(&SegmentMeans) -> f64;
type RequiredSetter = fn(&mut SegmentMeans, f64);
type Getter = fn(&SegmentMeans) -> Option<f64>;
type Setter = fn(&mut SegmentMeans, Option<f64>);

/// Columns of the mean state that are one number a segment and always there, in file order.
const REQUIRED: [(&str, RequiredGetter, RequiredSetter); 9] = [
    ("time_s", |m| m.time_s, |m, v| m.time_s = v),
    ("pressure_altitude_m", |m| m.pressure_altitude_m, |m, v| m.pressure_altitude_m = v),
    (
        "static_air_temperature_k",
        |m| m.static_air_temperature_k,
        |m, v| m.static_air_temperature_k = v,
    ),
    ("mach", |m| m.mach, |m, v| m.mach = v),
    ("true_airspeed_m_s", |m| m.true_airspeed_m_s, |m, v| m.true_airspeed_m_s = v),
    ("ground_speed_m_s", |m| m.ground_speed_m_s, |m, v| m.ground_speed_m_s = v),
    ("acceleration_m_s2", |m| m.acceleration_m_s2, |m, v| m.acceleration_m_s2 = v),
    ("mass_kg", |m| m.mass_kg, |m, v| m.mass_kg = v),
    ("fuel_flow_kg_s", |m| m.fuel_flow_total_kg_s, |m, v| m.fuel_flow_total_kg_s = v),
];

/// Columns that may be empty, after the engines' fuel flows, in file order.
const OPTIONAL: [(&str, Getter, Setter); 12] = [
    ("drift_deg", |m| m.drift_deg, |m, v| m.drift_deg = v),
    ("roll_deg", |m| m.roll_deg, |m, v| m.roll_deg = v),
    ("roll_squared_deg2", |m| m.roll_squared_deg2, |m, v| m.roll_squared_deg2 = v),
    (
        "vertical_speed_m_s",
        |m| Some(m.vertical_speed_m_s),
        |m, v| m.vertical_speed_m_s = v.unwrap_or(0.0),
    ),
    ("fuel_used_kg", |m| Some(m.fuel_used_kg), |m, v| m.fuel_used_kg = v.unwrap_or(0.0)),
    ("latitude_deg", |m| m.latitude_deg, |m, v| m.latitude_deg = v),
    ("longitude_deg", |m| m.longitude_deg, |m, v| m.longitude_deg = v),
    ("true_heading_deg", |m| m.true_heading_deg, |m, v| m.true_heading_deg = v),
    (
        "cg_percent_mac",
        |m| m.center_of_gravity_percent_mac,
        |m, v| m.center_of_gravity_percent_mac = v,
    ),
    (
        "total_air_temperature_k",
        |m| m.total_air_temperature_k,
        |m, v| {
            m.total_air_temperature_k = v;
        },
    ),
    ("fuel_quantity_kg", |m| m.fuel_quantity_kg, |m, v| m.fuel_quantity_kg = v),
    ("anti_ice", |m| m.anti_ice, |m, v| m.anti_ice = v),
];

/// The first column of a segment that holds no finite number; such a segment could not be read back.
pub fn not_finite(segment: &Segment) -> Option<&'static str> {
    let means = &segment.means;
    let bad = |value: f64| !value.is_finite();
    REQUIRED
        .iter()
        .find(|(_, get, _)| bad(get(means)))
        .map(|(name, _, _)| *name)
        .or_else(|| {
            let found = OPTIONAL.iter().find(|(_, get, _)| get(means).is_some_and(bad));
            found.map(|(name, _, _)| *name)
        })
        .or_else(|| {
            let engines = means.fuel_flow_engine_kg_s.iter().chain(&means.n2_percent).copied();
            let optional = means.n1_percent.iter().chain(&means.exhaust_gas_temperature_k);
            engines.chain(optional.flatten().copied()).any(bad).then_some("a column of an engine")
        })
}

/// The table of segments with columns for this many engines.
pub fn table(rows: &[SegmentRow], engines: usize) -> Columns {
    let engines = engines.min(MAXIMUM_ENGINES);
    let mut columns = Columns::default();
    let means = |of: Getter| rows.iter().map(move |row| of(&row.segment.means));
    columns.text("tail", rows.iter().map(|row| row.segment.identity.tail.as_str()));
    columns.text("flight", rows.iter().map(|row| row.segment.identity.flight.as_str()));
    columns.text("start", starts(rows));
    let (time, rest) = REQUIRED.split_at(1);
    for (name, get, _) in time {
        columns.number(*name, rows.iter().map(|row| Some(get(&row.segment.means))));
    }
    columns.count("samples", rows.iter().map(|row| row.segment.samples() as u64));
    for (name, get, _) in rest {
        columns.number(*name, rows.iter().map(|row| Some(get(&row.segment.means))));
    }
    let engine = |of: fn(&SegmentMeans, usize) -> Option<f64>, k: usize| {
        rows.iter().map(move |row| of(&row.segment.means, k))
    };
    for k in 0..engines {
        let flow = |m: &SegmentMeans, k: usize| m.fuel_flow_engine_kg_s.get(k).copied();
        columns.number(format!("fuel_flow_{}_kg_s", k + 1), engine(flow, k));
    }
    for (name, get, _) in &OPTIONAL {
        columns.number(*name, means(*get));
    }
    for k in 0..engines {
        let n2 = |m: &SegmentMeans, k: usize| m.n2_percent.get(k).copied();
        columns.number(format!("n2_{}_percent", k + 1), engine(n2, k));
    }
    for k in 0..engines {
        columns.number(format!("n1_{}_percent", k + 1), engine(|m, k| m.n1_percent[k], k));
    }
    for k in 0..engines {
        columns.number(
            format!("exhaust_gas_temperature_{}_k", k + 1),
            engine(|m, k| m.exhaust_gas_temperature_k[k], k),
        );
    }
    columns.count(
        "temperature_assumed",
        rows.iter().map(|row| u64::from(row.segment.temperature_assumed)),
    );
    columns.texts("rows", joined(rows));
    if rows.iter().any(|row| row.evaluated.is_some()) {
        let evaluated = |of: fn(&Evaluated) -> Option<f64>| {
            rows.iter().map(move |row| row.evaluated.as_ref().and_then(of))
        };
        columns.number("lift_coefficient", evaluated(|e| Some(e.lift_coefficient)));
        columns.number("drag_coefficient", evaluated(|e| Some(e.drag_coefficient)));
        columns.number("predicted_fuel_flow_kg_s", evaluated(|e| e.predicted_fuel_flow_kg_s));
        columns.number("error_percent", evaluated(|e| e.error_percent));
    }
    columns
}

/// Number of engines in these segments, for [`table`].
pub fn engines_of(rows: &[SegmentRow]) -> usize {
    rows.iter()
        .map(|row| {
            row.segment.means.fuel_flow_engine_kg_s.len().max(row.segment.means.n2_percent.len())
        })
        .max()
        .unwrap_or(0)
}

/// Whether a text begins as a table of segments does.
pub fn is_table(bytes: &[u8]) -> bool {
    bytes.starts_with(b"tail,flight,start,time_s,samples,")
}

/// Reads a table of segments back, as [`table`] wrote it. A model's predictions are left out: they are computed again.
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

/// START of each row as text: one text for all rows of a flight.
fn starts(rows: &[SegmentRow]) -> impl Iterator<Item = Rc<str>> {
    let mut last: Option<(&Arc<FlightIdentity>, Rc<str>)> = None;
    rows.iter().map(move |row| {
        let identity = &row.segment.identity;
        match &last {
            Some((known, text)) if Arc::ptr_eq(known, identity) => Rc::clone(text),
            _ => {
                let text = Rc::from(identity.start.to_string());
                Rc::clone(&last.insert((identity, text)).1)
            }
        }
    })
}

/// The samples of each segment.
fn joined(rows: &[SegmentRow]) -> Texts {
    let mut texts = Texts::default();
    for row in rows {
        texts.push_with(|text| {
            for (index, sample) in row.segment.rows.iter().enumerate() {
                text.push_str(if index == 0 { "" } else { ";" });
                text.push_str(itoa::Buffer::new().format(*sample));
            }
        });
    }
    texts
}
