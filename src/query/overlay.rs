//! What if? Edits that only a question sees, and bodies that a robot holds: worlds that are asked in the place of the scene.
//!
//! A world is a snapshot that is never published ([`Snapshot::suppose`]), so a question about it is the same question, and
//! its answer is that of a scene in which the same edits were made. Items with the same overlay share a world.

use std::sync::Arc;

use super::answer::Refused;
use crate::geometry::Pose;
use crate::limits::Limits;
use crate::scene::{Body, BodyId, BodyRef, Edit, Reason, Refusal, Snapshot};

/// Changes that only a question sees.
#[derive(Clone, Debug, Default)]
pub struct Overlay {
    /// Made in order, as by `Apply`.
    pub edits: Vec<Edit>,
    /// Bodies that robots hold, once the edits are made.
    pub attached: Vec<Attached>,
}

/// A body that moves with a link of the robot that is asked about, and is not where the scene has it.
#[derive(Clone, Debug)]
pub struct Attached {
    /// Which.
    pub body: BodyRef,
    /// The robot's name in the scene.
    pub robot: String,
    /// The link's name in the robot's description. The body is not held against it.
    pub link: String,
    /// The body's frame in the link's, metres.
    pub body_in_link: Pose,
    /// Names of other links that the body is not held against.
    pub may_touch: Vec<String>,
}

/// The overlays of a question.
#[derive(Clone, Debug, Default)]
pub struct Overlays {
    /// Of every item.
    pub common: Overlay,
    /// Made after the common one, for the items that choose them.
    pub alternatives: Vec<Overlay>,
    /// For each item the number of its alternative, counted from one; 0: none. Empty: no item has one.
    pub of_item: Vec<u32>,
}

/// What is asked in the place of the scene.
#[derive(Clone, Debug)]
pub struct World {
    /// The scene as it would be.
    pub snapshot: Arc<Snapshot>,
    /// The bodies that the overlay added, in the order of its edits; those of the common overlay are not repeated.
    pub added: Vec<BodyId>,
    pub(super) held: Vec<Held>,
}

/// A body that a link holds.
#[derive(Clone, Debug)]
pub(super) struct Held {
    pub body: BodyId,
    robot: String,
    link_name: String,
    pub link: u32,
    pub body_in_link: Pose,
    pub may_touch: Vec<u32>,
}

/// All worlds of a question: at least the one that items without an alternative are asked in.
#[derive(Clone, Debug)]
pub struct Worlds {
    /// The first without an alternative.
    worlds: Vec<World>,
    /// As in [`Overlays`].
    of_item: Vec<u32>,
}

/// Why a world cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotSupposed {
    /// An edit was refused.
    #[error(transparent)]
    Edit(#[from] Refusal),
    /// A body cannot be held.
    #[error("attached[{index}].{field}: {problem}")]
    Attached {
        /// Which, from zero.
        index: usize,
        /// Which field of it.
        field: &'static str,
        /// What is wrong with it.
        problem: String,
    },
    /// A body that the common overlay attaches cannot be held any more.
    #[error("edits: {problem}")]
    HeldBefore {
        /// Why.
        problem: String,
    },
}

impl World {
    /// The scene as it is.
    #[must_use]
    pub fn as_is(snapshot: &Arc<Snapshot>) -> Self {
        Self { snapshot: Arc::clone(snapshot), added: Vec::new(), held: Vec::new() }
    }

    /// This world under an overlay.
    ///
    /// # Errors
    /// An edit that cannot be made, a body or link that is not there, a body without bounds or attached twice.
    pub fn under(&self, overlay: &Overlay, limits: &Limits) -> Result<Self, NotSupposed> {
        let (snapshot, added) = if overlay.edits.is_empty() {
            (Arc::clone(&self.snapshot), Vec::new())
        } else {
            let supposed = self.snapshot.suppose(&overlay.edits, limits)?;
            (Arc::new(supposed.snapshot), supposed.added)
        };
        let mut held = Vec::with_capacity(self.held.len() + overlay.attached.len());
        for before in &self.held {
            let (Some(body), Some(robot)) = (snapshot.body(before.body), snapshot.robot(&before.robot)) else {
                continue; // An edit let the body go, with itself or with the robot.
            };
            if robot.model.link(&before.link_name) != Some(before.link) {
                let problem = format!("the robot {:?} holds the body {:?}, and changed", before.robot, body.name);
                return Err(NotSupposed::HeldBefore { problem });
            }
            check_bounds(body).map_err(|problem| NotSupposed::HeldBefore { problem })?;
            held.push(before.clone());
        }
        for (index, attached) in overlay.attached.iter().enumerate() {
            let one = hold(&snapshot, attached);
            let one = one.map_err(|(field, problem)| NotSupposed::Attached { index, field, problem })?;
            if held.iter().any(|other| other.body == one.body) {
                let problem = "is attached already".to_owned();
                return Err(NotSupposed::Attached { index, field: "body", problem });
            }
            held.push(one);
        }
        Ok(Self { snapshot, added, held })
    }
}

