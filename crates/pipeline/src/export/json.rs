//! A model as JSON, with what is needed to compute a fuel flow from it in any language.

use serde::Serialize;

use super::{LeftOut, informed, remainder_left_out};
use crate::model_file::ModelFile;

/// Schema of the JSON.
pub const SCHEMA: &str = "cruisefit.model/1";

/// How to use the numbers, for who has nothing but the file.
const EQUATIONS: [&str; 6] = [
    "p, rho: ISO 2533 static pressure of the pressure altitude; rho = p/(287.05287 SAT); V = mach sqrt(1.4 287.05287 SAT)",
    "q = rho V^2/2; CL = mass 9.80665/(q wing_area_m2)",
    "CD: bilinear in drag_coefficient[i][j] at lift_coefficient[i], mach[j]; no value outside the table",
    "tsfc = tsfc.static_kg_n_s sqrt(SAT/288.15) (1 + mach)^tsfc.mach_exponent",
    "fuel flow of all engines, kg/s = (q wing_area_m2 CD + mass acceleration) tsfc",
    "standard deviation of CD from what was learnt: relative_std x initial_drag_coefficient",
];

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    aircraft: AircraftPart<'a>,
    tail: Option<&'a str>,
    law: Option<&'static str>,
    flights: usize,
    tsfc: TsfcPart,
    lift_coefficient: &'a [f64],
    mach: &'a [f64],
    drag_coefficient: Vec<&'a [f64]>,
    initial_drag_coefficient: Vec<&'a [f64]>,
    /// `null` by law `paper`, which does not know it, and where nothing was learnt.
    relative_std: Option<Vec<&'a [f64]>>,
    informed: Vec<Vec<bool>>,
    effects_left_out: Vec<String>,
    /// `null` of a model that has learnt no more than a table.
    remainder_left_out: Option<LeftOut>,
    equations: [&'static str; 6],
}

#[derive(Serialize)]
struct AircraftPart<'a> {
    name: &'a str,
    type_code: &'a str,
    engines: usize,
    wing_area_m2: f64,
}

#[derive(Serialize)]
struct TsfcPart {
    static_kg_n_s: f64,
    mach_exponent: f64,
}

/// The model as JSON, with a final line end.
///
/// # Errors
/// None that is known: what JSON refuses to write.
pub fn json(model: &ModelFile) -> Result<String, serde_json::Error> {
    let aircraft = model.initial.aircraft();
    let law = aircraft.tsfc_law();
    let grid = model.grid();
    let columns = grid.y().len();
    let learnt = model.learnt.as_ref();
    let informed = informed(model);
    let document = Document {
        schema: SCHEMA,
        aircraft: AircraftPart {
            name: aircraft.name(),
            type_code: aircraft.type_code(),
            engines: aircraft.engines(),
            wing_area_m2: aircraft.wing_area().to_square_meters(),
        },
        tail: learnt.map(|learnt| learnt.tail.as_str()),
        law: learnt.map(|learnt| learnt.law.name()),
        flights: learnt.map_or(0, |learnt| learnt.ledger.len()),
        tsfc: TsfcPart {
            static_kg_n_s: law.static_tsfc.to_kilograms_per_newton_second(),
            mach_exponent: law.mach_exponent,
        },
        lift_coefficient: grid.x().breakpoints(),
        mach: grid.y().breakpoints(),
        drag_coefficient: model.drag_coefficient().values().chunks(columns).collect(),
        initial_drag_coefficient: model.initial.drag_table().values().chunks(columns).collect(),
        relative_std: model
            .posterior()
            .map(|posterior| posterior.standard_deviation().chunks(columns).collect()),
        informed: informed.chunks(columns).map(<[bool]>::to_vec).collect(),
        effects_left_out: if model.applied.is_empty() {
            Vec::new()
        } else {
            vec![model.told_effects()]
        },
        remainder_left_out: remainder_left_out(model),
        equations: EQUATIONS,
    };
    let mut text = serde_json::to_string_pretty(&document)?;
    text.push('\n');
    Ok(text)
}
