//! Places in words, and the names of their bounds.

use diagnose::{Condition, Edge, Region, Variable};
use flight::Timestamp;

/// Name of an engine's bounds.
pub const ENGINE_BOUNDS: &str = "engine";

/// A region: "engine 2", "mach >= 0.86 and mass < 14000 kg", "everywhere".
pub fn region_words(region: &Region) -> String {
    if region.is_everywhere() {
        return "everywhere".to_owned();
    }
    let engine = region.engine.map(|engine| format!("engine {engine}"));
    let conditions = region.conditions.iter().map(condition_words);
    engine.into_iter().chain(conditions).collect::<Vec<_>>().join(" and ")
}

/// Name of a variable's bounds: a column, with the unit in the name.
pub const fn bounds_name(variable: Variable) -> &'static str {
    names(variable).0
}

/// Unit of a variable behind a number, with a space before it; empty for most.
pub(super) const fn unit_words(variable: Variable) -> &'static str {
    names(variable).2
}

/// Name of the bounds, name and unit in words.
const fn names(variable: Variable) -> (&'static str, &'static str, &'static str) {
    match variable {
        Variable::Mach => ("mach", "mach", ""),
        Variable::LiftCoefficient => ("lift_coefficient", "lift_coefficient", ""),
        Variable::PressureAltitude => ("pressure_altitude_m", "pressure_altitude", " m"),
        Variable::CorrectedThrust => ("corrected_thrust_ratio", "corrected_thrust_ratio", ""),
        Variable::N2 => ("n2_percent", "n2", " %"),
        Variable::IsaDeviation => ("isa_deviation_k", "isa_deviation", " K"),
        Variable::StaticAirTemperature => {
            ("static_air_temperature_k", "static_air_temperature", " K")
        }
        Variable::FuelUsed => ("fuel_used_kg", "fuel_used", " kg"),
        Variable::Mass => ("mass_kg", "mass", " kg"),
        Variable::Date => ("date_s", "date", ""),
        Variable::Roll => ("roll_deg", "roll", " deg"),
        Variable::Acceleration => ("acceleration_m_s2", "acceleration", " m/s2"),
        Variable::CrossWind => ("cross_wind_m_s", "cross_wind", " m/s"),
        Variable::Latitude => ("latitude_deg", "latitude", " deg"),
        Variable::CenterOfGravity => {
            ("center_of_gravity_percent_mac", "center_of_gravity", " %MAC")
        }
        Variable::EastwardSpeed => ("eastward_speed_m_s", "eastward_speed", " m/s"),
        Variable::AntiIce => ("anti_ice", "anti_ice", ""),
        Variable::Engine => (ENGINE_BOUNDS, "engine", ""),
        // No region of a diagnosis is described by these.
        Variable::LatitudeCrossWind => ("latitude_cross_wind", "latitude_cross_wind", ""),
        Variable::CenterOfGravityLift => ("center_of_gravity_lift", "center_of_gravity_lift", ""),
        Variable::MachLift => ("mach_lift", "mach_lift", ""),
        Variable::MachExcess => ("mach_excess", "mach_excess", ""),
    }
}

fn condition_words(condition: &Condition) -> String {
    let &Condition { variable, from, to } = condition;
    if variable == Variable::Date {
        return date_words(from, to);
    }
    if variable == Variable::AntiIce {
        return if from.is_some() { "anti-ice on" } else { "anti-ice off" }.to_owned();
    }
    let (_, name, unit) = names(variable);
    // A number of few digits in another unit (42,000 ft) has a tail of them in this one.
    let written = |edge: Edge| (edge.value * 1e6).round() / 1e6;
    match (from.map(written), to.map(written)) {
        (Some(from), Some(to)) => format!("{name} {from} to {to}{unit}"),
        (Some(from), None) => format!("{name} >= {from}{unit}"),
        (None, Some(to)) => format!("{name} < {to}{unit}"),
        (None, None) => name.to_owned(),
    }
}

/// "after" is after the day of the last flight before; "before" is before the day of the first flight beyond. Where both
/// sides of an edge were flown on one day, its time is given too.
fn date_words(from: Option<Edge>, to: Option<Edge>) -> String {
    let day = |chosen_s: f64, edge: Edge| {
        let same_day = instant(edge.flown_below).get(..10) == instant(edge.value).get(..10);
        let chosen = instant(chosen_s);
        if same_day { chosen } else { chosen.get(..10).unwrap_or(&chosen).to_owned() }
    };
    let after = from.map(|edge| day(edge.flown_below, edge));
    let before = to.map(|edge| day(edge.value, edge));
    match (after, before) {
        (Some(after), Some(before)) => format!("after {after} and before {before}"),
        (Some(after), None) => format!("after {after}"),
        (None, Some(before)) => format!("before {before}"),
        (None, None) => "date".to_owned(),
    }
}

/// An instant, s since 1970, as RFC 3339; empty beyond the calendar.
pub(crate) fn instant(seconds: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
    Timestamp::from_second(seconds as i64).map_or_else(|_| String::new(), |t| t.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region(variable: Variable, from: Option<Edge>, to: Option<Edge>) -> Region {
        Region { engine: None, conditions: vec![Condition { variable, from, to }] }
    }

    #[test]
    fn bounds_read_well() {
        let edge = |value: f64| Some(Edge { value, flown_below: value - 1.0 });
        let words = |from, to| region_words(&region(Variable::Mass, from, to));
        assert_eq!(words(edge(80.0), None), "mass >= 80 kg");
        assert_eq!(words(edge(20.0), edge(60.0)), "mass 20 to 60 kg");
        assert_eq!(words(None, edge(20.0)), "mass < 20 kg");
        let mut both = region(Variable::Mass, edge(80.0), None);
        both.engine = Some(2);
        assert_eq!(region_words(&both), "engine 2 and mass >= 80 kg");
        let switch = |from, to| region_words(&region(Variable::AntiIce, from, to));
        assert_eq!(switch(edge(0.5), None), "anti-ice on");
        assert_eq!(switch(None, edge(0.5)), "anti-ice off");
        assert_eq!(region_words(&Region::default()), "everywhere");
    }

    #[test]
    fn dates_are_days_between_flights() {
        // A flight a day from 2019-06-01T00:00Z (1 559 347 200 s) on.
        let day = |day: f64| 1_559_347_200.0 + 86_400.0 * (day - 1.0);
        let edge = |first: f64| Some(Edge { value: day(first), flown_below: day(first - 1.0) });
        let words = |from, to| region_words(&region(Variable::Date, from, to));
        assert_eq!(words(edge(9.0), None), "after 2019-06-08");
        assert_eq!(words(None, edge(3.0)), "before 2019-06-03");
        assert_eq!(words(edge(3.0), edge(5.0)), "after 2019-06-02 and before 2019-06-05");
        // Two flights on one day: the time distinguishes them.
        let within = Some(Edge { value: day(1.0) + 3600.0, flown_below: day(1.0) });
        assert_eq!(words(within, None), "after 2019-06-01T00:00:00Z");
    }
}
