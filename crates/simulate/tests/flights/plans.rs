//! Plans, reports and truth: reproducible, within the format's ranges, and refused with a reason where they are wrong.

use crate::common::{column, fly_first, northbound, quiet_plan};
use flight::Report;
use flight::column::Column;
use flight::effect::{EffectId, TypicalSize};
use simulate::{
    AircraftChoice, Columns, Faults, FleetDesign, FlightPlan, Flights, Plan, PlannedEffect, Preset,
    SensorChoice, Sensors, Simulation, Switch, TailPlan, Truth, Weather,
};

fn small_design() -> FleetDesign {
    FleetDesign { flights: 4, duration_h: (0.5, 0.7), ..FleetDesign::default() }
}

fn fly_all(plan: &Plan) -> Vec<simulate::Flown> {
    let simulation = Simulation::new(plan.clone()).unwrap();
    (0..simulation.len()).map(|index| simulation.fly(index).unwrap()).collect()
}

#[test]
fn same_seed_same_flights_whatever_the_order_and_the_threads() {
    let simulation = Simulation::new(Plan::of_one_tail(5, "T-001", small_design())).unwrap();
    let forwards: Vec<Report> = (0..4).map(|i| simulation.fly(i).unwrap().report).collect();
    let backwards: Vec<Report> = (0..4).rev().map(|i| simulation.fly(i).unwrap().report).collect();
    let threads: Vec<Report> = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..4)
            .map(|i| {
                let simulation = &simulation;
                scope.spawn(move || simulation.fly(i).unwrap().report)
            })
            .collect();
        handles.into_iter().map(|handle| handle.join().unwrap()).collect()
    });
    for i in 0..4 {
        assert_eq!(forwards[i], backwards[3 - i]);
        assert_eq!(forwards[i], threads[i]);
    }
    let other = Simulation::new(Plan::of_one_tail(6, "T-001", small_design())).unwrap();
    assert_ne!(other.fly(0).unwrap().report, forwards[0]);
}

#[test]
fn another_tail_or_effect_moves_no_other_draw() {
    let one = Plan::of_one_tail(5, "T-001", small_design());
    let mut two = one.clone();
    let other = TailPlan { tail: "T-000".to_owned(), ..one.tails[0].clone() };
    two.tails.insert(0, other);
    let alone = fly_all(&one);
    let together = fly_all(&two);
    for (a, b) in alone.iter().zip(&together[4..]) {
        assert_eq!(a.report, b.report);
    }
    // With an effect the flights are the same flights in the same air.
    let mut with = one.clone();
    with.effects = vec![PlannedEffect::typical("drag_factor".parse().unwrap())];
    for (a, b) in alone.iter().zip(&fly_all(&with)) {
        assert_eq!(a.truth.isa_deviation_k, b.truth.isa_deviation_k);
        assert_eq!(a.truth.zero_fuel_mass_kg, b.truth.zero_fuel_mass_kg);
        assert_eq!(a.truth.lower_heating_value_mj_kg, b.truth.lower_heating_value_mj_kg);
        assert_eq!(column_sat(&a.report)[0], column_sat(&b.report)[0]);
    }
}

fn column_sat(report: &Report) -> Vec<f64> {
    report.columns().static_air_temperature_k.clone().unwrap()
}

