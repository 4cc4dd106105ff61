//! What a model has learnt in addition to its table, at flight points.

use diagnose::Baseline;
use effects::ExtendedModel;
use perf_model::FlightPoint;

use pipeline::model_file::ModelFile;

/// The remainder of a model that has learnt one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Remainder<'a>(&'a Baseline);

impl<'a> Remainder<'a> {
    /// The model's remainder; `None` where it has none, or where only the table was asked for.
    pub(super) fn of(model: &'a ModelFile, table_only: bool) -> Option<Self> {
        let baseline = model.learnt.as_ref()?.baseline.as_ref()?;
        (!table_only).then_some(Self(baseline))
    }

    /// Mean and standard deviation of ln fuel flow minus the table's, where recorded flights informed them.
    pub(super) fn at(self, current: &ExtendedModel, point: &FlightPoint) -> Option<(f64, f64)> {
        self.0.known_remainder(&current.response(point).ok()?)
    }

    /// Factors on the variances stated by the aircraft's sensors, of one segment and common to a flight, as learnt from
    /// recorded flights.
    pub(super) fn variance_factors(self) -> [f64; 2] {
        let noise = self.0.noise();
        [noise.within[0] * noise.within[0], noise.between[0] * noise.between[0]]
    }
}
