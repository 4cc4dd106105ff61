//! Reports into text and back.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helpers too")]

use flight::column::Column;
use flight::{
    Assumption, FlightIdentity, FuelFlowColumns, MissingColumn, Report, ReportColumns,
    ReportHeader, Timestamp,
};
use proptest::prelude::*;
use report::{Decimals, Reader, TextLayout, WriteError, write};
use test_support::reports::FORMAT_SAMPLE as SAMPLE;
use units::Mass;

fn read(text: &str) -> Report {
    Reader::new().read(text.as_bytes()).unwrap().report
}

#[test]
fn the_sample_of_the_format_page_comes_back_byte_for_byte() {
    assert_eq!(write(&read(SAMPLE), &TextLayout::industry(), &[]).unwrap(), SAMPLE);
}

#[test]
fn every_optional_part() {
    let text = SAMPLE
        .replace("TIME", "LHV      43.15 MJ/kg\nMISSING  SAT ROLL\nASSUMED  SAT=ISA-2.5 CG=27\nREMARK   two words\nTIME")
        .replace(" SAT MACH", " MACH").replace(" degC -", " -")
        .replace(" ROLL DRIFT", " DRIFT").replace("deg deg % %", "deg % %")
        .replace(" CG A/I", " CG TAT N1(2) EGT(1) FQ A/I").replace("%MAC -", "%MAC degC % degC lb -")
        .replace(" -56.6", "").replace(" -56.5", "").replace(" -56.8", "")
        .replace(" -0.1 4.2", " 4.2").replace(" 0.0 4", " 4")
        .replace(" 27.2 0\n", " 27.2 -30.1 85.0 - 5866 0\n").replace(" 27.1 0\n", " - - - 650 - -\n");
    let report = read(&text);
    let written = write(&report, &TextLayout::industry(), &["one\ntwo", "", "three  "]).unwrap();
    let with_comments = text.replacen('\n', "\n# one\n# two\n# three\n", 1);
    assert_eq!(written, with_comments);
}

/// Every column that the format defines is read and written again, an optional one with a sample that is not available.
#[test]
fn every_column_comes_back() {
    // Where the fuel flow of all engines is recorded, that of each engine is not.
    for absent in [Column::FuelFlowTotal, Column::FuelFlowEngine(1)] {
        let columns: Vec<Column> = Column::ALL.into_iter().filter(|c| *c != absent).collect();
        let line = |word: &dyn Fn(Column) -> String| {
            columns.iter().map(|column| word(*column)).collect::<Vec<_>>().join(" ")
        };
        let mut text = SAMPLE[..=SAMPLE.find("\nTIME").unwrap()].to_owned();
        text.push_str(&line(&|column| column.name()));
        text.push('\n');
        text.push_str(&line(&|column| column.canonical_unit().to_owned()));
        text.push('\n');
        for sample in 0..3 {
            let value = |column: Column| match column {
                Column::Time => (60 * sample).to_string(),
                Column::FuelUsed => (1000 + 10 * sample).to_string(),
                optional if optional.is_optional() && sample == 1 => "-".to_owned(),
                other => {
                    let range = other.range();
                    let least = range.minimum.unwrap_or(0.0);
                    // Whole numbers where the range holds one: anti-ice is 0 or 1.
                    let middle = 0.5 * (least + range.maximum.unwrap_or(least + 2.0));
                    if middle.ceil() <= range.maximum.unwrap_or(middle + 1.0) {
                        middle.ceil().to_string()
                    } else {
                        middle.to_string()
                    }
                }
            };
            text.push_str(&line(&value));
            text.push('\n');
        }
        let written = write(&read(&text), &TextLayout::exact(), &[]).unwrap();
        let table = |text: &str| text[text.find("\nTIME").unwrap()..].to_owned();
        assert_eq!(table(&written), table(&text), "{absent:?}");
    }
}

