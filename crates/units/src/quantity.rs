//! The one macro: a transparent newtype over an SI `f64`, with the arithmetic that is meaningful for every kind.

/// Defines a quantity: `quantity!(doc, Name, "unit", [(constructor, reader, factor-to-SI), …])`.
///
/// The SI constructor has factor 1. Division back to a unit uses the same factor, so a round trip costs one rounding.
macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $unit:literal, [$(($new:ident, $read:ident, $factor:expr, $what:literal)),+ $(,)?]) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, PartialOrd)]
        #[repr(transparent)]
        pub struct $name(f64);

        impl $name {
            $(
                #[doc = concat!("From ", $what, ".")]
                #[must_use]
                pub const fn $new(value: f64) -> Self {
                    Self(value * $factor)
                }

                #[doc = concat!("In ", $what, ".")]
                #[must_use]
                pub const fn $read(self) -> f64 {
                    self.0 / $factor
                }
            )+

            /// Whether the number is finite.
            #[must_use]
            pub const fn is_finite(self) -> bool {
                self.0.is_finite()
            }
        }

        impl core::fmt::Debug for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                write!(f, concat!(stringify!($name), "({} ", $unit, ")"), self.0)
            }
        }

        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                core::fmt::Display::fmt(&self.0, f)?;
                f.write_str(concat!(" ", $unit))
            }
        }
    };
}

/// For a quantity whose sums are meaningful: adds `+`, `-` with the same kind, scaling by `f64`, and the ratio of two.
macro_rules! additive {
    ($($name:ident),+ $(,)?) => {$(
        impl core::ops::Add for $name {
            type Output = Self;
            fn add(self, other: Self) -> Self {
                Self(self.0 + other.0)
            }
        }
        impl core::ops::Sub for $name {
            type Output = Self;
            fn sub(self, other: Self) -> Self {
                Self(self.0 - other.0)
            }
        }
        impl core::ops::Mul<f64> for $name {
            type Output = Self;
            fn mul(self, factor: f64) -> Self {
                Self(self.0 * factor)
            }
        }
        impl core::ops::Div for $name {
            type Output = f64;
            fn div(self, other: Self) -> f64 {
                self.0 / other.0
            }
        }
    )+};
}

pub(crate) use {additive, quantity};
