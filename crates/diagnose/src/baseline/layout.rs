//! Which nuisance column is what.
//!
//! Everything that a model is uncertain about and that no hypothesis names is a column of one block, the nuisance. Writers
//! of the design, the posterior of a baseline and the draws of model errors all take their columns from here by name.

use core::ops::Range;

use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::signals::n2_deck::DECK_TERMS;

/// Columns for the chord errors of a drag table: along lift coefficient and along Mach number.
const CHORD_COLUMNS: usize = 2;

/// Named ranges of nuisance columns, counted from the start of the nuisance. They follow one another without holes; a part
/// that a model does not have is an empty range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct NuisanceLayout {
    /// Terms of the remainder, on fuel flow.
    pub(crate) remainder: Range<usize>,
    /// Levels of the contrasts between engines.
    pub(crate) contrasts: Range<usize>,
    /// Coefficients of the N2 deck.
    pub(crate) deck: Range<usize>,
    /// Sizes of the effects that a fleet shows at all times.
    pub(crate) standing_effects: Range<usize>,
    /// Loadings of the drag table's nodes as a baseline believed them before its flights, on thrust.
    pub(crate) drag: Range<usize>,
    /// Chord errors of the drag table.
    pub(crate) chords: Range<usize>,
    /// Error of the recorded acceleration.
    pub(crate) acceleration: Range<usize>,
    /// What anti-ice bleed changes N2 by.
    pub(crate) bleed: Range<usize>,
    /// Gain of the tank gauges.
    pub(crate) gauges: Range<usize>,
    /// Loadings of the drag table's nodes.
    pub(crate) table: Range<usize>,
    /// Smooth functions beyond what was flown.
    pub(crate) beyond: Range<usize>,
    /// Contrasts between engines that drift.
    pub(crate) drift: Range<usize>,
    /// Level of N2 of an aircraft that did not teach the model.
    pub(crate) n2_level: Range<usize>,
}

/// What is uncertain besides a baseline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Uncertain {
    /// Whether the N2 deck is, where no baseline has one.
    pub(crate) deck: bool,
    /// Whether anti-ice bleed may change N2.
    pub(crate) bleed: bool,
    /// Whether tank gauges are held against the meters.
    pub(crate) gauges: bool,
    /// Loadings of the drag table.
    pub(crate) table_rank: usize,
    /// Columns of smooth functions beyond what was flown.
    pub(crate) beyond: usize,
    /// Contrasts between engines, where they may drift.
    pub(crate) drift: usize,
    /// Levels of N2, where engines of another aircraft than the one that taught the model may turn faster or slower.
    pub(crate) n2_level: usize,
}

impl NuisanceLayout {
    /// Of a baseline alone: what its covariance is over.
    pub(crate) fn of_baseline(remainder: usize, contrasts: usize, drag: usize) -> Self {
        Self::tiled([
            remainder,
            contrasts,
            DECK_TERMS,
            STANDING_EFFECTS.len(),
            drag,
            0,
            0,
            0,
            0,
            0,
            0,
            0,
            0,
        ])
    }

    /// The same, or none where there is no baseline, with what is uncertain at any time: chords, acceleration, and what is named.
    pub(crate) fn of_design(baseline: Option<&Self>, uncertain: Uncertain) -> Self {
        let [remainder, contrasts, deck, standing_effects, drag] = match baseline {
            Some(of) => [&of.remainder, &of.contrasts, &of.deck, &of.standing_effects, &of.drag]
                .map(Range::len),
            None => [0, 0, if uncertain.deck { DECK_TERMS } else { 0 }, 0, 0],
        };
        let [bleed, gauges] = [uncertain.bleed, uncertain.gauges].map(usize::from);
        Self::tiled([
            remainder,
            contrasts,
            deck,
            standing_effects,
            drag,
            CHORD_COLUMNS,
            1,
            bleed,
            gauges,
            uncertain.table_rank,
            uncertain.beyond,
            uncertain.drift,
            uncertain.n2_level,
        ])
    }

    /// Widths in the order of the fields.
    fn tiled(widths: [usize; 13]) -> Self {
        let mut end = 0;
        let mut widths = widths.into_iter();
        let mut next = || {
            let start = end;
            end += widths.next().unwrap_or(0);
            start..end
        };
        Self {
            remainder: next(),
            contrasts: next(),
            deck: next(),
            standing_effects: next(),
            drag: next(),
            chords: next(),
            acceleration: next(),
            bleed: next(),
            gauges: next(),
            table: next(),
            beyond: next(),
            drift: next(),
            n2_level: next(),
        }
    }

    /// Number of columns.
    pub(crate) const fn len(&self) -> usize {
        self.n2_level.end
    }

    /// Columns of a baseline's coefficients: those that its covariance is over.
    pub(crate) const fn of_baseline_range(&self) -> Range<usize> {
        self.remainder.start..self.drag.end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every column belongs to exactly one range.
    fn assert_tiled(layout: &NuisanceLayout) {
        let mut owners = vec![0; layout.len()];
        for range in [
            &layout.remainder,
            &layout.contrasts,
            &layout.deck,
            &layout.standing_effects,
            &layout.drag,
            &layout.chords,
            &layout.acceleration,
            &layout.bleed,
            &layout.gauges,
            &layout.table,
            &layout.beyond,
            &layout.drift,
            &layout.n2_level,
        ] {
            for column in range.clone() {
                owners[column] += 1;
            }
        }
        assert!(owners.iter().all(|&owner| owner == 1), "{layout:?}");
    }

    #[test]
    fn ranges_tile_the_nuisance_without_holes() {
        for contrasts in [0, 1, 3] {
            let baseline = NuisanceLayout::of_baseline(40, contrasts, 7 * contrasts);
            assert_tiled(&baseline);
            assert_eq!(baseline.of_baseline_range(), 0..baseline.len());
            for (table_rank, any) in [(0, false), (285, true)] {
                let uncertain = Uncertain {
                    bleed: any,
                    gauges: any,
                    table_rank,
                    beyond: 6,
                    drift: contrasts,
                    n2_level: usize::from(any),
                    ..Uncertain::default()
                };
                let design = NuisanceLayout::of_design(Some(&baseline), uncertain);
                assert_tiled(&design);
                // What a baseline's covariance is over has the same places in the design.
                assert_eq!(design.of_baseline_range(), baseline.of_baseline_range());
                assert_eq!(design.standing_effects, baseline.standing_effects);
                let others = CHORD_COLUMNS + 1 + 3 * usize::from(any) + table_rank + 6 + contrasts;
                assert_eq!(design.len(), baseline.len() + others);
            }
        }
        for (deck, columns) in [(true, DECK_TERMS), (false, 0)] {
            let uncertain = Uncertain { deck, table_rank: 7, ..Uncertain::default() };
            let design = NuisanceLayout::of_design(None, uncertain);
            assert_tiled(&design);
            assert_eq!(design.len(), columns + CHORD_COLUMNS + 1 + 7);
            assert_eq!(design.deck, 0..columns);
        }
    }
}
