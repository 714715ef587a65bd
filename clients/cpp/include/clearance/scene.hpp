/// A scene of a daemon, and the questions it answers.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clearance/answers.hpp"
#include "clearance/edits.hpp"
#include "clearance/estimate.hpp"
#include "clearance/question.hpp"
#include "clearance/v1/service.pb.h"

namespace clearance {

class Client;

/// Vectors of joint positions, one a row, in memory that somebody else keeps: radians, metres for sliding joints.
class Rows {
 public:
  /// `data` holds `count` rows of `width` numbers.
  Rows(const double* data, std::size_t count, std::size_t width) : data_(data), count_(count), width_(width) {}
  template <std::size_t N>
  Rows(const std::vector<std::array<double, N>>& rows) : Rows(rows.empty() ? nullptr : rows.front().data(), rows.size(), N) {}
  template <std::size_t N, std::size_t M>
  Rows(const std::array<double, N> (&rows)[M]) : Rows(rows[0].data(), M, N) {}

  const double* row(std::size_t i) const { return data_ + i * width_; }
  std::size_t count() const { return count_; }
  std::size_t width() const { return width_; }

 private:
  const double* data_;
  std::size_t count_;
  std::size_t width_;
};

/// What Scene::apply may be held to.
struct Expected {
  /// Edits are made only if the scene is at that revision; else Conflict.
  std::optional<std::uint64_t> revision;
  /// And in that epoch.
  std::optional<std::uint64_t> epoch;
  /// The same key and edits again are answered as the first time.
  std::string idempotency_key;
};

/// A scene, by its name. Made by Client::create_scene and Client::scene, which it must not outlive.
class Scene {
 public:
  const std::string& name() const { return name_; }

  /// Makes all edits, in order, or none. The answer names the revision that contains them, and the ids of added bodies.
  v1::ApplyResponse apply(const std::vector<v1::Edit>& edits, const Expected& expected = {});
  /// Bodies and robots of the newest revision; of a large scene page by page, as one.
  v1::SceneContents contents();
  /// The scene is gone.
  void remove();

  /// Is the robot free in these states? Measures the nearest pairs unless the question wants something else.
  States check_states(const std::string& robot, Rows states, const Question& question = {});
  /// As check_states, with everything there is to know: which pairs, and where. For a few states; a batch of thousands is
  /// quicker without.
  v1::Answer look_at_states(const std::string& robot, Rows states, const Question& question = {});
  /// Is the robot free all along straight lines of joint positions, from each start to its goal? Proved between states, not
  /// sampled.
  Motions check_motions(const std::string& robot, Rows starts, Rows goals, const Question& question = {});
  /// Is the robot free all along a path, and where is it blocked first?
  Motions check_path(const std::string& robot, Rows waypoints, const Question& question = {});
  /// How far is the nearest body from each subject? Without subjects: the nearest pair of all bodies. Tells points and normals
  /// unless the question wants something else.
  v1::Answer distance(const std::vector<v1::Subject>& subjects = {}, const Question& question = {});
  /// Which bodies does each subject touch? Without subjects: which pairs of all bodies touch.
  v1::Answer collide(const std::vector<v1::Subject>& subjects = {}, const Question& question = {});
  /// Which bodies are within that many metres of each subject? `pairs` of each item.
  v1::Answer clearance(double within, const std::vector<v1::Subject>& subjects = {}, const Question& question = {});
  /// Which pairs of links, and of links and bodies, are within that many metres in each state?
  v1::Answer clearance_of_states(const std::string& robot, Rows states, double within, const Question& question = {});

  /// What would check_states cost, and the others below? One row for each output and tolerance: a sample of the items is asked, and
  /// timed. Of the question count revision, filter, margin, overlay, budget and whatever context() sets; what it wants, its accuracy
  /// and stop_at_first do not, as each row has its own.
  v1::EstimateResponse estimate_states(const std::string& robot, Rows states, const Prices& prices = {}, const Question& question = {});
  v1::EstimateResponse estimate_motions(const std::string& robot, Rows starts, Rows goals, const Prices& prices = {},
                                        const Question& question = {});
  v1::EstimateResponse estimate_path(const std::string& robot, Rows waypoints, const Prices& prices = {}, const Question& question = {});
  /// Without subjects: all pairs, as one item.
  v1::EstimateResponse estimate_distance(const std::vector<v1::Subject>& subjects = {}, const Prices& prices = {},
                                         const Question& question = {});
  v1::EstimateResponse estimate_collide(const std::vector<v1::Subject>& subjects = {}, const Prices& prices = {},
                                        const Question& question = {});
  v1::EstimateResponse estimate_clearance(double within, const std::vector<v1::Subject>& subjects = {}, const Prices& prices = {},
                                          const Question& question = {});

  /// What the question says, for requests sent with Client::call.
  v1::Context context(const Question& question = {}) const;

 private:
  friend class Client;

  Scene(Client& client, std::string name) : client_(&client), name_(std::move(name)) {}
  v1::Context context(const Question& question, Want by_default, v1::AnswerForm form) const;
  v1::CheckStatesRequest states_request(const std::string& robot, const Rows& states, const Question& question, Want by_default,
                                        v1::AnswerForm form) const;
  v1::CheckMotionsRequest motions_request(const std::string& robot, const Rows& starts, const Rows& goals, const Question& question) const;
  v1::CheckPathRequest path_request(const std::string& robot, const Rows& waypoints, const Question& question) const;
  v1::DistanceRequest distance_request(const std::vector<v1::Subject>& subjects, const Question& question) const;
  v1::CollideRequest collide_request(const std::vector<v1::Subject>& subjects, const Question& question) const;
  v1::ClearanceRequest clearance_request(double within, const std::vector<v1::Subject>& subjects, const Question& question) const;
  v1::ClearanceRequest clearance_of_states_request(const std::string& robot, const Rows& states, double within,
                                                   const Question& question) const;
  v1::EstimateResponse estimate(v1::EstimateRequest& request, const Prices& prices, const Question& question);

  Client* client_;
  std::string name_;
};

}  // namespace clearance
