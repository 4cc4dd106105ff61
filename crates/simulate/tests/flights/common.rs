//! Plans that the integration tests share.

use flight::Report;
use simulate::{
    Columns, Earth, FleetDesign, FlightPlan, Flights, Flown, Loading, Plan, Recording, Scatter,
    SensorChoice, Simulation, Switch, TruthPhysics, Weather,
};

/// One hour at FL390, M 0.80, northbound from 45° N, 13.6 t at the start.
pub(crate) fn northbound() -> FlightPlan {
    FlightPlan {
        flight: "0001".to_owned(),
        start: "2019-01-01T00:00:00Z".parse().unwrap(),
        duration_s: 3600.0,
        waypoints: vec![(45.0, 10.0), (65.0, 10.0)],
        pressure_altitude_ft: 39_000.0,
        mach: 0.80,
        loading: Loading::AtRecording { gross_mass_kg: 13_600.0, fuel_on_board_kg: 4_000.0 },
        center_of_gravity_percent_mac: 25.0,
        center_of_gravity_travel_percent_mac_h: 0.0,
        changes: Vec::new(),
        anti_ice: Vec::new(),
    }
}

/// Plain truth, still air, perfect sensors that record everything, no scatter, true states kept.
pub(crate) fn quiet_plan(flights: Vec<FlightPlan>) -> Plan {
    let mut plan = Plan {
        physics: TruthPhysics::plain(),
        earth: Earth::plain(),
        weather: Weather::still(),
        sensors: SensorChoice::Perfect,
        columns: Columns::all(),
        scatter: Scatter::none(),
        recording: Recording { true_states: Switch::On, ..Recording::default() },
        ..Plan::of_one_tail(1, "T-001", FleetDesign::default())
    };
    plan.tails[0].flights = Flights::Listed(flights);
    plan
}

pub(crate) fn fly_first(plan: Plan) -> Flown {
    Simulation::new(plan).unwrap().fly(0).unwrap()
}

/// A column by its name in files, optional values unwrapped.
pub(crate) fn column(report: &Report, name: &str) -> Vec<f64> {
    use flight::FuelFlowColumns;
    use flight::column::Column;
    let c = report.columns();
    let optional = |column: Column| {
        c.optional.get(column).unwrap().iter().map(|value| value.unwrap()).collect::<Vec<_>>()
    };
    let engine = |k: usize| match &c.fuel_flow {
        FuelFlowColumns::PerEngine(engines) => engines[k].clone(),
        FuelFlowColumns::Total(_) => unreachable!("engines are recorded apart"),
    };
    match name {
        "TIME" => c.time_s.clone(),
        "ALT" => c.pressure_altitude_m.clone(),
        "SAT" => c.static_air_temperature_k.clone().unwrap(),
        "MACH" => c.mach.clone(),
        "VTAS" => c.true_airspeed_m_s.clone(),
        "GSPD" => c.ground_speed_m_s.clone(),
        "ROLL" => c.roll_deg.clone().unwrap(),
        "DRIFT" => c.drift_deg.clone().unwrap(),
        "N2(1)" => c.n2_percent.as_ref().unwrap()[0].clone(),
        "N2(2)" => c.n2_percent.as_ref().unwrap()[1].clone(),
        "WF(1)" => engine(0),
        "WF(2)" => engine(1),
        "FU" => c.fuel_used_kg.clone(),
        "HDG" => optional(Column::TrueHeading),
        "LAT" => optional(Column::Latitude),
        "CG" => optional(Column::CenterOfGravity),
        "TAT" => optional(Column::TotalAirTemperature),
        "N1(1)" => optional(Column::N1(1)),
        "EGT(1)" => optional(Column::ExhaustGasTemperature(1)),
        "EGT(2)" => optional(Column::ExhaustGasTemperature(2)),
        "FQ" => optional(Column::FuelQuantity),
        "A/I" => optional(Column::AntiIce),
        _ => unreachable!("{name}"),
    }
}
