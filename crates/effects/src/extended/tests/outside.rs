//! Forms outside the library in a model.

use super::*;
use crate::error::EffectModelError;
use crate::form::{AppliedForm, Form};
use crate::variable::Variable;

/// 10 counts or 1 % around Mach number 0.78.
fn bump(acts_on: StepTarget, size: f64) -> AppliedForm {
    AppliedForm {
        form: Form::Bump { middle: 0.78, width: 0.02 },
        variable: Variable::Mach,
        scale: [0.76, 0.03],
        acts_on,
        size,
        standard_deviation: 0.1,
    }
}

fn containing(form: AppliedForm) -> Result<ExtendedModel, EffectModelError> {
    let layer =
        AppliedLayer { effects: Effects::none(), forms: vec![form], references: references() };
    bare().with_effects(AppliedEffects::new(vec![layer]))
}

fn flow(model: &ExtendedModel, point: &FlightPoint) -> f64 {
    model.predict(point).unwrap().fuel_flow_total.to_kilograms_per_second()
}

/// By hand: M 0.8 is one width above the middle, where the bump is e^(−1/2). In level flight thrust is drag and TSFC does not
/// depend on it, so that fuel flow grows as the drag coefficient does.
#[test]
fn a_bump_by_hand() {
    let (plain, point) = (bare(), flight_point());
    let share = (-0.5_f64).exp();
    let before = plain.predict(&point).unwrap();
    let by_drag = containing(bump(StepTarget::Drag, 10.0)).unwrap();
    let after = by_drag.predict(&point).unwrap();
    let drag = before.drag_coefficient + 10.0e-4 * share;
    assert!((after.drag_coefficient / drag - 1.0).abs() < 1e-12);
    let ratio = flow(&by_drag, &point) / flow(&plain, &point);
    assert!((ratio - drag / before.drag_coefficient).abs() < 1e-12, "{ratio}");
    let by_fuel = containing(bump(StepTarget::FuelFlow, 1.0)).unwrap();
    let ratio = flow(&by_fuel, &point) / flow(&plain, &point);
    assert!((ratio.ln() - 0.01 * share).abs() < 1e-12, "{ratio}");
    assert_eq!(by_fuel.effects().unwrap().at_reference(&point), vec![]);
}

/// A variable that a point lacks is at its mean: a straight line over it is then nothing, a product as well.
#[test]
fn what_a_point_lacks_is_at_its_mean() {
    let center = Variable::CenterOfGravity;
    let line = AppliedForm {
        form: Form::Linear,
        variable: center,
        scale: [24.0, 2.0],
        ..bump(StepTarget::FuelFlow, 1.0)
    };
    let product = AppliedForm {
        form: Form::Product { with: center, scale: [24.0, 2.0] },
        ..bump(StepTarget::FuelFlow, 1.0)
    };
    let there = flight_point();
    let without = FlightPoint { center_of_gravity_percent_mac: None, ..there };
    let plain = flow(&bare(), &there);
    // The point's center of gravity is one deviation in front of the mean, its Mach number 4/3 above.
    for (form, expected) in [(line, -1.0), (product, -4.0 / 3.0)] {
        let model = containing(form).unwrap();
        assert!((100.0 * (flow(&model, &there) / plain).ln() - expected).abs() < 1e-9, "{form:?}");
        assert!((flow(&model, &without) / plain - 1.0).abs() < 1e-15, "{form:?}");
        let lacking = model.effects().unwrap().at_reference(&without);
        assert_eq!(lacking, vec![(AtReference::Outside, "cg_percent_mac")]);
    }
}

/// A dated form acts at a point's date, and without one on the date of its references.
#[test]
fn a_date_is_that_of_the_point_or_of_the_references() {
    let later = AppliedForm {
        form: Form::Step { from: DATE_S - 0.5 * YEAR_S },
        variable: Variable::Date,
        scale: [DATE_S, YEAR_S],
        ..bump(StepTarget::FuelFlow, 2.0)
    };
    let (model, there) = (containing(later).unwrap(), flight_point());
    let undated = FlightPoint { date: None, ..there };
    let plain = flow(&bare(), &there);
    assert!((flow(&model, &there) / plain - 0.02_f64.exp()).abs() < 1e-12);
    assert!((flow(&model, &undated) / plain - 1.0).abs() < 1e-15);
    assert_eq!(
        model.effects().unwrap().at_reference(&undated),
        vec![(AtReference::Outside, "date")]
    );
}

