//! A small scene that is edited at random, and what its edits changed, kept beside it by simple lists. Bodies touch exactly,
//! overlap, coincide, are flat, thin, huge, far away or without bounds; entries for pairs come and go at every rank.

use std::collections::BTreeSet;
use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::scene::{Body, BodyId, Edit, Epoch, NewBody, Party, Revision, Scene, Snapshot};

/// Numbers of a linear congruential generator, the upper bits.
pub struct Chance(u64);

impl Chance {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1))
    }

    pub fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % n
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }
}

/// What the edits of one list changed.
#[derive(Default)]
struct Step {
    bodies: BTreeSet<BodyId>,
    entries: Vec<(Named, Named)>,
}

/// A side of an entry for pairs.
#[derive(Clone, PartialEq)]
enum Named {
    Body(BodyId),
    Group(&'static str),
    Everything,
}

impl Named {
    fn is_side(&self, body: &Body) -> bool {
        match self {
            Self::Body(id) => body.id == *id,
            Self::Group(group) => body.is_in(group),
            Self::Everything => true,
        }
    }

    fn party(&self) -> Party {
        match self {
            Self::Body(id) => Party::Body((*id).into()),
            Self::Group(group) => Party::Group((*group).to_owned()),
            Self::Everything => Party::Everything,
        }
    }
}

pub struct MovingScene {
    pub scene: Scene,
    chance: Chance,
    /// Element n: what led to revision n + 1.
    steps: Vec<Step>,
    named: usize,
    /// The entries for pairs there are: margins, and allowed collisions as 0 and 1.
    entries: Vec<(bool, Named, Named, f64)>,
}

const GROUPS: [&str; 3] = ["g", "h", "k"];

impl MovingScene {
    pub fn new(seed: u64, snapshots_kept: usize) -> Self {
        let limits = Limits { snapshots_kept, ..Limits::default() };
        let scene = Scene::with_limits(Epoch(3), limits);
        let mut moving = Self { scene, chance: Chance::new(seed), steps: Vec::new(), named: 0, entries: Vec::new() };
        let edits = (0..14).map(|_| moving.addition()).collect::<Vec<_>>();
        moving.apply(&edits, Step::default());
        moving
    }

    pub fn snapshot(&self) -> Arc<Snapshot> {
        self.scene.snapshot()
    }

    /// Whether a side of the pair, or an entry that speaks of it, was changed by an edit after the revision.
    pub fn changed_since(&self, since: Revision, a: &Body, b: &Body) -> bool {
        self.steps[since.0 as usize..].iter().any(|step| {
            let speaks = |(x, y): &(Named, Named)| (x.is_side(a) && y.is_side(b)) || (x.is_side(b) && y.is_side(a));
            step.bodies.contains(&a.id) || step.bodies.contains(&b.id) || step.entries.iter().any(speaks)
        })
    }

    /// One list of edits: mostly short, sometimes empty.
    pub fn step(&mut self) {
        let mut step = Step::default();
        let mut edits = Vec::new();
        let snapshot = self.snapshot();
        let mut left: Vec<Arc<Body>> = snapshot.bodies().cloned().collect();
        for _ in 0..self.chance.below(5) {
            if left.len() < 8 || self.chance.one_in(8) {
                edits.push(self.addition());
                continue;
            }
            // Each body is edited once in a list, so that what is compared is what was there before the list.
            let body = left.swap_remove(self.chance.below(left.len()));
            let edit = self.edit(&body, &left, &mut step);
            edits.push(edit);
        }
        self.apply(&edits, step);
    }

    fn apply(&mut self, edits: &[Edit], mut step: Step) {
        let applied = self.scene.apply(edits, None).unwrap();
        step.bodies.extend(applied.added);
        self.steps.push(step);
        assert_eq!(self.scene.snapshot().validate(), Ok(()));
    }

    fn edit(&mut self, body: &Body, others: &[Arc<Body>], step: &mut Step) -> Edit {
        let id = body.id;
        let kind = self.chance.below(20);
        let (edit, changes) = match kind {
            0..8 => {
                let pose = if self.chance.one_in(8) { body.pose } else { self.pose() };
                (Edit::MoveBody { body: id.into(), pose }, pose != body.pose)
            }
            8 | 9 => {
                let gone = Named::Body(id);
                self.entries.retain(|(_, a, b, _)| *a != gone && *b != gone);
                (Edit::RemoveBody { body: id.into() }, true)
            }
            10 | 11 => {
                let enabled = self.chance.one_in(2);
                (Edit::SetEnabled { body: id.into(), enabled }, enabled != body.enabled)
            }
            12 => {
                let (layers, mask) = (self.layers(), self.layers());
                (Edit::SetLayers { body: id.into(), layers, mask }, (layers, mask) != (body.layers, body.mask))
            }
            13 => {
                let groups = self.groups();
                let changes =
                    *body.groups != groups.iter().map(|name| Arc::from(name.as_str())).collect::<Vec<Arc<str>>>();
                (Edit::SetGroups { body: id.into(), groups }, changes)
            }
            14 | 15 => (Edit::ReplaceShape { body: id.into(), shape: self.shape(), scale: 1.0, padding: 0.0 }, true),
            _ => return self.entry(id, others, step),
        };
        if changes {
            step.bodies.insert(id);
        }
        edit
    }

