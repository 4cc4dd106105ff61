//! True states.

/// Temperature of the fuel at engine start: that of the ISA at sea level, K.
pub(crate) const FUEL_TEMPERATURE_AT_START_K: f64 = atmos::constants::SEA_LEVEL_TEMPERATURE_K;
