//! Dryden turbulence: gust filters that are exact in discrete time, and the patches in which they run.

use serde::{Deserialize, Serialize};

use crate::random::Stream;

/// Scale of turbulence above 2 000 ft, 1 750 ft, for all three gusts. Source: MIL-F-8785C, section 3.7.3.1.
pub(crate) const SCALE_M: f64 = 1750.0 * units::convert::METERS_PER_FOOT;

/// Where turbulence occurs and how strong it is. A plan's `turbulence`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Turbulence {
    /// Light patches per hour of flight.
    pub light_patches_per_h: f64,
    /// Moderate patches per hour of flight.
    pub moderate_patches_per_h: f64,
    /// Mean length of a patch, min.
    pub mean_patch_min: f64,
    /// Standard deviation of a light gust, m/s.
    pub light_m_s: f64,
    /// Standard deviation of a moderate gust, m/s.
    pub moderate_m_s: f64,
    /// Standard deviation of the gusts everywhere else, m/s.
    pub elsewhere_m_s: f64,
}

impl Default for Turbulence {
    /// Gusts of 5.0 and 8.1 ft/s: the curves of probability 1e-3 and 1e-4 at 35 000 ft of MIL-F-8785C, figure 7, as
    /// tabulated in JSBSim's `FGWinds`. Their frequency is our choice.
    fn default() -> Self {
        Self {
            light_patches_per_h: 0.25,
            moderate_patches_per_h: 0.03,
            mean_patch_min: 6.0,
            light_m_s: 5.0 * units::convert::METERS_PER_FOOT,
            moderate_m_s: 8.1 * units::convert::METERS_PER_FOOT,
            elsewhere_m_s: 0.0,
        }
    }
}

impl Turbulence {
    /// No turbulence.
    #[must_use]
    pub fn none() -> Self {
        Self {
            light_patches_per_h: 0.0,
            moderate_patches_per_h: 0.0,
            elsewhere_m_s: 0.0,
            ..Self::default()
        }
    }
}

/// Gusts, m/s: head-on (raises the airspeed), from the left (pushes to the right), and upwards.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[expect(clippy::struct_field_names, reason = "the unit is in the name")]
pub(crate) struct Gusts {
    pub(crate) head_on_m_s: f64,
    pub(crate) from_left_m_s: f64,
    pub(crate) upward_m_s: f64,
}

/// Gust filters with their states, of unit standard deviation.
///
/// ```text
/// longitudinal   H(s) = σ·√(2L/(πV))·1/(1 + sL/V)
/// transverse     H(s) = σ·√(L/(πV))·(1 + √3·sL/V)/(1 + sL/V)²       [virtual.15]
/// ```
///
/// In time made dimensionless by L/V both are linear systems driven by white noise, so a step of any length has an exact
/// transition and an exact covariance: nothing is lost to a step of 1 s.
///
/// # Source
/// MIL-F-8785C, section 3.7.1.2, Dryden form; MIL-HDBK-1797, appendix A.
#[derive(Clone, Debug)]
pub(crate) struct DrydenFilters {
    step: StepMatrices,
    longitudinal: f64,
    lateral: [f64; 2],
    vertical: [f64; 2],
}

/// Transition and noise of one step h = V·dt/L.
#[derive(Clone, Copy, Debug)]
struct StepMatrices {
    length: f64,
    decay: f64,
    longitudinal_noise: f64,
    /// Cholesky factor of the covariance of the transverse states: q11, q21, q22.
    transverse_noise: [f64; 3],
}

impl StepMatrices {
    /// States y1' = −y1 + ξ, y2' = −y2 + y1: covariance of a step by integration of e^−2u·(1, u, u²).
    fn new(length: f64) -> Self {
        let decay = (-length).exp();
        let squared = decay * decay;
        let q11 = (1.0 - squared) / 2.0;
        let q12 = (1.0 - squared * (1.0 + 2.0 * length)) / 4.0;
        let q22 = (1.0 - squared * (1.0 + 2.0 * length + 2.0 * length * length)) / 4.0;
        let l11 = q11.max(0.0).sqrt();
        let l21 = if l11 > 0.0 { q12 / l11 } else { 0.0 };
        let l22 = (q22 - l21 * l21).max(0.0).sqrt();
        Self {
            length,
            decay,
            longitudinal_noise: (1.0 - squared).sqrt(),
            transverse_noise: [l11, l21, l22],
        }
    }

