//! What a folder knows of a tail, and which of a run's reports it does not know.

use std::path::Path;

use pipeline::adaptation::{Start, StoredTail};
use pipeline::known_flights::KnownFlights;
use pipeline::learning::FlightKey;
use pipeline::learnt_flights::KnownFlight;
use pipeline::model_file::ModelFile;

use crate::commands::adapt::{MORE_THAN_TABLE, Run};
use crate::failure::{Failure, RefusedReport, show};
use crate::folder::Salvage;
use crate::reading::Buffers;
use crate::reading::heads::Head;

/// What a folder knows of a tail, and the reports of a run that it does not know.
#[derive(Default)]
pub(super) struct Known {
    pub(super) flights: Vec<KnownFlight>,
    /// Flights whose reports are at hand as they were learnt.
    pub(super) learnt_before: Vec<FlightKey>,
    /// Reports of flights that are not known.
    pub(super) new: Vec<Head>,
    /// Copies of these.
    pub(super) copies: Vec<CopyOf>,
    pub(super) refused: Vec<RefusedReport>,
    /// The tail as it is stored, where there is something new.
    pub(super) stored: Option<StoredTail>,
}

impl Run<'_> {
    /// What the folder knows of a tail, and which reports are of flights that it does not know.
    pub(super) fn known(
        &self,
        tail: &str,
        heads: Vec<Head>,
        buffers: &mut Buffers,
    ) -> Result<Known, Failure> {
        let flights = self.folder.flights(tail)?;
        let (new, refused, learnt_before) = unknown(heads, &flights, buffers);
        let (new, copies) = without_copies(new, buffers);
        // Where flights may be learnt anew, damage is looked for without a new one too.
        let is_read = !new.is_empty() || self.arguments.relearn;
        let is_held = self.folder.holds(tail) && is_read;
        let stored = is_held.then(|| self.folder.load(tail)).transpose()?;
        Ok(Known { flights, learnt_before, new, copies, refused, stored })
    }

    /// A tail that is damaged, to be learnt anew from all of its reports where that is asked for and it was begun with the same;
    /// `None` otherwise.
    ///
    /// # Errors
    /// A file that cannot be read, or a setting that would drop what was learnt.
    pub(super) fn anew(
        &self,
        tail: &str,
        start: &Start<'_>,
        heads: Option<Vec<Head>>,
        buffers: &mut Buffers,
    ) -> Result<Option<(Known, Salvage)>, Failure> {
        let Some(heads) = heads
            .filter(|_| self.folder.state_of(tail).is_some_and(|state| state.begun == start.begun))
        else {
            return Ok(None);
        };
        let Some(left) = self.folder.salvage(tail)? else { return Ok(None) };
        self.keeps_remainder(left.model.as_ref())?;
        let (mut new, copies) = without_copies(heads, buffers);
        // Of versions of one flight that which was learnt comes first, and the others are refused for it.
        new.sort_by_cached_key(|head| {
            let flight = (head.start, head.flight.to_string());
            let content = match &head.read {
                Some(read) => Some(read.content.clone()),
                None => buffers.content_of(&head.path).ok(),
            };
            let is_other = content.is_some_and(|content| left.is_other_version(&flight, &content));
            (flight, is_other)
        });
        Ok(Some((Known { new, copies, ..Known::default() }, left)))
    }

    /// A tail does not lose what it has learnt beyond its table.
    ///
    /// # Errors
    /// A setting by which it would.
    pub(super) fn keeps_remainder(&self, stored: Option<&ModelFile>) -> Result<(), Failure> {
        let has_one = stored.is_some_and(ModelFile::has_whole_model);
        if self.arguments.no_remainder && has_one {
            return Err(Failure::BegunOtherwise {
                folder: show(&self.arguments.output),
                what: "setting",
                difference: MORE_THAN_TABLE.to_owned(),
            });
        }
        Ok(())
    }
}

/// Reports of flights that are not known, or known with other content; and the flights that are known, by START and name.
fn unknown(
    heads: Vec<Head>,
    known: &[KnownFlight],
    buffers: &mut Buffers,
) -> (Vec<Head>, Vec<RefusedReport>, Vec<FlightKey>) {
    if known.is_empty() {
        return (heads, Vec::new(), Vec::new());
    }
    let known = KnownFlights::new(known.to_vec());
    let mut new = Vec::new();
    let mut refused = Vec::new();
    let mut learnt_before = Vec::new();
    for head in heads {
        let Some(flight) = known.find(head.start, &head.flight) else {
            new.push(head);
            continue;
        };
        let same = match &head.read {
            Some(read) => Ok(read.has_content(&flight.entry.content)),
            None => buffers.content_of(&head.path).map(|content| content == flight.entry.content),
        };
        match same {
            Ok(true) => learnt_before.push((head.start, head.flight.into())),
            Ok(false) => new.push(head),
            Err(refusal) => refused.push(refusal),
        }
    }
    (new, refused, learnt_before)
}

/// A report that holds what another report of the batch holds, and that other report.
pub(super) type CopyOf = (Box<Path>, Box<Path>);

/// Reports without those that are byte for byte another one's copies: however many there are, each flight is read once.
/// What cannot be read stays, and is refused where it is read.
pub(super) fn without_copies(heads: Vec<Head>, buffers: &mut Buffers) -> (Vec<Head>, Vec<CopyOf>) {
    let is_one_flight =
        |one: &Head, other: &Head| one.start == other.start && one.flight == other.flight;
    let mut copies = Vec::new();
    let mut is_copy = Vec::with_capacity(heads.len());
    for of_flight in heads.chunk_by(is_one_flight) {
        let mut contents: Vec<(String, &Path)> = Vec::new();
        for head in of_flight {
            let of_file = of_flight.len() > 1 && head.read.is_none();
            let content = of_file.then(|| buffers.content_of(&head.path).ok()).flatten();
            let original = contents.iter().find(|(known, _)| Some(known) == content.as_ref());
            is_copy.push(original.is_some());
            if let Some((_, original)) = original {
                copies.push((head.path.clone(), Box::from(*original)));
            } else if let Some(content) = content {
                contents.push((content, &head.path));
            }
        }
    }
    let kept = heads.into_iter().zip(is_copy).filter(|(_, is_copy)| !is_copy);
    (kept.map(|(head, _)| head).collect(), copies)
}
