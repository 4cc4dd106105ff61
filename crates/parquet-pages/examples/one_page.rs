//! The values of a page: a header, three numbers of double precision, packed by Snappy.

use parquet_pages::{Codec, Column, Form, Kind, Values, header, unpack};

fn main() {
    let numbers = [0.78, 0.781, 0.779];
    let plain = numbers.map(f64::to_le_bytes).concat();
    let packed = snap::raw::Encoder::new().compress_vec(&plain).expect("memory");
    // A page of data: its lengths, and of its values the number and the encoding.
    let length = |bytes: usize| u8::try_from(2 * bytes).expect("a short page");
    let (unpacked_bytes, packed_bytes) = (length(plain.len()), length(packed.len()));
    let head = [0x15, 0, 0x15, unpacked_bytes, 0x15, packed_bytes];
    let data = [0x2c, 0x15, 6, 0x15, 0, 0x15, 6, 0x15, 6, 0, 0];
    let file = [&head[..], &data, &packed].concat();

    let (header, behind) = header(&file).expect("a header");
    assert!(matches!(header.kind, Kind::Data { values: 3, .. }));
    let mut column = Column::new(Form::Double, false);
    unpack(Codec::Snappy, &file[behind..], header.unpacked_bytes, column.page(), 0)
        .expect("a page");
    column.begin(header.kind).expect("values");
    let mut values = column.values(3);
    column.append(3, &mut values).expect("three values");
    assert_eq!(values, Values::Numbers(numbers.to_vec()));
    println!("{values:?}");
}