    fn transverse(&self, state: &mut [f64; 2], random: &mut Stream) {
        let [l11, l21, l22] = self.transverse_noise;
        let (first, second) = (random.normal(), random.normal());
        let old = *state;
        state[0] = self.decay * old[0] + l11 * first;
        state[1] = self.decay * (old[1] + self.length * old[0]) + l21 * first + l22 * second;
    }
}

const SQRT_3: f64 = 1.732_050_807_568_877_2;

impl DrydenFilters {
    /// In their stationary distribution, for an airspeed and a time step.
    pub(crate) fn new(true_airspeed_m_s: f64, step_s: f64, random: &mut Stream) -> Self {
        let stationary = StepMatrices::new(50.0);
        let mut filters = Self {
            step: StepMatrices::new(true_airspeed_m_s * step_s / SCALE_M),
            longitudinal: random.normal(),
            lateral: [0.0; 2],
            vertical: [0.0; 2],
        };
        stationary.transverse(&mut filters.lateral, random);
        stationary.transverse(&mut filters.vertical, random);
        filters
    }

    /// One step later; the gusts of unit standard deviation.
    pub(crate) fn advance(&mut self, random: &mut Stream) -> Gusts {
        self.longitudinal =
            self.step.decay * self.longitudinal + self.step.longitudinal_noise * random.normal();
        let step = self.step;
        step.transverse(&mut self.lateral, random);
        step.transverse(&mut self.vertical, random);
        // (1 + √3·s)/(1 + s)² = √3/(1 + s) + (1 − √3)/(1 + s)².
        let gust = |state: [f64; 2]| SQRT_3 * state[0] + (1.0 - SQRT_3) * state[1];
        Gusts {
            head_on_m_s: self.longitudinal,
            from_left_m_s: gust(self.lateral),
            upward_m_s: gust(self.vertical),
        }
    }
}

/// A stretch of time with turbulence.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_field_names, reason = "the unit is in the name")]
pub(crate) struct Patch {
    pub(crate) from_s: f64,
    pub(crate) to_s: f64,
    pub(crate) sigma_m_s: f64,
}

/// Seconds over which a patch builds up and decays.
const PATCH_EDGE_S: f64 = 30.0;

/// Patches of a flight in order, drawn as a Poisson process in time.
pub(crate) fn draw_patches(
    turbulence: &Turbulence,
    duration_s: f64,
    random: &mut Stream,
) -> Vec<Patch> {
    let mut patches = Vec::new();
    for (per_h, sigma_m_s) in [
        (turbulence.light_patches_per_h, turbulence.light_m_s),
        (turbulence.moderate_patches_per_h, turbulence.moderate_m_s),
    ] {
        if per_h <= 0.0 || sigma_m_s <= 0.0 {
            continue;
        }
        let mut from_s = random.exponential(3600.0 / per_h);
        while from_s < duration_s {
            let to_s = from_s + 60.0 + random.exponential(60.0 * turbulence.mean_patch_min);
            patches.push(Patch { from_s, to_s, sigma_m_s });
            from_s = to_s + random.exponential(3600.0 / per_h);
        }
    }
    patches.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
    patches
}