    /// An entry for pairs that is made, replaced, said again or taken back.
    fn entry(&mut self, id: BodyId, others: &[Arc<Body>], step: &mut Step) -> Edit {
        // Of bodies that no earlier edit of the list has removed.
        let side = |chance: &mut Chance| match chance.below(8) {
            0..4 if !others.is_empty() => Named::Body(others[chance.below(others.len())].id),
            7 => Named::Everything,
            _ => Named::Group(GROUPS[chance.below(3)]),
        };
        let a = if self.chance.one_in(2) { Named::Body(id) } else { side(&mut self.chance) };
        let mut b = side(&mut self.chance);
        if a == b && matches!(a, Named::Body(_)) {
            b = Named::Everything;
        }
        let is_margin = self.chance.one_in(2);
        let value = [None, Some(0.0), Some(1.0)][self.chance.below(3)];
        let is_it = |(margin, x, y, _): &(bool, Named, Named, f64)| {
            *margin == is_margin && ((x, y) == (&a, &b) || (y, x) == (&a, &b))
        };
        let before = self.entries.iter().find(|entry| is_it(entry)).map(|entry| entry.3);
        if before != value {
            step.entries.push((a.clone(), b.clone()));
        }
        self.entries.retain(|entry| !is_it(entry));
        self.entries.extend(value.map(|value| (is_margin, a.clone(), b.clone(), value)));
        let (a, b) = (a.party(), b.party());
        if is_margin {
            return Edit::SetPairMargin { a, b, margin: value.map(|value| 0.25 * value) };
        }
        Edit::SetAllowedCollision { a, b, allowed: value.map(|value| value == 1.0) }
    }

    fn addition(&mut self) -> Edit {
        self.named += 1;
        let mut body = NewBody::new(format!("body {}", self.named), self.shape(), self.pose());
        body.groups = self.groups();
        if self.chance.one_in(4) {
            (body.layers, body.mask) = (self.layers(), self.layers());
        }
        Edit::AddBody(body)
    }

    fn groups(&mut self) -> Vec<String> {
        let group = |(place, name): (usize, &&str)| (self.chance.below(4) == place).then(|| (*name).to_owned());
        GROUPS.iter().enumerate().filter_map(group).collect()
    }

    fn layers(&mut self) -> u32 {
        [u32::MAX, u32::MAX, 1, 3, 2, 0][self.chance.below(6)]
    }

    /// On a lattice where neighbours touch exactly, or anywhere, or very far away.
    fn pose(&mut self) -> Pose {
        let mut along = |step: f64| (self.chance.below(4) as f64) * step;
        let mut place = Vec3::new(along(0.5), along(0.5), along(0.5));
        let rotation = match self.chance.below(6) {
            0 | 1 => Quaternion { w: 0.9, x: 0.1, y: 0.1 * self.chance.below(9) as f64, z: 0.2 },
            2 => Quaternion { w: 1e-160, x: 0.0, y: 0.0, z: 1e-160 },
            _ => Quaternion::IDENTITY,
        };
        match self.chance.below(8) {
            0 | 1 => place += Vec3::new(0.3, 0.1, -0.07) * self.chance.below(5) as f64,
            2 => place += Vec3::new(1e9, -1e9, 0.0),
            // Centres a rational number apart that is no double.
            3 | 4 => place = Vec3::new(along_tenths(&mut self.chance), along_tenths(&mut self.chance), 0.0),
            _ => {}
        }
        Pose::new(place, rotation).unwrap()
    }

    fn shape(&mut self) -> Arc<Shape> {
        Arc::new(match self.chance.below(12) {
            0..3 => Shape::cuboid(Vec3::new(0.25, 0.25, 0.25)).unwrap(),
            3 | 4 => Shape::sphere(0.25).unwrap(),
            5 => Shape::cylinder(0.25, 0.25).unwrap(),
            6 => Shape::cuboid(Vec3::new(0.25, 0.5, 0.0)).unwrap(),
            7 => Shape::cuboid(Vec3::new(1e-9, 1e-9, 2.0)).unwrap(),
            8 => Shape::point(),
            9 => Shape::cuboid(Vec3::new(1e9, 0.1, 0.1)).unwrap(),
            10 => Shape::half_space(Vec3::z(), -0.25).unwrap(),
            _ => Shape::plane(Vec3::x(), 0.25).unwrap(),
        })
    }
}

/// A multiple of 0.1: the distance of two such places is often half a metre but for its last bit.
fn along_tenths(chance: &mut Chance) -> f64 {
    0.1 * chance.below(10) as f64
}
