//! What is held against the scene? The columns of subjects, item by item.

use super::layout::kind;
use super::request::required_rows;
use super::sections::{Malformed, Sections};
use crate::geometry::{InvalidShape, Pose, Quaternion, Shape, Vec3};
use crate::query::Subject;
use crate::scene::{BodyId, Revision, Snapshot};
use crate::service::ServiceError;

/// A subject as a request has it.
#[derive(Clone, Debug)]
pub enum Asked {
    /// One that needs no scene.
    Subject(Subject),
    /// The shape of a body, where the body is not.
    ShapeOfBody {
        /// Which body.
        body: BodyId,
        /// Of the shape in the world.
        pose: Pose,
    },
}

/// The numbers of the column of kinds of subjects.
pub(super) mod subject_kind {
    pub const ALL: u8 = 1;
    pub const BODY: u8 = 2;
    pub const SHAPE: u8 = 3;
    pub const CHANGED_SINCE: u8 = 4;
    pub const SHAPE_OF_BODY: u8 = 5;
}

/// The numbers of the column of kinds of shapes.
pub(super) mod shape_kind {
    pub const SPHERE: u8 = 1;
    pub const BOX: u8 = 2;
    pub const CAPSULE: u8 = 3;
    pub const CYLINDER: u8 = 4;
    pub const CONE: u8 = 5;
    pub const ELLIPSOID: u8 = 6;
    pub const POINT: u8 = 7;
}

/// Reads `items` subjects. Columns that no subject needs may be missing.
pub(super) fn decode(items: usize, sections: &Sections<'_>) -> Result<Vec<Asked>, Malformed> {
    let kinds = required_rows(sections, kind::SUBJECT_KINDS, items)?;
    let columns = Columns {
        ids: given(sections, kind::SUBJECT_IDS, items)?,
        poses: given(sections, kind::POSES, items)?,
        shape_kinds: given(sections, kind::SHAPE_KINDS, items)?,
        shape_parameters: given(sections, kind::SHAPE_PARAMETERS, items)?,
    };
    kinds.iter().enumerate().map(|(item, kind)| columns.subject(item, *kind)).collect()
}

/// A column that may be missing, but not be of another length.
fn given<'a>(sections: &Sections<'a>, kind: u32, items: usize) -> Result<Option<&'a [u8]>, Malformed> {
    if sections.has(kind) { required_rows(sections, kind, items).map(Some) } else { Ok(None) }
}

struct Columns<'a> {
    ids: Option<&'a [u8]>,
    poses: Option<&'a [u8]>,
    shape_kinds: Option<&'a [u8]>,
    shape_parameters: Option<&'a [u8]>,
}

impl Columns<'_> {
    fn subject(&self, item: usize, kind: u8) -> Result<Asked, Malformed> {
        let subject = match kind {
            subject_kind::ALL => Subject::All,
            subject_kind::BODY => Subject::Body(BodyId(self.id(item)?)),
            subject_kind::SHAPE => Subject::Shape { shape: self.shape(item)?, pose: self.pose(item)? },
            subject_kind::CHANGED_SINCE => Subject::ChangedSince(Revision(self.id(item)?)),
            subject_kind::SHAPE_OF_BODY => {
                return Ok(Asked::ShapeOfBody { body: BodyId(self.id(item)?), pose: self.pose(item)? });
            }
            other => return Err(wrong("subject_kinds", item, format!("has the unknown value {other}"))),
        };
        Ok(Asked::Subject(subject))
    }

    fn id(&self, item: usize) -> Result<u64, Malformed> {
        let bytes = row::<8>(self.ids, item, "subject_ids")?;
        Ok(u64::from_le_bytes(bytes))
    }

    fn pose(&self, item: usize) -> Result<Pose, Malformed> {
        let [x, y, z, qw, qx, qy, qz] = doubles(&row::<56>(self.poses, item, "poses")?);
        let rotation = Quaternion { w: qw, x: qx, y: qy, z: qz };
        Pose::new(Vec3::new(x, y, z), rotation).map_err(|error| wrong("poses", item, error.to_string()))
    }

    fn shape(&self, item: usize) -> Result<Shape, Malformed> {
        let [kind] = row::<1>(self.shape_kinds, item, "shape_kinds")?;
        let [a, b, c, swept] = doubles(&row::<32>(self.shape_parameters, item, "shape_parameters")?);
        let core = match kind {
            shape_kind::SPHERE => Shape::sphere(a),
            shape_kind::BOX => Shape::cuboid(Vec3::new(a, b, c)),
            shape_kind::CAPSULE => Shape::capsule(a, b),
            shape_kind::CYLINDER => Shape::cylinder(a, b),
            shape_kind::CONE => Shape::cone(a, b),
            shape_kind::ELLIPSOID => Shape::ellipsoid(Vec3::new(a, b, c)),
            shape_kind::POINT => Ok(Shape::point()),
            other => return Err(wrong("shape_kinds", item, format!("has the unknown value {other}"))),
        };
        let swept = |core: Shape| if swept == 0.0 { Ok(core) } else { core.swept(swept) };
        core.and_then(swept).map_err(|error: InvalidShape| wrong("shape_parameters", item, error.to_string()))
    }
}

fn wrong(column: &str, item: usize, problem: String) -> Malformed {
    Malformed::new(format!("{column}[{item}]"), problem)
}

fn row<const N: usize>(column: Option<&[u8]>, item: usize, name: &str) -> Result<[u8; N], Malformed> {
    let rows = column.map(|bytes| bytes.as_chunks::<N>().0);
    let row = rows.and_then(|rows| rows.get(item)).copied();
    row.ok_or_else(|| wrong(name, item, "must be said".to_owned()))
}

fn doubles<const BYTES: usize, const NUMBERS: usize>(bytes: &[u8; BYTES]) -> [f64; NUMBERS] {
    let (chunks, _) = bytes.as_chunks::<8>();
    std::array::from_fn(|index| chunks.get(index).map_or(f64::NAN, |chunk| f64::from_le_bytes(*chunk)))
}

/// The subjects in a snapshot.
pub(super) fn resolve(items: &[Asked], snapshot: &Snapshot) -> Result<Vec<Subject>, ServiceError> {
    let subject = |(item, asked): (usize, &Asked)| match asked {
        Asked::Subject(subject) => Ok(subject.clone()),
        Asked::ShapeOfBody { body, pose } => {
            let found =
                snapshot.body(*body).ok_or_else(|| wrong("subject_ids", item, format!("no body has id {}", body.0)))?;
            Ok(Subject::Shape { shape: Shape::clone(&found.shape), pose: *pose })
        }
    };
    items.iter().enumerate().map(subject).collect()
}
