//! `cruisefit optimum` on a learnt model.

use crate::json_schema::violations;
use crate::support::{adapt, cruisefit, csv_columns, fixture, initial_model};

#[test]
fn optima_as_table_csv_and_json() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[fixture("reports")], &[]).expect(0);
    let learnt = output.join("models/SIM-01.ron");
    let (csv, json) = (scratch.path().join("optimum.csv"), scratch.path().join("optimum.json"));
    let arguments = |extra: &[&str]| -> Vec<std::ffi::OsString> {
        let mut all: Vec<std::ffi::OsString> = vec!["optimum".into(), "--model".into()];
        all.push(learnt.clone().into());
        all.extend(extra.iter().map(Into::into));
        all
    };
    let files = [csv.to_str().unwrap(), json.to_str().unwrap()];
    let asked = ["--mass-kg", "28000,32000", "--cost-index", "5", "-o", files[0], "-o", files[1]];
    let ran = cruisefit(&arguments(&asked)).expect(0);
    assert_eq!(ran.stdout.lines().filter(|line| line.starts_with("max range")).count(), 2);
    let first = std::fs::read(&json).unwrap();
    assert!(!ran.stderr.contains("--mass-kg"), "{}", ran.stderr);
    let twice =
        ["--mass-kg", "28000,28000,32000", "--cost-index", "5", "-o", files[0], "-o", files[1]];
    cruisefit(&arguments(&twice)).expect(0);
    assert_eq!(std::fs::read(&json).unwrap(), first, "what is asked for twice is answered once");
    cruisefit(&arguments(&["--mass-kg", "70000"])).says("--mass-kg 70000: guide and flights have");
    cruisefit(&arguments(&asked)).expect(0);
    assert_eq!(std::fs::read(&json).unwrap(), first, "same input, same bytes");

    let document: serde_json::Value = serde_json::from_slice(&first).unwrap();
    let schema = crate::support::root().join("docs/schemas/optimum-1.json");
    let schema: serde_json::Value =
        serde_json::from_slice(&std::fs::read(schema).unwrap()).unwrap();
    assert_eq!(violations(&schema, &document), Vec::<String>::new());

    let printed = cruisefit(&arguments(&[&asked[..4], &["--json"]].concat())).expect(0);
    assert_eq!(printed.stdout.as_bytes(), first);

    let table = csv_columns(&csv);
    let number = |name: &str, row: usize| table[name][row].parse::<f64>().unwrap();
    assert!(!table["mach"].is_empty());
    let rows = table["mach"].len();
    for row in (0..).take(rows) {
        assert!(number("mach_ci95_low", row) <= number("mach_ci95_high", row));
        // A time that costs nothing is never a reason to fly slower than one that costs something.
        if table["kind"][row] == "cost_index" {
            assert!(number("mach", row) >= number("mach", row - 2), "row {row}");
        }
        // By the model itself its own optimum is never worse than the book's; where nothing is stated there is a reason.
        if table["no_saving"][row].is_empty() {
            assert!(number("saving_kg_h", row) >= 0.0);
        } else {
            assert_eq!(table["saving_kg_h"][row], "");
        }
    }
    best_rows_are_those_of_the_document(&table, &document);
    rows_are_held_against_predict(scratch.path(), &learnt, &table);
    assert!(ran.stdout.contains("from what `predict` states"), "{}", ran.stdout);
    let beyond = table["beyond_flights"].iter().any(|flag| flag == "1");
    assert!(beyond, "FL430 is above what these flights flew");

    // A mass that is informed nowhere is no silence, and costs nothing but itself.
    let lost = scratch.path().join("lost.csv");
    let asked = ["--mass-kg", "28000,400000", "-q", "-o", lost.to_str().unwrap()];
    cruisefit(&arguments(&asked)).expect(1).says("mass 400000 kg, ISA deviation +0 °C");
    assert!(csv_columns(&lost)["mass_kg"].iter().all(|mass| mass == "28000"));
    cruisefit(&arguments(&["-o", "x.txt"])).expect(2).says("ends neither in .csv");
    cruisefit(&arguments(&["--mass-kg", "-1"])).expect(2);
}

