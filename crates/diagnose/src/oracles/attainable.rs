//! What anyone could name, against dense algebra.

use flight::effect::EffectId;
use nalgebra::{DMatrix, DVector};

use crate::attainable::{KnownClutter, ln_evidence, reduced_at};
use crate::oracles::{fleet, ln_determinant, with_system};

/// `[diagnosis.54]`: the normal density of the whitened residuals with the whole covariance written out, clutter, smooth errors
/// and nuisance among it. Oracle: nalgebra.
#[test]
fn evidence_of_a_known_size_is_a_normal_density() {
    let clutter = KnownClutter { share: 0.1, smooth_percent: 0.35, times: 1.5 };
    with_system(&fleet(71, 5), |problem| {
        let (system, library) = (problem.system, problem.library);
        let design = system.design;
        let whitened: Vec<_> =
            (0..system.data.flights.len()).map(|flight| system.whitened(flight)).collect();
        let size = whitened.iter().map(|rows| rows.nrows()).sum();
        let column = |place: usize| {
            let values = whitened.iter().flat_map(|rows| rows.col_as_slice(place).iter().copied());
            DVector::from_iterator(size, values)
        };
        let residual = column(design.residual());
        let density = |named: EffectId| {
            let mut covariance = DMatrix::<f64>::identity(size, size);
            let mut add = |place: usize, deviation: f64| {
                let own = column(place) * deviation;
                covariance += &own * own.transpose();
            };
            design.nuisance.clone().for_each(|place| add(place, 1.0));
            let smooth = design.smooth_deviation(0.0035);
            design.smooth.clone().for_each(|place| add(place, smooth));
            for other in library.effects.iter().filter(|e| e.id != named && !e.has_known_size) {
                add(other.representative, 0.1 * other.typical);
            }
            let effect = library.effects.iter().find(|effect| effect.id == named).unwrap();
            let factor = covariance.clone().cholesky().unwrap();
            let each = [1.0, -1.0].map(|sign| {
                let of_effect = column(effect.representative) * (sign * 1.5 * effect.typical);
                let left = &residual - of_effect;
                -0.5 * (left.dot(&factor.solve(&left)) + ln_determinant(&covariance))
            });
            let best = each[0].max(each[1]);
            best + each.map(|ln| 0.5 * (ln - best).exp()).iter().sum::<f64>().ln()
        };
        let reduced = reduced_at(system, 0.0).unwrap();
        for named in [EffectId::DragFactor, EffectId::TemperatureBias, EffectId::FuelFlowGain] {
            let effect = library.effects.iter().find(|effect| effect.id == named).unwrap();
            assert_eq!(effect.columns, 1);
            let found = ln_evidence(&reduced, (design, library), effect, clutter).unwrap();
            let expected = density(named);
            assert!(
                (found - expected).abs() < 1e-7 * expected.abs(),
                "{named}: {found} {expected}"
            );
        }
    });
}
