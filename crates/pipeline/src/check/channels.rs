//! Channels that do not move, move in coarse steps, or hold another scale.

use std::borrow::Cow;

use flight::column::Column;
use flight::{FuelFlowColumns, OptionalColumn, Report, Severity};
use units::convert::{
    KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR, METERS_PER_SECOND_PER_KNOT, RADIANS_PER_DEGREE,
};

use super::{Draft, mean};

/// A channel that keeps one value this long, while it moves otherwise or others do, is stuck, s.
const STUCK_S: f64 = 1500.0;
/// Fewest samples from which a channel is judged.
const FEWEST_SAMPLES: usize = 12;
/// A run at one value is remarkable where less than this share of the other neighbours are equal.
const EQUAL_NEIGHBORS: f64 = 0.25;
/// Neighbours are looked at this far apart, s: a second apart most of any recorded steps are equal.
const NEIGHBORS_S: f64 = 60.0;
/// In a recording faster than that the other runs of one value are resolved, and judge too: a run is remarkable where it is this many
/// times as long as the second longest, and less than this share of the other neighbours are equal. Measured: 404 channels of level
/// flight at 0.25 and 1 Hz hold no run of 25 minutes; one recording in steps four times as coarse as usual holds one of 35, beside one of
/// 16 and 0.89 of equal neighbours. Channels that were held for 30 minutes on purpose have runs 3.9 times as long, and 0.56.
const TIMES_SECOND_RUN: f64 = 3.0;
const EQUAL_NEIGHBORS_OF_FAST: f64 = 0.6;
/// Centres of gravity of aircraft in flight, % of the mean aerodynamic chord.
const CENTER_OF_GRAVITY_PERCENT_MAC: (f64, f64) = (3.0, 60.0);
/// Rotor speeds of engines in cruise, %.
const ROTOR_SPEED_PERCENT: (f64, f64) = (35.0, 118.0);

pub(super) fn check(report: &Report) -> Vec<Draft> {
    let mut findings = Vec::new();
    let channels = channels(report);
    let moving = channels.iter().filter(|channel| channel.distinct() > 2).count();
    for channel in &channels {
        findings.extend(channel.stuck(&report.columns().time_s, moving > 0));
        findings.extend(channel.coarse());
    }
    findings.extend(rotor_scale(report));
    findings.extend(center_of_gravity(report));
    findings.extend(heading_scale(report));
    findings
}

/// A recorded channel that moves in every cruise.
struct Channel<'a> {
    name: Cow<'static, str>,
    values: &'a [f64],
    /// Step between neighbouring values from which the channel is coarse, in its stored unit and in words.
    coarse: (f64, &'static str),
}

fn channels(report: &Report) -> Vec<Channel<'_>> {
    let columns = report.columns();
    let mut channels = Vec::new();
    let mut push = |name: Cow<'static, str>, values, coarse: (f64, &'static str)| {
        channels.push(Channel { name, values, coarse });
    };
    let knot = METERS_PER_SECOND_PER_KNOT;
    push("GSPD".into(), &columns.ground_speed_m_s, (4.5 * knot, "5 kt"));
    push("VTAS".into(), &columns.true_airspeed_m_s, (4.5 * knot, "5 kt"));
    let is_assumed = !report.header().assumed.is_empty();
    if let (Some(values), false) = (&columns.static_air_temperature_k, is_assumed) {
        push("SAT".into(), values, (1.9, "2 K"));
    }
    push("MACH".into(), &columns.mach, (0.0095, "0.01"));
    let per_hour = KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR;
    match &columns.fuel_flow {
        FuelFlowColumns::Total(total) => {
            push("WF".into(), total, (95.0 * per_hour, "100 kg/h"));
        }
        FuelFlowColumns::PerEngine(engines) => {
            for (engine, values) in engines.iter().enumerate() {
                push(format!("WF({})", engine + 1).into(), values, (45.0 * per_hour, "50 kg/h"));
            }
        }
    }
    channels
}

/// Samples with one value.
struct Run {
    first: usize,
    last: usize,
    /// Where the channel may end, which it then meets in other runs too: they count neither way.
    limit: Option<f64>,
}

