//! What a model remembers beside its table, at flight points.

use diagnose::Baseline;
use effects::ExtendedModel;
use perf_model::FlightPoint;

use pipeline::model_file::ModelFile;

/// The remainder of a model that remembers one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Remainder<'a>(&'a Baseline);

impl<'a> Remainder<'a> {
    /// The model's remainder; `None` where it remembers none, or the table alone was asked for.
    pub(super) fn of(model: &'a ModelFile, table_only: bool) -> Option<Self> {
        let baseline = model.learnt.as_ref()?.baseline.as_ref()?;
        (!table_only).then_some(Self(baseline))
    }

    /// Mean and standard deviation of ln fuel flow less the table's, where flown data informed them.
    pub(super) fn at(self, current: &ExtendedModel, point: &FlightPoint) -> Option<(f64, f64)> {
        self.0.known_remainder(&current.response(point).ok()?)
    }

    /// Factors on the variances that the aircraft's sensors announce, of one segment and common to a flight: what the flown
    /// data showed of them.
    pub(super) fn variance_factors(self) -> [f64; 2] {
        let noise = self.0.noise();
        [noise.within[0] * noise.within[0], noise.between[0] * noise.between[0]]
    }
}
