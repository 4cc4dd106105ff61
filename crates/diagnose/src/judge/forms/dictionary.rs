//! The dictionary of forms: functions of one variable with the places and widths that are tried, and products of two.

use effects::{Form, Variable};

use crate::hypotheses::design::Acts;
use crate::math::quantile::{QuantileType, quantile};
use crate::priors::{FORM_EXPONENTS, FORM_PLACES, FORM_WIDTHS};

/// Steps on either side of a place in a closer grid.
const FINER: i32 = 4;
/// Factors of a width in the closer grid, and in the one about its best.
const FINER_WIDTHS: [f64; 5] = [0.5, 0.7, 1.0, 1.4, 2.0];
const FINEST_WIDTHS: [f64; 5] = [0.84, 0.92, 1.0, 1.09, 1.19];

/// A variable over the segments, and what a function of it acts on.
#[derive(Clone, Debug)]
pub(crate) struct Values {
    pub(crate) variable: Variable,
    pub(crate) acts: Acts,
    pub(crate) mean: f64,
    pub(crate) deviation: f64,
    of_segments: Vec<f64>,
    sorted: Vec<f64>,
}

/// A form of one variable, or of a product.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) form: Form,
    /// Index among the variables.
    pub(crate) variable: usize,
    /// Index of the other factor of a product.
    other: usize,
    /// ln of its share of the belief in all forms.
    pub(crate) ln_prior: f64,
}

impl Values {
    /// `None` where the variable does not vary.
    pub(crate) fn new(variable: Variable, acts: Acts, of_segments: Vec<f64>) -> Option<Self> {
        let count = of_segments.len() as f64;
        let mean = of_segments.iter().sum::<f64>() / count;
        let square = of_segments.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
        let deviation = square.sqrt();
        if !deviation.is_finite() || deviation <= f64::EPSILON * mean.abs() {
            return None;
        }
        let mut sorted = of_segments.clone();
        sorted.sort_by(f64::total_cmp);
        Some(Self { variable, acts, mean, deviation, of_segments, sorted })
    }

    fn quantile(&self, share: f64) -> f64 {
        quantile(&self.sorted, share, QuantileType::Type7)
    }
}

impl Candidate {
    /// Whether only parameters differ.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.variable == other.variable
            && self.other == other.other
            && self.form.is_like(other.form)
    }

    /// Where it lies, for a form that has a place.
    pub(crate) const fn place(&self) -> Option<f64> {
        match self.form {
            Form::HingeAbove { from } | Form::Step { from } => Some(from),
            Form::HingeBelow { to } => Some(to),
            Form::Logistic { middle, .. } | Form::Bump { middle, .. } => Some(middle),
            _ => None,
        }
    }

    /// Its value at a segment.
    pub(crate) fn value(&self, values: &[Values], segment: usize) -> f64 {
        let of = &values[self.variable];
        let with = values[self.other].of_segments[segment];
        self.form.value(of.of_segments[segment], [of.mean, of.deviation], with)
    }
}

/// Every form of every variable: alike probable by kind, within a kind by parameters.
pub(crate) fn candidates(values: &[Values]) -> Vec<Candidate> {
    let mut all = Vec::new();
    for (variable, of) in values.iter().enumerate() {
        // An offset is over no variable: one of each kind that acts is all there is.
        let again = values[..variable].iter().any(|before| before.acts == of.acts);
        for forms in forms_of(of) {
            if again && forms == [Form::Offset] {
                continue;
            }
            let ln_prior = -(forms.len() as f64).ln();
            let one = |form| Candidate { form, variable, other: variable, ln_prior };
            all.extend(forms.into_iter().map(one));
        }
        for (other, with) in values.iter().enumerate().skip(variable + 1) {
            if with.variable != of.variable && with.acts == of.acts {
                let scale = [with.mean, with.deviation];
                let form = Form::Product { with: with.variable, scale };
                all.push(Candidate { form, variable, other, ln_prior: 0.0 });
            }
        }
    }
    all
}

/// A closer grid about one candidate: places and widths between the neighbours that were tried.
pub(crate) fn finer(values: &[Values], one: &Candidate) -> Vec<Candidate> {
    let forms =
        closer(one.form, reach(&values[one.variable]), FINER_WIDTHS, [-0.5, -0.25, 0.0, 0.25, 0.5]);
    // The closer grid covers what one step of the coarse one stood for, and its neighbours.
    let steps = forms.len() as f64;
    let ln_prior = one.ln_prior + if steps > 1.0 { (2.0 / steps).ln() } else { 0.0 };
    forms.into_iter().map(|form| Candidate { form, ln_prior, ..*one }).collect()
}

/// The same about a candidate of the closer grid, each as probable as that one: they stand for it, for the best of them to be told.
pub(crate) fn finest(values: &[Values], one: &Candidate) -> Vec<Candidate> {
    let reach = reach(&values[one.variable]) / f64::from(FINER);
    let forms = closer(one.form, reach, FINEST_WIDTHS, [-0.12, -0.06, 0.0, 0.06, 0.12]);
    forms.into_iter().map(|form| Candidate { form, ..*one }).collect()
}

