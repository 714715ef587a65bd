// A robot in a cell: which of its states are free, how near is the nearest, and what does the daemon say of a mistake?
//
//     clearance serve &
//     first_query [ADDRESS [FOLDER]]
//
// FOLDER holds a robot's ur5.urdf, ur5.srdf and meshes. The examples of all clients print the same text.

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <unistd.h>

#include <clearance/clearance.hpp>

namespace v1 = clearance::v1;

namespace {

using Names = std::map<std::uint64_t, std::string>;

// Joint positions, radians.
const std::vector<std::array<double, 6>> states{
    {-1.6, -0.6, 0.0, -1.57, -1.57, 3.14},
    {-1.2, -0.6, 0.0, -1.57, -1.57, 3.14},
    {0.4, -0.3, 0.2, -1.57, -1.57, 3.14},
};

/// Enough digits to see both ends; `+ 0.0` takes the sign off zero.
std::string bracket(double lower, double upper) {
  char text[80];
  std::snprintf(text, sizeof text, "[%.17f, %.17f] m", lower + 0.0, upper + 0.0);
  return text;
}

std::string point(const v1::Vec3& p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.9f, %.9f, %.9f)", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
  return text;
}

std::string pair_names(const v1::PairAnswer& pair, const Names& names) {
  return names.at(pair.a().body().id()) + " and " + names.at(pair.b().body().id());
}

void ask(clearance::Scene& scene, const clearance::Robot& robot) {
  auto applied = scene.apply({
      clearance::add_robot("arm", robot),
      clearance::add_body("table", clearance::box(1.0, 1.0, 0.02), clearance::at(0.0, 0.0, 0.7)),
      clearance::add_body("post", clearance::capsule(0.05, 0.3), clearance::at(0.5, 0.3, 1.2)),
      clearance::add_body("ball", clearance::ellipsoid(0.3, 0.2, 0.1), clearance::pose({0.2, 0.8, 1.3}, {0.8, 0.2, 0.4, 0.4})),
  });
  const Names names{{applied.added(0), "table"}, {applied.added(1), "post"}, {applied.added(2), "ball"}};
  std::printf("the scene is at revision %llu\n", static_cast<unsigned long long>(applied.revision()));

  // A batch of states: verdicts and proved brackets as arrays.
  using clearance::Question;
  const auto checked = scene.check_states("arm", states, Question().want(clearance::Want::depth).at_least(applied.revision()));
  int free = 0;
  for (std::size_t i = 0; i < checked.verdicts.size(); ++i) {
    const auto nearest = bracket(checked.nearest_scene.lower[i], checked.nearest_scene.upper[i]);
    std::printf("state %zu: %s, to the scene %s\n", i, to_string(checked.verdicts[i]).c_str(), nearest.c_str());
    free += checked.verdicts[i] == clearance::Verdict::free;
  }
  std::printf("%d are free\n", free);

  // A state with everything there is to know.
  const auto seen = scene.look_at_states("arm", clearance::Rows(states[1].data(), 1, 6));
  for (const auto& pair : seen.items(0).pairs()) {
    const auto& link = robot.links[pair.a().link().link()];
    const auto& body = names.at(pair.b().body().id());
    std::printf("state 1: %s and %s, %s\n", link.c_str(), body.c_str(), clearance::to_string(pair.verdict()).c_str());
  }

  // Bodies.
  const auto apart = scene.distance({clearance::subject("ball")});
  const auto& nearest = apart.items(0).nearest();
  std::printf("%s: %s\n", pair_names(nearest, names).c_str(),
              bracket(nearest.bracket().lower(), nearest.bracket().upper()).c_str());
  std::printf("from %s to %s\n", point(nearest.witness().point_on_a()).c_str(), point(nearest.witness().point_on_b()).c_str());

  // An edit, and a question that sees it.
  applied = scene.apply({clearance::move_body("ball", clearance::at(0.5, 0.3, 1.6))});
  const auto touching = scene.collide({clearance::subject("ball")}, Question().at_least(applied.revision()));
  std::string pairs;
  for (const auto& pair : touching.items(0).pairs()) pairs += (pairs.empty() ? "" : ", ") + pair_names(pair, names);
  std::printf("at revision %llu %s: %s\n", static_cast<unsigned long long>(applied.revision()),
              clearance::to_string(touching.items(0).verdict()).c_str(), pairs.c_str());

  try {
    scene.apply({
        clearance::move_body("table", clearance::at(0.0, 0.0, 0.6)),
        clearance::add_body("flag", clearance::box(1.0, -1.0, 0.1)),
    });
  } catch (const clearance::InvalidRequest& error) {
    std::printf("refused: %s, item %zu, field %s\n", error.reason.c_str(), error.item.value(), error.field.c_str());
  }
}

}  // namespace

int main(int count, char** arguments) {
  const std::string address = count > 1 ? arguments[1] : clearance::default_address;
  const std::filesystem::path folder = count > 2 ? arguments[2] : "tests/data/robot-ur5";
  try {
    clearance::Client client(address);
    const auto robot = client.load_robot(clearance::RobotDescription::read(folder / "ur5.urdf", folder / "ur5.srdf"));
    std::printf("robot %s: %zu numbers a state, %zu links\n", robot.name.c_str(), robot.degrees_of_freedom, robot.links.size());
    auto scene = client.create_scene("first query " + std::to_string(getpid()));
    ask(scene, robot);
    scene.remove();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "first_query: %s\n", error.what());
    return 1;
  }
}
