//! What a guide's rows say of drag beside the polynomial through them.

use std::sync::Arc;

use adapt::bayes::{BayesSettings, BayesState, Posterior, Search, SettingValues, tune};
use flight::{Observation, ObservationVariance, Timestamp};
use lut::{Outside, SmoothCell, Table};
use perf_model::initial::{GuideObservation, observe_guide_point};
use perf_model::model::NODE_WEIGHT_THRESHOLD;
use perf_model::{Guide, GuidePoint, InitialModel, PerformanceModel};

use super::{GuideBook, GuideLevels, GuidePlace, GuideRecord};

/// The model with the drag of its guide's rows in the table, in place of the polynomial's; `None` where the rows do not make a table.
///
/// ```text
/// CD_guide = CD_polynomial·(1 + x),   x by law bayes from the rows, each a flight of one segment          [bayes.14]
/// ```
///
/// The polynomial is smooth between its nodes `[tables.10]`, as what comes of it is read: law `bayes`, whose table has chords
/// there, is given each row's drag by as much less or more as chord and smooth surface differ.
///
/// Six coefficients cannot hold a drag rise: beside the polynomial, a guide's own rows may be several per cent off, and most where
/// flights go beyond the Mach numbers that have been flown. At nodes that no row tells the nearest x within the guide's range holds.
pub(super) fn with_drag_of_guide(
    initial: &InitialModel,
    guide: &Guide,
    range: &GuideRecord,
) -> Option<(PerformanceModel, Option<GuideBook>)> {
    let model = &initial.model;
    let observe = |point: &GuidePoint| observe_guide_point(model.aircraft(), point).ok();
    let rows = guide.points().iter().map(|point| Some((point, observe(point)?)));
    let rows = rows.collect::<Option<Vec<(&GuidePoint, GuideObservation)>>>()?;
    let of_rows =
        |levels: &GuideLevels, settings| table_of(model, &rows, levels, (range, settings));
    let (table, _) = of_rows(&GuideLevels::default(), None)?;
    let book = book_of(&table, &rows, of_rows);
    Some((model.with_drag_table(table).ok()?, book))
}

/// Table and levels, each fitted to what the other leaves in turn; `None` where levels say nothing beside a table.
fn book_of(
    table: &Table,
    rows: &[(&GuidePoint, GuideObservation)],
    of_rows: impl Fn(&GuideLevels, Option<BayesSettings>) -> Option<(Table, BayesSettings)>,
) -> Option<GuideBook> {
    let mut drag_table = table.clone();
    let mut levels = GuideLevels::default();
    let mut settings = None;
    for round in 0..ROUNDS {
        levels = GuideLevels::of_rows(&left_by(&drag_table, rows));
        if levels.levels().is_empty() {
            return None;
        }
        // How far rows scatter and drag bends shows once levels are known, and better where they are known better.
        let known = settings.filter(|_| round % TUNED_EVERY != 0);
        let (next, found) = of_rows(&levels, known)?;
        (drag_table, settings) = (next, Some(found));
    }
    Some(GuideBook { drag_table, levels })
}

/// How often table and levels are fitted to what the other leaves, and after how many of these rounds settings are asked again. Our
/// choice.
const ROUNDS: usize = 8;
const TUNED_EVERY: usize = 3;

/// The place of every row, and its drag over that of a table, less 1.
fn left_by(table: &Table, rows: &[(&GuidePoint, GuideObservation)]) -> Vec<(GuidePlace, f64)> {
    let left = rows.iter().filter_map(|(point, row)| {
        let cell = SmoothCell::locate(table.grid(), row.lift_coefficient, row.mach).ok()?;
        let share = row.drag_coefficient / cell.value_of(table) - 1.0;
        Some((place_of(point, row), share))
    });
    left.collect()
}

fn place_of(point: &GuidePoint, row: &GuideObservation) -> GuidePlace {
    GuidePlace {
        lift_coefficient: row.lift_coefficient,
        mach: row.mach,
        pressure_altitude: point.pressure_altitude,
    }
}

