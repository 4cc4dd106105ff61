//! Sums over all places at once, by prefix sums over bins.

use crate::place::binned_variable::BinnedVariable;
use crate::thresholds::{BINS, REGION_SHARES, SECOND_CONDITION};

/// What is summed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Series {
    /// Fuel flow about its mean.
    FuelFlow,
    /// The same weighed by the noise that flights have in common: what differs within flights counts more.
    WithinFlights,
    /// One engine's difference from the mean of all, as it is.
    Engine(usize),
}

impl Series {
    /// Whether it is one engine alone.
    pub(crate) const fn is_engine(self) -> bool {
        matches!(self, Self::Engine(_))
    }
}

/// A place: bins `low..high` of one or two variables, of all engines or of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BinnedRegion {
    pub(crate) series: Series,
    /// Index of the variable, and its bins.
    pub(crate) ranges: [Option<(usize, usize, usize)>; 2],
    table: usize,
    /// Of the level of all segments.
    share: f64,
}

impl BinnedRegion {
    /// Bins of one variable, in fuel flow.
    pub(crate) const fn of_bins(variable: usize, (low, high): (usize, usize)) -> Self {
        let ranges = [Some((variable, low, high)), None];
        Self { series: Series::FuelFlow, ranges, table: 0, share: 0.0 }
    }

    pub(crate) fn holds(&self, places: &[BinnedVariable], segment: usize) -> bool {
        self.ranges.iter().flatten().all(|&(place, low, high)| {
            let bin = usize::from(places[place].bins[segment]);
            (low..high).contains(&bin)
        })
    }

    /// Whether it is made of the same segments as another, of all engines or of the same one.
    pub(crate) fn is_of_the_segments_of(&self, other: &Self) -> bool {
        let is_engine = |region: &Self| region.series.is_engine();
        let same_series = self.series == other.series || (!is_engine(self) && !is_engine(other));
        same_series && self.ranges == other.ranges
    }

    /// Whether it is all that another leaves, of one variable: what is said of one says the other's.
    pub(crate) fn is_the_rest_of(&self, other: &Self, places: &[BinnedVariable]) -> bool {
        let ([Some((variable, low, high)), None], [Some((same, from, to)), None]) =
            (self.ranges, other.ranges)
        else {
            return false;
        };
        let last = places[variable].count();
        variable == same
            && self.series.is_engine() == other.series.is_engine()
            && ((low == 0 && high == from && to == last)
                || (from == 0 && to == low && high == last))
    }

    /// Everything: no condition at all.
    pub(crate) fn is_everywhere(&self) -> bool {
        self.series == Series::FuelFlow && self.ranges == [None; 2]
    }

    /// Of the statistic: less with a second condition.
    pub(crate) fn weight(&self) -> f64 {
        let engine = usize::from(self.series.is_engine());
        let conditions = engine + self.ranges.iter().flatten().count();
        if conditions > 1 { 1.0 / SECOND_CONDITION } else { 1.0 }
    }

    fn corners(&self) -> [(usize, usize); 2] {
        let [first, second] = self.ranges.map(|range| range.map_or((0, 1), |(_, l, h)| (l, h)));
        [first, second]
    }
}

/// Bins of up to two variables over which one series is summed.
#[derive(Clone, Copy, Debug)]
struct Table {
    series: usize,
    variables: [Option<usize>; 2],
    offset: usize,
}

/// All places that are looked at.
pub(crate) struct Search<'a> {
    places: &'a [BinnedVariable],
    tables: Vec<Table>,
    cells: usize,
    /// Ordered by table.
    pub(crate) regions: Vec<BinnedRegion>,
    series: Vec<Series>,
}

/// Sums over the bins of every table, `width` draws side by side.
pub(crate) struct Sums {
    pub(crate) width: usize,
    cells: Vec<f64>,
    /// Of each series, over all segments.
    totals: Vec<Vec<f64>>,
}

impl<'a> Search<'a> {
    /// `weights` say how much of the level of all segments each one is where segments are weighed; `engines` are looked at one
    /// by one (none where fuel flow is not recorded by engine).
    pub(crate) fn new(places: &'a [BinnedVariable], weights: &[f64], engines: usize) -> Self {
        // Of two engines one series says all: the other's is its negative.
        let apart = if engines == 2 { 1 } else { engines };
        let series: Vec<Series> = [Series::FuelFlow, Series::WithinFlights]
            .into_iter()
            .chain((0..apart).map(Series::Engine))
            .collect();
        let mut search = Self { places, tables: vec![], cells: 0, regions: vec![], series };
        let alike = vec![1.0; weights.len()];
        for k in 0..search.series.len() {
            let within = search.series[k] == Series::WithinFlights;
            let weights = if within { weights } else { &alike };
            if !within {
                search.table(weights, k, [None; 2]);
            }
            for first in 0..places.len() {
                search.table(weights, k, [Some(first), None]);
            }
        }
        for (k, weights) in [&alike[..], weights].into_iter().enumerate() {
            for first in 0..places.len() {
                for second in first + 1..places.len() {
                    search.table(weights, k, [Some(first), Some(second)]);
                }
            }
        }
        search
    }

