//! Functions of one or two variables that act without being an effect of the library: what a cause outside it looks like.

use flight::effect::StepTarget;
use serde::{Deserialize, Serialize};

use crate::error::EffectModelError;
use crate::point::EffectPoint;
use crate::terms::Terms;
use crate::variable::{Aloft, Variable};

/// A drag count, the size that forms acting on drag are in.
pub const DRAG_COEFFICIENT_PER_COUNT: f64 = 1e-4;
/// A per cent as a share, the size that forms acting on fuel flow are in.
pub const PERCENT: f64 = 0.01;

/// A function of one variable, or a product of two; places and widths in the variable's unit, dates in s since 1970.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Form {
    /// The same everywhere.
    Offset,
    /// (x − mean)/deviation.
    Linear,
    /// The square of that.
    Square,
    /// (x/mean)^exponent − 1.
    Power {
        /// Exponent.
        exponent: f64,
    },
    /// max(0, x − from)/deviation.
    HingeAbove {
        /// Where it begins.
        from: f64,
    },
    /// max(0, to − x)/deviation.
    HingeBelow {
        /// Where it ends.
        to: f64,
    },
    /// 1 from here on.
    Step {
        /// Where.
        from: f64,
    },
    /// 1/(1 + e^(−(x − middle)/width)).
    Logistic {
        /// Where it is one half.
        middle: f64,
        /// Its width.
        width: f64,
    },
    /// e^(−((x − middle)/width)²/2).
    Bump {
        /// Where it is largest.
        middle: f64,
        /// Its width.
        width: f64,
    },
    /// The product of two linear forms.
    Product {
        /// The second variable.
        with: Variable,
        /// Its mean and standard deviation over the flights.
        scale: [f64; 2],
    },
}

/// A form with its size, as a model contains it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AppliedForm {
    /// The function.
    pub form: Form,
    /// Its variable.
    pub variable: Variable,
    /// Mean and standard deviation of the variable over the flights that showed it: what linear forms are in.
    pub scale: [f64; 2],
    /// What it acts on.
    pub acts_on: StepTarget,
    /// Change of ln fuel flow in %, or of the drag coefficient in counts, where the function is 1.
    pub size: f64,
    /// Standard deviation of the size.
    pub standard_deviation: f64,
}

/// What the forms of all layers change at a point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Change {
    pub(crate) drag_coefficient: f64,
    pub(crate) ln_fuel_flow: f64,
}

impl Form {
    /// Whether two are of one kind, whatever their parameters.
    #[must_use]
    pub fn is_like(self, other: Self) -> bool {
        core::mem::discriminant(&self) == core::mem::discriminant(&other)
    }

    /// The function at a value `x` of its variable, of which `scale` is mean and standard deviation over the flights; `with` is
    /// the second variable's value, used by a product alone.
    #[must_use]
    pub fn value(self, x: f64, scale: [f64; 2], with: f64) -> f64 {
        let [mean, deviation] = scale;
        let standard = (x - mean) / deviation;
        match self {
            Self::Offset => 1.0,
            Self::Linear => standard,
            Self::Square => standard.powi(2),
            Self::Power { exponent } => (x / mean).powf(exponent) - 1.0,
            Self::HingeAbove { from } => (x - from).max(0.0) / deviation,
            Self::HingeBelow { to } => (to - x).max(0.0) / deviation,
            Self::Step { from } => f64::from(u8::from(x >= from)),
            Self::Logistic { middle, width } => 1.0 / (1.0 + (-(x - middle) / width).exp()),
            Self::Bump { middle, width } => (-0.5 * ((x - middle) / width).powi(2)).exp(),
            Self::Product { scale: [mean, deviation], .. } => {
                standard * ((with - mean) / deviation)
            }
        }
    }

    /// The numbers that it has beside its variable's scale, with their names, and what each has to be.
    fn parameters(self) -> [Option<(&'static str, Must, f64)>; 2] {
        match self {
            Self::Offset | Self::Linear | Self::Square => [None, None],
            Self::Power { exponent } => [Some(("exponent", Must::BeFinite, exponent)), None],
            Self::HingeAbove { from } | Self::Step { from } => {
                [Some(("from", Must::BeFinite, from)), None]
            }
            Self::HingeBelow { to } => [Some(("to", Must::BeFinite, to)), None],
            Self::Logistic { middle, width } | Self::Bump { middle, width } => {
                [Some(("middle", Must::BeFinite, middle)), Some(("width", Must::BePositive, width))]
            }
            Self::Product { scale: [mean, deviation], .. } => [
                Some(("second mean", Must::BeFinite, mean)),
                Some(("second deviation", Must::BePositive, deviation)),
            ],
        }
    }
}

/// What a number of a form has to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Must {
    BeFinite,
    BePositive,
}

