//! What a cruise report holds.

use std::fmt::Write;

use flight::{FuelFlowColumns, Report};
use pipeline::summary::{aligned, counted};
use report::Parsed;
use units::Mass;

use crate::commands::Outcome;

/// Header, columns with their ranges, and what was noticed while it was read.
pub(super) fn outcome(parsed: &Parsed) -> Outcome {
    let header = parsed.report.header();
    let identity = &header.identity;
    let kilograms = |mass: Mass| format!("{:.0} kg", mass.to_kilograms());
    let columns = columns(&parsed.report);
    let mut text = format!(
        "Cruise report of tail {} ({}), flight {}, from {}\n",
        identity.tail, header.aircraft_type, identity.flight, identity.start
    );
    let _ = writeln!(
        text,
        "zero-fuel mass {}, fuel on board at engine start {}; {}",
        kilograms(header.zero_fuel_mass),
        kilograms(header.fuel_on_board),
        counted(parsed.report.len(), "sample"),
    );
    for (key, value) in &header.notes {
        let _ = writeln!(text, "{key}: {value}");
    }
    let mut rows = vec![["quantity", "least", "mean", "greatest"].map(str::to_owned).to_vec()];
    rows.extend(columns.iter().map(|column| {
        let [least, mean, greatest] = column.figures.map(|figure| format!("{figure:.3}"));
        vec![column.name.to_owned(), least, mean, greatest]
    }));
    let _ = write!(text, "\n{}", aligned(&rows));
    for finding in &parsed.findings {
        let _ = writeln!(text, "Note: {}", finding.message);
    }
    let document = serde_json::json!({
        "schema": "cruisefit.report/1",
        "tail": identity.tail,
        "aircraft": header.aircraft_type,
        "flight": identity.flight,
        "start": identity.start.to_string(),
        "zero_fuel_mass_kg": header.zero_fuel_mass.to_kilograms(),
        "fuel_on_board_kg": header.fuel_on_board.to_kilograms(),
        "samples": parsed.report.len(),
        "quantities": columns.iter().map(|column| serde_json::json!({
            "quantity": column.name,
            "least": column.figures[0],
            "mean": column.figures[1],
            "greatest": column.figures[2],
        })).collect::<Vec<_>>(),
        "findings": parsed.findings.iter().map(|finding| finding.message.clone()).collect::<Vec<_>>(),
    });
    Outcome::with_json(text, format!("{document:#}\n"))
}

struct Shown {
    name: &'static str,
    /// Least, mean, greatest.
    figures: [f64; 3],
}

fn columns(report: &Report) -> Vec<Shown> {
    let columns = report.columns();
    let total = (0..report.len()).map(|sample| columns.fuel_flow.total_kg_s(sample)).collect();
    let engines = match &columns.fuel_flow {
        FuelFlowColumns::PerEngine(engines) => engines.clone(),
        FuelFlowColumns::Total(_) => Vec::new(),
    };
    let optional = |values: &Option<Vec<f64>>| values.clone().unwrap_or_default();
    let n2 = columns.n2_percent.clone().unwrap_or_default().concat();
    [
        ("time, s", columns.time_s.clone()),
        ("pressure altitude, m", columns.pressure_altitude_m.clone()),
        ("static air temperature, K", optional(&columns.static_air_temperature_k)),
        ("Mach number", columns.mach.clone()),
        ("true airspeed, m/s", columns.true_airspeed_m_s.clone()),
        ("ground speed, m/s", columns.ground_speed_m_s.clone()),
        ("roll, deg", optional(&columns.roll_deg)),
        ("drift, deg", optional(&columns.drift_deg)),
        ("N2 of all engines, %", n2),
        ("total fuel flow, kg/s", total),
        ("fuel flow per engine, kg/s", engines.concat()),
        ("fuel used, kg", columns.fuel_used_kg.clone()),
    ]
    .into_iter()
    .filter(|(_, values)| !values.is_empty())
    .map(|(name, values)| Shown { name, figures: figures_of(&values) })
    .collect()
}

fn figures_of(values: &[f64]) -> [f64; 3] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [least, values.iter().sum::<f64>() / values.len() as f64, greatest]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_by_hand() {
        let wanted = [1.0, 3.0, 6.0].map(f64::to_bits);
        assert_eq!(figures_of(&[1.0, 2.0, 6.0]).map(f64::to_bits), wanted);
    }
}
