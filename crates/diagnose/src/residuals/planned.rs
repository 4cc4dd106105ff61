//! Flights that were not flown, as the channels of this data would see them.

use std::borrow::Cow;

use effects::{EffectModel, EffectPoint, Response};
use flight::{MAXIMUM_ENGINES, SegmentMeans};

use crate::library::Library;
use crate::residuals::gauges::gauge_row;
use crate::residuals::reference::Reference;
use crate::residuals::rows::FlightRows;
use crate::residuals::segments::{Inside, PreparedFlights, add_wander_to};
use crate::residuals::signatures::Differences;
use crate::signals::record::GaugeBurn;

/// How a planned flight is recorded: as the flights of the data at hand are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Recorded {
    /// Samples of a segment.
    pub(crate) samples: usize,
    /// Standard deviation of gauges against meters over the fuel burned; `None` where gauges are not recorded.
    pub(crate) gauge_deviation: Option<f64>,
}

impl PreparedFlights<'_> {
    /// One planned flight as data of its own: noise, nuisance and the signatures of the library's columns as for flights
    /// that were flown, residuals of zero. `None` where the model cannot predict a point.
    pub(crate) fn planned(
        &self,
        model: &EffectModel<'_>,
        library: &Library,
        points: &[EffectPoint],
        recorded: Recorded,
    ) -> Option<Self> {
        let reference = Reference::from_baseline(self.predictor.baseline);
        let statistics = reference.statistics(model);
        let samples: Vec<u32> = (0..u32::try_from(recorded.samples).ok()?).collect();
        let differences = Differences::new(model, library, self.predictor.baseline);
        let mut segments = Vec::with_capacity(points.len());
        for &point in points {
            let (known, response) = model.known_point(&point).ok()?;
            let means = Cow::Owned(self.means(&point, &response));
            let place = segments.len();
            let mut kept = Inside { means, rows: &samples, point, known, response, place };
            kept.look_up_n2(&self.predictor);
            segments.push(self.row(model, &kept, library, &differences, &statistics).ok()?);
        }
        add_wander_to(&mut segments, &statistics, model);
        let gauge = recorded.gauge_deviation.map(|deviation| {
            let burn = GaugeBurn { gauged_kg: 1.0, metered_kg: 1.0, deviation_kg: deviation };
            gauge_row(burn, model, library, &segments)
        });
        Some(Self {
            channels: self.channels,
            predictor: self.predictor.clone(),
            flights: vec![FlightRows {
                segments: 0..segments.len(),
                gauge,
                start_s: points.first()?.date_s,
                share: 1.0,
            }],
            segments,
            engines_change: self.engines_change,
            of_other_aircraft: self.of_other_aircraft,
            left_out: std::collections::BTreeMap::new(),
        })
    }

    /// What would be recorded at a point if the model were right.
    fn means(&self, point: &EffectPoint, response: &Response) -> SegmentMeans {
        let engines = self.channels.contrasts + 1;
        let predicted = self.predictor.predict(response);
        let n2_percent = if self.channels.n2 {
            vec![100.0 * predicted[self.channels.n2_row()].exp(); engines]
        } else {
            vec![]
        };
        SegmentMeans {
            time_s: 0.0,
            pressure_altitude_m: point.pressure_altitude_m,
            static_air_temperature_k: point.static_air_temperature_k,
            mach: point.mach,
            true_airspeed_m_s: point.true_airspeed_m_s,
            ground_speed_m_s: point.ground_speed_m_s,
            acceleration_m_s2: point.acceleration_m_s2,
            vertical_speed_m_s: 0.0,
            mass_kg: point.mass_kg,
            fuel_flow_total_kg_s: response.ln_fuel_flow_total.exp(),
            fuel_flow_engine_kg_s: response.ln_fuel_flow_engine[..engines]
                .iter()
                .map(|ln| ln.exp())
                .collect(),
            fuel_used_kg: point.fuel_used_kg,
            drift_deg: point.drift_deg,
            roll_deg: None,
            roll_squared_deg2: point.roll_squared_deg2,
            n2_percent,
            latitude_deg: point.latitude_deg,
            longitude_deg: None,
            true_heading_deg: point.true_heading_deg,
            center_of_gravity_percent_mac: point.center_of_gravity_percent_mac,
            total_air_temperature_k: None,
            n1_percent: [None; MAXIMUM_ENGINES],
            exhaust_gas_temperature_k: [None; MAXIMUM_ENGINES],
            fuel_quantity_kg: None,
            anti_ice: point.anti_ice,
        }
    }
}
