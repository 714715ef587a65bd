// The shapes and poses of `pairs.bin` as Coal has them.
#pragma once

#include <memory>

#include "../pairs.hpp"
#include "coal/BVH/BVH_model.h"
#include "coal/shape/convex.h"
#include "coal/shape/geometric_shapes.h"

using Geometry = std::shared_ptr<coal::CollisionGeometry>;

inline coal::Vec3s vector(const std::array<double, 3>& v) { return coal::Vec3s(v[0], v[1], v[2]); }

inline Geometry make_hull(const ShapeRecord& shape) {
  auto points = std::make_shared<std::vector<coal::Vec3s>>();
  auto faces = std::make_shared<std::vector<coal::Triangle>>();
  for (auto& v : shape.vertices) points->push_back(vector(v));
  for (auto& t : shape.triangles) faces->push_back(coal::Triangle(t[0], t[1], t[2]));
  unsigned vertices = unsigned(points->size()), triangles = unsigned(faces->size());
  return std::make_shared<coal::Convex<coal::Triangle>>(points, vertices, faces, triangles);
}

// A mesh under a tree of the bounding volumes `Volume`.
template <class Volume>
Geometry make_mesh(const ShapeRecord& shape) {
  std::vector<coal::Vec3s> points;
  std::vector<coal::Triangle> faces;
  for (auto& v : shape.vertices) points.push_back(vector(v));
  for (auto& t : shape.triangles) faces.push_back(coal::Triangle(t[0], t[1], t[2]));
  auto mesh = std::make_shared<coal::BVHModel<Volume>>();
  mesh->beginModel();
  mesh->addSubModel(points, faces);
  mesh->endModel();
  return mesh;
}

inline Geometry make_convex(const ShapeRecord& shape) {
  const double* p = shape.params;
  switch (shape.kind) {
    case Kind::Hull: return make_hull(shape);
    case Kind::Sphere: return std::make_shared<coal::Sphere>(p[0]);
    case Kind::Box: return std::make_shared<coal::Box>(2 * p[0], 2 * p[1], 2 * p[2]);
    case Kind::Capsule: return std::make_shared<coal::Capsule>(p[0], 2 * p[1]);
    case Kind::Cylinder: return std::make_shared<coal::Cylinder>(p[0], 2 * p[1]);
    case Kind::Cone: return std::make_shared<coal::Cone>(p[0], 2 * p[1]);
    case Kind::Ellipsoid: return std::make_shared<coal::Ellipsoid>(p[0], p[1], p[2]);
    case Kind::Mesh: return nullptr;
  }
  return nullptr;
}

inline coal::Transform3s transform(const double* q, const double* t) {
  Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  return coal::Transform3s(rotation.toRotationMatrix(), coal::Vec3s(t[0], t[1], t[2]));
}
