//! Where a model differs from flight, which effect it lacks, how far the gap shrinks.
