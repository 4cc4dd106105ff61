//! The fields of an Arrow schema: what their cells become, and how many buffers they take.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::flatbuffer::Table;

/// A column of the schema.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// Nodes and buffers that it and its children take.
    pub(super) extent: Extent,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extent {
    pub(super) nodes: usize,
    pub(super) buffers: usize,
    /// Columns of views, each with a number of buffers that its batch states.
    pub(super) views: usize,
}

/// What cells are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// No cell has a value.
    Null,
    Number(Number),
    Flag,
    /// With nanoseconds for each count.
    Instant(i64),
    /// Likewise, on a clock of which the file does not say where it is.
    LocalTime(i64),
    /// With nanoseconds for each count, and bytes of it.
    TimeOfDay(i64, usize),
    /// Days, or milliseconds in eight bytes.
    Date(usize),
    /// Bytes of an offset.
    Text(usize),
    View,
    /// Texts by the number of a dictionary.
    Dictionary {
        index: Number,
        number: i64,
        values: TextForm,
    },
    /// Not read.
    Other,
}

/// How the texts of a dictionary are stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TextForm {
    /// Bytes of an offset.
    Offsets(usize),
    Views,
    /// No texts.
    None,
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    Signed(usize),
    Unsigned(usize),
    Single,
    Double,
}

impl Number {
    /// Bytes of it.
    pub(super) const fn width(self) -> usize {
        match self {
            Self::Signed(width) | Self::Unsigned(width) => width,
            Self::Single => 4,
            Self::Double => 8,
        }
    }
}

impl Field {
    pub(super) const fn is_read(&self) -> bool {
        !matches!(self.kind, Kind::Other | Kind::Dictionary { values: TextForm::None, .. })
    }

    /// The values of the dictionary of this number as a field, where they are texts.
    pub(super) fn dictionary_values(&self, wanted: i64) -> Option<Self> {
        let Kind::Dictionary { number, values, .. } = self.kind else { return None };
        let kind = match values {
            TextForm::Offsets(width) => Kind::Text(width),
            TextForm::Views => Kind::View,
            TextForm::None => return None,
        };
        (number == wanted).then(|| Self {
            name: self.name.clone(),
            kind,
            extent: Extent::default(),
        })
    }
}

/// The fields of a schema.
pub(super) fn of_schema(schema: Table<'_>) -> Option<Vec<Field>> {
    let fields = schema.vector(1)?;
    (0..fields.length).map(|place| field(fields.table(place)?, 0)).collect()
}

/// Columns of durations in a schema as Arrow's writers put it into other files: a message in base 64. Whoever reads the numbers alone
/// does not know their unit.
pub(crate) fn durations(schema: &str) -> Vec<String> {
    const DURATION: u8 = 18;
    let message = STANDARD.decode(schema).unwrap_or_default();
    let begin = if message.starts_with(&[0xff; 4]) { 8 } else { 4 };
    let message = message.get(begin..).and_then(Table::root);
    let fields = message.and_then(|message| message.table(2)?.vector(1));
    let name = |field: Table<'_>| {
        (field.byte(2) == Some(DURATION)).then(|| field.text(0).unwrap_or_default().to_owned())
    };
    let fields =
        fields.into_iter().flat_map(|fields| (0..fields.length).map(move |at| fields.table(at)));
    fields.flatten().filter_map(name).collect()
}

/// Deepest nesting that is looked into: a damaged file must not lead in circles.
const DEEPEST: usize = 16;

fn field(table: Table<'_>, depth: usize) -> Option<Field> {
    if depth > DEEPEST {
        return None;
    }
    let name = table.text(0).unwrap_or_default().to_owned();
    let code = table.byte(2)?;
    let form = table.table(3);
    let kind = kind(code, form);
    if let Some(encoding) = table.table(4) {
        let index = encoding.table(1).map_or(Some(Number::Signed(4)), integer)?;
        let values = match kind {
            Kind::Text(width) => TextForm::Offsets(width),
            Kind::View => TextForm::Views,
            _ => TextForm::None,
        };
        let kind = Kind::Dictionary { index, number: encoding.long(0).unwrap_or(0), values };
        return Some(Field { name, kind, extent: Extent { nodes: 1, buffers: 2, views: 0 } });
    }
    let mut extent = Extent { nodes: 1, buffers: buffers(code, form), views: 0 };
    extent.views = usize::from(matches!(code, BINARY_VIEW | TEXT_VIEW));
    if let Some(children) = table.vector(5) {
        for place in 0..children.length {
            let child = field(children.table(place)?, depth + 1)?.extent;
            extent.nodes += child.nodes;
            extent.buffers += child.buffers;
            extent.views += child.views;
        }
    }
    Some(Field { name, kind, extent })
}

