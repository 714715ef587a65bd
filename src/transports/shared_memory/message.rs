//! How does a client ask? A question as the message of a request.

use std::time::Duration;

use super::codes;
use super::layout::{ABI_HASH, MAGIC, RequestHeader, VERSION, kind};
use super::request::{ClientId, Nonce, flag, question_number};
use super::sections::Writer;
use super::subjects::{shape_kind, subject_kind};
use crate::geometry::Pose;
use crate::query::{CastRays, CheckMotions, CheckStates, Context, Filter, Motions};
use crate::service::{Rule, Target};

/// A shape as the columns have it: its kind, three numbers and the swept radius, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainShape {
    kind: u8,
    parameters: [f64; 4],
}

impl PlainShape {
    /// A ball.
    #[must_use]
    pub fn sphere(radius: f64) -> Self {
        Self { kind: shape_kind::SPHERE, parameters: [radius, 0.0, 0.0, 0.0] }
    }

    /// A box.
    #[must_use]
    pub fn cuboid([x, y, z]: [f64; 3]) -> Self {
        Self { kind: shape_kind::BOX, parameters: [x, y, z, 0.0] }
    }

    /// A capsule along z.
    #[must_use]
    pub fn capsule(radius: f64, half_length: f64) -> Self {
        Self { kind: shape_kind::CAPSULE, parameters: [radius, half_length, 0.0, 0.0] }
    }

    /// A cylinder along z.
    #[must_use]
    pub fn cylinder(radius: f64, half_length: f64) -> Self {
        Self { kind: shape_kind::CYLINDER, parameters: [radius, half_length, 0.0, 0.0] }
    }

    /// A cone along z.
    #[must_use]
    pub fn cone(radius: f64, half_length: f64) -> Self {
        Self { kind: shape_kind::CONE, parameters: [radius, half_length, 0.0, 0.0] }
    }

    /// An ellipsoid.
    #[must_use]
    pub fn ellipsoid([x, y, z]: [f64; 3]) -> Self {
        Self { kind: shape_kind::ELLIPSOID, parameters: [x, y, z, 0.0] }
    }

    /// A point.
    #[must_use]
    pub fn point() -> Self {
        Self { kind: shape_kind::POINT, parameters: [0.0; 4] }
    }

    /// The same, grown by a ball of this radius, metres.
    #[must_use]
    pub fn swept(self, radius: f64) -> Self {
        let [a, b, c, _] = self.parameters;
        Self { parameters: [a, b, c, radius], ..self }
    }
}

/// What is held against the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlainSubject {
    /// Every pair of bodies.
    All,
    /// One body, by its id, against the others.
    Body(u64),
    /// A shape that is not in the scene.
    Shape(PlainShape, Pose),
    /// Every pair that changed after a revision.
    ChangedSince(u64),
    /// The shape of a body, by its id, at another pose. The body itself is met unless the filter ignores it.
    ShapeOfBody(u64, Pose),
}

