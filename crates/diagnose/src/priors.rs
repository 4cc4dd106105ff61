//! Every number of belief: what is taken for probable before a flight is looked at.

use crate::deciding::deciding_numbers;

deciding_numbers! {
    "Which hypothesis" {
        PRIOR_BY_SIZE: [f64; 3] = [0.25, 0.45, 0.25], "",
            "prior weights of no effect, of one, of two",
            OurChoice "One is the likeliest, none and two are no surprise; three, which would have the rest, are not searched.";
        PRIOR_NO_GAP: f64 = 0.5, "",
            "share of the prior of no effect that is on a model without any fault; the rest is on small faults of all kinds",
            OurChoice "An even chance: no gap is a belief of its own, and no corner of the backgrounds.";
        PRIOR_OUTSIDE: f64 = 0.20, "",
            "prior probability that something outside the library acts",
            OurChoice "One cause in five: the library is long, but nobody can list every cause.";
        PRIOR_OTHER_FORM: f64 = 0.50, "",
            "prior probability that an effect has another form than the library's",
            OurChoice "An even chance: a truth of another form differs along one variable, or too little to be seen.";
        EXPECTED_SIGN: f64 = 0.95, "",
            "prior probability of the sign that physics expects",
            OurChoice "A sign is a strong expectation and no law: one model in twenty errs the other way.";
    }
    "How large an effect is" {
        PRIOR_SCALES: [(f64, f64); 3] = [(1.0, 0.45), (3.0, 0.45), (10.0, 0.10)], "",
            "prior standard deviations of an effect over its typical size, each with its probability",
            OurChoice "As much belief on three times the typical size, so that a large effect is not shrunk away; one in ten on ten times.";
        LARGEST_OF_TWO: f64 = 10.0, "of typical size",
            "size of either of two effects beyond which the pair is not believed",
            OurChoice "The largest prior scale: two impossible ones may cancel, as 57 K of SAT and 16 % of drag did.";
        CONTRIBUTING: f64 = 1.0, "effects",
            "how many of all effects are expected to act at typical size where all are looked at at once",
            OurChoice "One: most models lack one thing, and the rest a little. Flights decide.";
        FLAT_RANGE: f64 = 0.10, "of fuel flow",
            "range over which the effect of a cause on fuel flow is evenly probable where its prior size is left out",
            OurChoice "Five per cent either way: what an engineer would not call impossible of any cause.";
        FORM_ERROR: f64 = 0.15, "of the effect",
            "amplitude of the function of one variable by which its form is off",
            OurChoice "About the difference between the common laws of one effect, as of friction with Reynolds number.";
        KNOWN_DEVIATION: f64 = 0.15, "",
            "prior standard deviation of a coefficient that physics says is 1",
            OurChoice "Physics says 1; what is recorded of wind, position and turns is not exact, so that some 15 % are left.";
        FLIGHT_SCATTER_SIZES_PERCENT: [f64; 4] = [0.3, 0.6, 1.2, 2.4], "% of fuel flow",
            "sizes of scatter from flight to flight that are tried",
            OurChoice "From half the typical 0.6 % to four times it, each twice the one before.";
    }
    "Hidden parameters that are tried" {
        THROTTLE_PIVOTS: [f64; 5] = [0.6, 0.8, 1.0, 1.2, 1.5], "",
            "corrected thrusts over their reference about which the throttle effect may pivot",
            OurChoice "The range that cruise covers, about as far apart as the parabola is wide (0.25).";
        N2_PIVOT: f64 = 1.0, "",
            "the one thrust by N2 about which the throttle effect may pivot",
            Measured "16 clean fleets: with all five pivots over N2, 7 had a throttle effect; with this one alone, none had.";
        DIVERGENCE_MACHS: [f64; 6] = [0.74, 0.78, 0.82, 0.86, 0.90, 0.94], "Mach",
            "drag-divergence Mach numbers that are tried where the aircraft file states none",
            OurChoice "The range of transport and business aircraft.";
        STEEP_DIVERGENCE_MACHS: [f64; 11] = [0.74, 0.76, 0.78, 0.80, 0.82, 0.84, 0.86, 0.88, 0.90, 0.92, 0.94], "Mach",
            "drag-divergence Mach numbers of a steep rise that are tried",
            OurChoice "The same range, half as far apart: a steep rise is a third as wide.";
        STEEP_DIVERGENCE_FROM_FASTEST_MACH: f64 = 0.03, "Mach",
            "how far from the fastest segment they may be",
            OurChoice "What diverges farther above changes nothing that was flown, and nobody cruises farther beyond divergence.";
        STEP_DATES: usize = 15, "",
            "dates of a step that are tried, each with equally many flights between",
            OurChoice "A date is then off by at most a thirty-second of the flights, before the dates about a leading one are tried.";
        FORM_AMPLITUDES: [f64; 3] = [0.005, 0.015, 0.05], "of fuel flow",
            "root mean squares of a form outside the library that are believed in alike",
            OurChoice "What the library's effects make at a third of, once and three times their usual sizes.";
        FORM_PLACES: usize = 15, "",
            "places of a hinge, step, logistic or bump that are tried, with equally many segments between; then closer ones",
            OurChoice "As many as dates of a step.";
        FORM_WIDTHS: [f64; 3] = [0.05, 0.15, 0.4], "of what was flown",
            "widths of a logistic or bump that are tried; then closer ones",
            OurChoice "From nearly a step to nearly a line.";
        FORM_EXPONENTS: [f64; 4] = [-2.0, -1.0, 0.5, 3.0], "",
            "exponents of a power that are tried; then closer ones",
            OurChoice "Those that differ from a line and a square where a variable varies by a tenth.";
        HISTORY_DATES: usize = 7, "",
            "dates of a fall in a history that are tried first, each with equally many flights between",
            OurChoice "A date is then off by at most a sixteenth of the flights, before the dates about a leading one are tried.";
        RECOVERED_COARSE: [f64; 2] = [0.5, 1.0], "",
            "shares of what has gathered that a fall takes back, tried first",
            OurChoice "A wash takes back a part, an engine change or repair all.";
        RECOVERED_FINE: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 1.0], "",
            "the same about a leading history",
            OurChoice "A tenth of what has gathered is far below what single flights scatter by.";
    }
    "What else may act in the background" {
        BACKGROUND_SPIKES: [f64; 4] = [0.0, 0.05, 0.15, 0.30], "of typical size",
            "standard deviation of every effect that a hypothesis does not name",
            OurChoice "From an otherwise exact model to one in which everything is a third off; all are averaged over.";
        SMOOTH_AMPLITUDES: [f64; 4] = [0.0, 0.0015, 0.004, 0.010], "of fuel flow",
            "amplitudes of the smooth discrepancy",
            OurChoice "From none to 1 %, about what a table over lift coefficient and Mach number cannot hold; averaged over.";
        TAUGHT_LARGEST_AMPLITUDE: f64 = 0.010, "of fuel flow",
            "largest amplitude of the smooth discrepancy against a baseline",
            OurChoice "All that are tried: a remainder of few flights may lack as much.";
        TAUGHT_SCATTERS: [f64; 2] = [0.0, 0.003], "of fuel flow",
            "scatter between flights beyond what a baseline learnt",
            OurChoice "A baseline knows the scatter from few flights: it may be more. Both are averaged over.";
        SMOOTH_QUANTILES: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0], "",
            "quantiles of a variable at which the smooth discrepancy has its knots",
            OurChoice "A fifth of the segments between two knots, so that each is informed.";
        PRODUCT_SCALE: f64 = 0.5, "",
            "amplitude of a product of two variables over that of a function of one",
            OurChoice "Discrepancies of one variable are taken for twice as large as those of two together.";
    }
    "A guide that no flight has taught" {
        PRIOR_BOOK_RIGHT: f64 = 0.10, "",
            "prior probability that the drag of a guide is right as it is",
            OurChoice "Guides are some per cent too optimistic as a rule.";
        BOOK_SPIKES: [f64; 4] = [0.0, 0.3, 1.0, 3.0], "of typical size",
            "standard deviation, against a guide, of every effect that a hypothesis does not name and a model may lack at all times",
            OurChoice "A guide's equations lack Reynolds number, offtake, part load: none, or all, up to three times usual; averaged over.";
        SPIKES_OF_RIGHT_TABLE: usize = 2, "",
            "how many of them, from the smallest, apply where the guide's drag is right",
            OurChoice "Larger ones of drag would be a table that is off by another name.";
        BOOK_SCATTERS: [f64; 2] = [0.0, 0.01], "of fuel flow",
            "scatter between flights against a guide beyond what the sensors make",
            OurChoice "Law bayes' own 1 % of what is no function of lift coefficient and Mach number, or none; averaged over.";
        BOOK_AMPLITUDES: [f64; 2] = [0.0, 0.004], "of fuel flow",
            "amplitudes of the smooth discrepancy against a guide",
            OurChoice "None, and about law bayes' 0.3 % of a segment: the table itself is free.";
        BOOK_OTHER_EFFECTS: f64 = 0.05, "of that",
            "the same of effects of one aircraft: sensors, loading, single engines, age, steps",
            OurChoice "An equation that is lacking says nothing of sensors: at most 0.15 of typical.";
        BOOK_AGNOSTIC_SPIKES: [f64; 2] = [0.3, 3.0], "of typical size",
            "the same behind a function without a name",
            OurChoice "The smallest and the largest of those above; averaged over.";
    }
    "Functions without a name" {
        AGNOSTIC_AMPLITUDES: [f64; 3] = [0.002, 0.005, 0.015], "of fuel flow",
            "amplitudes of a function of one variable that competes with the named effects",
            OurChoice "From just visible to the size of a typical effect; averaged over.";
        AGNOSTIC_SPIKES: [f64; 2] = [0.0, 0.10], "of typical size",
            "standard deviation of every other effect behind such a function",
            OurChoice "Fewer than in the search for named effects, because each costs a search; averaged over.";
        AGNOSTIC_QUANTILES: [f64; 7] = [0.0, 0.17, 0.33, 0.5, 0.67, 0.83, 1.0], "",
            "quantiles at which such a function has its knots",
            OurChoice "A sixth of the segments between two knots: one piece more than the smooth discrepancy.";
        SPLIT_SCALE: f64 = 2.0, "",
            "amplitude of a difference between engines over that of all fuel flow",
            Source "Arithmetic: what one engine of two burns more is half as much of the fuel flow of both.";
    }
    "Noise" {
        NOISE_FREEDOM: f64 = 40.0, "",
            "degrees of freedom of the prior of the noise scale",
            OurChoice "The stated noise counts as much as 40 residuals: a scale of 1 within about 11 %.";
        STUDENT_FREEDOM: f64 = 4.0, "",
            "degrees of freedom of the Student distribution behind the weights of segments",
            OurChoice "As law bayes has: an error of ten standard deviations keeps a twentieth of its weight.";
        ROBUST_EFFECT: f64 = 3.0, "of typical size",
            "prior standard deviation of the effects in the fits that outliers and weights come from",
            OurChoice "The larger of the two prior scales: what an effect explains is no outlier.";
        ROBUST_SMOOTH: f64 = 0.0015, "of fuel flow",
            "prior standard deviation of the smooth terms in the fit that weights come from",
            OurChoice "The smallest amplitude of the smooth discrepancy, so that it explains no outlier.";
        OUTLIER_SMOOTH: f64 = 0.010, "of fuel flow",
            "amplitude of the smooth discrepancy in the fit that outliers are judged by",
            OurChoice "The largest: what depends on conditions is no outlier.";
        FLIGHT_SPLIT_DEVIATION: f64 = 0.01, "",
            "standard deviation from flight to flight of ln(Wf1/Wf2)",
            OurChoice "Engines of one aircraft are not set exactly alike; how far apart is a guess.";
        GAUGE_DEVIATION_KG: f64 = 25.0, "kg",
            "standard deviation of the difference of two gauge readings",
            OurChoice "A fuel-quantity indication to about 1 % of a business jet's tanks.";
        GAUGE_GAIN_DEVIATION: f64 = 0.01, "of the fuel burned",
            "prior standard deviation of what gauges and meters of one aircraft differ by at all times",
            OurChoice "Gauges and meters are each calibrated to about a per cent, or half of one.";
        GAUGE_SCATTER_FREEDOM: f64 = 2.0, "",
            "flights that the stated deviation of gauges counts as much as",
            OurChoice "It is a guess for every size of tanks; a few flights know better.";
    }
    "What a baseline may be" {
        REMAINDER_LEVEL_DEVIATION: f64 = 0.10, "of fuel flow",
            "prior standard deviation of the remainder's level",
            OurChoice "Wide: any fleet finds its level.";
        REMAINDER_SLOPE_DEVIATION: f64 = 0.03, "of fuel flow per length",
            "prior standard deviation of the remainder's slope along a variable",
            OurChoice "Wide, so that a straight line is hardly shrunk: a length is about the spread of one fleet.";
        REMAINDER_SMOOTH_DEVIATION: f64 = 0.01, "of fuel flow",
            "prior standard deviation of the remainder's bends along a variable, before flights scale it",
            OurChoice "What a table over two variables leaves is of the order of a per cent; the data scale it.";
        LEAST_SCALE_BEYOND_MACH: f64 = 1.0, "",
            "least factor by which flights scale bends, beyond the Mach numbers that they flew",
            OurChoice "The prior's own: how little a model bends where flights were does not say where the drag rise begins.";
        REMAINDER_PRODUCT_DEVIATION: f64 = 0.005, "of fuel flow",
            "prior standard deviation of a product of two variables a length from their middles, before flights scale it",
            OurChoice "Half of that of a function of one variable; the data scale it.";
        PATH_FORCE_DEVIATION: f64 = 0.5, "of the force along the path",
            "prior standard deviation of how much of the recorded acceleration and climb does not show in thrust",
            OurChoice "From all of it to none within two deviations: differences of recorded speeds have noise of their own.";
        SCALE_LN_DEVIATIONS: [f64; 3] = [1.0, 1.0, 2.0], "ln",
            "prior spread of the factors by which flights scale bends, products, and slopes with standing effects and the drag table",
            OurChoice "A factor of e either way: weak; of slopes and drag twice that: a model may be anything from right to a quarter off.";
        PRIOR_LEVEL_ALONE: f64 = 0.10, "",
            "prior probability that nothing but the level of what an initial model predicts is off",
            OurChoice "As for the drag of a guide: one in ten is right but for a factor on its fuel flow.";
        REMAINDER_LENGTHS: [f64; 6] = [0.02, 0.10, 600.0, 0.10, 6.0, 0.08],
            "Mach, CL, m, of the reference thrust, K, of the mean mass",
            "lengths over which the remainder bends: Mach number, lift coefficient, pressure altitude, thrust, ISA deviation, mass",
            OurChoice "About the standard deviation of each over a fleet's cruise; a drag rise bends over 0.02 of Mach number.";
        GUIDE_SHAPE_DEVIATION: f64 = 0.06, "of fuel flow",
            "how far an aircraft's departure from its guide is believed to be another elsewhere in the guide's range",
            OurChoice "Guides are off by 3 to 8 %, their level included, and by as much between levels.";
        GUIDE_SHAPE_LIFT: f64 = 0.10, "",
            "lift coefficient over which that departure bends",
            OurChoice "As the remainder.";
        GUIDE_SHAPE_MACH: f64 = 0.03, "Mach",
            "Mach number over which that departure bends",
            OurChoice "About as the remainder.";
        SMOOTH_KNOT_DISTANCE: f64 = 0.75, "lengths",
            "distance between the knots of a smooth function",
            Source "Arithmetic: a squared exponential kernel is then held to a hundredth between them.";
        SMOOTH_MOST_KNOTS: usize = 16, "knots",
            "most knots of a smooth function",
            OurChoice "Ten lengths; a variable that spreads over more bends over a longer length.";
        TAUGHT_SPLIT_DEVIATION: f64 = 0.03, "",
            "prior standard deviation of the level of ln(Wf1/Wf2)",
            OurChoice "Two engines of one type differ by some per cent: the typical size of one engine's TSFC.";
        DECK_DEVIATION: f64 = 0.02, "of N2",
            "prior standard deviation of a deck coefficient about its least-squares value",
            OurChoice "Wide: least squares over the same flights is only a start.";
        ENGINES_APART_PERCENT_PER_YEAR: f64 = 0.8, "% a year",
            "prior standard deviation of how fast two engines drift apart, where they do not stay as they are",
            OurChoice "As much as an engine usually ages: one wears, the other is newer.";
        BLEED_DEVIATION: f64 = 0.005, "of N2",
            "prior standard deviation of what anti-ice bleed changes N2 by, thrust the same",
            OurChoice "Bleed turns the core faster or slower by some tenths of a per cent, by the engine's control; a deck has no variable for it.";
        THRUST_SHARES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0], "",
            "shares of a remainder that may be thrust, as likely beforehand",
            OurChoice "From fuel alone to thrust alone; N2 says which, and hardly more finely.";
        CARRIED_DEVIATION: f64 = 1.0, "of typical size",
            "prior standard deviation of an effect that a fleet shows at all times",
            Measured "JSBSim, SIM-02: closure on unseen flights 0.90; at 3.0 it was 0.69, with 22 counts of trim drag.";
        CARRIED_SLOPE_DEVIATION: f64 = 2.0, "of typical size",
            "the same of isobaric slope",
            OurChoice "Twice the typical 0.5: from geostrophic wind, 0, to a slope that nothing balances, 1.";
        CARRIED_DRAG_RISE_MACHS: [f64; 3] = [0.82, 0.88, 0.94], "Mach",
            "drag-divergence Mach numbers of the drag rises that a baseline carries",
            OurChoice "Evenly over the upper part of the range that a diagnosis tries; flights mix them.";
        USUAL_NOISE: [f64; 2] = [0.5, 1.0], "",
            "noise that is usual within flights, and between them, over that of the aircraft file",
            OurChoice "Averaging samples halves a meter's deviation; load sheet and heating value are as the file states.";
        USUAL_NOISE_LN_DEVIATION: f64 = 0.5, "ln",
            "prior spread of the noise factors about what is usual",
            OurChoice "From 0.3 to 0.8 is one standard deviation: few flights do not make noise vanish.";
        NOISE_LIMITS: (f64, f64) = (0.03, 10.0), "",
            "least and largest noise factor",
            OurChoice "What few flights say is not believed beyond a factor of ten or thirty.";
        SCALE_LIMITS: (f64, f64) = (0.0005, 10.0), "",
            "least and largest factor on prior standard deviations of what is learnt",
            OurChoice "Below a thousandth they are nothing.";
        SCALE_OF_NOTHING: f64 = 0.001, "",
            "the factor that stands for none of it, where only a level is off",
            OurChoice "0.01 % of drag: not zero, so that matrices stay definite.";
    }
    "A fleet" {
        FLEET_FREE: f64 = 3.0, "of typical size",
            "prior standard deviation of an effect that was found, in the type or on a tail, where its size is given",
            OurChoice "The middle one of the prior sizes: what was found is hardly shrunk, what is not stays small.";
        FLEET_OTHER_LEVEL: f64 = 0.1, "",
            "prior of an effect at a level that is not its own (a sensor in all of a type, a law of physics on one tail) over the others'",
            OurChoice "It happens, as with a batch of probes or a retrofit, but one cause in ten at most.";
        FLEET_PRIOR_TAILS: f64 = 4.0, "tails",
            "how many tails the prior shares of tails with none, one and two effects count as much as",
            OurChoice "Few: the tails at hand decide how common an effect on one tail is.";
        FLEET_FLIGHT_SHARES: [f64; 3] = [0.0, 0.1, 0.3], "of typical size",
            "what a flight's probes and load sheet may be off by, beside the scatter that a model learnt",
            OurChoice "None, a tenth as industrial tolerances from flight to flight, or three of it; the most probable is taken.";
        FLEET_TAIL_NUISANCE: f64 = 1.0, "of its standard deviation",
            "how much of what the model of a type is uncertain about differs from tail to tail",
            Measured "As much as the model itself. 20 development fleets: 4 of 126 findings false; 13 of 134 at 0.3, 17 of 133 at 0.1.";
        FLEET_TAIL_SMOOTH: f64 = 0.0015, "of fuel flow",
            "smooth discrepancy of each tail",
            OurChoice "The smallest amplitude of the smooth discrepancy of a model.";
        FLEET_MODEL_SMOOTH: f64 = 0.004, "of fuel flow",
            "the same, in addition, of tails that each have learnt a model of their own",
            OurChoice "The middle amplitude: what one tail's model lacks no other tail tells.";
        FLEET_N2_LEVEL: f64 = 0.0015, "of N2",
            "how much faster or slower the engines of a tail turn at one thrust than those of the tail that taught the model",
            OurChoice "Two tenths of a per cent an engine, of which nothing is published. 3 K of SAT, 0.7 % of N2, stand out of it yet.";
        MOST_USUAL_RATE: f64 = 6.0, "%/year",
            "what a history usually gathers at most, however short the period",
            OurChoice "A usual fall of 1.5 % in a quarter of a year, as between two washes. Faster wear sends an engine to the shop.";
    }
}
