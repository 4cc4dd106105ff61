//! Drag by the initial table and what was learnt of it, at points and about them.

use effects::{BetweenNodes, value_continued};
use lut::{Cell, Outside, SmoothTable, Table};

use crate::math::lanes::{LANES, Lanes};
use crate::residuals::level::covariance::TOGETHER;
use crate::signals::table_uncertainty::TableUncertainty;

/// The initial table as the model was learnt with it, and what was learnt.
#[derive(Clone, Debug)]
pub(super) struct Drag {
    table: Table,
    between_nodes: BetweenNodes,
    smooth: SmoothTable,
    learnt: Option<LearntDrag>,
}

/// What was learnt of the drag table: its mean at the nodes, and what the loadings leave out.
#[derive(Clone, Debug)]
struct LearntDrag {
    uncertainty: TableUncertainty,
    mean: Table,
    left_deviation: Option<Table>,
}

/// Drag at the points of a block.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// The initial table's drag coefficient.
    pub(super) coefficient: Lanes,
    /// What was learnt, of ln drag.
    pub(super) learnt: Lanes,
}

impl Drag {
    /// `None` where what was learnt makes no table.
    pub(super) fn new(
        table: &Table,
        between_nodes: BetweenNodes,
        learnt: Option<(&TableUncertainty, &[f64])>,
    ) -> Option<Self> {
        let learnt = match learnt {
            Some((uncertainty, means)) => Some(LearntDrag::new(uncertainty, means)?),
            None => None,
        };
        Some(Self { table: table.clone(), between_nodes, smooth: SmoothTable::new(table), learnt })
    }

    /// Drag at points; false in `is_known` where there is none, or none that is positive.
    pub(super) fn at(
        &self,
        lift_coefficient: &Lanes,
        mach: &Lanes,
        is_known: &mut [bool; LANES],
    ) -> Found {
        // Where there is no drag a positive number, so that all goes on.
        let mut found = Found { coefficient: [1.0; LANES], learnt: [0.0; LANES] };
        for (place, is_known) in is_known.iter_mut().enumerate() {
            match self.at_one(lift_coefficient[place], mach[place]) {
                Some((coefficient, learnt)) if coefficient > 0.0 => {
                    found.coefficient[place] = coefficient;
                    found.learnt[place] = learnt;
                }
                _ => *is_known = false,
            }
        }
        found
    }

    fn at_one(&self, lift_coefficient: f64, mach: f64) -> Option<(f64, f64)> {
        let grid = self.table.grid();
        if let Ok(cell) = grid.locate(lift_coefficient, mach, Outside::Error) {
            let coefficient = match self.between_nodes {
                BetweenNodes::Smooth => self.smooth.value(&cell),
                BetweenNodes::Straight => self.table.interpolate(&cell),
            };
            let learnt = self.learnt.as_ref().map_or(0.0, |learnt| learnt.mean.interpolate(&cell));
            return Some((coefficient, learnt));
        }
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

    /// Writes the loadings of one of the points; returns the variance that they leave out.
    pub(super) fn write(&self, cell: &Cell, place: usize, into: &mut [f64]) -> f64 {
        let Some(learnt) = &self.learnt else { return 0.0 };
        let slots = into.iter_mut().skip(place).step_by(TOGETHER);
        for (slot, loading) in slots.zip(learnt.uncertainty.loadings(cell)) {
            *slot = loading;
        }
        learnt.left_deviation.as_ref().map_or(0.0, |left| {
            let deviation = left.interpolate(cell);
            deviation * deviation
        })
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
        Some(Self { uncertainty: uncertainty.clone(), mean, left_deviation })
    }
}
