//! What a guide's rows say of drag beside the polynomial through them.

use std::sync::Arc;

use adapt::bayes::{BayesSettings, BayesState, Posterior, Search, SettingValues, tune};
use flight::{Observation, ObservationVariance, Timestamp};
use lut::{Outside, SmoothCell, Table};
use perf_model::initial::{GuideObservation, observe_guide_point};
use perf_model::model::NODE_WEIGHT_THRESHOLD;
use perf_model::{Guide, GuideLevels, GuidePlace, GuidePoint, InitialModel, PerformanceModel};

use super::GuideRecord;
use super::guide_levels::{ONE_LEVEL_M, levels_of_rows};

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
///
/// Where the rows tell so, drag has a factor by level in addition `[bayes.16]`.
pub(super) fn with_drag_of_guide(
    initial: &InitialModel,
    guide: &Guide,
    range: &GuideRecord,
) -> Option<PerformanceModel> {
    let model = &initial.model;
    let observe = |point: &GuidePoint| observe_guide_point(model.aircraft(), point).ok();
    let rows = guide.points().iter().map(|point| Some((point, observe(point)?)));
    let rows = rows.collect::<Option<Vec<Row<'_>>>>()?;
    let rows = Rows { model, printed: &rows, range };
    let printed = SettingValues {
        student_degrees_of_freedom: NO_OUTLIERS,
        ..*BayesSettings::physical_2026().values()
    };
    let settings = rows.settings(None, BayesSettings::new(printed).ok()?, &SEARCH)?;
    let table = rows.table(None, settings)?;
    if let Some((by_level, levels)) = rows.by_level(&table, settings) {
        return Some(model.with_drag_table(by_level).ok()?.with_levels(levels));
    }
    model.with_drag_table(table).ok()
}

/// A row of a guide, and the drag that corresponds to it.
type Row<'a> = (&'a GuidePoint, GuideObservation);

/// The rows of a guide.
struct Rows<'a> {
    model: &'a PerformanceModel,
    printed: &'a [Row<'a>],
    range: &'a GuideRecord,
}

impl Rows<'_> {
    /// Table and levels, each fitted to what the other leaves in turn; `None` where levels do not tell most of what `table` leaves:
    /// rows of flights scatter by more than levels do.
    fn by_level(&self, table: &Table, mut settings: BayesSettings) -> Option<(Table, GuideLevels)> {
        let none = GuideLevels::default();
        let mut drag_table = table.clone();
        let mut levels = none.clone();
        let mut variances = None;
        for round in 0..ROUNDS {
            let found = levels_of_rows(&self.left_by(&drag_table), variances.as_ref())?;
            (levels, variances) = (found.0, Some(found.1));
            // How far rows scatter shows once levels are known, and better where they are known better. How much drag bends is not
            // asked again: a table that may bend more holds what planes miss of single levels, between whose rows it is off.
            if round % TUNED_EVERY == 0 {
                settings = self.settings(Some(&levels), settings, &SEARCH_OF_SCATTER)?;
            }
            drag_table = self.table(Some(&levels), settings)?;
        }
        let tells = self.square_left(&drag_table, &levels)
            <= MOST_OF_SQUARE_LEFT * self.square_left(table, &none);
        tells.then_some((drag_table, levels))
    }

    /// The place of every row, and its drag over that of a table, less 1.
    fn left_by(&self, table: &Table) -> Vec<(GuidePlace, f64)> {
        let left = self.printed.iter().filter_map(|(point, row)| {
            let cell = SmoothCell::locate(table.grid(), row.lift_coefficient, row.mach).ok()?;
            let share = row.drag_coefficient / cell.value_of(table) - 1.0;
            Some((place_of(point, row), share))
        });
        left.collect()
    }

    /// Sum of squares of what table and levels leave.
    fn square_left(&self, table: &Table, levels: &GuideLevels) -> f64 {
        let left = self.left_by(table).into_iter();
        left.map(|(place, share)| ((1.0 + share) / levels.factor(place) - 1.0).powi(2)).sum()
    }

    /// What the rows tell of settings.
    fn settings(
        &self,
        levels: Option<&GuideLevels>,
        from: BayesSettings,
        search: &Search,
    ) -> Option<BayesSettings> {
        let initial = self.model.drag_table();
        Some(tune(initial, from, &self.observations(levels), search).ok()?.settings)
    }

    /// The table of rows whose levels are known.
    fn table(&self, levels: Option<&GuideLevels>, settings: BayesSettings) -> Option<Table> {
        let initial = self.model.drag_table();
        let flights = self.observations(levels);
        let mut state = BayesState::new(initial, settings).ok()?;
        for rows in &flights {
            let _ = state.learn_flight(rows);
        }
        let told = told_nodes(initial, &flights);
        table_within(&state.solve().ok()?, initial, (self.range, &told))
    }

    /// What rows say of the table. With levels, rows of one level that follow each other are off together, by what law `bayes` has for
    /// what is common to a flight.
    fn observations(&self, levels: Option<&GuideLevels>) -> Vec<Vec<Observation>> {
        let initial = self.model.drag_table();
        let together = |a: &Row<'_>, b: &Row<'_>| levels.is_some() && are_of_one_level(a, b);
        let flights = self.printed.chunk_by(together);
        flights
            .map(|rows| rows.iter().map(|row| observation(initial, levels, row)).collect())
            .collect()
    }
}