/// Law `paper` leaves nodes so far apart that a smooth surface overshoots between them: noted, warned of, and in the document. It has
/// no interval, and no flights beyond which something lies.
#[test]
fn a_surface_that_overshoots_is_warned_of() {
    let model = fixture("expected/SIM-01.ron");
    let ran = cruisefit(&["optimum".as_ref(), "--model".as_ref(), model.as_os_str()]).expect(0);
    ran.says("overshoots").prints("from what `predict` states");
    let words = ["optimum".as_ref(), "--json".as_ref(), "--model".as_ref(), model.as_os_str()];
    let printed = cruisefit(&words).expect(0).stdout;
    let document: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert!(document["largest_against_predict_percent"].as_f64().unwrap() > 0.5);
    assert!(document["conditions"][0]["best"][0]["beyond_flights"].is_null());
    let schema = crate::support::root().join("docs/schemas/optimum-1.json");
    let schema: serde_json::Value =
        serde_json::from_slice(&std::fs::read(schema).unwrap()).unwrap();
    assert_eq!(violations(&schema, &document), Vec::<String>::new());
    let scratch = tempfile::tempdir().unwrap();
    let initial = initial_model(scratch.path());
    let ran = cruisefit(&["optimum".as_ref(), "--model".as_ref(), initial.as_os_str()]).expect(0);
    ran.says("the chords of `predict`");
    assert!(!ran.stderr.contains("overshoots"), "{}", ran.stderr);
}

type Table = std::collections::BTreeMap<String, Vec<String>>;

/// What the document has of best levels is in their rows, and in no other.
fn best_rows_are_those_of_the_document(table: &Table, document: &serde_json::Value) {
    let conditions = document["conditions"].as_array().unwrap();
    let best: Vec<&serde_json::Value> =
        conditions.iter().flat_map(|one| one["best"].as_array().unwrap()).collect();
    let rows: Vec<usize> =
        (0..table["mach"].len()).filter(|row| table["best_level"][*row] == "1").collect();
    assert_eq!(rows.len(), best.len());
    let is = |name: &str, row: usize, value: &serde_json::Value| {
        // The parser of the document may miss the last bit.
        let near = match (table[name][row].parse::<f64>().ok(), value.as_f64()) {
            (Some(found), Some(value)) => (found - value).abs() <= 1e-12 * value.abs(),
            (found, value) => found == value,
        };
        assert!(near, "{name} of row {row}: {value}");
    };
    for row in (0..).take(table["mach"].len()) {
        let Some(best) = best.iter().find(|best| {
            table["best_level"][row] == "1"
                && best["kind"] == table["kind"][row]
                && best["mach"] == table["mach"][row].parse::<f64>().unwrap()
                && best["pressure_altitude_ft"]
                    == table["pressure_altitude_ft"][row].parse::<f64>().unwrap()
        }) else {
            assert_eq!(table["best_level"][row], "0");
            assert_eq!(table["level_ci95_low_ft"][row], "");
            continue;
        };
        is("level_ci95_low_ft", row, &best["pressure_altitude_ci95"][0]);
        is("level_ci95_high_ft", row, &best["pressure_altitude_ci95"][1]);
        is("book_level_ft", row, &best["book_pressure_altitude_ft"]);
        is("book_level_mach", row, &best["book_mach"]);
        is("level_saving_kg_h", row, &best["saving_kg_h"]);
        assert_eq!(table["level_no_saving"][row], best["no_saving"].as_str().unwrap_or(""));
        assert!(best["at_edge"] == false || !table["at_edge"][row].is_empty(), "row {row}");
        assert_eq!(best["beyond_flights"] == true, table["beyond_flights"][row] == "1");
    }
}

/// The oracle is `predict` at the same points.
fn rows_are_held_against_predict(folder: &std::path::Path, model: &std::path::Path, table: &Table) {
    let mut points = "mass_kg,pressure_altitude_ft,mach,isa_deviation_c\n".to_owned();
    for row in (0..).take(table["mach"].len()) {
        let names = ["mass_kg", "pressure_altitude_ft", "mach", "isa_deviation_c"];
        points.push_str(&names.map(|name| table[name][row].as_str()).join(","));
        points.push('\n');
    }
    let (given, predicted) = (folder.join("points.csv"), folder.join("predicted.csv"));
    std::fs::write(&given, points).unwrap();
    cruisefit(&[
        "predict".as_ref(),
        "--model".as_ref(),
        model.as_os_str(),
        given.as_os_str(),
        "-o".as_ref(),
        predicted.as_os_str(),
    ])
    .expect(0);
    let predicted = csv_columns(&predicted);
    assert_eq!(predicted["beyond_flights"], table["beyond_flights"]);
    for row in (0..).take(table["mach"].len()) {
        let number = |table: &Table, name: &str| table[name][row].parse::<f64>().unwrap();
        let flow = number(table, "fuel_flow_kg_h") / 3600.0;
        let against = 100.0 * (flow / number(&predicted, "fuel_flow_kg_s") - 1.0);
        assert!((against - number(table, "against_predict_percent")).abs() < 1e-6, "row {row}");
    }
}