/// Standard deviation of the gusts at a time: the largest of the patches there, with soft edges.
pub(crate) fn intensity_m_s(patches: &[Patch], elsewhere_m_s: f64, time_s: f64) -> f64 {
    patches.iter().take_while(|patch| patch.from_s <= time_s).fold(
        elsewhere_m_s,
        |largest, patch| {
            let inside =
                ((time_s - patch.from_s).min(patch.to_s - time_s) / PATCH_EDGE_S).clamp(0.0, 1.0);
            largest.max(patch.sigma_m_s * inside * inside * (3.0 - 2.0 * inside))
        },
    )
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use core::f64::consts::PI;

    use super::*;
    use crate::random::{Purpose, Streams};

    /// The standard's one-sided spectra over spatial frequency Ω, integrating to σ² over 0..∞ (σ = 1).
    fn longitudinal_spectrum(omega: f64) -> f64 {
        2.0 * SCALE_M / PI / (1.0 + (SCALE_M * omega).powi(2))
    }

    fn transverse_spectrum(omega: f64) -> f64 {
        let squared = (SCALE_M * omega).powi(2);
        SCALE_M / PI * (1.0 + 3.0 * squared) / (1.0 + squared).powi(2)
    }

    /// Averaged periodogram at a frequency, one-sided over Ω, for Hann-windowed pieces.
    fn periodogram(gusts: &[f64], piece: usize, bin: usize, spacing_m: f64) -> f64 {
        let mut sum = 0.0;
        let mut pieces = 0.0;
        for chunk in gusts.chunks_exact(piece) {
            let (mut re, mut im, mut power) = (0.0, 0.0, 0.0);
            for (i, gust) in chunk.iter().enumerate() {
                let window = 0.5 - 0.5 * (2.0 * PI * i as f64 / piece as f64).cos();
                let (sine, cosine) = (2.0 * PI * (bin * i) as f64 / piece as f64).sin_cos();
                re += window * gust * cosine;
                im += window * gust * sine;
                power += window * window;
            }
            sum += (re * re + im * im) / power * spacing_m / PI;
            pieces += 1.0;
        }
        sum / pieces
    }

    #[test]
    fn spectra_are_those_of_the_standard() {
        // Steps of 0.1 s so that folding is small at the frequencies compared.
        let (airspeed_m_s, step_s) = (240.0, 0.1);
        let mut random = Streams::of_flight(1, "spectrum", 0).stream(Purpose::Gusts);
        let mut filters = DrydenFilters::new(airspeed_m_s, step_s, &mut random);
        let gusts: Vec<Gusts> = (0..400_000).map(|_| filters.advance(&mut random)).collect();
        let spacing_m = airspeed_m_s * step_s;
        let piece = 1000;
        for channel in 0..3 {
            let pick = |g: &Gusts| [g.head_on_m_s, g.from_left_m_s, g.upward_m_s][channel];
            let spectrum = |omega: f64| {
                if channel == 0 { longitudinal_spectrum(omega) } else { transverse_spectrum(omega) }
            };
            let series: Vec<f64> = gusts.iter().map(pick).collect();
            let variance = series.iter().map(|g| g * g).sum::<f64>() / series.len() as f64;
            assert!((variance - 1.0).abs() < 0.05, "channel {channel}: variance {variance}");
            for bin in [5, 8, 12, 20, 40, 80] {
                let omega = 2.0 * PI * bin as f64 / (piece as f64 * spacing_m);
                // 400 pieces: 5 % standard error; a Hann window has 1.5 bins of bandwidth.
                let ratio = periodogram(&series, piece, bin, spacing_m) / spectrum(omega);
                assert!((0.82..1.22).contains(&ratio), "channel {channel}, bin {bin}: {ratio}");
            }
        }
    }

    #[test]
    fn variance_does_not_depend_on_the_step() {
        // Closed form of the standard: σ² = ∫Φ dΩ = 1, for a step of 1 s as for 0.1 s.
        let mut random = Streams::of_flight(2, "variance", 0).stream(Purpose::Gusts);
        let mut filters = DrydenFilters::new(240.0, 1.0, &mut random);
        let (mut sum, n) = ([0.0; 3], 200_000);
        for _ in 0..n {
            let g = filters.advance(&mut random);
            for (s, v) in sum.iter_mut().zip([g.head_on_m_s, g.from_left_m_s, g.upward_m_s]) {
                *s += v * v / f64::from(n);
            }
        }
        for variance in sum {
            assert!((variance - 1.0).abs() < 0.02, "{variance}");
        }
    }

    #[test]
    fn patches_come_as_often_as_asked_and_have_soft_edges() {
        let turbulence = Turbulence {
            light_patches_per_h: 1.0,
            moderate_patches_per_h: 0.0,
            ..Turbulence::default()
        };
        let mut random = Streams::of_flight(3, "patches", 0).stream(Purpose::Patches);
        let hours = 4000.0;
        let patches = draw_patches(&turbulence, 3600.0 * hours, &mut random);
        // Poisson with dead time: gaps of 60 min, patches of 1 + 6 min, so one in 67 min.
        let expected = hours * 60.0 / 67.0;
        assert!(
            (patches.len() as f64 - expected).abs() < 4.0 * expected.sqrt(),
            "{}",
            patches.len()
        );
        let patch = Patch { from_s: 100.0, to_s: 500.0, sigma_m_s: 2.0 };
        assert_eq!(intensity_m_s(&[patch], 0.0, 100.0), 0.0);
        assert_eq!(intensity_m_s(&[patch], 0.0, 300.0), 2.0);
        assert_eq!(intensity_m_s(&[patch], 0.0, 501.0), 0.0);
        assert!((intensity_m_s(&[patch], 0.0, 115.0) - 1.0).abs() < 1e-12);
    }
}
