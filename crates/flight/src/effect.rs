//! The library of physical effects: everything about an effect except its physics, in one place.
//!
//! The list of ids is below, the entries are in the files of the groups: airframe, engine, recording, surroundings. The
//! physics is in the crate `effects`, and in the truth's own form in `simulate`. Library table, help, docs and report
//! are made from here.

use core::fmt;

use crate::MAXIMUM_ENGINES;

mod airframe;
mod engine;
mod entry;
mod hidden;
mod history;
mod recording;
mod surroundings;

pub use entry::{
    DrivingVariable, EffectEntry, EffectGroup, EffectSign, NeededInput, Phrase, TypicalSize,
};
pub use hidden::{DragRise, DragRiseLaw, HiddenParameter, StepTarget, ThrottleArgument};
pub use history::{History, HistoryError, MAXIMUM_FALLS};

/// Makes the enum, its list and the table of entries from one list, so that they cannot differ in length.
macro_rules! effects {
    ($($(#[$doc:meta])* $id:ident $(($engine:ty))? = $file:ident::$entry:ident,)*) => {
        /// A physical effect that a performance model may lack.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum EffectId {
            $($(#[$doc])* $id $(($engine))?,)*
        }

        /// Effects without an engine's number, for their place in the list.
        enum Place {
            $($id,)*
        }

        impl EffectId {
            /// Every effect in the library's order; of effects of single engines, that of engine 1.
            pub const ALL: &[Self] = &[$(Self::$id $((<$engine>::MIN + 1))?,)*];

            /// Index in [`ALL`](Self::ALL), whatever the engine.
            #[inline] // of a constant, it is one
            #[must_use]
            pub const fn index(self) -> usize {
                match self {
                    $(Self::$id $((effects!(@any $engine)))? => Place::$id as usize,)*
                }
            }

            /// The library's entry.
            #[must_use]
            pub const fn entry(self) -> &'static EffectEntry {
                match self {
                    $(Self::$id $((effects!(@any $engine)))? => &$file::$entry,)*
                }
            }

            /// The number of its engine, from 1, for an effect of a single engine.
            #[must_use]
            pub const fn engine(self) -> Option<u8> {
                match self {
                    $($(Self::$id(engine) => { let engine: $engine = engine; Some(engine) })?)*
                    _ => None,
                }
            }

            /// The same effect for another engine; unchanged where it is not of a single one.
            #[must_use]
            const fn of_engine(self, engine: u8) -> Self {
                match self {
                    $($(Self::$id(_) => { let engine: $engine = engine; Self::$id(engine) })?)*
                    other => other,
                }
            }
        }
    };
    (@any $engine:ty) => { _ };
}

effects! {
    /// More (or less) drag at zero lift.
    ZeroLiftDrag = airframe::ZERO_LIFT_DRAG,
    /// All drag scaled.
    DragFactor = airframe::DRAG_FACTOR,
    /// Lift-dependent drag scaled.
    InducedDrag = airframe::INDUCED_DRAG,
    /// Earlier or later drag rise with Mach number.
    WaveDrag = airframe::WAVE_DRAG,
    /// Friction that depends on the Reynolds number.
    ReynoldsNumber = airframe::REYNOLDS_NUMBER,
    /// Trim drag with the center of gravity.
    TrimDragCg = airframe::TRIM_DRAG_CG,
    /// Drag of flying with a wing low.
    AsymmetryDrag = airframe::ASYMMETRY_DRAG,
    /// Lift needed in a turn.
    LoadFactor = airframe::LOAD_FACTOR,
    /// Zero-lift drag that grows with age.
    AirframeAgeing = airframe::AIRFRAME_AGEING,
    /// TSFC scaled, all engines.
    TsfcFactor = engine::TSFC_FACTOR,
    /// TSFC of one engine scaled.
    TsfcEngine(u8) = engine::TSFC_ENGINE,
    /// Another exponent of Mach number in the TSFC law.
    TsfcMachExponent = engine::TSFC_MACH_EXPONENT,
    /// Another exponent of temperature in the TSFC law.
    TsfcTemperatureExponent = engine::TSFC_TEMPERATURE_EXPONENT,
    /// TSFC that depends on thrust.
    TsfcThrottle = engine::TSFC_THROTTLE,
    /// Constant fuel flow for power and bleed.
    PowerOfftake = engine::POWER_OFFTAKE,
    /// Fuel for anti-ice bleed while it is on.
    AntiIceBleed = engine::ANTI_ICE_BLEED,
    /// TSFC that grows with age.
    EngineAgeing = engine::ENGINE_AGEING,
    /// Flight-to-flight scatter of the fuel's heating value.
    FuelHeatingValue = engine::FUEL_HEATING_VALUE,
    /// Zero-fuel mass recorded wrongly.
    ZeroFuelMassBias = recording::ZERO_FUEL_MASS_BIAS,
    /// Fuel used recorded wrongly.
    FuelQuantityGain = recording::FUEL_QUANTITY_GAIN,
    /// Mach number reads high.
    MachBias = recording::MACH_BIAS,
    /// Static pressure reads high.
    StaticPressureBias = recording::STATIC_PRESSURE_BIAS,
    /// Static air temperature reads high.
    TemperatureBias = recording::TEMPERATURE_BIAS,
    /// Fuel flow of all engines reads high.
    FuelFlowGain = recording::FUEL_FLOW_GAIN,
    /// Fuel flow of one engine reads high.
    FuelFlowGainEngine(u8) = recording::FUEL_FLOW_GAIN_ENGINE,
    /// Gravity by latitude and height.
    LocalGravity = surroundings::LOCAL_GRAVITY,
    /// Lift saved or needed because of the Earth's rotation and curvature.
    RotatingEarth = surroundings::ROTATING_EARTH,
    /// Climb along a sloping pressure surface.
    IsobaricSlope = surroundings::ISOBARIC_SLOPE,
    /// A step on an estimated date.
    StepChange = surroundings::STEP_CHANGE,
    /// TSFC that grows, and falls at dates.
    EngineHistory = engine::ENGINE_HISTORY,
    /// Zero-lift drag that grows, and falls at dates.
    AirframeHistory = airframe::AIRFRAME_HISTORY,
    /// The whole drag table off, smoothly over lift coefficient and Mach number.
    DragTable = airframe::DRAG_TABLE,
}

impl EffectId {
    /// Every effect with a size of its own for an aircraft with this many engines, in the library's order. Effects of single
    /// engines exist for two engines and more. [`Self::DragTable`], which is a function and not a size, is not among them.
    #[must_use]
    pub fn library(engines: usize) -> Vec<Self> {
        let single = if engines < 2 { 0 } else { engines.min(MAXIMUM_ENGINES) };
        let mut library = Vec::new();
        for id in Self::ALL.iter().filter(|id| **id != Self::DragTable) {
            match id.engine() {
                Some(_) => library.extend((1_u8..).take(single).map(|k| id.of_engine(k))),
                None => library.push(*id),
            }
        }
        library
    }

    /// The effect of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let library = Self::library(MAXIMUM_ENGINES).into_iter();
        library.chain([Self::DragTable]).find(|id| id.to_string() == name)
    }

    /// Whether it moves the mean of what is recorded by a size: a scatter does not, and a whole table has no single size.
    #[must_use]
    pub const fn has_signature(self) -> bool {
        !matches!(self, Self::FuelHeatingValue | Self::DragTable)
    }

    /// Whether it concerns the recording (sensors, load sheet, fuel quantity) and not the flight itself: it then
    /// corrects recordings, and never a prediction.
    #[must_use]
    pub const fn is_of_recordings(self) -> bool {
        matches!(self.entry().group, EffectGroup::Mass | EffectGroup::Sensor)
    }

    /// Whether its coefficient is known from physics: 1.
    #[must_use]
    pub const fn is_known(self) -> bool {
        matches!(self.entry().typical, TypicalSize::Known)
    }

    /// The unit of its size in a sentence: where physics knows the size, how many times that it is.
    #[must_use]
    pub const fn unit_words(self) -> &'static str {
        if self.is_known() { "times its known size" } else { self.entry().unit }
    }

    /// Whether physics requires its size to be positive, or its size has no sign.
    #[must_use]
    pub const fn is_one_sided(self) -> bool {
        matches!(self.entry().sign, EffectSign::Positive | EffectSign::Spread)
    }

    /// Its description at a size of this sign, as a noun phrase or a clause.
    #[must_use]
    pub fn phrase(self, size: f64) -> String {
        let Phrase { positive, negative } = self.entry().phrase;
        self.with_engine(if size < 0.0 { negative } else { positive })
    }

    fn with_engine(self, text: &str) -> String {
        match self.engine() {
            Some(engine) => text.replace("{k}", &engine.to_string()),
            None => text.to_owned(),
        }
    }
}

/// The name in files.
impl fmt::Display for EffectId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.engine() {
            Some(_) => f.write_str(&self.with_engine(self.entry().name)),
            None => f.write_str(self.entry().name),
        }
    }
}

#[cfg(test)]
mod tests;
