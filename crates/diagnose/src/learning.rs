//! How a baseline is learnt from the residuals of clean flights.

mod fit;
mod learn;
mod moments;
mod outliers;
mod unseen;
