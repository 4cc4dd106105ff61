//! What the tails of one model have in common before they are compared: channels, N2 deck, effects, columns of what is uncertain;
//! and the Gram of a tail over them.

use effects::{EffectModel, EffectReferences};
use faer::Mat;
use flight::effect::{EffectId, HiddenParameter};

use crate::baseline::Baseline;
use crate::fleet::basis::{Layout, SharedBasis};
use crate::fleet::joint::TailGram;
use crate::hypotheses::design::Design;
use crate::hypotheses::evidence::ln_evidence_of_left;
use crate::input::{Input, Options};
use crate::library::dates::{DateGrid, is_dated};
use crate::library::{Library, Testable};
use crate::math::cholesky::Cholesky;
use crate::math::eliminate::{Reduced, integrate_out};
use crate::math::gram::Sum;
use crate::math::linear::{subtract_gram, symmetrize};
use crate::output::addition::{AddedEffect, Addition};
use crate::priors::{
    BOOK_SCATTERS, FLEET_FLIGHT_SHARES, FLEET_MODEL_SMOOTH, FLEET_TAIL_NUISANCE, FLEET_TAIL_SMOOTH,
    SMOOTH_AMPLITUDES, TAUGHT_SCATTERS,
};
use crate::residuals::reference::Reference;
use crate::residuals::segments::{Frame as ChannelFrame, PreparedFlights};
use crate::signals::record::FlightRecord;
use crate::signals::references::DiagnoseError;
use crate::thresholds::{FLEET_BASIS_FLIGHTS, FLEET_FRAME_FLIGHTS};

/// What is common to the tails of one model: built from some flights of all of them, used for each.
#[derive(Debug)]
pub struct FleetFrame<'a> {
    model: EffectModel<'a>,
    baseline: Option<&'a Baseline>,
    references: EffectReferences,
    design: Design<'a>,
    library: Library,
    channels: ChannelFrame,
    /// The column of each effect in the design.
    columns: Vec<usize>,
    model_of: ModelOf,
    basis: SharedBasis,
}

/// A tail reduced to a Gram matrix over the effects, what its type shares, and its residual.
#[derive(Clone, Debug)]
pub struct FleetTail {
    pub(crate) gram: TailGram,
    pub(crate) effects: Vec<Testable>,
    pub(crate) shared: SharedColumns,
    /// What each effect has beyond its size.
    hidden: Vec<HiddenParameter>,
    references: EffectReferences,
    /// Flights that were used.
    pub flights: usize,
    /// Segments that were used.
    pub segments: usize,
    /// Mean gap of the segments, 100·ln(recorded/predicted) fuel flow.
    pub mean_gap_percent: f64,
}

/// What tails share beyond the effects: columns of unit prior variance, then those of the smooth discrepancy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SharedColumns {
    nuisance: usize,
    smooth: usize,
    /// Prior standard deviation of a smooth term for an amplitude of 1.
    smooth_deviation: f64,
}

/// Whether what the model is uncertain about is one and the same for several tails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelOf {
    /// One model for all tails: what it lacks, all of them show.
    Type,
    /// Each tail has learnt its own.
    Tail,
}

impl<'a> FleetFrame<'a> {
    /// From flights of every tail of a model, `input.flights`, evenly thinned out where they are many.
    ///
    /// # Errors
    /// [`DiagnoseError`] where the model takes no effects, or no flight is inside its table.
    pub fn new(
        input: Input<'a>,
        options: &Options,
        model_of: ModelOf,
    ) -> Result<Self, DiagnoseError> {
        let every = input.flights.len().div_ceil(FLEET_FRAME_FLIGHTS).max(1);
        let flights: Vec<FlightRecord<'a>> = input.flights.iter().step_by(every).copied().collect();
        let thinned = Input { flights: &flights, ..input };
        let references = thinned.effect_references()?;
        let model = EffectModel::new(input.model, input.drag_table, references)?;
        let chosen = |id: EffectId| {
            (options.effects.is_empty() || options.effects.contains(&id))
                && !options.without.contains(&id)
                // `monitor` looks for what has dates of its own on every tail.
                && !is_dated(id)
        };
        let (mut data, library) = PreparedFlights::prepare(
            &model,
            &flights,
            input.reference(),
            |points, engines, starts| {
                let dates = DateGrid::coarse(starts, &[], None);
                Library::new(&model, points, engines, dates, chosen)
            },
        );
        data.of_other_aircraft = model_of == ModelOf::Type;
        let design = Design::new(&data, &references, input.baseline, input.table);
        let columns: Vec<usize> =
            library.effects.iter().map(|effect| effect.representative).collect();
        let channels = data.frame();
        let design = design.without_blocks();
        let basis = basis_of(&design, &columns, &data, input.flights.len())?;
        Ok(Self {
            model,
            baseline: input.baseline,
            references,
            design,
            library,
            channels,
            columns,
            model_of,
            basis,
        })
    }

