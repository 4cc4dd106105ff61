//! `cargo run -p cruisefit-parquet-pages --example one_page`
//! The values of a page: a header, three numbers of double precision, packed by Snappy.
#![expect(clippy::print_stdout, reason = "an example shows its result")]

use std::error::Error;

use parquet_pages::{Codec, Column, Form, Kind, Values, header, unpack};

fn main() -> Result<(), Box<dyn Error>> {
    let numbers = [0.78, 0.781, 0.779];
    let plain = numbers.map(f64::to_le_bytes).concat();
    let packed = snap::raw::Encoder::new().compress_vec(&plain)?;
    // A page of data: its lengths, and of its values the number and the encoding.
    let (unpacked_bytes, packed_bytes) =
        (u8::try_from(2 * plain.len())?, u8::try_from(2 * packed.len())?);
    let head = [0x15, 0, 0x15, unpacked_bytes, 0x15, packed_bytes];
    let data = [0x2c, 0x15, 6, 0x15, 0, 0x15, 6, 0x15, 6, 0, 0];
    let file = [&head[..], &data, &packed].concat();

    let (header, behind) = header(&file).ok_or("no header")?;
    assert!(matches!(header.kind, Kind::Data { values: 3, .. }));
    let mut column = Column::new(Form::Double, false);
    unpack(Codec::Snappy, &file[behind..], header.unpacked_bytes, column.page(), 0)?;
    column.begin(header.kind)?;
    let mut values = column.values(3);
    column.append(3, &mut values)?;
    assert_eq!(values, Values::Numbers(numbers.to_vec()));
    println!("{values:?}");
    Ok(())
}
