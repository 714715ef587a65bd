//! Many items on one snapshot: in parts, on any number of threads, with the same answer.

use std::ops::Range;

use super::answer::{Answer, ItemAnswer, Refused, Verdict};
use super::context::length;
use super::declared::{Coverage, declared_empty, effects_of};
#[cfg(feature = "effect-motion")]
use super::motions::Motions;
#[cfg(not(feature = "effect-motion"))]
use super::no_motions::Motions;
use super::overlay::{Asked, Place, field_of};
use super::pairs::Pairs;
use super::request::{CheckMotions, CheckStates, Clearance, ClearanceOf, Context, Mode, PairQuery, Subject};
use super::states::{Scratch, States};
use crate::narrow_phase::Cost;
use crate::scene::{Asker, BodyId, Effect, Effects};

/// A checked request on a snapshot, or on worlds supposed on it. Runs of disjoint ranges may go on at the same time;
/// [`Prepared::join`] puts their parts together in order.
pub struct Prepared<'a> {
    asked: Asked<'a>,
    mode: Mode,
    /// One for each world, the common one first: the same question.
    questions: Vec<Question<'a>>,
    coverage: Coverage,
}

enum Question<'a> {
    States(States<'a>),
    /// In a box, so that what the others take is the same in a build without motions.
    Motions(Box<Motions<'a>>),
    Pairs(Pairs<'a>),
}

/// Asks one item after the other, with memory that is used again.
pub struct OneByOne<'p, 'a> {
    prepared: &'p Prepared<'a>,
    /// Memory of states, of the world that the last item was asked in.
    scratch: Option<(usize, Scratch)>,
}

/// The answers to a range of items.
pub struct Part {
    items: Vec<ItemAnswer>,
    out_of_time: bool,
}

impl<'a> Prepared<'a> {
    /// Is the robot free in these states?
    ///
    /// # Errors
    /// A context that cannot be, a robot that is not in the scene, positions that are no whole number of states.
    pub fn check_states(asked: impl Into<Asked<'a>>, request: &'a CheckStates) -> Result<Self, Refused> {
        let context = &request.context;
        let wanted = effects_of(context.wants, context.margin);
        Self::in_each(asked.into(), request.mode, |world| Ok(Question::States(States::new(world, request)?)))?.of_robot(
            &request.robot,
            context,
            wanted,
        )
    }

    /// Is the robot free all along these motions?
    ///
    /// # Errors
    /// A context, resolution or number of states that cannot be, a robot that is not in the scene or does not move, positions
    /// that are no whole number of motions.
    pub fn check_motions(asked: impl Into<Asked<'a>>, request: &'a CheckMotions) -> Result<Self, Refused> {
        let context = &request.context;
        let wanted = effects_of(context.wants, context.margin).and(Effects::of(Effect::Motion));
        Self::in_each(asked.into(), request.mode, |world| {
            Ok(Question::Motions(Box::new(Motions::new(world, request)?)))
        })?
        .of_robot(&request.robot, context, wanted)
    }

    /// Which pairs touch?
    ///
    /// # Errors
    /// A context that cannot be.
    pub fn collide(asked: impl Into<Asked<'a>>, request: &'a PairQuery) -> Result<Self, Refused> {
        let asked = asked.into();
        let common = Pairs::collide(asked.common().snapshot, request)?;
        let wanted = effects_of(request.context.wants, request.context.margin);
        Self::of_pairs(asked, request, &common)?.of_subjects(request, wanted)
    }

    /// How far is the nearest?
    ///
    /// # Errors
    /// A context that cannot be.
    pub fn distance(asked: impl Into<Asked<'a>>, request: &'a PairQuery) -> Result<Self, Refused> {
        let asked = asked.into();
        let common = Pairs::distance(asked.common().snapshot, request)?;
        Self::of_pairs(asked, request, &common)?.of_subjects(request, with_distance(&request.context))
    }

    /// Which pairs are within a distance?
    ///
    /// # Errors
    /// A distance that is negative or not finite, and what the question about states or subjects refuses.
    pub fn clearance(asked: impl Into<Asked<'a>>, request: &'a Clearance) -> Result<Self, Refused> {
        let asked = asked.into();
        length("within", request.within)?;
        match &request.subjects {
            ClearanceOf::States(states) => Self::in_each(asked, states.mode, |world| {
                Ok(Question::States(States::clearance(world, states, request.within)?))
            })?
            .of_robot(&states.robot, &states.context, with_distance(&states.context)),
            ClearanceOf::Subjects(pairs) => {
                let common = Pairs::clearance(asked.common().snapshot, pairs, request.within)?;
                Self::of_pairs(asked, pairs, &common)?.of_subjects(pairs, with_distance(&pairs.context))
            }
        }
    }

    fn of_pairs(asked: Asked<'a>, request: &PairQuery, common: &Pairs<'a>) -> Result<Self, Refused> {
        Self::in_each(asked, request.mode, |world| {
            world.check_nothing_held()?;
            // The common question once more, as it is cheap, and otherwise the same in another world.
            Ok(Question::Pairs(common.in_world(world)))
        })
    }

    fn in_each(
        asked: Asked<'a>,
        mode: Mode,
        question: impl Fn(Place<'a>) -> Result<Question<'a>, Refused>,
    ) -> Result<Self, Refused> {
        let questions = asked.places().map(question);
        let questions: Vec<Question<'a>> = questions.collect::<Result<_, Refused>>()?;
        for (number, question) in questions.iter().enumerate() {
            if question.width() != questions[0].width() {
                let problem = "puts a robot with other joints in the place of the one that is asked about".to_owned();
                return Err(Refused::Invalid { field: field_of(number), problem });
            }
        }
        asked.check_items(questions[0].len())?;
        Ok(Self { asked, mode, questions, coverage: Coverage::default() })
    }

    /// Checks what the scene, and each world in its place, declares of the robot.
    fn of_robot(self, robot: &str, context: &Context, wanted: Effects) -> Result<Self, Refused> {
        self.covered(context, wanted, |place| Asker::Robot(robot, place.held_bodies()))
    }

    /// The same of the subjects. A bare shape is in no pair of the scene.
    fn of_subjects(self, request: &PairQuery, wanted: Effects) -> Result<Self, Refused> {
        if !self.asked.places().any(|place| place.snapshot.declares_effects()) {
            return Ok(self);
        }
        let everybody = |subject: &Subject| matches!(subject, Subject::All | Subject::ChangedSince(_));
        let bodies: Vec<BodyId> = request.items.iter().filter_map(Subject::body).collect();
        let all = request.items.iter().any(everybody);
        if !all && bodies.is_empty() {
            return Ok(self);
        }
        self.covered(&request.context, wanted, |_| if all { Asker::Everybody } else { Asker::Bodies(&bodies) })
    }

    fn covered<'s>(
        mut self,
        context: &Context,
        wanted: Effects,
        asker: impl Fn(&Place<'a>) -> Asker<'s>,
    ) -> Result<Self, Refused>
    where
        'a: 's,
    {
        let mut empty = Vec::new();
        for place in self.asked.places() {
            empty.extend(declared_empty(place.snapshot, &asker(&place), context, wanted)?);
        }
        self.coverage = Coverage::of(empty, context.max_pairs);
        Ok(self)
    }

    /// Number of items that a thread should take at a time, at least: fewer cost more in handing over than they gain.
    #[must_use]
    pub fn smallest_part(&self) -> usize {
        match self.questions[0] {
            Question::States(_) | Question::Pairs(_) => 8,
            // A motion is the work of tens of states.
            Question::Motions(_) => 1,
        }
    }

    /// Number of items.
    #[must_use]
    pub fn len(&self) -> usize {
        self.questions[0].len()
    }

    /// Joint positions of one state; 0 where nothing moves.
    #[must_use]
    pub fn width(&self) -> usize {
        self.questions[0].width()
    }

    /// Whether there is nothing to answer.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Answers the items of `range`. `stop` is asked before each item, and within long ones; once it says yes, what is
    /// left is not run.
    #[must_use]
    pub fn run(&self, range: Range<usize>, stop: &dyn Fn() -> bool) -> Part {
        let mut items = self.one_by_one();
        self.run_items(range, stop, |i| items.look_at(i, stop))
    }

    /// Asks items in any order, any number of times, each at the price that it has within a batch.
    #[must_use]
    pub fn one_by_one(&self) -> OneByOne<'_, 'a> {
        OneByOne { prepared: self, scratch: None }
    }

    fn run_items(
        &self,
        range: Range<usize>,
        stop: &dyn Fn() -> bool,
        mut answer: impl FnMut(usize) -> ItemAnswer,
    ) -> Part {
        let count = range.len();
        let mut part = Part { items: Vec::with_capacity(count), out_of_time: false };
        for i in range {
            if stop() {
                part.out_of_time = true;
                break;
            }
            let item = answer(i);
            // An item that the clock cut short is no answer: its bracket would depend on the machine's speed.
            if stop() {
                part.out_of_time = true;
                break;
            }
            let stops = self.mode == Mode::StopAtFirst && item.verdict.stops_batch();
            part.items.push(item);
            if stops {
                break;
            }
        }
        part.items.resize(count, ItemAnswer::without_work(Verdict::NotRun));
        part
    }

    /// The answer, from the parts of consecutive ranges that cover all items.
    #[must_use]
    pub fn join(&self, parts: impl IntoIterator<Item = Part>) -> Answer {
        let mut answer = Answer {
            epoch: self.asked.common().snapshot.epoch(),
            revision: self.asked.common().snapshot.revision(),
            items: Vec::with_capacity(self.len()),
            stopped_at: None,
            out_of_time: false,
            coverage: self.coverage.clone(),
            cost: Cost::default(),
        };
        for part in parts {
            // What comes after a gap is not told when the first hit is asked for: an earlier one may be in the gap.
            let after_gap = self.mode == Mode::StopAtFirst && answer.out_of_time;
            answer.out_of_time |= part.out_of_time && answer.stopped_at.is_none();
            for item in part.items {
                if answer.stopped_at.is_some() || after_gap {
                    answer.items.push(ItemAnswer::without_work(Verdict::NotRun));
                    continue;
                }
                if self.mode == Mode::StopAtFirst && item.verdict.stops_batch() {
                    answer.stopped_at = Some(answer.items.len());
                }
                answer.cost += item.cost;
                answer.items.push(item);
            }
        }
        answer
    }

    /// Everything in one go.
    #[must_use]
    pub fn answer(&self, stop: &dyn Fn() -> bool) -> Answer {
        self.join([self.run(0..self.len(), stop)])
    }
}

/// What is wanted of a question that tells distances whether they are wanted or not.
fn with_distance(context: &Context) -> Effects {
    effects_of(context.wants, context.margin).and(Effects::of(Effect::Distance))
}

impl OneByOne<'_, '_> {
    /// The answer to an item; `None` where `stop` cut it short, because that is no answer.
    pub fn answer(&mut self, item: usize, stop: &dyn Fn() -> bool) -> Option<ItemAnswer> {
        if stop() {
            return None;
        }
        let answer = self.look_at(item, stop);
        (!stop()).then_some(answer)
    }

    /// Not within its caller, so that both are compiled alike whether there is code for motions or not.
    #[inline(never)]
    fn look_at(&mut self, item: usize, stop: &dyn Fn() -> bool) -> ItemAnswer {
        let number = self.prepared.asked.number(item);
        match &self.prepared.questions[number] {
            Question::States(states) => {
                let (_, memory) = match self.scratch.take() {
                    Some(of) if matches!(of, (world, _) if world == number) => self.scratch.insert(of),
                    _ => self.scratch.insert((number, states.scratch())),
                };
                states.answer(item, memory, stop)
            }
            Question::Motions(motions) => motions.answer(item, stop),
            Question::Pairs(pairs) => pairs.answer(item, stop),
        }
    }
}

impl Question<'_> {
    fn len(&self) -> usize {
        match self {
            Self::States(states) => states.len(),
            Self::Motions(motions) => motions.len(),
            Self::Pairs(pairs) => pairs.len(),
        }
    }

    /// Joint positions of one state.
    fn width(&self) -> usize {
        match self {
            Self::States(states) => states.width(),
            Self::Motions(motions) => motions.width(),
            Self::Pairs(_) => 0,
        }
    }
}
