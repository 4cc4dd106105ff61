//! Ground speed and angles against position and heading.

use core::f64::consts::PI;
use flight::column::Column;

use flight::{Report, Severity};
use units::convert::{METERS_PER_SECOND_PER_KNOT, RADIANS_PER_DEGREE};

use super::air::believed_true_airspeed_m_s;
use super::slips::{self, SPEED};
use super::{Draft, mean};

/// Mean radius of the earth, m (IUGG: (2a + b)/3 of WGS 84). A sphere is within 0.5 % of the ellipsoid.
const EARTH_RADIUS_M: f64 = 6_371_008.8;
/// Positions are compared over steps at least this long, s: rounding to 0.01° is 0.7 km, 1.5 % of what is flown.
const STEP_S: f64 = 300.0;
/// Way flown over great circle up to which a step is straight.
const STRAIGHT: f64 = 1.02;
/// Fewest straight steps from which anything is said.
const FEWEST_LEGS: usize = 3;
/// Longest step over which a track is taken as straight, s.
const LONGEST_STEP_S: f64 = 1200.0;
/// Difference of ground speed from the positions' worth a word.
const WARNING_SHARE: f64 = 0.06;
const SERIOUS_SHARE: f64 = 0.15;
/// Mean wind along a cruise that no jet stream has, kt.
const STRONGEST_WIND_KT: f64 = 180.0;
/// How far a wind may move the ratio of ground speed to true airspeed from that of a slip.
const BLURRED_BY_WIND: f64 = 0.25;
/// Angles are judged where the drift is larger than this on average, degrees.
const SMALLEST_DRIFT_DEG: f64 = 1.5;
/// Residual of track − heading − drift that is a wrong angle rather than rounding, degrees.
const WRONG_ANGLE_DEG: f64 = 3.0;
/// Residual of an angle that is right: positions are rounded, and the wind changes between them, degrees.
const RIGHT_ANGLE_DEG: f64 = 1.5;
/// How much more one sign of the drift may leave than the other where the drift hardly changes and both leave noise.
const SAME_SCATTER: f64 = 1.25;
/// Rolls that turn an aircraft, degrees.
const TURNING_ROLL_DEG: f64 = 5.0;

/// Code of the finding that ground speed is not that of the positions.
pub(super) const AGAINST_POSITION: &str = "ground-speed-against-position";

pub(super) fn check(report: &Report) -> Vec<Draft> {
    let legs = legs(report);
    let wind = wind(report);
    [speed(report, &legs, wind), drift(report, &legs), roll(report)].into_iter().flatten().collect()
}

/// A straight step between two positions.
struct Leg {
    first: usize,
    last: usize,
    speed_m_s: f64,
    track_deg: f64,
}

/// The straight steps; none where they are too few to say anything.
fn legs(report: &Report) -> Vec<Leg> {
    let columns = report.columns();
    let (Some(latitudes), Some(longitudes)) =
        (columns.optional.get(Column::Latitude), columns.optional.get(Column::Longitude))
    else {
        return Vec::new();
    };
    let position =
        |sample: usize| Some(Position::of_degrees(latitudes[sample]?, longitudes[sample]?));
    let mut legs = Vec::new();
    let mut begun: Option<(usize, Position)> = None;
    for sample in 0..report.len() {
        let recorded = latitudes[sample].is_some() && longitudes[sample].is_some();
        let seconds =
            begun.map_or(0.0, |(first, _)| columns.time_s[sample] - columns.time_s[first]);
        if !recorded || begun.is_some() && seconds < STEP_S {
            continue;
        }
        let Some(to) = position(sample) else { continue };
        if let Some((first, from)) = begun.replace((sample, to))
            && seconds < LONGEST_STEP_S
        {
            let distance_m = from.distance_m(to);
            let between = [1, 2, 3].map(|quarter| first + (sample - first) * quarter / 4);
            let way =
                [Some(from), position(between[0]), position(between[1]), position(between[2])];
            if is_straight(way.into_iter().flatten().chain([to]), distance_m) {
                let (speed_m_s, track_deg) = (distance_m / seconds, from.course_deg(to));
                legs.push(Leg { first, last: sample, speed_m_s, track_deg });
            }
        }
    }
    if legs.len() < FEWEST_LEGS { Vec::new() } else { legs }
}

/// Whether the way over these positions is hardly longer than the great circle between its ends.
fn is_straight(mut way: impl Iterator<Item = Position>, distance_m: f64) -> bool {
    let Some(mut from) = way.next() else { return false };
    let mut way_m = 0.0;
    for to in way {
        way_m += from.distance_m(to);
        from = to;
    }
    way_m <= STRAIGHT * distance_m
}

