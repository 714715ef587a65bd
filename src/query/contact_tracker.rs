//! Which contacts begin, stay and end from one revision to the next? A value of the caller's that holds those of one
//! revision, and is led on to a later one at the cost of what changed in between.
//!
//! Pairs of which nothing changed are not looked at: they are what they were, by the same proof.

use std::collections::BTreeMap;

use super::answer::{PairAnswer, Refused, Side, Verdict};
use super::changed_pairs::pair_changed;
use super::contacts::{
    ContactChanges, ContactEvent, ContactEventKind, ContactQuestion, ContactState, EndReason, NotAdvanced, PairKey,
    Threshold,
};
use super::declared::{Coverage, declared_empty, effects_of};
use super::pairs::Pairs;
use super::request::{Context, Mode, PairQuery, Wants};
use super::search::{Plan, Search};
use crate::limits::LimitExceeded;
use crate::narrow_phase::Cost;
use crate::scene::{Asker, BodyId, Changes, Effect, Effects, Epoch, NotKept, Revision, Snapshot};

/// The contacts of one revision, which can be led on to later ones.
#[derive(Clone, Debug)]
pub struct ContactTracker {
    question: ContactQuestion,
    at: Option<(Epoch, Revision)>,
    /// Every pair from both its sides: by one body, the others in the order of their ids.
    rows: BTreeMap<BodyId, Vec<(BodyId, ContactState)>>,
    /// If what stays is listed: what is known of each pair.
    answers: BTreeMap<PairKey, PairAnswer>,
    contacts: usize,
    undecided: usize,
}

/// A pair that was measured and is not apart.
struct Measured {
    pair: PairKey,
    state: ContactState,
    answer: PairAnswer,
}

impl ContactTracker {
    /// A tracker of no revision yet: the first it is led to gives every contact as begun.
    #[must_use]
    pub fn new(question: ContactQuestion) -> Self {
        Self { question, at: None, rows: BTreeMap::new(), answers: BTreeMap::new(), contacts: 0, undecided: 0 }
    }

    /// The revision whose contacts are held; none before the first.
    #[must_use]
    pub fn revision(&self) -> Option<Revision> {
        self.at.map(|(_, revision)| revision)
    }

    /// The pairs in contact or undecided, in order.
    pub fn pairs(&self) -> impl Iterator<Item = (BodyId, BodyId, ContactState)> {
        let row = |(a, row): (&BodyId, &Vec<(BodyId, ContactState)>)| {
            let a = *a;
            let first = row.partition_point(|(other, _)| *other < a);
            row[first..].iter().map(move |(b, state)| (a, *b, *state)).collect::<Vec<_>>()
        };
        self.rows.iter().flat_map(row)
    }

    /// Leads on to a later revision of the same epoch, or to the same one. Where the snapshot does not know any more what
    /// changed since the tracker's revision, everything is measured; the events are the same.
    ///
    /// # Errors
    /// [`NotAdvanced`]; then nothing has changed.
    pub fn advance(&mut self, snapshot: &Snapshot, stop: &dyn Fn() -> bool) -> Result<ContactChanges, NotAdvanced> {
        let changes = self.changes(snapshot)?;
        let query = self.query();
        let pairs =
            Pairs::tracked(snapshot, &query, self.question.threshold == Threshold::Touching, self.at.is_none())?;
        let context = &query.context;
        let wanted = effects_of(context.wants, context.margin).and(Effects::of(Effect::Events));
        let empty = declared_empty(snapshot, &Asker::Everybody, context, wanted)?;
        let coverage = Coverage::of(empty, Context::default().max_pairs);
        let plan = pairs.plan(stop);
        let (measured, mut cost) = self.measure(&pairs, &plan, changes.as_ref())?;
        let suspects = self.suspects(snapshot, changes.as_ref());
        let mut events = self.differences(&pairs, measured, &suspects);
        self.check_count(&events)?;
        let told = |event: &&mut ContactEvent| self.question.stays || event.kind != ContactEventKind::Stay;
        for pair in events.iter_mut().filter(told).filter_map(|event| event.pair.as_mut()) {
            plan.derive(std::slice::from_mut(pair), [None; 2], &pairs.stage(0), &mut cost);
        }
        if stop() {
            return Err(NotAdvanced::Stopped);
        }

        let from = self.revision();
        self.at = Some((snapshot.epoch(), snapshot.revision()));
        events.iter().for_each(|event| self.set(event));
        if self.question.stays {
            self.add_untouched(&mut events);
        } else {
            events.retain(|event| event.kind != ContactEventKind::Stay);
        }
        Ok(ContactChanges {
            epoch: snapshot.epoch(),
            from,
            revision: snapshot.revision(),
            events,
            contacts: self.contacts,
            undecided: self.undecided,
            coverage,
            cost,
        })
    }