#[test]
fn what_the_text_cannot_hold_is_refused() {
    let layout = TextLayout::industry();
    let (header, columns) = read(SAMPLE).into_parts();
    let written = |change: &dyn Fn(&mut ReportHeader, &mut ReportColumns)| {
        let (mut header, mut columns) = (header.clone(), columns.clone());
        change(&mut header, &mut columns);
        write(&Report::new(header, columns).unwrap(), &layout, &[])
    };
    for (key, change) in [
        (
            "TAIL",
            (|header, _| header.identity.tail.push(' '))
                as fn(&mut ReportHeader, &mut ReportColumns),
        ),
        ("FLIGHT", |header, _| header.identity.flight.push_str(" # 2")),
        ("AIRCRAFT", |header, _| header.aircraft_type.push_str("\nREMARK x")),
        ("note", |header, _| header.notes.push(("TWO WORDS".into(), "x".into()))),
        ("LHV", |header, _| header.notes.push(("LHV".into(), "43 MJ/kg".into()))),
        ("ASSUMED", |header, _| {
            header.assumed.push(Assumption::Other { key: "CG".into(), value: "1,2=3".into() });
        }),
    ] {
        assert_eq!(written(&change).unwrap_err(), WriteError::HeaderNotKept { key });
    }
    let declared = written(&|header, _| header.missing.push(MissingColumn::Roll)).unwrap_err();
    assert_eq!(declared, WriteError::ColumnDeclaredMissing);
    let code = |error: WriteError| match error {
        WriteError::Refused(refusal) => refusal.kind.code(),
        other => panic!("{other:?}"),
    };
    // Nothing declares the column missing; times that rounding makes equal; a flow that it makes zero; Mach 1.2.
    let refused = [
        ("column-missing", written(&|_, columns| columns.roll_deg = None)),
        ("time-not-increasing", written(&|_, columns| columns.time_s[1] = 0.0004)),
        (
            "out-of-range",
            written(&|_, columns| {
                columns.fuel_flow = FuelFlowColumns::PerEngine(vec![vec![1e-5; 3]; 2]);
            }),
        ),
        ("out-of-range", written(&|_, columns| columns.mach[2] = 1.2)),
        (
            "out-of-range",
            written(&|_, columns| columns.optional.insert(Column::AntiIce, vec![Some(0.5); 3])),
        ),
        ("header-value-malformed", written(&|header, _| header.identity.tail.clear())),
    ];
    for (expected, result) in refused {
        assert_eq!(code(result.unwrap_err()), expected);
    }
}

#[test]
fn other_units_and_decimals() {
    let layout = TextLayout::industry()
        .with(Column::FuelUsed, "kg", Decimals::Fixed(2))
        .unwrap()
        .with(Column::N2(2), "%", Decimals::Fixed(3))
        .unwrap()
        .with(Column::Time, "min", Decimals::AtMost(4))
        .unwrap();
    let text = write(&read(SAMPLE), &layout, &[]).unwrap();
    // 24 283 lb × 0.45359237 kg/lb = 11 014.583 521 kg; 1353 lb = 613.710 477 kg.
    assert!(text.contains("\nZFW      11014.58 kg\n"), "{text}");
    assert!(
        text.contains("\n0 43008 ")
            && text.contains("\n1 43003 ")
            && text.contains(" 89.400 89.400 654 658 613.71 ")
    );
    let error = TextLayout::industry().with(Column::Mach, "kt", Decimals::Shortest).unwrap_err();
    assert_eq!(error.to_string(), "column MACH is not written in kt");
}

