/// Points, poses and shapes as messages. Metres; sizes may be zero, and touching collides.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "clearance/v1/geometry.pb.h"

namespace clearance {

/// x, y, z.
using Point = std::array<double, 3>;

v1::Vec3 vec3(const Point& point);
Point point_of(const v1::Vec3& message);

/// A pose without rotation.
v1::Pose at(double x, double y, double z);
/// A pose from a translation and a quaternion w, x, y, z of any norm but zero.
v1::Pose pose(const Point& translation, const std::array<double, 4>& rotation);

v1::Shape sphere(double radius);
/// |x| <= half_x, and so for y and z.
v1::Shape box(double half_x, double half_y, double half_z);
/// A ball swept along the axis z; `half_length` is that of the core segment.
v1::Shape capsule(double radius, double half_length);
/// Axis z, centred.
v1::Shape cylinder(double radius, double half_length);
/// Axis z: apex at `half_length`, base disc at `-half_length`.
v1::Shape cone(double radius, double half_length);
/// Semi-axes along x, y, z.
v1::Shape ellipsoid(double x, double y, double z);
/// The convex hull of points.
v1::Shape convex(const std::vector<Point>& points);
/// Triangles as indices of vertices, counter-clockwise from outside; the mode says what they stand for.
v1::Shape mesh(const std::vector<Point>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles, v1::MeshMode mode);

/// A part of a compound.
struct Part {
  v1::Shape shape;
  v1::Pose pose;
};
/// The union of placed shapes.
v1::Shape compound(const std::vector<Part>& parts);
/// The union of balls around points.
v1::Shape point_cloud(const std::vector<Point>& points, double radius);
/// The occupied cells of a grid of side `resolution`: those of points. Without points a map that nothing touches yet.
v1::Shape voxels(double resolution, const std::vector<Point>& points = {});
/// The solid normal . x <= offset.
v1::Shape half_space(const Point& normal, double offset);
/// The thin, two-sided normal . x = offset.
v1::Shape plane(const Point& normal, double offset);
/// The shape grown by a ball, rounded at corners and edges.
v1::Shape ball_swept(v1::Shape shape, double radius);

/// Points as a message, as bytes.
v1::Numbers numbers(const std::vector<Point>& points);

}  // namespace clearance
