//! Columns and figures of what the program writes: name, unit, what it is.

/// A column or figure of an output.
pub(super) struct Output {
    /// As it is written in tables and documents.
    pub(super) name: &'static str,
    /// `-` where it has none.
    pub(super) unit: &'static str,
    /// Where it is, and what it means.
    pub(super) words: &'static str,
}

const fn output(name: &'static str, unit: &'static str, words: &'static str) -> Output {
    Output { name, unit, words }
}

/// Those whose name does not say all, by command.
pub(super) const OUTPUTS: [Output; 37] = [
    output("acceleration_m_s2", "m/s²", "Segments: mean rate of change of ground speed."),
    output("temperature_assumed", "0, 1", "Segments: 1 where SAT was assumed and not recorded."),
    output(
        "fuel_flow_kg_s",
        "kg/s",
        "Fuel flow of all engines: recorded in segments, predicted by predict.",
    ),
    output(
        "fuel_flow_std_kg_s",
        "kg/s",
        "predict, law bayes: standard deviation of the fuel flow of one segment of a new flight\n\
         (table, what else was learnt, flight, sensors).",
    ),
    output("specific_range_m_kg", "m/kg", "TAS over the fuel flow of all engines."),
    output(
        "extrapolated",
        "0, 1",
        "predict: 1 where a node of the table outside the guide's range takes part.",
    ),
    output(
        "beyond_flights",
        "0, 1",
        "predict, optimum: 1 where Mach number, lift coefficient, pressure altitude, corrected thrust,\n\
         deviation from the ISA or mass lies beyond all that the model's flights flew.",
    ),
    output(
        "error_percent",
        "%",
        "100 (recorded − predicted)/recorded fuel flow: positive, more is burnt than predicted.",
    ),
    output(
        "remainder_percent",
        "%",
        "predict: fuel flow over that of the learnt table, less 1: what the model has learnt that no\n\
         table over lift coefficient and Mach number can hold.",
    ),
    output(
        "informed_nodes",
        "0 to 1",
        "adapt: share of the table's nodes about which flights have told more than the guide.",
    ),
    output(
        "outside_table",
        "-",
        "Segments outside the table's lift coefficients or Mach numbers: not learnt, in no figure.",
    ),
    output(
        "interval95_coverage",
        "0 to 1",
        "evaluate, law bayes: share of the segments within the model's own 95 % intervals.",
    ),
    output(
        "mean_error_within_percent",
        "%",
        "evaluate: half the 95 % interval that the model states for the mean error of these flights\n\
         before it sees them.",
    ),
    output(
        "mean_error_half_width95_percent",
        "%",
        "evaluate: half the 95 % interval of the mean error as these flights scatter, by which two\n\
         models are compared on the same flights.",
    ),
    output("gap", "%", "diagnose: 100 ln(recorded/predicted fuel flow)."),
    output(
        "noise_floor_rms_percent",
        "%",
        "diagnose: what sensors and flights make of the gap if nothing is wrong, root mean square.",
    ),
    output(
        "probability",
        "0 to 1",
        "diagnose: that an effect is the larger one of what acts, or that nothing in the library\n\
         explains the gap; monitor: that something changed about a date.",
    ),
    output(
        "probability_flat",
        "0 to 1",
        "diagnose: the probability of an effect without what is believed of its size beforehand.",
    ),
    output(
        "class",
        "-",
        "diagnose: effects that these flights cannot tell from the one that is named.",
    ),
    output(
        "closure",
        "share",
        "diagnose: how much of the explainable gap (beyond the noise) closes on flights that neither\n\
         choice nor fit has seen, with its 95 % interval; below 0 the gap widens.",
    ),
    output(
        "share_of_gap",
        "share",
        "diagnose: how much of the explainable gap lies in a place; above 1 where the gap elsewhere\n\
         is less than noise.",
    ),
    output(
        "p_value",
        "0 to 1",
        "diagnose: how often noise alone makes a place as striking as this one anywhere.",
    ),
    output(
        "detectable",
        "effect's",
        "diagnose: the size that would just have been seen, with about 60 % probability.",
    ),
    output(
        "separations",
        "-",
        "diagnose: measurements, or flights on purpose, that would tell apart what is of one class.",
    ),
    output(
        "deviation_percent",
        "%",
        "monitor: 100 ln(recorded/predicted fuel flow) by the book, at the tail's mean\n\
         conditions: positive, the aircraft burns more.",
    ),
    output(
        "initial_deviation_percent",
        "%",
        "monitor: the same at the conditions flown, of which the book's own error is part.",
    ),
    output(
        "before_learning_percent",
        "%",
        "monitor: the deviation by the learnt table as it was before it learnt the flight.",
    ),
    output(
        "specific_range_deviation_percent",
        "%",
        "monitor: DSR, the deviation of specific range: negative, worse than the book.",
    ),
    output(
        "fuel_factor_percent",
        "%",
        "monitor: what to plan with, by how much predicted fuel flow is to be raised at the present level.",
    ),
    output(
        "monitored_fuel_factor_percent",
        "%",
        "monitor: how much more fuel is burnt than predicted, mean of a month.",
    ),
    output(
        "retained_fuel_factor_percent",
        "%",
        "monitor: mean of the monthly factors of the last three calendar months, rounded up to 0.1 %.",
    ),
    output(
        "performance_factor_percent",
        "%",
        "monitor: PERF FACTOR of the flight management system: its basic factor plus fuel_factor_percent,\n\
         rounded up to 0.1 %.",
    ),
    output("since_ci95", "-", "monitor: the first flights between which a change lies with 95 %."),
    output("step_percent", "%", "monitor: size of a change: positive, more is burnt afterwards."),
    output(
        "trend_percent_per_year",
        "%/year",
        "monitor: drift between changes; none where the flights say next to nothing of it.",
    ),
    output(
        "at_type_conditions_percent",
        "%",
        "monitor: the present level at the mean conditions of all tails of the type, by which they are compared.",
    ),
    output(
        "step_in_gap_percent",
        "%",
        "monitor: a step while the aircraft did not fly, which explains the flights about as well as the\n\
         trend does: it is one or the other.",
    ),
];

/// An output in words, by its name.
pub(super) fn explain(topic: &str) -> Option<String> {
    let found = OUTPUTS.iter().find(|output| output.name == topic)?;
    Some(format!("{}: of an output\n\n{}\n\nUnit:  {}\n", found.name, found.words, found.unit))
}
