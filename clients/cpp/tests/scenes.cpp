// Scenes, robots and questions against a real daemon. What is expected is worked out by hand: balls and boxes along axes.

#include <array>
#include <cmath>
#include <map>

#include <clearance/clearance.hpp>
#include <doctest/doctest.h>

#include "crane.hpp"
#include "daemon.hpp"

using namespace clearance;

namespace {

constexpr double pi = 3.14159265358979323846;

void tightly_around(double truth, const v1::Bracket& bracket) {
  CHECK(bracket.lower() <= truth);
  CHECK(truth <= bracket.upper());
  CHECK(bracket.upper() - bracket.lower() < 1e-6);
}

}  // namespace

TEST_CASE("distance and depth of balls") {
  Daemon daemon;
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  const auto applied = scene.apply({
      add_body("a", sphere(0.5)),
      add_body("b", ball_swept(sphere(0.25), 0.25), at(3, 0, 0)),
  });
  CHECK(applied.revision() == 1);
  REQUIRE(applied.added_size() == 2);
  const auto apart = scene.distance().items(0).nearest();
  tightly_around(2.0, apart.bracket());
  CHECK(std::abs(point_of(apart.witness().point_on_b())[0] - 2.5) < 1e-9);
  CHECK(!apart.has_derivatives());
  const auto exact = scene.distance({}, Question().derivatives()).items(0).nearest().derivatives();
  CHECK(exact.method() == v1::DERIVATIVE_METHOD_EXACT);
  CHECK(std::abs(exact.conditioning() - 3.0) < 1e-9);
  REQUIRE(exact.of_b().signed_distance_size() == 6);
  for (int column = 0; column < 6; ++column) {
    CHECK(std::abs(exact.of_b().signed_distance(column) - (column == 0 ? 1.0 : 0.0)) < 1e-9);
  }
  CHECK(exact.of_a().normal_size() == 18);
  v1::DerivativeOptions differences;
  differences.set_method(v1::DERIVATIVE_METHOD_FINITE_DIFFERENCE);
  const auto told = scene.distance({}, Question().derivatives(differences)).items(0).nearest().derivatives();
  CHECK(told.method() == differences.method());
  const auto inside = subject(sphere(0.1), at(0.5, 0, 0));
  const auto probed = scene.distance({inside}, Question().want(Want::depth)).items(0);
  CHECK(probed.verdict() == v1::VERDICT_COLLISION);
  tightly_around(-0.1, probed.nearest().bracket());
  CHECK(scene.collide({inside}, Question().ignore({"a"})).items(0).verdict() == v1::VERDICT_FREE);
  const auto near = scene.clearance(2.1).items(0);
  REQUIRE(near.pairs_size() == 1);
  CHECK(near.pairs(0).a().body().id() == applied.added(0));
  CHECK(scene.clearance(1.9).items(0).pairs_size() == 0);
  CHECK(scene.contents().bodies(1).name() == "b");
  CHECK(client.list_scenes().size() == 1);
  CHECK(client.server_info().threads() > 0);
}