/// How far apart the places of the coarse grid are, in the mean.
fn reach(of: &Values) -> f64 {
    (of.quantile(0.95) - of.quantile(0.05)) / FORM_PLACES as f64
}

/// Forms about one: places within `reach`, widths by factors, exponents by steps.
fn closer(one: Form, reach: f64, by: [f64; 5], steps: [f64; 5]) -> Vec<Form> {
    let places = |middle: f64| {
        (-FINER..=FINER).map(move |step| middle + reach * f64::from(step) / f64::from(FINER))
    };
    let widths = |width: f64| by.map(|by| by * width);
    match one {
        Form::HingeAbove { from } => places(from).map(|from| Form::HingeAbove { from }).collect(),
        Form::HingeBelow { to } => places(to).map(|to| Form::HingeBelow { to }).collect(),
        Form::Step { from } => places(from).map(|from| Form::Step { from }).collect(),
        Form::Logistic { middle, width } => places(middle)
            .flat_map(|middle| widths(width).map(|width| Form::Logistic { middle, width }))
            .collect(),
        Form::Bump { middle, width } => places(middle)
            .flat_map(|middle| widths(width).map(|width| Form::Bump { middle, width }))
            .collect(),
        Form::Power { exponent } => {
            steps.map(|by| Form::Power { exponent: exponent + by }).to_vec()
        }
        form => vec![form],
    }
}

/// Forms of a variable, kind by kind.
fn forms_of(of: &Values) -> Vec<Vec<Form>> {
    let places: Vec<f64> =
        (1..=FORM_PLACES).map(|k| of.quantile(k as f64 / (FORM_PLACES + 1) as f64)).collect();
    let span = of.quantile(0.95) - of.quantile(0.05);
    let widths = FORM_WIDTHS.map(|share| share * span);
    let with_width = |form: fn(f64, f64) -> Form| -> Vec<Form> {
        places.iter().flat_map(|&place| widths.map(|width| form(place, width))).collect()
    };
    let mut all = vec![
        vec![Form::Offset],
        vec![Form::Linear],
        vec![Form::Square],
        places.iter().map(|&from| Form::HingeAbove { from }).collect(),
        places.iter().map(|&to| Form::HingeBelow { to }).collect(),
        places.iter().map(|&from| Form::Step { from }).collect(),
        with_width(|middle, width| Form::Logistic { middle, width }),
        with_width(|middle, width| Form::Bump { middle, width }),
    ];
    if of.sorted.first().is_some_and(|least| *least > 0.0) {
        all.push(FORM_EXPONENTS.map(|exponent| Form::Power { exponent }).to_vec());
    }
    if span <= 0.0 {
        all.truncate(3);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(form: Form) -> Candidate {
        Candidate { form, variable: 0, other: 0, ln_prior: 0.0 }
    }

    /// Every form by hand at x = 2, where 0, 2 and 4 were flown: mean 2, deviation √(8/3).
    #[test]
    fn forms_by_hand() {
        let values = [Values::new(Variable::Mach, Acts::FuelFlow, vec![0.0, 2.0, 4.0]).unwrap()];
        let deviation = (8.0_f64 / 3.0).sqrt();
        let at = |form: Form, segment: usize| one(form).value(&values, segment);
        for (form, segment, expected) in [
            (Form::Offset, 0, 1.0),
            (Form::Linear, 2, 2.0 / deviation),
            (Form::Square, 2, 1.5),
            (Form::Power { exponent: 3.0 }, 2, 7.0),
            (Form::HingeAbove { from: 1.0 }, 2, 3.0 / deviation),
            (Form::HingeAbove { from: 1.0 }, 0, 0.0),
            (Form::HingeBelow { to: 1.0 }, 0, 1.0 / deviation),
            (Form::Step { from: 2.0 }, 1, 1.0),
            (Form::Step { from: 2.0 }, 0, 0.0),
            (Form::Logistic { middle: 2.0, width: 0.5 }, 1, 0.5),
            (Form::Logistic { middle: 2.0, width: 0.5 }, 2, 1.0 / (1.0 + (-4.0_f64).exp())),
            (Form::Bump { middle: 2.0, width: 2.0 }, 0, (-0.5_f64).exp()),
        ] {
            assert!((at(form, segment) - expected).abs() < 1e-12, "{form:?}");
        }
        assert!(Values::new(Variable::Mach, Acts::FuelFlow, vec![0.8; 5]).is_none());
    }

    #[test]
    fn each_kind_has_one_share_of_the_belief() {
        let values: Vec<f64> = (1..=100).map(f64::from).collect();
        let values = [Values::new(Variable::Mach, Acts::FuelFlow, values).unwrap()];
        let all = candidates(&values);
        let total: f64 = all.iter().map(|one| one.ln_prior.exp()).sum();
        assert!((total - 9.0).abs() < 1e-9, "{total}");
    }
}