    /// Reduces a tail's flights, in order of flying; `None` where none is inside the table or the numbers are degenerate.
    #[must_use]
    pub fn tail(&self, flights: &[FlightRecord<'_>]) -> Option<FleetTail> {
        let reference = Reference::from_baseline(self.baseline);
        let data = PreparedFlights::prepare_in(
            &self.model,
            flights,
            reference,
            &self.channels,
            &self.library,
        );
        if data.segments.is_empty() {
            return None;
        }
        let [nuisance, smooth] = self.basis.columns();
        let effects = self.columns.len();
        let columns = effects + nuisance + smooth + 1;
        let own_columns = self.columns_of_a_flight();
        let mut sum = Sum::new(columns);
        let mut products = Vec::with_capacity(data.flights.len());
        for flight in &data.flights {
            let rows = self.design.whitened(&data, flight);
            let own = Mat::from_fn(rows.nrows(), own_columns.len(), |row, place| {
                rows[(row, own_columns[place].0)]
            });
            let rows = self.basis.project(&rows);
            products.push((rows.transpose() * &own, own.transpose() * &own));
            sum.add(&rows, data.recorded_values(flight));
        }
        let gram = sum.finish();
        // What the model does not know of the aircraft that taught it, it does not know of this one either.
        let smooth_amplitude = match self.model_of {
            ModelOf::Type => FLEET_TAIL_SMOOTH,
            ModelOf::Tail => FLEET_TAIL_SMOOTH.hypot(FLEET_MODEL_SMOOTH),
        };
        let mut deviations = vec![FLEET_TAIL_NUISANCE; nuisance];
        deviations.resize(nuisance + smooth, self.design.smooth_deviation(smooth_amplitude));
        let out: Vec<usize> = (effects..columns - 1).collect();
        let (kept, shared): (Vec<usize>, SharedColumns) = match self.model_of {
            ModelOf::Type => {
                let smooth_deviation = self.design.smooth_deviation(1.0);
                ((0..columns).collect(), SharedColumns { nuisance, smooth, smooth_deviation })
            }
            ModelOf::Tail => ((0..effects).chain([columns - 1]).collect(), SharedColumns::NONE),
        };
        let mut best: Option<(f64, Reduced)> = None;
        for of_flight in self.scatters(&own_columns) {
            let (matrix, ln_determinant) = without_scatter(&gram.matrix, &products, &of_flight)?;
            let mut reduced = integrate_out(&matrix, &kept, &out, &deviations)?;
            reduced.ln_determinant += ln_determinant;
            let ln = self.ln_evidence(&reduced, gram.rows, shared)?;
            if best.as_ref().is_none_or(|(known, _)| ln > *known) {
                best = Some((ln, reduced));
            }
        }
        let (_, reduced) = best?;
        Some(FleetTail {
            gram: TailGram { matrix: reduced.matrix, rows: gram.rows },
            effects: self.library.effects.clone(),
            shared,
            hidden: self.columns.iter().map(|&c| self.library.columns[c].hidden).collect(),
            references: self.references,
            flights: data.flights.len(),
            segments: data.segments.len(),
            mean_gap_percent: 100.0 * data.segments.iter().map(|row| row.residual[0]).sum::<f64>()
                / data.segments.len() as f64,
        })
    }
}

impl FleetFrame<'_> {
    /// Columns of what a flight may have of its own, and the typical size of an effect: its level of fuel flow, what its probes
    /// and its load sheet are off by.
    fn columns_of_a_flight(&self) -> Vec<(usize, Option<f64>)> {
        let of_effects =
            self.library.effects.iter().zip(&self.columns).filter_map(|(effect, &column)| {
                let is_own = matches!(
                    effect.id,
                    EffectId::MachBias
                        | EffectId::StaticPressureBias
                        | EffectId::TemperatureBias
                        | EffectId::ZeroFuelMassBias
                );
                is_own.then_some((column, Some(effect.typical)))
            });
        core::iter::once((self.design.smooth.start, None)).chain(of_effects).collect()
    }

