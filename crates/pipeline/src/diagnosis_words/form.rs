//! A form outside the library in words.

use diagnose::{ActsOn, Form, FoundForm, Variable};
use effects::{AppliedForm, OUTSIDE};
use flight::effect::StepTarget;
use units::convert::SECONDS_PER_DAY;

use super::region::{instant, unit_words};
use super::variable_words;
use crate::summary::not_minus_zero;

/// "CD +9.6 ± 0.8 counts around Mach number 0.781 (width 0.016): closes 93 % on unseen flights".
pub fn form_words(found: &FoundForm) -> String {
    let half = 0.5 * (found.size_ci95[1] - found.size_ci95[0]);
    let (what, unit) = match found.acts_on {
        ActsOn::Thrust => of_target(StepTarget::Drag),
        ActsOn::FuelFlow | ActsOn::OneEngine => of_target(StepTarget::FuelFlow),
    };
    let closure = found.closure.map_or_else(
        || "how much it closes could not be measured".to_owned(),
        |closure| {
            format!("closes {:.0} % on unseen flights", not_minus_zero(100.0 * closure.share, 0))
        },
    );
    let size = not_minus_zero(found.size, 2);
    let shape = shape(found.form, (found.variable, found.scale), found.place_ci95);
    let alike = match (found.is_a_level(), found.acts_on) {
        (true, ActsOn::Thrust) => ", as zero_lift_drag makes it",
        (true, _) => ", as tsfc_factor or fuel_flow_gain makes it",
        _ => "",
    };
    format!("{what} {size:+.2} ± {half:.2} {unit} {shape}{alike}: {closure}")
}

/// "outside: drag +9.61 ± 0.80 counts around Mach number 0.781, width 0.016".
pub fn applied_form_words(applied: &AppliedForm) -> String {
    let (what, unit) = of_target(applied.acts_on);
    let shape = shape(applied.form, (applied.variable, applied.scale), None);
    let AppliedForm { size, standard_deviation, .. } = applied;
    format!("{OUTSIDE}: {what} {size:+.4} ± {standard_deviation:.4} {unit} {shape}")
}

/// What a size is of, and its unit.
const fn of_target(target: StepTarget) -> (&'static str, &'static str) {
    match target {
        StepTarget::Drag => ("drag", "counts"),
        of_fuel_flow => (of_fuel_flow.words(), "%"),
    }
}

/// What its size is of, and where.
fn shape(
    form: Form,
    (variable, scale): (Variable, [f64; 2]),
    place_ci95: Option<[f64; 2]>,
) -> String {
    let name = variable_words(variable);
    let [mean, deviation] = scale;
    let unit = unit_words(variable);
    let is_date = variable == Variable::Date;
    let bare = |value: f64| if is_date { day(value) } else { short(value, deviation) };
    let written = |value: f64| format!("{}{unit}", bare(value));
    let length = |value: f64| {
        if is_date {
            format!("{:.0} days", value / SECONDS_PER_DAY)
        } else {
            format!("{}{unit}", short(value, deviation))
        }
    };
    let place = |value: f64| match place_ci95 {
        Some([low, high]) if high > low => {
            format!("{} ({} to {})", written(value), bare(low), bare(high))
        }
        _ => written(value),
    };
    let per = length(deviation);
    match form {
        Form::Offset => "everywhere".to_owned(),
        Form::Linear => format!("per {per} of {name}, zero at {}", written(mean)),
        Form::Square => format!("at {per} of {name} from {}, growing as the square", written(mean)),
        Form::Power { exponent } => {
            format!("times ({name} over {})^{exponent:.2} less 1", written(mean))
        }
        Form::HingeAbove { from } => format!("per {per} of {name} above {}", place(from)),
        Form::HingeBelow { to } => format!("per {per} of {name} below {}", place(to)),
        Form::Step { from } => format!("from {name} {} on", place(from)),
        Form::Logistic { middle, width } => {
            format!("beyond {name} {}, over a width of {}", place(middle), length(width))
        }
        Form::Bump { middle, width } => {
            format!("around {name} {}, width {}", place(middle), length(width))
        }
        Form::Product { with, .. } => {
            format!("per standard deviation of {name} and of {}", variable_words(with))
        }
    }
}