/// Number of samples from one to the next that is about a minute later.
fn samples_apart(time_s: &[f64]) -> usize {
    let mut steps_s: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps_s.len() / 2;
    if steps_s.is_empty() {
        return 1;
    }
    let (_, median_s, _) = steps_s.select_nth_unstable_by(middle, f64::total_cmp);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "steps of a report are above zero, and a quotient beyond usize is its largest"
    )]
    let samples = (NEIGHBORS_S / *median_s).round() as usize;
    samples.max(1)
}

impl Channel<'_> {
    /// Number of different values, counted to 3.
    fn distinct(&self) -> usize {
        let mut seen: Vec<f64> = Vec::new();
        for value in self.values {
            if !seen.contains(value) {
                seen.push(*value);
            }
            if seen.len() > 2 {
                break;
            }
        }
        seen.len()
    }

    fn stuck(&self, time_s: &[f64], others_move: bool) -> Option<Draft> {
        if self.values.len() < FEWEST_SAMPLES || !others_move {
            return None;
        }
        let (first, last) = self.longest_run();
        let run_s = time_s[last] - time_s[first];
        if run_s < STUCK_S {
            return None;
        }
        let (low, high) = self.extremes();
        let is_whole = first == 0 && last + 1 == self.values.len();
        let value = self.values[first];
        let at_limit = !is_whole && (value <= low || value >= high);
        let run = Run { first, last, limit: at_limit.then_some(value) };
        if !is_whole && !self.moves_beside(&run, time_s) {
            return None;
        }
        // A Mach number that an autopilot holds, or temperature and speed of calm air, may stay at one printed value.
        if is_whole && !self.name.starts_with("WF") && !self.name.starts_with("GSPD") {
            return None;
        }
        Some(Draft {
            severity: if is_whole { Severity::Serious } else { Severity::Warning },
            code: if at_limit { "channel-saturated" } else { "channel-stuck" },
            size: run_s,
            unit: "s",
            message: format!(
                "{} keeps one value for {run_s:.0} s from {:.0} s on{}",
                self.name,
                time_s[first],
                if at_limit { ", its largest or smallest" } else { "" }
            ),
            likely_cause: if at_limit {
                "the recorder's range ends there".to_owned()
            } else {
                "the sensor or its bus label stopped, or the column is a constant".to_owned()
            },
            remedy: format!("leave these samples of {} out", self.name),
        })
    }

    /// First and last sample of the longest run of one value.
    fn longest_run(&self) -> (usize, usize) {
        let (mut best, mut first) = ((0, 0), 0);
        // A longer run than the longest so far reaches beyond as many samples. Looked at backwards from there, most samples
        // need not be looked at.
        while let Some(needed) = self.values.get(first..=first + (best.1 - best.0) + 1) {
            let value = needed[0].to_bits();
            let differs = |value: &f64, from: u64| value.to_bits() != from;
            let end = needed[needed.len() - 1].to_bits();
            let others = needed.iter().rposition(|value| differs(value, end));
            first += if let Some(last) = others {
                // The first run that can reach so far begins behind the last value that is another than there.
                last + 1
            } else {
                let rest = self.values[first..].iter().position(|other| differs(other, value));
                let length = rest.unwrap_or(self.values.len() - first);
                best = (first, first + length - 1);
                length
            };
        }
        best
    }

    /// A channel of few steps repeats itself: only what moves finely elsewhere is stuck in a run.
    fn moves_beside(&self, run: &Run, time_s: &[f64]) -> bool {
        let apart = samples_apart(time_s);
        let outside = self.values.len() - (run.last - run.first + 1);
        if outside / apart < FEWEST_SAMPLES {
            return false;
        }
        let equal = self.equal_neighbors(run, apart);
        if apart == 1 {
            return equal <= EQUAL_NEIGHBORS;
        }
        let run_s = time_s[run.last] - time_s[run.first];
        equal <= EQUAL_NEIGHBORS_OF_FAST
            && run_s >= TIMES_SECOND_RUN * self.longest_other_run_s(run, time_s)
    }

    fn longest_other_run_s(&self, run: &Run, time_s: &[f64]) -> f64 {
        let mut longest_s = 0.0_f64;
        let mut first = 0;
        for same in self.values.chunk_by(|one, other| one.to_bits() == other.to_bits()) {
            let last = first + same.len() - 1;
            if first != run.first && run.limit.map(f64::to_bits) != Some(same[0].to_bits()) {
                longest_s = longest_s.max(time_s[last] - time_s[first]);
            }
            first = last + 1;
        }
        longest_s
    }

    /// Share of equal neighbours outside a run, so many samples apart.
    fn equal_neighbors(&self, run: &Run, apart: usize) -> f64 {
        let bits = |sample: usize| self.values[sample].to_bits();
        let limit = run.limit.map(f64::to_bits);
        let (mut equal, mut pairs) = (0.0, 0.0);
        for sample in 0..self.values.len().saturating_sub(apart) {
            let is_inside = sample >= run.first && sample + apart <= run.last;
            let is_equal = bits(sample) == bits(sample + apart);
            if is_inside || is_equal && Some(bits(sample)) == limit {
                continue;
            }
            pairs += 1.0;
            equal += f64::from(u8::from(is_equal));
        }
        if pairs > 0.0 { equal / pairs } else { 1.0 }
    }

    fn extremes(&self) -> (f64, f64) {
        self.values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(*value), high.max(*value))
        })
    }

    /// Steps that are large for the channel. At least four values have to be met: two levels of a cruise are no step.
    fn coarse(&self) -> Option<Draft> {
        let (limit, words) = self.coarse;
        let is_fine = |pair: &[f64]| {
            let step = (pair[1] - pair[0]).abs();
            step > 0.0 && step < limit
        };
        // Nearly every channel has such neighbours in time, and is not sorted then: the smallest step is smaller still.
        if self.values.len() < FEWEST_SAMPLES || self.values.windows(2).any(is_fine) {
            return None;
        }
        let mut sorted = self.values.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted.dedup();
        let fewest = if self.name == "MACH" { 3 } else { 4 };
        if sorted.len() < fewest {
            return None;
        }
        let step = sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        if step < limit {
            return None;
        }
        Some(Draft {
            severity: Severity::Warning,
            code: "channel-coarse",
            size: step / limit,
            unit: "-",
            message: format!("{} moves in steps of {words} or more", self.name),
            likely_cause: "rounded where it was decoded or exported".to_owned(),
            remedy: format!("export {} with all digits of its recorder", self.name),
        })
    }
}

