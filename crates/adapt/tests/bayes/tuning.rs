//! Settings fitted to past flights, and the exported polynomial.

use adapt::bayes::{
    BayesSettings, Posterior, Search, SettingValues, TuneError, log_evidence, polynomial_export,
    tune,
};
use lut::surface::{Basis, Surface};

use crate::fleet::{Fleet, Noise, SENSOR_NOISE, believed_drag, grid, solved, table, times};
use crate::golden;

/// A fleet with little noise of its own: the search finds that, and evidence times prior grows with each of its steps.
#[test]
fn tuning_finds_the_noise_that_was_flown() {
    let initial = table(&grid(0.05, 0.95), believed_drag);
    let noise = Noise { segment: (0.005_f64.powi(2) + 0.0015_f64.powi(2)).sqrt(), flight: 0.025 };
    let truth = times(&initial, 1.03);
    let flights = Fleet::new(900).flights(80, noise, truth);
    let start = BayesSettings::physical_2026();
    let tuned = tune(&initial, start, &flights, &Search::standard()).unwrap();
    let values = tuned.settings.values();
    eprintln!("{} evaluations, {:?}", tuned.evaluations, values);
    // Truth: √(0.025² − 0.0045²) = 0.0246 of a flight beyond the sensors'.
    assert!((0.018..0.032).contains(&values.extra_flight_std), "{values:?}");
    assert!(tuned.path.len() > 3, "{:?}", tuned.path);
    for pair in tuned.path.windows(2) {
        let [before, after] =
            [&pair[0], &pair[1]].map(|step| step.log_evidence + log_prior(&step.settings, &start));
        // Evidences with other outlier weights cannot be compared; the settings are the same there.
        let renewed = pair[1].changed == "outlier weights";
        assert!(renewed || after > before, "{before} {after}: {:?}", tuned.path);
    }
    assert_eq!(tuned.path[0].settings, start);
    assert!(tuned.evaluations <= 400);
    // The same again, to the bit.
    assert_eq!(tune(&initial, start, &flights, &Search::standard()).unwrap(), tuned);
    // Settings that tuning does not change.
    assert_eq!(values.student_degrees_of_freedom, start.values().student_degrees_of_freedom);
}

/// ln of the standard search's prior but for a constant: each setting of the noise is log-normal about its start, a factor of 2 one
/// standard deviation.
fn log_prior(settings: &BayesSettings, start: &BayesSettings) -> f64 {
    let of_noise = |settings: &BayesSettings| {
        let values = settings.values();
        [
            values.extra_flight_std,
            values.extra_segment_std,
            values.sensor_flight_factor,
            values.sensor_segment_factor,
        ]
    };
    let pairs = of_noise(settings).into_iter().zip(of_noise(start));
    pairs.map(|(now, then)| -0.5 * (now / then).log2().powi(2)).sum()
}

/// A search that would halve its steps without end, or has no prior, is refused; one with the finest of steps ends with its evaluations.
#[test]
fn every_search_ends() {
    let initial = table(&grid(0.05, 0.95), believed_drag);
    let noise = Noise { segment: 0.005, flight: 0.025 };
    let flights = Fleet::new(901).flights(5, noise, times(&initial, 1.0));
    let standard = Search::standard();
    let tuned = |search: Search| tune(&initial, BayesSettings::physical_2026(), &flights, &search);
    for search in [
        Search { smallest_factor: 1.0, ..standard },
        Search { smallest_factor: 0.5, ..standard },
        Search { smallest_factor: f64::NAN, ..standard },
        Search { smallest_factor: f64::INFINITY, ..standard },
        Search { prior_factor: 1.0, ..standard },
        Search { prior_factor: f64::NAN, ..standard },
        Search { largest_factor: 0.9, ..standard },
        Search { largest_factor: f64::NAN, ..standard },
    ] {
        let refused = tuned(search);
        assert!(matches!(refused, Err(TuneError::Search { .. })), "{search:?}: {refused:?}");
    }
    let finest =
        Search { smallest_factor: 1.0 + f64::EPSILON, maximum_evaluations: 30, ..standard };
    // The second round begins with an evaluation of its own.
    assert!(tuned(finest).unwrap().evaluations <= 31);
    // Without a limit or a prior the search is one by evidence alone.
    let free = Search { largest_factor: f64::INFINITY, prior_factor: f64::INFINITY, ..standard };
    assert!(tuned(free).unwrap().log_evidence >= tuned(standard).unwrap().path[0].log_evidence);
}

/// On the golden baseline the evidence is better than the defaults', and unseen flights are not worse for it.
#[test]
fn tuning_on_ten_flights_does_no_harm_to_the_others() {
    let initial = golden::initial_table();
    for name in ["SIM-01", "SIM-02", "SIM-05"] {
        let (flights, _) = golden::fleet(name);
        let (past, unseen) = flights.split_at(10);
        let start = BayesSettings::physical_2026();
        let tuned = tune(&initial, start, past, &Search::standard()).unwrap();
        let state = crate::fleet::learnt(&initial, tuned.settings, past);
        let posterior = state.solve().unwrap();
        let errors = crate::fleet::errors_percent(posterior.drag(), unseen);
        let after = crate::fleet::mean_and_std(&errors);
        eprintln!(
            "{name} tuned: {:.2}/{:.2} %, {} evaluations, evidence {:.1} {:.1} {:?} {:?}",
            after.0,
            after.1,
            tuned.evaluations,
            tuned.path[0].log_evidence,
            tuned.log_evidence,
            tuned.settings.values(),
            tuned.at_limit
        );
        assert!(after.0.abs() <= 0.4 && after.1 <= 0.85, "{name}: {after:?}");
    }
}

