#include "clearance/geometry.hpp"

#include <utility>

#include "little_endian.hpp"

namespace clearance {

v1::Vec3 vec3(const Point& point) {
  v1::Vec3 message;
  message.set_x(point[0]);
  message.set_y(point[1]);
  message.set_z(point[2]);
  return message;
}

Point point_of(const v1::Vec3& message) { return {message.x(), message.y(), message.z()}; }

v1::Pose at(double x, double y, double z) {
  v1::Pose message;
  *message.mutable_translation() = vec3({x, y, z});
  return message;
}

v1::Pose pose(const Point& translation, const std::array<double, 4>& rotation) {
  auto message = at(translation[0], translation[1], translation[2]);
  auto& q = *message.mutable_rotation();
  q.set_w(rotation[0]);
  q.set_x(rotation[1]);
  q.set_y(rotation[2]);
  q.set_z(rotation[3]);
  return message;
}

v1::Shape sphere(double radius) {
  v1::Shape shape;
  shape.mutable_sphere()->set_radius(radius);
  return shape;
}

v1::Shape box(double half_x, double half_y, double half_z) {
  v1::Shape shape;
  *shape.mutable_box()->mutable_half_extents() = vec3({half_x, half_y, half_z});
  return shape;
}

v1::Shape capsule(double radius, double half_length) {
  v1::Shape shape;
  shape.mutable_capsule()->set_radius(radius);
  shape.mutable_capsule()->set_half_length(half_length);
  return shape;
}

v1::Shape cylinder(double radius, double half_length) {
  v1::Shape shape;
  shape.mutable_cylinder()->set_radius(radius);
  shape.mutable_cylinder()->set_half_length(half_length);
  return shape;
}

v1::Shape cone(double radius, double half_length) {
  v1::Shape shape;
  shape.mutable_cone()->set_radius(radius);
  shape.mutable_cone()->set_half_length(half_length);
  return shape;
}

v1::Shape ellipsoid(double x, double y, double z) {
  v1::Shape shape;
  *shape.mutable_ellipsoid()->mutable_radii() = vec3({x, y, z});
  return shape;
}

v1::Shape convex(const std::vector<Point>& points) {
  v1::Shape shape;
  auto& message = *shape.mutable_convex();
  for (const auto& point : points) *message.add_points() = vec3(point);
  return shape;
}

v1::Shape mesh(const std::vector<Point>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles, v1::MeshMode mode) {
  v1::Shape shape;
  auto& message = *shape.mutable_mesh();
  for (const auto& vertex : vertices) *message.add_vertices() = vec3(vertex);
  for (const auto& triangle : triangles) {
    for (const auto index : triangle) message.add_triangles(index);
  }
  message.set_mode(mode);
  return shape;
}

v1::Shape compound(const std::vector<Part>& parts) {
  v1::Shape shape;
  auto& message = *shape.mutable_compound();
  for (const auto& part : parts) {
    auto& added = *message.add_parts();
    *added.mutable_shape() = part.shape;
    *added.mutable_pose() = part.pose;
  }
  return shape;
}

v1::Shape point_cloud(const std::vector<Point>& points, double radius) {
  v1::Shape shape;
  *shape.mutable_point_cloud()->mutable_points() = numbers(points);
  shape.mutable_point_cloud()->set_radius(radius);
  return shape;
}

v1::Shape voxels(double resolution, const std::vector<Point>& points) {
  v1::Shape shape;
  shape.mutable_voxels()->set_resolution(resolution);
  *shape.mutable_voxels()->mutable_points() = numbers(points);
  return shape;
}

v1::Shape half_space(const Point& normal, double offset) {
  v1::Shape shape;
  *shape.mutable_half_space()->mutable_normal() = vec3(normal);
  shape.mutable_half_space()->set_offset(offset);
  return shape;
}

v1::Shape plane(const Point& normal, double offset) {
  v1::Shape shape;
  *shape.mutable_plane()->mutable_normal() = vec3(normal);
  shape.mutable_plane()->set_offset(offset);
  return shape;
}

v1::Shape ball_swept(v1::Shape shape, double radius) {
  shape.set_swept_radius(shape.swept_radius() + radius);
  return shape;
}

v1::Numbers numbers(const std::vector<Point>& points) {
  std::string bytes;
  for (const auto& point : points) {
    for (const auto value : point) append_double(bytes, value);
  }
  v1::Numbers message;
  message.set_little_endian(std::move(bytes));
  return message;
}

}  // namespace clearance