TEST_CASE("every edit and every shape is taken") {
  Daemon daemon;
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  const auto model = client.load_robot(described(crane));
  const std::vector<Point> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::map<std::string, v1::Shape> shapes{
      {"sphere", sphere(0.1)},
      {"box", box(0.1, 0.2, 0.3)},
      {"capsule", capsule(0.1, 0.2)},
      {"cylinder", cylinder(0.1, 0.2)},
      {"cone", cone(0.1, 0.2)},
      {"ellipsoid", ellipsoid(0.1, 0.2, 0.3)},
      {"convex", convex(corners)},
      {"mesh", mesh(corners, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}, v1::MESH_MODE_SOLID)},
      {"compound", compound({{sphere(0.1), at(1, 0, 0)}, {box(1, 1, 1), {}}})},
      {"point_cloud", point_cloud(corners, 0.01)},
      {"voxels", voxels(0.1)},
      {"half_space", half_space({0, 0, 1}, -50)},
      {"plane", plane({1, 0, 0}, 90)},
  };
  std::vector<v1::Edit> edits;
  for (const auto& [kind, shape] : shapes) edits.push_back(add_body(kind, shape, at(3.0 * double(edits.size()), 0, 5)));
  const auto applied = scene.apply(edits);
  const auto contents = scene.contents();
  for (const auto& body : contents.bodies()) CHECK(body.shape_kind() == body.name());
  Expected expected;
  expected.revision = applied.revision();
  expected.epoch = applied.epoch();
  expected.idempotency_key = "once";
  const std::vector<v1::Edit> more{
      add_robot("arm", model),
      move_robot("arm", at(-50, 0, 0)),
      move_body("box", at(0, 50, 0)),
      move_body(applied.added(0), at(0, 60, 0)),
      replace_shape("cone", sphere(0.2)),
      insert_points("voxels", corners),
      clear_box("voxels", {-1, -1, -1}, {2, 2, 0.5}),
      set_enabled("mesh", false),
      allow_collision(one_body("box"), all_links("arm")),
      allow_collision(one_link("arm", "boom"), group("fixtures"), false),
      set_pair_margin(one_body("box"), everything(), 0.1),
      declare_effects(one_body("box"), everything(), {v1::EFFECT_MARGIN}),
      remove_body("plane"),
  };
  // The same key again is answered, not applied.
  CHECK(scene.apply(more, expected).revision() == scene.apply(more, expected).revision());
  CHECK(scene.contents().robots_size() == 1);
  CHECK(scene.contents().bodies_size() == static_cast<int>(shapes.size()) - 1);
  scene.apply({remove_robot("arm")});
  CHECK(scene.contents().robots_size() == 0);
}

TEST_CASE("states, motions and paths of a robot") {
  Daemon daemon;
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  const auto robot = client.load_robot(described(crane));
  CHECK(robot.degrees_of_freedom == 2);
  CHECK(robot.links == std::vector<std::string>{"foot", "boom", "hook"});
  CHECK(robot.lower == std::vector<double>{-3, -1});
  CHECK(robot.upper == std::vector<double>{3, 0});
  const auto applied = scene.apply({add_robot("crane", robot), add_body("wall", box(0.1, 0.5, 0.5), at(0, 1, 0))});
  const std::vector<std::array<double, 2>> states{{0, -0.5}, {pi / 2, -0.5}, {-1, -0.5}};
  const auto checked = scene.check_states("crane", states, Question().at_least(applied.revision()));
  CHECK(checked.verdicts == std::vector<Verdict>{Verdict::free, Verdict::collision, Verdict::free});
  CHECK_FALSE(checked.stopped_at);
  CHECK_FALSE(checked.out_of_time);
  CHECK(checked.cost.pairs() > 0);
  CHECK(checked.nearest.lower.at(0) > 0);
  const auto first = scene.check_states("crane", states, Question().stop_at_first().want(Want::verdict));
  CHECK(first.stopped_at == std::size_t{1});
  CHECK(first.verdicts[2] == Verdict::not_run);
  CHECK(first.nearest_self.lower.empty());
  const auto seen = scene.look_at_states("crane", Rows(states[1].data(), 1, 2));
  REQUIRE(seen.items(0).pairs_size() > 0);
  CHECK(seen.items(0).pairs(0).has_witness());

  const std::vector<std::array<double, 2>> goals{{0.2, -0.5}, {1, -0.5}};
  const auto motions = scene.check_motions("crane", Rows(states[0].data(), 2, 2), goals);
  CHECK(motions.verdicts == std::vector<Verdict>{Verdict::free, Verdict::collision});
  CHECK(motions.free_until[0] == 1.0);
  CHECK(std::isnan(motions.reached_from[0]));
  CHECK(motions.reached_to[1] == 0.0);
  const std::vector<std::array<double, 2>> waypoints{{-1, 0}, {0, 0}, {pi / 2, 0}, {3, 0}};
  const auto path = scene.check_path("crane", waypoints);
  CHECK(path.stopped_at == std::size_t{1});
  CHECK(path.verdicts[2] == Verdict::not_run);

  const auto near = scene.clearance_of_states("crane", Rows(states[0].data(), 1, 2), 10, Question().max_pairs(1));
  CHECK(near.items(0).pairs_size() == 1);
  CHECK(near.items(0).truncated());
  // Only this question sees the wall elsewhere.
  v1::Overlay overlay;
  *overlay.add_edits() = move_body("wall", at(0, 9, 0));
  const auto what = scene.check_states("crane", Rows(states[1].data(), 1, 2), Question().what_if(overlay));
  CHECK(what.verdicts[0] == Verdict::free);
  CHECK_THROWS_AS(scene.check_states("crane", Rows(states[0].data(), 1, 4)), std::invalid_argument);
  CHECK_THROWS_AS(scene.check_motions("crane", states, goals), std::invalid_argument);
}

