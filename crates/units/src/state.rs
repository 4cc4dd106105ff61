//! State of the air.

use crate::quantity::{additive, quantity};

quantity!(
    /// Pressure; the argument's name states whether it is static, total or impact pressure.
    Pressure, "Pa",
    [(pascals, to_pascals, 1.0, "pascals"), (hectopascals, to_hectopascals, 100.0, "hectopascals")]
);
quantity!(
    /// Air density.
    Density, "kg/m³",
    [(kilograms_per_cubic_meter, to_kilograms_per_cubic_meter, 1.0, "kg/m³")]
);
quantity!(
    /// Dynamic viscosity of air.
    DynamicViscosity, "Pa s",
    [(pascal_seconds, to_pascal_seconds, 1.0, "Pa s")]
);
additive!(Pressure);
