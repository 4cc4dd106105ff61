//! Forms against dense linear algebra.

use effects::Variable;
use nalgebra::{DMatrix, DVector};

use super::{assert_near, covariance, fleet, with_system};
use crate::hypotheses::design::Acts;
use crate::judge::forms::dictionary::{Candidate, Values, candidates};
use crate::judge::forms::{Columns, change};
use crate::residuals::rows::{FlightRows, SegmentRow};
use crate::search::folds::fold_of;
use crate::search::system::WhitenedSystem;
use crate::signals::channels::{ByChannel, MAXIMUM_CHANNELS};

/// Candidates' units, which only scale: any numbers.
fn unit_of(candidate: usize) -> f64 {
    1.0 + 0.25 * (candidate % 5) as f64
}

/// One column per value that `of` a segment has, as recorded and not whitened, over a flight.
fn plain(
    system: &WhitenedSystem<'_>,
    flight: &FlightRows,
    width: usize,
    of: impl Fn(usize, &SegmentRow, usize) -> ByChannel,
) -> DMatrix<f64> {
    let channels = system.data.channels.count();
    let mut matrix = DMatrix::zeros(flight.segments.len() * channels, width);
    for (place, segment) in flight.segments.clone().enumerate() {
        for column in 0..width {
            let values = of(segment, &system.data.segments[segment], column);
            for channel in 0..channels {
                matrix[(place * channels + channel, column)] = values[channel];
            }
        }
    }
    matrix
}

/// What a candidate changes in the channels of a segment: fuel flow, and N2 where it acts on thrust.
fn of_candidate(
    system: &WhitenedSystem<'_>,
    (values, one): (&[Values], &Candidate),
    (segment, row): (usize, &SegmentRow),
) -> ByChannel {
    let mut by_channel = [0.0; MAXIMUM_CHANNELS];
    by_channel[0] = change(values, one, segment, row);
    if values[one.variable].acts == Acts::Thrust {
        by_channel[system.data.channels.n2_row()] = row.n2_slope * by_channel[0];
    }
    by_channel
}

/// Products of the columns of forms with effects, residual, each other and each flight's level are those with the inverse of the
/// covariance of every flight, written out; a fold that is left out is in none of them.
#[test]
fn products_of_forms_are_by_the_inverse_of_the_covariance() {
    with_system(&fleet(79, 7), |problem| {
        let (system, data) = (problem.system, problem.system.data);
        let design = system.design;
        let references = design.references();
        let mach = |row: &SegmentRow| {
            Variable::Mach.value_of_form(&row.point, &row.response, references).unwrap()
        };
        let of_segments: Vec<f64> = data.segments.iter().map(mach).collect();
        let values = [Acts::FuelFlow, Acts::Thrust]
            .map(|acts| Values::new(Variable::Mach, acts, of_segments.clone()).unwrap());
        let candidates: Vec<Candidate> = candidates(&values).into_iter().step_by(9).collect();
        let acts: Vec<Acts> = candidates.iter().map(|one| values[one.variable].acts).collect();
        assert!(data.channels.n2 && acts.contains(&Acts::FuelFlow) && acts.contains(&Acts::Thrust));
        let units: Vec<f64> = (0..candidates.len()).map(unit_of).collect();
        let columns = Columns { system, values: &values, candidates: &candidates, units: &units };
        let (count, end) = (candidates.len(), design.smooth.end);

        for without in [None, Some(1)] {
            let mut own = DMatrix::zeros(count + 1, count + 1);
            let mut cross = DMatrix::zeros(design.effects, count + 1);
            let mut levels = DMatrix::zeros(data.flights.len(), count + 1);
            for (index, flight) in data.flights.iter().enumerate() {
                if Some(fold_of(index)) == without {
                    continue;
                }
                let forms = plain(system, flight, count + 1, |segment, row, k| {
                    if k == count {
                        return row.residual;
                    }
                    let one = of_candidate(system, (&values, &candidates[k]), (segment, row));
                    one.map(|value| value * units[k])
                });
                let effects = plain(system, flight, design.effects, |_, row, k| row.signatures[k]);
                let mut level = DVector::zeros(forms.nrows());
                level.iter_mut().step_by(data.channels.count()).for_each(|value| *value = 1.0);
                let solved = covariance(data, flight).try_inverse().unwrap() * &forms;
                own += forms.transpose() * &solved;
                cross += effects.transpose() * &solved;
                levels.set_row(index, &(level.transpose() * &solved).row(0));
            }
            let (changed, of_levels) = columns.products(without);
            let near = |found: &faer::Mat<f64>, rows: &[usize], expected: &DMatrix<f64>| {
                for column in 0..=count {
                    let found = DMatrix::from_fn(rows.len(), 1, |i, _| found[(rows[i], column)]);
                    let expected = expected.columns(column, 1).into_owned();
                    assert_near(&found, &expected, 1e-7);
                }
            };
            let all = |length: usize| (0..length).collect::<Vec<usize>>();
            near(&changed.own, &all(count + 1), &own);
            near(&changed.cross, &all(design.effects), &cross);
            near(&changed.cross, &[end], &own.rows(count, 1).into_owned());
            near(&of_levels, &all(data.flights.len()), &levels);
        }
    });
}
