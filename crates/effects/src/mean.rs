//! References from segments: the mean over what a model was adapted to, or over the data at hand.

use lut::Table;
use lut::surface::{Basis, Surface};
use perf_model::Aircraft;

use crate::error::EffectModelError;
use crate::point::EffectPoint;
use crate::references::EffectReferences;
use crate::response::{Bare, Edge, evaluate};
use crate::set::Effects;
use crate::terms::{Layers, Terms};

/// Means over segments, with thrust and fuel flow as the model predicts them. Points outside the table are left out.
///
/// # Errors
/// [`EffectModelError::NothingInside`] where none is left.
pub fn mean_references(
    aircraft: &Aircraft,
    drag_table: &Table,
    points: &[EffectPoint],
) -> Result<EffectReferences, EffectModelError> {
    let bare = Bare {
        aircraft,
        drag_table,
        polar: Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] },
        levels: None,
        smooth: None,
    };
    let none = Terms::new(&Effects::none(), &EffectReferences::UNUSED);
    let layers = Layers { contained: &[], trial: &none };
    let mut sum = EffectReferences { mach: 0.0, ..EffectReferences::UNUSED };
    sum.unit_reynolds_number_per_m = 0.0;
    sum.temperature_ratio = 0.0;
    sum.corrected_thrust_n = 0.0;
    sum.fuel_flow_total_kg_s = 0.0;
    sum.mass_kg = 0.0;
    let (mut count, mut center, mut centers) = (0.0, 0.0, 0.0);
    // Dates relative to the first one: relative to 1970 they would lose digits.
    let first_date_s = points.first().map_or(0.0, |point| point.date_s);
    for point in points {
        let Ok((response, _)) = evaluate(&bare, point, layers, Edge::Refuse, None) else {
            continue;
        };
        count += 1.0;
        sum.date_s += point.date_s - first_date_s;
        sum.mach += point.mach;
        sum.unit_reynolds_number_per_m += response.unit_reynolds_number_per_m;
        sum.temperature_ratio += response.ln_temperature_ratio.exp();
        sum.corrected_thrust_n += response.ln_corrected_thrust.exp();
        sum.fuel_flow_total_kg_s += response.ln_fuel_flow_total.exp();
        sum.mass_kg += point.mass_kg;
        if let Some(percent) = point.center_of_gravity_percent_mac {
            center += percent;
            centers += 1.0;
        }
    }
    if count == 0.0 {
        return Err(EffectModelError::NothingInside { segments: points.len() });
    }
    Ok(EffectReferences {
        date_s: first_date_s + sum.date_s / count,
        mach: sum.mach / count,
        unit_reynolds_number_per_m: sum.unit_reynolds_number_per_m / count,
        temperature_ratio: sum.temperature_ratio / count,
        corrected_thrust_n: sum.corrected_thrust_n / count,
        fuel_flow_total_kg_s: sum.fuel_flow_total_kg_s / count,
        mass_kg: sum.mass_kg / count,
        center_of_gravity_percent_mac: (centers > 0.0).then(|| center / centers),
    })
}