    /// Standard deviations of what each flight has of its own, as they are tried.
    fn scatters(&self, own_columns: &[(usize, Option<f64>)]) -> Vec<Vec<f64>> {
        let levels: &[f64] =
            if self.baseline.is_some() { &TAUGHT_SCATTERS } else { &BOOK_SCATTERS };
        let deviations = |level: f64, of_typical: f64| {
            let own = own_columns.iter();
            own.map(|(_, typical)| typical.map_or(level, |typical| of_typical * typical)).collect()
        };
        levels
            .iter()
            .flat_map(|&level| FLEET_FLIGHT_SHARES.map(|share| deviations(level, share)))
            .collect()
    }

    /// ln of a tail's evidence where every effect and everything shared may act as believed beforehand.
    fn ln_evidence(&self, reduced: &Reduced, rows: f64, shared: SharedColumns) -> Option<f64> {
        let last = reduced.matrix.ncols() - 1;
        let mut deviations: Vec<f64> =
            self.library.effects.iter().map(|effect| effect.prior_deviation).collect();
        deviations.extend(shared.deviations(FLEET_MODEL_SMOOTH));
        let out: Vec<usize> = (0..last).collect();
        let left = integrate_out(&reduced.matrix, &[last], &out, &deviations)?;
        let ln_determinant = reduced.ln_determinant + left.ln_determinant;
        Some(ln_evidence_of_left(rows, left.matrix[(0, 0)], ln_determinant))
    }
}

impl SharedColumns {
    const NONE: Self = Self { nuisance: 0, smooth: 0, smooth_deviation: 0.0 };

    pub(crate) const fn columns(self) -> usize {
        self.nuisance + self.smooth
    }

    /// Prior standard deviations, with this amplitude of the smooth discrepancy.
    pub(crate) fn deviations(self, smooth_amplitude: f64) -> Vec<f64> {
        let nuisance = core::iter::repeat_n(1.0, self.nuisance);
        let smooth = smooth_amplitude * self.smooth_deviation;
        nuisance.chain(core::iter::repeat_n(smooth, self.smooth)).collect()
    }
}

#[cfg(test)]
impl SharedColumns {
    pub(crate) const fn of_nuisance(nuisance: usize) -> Self {
        Self { nuisance, smooth: 0, smooth_deviation: 0.0 }
    }
}

#[cfg(test)]
impl FleetTail {
    pub(crate) fn made_up(
        gram: TailGram,
        effects: Vec<Testable>,
        shared: SharedColumns,
        (hidden, references): (Vec<HiddenParameter>, EffectReferences),
    ) -> Self {
        Self {
            gram,
            effects,
            shared,
            hidden,
            references,
            flights: 1,
            segments: 1,
            mean_gap_percent: 0.0,
        }
    }
}

impl FleetTail {
    /// Effects of these sizes and standard deviations, as a model of the tail takes them.
    #[must_use]
    pub fn addition(&self, sizes: &[(EffectId, f64, f64)]) -> Addition {
        let added = |&(effect, size, standard_deviation): &(EffectId, f64, f64)| {
            let place = self.effects.iter().position(|testable| testable.id == effect);
            let hidden = place.map_or(effect.entry().hidden, |place| self.hidden[place]);
            AddedEffect { effect, size, standard_deviation, hidden }
        };
        Addition {
            effects: sizes.iter().map(added).collect(),
            form: None,
            references: self.references,
        }
    }

