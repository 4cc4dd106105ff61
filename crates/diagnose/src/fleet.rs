//! All tails of a type together: what all share is the model, what one has is the aircraft or its sensors.
//!
//! Effect k on tail t has the size `μ_k + η_tk`. What the model is uncertain about and the tails share (table, remainder, deck,
//! smooth discrepancy) is one set of coefficients for all of them, and as much again for each. Of each tail only a Gram matrix
//! is kept.
//!
//! Difficult: types and tails explain each other. The search goes back and forth: each tail against what all others say of the
//! type, then the type with what was found on tails left free, until nothing changes. All of it is Gaussian algebra on
//! matrices of the size of the library (`joint`); the cost is linear in the number of tails.

pub(crate) mod basis;
pub(crate) mod false_discoveries;
pub(crate) mod found;
pub(crate) mod frame;
pub(crate) mod infer;
pub(crate) mod joint;
pub(crate) mod levels;
pub(crate) mod sizes;