/// A position on a sphere.
#[derive(Clone, Copy)]
struct Position {
    latitude: f64,
    longitude_deg: f64,
    cosine_of_latitude: f64,
}

impl Position {
    fn of_degrees(latitude_deg: f64, longitude_deg: f64) -> Self {
        let latitude = latitude_deg * RADIANS_PER_DEGREE;
        Self { latitude, longitude_deg, cosine_of_latitude: latitude.cos() }
    }

    /// Change of longitude to another position, radians.
    fn longitude_to(self, to: Self) -> f64 {
        (to.longitude_deg - self.longitude_deg) * RADIANS_PER_DEGREE
    }

    /// Distance along the great circle, m.
    fn distance_m(self, to: Self) -> f64 {
        let haversine = (0.5 * (to.latitude - self.latitude)).sin().powi(2)
            + self.cosine_of_latitude
                * to.cosine_of_latitude
                * (0.5 * self.longitude_to(to)).sin().powi(2);
        2.0 * EARTH_RADIUS_M * haversine.sqrt().clamp(0.0, 1.0).asin()
    }

    /// Initial course along the great circle, degrees.
    fn course_deg(self, to: Self) -> f64 {
        let longitude = self.longitude_to(to);
        let course = f64::atan2(
            longitude.sin() * to.cosine_of_latitude,
            self.cosine_of_latitude * to.latitude.sin()
                - self.latitude.sin() * to.cosine_of_latitude * longitude.cos(),
        );
        course / RADIANS_PER_DEGREE
    }
}

/// An angle brought to -180 to 180 degrees.
fn wrapped(angle_deg: f64) -> f64 {
    let turns = (angle_deg * RADIANS_PER_DEGREE + PI).rem_euclid(2.0 * PI) - PI;
    turns / RADIANS_PER_DEGREE
}

/// Mean speed of the wind that ground speed, true airspeed and drift give, kt, and ground over true airspeed.
fn wind(report: &Report) -> (f64, f64) {
    let columns = report.columns();
    let (ground, air) = (&columns.ground_speed_m_s, &believed_true_airspeed_m_s(report)[..]);
    let wind = |ground: f64, air: f64, cosine_of_drift: f64| {
        let squared = ground * ground + air * air - 2.0 * ground * air * cosine_of_drift;
        squared.max(0.0).sqrt() / METERS_PER_SECOND_PER_KNOT
    };
    let winds = match &columns.drift_deg {
        None => mean(ground.iter().zip(air).map(|(ground, air)| wind(*ground, *air, 1.0))),
        Some(drift_deg) => {
            let speeds = ground.iter().zip(air).zip(drift_deg);
            mean(speeds.map(|((ground, air), drift)| {
                wind(*ground, *air, (drift * RADIANS_PER_DEGREE).cos())
            }))
        }
    };
    let ratios = mean(ground.iter().zip(air).map(|(ground, air)| ground / air));
    (winds.unwrap_or(0.0), ratios.unwrap_or(1.0))
}

fn speed(report: &Report, legs: &[Leg], (wind_kt, over_air): (f64, f64)) -> Option<Draft> {
    let columns = report.columns();
    let by_position = mean(legs.iter().map(|leg| {
        let samples = &columns.ground_speed_m_s[leg.first..=leg.last];
        mean(samples.iter().copied()).unwrap_or(0.0) / leg.speed_m_s.max(1.0)
    }));
    if let Some(ratio) = by_position
        && (ratio - 1.0).abs() > WARNING_SHARE
    {
        let slip = slips::find(&SPEED, ratio);
        let serious = (ratio - 1.0).abs() > SERIOUS_SHARE;
        return Some(Draft {
            severity: if serious { Severity::Serious } else { Severity::Warning },
            code: AGAINST_POSITION,
            size: ratio,
            unit: "-",
            message: format!("ground speed is {ratio:.3} of the speed at which the positions move"),
            likely_cause: slip.map_or_else(
                || "LAT and LON swapped or in another unit, TIME in another unit, or GSPD another speed".to_owned(),
                |slip| format!("GSPD: {}", slip.cause),
            ),
            remedy: slip.map_or_else(
                || "compare GSPD, LAT, LON and TIME with the recorder's list".to_owned(),
                |slip| format!("GSPD: {}", slip.remedy),
            ),
        });
    }
    if wind_kt < STRONGEST_WIND_KT {
        return None;
    }
    // Without positions the wind itself blurs the ratio: the nearest slip is the best guess.
    let slip = slips::find_within(&SPEED, over_air, BLURRED_BY_WIND);
    Some(Draft {
        severity: Severity::Serious,
        code: "wind-impossible",
        size: wind_kt,
        unit: "kt",
        message: format!(
            "ground speed, true airspeed and drift make a mean wind of {wind_kt:.0} kt (ground speed {over_air:.2} of true airspeed)"
        ),
        likely_cause: slip.map_or_else(
            || "GSPD, VTAS or DRIFT is in another unit".to_owned(),
            |slip| format!("GSPD: {}", slip.cause),
        ),
        remedy: "compare the units of GSPD, VTAS and DRIFT with the recorder's list".to_owned(),
    })
}