/// Fleets quieter than the aircraft file and the settings state: the truth is in the model class, so the stated 95 %
/// intervals must cover 92 to 98 % of flights that were used neither for learning nor for tuning.
#[test]
fn after_tuning_intervals_of_quiet_fleets_cover() {
    let initial = table(&grid(0.05, 0.95), believed_drag);
    let start = BayesSettings::physical_2026();
    let mut inside = [0.0; 4];
    let mut all = 0.0;
    for seed in 0..20 {
        let mut fleet = Fleet::new(5000 + seed);
        let noise = Noise { segment: 0.0025, flight: 0.004 };
        let past = fleet.flights(40, noise, times(&initial, 1.0));
        let unseen = fleet.flights(60, noise, times(&initial, 1.0));
        let tuned = tune(&initial, start, &past, &Search::standard()).unwrap().settings;
        let cases = [(start, 40), (tuned, 1), (tuned, 5), (tuned, 40)];
        for (inside, (settings, count)) in inside.iter_mut().zip(cases) {
            let posterior =
                crate::fleet::learnt(&initial, settings, &past[..count]).solve().unwrap();
            *inside += unseen.iter().flatten().filter(|o| is_inside(&posterior, o)).count() as f64;
        }
        all += unseen.iter().flatten().count() as f64;
    }
    let shares = inside.map(|inside| 100.0 * inside / all);
    eprintln!(
        "inside, %: defaults {:.1}, tuned after 1, 5, 40 flights {:.1?}",
        shares[0],
        &shares[1..]
    );
    assert!(shares[0] > 99.5, "the fleets are quieter than the defaults");
    assert!(shares[2..].iter().all(|share| (92.0..=98.0).contains(share)), "{shares:?}");
    // After one flight most of the variance is the table's, and a correction of 0 is the very middle of its prior.
    assert!(shares[1] >= 92.0, "{shares:?}");
}

fn is_inside(posterior: &Posterior, observation: &flight::Observation) -> bool {
    let at = (observation.lift_coefficient, observation.mach);
    let cell = posterior.drag().grid().locate(at.0, at.1, lut::Outside::Error).unwrap();
    let excess = observation.drag_coefficient - posterior.drag().interpolate(&cell);
    let variance = posterior.segment_variance(&cell, &observation.variance);
    (excess / posterior.initial().interpolate(&cell)).powi(2) <= 1.96 * 1.96 * variance
}

/// Both more noise than there is and less are less likely.
#[test]
fn evidence_prefers_the_truth() {
    let initial = table(&grid(0.05, 0.95), believed_drag);
    let settings = |extra_flight_std| {
        let physical = *BayesSettings::physical_2026().values();
        BayesSettings::new(SettingValues { extra_flight_std, ..physical }).unwrap()
    };
    let noise = Noise { flight: (0.0045_f64.powi(2) + 1e-4).sqrt(), ..SENSOR_NOISE };
    let flights = Fleet::new(910).flights(200, noise, times(&initial, 1.0));
    let evidence = |std| log_evidence(&initial, settings(std), &flights).unwrap();
    assert!(evidence(0.010) > evidence(0.003) && evidence(0.010) > evidence(0.030));
}

/// A posterior that is a polynomial comes back as that polynomial; its covariance is what scattered truths give.
#[test]
fn the_exported_polynomial_is_the_table_s() {
    let surface = Surface {
        basis: Basis::SeparableQuadratic,
        coefficients: [0.030, -0.030, 0.022, 0.030, 0.010, 0.020],
    };
    let grid = grid(0.05, 0.95);
    let initial = table(&grid, |x, y| surface.value(x, y));
    // Drag 4 % up everywhere is the polynomial 4 % up; the posterior shrinks a little towards 0.
    let truth = |x, y| 1.04 * initial.interpolate(&grid.locate(x, y, lut::Outside::Error).unwrap());
    let flights = Fleet::new(920).flights(60, Noise { segment: 0.0, flight: 0.0 }, truth);
    let posterior = solved(&initial, &flights);
    let export = polynomial_export(&posterior, Basis::SeparableQuadratic).unwrap();
    let at = |x, y| export.surface.value(x, y) / surface.value(x, y);
    assert!((at(0.35, 0.82) - 1.04).abs() < 1e-3 && (at(0.2, 0.6) - 1.04).abs() < 2e-3);
    assert!(export.residual_rms < 1e-4, "{}", export.residual_rms);

    // Standard deviation of the polynomial's drag at a point, against the table's own there: the polynomial smooths, so
    // that inside the flown region it is not larger than 1.2 times the table's.
    let row = Basis::SeparableQuadratic.row(0.35, 0.82);
    let mut variance = 0.0;
    for (a, line) in row.iter().zip(&export.covariance) {
        variance += a * line.iter().zip(&row).map(|(entry, b)| entry * b).sum::<f64>();
    }
    let cell = grid.locate(0.35, 0.82, lut::Outside::Error).unwrap();
    let of_table = posterior.relative_variance(&cell).sqrt() * initial.interpolate(&cell);
    assert!(variance.sqrt() < 1.2 * of_table && variance.sqrt() > 0.5 * of_table);
    for (i, line) in export.covariance.iter().enumerate() {
        assert!(line[i] > 0.0);
        for (k, entry) in line.iter().enumerate() {
            assert!((entry - export.covariance[k][i]).abs() <= 1e-9 * entry.abs());
        }
    }
}
