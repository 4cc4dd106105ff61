//! What the charts of a diagnosis are drawn from: the gap at every segment, and which model it is a gap to.

use diagnose::{
    DiagnoseError, Diagnosis, Input, SegmentGap, Shown, Variable, Verdict, segment_gaps,
};

use crate::model_file::ModelFile;

/// The model and the segments behind one diagnosis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DiagnosisFigures {
    /// Name of the aircraft in the model's file.
    pub aircraft: String,
    /// Its type.
    pub type_code: String,
    /// What the model has learnt, in words.
    pub model: String,
    /// The variable that the gap is drawn over, beside Mach number, lift coefficient and date.
    pub driver: Option<Variable>,
    /// What was done to the aircraft: instant, s since 1970, and kind.
    pub events: Vec<(f64, String)>,
    /// The gap at every segment that was used; empty where the data was insufficient.
    pub segments: Vec<SegmentGap>,
}

impl DiagnosisFigures {
    /// Of a diagnosis and what it was made from.
    ///
    /// # Errors
    /// As the diagnosis itself.
    pub fn new(
        model: &ModelFile,
        input: &Input<'_>,
        diagnosis: &Diagnosis,
    ) -> Result<Self, DiagnoseError> {
        let driver = Some(driver(diagnosis));
        let shown = Shown {
            addition: diagnosis.addition.as_ref(),
            region: diagnosis.r#where.first().map(|place| &place.region),
            driver,
            outliers: &diagnosis.outliers,
        };
        let segments = match &diagnosis.verdict {
            Verdict::InsufficientData(_) => Vec::new(),
            _ => segment_gaps(input, shown)?,
        };
        let aircraft = model.initial.aircraft();
        Ok(Self {
            aircraft: aircraft.name().to_owned(),
            type_code: aircraft.type_code().to_owned(),
            model: model.told(),
            driver,
            events: Vec::new(),
            segments,
        })
    }
}

/// What the verdict's effect depends on first, else what bounds the place, else what a cause outside the library depends on;
/// Mach number where none of them has a scale.
fn driver(diagnosis: &Diagnosis) -> Variable {
    let of_effect = diagnosis
        .verdict
        .effects()
        .first()
        .and_then(|effect| effect.entry().driven_by.first())
        .map(|driver| Variable::from(*driver));
    let of_place =
        diagnosis.r#where.iter().flat_map(|place| &place.region.conditions).map(|one| one.variable);
    let outside = matches!(diagnosis.verdict, Verdict::OutsideLibrary(_));
    of_effect
        .into_iter()
        .chain(of_place)
        .chain(diagnosis.outside.variable.filter(|_| outside))
        .find(|variable| !matches!(variable, Variable::Date | Variable::Engine))
        .unwrap_or(Variable::Mach)
}
