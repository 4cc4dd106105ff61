//! The remainder over the variables of a state, each function asked only where its variable moved; a block of points at a time.

#![expect(clippy::needless_range_loop, reason = "loops count, as those over lanes")]

use core::ops::Range;

use effects::Variable;

use crate::baseline::Baseline;
use crate::baseline::smooth::Prepared;
use crate::math::curve::{Cubics, Curve};
use crate::math::lanes::{LANES, Lanes, add, add_product, each, map};
use crate::residuals::level::states::States;
use crate::thresholds::FARTHEST_PRODUCT;

/// Most variables that a remainder has.
pub(super) const MOST: usize = 8;

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
    smooth: Vec<Tabulated>,
    level: f64,
    /// Means of the products, a row for each factor; each product is there twice.
    products: [[f64; MOST]; MOST],
    reference_thrust_n: f64,
    smooth_variance: f64,
}

/// One of the remainder's functions.
#[derive(Clone, Debug)]
pub(super) struct Tabulated {
    prepared: Prepared,
    mean: Curve,
    /// What its terms leave of the process' variance, but for its growth beyond what was flown.
    left: Curve,
}

/// The remainder at the points, and how it changes about them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values {
    /// All of it.
    pub(super) sum: Lanes,
    /// By how many lengths a variable lies beyond what was flown.
    pub(super) beyond: Lanes,
    /// Each variable in lengths of its function.
    lengths: [Lanes; MOST],
    functions: [Lanes; MOST],
    /// Each variable as a factor of products, and how all products change with it.
    factors: [Lanes; MOST],
    slopes: [Lanes; MOST],
}

impl Functions {
    /// `None` for more variables than are handled here, and for functions that bend too often for a table.
    pub(super) fn new(baseline: &Baseline) -> Option<Self> {
        if baseline.parts.smooth.len() > MOST {
            return None;
        }
        let parts = &baseline.parts;
        let mut means = parts.mean.iter().copied();
        let level = means.next().unwrap_or(0.0);
        let tabulated = |prepared: Prepared| {
            Some(Tabulated { mean: prepared.curve()?, left: prepared.left_curve()?, prepared })
        };
        let smooth: Vec<Tabulated> = parts
            .smooth
            .iter()
            .map(|one| tabulated(one.prepared(means.by_ref().take(one.len()))))
            .collect::<Option<_>>()?;
        let mut products = [[0.0; MOST]; MOST];
        let count = smooth.len();
        let pairs =
            (0..count).flat_map(|first| (first + 1..count).map(move |other| (first, other)));
        for ((first, second), mean) in pairs.zip(means) {
            products[first][second] = mean;
            products[second][first] = mean;
        }
        Some(Self {
            smooth,
            level,
            products,
            reference_thrust_n: parts.references.corrected_thrust_n,
            smooth_variance: baseline.smooth_variance(),
        })
    }

    /// The functions, in order.
    pub(super) fn smooth(&self) -> &[Tabulated] {
        &self.smooth
    }

    /// Places of each one's terms among all of the remainder's; the level has the first one, products come last.
    pub(super) fn places(&self) -> Vec<Range<usize>> {
        let mut next = 1;
        let place = |one: &Tabulated| {
            let start = next;
            next += one.prepared.len();
            start..next
        };
        self.smooth.iter().map(place).collect()
    }

    /// A variable in lengths of its function.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn lengths(&self, one: &Tabulated, states: &States) -> Lanes {
        let one = &one.prepared;
        match one.variable() {
            Variable::Mach => one.at(&states.mach),
            Variable::LiftCoefficient => one.at(&states.lift_coefficient),
            Variable::PressureAltitude => one.at(&states.pressure_altitude_m),
            Variable::CorrectedThrust => {
                let per_reference = 1.0 / self.reference_thrust_n;
                one.at(&map(&states.corrected_thrust_n, |thrust_n| thrust_n * per_reference))
            }
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
        let mut sum = Sum::new(self.level);
        for place in 0..self.smooth.len().min(MOST) {
            let z = self.lengths(&self.smooth[place], states);
            functions[place] = self.add(place, &z, &mut factors, &mut sum);
            lengths[place] = z;
        }
        let mut slopes = none;
        for place in 0..self.smooth.len().min(MOST) {
            slopes[place] = self.product(place, &factors);
        }
        Values { sum: sum.value, beyond: sum.beyond, lengths, functions, factors, slopes }
    }

