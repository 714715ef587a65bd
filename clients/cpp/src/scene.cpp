#include "clearance/scene.hpp"

#include <stdexcept>
#include <utility>

#include "clearance/client.hpp"

namespace clearance {
namespace {

using Queries = v1::Queries::Stub;

void check_items(const Rows& rows, const v1::Answer& answer) {
  if (static_cast<std::size_t>(answer.items_size()) == rows.count()) return;
  throw std::invalid_argument("states: do not have as many numbers as the robot takes");
}

}  // namespace

v1::ApplyResponse Scene::apply(const std::vector<v1::Edit>& edits, const Expected& expected) {
  v1::ApplyRequest request;
  request.set_scene(name_);
  for (const auto& edit : edits) *request.add_edits() = edit;
  if (expected.revision) request.set_expected_revision(*expected.revision);
  if (expected.epoch) request.set_expected_epoch(*expected.epoch);
  request.set_idempotency_key(expected.idempotency_key);
  return client_->call(client_->scenes(), &v1::Scenes::Stub::Apply, request);
}

v1::SceneContents Scene::contents() {
  v1::GetSceneRequest request;
  request.set_scene(name_);
  auto contents = client_->call(client_->scenes(), &v1::Scenes::Stub::GetScene, request).scene();
  // The other pages are of the first one's state.
  request.mutable_revision()->set_epoch(contents.epoch());
  request.mutable_revision()->set_exactly(contents.revision());
  while (contents.bodies_left() && contents.bodies_size() > 0) {
    request.set_after_body(contents.bodies(contents.bodies_size() - 1).id());
    const auto page = client_->call(client_->scenes(), &v1::Scenes::Stub::GetScene, request).scene();
    contents.mutable_bodies()->MergeFrom(page.bodies());
    contents.set_bodies_left(page.bodies_left());
  }
  return contents;
}

void Scene::remove() {
  v1::DeleteSceneRequest request;
  request.set_scene(name_);
  client_->call(client_->scenes(), &v1::Scenes::Stub::DeleteScene, request);
}

States Scene::check_states(const std::string& robot, Rows states, const Question& question) {
  const auto request = states_request(robot, states, question, Want::distance, v1::ANSWER_FORM_BULK);
  return States::of(client_->call(client_->queries(), &Queries::CheckStates, request, question.timeout_).answer(), states.count());
}

v1::Answer Scene::look_at_states(const std::string& robot, Rows states, const Question& question) {
  auto request = states_request(robot, states, question, Want::witness, v1::ANSWER_FORM_ITEMS);
  request.mutable_context()->mutable_wants()->set_pairs(true);
  auto response = client_->call(client_->queries(), &Queries::CheckStates, request, question.timeout_);
  check_items(states, response.answer());
  return std::move(*response.mutable_answer());
}

Motions Scene::check_motions(const std::string& robot, Rows starts, Rows goals, const Question& question) {
  const auto request = motions_request(robot, starts, goals, question);
  const auto response = client_->call(client_->queries(), &Queries::CheckMotions, request, question.timeout_);
  return Motions::of(response.answer(), response.bulk(), starts.count());
}

Motions Scene::check_path(const std::string& robot, Rows waypoints, const Question& question) {
  const auto request = path_request(robot, waypoints, question);
  const auto response = client_->call(client_->queries(), &Queries::CheckPath, request, question.timeout_);
  return Motions::of(response.answer(), response.bulk(), waypoints.count() > 0 ? waypoints.count() - 1 : 0);
}

v1::Answer Scene::distance(const std::vector<v1::Subject>& subjects, const Question& question) {
  return client_->call(client_->queries(), &Queries::Distance, distance_request(subjects, question), question.timeout_).answer();
}

v1::Answer Scene::collide(const std::vector<v1::Subject>& subjects, const Question& question) {
  return client_->call(client_->queries(), &Queries::Collide, collide_request(subjects, question), question.timeout_).answer();
}

v1::Answer Scene::clearance(double within, const std::vector<v1::Subject>& subjects, const Question& question) {
  const auto request = clearance_request(within, subjects, question);
  return client_->call(client_->queries(), &Queries::Clearance, request, question.timeout_).answer();
}

v1::Answer Scene::clearance_of_states(const std::string& robot, Rows states, double within, const Question& question) {
  const auto request = clearance_of_states_request(robot, states, within, question);
  auto response = client_->call(client_->queries(), &Queries::Clearance, request, question.timeout_);
  check_items(states, response.answer());
  return std::move(*response.mutable_answer());
}

}  // namespace clearance
