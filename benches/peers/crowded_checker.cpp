// The usual libraries among ten thousand bodies: pinocchio for the robot's kinematics and its pairs of links, and between
// the robot and the scene Coal's DynamicAABBTreeCollisionManager, all in C++.
//
// pinocchio's own BroadPhaseManager takes the bodies as geometry objects of its model, each of which copies a matrix of
// all pairs when it is added: 3000 bodies take 38 s. Its list of pairs has the same matrix.
//
//   crowded_checker ROBOT_FOLDER NAME SCENES      reads the text that the benchmark `states` writes
//
// A verdict stops at the first hit and asks for no contact, which is the fastest that Coal can be asked. A distance is
// the least signed one, penetration included; the search starts from the least distance between links. Both are asked
// in several ways before the first pass, and then in the fastest: links first or scene first, and a query for each link
// or a tree of links against the tree of bodies. For each line on standard input it makes one pass over all states and
// prints the line of JSON that `usual_checker.py` prints, and the ways taken.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "pinocchio/parsers/urdf.hpp"
// The readers come before what uses the models.
#include "coal/BVH/BVH_model.h"
#include "coal/broadphase/broadphase.h"
#include "coal/distance.h"
#include "coal/shape/geometric_shapes.h"
#include "pinocchio/algorithm/geometry.hpp"
#include "pinocchio/collision/collision.hpp"
#include "pinocchio/collision/distance.hpp"
#include "pinocchio/parsers/srdf.hpp"

using namespace coal;
namespace pin = pinocchio;

[[noreturn]] static void fail(const std::string& what) {
  fprintf(stderr, "%s\n", what.c_str());
  exit(1);
}

struct State {
  Eigen::VectorXd positions;
  bool collides;
  double distance;
};

struct CrowdedScene {
  std::vector<std::unique_ptr<CollisionObject>> bodies;
  DynamicAABBTreeCollisionManager tree;
  std::vector<State> states;
};

static std::shared_ptr<CollisionGeometry> shape(const std::string& kind, double a, double b, double c) {
  if (kind == "box") return std::make_shared<Box>(2 * a, 2 * b, 2 * c);
  if (kind == "cylinder") return std::make_shared<Cylinder>(a, 2 * b);
  if (kind == "sphere") return std::make_shared<Sphere>(a);
  fail("a scene has a " + kind);
}

static std::unique_ptr<CrowdedScene> read_scene(std::istream& in, size_t joints) {
  auto scene = std::make_unique<CrowdedScene>();
  size_t bodies, states;
  in >> bodies >> states;
  for (size_t i = 0; i < bodies; i++) {
    std::string kind;
    double l[3], t[3], q[4];
    in >> kind >> l[0] >> l[1] >> l[2] >> t[0] >> t[1] >> t[2] >> q[0] >> q[1] >> q[2] >> q[3];
    Matrix3s rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    auto body = shape(kind, l[0], l[1], l[2]);
    scene->bodies.push_back(std::make_unique<CollisionObject>(body, rotation, Vec3s(t[0], t[1], t[2])));
  }
  std::vector<CollisionObject*> all;
  for (auto& body : scene->bodies) all.push_back(body.get());
  scene->tree.registerObjects(all);
  scene->tree.setup();
  for (size_t i = 0; i < states; i++) {
    State state{Eigen::VectorXd(Eigen::Index(joints)), false, 0};
    for (auto& position : state.positions) in >> position;
    in >> state.collides >> state.distance;
    scene->states.push_back(state);
  }
  if (!in) fail("the scenes end early");
  return scene;
}

// Stops at the first hit.
struct AnyHit : CollisionCallBackBase {
  CollisionRequest request;
  CollisionResult result;
  bool hit = false;

  AnyHit() {
    request.num_max_contacts = 1;
    request.enable_contact = false;
    request.distance_upper_bound = 0;
  }
  bool collide(CollisionObject* a, CollisionObject* b) override {
    result.clear();
    hit = coal::collide(a, b, request, result) > 0;
    return hit;
  }
};

// The least signed distance: a hit does not end the search, but boxes that do not overlap end with it.
struct Least : DistanceCallBackBase {
  DistanceRequest request;
  DistanceResult result;
  double least = 0;

  Least() { request.enable_signed_distance = true; }
  bool distance(CollisionObject* a, CollisionObject* b, CoalScalar& bound) override {
    result.clear();
    least = std::min<double>(least, coal::distance(a, b, request, result));
    bound = std::max(least, 1e-300);
    return false;
  }
};

class Robot {
 public:
  Robot(const std::string& folder, const std::string& name) {
    std::string urdf = folder + "/" + name + ".urdf";
    std::ifstream file(urdf);
    std::stringstream text;
    text << file.rdbuf();
    std::string whole = text.str(), package = "package://" + name + "/";
    for (size_t at; (at = whole.find(package)) != std::string::npos;) whole.replace(at, package.size(), folder + "/");
    pin::urdf::buildModel(urdf, model);
    std::istringstream stream(whole);
    pin::urdf::buildGeom(model, stream, pin::COLLISION, geometry);
    for (auto& item : geometry.geometryObjects) {
      auto mesh = std::dynamic_pointer_cast<BVHModelBase>(item.geometry);
      if (!mesh) continue;
      mesh->buildConvexRepresentation(false);
      item.geometry = mesh->convex;
    }
    geometry.addAllCollisionPairs();
    pin::srdf::removeCollisionPairs(model, geometry, folder + "/" + name + ".srdf");
    data = pin::Data(model);
    geometry_data = pin::GeometryData(geometry);
    for (auto& request : geometry_data.collisionRequests) {
      request.enable_contact = false;
      request.distance_upper_bound = 0;
    }
    for (auto& item : geometry.geometryObjects) {
      links.push_back(std::make_unique<CollisionObject>(item.geometry));
      tree.registerObject(links.back().get());
    }
    tree.setup();
  }

