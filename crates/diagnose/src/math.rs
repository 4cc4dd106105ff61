//! Numerical methods without a word of aviation.

pub(crate) mod bootstrap;
pub(crate) mod cholesky;
pub(crate) mod curve;
pub(crate) mod eliminate;
pub(crate) mod gram;
pub(crate) mod half_spaces;
pub(crate) mod horseshoe;
pub(crate) mod integrated_wiener;
pub(crate) mod lanes;
pub(crate) mod linear;
pub(crate) mod lower;
pub(crate) mod mixture;
pub(crate) mod pivoted;
pub(crate) mod quantile;
pub(crate) mod random;
pub(crate) mod vector_ln_exp;
