//! One way to ask, seen by the caller who waits: the time from having the states to having the verdicts.

use std::sync::Arc;

use tokio::runtime::Runtime;

use super::super::exit_code::Failed;
use super::workload::Batch;
use crate::query::{Answer, Verdict};
use crate::service::{FEW_ITEMS, Patience, Service, ServiceError, View};

/// Asks, and keeps the last answer.
pub(super) trait Asker {
    /// Asks about all states of a batch.
    fn ask(&mut self, batch: &Batch) -> Result<(), Failed>;

    /// Of the last answer: which states are free, and what came back in bytes.
    fn last(&self) -> Last;
}

/// What the last answer said.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Last {
    /// For each state whether it is free.
    pub free: Vec<bool>,
    /// Bytes that were sent; nothing is, within a process.
    pub sent: usize,
    /// Bytes that came back.
    pub came: usize,
}

/// Without any door: the library within the caller's own process.
#[derive(Debug)]
pub(super) struct InProcess {
    service: Arc<Service>,
    runtime: Runtime,
    free: Vec<bool>,
}

impl InProcess {
    pub fn new(service: &Arc<Service>) -> Result<Self, Failed> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(Failed::failure)?;
        Ok(Self { service: Arc::clone(service), runtime, free: Vec::new() })
    }
}

/// The same work, wherever it is done; small batches where they are asked, as the doors do it.
pub(super) async fn asked(service: &Service, batch: &Batch) -> Result<Answer, ServiceError> {
    let question = Arc::clone(&batch.question);
    let work = move |view: &View| view.check_states(&question);
    if batch.items <= FEW_ITEMS {
        return service.ask_at_once(&batch.target, Patience::default(), work).await;
    }
    service.ask(&batch.target, Patience::default(), work).await
}

impl Asker for InProcess {
    fn ask(&mut self, batch: &Batch) -> Result<(), Failed> {
        let answer = self.runtime.block_on(asked(&self.service, batch)).map_err(Failed::failure)?;
        self.free = answer.items.iter().map(|item| item.verdict == Verdict::Free).collect();
        Ok(())
    }

    fn last(&self) -> Last {
        Last { free: self.free.clone(), ..Last::default() }
    }
}
