//! Trim criteria by the name of a preset, or of one's own in a file.

use std::path::Path;
use std::str::FromStr;

use segmenter::TrimCriteria;
use serde::Deserialize;

/// Criteria and the name by which models state them.
#[derive(Clone, Debug)]
pub(crate) struct NamedCriteria {
    /// A preset's name; of criteria in a file their own, `#`, and eight digits that change with any limit, so that a
    /// folder is not continued with other limits under the same name.
    pub(crate) name: String,
    /// The limits.
    pub(crate) limits: TrimCriteria,
}

impl NamedCriteria {
    /// The default.
    pub(crate) const fn name_of_default() -> &'static str {
        TrimCriteria::PRESETS[0]
    }
}

impl Default for NamedCriteria {
    fn default() -> Self {
        Self {
            name: Self::name_of_default().to_owned(),
            limits: TrimCriteria::ghazi_2020_table_4(),
        }
    }
}

impl FromStr for NamedCriteria {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(limits) = TrimCriteria::preset(text) {
            return Ok(Self { name: text.to_owned(), limits });
        }
        if !Path::new(text).is_file() {
            let presets = TrimCriteria::PRESETS.join(", ");
            let meant = report::nearest(text, TrimCriteria::PRESETS)
                .map_or_else(String::new, |name| format!("; did you mean {name}?"));
            return Err(format!("neither a file nor one of {presets}{meant}"));
        }
        let file = std::fs::read_to_string(text).map_err(|error| error.to_string())?;
        of_file(&file)
    }
}

/// Criteria as they are written; what is left away is as in the preset that they are based on.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Criteria")]
struct CriteriaFile {
    format: u32,
    name: String,
    /// Where the limits come from: without it nobody can judge a result.
    source: String,
    based_on: String,
    pressure_altitude_ft: Option<f64>,
    vertical_speed_ft_min: Option<f64>,
    mach: Option<f64>,
    ground_speed_kt: Option<f64>,
    static_air_temperature_c: Option<f64>,
    n2_percent: Option<f64>,
    drift_deg: Option<f64>,
    roll_deg: Option<f64>,
    outlier_standard_deviations: Option<f64>,
    piece_maximum_s: Option<f64>,
    segment_minimum_s: Option<f64>,
}

fn of_file(text: &str) -> Result<NamedCriteria, String> {
    let options =
        ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    let file: CriteriaFile = options.from_str(text).map_err(|error| error.to_string())?;
    if file.format != 1 {
        return Err(format!("criteria file of format {}, expected format 1", file.format));
    }
    if file.source.trim().is_empty() || file.name.trim().is_empty() || file.name.contains('#') {
        return Err("name (without `#`) and source of criteria must say something".to_owned());
    }
    let mut limits = TrimCriteria::preset(&file.based_on).ok_or_else(|| {
        format!(
            "based_on: {:?}, expected one of {}",
            file.based_on,
            TrimCriteria::PRESETS.join(", ")
        )
    })?;
    let mut digest = FNV_OFFSET;
    for (name, limit, given) in [
        ("pressure_altitude_ft", &mut limits.pressure_altitude_ft, file.pressure_altitude_ft),
        ("vertical_speed_ft_min", &mut limits.vertical_speed_ft_min, file.vertical_speed_ft_min),
        ("mach", &mut limits.mach, file.mach),
        ("ground_speed_kt", &mut limits.ground_speed_kt, file.ground_speed_kt),
        (
            "static_air_temperature_c",
            &mut limits.static_air_temperature_c,
            file.static_air_temperature_c,
        ),
        ("n2_percent", &mut limits.n2_percent, file.n2_percent),
        ("drift_deg", &mut limits.drift_deg, file.drift_deg),
        ("roll_deg", &mut limits.roll_deg, file.roll_deg),
        (
            "outlier_standard_deviations",
            &mut limits.outlier_standard_deviations,
            file.outlier_standard_deviations,
        ),
        ("piece_maximum_s", &mut limits.piece_maximum_s, file.piece_maximum_s),
        ("segment_minimum_s", &mut limits.segment_minimum_s, file.segment_minimum_s),
    ] {
        *limit = given.unwrap_or(*limit);
        if limit.is_nan() || *limit < 0.0 {
            return Err(format!("{name}: {limit}, expected 0 or more, or inf for no limit"));
        }
        digest = fnv(digest, limit.to_bits());
    }
    check_finds(&limits)?;
    Ok(NamedCriteria { name: format!("{}#{:08x}", file.name, digest >> 32), limits })
}