prop_compose! {
    fn some_report()(
        engines in 1_usize..=4,
        samples in 3_usize..8,
    )(
        steps in prop::collection::vec(0.01_f64..100.0, samples),
        numbers in prop::collection::vec(prop::collection::vec(0.0_f64..1.0, samples), 24 + 4 * engines),
        absent in prop::collection::vec(prop::collection::vec(any::<bool>(), samples), 8),
        present in prop::collection::vec(any::<bool>(), 16),
        masses in (1_000.0_f64..300_000.0, 100.0_f64..150_000.0),
        start in -60_000_000_000_i64..200_000_000_000,
        texts in prop::collection::vec("[!-\"$-~§]([ -\"$-~§\t]{0,8}[!-\"$-~§])?", 4),
        isa_deviation_k in -120.0_f64..120.0,
    ) -> Report {
        let samples = steps.len();
        let engines = (numbers.len() - 24) / 4;
        let mut series = numbers.into_iter();
        let mut within = |low: f64, high: f64| -> Vec<f64> {
            series.next().unwrap().into_iter().map(|share| low + share * (high - low)).collect()
        };
        let mut gaps = absent.into_iter();
        let mut thin = |is_present: bool, values: Vec<f64>| {
            let gaps = gaps.next().unwrap();
            is_present.then(|| values.into_iter().zip(gaps).map(|(value, gap)| (!gap).then_some(value)).collect())
        };
        let missing: Vec<_> =
            MissingColumn::ALL.into_iter().zip(&present).filter(|(_, present)| !**present).map(|(column, _)| column).collect();
        let kept = |column: MissingColumn, values: Vec<f64>| (!missing.contains(&column)).then_some(values);
        let fuel_on_board_kg = masses.1;
        let mut fuel_used_kg = within(0.0, fuel_on_board_kg);
        fuel_used_kg.sort_by(f64::total_cmp);
        let columns = ReportColumns {
            time_s: steps.iter().scan(-50.0, |time, step| { *time += step; Some(*time) }).collect(),
            pressure_altitude_m: within(-609.6, 18_288.0),
            static_air_temperature_k: kept(MissingColumn::StaticAirTemperature, within(173.15, 333.15)),
            mach: within(0.1, 0.99),
            true_airspeed_m_s: within(25.8, 514.4),
            ground_speed_m_s: within(25.8, 514.4),
            roll_deg: kept(MissingColumn::Roll, within(-90.0, 90.0)),
            drift_deg: kept(MissingColumn::Drift, within(-90.0, 90.0)),
            n2_percent: (!missing.contains(&MissingColumn::N2)).then(|| (0..engines).map(|_| within(0.0, 130.0)).collect()),
            fuel_flow: if present[4] {
                FuelFlowColumns::PerEngine((0..engines).map(|_| within(1e-3, 12.5)).collect())
            } else {
                FuelFlowColumns::Total(within(1e-3, 12.5))
            },
            fuel_used_kg,
            optional: [
                (Column::Latitude, thin(present[5], within(-90.0, 90.0))),
                (Column::Longitude, thin(present[6], within(-180.0, 360.0))),
                (Column::TrueHeading, thin(present[7], within(-360.0, 360.0))),
                (Column::CenterOfGravity, thin(present[8], within(-50.0, 150.0))),
                (Column::TotalAirTemperature, thin(present[9], within(173.15, 363.15))),
                (Column::N1(1), thin(present[10], within(0.0, 130.0))),
                (Column::ExhaustGasTemperature(1), thin(present[11], within(173.15, 1773.15))),
                (Column::FuelQuantity, thin(present[12], within(0.0, 1.02 * fuel_on_board_kg))),
                (Column::AntiIce, present[13].then(|| vec![Some(1.0); samples])),
            ]
            .into_iter()
            .filter_map(|(column, values)| Some((column, values?)))
            .collect(),
        };
        let is_assumed = missing.contains(&MissingColumn::StaticAirTemperature);
        let header = ReportHeader {
            aircraft_type: texts[0].clone(),
            identity: FlightIdentity {
                tail: texts[1].clone(),
                flight: texts[2].clone(),
                start: Timestamp::from_second(start).unwrap(),
            },
            zero_fuel_mass: Mass::kilograms(masses.0),
            fuel_on_board: Mass::kilograms(fuel_on_board_kg),
            lower_heating_value_mj_kg: present[14].then_some(43.15),
            missing,
            assumed: is_assumed.then_some(Assumption::StaticAirTemperatureIsa { isa_deviation_k }).into_iter().collect(),
            notes: vec![("REMARK".to_owned(), texts[3].clone())],
        };
        Report::new(header, columns).unwrap()
    }
}

proptest! {
    #[test]
    fn exact_text_gives_the_same_report_back(report in some_report()) {
        let text = write(&report, &TextLayout::exact(), &["made up"]).unwrap();
        let parsed = Reader::new().read(text.as_bytes()).unwrap();
        prop_assert_eq!(&parsed.report, &report);
        prop_assert!(parsed.findings.is_empty());
    }

    #[test]
    fn industry_text_is_within_half_of_its_last_decimals(report in some_report()) {
        let layout = TextLayout::industry();
        let text = match write(&report, &layout, &[]) {
            Ok(text) => text,
            // Random flows below half a pound an hour round to zero, which the format does not allow.
            Err(WriteError::Refused(refusal)) => {
                prop_assert!(refusal.to_string().contains("WF"), "{}", refusal);
                return Ok(());
            }
            Err(error) => panic!("{error:?}"),
        };
        let back = Reader::new().read(text.as_bytes()).unwrap().report;
        let close = |found: &[f64], meant: &[f64], tolerance: f64| {
            found.iter().zip(meant).all(|(found, meant)| (found - meant).abs() <= tolerance)
        };
        let (found, meant) = (back.columns(), report.columns());
        prop_assert!(close(&found.time_s, &meant.time_s, 0.000_500_1));
        prop_assert!(close(&found.pressure_altitude_m, &meant.pressure_altitude_m, 0.500_1 * 0.3048));
        prop_assert!(close(&found.mach, &meant.mach, 0.000_050_1));
        prop_assert!(close(&found.fuel_used_kg, &meant.fuel_used_kg, 0.500_1 * 0.453_592_37));
        // A second time nothing is rounded any more.
        prop_assert_eq!(write(&back, &layout, &[]).unwrap(), text);
    }
}
