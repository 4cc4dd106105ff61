//! Reads a cruise report, shows why a damaged one is refused, and writes it in other units.
//!
//! `cargo run -p cruisefit-report --example read_report`

#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use flight::column::Column;
use report::{Decimals, Reader, TextLayout, write};

const TEXT: &str = "\
CRUISE-REPORT 1
AIRCRAFT C750
TAIL     T-001
FLIGHT   0007
START    2018-05-20T14:14:21Z
ZFW      24283 lb
FOB      7219 lb
TIME ALT SAT MACH VTAS GSPD ROLL DRIFT N2(1) N2(2) WF(1) WF(2) FU
s ft degC - kt kt deg deg % % lb/h lb/h lb
0 43008 -56.6 0.8030 460.5 451.5 -0.1 4.2 89.4 89.4 654 658 1353
60 43003 -56.5 0.8025 460.5 451.0 0.0 4.4 89.4 89.3 653 648 1375
120 43003 -56.8 0.8025 460.0 450.5 0.0 4.6 89.5 89.5 659 658 1396
";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut reader = Reader::new();
    let report = reader.read(TEXT.as_bytes())?.report;
    let columns = report.columns();
    for sample in 0..report.len() {
        let fuel_flow_total_kg_s = columns.fuel_flow.total_kg_s(sample);
        println!("{:4} s: {fuel_flow_total_kg_s:.4} kg/s", columns.time_s[sample]);
    }

    let damaged = TEXT.replace("0.8025 460.0", "0.8025 460,0");
    if let Err(refusal) = reader.read(damaged.as_bytes()) {
        println!("refused: {refusal}");
    }

    let layout = TextLayout::industry().with(Column::FuelUsed, "kg", Decimals::Fixed(1))?;
    let text = write(&report, &layout, &["fuel used in kg"])?;
    println!("{text}");
    assert!(text.contains("FOB      3274.5 kg"));
    Ok(())
}
