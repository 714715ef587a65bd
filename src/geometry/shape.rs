//! The shapes a scene is made of. Checked when made, never failing afterwards.
//!
//! Every shape is a closed set: touching collides. Flat and point-like ones are valid (a box of zero thickness, a hull
//! whose points lie in a plane); empty, negative and non-finite ones are refused.

use std::sync::Arc;

use super::tolerance::LARGEST_LENGTH;
use super::{
    Aabb, Column, Compound, ConvexHull, HeightField, InvalidShape, Placement, PointCloud, TriangleMesh, Vec3, Voxels,
};

/// A shape in its own frame: a core, and the radius of a ball swept over it (their Minkowski sum). Metres.
#[derive(Clone, Debug)]
pub struct Shape {
    core: Core,
    swept_radius: f64,
    /// What rounding took off the swept radius when sweeps were added up.
    rest_of_radius: [f64; 2],
    bounds: Option<Aabb>,
}

/// What a shape is before the ball is swept over it. Lengths are metres in the shape's frame.
#[derive(Clone, Debug)]
pub enum Core {
    /// A single point at the origin. A sphere is a point with a swept radius.
    Point,
    /// `|x| <= half_extents.x`, and so for y and z.
    Cuboid {
        /// Half the side lengths; any may be zero.
        half_extents: Vec3,
    },
    /// Points `(0, 0, -half_length) ..= (0, 0, half_length)`. A capsule is this with a swept radius.
    AxialSegment {
        /// Half the length of the core segment.
        half_length: f64,
    },
    /// Axis z, centred.
    Cylinder {
        /// Of the discs.
        radius: f64,
        /// Half the height.
        half_length: f64,
    },
    /// Axis z: apex at `(0, 0, half_length)`, base disc at `z = -half_length`.
    Cone {
        /// Of the base disc.
        radius: f64,
        /// Half the height.
        half_length: f64,
    },
    /// `(x/a)^2 + (y/b)^2 + (z/c)^2 <= 1`.
    Ellipsoid {
        /// The semi-axes a, b, c; any may be zero.
        radii: Vec3,
    },
    /// Convex hull of a set of points, possibly flat.
    Convex(Arc<ConvexHull>),
    /// A triangle, possibly degenerate.
    Triangle([Vec3; 3]),
    /// A segment, possibly a point.
    Segment([Vec3; 2]),
    /// Solid `{ x : normal . x <= offset }`, without bounds.
    HalfSpace {
        /// Outward normal, of any finite length but zero.
        normal: Vec3,
        /// In units of the normal's length.
        offset: f64,
    },
    /// Thin and two-sided `{ x : normal . x = offset }`, without bounds.
    Plane {
        /// Of any finite length but zero.
        normal: Vec3,
        /// In units of the normal's length.
        offset: f64,
    },
    /// A surface of triangles; a body with an interior when it is declared solid.
    Mesh(Arc<TriangleMesh>),
    /// The union of placed shapes.
    Compound(Arc<Compound>),
    /// Terrain, solid down to a floor.
    HeightField(Arc<HeightField>),
    /// Points; with a swept radius the union of balls around them.
    PointCloud(Arc<PointCloud>),
    /// Occupied cells of a grid; may be none.
    Voxels(Voxels),
    /// What lies under one triangle of a height field.
    Column(Column),
    /// A box along the axes, anywhere: a cell of voxels.
    Block(Aabb),
}

/// Checks that a length is finite, not negative and within reach.
///
/// # Errors
/// Names `field`.
pub(super) fn length(field: &str, value: f64) -> Result<f64, InvalidShape> {
    let field = || field.to_owned();
    if !value.is_finite() {
        return Err(InvalidShape::NotFinite { field: field() });
    }
    if value < 0.0 {
        return Err(InvalidShape::Negative { field: field(), value });
    }
    if value > LARGEST_LENGTH {
        return Err(InvalidShape::TooLarge { field: field(), value, limit: LARGEST_LENGTH });
    }
    Ok(value)
}

fn lengths(field: &str, v: Vec3) -> Result<Vec3, InvalidShape> {
    for (axis, value) in ["x", "y", "z"].into_iter().zip(v.iter()) {
        length(&format!("{field}.{axis}"), *value)?;
    }
    Ok(v)
}

/// Checks that a point is finite and within reach.
///
/// # Errors
/// [`InvalidShape::NotFinite`] or [`InvalidShape::TooLarge`], naming `field`.
pub(super) fn position(field: impl Fn() -> String, p: Vec3) -> Result<Vec3, InvalidShape> {
    if !p.iter().all(|c| c.is_finite()) {
        return Err(InvalidShape::NotFinite { field: field() });
    }
    if p.amax() > LARGEST_LENGTH {
        return Err(InvalidShape::TooLarge { field: field(), value: p.amax(), limit: LARGEST_LENGTH });
    }
    Ok(p)
}

