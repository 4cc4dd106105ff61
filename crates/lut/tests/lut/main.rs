//! Tests of the whole crate from outside, in one program: each would be linked by itself.

mod axis;
mod lookup;
mod oracle;
mod ron;
mod surface;
