//! Standard atmosphere, airspeeds, temperatures, gravity, viscosity.
