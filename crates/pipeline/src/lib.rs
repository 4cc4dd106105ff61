//! The chain from cruise reports to an adapted, evaluated and diagnosed model, as a library.

pub mod checksum;
pub mod columns;
pub mod condition_means;
pub mod diagnosis_document;
pub mod diagnosis_text;
pub mod difference;
pub mod evaluation;
pub mod learning;
pub mod model_file;
pub mod reduction;
pub mod segments_table;
pub mod statistics;
pub mod summary;
pub mod table_uncertainty;
