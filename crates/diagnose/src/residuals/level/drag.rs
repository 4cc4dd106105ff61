//! Drag by the initial table and what was learnt of it, at points and about them.

use effects::{BetweenNodes, value_continued};
use lut::{Cells, Outside, SmoothTable, Table};
use perf_model::{GuideLevels, LevelBlock};

use crate::math::lanes::{LANES, Lanes, add, each, map};
use crate::residuals::level::by_level::Planes;
use crate::signals::table_uncertainty::TableUncertainty;

/// The initial table as the model was learnt with it, and what was learnt.
#[derive(Clone, Debug)]
pub(super) struct Drag {
    table: Table,
    between_nodes: BetweenNodes,
    smooth: SmoothTable,
    learnt: Option<LearntDrag>,
    levels: Option<GuideLevels>,
}

/// What was learnt of the drag table: its mean at the nodes, and what the loadings leave out.
#[derive(Clone, Debug)]
struct LearntDrag {
    mean: Table,
    left_deviation: Option<Table>,
}

/// Drag at the points of a block.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// The initial drag coefficient: of the table, times its factor by level.
    pub(super) coefficient: Lanes,
    /// What was learnt, of ln drag.
    pub(super) learnt: Lanes,
}

/// Slopes along ln lift coefficient.
#[derive(Clone, Debug)]
pub(super) struct AlongLift {
    /// Of the initial table's ln drag.
    pub(super) ln_drag: Lanes,
    /// Of what was learnt of it.
    pub(super) learnt: Lanes,
}

impl Drag {
    /// `None` where what was learnt makes no table.
    pub(super) fn new(
        (table, levels): (&Table, Option<&GuideLevels>),
        between_nodes: BetweenNodes,
        learnt: Option<(&TableUncertainty, &[f64])>,
    ) -> Option<Self> {
        let learnt = match learnt {
            Some((uncertainty, means)) => Some(LearntDrag::new(uncertainty, means)?),
            None => None,
        };
        let (smooth, table) = (SmoothTable::new(table), table.clone());
        Some(Self { table, between_nodes, smooth, learnt, levels: levels.cloned() })
    }

    /// The factors by level at the points of a block, moved by so much; `None` where there are none.
    pub(super) fn planes(&self, block: &LevelBlock, by_m: f64) -> Option<Planes> {
        self.levels.as_ref().map(|levels| Planes::at(levels, block, by_m))
    }