impl Shape {
    fn new(core: Core, swept_radius: f64) -> Self {
        let bounds = core.bounds().map(|b| b.grown(swept_radius));
        Self { core, swept_radius, rest_of_radius: [0.0; 2], bounds }
    }

    /// A ball. # Errors: a negative or non-finite radius.
    pub fn sphere(radius: f64) -> Result<Self, InvalidShape> {
        Ok(Self::new(Core::Point, length("radius", radius)?))
    }

    /// A single point.
    #[must_use]
    pub fn point() -> Self {
        Self::new(Core::Point, 0.0)
    }

    /// A box of side lengths `2 * half_extents`. # Errors: a negative or non-finite extent.
    pub fn cuboid(half_extents: Vec3) -> Result<Self, InvalidShape> {
        Ok(Self::new(Core::Cuboid { half_extents: lengths("half_extents", half_extents)? }, 0.0))
    }

    /// A ball swept along the axis z; `half_length` is that of the core segment. # Errors: as for a sphere.
    pub fn capsule(radius: f64, half_length: f64) -> Result<Self, InvalidShape> {
        let core = Core::AxialSegment { half_length: length("half_length", half_length)? };
        Ok(Self::new(core, length("radius", radius)?))
    }

    /// Axis z, centred. # Errors: a negative or non-finite size.
    pub fn cylinder(radius: f64, half_length: f64) -> Result<Self, InvalidShape> {
        let (radius, half_length) = (length("radius", radius)?, length("half_length", half_length)?);
        Ok(Self::new(Core::Cylinder { radius, half_length }, 0.0))
    }

    /// Axis z, apex up, centred. # Errors: a negative or non-finite size.
    pub fn cone(radius: f64, half_length: f64) -> Result<Self, InvalidShape> {
        let (radius, half_length) = (length("radius", radius)?, length("half_length", half_length)?);
        Ok(Self::new(Core::Cone { radius, half_length }, 0.0))
    }

    /// Semi-axes along x, y, z. # Errors: a negative or non-finite radius.
    pub fn ellipsoid(radii: Vec3) -> Result<Self, InvalidShape> {
        Ok(Self::new(Core::Ellipsoid { radii: lengths("radii", radii)? }, 0.0))
    }

    /// The convex hull of `points`. Duplicate, inner, collinear and coplanar points are welcome.
    ///
    /// # Errors
    /// No points, or one that is not finite.
    pub fn convex(points: &[Vec3]) -> Result<Self, InvalidShape> {
        Ok(Self::hull(Arc::new(ConvexHull::new(points)?)))
    }

    /// A hull that was made before, shared.
    #[must_use]
    pub fn hull(hull: Arc<ConvexHull>) -> Self {
        Self::new(Core::Convex(hull), 0.0)
    }

    /// # Errors: a corner that is not finite.
    pub fn triangle(a: Vec3, b: Vec3, c: Vec3) -> Result<Self, InvalidShape> {
        for (name, p) in ["a", "b", "c"].into_iter().zip([a, b, c]) {
            position(|| name.to_owned(), p)?;
        }
        Ok(Self::new(Core::Triangle([a, b, c]), 0.0))
    }

    /// # Errors: an end that is not finite.
    pub fn segment(a: Vec3, b: Vec3) -> Result<Self, InvalidShape> {
        for (name, p) in ["a", "b"].into_iter().zip([a, b]) {
            position(|| name.to_owned(), p)?;
        }
        Ok(Self::new(Core::Segment([a, b]), 0.0))
    }

    /// Solid `{ x : normal . x <= offset }`. # Errors: a zero or non-finite normal, a non-finite offset.
    pub fn half_space(normal: Vec3, offset: f64) -> Result<Self, InvalidShape> {
        let (normal, offset) = plane_equation(normal, offset)?;
        Ok(Self::new(Core::HalfSpace { normal, offset }, 0.0))
    }

    /// Thin `{ x : normal . x = offset }`. # Errors: as for a half-space.
    pub fn plane(normal: Vec3, offset: f64) -> Result<Self, InvalidShape> {
        let (normal, offset) = plane_equation(normal, offset)?;
        Ok(Self::new(Core::Plane { normal, offset }, 0.0))
    }

    /// A mesh that was made before, shared.
    #[must_use]
    pub fn mesh(mesh: Arc<TriangleMesh>) -> Self {
        Self::new(Core::Mesh(mesh), 0.0)
    }

    /// The union of placed shapes.
    #[must_use]
    pub fn compound(compound: Arc<Compound>) -> Self {
        Self::new(Core::Compound(compound), 0.0)
    }

