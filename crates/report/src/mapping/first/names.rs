//! What a column's name tells: quantity, unit, engine.

use super::rules::Kind;

/// A column's name, as sent and taken apart.
pub(super) struct Name {
    pub(super) sent: String,
    /// Letters and digits in lower case, without a unit at the end.
    plain: String,
    unit: Option<&'static str>,
    /// The same with that unit, where the name has one.
    whole: String,
    /// What a row of units says, where it is no unit that we know.
    pub(super) unknown_unit: Option<String>,
}

/// What units are called at the end of a name, their words as in [`WORDS`], and what we call them. In one text: the program has no room
/// for lists.
const UNITS: &str = "feet=ft ft=ft meters=m metres=m m=m fl=FL hft=FL 100ft=FL kts=kt knots=kt kt=kt mps=m/s \
    ms=m/s kmh=km/h kph=km/h mph=mph kgh=kg/h kgph=kg/h kghr=kg/h kgmin=kg/min lbh=lb/h \
    lbhr=lb/h lbsh=lb/h lbshr=lb/h pph=lb/h lbmin=lb/min ppm=lb/min gph=gal/h galh=gal/h \
    galhr=gal/h th=t/h tph=t/h thr=t/h kgs=kg/s kg=kg lb=lb klbs=klb klb=klb 1000lb=klb \
    lb1000=klb lbx1000=klb t=t 1000kg=t kgx1000=t degc=degC degf=degF degk=K deg=deg rad=rad \
    celsius=degC fahrenheit=degF kelvin=K pct=% percent=% pctmac=% c=degC f=degF k=K";

/// Words of units, and how [`UNITS`] has them.
const WORDS: &str = "pound=lb pounds=lb lbs=lb lbm=lb kilograms=kg kilogram=kg tonnes=t tonne=t tons=t ton=t \
    mt=t per= hr=h hour=h hrs=h sec=s second=s minute=min degrees=deg degree=deg radians=rad";

/// "m/s" without its stroke, which in one piece are milliseconds.
const METERS_PER_SECOND: &str = "ms";

/// A unit that a mapping has by a scale.
const GALLONS: &str = "gal/h";
/// A US gallon of kerosene of 0.803 kg/l, as fuel flow meters that count gallons take it: 6.7 lb.
const POUNDS_OF_GALLON: &str = "unit: \"lb/h\", scale: 6.7";

/// What a row of units has for a number without one.
const NO_UNITS: [&str; 7] = ["", "-", "--", "1", "Mach", "mach", "bool"];

impl Name {
    /// `in_row` is what a row of units says of the column.
    pub(super) fn new(sent: &str, in_row: Option<&str>) -> Self {
        let mut name = Self::from_name(sent);
        let stated = in_row.map(str::trim).filter(|text| !NO_UNITS.contains(text));
        name.unit = stated.and_then(unit_called).or(name.unit);
        name.unknown_unit = stated.filter(|text| unit_called(text).is_none()).map(str::to_owned);
        if name.unit.is_none() && ["ktas", "kcas", "kias"].contains(&name.plain.as_str()) {
            name.unit = Some("kt");
        }
        name
    }

    /// Whether others are called so too: at times it is another quantity.
    pub(super) fn is_vague(&self) -> bool {
        ["temperature", "wt", "wgt", "altb", "baroalt", "togw"].contains(&self.plain.as_str())
    }

