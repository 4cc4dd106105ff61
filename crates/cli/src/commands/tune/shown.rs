//! Settings of law `bayes` for a person.

use std::fmt::Write;

use adapt::bayes::SettingValues;

/// The settings, one line each with unit, under the names that a model file has; per cent are of drag.
pub(super) fn settings(values: &SettingValues) -> String {
    let &SettingValues {
        correction_std,
        slope_std_per_lift_coefficient,
        slope_std_per_mach,
        bend_std_per_lift_coefficient_squared,
        bend_std_per_lift_coefficient_mach,
        bend_std_per_mach_squared,
        extra_flight_std,
        extra_segment_std,
        sensor_segment_factor,
        sensor_flight_factor,
        student_degrees_of_freedom,
        half_life_days,
    } = values;
    let percent = |share: f64| 100.0 * share;
    let numbers = [
        ("correction_std", percent(correction_std), "% of drag"),
        (
            "slope_std_per_lift_coefficient",
            percent(slope_std_per_lift_coefficient),
            "% per lift coefficient",
        ),
        ("slope_std_per_mach", percent(slope_std_per_mach), "% per Mach number"),
        (
            "bend_std_per_lift_coefficient_squared",
            percent(bend_std_per_lift_coefficient_squared),
            "% per lift coefficient²",
        ),
        (
            "bend_std_per_lift_coefficient_mach",
            percent(bend_std_per_lift_coefficient_mach),
            "% per lift coefficient and Mach number",
        ),
        ("bend_std_per_mach_squared", percent(bend_std_per_mach_squared), "% per Mach number²"),
        ("extra_flight_std", percent(extra_flight_std), "% of drag"),
        ("extra_segment_std", percent(extra_segment_std), "% of drag"),
        ("sensor_segment_factor", sensor_segment_factor, "times what the sensors make"),
        ("sensor_flight_factor", sensor_flight_factor, "times what the sensors make"),
        ("student_degrees_of_freedom", student_degrees_of_freedom, "degrees of freedom"),
    ];
    let mut text = "Settings:\n".to_owned();
    for (name, value, unit) in numbers {
        push(&mut text, name, &significant(value), unit);
    }
    match half_life_days {
        None => push(&mut text, "half_life_days", "none", "(knowledge does not age)"),
        Some(days) => push(&mut text, "half_life_days", &significant(days), "days"),
    }
    text
}

fn push(text: &mut String, name: &str, value: &str, unit: &str) {
    let _ = writeln!(text, "  {name:<37} {value:>8} {unit}");
}

/// A number with up to four digits after its point, without zeros at the end.
fn significant(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
