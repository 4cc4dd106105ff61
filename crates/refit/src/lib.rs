//! Global weighted least squares over a table.
