// What questions would cost. Oracle: verdicts worked out by hand, and the tolerances themselves; of times, that they are there.

#include <array>
#include <chrono>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <clearance/clearance.hpp>
#include <doctest/doctest.h>

#include "crane.hpp"
#include "daemon.hpp"

using namespace clearance;

namespace {

constexpr double half_pi = 1.57079632679489661923;

/// Three cones in a row, 2 m from one to the next, each turned otherwise: their brackets have to be narrowed.
std::vector<v1::Subject> add_cones(Scene& scene) {
  std::vector<v1::Edit> edits;
  std::vector<v1::Subject> subjects;
  for (int i = 0; i < 3; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    edits.push_back(add_body(name, cone(0.3, 0.4), pose({2.0 * i, 0, 0}, {1, 0, 0.3 * i, 0})));
    subjects.push_back(subject(name));
  }
  scene.apply(edits);
  return subjects;
}

Prices at_tolerances(std::vector<double> tolerances, std::vector<v1::Output> outputs = {}) {
  Prices prices;
  prices.tolerances = std::move(tolerances);
  prices.outputs = std::move(outputs);
  return prices;
}

void measured(const v1::EstimateResponse& told) {
  for (const auto& row : told.rows()) {
    CHECK(row.complete());
    CHECK(row.has_mean_cost());
    CHECK(row.times().median() > 0);
    CHECK(row.times().median() <= row.times().p99());
  }
}

/// Runs what must be refused, and tells which field is wrong.
template <typename F>
std::string refused_field(F&& run) {
  try {
    run();
  } catch (const InvalidRequest& error) {
    return error.field;
  }
  return "nothing was thrown";
}

}  // namespace

TEST_CASE("an estimate has a row for each tolerance") {
  Daemon daemon;
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  const auto subjects = add_cones(scene);
  const auto prices = at_tolerances({1e-2, 1e-6}, {v1::OUTPUT_DISTANCE});
  const auto told = scene.estimate_distance(subjects, prices);
  CHECK(told.items() == 3);
  CHECK(told.sample() == 3);
  CHECK(told.revision() == 1);
  CHECK(told.end() == v1::ESTIMATE_END_COMPLETE);
  REQUIRE(told.rows_size() == 2);
  measured(told);
  for (int i = 0; i < 2; ++i) {
    const auto& row = told.rows(i);
    const double tolerance = prices.tolerances[static_cast<std::size_t>(i)];
    CHECK(row.output() == v1::OUTPUT_DISTANCE);
    CHECK(row.tolerance() == tolerance);
    CHECK(row.verdicts().free() == 3);
    CHECK(row.widths().items() == 3);
    CHECK(row.widths().wider() == 0);
    CHECK(row.widths().largest() <= tolerance);
  }

  // Of a sample, on the daemon's ladder.
  Prices ladder;
  ladder.outputs = {v1::OUTPUT_DISTANCE};
  ladder.sample = 2;
  const auto left_to_itself = scene.estimate_distance(subjects, ladder);
  CHECK(left_to_itself.sample() == 2);
  REQUIRE(left_to_itself.rows_size() == 10);
  CHECK(left_to_itself.rows(0).tolerance() == 0.1);
  CHECK(left_to_itself.rows(9).has_tolerance());
  // No machine has measured anything after a nanosecond.
  auto hurried = prices;
  hurried.time = std::chrono::nanoseconds(1);
  const auto nothing = scene.estimate_distance(subjects, hurried);
  CHECK(nothing.end() == v1::ESTIMATE_END_TIME);
  CHECK_FALSE(nothing.rows(0).has_times());
}

TEST_CASE("an estimate is of the question as it is asked") {
  Daemon daemon;
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  const auto subjects = add_cones(scene);
  const auto prices = at_tolerances({1e-3}, {v1::OUTPUT_DISTANCE});
  const auto counts = [&](const Question& question) { return scene.estimate_distance(subjects, prices, question).rows(0).verdicts(); };
  CHECK(counts(Question().margin(10).stop_at_first()).margin() == 3);
  v1::Overlay overlay;
  *overlay.add_edits() = move_body("a", at(2, 0, 0));
  const auto what = counts(Question().what_if(overlay));
  CHECK(what.collision() == 2);
  CHECK(what.free() == 1);
  // Cones are nothing for separating axes.
  Question axes;
  axes.context().set_solver(v1::SOLVER_SAT);
  CHECK(counts(axes).invalid_input() == 3);
  // Each question has its own outputs; without subjects all pairs are one item.
  const auto every = at_tolerances({1e-3});
  const auto touching = scene.estimate_collide({}, every);
  CHECK(touching.items() == 1);
  CHECK(touching.rows_size() == 6);
  const auto near = scene.estimate_clearance(2, subjects, every);
  CHECK(near.items() == 3);
  CHECK(near.rows_size() == 5);
}

TEST_CASE("estimates of a robot") {
  Daemon daemon;
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  scene.apply({add_robot("crane", client.load_robot(described(crane))), add_body("wall", box(0.1, 0.5, 0.5), at(0, 1, 0))});
  const auto prices = at_tolerances({1e-2, 1e-3});
  const std::vector<std::array<double, 2>> states{{0, -0.5}, {half_pi, -0.5}, {-1, -0.5}};
  // Verdict and pairs, which no tolerance changes; distance, witness, depth, patch and derivatives.
  const auto of = scene.estimate_states("crane", states, prices);
  CHECK(of.items() == 3);
  REQUIRE(of.rows_size() == 2 + 5 * 2);
  CHECK(of.rows(0).output() == v1::OUTPUT_VERDICT);
  CHECK_FALSE(of.rows(0).has_tolerance());
  CHECK(of.rows(0).verdicts().free() == 2);
  CHECK(of.rows(0).verdicts().collision() == 1);
  measured(of);
  const std::vector<std::array<double, 2>> goals{{0.2, -0.5}, {1, -0.5}};
  const auto motions = scene.estimate_motions("crane", Rows(states[0].data(), 2, 2), goals, prices);
  CHECK(motions.items() == 2);
  REQUIRE(motions.rows_size() == 6 * 2);
  CHECK(motions.rows(0).tolerance() == 1e-2);
  CHECK(motions.rows(0).verdicts().free() == 1);
  CHECK(motions.rows(0).verdicts().collision() == 1);
  measured(motions);
  const std::vector<std::array<double, 2>> waypoints{{-1, 0}, {0, 0}, {half_pi, 0}, {3, 0}};
  const auto path = scene.estimate_path("crane", waypoints, prices);
  CHECK(path.items() == 3);
  CHECK(path.rows_size() == 6 * 2);
  measured(path);
  CHECK_THROWS_AS(scene.estimate_states("crane", Rows(states[0].data(), 1, 4), prices), std::invalid_argument);
  CHECK_THROWS_AS(scene.estimate_motions("crane", states, goals, prices), std::invalid_argument);
}

TEST_CASE("what cannot be estimated is named") {
  Daemon daemon;
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  const auto subjects = add_cones(scene);
  const auto no_number = at_tolerances({1, std::numeric_limits<double>::quiet_NaN()});
  CHECK(refused_field([&] { scene.estimate_distance(subjects, no_number); }) == "tolerances[1]");
  CHECK(refused_field([&] { scene.estimate_distance(subjects, {}, Question().margin(-1)); }) == "question.context.margin");
  const auto verdict = at_tolerances({}, {v1::OUTPUT_VERDICT});
  CHECK(refused_field([&] { scene.estimate_distance(subjects, verdict); }) == "outputs[0]");
}