  void move_to(const Eigen::VectorXd& positions, bool with_tree) {
    pin::updateGeometryPlacements(model, data, geometry, geometry_data, positions);
    for (size_t i = 0; i < links.size(); i++) {
      links[i]->setTransform(pin::toCoalTransform3s(geometry_data.oMg[i]));
      links[i]->computeAABB();
    }
    if (with_tree) tree.update();
  }

  bool hits_itself() { return pin::computeCollisions(geometry, geometry_data, true); }

  double own_distance() {
    size_t nearest = pin::computeDistances(geometry, geometry_data);
    return geometry_data.distanceResults[nearest].min_distance;
  }

  pin::Model model;
  pin::Data data;
  pin::GeometryModel geometry;
  pin::GeometryData geometry_data;
  std::vector<std::unique_ptr<CollisionObject>> links;
  DynamicAABBTreeCollisionManager tree;
};

struct Way {
  bool scene_first, with_tree;

  std::string name() const {
    return std::string(with_tree ? "tree of links" : "link by link") + (scene_first ? ", scene first" : ", links first");
  }
};

static bool collides(Robot& robot, CrowdedScene& scene, const State& state, const Way& way) {
  robot.move_to(state.positions, way.with_tree);
  if (!way.scene_first && robot.hits_itself()) return true;
  AnyHit any;
  if (way.with_tree) {
    scene.tree.collide(&robot.tree, &any);
  } else {
    for (size_t i = 0; i < robot.links.size() && !any.hit; i++) scene.tree.collide(robot.links[i].get(), &any);
  }
  return any.hit || (way.scene_first && robot.hits_itself());
}

static double distance(Robot& robot, CrowdedScene& scene, const State& state, const Way& way) {
  robot.move_to(state.positions, way.with_tree);
  Least search;
  search.least = robot.own_distance();
  if (way.with_tree) {
    scene.tree.distance(&robot.tree, &search);
  } else {
    for (auto& link : robot.links) scene.tree.distance(link.get(), &search);
  }
  return search.least;
}

int main(int count, char** arguments) {
  if (count != 4) fail("usage: crowded_checker ROBOT_FOLDER NAME SCENES");
  Robot robot(arguments[1], arguments[2]);
  std::ifstream in(arguments[3]);
  std::vector<std::unique_ptr<CrowdedScene>> scenes;
  for (std::string word; in >> word;) scenes.push_back(read_scene(in, size_t(robot.model.nq)));
  size_t states = 0;
  for (auto& scene : scenes) states += scene->states.size();
  if (!states) fail("no scenes");

  // Seconds of a pass in that way, and the number of wrong answers.
  auto pass = [&](bool verdict, const Way& way) {
    auto start = std::chrono::steady_clock::now();
    size_t wrong = 0;
    for (auto& scene : scenes) {
      for (auto& state : scene->states) {
        if (verdict) {
          wrong += collides(robot, *scene, state, way) != state.collides;
        } else {
          wrong += !(std::abs(distance(robot, *scene, state, way) - state.distance) <= 1e-5);
        }
      }
    }
    double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::pair(seconds, wrong);
  };
  auto fastest = [&](bool verdict, std::vector<Way> ways) {
    Way best = ways[0];
    double least = INFINITY;
    for (auto& way : ways) {
      double seconds = std::min(pass(verdict, way).first, pass(verdict, way).first);
      const char* question = verdict ? "verdict" : "distance";
      fprintf(stderr, "%s, %s: %.0f states/s\n", question, way.name().c_str(), double(states) / seconds);
      if (seconds < least) least = seconds, best = way;
    }
    return best;
  };
  fprintf(stderr, "%zu pairs of links\n", robot.geometry.collisionPairs.size());
  Way for_verdicts = fastest(true, {{false, false}, {false, true}, {true, false}, {true, true}});
  Way for_distances = fastest(false, {{false, false}, {false, true}});
  printf("ready\n");
  fflush(stdout);
  for (std::string line; std::getline(std::cin, line); fflush(stdout)) {
    auto [verdict_seconds, wrong_verdicts] = pass(true, for_verdicts);
    auto [distance_seconds, wrong_distances] = pass(false, for_distances);
    printf("{\"verdict\": %.1f, \"distance\": %.1f, \"wrong_verdicts\": %zu, \"wrong_distances\": %zu, ",
           double(states) / verdict_seconds, double(states) / distance_seconds, wrong_verdicts, wrong_distances);
    std::string verdict_way = for_verdicts.name(), distance_way = for_distances.name();
    printf("\"verdict_way\": \"%s\", \"distance_way\": \"%s\"}\n", verdict_way.c_str(), distance_way.c_str());
  }
  return 0;
}
