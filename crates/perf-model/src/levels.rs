//! By how much drag differs by level from a table over lift coefficient and Mach number.

use units::PressureAltitude;

/// By how much drag exceeds that of a table at each of some levels: a plane over lift coefficient and Mach number at each.
///
/// Reynolds number, part load and the temperature in TSFC vary with the level where lift coefficient and Mach number do not: rows of
/// guides that know them are 1 to 3 % off any table. Book `[bayes.16]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GuideLevels {
    /// Smallest and largest lift coefficient and Mach number of the rows.
    ranges: [(f64, f64); 2],
    levels: Vec<GuideLevel>,
}

/// One level of a guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideLevel {
    /// Pressure altitude, m.
    pub pressure_altitude_m: f64,
    /// Drag by the rows over that by the table, less 1: in the middle of lift coefficients and Mach numbers, and how much more it
    /// is at the largest of either.
    pub shares: [f64; 3],
}

/// A place in a guide.
#[derive(Clone, Copy, Debug)]
pub struct GuidePlace {
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Mach number.
    pub mach: f64,
    /// Pressure altitude.
    pub pressure_altitude: PressureAltitude,
}

/// Numbers that are no levels of a guide.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GuideLevelError {
    /// A level.
    #[error("level {0} m: expected pressure altitudes that rise, and shares between -0.5 and 0.5")]
    Level(f64),
    /// A range.
    #[error("from {0} to {1}: expected a range of lift coefficients or Mach numbers")]
    Range(f64, f64),
}

impl GuideLevels {
    /// Levels that were found or written.
    ///
    /// # Errors
    /// Pressure altitudes that do not rise, shares that no level has, or ranges that are none.
    pub fn new(ranges: [(f64, f64); 2], levels: Vec<GuideLevel>) -> Result<Self, GuideLevelError> {
        for (low, high) in ranges {
            if !(low.is_finite() && high.is_finite() && low < high) {
                return Err(GuideLevelError::Range(low, high));
            }
        }
        let mut below = f64::NEG_INFINITY;
        for GuideLevel { pressure_altitude_m, shares } in &levels {
            let rises = pressure_altitude_m.is_finite() && *pressure_altitude_m > below;
            if !(rises && shares.iter().all(|share| share.abs() < 0.5)) {
                return Err(GuideLevelError::Level(*pressure_altitude_m));
            }
            below = *pressure_altitude_m;
        }
        Ok(Self { ranges, levels })
    }

    /// The levels, the lowest first.
    #[must_use]
    pub fn levels(&self) -> &[GuideLevel] {
        &self.levels
    }

    /// Smallest and largest lift coefficient and Mach number of the rows.
    #[must_use]
    pub const fn ranges(&self) -> [(f64, f64); 2] {
        self.ranges
    }

    /// Factor on the drag of the table: linear between levels, held below and above them and beyond the rows.
    #[must_use]
    pub fn factor(&self, place: GuidePlace) -> f64 {
        let shares = self.shares(place.pressure_altitude);
        let terms = guide_terms(place, self.ranges);
        1.0 + shares[0] + shares[1] * terms[1] + shares[2] * terms[2]
    }

    /// The plane at a pressure altitude: shares as a level has them.
    #[must_use]
    pub fn shares(&self, pressure_altitude: PressureAltitude) -> [f64; 3] {
        let at_m = pressure_altitude.to_meters();
        let above = self.levels.partition_point(|level| level.pressure_altitude_m <= at_m);
        let below = above.checked_sub(1).map(|k| &self.levels[k]);
        match (below, self.levels.get(above)) {
            (Some(low), Some(high)) => {
                let span_m = high.pressure_altitude_m - low.pressure_altitude_m;
                let upper = (at_m - low.pressure_altitude_m) / span_m;
                let share =
                    |term| low.shares[term] + upper * (high.shares[term] - low.shares[term]);
                [share(0), share(1), share(2)]
            }
            (Some(end), None) | (None, Some(end)) => end.shares,
            (None, None) => [0.0; 3],
        }
    }
}

/// What the shares of a level multiply: 1, and lift coefficient and Mach number from -1 to 1 over their ranges, held at their ends.
#[must_use]
#[inline]
pub fn guide_terms(place: GuidePlace, [lift, mach]: [(f64, f64); 2]) -> [f64; 3] {
    let over = |value: f64, (low, high): (f64, f64)| {
        (2.0 * (value - low) / (high - low) - 1.0).clamp(-1.0, 1.0)
    };
    [1.0, over(place.lift_coefficient, lift), over(place.mach, mach)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(pressure_altitude_m: f64, shares: [f64; 3]) -> GuideLevel {
        GuideLevel { pressure_altitude_m, shares }
    }

    fn factor(levels: &GuideLevels, lift_coefficient: f64, mach: f64, at_m: f64) -> f64 {
        let pressure_altitude = PressureAltitude::meters(at_m);
        levels.factor(GuidePlace { lift_coefficient, mach, pressure_altitude })
    }

    /// By hand: a quarter of the way from the lower to the upper level, half way to the largest lift coefficient, a tenth below the
    /// middle of the Mach numbers.
    #[test]
    fn planes_are_linear_between_levels_and_held_beyond_rows() {
        let ranges = [(0.2, 0.6), (0.7, 0.9)];
        let [low, high] = [[-0.02, 0.01, 0.03], [0.06, -0.03, 0.07]];
        let levels = vec![level(9_000.0, low), level(11_000.0, high)];
        let levels = GuideLevels::new(ranges, levels).unwrap();
        let by_hand = 1.0 + 0.0 + 0.0 * 0.5 + 0.04 * -0.1;
        assert!((factor(&levels, 0.5, 0.79, 9_500.0) - by_hand).abs() < 1e-14);
        let lowest = 1.0 - 0.02 + 0.01 - 0.03;
        for (lift, mach, at_m) in [(0.6, 0.7, 9_000.0), (0.9, 0.5, 0.0), (7.0, 0.0, -100.0)] {
            assert!((factor(&levels, lift, mach, at_m) - lowest).abs() < 1e-14);
        }
        assert!((factor(&levels, 0.2, 0.9, 20_000.0) - (1.0 + 0.06 + 0.03 + 0.07)).abs() < 1e-14);
        assert!((factor(&GuideLevels::default(), 0.5, 0.8, 9_000.0) - 1.0).abs() < 1e-15);
        assert_eq!(GuideLevels::new(levels.ranges(), levels.levels().to_vec()), Ok(levels));
    }

    #[test]
    fn what_is_no_level_is_refused() {
        let ranges = [(0.2, 0.6), (0.7, 0.9)];
        let of = |pressure_altitude_m, share| level(pressure_altitude_m, [share; 3]);
        assert!(GuideLevels::new(ranges, vec![of(1.0, 0.1)]).is_ok());
        assert!(GuideLevels::new([(0.2, 0.2), (0.7, 0.9)], vec![of(1.0, 0.1)]).is_err());
        for wrong in [
            vec![of(1.0, 0.0), of(1.0, 0.0)],
            vec![of(f64::NAN, 0.0)],
            vec![of(1.0, f64::NAN)],
            vec![of(1.0, -0.5)],
        ] {
            assert!(GuideLevels::new(ranges, wrong).is_err());
        }
    }
}
