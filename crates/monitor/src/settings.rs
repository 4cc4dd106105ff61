//! Every number that decides in this crate, once, with its reason. All of them are beliefs of before the flights were seen;
//! none was fitted to a fleet.

use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

/// What is believed of a tail's changes before its flights are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangeBeliefs {
    /// Standard deviation of the level between two changes, about the series' middle, %. A typical step (wash, engine
    /// change, recalibration) is 1.5 %.
    pub level_deviation_percent: f64,
    /// Standard deviation of the slope of a tail that ages as fast as the effects of ageing state as typical, % a year:
    /// airframe ageing of 1.2 and engine ageing of 0.8 % a year, added in square.
    pub slope_deviation_percent_per_year: f64,
    /// The same of a tail that hardly ages: between two changes, one is as likely as the other.
    pub small_slope_deviation_percent_per_year: f64,
    /// Standard deviation of what one of a condition (temperature, level, mass) changes a deviation by, %, because the learnt model
    /// took a change over time for it: a third of a typical step.
    pub condition_deviation_percent: f64,
    /// How often something changes that nobody recorded (engine, box, probe, load sheet), a year: however many flights there
    /// are, aircraft change with time.
    pub changes_per_year: f64,
    /// Probability that something changes where an event (wash, engine change) is recorded: most are meant to change
    /// something, not all do. Between two flights without an event it is never more likely, however long the aircraft stood.
    pub change_at_event: f64,
    /// What is done to burn less (a wash, a polish) changes, mean of one tail's and its standard deviation, %: washed compressors are
    /// said to give back 0.3 to 1 %, a washed airframe some tenths. One that gives nothing is a standard deviation off.
    pub to_burn_less_percent: [f64; 2],
    /// Standard deviations of a step that nobody recorded and that no flight shows clearly, %, each as likely: a typical step, and a third of
    /// one (fuel of another supplier, a sensor, standard masses).
    pub unrecorded_step_deviations_percent: [f64; 2],
    /// Largest probability, before the flights are seen, that something changed among those about a date: that nothing did is
    /// never believed to be less likely, however many months they span. Twenty flights in two years may hide a change by the
    /// calendar, which is no sign of one.
    pub change_at_most: f64,
}

impl ChangeBeliefs {
    /// The defaults.
    #[must_use]
    pub const fn of_2026() -> Self {
        Self {
            level_deviation_percent: 1.5,
            slope_deviation_percent_per_year: 1.5,
            small_slope_deviation_percent_per_year: 0.3,
            condition_deviation_percent: 0.5,
            changes_per_year: 1.0,
            change_at_event: 0.5,
            to_burn_less_percent: [-0.5, 0.5],
            unrecorded_step_deviations_percent: [0.5, 1.5],
            change_at_most: 0.5,
        }
    }

    /// The same of a tail that hardly ages.
    #[must_use]
    pub(crate) fn of_a_steady_tail(self) -> Self {
        let slope_deviation_percent_per_year = self.small_slope_deviation_percent_per_year;
        Self { slope_deviation_percent_per_year, ..self }
    }

    /// The same of one engine of several: what changes is any of them, each as likely.
    #[must_use]
    pub fn of_an_engine(self, engines: usize) -> Self {
        Self { change_at_most: 1.0 / (1.0 + engines.max(1) as f64), ..self }
    }

    /// Probability that something changes within a time between two flights where no event is recorded.
    ///
    /// ```text
    /// p = min(1 − exp(−r·Δt), p at an event)                                                   [monitoring.17]
    /// ```
    ///
    /// Flights at the same instant have a minute between them.
    #[must_use]
    pub fn change_within(&self, years: f64) -> f64 {
        let apart = years.max(MINUTE_YEARS);
        (-(-self.changes_per_year * apart).exp_m1()).min(self.change_at_event)
    }
}

/// A minute in years.
const MINUTE_YEARS: f64 = 60.0 / (DAYS_PER_YEAR * SECONDS_PER_DAY);

/// Sets of events that are less probable than this share of the most probable one enter the trend without a step that nobody recorded
/// beside them: with one they count next to nothing.
pub const LEAST_SHARE_WITH_A_STEP: f64 = 0.01;

/// A change is reported where it is more probable than not.
pub const REPORTED_PROBABILITY: f64 = 0.5;

