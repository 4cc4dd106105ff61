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
    /// How much a drawing holds beside what is seen.
    pub(crate) detail: Detail,
}

/// How much a drawing holds beside what is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Detail {
    /// Words under the pointer for every cell.
    Full,
    /// None: the page holds very many tails.
    Brief,
}

impl Place<'_> {
    /// An id for an element of this section.
    pub(crate) fn id(&self, what: &str) -> String {
        format!("{}-{what}", self.id)
    }

    /// Points of a cloud that has at most so many: a third of them on a page of very many tails.
    pub(crate) fn cloud(&self, most: usize) -> usize {
        let most = if self.detail == Detail::Brief { most / 3 } else { most };
        most.min(self.most_points)
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
