//! The air along the way: temperature, wind, and the slope of pressure surfaces that belongs to the wind.
//!
//! Fields are sums of plane waves in space, cut by the sphere: smooth, with exact gradients, and without a map
//! projection. A wave of the stream function makes a wind along its crests, so the wind has no divergence; in
//! geostrophic balance that same wind determines the slope of the pressure surface. The unbalanced part is a second,
//! smaller set of waves.

mod turbulence;

use core::f64::consts::TAU;

use flight::Timestamp;
use serde::{Deserialize, Serialize};
use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

use crate::random::Stream;
use crate::vector::{EARTH_RADIUS_M, Vector, combine, cross, dot, east_and_north};

pub use turbulence::Turbulence;
pub(crate) use turbulence::{DrydenFilters, Gusts, Patch, draw_patches, intensity_m_s};

/// Weather of a plan: the ranges of what is drawn for every flight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Weather {
    /// Mean over flights, and spread between flights, of the ISA deviation, K.
    pub isa_deviation_k: Spread,
    /// How much warmer than on the mean of the year it is on the warmest day at 45° latitude, K.
    #[serde(skip_serializing_if = "is_zero")]
    pub season_k: f64,
    /// Standard deviation along a flight of the ISA deviation, K.
    pub isa_deviation_field_k: f64,
    /// Mean over flights, and spread between them, of the eastward wind, m/s.
    pub wind_east_m_s: Spread,
    /// The same for the northward wind, m/s.
    pub wind_north_m_s: Spread,
    /// Standard deviation along a flight of each component of the wind, m/s.
    pub wind_field_m_s: f64,
    /// Share of that which is not geostrophic.
    pub ageostrophic_share: f64,
    /// Standard deviation of the slow vertical wind, m/s.
    pub vertical_wind_m_s: f64,
    /// Shortest and longest wave of temperature and wind, km.
    pub wavelengths_km: (f64, f64),
    /// Shortest and longest wave of the vertical wind, km.
    pub vertical_wavelengths_km: (f64, f64),
    /// Turbulence.
    pub turbulence: Turbulence,
}

/// A mean and a standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

impl Default for Weather {
    /// A quiet middle-latitude day, our choice: so quiet that a two-hour cruise gives about ten stabilised segments.
    fn default() -> Self {
        Self {
            isa_deviation_k: Spread { mean: 0.0, sd: 5.0 },
            season_k: 0.0,
            isa_deviation_field_k: 2.0,
            wind_east_m_s: Spread { mean: 12.0, sd: 9.0 },
            wind_north_m_s: Spread { mean: 0.0, sd: 8.0 },
            wind_field_m_s: 6.0,
            ageostrophic_share: 0.08,
            vertical_wind_m_s: 0.02,
            wavelengths_km: (300.0, 2500.0),
            vertical_wavelengths_km: (100.0, 400.0),
            turbulence: Turbulence::default(),
        }
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The warmest day of the northern year, days after its beginning: our choice, a month after the solstice.
const WARMEST_DAY: f64 = 202.0;

impl Weather {
    /// ISA deviation of the season, K: half a year later south of the equator, and none at it.
    ///
    /// ```text
    /// ΔT = A·(sin φ/sin 45°)·cos(2π (d − 202 d)/365.25 d)      [virtual.19]
    /// ```
    pub(crate) fn season_at(&self, start: Timestamp, latitude_rad: f64) -> f64 {
        if self.season_k == 0.0 {
            return 0.0;
        }
        // 1970 begins with a year: whole years of 365.25 days keep the phase within a day.
        let days = flight::seconds_since_1970(start) / SECONDS_PER_DAY;
        let phase = TAU * (days - WARMEST_DAY) / DAYS_PER_YEAR;
        self.season_k * latitude_rad.sin() * core::f64::consts::SQRT_2 * phase.cos()
    }

    /// Still air of the standard day.
    #[must_use]
    pub fn still() -> Self {
        let nothing = Spread { mean: 0.0, sd: 0.0 };
        Self {
            isa_deviation_k: nothing,
            isa_deviation_field_k: 0.0,
            wind_east_m_s: nothing,
            wind_north_m_s: nothing,
            wind_field_m_s: 0.0,
            ageostrophic_share: 0.0,
            vertical_wind_m_s: 0.0,
            turbulence: Turbulence::none(),
            ..Self::default()
        }
    }
}

/// The air at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Air {
    /// Horizontal wind, where the air goes to, m/s.
    pub(crate) wind_m_s: Vector,
    /// The part of it that balances the slope of the pressure surface, m/s.
    pub(crate) geostrophic_m_s: Vector,
    pub(crate) isa_deviation_k: f64,
    pub(crate) vertical_wind_m_s: f64,
}

impl Air {
    /// Linear between two.
    pub(crate) fn between(&self, next: &Self, share: f64) -> Self {
        let rest = 1.0 - share;
        Self {
            wind_m_s: combine(rest, self.wind_m_s, share, next.wind_m_s),
            geostrophic_m_s: combine(rest, self.geostrophic_m_s, share, next.geostrophic_m_s),
            isa_deviation_k: rest * self.isa_deviation_k + share * next.isa_deviation_k,
            vertical_wind_m_s: rest * self.vertical_wind_m_s + share * next.vertical_wind_m_s,
        }
    }
}

/// A plane wave: wave vector in radians per Earth radius, its inverse length, amplitude and phase.
#[derive(Clone, Copy, Debug)]
struct Wave {
    vector: Vector,
    inverse_length: f64,
    amplitude: f64,
    phase: f64,
}

/// The air of one flight.
#[derive(Clone, Debug)]
pub(crate) struct AirMass {
    mean_isa_deviation_k: f64,
    mean_east_m_s: f64,
    mean_north_m_s: f64,
    wind: Vec<Wave>,
    ageostrophic: Vec<Wave>,
    temperature: Vec<Wave>,
    vertical: Vec<Wave>,
}

const WIND_WAVES: usize = 20;
const AGEOSTROPHIC_WAVES: usize = 6;
const TEMPERATURE_WAVES: usize = 10;
const VERTICAL_WAVES: usize = 8;

impl AirMass {
    /// Draws the air about a point of the unit sphere, the middle of the route.
    pub(crate) fn draw(
        weather: &Weather,
        middle: Vector,
        start: Timestamp,
        random: &mut Stream,
    ) -> Self {
        let mut drawn = |spread: &Spread| spread.mean + spread.sd * random.normal();
        // The sphere's third coordinate is the sine of latitude.
        let season_k = weather.season_at(start, middle[2].clamp(-1.0, 1.0).asin());
        let mean_isa_deviation_k = drawn(&weather.isa_deviation_k) + season_k;
        let mean_east_m_s = drawn(&weather.wind_east_m_s);
        let mean_north_m_s = drawn(&weather.wind_north_m_s);
        let synoptic = weather.wavelengths_km;
        let share = weather.ageostrophic_share.clamp(0.0, 1.0);
        let balanced = weather.wind_field_m_s * (1.0 - share * share).sqrt();
        // A component of a vector wave of random direction has half of the wave's variance.
        let vector = core::f64::consts::SQRT_2;
        Self {
            mean_isa_deviation_k,
            mean_east_m_s,
            mean_north_m_s,
            wind: draw_waves(WIND_WAVES, synoptic, balanced * vector, middle, random),
            ageostrophic: draw_waves(
                AGEOSTROPHIC_WAVES,
                synoptic,
                weather.wind_field_m_s * share * vector,
                middle,
                random,
            ),
            temperature: draw_waves(
                TEMPERATURE_WAVES,
                synoptic,
                weather.isa_deviation_field_k,
                middle,
                random,
            ),
            vertical: draw_waves(
                VERTICAL_WAVES,
                weather.vertical_wavelengths_km,
                weather.vertical_wind_m_s,
                middle,
                random,
            ),
        }
    }