    /// The remainder alone, and by how many lengths the points lie beyond what was flown, as [`values`](Self::values) has them.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn sum(&self, states: &States) -> (Lanes, Lanes) {
        let mut factors = [[0.0; LANES]; MOST];
        let mut sum = Sum::new(self.level);
        for place in 0..self.smooth.len().min(MOST) {
            let z = self.lengths(&self.smooth[place], states);
            self.add(place, &z, &mut factors, &mut sum);
        }
        (sum.value, sum.beyond)
    }

    /// Adds a function at these lengths and its products with those before it; returns the function.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn add(&self, place: usize, z: &Lanes, factors: &mut [Lanes; MOST], sum: &mut Sum) -> Lanes {
        let one = &self.smooth[place];
        one.prepared.add_beyond(z, &mut sum.beyond);
        let function = one.mean.at_with(z, &mut sum.cubics);
        add(&mut sum.value, 1.0, &function);
        let mut of_others = [0.0; LANES];
        for other in 0..place {
            add(&mut of_others, self.products[place][other], &factors[other]);
        }
        factors[place] = factor(z);
        add_product(&mut sum.value, 1.0, &factors[place], &of_others);
        function
    }

    /// How much the remainder at other states differs where only some variables do. Compiled once: it is asked ten
    /// times.
    pub(super) fn change(&self, at: &Values, states: &States, moved: &[Variable]) -> Lanes {
        pulp::Arch::new().dispatch(Change { functions: self, at, states, moved })
    }

    /// Means of the products of one factor with others, times these.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn product(&self, place: usize, factors: &[Lanes; MOST]) -> Lanes {
        let mut sum = [0.0; LANES];
        for other in 0..self.smooth.len().min(MOST) {
            add(&mut sum, self.products[place][other], &factors[other]);
        }
        sum
    }

    /// The variance of what the terms do not hold.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn left(&self, at: &Values) -> Lanes {
        let mut left = [0.0; LANES];
        for place in 0..self.smooth.len().min(MOST) {
            let (one, z) = (&self.smooth[place], &at.lengths[place]);
            let of_one = each(z, &one.left.at(z), |z, left| one.prepared.left(z, left));
            add(&mut left, self.smooth_variance, &of_one);
        }
        left
    }
}

impl Tabulated {
    pub(super) const fn prepared(&self) -> &Prepared {
        &self.prepared
    }
}

impl Values {
    /// A variable in lengths of its function.
    #[inline]
    pub(super) const fn lengths(&self, function: usize) -> &Lanes {
        &self.lengths[function]
    }

    /// A variable as a factor of products.
    #[inline]
    pub(super) const fn factors(&self, function: usize) -> &Lanes {
        &self.factors[function]
    }
}

/// The remainder as it is summed.
struct Sum {
    value: Lanes,
    beyond: Lanes,
    cubics: Cubics,
}

impl Sum {
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    const fn new(level: f64) -> Self {
        Self { value: [level; LANES], beyond: [0.0; LANES], cubics: [[0.0; 4]; LANES] }
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
        for place in 0..functions.smooth.len().min(MOST) {
            let one = &functions.smooth[place];
            if !moved.contains(&one.prepared.variable()) {
                continue;
            }
            let z = functions.lengths(one, states);
            let mut step = factor(&z);
            add(&mut step, -1.0, &at.factors[place]);
            add(&mut sum, 1.0, &one.mean.at(&z));
            add(&mut sum, -1.0, &at.functions[place]);
            add_product(&mut sum, 1.0, &step, &at.slopes[place]);
            // With each of those that moved before it.
            add_product(&mut sum, 1.0, &step, &functions.product(place, &steps));
            steps[place] = step;
        }
        sum
    }
}

#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn factor(lengths: &Lanes) -> Lanes {
    map(lengths, |z| z.clamp(-FARTHEST_PRODUCT, FARTHEST_PRODUCT))
}