    fn table(&mut self, weights: &[f64], series: usize, variables: [Option<usize>; 2]) {
        let [rows, columns] = variables.map(|v| v.map_or(1, |place| self.places[place].count()));
        let table = self.tables.len();
        self.tables.push(Table { series, variables, offset: self.cells });
        self.cells += if variables[1].is_some() {
            BINS * BINS
        } else if variables[0].is_some() {
            BINS
        } else {
            1
        };
        // Of each cell: segments, and their weight.
        let mut cells = vec![(0.0, 0.0); rows * columns];
        for (segment, weight) in weights.iter().enumerate() {
            let cell = self.bin(variables[0], segment) * columns + self.bin(variables[1], segment);
            let (segments, weights) = &mut cells[cell];
            *segments += 1.0;
            *weights += weight;
        }
        let whole: f64 = weights.iter().sum();
        for (low, high) in intervals(rows, variables[0].is_some()) {
            for (left, right) in intervals(columns, variables[1].is_some()) {
                let (count, weight) = (low..high)
                    .flat_map(|row| (left..right).map(move |column| row * columns + column))
                    .fold((0.0, 0.0), |sum, cell| (sum.0 + cells[cell].0, sum.1 + cells[cell].1));
                let of_segments = count / weights.len() as f64;
                let mut usual = REGION_SHARES[0]..=REGION_SHARES[1];
                // A switch that is on is a place however seldom it is.
                if variables[1].is_none() && low > 0 && self.is_switch(variables[0]) {
                    usual = f64::MIN_POSITIVE..=REGION_SHARES[1];
                }
                if variables[0].is_some() && !usual.contains(&of_segments) {
                    continue;
                }
                let share = weight / whole;
                let ranges = [
                    variables[0].map(|place| (place, low, high)),
                    variables[1].map(|place| (place, left, right)),
                ];
                let series = self.series[series];
                self.regions.push(BinnedRegion { series, ranges, table, share });
            }
        }
    }

    fn is_switch(&self, place: Option<usize>) -> bool {
        place.is_some_and(|place| self.places[place].is_switch())
    }

    fn bin(&self, place: Option<usize>, segment: usize) -> usize {
        place.map_or(0, |place| usize::from(self.places[place].bins[segment]))
    }

    pub(crate) fn series(&self) -> &[Series] {
        &self.series
    }

    pub(crate) fn sums(&self, width: usize) -> Sums {
        Sums {
            width,
            cells: vec![0.0; self.cells * width],
            totals: vec![vec![0.0; width]; self.series.len()],
        }
    }

    /// Adds segments one after the other from `first` on: values of each series, one row a segment, one value a draw. Table by
    /// table, so that its few sums stay in a near cache.
    pub(crate) fn add(&self, sums: &mut Sums, first: usize, values: &[Vec<f64>]) {
        let width = sums.width;
        for (total, values) in sums.totals.iter_mut().zip(values) {
            for row in values.chunks_exact(width) {
                add_row(total, row);
            }
        }
        for table in &self.tables {
            let [row, column] = table.variables;
            let columns = if column.is_some() { BINS } else { 1 };
            for (segment, values) in (first..).zip(values[table.series].chunks_exact(width)) {
                let cell = columns * self.bin(row, segment) + self.bin(column, segment);
                let at = (table.offset + cell) * width;
                add_row(&mut sums.cells[at..at + width], values);
            }
        }
    }

    /// Hands over the sum over every place, about the level of all segments where fuel flow is looked at, in the order of
    /// regions.
    ///
    /// ```text
    /// S = Σ_{i in place} u_i − Σ_{i in place} w_i/Σ w·Σ u,   w the weights, 1 where segments are not weighed
    /// ```
    pub(crate) fn for_each(&self, sums: &Sums, mut each: impl FnMut(usize, &[f64])) {
        let width = sums.width;
        let mut prefix = vec![0.0; (BINS + 1) * (BINS + 1) * width];
        let mut out = vec![0.0; width];
        let mut made = usize::MAX;
        for (index, candidate) in self.regions.iter().enumerate() {
            if made != candidate.table {
                made = candidate.table;
                self.prefix(sums, made, &mut prefix);
            }
            let [(low, high), (left, right)] = candidate.corners();
            let at = |row: usize, column: usize| {
                let start = (row * (BINS + 1) + column) * width;
                &prefix[start..start + width]
            };
            let corners = [at(high, right), at(low, right), at(high, left), at(low, left)];
            let is_level = candidate.series.is_engine() || candidate.is_everywhere();
            let share = if is_level { 0.0 } else { candidate.share };
            let total = &sums.totals[self.tables[made].series];
            for (k, slot) in out.iter_mut().enumerate() {
                let inside = corners[0][k] - corners[1][k] - corners[2][k] + corners[3][k];
                *slot = inside - share * total[k];
            }
            each(index, &out);
        }
    }

    fn prefix(&self, sums: &Sums, table: usize, prefix: &mut [f64]) {
        let width = sums.width;
        let Table { variables, offset, .. } = self.tables[table];
        let rows = if variables[0].is_some() { BINS } else { 1 };
        let columns = if variables[1].is_some() { BINS } else { 1 };
        for row in 0..rows {
            for column in 0..columns {
                let cell = (offset + row * columns + column) * width;
                let at = |row: usize, column: usize| (row * (BINS + 1) + column) * width;
                for k in 0..width {
                    // Row 0 and column 0 of the prefix stay zero.
                    prefix[at(row + 1, column + 1) + k] = sums.cells[cell + k]
                        + prefix[at(row, column + 1) + k]
                        + prefix[at(row + 1, column) + k]
                        - prefix[at(row, column) + k];
                }
            }
        }
    }
}

fn add_row(into: &mut [f64], row: &[f64]) {
    for (slot, value) in into.iter_mut().zip(row) {
        *slot += value;
    }
}

/// Ranges of bins, all of them together left out unless there is only this one.
pub(super) fn intervals(bins: usize, is_variable: bool) -> Vec<(usize, usize)> {
    if !is_variable {
        return vec![(0, 1)];
    }
    (0..bins)
        .flat_map(|low| (low + 1..=bins).map(move |high| (low, high)))
        .filter(|(low, high)| high - low < bins)
        .collect()
}
