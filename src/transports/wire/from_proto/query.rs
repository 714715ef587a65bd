//! Questions: from messages to plain structs. Names of bodies are looked up in the snapshot that is asked.

use std::time::Duration;

use super::derivatives::derivative_goal;
use super::{Path, geometry};
use crate::narrow_phase::Solver;
use crate::query::{CheckStates, Context, Filter, Mode, PairQuery, Subject, Wants, Worlds};
use crate::scene::{BodyId, Epoch, Revision, Snapshot};
use crate::service::{Library, Patience, RevisionRule, Rule, ServiceError, Target};
use crate::transports::wire::v1;

/// How items are answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnswerForm {
    /// One message each.
    Items,
    /// Arrays of verdicts, and of brackets where distances are wanted.
    Bulk {
        /// Distances are wanted.
        brackets: bool,
    },
}

/// Which scene is asked, and in which state.
///
/// # Errors
/// No context.
pub fn target(context: Option<&v1::Context>) -> Result<Target, ServiceError> {
    let context = Path::root("context").required(context)?;
    Ok(Target { scene: context.scene.clone(), revision: revision_rule(context.revision.as_ref()) })
}

/// Which revision may answer.
#[must_use]
pub fn revision_rule(rule: Option<&v1::RevisionRule>) -> RevisionRule {
    let Some(rule) = rule else { return RevisionRule::default() };
    let epoch = rule.epoch.map(Epoch);
    let rule = match rule.rule {
        None | Some(v1::revision_rule::Rule::Latest(v1::Latest {})) => Rule::Latest,
        Some(v1::revision_rule::Rule::Exactly(revision)) => Rule::Exactly(Revision(revision)),
        Some(v1::revision_rule::Rule::AtLeast(revision)) => Rule::AtLeast(Revision(revision)),
    };
    RevisionRule { epoch, rule }
}

/// How long the caller waits: the transport's timeout and the context's budget.
///
/// # Errors
/// A budget that is no length of time.
pub fn patience(timeout: Option<Duration>, context: Option<&v1::Context>) -> Result<Patience, ServiceError> {
    let seconds = context.and_then(|context| context.time_budget);
    let budget = |seconds: f64| {
        let problem = || ServiceError::invalid("context.time_budget", format!("{seconds} is not a number of seconds"));
        Duration::try_from_secs_f64(seconds).map_err(|_| problem())
    };
    Ok(Patience { timeout, time_budget: seconds.map(budget).transpose()? })
}

/// How the items are to be answered.
///
/// # Errors
/// A number that stands for nothing; derivatives in a form that has no room for them.
pub fn answer_form(context: Option<&v1::Context>) -> Result<AnswerForm, ServiceError> {
    let number = context.map_or(0, |context| context.answer_form);
    match v1::AnswerForm::try_from(number) {
        Ok(v1::AnswerForm::Unspecified | v1::AnswerForm::Items) => Ok(AnswerForm::Items),
        Ok(v1::AnswerForm::Bulk) => {
            let wants = context.and_then(|context| context.wants).unwrap_or_default();
            if wants.derivatives {
                let problem = "asks for derivatives, which the bulk form has no columns for";
                return Err(ServiceError::invalid("context.wants", problem));
            }
            Ok(AnswerForm::Bulk { brackets: self::wants(&wants).closed().distance })
        }
        Err(_) => Err(unknown_value(&Path::root("context").field("answer_form"), number)),
    }
}

/// A question about states.
///
/// # Errors
/// A field that cannot be, a body that is not there.
pub fn check_states(request: &v1::CheckStatesRequest, snapshot: &Snapshot) -> Result<CheckStates, ServiceError> {
    Ok(CheckStates {
        robot: request.robot.clone(),
        positions: doubles(&Path::root("positions"), request.positions.as_ref())?,
        mode: mode(request.mode)?,
        context: context(request.context.as_ref(), snapshot)?,
    })
}

/// A question about touching.
///
/// # Errors
/// A field that cannot be, a body or asset that is not there.
pub fn collide(request: &v1::CollideRequest, worlds: &Worlds, library: &Library) -> Result<PairQuery, ServiceError> {
    pair_query(&request.items, request.mode, request.context.as_ref(), worlds, library)
}

/// A question about distance.
///
/// # Errors
/// A field that cannot be, a body or asset that is not there.
pub fn distance(request: &v1::DistanceRequest, worlds: &Worlds, library: &Library) -> Result<PairQuery, ServiceError> {
    pair_query(&request.items, request.mode, request.context.as_ref(), worlds, library)
}

fn pair_query(
    items: &[v1::Subject],
    mode_number: i32,
    context_message: Option<&v1::Context>,
    worlds: &Worlds,
    library: &Library,
) -> Result<PairQuery, ServiceError> {
    Ok(PairQuery {
        items: subjects(items, worlds, library)?,
        mode: mode(mode_number)?,
        context: context(context_message, &worlds.common().snapshot)?,
    })
}

/// What is held against the scene, item by item, each in its own world.
pub(super) fn subjects(
    items: &[v1::Subject],
    worlds: &Worlds,
    library: &Library,
) -> Result<Vec<Subject>, ServiceError> {
    let subject = |(index, item)| subject(&Path::root_item("items", index), item, &worlds.of(index).snapshot, library);
    items.iter().enumerate().map(subject).collect()
}

