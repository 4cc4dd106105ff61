//! The search over hypotheses: one linear system, all single effects and pairs, the leading ones refined.

pub(crate) mod analyse;
pub(crate) mod folds;
pub(crate) mod outliers;
pub(crate) mod outside;
pub(crate) mod pairs;
pub(crate) mod refine;
pub(crate) mod robust;
pub(crate) mod singles;
pub(crate) mod system;