#[test]
fn reports_of_every_preset_are_within_the_ranges_of_the_format() {
    for preset in [Preset::CitationX, Preset::A320, Preset::RegionalJet] {
        let mut plan =
            Plan::of_one_tail(11, "T-001", FleetDesign { flights: 8, ..FleetDesign::default() });
        plan.aircraft = AircraftChoice::Preset(preset);
        plan.columns = Columns::all();
        for flown in fly_all(&plan) {
            let within = |column: Column, name: &str| {
                let range = column.range();
                for value in self::column(&flown.report, name) {
                    assert!(
                        range.minimum.is_none_or(|least| value >= least)
                            && range.maximum.is_none_or(|most| value <= most),
                        "{preset:?} {name}: {value}"
                    );
                }
            };
            for name in [
                "ALT", "SAT", "MACH", "VTAS", "GSPD", "ROLL", "DRIFT", "N2(1)", "N2(2)", "WF(1)",
                "WF(2)", "LAT", "HDG", "CG", "TAT", "N1(1)", "EGT(1)", "A/I",
            ] {
                within(Column::from_name(name).unwrap(), name);
            }
            let fuel_on_board_kg = flown.report.header().fuel_on_board.to_kilograms();
            for (used, left) in column(&flown.report, "FU").iter().zip(column(&flown.report, "FQ"))
            {
                assert!(*used > 0.0 && *used <= fuel_on_board_kg);
                assert!((0.0..=1.02 * fuel_on_board_kg).contains(&left));
            }
            assert!(column(&flown.report, "FU").windows(2).all(|pair| pair[1] >= pair[0]));
        }
    }
}

#[test]
fn perfect_sensors_record_the_truth_and_meters_integrate_the_flow() {
    let mut plan = quiet_plan(vec![northbound()]);
    plan.weather = Weather::default();
    let flown = fly_first(plan);
    let fu = column(&flown.report, "FU");
    for (i, s) in flown.states.iter().enumerate() {
        let near = |name: &str, truth: f64, tolerance: f64| {
            let recorded = column(&flown.report, name)[i];
            assert!(
                (recorded - truth).abs() <= tolerance,
                "{name} at {}: {recorded} {truth}",
                s.time_s
            );
        };
        near("ALT", s.pressure_altitude_m, 1e-6);
        near("MACH", s.mach, 1e-12);
        near("SAT", s.static_air_temperature_k, 1e-9);
        near("VTAS", s.true_airspeed_m_s, 1e-9);
        near("GSPD", s.ground_speed_m_s, 1e-9);
        near("WF(1)", s.fuel_flow_kg_s[0], 1e-12);
        near("N2(2)", s.n2_percent[1], 1e-12);
        // Meters add up rectangles of one second, the truth trapezoids.
        near("FU", s.fuel_used_kg, 0.05);
    }
    assert!(fu[60] - fu[0] > 500.0);
}

#[test]
fn a_lagging_probe_follows_late() {
    // A speed change is a ramp of Mach number and so of TAT: a first-order lag follows it with a delay of its time
    // constant.
    let mut flight = northbound();
    flight.changes = vec![simulate::Change::Mach { at_s: 600.0, mach: 0.83 }];
    let fly = |lag_s: f64| {
        let mut plan = quiet_plan(vec![flight.clone()]);
        let mut sensors = Sensors::perfect();
        sensors.total_air_temperature.lag_s = lag_s;
        plan.sensors = SensorChoice::Custom(sensors);
        plan.recording.interval_s = 1.0;
        column(&fly_first(plan).report, "TAT")
    };
    let (now, late) = (fly(0.0), fly(4.0));
    let rate = now[690] - now[689];
    assert!(rate > 0.001, "{rate}");
    let behind_s = (now[690] - late[690]) / rate;
    assert!((behind_s - 3.5).abs() < 0.7, "{behind_s}");
}

#[test]
fn faults_leave_rows_and_values_out_as_often_as_asked() {
    let mut sensors = Sensors::transport();
    sensors.faults =
        Faults { missing_sample: 0.1, drop_out: 0.2, stuck_per_h: 2.0, stuck_min: 10.0 };
    let flights =
        (0..40).map(|i| FlightPlan { flight: format!("{i:04}"), ..northbound() }).collect();
    let mut plan = quiet_plan(flights);
    plan.sensors = SensorChoice::Custom(sensors);
    plan.weather = Weather::default();
    let (mut rows, mut absent, mut stuck) = (0, 0, 0);
    for flown in fly_all(&plan) {
        let columns = flown.report.columns();
        rows += flown.report.len();
        absent +=
            columns.optional.get(Column::Latitude).unwrap().iter().filter(|v| v.is_none()).count();
        for name in ["GSPD", "WF(1)", "WF(2)"] {
            // Four in a row the same to the last digit.
            stuck += column(&flown.report, name)
                .windows(5)
                .filter(|w| w.iter().all(|v| *v == w[0]))
                .count();
        }
    }
    let expected = 40.0 * 61.0 * 0.9;
    assert!((rows as f64 - expected).abs() < 60.0, "{rows} rows");
    assert!((absent as f64 / rows as f64 - 0.2).abs() < 0.03, "{absent} of {rows}");
    assert!(stuck > 20, "{stuck}");
}