/// The day of an instant, s since 1970.
fn day(instant_s: f64) -> String {
    instant(instant_s).get(..10).unwrap_or_default().to_owned()
}

/// A number with as many digits as a hundredth of what the variable varies by needs.
fn short(value: f64, deviation: f64) -> String {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few digits")]
    let digits = (2.0 - deviation.abs().max(1e-9).log10()).ceil().clamp(0.0, 9.0) as usize;
    format!("{value:.digits$}")
}

/// Name of a form in files.
pub const fn form_name(form: Form) -> &'static str {
    match form {
        Form::Offset => "offset",
        Form::Linear => "linear",
        Form::Square => "square",
        Form::Power { .. } => "power",
        Form::HingeAbove { .. } => "hinge_above",
        Form::HingeBelow { .. } => "hinge_below",
        Form::Step { .. } => "step",
        Form::Logistic { .. } => "logistic",
        Form::Bump { .. } => "bump",
        Form::Product { .. } => "product",
    }
}

/// The second variable of a product, with its mean and standard deviation.
type With = (Variable, [f64; 2]);

/// Place, width and exponent, where a form has them, and the second variable of a product.
pub const fn form_parameters(form: Form) -> (Option<f64>, Option<f64>, Option<f64>, Option<With>) {
    match form {
        Form::HingeAbove { from } | Form::Step { from } => (Some(from), None, None, None),
        Form::HingeBelow { to } => (Some(to), None, None, None),
        Form::Logistic { middle, width } | Form::Bump { middle, width } => {
            (Some(middle), Some(width), None, None)
        }
        Form::Power { exponent } => (None, None, Some(exponent), None),
        Form::Product { with, scale } => (None, None, None, Some((with, scale))),
        Form::Offset | Form::Linear | Form::Square => (None, None, None, None),
    }
}

#[cfg(test)]
mod tests {
    use diagnose::Closure;

    use super::*;

    #[test]
    fn forms_read_well() {
        let bump = FoundForm {
            form: Form::Bump { middle: 0.781_2, width: 0.016_3 },
            variable: Variable::Mach,
            acts_on: ActsOn::Thrust,
            size: 9.61,
            size_ci95: [8.81, 10.41],
            rms_percent: 0.4,
            place_ci95: Some([0.779, 0.784]),
            scale: [0.78, 0.02],
            probability: 0.97,
            closure: Some(Closure { share: 0.931, ci95: [0.9, 0.95] }),
        };
        assert_eq!(
            form_words(&bump),
            "drag +9.61 ± 0.80 counts around Mach number 0.7812 (0.7790 to 0.7840), width 0.0163: closes 93 % on unseen flights"
        );
        let line = FoundForm {
            form: Form::Linear,
            variable: Variable::PressureAltitude,
            acts_on: ActsOn::FuelFlow,
            scale: [11_000.0, 600.0],
            closure: None,
            ..bump
        };
        assert_eq!(
            form_words(&line),
            "fuel flow +9.61 ± 0.80 % per 600 m of pressure altitude, zero at 11000 m: how much it closes could not be measured"
        );
        // 2019-05-10T00:00Z is 1 557 446 400 s.
        let dated = FoundForm {
            form: Form::Logistic { middle: 1_557_446_400.0, width: 2.0 * 86_400.0 },
            variable: Variable::Date,
            place_ci95: None,
            scale: [1.55e9, 2e6],
            ..line
        };
        assert!(
            form_words(&dated).contains("beyond date 2019-05-10, over a width of 2 days"),
            "{}",
            form_words(&dated)
        );
    }
}