/// Refuses limits by which no recording has a segment: a run of them would end well and learn nothing.
fn check_finds(limits: &TrimCriteria) -> Result<(), String> {
    let (piece_s, segment_s) = (limits.piece_maximum_s, limits.segment_minimum_s);
    let nothing = "no recording has a segment by it";
    if limits.outlier_standard_deviations <= 0.0 {
        return Err(format!("outlier_standard_deviations: 0, expected more than 0: {nothing}"));
    }
    if piece_s <= 0.0 {
        return Err(format!("piece_maximum_s: 0, expected more than 0: {nothing}"));
    }
    if segment_s > piece_s || segment_s.is_infinite() {
        return Err(format!(
            "segment_minimum_s: {segment_s}, expected a time up to piece_maximum_s, {piece_s}: {nothing}"
        ));
    }
    Ok(())
}

/// Fowler, Noll, Vo: FNV-1a of 64 bits (RFC 9923).
const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

fn fnv(digest: u64, word: u64) -> u64 {
    word.to_le_bytes()
        .iter()
        .fold(digest, |digest, byte| (digest ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = r#"(
        format: 1,
        name: "airline",
        source: "what our unit's report 02 asks for",
        based_on: "airbus-report-02",
        ground_speed_kt: 10,
        drift_deg: inf,
    )"#;

    #[test]
    fn what_is_left_away_is_that_of_the_preset() {
        let named = of_file(FILE).unwrap();
        let expected = TrimCriteria { ground_speed_kt: 10.0, ..TrimCriteria::airbus_report_02() };
        assert_eq!(named.limits, expected);
        assert!(named.name.starts_with("airline#") && named.name.len() == 16, "{}", named.name);
        // Any other limit is another name; another source is not.
        let other = of_file(&FILE.replace("10,", "11,")).unwrap();
        assert_ne!(other.name, named.name);
        let sourced = of_file(&FILE.replace("what our", "what their")).unwrap();
        assert_eq!(sourced.name, named.name);
    }

    #[test]
    fn what_says_nothing_or_is_no_limit_is_refused() {
        for (from, to, reason) in [
            ("\"airline\"", "\"\"", "must say something"),
            ("report 02 asks for", "", ""),
            ("airbus-report-02", "airbus", "expected one of ghazi-2020-table-4"),
            ("10,", "-1,", "ground_speed_kt: -1"),
            ("ground_speed_kt", "ground_speed", "ground_speed"),
            ("format: 1", "format: 2", "expected format 1"),
            ("drift_deg: inf", "piece_maximum_s: 0", "piece_maximum_s: 0, expected more"),
            ("drift_deg: inf", "outlier_standard_deviations: 0", "expected more than 0"),
            ("drift_deg: inf", "segment_minimum_s: inf", "up to piece_maximum_s, 600"),
            ("drift_deg: inf", "segment_minimum_s: 601", "up to piece_maximum_s, 600"),
            ("drift_deg: inf", "segment_minimum_s: 600", ""),
        ] {
            let read = of_file(&FILE.replace(from, to));
            if reason.is_empty() {
                assert!(read.is_ok());
                continue;
            }
            let error = read.err().unwrap();
            assert!(error.contains(reason), "{error}");
        }
        assert!("no-such-criteria".parse::<NamedCriteria>().is_err());
    }

    /// FNV-1a of the byte 0x61 is af63dc4c8601ec8c (RFC 9923, appendix C).
    #[test]
    fn fnv_of_a_letter() {
        let letter = (FNV_OFFSET ^ 0x61).wrapping_mul(0x0100_0000_01b3);
        assert_eq!(letter, 0xaf63_dc4c_8601_ec8c);
    }
}
