//! A virtual aircraft: cruise flights with a truth that is known.