#[test]
fn plans_survive_their_text() {
    let mut plan = Plan::of_one_tail(2020, "T-001", small_design());
    plan.effects = vec![
        PlannedEffect::typical("wave_drag".parse().unwrap()),
        PlannedEffect {
            from: Some("2018-11-01T00:00:00Z".parse().unwrap()),
            ..PlannedEffect::sized("step_change".parse().unwrap(), 1.5)
        },
    ];
    plan.tails.push(TailPlan {
        tail: "T-002".to_owned(),
        flights: Flights::Listed(vec![northbound()]),
        ..plan.tails[0].clone()
    });
    assert_eq!(Plan::from_ron(&plan.to_ron().unwrap()).unwrap(), plan);
}

#[test]
fn a_short_plan_says_little() {
    let plan = Plan::from_ron(
        r#"(
            seed: 7,
            aircraft: Preset(a320),
            effects: [(id: "tsfc_factor", size: 1.0), (id: "outside_mach_bump", at: 0.78)],
            tails: [(tail: "T-001", flights: Designed((flights: 2, duration_h: (0.3, 0.4))))],
        )"#,
    )
    .unwrap();
    let flown = fly_all(&plan);
    assert_eq!(flown.len(), 2);
    assert_eq!(flown[0].report.header().aircraft_type, "A320");
}