/// A question as a client asks it.
#[derive(Clone, Copy, Debug)]
pub enum Ask<'a> {
    /// Are these states free? `width` numbers each.
    States(&'a CheckStates, usize),
    /// Are these motions free? `width` numbers for each position vector.
    Motions(&'a CheckMotions, usize),
    /// What touches these subjects?
    Collide(&'a [PlainSubject], &'a Context),
    /// How far is the nearest from these subjects?
    Distance(&'a [PlainSubject], &'a Context),
    /// What do these rays meet?
    Rays(&'a CastRays),
}

/// The message of a request that calls an rpc by its name, `SERVICE/METHOD`, with the bytes of its request message.
#[must_use]
pub fn call_message(envelope: &Envelope<'_>, rpc: &str, message: &[u8]) -> Vec<u8> {
    let mut writer = Writer::new(RequestHeader::BYTES, 2);
    writer.text(kind::RPC, rpc);
    writer.bytes(kind::MESSAGE, message.iter().copied());
    let header = RequestHeader { question: question_number::CALL, ..frame(envelope) };
    writer.finish(|sections, total_bytes, bytes| RequestHeader { sections, total_bytes, ..header }.write(bytes))
}

/// What a request says beside its question.
#[derive(Clone, Debug)]
pub struct Envelope<'a> {
    /// The scene and its state.
    pub target: &'a Target,
    /// How long the client listens; none: as long as the daemon allows.
    pub timeout: Option<Duration>,
    /// When the client wants what is there.
    pub time_budget: Option<Duration>,
    /// Whether the sides of the nearest pair are told.
    pub wants_sides: bool,
    /// Random.
    pub nonce: Nonce,
    /// What the client's listener is called.
    pub client: ClientId,
}

/// Sections that a request may have.
const ROOM: usize = 13;

/// The message of a request.
#[must_use]
pub fn request_message(envelope: &Envelope<'_>, ask: Ask<'_>) -> Vec<u8> {
    request_message_in(Vec::new(), envelope, ask)
}

/// The same in memory that was used before.
pub(super) fn request_message_in(memory: Vec<u8>, envelope: &Envelope<'_>, ask: Ask<'_>) -> Vec<u8> {
    let mut writer = Writer::within(memory, RequestHeader::BYTES, ROOM);
    writer.text(kind::SCENE, &envelope.target.scene);
    let mut header = frame(envelope);
    match ask {
        Ask::States(question, width) => {
            header.question = question_number::STATES;
            header.mode = codes::mode_number(question.mode);
            rows_of(&mut header, &mut writer, (&question.robot, &question.positions), width, width);
            with_context(&mut header, &mut writer, &question.context);
        }
        Ask::Motions(question, width) => {
            let (number, vectors) = match question.motions {
                Motions::Edges => (question_number::MOTIONS, 2),
                Motions::Path => (question_number::PATH, 1),
            };
            header.question = number;
            header.mode = codes::mode_number(question.mode);
            header.find = codes::find_number(question.find);
            header.resolution = question.resolution;
            header.max_states = u32::try_from(question.max_states).unwrap_or(u32::MAX);
            header.flags |= flag::RESOLUTION | flag::MAX_STATES;
            rows_of(&mut header, &mut writer, (&question.robot, &question.positions), width, width * vectors);
            with_context(&mut header, &mut writer, &question.context);
        }
        Ask::Collide(items, context) | Ask::Distance(items, context) => {
            let collide = matches!(ask, Ask::Collide(..));
            header.question = if collide { question_number::COLLIDE } else { question_number::DISTANCE };
            header.items = items.len() as u32;
            subjects(&mut writer, items);
            with_context(&mut header, &mut writer, context);
        }
        Ask::Rays(rays) => {
            header.question = question_number::RAYS;
            header.mode = codes::cast_mode_number(rays.mode);
            header.items = (rays.origins.len() / 3) as u32;
            writer.doubles(kind::ORIGINS, 3, &rays.origins);
            writer.doubles(kind::DIRECTIONS, 3, &rays.directions);
            writer.doubles(kind::LENGTHS, 1, &rays.lengths);
            with_context(&mut header, &mut writer, &rays.context);
        }
    }
    writer.finish(|sections, total_bytes, bytes| RequestHeader { sections, total_bytes, ..header }.write(bytes))
}

fn frame(envelope: &Envelope<'_>) -> RequestHeader {
    let nanoseconds = |time: Duration| u64::try_from(time.as_nanos()).unwrap_or(u64::MAX);
    let rule = envelope.target.revision;
    let (revision_rule, revision) = match rule.rule {
        Rule::Latest => (0, 0),
        Rule::Exactly(revision) => (1, revision.0),
        Rule::AtLeast(revision) => (2, revision.0),
    };
    let given = |is_given, flag| if is_given { flag } else { 0 };
    RequestHeader {
        magic: MAGIC,
        abi_hash: ABI_HASH,
        version: VERSION,
        nonce: envelope.nonce,
        client: envelope.client,
        flags: given(rule.epoch.is_some(), flag::EPOCH) | given(envelope.time_budget.is_some(), flag::TIME_BUDGET),
        revision_rule,
        wants: given(envelope.wants_sides, codes::WANTS_SIDES),
        epoch: rule.epoch.map_or(0, |epoch| epoch.0),
        revision,
        // Zero would mean no timeout; a caller without any time is told so.
        timeout_ns: envelope.timeout.map_or(0, |time| nanoseconds(time).max(1)),
        time_budget_ns: envelope.time_budget.map_or(0, nanoseconds),
        ..RequestHeader::default()
    }
}

fn with_context(header: &mut RequestHeader, writer: &mut Writer, context: &Context) {
    header.wants |= codes::wants_bits(context.wants);
    header.margin = context.margin;
    header.cut_off = context.cut_off.unwrap_or(0.0);
    (header.accuracy_absolute, header.accuracy_relative) = (context.accuracy.absolute, context.accuracy.relative);
    header.solver = codes::solver_number(context.solver);
    header.max_pairs = u32::try_from(context.max_pairs).unwrap_or(u32::MAX);
    let Filter { groups, ignore, disregard_allowed_collisions, layers, mask } = &context.filter;
    (header.layers, header.mask) = (layers.unwrap_or(0), mask.unwrap_or(0));
    header.flags |= flag::ACCURACY | flag::MAX_PAIRS;
    let optional = [
        (context.cut_off.is_some(), flag::CUT_OFF),
        (layers.is_some(), flag::LAYERS),
        (mask.is_some(), flag::MASK),
        (*disregard_allowed_collisions, flag::DISREGARD_ALLOWED),
    ];
    header.flags |= optional.iter().filter(|(is_given, _)| *is_given).map(|(_, flag)| flag).sum::<u32>();
    if !groups.is_empty() {
        writer.texts(kind::GROUPS, groups.iter().map(String::as_str));
    }
    if !ignore.is_empty() {
        writer.integers(kind::IGNORE, ignore.iter().map(|id| id.0));
    }
}

/// The robot and its positions, `row` numbers an item.
fn rows_of(
    header: &mut RequestHeader,
    writer: &mut Writer,
    (robot, positions): (&str, &[f64]),
    width: usize,
    row: usize,
) {
    // A robot without joints has rows without numbers, which columns cannot have; the daemon refuses the stride.
    header.items = if width == 0 { 0 } else { (positions.len() / row) as u32 };
    writer.text(kind::ROBOT, robot);
    writer.doubles(kind::POSITIONS, row, positions);
}

fn subjects(writer: &mut Writer, items: &[PlainSubject]) {
    let kinds = items.iter().map(|item| match item {
        PlainSubject::All => subject_kind::ALL,
        PlainSubject::Body(_) => subject_kind::BODY,
        PlainSubject::Shape(..) => subject_kind::SHAPE,
        PlainSubject::ChangedSince(_) => subject_kind::CHANGED_SINCE,
        PlainSubject::ShapeOfBody(..) => subject_kind::SHAPE_OF_BODY,
    });
    let ids = items.iter().map(|item| match item {
        PlainSubject::Body(id) | PlainSubject::ChangedSince(id) | PlainSubject::ShapeOfBody(id, _) => *id,
        PlainSubject::All | PlainSubject::Shape(..) => 0,
    });
    let pose = |item: &PlainSubject| match item {
        PlainSubject::Shape(_, pose) | PlainSubject::ShapeOfBody(_, pose) => Some(*pose),
        PlainSubject::All | PlainSubject::Body(_) | PlainSubject::ChangedSince(_) => None,
    };
    let shape = |item: &PlainSubject| match item {
        PlainSubject::Shape(shape, _) => Some(*shape),
        PlainSubject::All | PlainSubject::Body(_) | PlainSubject::ChangedSince(_) | PlainSubject::ShapeOfBody(..) => {
            None
        }
    };
    writer.bytes(kind::SUBJECT_KINDS, kinds);
    writer.integers(kind::SUBJECT_IDS, ids);
    writer.doubles_of(
        kind::POSES,
        7,
        items.iter().flat_map(|item| pose_row(pose(item).unwrap_or_else(Pose::identity))),
    );
    if items.iter().any(|item| shape(item).is_some()) {
        writer.bytes(kind::SHAPE_KINDS, items.iter().map(|item| shape(item).map_or(0, |shape| shape.kind)));
        let parameters = items.iter().flat_map(|item| shape(item).map_or([0.0; 4], |shape| shape.parameters));
        writer.doubles_of(kind::SHAPE_PARAMETERS, 4, parameters);
    }
}

/// Translation and quaternion, w first.
fn pose_row(pose: Pose) -> [f64; 7] {
    let (t, q) = (pose.translation(), pose.rotation());
    [t.x, t.y, t.z, q.w, q.x, q.y, q.z]
}

#[cfg(test)]
mod tests {
    use prost::bytes::Bytes;

    use super::*;
    use crate::geometry::Shape;
    use crate::limits::Limits;
    use crate::query::{CastMode, Find, Mode, Subject, Wants};
    use crate::scene::{BodyId, Epoch, Revision};
    use crate::service::RevisionRule;
    use crate::transports::shared_memory::request::{Called, Question, Received, Request, decode};
    use crate::transports::shared_memory::subjects::Asked;

    fn context() -> Context {
        Context {
            wants: Wants { patch: false, derivatives: false, ..Wants::ALL },
            margin: 0.25,
            cut_off: Some(2.0),
            filter: Filter {
                groups: vec!["tools".to_owned(), "walls".to_owned()],
                ignore: vec![BodyId(7), BodyId(9)],
                disregard_allowed_collisions: true,
                layers: Some(3),
                mask: None,
            },
            max_pairs: 5,
            ..Context::default()
        }
    }

    fn states() -> CheckStates {
        let positions = vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
        CheckStates { robot: "arm".to_owned(), positions, mode: Mode::StopAtFirst, context: context() }
    }

    fn motions(motions: Motions) -> CheckMotions {
        CheckMotions {
            robot: "arm".to_owned(),
            positions: vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8],
            motions,
            mode: Mode::All,
            find: Find::AnyContact,
            resolution: 0.01,
            max_states: 99,
            context: context(),
        }
    }

    fn rays() -> CastRays {
        CastRays {
            origins: vec![0.0; 6],
            directions: vec![1.0; 6],
            lengths: vec![4.0],
            mode: CastMode::Any,
            context: context(),
        }
    }

    fn subjects() -> Vec<PlainSubject> {
        vec![
            PlainSubject::All,
            PlainSubject::Body(4),
            PlainSubject::Shape(PlainShape::capsule(0.1, 0.2).swept(0.05), Pose::identity()),
            PlainSubject::ChangedSince(3),
            PlainSubject::ShapeOfBody(5, Pose::identity()),
        ]
    }

    fn written(ask: Ask<'_>) -> Vec<u8> {
        let revision = RevisionRule { epoch: Some(Epoch(8)), rule: Rule::AtLeast(Revision(6)) };
        let target = Target { scene: "cell".to_owned(), revision };
        let (timeout, time_budget) = (Some(Duration::from_millis(20)), Some(Duration::from_millis(10)));
        let (nonce, client) = ([1; 16], [2; 16]);
        request_message(&Envelope { target: &target, timeout, time_budget, wants_sides: true, nonce, client }, ask)
    }

    fn read(message: &[u8]) -> Request {
        match received(message) {
            Received::Asked(request) => *request,
            other @ Received::Called(_) => panic!("{other:?}"),
        }
    }

    fn received(message: &[u8]) -> Received {
        decode(message, &Limits::default()).unwrap()
    }

    fn calling(rpc: &str, message: &[u8]) -> Vec<u8> {
        let (target, timeout) = (Target::default(), Some(Duration::from_millis(20)));
        let (nonce, client) = ([1; 16], [2; 16]);
        let envelope = Envelope { target: &target, timeout, time_budget: None, wants_sides: false, nonce, client };
        call_message(&envelope, rpc, message)
    }

    #[test]
    fn the_daemon_reads_what_rpc_the_client_calls() {
        for message in [b"some bytes".as_slice(), b""] {
            let called = Called {
                rpc: "Queries/Collide".to_owned(),
                message: Bytes::copy_from_slice(message),
                timeout: Some(Duration::from_millis(20)),
            };
            assert!(matches!(received(&calling("Queries/Collide", message)), Received::Called(read) if read == called));
        }
    }

    #[test]
    fn the_daemon_reads_what_the_client_asks() {
        let request = read(&written(Ask::States(&states(), 2)));
        assert_eq!((request.items, request.wants_sides), (3, true));
        assert_eq!((request.target.scene.as_str(), request.target.revision.epoch), ("cell", Some(Epoch(8))));
        assert_eq!(request.target.revision.rule, Rule::AtLeast(Revision(6)));
        assert_eq!(request.patience.timeout, Some(Duration::from_millis(20)));
        assert_eq!(request.patience.time_budget, Some(Duration::from_millis(10)));
        assert!(matches!(request.question, Question::States(question, 2) if question == states()));
        for (kind, items) in [(Motions::Edges, 2), (Motions::Path, 4)] {
            let request = read(&written(Ask::Motions(&motions(kind), 2)));
            assert_eq!(request.items, items);
            assert!(matches!(request.question, Question::Motions(question, 2) if question == motions(kind)));
        }
        let request = read(&written(Ask::Rays(&rays())));
        assert!(matches!(request.question, Question::Rays(question) if question == rays()));
    }

    #[test]
    fn subjects_of_every_kind_are_read() {
        let Question::Pairs { items, context: read_context, .. } =
            read(&written(Ask::Collide(&subjects(), &context()))).question
        else {
            panic!("another question")
        };
        assert_eq!(read_context, context());
        assert!(matches!(items[0], Asked::Subject(Subject::All)));
        assert!(matches!(items[1], Asked::Subject(Subject::Body(BodyId(4)))));
        let capsule = Shape::capsule(0.1, 0.2).and_then(|capsule| capsule.swept(0.05)).unwrap();
        assert!(matches!(&items[2], Asked::Subject(Subject::Shape { shape, .. })
            if format!("{shape:?}") == format!("{capsule:?}")));
        assert!(matches!(items[3], Asked::Subject(Subject::ChangedSince(Revision(3)))));
        assert!(matches!(items[4], Asked::ShapeOfBody { body: BodyId(5), .. }));
    }

    /// With `FUZZ_CORPUS` set to a folder, a request of each kind is written there: where fuzzing begins.
    #[test]
    fn requests_for_the_fuzzer() {
        let (edges, path) = (motions(Motions::Edges), motions(Motions::Path));
        let messages = [
            written(Ask::States(&states(), 2)),
            written(Ask::Motions(&edges, 2)),
            written(Ask::Motions(&path, 2)),
            written(Ask::Collide(&subjects(), &context())),
            written(Ask::Distance(&subjects(), &context())),
            written(Ask::Rays(&rays())),
            calling("Scenes/ListScenes", b""),
        ];
        assert!(messages.iter().all(|message| message.len() <= 4096), "fuzz/run cuts longer ones");
        let Ok(folder) = std::env::var("FUZZ_CORPUS") else { return };
        let folder = std::path::PathBuf::from(folder).join("shared_memory");
        std::fs::create_dir_all(&folder).unwrap();
        for (index, message) in messages.iter().enumerate() {
            std::fs::write(folder.join(index.to_string()), message).unwrap();
        }
    }
}
