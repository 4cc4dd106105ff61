//! The form of a cause outside the library.

use crate::output::verdict::Closure;
use crate::signals::variables::Variable;

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

/// A function of one variable, or a product of two; places and widths in the variable's unit, dates in s since 1970.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    },
}

impl Form {
    /// Whether two are of one kind, whatever their parameters.
    #[must_use]
    pub fn is_like(self, other: Self) -> bool {
        core::mem::discriminant(&self) == core::mem::discriminant(&other)
    }
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
    /// Where a hinge, step, logistic or bump lies: 95 % of the belief over the places that were tried.
    pub place_ci95: Option<[f64; 2]>,
    /// Mean and standard deviation of the variable over the flights: what linear forms are in.
    pub scale: [f64; 2],
    /// Probability among all forms that were tried, with all parameters of its kind.
    pub probability: f64,
    /// Share of the explainable gap that it closes on flights that neither its parameters nor its size have seen.
    pub closure: Option<Closure>,
}