    /// Takes its Gram, over the effects of a fleet; one that the tail cannot test has zeros. `None` where what it shares is
    /// laid out in another way.
    pub(crate) fn take_spread(
        &mut self,
        effects: &[Testable],
        shared: SharedColumns,
    ) -> Option<TailGram> {
        if self.shared != shared {
            return None;
        }
        let rows = self.gram.rows;
        let gram = core::mem::replace(&mut self.gram.matrix, Mat::zeros(0, 0));
        let ids = |of: &[Testable]| of.iter().map(|effect| effect.id).collect::<Vec<_>>();
        if ids(&self.effects) == ids(effects) {
            return Some(TailGram { matrix: gram, rows });
        }
        let own = &self.effects;
        let of_effect =
            |effect: &Testable| own.iter().position(|testable| testable.id == effect.id);
        let places: Vec<Option<usize>> =
            effects.iter().map(of_effect).chain((own.len()..gram.ncols()).map(Some)).collect();
        let matrix = Mat::from_fn(places.len(), places.len(), |i, j| {
            places[i].zip(places[j]).map_or(0.0, |(i, j)| gram[(i, j)])
        });
        Some(TailGram { matrix, rows })
    }
}

/// From at most some flights, evenly: which combinations of what is shared `flights` flights tell about.
fn basis_of(
    design: &Design<'_>,
    effects: &[usize],
    data: &PreparedFlights<'_>,
    flights: usize,
) -> Result<SharedBasis, DiagnoseError> {
    let every = data.flights.len().div_ceil(FLEET_BASIS_FLIGHTS).max(1);
    let mut sum = Sum::new(design.columns);
    let mut taken = 0;
    for flight in data.flights.iter().step_by(every) {
        let rows = design.whitened(data, flight);
        sum.add(&rows, data.recorded_values(flight));
        taken += 1;
    }
    let most = SMOOTH_AMPLITUDES.into_iter().fold(0.0, f64::max);
    let layout = Layout {
        effects: effects.to_vec(),
        nuisance: design.nuisance.clone(),
        smooth: design.smooth.clone(),
        residual: design.residual(),
        smooth_deviation: design.smooth_deviation(most),
    };
    let more = flights as f64 / f64::from(taken.max(1));
    SharedBasis::new(&sum.finish().matrix, &layout, more).ok_or(DiagnoseError::Degenerate)
}

/// A Gram from which what each flight has of its own is integrated out, and ln of the determinant:
///
/// ```text
/// G' = G − Σ_f P_f S (1 + S K_f S)⁻¹ S P_fᵀ,   P_f = A_fᵀ O_f,   K_f = O_fᵀ O_f        [fleet.4]
/// ```
///
/// with the whitened rows `A_f` of a flight, those of its own columns `O_f`, and their standard deviations S.
fn without_scatter(
    gram: &Mat<f64>,
    products: &[(Mat<f64>, Mat<f64>)],
    deviations: &[f64],
) -> Option<(Mat<f64>, f64)> {
    let mut matrix = gram.clone();
    let mut ln_determinant = 0.0;
    let own: Vec<usize> = (0..deviations.len()).filter(|&k| deviations[k] > 0.0).collect();
    if own.is_empty() {
        return Some((matrix, ln_determinant));
    }
    let mut all = Mat::<f64>::zeros(gram.ncols(), own.len() * products.len());
    for (flight, (with_all, with_own)) in products.iter().enumerate() {
        let mut scaled = Mat::from_fn(own.len(), gram.ncols(), |place, column| {
            deviations[own[place]] * with_all[(column, own[place])]
        });
        let inner = Mat::from_fn(own.len(), own.len(), |a, b| {
            let one = if a == b { 1.0 } else { 0.0 };
            let [a, b] = [own[a], own[b]];
            (deviations[a] * deviations[b]).mul_add(with_own[(a, b)], one)
        });
        let factor = Cholesky::new(&inner)?;
        ln_determinant += factor.ln_determinant();
        factor.solve_lower(&mut scaled);
        all.subcols_mut(flight * own.len(), own.len()).copy_from(scaled.transpose());
    }
    subtract_gram(&mut matrix, &all);
    symmetrize(&mut matrix);
    Some((matrix, ln_determinant))
}

#[cfg(test)]
mod tests;
