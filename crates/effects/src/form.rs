//! Functions of one or two variables that act without being an effect of the library: what a cause outside it looks like.

use flight::effect::StepTarget;
use serde::{Deserialize, Serialize};

use crate::error::EffectModelError;
use crate::point::EffectPoint;
use crate::terms::{Layers, Terms};
use crate::variable::{Aloft, Variable};

/// A drag count.
const COUNT: f64 = 1e-4;
/// Share of a whole in per cent.
const PERCENT: f64 = 0.01;

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

    /// The numbers that it has beside its variable's scale, with their names; the second is whether it has to be positive.
    fn parameters(self) -> [Option<(&'static str, bool, f64)>; 2] {
        match self {
            Self::Offset | Self::Linear | Self::Square => [None, None],
            Self::Power { exponent } => [Some(("exponent", false, exponent)), None],
            Self::HingeAbove { from } | Self::Step { from } => [Some(("from", false, from)), None],
            Self::HingeBelow { to } => [Some(("to", false, to)), None],
            Self::Logistic { middle, width } | Self::Bump { middle, width } => {
                [Some(("middle", false, middle)), Some(("width", true, width))]
            }
            Self::Product { scale: [mean, deviation], .. } => {
                [Some(("second mean", false, mean)), Some(("second deviation", true, deviation))]
            }
        }
    }
}

impl AppliedForm {
    /// Refuses variables that no flight point has, numbers that are not finite, and widths and deviations that are not positive.
    pub(crate) fn check(&self) -> Result<(), EffectModelError> {
        for variable in self.variables() {
            let variable = match variable {
                Variable::FuelUsed => "fuel used",
                Variable::Engine => "the engine",
                Variable::N2 => "N2",
                _ => continue,
            };
            return Err(EffectModelError::FormOver { variable });
        }
        let own = [
            Some(("size", false, self.size)),
            Some(("mean", false, self.scale[0])),
            Some(("deviation", true, self.scale[1])),
        ];
        for (quantity, has_sign, value) in own.into_iter().chain(self.form.parameters()).flatten() {
            if !value.is_finite() || (has_sign && value <= 0.0) {
                return Err(EffectModelError::Form { quantity, value });
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
        let of = |variable: Variable| match variable {
            // The instant itself, not years since a reference that nobody sees.
            Variable::Date => Some(terms.date_s(point.date_s)),
            _ => variable.at(point, aloft, &terms.references),
        };
        let [mean, _] = self.scale;
        let with = match self.form {
            Form::Product { with, scale: [mean, _] } => of(with).unwrap_or(mean),
            _ => 0.0,
        };
        self.form.value(of(self.variable).unwrap_or(mean), self.scale, with)
    }
}

/// What the forms of all layers change at a point, lift and thrust without them:
///
/// ```text
/// CD + Σ s·1e-4·f(x),   Wf·exp(Σ s/100·f(x))                                           [applying.3]
/// ```
pub(crate) fn change(layers: Layers<'_>, point: &EffectPoint, aloft: Aloft) -> Change {
    let mut change = Change::default();
    for terms in layers.iter() {
        for form in &terms.forms {
            let sized = form.size * form.shape(point, aloft, terms);
            match form.acts_on {
                StepTarget::Drag => change.drag_coefficient += sized * COUNT,
                StepTarget::FuelFlow => change.ln_fuel_flow += sized * PERCENT,
            }
        }
    }
    change
}
