//! Where the aircraft goes: great circles between waypoints, and the turns at them.

use units::convert::STANDARD_GRAVITY_M_S2;

use crate::route::Autopilot;
use crate::vector::{Place, Vector, point};

/// Roll command per angle still to turn.
const BANK_PER_ANGLE: f64 = 4.0;
/// Largest roll rate, rad/s.
const ROLL_RATE_RAD_S: f64 = 5.0 * units::convert::RADIANS_PER_DEGREE;
/// A turn is finished within this angle of the new course and of wings level, rad.
const TURN_DONE_RAD: f64 = 0.05 * units::convert::RADIANS_PER_DEGREE;

/// Position, direction, bank.
#[derive(Clone, Debug)]
pub(crate) struct Steering {
    place: Place,
    /// Waypoints still to come, the next one last.
    waypoints: Vec<Vector>,
    bank_rad: f64,
    turning: bool,
}

impl Steering {
    /// From the first waypoint towards the second. A route of one point goes north.
    pub(crate) fn start(waypoints: &[(f64, f64)]) -> Self {
        let (latitude_deg, longitude_deg) = waypoints.first().copied().unwrap_or_default();
        let mut place = Place::at(latitude_deg, longitude_deg, 0.0);
        let mut ahead: Vec<Vector> = waypoints
            .iter()
            .skip(1)
            .rev()
            .map(|(latitude, longitude)| point(*latitude, *longitude))
            .collect();
        if let Some(first) = ahead.last() {
            place = place.turned(place.angle_to(*first));
        }
        if ahead.len() == 1 {
            // Straight on after the last: nothing to turn to.
            ahead.clear();
        }
        Self { place, waypoints: ahead, bank_rad: 0.0, turning: false }
    }

    pub(crate) const fn place(&self) -> &Place {
        &self.place
    }

    /// Roll of the turn, degrees; 0 on a straight leg.
    pub(crate) fn roll_deg(&self) -> f64 {
        self.bank_rad.to_degrees()
    }

    /// One step on; true while turning.
    pub(crate) fn advance(
        &mut self,
        ground_speed_m_s: f64,
        true_airspeed_m_s: f64,
        autopilot: &Autopilot,
        step_s: f64,
    ) -> bool {
        self.place = self.place.step(ground_speed_m_s * step_s);
        if !self.turning {
            self.begin_turn(ground_speed_m_s, autopilot);
        }
        if !self.turning {
            return false;
        }
        // In a turn the waypoint turned at is gone: the next one is last.
        let Some(target) = self.waypoints.last().copied() else {
            self.turning = false;
            return false;
        };
        let still_rad = self.place.angle_to(target);
        let limit_rad = autopilot.bank_deg.to_radians();
        let command_rad = (BANK_PER_ANGLE * still_rad).clamp(-limit_rad, limit_rad);
        let rate = ((command_rad - self.bank_rad) / autopilot.roll_time_s)
            .clamp(-ROLL_RATE_RAD_S, ROLL_RATE_RAD_S);
        self.bank_rad += rate * step_s;
        let turn_rad = STANDARD_GRAVITY_M_S2 * self.bank_rad.tan() / true_airspeed_m_s * step_s;
        self.place = self.place.turned(turn_rad);
        if still_rad.abs() < TURN_DONE_RAD && self.bank_rad.abs() < 10.0 * TURN_DONE_RAD {
            self.place = self.place.turned(self.place.angle_to(target));
            self.bank_rad = 0.0;
            self.turning = false;
            if self.waypoints.len() == 1 {
                self.waypoints.clear();
            }
        }
        true
    }

    /// Starts the turn early enough that it ends on the new leg.
    fn begin_turn(&mut self, ground_speed_m_s: f64, autopilot: &Autopilot) {
        let [.., after, next] = self.waypoints[..] else { return };
        let distance_m = self.place.distance_to_m(next);
        // No turn starts farther out than this: it saves the rest of the arithmetic on a long leg.
        if distance_m > 100_000.0 {
            return;
        }
        let at_waypoint = self.place.ahead(distance_m);
        let angle_rad = at_waypoint.angle_to(after);
        let radius_m = ground_speed_m_s * ground_speed_m_s
            / (STANDARD_GRAVITY_M_S2 * autopilot.bank_deg.to_radians().tan());
        let early_m = radius_m * (0.5 * angle_rad.abs().min(2.5)).tan();
        if distance_m <= early_m + 3.0 * ground_speed_m_s {
            self.waypoints.pop();
            self.turning = true;
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;

    #[test]
    fn turns_at_the_waypoint_and_flies_to_the_next() {
        let waypoints = [(50.0, 0.0), (50.0, 2.0), (52.0, 3.0)];
        let mut steering = Steering::start(&waypoints);
        let autopilot = Autopilot::default();
        let target = point(52.0, 3.0);
        let (mut nearest_m, mut largest_bank) = (f64::INFINITY, 0.0_f64);
        let mut turning_s = 0;
        for _ in 0..2400 {
            if steering.advance(240.0, 235.0, &autopilot, 1.0) {
                turning_s += 1;
            }
            nearest_m = nearest_m.min(steering.place().distance_to_m(target));
            largest_bank = largest_bank.max(steering.roll_deg().abs());
        }
        assert!(nearest_m < 300.0, "{nearest_m}");
        assert!(largest_bank > 15.0 && largest_bank <= 20.0, "{largest_bank}");
        // Some 73° of turn at g·tan 20°/235 m/s = 0.87°/s: 84 s and the time to roll in and out.
        assert!((80..160).contains(&turning_s), "{turning_s}");
        assert_eq!(steering.roll_deg(), 0.0);
    }
}
