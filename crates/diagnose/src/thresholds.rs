//! Every number that decides a verdict or an answer.

use crate::deciding::deciding_numbers;

deciding_numbers! {
    "Whether there is enough data" {
        FEWEST_FLIGHTS_OF_A_NAME: usize = 6, "flights",
            "fewest flights on which a diagnosis names anything",
            OurChoice "Five folds of flights, and one fold that has more than one.";
        FEWEST_SEGMENTS_OF_A_NAME: usize = 30, "segments",
            "fewest segments on which a diagnosis names anything",
            OurChoice "About as many as the library has effects.";
        LEAST_SPREADS: [f64; 4] = [1e-3, 30.0, 1.0, 0.1], "Mach, m, kg, K",
            "ranges of Mach number, pressure altitude, mass and SAT of which two must be exceeded",
            OurChoice "Below them a condition was not varied: rounding and turbulence move it by as much.";
        FEWEST_FLIGHTS_OF_SCATTER: usize = 3, "flights",
            "fewest flights that raise the scatter between flights to what each shows against the others",
            OurChoice "Two know of it by one difference, one by none: what it shows is how far the guide is off.";
        RECORDED_SHARE: f64 = 0.9, "of the segments",
            "share of the segments that must have what an effect needs",
            OurChoice "A column that is missing in every tenth segment is still a column.";
        LONGEST_STEP: f64 = 3.0, "usual steps",
            "time between two samples beyond which a recording has a hole, and gauges are not held against meters across it",
            OurChoice "A row or two may be missing; a step climb that was left out takes longer.";
        SMALLEST_BURN_KG: f64 = 400.0, "kg",
            "smallest burn for which gauges are compared with meters",
            OurChoice "There the deviation of the gauges, 25 kg, is 6 % of the burn.";
        SMALLEST_SLOPE: f64 = 0.02, "d ln N2/d ln F",
            "slope of the N2 deck from which thrust is read",
            Source "Arithmetic: N2 off by 0.1 % is then a thrust off by 5 %.";
        FARTHEST_LN_THRUST: f64 = 0.2, "ln F/δ",
            "how far from the prediction the N2 deck is followed",
            OurChoice "Beyond it N2 and the model disagree about more than thrust.";
        FARTHEST_FROM_MEDIAN: f64 = 5.0, "standard deviations",
            "distance from the median of all residuals up to which a segment counts whole before anything is learnt",
            OurChoice "Far enough for an initial table that is off by several per cent in places.";
        LEAST_MEDIAN_DISTANCE: f64 = 0.01, "of fuel flow",
            "least standard deviation that this distance is over",
            OurChoice "Residuals of a table that is nearly right must not make ordinary segments outliers.";
        USUAL_DISTANCE: f64 = 2.5, "standard deviations",
            "distance from what is learnt up to which a segment or flight counts whole",
            OurChoice "Of normal errors 1.2 % lie beyond: clean flights are learnt as if nothing were weighed.";
        ABSURD: f64 = 0.25, "",
            "weight of a value or flight up to which it says nothing of stated intervals",
            OurChoice "Five standard deviations from what was learnt: no ordinary flight of the aircraft, which is what intervals are of.";
        ORDINARY_SEGMENTS: f64 = 20.0, "segments",
            "ordinary segments that count in addition where unseen ones judge stated intervals",
            OurChoice "One of twenty lies outside a 95 % interval: fewer say nothing of it.";
        FACTOR_LIMITS: (f64, f64) = (1.0, 4.0), "",
            "least and largest factor on stated standard deviations",
            Measured "JSBSim, flights after those learnt (development data): 91 % inside with factors below 1, 97 % without.";
        LEAST_CORRELATION: f64 = 0.05, "",
            "correlation of fuel flow and N2 by the aircraft file from which flights are asked how large it is",
            OurChoice "Twenty flights know a correlation to about as much.";
        FARTHEST_PRODUCT: f64 = 4.0, "lengths",
            "how far from its middle a variable is followed in products of the remainder",
            OurChoice "Hardly anything is flown beyond; a product would grow there like a square.";
    }
    "Physical drag" {
        PHYSICAL_LIFT_STEP: f64 = 0.05, "",
            "largest step along lift coefficient over which fuel flow is asked not to fall",
            OurChoice "Half the length over which a remainder bends.";
        PHYSICAL_MACH_STEP: f64 = 0.02, "Mach",
            "largest step along Mach number over which drag is asked not to fall in the drag rise",
            OurChoice "The length over which a remainder bends.";
        MASSES_BEYOND: f64 = 0.2, "of the mass",
            "how far beyond the masses that were flown this is asked",
            OurChoice "From empty to full where a fleet flew half loaded.";
        DRAG_RISE_SLOPE: f64 = 0.05, "dCD/dM",
            "slope of the initial drag coefficient from which its drag rises with Mach number",
            OurChoice "Half of the 0.1 that defines drag divergence.";
        DOUBTFUL_PHYSICS: f64 = 2.0, "standard deviations",
            "distance from an inequality up to which it is in doubt: held on either side, left alone beyond",
            OurChoice "The interval that is stated: nothing in it is unphysical, and flights that say otherwise are believed.";
    }
    "Gap or no gap" {
        CLEAN_PROBABILITY: f64 = 0.05, "",
            "probability of no effect below which a gap is real",
            OurChoice "The usual one in twenty; it leaves 0.988 of 820 blind cases without an effect silent.";
        TAUGHT_CLEAN_SPIKE: f64 = 0.05, "of typical size",
            "amount of every effect that is no finding against a baseline",
            Measured "10 pairs of periods, seeds of development: silent in 10 without an effect, TSFC +2 % found in 10.";
        TAUGHT_CLEAN_AMPLITUDE: f64 = 0.007, "of fuel flow",
            "smooth discrepancy against a baseline that is left to neither agnostic functions nor regions",
            Source "Arithmetic: 0.15 % for each of some twenty independent functions, its value before amplitudes were totals.";
        SMALLEST_GAP: f64 = 0.15, "of the floor's square",
            "excess over the noise floor below which closure is not measured and size alone shows no gap",
            OurChoice "Below it the ratio that closure is has noise above and below the line.";
        SMALLEST_GAP_PERCENT: f64 = 0.15, "% rms",
            "root mean square of what is explained, or of the excess over the floor, below which there is no gap",
            OurChoice "No operator acts on less, however many flights show it.";
        UNPROVEN_SHARE: f64 = 0.5, "",
            "share of its probability that a name keeps where the interval of its closure on unseen flights holds zero",
            OurChoice "A name that other flights do not bear out is not more probable than not.";
        SHARE_AT_ITS_PLACE: f64 = 0.85, "",
            "the same of an effect of one engine, or of a switch, where the first place is that engine or switch",
            OurChoice "The place bears it out; below 0.9, with which nothing is named whose closure may be none.";
        CLOSES: f64 = 0.9, "of the explainable gap",
            "upper end of a name's closure on unseen flights below which a more probable cause outside the library is the verdict",
            OurChoice "Nine tenths: what the library names closes 0.94 and more in whatever form, what it lacks a quarter.";
        ENGINE_CHANGES: f64 = 4.5, "standard deviations",
            "difference of what an engine burns beside the others, before and after some date, above which steps of single engines are tried",
            OurChoice "Where nothing changes, one tail in a hundred has so much between some of a hundred dates.";
        SURE_P_VALUE: f64 = 1e-12, "",
            "p-value of the gap below which it is told, whether or not a name fits it",
            OurChoice "The smallest of 233 healthy fleets of two other simulators was 1e-9; ill ones had 1e-10 to 1e-314.";
        REFUTES_SCATTER: f64 = 0.01, "",
            "largest p-value of a place beside which scatter from flight to flight is not borne out",
            OurChoice "A place that one clean fleet in a hundred shows by chance; scatter has none.";
        LEAST_OF_A_TABLE: f64 = 0.5, "of the explainable gap",
            "lower end of the closure by a table fitted to other flights below which a guide's drag is not what is wrong",
            OurChoice "More than half. Guides of virtual fleets, while this was developed: 0.95 and more; shuffled fuel flows 0 to 0.3.";
        LEAST_OF_A_FORM: f64 = 0.5, "of the explainable gap",
            "lower end of the closure by a form fitted to other flights above which a gap needs no name",
            OurChoice "More than half, for sure. Closures of narrow bumps are 0.76 to 1.06, of the best form where nothing acts 0.54 to 0.69.";
        SHARE_BEYOND_TABLE: f64 = 0.2, "of d²",
            "share of an effect beyond what a guide's table can take up, below which the table holds it",
            OurChoice "Virtual fleets: drag, throttle, offtake, air data 0 to 0.13; Reynolds number, age, engines 0.5 and more.";
        LARGEST_REST: f64 = 25.0, "times the stated variance of noise",
            "mean square that a name leaves beyond which it keeps that share, unless it closes most of the gap",
            OurChoice "Five standard deviations: sensors three times worse than stated leave nine times it.";
        LEAST_MADE_SMALLER: f64 = 0.1, "of the explainable gap",
            "share of the explainable mean square that named effects take off the gap (fuel flow and split between engines)",
            OurChoice "What leaves nine tenths of a gap beside other things that explain it is not its cause.";
        MORE_PROBABLE_THAN_NOT: f64 = 0.5, "",
            "probability of a cause, or of all named ones, above which it carries the verdict",
            OurChoice "More probable than not.";
    }
    "Verdict" {
        OUTSIDE_PROBABILITY: f64 = 0.5, "",
            "probability of a cause outside the library above which the verdict is \"outside the library\"",
            OurChoice "More probable than not.";
        OTHER_FORM: [f64; 2] = [0.8, 1.0], "of the explainable gap",
            "closures between which a gap passes from something else to the effect in another form",
            Measured "Two other simulators: effects in other forms close 0.94 to 0.98, effects the library lacks 0.25.";
        CREDIBLE: f64 = 0.95, "",
            "probability of the causes that the class of a verdict holds at least",
            OurChoice "The usual 95 %.";
        SIZE_ALONE: f64 = 20.0, "",
            "factor within which a cause must be of the leading one, prior sizes left out, to be in its class",
            OurChoice "One in twenty, as for a gap: what only the prior sizes decide is open.";
        LEVEL_LIKE: f64 = 1.0, "standard deviations among the flights",
            "mean of an effect's signature beyond which it is like a level",
            OurChoice "Flights that differ from the reference by more than they differ from each other.";
        NORMAL_95: f64 = 1.96, "standard deviations",
            "half width of a 95 % interval",
            Source "The normal distribution's 97.5 % quantile, to two decimals as tables have it.";
        SCATTER_INTERVAL: [f64; 2] = [0.5, 2.0], "of the size",
            "interval of a scatter from flight to flight",
            OurChoice "The sizes that are tried are factors of two apart.";
        SCATTER_SHARE: f64 = 0.5, "of the size",
            "standard deviation of such a scatter where it is applied to a model",
            OurChoice "The same: known to about half of itself.";
        FEWEST_CAUSES: usize = 3, "causes",
            "causes that are listed whatever their probability",
            OurChoice "A reader sees what came second and third.";
        LISTED_PROBABILITY: f64 = 0.995, "",
            "probability of the listed causes at which the list of more ends",
            OurChoice "What is left is not worth a line.";
        LEAST_LISTED: f64 = 1e-3, "",
            "probability below which a further cause is not listed",
            OurChoice "One in a thousand is not worth a line.";
    }
    "Search" {
        OUTLIER_DISTANCE: f64 = 4.5, "standard deviations",
            "distance from all other segments, or flights, beyond which one is an outlier",
            OurChoice "Of normal errors seven in a million lie beyond: clean flights lose nothing.";
        OUTLIER_NEIGHBORS: usize = 10, "segments",
            "nearest segments of other flights, in each variable, that an outlier is compared with",
            OurChoice "About a flight's worth: in date, half of the flight before and half of the one after.";
        ALIKE_NEIGHBORS: f64 = 0.5, "of these",
            "share of them from which a segment that is off as they are is no outlier",
            OurChoice "Half: a gap of a range that was flown, not of a recording. Of a tenth that is off at random, one in 600 has as many.";
        NEIGHBORS_AS_THIS: f64 = 0.75, "of these",
            "share of them that leave rather what a segment leaves than what its flight has in common, from which it is no outlier",
            OurChoice "More than a half, which neighbors about the middle of both would be by chance: beside a gap that begins nearby.";
        HEAVY_KURTOSIS: f64 = 4.0, "",
            "kurtosis of the whitened residuals above which segments are weighted",
            OurChoice "A normal distribution has 3. Weights cost information, so that they need a reason.";
        LEAST_ROBUST_SCALE: f64 = 0.3, "standard deviations",
            "least scale of the residuals that outliers and weights are taken from",
            OurChoice "Residuals that are far quieter than stated must not turn ordinary segments into outliers.";
        REFINED: usize = 5, "hypotheses",
            "leading hypotheses that are simulated again at their estimates",
            OurChoice "Time grows with each; the fifth is rarely probable.";
        WORTH_REFINING: f64 = 1e-4, "",
            "probability below which a hypothesis is not simulated again",
            OurChoice "What comes from it cannot be seen in the answer.";
        FORM_VARIABLES: usize = 2, "",
            "leading variables whose forms are tried where a cause is outside the library",
            OurChoice "Time grows with each, and with the products between them; the third is rarely probable.";
        FORMS_TOLD: usize = 2, "",
            "forms of different kinds that are told",
            OurChoice "The best, and the one to hold against it.";
        WORTH_CLOSER_DATES: f64 = 0.01, "",
            "probability of a hypothesis with a date below which no closer dates are tried",
            OurChoice "Each attempt goes through the data again; below this a date is in no answer.";
        CLOSER_DATES: usize = 12, "",
            "times that closer dates, or one more fall of a history, are tried at most",
            OurChoice "Three to a date bring 5,000 flights to a few; four falls are then possible.";
        CONTRIBUTION_SWEEPS: (usize, usize) = (200, 1000), "draws",
            "draws thrown away, and kept, behind what each of all effects contributes",
            OurChoice "Ends of a 95 % interval rest on 25 draws each.";
        AGNOSTIC_SETS: usize = 10, "hypotheses",
            "leading hypotheses to which functions without a name are added",
            OurChoice "Time grows with each; the tenth is rarely probable.";
    }
    "Closure, noise floor, intervals" {
        CLOSURE_FOLDS: usize = 5, "folds",
            "folds of flights on which closure is measured",
            OurChoice "Four fifths of the flights still find what all of them find, and each is judged once.";
        RESAMPLES: usize = 1000, "",
            "resamples of flights behind an interval",
            OurChoice "An end of a 95 % interval rests on 25 of them. 64 of 66 intervals of closure held the truth.";
        REPLICATE_MACH: f64 = 0.02, "Mach",
            "difference of Mach number up to which successive segments are replicates",
            OurChoice "Within it the model's error hardly changes.";
        REPLICATE_ALTITUDE_M: f64 = 100.0, "m",
            "difference of pressure altitude up to which they are",
            OurChoice "The same flight level.";
        FEWEST_REPLICATES: usize = 20, "pairs",
            "fewest replicates of which a noise floor is told",
            OurChoice "A standard deviation is then known to about 16 %.";
        FLEXIBLE_EFFECT: f64 = 3.0, "of typical size",
            "prior standard deviation of effects in the flexible fit behind a noise floor",
            OurChoice "The larger of the two prior scales: flexible on purpose.";
        FLEXIBLE_SMOOTH: f64 = 0.004, "of fuel flow",
            "prior standard deviation of smooth terms in that fit",
            OurChoice "The third of the four amplitudes of the smooth discrepancy.";
    }
    "Regions" {
        REGION_P_VALUE: f64 = 0.05, "",
            "largest p-value of a region that is reported",
            OurChoice "The usual 5 %: 6 of 150 clean virtual fleets had a region.";
        MOST_REGIONS: usize = 3, "regions",
            "regions that are reported at most",
            OurChoice "The third is often what steps leave of a smooth effect already.";
        FEWEST_FLIGHTS_OF_A_REGION: usize = 3, "flights",
            "fewest flights that a region has segments of",
            OurChoice "One flight, or two, may have a mass that is wrong.";
        REGION_SHARES: [f64; 2] = [0.05, 0.70], "of the segments",
            "least and largest region",
            OurChoice "Below, noise stands out; above, it is the rest that is a region.";
        SECOND_CONDITION: f64 = 1.15, "",
            "factor by which a second condition must raise the statistic",
            OurChoice "A simpler region is easier to use.";
        LARGER_IN_A_PLACE: f64 = 1.1, "times the mean gap outside",
            "mean gap in a place from which on the gap lies there",
            OurChoice "A tenth more: what is less of a uniform gap is no place where one would look.";
        LEAST_SHARE: f64 = 0.005, "",
            "least share of the explainable gap in a region of all engines",
            OurChoice "Less is 0 % in words: what lies there is made up for within it.";
        MOST_COMPARED: usize = 200, "regions",
            "regions that are not by chance and compete by likelihood, at most",
            OurChoice "A bound on time.";
        REGION_DRAWS: usize = 400, "draws",
            "draws of noise, half for standard deviations and half for p-values",
            OurChoice "The least p-value is then 1 in 201, a tenth of the largest that is reported.";
        BINS: usize = 5, "bins",
            "bins of a variable",
            OurChoice "Quintiles: coarse enough to be read, and to hold segments of many flights.";
        ROLL_EDGES_DEG: [f64; BINS - 1] = [0.3, 0.7, 1.5, 5.0], "deg",
            "edges of the bins of roll",
            OurChoice "Most segments are flown wings level, so that quintiles would say nothing.";
        EDGE_TOLERANCE: f64 = 0.02, "of the segments",
            "how far an edge may lie from its quintile to be a number of few digits",
            OurChoice "A number that reads well is worth a fiftieth of the segments.";
    }
    "Classes and what can be seen" {
        CONFUSED: f64 = 9.0, "standard deviations squared",
            "squared distance below which two effects share a class",
            OurChoice "Three standard deviations.";
        FORM_DIRECTIONS: f64 = 3.0, "",
            "directions in which the form of an effect may be off",
            OurChoice "A slope, a curvature and one more bend over the variable that drives it; a level is its size.";
        DECIDED: f64 = 5.0, "standard deviations",
            "distance from which on two effects are told apart, and nothing more is advised",
            OurChoice "Two standard deviations more than what a class is made of.";
        DETECTION: f64 = 4.0, "standard deviations",
            "size of an effect that would just be seen",
            OurChoice "By noise alone one look in 16 000 shows as much; the library has fewer than a hundred columns.";
        PLAUSIBLE: f64 = 6.0, "of typical size",
            "largest size at which an effect may pass for another one",
            OurChoice "Twice the larger prior scale.";
        PLAUSIBLE_KNOWN: f64 = 0.5, "",
            "how far from 1 a coefficient that physics knows may be to pass for another effect",
            OurChoice "Some three of its prior standard deviations (0.15).";
    }
    "Advice" {
        LEAST_GAIN: f64 = 1.1, "",
            "factor by which what is advised must raise the distance",
            OurChoice "A tenth more is the least that is worth an effort.";
        LEAST_GAIN_DEVIATIONS: f64 = 0.1, "standard deviations",
            "what it must raise the distance by besides",
            OurChoice "A tenth more of next to no distance is no gain.";
        LEAST_DISTANCE: f64 = 1.0, "standard deviations",
            "least distance that is worth six flights",
            Measured "Blind trials: the right one of two was named in 0.71 at 1 to 2, in 0.38 at 0.5 to 1, in 0.33 below.";
        WORTH_MIXING: f64 = 1.05, "",
            "factor that flights of two sorts must gain over flights of one",
            OurChoice "One sort is simpler to plan.";
        ADVISED_FLIGHTS: usize = 6, "flights",
            "flights that are advised",
            OurChoice "What an operator may do in a week or two.";
        ADVISED_SEGMENTS: usize = 10, "segments",
            "segments of such a flight",
            OurChoice "A flight of two hours has about as many.";
        SEGMENT_EVERY_S: f64 = 600.0, "s",
            "time from one segment to the next",
            OurChoice "A new level or Mach number, settled and held.";
        SWEEP_LEVELS: usize = 5, "levels",
            "most flight levels at which Mach sweeps are tried",
            OurChoice "A bound on time; they cover the range that was flown.";
        NARROWEST_MACH: u32 = 6, "Mach/100",
            "narrowest Mach sweep",
            OurChoice "Ten segments over less are nearly one Mach number.";
        NARROWEST_LEVELS: u32 = 40, "flight levels",
            "narrowest level sweep",
            OurChoice "4000 ft: less changes pressure by less than a fifth.";
        LEVEL_TOLERANCE_M: f64 = 30.48, "m",
            "how near a segment must be to a flight level for it to count as flown",
            OurChoice "100 ft.";
        REDUCED_SEPARATION_TO: u32 = 410, "flight level",
            "highest level of the band in which levels lie 1000 ft apart",
            Source "ICAO Annex 2, Appendix 3 (reduced vertical separation).";
        LIGHT: f64 = 0.1, "of the segments",
            "share of the segments below the mass of a light aircraft",
            OurChoice "Light, and still usual.";
        HEAVY: f64 = 0.9, "of the segments",
            "share of the segments below the mass of a heavy aircraft",
            OurChoice "Heavy, and still usual.";
        EDGE_MACH: u32 = 1, "Mach/100",
            "distance that an advised flight keeps from the edges of the drag table",
            OurChoice "The aircraft will not be exactly there.";
        EDGE_MASS: f64 = 0.02, "of the mass",
            "the same along lift coefficient, as a share of mass",
            OurChoice "The aircraft will not have exactly that mass.";
        MEASURED_MASS: f64 = 0.003, "of the mass",
            "standard deviation of a mass that is weighed",
            OurChoice "What an operator may expect of scales; a guess, which the advice states.";
        MEASURED_BURN_PERCENT: f64 = 0.15, "%",
            "standard deviation of fuel flow held against fuel uplifted or against tank gauges whose gain is known, however many flights",
            OurChoice "Over many flights errors average out but for what changes of a gain; a guess, which the advice states.";
        MEASURED_SAT_K: f64 = 0.5, "K",
            "standard deviation of SAT held against a reanalysis",
            OurChoice "A mean over many flights; a guess, which the advice states.";
        MEASURED_MACH: f64 = 0.0015, "Mach",
            "standard deviation of Mach number held against GPS and wind",
            OurChoice "About 0.45 m/s of true airspeed in the mean; a guess, which the advice states.";
        MEASURED_PRESSURE_PERCENT: f64 = 0.05, "% of p",
            "standard deviation of static pressure held against GPS height and a reanalysis",
            OurChoice "About 10 ft in the mean; a guess, which the advice states.";
        DECK_MEASURED: f64 = 0.05, "",
            "what measuring an N2 deck leaves of its uncertainty",
            Source "Arithmetic: from the prior's 2 % to 0.1 %.";
    }
    "A fleet" {
        FALSE_DISCOVERIES: f64 = 0.05, "of the findings",
            "expected share of false ones among what is found in a type and on its tails",
            OurChoice "The usual one in twenty, over all tails and effects together.";
        FLEET_FRAME_FLIGHTS: usize = 400, "flights",
            "flights, evenly from all tails, from which channels, N2 deck, means and quantiles of a fleet are taken",
            OurChoice "Quantiles of some thousand segments stand still; more only cost time.";
        FLEET_BASIS_FLIGHTS: usize = 100, "flights",
            "flights among them from which it is found what the tails' flights tell of all that they share",
            OurChoice "Far more rows than combinations that matter; more only cost time.";
        FLEET_TOLD: f64 = 1e-3, "",
            "how much flights must divide the prior variance of a combination by, above 1, for it to be kept",
            OurChoice "A thousandth of a variance: what is left out moves no figure that is printed.";
        FEWEST_TAILS_OF_A_FLEET: usize = 3, "tails",
            "fewest tails that are diagnosed as a fleet",
            Source "Arithmetic: of two that differ nothing says which one is unlike its type.";
        FLEET_ACTS: f64 = 0.5, "",
            "probability that some effect acts from which the leading one is looked at as a finding",
            OurChoice "More probable than not; whether it is reported is decided over all findings together.";
        FLEET_CLASS: f64 = 90.0, "",
            "factor below the probability of an effect within which others are in its class",
            Source "Arithmetic: exp(9/2), three standard deviations, as between the members of a class of one tail.";
        FLEET_MOST_EFFECTS: usize = 6, "effects",
            "most effects in a type, and on a tail",
            OurChoice "Three pairs; what needs more is not a list of effects.";
        FLEET_SWEEPS: usize = 8, "",
            "turns of looking at the type and at the tails",
            OurChoice "Two or three settle what is found; more only guard against two answers in turn.";
    }
}
