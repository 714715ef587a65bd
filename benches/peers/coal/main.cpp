// Coal as a contender, in every way of calling it that may be the fastest. A configuration is words joined by "/":
//
//   gjk, nesterov, polyak     the variant of GJK
//   1e-04, 1e-06, 1e-08       the tolerance of GJK and EPA
//   functor, free, kept       who owns the solver: `ComputeDistance`/`ComputeCollision` made before the clock starts,
//                             one a pair; the free functions `distance`/`collide`; one solver kept over all pairs and
//                             Coal's table of functions called with it
//   early                     booleans: `distance_upper_bound = 0`, which lets GJK stop at the first separating plane
//   obbrss, rss, kios, obb    meshes: the bounding volumes of the tree
//   cold, warm                tracks: each pair anew, or from the guess that the step before left
#include <map>

#include "../contender.hpp"
#include "coal/collision.h"
#include "coal/collision_func_matrix.h"
#include "coal/distance.h"
#include "coal/distance_func_matrix.h"
#include "shapes.hpp"

using namespace coal;
using Words = std::vector<std::string>;

static Words split(const std::string& text) {
  Words words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, '/');) words.push_back(word);
  return words;
}

static bool has(const Words& words, const char* word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

static bool starts_with(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }

// The part of a request that distance and collision have in common.
template <class Request>
static Request request_for(const Words& config) {
  Request request;
  if (has(config, "nesterov")) request.gjk_variant = NesterovAcceleration;
  if (has(config, "polyak")) request.gjk_variant = PolyakAcceleration;
  for (const char* tolerance : {"1e-04", "1e-06", "1e-08"}) {
    if (has(config, tolerance)) request.gjk_tolerance = request.epa_tolerance = atof(tolerance);
  }
  return request;
}

static DistanceRequest distance_request(const Words& config, const std::string& operation) {
  auto request = request_for<DistanceRequest>(config);
  request.enable_signed_distance = operation == "penetration";
  return request;
}

static CollisionRequest collision_request(const Words& config) {
  auto request = request_for<CollisionRequest>(config);
  request.num_max_contacts = 1;
  request.enable_contact = false;
  if (has(config, "early")) request.distance_upper_bound = 0;
  return request;
}

class Coal {
 public:
  explicit Coal(const Pairs& pairs) : all(pairs) {
    for (const ShapeRecord& shape : all.shapes) convex.push_back(make_convex(shape));
    for (size_t i = 0; i < all.shapes.size(); i++) {
      const ShapeRecord& shape = all.shapes[i];
      if (shape.kind != Kind::Mesh) continue;
      meshes["obbrss"][i] = make_mesh<OBBRSS>(shape);
      meshes["rss"][i] = make_mesh<RSS>(shape);
      meshes["kios"][i] = make_mesh<kIOS>(shape);
      meshes["obb"][i] = make_mesh<OBB>(shape);
    }
    for (auto& geometry : convex) {
      if (geometry) geometry->computeLocalAABB();
    }
  }

  Words configs(const PairSet& set, const std::string& operation) const {
    bool boolean = operation == "collide";
    Words names;
    if (starts_with(set.name, "mesh")) {
      if (operation == "penetration") return {};
      // Coal has no distance between trees of plain OBB.
      names = boolean ? Words{"obbrss", "rss", "kios", "obb"} : Words{"obbrss", "rss", "kios"};
    } else if (starts_with(set.name, "warm")) {
      if (operation != "distance") return {};
      return {"gjk/1e-06/cold", "gjk/1e-06/warm", "polyak/1e-06/cold", "polyak/1e-06/warm"};
    } else {
      for (const char* variant : {"gjk", "nesterov", "polyak"}) {
        for (const char* tolerance : {"1e-04", "1e-06", "1e-08"}) {
          for (const char* owner : {"functor", "free", "kept"}) {
            names.push_back(std::string(variant) + "/" + tolerance + "/" + owner);
          }
        }
      }
    }
    if (boolean) {
      for (size_t i = 0, plain = names.size(); i < plain; i++) names.push_back(names[i] + "/early");
    }
    return names;
  }

  void ask(const PairSet& set, const std::string& operation, const std::string& config, Pass& pass) {
    prepare(set);
    Words words = split(config);
    if (operation == "collide") {
      collide_pairs(words, collision_request(words), pass);
    } else if (has(words, "warm")) {
      follow_tracks(set, distance_request(words, operation), pass);
    } else {
      distance_pairs(words, distance_request(words, operation), pass);
    }
  }

 private:
  // A pair of the current set, ready to be asked about.
  struct Placed {
    uint32_t shape_a, shape_b;
    Transform3s at_a, at_b;
  };

  void prepare(const PairSet& set) {
    if (prepared == set.name) return;
    prepared = set.name;
    placed.clear();
    distance_functors.clear();
    collision_functors.clear();
    for (uint32_t i = 0; i < set.count; i++) {
      const PairRecord& p = all.pairs[set.first + i];
      placed.push_back({p.a, p.b, transform(p.rotation_a, p.translation_a), transform(p.rotation_b, p.translation_b)});
      if (starts_with(set.name, "mesh")) continue;
      distance_functors.emplace_back(new ComputeDistance(convex[p.a].get(), convex[p.b].get()));
      collision_functors.emplace_back(new ComputeCollision(convex[p.a].get(), convex[p.b].get()));
    }
  }

  // The geometry of every shape under the bounding volume that the configuration names, if it names one.
  std::vector<const CollisionGeometry*> geometries(const Words& config) {
    std::vector<const CollisionGeometry*> found;
    for (auto& geometry : convex) found.push_back(geometry.get());
    for (auto& [volume, shapes] : meshes) {
      if (!has(config, volume.c_str())) continue;
      for (auto& [index, geometry] : shapes) found[index] = geometry.get();
    }
    return found;
  }

  void distance_pairs(const Words& config, const DistanceRequest& request, Pass& pass) {
    DistanceResult result;
    auto geometry = geometries(config);
    GJKSolver solver(request);
    if (has(config, "functor") || has(config, "cold")) {
      pass.run([&](size_t i) {
        const Placed& pair = placed[i];
        result.clear();
        return (*distance_functors[i])(pair.at_a, pair.at_b, request, result);
      });
    } else if (has(config, "kept")) {
      pass.run([&](size_t i) {
        const Placed& pair = placed[i];
        auto a = geometry[pair.shape_a], b = geometry[pair.shape_b];
        result.clear();
        auto function = distances.distance_matrix[a->getNodeType()][b->getNodeType()];
        return function(a, pair.at_a, b, pair.at_b, &solver, request, result);
      });
    } else {
      pass.run([&](size_t i) {
        const Placed& pair = placed[i];
        result.clear();
        return distance(geometry[pair.shape_a], pair.at_a, geometry[pair.shape_b], pair.at_b, request, result);
      });
    }
  }

  void collide_pairs(const Words& config, const CollisionRequest& request, Pass& pass) {
    CollisionResult result;
    auto geometry = geometries(config);
    GJKSolver solver(request);
    if (has(config, "functor")) {
      pass.run([&](size_t i) {
        const Placed& pair = placed[i];
        result.clear();
        return double((*collision_functors[i])(pair.at_a, pair.at_b, request, result) > 0);
      });
    } else if (has(config, "kept")) {
      pass.run([&](size_t i) {
        const Placed& pair = placed[i];
        auto a = geometry[pair.shape_a], b = geometry[pair.shape_b];
        result.clear();
        auto function = collisions.collision_matrix[a->getNodeType()][b->getNodeType()];
        return double(function(a, pair.at_a, b, pair.at_b, &solver, request, result) > 0);
      });
    } else {
      pass.run([&](size_t i) {
        const Placed& pair = placed[i];
        result.clear();
        auto a = geometry[pair.shape_a], b = geometry[pair.shape_b];
        return double(collide(a, pair.at_a, b, pair.at_b, request, result) > 0);
      });
    }
  }

  // Each step of a track starts from the direction and the two vertices that the step before ended with.
  void follow_tracks(const PairSet& set, DistanceRequest request, Pass& pass) {
    DistanceResult result;
    request.gjk_initial_guess = GJKInitialGuess::CachedGuess;
    pass.run([&](size_t i) {
      const Placed& pair = placed[i];
      if (i % set.track_length == 0) {
        request.cached_gjk_guess = Vec3s(1, 0, 0);
        request.cached_support_func_guess.setZero();
      } else {
        request.updateGuess(result);
      }
      result.clear();
      return (*distance_functors[i])(pair.at_a, pair.at_b, request, result);
    });
  }

  const Pairs& all;
  std::vector<Geometry> convex;
  std::map<std::string, std::map<size_t, Geometry>> meshes;
  DistanceFunctionMatrix distances;
  CollisionFunctionMatrix collisions;
  std::string prepared;
  std::vector<Placed> placed;
  std::vector<std::unique_ptr<ComputeDistance>> distance_functors;
  std::vector<std::unique_ptr<ComputeCollision>> collision_functors;
};

int main(int, char** argv) {
  Pairs pairs = read_pairs(argv[1]);
  Coal coal(pairs);
  return serve(coal, pairs);
}
