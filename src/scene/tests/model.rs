//! A scene as simply as it can be said: vectors that are searched from end to end. It shares no structure with the
//! real one, only the types of edits, and says of every edit whether it can be made.

use std::collections::BTreeSet;

use super::*;

#[derive(Clone, Debug, Default)]
pub(super) struct Model {
    pub(super) bodies: Vec<ModelBody>,
    pub(super) robots: Vec<String>,
    pub(super) allowed: Vec<(Side, Side, bool)>,
    pub(super) margins: Vec<(Side, Side, f64)>,
    pub(super) effects: Vec<(Side, Side, Effects)>,
    given: u64,
}

#[derive(Clone, Debug)]
pub(super) struct ModelBody {
    pub(super) id: u64,
    pub(super) name: String,
    pub(super) pose: Pose,
    pub(super) radius: f64,
    pub(super) groups: BTreeSet<String>,
    pub(super) layers: u32,
    pub(super) mask: u32,
    pub(super) enabled: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Side {
    Body(u64),
    Link(String, u32),
    Group(String),
    Robot(String),
    Everything,
}

/// What a single body or link answers to, from itself to everything, with how far from itself that is.
pub(super) type Answers = Vec<(Side, u32)>;

impl Model {
    /// Makes the edit, or says (`None`) that it cannot be made.
    pub(super) fn apply(&mut self, edit: &Edit) -> Option<()> {
        match edit {
            Edit::AddBody(new) => {
                let radius = inflated(new.scale, new.padding)?;
                self.check_name(&new.name)?;
                self.given += 1;
                self.bodies.push(ModelBody {
                    id: self.given,
                    name: new.name.clone(),
                    pose: new.pose,
                    radius,
                    groups: new.groups.iter().cloned().collect(),
                    layers: new.layers,
                    mask: new.mask,
                    enabled: true,
                });
            }
            Edit::RemoveBody { body } => {
                let gone = self.bodies.remove(self.find(body)?);
                self.forget(|side| *side == Side::Body(gone.id));
            }
            Edit::MoveBody { body, pose } => {
                let place = self.find(body)?;
                self.bodies[place].pose = *pose;
            }
            Edit::ReplaceShape { body, scale, padding, .. } => {
                let place = self.find(body)?;
                self.bodies[place].radius = inflated(*scale, *padding)?;
            }
            // The model's bodies are balls.
            Edit::InsertPoints { .. } | Edit::ClearBox { .. } => return None,
            Edit::SetGroups { body, groups } => {
                let place = self.find(body)?;
                self.bodies[place].groups = groups.iter().cloned().collect();
            }
            Edit::SetLayers { body, layers, mask } => {
                let place = self.find(body)?;
                (self.bodies[place].layers, self.bodies[place].mask) = (*layers, *mask);
            }
            Edit::SetEnabled { body, enabled } => {
                let place = self.find(body)?;
                self.bodies[place].enabled = *enabled;
            }
            Edit::AddRobot { name, .. } => {
                self.check_name(name)?;
                self.robots.push(name.clone());
            }
            Edit::MoveRobot { robot, .. } => self.robots.contains(robot).then_some(())?,
            Edit::RemoveRobot { robot } => {
                let place = self.robots.iter().position(|name| name == robot)?;
                let gone = self.robots.remove(place);
                self.forget(|side| matches!(side, Side::Link(name, _) | Side::Robot(name) if *name == gone));
            }
            Edit::SetAllowedCollision { a, b, allowed } => {
                let (a, b) = self.sides(a, b)?;
                self.allowed.retain(|entry| !is_of(entry, &a, &b));
                self.allowed.extend(allowed.map(|allowed| (a, b, allowed)));
            }
            Edit::SetPairMargin { a, b, margin } => {
                let (a, b) = self.sides(a, b)?;
                if margin.is_some_and(|margin| !(0.0..f64::INFINITY).contains(&margin)) {
                    return None;
                }
                let declared = self.effects.iter().find(|entry| is_of(entry, &a, &b));
                if *margin > Some(0.0) && declared.is_some_and(|(_, _, effects)| !effects.contains(Effect::Margin)) {
                    return None;
                }
                self.margins.retain(|entry| !is_of(entry, &a, &b));
                self.margins.extend(margin.map(|margin| (a, b, margin)));
            }
            Edit::DeclareEffects { a, b, effects } => {
                let (a, b) = self.sides(a, b)?;
                let margin = self.margins.iter().any(|entry| is_of(entry, &a, &b) && entry.2 > 0.0);
                if margin && effects.is_some_and(|effects| !effects.contains(Effect::Margin)) {
                    return None;
                }
                self.effects.retain(|entry| !is_of(entry, &a, &b));
                self.effects.extend(effects.map(|effects| (a, b, effects)));
            }
        }
        Some(())
    }

