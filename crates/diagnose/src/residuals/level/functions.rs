//! The remainder over the variables of a state, each function asked only where its variable moved; a block of points at a time.

use effects::Variable;

use crate::baseline::Baseline;
use crate::baseline::smooth::Prepared;
use crate::math::lanes::{LANES, Lanes, add, add_product, map};
use crate::priors::SMOOTH_MOST_KNOTS;
use crate::thresholds::FARTHEST_PRODUCT;

/// Most variables that a remainder has.
const MOST: usize = 8;

/// Most terms: a level, of each variable a slope and a term for each knot, and a product of each pair.
pub(super) const MOST_TERMS: usize = 1 + MOST * (1 + SMOOTH_MOST_KNOTS) + MOST * (MOST - 1) / 2;

/// What the remainder depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct States {
    pub(super) mach: Lanes,
    pub(super) lift_coefficient: Lanes,
    pub(super) pressure_altitude_m: Lanes,
    pub(super) corrected_thrust_n: Lanes,
    pub(super) isa_deviation_k: Lanes,
    pub(super) mass_kg: Lanes,
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

/// The remainder at the points, and how it changes about them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values {
    /// All of it.
    pub(super) sum: Lanes,
    /// Each variable in lengths of its function.
    lengths: [Lanes; MOST],
    functions: [Lanes; MOST],
    /// Each variable as a factor of products, and how all products change with it.
    factors: [Lanes; MOST],
    slopes: [Lanes; MOST],
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

    /// A variable in lengths of its function.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn lengths(&self, one: &Prepared, states: &States) -> Lanes {
        match one.variable() {
            Variable::Mach => one.at(&states.mach),
            Variable::LiftCoefficient => one.at(&states.lift_coefficient),
            Variable::PressureAltitude => one.at(&states.pressure_altitude_m),
            Variable::CorrectedThrust => one.at(&map(&states.corrected_thrust_n, |thrust_n| {
                thrust_n / self.reference_thrust_n
            })),
            Variable::IsaDeviation => one.at(&states.isa_deviation_k),
            Variable::Mass => one.at(&states.mass_kg),
            // As of a state that was flown: not a variable of it.
            _ => one.at(&[0.0; LANES]),
        }
    }

    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn values(&self, states: &States) -> Values {
        let none = [[0.0; LANES]; MOST];
        let (mut lengths, mut functions, mut factors) = (none, none, none);
        let mut sum = [self.level; LANES];
        for (place, one) in self.smooth.iter().enumerate() {
            let z = self.lengths(one, states);
            functions[place] = one.mean(&z);
            factors[place] = factor(&z);
            add(&mut sum, 1.0, &functions[place]);
            lengths[place] = z;
        }
        let mut slopes = none;
        for (place, slope) in slopes.iter_mut().enumerate().take(self.smooth.len()) {
            *slope = self.product(place, &factors);
            add_product(&mut sum, 0.5, &factors[place], slope);
        }
        Values { sum, lengths, functions, factors, slopes }
    }

    /// How much the remainder at other states differs where only some variables do; no number where the functions do not hold
    /// there. Compiled once: it is asked ten times.
    pub(super) fn change(&self, at: &Values, states: &States, moved: &[Variable]) -> Lanes {
        pulp::Arch::new().dispatch(Change { functions: self, at, states, moved })
    }

    /// Means of the products of one factor with others, times these.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn product(&self, place: usize, factors: &[Lanes; MOST]) -> Lanes {
        let mut sum = [0.0; LANES];
        let row = &self.products[place][..self.smooth.len()];
        for (mean, factor) in row.iter().zip(factors) {
            add(&mut sum, *mean, factor);
        }
        sum
    }

    /// Whether a variable at a point lies beyond what was flown.
    pub(super) fn is_beyond_flights(&self, at: &Values, point: usize) -> bool {
        let mut places = self.smooth.iter().zip(&at.lengths);
        places.any(|(one, lengths)| one.is_beyond(lengths[point]))
    }

    /// Whether the functions hold at a point.
    pub(super) fn reach(&self, at: &Values, point: usize) -> bool {
        let mut places = self.smooth.iter().zip(&at.lengths);
        places.all(|(one, lengths)| one.reaches(lengths[point]))
    }

    /// Writes the terms; returns the variance of what they do not hold.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn write(&self, at: &Values, into: &mut [Lanes]) -> Lanes {
        let mut left = [0.0; LANES];
        into[0] = [1.0; LANES];
        let mut place = 1;
        for (one, z) in self.smooth.iter().zip(&at.lengths) {
            let of_one = one.write(z, &mut into[place..place + one.len()]);
            add(&mut left, self.smooth_variance, &of_one);
            place += one.len();
        }
        let factors = &at.factors[..self.smooth.len()];
        for (k, a) in factors.iter().enumerate() {
            for b in &factors[k + 1..] {
                into[place] = [0.0; LANES];
                add_product(&mut into[place], 1.0, a, b);
                place += 1;
            }
        }
        left
    }
}

struct Change<'a> {
    functions: &'a Functions,
    at: &'a Values,
    states: &'a States,
    moved: &'a [Variable],
}

impl pulp::NullaryFnOnce for Change<'_> {
    type Output = Lanes;

    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn call(self) -> Lanes {
        let Self { functions, at, states, moved } = self;
        let mut steps = [[0.0; LANES]; MOST];
        let mut sum = [0.0; LANES];
        for (place, one) in functions.smooth.iter().enumerate() {
            if !moved.contains(&one.variable()) {
                continue;
            }
            let z = functions.lengths(one, states);
            let mut step = factor(&z);
            add(&mut step, -1.0, &at.factors[place]);
            add(&mut sum, 1.0, &one.mean(&z));
            add(&mut sum, -1.0, &at.functions[place]);
            add_product(&mut sum, 1.0, &step, &at.slopes[place]);
            // With each of those that moved before it.
            add_product(&mut sum, 1.0, &step, &functions.product(place, &steps));
            steps[place] = step;
            for (sum, z) in sum.iter_mut().zip(&z) {
                if !one.reaches(*z) {
                    *sum = f64::NAN;
                }
            }
        }
        sum
    }
}

#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn factor(lengths: &Lanes) -> Lanes {
    map(lengths, |z| z.clamp(-FARTHEST_PRODUCT, FARTHEST_PRODUCT))
}