const UNION: u8 = 14;
const BINARY_VIEW: u8 = 23;
const TEXT_VIEW: u8 = 24;

/// Buffers of a type, without those of its children.
fn buffers(code: u8, form: Option<Table<'_>>) -> usize {
    const DENSE: i16 = 1;
    match code {
        // Null, run-end encoded.
        1 | 22 => 0,
        // Structure, list of fixed size.
        13 | 16 => 1,
        UNION => 1 + usize::from(form.and_then(|form| form.short(0)).unwrap_or(0) == DENSE),
        // Bytes and texts with offsets; lists with offsets and sizes.
        4 | 5 | 19 | 20 | 25 | 26 => 3,
        _ => 2,
    }
}

/// Nanoseconds of a time unit: seconds, milliseconds, microseconds, nanoseconds.
const NANOSECONDS: [i64; 4] = [1_000_000_000, 1_000_000, 1_000, 1];

fn kind(code: u8, form: Option<Table<'_>>) -> Kind {
    let unit = |default: i16| {
        let unit = form.and_then(|form| form.short(0)).unwrap_or(default);
        usize::try_from(unit).ok().and_then(|unit| NANOSECONDS.get(unit)).copied()
    };
    let found = match code {
        1 => Some(Kind::Null),
        2 => form.and_then(integer).map(Kind::Number),
        3 => match form.and_then(|form| form.short(0)).unwrap_or(0) {
            1 => Some(Kind::Number(Number::Single)),
            2 => Some(Kind::Number(Number::Double)),
            _ => None,
        },
        5 => Some(Kind::Text(4)),
        20 => Some(Kind::Text(8)),
        TEXT_VIEW => Some(Kind::View),
        6 => Some(Kind::Flag),
        // Milliseconds by default.
        8 => match form.and_then(|form| form.short(0)).unwrap_or(1) {
            0 => Some(Kind::Date(4)),
            _ => Some(Kind::Date(8)),
        },
        9 => {
            let bits = form.and_then(|form| form.int(1)).unwrap_or(32);
            unit(1).map(|each| Kind::TimeOfDay(each, if bits == 64 { 8 } else { 4 }))
        }
        // With a name of a zone, whichever it is, counts are of UTC.
        10 => {
            let has_zone = form.and_then(|form| form.text(1)).is_some_and(|zone| !zone.is_empty());
            unit(0).map(if has_zone { Kind::Instant } else { Kind::LocalTime })
        }
        _ => None,
    };
    found.unwrap_or(Kind::Other)
}

fn integer(form: Table<'_>) -> Option<Number> {
    let width = match form.int(0)? {
        8 => 1,
        16 => 2,
        32 => 4,
        64 => 8,
        _ => return None,
    };
    let is_signed = form.byte(1).unwrap_or(0) != 0;
    Some(if is_signed { Number::Signed(width) } else { Number::Unsigned(width) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: pyarrow 22, `base64.b64encode(pa.schema([("TIME", pa.duration("ms")), ("alt", pa.float64())]).serialize())`.
    #[test]
    fn durations_of_a_schema() {
        let schema = "/////6gAAAAQAAAAAAAKAAwABgAFAAgACgAAAAABBAAMAAAACAAIAAAABAAIAAAABAAAAAIAAABIAAAABAAAAND///8AAAED\
            EAAAABwAAAAEAAAAAAAAAAMAAABhbHQAAAAGAAgABgAGAAAAAAACABAAFAAIAAYABwAMAAAAEAAQAAAAAAABEhAAAAAcAAAABAAAAAAA\
            AAAEAAAAVElNRQAAAAAEAAQABAAAAAAAAAA=";
        assert_eq!(durations(schema), ["TIME"]);
        assert_eq!(durations(&schema[..80]), Vec::<String>::new());
    }
}