/// The table of rows whose levels are known, and the settings that rows tell where none are.
fn table_of(
    model: &PerformanceModel,
    rows: &[(&GuidePoint, GuideObservation)],
    levels: &GuideLevels,
    (range, known): (&GuideRecord, Option<BayesSettings>),
) -> Option<(Table, BayesSettings)> {
    let initial = model.drag_table();
    let flights: Vec<Vec<Observation>> = rows
        .iter()
        .map(|(point, row)| {
            let total_kg_s = point.fuel_flow_total.to_kilograms_per_second();
            let chord = chord_over_smooth(initial, row.lift_coefficient, row.mach).unwrap_or(1.0);
            let at_level = levels.factor(place_of(point, row));
            let drag_coefficient = row.drag_coefficient * chord / at_level;
            vec![Observation {
                time: Timestamp::UNIX_EPOCH,
                lift_coefficient: row.lift_coefficient,
                mach: row.mach,
                drag_coefficient,
                fuel_flow_total_kg_s: total_kg_s,
                fuel_flow_per_drag_coefficient_kg_s: total_kg_s / drag_coefficient,
                variance: ObservationVariance { segment: 0.0, flight: 0.0 },
            }]
        })
        .collect();
    let settings = if let Some(known) = known {
        known
    } else {
        let printed = SettingValues {
            student_degrees_of_freedom: NO_OUTLIERS,
            ..*BayesSettings::physical_2026().values()
        };
        tune(initial, BayesSettings::new(printed).ok()?, &flights, &SEARCH).ok()?.settings
    };
    let mut state = BayesState::new(initial, settings).ok()?;
    for row in &flights {
        let _ = state.learn_flight(row);
    }
    let told = told_nodes(initial, &flights);
    Some((table_within(&state.solve().ok()?, initial, (range, &told))?, settings))
}

/// How the rows of a guide tell their own noise, and how much drag bends beside the polynomial: a drag rise sets in more sharply than
/// an aircraft departs from its guide.
const SEARCH: Search = Search {
    largest_factor: 32.0,
    smallest_factor: 1.4,
    maximum_evaluations: 120,
    prior_factor: 4.0,
    with_correction: true,
};
/// Degrees of freedom of rows that are printed and not measured: none is weighed down.
const NO_OUTLIERS: f64 = 1e6;

/// Bilinear value of a table over the smooth one; `None` outside it.
fn chord_over_smooth(table: &Table, lift_coefficient: f64, mach: f64) -> Option<f64> {
    let grid = table.grid();
    let cell = grid.locate(lift_coefficient, mach, Outside::Error).ok()?;
    let smooth = SmoothCell::locate(grid, lift_coefficient, mach).ok()?;
    Some(table.interpolate(&cell) / smooth.value_of(table))
}

/// Nodes of the cells that rows lie in: those that a row says something of.
fn told_nodes(table: &Table, rows: &[Vec<Observation>]) -> Vec<bool> {
    let grid = table.grid();
    let mut told = vec![false; grid.nodes()];
    for row in rows.iter().flatten() {
        let Ok(cell) = grid.locate(row.lift_coefficient, row.mach, Outside::Error) else {
            continue;
        };
        for (node, weight) in cell.nodes().into_iter().zip(cell.weights()) {
            told[node] |= weight > NODE_WEIGHT_THRESHOLD;
        }
    }
    told
}

/// A table with the corrections of a posterior, those of its edge beyond a guide's range where no row tells a node.
fn table_within(
    posterior: &Posterior,
    initial: &Table,
    (range, told): (&GuideRecord, &[bool]),
) -> Option<Table> {
    let grid = initial.grid();
    let values = initial.values().iter().enumerate().map(|(node, drag_coefficient)| {
        let (mut lift_coefficient, mut mach) = grid.coordinates(node);
        if !told[node] {
            lift_coefficient =
                lift_coefficient.clamp(range.lift_coefficient.0, range.lift_coefficient.1);
            mach = mach.clamp(range.mach.0, range.mach.1);
        }
        let cell = grid.locate(lift_coefficient, mach, Outside::Hold);
        Some(drag_coefficient * (1.0 + posterior.correction_at(&cell.ok()?)))
    });
    Table::new(Arc::clone(grid), values.collect::<Option<Vec<f64>>>()?).ok()
}
