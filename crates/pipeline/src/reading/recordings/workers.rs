//! Workers that take tasks as they are free, and results that are used in the order of their tasks.

use std::collections::{BTreeMap, VecDeque};
use std::sync::mpsc::Sender;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Who does a recording's tasks: threads of the caller, as this crate has none.
pub struct Workers<'w> {
    /// How many there are, the caller of [`Spread`] among them.
    pub count: usize,
    /// Has one of them do one task at whatever time; the tasks that none has begun the caller does itself.
    pub call: &'w dyn Fn(),
}

/// Runs the second function here and once, with workers that run the first one (it does a task, where one waits) whenever they are
/// called; comes back when none of them is at work.
pub type Spread<'a> = dyn Fn(&(dyn Fn() + Sync), &mut dyn FnMut(&Workers<'_>)) + 'a;

/// One task after the other, without other workers.
pub fn one_by_one(_: &(dyn Fn() + Sync), run: &mut dyn FnMut(&Workers<'_>)) {
    run(&Workers { count: 1, call: &|| {} });
}

impl std::fmt::Debug for Workers<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Workers").field("count", &self.count).finish_non_exhaustive()
    }
}

/// Tasks that nobody has begun, the oldest first.
pub(super) struct Queue<T>(Mutex<VecDeque<T>>);

impl<T> Default for Queue<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T> Queue<T> {
    pub(super) fn add(&self, task: T) {
        self.tasks().push_back(task);
    }

    pub(super) fn take(&self) -> Option<T> {
        self.tasks().pop_front()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.tasks().is_empty()
    }

    fn tasks(&self) -> MutexGuard<'_, VecDeque<T>> {
        // Nothing that is done while it is locked can panic.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Sends what came of a task when it is dropped: `None` where a panic did, so that nobody waits for the result.
pub(super) struct Delivery<'s, D> {
    sender: &'s Sender<Option<D>>,
    pub(super) done: Option<D>,
}

impl<'s, D> Delivery<'s, D> {
    pub(super) const fn of(sender: &'s Sender<Option<D>>) -> Self {
        Self { sender, done: None }
    }
}

impl<D> Drop for Delivery<'_, D> {
    fn drop(&mut self) {
        // Whoever stopped at a refusal waits for nothing more.
        let _ = self.sender.send(self.done.take());
    }
}

/// Results in the order in which their tasks were numbered.
pub(super) struct InOrder<T> {
    numbered: usize,
    used: usize,
    waiting: BTreeMap<usize, T>,
}

impl<T> Default for InOrder<T> {
    fn default() -> Self {
        Self { numbered: 0, used: 0, waiting: BTreeMap::new() }
    }
}

impl<T> InOrder<T> {
    /// The number of the next task.
    pub(super) const fn number(&mut self) -> usize {
        self.numbered += 1;
        self.numbered - 1
    }

    pub(super) fn put(&mut self, number: usize, result: T) {
        self.waiting.insert(number, result);
    }

    /// The next result, if it has come.
    pub(super) fn next(&mut self) -> Option<T> {
        let next = self.waiting.remove(&self.used)?;
        self.used += 1;
        Some(next)
    }

    /// Tasks whose result was not used yet.
    pub(super) const fn missing(&self) -> usize {
        self.numbered - self.used
    }
}