    /// Terrain that was made before, shared.
    #[must_use]
    pub fn height_field(field: Arc<HeightField>) -> Self {
        Self::new(Core::HeightField(field), 0.0)
    }

    /// The union of balls of that radius around the points. # Errors: a negative or non-finite radius.
    pub fn point_cloud(cloud: Arc<PointCloud>, radius: f64) -> Result<Self, InvalidShape> {
        Ok(Self::new(Core::PointCloud(cloud), length("radius", radius)?))
    }

    /// The occupied cells of a map.
    #[must_use]
    pub fn voxels(map: Voxels) -> Self {
        Self::new(Core::Voxels(map), 0.0)
    }

    /// The same shape with another map in it, swept by as much; none unless it is a map.
    #[must_use]
    pub fn with_voxels(&self, map: Voxels) -> Option<Self> {
        let Core::Voxels(_) = self.core else { return None };
        Some(Self { rest_of_radius: self.rest_of_radius, ..Self::new(Core::Voxels(map), self.swept_radius) })
    }

    /// Whether there is nothing in it: true of voxels without a cell, and of nothing else.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        matches!(&self.core, Core::Voxels(map) if map.is_empty())
    }

    /// The same shape with `extra` metres added to its swept radius. A half-space or plane moves or thickens by that
    /// much; a compound grows part by part.
    ///
    /// # Errors
    /// A negative or non-finite radius.
    pub fn swept(&self, extra: f64) -> Result<Self, InvalidShape> {
        let extra = length("swept_radius", extra)?;
        // Without rounding, from the smallest part up (Shewchuk 1997); what a third sweep leaves may round at 2^-159.
        let [large, small] = self.rest_of_radius;
        let (sum, least) = two_sum(extra, small);
        let (sum, less) = two_sum(sum, large);
        let (radius, most) = two_sum(sum, self.swept_radius);
        let radius = length("swept_radius", radius)?;
        Ok(Self { rest_of_radius: [most, less + least], ..Self::new(self.core.clone(), radius) })
    }

    /// The same shape with every length multiplied by `factor` about its origin, swept radius included.
    ///
    /// # Errors
    /// A factor that is negative or not finite, or lengths beyond the largest accepted.
    pub fn scaled(&self, factor: f64) -> Result<Self, InvalidShape> {
        length("scale", factor)?;
        let scaled = Self::new(self.core.scaled(factor)?, 0.0).swept(self.swept_radius * factor)?;
        Ok(Self { rest_of_radius: self.rest_of_radius.map(|rest| rest * factor), ..scaled })
    }

    /// What the shape is without its swept radius.
    #[must_use]
    pub fn core(&self) -> &Core {
        &self.core
    }

    /// Radius of the ball swept over the core, metres.
    #[must_use]
    pub fn swept_radius(&self) -> f64 {
        self.swept_radius
    }

    /// Numbers whose sum, not rounded, is the radius of the ball swept over the core, metres: a capsule of radius 0.1 with a
    /// margin of 0.2 has neither 0.3 nor the double next to it. The first is [`Self::swept_radius`].
    #[must_use]
    pub fn swept_radius_unrounded(&self) -> [f64; 3] {
        let [large, small] = self.rest_of_radius;
        [self.swept_radius, large, small]
    }

    /// Name of the kind, as in case files and on the wire.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match &self.core {
            Core::Point if self.swept_radius > 0.0 => "sphere",
            Core::AxialSegment { .. } => "capsule",
            Core::Point => "point",
            Core::Cuboid { .. } => "box",
            Core::Cylinder { .. } => "cylinder",
            Core::Cone { .. } => "cone",
            Core::Ellipsoid { .. } => "ellipsoid",
            Core::Convex(_) => "convex",
            Core::Triangle(_) => "triangle",
            Core::Segment(_) => "segment",
            Core::HalfSpace { .. } => "half_space",
            Core::Plane { .. } => "plane",
            Core::Mesh(_) => "mesh",
            Core::Compound(_) => "compound",
            Core::HeightField(_) => "height_field",
            Core::PointCloud(_) => "point_cloud",
            Core::Voxels(_) => "voxels",
            Core::Column(_) => "column",
            Core::Block(_) => "block",
        }
    }

    /// Bounds in the shape's own frame, swept radius included; none for half-spaces and planes, nor for what is empty.
    #[must_use]
    pub fn bounds(&self) -> Option<Aabb> {
        self.bounds
    }

    /// A box, in the frame the shape is placed in, that surely holds the placed shape; none when unbounded or
    /// empty. Rounded outwards: it may be larger than the least one by rotation and by rounding, never smaller.
    #[must_use]
    pub fn placed_bounds(&self, at: &Placement) -> Option<Aabb> {
        let local = self.bounds?;
        let half = at.rotation.abs() * local.half_extents();
        let center = at.point(local.center());
        // Rounding of centre, half extents and sums: a few units in the last place of the sizes that went in.
        let slack = 16.0 * f64::EPSILON * (center.amax() + at.translation.amax() + half.amax() + local.center().norm());
        Some(Aabb::centred(center, half).grown(slack))
    }
}

