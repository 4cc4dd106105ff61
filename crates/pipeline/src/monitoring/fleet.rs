//! Tails of a type together: their levels at common conditions, and the means over them.

use monitor::{Estimate, FleetMean, FlownConditions, fleet_mean, to_common_conditions};
use units::PressureAltitude;

use super::document::{
    AlertDocument, Figure, FleetDocument, FleetMonthDocument, MonitorDocument, TailDocument,
    TypeConditions,
};
use super::flights::MeanConditions;
use crate::statistics::students_quantile975;

impl MonitorDocument {
    /// The document of these tails, in their order, each with its flights by the conditions flown: tails of a type are compared at
    /// the mean conditions of all of them.
    #[must_use]
    pub fn compared(
        tails: Vec<(TailDocument, FlownConditions)>,
        alerts: Vec<AlertDocument>,
    ) -> Self {
        let (mut tails, mut flown): (Vec<_>, Vec<_>) = tails.into_iter().unzip();
        for of_type in types_of(&tails) {
            let is_of_type = |place: &usize| tails[*place].aircraft_type == of_type;
            let places: Vec<usize> = (0..tails.len()).filter(is_of_type).collect();
            let of_tails: Vec<FlownConditions> =
                places.iter().map(|place| core::mem::take(&mut flown[*place])).collect();
            let raised = to_common_conditions(&of_tails).unwrap_or_default();
            for (place, raised) in places.iter().zip(raised) {
                let tail = &mut tails[*place];
                tail.at_type_conditions_percent = Some(sum(&tail.deviation_percent, raised));
            }
        }
        Self::new(tails, alerts)
    }
}

impl TailDocument {
    /// The level by which the tail is compared with others of its type: that at the mean conditions of all of them, where these are
    /// known.
    #[must_use]
    pub fn compared_percent(&self) -> Figure {
        self.at_type_conditions_percent.unwrap_or(self.deviation_percent)
    }

    /// By how much that is above the level at its own mean conditions.
    fn raised(&self) -> Estimate {
        let (own, compared) =
            (estimate(&self.deviation_percent), estimate(&self.compared_percent()));
        let variance = compared.deviation.powi(2) - own.deviation.powi(2);
        Estimate { value: compared.value - own.value, deviation: variance.max(0.0).sqrt() }
    }
}

impl TypeConditions {
    /// In words: `Mach 0.780, 36400 ft, 62100 kg`.
    #[must_use]
    pub fn in_words(&self) -> String {
        let feet = PressureAltitude::meters(self.pressure_altitude_m).to_feet();
        format!(
            "Mach {:.3}, {:.0} ft, {:.0} kg",
            self.mach,
            100.0 * (feet / 100.0).round(),
            100.0 * (self.mass_kg / 100.0).round()
        )
    }
}

impl From<&MeanConditions> for TypeConditions {
    fn from(of: &MeanConditions) -> Self {
        Self {
            pressure_altitude_m: of.pressure_altitude_m,
            mach: of.mach,
            static_air_temperature_k: of.static_air_temperature_k,
            mass_kg: of.mass_kg,
        }
    }
}

/// The types of some tails, in order, each once.
pub(super) fn types_of(tails: &[TailDocument]) -> Vec<String> {
    let mut types: Vec<String> = tails.iter().map(|tail| tail.aircraft_type.clone()).collect();
    types.sort_unstable();
    types.dedup();
    types
}

/// The tails of a type together; `None` without one.
pub(super) fn fleet(aircraft_type: &str, tails: &[TailDocument]) -> Option<FleetDocument> {
    let of_type: Vec<&TailDocument> =
        tails.iter().filter(|tail| tail.aircraft_type == aircraft_type).collect();
    let mean = |of: &dyn Fn(&TailDocument) -> Option<Figure>| -> Option<FleetMean> {
        let figures: Vec<Estimate> =
            of_type.iter().filter_map(|tail| of(tail)).map(|figure| estimate(&figure)).collect();
        fleet_mean(&figures)
    };
    let deviation = mean(&|tail| Some(tail.compared_percent()))?;
    let trend = mean(&|tail| tail.trend_percent_per_year);
    let mut names: Vec<&str> =
        of_type.iter().flat_map(|tail| tail.months.iter().map(|m| m.month.as_str())).collect();
    names.sort_unstable();
    names.dedup();
    let months = names
        .into_iter()
        .filter_map(|name| {
            let found = mean(&|tail| {
                let month = tail.months.iter().find(|m| m.month == name)?;
                Some(sum(&month.deviation_percent, tail.raised()))
            })?;
            Some(FleetMonthDocument {
                month: name.to_owned(),
                tails: found.tails,
                deviation_percent: of_tails(&found),
            })
        })
        .collect();
    Some(FleetDocument {
        aircraft_type: aircraft_type.to_owned(),
        tails: deviation.tails,
        reference: conditions_of(&of_type),
        deviation_percent: of_tails(&deviation),
        between_tails_percent: deviation.between_tails,
        trend_percent_per_year: trend.as_ref().map(of_tails),
        months,
    })
}

/// Mean conditions of tails, each counted alike.
fn conditions_of(tails: &[&TailDocument]) -> TypeConditions {
    let mean = |of: fn(&TailDocument) -> f64| {
        tails.iter().map(|tail| of(tail)).sum::<f64>() / tails.len().max(1) as f64
    };
    TypeConditions {
        pressure_altitude_m: mean(|tail| tail.reference.pressure_altitude_m),
        mach: mean(|tail| tail.reference.mach),
        static_air_temperature_k: mean(|tail| tail.reference.static_air_temperature_k),
        mass_kg: mean(|tail| tail.reference.mass_kg),
    }
}

/// A mean over tails with its interval: Student's, and of a tail alone its own.
fn of_tails(found: &FleetMean) -> Figure {
    let factor = students_quantile975(found.freedom() as f64).unwrap_or(monitor::NORMAL_95);
    let (value, half) = (found.mean.value, factor * found.mean.deviation);
    Figure { value, ci95: [value - half, value + half] }
}

fn estimate(figure: &Figure) -> Estimate {
    Estimate { value: figure.value, deviation: figure.half_width() / monitor::NORMAL_95 }
}

/// A figure raised by what is known independently of it.
fn sum(figure: &Figure, raised: Estimate) -> Figure {
    let own = estimate(figure);
    let deviation = own.deviation.hypot(raised.deviation);
    Figure::from(Estimate { value: own.value + raised.value, deviation })
}
