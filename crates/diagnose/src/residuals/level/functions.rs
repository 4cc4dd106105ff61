//! The remainder over the variables of a state, each function asked only where its variable moved.

use effects::Variable;

use crate::baseline::Baseline;
use crate::baseline::smooth::Prepared;
use crate::thresholds::FARTHEST_PRODUCT;

/// Most variables that a remainder has.
const MOST: usize = 8;

/// What the remainder depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) mach: f64,
    pub(super) lift_coefficient: f64,
    pub(super) pressure_altitude_m: f64,
    pub(super) corrected_thrust_n: f64,
    pub(super) isa_deviation_k: f64,
    pub(super) mass_kg: f64,
}

pub(super) const MACH: [Variable; 3] =
    [Variable::Mach, Variable::LiftCoefficient, Variable::CorrectedThrust];
pub(super) const TEMPERATURE: [Variable; 1] = [Variable::IsaDeviation];
pub(super) const ALTITUDE: [Variable; 4] = [
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::IsaDeviation,
];
pub(super) const MASS: [Variable; 3] =
    [Variable::LiftCoefficient, Variable::CorrectedThrust, Variable::Mass];
pub(super) const ACCELERATION: [Variable; 1] = [Variable::CorrectedThrust];

/// The remainder's functions.
#[derive(Clone, Debug)]
pub(super) struct Functions {
    smooth: Vec<Prepared>,
    level: f64,
    /// Means of the products, a row for each factor; each product is there twice.
    products: [[f64; MOST]; MOST],
    reference_thrust_n: f64,
    smooth_variance: f64,
    terms: usize,
}

/// The remainder at a point, and how it changes about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values {
    /// All of it.
    pub(super) sum: f64,
    functions: [f64; MOST],
    /// Each variable as a factor of products, and how all products change with it.
    factors: [f64; MOST],
    slopes: [f64; MOST],
}

impl Functions {
    pub(super) fn new(baseline: &Baseline) -> Self {
        let parts = &baseline.parts;
        let mut means = parts.mean.iter().copied();
        let level = means.next().unwrap_or(0.0);
        let smooth: Vec<Prepared> = parts
            .smooth
            .iter()
            .take(MOST)
            .map(|one| one.prepared(means.by_ref().take(one.len())))
            .collect();
        let mut products = [[0.0; MOST]; MOST];
        let count = smooth.len();
        let pairs =
            (0..count).flat_map(|first| (first + 1..count).map(move |other| (first, other)));
        for ((first, second), mean) in pairs.zip(means) {
            products[first][second] = mean;
            products[second][first] = mean;
        }
        Self {
            smooth,
            level,
            products,
            reference_thrust_n: parts.references.corrected_thrust_n,
            smooth_variance: baseline.smooth_variance(),
            terms: baseline.remainder_terms(),
        }
    }

    /// Whether a baseline has no more variables than are handled here.
    pub(super) fn hold(baseline: &Baseline) -> bool {
        baseline.parts.smooth.len() <= MOST
    }

    /// Number of terms.
    pub(super) const fn terms(&self) -> usize {
        self.terms
    }

    fn variable(&self, variable: Variable, state: &State) -> f64 {
        match variable {
            Variable::Mach => state.mach,
            Variable::LiftCoefficient => state.lift_coefficient,
            Variable::PressureAltitude => state.pressure_altitude_m,
            Variable::CorrectedThrust => state.corrected_thrust_n / self.reference_thrust_n,
            Variable::IsaDeviation => state.isa_deviation_k,
            Variable::Mass => state.mass_kg,
            // As of a state that was flown: not a variable of it.
            _ => 0.0,
        }
    }

    pub(super) fn values(&self, state: &State) -> Values {
        let (mut functions, mut factors) = ([0.0; MOST], [0.0; MOST]);
        let mut sum = self.level;
        for (place, one) in self.smooth.iter().enumerate() {
            let z = one.at(self.variable(one.variable(), state));
            functions[place] = one.mean(z);
            factors[place] = factor(z);
            sum += functions[place];
        }
        let slopes = self.products.map(|row| product(&row, &factors));
        sum += 0.5 * product(&factors, &slopes);
        Values { sum, functions, factors, slopes }
    }

    /// How much the remainder at a state differs where only some variables do.
    pub(super) fn change(&self, at: &Values, state: &State, moved: &[Variable]) -> f64 {
        let mut steps = [0.0; MOST];
        let mut sum = 0.0;
        for (place, one) in self.smooth.iter().enumerate() {
            if !moved.contains(&one.variable()) {
                continue;
            }
            let z = one.at(self.variable(one.variable(), state));
            let step = factor(z) - at.factors[place];
            sum += one.mean(z) - at.functions[place] + step * at.slopes[place];
            // With each of those that moved before it.
            sum += step * product(&self.products[place], &steps);
            steps[place] = step;
        }
        sum
    }

    /// Whether a variable lies beyond what was flown.
    pub(super) fn is_beyond_flights(&self, state: &State) -> bool {
        let z = |one: &Prepared| one.at(self.variable(one.variable(), state));
        self.smooth.iter().any(|one| one.is_beyond(z(one)))
    }

    /// Writes the terms; returns the variance of what they do not hold.
    pub(super) fn write(&self, state: &State, into: &mut [f64]) -> f64 {
        let mut factors = [0.0; MOST];
        let mut left = 0.0;
        into[0] = 1.0;
        let mut place = 1;
        for (one, factor_of) in self.smooth.iter().zip(&mut factors) {
            let z = one.at(self.variable(one.variable(), state));
            left += one.write(z, &mut into[place..place + one.len()]);
            *factor_of = factor(z);
            place += one.len();
        }
        let factors = &factors[..self.smooth.len()];
        for (k, a) in factors.iter().enumerate() {
            for b in &factors[k + 1..] {
                into[place] = a * b;
                place += 1;
            }
        }
        left * self.smooth_variance
    }
}

fn product(a: &[f64; MOST], b: &[f64; MOST]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn factor(z: f64) -> f64 {
    z.clamp(-FARTHEST_PRODUCT, FARTHEST_PRODUCT)
}
