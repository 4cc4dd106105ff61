//! The N2 deck: which N2 belongs to which corrected thrust, and the other way round.

use effects::Response;

use crate::thresholds::{FARTHEST_LN_THRUST, SMALLEST_SLOPE};

/// Coefficients of the N2 deck: a full quadratic in four variables.
pub(crate) const DECK_TERMS: usize = 15;
/// Scales that make the deck's variables dimensionless: ln F/δ, Mach number, ln δ, ln θ.
const DECK_SCALES: [f64; 4] = [0.2, 0.05, 0.3, 0.04];

/// The N2 deck: ln(N2/√θt) as a full quadratic.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Deck {
    pub(crate) centers: [f64; 4],
    pub(crate) coefficients: [f64; DECK_TERMS],
}

impl Deck {
    /// Least squares over predictions and the N2 recorded there, %; all zero without any.
    pub(crate) fn fitted(recorded: &[(&Response, f64)]) -> Self {
        let mut deck = Self { centers: [0.0; 4], coefficients: [0.0; DECK_TERMS] };
        if recorded.is_empty() {
            return deck;
        }
        for (response, _) in recorded {
            for (center, variable) in deck.centers.iter_mut().zip(deck_variables(response)) {
                *center += variable / recorded.len() as f64;
            }
        }
        // Ridge of a millionth: with fewer directions flown than the deck has, the rest stays at zero.
        let mut normal = faer::Mat::<f64>::zeros(DECK_TERMS, DECK_TERMS);
        let mut right = faer::Mat::<f64>::zeros(DECK_TERMS, 1);
        for (response, n2_percent) in recorded {
            let terms = deck.terms(response);
            let target = (n2_percent / 100.0).ln() - half_ln_total_temperature_ratio(response);
            for a in 0..DECK_TERMS {
                right[(a, 0)] += terms[a] * target;
                for b in 0..DECK_TERMS {
                    normal[(a, b)] += terms[a] * terms[b];
                }
            }
        }
        for a in 0..DECK_TERMS {
            normal[(a, a)] += 1e-6 * recorded.len() as f64;
        }
        if let Some(factor) = crate::math::cholesky::Cholesky::new(&normal) {
            factor.solve(&mut right);
            for a in 0..DECK_TERMS {
                deck.coefficients[a] = right[(a, 0)];
            }
        }
        deck
    }

    fn scaled(&self, variables: [f64; 4]) -> [f64; 4] {
        core::array::from_fn(|k| (variables[k] - self.centers[k]) / DECK_SCALES[k])
    }

    pub(crate) fn terms(&self, response: &Response) -> [f64; DECK_TERMS] {
        self.terms_of(deck_variables(response))
    }

    fn terms_of(&self, variables: [f64; 4]) -> [f64; DECK_TERMS] {
        let v = self.scaled(variables);
        let mut terms = [1.0; DECK_TERMS];
        terms[1..5].copy_from_slice(&v);
        let mut at = 5;
        for a in 0..4 {
            for b in a..4 {
                terms[at] = v[a] * v[b];
                at += 1;
            }
        }
        terms
    }

    /// ln N2 that the deck predicts.
    pub(crate) fn value(&self, response: &Response) -> f64 {
        self.value_with_thrust(response, 0.0)
    }

    /// The same with another thrust: ln of the ratio.
    pub(crate) fn value_with_thrust(&self, response: &Response, ln_ratio: f64) -> f64 {
        let mut variables = deck_variables(response);
        variables[0] += ln_ratio;
        self.of_terms(&self.terms_of(variables)) + half_ln_total_temperature_ratio(response)
    }

    /// ln(N2/√θt) at these terms.
    pub(crate) fn of_terms(&self, terms: &[f64; DECK_TERMS]) -> f64 {
        terms.iter().zip(&self.coefficients).map(|(t, c)| t * c).sum()
    }

    pub(crate) fn slope(&self, response: &Response) -> f64 {
        let v = self.scaled(deck_variables(response));
        let c = &self.coefficients;
        (c[1] + 2.0 * c[5] * v[0] + c[6] * v[1] + c[7] * v[2] + c[8] * v[3]) / DECK_SCALES[0]
    }

