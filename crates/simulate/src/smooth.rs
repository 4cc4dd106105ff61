//! Smooth errors of the whole truth: every real aircraft has them, and no named effect describes them.

use core::f64::consts::TAU;

use crate::random::Stream;

/// Relative errors of drag and fuel flow as smooth random functions of Mach number, lift coefficient and pressure altitude.
#[derive(Clone, Debug)]
pub(crate) struct SmoothErrors {
    drag: Vec<Ripple>,
    fuel: Vec<Ripple>,
}

#[derive(Clone, Copy, Debug)]
struct Ripple {
    vector: [f64; 3],
    phase: f64,
    amplitude: f64,
}

/// Number of ripples of one function.
const RIPPLES: usize = 10;
/// Center and scale of Mach number, lift coefficient and pressure altitude, m: about the spread of cruise flights.
const CENTERS: [f64; 3] = [0.80, 0.33, 12_000.0];
const SCALES: [f64; 3] = [0.08, 0.08, 1_800.0];

impl SmoothErrors {
    /// Draws both functions, of given standard deviations.
    pub(crate) fn draw(drag_relative: f64, fuel_relative: f64, random: &mut Stream) -> Self {
        Self { drag: ripples(drag_relative, random), fuel: ripples(fuel_relative, random) }
    }

    /// Relative errors of drag and of fuel flow.
    pub(crate) fn at(
        &self,
        mach: f64,
        lift_coefficient: f64,
        pressure_altitude_m: f64,
    ) -> (f64, f64) {
        let scaled = [
            (mach - CENTERS[0]) / SCALES[0],
            (lift_coefficient - CENTERS[1]) / SCALES[1],
            (pressure_altitude_m - CENTERS[2]) / SCALES[2],
        ];
        (sum(&self.drag, scaled), sum(&self.fuel, scaled))
    }
}

fn ripples(standard_deviation: f64, random: &mut Stream) -> Vec<Ripple> {
    if standard_deviation <= 0.0 {
        return Vec::new();
    }
    (0..RIPPLES)
        .map(|_| Ripple {
            vector: [random.normal(), random.normal(), random.normal()],
            phase: random.uniform(0.0, TAU),
            // A cosine of random phase has variance ½; Gaussian amplitudes of variance 2/n sum to 1.
            amplitude: standard_deviation * (2.0 / RIPPLES as f64).sqrt() * random.normal(),
        })
        .collect()
}

fn sum(ripples: &[Ripple], at: [f64; 3]) -> f64 {
    ripples
        .iter()
        .map(|ripple| {
            let [a, b, c] = ripple.vector;
            ripple.amplitude * (a * at[0] + b * at[1] + c * at[2] + ripple.phase).cos()
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, Streams};

    #[test]
    fn spread_is_that_asked_for() {
        let (mut drag, mut fuel, n) = (0.0, 0.0, 3000);
        for tail in 0..n {
            let mut random = Streams::of_flight(1, "smooth", tail).stream(Purpose::SmoothErrors);
            let errors = SmoothErrors::draw(0.0025, 0.0050, &mut random);
            let (d, f) = errors.at(0.77, 0.41, 11_300.0);
            drag += d * d / n as f64;
            fuel += f * f / n as f64;
        }
        assert!((drag.sqrt() / 0.0025 - 1.0).abs() < 0.06, "{}", drag.sqrt());
        assert!((fuel.sqrt() / 0.0050 - 1.0).abs() < 0.06, "{}", fuel.sqrt());
    }
}
