//! Command line of cruisefit: files, threads, progress, pages.
