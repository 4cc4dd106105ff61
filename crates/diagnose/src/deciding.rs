//! A number that decides, and where it comes from: one definition makes the constant that is used and the row that tells of it.

/// Where a number comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certainty {
    /// A published source, or arithmetic that anyone can repeat.
    Source(&'static str),
    /// A measurement with this program; what was measured, on how many cases.
    Measured(&'static str),
    /// Nothing but a choice, and why it was made.
    OurChoice(&'static str),
}

/// A number that decides what is believed or what is answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecidingNumber {
    /// What it belongs to.
    pub group: &'static str,
    /// The constant's name in the code.
    pub name: &'static str,
    /// The constant's value; several values have commas between them.
    pub value: String,
    /// Unit of the value; empty for a number without one.
    pub unit: &'static str,
    /// What it decides.
    pub decides: &'static str,
    /// Where it comes from.
    pub certainty: Certainty,
}

/// A value as the list writes it.
pub(crate) trait Written {
    fn written(&self) -> String;
}

impl Written for f64 {
    fn written(&self) -> String {
        self.to_string()
    }
}

impl Written for usize {
    fn written(&self) -> String {
        self.to_string()
    }
}

impl Written for u32 {
    fn written(&self) -> String {
        self.to_string()
    }
}

impl<A: Written, B: Written> Written for (A, B) {
    fn written(&self) -> String {
        format!("({}, {})", self.0.written(), self.1.written())
    }
}

impl<T: Written, const N: usize> Written for [T; N] {
    fn written(&self) -> String {
        self.iter().map(Written::written).collect::<Vec<_>>().join(", ")
    }
}

/// Makes constants, and the list `numbers()` of them: `NAME: type = value, "unit", "what it decides", Certainty "why";`, in
/// groups.
macro_rules! deciding_numbers {
    ($($group:literal {
        $($name:ident: $type:ty = $value:expr, $unit:literal, $decides:literal, $certainty:ident $why:literal;)*
    })*) => {
        $($(
            #[doc = $decides]
            #[doc = ""]
            #[doc = $why]
            pub(crate) const $name: $type = $value;
        )*)*

        /// Every number of this file.
        pub(crate) fn numbers() -> Vec<crate::deciding::DecidingNumber> {
            use crate::deciding::{Certainty, DecidingNumber, Written as _};
            vec![$($(DecidingNumber {
                group: $group,
                name: stringify!($name),
                value: $name.written(),
                unit: $unit,
                decides: $decides,
                certainty: Certainty::$certainty($why),
            },)*)*]
        }
    };
}
pub(crate) use deciding_numbers;
