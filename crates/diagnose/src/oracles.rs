//! Oracles of equations whose parts lie in several modules: dense linear algebra of crate `nalgebra`, Monte Carlo from the model
//! of the noise, values by hand.

use effects::{
    AppliedEffects, AppliedForm, AppliedLayer, EffectModel, EffectPoint, Effects, Form, Variable,
};
use faer::Mat;
use flight::Segment;
use flight::effect::StepTarget;
use nalgebra::{DMatrix, DVector};
use test_support::fleet::{Background, Setup, exact_model, fly};

use crate::hypotheses::design::{Acts, Design};
use crate::judge::closure::Shrinkage;
use crate::judge::forms::change;
use crate::judge::forms::dictionary::{Values, candidates};
use crate::judge::noise_floors::{are_replicates, replicate_floor};
use crate::judge::verdict::credit;
use crate::library::Library;
use crate::library::dates::DateGrid;
use crate::math::random::RandomStream;
use crate::place::binned_variable::places;
use crate::place::draws::{Drawing, NoiseLevel, chords, draw};
use crate::place::likelihood::Noise;
use crate::place::regions::{Search, Series};
use crate::residuals::chords::chord_errors;
use crate::residuals::reference::Reference;
use crate::residuals::rows::{FlightRows, SegmentRow};
use crate::residuals::segments::PreparedFlights;
use crate::residuals::whiten::{FlightWhitening, whiten_within_segment};
use crate::search::robust::student_weight;
use crate::search::system::{Problem, WhitenedSystem};
use crate::signals::channels::MAXIMUM_CHANNELS;
use crate::signals::record::FlightRecord;
use crate::signals::references::references_of;

mod attainable;
mod forms;
mod places;
mod taught;