    /// What changed since the tracker's revision; none where everything has to be measured.
    fn changes(&self, snapshot: &Snapshot) -> Result<Option<Changes>, NotAdvanced> {
        let Some((epoch, revision)) = self.at else { return Ok(None) };
        if snapshot.epoch() != epoch {
            return Err(NotAdvanced::OtherEpoch { asked: snapshot.epoch(), tracked: epoch });
        }
        match snapshot.changes_since(revision) {
            Ok(changes) => Ok(Some(changes)),
            Err(NotKept::Gone { .. }) => Ok(None),
            Err(NotKept::Ahead { .. }) => Err(NotAdvanced::Backwards { asked: snapshot.revision(), tracked: revision }),
        }
    }

    fn query(&self) -> PairQuery {
        let ContactQuestion {
            threshold,
            wants,
            accuracy,
            solver,
            filter,
            stays: _,
            max_patch_points,
            derivatives,
            max_contacts,
        } = &self.question;
        let margin = match threshold {
            Threshold::Touching => 0.0,
            Threshold::Margin(margin) => *margin,
        };
        let context = Context {
            wants: Wants { pairs: true, ..*wants },
            margin,
            // Only what is within the threshold is of interest, and the search reaches as far as margins do.
            cut_off: Some(0.0),
            accuracy: *accuracy,
            solver: *solver,
            filter: filter.clone(),
            max_pairs: *max_contacts,
            max_patch_points: *max_patch_points,
            derivatives: *derivatives,
        };
        PairQuery { items: Vec::new(), mode: Mode::All, context }
    }

    /// Measures the pairs that changed, or all. In the order of the pairs.
    fn measure(
        &self,
        pairs: &Pairs<'_>,
        plan: &Plan,
        changes: Option<&Changes>,
    ) -> Result<(Vec<Measured>, Cost), NotAdvanced> {
        let mut search = Search::new(plan);
        match changes {
            Some(changes) => pairs.changed(changes, &mut search),
            None => pairs.everything(&mut search),
        }
        let found = search.finish(None);
        if (plan.stop)() {
            return Err(NotAdvanced::Stopped);
        }
        if let Some(unclaimed) = found.unclaimed {
            return Err(Refused::Invalid { field: "context.solver".to_owned(), problem: unclaimed.to_string() }.into());
        }
        if found.truncated {
            return Err(self.too_many(self.question.max_contacts.saturating_add(1)));
        }
        let measured = found.pairs.into_iter().filter_map(|answer| {
            let (Side::Body { id: a, .. }, Side::Body { id: b, .. }) = (&answer.a, &answer.b) else { return None };
            Some(Measured { pair: (*a, *b), state: self.state_of(pairs, (*a, *b), &answer), answer })
        });
        let mut measured: Vec<Measured> = measured.collect();
        // Answers are in the order of sides, where a piece of A comes before B.
        measured.sort_by_key(|measured| measured.pair);
        Ok((measured, found.cost))
    }

    /// Of a pair that is not proved free.
    fn state_of(&self, pairs: &Pairs<'_>, (a, b): PairKey, answer: &PairAnswer) -> ContactState {
        match answer.verdict {
            Verdict::Collision | Verdict::Margin => ContactState::Contact,
            Verdict::Free => ContactState::Apart,
            Verdict::Indeterminate(_) | Verdict::NotRun | Verdict::InvalidInput => {
                // Whether it touches may be open while it is proved to be within the margin.
                let bodies = pairs.snapshot().body(a).zip(pairs.snapshot().body(b));
                let margin = bodies.map_or(0.0, |(a, b)| pairs.margin(a, b));
                if answer.bracket.upper <= margin { ContactState::Contact } else { ContactState::Undecided }
            }
        }
    }

    /// The pairs held that may have changed, in order.
    fn suspects(&self, snapshot: &Snapshot, changes: Option<&Changes>) -> Vec<(PairKey, ContactState)> {
        let Some(changes) = changes else {
            return self.pairs().map(|(a, b, state)| ((a, b), state)).collect();
        };
        let named = changes.bodies_of_entries(snapshot);
        let mut suspects = Vec::new();
        for one in changes.bodies().iter().map(|body| body.id).chain(named) {
            let row = self.rows.get(&one).map_or(&[][..], Vec::as_slice);
            let pairs = row.iter().map(|(other, state)| ((one.min(*other), one.max(*other)), *state));
            suspects.extend(pairs.filter(|((a, b), _)| pair_changed(snapshot, changes, *a, *b)));
        }
        suspects.sort_unstable_by_key(|(pair, _)| *pair);
        suspects.dedup_by_key(|(pair, _)| *pair);
        suspects
    }

