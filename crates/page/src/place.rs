//! The anchor of a tail's section on the page, and how much may be drawn in it.

/// Class of elements that belong to the initial (or given) table.
pub(crate) const BEFORE: &str = "before";

/// The anchor of a tail's section, and how much may be drawn in it.
pub(crate) struct Place<'a> {
    /// Tail.
    pub(crate) tail: &'a str,
    /// Unique on the page.
    pub(crate) id: String,
    /// Largest number of points of a chart.
    pub(crate) most_points: usize,
    /// Which charts a tail has.
    pub(crate) detail: Detail,
}

/// Which charts a tail has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Detail {
    /// All.
    Full,
    /// The most important: 200 tails on one page must stay below 6 MB.
    Brief,
}

impl Place<'_> {
    /// An id for an element of this section.
    pub(crate) fn id(&self, what: &str) -> String {
        format!("{}-{what}", self.id)
    }

    /// The note that not everything is drawn.
    pub(crate) fn thinned_words(&self, shown: usize, all: usize, what: &str) -> String {
        format!(
            "Drawn are {shown} of {all} {what}, evenly chosen, at most {} a chart to keep the page small. Figures and \
             tables are of all.",
            self.most_points
        )
    }
}
