//! What does a request ask? From the header and sections of a message, copied before, to the service's questions.
//! Total: whatever the bytes, the outcome is a checked question or an error that names the field.

use std::time::Duration;

use prost::bytes::Bytes;

use super::codes;
use super::layout::{ABI_HASH, MAGIC, RequestHeader, VERSION, kind};
use super::sections::{Malformed, Sections, name_of};
use super::subjects::{self, Asked};
use crate::limits::{LimitExceeded, Limits};
use crate::query::{CastRays, CheckMotions, CheckStates, Context, Filter, Mode, Motions};
use crate::scene::{BodyId, Epoch, Revision};
use crate::service::{Patience, RevisionRule, Rule, ServiceError, Target};

/// Random for each request; whoever gets an answer with another nonce has got somebody else's.
pub type Nonce = [u8; 16];

/// What a client's listener for answers is called, as bytes.
pub type ClientId = [u8; 16];

/// The bits of [`RequestHeader::flags`].
pub(super) mod flag {
    pub const EPOCH: u32 = 1;
    pub const CUT_OFF: u32 = 2;
    pub const ACCURACY: u32 = 4;
    pub const MAX_PAIRS: u32 = 8;
    pub const LAYERS: u32 = 16;
    pub const MASK: u32 = 32;
    pub const RESOLUTION: u32 = 64;
    pub const MAX_STATES: u32 = 128;
    pub const TIME_BUDGET: u32 = 256;
    pub const DISREGARD_ALLOWED: u32 = 512;
    pub const ALL: u32 = 1023;
}

/// A request as it came.
#[derive(Clone, Debug)]
pub enum Received {
    /// A question in columns.
    Asked(Box<Request>),
    /// An rpc and its message.
    Called(Called),
}

/// An rpc that is called by its name, with the message that gRPC would carry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Called {
    /// `SERVICE/METHOD`.
    pub rpc: String,
    /// Its request message.
    pub message: Bytes,
    /// How long the caller listens.
    pub timeout: Option<Duration>,
}

/// A request that can be asked of a scene.
#[derive(Clone, Debug)]
pub struct Request {
    /// Which scene, and in which state.
    pub target: Target,
    /// How long the caller waits.
    pub patience: Patience,
    /// The question.
    pub question: Question,
    /// Its number in the header.
    pub question_number: u32,
    /// How many items the columns of items have.
    pub items: usize,
    /// The sides of the nearest pair are wanted.
    pub wants_sides: bool,
}

/// The question of a request. It is asked of a snapshot by [`super::questions`].
#[derive(Clone, Debug)]
pub enum Question {
    /// Robot states, and the numbers of one of them.
    States(CheckStates, usize),
    /// Motions, or a path, and the numbers of one position vector.
    Motions(CheckMotions, usize),
    /// Subjects against the scene.
    Pairs {
        /// What touches, or how far is the nearest?
        what: PairsOf,
        /// The subjects; those that need the scene are looked up later.
        items: Vec<Asked>,
        /// All or up to the first hit.
        mode: Mode,
        /// The rest.
        context: Context,
    },
    /// Rays.
    Rays(CastRays),
}

/// Which question about subjects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairsOf {
    /// What touches?
    Collide,
    /// How far is the nearest?
    Distance,
}

/// The numbers of [`RequestHeader::question`].
pub(super) mod question_number {
    pub const STATES: u32 = 1;
    pub const MOTIONS: u32 = 2;
    pub const PATH: u32 = 3;
    pub const COLLIDE: u32 = 4;
    pub const DISTANCE: u32 = 5;
    pub const RAYS: u32 = 6;
    pub const CALL: u32 = 7;
}

impl From<Malformed> for ServiceError {
    fn from(malformed: Malformed) -> Self {
        Self::Invalid { field: malformed.field, problem: malformed.problem }
    }
}

/// Reads a request. `message` must be memory that the client cannot write to any more.
///
/// # Errors
/// A field that cannot be, or a name or message beyond its cap.
pub fn decode(message: &[u8], limits: &Limits) -> Result<Received, ServiceError> {
    let header = RequestHeader::read(message);
    let whole = check_frame(&header, message)?;
    let sections = Sections::check(whole, RequestHeader::BYTES, header.sections)?;
    if header.question == question_number::CALL {
        let message = Bytes::copy_from_slice(sections.bytes(kind::MESSAGE).unwrap_or_default());
        let Patience { timeout, .. } = patience(&header);
        return Ok(Received::Called(Called { rpc: rpc(&sections)?, message, timeout }));
    }
    let target = Target { scene: name(&sections, kind::SCENE, limits)?, revision: revision_rule(&header)? };
    let decoder = Decoder { header: &header, sections: &sections, limits };
    Ok(Received::Asked(Box::new(Request {
        target,
        patience: patience(&header),
        question: decoder.question()?,
        question_number: header.question,
        items: header.items as usize,
        wants_sides: header.wants & codes::WANTS_SIDES != 0,
    })))
}