    /// The corrected thrust that a recorded N2 belongs to at the Mach number, pressure and temperature of `response`, N:
    /// the deck's quadratic solved for ln F/δ, from the predicted thrust on.
    ///
    /// ```text
    /// c d² + s d = ln N2 − ln N2_deck,   d = 2 r/(s + √(s² + 4 c r)),   F/δ = (F/δ)_predicted·eᵈ      [diagnosis.43]
    /// ```
    ///
    /// s and c are slope and half the curvature of the deck at the predicted thrust, r the right-hand side. This root is the
    /// one on the branch that the prediction is on, and r/s for a straight deck. `None` where the deck rises by less than
    /// 0.02 per unit of ln F, there or at the solution, or where the solution is more than 0.2 in ln F/δ away.
    pub(crate) fn corrected_thrust_n(&self, n2_percent: f64, response: &Response) -> Option<f64> {
        let above = (n2_percent / 100.0).ln() - self.value(response);
        let slope = self.slope(response);
        let half_curvature = self.coefficients[5] / (DECK_SCALES[0] * DECK_SCALES[0]);
        // The slope at the solution; NaN where the deck never gets there.
        let there = (slope * slope + 4.0 * half_curvature * above).sqrt();
        let distance = 2.0 * above / (slope + there);
        let tells = slope >= SMALLEST_SLOPE
            && there >= SMALLEST_SLOPE
            && distance.abs() <= FARTHEST_LN_THRUST;
        tells.then(|| (response.ln_corrected_thrust + distance).exp())
    }
}

fn deck_variables(response: &Response) -> [f64; 4] {
    [
        response.ln_corrected_thrust,
        response.mach,
        response.ln_pressure_ratio,
        response.ln_temperature_ratio,
    ]
}