/// A world that a question is prepared for.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub snapshot: &'a Snapshot,
    pub held: &'a [Held],
    /// Its number among the worlds: 0 for the common one.
    pub number: usize,
}

impl Place<'_> {
    /// The bodies that links hold.
    pub fn held_bodies(&self) -> Vec<BodyId> {
        self.held.iter().map(|held| held.body).collect()
    }

    /// For questions that are not about one robot.
    pub fn check_nothing_held(&self) -> Result<(), Refused> {
        if self.held.is_empty() {
            return Ok(());
        }
        Err(self.refused("has no meaning but for the states and motions of a robot".to_owned()))
    }

    /// For questions about one robot.
    pub fn check_held_by(&self, robot: &str) -> Result<(), Refused> {
        let Some(held) = self.held.iter().find(|held| held.robot != robot) else { return Ok(()) };
        Err(self.refused(format!("names the robot {:?}, and the question is about {robot:?}", held.robot)))
    }

    fn refused(&self, problem: String) -> Refused {
        Refused::Invalid { field: format!("{}.attached", field_of(self.number)), problem }
    }
}

/// What a question is prepared on: a snapshot as it is, or worlds supposed on it.
#[derive(Clone, Copy)]
pub struct Asked<'a>(Kind<'a>);

#[derive(Clone, Copy)]
enum Kind<'a> {
    AsIs(&'a Snapshot),
    Supposed(&'a Worlds),
}

impl<'a> From<&'a Snapshot> for Asked<'a> {
    fn from(snapshot: &'a Snapshot) -> Self {
        Self(Kind::AsIs(snapshot))
    }
}

impl<'a> From<&'a Arc<Snapshot>> for Asked<'a> {
    fn from(snapshot: &'a Arc<Snapshot>) -> Self {
        Self(Kind::AsIs(snapshot))
    }
}

impl<'a> From<&'a Worlds> for Asked<'a> {
    fn from(worlds: &'a Worlds) -> Self {
        Self(Kind::Supposed(worlds))
    }
}

impl<'a> Asked<'a> {
    /// Where items without an alternative are asked.
    pub(super) fn common(self) -> Place<'a> {
        self.place(0)
    }

    /// Every world, the common one first.
    pub(super) fn places(self) -> impl Iterator<Item = Place<'a>> {
        let worlds = match self.0 {
            Kind::AsIs(_) => 1,
            Kind::Supposed(worlds) => worlds.worlds.len(),
        };
        (0..worlds).map(move |number| self.place(number))
    }

    fn place(self, number: usize) -> Place<'a> {
        match self.0 {
            Kind::AsIs(snapshot) => Place { snapshot, held: &[], number },
            Kind::Supposed(Worlds { worlds, .. }) => {
                let World { snapshot, held, .. } = &worlds[number];
                Place { snapshot, held, number }
            }
        }
    }

    /// The number of the world of an item.
    pub(super) fn number(self, item: usize) -> usize {
        match self.0 {
            Kind::AsIs(_) => 0,
            Kind::Supposed(worlds) => worlds.number(item),
        }
    }

    /// Whether each item has said which alternative it has, or none has.
    pub(super) fn check_items(self, items: usize) -> Result<(), Refused> {
        match self.0 {
            Kind::AsIs(_) => Ok(()),
            Kind::Supposed(worlds) => worlds.check_items(items),
        }
    }
}

/// The field of a question that has an overlay, by its number.
#[must_use]
pub fn field_of(number: usize) -> String {
    match number.checked_sub(1) {
        None => "context.overlay".to_owned(),
        Some(index) => format!("context.alternatives[{index}]"),
    }
}