/// Largest standard deviation of a trend as a share of the one believed before the flights, of which it is stated. Our choice:
/// beyond, the flights alone would give it ± 4 % a year (0.8/√(1 − 0.8²) of 1.5, twice), more than any ageing.
pub const MEASURED_TREND_SHARE: f64 = 0.8;

/// Days between two flights from which the time between them is a gap, in which a step may be what a trend is taken for. Our choice: a
/// month; in a shorter time something rarely changes.
pub const GAP_DAYS: f64 = 30.0;

/// Least odds of a step in a gap against a trend at which a trend is stated as one or the other. Our choice: ten to one is what is
/// called strong (Jeffreys 1961).
pub const DOUBTED_TREND_ODDS: f64 = 0.1;

/// Standard deviation of what a standard deviation of a condition over a type's flights changes of the deviation by its model, %, before
/// the flights are seen; the same of squares and products. Our choice: a guide that is a few per cent off is so at the edges of
/// what a type flies, and one condition may make up for another.
pub const MODEL_BY_CONDITION_PERCENT: f64 = 3.0;

/// Flights on either side within which the probability of one change is summed up where no single flight stands out: two
/// weeks of an aircraft that flies one recorded leg a day.
pub const ABOUT_FLIGHTS: usize = 7;

/// Share of the probability that the interval of a change's date holds.
pub const DATE_INTERVAL: f64 = 0.95;

/// Starts of the current piece that are remembered from flight to flight, the most probable ones: the cost of a flight is
/// this many evidences, however long the history.
pub const MOST_STARTS: usize = 300;

/// A start of the current piece that is less probable than this is forgotten. A change of one standard deviation of a flight
/// gains a factor of e^0.5 with each flight: what is forgotten would have needed 40 flights to become likely.
pub const FORGOTTEN_SHARE: f64 = 1e-9;

/// Prior standard deviation of a segment within its flight, %, and its weight in segments: stands in where there are only
/// one or two segments a flight. Flow meters of 0.5 %, two of them averaged, and turbulence.
pub const WITHIN_PRIOR_PERCENT: f64 = 0.5;
/// See [`WITHIN_PRIOR_PERCENT`].
pub const WITHIN_PRIOR_COUNT: f64 = 5.0;

/// Prior standard deviation of what a flight keeps, %, and its weight in flights: stands in until a dozen flights show
/// their own. Heating value 0.3 to 0.6 %, load sheet 0.5 % of mass.
pub const BETWEEN_PRIOR_PERCENT: f64 = 0.6;
/// See [`BETWEEN_PRIOR_PERCENT`].
pub const BETWEEN_PRIOR_COUNT: f64 = 5.0;

/// Flights from which correlation between successive flights is looked for; below, it cannot be seen.
pub const FEWEST_FLIGHTS_OF_A_CORRELATION: usize = 30;
/// Largest correlation that is believed: beyond, a wandering level and a noise that is correlated are the same thing.
pub const LARGEST_CORRELATION: f64 = 0.8;
/// Standard error of the estimated correlation of a white series, over √n, by Monte Carlo (`noise` has the test).
pub const CORRELATION_ERROR: f64 = 1.46;
/// Standard errors below which a correlation is not believed: beyond the 95 % interval of none.
pub const CORRELATION_SEEN: f64 = 2.0;

/// Huber's robust scale (1964, proposal 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobustScale {
    /// Standard deviations beyond which a difference counts as no larger.
    pub limit: f64,
    /// E min(z², c²) of a standard normal z: 2Φ(c) − 1 − 2cφ(c) + 2c²(1 − Φ(c)) at the limit c.
    pub consistency: f64,
}

/// Of how much flights scatter. It has an end as long as fewer than a third of the differences, and so a sixth of the flights, are
/// odd ones (consistency/limit²); of limit 2.5, a thirteenth of the flights, which load sheets may be.
pub const SCALE_OF_SCATTER: RobustScale = RobustScale { limit: 1.5, consistency: 0.778_465_216 };
/// Of scales whose ratio is the correlation: it varies less from series to series.
pub const SCALE_OF_CORRELATION: RobustScale =
    RobustScale { limit: 2.5, consistency: 0.977_559_983 };

/// Flights on either side of a flight whose median it is compared with when outliers are weighed.
pub const MEDIAN_REACH: usize = 5;
/// Degrees of freedom of the Student distribution by which a flight that is off loses weight, as law `bayes` has it.
pub const STUDENT_DEGREES_OF_FREEDOM: f64 = 4.0;