/// Track from the positions less heading and drift, by either sign of the drift.
fn drift(report: &Report, legs: &[Leg]) -> Option<Draft> {
    let columns = report.columns();
    let headings = columns.optional.get(Column::TrueHeading)?;
    let drifts = columns.drift_deg.as_ref()?;
    let (mut as_declared, mut as_negated, mut sizes) = (Vec::new(), Vec::new(), Vec::new());
    let (mut left_declared, mut left_negated) = (Vec::new(), Vec::new());
    for leg in legs {
        let middle = usize::midpoint(leg.first, leg.last);
        let Some(heading) = headings[middle] else { continue };
        let crab = wrapped(leg.track_deg - heading);
        let drift = drifts[middle];
        left_declared.push(wrapped(crab - drift));
        left_negated.push(wrapped(crab + drift));
        as_declared.push(wrapped(crab - drift).abs());
        as_negated.push(wrapped(crab + drift).abs());
        sizes.push(drift.abs());
    }
    let (declared, negated, size) = (mean(as_declared)?, mean(as_negated)?, mean(sizes)?);
    if declared < WRONG_ANGLE_DEG || size < SMALLEST_DRIFT_DEG {
        return None;
    }
    // An angle that is added to the heading is left on every leg, whatever the drift; with the other sign nothing is left.
    let (scatter_declared, scatter_negated) = (spread(&left_declared), spread(&left_negated));
    let is_sign = negated < 0.5 * declared
        && negated < scatter_declared.max(RIGHT_ANGLE_DEG)
        && scatter_negated < SAME_SCATTER * scatter_declared;
    Some(Draft {
        severity: Severity::Warning,
        code: if is_sign { "drift-sign" } else { "heading-against-track" },
        size: declared,
        unit: "deg",
        message: format!(
            "track from the positions less heading is {declared:.1}° off the drift angle, {negated:.1}° with its sign reversed"
        ),
        likely_cause: if is_sign {
            "DRIFT is heading minus track (positive to the left)".to_owned()
        } else {
            "HDG is magnetic, or holds the track".to_owned()
        },
        remedy: if is_sign {
            "DRIFT: scale -1 (track minus heading)".to_owned()
        } else {
            "map HDG to true heading".to_owned()
        },
    })
}

/// Mean distance from the mean angle; the angles are near each other.
fn spread(angles_deg: &[f64]) -> f64 {
    let Some(&first) = angles_deg.first() else { return 0.0 };
    let from_first = || angles_deg.iter().map(|angle| wrapped(angle - first));
    let middle = mean(from_first()).unwrap_or(0.0);
    mean(from_first().map(|angle| (angle - middle).abs())).unwrap_or(0.0)
}

/// Turns in the direction opposite to the roll.
fn roll(report: &Report) -> Option<Draft> {
    let columns = report.columns();
    let headings = columns.optional.get(Column::TrueHeading)?;
    let rolls = columns.roll_deg.as_ref()?;
    let (mut agreeing, mut opposed) = (0_u32, 0_u32);
    for sample in 1..report.len().saturating_sub(1) {
        let (Some(before), Some(after)) = (headings[sample - 1], headings[sample + 1]) else {
            continue;
        };
        if rolls[sample].abs() < TURNING_ROLL_DEG {
            continue;
        }
        let turned = wrapped(after - before);
        if turned.abs() < 1.0 {
            continue;
        }
        if (turned > 0.0) == (rolls[sample] > 0.0) { agreeing += 1 } else { opposed += 1 }
    }
    if opposed < 3 || opposed < 4 * agreeing {
        return None;
    }
    Some(Draft {
        severity: Severity::Warning,
        code: "roll-sign",
        size: f64::from(opposed),
        unit: "samples",
        message: format!(
            "in {opposed} of {} samples of a turn the heading moves against the roll",
            opposed + agreeing
        ),
        likely_cause: "ROLL is positive to the left".to_owned(),
        remedy: "ROLL: scale -1 (positive with the right wing down)".to_owned(),
    })
}
