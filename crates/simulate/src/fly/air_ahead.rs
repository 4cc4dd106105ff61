//! The air between two points on the way: the fields are evaluated every 2 km and are linear between.

use crate::vector::Place;
use crate::weather::{Air, AirMass};

/// Spacing of the points, m. At the shortest wave, 100 km, a chord is off by 0.2 % of its amplitude.
const SPACING_M: f64 = 2000.0;

/// The air here, and at the next point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AirAhead {
    from: Air,
    to: Air,
    next: Place,
    flown_m: f64,
    now: Air,
}

impl AirAhead {
    pub(crate) fn start(air: &AirMass, place: &Place) -> Self {
        let from = air.at(place.position);
        let next = place.ahead(SPACING_M);
        Self { from, to: air.at(next.position), next, flown_m: 0.0, now: from }
    }

    /// The air at the present position.
    pub(crate) const fn now(&self) -> &Air {
        &self.now
    }

    /// Moves on; true when a point was passed. During a turn every step is a point of its own.
    pub(crate) fn advance(
        &mut self,
        air: &AirMass,
        place: &Place,
        distance_m: f64,
        turning: bool,
    ) -> bool {
        if turning {
            *self = Self::start(air, place);
            return true;
        }
        self.flown_m += distance_m;
        let mut passed = false;
        while self.flown_m >= SPACING_M {
            self.flown_m -= SPACING_M;
            self.from = self.to;
            self.next = self.next.ahead(SPACING_M);
            self.to = air.at(self.next.position);
            passed = true;
        }
        self.now = self.from.between(&self.to, self.flown_m / SPACING_M);
        passed
    }
}