/// The virtual aircraft's own optima, found by brute force over its truth: thousandth by thousandth, each trimmed.
///
/// Forty flights teach. Wherever the model has its optimum inside what it knows, flying it costs the truth less fuel than
/// flying the book's. How much more than the truth's own optimum it costs is printed: nothing promises a figure.
#[test]
fn optima_of_the_virtual_aircraft_by_brute_force() {
    let scratch = tempfile::tempdir().unwrap();
    let at = |name: &str| scratch.path().join(name);
    let text = |path: &std::path::Path| path.to_str().unwrap().to_owned();
    let plan = "(seed: 4711, tails: [(tail: \"T-001\", flights: Designed((flights: 40)))])";
    std::fs::write(at("plan.ron"), plan).unwrap();
    cruisefit(&["simulate", "ghazi-2020", "-o", &text(&at("study"))]).expect(0);
    cruisefit(&["simulate", &text(&at("plan.ron")), "-o", &text(&at("fleet"))]).expect(0);
    let (aircraft, guide) = (text(&at("study/AIRCRAFT.ron")), text(&at("study/guide.csv")));
    let model = text(&at("MODEL.ron"));
    cruisefit(&["init", "--aircraft", &aircraft, "--guide", &guide, "-o", &model]).expect(0);
    let fleet = at("fleet").join("T-001");
    adapt(std::path::Path::new(&model), &at("out"), &[fleet], &["--no-remainder"]).expect(0);
    let (learnt, csv) = (text(&at("out/models/T-001.ron")), text(&at("optimum.csv")));
    let masses = [12_500.0, 13_500.0, 14_500.0];
    let levels = [37_000.0, 40_000.0, 43_000.0];
    let asked = ["--mass-kg", "12500,13500,14500", "--levels", "37000,40000,43000"];
    cruisefit(&[&["optimum", "--model", &learnt, "-o", &csv][..], &asked[..]].concat()).expect(0);

    let truth = simulate::AircraftTruth::preset(simulate::Preset::CitationX).unwrap();
    let physics = simulate::Plan::from_ron(plan).unwrap().physics;
    let table = csv_columns(std::path::Path::new(&csv));
    let mut compared = 0;
    for row in (0..).take(table["mach"].len()) {
        let number = |name: &str| table[name][row].parse::<f64>().unwrap();
        let inside = table["at_edge"][row].is_empty();
        if table["kind"][row] != "maximum_range" || !inside {
            continue;
        }
        let (mass, level) = (number("mass_kg"), number("pressure_altitude_ft"));
        assert!(masses.contains(&mass) && levels.contains(&level));
        let fuel_per_distance = |mach: f64| {
            let pressure_altitude = units::PressureAltitude::feet(level);
            let trimmed = truth.trim(
                &simulate::TrimPoint {
                    mass: units::Mass::kilograms(mass),
                    pressure_altitude,
                    mach: units::Mach::new(mach),
                    sat: atmos::isa::temperature(pressure_altitude).unwrap(),
                    center_of_gravity_percent_mac: truth.airframe.trim.reference_percent_mac,
                },
                physics,
            );
            trimmed.map_or(f64::INFINITY, |t| t.fuel_flow_kg_s / t.true_airspeed_m_s)
        };
        let machs = (550..950_u32).map(|thousandths| f64::from(thousandths) / 1000.0);
        let best =
            machs.min_by(|a, b| fuel_per_distance(*a).total_cmp(&fuel_per_distance(*b))).unwrap();
        let regret = |mach: f64| 100.0 * (fuel_per_distance(mach) / fuel_per_distance(best) - 1.0);
        eprintln!(
            "{mass} kg, {level} ft: own {} ({}–{}), book {}, truth {best}; regret {:.3} %, book {:.3} %",
            number("mach"),
            number("mach_ci95_low"),
            number("mach_ci95_high"),
            number("book_mach"),
            regret(number("mach")),
            regret(number("book_mach"))
        );
        assert!(regret(number("mach")) < regret(number("book_mach")));
        compared += 1;
    }
    assert!(compared >= 3, "{compared} optima inside what is informed");
}
