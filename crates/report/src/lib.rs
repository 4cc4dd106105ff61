//! Cruise-report text and other layouts into Report, refusals with position.