impl Worlds {
    /// Without overlays.
    #[must_use]
    pub fn as_is(snapshot: &Arc<Snapshot>) -> Self {
        Self { worlds: vec![World::as_is(snapshot)], of_item: Vec::new() }
    }

    /// Of worlds that were made: first the common one, then those of the alternatives.
    ///
    /// # Errors
    /// An item names an alternative that is not there.
    pub fn new(common: World, alternatives: Vec<World>, of_item: Vec<u32>) -> Result<Self, Refused> {
        if let Some(item) = of_item.iter().position(|number| *number as usize > alternatives.len()) {
            let field = format!("context.item_alternatives[{item}]");
            let problem = format!("is {}, and there are {} alternatives", of_item[item], alternatives.len());
            return Err(Refused::Invalid { field, problem });
        }
        let worlds = std::iter::once(common).chain(alternatives).collect();
        Ok(Self { worlds, of_item })
    }

    /// Those of the chosen items alone, in their order.
    #[must_use]
    pub fn chosen(&self, items: &[usize]) -> Self {
        if self.of_item.is_empty() {
            return Self { worlds: vec![self.worlds[0].clone()], of_item: Vec::new() };
        }
        let mut numbers: Vec<usize> = items.iter().map(|item| self.number(*item)).chain([0]).collect();
        let of_item: Vec<usize> = numbers[..items.len()].to_vec();
        numbers.sort_unstable();
        numbers.dedup();
        let renumbered = |number: usize| numbers.partition_point(|other| *other < number) as u32;
        Self {
            worlds: numbers.iter().map(|number| self.worlds[*number].clone()).collect(),
            of_item: of_item.into_iter().map(renumbered).collect(),
        }
    }

    /// Every world, the common one first.
    #[must_use]
    pub fn all(&self) -> &[World] {
        &self.worlds
    }

    /// The world of items without an alternative, where names in a question's context are looked up.
    #[must_use]
    pub fn common(&self) -> &World {
        &self.worlds[0]
    }

    /// The world that an item is asked in.
    #[must_use]
    pub fn of(&self, item: usize) -> &World {
        &self.worlds[self.number(item)]
    }

    /// The number of the world of an item: 0 for the common one.
    fn number(&self, item: usize) -> usize {
        self.of_item.get(item).map_or(0, |number| *number as usize)
    }

    /// Whether each item has said which alternative it has, or none has.
    fn check_items(&self, items: usize) -> Result<(), Refused> {
        let said = self.of_item.len();
        if said == 0 || said == items {
            return Ok(());
        }
        let problem = format!("has {said} numbers for {items} items");
        Err(Refused::Invalid { field: "context.item_alternatives".to_owned(), problem })
    }
}

fn hold(snapshot: &Snapshot, attached: &Attached) -> Result<Held, (&'static str, String)> {
    let body = match &attached.body {
        BodyRef::Id(id) => snapshot.body(*id).ok_or(Reason::UnknownId { id: *id }),
        BodyRef::Name(name) => snapshot.body_named(name).ok_or_else(|| Reason::UnknownBody { name: name.clone() }),
    };
    let body = body.map_err(|reason| ("body", reason.to_string()))?;
    check_bounds(body).map_err(|problem| ("body", problem))?;
    let robot = snapshot.robot(&attached.robot);
    let unknown = || ("robot", Reason::UnknownRobot { name: attached.robot.clone() }.to_string());
    let robot = robot.ok_or_else(unknown)?;
    let link_of = |field, link: &String| {
        let unknown = || Reason::UnknownLink { robot: attached.robot.clone(), link: link.clone() };
        robot.model.link(link).ok_or_else(|| (field, unknown().to_string()))
    };
    Ok(Held {
        body: body.id,
        robot: attached.robot.clone(),
        link_name: attached.link.clone(),
        link: link_of("link", &attached.link)?,
        body_in_link: attached.body_in_link,
        may_touch: attached.may_touch.iter().map(|link| link_of("may_touch", link)).collect::<Result<_, _>>()?,
    })
}

fn check_bounds(body: &Body) -> Result<(), String> {
    if body.shape.bounds().is_some() || body.shape.is_empty() {
        return Ok(());
    }
    Err(format!("the body {:?} is a {}, which has no bounds and cannot be held", body.name, body.shape.kind()))
}