/// The linear system of a fleet against the model that flew it.
fn with_system(flights: &[Vec<Segment>], check: impl FnOnce(&Problem<'_>)) {
    let model = exact_model();
    let records: Vec<FlightRecord<'_>> =
        flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let references = references_of(&model, model.drag_table(), &records).unwrap();
    let effects = EffectModel::new(&model, model.drag_table(), references).unwrap();
    let library_of = |points: &[EffectPoint], engines, starts: &[f64]| {
        let dates = DateGrid::coarse(starts, &[], None);
        Library::new(&effects, points, engines, dates, |_| true)
    };
    let (data, library) =
        PreparedFlights::prepare(&effects, &records, Reference::Table, library_of);
    let design = Design::new(&data, &references, None, None);
    let system = WhitenedSystem::new(&data, &design);
    check(&Problem { system: &system, model: &effects, library: &library });
}

fn fleet(seed: u64, flights: usize) -> Vec<Vec<Segment>> {
    let setup = Setup { flights, ..Setup::default() };
    fly(seed, &setup, &[], &Background::default()).flights
}

/// The covariance of all channels of a flight, written out: each segment's own, and what they have in common.
fn covariance(data: &PreparedFlights<'_>, flight: &FlightRows) -> DMatrix<f64> {
    let (rows, channels) = (&data.segments[flight.segments.clone()], data.channels.count());
    let size = rows.len() * channels;
    let mut whole = DMatrix::zeros(size, size);
    for (place, row) in rows.iter().enumerate() {
        let factor =
            DMatrix::from_fn(
                channels,
                channels,
                |a, b| {
                    if b <= a { row.noise.factor[a][b] } else { 0.0 }
                },
            );
        let own = &factor * factor.transpose();
        whole.view_mut((place * channels, place * channels), own.shape()).copy_from(&own);
    }
    for source in 0..rows[0].noise.common.len() {
        let loading =
            DVector::from_fn(size, |i, _| rows[i / channels].noise.common[source][i % channels]);
        whole += &loading * loading.transpose();
    }
    whole
}

fn ln_determinant(matrix: &DMatrix<f64>) -> f64 {
    let factor = matrix.clone().cholesky().unwrap();
    2.0 * factor.l().diagonal().map(f64::ln).sum()
}

fn assert_near(found: &DMatrix<f64>, expected: &DMatrix<f64>, relative: f64) {
    let difference = (found - expected).amax();
    assert!(difference <= relative * expected.amax(), "{difference} of {}", expected.amax());
}

/// `[diagnosis.16]`: products of whitened rows are products with the inverse of the whole covariance, and the determinant is
/// its own.
#[test]
fn whitening_is_by_the_inverse_of_the_whole_covariance() {
    with_system(&fleet(71, 4), |problem| {
        let data = problem.system.data;
        let channels = data.channels.count();
        assert!(channels >= 3, "{channels}");
        for flight in &data.flights {
            let rows = &data.segments[flight.segments.clone()];
            let size = rows.len() * channels;
            let plain =
                DMatrix::from_fn(size, 3, |i, j| ((7 * i + 5 * j + i * j) % 11) as f64 - 5.0);
            let mut white = Mat::<f64>::zeros(size, 3);
            for (place, row) in rows.iter().enumerate() {
                for column in 0..3 {
                    let mut values = [0.0; MAXIMUM_CHANNELS];
                    for channel in 0..channels {
                        values[channel] = plain[(place * channels + channel, column)];
                    }
                    let values = whiten_within_segment(row, &values, channels);
                    for channel in 0..channels {
                        white[(place * channels + channel, column)] = values[channel];
                    }
                }
            }
            let whitening = FlightWhitening::new(data, flight);
            whitening.whiten(data, flight, &mut white);
            let whole = covariance(data, flight);
            let expected = plain.transpose() * whole.clone().try_inverse().unwrap() * &plain;
            let found = white.transpose() * &white;
            assert_near(&DMatrix::from_fn(3, 3, |i, j| found[(i, j)]), &expected, 1e-8);
            let own: f64 = rows
                .iter()
                .flat_map(|row| (0..channels).map(|k| 2.0 * row.noise.factor[k][k].ln()))
                .sum();
            assert!((own + whitening.ln_determinant - ln_determinant(&whole)).abs() < 1e-7);
        }
    });
}

/// `[diagnosis.14]`: what errors of Mach number, SAT and pressure altitude, drawn, make of predicted fuel flow has the variance
/// that is propagated; meter and acceleration, which are added to it, are left out of both.
#[test]
fn propagated_noise_of_fuel_flow_by_monte_carlo() {
    const DRAWS: usize = 4000;
    with_system(&fleet(72, 2), |problem| {
        let sensors = *problem.model.aircraft().sensors();
        let engines = problem.model.aircraft().engines() as f64;
        let mut stream = RandomStream::new(14, 0);
        let mut errors = vec![0.0; 3 * DRAWS];
        for row in problem.system.data.segments.iter().step_by(4) {
            stream.fill(&mut errors);
            let point = row.known.point();
            let ln_flow = |error: &[f64]| {
                let mach = point.mach + error[0] * sensors.mach;
                let sat_k =
                    point.static_air_temperature_k + error[1] * sensors.static_air_temperature_k;
                let sound = (sat_k / point.static_air_temperature_k).sqrt();
                let moved = EffectPoint {
                    mach,
                    static_air_temperature_k: sat_k,
                    // Airspeed is Mach number times the speed of sound.
                    true_airspeed_m_s: point.true_airspeed_m_s * mach / point.mach * sound,
                    pressure_altitude_m: point.pressure_altitude_m
                        + error[2] * sensors.pressure_altitude_m,
                    ..*point
                };
                let response = problem.model.response_beside(&moved, &Effects::none());
                response.unwrap().ln_fuel_flow_total
            };
            let drawn: Vec<f64> = errors.chunks(3).map(ln_flow).collect();
            let mean = drawn.iter().sum::<f64>() / DRAWS as f64;
            let variance = drawn.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / DRAWS as f64;
            let meter = (sensors.fuel_flow_percent / 100.0).powi(2) / engines;
            let slope = row.point.mass_kg / row.response.net_thrust_n;
            let acceleration = (slope * row.acceleration_deviation_m_s2).powi(2);
            // Of the segment alone, and what wanders through its flight.
            let wandering: f64 = row.noise.air_data[0].iter().map(|value| value * value).sum();
            let own = row.noise.factor[0][0].powi(2) - meter - acceleration;
            let propagated = own + wandering;
            // Five standard errors of a variance: 5·√(2/4000) = 0.11.
            let ratio = variance / propagated;
            assert!((ratio - 1.0).abs() < 0.11, "{variance} drawn, {propagated} propagated");
        }
    });
}

/// `[diagnosis.20]`: scatter of a level between flights, in the covariance of each flight written out.
#[test]
fn scatter_between_flights_is_part_of_the_covariance() {
    const SCATTER: f64 = 0.01;
    with_system(&fleet(73, 5), |problem| {
        let (system, design) = (problem.system, problem.system.design);
        let columns = [0, 3, design.smooth.start, design.residual()];
        let mut expected = DMatrix::zeros(4, 4);
        let mut expected_ln = 0.0;
        for flight in 0..system.data.flights.len() {
            let rows = system.whitened(flight);
            let of = |column: usize| DVector::from_column_slice(rows.col_as_slice(column));
            let level = of(design.smooth.start);
            let whole = DMatrix::identity(level.len(), level.len())
                + SCATTER * SCATTER * &level * level.transpose();
            expected_ln += ln_determinant(&whole);
            let x = DMatrix::from_columns(&columns.map(of));
            expected += x.transpose() * whole.try_inverse().unwrap() * &x;
        }
        let (scatter, found_ln) = system.scatter_of(&columns, SCATTER, None);
        let gram = &system.gram(None).matrix;
        let found = DMatrix::from_fn(4, 4, |i, j| {
            let taken: f64 = (0..scatter.scaled.ncols())
                .map(|flight| scatter.scaled[(i, flight)] * scatter.scaled[(j, flight)])
                .sum();
            gram[(columns[i], columns[j])] - taken
        });
        // Column by column: they differ by orders of magnitude.
        for i in 0..4 {
            for j in 0..4 {
                let scale = (expected[(i, i)] * expected[(j, j)]).sqrt();
                let difference = (found[(i, j)] - expected[(i, j)]).abs();
                assert!(difference <= 1e-9 * scale, "{i} {j}: {difference} of {scale}");
            }
        }
        assert!((found_ln - expected_ln).abs() < 1e-9 * expected_ln, "{found_ln} {expected_ln}");
    });
}

/// `[diagnosis.50]`, by hand: √(5/(4 + z²)) is 1 at 1 and ½ at 4.
#[test]
fn far_segments_weigh_little() {
    for (z, expected) in
        [(0.0, 1.0), (1.0, 1.0), (4.0, 0.5), (14.0, 5.0_f64.sqrt() / 200.0_f64.sqrt())]
    {
        assert!((student_weight(z) - expected).abs() < 1e-12, "{z}");
    }
}

/// `[diagnosis.24]`: draws of the noise have the covariance from which they are drawn, written out: scaled noise of the flight,
/// scatter between flights, chords of the table, which all flights share.
#[test]
fn draws_have_their_covariance() {
    const DRAWS: usize = 6000;
    let level = NoiseLevel { factor: 1.3, scatter: 0.004 };
    with_system(&fleet(75, 2), |problem| {
        let (system, data) = (problem.system, problem.system.data);
        let (channels, chords) = (data.channels.count(), chords(system));
        let mut drawn = vec![vec![]; data.segments.len()];
        let drawing = Drawing { level, chords: &chords, width: DRAWS };
        draw(system, &drawing, &mut RandomStream::new(24, 1), |segment, values| {
            drawn[segment] = values[0].clone();
        });
        for (i, a) in drawn.iter().enumerate() {
            for (j, b) in drawn.iter().enumerate().take(i + 1) {
                let mut expected: f64 = chords[i].iter().zip(&chords[j]).map(|(a, b)| a * b).sum();
                let own = |flight: &&FlightRows| flight.segments.contains(&i);
                let flight = data.flights.iter().find(own).unwrap();
                if flight.segments.contains(&j) {
                    let whole = covariance(data, flight);
                    let at = |segment: usize| (segment - flight.segments.start) * channels;
                    expected +=
                        level.factor.powi(2) * whole[(at(i), at(j))] + level.scatter.powi(2);
                }
                let found = a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / DRAWS as f64;
                let scale =
                    |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>() / DRAWS as f64;
                // Standard error of a covariance: at most √2 of both standard deviations over √n; of 210 none is beyond five.
                let error = (2.0 * scale(a) * scale(b) / DRAWS as f64).sqrt();
                assert!((found - expected).abs() < 5.0 * error, "{i} {j}: {found} {expected}");
            }
        }
    });
}

/// Noise of fuel flow between all segments, at a level.
fn dense_noise(data: &PreparedFlights<'_>, level: NoiseLevel) -> DMatrix<f64> {
    let (size, channels) = (data.segments.len(), data.channels.count());
    let mut whole = DMatrix::<f64>::zeros(size, size);
    for flight in &data.flights {
        let dense = covariance(data, flight);
        let from = flight.segments.start;
        for i in flight.segments.clone() {
            for j in flight.segments.clone() {
                let own = dense[((i - from) * channels, (j - from) * channels)];
                whole[(i, j)] = level.factor.powi(2) * own + level.scatter.powi(2);
            }
        }
    }
    whole
}

/// A gap without meaning.
fn any_gap(size: usize) -> DVector<f64> {
    DVector::from_fn(size, |i, _| 0.01 * (((13 * i) % 17) as f64 / 17.0 - 0.4))
}

/// `[diagnosis.29]`: step and fall of χ² are those of two generalised least-squares fits, written out densely.
#[test]
fn steps_over_regions_are_of_two_fits() {
    let level = NoiseLevel { factor: 1.2, scatter: 0.003 };
    with_system(&fleet(76, 4), |problem| {
        let (system, data) = (problem.system, problem.system.data);
        let size = data.segments.len();
        let inverse = dense_noise(data, level).try_inverse().unwrap();
        let gap = any_gap(size);
        let fit = |x: &DMatrix<f64>| {
            let normal = x.transpose() * &inverse * x;
            let right = x.transpose() * &inverse * &gap;
            let sizes = normal.try_inverse().unwrap() * right;
            let left = &gap - x * &sizes;
            ((left.transpose() * &inverse * &left)[(0, 0)], sizes)
        };
        let places: Vec<Vec<usize>> =
            [3, 4, 7].map(|n| (0..size).filter(|i| i % n == 1).collect()).to_vec();
        let noise = Noise::new(system, level);
        let steps = noise.steps(gap.as_slice(), &places);
        assert_eq!(steps.len(), places.len());
        let ones = DVector::from_element(size, 1.0);
        for (step, place) in steps.iter().zip(&places) {
            let inside = DVector::from_fn(size, |i, _| if place.contains(&i) { 1.0 } else { 0.0 });
            let both = DMatrix::from_columns(&[ones.clone(), inside]);
            let (of_level, _) = fit(&DMatrix::from_columns(core::slice::from_ref(&ones)));
            let (of_both, sizes) = fit(&both);
            assert!((step.fall / (of_level - of_both) - 1.0).abs() < 1e-7, "{step:?} {of_both}");
            assert!((step.size / sizes[1] - 1.0).abs() < 1e-7, "{step:?} {sizes}");
        }
    });
}

/// `[diagnosis.25]`: the sums over all places, by prefix sums over bins, are those that are written out segment by segment, with
/// C⁻¹ inverted densely.
#[test]
fn sums_over_places_are_of_their_segments() {
    let level = NoiseLevel { factor: 1.2, scatter: 0.003 };
    with_system(&fleet(78, 12), |problem| {
        let (system, data) = (problem.system, problem.system.data);
        let size = data.segments.len();
        let inverse = dense_noise(data, level).try_inverse().unwrap();
        let (gap, ones) = (any_gap(size), DVector::from_element(size, 1.0));
        let noise = Noise::new(system, level);
        let weighed = noise.weighed(gap.as_slice());
        let of_ones = &inverse * &ones;
        let best_level = gap.dot(&of_ones) / ones.dot(&of_ones);
        let within = &inverse * (&gap - &ones * best_level);
        let about_mean = gap.add_scalar(-gap.mean());

        let places = places(&data.segments, system.design.references());
        let search = Search::new(&places, &noise.weighed(ones.as_slice()), 0);
        assert_eq!(search.series(), [Series::FuelFlow, Series::WithinFlights]);
        let mut sums = search.sums(1);
        search.add(&mut sums, 0, &[gap.as_slice().to_vec(), weighed.clone()]);
        let mut seen = [0, 0];
        search.for_each(&sums, |index, sum| {
            let region = &search.regions[index];
            if region.is_everywhere() {
                return;
            }
            let of = match region.series {
                Series::WithinFlights => &within,
                _ => &about_mean,
            };
            seen[usize::from(region.series == Series::WithinFlights)] += 1;
            let expected: f64 =
                (0..size).filter(|&k| region.holds(&places, k)).map(|k| of[k]).sum();
            let scale: f64 = of.iter().map(|value| value.abs()).sum();
            assert!((sum[0] - expected).abs() < 1e-9 * scale, "{region:?}: {} {expected}", sum[0]);
        });
        assert!(seen.iter().all(|count| *count > 200), "{seen:?}");
    });
}

/// `[diagnosis.15]`: of a table whose drag is a sum of squares, a chord is above the curve by the curvature, exactly.
#[test]
fn chords_of_a_parabola() {
    let model = exact_model();
    let grid = std::sync::Arc::clone(model.drag_table().grid());
    let (curved_lift, curved_mach) = (0.05, 0.3);
    let drag = |lift: f64, mach: f64| 0.02 + curved_lift * lift * lift + curved_mach * mach * mach;
    let values: Vec<f64> = grid
        .x()
        .breakpoints()
        .iter()
        .flat_map(|lift| grid.y().breakpoints().iter().map(|mach| drag(*lift, *mach)))
        .collect();
    let table = lut::Table::new(std::sync::Arc::clone(&grid), values).unwrap();
    let flights = fleet(77, 2);
    let records: Vec<FlightRecord<'_>> =
        flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let references = references_of(&model, &table, &records).unwrap();
    let effects = EffectModel::new(&model, &table, references).unwrap();
    with_system(&flights, |problem| {
        for row in &problem.system.data.segments {
            let (lift, mach) = (row.response.lift_coefficient, row.response.mach);
            let cell = grid.locate(lift, mach, lut::Outside::Hold).unwrap();
            let (u, v) = cell.local();
            let step = |axis: &lut::Axis, at: f64| {
                let points = axis.breakpoints();
                let next = points.iter().position(|point| *point > at).unwrap();
                points[next] - points[next - 1]
            };
            // A chord of c·x² is above it by c·Δ²·u(1 − u).
            let above_lift = curved_lift * step(grid.x(), lift).powi(2) * u * (1.0 - u);
            let above_mach = curved_mach * step(grid.y(), mach).powi(2) * v * (1.0 - v);
            let interpolated = table.interpolate(&cell);
            let truth = drag(lift, mach);
            assert!((interpolated - above_lift - above_mach - truth).abs() < 1e-12);
            let found = chord_errors(&effects, &row.response);
            for (found, above) in found.into_iter().zip([above_lift, above_mach]) {
                let expected = -above / interpolated;
                assert!((found - expected).abs() < 1e-9, "{found} {expected}");
            }
        }
    });
}

/// `[diagnosis.30]`, Monte Carlo: of gaps that are noise of 0.5 % within flights and of any size between them, replicates find
/// the noise within, and the propagated part is added.
#[test]
fn replicates_find_the_noise_within_flights() {
    const WITHIN: f64 = 0.005;
    with_system(&fleet(78, 200), |problem| {
        let data = problem.system.data;
        let mut stream = RandomStream::new(30, 0);
        let mut noise = vec![0.0; data.segments.len()];
        stream.fill(&mut noise);
        let mut of_flight = vec![0.0; data.flights.len()];
        stream.fill(&mut of_flight);
        let left =
            |flight: usize, segment: usize| WITHIN * noise[segment] + 0.03 * of_flight[flight];
        let change = |flight: usize, segment: usize| {
            data.segments[segment].residual[0] - left(flight, segment)
        };
        let own = Shrinkage::of_changes(problem.system, 1.0, 0, change);
        let found = replicate_floor(problem.system, &own, 2.0).unwrap();
        let neighbours = data.flights.iter().flat_map(|flight| {
            data.segments[flight.segments.clone()].windows(2).map(|pair| (&pair[0], &pair[1]))
        });
        let (mut covariance, mut pairs) = (0.0, 0.0);
        for (a, b) in neighbours.filter(|(a, b)| are_replicates(&a.point, &b.point)) {
            for (a, b) in a.noise.common.iter().zip(&b.noise.common) {
                covariance += a[0] * b[0];
            }
            pairs += 1.0;
        }
        let between = 2.0 * covariance / pairs;
        let ratio = (found - between) / (WITHIN * WITHIN);
        // Neighbours share segments: some hundreds of pairs know a variance to a tenth.
        assert!((ratio - 1.0).abs() < 0.25, "{ratio}");
    });
}

/// `[diagnosis.41]`, by hand: 0.9 is half way from 0.8 to 1.
#[test]
fn credit_by_hand() {
    let sure = |share: f64| Some((share, [0.1, 1.0]));
    for (beside, closed, expected) in [
        (0.3, None, 0.3),
        (0.3, sure(0.9), 0.5),
        (0.7, sure(0.9), 0.7),
        (0.3, sure(0.8), 0.3),
        (0.3, sure(1.2), 1.0),
        // Where the effect may close nothing, what acts beside the function counts for nothing.
        (0.7, Some((0.5, [-0.1, 0.9])), 0.0),
    ] {
        let found = credit(beside, closed);
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

/// What a form is fitted as is what it does once a model contains it: every kind of form, on drag and on fuel flow, over a
/// variable of the state, of the forces and of time; a size so small that the difference is of first order.
#[test]
fn a_form_acts_in_a_model_as_it_was_fitted() {
    const SIZE: f64 = 1e-3;
    with_system(&fleet(9806, 8), |problem| {
        let (system, plain) = (problem.system, exact_model());
        let references = *system.design.references();
        let values: Vec<Values> = [Variable::Mach, Variable::CorrectedThrust, Variable::Date]
            .into_iter()
            .flat_map(|variable| [Acts::FuelFlow, Acts::Thrust].map(|acts| (variable, acts)))
            .filter_map(|(variable, acts)| {
                let of = |row: &SegmentRow| {
                    variable.value_of_form(&row.point, &row.response, &references).unwrap()
                };
                Values::new(variable, acts, system.data.segments.iter().map(of).collect())
            })
            .collect();
        let mut kinds: Vec<(Form, usize)> = Vec::new();
        for one in candidates(&values) {
            let of = &values[one.variable];
            if kinds
                .iter()
                .any(|(form, variable)| form.is_like(one.form) && *variable == one.variable)
            {
                continue;
            }
            kinds.push((one.form, one.variable));
            let acts_on =
                if of.acts == Acts::Thrust { StepTarget::Drag } else { StepTarget::FuelFlow };
            let form = AppliedForm {
                form: one.form,
                variable: of.variable,
                scale: [of.mean, of.deviation],
                acts_on,
                size: SIZE,
                standard_deviation: SIZE,
            };
            let layer = AppliedLayer { effects: Effects::none(), forms: vec![form], references };
            let extended = plain.with_effects(AppliedEffects::new(vec![layer])).unwrap();
            let applied = EffectModel::new(&extended, extended.drag_table(), references).unwrap();
            for (segment, row) in system.data.segments.iter().enumerate() {
                let with = applied.response(&row.point, &Effects::none()).unwrap();
                let found = (with.ln_fuel_flow_total - row.response.ln_fuel_flow_total) / SIZE;
                let fitted = change(&values, &one, segment, row);
                let scale = 1e-4 * fitted.abs().max(1e-2);
                assert!((found - fitted).abs() < scale, "{form:?}: {found} {fitted}");
            }
        }
        // Ten kinds of each of six; an offset once for each of the two that it can act on.
        assert!(kinds.len() > 50, "{}", kinds.len());
    });
}