impl AppliedForm {
    /// Whether it is a property of the aircraft or its surroundings, which a prediction can have: not over fuel used, an engine
    /// or N2, which no flight point has.
    #[must_use]
    pub fn is_of_aircraft(&self) -> bool {
        self.of_recordings().is_none()
    }

    /// A variable that no flight point has.
    fn of_recordings(&self) -> Option<&'static str> {
        self.variables().find_map(|variable| match variable {
            Variable::FuelUsed => Some("fuel used"),
            Variable::Engine => Some("the engine"),
            Variable::N2 => Some("N2"),
            _ => None,
        })
    }

    /// Refuses variables that no flight point has, numbers that are not finite, and widths, deviations and means of powers that
    /// are not positive.
    pub(crate) fn check(&self) -> Result<(), EffectModelError> {
        if let Some(variable) = self.of_recordings() {
            return Err(EffectModelError::FormOver { variable });
        }
        if let Some(engine) = self.acts_on.engine() {
            let expected = "fuel flow of all engines, or drag";
            let value = f64::from(engine);
            return Err(EffectModelError::Form { quantity: "engine", value, expected });
        }
        let is_power = matches!(self.form, Form::Power { .. });
        let own = [
            Some(("size", Must::BeFinite, self.size)),
            Some(("standard deviation", Must::BeFinite, self.standard_deviation)),
            Some(("mean", if is_power { Must::BePositive } else { Must::BeFinite }, self.scale[0])),
            Some(("deviation", Must::BePositive, self.scale[1])),
        ];
        for (quantity, must, value) in own.into_iter().chain(self.form.parameters()).flatten() {
            let (is_good, expected) = match must {
                Must::BeFinite => (value.is_finite(), "a finite number"),
                Must::BePositive => (value.is_finite() && value > 0.0, "a positive number"),
            };
            if !is_good {
                return Err(EffectModelError::Form { quantity, value, expected });
            }
        }
        Ok(())
    }

    /// Its variables.
    pub(crate) fn variables(&self) -> impl Iterator<Item = Variable> {
        let with = match self.form {
            Form::Product { with, .. } => Some(with),
            _ => None,
        };
        // An offset is over no variable.
        let own = (self.form != Form::Offset).then_some(self.variable);
        own.into_iter().chain(with)
    }

    /// The function at a point; a variable that the point lacks is at its mean.
    fn shape(&self, point: &EffectPoint, aloft: Aloft, terms: &Terms) -> f64 {
        let dated = EffectPoint { date_s: terms.date_s(point.date_s), ..*point };
        let of = |variable: Variable| variable.value_of_form(&dated, aloft, &terms.references);
        let [mean, _] = self.scale;
        let with = match self.form {
            Form::Product { with, scale: [mean, _] } => of(with).unwrap_or(mean),
            _ => 0.0,
        };
        self.form.value(of(self.variable).unwrap_or(mean), self.scale, with)
    }
}

impl Change {
    /// With the forms of one more layer:
    ///
    /// ```text
    /// CD + Σ s·1e-4·f(x),   Wf·exp(Σ s/100·f(x))                                           [applying.3]
    /// ```
    pub(crate) fn with_layer(mut self, terms: &Terms, point: &EffectPoint, aloft: Aloft) -> Self {
        for form in &terms.forms {
            let sized = form.size * form.shape(point, aloft, terms);
            match form.acts_on {
                StepTarget::Drag => self.drag_coefficient += sized * DRAG_COEFFICIENT_PER_COUNT,
                // A form of one engine is refused.
                _ => self.ln_fuel_flow += sized * PERCENT,
            }
        }
        self
    }

    /// Whether every form has a value.
    pub(crate) const fn is_finite(self) -> bool {
        self.drag_coefficient.is_finite() && self.ln_fuel_flow.is_finite()
    }
}
