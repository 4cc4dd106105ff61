//! The remainder over the variables of a state, each function asked only where its variable moved; a block of points at a time.

#![expect(clippy::needless_range_loop, reason = "loops count, as those over lanes")]

use core::ops::Range;

use effects::Variable;

use crate::baseline::smooth::Prepared;
use crate::baseline::{Baseline, within_guide};
use crate::math::curve::{Curve, Fetched};
use crate::math::lanes::{LANES, Lanes, add, add_product, each, map};
use crate::residuals::level::states::{MachSide, States};
use crate::thresholds::FARTHEST_PRODUCT;

/// Most variables that a remainder has.
pub(super) const MOST: usize = 6;

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
    /// Each variable as a factor of products.
    factors: [Lanes; MOST],
    /// Slopes of all of it along each variable in lengths.
    slopes: [Lanes; MOST],
    /// From one side of an error of the Mach number to the other.
    pub(super) rise_by_mach: Lanes,
}

/// Slopes of the remainder along what the variables of a state are made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes {
    pub(super) ln_lift: Lanes,
    pub(super) ln_thrust: Lanes,
    pub(super) ln_mass: Lanes,
    pub(super) pressure_altitude_m: Lanes,
    pub(super) isa_deviation_k: Lanes,
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

    /// The remainder at states, on both sides of errors of their Mach numbers too.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn values(&self, states: &States, sides: &[MachSide; 2]) -> Values {
        let none = [[0.0; LANES]; MOST];
        let (mut lengths, mut factors, mut slopes) = (none, none, none);
        let mut moves = [none, none];
        let mut sum = Sum::new(self.level);
        let mut rise_by_mach = [0.0; LANES];
        for place in 0..self.smooth.len().min(MOST) {
            let one = &self.smooth[place];
            let z = self.lengths(one, states);
            self.add(place, &z, &mut factors, &mut sum);
            slopes[place] = sum.fetched.slopes();
            if let Some(at_sides) = self.lengths_at_sides(one, sides) {
                let [above, below] = &at_sides;
                let above_by = each(above, &z, |at, here| at - here);
                let below_by = each(below, &z, |at, here| at - here);
                add(&mut rise_by_mach, 1.0, &sum.fetched.rises(&above_by, &below_by));
                for side in 0..2 {
                    let there = factor(&at_sides[side]);
                    moves[side][place] = each(&there, &factors[place], |at, here| at - here);
                }
            }
            lengths[place] = z;
        }
        for place in 0..self.smooth.len().min(MOST) {
            let of_products = self.product(place, &factors);
            let ([above, below], z) = (&moves, &lengths[place]);
            let rise = each(&above[place], &below[place], |above, below| above - below);
            add_product(&mut rise_by_mach, 1.0, &rise, &of_products);
            for other in 0..place {
                let mean = self.products[place][other];
                add_product(&mut rise_by_mach, mean, &above[place], &above[other]);
                add_product(&mut rise_by_mach, -mean, &below[place], &below[other]);
            }
            for lane in 0..LANES {
                let is_held = z[lane].abs() > FARTHEST_PRODUCT;
                slopes[place][lane] += if is_held { 0.0 } else { of_products[lane] };
            }
        }
        Values { sum: sum.value, beyond: sum.beyond, lengths, factors, slopes, rise_by_mach }
    }

    /// A variable in lengths of its function on both sides of an error of the Mach number; `None` of one that it does not move.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn lengths_at_sides(&self, one: &Tabulated, sides: &[MachSide; 2]) -> Option<[Lanes; 2]> {
        let (one, [above, below]) = (&one.prepared, sides);
        match one.variable() {
            Variable::Mach => Some([one.at(&above.mach), one.at(&below.mach)]),
            Variable::LiftCoefficient => {
                Some([one.at(&above.lift_coefficient), one.at(&below.lift_coefficient)])
            }
            Variable::CorrectedThrust => {
                let per_reference = 1.0 / self.reference_thrust_n;
                let above = map(&above.corrected_thrust_n, |thrust_n| thrust_n * per_reference);
                let below = map(&below.corrected_thrust_n, |thrust_n| thrust_n * per_reference);
                Some([one.at(&above), one.at(&below)])
            }
            _ => None,
        }
    }

    /// Slopes along what the variables of the states are made of.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn slopes(&self, at: &Values, states: &States) -> Slopes {
        let none = [0.0; LANES];
        let mut found = Slopes {
            ln_lift: none,
            ln_thrust: none,
            ln_mass: none,
            pressure_altitude_m: none,
            isa_deviation_k: none,
        };
        for place in 0..self.smooth.len().min(MOST) {
            let (one, slopes) = (&self.smooth[place].prepared, &at.slopes[place]);
            let per_length = one.per_length();
            match one.variable() {
                Variable::LiftCoefficient => {
                    add_product(&mut found.ln_lift, per_length, slopes, &states.lift_coefficient);
                }
                Variable::CorrectedThrust => {
                    let share = per_length / self.reference_thrust_n;
                    add_product(&mut found.ln_thrust, share, slopes, &states.corrected_thrust_n);
                }
                Variable::Mass => {
                    add_product(&mut found.ln_mass, per_length, slopes, &states.mass_kg);
                }
                Variable::PressureAltitude => {
                    add(&mut found.pressure_altitude_m, per_length, slopes);
                }
                Variable::IsaDeviation => add(&mut found.isa_deviation_k, per_length, slopes),
                _ => {}
            }
        }
        found
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

    /// Adds a function at these lengths and its products with those before it.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn add(&self, place: usize, z: &Lanes, factors: &mut [Lanes; MOST], sum: &mut Sum) {
        let one = &self.smooth[place];
        one.prepared.add_beyond(z, &mut sum.beyond);
        one.mean.fetch(z, &mut sum.fetched);
        add(&mut sum.value, 1.0, &sum.fetched.values());
        let mut of_others = [0.0; LANES];
        for other in 0..place {
            add(&mut of_others, self.products[place][other], &factors[other]);
        }
        factors[place] = factor(z);
        add_product(&mut sum.value, 1.0, &factors[place], &of_others);
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
        let mut left = [[0.0; LANES]; 2];
        for place in 0..self.smooth.len().min(MOST) {
            let (one, z) = (&self.smooth[place], &at.lengths[place]);
            one.prepared.add_left((z, &one.left.at(z)), self.smooth_variance, &mut left);
        }
        let [known, beyond_guide] = &left;
        each(known, beyond_guide, |known, rest| within_guide(known) + rest)
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
    /// The cubics of the function that was added last.
    fetched: Fetched,
}

impl Sum {
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn new(level: f64) -> Self {
        Self { value: [level; LANES], beyond: [0.0; LANES], fetched: Fetched::default() }
    }
}

#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn factor(lengths: &Lanes) -> Lanes {
    map(lengths, |z| z.clamp(-FARTHEST_PRODUCT, FARTHEST_PRODUCT))
}
