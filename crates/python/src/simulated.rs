//! Cruise reports of virtual aircraft.

use std::num::NonZeroUsize;

use ::simulate::{Flown, Plan, REPORT_COMMENT, Simulation};
use pyo3::prelude::*;
use rayon::prelude::*;
use report::TextLayout;

use crate::failure::{Failure, chain};
use crate::work::{run, threads_of};

/// The flights of a plan.
#[pyclass(frozen, module = "cruisefit._native", get_all)]
#[derive(Clone, Debug)]
pub(crate) struct Simulated {
    /// Tail, flight and text of every report.
    reports: Vec<(String, String, String)>,
    /// `TRUTH.json`.
    truth: String,
    /// `EVENTS.csv`; without events its header alone.
    events: String,
}

/// Flies every flight of a plan (RON).
#[pyfunction]
pub(crate) fn simulate(
    py: Python<'_>,
    plan: String,
    #[pyo3(from_py_with = threads_of)] threads: Option<NonZeroUsize>,
) -> PyResult<Simulated> {
    run(py, threads, move |caller| {
        let plan = Plan::from_ron(&plan).map_err(|error| Failure::input(chain(&error)))?;
        let simulation = Simulation::new(plan).map_err(|error| Failure::input(chain(&error)))?;
        let flown = (0..simulation.len())
            .into_par_iter()
            .map(|index| {
                caller.still_waits()?;
                let Flown { report, truth, .. } =
                    simulation.fly(index).map_err(|error| Failure::input(chain(&error)))?;
                let text = report::write(&report, &TextLayout::industry(), &[REPORT_COMMENT])
                    .map_err(Failure::internal)?;
                let identity = &report.header().identity;
                Ok(((identity.tail.clone(), identity.flight.clone(), text), truth))
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        let (reports, truths): (Vec<_>, Vec<_>) = flown.into_iter().unzip();
        let mut truth =
            serde_json::to_string_pretty(&simulation.truth(truths)).map_err(Failure::internal)?;
        truth.push('\n');
        let events = ::simulate::events_csv(simulation.events());
        Ok(Simulated { reports, truth, events })
    })
}