#[test]
fn wrong_plans_are_refused_by_name() {
    let refused = |text: &str| match Plan::from_ron(text) {
        Err(error) => error.to_string(),
        Ok(plan) => Simulation::new(plan).unwrap_err().to_string(),
    };
    let with = |inner: &str| {
        refused(&format!(
            "(seed: 1, {inner} tails: [(tail: \"T\", flights: Designed((flights: 1)))])"
        ))
    };
    assert!(with(r#"effects: [(id: "magic")],"#).contains("no effect is called \"magic\""));
    assert!(with("speed: 3,").contains("speed"));
    assert!(
        with(r#"effects: [(id: "tsfc_engine_3")],"#)
            .contains("tsfc_engine_3 on an aircraft with 2 engines")
    );
    assert!(
        with(r#"effects: [(id: "step_change", size: 1.0, target: engine_4)],"#)
            .contains("step_change of engine 4 on an aircraft with 2 engines")
    );
    assert!(
        with("recording: (longest_step_s: 5.0),")
            .contains("simulation step 5 s outside 0.01 to 1 s")
    );
    assert!(
        refused("(seed: 1, tails: [(tail: \"T\", flights: Listed([]))])").contains("has no flight")
    );
    let twice = "(seed: 1, tails: [(tail: \"T\", flights: Designed((flights: 1))), (tail: \"T\", flights: Designed((flights: 1)))])";
    assert!(refused(twice).contains("tail T occurs twice"));
    let doubled = r#"effects: [(id: "drag_factor"), (id: "drag_factor", size: 1.0)],"#;
    assert!(with(doubled).contains("tail T has the effect drag_factor twice"));
    let impossible = "(seed: 1, tails: [(tail: \"T\", flights: Designed((flights: 1, high_mach: (0.3, 0.31), low_share: 0.0)))])";
    assert!(refused(impossible).contains("no flight within the ranges"), "{}", refused(impossible));
}

#[test]
fn truth_names_effects_with_their_sizes_and_survives_json() {
    let mut plan = Plan::of_one_tail(3, "T-001", small_design());
    plan.effects = vec![PlannedEffect::typical("zero_fuel_mass_bias".parse().unwrap())];
    let simulation = Simulation::new(plan).unwrap();
    // Flown in any order, written in order of time.
    let flown = (0..4).rev().map(|i| simulation.fly(i).unwrap().truth).collect();
    let truth = simulation.truth(flown);
    let tail = &truth.tails[0];
    assert!((tail.effects[0].size / (0.015 * tail.references.mass_kg) - 1.0).abs() < 1e-12);
    assert!(tail.flights.windows(2).all(|pair| pair[0].start <= pair[1].start));
    let flight = &tail.flights[0];
    let planted = flight.zero_fuel_mass_kg - flight.recorded_zero_fuel_mass_kg;
    assert!((planted - tail.effects[0].size).abs() < 4.0 * 0.007 * 11_068.0);
    let text = serde_json::to_string_pretty(&truth).unwrap();
    assert!(text.contains("\"id\": \"zero_fuel_mass_bias\""));
    // Names and structure survive; digits do if the reader is exact, which serde_json is not by default.
    let read: Truth = serde_json::from_str(&text).unwrap();
    assert_eq!(read.tails[0].effects[0].id, tail.effects[0].id);
    assert_eq!(read.tails[0].flights.len(), 4);
    assert_eq!(read.tails[0].flights[0].start, flight.start);
}

#[test]
fn quiet_cruise_meets_the_trim_criteria_most_of_the_time() {
    // The neighbor limits of Ghazi et al., table 4, counted here apart from the segmenter: a fleet that the trials can use
    // has most of its samples within them.
    let plan =
        Plan::of_one_tail(2020, "T-001", FleetDesign { flights: 20, ..FleetDesign::default() });
    let (mut steady, mut all) = (0, 0);
    for flown in fly_all(&plan) {
        let channels = [
            ("ALT", 20.0 * 0.3048),
            ("MACH", 0.003),
            ("GSPD", 1852.0 / 3600.0),
            ("SAT", 1.0),
            ("N2(1)", 1.6),
        ]
        .map(|(name, limit)| (column(&flown.report, name), limit + 1e-9));
        let (drift, roll) = (column(&flown.report, "DRIFT"), column(&flown.report, "ROLL"));
        for i in 1..flown.report.len() - 1 {
            let near = channels.iter().all(|(x, limit)| {
                (x[i] - x[i - 1]).abs() <= *limit && (x[i] - x[i + 1]).abs() <= *limit
            });
            steady += usize::from(near && drift[i].abs() <= 5.0 && roll[i].abs() <= 0.8);
            all += 1;
        }
    }
    let share = steady as f64 / f64::from(all);
    assert!((0.65..0.97).contains(&share), "{share}");
}

#[test]
fn clutter_is_every_other_effect_at_a_tenth() {
    let mut plan = Plan::of_one_tail(4, "T-001", small_design());
    plan.clutter_share = 0.1;
    plan.smooth_errors = simulate::SmoothErrorSizes { drag_percent: 0.25, fuel_flow_percent: 0.25 };
    plan.effects = vec![PlannedEffect::typical("wave_drag".parse().unwrap())];
    let simulation = Simulation::new(plan.clone()).unwrap();
    let clutter = simulation.truth(Vec::new()).tails.remove(0).clutter;
    // Of the library's effects for two engines: not the planted one, not those with a known coefficient.
    let library = EffectId::library(2);
    let known = library.iter().filter(|id| id.entry().typical == TypicalSize::Known).count();
    assert_eq!(known, 3);
    assert_eq!(clutter.len(), library.len() - 1 - known);
    let mean_mass_kg = simulation.truth(Vec::new()).tails[0].references.mass_kg;
    let shares: Vec<f64> =
        clutter.iter().map(|e| e.size / e.id.typical_size(mean_mass_kg)).collect();
    let rms = (shares.iter().map(|s| s * s).sum::<f64>() / shares.len() as f64).sqrt();
    assert!((0.06..0.14).contains(&rms), "{rms}");
    assert!(simulation.fly(0).is_ok());
    // A planted effect changes no size of the clutter.
    plan.effects = Vec::new();
    let without = Simulation::new(plan).unwrap().truth(Vec::new()).tails.remove(0).clutter;
    assert!(clutter.iter().all(|effect| without.contains(effect)));
}

#[test]
fn one_engine_and_four_engines_fly_on_the_same_fuel() {
    let fly = |count: u8| {
        let mut aircraft = simulate::AircraftTruth::preset(Preset::CitationX).unwrap();
        aircraft.engine.rated_thrust_n *= 2.0 / f64::from(count);
        aircraft.engine.count = count;
        let mut plan = quiet_plan(vec![northbound()]);
        plan.aircraft = AircraftChoice::Custom(Box::new(aircraft));
        fly_first(plan).report
    };
    let total = |report: &Report| report.columns().fuel_flow.total_kg_s(30);
    let (one, two, four) = (fly(1), fly(2), fly(4));
    assert_eq!([one.engines(), two.engines(), four.engines()], [Some(1), Some(2), Some(4)]);
    assert!((total(&one) / total(&two) - 1.0).abs() < 1e-9);
    assert!((total(&four) / total(&two) - 1.0).abs() < 1e-9);
}

#[test]
fn true_states_are_kept_only_when_asked_for() {
    let mut plan = quiet_plan(vec![northbound()]);
    assert_eq!(fly_first(plan.clone()).states.len(), 61);
    plan.recording.true_states = Switch::Off;
    assert!(fly_first(plan).states.is_empty());
}

#[test]
fn recordings_that_the_format_refuses_are_refused_here() {
    let refused = |name: &str, size: f64| {
        let mut plan = quiet_plan(vec![northbound()]);
        plan.effects = vec![PlannedEffect::sized(name.parse().unwrap(), size)];
        Simulation::new(plan).unwrap().fly(0).unwrap_err().to_string()
    };
    let message = refused("mach_bias", 0.5);
    assert!(
        message.contains("flight 0001: MACH 1.29997") && message.contains("outside 0.1 to 0.99"),
        "{message}"
    );
    let message = refused("fuel_quantity_gain", 90.0);
    assert!(message.contains("FU") && message.contains("outside 0 to FOB"), "{message}");
}

#[test]
fn the_example_plan_shows_the_defaults_and_flies() {
    let plan = Plan::from_ron(include_str!("../../examples/plan.ron")).unwrap();
    let defaults = Plan::of_one_tail(2020, "T-001", FleetDesign::default());
    assert_eq!(plan.physics, defaults.physics);
    assert_eq!(plan.earth, defaults.earth);
    assert_eq!(plan.weather, defaults.weather);
    assert_eq!(plan.columns, defaults.columns);
    assert_eq!(plan.scatter, defaults.scatter);
    assert_eq!(plan.recording, defaults.recording);
    assert_eq!(plan.tails[0].flights, defaults.tails[0].flights);
    let simulation = Simulation::new(plan).unwrap();
    assert_eq!(simulation.len(), 61);
    assert_eq!(simulation.fly(60).unwrap().report.len(), 121);
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(64))]

    /// Whatever the plan: a report within the format's ranges, or an error with a reason; never a panic.
    #[test]
    fn any_flight_flies_or_says_why(
        seed in proptest::prelude::any::<u64>(),
        latitude_deg in -75.0..75.0_f64,
        track_deg in 0.0..360.0_f64,
        feet in 3_000.0..55_000.0_f64,
        mach in 0.3..0.97_f64,
        mass_kg in 9_000.0..18_000.0_f64,
        wind_field_m_s in 0.0..40.0_f64,
        light_patches_per_h in 0.0..6.0_f64,
        size in -30.0..30.0_f64,
        which in 0..31_usize,
    ) {
        let radians = track_deg.to_radians();
        let mut flight = northbound();
        flight.waypoints = vec![
            (latitude_deg, 10.0),
            ((latitude_deg + radians.cos()).clamp(-80.0, 80.0), 10.0 + radians.sin()),
            ((latitude_deg - radians.sin()).clamp(-80.0, 80.0), 13.0),
        ];
        flight.pressure_altitude_ft = feet;
        flight.mach = mach;
        flight.loading = simulate::Loading::AtRecording { gross_mass_kg: mass_kg, fuel_on_board_kg: 3_000.0 };
        let mut plan = quiet_plan(vec![flight]);
        plan.seed = seed;
        plan.sensors = SensorChoice::Transport;
        plan.weather = Weather {
            wind_field_m_s,
            turbulence: simulate::Turbulence { light_patches_per_h, ..simulate::Turbulence::default() },
            ..Weather::default()
        };
        let id = flight::effect::EffectId::library(2)[which];
        plan.effects = vec![PlannedEffect::sized(simulate::TruthEffect::Library(id), size)];
        match Simulation::new(plan) {
            Err(error) => assert!(!error.to_string().is_empty()),
            Ok(simulation) => match simulation.fly(0) {
                Err(error) => assert!(error.to_string().contains("T-001")),
                Ok(flown) => {
                    let machs = &flown.report.columns().mach;
                    assert!(machs.iter().all(|mach| (0.1..=0.99).contains(mach)), "{machs:?}");
                }
            },
        }
    }
}

#[test]
fn one_aircraft_does_not_fly_twice_at_a_time() {
    let start = "2024-03-01T00:00:00Z".parse().unwrap();
    let end = "2024-03-02T00:00:00Z".parse().unwrap();
    let design = FleetDesign { flights: 30, dates: (start, end), ..small_design() };
    let simulation = Simulation::new(Plan::of_one_tail(5, "T-001", design)).unwrap();
    let flights: Vec<_> = (0..30).map(|index| simulation.flight(index).unwrap().1).collect();
    for pair in flights.windows(2) {
        let apart_s = pair[1].start.as_second() - pair[0].start.as_second();
        assert!(apart_s as f64 >= pair[0].duration_s, "{apart_s} s");
    }
}

/// Plans that made the program panic, hang or run out of memory.
#[test]
fn absurd_plans_are_refused_with_the_reason() {
    let designed = |design: &str| {
        format!("(seed: 1, tails: [(tail: \"P\", flights: Designed((flights: 1, {design})))])")
    };
    let weather = |weather: &str| {
        format!(
            "(seed: 1, weather: ({weather}), tails: [(tail: \"P\", flights: Designed((flights: 1)))])"
        )
    };
    for (plan, words) in [
        (designed("high_mach: (0.94, 0.95)"), "high_mach"),
        (designed("turns_per_h: 1e300"), "turns_per_h"),
        (weather("wind_east_m_s: (mean: 86400, sd: 9.0)"), "mean eastward wind"),
        (
            weather("wind_north_m_s: (mean: 0.0, sd: -1e308)"),
            "standard deviation of northward wind",
        ),
        (
            "(seed: 7, tails: [(tail: \"P\", flights: Designed((flights: 18446744073709551615)))])"
                .to_owned(),
            "number of flights",
        ),
    ] {
        let refused = Simulation::new(Plan::from_ron(&plan).unwrap()).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
    let mut doubled = quiet_plan(vec![northbound(), northbound()]);
    let Flights::Listed(flights) = &mut doubled.tails[0].flights else { panic!("listed") };
    let name = flights[0].flight.clone();
    flights[1].flight = name;
    let refused = Simulation::new(doubled).unwrap_err().to_string();
    assert!(refused.contains("twice"), "{refused}");
}
