//! Classes of effects that these flights cannot tell apart.

use crate::advice::distances::Distances;
use crate::library::{Library, Testable};
use crate::thresholds::{CONFUSED, PLAUSIBLE, PLAUSIBLE_KNOWN};

impl Distances {
    /// Classes at typical sizes: complete linkage of effects whose squared distance, the smaller of both directions, is
    /// below 9.
    pub(crate) fn classes(&self, library: &Library) -> Vec<Vec<usize>> {
        let effects = library.effects.len();
        let distance = |a: usize, b: usize| {
            let (ea, eb) = (&library.effects[a], &library.effects[b]);
            let from = |k: usize, e: &Testable, f: &Testable| {
                self.squared_from_any(k, f.all_columns(), e.typical)
            };
            from(self.leading[a], ea, eb).min(from(self.leading[b], eb, ea))
        };
        let mut classes: Vec<Vec<usize>> = (0..effects).map(|k| vec![k]).collect();
        loop {
            let mut best: Option<(f64, usize, usize)> = None;
            for a in 0..classes.len() {
                for b in a + 1..classes.len() {
                    let linkage = classes[a]
                        .iter()
                        .flat_map(|&i| classes[b].iter().map(move |&j| (i, j)))
                        .map(|(i, j)| distance(i, j))
                        .fold(0.0, f64::max);
                    if linkage < CONFUSED && best.is_none_or(|(d, _, _)| linkage < d) {
                        best = Some((linkage, a, b));
                    }
                }
            }
            let Some((_, a, b)) = best else { break };
            let moved = classes.remove(b);
            classes[a].extend(moved);
            classes[a].sort_unstable();
        }
        classes
    }

    /// Effects that this data cannot tell from one at a size, itself first.
    pub(crate) fn confused_with(&self, library: &Library, column: usize, size: f64) -> Vec<usize> {
        self.nearer_than(library, column, size, |_| 1.0)
    }

    /// The same where no effect need have the form that the library gives it `[diagnosis.61]`.
    pub(crate) fn alike_in_form(&self, library: &Library, column: usize, size: f64) -> Vec<usize> {
        self.nearer_than(library, column, size, |other| {
            self.form_variance(library, [column, other], size)
        })
    }

    fn nearer_than(
        &self,
        library: &Library,
        column: usize,
        size: f64,
        variance: impl Fn(usize) -> f64,
    ) -> Vec<usize> {
        let own = library.columns[column].effect;
        let mut class = vec![own];
        if size * size * self.information(column) < CONFUSED {
            return class; // what is hardly seen at all is not like anything
        }
        for (index, effect) in library.effects.iter().enumerate() {
            if index == own {
                continue;
            }
            let confused = effect.all_columns().any(|l| {
                let (squared, implied) = self.squared(column, l, size);
                let plausible = if effect.has_known_size {
                    (implied - 1.0).abs() < PLAUSIBLE_KNOWN
                } else {
                    implied.abs() < PLAUSIBLE * effect.typical
                };
                plausible && squared < CONFUSED * variance(l)
            });
            if confused {
                class.push(index);
            }
        }
        class
    }
}