/// Rotor speeds as fractions.
fn rotor_scale(report: &Report) -> Option<Draft> {
    let columns = report.columns();
    let n2 = columns.n2_percent.as_ref()?;
    let percent = mean(n2.iter().flatten().copied())?;
    let (low, high) = ROTOR_SPEED_PERCENT;
    if (low..=high).contains(&percent) {
        return None;
    }
    let is_fraction = percent <= 1.3;
    Some(Draft {
        severity: Severity::Serious,
        code: "rotor-speed-scale",
        size: percent,
        unit: "%",
        message: format!("N2 is {percent:.2} % on average"),
        likely_cause: if is_fraction {
            "N2: fractions declared as per cent"
        } else {
            "N2 is another quantity"
        }
        .to_owned(),
        remedy: if is_fraction {
            "N2: scale 100"
        } else {
            "map N2 to the high-pressure rotor speed"
        }
        .to_owned(),
    })
}

fn center_of_gravity(report: &Report) -> Option<Draft> {
    let percent = mean_of(report.columns().optional.get(Column::CenterOfGravity))?;
    let (low, high) = CENTER_OF_GRAVITY_PERCENT_MAC;
    if (low..=high).contains(&percent) {
        return None;
    }
    let (likely_cause, remedy) = if (-high..=-low).contains(&percent) {
        ("CG: sign reversed", "CG: scale -1 (positive behind the leading edge)")
    } else if (0.01 * low..=0.01 * high).contains(&percent) {
        ("CG: fraction of the chord declared as per cent", "CG: scale 100")
    } else {
        ("CG is a moment arm or an index, not per cent of the chord", "CG: convert to %MAC")
    };
    Some(Draft {
        severity: Severity::Warning,
        code: "center-of-gravity",
        size: percent,
        unit: "%MAC",
        message: format!(
            "centre of gravity {percent:.2} % of the mean aerodynamic chord on average"
        ),
        likely_cause: likely_cause.to_owned(),
        remedy: remedy.to_owned(),
    })
}

