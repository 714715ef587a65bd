//! Ground floor: shapes, poses and bounds as plain, checked numbers.
//!
//! A value of a type from here has passed its checks, so nothing above needs to ask again whether a number is finite.
//! Metres, radians, right-handed frames, `f64` throughout.

mod aabb;
mod bounding_ball;
mod box_cast;
mod compound;
mod convex_hull;
mod decomposition;
mod height_field;
mod hull_builder;
mod hull_climb;
mod hull_interior;
mod hull_scan;
mod hull_surface;
mod invalid_shape;
mod length;
pub mod mesh_file;
mod mesh_tree;
mod octree;
mod oriented_box;
mod point_cloud;
mod pose;
mod ray;
mod rigid_motion;
mod shape;
pub mod tolerance;
mod triangle_mesh;
mod twin;
pub mod vector;
mod voxels;
mod weighted_corners;

pub use aabb::Aabb;
pub use bounding_ball::Ball;
pub use box_cast::BoxCast;
pub use compound::{Compound, Part};
pub use convex_hull::ConvexHull;
pub use decomposition::decomposed;
pub use height_field::{Column, Grid, HeightField, Patch};
pub use hull_interior::HullInterior;
pub use hull_surface::HullSurface;
pub use invalid_shape::InvalidShape;
pub use length::length;
pub use mesh_tree::{Content, MOST_LEVELS, MeshTree, NodeId, Nodes, Siblings};
pub use oriented_box::{MOST_SKEW, OrientedBox, TwinBox};
pub use point_cloud::{PointCloud, Run};
pub use pose::{InvalidPose, Placement, Pose, Quaternion};
pub use ray::{InvalidRay, Ray};
pub use rigid_motion::{InvalidMotion, LARGEST_TURN, RigidMotion};
pub use shape::{Core, Shape};
pub use triangle_mesh::TriangleMesh;
pub use twin::{Twin, TwinVec3};
pub use voxels::{Cells, Voxels};
pub use weighted_corners::{CornerSums, CornerWeights};

/// A point, a direction or a difference of points.
pub type Vec3 = nalgebra::Vector3<f64>;

/// A rotation, or a product of rotations, by rows.
pub type Mat3 = nalgebra::Matrix3<f64>;