/// The message as long as it says it is.
fn check_frame<'m>(header: &RequestHeader, message: &'m [u8]) -> Result<&'m [u8], Malformed> {
    if message.len() < RequestHeader::BYTES {
        let problem = format!("has {} bytes; its header alone has {}", message.len(), RequestHeader::BYTES);
        return Err(Malformed::new("message", problem));
    }
    if header.magic != MAGIC {
        return Err(Malformed::new("header.magic", "is not that of a request"));
    }
    if header.version != VERSION {
        return Err(Malformed::new("header.version", format!("{} is not {VERSION}", header.version)));
    }
    if header.abi_hash != ABI_HASH {
        let problem =
            format!("{:#018x} is not {ABI_HASH:#018x}: the client was built for another layout", header.abi_hash);
        return Err(Malformed::new("header.abi_hash", problem));
    }
    if header.flags & !flag::ALL != 0 {
        return Err(Malformed::new("header.flags", format!("{:#x} has unknown bits", header.flags)));
    }
    let whole = usize::try_from(header.total_bytes).ok().and_then(|total| message.get(..total));
    whole.ok_or_else(|| {
        Malformed::new("header.total_bytes", format!("{} is more than the {} sent", header.total_bytes, message.len()))
    })
}

fn unknown(field: &str, number: u32) -> Malformed {
    Malformed::new(field, format!("has the unknown value {number}"))
}

fn revision_rule(header: &RequestHeader) -> Result<RevisionRule, Malformed> {
    let revision = Revision(header.revision);
    let rule = match header.revision_rule {
        0 => Rule::Latest,
        1 => Rule::Exactly(revision),
        2 => Rule::AtLeast(revision),
        other => return Err(unknown("context.revision", other)),
    };
    Ok(RevisionRule { epoch: (header.flags & flag::EPOCH != 0).then_some(Epoch(header.epoch)), rule })
}

fn patience(header: &RequestHeader) -> Patience {
    let timeout = (header.timeout_ns != 0).then(|| Duration::from_nanos(header.timeout_ns));
    let budget = (header.flags & flag::TIME_BUDGET != 0).then(|| Duration::from_nanos(header.time_budget_ns));
    Patience { timeout, time_budget: budget }
}

fn name(sections: &Sections<'_>, kind: u32, limits: &Limits) -> Result<String, ServiceError> {
    let name = sections.text(kind)?.ok_or_else(|| Malformed::new(name_of(kind), "must be said"))?;
    LimitExceeded::check("max_name_bytes", name.len(), limits.max_name_bytes)?;
    Ok(name.to_owned())
}

/// The rpc that is called. No rpc has a longer name than this, bytes.
const LONGEST_RPC: usize = 64;

fn rpc(sections: &Sections<'_>) -> Result<String, Malformed> {
    let wrong = |problem: &str| Malformed::new(name_of(kind::RPC), problem);
    let rpc = sections.text(kind::RPC)?.ok_or_else(|| wrong("must be said"))?;
    if rpc.len() > LONGEST_RPC { Err(wrong("is longer than any name of an rpc")) } else { Ok(rpc.to_owned()) }
}

struct Decoder<'a> {
    header: &'a RequestHeader,
    sections: &'a Sections<'a>,
    limits: &'a Limits,
}