/// Headings in radians: never beyond 2π, and of a flight that does not go north.
fn heading_scale(report: &Report) -> Option<Draft> {
    let columns = report.columns();
    let headings = columns.optional.get(Column::TrueHeading)?;
    let (latitudes, longitudes) =
        (columns.optional.get(Column::Latitude)?, columns.optional.get(Column::Longitude)?);
    let largest =
        headings.iter().flatten().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    if largest > 2.0 * core::f64::consts::PI || headings.iter().flatten().count() < FEWEST_SAMPLES {
        return None;
    }
    // Flown east or west by more than a tenth of the way north or south: the heading cannot be within 6.3° of north.
    let change = |values: &OptionalColumn| {
        let first = values.iter().flatten().next().copied()?;
        values.iter().flatten().next_back().map(|last| last - first)
    };
    let north = change(latitudes)?;
    let latitude = mean_of(Some(latitudes))?;
    let east = change(longitudes)? * (latitude * RADIANS_PER_DEGREE).cos();
    let is_straight_north = north > 0.0 && east.abs() < 0.3 * north;
    if is_straight_north || north.hypot(east) < 1.0 {
        return None;
    }
    Some(Draft {
        severity: Severity::Warning,
        code: "heading-scale",
        size: largest,
        unit: "deg",
        message: format!("HDG never exceeds {largest:.2}, but the positions do not go north"),
        likely_cause: "HDG: radians declared as degrees".to_owned(),
        remedy: "HDG: scale 57.29578".to_owned(),
    })
}

fn mean_of(column: Option<&OptionalColumn>) -> Option<f64> {
    mean(column?.iter().flatten().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two hours and a half, a second each, about `middle` by slow waves of this size, in steps as recorded.
    fn cruise(middle: f64, size: f64, step: f64) -> Vec<f64> {
        let value = |second: f64| {
            let waves = (second / 190.0).sin() + (second / 127.0).sin() + (second / 231.0).sin();
            ((middle + size / 3.0 * waves) / step).round() * step
        };
        (0..9000).map(|second| value(f64::from(second))).collect()
    }

    fn found(values: &[f64], apart_s: f64) -> Option<&'static str> {
        let time_s: Vec<f64> = (0..values.len()).map(|sample| apart_s * sample as f64).collect();
        let channel = Channel { name: "MACH".into(), values, coarse: (0.0095, "0.01") };
        channel.stuck(&time_s, true).map(|draft| draft.code)
    }

    /// Half an hour at one value is planted: found at one sample a second and in ten seconds, though most neighbours are equal there
    /// without it; and none where nothing is planted, also in steps so coarse that a channel stays at one value for long anyhow.
    #[test]
    fn a_stuck_channel_is_found_at_any_rate() {
        for (middle, size, step) in [(0.78, 0.004, 0.0005), (-54.0, 2.0, 0.25), (450.0, 8.0, 1.0)] {
            let clean = cruise(middle, size, step);
            let mut stuck = clean.clone();
            stuck[3000..4800].fill(clean[3000]);
            for every in [1, 10] {
                let slower = |values: &[f64]| -> Vec<f64> {
                    values.iter().step_by(every).copied().collect()
                };
                let apart_s = every as f64;
                assert_eq!(found(&slower(&clean), apart_s), None, "{middle}, {every} s");
                assert_eq!(
                    found(&slower(&stuck), apart_s),
                    Some("channel-stuck"),
                    "{middle}, {every} s"
                );
            }
            let mut short = clean.clone();
            short[3000..4200].fill(clean[3000]);
            assert_eq!(found(&short, 1.0), None, "{middle}");
            assert_eq!(found(&cruise(middle, size, 4.0 * step), 1.0), None, "{middle}");
        }
    }

    /// By hand: neighbours at one sample a minute are the next ones, at one in ten seconds the sixth.
    #[test]
    fn neighbors_are_about_a_minute_apart() {
        let every =
            |step_s: f64| (0..30).map(|sample| step_s * f64::from(sample)).collect::<Vec<_>>();
        let apart =
            [1.0, 4.0, 10.0, 30.0, 45.0, 60.0, 90.0].map(|step_s| samples_apart(&every(step_s)));
        assert_eq!(apart, [60, 15, 6, 2, 1, 1, 1]);
        assert_eq!(samples_apart(&[0.0]), 1);
    }
}