    fn from_name(sent: &str) -> Self {
        let pieces: Vec<String> = sent
            .split(|letter: char| !letter.is_alphanumeric())
            .filter(|piece| !piece.is_empty())
            .map(str::to_lowercase)
            .collect();
        let whole = pieces.concat();
        // "kg/h" and "kg_h" come as two pieces, "kg per h" as three.
        for count in [3, 2, 1] {
            let Some(split) = pieces.len().checked_sub(count).filter(|split| *split > 0) else {
                continue;
            };
            let last = pieces[split..].iter().map(|piece| word_of(piece)).collect::<String>();
            let plain = pieces[..split].concat();
            // "time_m" counts minutes.
            let is_other = (last == METERS_PER_SECOND && count != 2)
                || (last == "m" && plain.ends_with("time"));
            if let Some(unit) = called_in(UNITS, &last).filter(|_| !is_other) {
                let (sent, unit) = (sent.to_owned(), Some(unit));
                return Self { sent, plain, unit, whole, unknown_unit: None };
            }
        }
        let (sent, plain) = (sent.to_owned(), whole.clone());
        Self { sent, plain, unit: None, whole, unknown_unit: None }
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

    /// The same of a quantity of some kind: what ends like a temperature's unit (a centre tank, `FQ_C`) has none as a mass.
    pub(super) fn is_of(&self, wanted: &str, kind: Kind) -> bool {
        let is_unit = matches!(kind, Kind::Mass)
            && matches!(self.unit, Some("degC" | "degF" | "K"))
            && self.unknown_unit.is_none();
        if is_unit { self.whole == wanted } else { self.is(wanted) }
    }

    /// Whether nothing says that an angle is in another unit.
    pub(super) fn may_be_in_degrees(&self) -> bool {
        self.unknown_unit.is_none() && self.unit.is_none_or(|unit| unit == "deg")
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
            (Kind::Speed | Kind::CalibratedSpeed, "km/h") => "unit: \"m/s\", scale: 0.277777778",
            (Kind::Speed | Kind::CalibratedSpeed, "mph") => "unit: \"kt\", scale: 0.868976242",
            (Kind::Altitude, "FL") => "unit: \"FL\"",
            // "KGS" are kilograms where they are no flow.
            (Kind::Mass, "kg" | "kg/s") => "unit: \"kg\"",
            (Kind::Mass, "lb") => "unit: \"lb\"",
            (Kind::Mass, "klb") => "unit: \"klb\"",
            (Kind::Mass, "t") => "unit: \"t\"",
            (Kind::Percent, "%") => "unit: \"%MAC\"",
            (Kind::Angle, "deg") => "unit: \"deg\"",
            (Kind::Angle, "rad") => "unit: \"deg\", scale: 57.2957795",
            _ => return None,
        })
    }

    /// The same for fuel flow, and whether it is a guess.
    pub(super) fn flow_unit(&self) -> Option<(String, bool)> {
        let unit = self.unit?;
        if unit == GALLONS {
            return Some((POUNDS_OF_GALLON.to_owned(), true));
        }
        let of_minutes = [("kg/min", "kg/h"), ("lb/min", "lb/h")];
        if let Some((_, unit)) = of_minutes.iter().find(|(known, _)| *known == unit) {
            return Some((format!("unit: {unit:?}, scale: 60"), false));
        }
        let is_known = ["kg/h", "lb/h", "kg/s", "t/h"].contains(&unit);
        is_known.then(|| (format!("unit: {unit:?}"), false))
    }
}

/// What we call a unit that stands by itself, whatever its marks and capitals.
pub(super) fn unit_called(text: &str) -> Option<&'static str> {
    let text = text.trim().replace('#', "lb").replace('%', "pct");
    let own = ["m/s", "K"];
    let as_written = own.into_iter().find(|unit| *unit == text);
    let lower = text.to_lowercase();
    let words = lower.split(|letter: char| !letter.is_alphanumeric());
    let plain: String = words.map(word_of).collect();
    let is_other = plain == METERS_PER_SECOND && !lower.contains(['/', ' ']);
    as_written.or_else(|| called_in(UNITS, &plain).filter(|_| !is_other))
}

/// A word of a unit as [`UNITS`] has it.
fn word_of(word: &str) -> &str {
    called_in(WORDS, word).unwrap_or(word)
}

/// What a table has for a word.
#[inline(never)]
fn called_in(table: &'static str, word: &str) -> Option<&'static str> {
    let mut pairs = table.split(' ').filter_map(|pair| pair.split_once('='));
    pairs.find(|(known, _)| *known == word).map(|(_, name)| name)
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
