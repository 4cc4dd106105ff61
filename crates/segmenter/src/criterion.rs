//! The eight criteria by name, and sets of them.

use core::fmt;

use units::convert::{
    METERS_PER_FOOT, METERS_PER_SECOND_PER_FOOT_PER_MINUTE, METERS_PER_SECOND_PER_KNOT,
};

/// A trim criterion, in the order of the published table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Criterion {
    /// Change of pressure altitude between neighbors.
    PressureAltitude,
    /// Change of vertical speed between neighbors.
    VerticalSpeed,
    /// Change of Mach number between neighbors.
    Mach,
    /// Change of ground speed between neighbors.
    GroundSpeed,
    /// Change of static air temperature between neighbors.
    StaticAirTemperature,
    /// Change of the high-pressure rotor speed of any engine between neighbors.
    N2,
    /// Size of the drift angle.
    Drift,
    /// Size of the roll angle.
    Roll,
}

/// What a criterion limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum CriterionKind {
    /// The change to the sample before and to the sample after.
    ChangeToNeighbors,
    /// The size of the value itself.
    Size,
}

impl Criterion {
    /// All eight, in the order of the published table.
    pub const ALL: [Self; 8] = [
        Self::PressureAltitude,
        Self::VerticalSpeed,
        Self::Mach,
        Self::GroundSpeed,
        Self::StaticAirTemperature,
        Self::N2,
        Self::Drift,
        Self::Roll,
    ];

    /// Its short name: that of the report's column, and `VS` for the derived vertical speed.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::PressureAltitude => "ALT",
            Self::VerticalSpeed => "VS",
            Self::Mach => "MACH",
            Self::GroundSpeed => "GSPD",
            Self::StaticAirTemperature => "SAT",
            Self::N2 => "N2",
            Self::Drift => "DRIFT",
            Self::Roll => "ROLL",
        }
    }

    /// The criterion of this short name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|criterion| criterion.name() == name)
    }

    /// The quantity that is judged, in the field's words.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::PressureAltitude => "pressure altitude",
            Self::VerticalSpeed => "vertical speed (rate of pressure altitude)",
            Self::Mach => "Mach number",
            Self::GroundSpeed => "ground speed",
            Self::StaticAirTemperature => "static air temperature",
            Self::N2 => "high-pressure rotor speed of each engine",
            Self::Drift => "drift angle",
            Self::Roll => "roll angle",
        }
    }

    /// The unit of its limit.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::PressureAltitude => "ft",
            Self::VerticalSpeed => "ft/min",
            Self::Mach => "-",
            Self::GroundSpeed => "kt",
            Self::StaticAirTemperature => "degC",
            Self::N2 => "%",
            Self::Drift | Self::Roll => "deg",
        }
    }

    /// What it limits.
    #[must_use]
    pub const fn kind(self) -> CriterionKind {
        match self {
            Self::Drift | Self::Roll => CriterionKind::Size,
            _ => CriterionKind::ChangeToNeighbors,
        }
    }

    /// The limit's unit in the unit in which a track stores the channel.
    pub(crate) const fn stored_per_unit(self) -> f64 {
        match self {
            Self::PressureAltitude => METERS_PER_FOOT,
            Self::VerticalSpeed => METERS_PER_SECOND_PER_FOOT_PER_MINUTE,
            Self::GroundSpeed => METERS_PER_SECOND_PER_KNOT,
            _ => 1.0,
        }
    }

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

impl fmt::Display for Criterion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A set of criteria.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CriterionSet(u8);

impl CriterionSet {
    /// None of them.
    pub const EMPTY: Self = Self(0);

    /// Adds a criterion.
    pub const fn insert(&mut self, criterion: Criterion) {
        self.0 |= criterion.bit();
    }

    /// Whether it holds a criterion.
    #[must_use]
    pub const fn contains(self, criterion: Criterion) -> bool {
        self.0 & criterion.bit() != 0
    }

    /// Whether it holds none.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// How many it holds.
    #[must_use]
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// The criteria in it, in the order of [`Criterion::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Criterion> {
        Criterion::ALL.into_iter().filter(move |criterion| self.contains(*criterion))
    }
}

impl FromIterator<Criterion> for CriterionSet {
    fn from_iter<I: IntoIterator<Item = Criterion>>(criteria: I) -> Self {
        let mut set = Self::EMPTY;
        for criterion in criteria {
            set.insert(criterion);
        }
        set
    }
}

impl fmt::Debug for CriterionSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.iter()).finish()
    }
}

/// Short names with commas between.
impl fmt::Display for CriterionSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, criterion) in self.iter().enumerate() {
            if index > 0 {
                f.write_str(", ")?;
            }
            f.write_str(criterion.name())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_both_ways() {
        for criterion in Criterion::ALL {
            assert_eq!(Criterion::from_name(criterion.name()), Some(criterion));
        }
        assert_eq!(Criterion::from_name("TAT"), None);
    }

    /// Table 4 of Ghazi et al. 2020: what each row judges, in which unit its limit stands.
    #[test]
    fn quantities_and_units_are_those_of_the_published_table() {
        let words: Vec<_> =
            Criterion::ALL.into_iter().map(|row| (row.name(), row.meaning(), row.unit())).collect();
        let published = [
            ("ALT", "pressure altitude", "ft"),
            ("VS", "vertical speed (rate of pressure altitude)", "ft/min"),
            ("MACH", "Mach number", "-"),
            ("GSPD", "ground speed", "kt"),
            ("SAT", "static air temperature", "degC"),
            ("N2", "high-pressure rotor speed of each engine", "%"),
            ("DRIFT", "drift angle", "deg"),
            ("ROLL", "roll angle", "deg"),
        ];
        assert_eq!(words, published);
    }

    #[test]
    fn sets_keep_the_table_s_order() {
        let set: CriterionSet = [Criterion::Roll, Criterion::Mach].into_iter().collect();
        assert_eq!(set.to_string(), "MACH, ROLL");
        assert_eq!(format!("{set:?}"), "{Mach, Roll}");
        assert_eq!(set.len(), 2);
        assert!(set.contains(Criterion::Roll) && !set.contains(Criterion::Drift));
        assert_eq!(CriterionSet::EMPTY.to_string(), "");
    }
}
