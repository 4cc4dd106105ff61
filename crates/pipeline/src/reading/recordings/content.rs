//! By what a flight out of a recording is known again.

use flight::{Report, ReportColumns};

use crate::checksum::sha256;

/// By what a flight out of a recording is known again: header and every sample, to the bit.
pub(super) fn content_as_read(report: &Report) -> String {
    let header = report.header();
    let mut content = format!(
        "{}\n{}\n{}\n{}\n",
        header.aircraft_type, header.identity.tail, header.identity.flight, header.identity.start
    )
    .into_bytes();
    for (key, text) in &header.notes {
        content.extend(format!("{key} {text}\n").into_bytes());
    }
    let heating_value = header.lower_heating_value_mj_kg.unwrap_or(f64::NAN);
    let masses = [header.zero_fuel_mass, header.fuel_on_board].map(units::Mass::to_kilograms);
    let numbers = [masses[0], masses[1], heating_value];
    content.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    each_column(report.columns(), |name, values| {
        content.extend_from_slice(name.as_bytes());
        content.extend(values.iter().flat_map(|word| word.to_le_bytes()));
    });
    format!("flight:{}", sha256(&content))
}

/// Each column's name and two words that stand for its values.
fn each_column(columns: &ReportColumns, mut each: impl FnMut(&str, [u64; 2])) {
    // Each step of a sum waits for the one before: of several columns they are made side by side.
    let mut together: Vec<(&str, &[f64])> = Vec::with_capacity(16);
    let mut one = |name, values| together.push((name, values));
    one("TIME", &columns.time_s);
    one("ALT", &columns.pressure_altitude_m);
    one("SAT", columns.static_air_temperature_k.as_deref().unwrap_or_default());
    one("MACH", &columns.mach);
    one("VTAS", &columns.true_airspeed_m_s);
    one("GSPD", &columns.ground_speed_m_s);
    one("ROLL", columns.roll_deg.as_deref().unwrap_or_default());
    one("DRIFT", columns.drift_deg.as_deref().unwrap_or_default());
    for speeds in columns.n2_percent.iter().flatten() {
        one("N2", speeds);
    }
    match &columns.fuel_flow {
        flight::FuelFlowColumns::Total(total) => one("WF", total),
        flight::FuelFlowColumns::PerEngine(flows) => {
            for flow in flows {
                one("WF()", flow);
            }
        }
    }
    one("FU", &columns.fuel_used_kg);
    for columns in together.chunks(COLUMNS_AT_ONCE) {
        let words = folded_together(columns);
        for ((name, _), words) in columns.iter().zip(words) {
            each(name, words);
        }
    }
    for (column, values) in columns.optional.iter() {
        let values = values.iter().map(|value| value.unwrap_or(f64::NAN));
        each(&column.name(), folded(values));
    }
}

/// 128 bits that depend on every bit of every value and on their order: two sums, one multiplied by an odd number and
/// rotated at each step, so that no exchange of values leaves both. Against accident, not against intent.
fn folded(values: impl Iterator<Item = f64>) -> [u64; 2] {
    values.fold([0; 2], with)
}

/// The same of a few columns; one that is shorter than the others by itself.
fn folded_together(columns: &[(&str, &[f64])]) -> [[u64; 2]; COLUMNS_AT_ONCE] {
    let mut words = [[0; 2]; COLUMNS_AT_ONCE];
    let [(_, a), (_, b), (_, c)] = columns else {
        for (words, (_, values)) in words.iter_mut().zip(columns) {
            *words = folded(values.iter().copied());
        }
        return words;
    };
    let rows = a.len().min(b.len()).min(c.len());
    for ((a, b), c) in a.iter().zip(*b).zip(*c) {
        words = [with(words[0], *a), with(words[1], *b), with(words[2], *c)];
    }
    for (words, (_, values)) in words.iter_mut().zip(columns) {
        *words = values[rows..].iter().copied().fold(*words, with);
    }
    words
}

/// Columns whose sums are made side by side: as many as the registers of a processor hold.
const COLUMNS_AT_ONCE: usize = 3;

fn with(words: [u64; 2], value: f64) -> [u64; 2] {
    // The golden ratio and the square root of three, as odd 64-bit fractions.
    const FACTORS: [u64; 2] = [0x9e37_79b9_7f4a_7c15, 0xbb67_ae85_84ca_a73b];
    let bits = value.to_bits();
    [
        (words[0] ^ bits).wrapping_mul(FACTORS[0]).rotate_left(29),
        words[1].wrapping_mul(FACTORS[1]).wrapping_add(bits ^ (bits >> 31)),
    ]
}
