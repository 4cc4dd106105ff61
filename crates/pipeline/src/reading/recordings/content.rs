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
    #[expect(clippy::cast_precision_loss, reason = "no flight has 2^53 samples")]
    let numbers = [masses[0], masses[1], heating_value, report.len() as f64];
    content.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    each_column(report.columns(), |name, values| {
        content.extend_from_slice(name.as_bytes());
        content.extend(values.iter().flat_map(|word| word.to_le_bytes()));
    });
    format!("flight:{}", sha256(&content))
}

/// Each column's name and two words that stand for its values.
fn each_column(columns: &ReportColumns, mut each: impl FnMut(&str, [u64; 2])) {
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

/// 128 bits that depend on every bit of every value, and on their order. Against accident, not against intent.
///
/// Two values at a time go into the first word by a product of 64 by 64 bits, of which both halves count (a step of the hash "wyhash"
/// by Wang Yi), and into the second one by a rotation and a sum each.
#[derive(Clone, Copy)]
struct Words([u64; 2]);

impl Words {
    /// The golden ratio and the square root of three, as odd 64-bit fractions.
    const BEGINNING: Self = Self([0x9e37_79b9_7f4a_7c15, 0xbb67_ae85_84ca_a73b]);

    #[expect(clippy::cast_possible_truncation, reason = "both halves are taken")]
    fn with(self, one: f64, other: f64) -> Self {
        let (one, other) = (one.to_bits(), other.to_bits());
        let Self([product, sum]) = self;
        let wide = u128::from(product ^ one) * u128::from(other ^ Self::BEGINNING.0[0]);
        let sum = (sum.rotate_left(19).wrapping_add(one)).rotate_left(19).wrapping_add(other);
        Self([wide as u64 ^ (wide >> 64) as u64, sum])
    }

    /// Of values, behind those of which these are.
    fn with_all(self, values: impl IntoIterator<Item = f64>) -> [u64; 2] {
        let mut words = self;
        let mut values = values.into_iter();
        while let Some(one) = values.next() {
            words = words.with(one, values.next().unwrap_or(f64::NAN));
        }
        words.0
    }
}

/// The words of a few columns; one that is longer than the others ends by itself.
fn folded_together(columns: &[(&str, &[f64])]) -> [[u64; 2]; COLUMNS_AT_ONCE] {
    let mut words = [[0; 2]; COLUMNS_AT_ONCE];
    let [(_, a), (_, b), (_, c)] = columns else {
        for (words, (_, values)) in words.iter_mut().zip(columns) {
            *words = folded(values.iter().copied());
        }
        return words;
    };
    let mut all = [Words::BEGINNING; COLUMNS_AT_ONCE];
    let pairs = a.as_chunks::<2>().0.iter().zip(b.as_chunks::<2>().0).zip(c.as_chunks::<2>().0);
    let together = 2 * pairs.len();
    for ((a, b), c) in pairs {
        all = [all[0].with(a[0], a[1]), all[1].with(b[0], b[1]), all[2].with(c[0], c[1])];
    }
    for ((words, all), (_, values)) in words.iter_mut().zip(all).zip(columns) {
        *words = all.with_all(values[together..].iter().copied());
    }
    words
}

fn folded(values: impl Iterator<Item = f64>) -> [u64; 2] {
    Words::BEGINNING.with_all(values)
}

/// Columns whose words are made side by side, since each step waits for the one before: as many as the registers of a processor hold.
const COLUMNS_AT_ONCE: usize = 3;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// A changed bit, an exchange, a value less: other words; side by side the same as alone.
        #[test]
        fn words_depend_on_every_bit_and_on_the_order(
            values in prop::collection::vec(any::<f64>(), 1..40),
            place in any::<prop::sample::Index>(),
            other in any::<prop::sample::Index>(),
            bit in 0_u32..64,
        ) {
            let words = |values: &[f64]| folded(values.iter().copied());
            let (place, other) = (place.index(values.len()), other.index(values.len()));
            let mut changed = values.clone();
            changed[place] = f64::from_bits(values[place].to_bits() ^ 1 << bit);
            prop_assert_ne!(words(&values)[0], words(&changed)[0]);
            prop_assert_ne!(words(&values)[1], words(&changed)[1]);
            let mut exchanged = values.clone();
            exchanged.swap(place, other);
            let is_same = values[place].to_bits() == values[other].to_bits();
            prop_assert_eq!(words(&values) == words(&exchanged), is_same);
            prop_assert_ne!(words(&values), words(&values[1..]));
            let columns = [("a", &values[..]), ("b", &changed[..]), ("c", &values[1..])];
            let expected = columns.map(|(_, values)| words(values));
            prop_assert_eq!(folded_together(&columns), expected);
        }
    }
}