    /// Drag at points; false in `is_known` where there is none, or none that is positive.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    pub(super) fn at(
        &self,
        (lift_coefficient, mach): (&Lanes, &Lanes),
        planes: Option<&Planes>,
        is_known: &mut [bool; LANES],
    ) -> Found {
        let mut cells = Cells::default();
        cells.locate(self.table.grid(), lift_coefficient, mach);
        let mut found = self.in_cells(&cells);
        for place in 0..LANES {
            if !cells.is_inside(place) {
                (found.coefficient[place], found.learnt[place]) =
                    self.continued(lift_coefficient[place], mach[place]).unwrap_or((f64::NAN, 0.0));
            }
        }
        if let Some(planes) = planes {
            found.multiply(&planes.factor((lift_coefficient, mach)));
        }
        found.keep_positive(is_known);
        found
    }

    /// Drag at the points of a block; false in `is_known` where it is not positive.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn of_block(
        &self,
        block: &LevelBlock,
        planes: Option<&Planes>,
        is_known: &mut [bool; LANES],
    ) -> Found {
        let mut found = self.in_cells(&block.cells);
        if let Some(planes) = planes {
            found.multiply(&planes.factor((&block.lift_coefficient, &block.mach)));
        }
        found.keep_positive(is_known);
        found
    }

    /// The same, and how both change with lift.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn of_block_along_lift(
        &self,
        block: &LevelBlock,
        planes: Option<&Planes>,
        is_known: &mut [bool; LANES],
    ) -> (Found, AlongLift) {
        let (cells, lift) = (&block.cells, &block.lift_coefficient);
        let (coefficient, slopes) = match self.between_nodes {
            BetweenNodes::Smooth => self.smooth.values_and_slopes_along_x(cells),
            BetweenNodes::Straight => self.table.values_and_slopes_along_x(cells),
        };
        let (learnt, slopes_of_learnt) = match &self.learnt {
            Some(learnt) => learnt.mean.values_and_slopes_along_x(cells),
            None => ([0.0; LANES], [0.0; LANES]),
        };
        let mut found = Found { coefficient, learnt };
        found.keep_positive(is_known);
        let mut ln_drag = each(&slopes, lift, |slope, lift| slope * lift);
        for place in 0..LANES {
            ln_drag[place] /= found.coefficient[place];
        }
        if let Some(planes) = planes {
            let along = planes.along_lift((lift, &block.mach));
            found.multiply(&along.factor);
            add(&mut ln_drag, 1.0, &along.ln_factor);
        }
        let learnt = each(&slopes_of_learnt, lift, |slope, lift| slope * lift);
        (found, AlongLift { ln_drag, learnt })
    }

    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn in_cells(&self, cells: &Cells<LANES>) -> Found {
        let coefficient = match self.between_nodes {
            BetweenNodes::Smooth => self.smooth.values(cells),
            BetweenNodes::Straight => self.table.interpolate_all(cells),
        };
        let learnt = match &self.learnt {
            Some(learnt) => learnt.mean.interpolate_all(cells),
            None => [0.0; LANES],
        };
        Found { coefficient, learnt }
    }

    /// Beyond the table.
    #[cold]
    fn continued(&self, lift_coefficient: f64, mach: f64) -> Option<(f64, f64)> {
        let grid = self.table.grid();
        let smooth = (self.between_nodes == BetweenNodes::Smooth).then_some(&self.smooth);
        let coefficient = value_continued((&self.table, smooth), lift_coefficient, mach)?;
        let learnt = match &self.learnt {
            Some(learnt) => {
                learnt.mean.interpolate(&grid.locate(lift_coefficient, mach, Outside::Hold).ok()?)
            }
            None => 0.0,
        };
        Some((coefficient, learnt))
    }

    /// The variance of what was learnt that its directions leave out.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn left_out(&self, cells: &Cells<LANES>) -> Lanes {
        let left = self.learnt.as_ref().and_then(|learnt| learnt.left_deviation.as_ref());
        match left {
            Some(left) => map(&left.interpolate_all(cells), |deviation| deviation * deviation),
            None => [0.0; LANES],
        }
    }
}

impl Found {
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn multiply(&mut self, factor: &Lanes) {
        self.coefficient = each(&self.coefficient, factor, |drag, factor| drag * factor);
    }

    /// False in `is_known` where drag is not positive; 1 is put there, so that all goes on.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn keep_positive(&mut self, is_known: &mut [bool; LANES]) {
        let Self { coefficient, learnt } = self;
        for place in 0..LANES {
            let is_positive = coefficient[place] > 0.0;
            is_known[place] &= is_positive;
            coefficient[place] = if is_positive { coefficient[place] } else { 1.0 };
            learnt[place] = if is_positive { learnt[place] } else { 0.0 };
        }
    }
}

impl LearntDrag {
    fn new(uncertainty: &TableUncertainty, means: &[f64]) -> Option<Self> {
        let grid = uncertainty.grid();
        let mean = (0..grid.nodes())
            .map(|node| uncertainty.row(node).iter().zip(means).map(|(l, mean)| l * mean).sum());
        let mean = Table::new(grid.clone(), mean.collect()).ok()?;
        let left = uncertainty.left_deviations();
        let left_deviation =
            if left.is_empty() { None } else { Some(Table::new(grid.clone(), left).ok()?) };
        Some(Self { mean, left_deviation })
    }
}
