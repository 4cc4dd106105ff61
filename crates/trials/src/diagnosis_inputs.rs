//! What the diagnosis of a case is given: a model that knows nothing of what was planted, and segments. No name of an
//! effect, no size.

use diagnose::{
    Baseline, Diagnosis, FlightRecord, Input, KnownClutter, Options, TableUncertainty, WholeModel,
    attainable, diagnose,
};
use effects::{BetweenNodes, ExtendedModel};
use flight::Segment;
use flight::effect::EffectId;
use lut::Table;
use pipeline::learning::{self, FlightToLearn, LawChoice};
use pipeline::model_file::{LawState, LedgerEntry, ModelFile};
use pipeline::reduction::ReducedFlight;
use pipeline::table_uncertainty;
use pipeline::whole_model::{HeldAgainst, Predicts, ln_gap_of};
use segmenter::TrimCriteria;
use simulate::Scatter;
use simulate::study::DragError;

use crate::draw::{DrawnCase, TAIL};
use crate::failure::CaseFailure;
use crate::flown_case::{fly, records};
use crate::guide_model::model_of_guide;
use crate::plan::ReferenceModel;
use crate::reference_model::{COARSE, FINE, reference_model};
use crate::stated_sensors::{misstated, stated_sensors};

/// What the diagnosis is given.
#[derive(Clone, Debug)]
pub struct DiagnosisInputs {
    model: ExtendedModel,
    /// The adapted drag table; the model's own where nothing was learnt.
    drag_table: Table,
    between_nodes: BetweenNodes,
    baseline: Option<Baseline>,
    uncertainty: Option<TableUncertainty>,
    flights: Vec<ReducedFlight>,
}

impl DiagnosisInputs {
    /// Flies a case and makes the model that lacks what is planted.
    ///
    /// # Errors
    /// What the simulator, the segmenter or the law of adaptation refuses.
    pub fn gather(drawn: &DrawnCase) -> Result<Self, CaseFailure> {
        let clean = drawn.clean_flights();
        let sensors = drawn.flown().plan().sensors.sensors();
        let truth = drawn.aircraft();
        let stated = stated_sensors(&sensors, &Scatter::default(), truth);
        let flights = fly(drawn.flown(), clean..drawn.flown().len())?;
        let model =
            |stated, grid, error| reference_model(truth, drawn.physics(), stated, grid, error);
        match drawn.reference_model() {
            ReferenceModel::Exact => Ok(Self::untaught(model(stated, &FINE, None)?, flights)),
            ReferenceModel::Misstated => {
                let stated = misstated(&stated, drawn.stated_over_true());
                Ok(Self::untaught(model(stated, &FINE, None)?, flights))
            }
            ReferenceModel::Initial => {
                let book = model(stated, &COARSE, Some(drawn.book_error()))?;
                Self::of_book(book, flights)
            }
            ReferenceModel::Guide => Self::of_guide(&model_of_guide(drawn, stated)?, flights),
            ReferenceModel::Adapted => {
                let training_flights = fly(drawn.training_flights(), 0..clean)?;
                let initial = model(stated, &COARSE, Some(&DragError::study()))?;
                adapted(initial, &training_flights, flights)
            }
        }
    }

    /// A model that no flight has taught, every node of its table taken as known.
    fn untaught(model: ExtendedModel, flights: Vec<ReducedFlight>) -> Self {
        let drag_table = model.drag_table().clone();
        let between_nodes = BetweenNodes::Straight;
        Self { model, drag_table, between_nodes, baseline: None, uncertainty: None, flights }
    }

    /// A table that no flight has taught, with what law `bayes` believes of a guide's drag.
    fn of_book(book: ExtendedModel, flights: Vec<ReducedFlight>) -> Result<Self, CaseFailure> {
        let settings = adapt::bayes::BayesSettings::physical_2026();
        let table = book.drag_table();
        let uncertainty =
            table_uncertainty::of_book(&book, table, settings, None, &records(&flights))?;
        Ok(Self { uncertainty, ..Self::untaught(book, flights) })
    }

    /// What `init` makes of a guide.
    fn of_guide(model: &ModelFile, flights: Vec<ReducedFlight>) -> Result<Self, CaseFailure> {
        let whole = Predicts::WholeModel;
        let uncertainty = table_uncertainty::of_model(model, whole, &records(&flights))?;
        let HeldAgainst { model, between_nodes, .. } = model.held_against(whole);
        Ok(Self { between_nodes, uncertainty, ..Self::untaught(model.clone(), flights) })
    }

    /// The diagnosis, with these effects struck from the library.
    ///
    /// # Errors
    /// What the diagnosis refuses.
    pub fn diagnose(&self, without: &[EffectId]) -> Result<Diagnosis, CaseFailure> {
        self.diagnose_with(&Options { without: without.to_vec(), ..Options::default() })
    }

