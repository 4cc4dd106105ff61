//! `segments/TAIL.csv`: every segment with its mean state, and back.

use std::rc::Rc;
use std::sync::Arc;

use flight::{FlightIdentity, MAXIMUM_ENGINES, Segment, SegmentMeans};

use crate::columns::{Columns, Texts};

mod reading;

pub use reading::{is_table, read};

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
