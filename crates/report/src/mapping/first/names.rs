//! What a column's name tells: quantity, unit, engine.

use super::rules::Kind;

/// A column's name, as sent and taken apart.
pub(super) struct Name {
    pub(super) sent: String,
    /// Letters and digits in lower case, without a unit at the end.
    plain: String,
    unit: Option<&'static str>,
}

/// What units are called at the end of a name, and what we call them; the longer ones first.
const UNITS: [(&str, &str); 43] = [
    ("feet", "ft"),
    ("ft", "ft"),
    ("meters", "m"),
    ("metres", "m"),
    ("m", "m"),
    ("kts", "kt"),
    ("knots", "kt"),
    ("kt", "kt"),
    ("mps", "m/s"),
    (METERS_PER_SECOND, "m/s"),
    ("kgh", "kg/h"),
    ("kgph", "kg/h"),
    ("kghr", "kg/h"),
    ("lbh", "lb/h"),
    ("lbhr", "lb/h"),
    ("lbsh", "lb/h"),
    ("pph", "lb/h"),
    ("gph", GALLONS),
    ("galh", GALLONS),
    ("galhr", GALLONS),
    ("th", "t/h"),
    ("tph", "t/h"),
    ("thr", "t/h"),
    ("kgs", "kg/s"),
    ("kg", "kg"),
    ("lbs", "lb"),
    ("lb", "lb"),
    ("klbs", "klb"),
    ("klb", "klb"),
    ("tonnes", "t"),
    ("tonne", "t"),
    ("tons", "t"),
    ("t", "t"),
    ("degc", "degC"),
    ("degf", "degF"),
    ("deg", "deg"),
    ("celsius", "degC"),
    ("kelvin", "K"),
    ("pct", "%"),
    ("percent", "%"),
    ("c", "degC"),
    ("f", "degF"),
    ("k", "K"),
];

/// "m/s" without its stroke, which in one piece are milliseconds.
const METERS_PER_SECOND: &str = "ms";

/// A unit that a mapping has by a scale.
const GALLONS: &str = "gal/h";
/// A US gallon of kerosene of 0.803 kg/l, as fuel flow meters that count gallons take it: 6.7 lb.
const POUNDS_OF_GALLON: &str = "unit: \"lb/h\", scale: 6.7";

impl Name {
    /// `in_row` is what a row of units says of the column.
    pub(super) fn new(sent: &str, in_row: Option<&str>) -> Self {
        let mut name = Self::from_name(sent);
        name.unit = in_row.and_then(unit_called).or(name.unit);
        if name.unit.is_none() && ["ktas", "kcas", "kias"].contains(&name.plain.as_str()) {
            name.unit = Some("kt");
        }
        name
    }

    /// Whether others are called so too: at times it is another quantity.
    pub(super) fn is_vague(&self) -> bool {
        ["temperature", "wt", "altb", "baroalt", "togw"].contains(&self.plain.as_str())
    }

    fn from_name(sent: &str) -> Self {
        let pieces: Vec<String> = sent
            .split(|letter: char| !letter.is_alphanumeric())
            .filter(|piece| !piece.is_empty())
            .map(str::to_lowercase)
            .collect();
        // "kg/h" and "kg_h" come as two pieces.
        for count in [2, 1] {
            let Some(split) = pieces.len().checked_sub(count).filter(|split| *split > 0) else {
                continue;
            };
            let last = pieces[split..].concat();
            let plain = pieces[..split].concat();
            let is_meant = |word: &str| {
                word == last
                    && (word != METERS_PER_SECOND || count == 2)
                    // "time_m" counts minutes.
                    && (word != "m" || !plain.ends_with("time"))
            };
            if let Some((_, unit)) = UNITS.iter().find(|(word, _)| is_meant(word)) {
                return Self { sent: sent.to_owned(), plain, unit: Some(unit) };
            }
        }
        Self { sent: sent.to_owned(), plain: pieces.concat(), unit: None }
    }