    /// The pairs that may have changed as they were, beside what was measured of them.
    fn differences(
        &self,
        pairs: &Pairs<'_>,
        measured: Vec<Measured>,
        suspects: &[(PairKey, ContactState)],
    ) -> Vec<ContactEvent> {
        let mut events = Vec::with_capacity(measured.len().max(suspects.len()));
        let mut suspects = suspects.iter().copied().peekable();
        let ended = |(pair, before): (PairKey, ContactState)| ContactEvent {
            reason: Some(end_reason(pairs, pair)),
            ..ContactEvent::of(pair, before, ContactState::Apart)
        };
        for Measured { pair, state, answer } in measured {
            while let Some(suspect) = suspects.next_if(|(suspect, _)| *suspect < pair) {
                events.push(ended(suspect));
            }
            let before =
                suspects.next_if(|(suspect, _)| *suspect == pair).map_or(ContactState::Apart, |(_, state)| state);
            events.push(ContactEvent { pair: Some(answer), ..ContactEvent::of(pair, before, state) });
        }
        events.extend(suspects.map(ended));
        events
    }

    fn check_count(&self, events: &[ContactEvent]) -> Result<(), NotAdvanced> {
        let begun = events.iter().filter(|event| event.before == ContactState::Apart).count();
        let ended = events.iter().filter(|event| event.after == ContactState::Apart).count();
        let held = self.contacts + self.undecided + begun - ended;
        if held > self.question.max_contacts { Err(self.too_many(held)) } else { Ok(()) }
    }

    fn too_many(&self, asked: usize) -> NotAdvanced {
        let allowed = self.question.max_contacts as u64;
        NotAdvanced::TooMany(LimitExceeded { limit: "max_contacts", asked: asked as u64, allowed })
    }

    fn set(&mut self, event: &ContactEvent) {
        let pair @ (a, b) = (event.a, event.b);
        if event.before != event.after {
            self.set_half(a, b, event.after);
            self.set_half(b, a, event.after);
            self.count(event.before, -1);
            self.count(event.after, 1);
        }
        if self.question.stays {
            match &event.pair {
                Some(answer) => drop(self.answers.insert(pair, answer.clone())),
                None => drop(self.answers.remove(&pair)),
            }
        }
    }

    fn count(&mut self, state: ContactState, by: isize) {
        let count = match state {
            ContactState::Apart => return,
            ContactState::Undecided => &mut self.undecided,
            ContactState::Contact => &mut self.contacts,
        };
        *count = count.saturating_add_signed(by);
    }

    fn set_half(&mut self, one: BodyId, other: BodyId, state: ContactState) {
        let row = self.rows.entry(one).or_default();
        match (row.binary_search_by_key(&other, |(id, _)| *id), state) {
            (Ok(place), ContactState::Apart) => drop(row.remove(place)),
            (Ok(place), state) => row[place].1 = state,
            (Err(_), ContactState::Apart) => {}
            (Err(place), state) => row.insert(place, (other, state)),
        }
        if row.is_empty() {
            self.rows.remove(&one);
        }
    }

    /// Adds what stays of the pairs of which nothing changed.
    fn add_untouched(&self, events: &mut Vec<ContactEvent>) {
        let told = events.len();
        for (a, b, state) in self.pairs() {
            if events[..told].binary_search_by_key(&(a, b), |event| (event.a, event.b)).is_err() {
                let answer = self.answers.get(&(a, b)).cloned();
                events.push(ContactEvent { pair: answer, ..ContactEvent::of((a, b), state, state) });
            }
        }
        events.sort_by_key(|event| (event.a, event.b));
    }
}

fn end_reason(pairs: &Pairs<'_>, (a, b): PairKey) -> EndReason {
    let Some((a, b)) = pairs.snapshot().body(a).zip(pairs.snapshot().body(b)) else { return EndReason::Removed };
    if !(a.enabled && b.enabled) {
        return EndReason::Disabled;
    }
    let bounded = a.bounds.is_some() || b.bounds.is_some();
    if bounded && pairs.passes(a) && pairs.passes(b) && pairs.admits(a, b) {
        EndReason::Apart
    } else {
        EndReason::NotAPair
    }
}
