//! What is recorded of a flight and how well it is known: channels, their noise, the variables that residuals may depend on.

pub(crate) mod channels;
pub(crate) mod n2_deck;
pub(crate) mod noise;
pub(crate) mod record;
pub(crate) mod references;
pub(crate) mod table_uncertainty;
pub(crate) mod variables;
pub(crate) mod wander;
