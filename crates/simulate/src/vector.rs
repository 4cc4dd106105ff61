//! Three-dimensional vectors and the sphere that flights are flown over.

/// Mean radius of the Earth, m. IUGG, R1 = (2a + b)/3 of WGS 84.
pub(crate) const EARTH_RADIUS_M: f64 = 6_371_008.8;

/// A vector, or a point of the unit sphere: z to the north pole, x to latitude 0, longitude 0.
pub(crate) type Vector = [f64; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a·x + b·y.
pub(crate) fn combine(a: f64, x: Vector, b: f64, y: Vector) -> Vector {
    [a * x[0] + b * y[0], a * x[1] + b * y[1], a * x[2] + b * y[2]]
}

pub(crate) fn subtract(x: Vector, y: Vector) -> Vector {
    [x[0] - y[0], x[1] - y[1], x[2] - y[2]]
}

pub(crate) fn normalize(x: Vector) -> Vector {
    let factor = 1.0 / dot(x, x).sqrt();
    [x[0] * factor, x[1] * factor, x[2] * factor]
}

/// A point and the direction of motion there, both unit vectors, at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) position: Vector,
    pub(crate) along: Vector,
}

impl Place {
    /// At a latitude and longitude, moving at a track angle, all in degrees.
    pub(crate) fn at(latitude_deg: f64, longitude_deg: f64, track_deg: f64) -> Self {
        let position = point(latitude_deg, longitude_deg);
        let (east, north) = east_and_north(position);
        let (sine, cosine) = track_deg.to_radians().sin_cos();
        Self { position, along: combine(sine, east, cosine, north) }
    }

    /// To the right of the motion, horizontally.
    pub(crate) fn right(&self) -> Vector {
        cross(self.along, self.position)
    }

    /// The point at a distance further along the great circle.
    pub(crate) fn ahead(&self, distance_m: f64) -> Self {
        let (sine, cosine) = (distance_m / EARTH_RADIUS_M).sin_cos();
        Self {
            position: combine(cosine, self.position, sine, self.along),
            along: combine(cosine, self.along, -sine, self.position),
        }
    }

    /// The same for the short distance of one step: sine and cosine by series, then put back on the sphere.
    pub(crate) fn step(&self, distance_m: f64) -> Self {
        let angle = distance_m / EARTH_RADIUS_M;
        let squared = angle * angle;
        let sine = angle * (1.0 - squared / 6.0);
        let cosine = 1.0 - squared / 2.0 + squared * squared / 24.0;
        let position = normalize(combine(cosine, self.position, sine, self.along));
        let along = combine(cosine, self.along, -sine, self.position);
        // Rounding errors along the vertical would otherwise grow over thousands of steps.
        let along = normalize(combine(1.0, along, -dot(along, position), position));
        Self { position, along }
    }

    /// Turned right by an angle.
    pub(crate) fn turned(&self, angle_rad: f64) -> Self {
        let (sine, cosine) = angle_rad.sin_cos();
        Self { position: self.position, along: combine(cosine, self.along, sine, self.right()) }
    }

    /// The angle to turn right to fly the great circle to a point.
    pub(crate) fn angle_to(&self, target: Vector) -> f64 {
        dot(target, self.right()).atan2(dot(target, self.along))
    }

    /// Great-circle distance to a point, m.
    pub(crate) fn distance_to_m(&self, target: Vector) -> f64 {
        let crossed = cross(self.position, target);
        dot(crossed, crossed).sqrt().atan2(dot(self.position, target)) * EARTH_RADIUS_M
    }

    pub(crate) fn latitude_rad(&self) -> f64 {
        self.position[2].clamp(-1.0, 1.0).asin()
    }

    pub(crate) fn longitude_rad(&self) -> f64 {
        self.position[1].atan2(self.position[0])
    }

    /// Track angle from north, −π..π.
    pub(crate) fn track_rad(&self) -> f64 {
        let (east, north) = east_and_north(self.position);
        dot(self.along, east).atan2(dot(self.along, north))
    }
}

/// The unit vector of a latitude and longitude in degrees.
pub(crate) fn point(latitude_deg: f64, longitude_deg: f64) -> Vector {
    let (sine, cosine) = latitude_deg.to_radians().sin_cos();
    let (sine_longitude, cosine_longitude) = longitude_deg.to_radians().sin_cos();
    [cosine * cosine_longitude, cosine * sine_longitude, sine]
}

/// Unit vectors east and north. At a pole, where they are undefined, any pair at right angles.
pub(crate) fn east_and_north(position: Vector) -> (Vector, Vector) {
    let horizontal = position[0].hypot(position[1]);
    let east = if horizontal > 1e-12 {
        [-position[1] / horizontal, position[0] / horizontal, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    (east, cross(position, east))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn great_circle_of_the_textbook() {
        // Ed Williams' Aviation Formulary: LAX (33.95 N, 118.40 W) to JFK (40.633 N, 73.783 W): 0.623585 rad, course 66°.
        let from = point(33.95, -118.4);
        let target = point(40.0 + 38.0 / 60.0, -(73.0 + 47.0 / 60.0));
        let north = Place::at(33.95, -118.4, 0.0);
        assert!((north.distance_to_m(target) / EARTH_RADIUS_M - 0.623585).abs() < 2e-5);
        let course = north.angle_to(target).to_degrees();
        assert!((course - 65.8921).abs() < 0.01, "{course}");
        let arrived = Place::at(33.95, -118.4, course).ahead(north.distance_to_m(target));
        assert!(
            dot(subtract(arrived.position, target), subtract(arrived.position, target)) < 1e-20
        );
        assert!(dot(from, from) - 1.0 < 1e-15);
    }

    #[test]
    fn small_steps_make_the_same_circle() {
        let start = Place::at(52.0, 10.0, 77.0);
        let mut place = start;
        for _ in 0..7200 {
            place = place.step(241.3);
        }
        let direct = start.ahead(7200.0 * 241.3);
        let gap = subtract(place.position, direct.position);
        assert!(dot(gap, gap).sqrt() * EARTH_RADIUS_M < 1e-2);
        assert!((place.track_rad() - direct.track_rad()).abs() < 1e-8);
    }

    #[test]
    fn right_of_north_is_east() {
        let north = Place::at(45.0, 0.0, 0.0);
        let (east, _) = east_and_north(north.position);
        assert!((dot(north.right(), east) - 1.0).abs() < 1e-12);
        assert!((north.turned(1.0).track_rad() - 1.0).abs() < 1e-12);
    }
}
