//! The form of a cause outside the library.

use effects::{AppliedForm, Form, Variable};
use flight::effect::StepTarget;

use crate::output::verdict::Closure;
use crate::thresholds::NORMAL_95;

/// What a cause outside the library acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ActsOn {
    /// Fuel flow of all engines.
    FuelFlow,
    /// Thrust: drag or weight.
    Thrust,
    /// One engine's fuel flow.
    OneEngine,
}

/// A form with its size, as the flights have it.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundForm {
    /// The function.
    pub form: Form,
    /// Its variable.
    pub variable: Variable,
    /// What it acts on.
    pub acts_on: ActsOn,
    /// Change of fuel flow in %, or of the drag coefficient in counts, where the function is 1; with its 95 % interval, the form's
    /// place and width as they are.
    pub size: f64,
    /// 95 % interval of the size.
    pub size_ci95: [f64; 2],
    /// Root mean square of what it changes fuel flow by over the flights, %.
    pub rms_percent: f64,
    /// Where a hinge, step, logistic or bump lies: 95 % of the belief over the places that were tried.
    pub place_ci95: Option<[f64; 2]>,
    /// Mean and standard deviation of the variable over the flights: what linear forms are in.
    pub scale: [f64; 2],
    /// Probability among all forms that were tried, with all parameters of its kind.
    pub probability: f64,
    /// Share of the explainable gap that it closes on flights that neither its parameters nor its size have seen.
    pub closure: Option<Closure>,
}

impl FoundForm {
    /// Whether 0 lies outside the 95 % interval of its size.
    #[must_use]
    pub fn has_a_size(&self) -> bool {
        let [low, high] = self.size_ci95;
        low > 0.0 || high < 0.0
    }

    /// Whether it is the same everywhere, as effects of the library are.
    #[must_use]
    pub const fn is_a_level(&self) -> bool {
        matches!(self.form, Form::Offset)
    }

    /// The form as a model contains it; `None` for what no prediction can have: one engine's, or one over what is recorded and no
    /// property of the aircraft.
    #[must_use]
    pub fn applied(&self) -> Option<AppliedForm> {
        let acts_on = match self.acts_on {
            ActsOn::FuelFlow => StepTarget::FuelFlow,
            ActsOn::Thrust => StepTarget::Drag,
            ActsOn::OneEngine => return None,
        };
        let applied = AppliedForm {
            form: self.form,
            variable: self.variable,
            scale: self.scale,
            acts_on,
            size: self.size,
            standard_deviation: (self.size_ci95[1] - self.size_ci95[0]) / (2.0 * NORMAL_95),
        };
        applied.is_of_aircraft().then_some(applied)
    }
}
