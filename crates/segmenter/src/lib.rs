//! Stabilised cruise segments by named trim criteria, with reasons for what is dropped.
