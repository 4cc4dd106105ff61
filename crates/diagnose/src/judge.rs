//! What is said in the end: whether there is a gap, how far it shrinks, which effect it is.

pub(crate) mod addition;
pub(crate) mod closure;
pub(crate) mod contributions;
pub(crate) mod detection;
pub(crate) mod forms;
pub(crate) mod gap;
pub(crate) mod noise_floors;
pub(crate) mod pair;
pub(crate) mod posterior;
pub(crate) mod size;
pub(crate) mod sufficiency;
pub(crate) mod table;
pub(crate) mod verdict;