    /// ISA deviation without its field, K.
    pub(crate) const fn mean_isa_deviation_k(&self) -> f64 {
        self.mean_isa_deviation_k
    }

    /// The air at a point of the unit sphere.
    pub(crate) fn at(&self, position: Vector) -> Air {
        let (east, north) = east_and_north(position);
        let mut geostrophic = combine(self.mean_east_m_s, east, self.mean_north_m_s, north);
        for wave in &self.wind {
            // Along the crests: up × gradient. The cross product drops what of the wave vector points up.
            let strength = wave.strength(position) * wave.inverse_length;
            geostrophic = combine(1.0, geostrophic, strength, cross(position, wave.vector));
        }
        let mut wind = geostrophic;
        for wave in &self.ageostrophic {
            // Across the crests, tangent to the sphere.
            let strength = wave.strength(position) * wave.inverse_length;
            let tangent = combine(1.0, wave.vector, -dot(wave.vector, position), position);
            wind = combine(1.0, wind, strength, tangent);
        }
        let sum = |waves: &[Wave]| waves.iter().map(|wave| wave.strength(position)).sum::<f64>();
        Air {
            wind_m_s: wind,
            geostrophic_m_s: geostrophic,
            isa_deviation_k: self.mean_isa_deviation_k + sum(&self.temperature),
            vertical_wind_m_s: sum(&self.vertical),
        }
    }
}

impl Wave {
    fn strength(&self, position: Vector) -> f64 {
        self.amplitude * (dot(self.vector, position) + self.phase).sin()
    }
}

/// Waves of random direction and phase whose sum is a Gaussian field of a standard deviation. Amplitudes grow with
/// wavelength, as those of a k⁻³ spectrum: then every octave has the same share of the gradient.
fn draw_waves(
    count: usize,
    (shortest_km, longest_km): (f64, f64),
    standard_deviation: f64,
    middle: Vector,
    random: &mut Stream,
) -> Vec<Wave> {
    if standard_deviation <= 0.0 {
        return Vec::new();
    }
    let (east, north) = east_and_north(middle);
    let ratio = longest_km / shortest_km;
    let lengths_km: Vec<f64> = (0..count)
        .map(|i| shortest_km * ratio.powf((i as f64 + random.unit()) / count as f64))
        .collect();
    let total: f64 = lengths_km.iter().map(|length| length * length).sum();
    lengths_km
        .iter()
        .map(|length_km| {
            let radians_per_radius = TAU * EARTH_RADIUS_M / (1000.0 * length_km);
            let (sine, cosine) = random.uniform(0.0, TAU).sin_cos();
            // Rayleigh amplitude and uniform phase: Gaussian sine and cosine coefficients.
            let rayleigh = random.normal().hypot(random.normal());
            Wave {
                vector: combine(
                    radians_per_radius * sine,
                    east,
                    radians_per_radius * cosine,
                    north,
                ),
                inverse_length: 1.0 / radians_per_radius,
                amplitude: standard_deviation * length_km / total.sqrt() * rayleigh,
                phase: random.uniform(0.0, TAU),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, Streams};
    use crate::vector::Place;

    fn flights(weather: &Weather, count: usize, mut each: impl FnMut(&AirMass, Place)) {
        for flight in 0..count {
            let mut random = Streams::of_flight(7, "weather", flight).stream(Purpose::Weather);
            let middle = Place::at(45.0, 10.0, 60.0);
            let air = AirMass::draw(weather, middle.position, Timestamp::UNIX_EPOCH, &mut random);
            each(&air, middle);
        }
    }

    #[test]
    fn means_and_standard_deviations_are_those_asked_for() {
        let weather = Weather::default();
        let mut sums = [0.0; 6];
        let mut squares = [0.0; 6];
        let n = 4000;
        flights(&weather, n, |air, middle| {
            let here = air.at(middle.position);
            let (east, north) = east_and_north(middle.position);
            let values = [
                here.isa_deviation_k,
                dot(here.wind_m_s, east),
                dot(here.wind_m_s, north),
                here.vertical_wind_m_s,
                dot(combine(1.0, here.wind_m_s, -1.0, here.geostrophic_m_s), east),
                dot(here.wind_m_s, middle.position),
            ];
            for ((sum, square), value) in sums.iter_mut().zip(&mut squares).zip(values) {
                *sum += value / n as f64;
                *square += value * value / n as f64;
            }
        });
        // Asked for: spread between flights and field along them add as variances.
        let expected = [
            (0.0, (25.0_f64 + 4.0).sqrt()),
            (12.0, (81.0_f64 + 36.0).sqrt()),
            (0.0, (64.0_f64 + 36.0).sqrt()),
            (0.0, 0.02),
            (0.0, 0.08 * 6.0),
            (0.0, 0.0),
        ];
        for (k, (mean, sd)) in expected.into_iter().enumerate() {
            let found = (squares[k] - sums[k] * sums[k]).max(0.0).sqrt();
            // Four standard errors of a mean of 4000, and as much again for the heavier tails of a sum of few waves.
            assert!((sums[k] - mean).abs() <= 0.07 * sd + 1e-12, "{k}: mean {}", sums[k]);
            assert!((found - sd).abs() <= 0.06 * sd + 1e-12, "{k}: sd {found} asked {sd}");
        }
    }

    #[test]
    fn the_field_is_smooth_on_the_scale_of_its_shortest_wave() {
        // Mean square of the difference over 20 km against that of the shortest wave alone, 300 km: far below it.
        let weather = Weather { vertical_wind_m_s: 0.0, ..Weather::default() };
        let (mut difference, mut n) = (0.0, 0.0);
        flights(&weather, 300, |air, middle| {
            let a = air.at(middle.position);
            let b = air.at(middle.ahead(20_000.0).position);
            let gap = dot(combine(1.0, b.wind_m_s, -1.0, a.wind_m_s), middle.along);
            difference += gap * gap;
            n += 1.0;
        });
        let rms = (difference / n).sqrt();
        let shortest_alone = 6.0 * TAU * 20.0 / 300.0;
        assert!(rms > 0.0 && rms < 0.3 * shortest_alone, "{rms} {shortest_alone}");
    }

    #[test]
    fn balanced_wind_has_no_divergence() {
        // By differences over 1 km: ∂u/∂x + ∂v/∂y far below either.
        let weather = Weather {
            wind_east_m_s: Spread { mean: 0.0, sd: 0.0 },
            wind_north_m_s: Spread { mean: 0.0, sd: 0.0 },
            ageostrophic_share: 0.0,
            ..Weather::default()
        };
        flights(&weather, 20, |air, middle| {
            let h = 1000.0;
            let rate = |place: Place| {
                let (fore, aft) = (place.ahead(h), place.ahead(-h));
                (dot(air.at(fore.position).wind_m_s, fore.along)
                    - dot(air.at(aft.position).wind_m_s, aft.along))
                    / (2.0 * h)
            };
            let along = rate(middle);
            let across = rate(middle.turned(core::f64::consts::FRAC_PI_2));
            assert!((along + across).abs() < 1e-3 * along.abs() + 1e-10, "{along} {across}");
        });
    }
}
