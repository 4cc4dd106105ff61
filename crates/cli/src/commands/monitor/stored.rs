//! What `monitor` needs of an output folder of `adapt`: it reads, and writes nothing there.

use std::path::{Path, PathBuf};

use pipeline::monitoring::{BeforeLearning, MonitorOptions, TailDeviations};
use pipeline::segments_table;

use crate::failure::Failure;
use crate::folder::older::known_segments;
use crate::folder::state::{self, State, TailState};
use crate::folder::{deviations_of, is_superseded, warn_of_strangers};
use crate::models::{model_of_bytes, read_model};

/// The tails of a folder.
#[derive(Debug)]
pub(crate) struct Tails {
    folder: PathBuf,
    /// What the folder holds; `None` of a program that kept no state.
    state: Option<State>,
}

/// Where a tail is found.
#[derive(Debug)]
pub(crate) enum Place<'a> {
    /// In the state, by its name.
    State(&'a State, &'a str, &'a TailState),
    /// The model of a folder without a state.
    Model(PathBuf),
}

impl Place<'_> {
    /// The tail, in words.
    pub(crate) fn told(&self) -> String {
        match self {
            Self::State(_, tail, _) => format!("tail {tail}"),
            Self::Model(_) => "this tail".to_owned(),
        }
    }
}

impl Tails {
    /// Looks what a folder holds.
    ///
    /// # Errors
    /// A state that cannot be read.
    pub(crate) fn of(folder: &Path) -> Result<Self, Failure> {
        if folder.is_file() {
            let reason = "it is a file, where a folder of `adapt` was expected";
            return Err(Failure::unreadable(folder, reason));
        }
        let state = state::read(folder)?;
        if let Some(state) = &state {
            warn_of_strangers(folder, state);
        }
        Ok(Self { folder: folder.to_owned(), state })
    }

    /// The folder.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Whether the folder holds something newer by now: files may have gone while they were read.
    pub(crate) fn is_out_of_date(&self) -> bool {
        match &self.state {
            Some(state) => is_superseded(&self.folder, state),
            None => self.folder.join(state::NAME).exists(),
        }
    }

    /// The tails, in order.
    ///
    /// # Errors
    /// A folder that cannot be read or holds no tail.
    pub(crate) fn places(&self) -> Result<Vec<Place<'_>>, Failure> {
        let places: Vec<Place<'_>> = match &self.state {
            Some(state) => {
                state.tails.iter().map(|(tail, entry)| Place::State(state, tail, entry)).collect()
            }
            None => models_below(&self.folder)?.into_iter().map(Place::Model).collect(),
        };
        if places.is_empty() {
            let reason = match &self.state {
                Some(_) => {
                    "the folder of `cruisefit adapt` holds no tail: none has learnt a flight, or all were forgotten"
                }
                None => "found no model in models/, expected a folder that `cruisefit adapt` wrote",
            };
            return Err(Failure::bad_file(&self.folder, reason));
        }
        Ok(places)
    }

    /// A tail's name and what its flights show.
    ///
    /// # Errors
    /// A file that cannot be read or was damaged.
    pub(crate) fn deviations(
        &self,
        place: &Place<'_>,
        options: &MonitorOptions,
    ) -> Result<(String, TailDeviations), Failure> {
        match place {
            Place::State(state, tail, entry) => {
                Ok(((*tail).to_owned(), self.of_state(state, entry, options)?))
            }
            Place::Model(path) => of_model(&self.folder, path, options),
        }
    }

    fn of_state(
        &self,
        state: &State,
        entry: &TailState,
        options: &MonitorOptions,
    ) -> Result<TailDeviations, Failure> {
        if let Some(of) = &entry.deviations {
            match deviations_of(state, &self.folder, of) {
                Ok(mut flights) => {
                    if options.before_learning == BeforeLearning::LeaveOut {
                        for flight in &mut flights {
                            flight.before_learning = None;
                        }
                    }
                    return Ok(TailDeviations::of_flights(&of.aircraft_type, &of.model, flights)
                        .since(options.since));
                }
                Err(failure) if self.is_out_of_date() => return Err(failure),
                // All that it holds follows from model and segments, more slowly.
                Err(failure) => tracing::warn!("{failure}; model and segments are read instead"),
            }
        }
        let path = self.folder.join(&entry.model.file);
        let model = model_of_bytes(&path, &state::bytes_of(state, &self.folder, &entry.model)?)?;
        let table = self.folder.join(&entry.segments.file);
        let bytes = state::bytes_of(state, &self.folder, &entry.segments)?;
        let segments =
            segments_table::read(&bytes).map_err(|error| Failure::bad_file(&table, error))?;
        TailDeviations::new(&model, &segments, options.before_learning)
            .map(|deviations| deviations.since(options.since))
            .map_err(|error| Failure::bad_file(&path, error))
    }
}

/// The model files of a folder without a state, in order.
fn models_below(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let models = folder.join("models");
    let mut paths = Vec::new();
    // A folder without `models/` is one that another command wrote.
    if models.is_dir() || !folder.is_dir() {
        let entries =
            std::fs::read_dir(&models).map_err(|error| Failure::unreadable(&models, error))?;
        for entry in entries {
            let path = entry.map_err(|error| Failure::unreadable(&models, error))?.path();
            if path.extension().is_some_and(|ending| ending == "ron") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    Ok(paths)
}

/// A tail of a folder without a state.
fn of_model(
    folder: &Path,
    path: &Path,
    options: &MonitorOptions,
) -> Result<(String, TailDeviations), Failure> {
    let model = read_model(path)?;
    let Some(learnt) = &model.learnt else {
        return Err(Failure::bad_file(path, "a model that has learnt nothing"));
    };
    let tail = learnt.tail.clone();
    let segments = known_segments(folder, learnt)?;
    let deviations = TailDeviations::new(&model, &segments, options.before_learning)
        .map_err(|error| Failure::bad_file(path, error))?;
    Ok((tail, deviations.since(options.since)))
}