    pub(super) fn body_answers(body: &ModelBody) -> Answers {
        let groups = body.groups.iter().map(|name| (Side::Group(name.clone()), 1));
        [(Side::Body(body.id), 0)].into_iter().chain(groups).chain([(Side::Everything, 2)]).collect()
    }

    pub(super) fn link_answers(robot: &str, link: u32) -> Answers {
        vec![(Side::Link(robot.to_owned(), link), 0), (Side::Robot(robot.to_owned()), 1), (Side::Everything, 2)]
    }

    pub(super) fn is_allowed(&self, a: &Answers, b: &Answers) -> Option<bool> {
        most_specific(&self.allowed, a, b).into_iter().reduce(|x, y| x && y)
    }

    pub(super) fn margin(&self, a: &Answers, b: &Answers) -> Option<f64> {
        most_specific(&self.margins, a, b).into_iter().reduce(f64::max)
    }

    pub(super) fn declared(&self, a: &Answers, b: &Answers) -> Option<Effects> {
        most_specific(&self.effects, a, b).into_iter().reduce(Effects::and)
    }

    /// Whether an empty declaration takes the pair out.
    pub(super) fn is_empty(&self, a: &Answers, b: &Answers) -> bool {
        self.declared(a, b) == Some(Effects::NONE)
    }

    fn find(&self, body: &BodyRef) -> Option<usize> {
        self.bodies.iter().position(|candidate| match body {
            BodyRef::Id(id) => candidate.id == id.0,
            BodyRef::Name(name) => candidate.name == *name,
        })
    }

    fn check_name(&self, name: &String) -> Option<()> {
        let taken = self.robots.contains(name) || self.bodies.iter().any(|body| body.name == *name);
        (!taken && !name.is_empty()).then_some(())
    }

    fn sides(&self, a: &Party, b: &Party) -> Option<(Side, Side)> {
        let side = |party: &Party| {
            let robot = |name: &String| self.robots.contains(name).then(|| name.clone());
            Some(match party {
                Party::Body(body) => Side::Body(self.bodies[self.find(body)?].id),
                Party::Link { robot: name, link } => {
                    let index = ["base", "upper", "lower"].iter().position(|known| known == link)?;
                    Side::Link(robot(name)?, index as u32)
                }
                Party::Group(name) => Side::Group((!name.is_empty()).then(|| name.clone())?),
                Party::Robot(name) => Side::Robot(robot(name)?),
                Party::Everything => Side::Everything,
            })
        };
        let (a, b) = (side(a)?, side(b)?);
        let with_itself = a == b && matches!(a, Side::Body(_) | Side::Link(..));
        (!with_itself).then_some((a, b))
    }

    fn forget(&mut self, gone: impl Fn(&Side) -> bool) {
        self.allowed.retain(|(a, b, _)| !gone(a) && !gone(b));
        self.margins.retain(|(a, b, _)| !gone(a) && !gone(b));
        self.effects.retain(|(a, b, _)| !gone(a) && !gone(b));
    }
}

/// The radius of a ball of half a metre, scaled and padded.
fn inflated(scale: f64, padding: f64) -> Option<f64> {
    let valid = scale > 0.0 && scale.is_finite() && padding >= 0.0 && padding.is_finite();
    valid.then_some(0.5 * scale + padding)
}

fn is_of<V>((x, y, _): &(Side, Side, V), a: &Side, b: &Side) -> bool {
    (x, y) == (a, b) || (y, x) == (a, b)
}

/// Values of the most specific entries that speak of a pair. Ranks: both single, single and many, single and all, both
/// many, many and all, both all.
fn most_specific<V: Copy>(entries: &[(Side, Side, V)], a: &Answers, b: &Answers) -> Vec<V> {
    let mut found: Vec<(u32, V)> = Vec::new();
    for (side_a, far_a) in a {
        for (side_b, far_b) in b {
            let rank = 3 * far_a.min(far_b) + far_a.max(far_b);
            found.extend(entries.iter().filter(|entry| is_of(entry, side_a, side_b)).map(|entry| (rank, entry.2)));
        }
    }
    let best = found.iter().map(|(rank, _)| *rank).min();
    found.into_iter().filter(|(rank, _)| Some(*rank) == best).map(|(_, value)| value).collect()
}
