//! Gross mass along the track.

use flight::Report;
use units::Mass;

/// Gross mass in cruise from load sheet and fuel-used counter.
///
/// ```text
/// m = m_ZFW + m_FOB − m_FU
/// ```
///
/// Fuel on board is that at main engine start and fuel used counts from there, so it does not include fuel burnt by the
/// auxiliary power unit in flight.
///
/// # Source
/// `[steadiness.3]`; Ghazi et al. 2020, eq. (16).
#[must_use]
pub fn gross_mass(zero_fuel_mass: Mass, fuel_on_board: Mass, fuel_used: Mass) -> Mass {
    zero_fuel_mass + fuel_on_board - fuel_used
}

/// Gross mass of each sample, kg.
pub(crate) fn gross_mass_kg(report: &Report) -> Vec<f64> {
    let header = report.header();
    let of = |fuel_used_kg: &f64| {
        gross_mass(header.zero_fuel_mass, header.fuel_on_board, Mass::kilograms(*fuel_used_kg))
            .to_kilograms()
    };
    report.columns().fuel_used_kg.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_sample_of_the_format_s_example() {
        // The format's example report: ZFW 24 283 lb, FOB 7 219 lb, FU 1 353 lb: 30 149 lb.
        let mass = gross_mass(Mass::pounds(24_283.0), Mass::pounds(7_219.0), Mass::pounds(1_353.0));
        assert!((mass.to_pounds() - 30_149.0).abs() < 1e-9);
    }
}
