//! What a table leaves out of a model that has learnt more, and how large it is.

use diagnose::Baseline;
use effects::Variable;
use perf_model::LevelFlights;
use serde::Serialize;

use super::rms_and_largest;
use crate::model_file::ModelFile;
use crate::prediction::{PredictedColumn, Predictor};
use crate::whole_model::Predicts;

/// Values of each condition, from the smallest to the largest that was flown. Our choice.
const VALUES: u32 = 9;

/// What a table leaves out: the fuel flow that `predict` states over that of the table, less 1, in level flight over the masses,
/// levels, Mach numbers and deviations from the ISA that the learnt flights flew, at points where nothing lies beyond them.
/// `None` where no such point is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// Root mean square, %.
    pub rms_percent: Option<f64>,
    /// The largest, without its sign, %.
    pub largest_percent: Option<f64>,
}

/// What a table leaves out of a model; `None` of one that has learnt no more than a table.
#[must_use]
pub fn remainder_left_out(model: &ModelFile) -> Option<LeftOut> {
    model.whole(Predicts::WholeModel)?;
    let baseline = model.learnt.as_ref()?.baseline.as_ref()?;
    let percents = inside_flights(model, baseline).unwrap_or_default();
    let [rms_percent, largest_percent] =
        rms_and_largest(&percents).map_or([None; 2], |found| found.map(Some));
    Some(LeftOut { rms_percent, largest_percent })
}

impl LeftOut {
    /// In words, for a message or a comment.
    #[must_use]
    pub fn words(&self) -> String {
        let what = "what else the model has learnt is left out";
        match (self.rms_percent, self.largest_percent) {
            (Some(rms), Some(largest)) => format!(
                "{what}, {rms:.2} % of fuel flow rms and {largest:.2} % at most within what the learnt flights flew"
            ),
            _ => what.to_owned(),
        }
    }
}

/// What `predict` adds to the table, %, at points over what was flown; `None` where the baseline does not keep that.
fn inside_flights(model: &ModelFile, baseline: &Baseline) -> Option<Vec<f64>> {
    let values = |variable: Variable| {
        let (low, high) = baseline.flown(variable)?;
        let step = (high - low) / f64::from(VALUES - 1);
        Some((0..VALUES).map(move |k| low + f64::from(k) * step).collect::<Vec<f64>>())
    };
    let (mut mass_kg, mut pressure_altitude_m) = (Vec::new(), Vec::new());
    let (mut mach, mut isa_deviation_k) = (Vec::new(), Vec::new());
    let machs = values(Variable::Mach)?;
    let days_k = values(Variable::IsaDeviation)?;
    for level_m in values(Variable::PressureAltitude)? {
        for kilograms in values(Variable::Mass)? {
            for one in &machs {
                for day_k in &days_k {
                    mass_kg.push(kilograms);
                    pressure_altitude_m.push(level_m);
                    mach.push(*one);
                    isa_deviation_k.push(*day_k);
                }
            }
        }
    }
    let flights = LevelFlights {
        mass_kg: &mass_kg,
        pressure_altitude_m: &pressure_altitude_m,
        mach: &mach,
        isa_deviation_k: &isa_deviation_k,
    };
    let asked = [PredictedColumn::RemainderPercent, PredictedColumn::BeyondFlights];
    let predictor = Predictor::new(model, Predicts::WholeModel).ok()?.without_deviations();
    let found = predictor.with_columns(&asked).at_level_flights(flights, None);
    let [(_, percents), (_, beyond)] = &found.columns[..] else { return None };
    let inside = percents.iter().zip(beyond).filter(|(_, beyond)| **beyond < 0.5);
    Some(inside.map(|(percent, _)| *percent).filter(|percent| percent.is_finite()).collect())
}