/// What a question is about.
pub(super) fn subject(
    path: &Path<'_>,
    item: &v1::Subject,
    snapshot: &Snapshot,
    library: &Library,
) -> Result<Subject, ServiceError> {
    match path.required(item.kind.as_ref())? {
        v1::subject::Kind::AllPairs(v1::AllPairs {}) => Ok(Subject::All),
        v1::subject::Kind::ChangedSince(since) => Ok(Subject::ChangedSince(Revision(since.revision))),
        v1::subject::Kind::Body(body) => Ok(Subject::Body(body_id(&path.field("body"), Some(body), snapshot)?)),
        v1::subject::Kind::Shape(placed) => {
            let path = path.field("shape");
            let shape = geometry::shape(&path.field("shape"), placed.shape.as_ref(), library)?;
            Ok(Subject::Shape { shape, pose: geometry::pose(&path.field("pose"), placed.pose.as_ref())? })
        }
    }
}

/// What every question carries; the numbers in it are checked by the query itself.
pub(super) fn context(context: Option<&v1::Context>, snapshot: &Snapshot) -> Result<Context, ServiceError> {
    let path = Path::root("context");
    let context = path.required(context)?;
    let wants = context.wants.unwrap_or_default();
    let defaults = Context::default();
    let mut accuracy = defaults.accuracy;
    if let Some(asked) = context.accuracy {
        (accuracy.absolute, accuracy.relative) = (asked.absolute, asked.relative);
    }
    Ok(Context {
        wants: self::wants(&wants),
        margin: context.margin,
        cut_off: context.cut_off,
        accuracy,
        solver: solver(context.solver)?,
        filter: filter(&path.field("filter"), context.filter.as_ref(), snapshot)?,
        max_pairs: context.max_pairs.map_or(defaults.max_pairs, |pairs| pairs as usize),
        max_patch_points: context.max_patch_points.map_or(defaults.max_patch_points, |points| points as usize),
        derivatives: derivative_goal(&path.field("derivatives"), context.derivatives.as_ref())?,
    })
}

fn wants(wants: &v1::Wants) -> Wants {
    let v1::Wants { distance, witness, depth, pairs, patch, derivatives } = *wants;
    Wants { distance, witness, depth, pairs, patch, derivatives }
}

fn solver(number: i32) -> Result<Solver, ServiceError> {
    match v1::Solver::try_from(number) {
        Ok(v1::Solver::Unspecified | v1::Solver::Default) => Ok(Solver::Default),
        Ok(v1::Solver::FrankWolfe) => Ok(Solver::FrankWolfe),
        Ok(v1::Solver::Gjk) => Ok(Solver::Gjk),
        Ok(v1::Solver::GjkPolyak) => Ok(Solver::GjkPolyak),
        Ok(v1::Solver::GjkNesterov) => Ok(Solver::GjkNesterov),
        Ok(v1::Solver::GjkNesterovNormalised) => Ok(Solver::GjkNesterovNormalised),
        Ok(v1::Solver::Sat) => Ok(Solver::Sat),
        Ok(v1::Solver::Qp) => Ok(Solver::Qp),
        Ok(v1::Solver::Exact) => Ok(Solver::Exact),
        Err(_) => Err(unknown_value(&Path::root("context").field("solver"), number)),
    }
}

fn filter(path: &Path<'_>, filter: Option<&v1::Filter>, snapshot: &Snapshot) -> Result<Filter, ServiceError> {
    let Some(filter) = filter else { return Ok(Filter::default()) };
    let ignored = |(index, body)| body_id(&path.item("ignore", index), Some(body), snapshot);
    Ok(Filter {
        groups: filter.groups.clone(),
        ignore: filter.ignore.iter().enumerate().map(ignored).collect::<Result<_, ServiceError>>()?,
        disregard_allowed_collisions: filter.disregard_allowed_collisions,
        layers: filter.layers,
        mask: filter.mask,
    })
}

/// A body's id; whether it is there, if it came as an id, is for the query to see.
pub(super) fn body_id(
    path: &Path<'_>,
    body: Option<&v1::BodyRef>,
    snapshot: &Snapshot,
) -> Result<BodyId, ServiceError> {
    let by = body.and_then(|body| body.by.as_ref());
    match path.required(by)? {
        v1::body_ref::By::Id(id) => Ok(BodyId(*id)),
        v1::body_ref::By::Name(name) => {
            let missing = || ServiceError::NotFound { what: "body", name: name.clone() };
            Ok(snapshot.body_named(name).ok_or_else(missing)?.id)
        }
    }
}

pub(super) fn doubles(path: &Path<'_>, doubles: Option<&v1::Doubles>) -> Result<Vec<f64>, ServiceError> {
    match path.required(doubles.and_then(|doubles| doubles.form.as_ref()))? {
        v1::doubles::Form::Packed(packed) => Ok(packed.values.clone()),
        v1::doubles::Form::LittleEndian(bytes) => {
            let (numbers, rest) = bytes.as_chunks::<8>();
            if !rest.is_empty() {
                let path = path.field("little_endian");
                return Err(path.invalid(format!("has {} bytes, which is not a multiple of 8", bytes.len())));
            }
            Ok(numbers.iter().map(|number| f64::from_le_bytes(*number)).collect())
        }
    }
}

pub(super) fn mode(number: i32) -> Result<Mode, ServiceError> {
    match v1::Mode::try_from(number) {
        Ok(v1::Mode::Unspecified | v1::Mode::All) => Ok(Mode::All),
        Ok(v1::Mode::StopAtFirst) => Ok(Mode::StopAtFirst),
        Err(_) => Err(unknown_value(&Path::root("mode"), number)),
    }
}

pub(super) fn unknown_value(path: &Path<'_>, number: i32) -> ServiceError {
    path.invalid(format!("has the unknown value {number}"))
}