    /// Whether it may be that of an outside air temperature by a name that no rule has.
    pub(super) fn may_be_air_temperature(&self) -> bool {
        let of_other =
            ["oil", "fuel", "egt", "itt", "cabin", "turbine", "engine", "total", "tat", "dew"];
        ["temp", "oat", "sat"].iter().any(|word| self.plain.contains(word))
            && !of_other.iter().any(|word| self.plain.contains(word))
    }

    pub(super) fn is(&self, wanted: &str) -> bool {
        self.plain == wanted
    }

    /// The `unit` field for a quantity of this kind, where the name carries one.
    pub(super) fn unit(&self, kind: Kind) -> Option<&'static str> {
        Some(match (kind, self.unit?) {
            (Kind::Altitude, "ft") => "unit: \"ft\"",
            (Kind::Altitude, "m") => "unit: \"m\"",
            (Kind::Temperature, "degC") => "unit: \"degC\"",
            (Kind::Temperature, "K") => "unit: \"K\"",
            (Kind::Temperature, "degF") => "unit: \"degF\"",
            (Kind::Speed | Kind::CalibratedSpeed, "kt") => "unit: \"kt\"",
            (Kind::Speed | Kind::CalibratedSpeed, "m/s") => "unit: \"m/s\"",
            (Kind::Mass, "kg") => "unit: \"kg\"",
            (Kind::Mass, "lb") => "unit: \"lb\"",
            (Kind::Mass, "klb") => "unit: \"klb\"",
            (Kind::Mass, "t") => "unit: \"t\"",
            (Kind::Percent, "%") => "unit: \"%MAC\"",
            (Kind::Angle, "deg") => "unit: \"deg\"",
            _ => return None,
        })
    }

    /// The same for fuel flow, and whether it is a guess.
    pub(super) fn flow_unit(&self) -> Option<(String, bool)> {
        let unit = self.unit?;
        if unit == GALLONS {
            return Some((POUNDS_OF_GALLON.to_owned(), true));
        }
        let is_known = ["kg/h", "lb/h", "kg/s", "t/h"].contains(&unit);
        is_known.then(|| (format!("unit: {unit:?}"), false))
    }
}

/// What we call a unit that stands by itself, whatever its marks and capitals.
pub(super) fn unit_called(text: &str) -> Option<&'static str> {
    let plain: String =
        text.chars().filter(|letter| letter.is_alphanumeric()).collect::<String>().to_lowercase();
    let own = [
        "kt", "ft", "m", "m/s", "kg", "lb", "klb", "t", "kg/h", "lb/h", "kg/s", "t/h", "degC", "K",
        "deg", "%",
    ];
    let as_written = own.into_iter().find(|unit| *unit == text.trim());
    let is_meant = |word: &str| word == plain && word != METERS_PER_SECOND;
    as_written.or_else(|| UNITS.iter().find(|(word, _)| is_meant(word)).map(|(_, unit)| *unit))
}

/// The engine of a column named by one of `stems` and a number, a letter or a side; `None` for any other column.
pub(super) fn engine_of(name: &Name, stems: &[&str]) -> Option<u8> {
    let marks: [(u8, &[&str]); 4] = [
        (1, &["1", "l", "a", "left", "lh"]),
        (2, &["2", "r", "b", "right", "rh"]),
        (3, &["3"]),
        (4, &["4"]),
    ];
    for stem in stems {
        for (engine, words) in marks {
            for word in words {
                let forms = [
                    format!("{stem}{word}"),
                    format!("{stem}eng{word}"),
                    format!("eng{word}{stem}"),
                    format!("engine{word}{stem}"),
                    format!("e{word}{stem}"),
                    format!("{word}{stem}"),
                ];
                if forms.contains(&name.plain) {
                    return Some(engine);
                }
            }
        }
    }
    None
}