/// What a row says of the table that is learnt.
fn observation(
    initial: &Table,
    levels: Option<&GuideLevels>,
    (point, row): &Row<'_>,
) -> Observation {
    let total_kg_s = point.fuel_flow_total.to_kilograms_per_second();
    let chord = chord_over_smooth(initial, row.lift_coefficient, row.mach).unwrap_or(1.0);
    let at_level = levels.map_or(1.0, |levels| levels.factor(place_of(point, row)));
    let drag_coefficient = row.drag_coefficient * chord / at_level;
    Observation {
        time: Timestamp::UNIX_EPOCH,
        lift_coefficient: row.lift_coefficient,
        mach: row.mach,
        drag_coefficient,
        fuel_flow_total_kg_s: total_kg_s,
        fuel_flow_per_drag_coefficient_kg_s: total_kg_s / drag_coefficient,
        variance: ObservationVariance { segment: 0.0, flight: 0.0 },
    }
}

fn are_of_one_level((a, _): &Row<'_>, (b, _): &Row<'_>) -> bool {
    (a.pressure_altitude.to_meters() - b.pressure_altitude.to_meters()).abs() < ONE_LEVEL_M
}

fn place_of(point: &GuidePoint, row: &GuideObservation) -> GuidePlace {
    GuidePlace {
        lift_coefficient: row.lift_coefficient,
        mach: row.mach,
        pressure_altitude: point.pressure_altitude,
    }
}

/// How often table and levels are fitted to what the other leaves, and after how many of these rounds settings are asked again. Our
/// choice.
const ROUNDS: usize = 8;
const TUNED_EVERY: usize = 3;

/// Of the squares that a table leaves of rows, the most that levels may leave. Our choice: printed guides leave 0.004 to 0.05, guides made
/// of flights 0.3 and more.
const MOST_OF_SQUARE_LEFT: f64 = 0.25;

/// How the rows of a guide tell their own noise, and how much drag bends beside the polynomial: a drag rise sets in more sharply than
/// an aircraft departs from its guide.
const SEARCH: Search = Search {
    largest_factor: 32.0,
    smallest_factor: 1.4,
    maximum_evaluations: 120,
    prior_factor: 4.0,
    with_correction: true,
};
/// How they tell their noise alone.
const SEARCH_OF_SCATTER: Search = Search { with_correction: false, ..SEARCH };
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