impl Decoder<'_> {
    fn question(&self) -> Result<Question, ServiceError> {
        LimitExceeded::check("max_items", self.header.items as usize, self.limits.max_items)?;
        match self.header.question {
            question_number::STATES => self.states(),
            question_number::MOTIONS => self.motions(Motions::Edges),
            question_number::PATH => self.motions(Motions::Path),
            question_number::COLLIDE => self.pairs(PairsOf::Collide),
            question_number::DISTANCE => self.pairs(PairsOf::Distance),
            question_number::RAYS => self.rays(),
            other => Err(unknown("header.question", other).into()),
        }
    }

    fn has(&self, flag: u32) -> bool {
        self.header.flags & flag != 0
    }

    fn mode(&self) -> Result<Mode, Malformed> {
        codes::mode(self.header.mode).ok_or_else(|| unknown("mode", self.header.mode))
    }

    fn context(&self) -> Result<Context, ServiceError> {
        let header = self.header;
        let defaults = Context::default();
        let mut accuracy = defaults.accuracy;
        if self.has(flag::ACCURACY) {
            (accuracy.absolute, accuracy.relative) = (header.accuracy_absolute, header.accuracy_relative);
        }
        let max_pairs = header.max_pairs as usize;
        for (bit, asked) in [(codes::WANTS_PATCH, "contact patches"), (codes::WANTS_DERIVATIVES, "derivatives")] {
            if header.wants & bit != 0 {
                let problem = format!("asks for {asked}, which a batch has no columns for: call the rpc by its name");
                return Err(ServiceError::invalid("context.wants", problem));
            }
        }
        Ok(Context {
            wants: codes::wants(header.wants).ok_or_else(|| unknown("context.wants", header.wants))?,
            margin: header.margin,
            cut_off: self.has(flag::CUT_OFF).then_some(header.cut_off),
            accuracy,
            solver: codes::solver(header.solver).ok_or_else(|| unknown("context.solver", header.solver))?,
            filter: self.filter()?,
            max_pairs: if self.has(flag::MAX_PAIRS) { max_pairs } else { defaults.max_pairs },
            max_patch_points: defaults.max_patch_points,
            derivatives: defaults.derivatives,
        })
    }

    fn filter(&self) -> Result<Filter, ServiceError> {
        let groups = self.sections.texts(kind::GROUPS)?;
        LimitExceeded::check("max_groups", groups.len(), self.limits.max_groups)?;
        for group in &groups {
            LimitExceeded::check("max_name_bytes", group.len(), self.limits.max_name_bytes)?;
        }
        Ok(Filter {
            groups: groups.into_iter().map(str::to_owned).collect(),
            ignore: self.sections.integers(kind::IGNORE).unwrap_or_default().into_iter().map(BodyId).collect(),
            disregard_allowed_collisions: self.has(flag::DISREGARD_ALLOWED),
            layers: self.has(flag::LAYERS).then_some(self.header.layers),
            mask: self.has(flag::MASK).then_some(self.header.mask),
        })
    }

    /// The numbers of all position vectors, and how many one of them has. `vectors` of them make an item.
    fn positions(&self, vectors: usize) -> Result<(Vec<f64>, usize), ServiceError> {
        let positions = self.column(kind::POSITIONS, self.header.items as usize, f64::from_le_bytes)?;
        let per_row = self.sections.stride(kind::POSITIONS).unwrap_or(0) / size_of::<f64>();
        if !per_row.is_multiple_of(vectors) {
            return Err(Malformed::new(
                "positions",
                format!("has rows of {per_row} numbers, not of a start and a goal"),
            )
            .into());
        }
        Ok((positions, per_row / vectors))
    }

    fn states(&self) -> Result<Question, ServiceError> {
        let (positions, width) = self.positions(1)?;
        let robot = name(self.sections, kind::ROBOT, self.limits)?;
        Ok(Question::States(CheckStates { robot, positions, mode: self.mode()?, context: self.context()? }, width))
    }

    fn motions(&self, motions: Motions) -> Result<Question, ServiceError> {
        let vectors = match motions {
            Motions::Edges => 2,
            Motions::Path => 1,
        };
        let (positions, width) = self.positions(vectors)?;
        let header = self.header;
        let resolution = if self.has(flag::RESOLUTION) { header.resolution } else { CheckMotions::DEFAULT_RESOLUTION };
        let states = header.max_states as usize;
        let question = CheckMotions {
            robot: name(self.sections, kind::ROBOT, self.limits)?,
            positions,
            motions,
            mode: self.mode()?,
            find: codes::find(header.find).ok_or_else(|| unknown("effort.find", header.find))?,
            resolution,
            max_states: if self.has(flag::MAX_STATES) { states } else { CheckMotions::DEFAULT_MAX_STATES },
            context: self.context()?,
        };
        Ok(Question::Motions(question, width))
    }

    fn pairs(&self, what: PairsOf) -> Result<Question, ServiceError> {
        let items = subjects::decode(self.header.items as usize, self.sections)?;
        Ok(Question::Pairs { what, items, mode: self.mode()?, context: self.context()? })
    }

    fn rays(&self) -> Result<Question, ServiceError> {
        let rows = self.header.items as usize;
        let lengths = self.sections.doubles(kind::LENGTHS);
        let lengths = lengths.ok_or_else(|| Malformed::new(name_of(kind::LENGTHS), "must be said"))?;
        Ok(Question::Rays(CastRays {
            origins: self.column(kind::ORIGINS, rows, f64::from_le_bytes)?,
            directions: self.column(kind::DIRECTIONS, rows, f64::from_le_bytes)?,
            lengths,
            mode: codes::cast_mode(self.header.mode).ok_or_else(|| unknown("mode", self.header.mode))?,
            context: self.context()?,
        }))
    }

    fn column<const N: usize, T>(&self, kind: u32, rows: usize, number: fn([u8; N]) -> T) -> Result<Vec<T>, Malformed> {
        let (numbers, _) = required_rows(self.sections, kind, rows)?.as_chunks::<N>();
        Ok(numbers.iter().map(|bytes| number(*bytes)).collect())
    }
}

/// The bytes of a column that must have a row for each item.
pub(super) fn required_rows<'a>(sections: &Sections<'a>, kind: u32, rows: usize) -> Result<&'a [u8], Malformed> {
    let missing = || Malformed::new(name_of(kind), "must be said");
    let (bytes, stride) = (sections.bytes(kind).ok_or_else(missing)?, sections.stride(kind).ok_or_else(missing)?);
    let there = bytes.len() / stride;
    if there == rows {
        return Ok(bytes);
    }
    Err(Malformed::new(name_of(kind), format!("has {there} rows; the header says {rows} items")))
}