/// ½ ln θt, θt = θ(1 + 0.2 M²).
fn half_ln_total_temperature_ratio(response: &Response) -> f64 {
    0.5 * (response.ln_temperature_ratio + (0.2 * response.mach * response.mach).ln_1p())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point at M 0.80, δ 0.19, θ 0.77 with the predicted thrust F/δ = 60 000 N.
    fn response() -> Response {
        Response {
            ln_fuel_flow_total: 0.0,
            ln_fuel_flow_engine: [0.0; flight::MAXIMUM_ENGINES],
            ln_corrected_thrust: 60_000.0_f64.ln(),
            ln_pressure_ratio: 0.19_f64.ln(),
            ln_temperature_ratio: 0.77_f64.ln(),
            mach: 0.80,
            lift_coefficient: 0.4,
            drag_over_thrust: 1.0,
            net_thrust_n: 11_400.0,
            unit_reynolds_number_per_m: 6e6,
            mass_kg: 13_500.0,
        }
    }

    /// ln(N2/√θt) = −0.1 + 0.16 l + q l² + 0.04 (M − 0.8), l = ln(F/δ / 60 000 N).
    fn deck(q: f64) -> Deck {
        let mut coefficients = [0.0; DECK_TERMS];
        coefficients[0] = -0.1;
        coefficients[1] = 0.16 * 0.2;
        coefficients[2] = 0.04 * 0.05;
        coefficients[5] = q * 0.2 * 0.2;
        Deck { centers: [60_000.0_f64.ln(), 0.8, 0.19_f64.ln(), 0.77_f64.ln()], coefficients }
    }

    /// N2 of an engine with that deck at l = ln(F/δ / 60 000 N), written out: θt = 0.77·(1 + 0.2·0.64) = 0.868 56.
    fn n2_percent(q: f64, l: f64) -> f64 {
        100.0 * (-0.1 + 0.16 * l + q * l * l).exp() * 0.868_56_f64.sqrt()
    }

    #[test]
    fn thrust_by_n2_by_hand() {
        // A straight deck: N2 0.8 % higher is ln 1.008/0.16 = 4.980 % more of ln F.
        let found = deck(0.0).corrected_thrust_n(1.008 * n2_percent(0.0, 0.0), &response());
        assert!((found.unwrap() / (60_000.0 * (1.008_f64.ln() / 0.16).exp()) - 1.0).abs() < 1e-12);
        // A bent one, that of the virtual fleet: from thrust to N2 and back, on both sides of the prediction.
        for q in [-0.05, 0.03] {
            for l in [-0.19, -0.08, 0.0, 0.05, 0.19_f64] {
                let found = deck(q).corrected_thrust_n(n2_percent(q, l), &response()).unwrap();
                assert!((found / (60_000.0 * l.exp()) - 1.0).abs() < 1e-12, "{q} {l}: {found}");
            }
        }
        // At another predicted thrust the same N2 belongs to the same thrust.
        let elsewhere = Response { ln_corrected_thrust: 55_000.0_f64.ln(), ..response() };
        let found = deck(-0.05).corrected_thrust_n(n2_percent(-0.05, 0.05), &elsewhere).unwrap();
        assert!((found / (60_000.0 * 0.05_f64.exp()) - 1.0).abs() < 1e-12);
    }

    /// From N2 of a known deck, over l, Mach number, δ and θ that vary apart, back to its coefficients.
    #[test]
    fn a_fitted_deck_is_the_one_that_it_was_made_of() {
        let mut responses = Vec::new();
        for (k, l) in [-0.3, -0.1, 0.0, 0.15, 0.3_f64].into_iter().enumerate() {
            for (j, mach) in [0.72, 0.80, 0.86].into_iter().enumerate() {
                for ln_pressure_ratio in [-1.9, -1.6, -1.4] {
                    for ln_temperature_ratio in [-0.30, -0.26, -0.21] {
                        responses.push(Response {
                            ln_corrected_thrust: 60_000.0_f64.ln() + l + 0.01 * (j * k % 3) as f64,
                            mach,
                            ln_pressure_ratio,
                            ln_temperature_ratio,
                            ..response()
                        });
                    }
                }
            }
        }
        let n2 = |r: &Response| {
            let l = r.ln_corrected_thrust - 60_000.0_f64.ln();
            let theta_t = r.ln_temperature_ratio.exp() * (1.0 + 0.2 * r.mach * r.mach);
            100.0 * (-0.1 + 0.16 * l - 0.05 * l * l + 0.04 * (r.mach - 0.8)).exp() * theta_t.sqrt()
        };
        let recorded: Vec<_> = responses.iter().map(|r| (r, n2(r))).collect();
        let found = Deck::fitted(&recorded);
        for r in &responses {
            let l = r.ln_corrected_thrust - 60_000.0_f64.ln();
            assert!((found.slope(r) - (0.16 - 0.1 * l)).abs() < 1e-4, "{l} {}", found.slope(r));
            let thrust = found.corrected_thrust_n(n2(r), r).unwrap();
            assert!((thrust / r.ln_corrected_thrust.exp() - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn a_deck_that_does_not_tell_thrust_says_so() {
        // Beyond 0.2 in ln F/δ.
        assert_eq!(deck(-0.05).corrected_thrust_n(n2_percent(-0.05, 0.21), &response()), None);
        // Bent so much that N2 rises no further: 0.16 l − 0.6 l² has its summit at l = 0.133 (0.010 67); 1.2 % more N2 is
        // on no branch, 1.06 % (l = 0.12, where the slope is 0.016) too near the summit.
        let at = |above: f64| {
            deck(-0.6).corrected_thrust_n(n2_percent(-0.6, 0.0) * above.exp(), &response())
        };
        assert_eq!(at(0.012), None);
        assert_eq!(at(0.16 * 0.12 - 0.6 * 0.12 * 0.12), None);
        assert!(at(0.16 * 0.10 - 0.6 * 0.10 * 0.10).is_some());
        // A deck that was never fitted.
        let flat = Deck { centers: [0.0; 4], coefficients: [0.0; DECK_TERMS] };
        assert_eq!(flat.corrected_thrust_n(90.0, &response()), None);
    }
}
