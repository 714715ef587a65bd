// FCL as a contender: the distance and the overlap of convex shapes. A configuration is words joined by "/":
//
//   libccd, indep             whose GJK: libccd's, or FCL's own
//   1e-04, 1e-06, 1e-08       the tolerance of the distance
//
// Objects are made before the clock starts, one for each body of a pair; a call is `fcl::distance` or `fcl::collide` of both.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <memory>

#include "../contender.hpp"

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;
using Object = std::unique_ptr<fcl::CollisionObjectd>;

static Geometry make_hull(const ShapeRecord& shape) {
  auto points = std::make_shared<std::vector<fcl::Vector3d>>();
  auto faces = std::make_shared<std::vector<int>>();
  for (auto& v : shape.vertices) points->emplace_back(v[0], v[1], v[2]);
  for (auto& t : shape.triangles) faces->insert(faces->end(), {3, int(t[0]), int(t[1]), int(t[2])});
  return std::make_shared<fcl::Convexd>(points, int(shape.triangles.size()), faces);
}

static Geometry make_shape(const ShapeRecord& shape) {
  const double* p = shape.params;
  switch (shape.kind) {
    case Kind::Hull: return make_hull(shape);
    case Kind::Sphere: return std::make_shared<fcl::Sphered>(p[0]);
    case Kind::Box: return std::make_shared<fcl::Boxd>(2 * p[0], 2 * p[1], 2 * p[2]);
    case Kind::Capsule: return std::make_shared<fcl::Capsuled>(p[0], 2 * p[1]);
    case Kind::Cylinder: return std::make_shared<fcl::Cylinderd>(p[0], 2 * p[1]);
    case Kind::Cone: return std::make_shared<fcl::Coned>(p[0], 2 * p[1]);
    case Kind::Ellipsoid: return std::make_shared<fcl::Ellipsoidd>(p[0], p[1], p[2]);
    case Kind::Mesh: return nullptr;
  }
  return nullptr;
}

static fcl::Transform3d transform(const double* q, const double* t) {
  fcl::Transform3d at = fcl::Transform3d::Identity();
  at.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
  at.translation() = fcl::Vector3d(t[0], t[1], t[2]);
  return at;
}

static bool contains(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

class Fcl {
 public:
  explicit Fcl(const Pairs& pairs) : all(pairs) {
    for (const ShapeRecord& shape : all.shapes) geometries.push_back(make_shape(shape));
  }

  std::vector<std::string> configs(const PairSet& set, const std::string& operation) const {
    bool shapes = set.name.rfind("seed", 0) == 0 || set.name.rfind("prim", 0) == 0;
    if (!shapes || operation == "penetration") return {};
    if (operation == "collide") return {"libccd", "indep"};
    std::vector<std::string> names;
    for (const char* solver : {"libccd", "indep"}) {
      for (const char* tolerance : {"1e-04", "1e-06", "1e-08"}) names.push_back(std::string(solver) + "/" + tolerance);
    }
    return names;
  }

  void ask(const PairSet& set, const std::string& operation, const std::string& config, Pass& pass) {
    prepare(set);
    auto solver = contains(config, "indep") ? fcl::GST_INDEP : fcl::GST_LIBCCD;
    if (operation == "collide") {
      fcl::CollisionRequestd request;
      request.gjk_solver_type = solver;
      fcl::CollisionResultd result;
      pass.run([&](size_t i) {
        result.clear();
        return double(fcl::collide(objects[2 * i].get(), objects[2 * i + 1].get(), request, result) > 0);
      });
      return;
    }
    fcl::DistanceRequestd request;
    request.gjk_solver_type = solver;
    for (const char* tolerance : {"1e-04", "1e-06", "1e-08"}) {
      if (contains(config, tolerance)) request.distance_tolerance = atof(tolerance);
    }
    fcl::DistanceResultd result;
    pass.run([&](size_t i) {
      result.clear();
      return fcl::distance(objects[2 * i].get(), objects[2 * i + 1].get(), request, result);
    });
  }

 private:
  void prepare(const PairSet& set) {
    if (prepared == set.name) return;
    prepared = set.name;
    objects.clear();
    for (uint32_t i = 0; i < set.count; i++) {
      const PairRecord& p = all.pairs[set.first + i];
      objects.emplace_back(new fcl::CollisionObjectd(geometries[p.a], transform(p.rotation_a, p.translation_a)));
      objects.emplace_back(new fcl::CollisionObjectd(geometries[p.b], transform(p.rotation_b, p.translation_b)));
    }
  }

  const Pairs& all;
  std::vector<Geometry> geometries;
  std::string prepared;
  std::vector<Object> objects;
};

int main(int, char** argv) {
  Pairs pairs = read_pairs(argv[1]);
  Fcl fcl(pairs);
  return serve(fcl, pairs);
}
