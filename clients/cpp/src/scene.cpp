#include "clearance/scene.hpp"

#include <stdexcept>
#include <utility>

#include "clearance/client.hpp"
#include "little_endian.hpp"

namespace clearance {
namespace {

using Queries = v1::Queries::Stub;

v1::Wants wants_of(Want want) {
  v1::Wants wants;
  wants.set_distance(want != Want::verdict);
  const bool points = want == Want::witness || want == Want::patch;
  wants.set_depth(want == Want::depth || points);
  wants.set_witness(points);
  wants.set_patch(want == Want::patch);
  return wants;
}

void append_row(std::string& bytes, const Rows& rows, std::size_t i) {
  for (std::size_t k = 0; k < rows.width(); ++k) append_double(bytes, rows.row(i)[k]);
}

v1::Doubles doubles(const Rows& rows) {
  v1::Doubles message;
  auto& bytes = *message.mutable_little_endian();
  bytes.reserve(8 * rows.count() * rows.width());
  for (std::size_t i = 0; i < rows.count(); ++i) append_row(bytes, rows, i);
  return message;
}

/// Starts and goals, one after the other.
v1::Doubles edges(const Rows& starts, const Rows& goals) {
  if (starts.count() != goals.count() || starts.width() != goals.width()) {
    throw std::invalid_argument("starts and goals: are not of one size");
  }
  v1::Doubles message;
  auto& bytes = *message.mutable_little_endian();
  for (std::size_t i = 0; i < starts.count(); ++i) {
    append_row(bytes, starts, i);
    append_row(bytes, goals, i);
  }
  return message;
}

template <typename Items>
void put_subjects(Items& items, const std::vector<v1::Subject>& subjects) {
  for (const auto& subject : subjects) *items.Add() = subject;
  if (subjects.empty()) items.Add()->mutable_all_pairs();
}

void check_items(const Rows& rows, const v1::Answer& answer) {
  if (static_cast<std::size_t>(answer.items_size()) == rows.count()) return;
  throw std::invalid_argument("states: do not have as many numbers as the robot takes");
}

}  // namespace

v1::Context Scene::context(const Question& question, Want by_default, v1::AnswerForm form) const {
  v1::Context context = question.context_;
  context.set_scene(name_);
  if (question.want_ || !context.has_wants()) *context.mutable_wants() = wants_of(question.want_.value_or(by_default));
  context.set_answer_form(form);
  return context;
}

v1::Context Scene::context(const Question& question) const {
  return context(question, Want::verdict, question.context_.answer_form());
}

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
  v1::CheckStatesRequest request;
  *request.mutable_context() = context(question, Want::distance, v1::ANSWER_FORM_BULK);
  request.set_robot(robot);
  *request.mutable_positions() = doubles(states);
  request.set_mode(question.mode_);
  return States::of(client_->call(client_->queries(), &Queries::CheckStates, request, question.timeout_).answer(), states.count());
}

v1::Answer Scene::look_at_states(const std::string& robot, Rows states, const Question& question) {
  v1::CheckStatesRequest request;
  *request.mutable_context() = context(question, Want::witness, v1::ANSWER_FORM_ITEMS);
  request.mutable_context()->mutable_wants()->set_pairs(true);
  request.set_robot(robot);
  *request.mutable_positions() = doubles(states);
  request.set_mode(question.mode_);
  auto response = client_->call(client_->queries(), &Queries::CheckStates, request, question.timeout_);
  check_items(states, response.answer());
  return std::move(*response.mutable_answer());
}

Motions Scene::check_motions(const std::string& robot, Rows starts, Rows goals, const Question& question) {
  v1::CheckMotionsRequest request;
  *request.mutable_context() = context(question, Want::verdict, v1::ANSWER_FORM_BULK);
  request.set_robot(robot);
  *request.mutable_positions() = edges(starts, goals);
  request.set_mode(question.mode_);
  *request.mutable_effort() = question.effort_;
  const auto response = client_->call(client_->queries(), &Queries::CheckMotions, request, question.timeout_);
  return Motions::of(response.answer(), response.bulk(), starts.count());
}

Motions Scene::check_path(const std::string& robot, Rows waypoints, const Question& question) {
  v1::CheckPathRequest request;
  *request.mutable_context() = context(question, Want::verdict, v1::ANSWER_FORM_BULK);
  request.set_robot(robot);
  *request.mutable_waypoints() = doubles(waypoints);
  request.set_mode(question.mode_);
  *request.mutable_effort() = question.effort_;
  const auto response = client_->call(client_->queries(), &Queries::CheckPath, request, question.timeout_);
  return Motions::of(response.answer(), response.bulk(), waypoints.count() > 0 ? waypoints.count() - 1 : 0);
}

v1::Answer Scene::distance(const std::vector<v1::Subject>& subjects, const Question& question) {
  v1::DistanceRequest request;
  *request.mutable_context() = context(question, Want::witness, v1::ANSWER_FORM_ITEMS);
  put_subjects(*request.mutable_items(), subjects);
  request.set_mode(question.mode_);
  return client_->call(client_->queries(), &Queries::Distance, request, question.timeout_).answer();
}

v1::Answer Scene::collide(const std::vector<v1::Subject>& subjects, const Question& question) {
  v1::CollideRequest request;
  *request.mutable_context() = context(question, Want::verdict, v1::ANSWER_FORM_ITEMS);
  put_subjects(*request.mutable_items(), subjects);
  request.set_mode(question.mode_);
  return client_->call(client_->queries(), &Queries::Collide, request, question.timeout_).answer();
}

v1::Answer Scene::clearance(double within, const std::vector<v1::Subject>& subjects, const Question& question) {
  v1::ClearanceRequest request;
  *request.mutable_context() = context(question, Want::distance, v1::ANSWER_FORM_ITEMS);
  request.set_within(within);
  request.set_mode(question.mode_);
  put_subjects(*request.mutable_items()->mutable_items(), subjects);
  return client_->call(client_->queries(), &Queries::Clearance, request, question.timeout_).answer();
}

v1::Answer Scene::clearance_of_states(const std::string& robot, Rows states, double within, const Question& question) {
  v1::ClearanceRequest request;
  *request.mutable_context() = context(question, Want::distance, v1::ANSWER_FORM_ITEMS);
  request.set_within(within);
  request.set_mode(question.mode_);
  request.mutable_states()->set_robot(robot);
  *request.mutable_states()->mutable_positions() = doubles(states);
  auto response = client_->call(client_->queries(), &Queries::Clearance, request, question.timeout_);
  check_items(states, response.answer());
  return std::move(*response.mutable_answer());
}

}  // namespace clearance