impl Core {
    /// The core with every length multiplied by a finite, non-negative `factor`.
    ///
    /// # Errors
    /// Lengths beyond the largest accepted.
    pub fn scaled(&self, factor: f64) -> Result<Self, InvalidShape> {
        let f = factor;
        let shape = match self {
            Self::Point => Shape::point(),
            Self::Cuboid { half_extents } => Shape::cuboid(half_extents * f)?,
            Self::AxialSegment { half_length } => Shape::capsule(0.0, half_length * f)?,
            Self::Cylinder { radius, half_length } => Shape::cylinder(radius * f, half_length * f)?,
            Self::Cone { radius, half_length } => Shape::cone(radius * f, half_length * f)?,
            Self::Ellipsoid { radii } => Shape::ellipsoid(radii * f)?,
            Self::Convex(hull) => Shape::hull(Arc::new(hull.scaled(f)?)),
            Self::Triangle([a, b, c]) => Shape::triangle(a * f, b * f, c * f)?,
            Self::Segment([a, b]) => Shape::segment(a * f, b * f)?,
            Self::HalfSpace { normal, offset } => Shape::half_space(*normal, offset * f)?,
            Self::Plane { normal, offset } => Shape::plane(*normal, offset * f)?,
            Self::Mesh(mesh) => Shape::mesh(Arc::new(mesh.scaled(Vec3::repeat(f))?)),
            Self::Compound(compound) => Shape::compound(Arc::new(compound.scaled(f)?)),
            Self::HeightField(field) => Shape::height_field(Arc::new(field.scaled(f)?)),
            Self::PointCloud(cloud) => Shape::point_cloud(Arc::new(cloud.scaled(f)?), 0.0)?,
            Self::Voxels(map) => Shape::voxels(map.scaled(f)?),
            Self::Block(Aabb { min, max }) => return Ok(Self::Block(Aabb { min: min * f, max: max * f })),
            Self::Column(Column { top, floor }) => {
                return Ok(Self::Column(Column { top: top.map(|p| p * f), floor: floor * f }));
            }
        };
        Ok(shape.core)
    }

    /// Bounds of the core in its own frame; none when unbounded.
    #[must_use]
    pub fn bounds(&self) -> Option<Aabb> {
        let centred = |h: Vec3| Some(Aabb::centred(Vec3::zeros(), h));
        match self {
            Self::Point => centred(Vec3::zeros()),
            Self::Cuboid { half_extents } => centred(*half_extents),
            Self::AxialSegment { half_length } => centred(Vec3::new(0.0, 0.0, *half_length)),
            Self::Cylinder { radius, half_length } | Self::Cone { radius, half_length } => {
                centred(Vec3::new(*radius, *radius, *half_length))
            }
            Self::Ellipsoid { radii } => centred(*radii),
            Self::Convex(hull) => Some(hull.bounds()),
            Self::Triangle(corners) => Some(Aabb::around(*corners)),
            Self::Segment(ends) => Some(Aabb::around(*ends)),
            Self::HalfSpace { .. } | Self::Plane { .. } => None,
            Self::Mesh(mesh) => Some(mesh.bounds()),
            Self::Compound(compound) => Some(compound.bounds()),
            Self::HeightField(field) => Some(field.bounds()),
            Self::PointCloud(cloud) => Some(cloud.bounds()),
            Self::Voxels(map) => map.bounds(),
            Self::Column(column) => Some(Aabb::around(column.corners())),
            Self::Block(block) => Some(*block),
        }
    }
}

/// The sum and what rounding took off it (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

fn plane_equation(normal: Vec3, offset: f64) -> Result<(Vec3, f64), InvalidShape> {
    position(|| "normal".to_owned(), normal)?;
    if normal == Vec3::zeros() {
        return Err(InvalidShape::ZeroNormal);
    }
    if !offset.is_finite() {
        return Err(InvalidShape::NotFinite { field: "offset".to_owned() });
    }
    // How far the plane is from the origin; the largest component is within a factor of two of the normal's length.
    let distance = (offset / normal.amax()).abs();
    if distance > LARGEST_LENGTH {
        let field = "offset / |normal|".to_owned();
        return Err(InvalidShape::TooLarge { field, value: distance, limit: LARGEST_LENGTH });
    }
    Ok((normal, offset))
}