#[test]
fn numbers_and_variables_that_make_no_model_are_refused() {
    let good = bump(StepTarget::Drag, 5.0);
    let refused = |form: AppliedForm| containing(form).unwrap_err().to_string();
    assert_eq!(
        refused(AppliedForm { form: Form::Bump { middle: 0.78, width: 0.0 }, ..good }),
        "width of a form outside the library is 0, expected a positive number"
    );
    assert_eq!(
        refused(AppliedForm { size: f64::NAN, ..good }),
        "size of a form outside the library is NaN, expected a finite number"
    );
    assert_eq!(
        refused(AppliedForm { scale: [0.76, -0.03], ..good }),
        "deviation of a form outside the library is -0.03, expected a positive number"
    );
    assert_eq!(
        refused(AppliedForm { form: Form::Linear, variable: Variable::FuelUsed, ..good }),
        "a function of fuel used says something of what was recorded, and is no part of a prediction"
    );
}

/// By hand: with 5 % more drag by the first form, corrected thrust is 5 % more where the second is over it.
#[test]
fn a_later_form_is_over_the_thrust_that_it_was_found_over() {
    let form = |form, variable, acts_on, size| AppliedForm {
        form,
        variable,
        scale: [1.0, 0.1],
        acts_on,
        size,
        standard_deviation: 0.1,
    };
    let point = flight_point();
    let plain = bare().predict(&point).unwrap();
    let five_percent = 0.05 * plain.drag_coefficient / 1e-4;
    let drag = form(Form::Offset, Variable::Mach, StepTarget::Drag, five_percent);
    let over_thrust = form(Form::Linear, Variable::CorrectedThrust, StepTarget::FuelFlow, 1.0);
    let layer = |form| AppliedLayer {
        effects: Effects::none(),
        forms: vec![form],
        references: references(),
    };
    let both = AppliedEffects::new(vec![layer(drag), layer(over_thrust)]);
    let model = bare().with_effects(both).unwrap();
    let pressure_ratio = plain.static_pressure.to_pascals() / 101_325.0;
    let thrust = 1.05 * plain.net_thrust.to_newtons() / pressure_ratio / 60_000.0;
    let expected = 1.05_f64.ln() + 0.01 * (thrust - 1.0) / 0.1;
    let ratio = flow(&model, &point) / flow(&bare(), &point);
    assert!((ratio.ln() - expected).abs() < 1e-12, "{ratio} {expected}");
}

/// A sensor's error moves the point that a form is over: Mach number reads 0.01 high, so that M 0.79 was flown.
#[test]
fn a_form_is_over_what_was_flown() {
    let model = containing(bump(StepTarget::FuelFlow, 1.0)).unwrap();
    let plain = bare();
    let [contained, bare] = [&model, &plain]
        .map(|model| EffectModel::new(model, model.drag_table(), references()).unwrap());
    let point = crate::point::EffectPoint::from_flight_point(&flight_point(), 2).unwrap();
    let biased = Effects::one(EffectId::MachBias, 0.01);
    let of = |model: &EffectModel<'_>| model.response(&point, &biased).unwrap().ln_fuel_flow_total;
    let share = (-0.5 * 0.5_f64.powi(2)).exp();
    assert!((of(&contained) - of(&bare) - 0.01 * share).abs() < 1e-12);
}

/// A power of what is not positive is no number: the point is refused, and not predicted as NaN.
#[test]
fn a_power_without_a_value_is_refused() {
    let power = AppliedForm {
        form: Form::Power { exponent: 0.5 },
        variable: Variable::IsaDeviation,
        scale: [10.0, 3.0],
        ..bump(StepTarget::FuelFlow, 1.0)
    };
    let model = containing(power).unwrap();
    let colder =
        FlightPoint { isa_deviation: units::TemperatureDifference::kelvin(-5.0), ..flight_point() };
    let refusal = model.predict(&colder).unwrap_err().to_string();
    assert!(refusal.contains("has no value at this point"), "{refusal}");
    let of_mean = AppliedForm { scale: [0.0, 3.0], ..power };
    assert_eq!(
        containing(of_mean).unwrap_err().to_string(),
        "mean of a form outside the library is 0, expected a positive number"
    );
}