TEST_CASE("meshes are uploaded once") {
  Daemon daemon;
  Client client(daemon.address());
  const std::filesystem::path folder = told("CLEARANCE_ROOT") + "/tests/data/robot-ur5";
  const auto description = RobotDescription::read(folder / "ur5.urdf", folder / "ur5.srdf");
  CHECK(description.meshes.size() == 17);
  CHECK(client.load_robot(description).id == client.load_robot(description).id);
  // More than one message, and a file that is there twice.
  const std::string large(2'700'000, 'x');
  const auto hashes = client.upload({large, "small", large});
  CHECK(hashes[0] == hashes[2]);
  CHECK(hashes[0] != hashes[1]);
  v1::HasAssetsRequest asked;
  for (const auto& hash : hashes) asked.add_sha256(hash);
  const auto answer = client.call(client.assets(), &v1::Assets::Stub::HasAssets, asked);
  for (const bool present : answer.present()) CHECK(present);
  CHECK_THROWS_WITH_AS(RobotDescription::read(folder / "ur5.urdf", {}, {{"ur5", "/nowhere"}}),
                       "/nowhere/meshes/base_link_0.obj: cannot be read", std::runtime_error);
  CHECK_THROWS_AS(mesh_names("<robot"), std::runtime_error);
}

TEST_CASE("streams of the generated stubs") {
  Daemon daemon;
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  scene.apply({add_body("a", sphere(1))});

  grpc::ClientContext watching;
  client.prepare(watching);
  v1::WatchRequest request;
  request.set_scene("cell");
  const auto watch = client.scenes().Watch(&watching, request);
  v1::WatchResponse step;
  REQUIRE(watch->Read(&step));
  CHECK(step.revision() == 1);
  CHECK(step.bodies_size() == 1);

  grpc::ClientContext asking;
  client.prepare(asking);
  const auto stream = client.queries().QueryStream(&asking);
  v1::QueryStreamRequest question;
  question.mutable_options()->set_in_order(true);
  REQUIRE(stream->Write(question));
  question.set_id(7);
  *question.mutable_collide()->mutable_context() = scene.context();
  *question.mutable_collide()->add_items() = subject(sphere(1), at(1, 0, 0));
  REQUIRE(stream->Write(question));
  question.mutable_collide()->mutable_context()->set_margin(-1);
  REQUIRE(stream->Write(question));
  stream->WritesDone();
  v1::QueryStreamResponse answer;
  REQUIRE(stream->Read(&answer));
  CHECK(answer.id() == 7);
  CHECK(answer.collide().answer().items(0).verdict() == v1::VERDICT_COLLISION);
  REQUIRE(stream->Read(&answer));
  try {
    throw_refusal(answer.error());
  } catch (const InvalidRequest& error) {
    CHECK(error.field == "context.margin");
    CHECK(error.reason == "INVALID_FIELD");
  }
  CHECK_FALSE(stream->Read(&answer));
  CHECK(stream->Finish().ok());

  scene.remove();
  CHECK_FALSE(watch->Read(&step));
  const auto status = watch->Finish();
  CHECK_THROWS_AS(check(status, watching), NotFound);
}
