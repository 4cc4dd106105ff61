//! Why a case came to nothing.

/// Why a case came to nothing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CaseFailure {
    /// The plan.
    #[error(transparent)]
    Plan(#[from] simulate::PlanError),
    /// The flight.
    #[error(transparent)]
    Flight(#[from] simulate::SimulationError),
    /// Too few of the planned flights.
    #[error("{flown} of {planned} flights could be flown, nine tenths are needed")]
    NotFlown {
        /// Flights flown.
        flown: usize,
        /// Flights planned.
        planned: usize,
    },
    /// The track.
    #[error(transparent)]
    Track(#[from] track::TrackError),
    /// The aircraft of the reference model.
    #[error(transparent)]
    Aircraft(#[from] perf_model::AircraftError),
    /// Its table.
    #[error(transparent)]
    Table(#[from] lut::TableError),
    /// The denied model.
    #[error(transparent)]
    Model(#[from] perf_model::ModelError),
    /// The rows of a guide.
    #[error(transparent)]
    GuideRows(#[from] units::OutOfDomain),
    /// Their text.
    #[error(transparent)]
    GuideText(#[from] perf_model::CsvError),
    /// The model that they make.
    #[error(transparent)]
    Initial(#[from] perf_model::InitialModelError),
    /// What it should have learnt.
    #[error(transparent)]
    Learning(#[from] pipeline::learning::LearningError),
    /// A model of a fleet's type that has learnt too little to be a reference.
    #[error("the clean flights are too few for a model of the type")]
    Untaught,
    /// What its table does not know.
    #[error(transparent)]
    Uncertainty(#[from] diagnose::TableUncertaintyError),
    /// The diagnosis.
    #[error(transparent)]
    Diagnose(#[from] diagnose::DiagnoseError),
    /// A model that takes no effects.
    #[error(transparent)]
    Effects(#[from] effects::EffectModelError),
}