    /// The diagnosis with the whole library, closure and places left out.
    ///
    /// # Errors
    /// What the diagnosis refuses.
    pub fn diagnose_quickly(&self) -> Result<Diagnosis, CaseFailure> {
        self.diagnose_with(&Options { skip_closure: true, skip_where: true, ..Options::default() })
    }

    /// The effect that one would name who knows how the clutter varies.
    ///
    /// # Errors
    /// What the diagnosis refuses.
    pub(crate) fn attainable(&self, clutter: KnownClutter) -> Result<Option<String>, CaseFailure> {
        let records = self.records();
        let found = attainable(&self.input(&records), clutter)?;
        Ok(found.first().map(|(id, _)| id.to_string()))
    }

    fn diagnose_with(&self, options: &Options) -> Result<Diagnosis, CaseFailure> {
        let records = self.records();
        Ok(diagnose(&self.input(&records), options)?)
    }

    /// The same model held against other flights, for the scorer.
    pub(crate) fn against(&self, flights: Vec<ReducedFlight>) -> Self {
        Self { flights, ..self.clone() }
    }

    pub(crate) fn flights(&self) -> &[ReducedFlight] {
        &self.flights
    }

    /// Everything that the model has learnt, ready to predict segments.
    ///
    /// # Errors
    /// [`CaseFailure::Untaught`] for a model that has learnt too little.
    pub(crate) fn whole_model(&self) -> Result<WholeOfType<'_>, CaseFailure> {
        let baseline = self.baseline.as_ref().ok_or(CaseFailure::Untaught)?;
        Ok(WholeOfType { whole: WholeModel::new(&self.model, baseline)?, model: &self.model })
    }

    pub(crate) fn records(&self) -> Vec<FlightRecord<'_>> {
        records(&self.flights)
    }

    pub(crate) fn input<'a>(&'a self, records: &'a [FlightRecord<'a>]) -> Input<'a> {
        Input {
            model: &self.model,
            drag_table: &self.drag_table,
            between_nodes: self.between_nodes,
            flights: records,
            baseline: self.baseline.as_ref(),
            table: self.uncertainty.as_ref(),
            references: self.baseline.as_ref().map(|baseline| *baseline.references()),
            events_s: &[],
        }
    }
}

/// A model with everything that it has learnt.
#[derive(Debug)]
pub(crate) struct WholeOfType<'a> {
    whole: WholeModel<'a>,
    model: &'a ExtendedModel,
}

impl WholeOfType<'_> {
    /// 100·ln of recorded over predicted fuel flow; `None` outside the table.
    pub(crate) fn gap_percent(&self, segment: &Segment) -> Option<f64> {
        ln_gap_of(&self.whole, self.model, segment).map(|gap| 100.0 * gap)
    }
}

/// Law `bayes` on clean flights with its remainder, as `cruisefit adapt` does it.
pub(crate) fn adapted(
    initial: ExtendedModel,
    training_flights: &[ReducedFlight],
    flights: Vec<ReducedFlight>,
) -> Result<DiagnosisInputs, CaseFailure> {
    let law = LawChoice::Bayes(adapt::bayes::BayesSettings::physical_2026());
    let mut learnt = learning::begin(&initial, TAIL, TrimCriteria::PRESETS[0], law)?;
    let mut all = Vec::new();
    for (index, flight) in training_flights.iter().enumerate() {
        let Some(first) = flight.segments.first() else { continue };
        let entry = LedgerEntry {
            tail: TAIL.to_owned(),
            flight: first.identity.flight.clone(),
            start: first.identity.start.to_string(),
            content: format!("flight {index}"),
            samples: flight.samples as u64,
            segments: 0,
            outside_table: 0,
            gauges: flight.gauges,
        };
        let lesson = FlightToLearn { entry, segments: &flight.segments };
        learning::learn_flight(&initial, &mut learnt, &lesson)?;
        all.extend(flight.segments.iter().cloned());
    }
    learning::settle(&mut learnt)?;
    learning::remember_remainder((&initial, None), &mut learnt, &all);
    // A baseline has the table's uncertainty, joint with everything else that it has learnt, against the initial table.
    let uncertainty = match &learnt.law {
        LawState::Bayes { posterior, .. } if learnt.baseline.is_none() => {
            let table = learnt.law.drag_coefficient();
            let records = records(&flights);
            Some(table_uncertainty::of_posterior(posterior, &initial, table, &records)?)
        }
        _ => None,
    };
    Ok(DiagnosisInputs {
        drag_table: match &learnt.baseline {
            Some(_) => initial.drag_table().clone(),
            None => learnt.law.drag_coefficient().clone(),
        },
        between_nodes: BetweenNodes::Straight,
        baseline: learnt.baseline,
        uncertainty,
        model: initial,
        flights,
    })
}
