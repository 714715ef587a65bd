// How is a question written as a message? As it is asked, and as its price is.
#include <stdexcept>
#include <string>
#include <vector>

#include "clearance/scene.hpp"
#include "little_endian.hpp"

namespace clearance {
namespace {

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

}  // namespace

v1::Context Scene::context(const Question& question, Want by_default, v1::AnswerForm form) const {
  v1::Context context = question.context_;
  context.set_scene(name_);
  if (question.want_ || !context.has_wants()) *context.mutable_wants() = wants_of(question.want_.value_or(by_default));
  if (context.has_derivatives()) context.mutable_wants()->set_derivatives(true);
  context.set_answer_form(form);
  return context;
}

v1::Context Scene::context(const Question& question) const {
  return context(question, Want::verdict, question.context_.answer_form());
}

v1::CheckStatesRequest Scene::states_request(const std::string& robot, const Rows& states, const Question& question, Want by_default,
                                             v1::AnswerForm form) const {
  v1::CheckStatesRequest request;
  *request.mutable_context() = context(question, by_default, form);
  request.set_robot(robot);
  *request.mutable_positions() = doubles(states);
  request.set_mode(question.mode_);
  return request;
}

v1::CheckMotionsRequest Scene::motions_request(const std::string& robot, const Rows& starts, const Rows& goals,
                                               const Question& question) const {
  v1::CheckMotionsRequest request;
  *request.mutable_context() = context(question, Want::verdict, v1::ANSWER_FORM_BULK);
  request.set_robot(robot);
  *request.mutable_positions() = edges(starts, goals);
  request.set_mode(question.mode_);
  *request.mutable_effort() = question.effort_;
  return request;
}

v1::CheckPathRequest Scene::path_request(const std::string& robot, const Rows& waypoints, const Question& question) const {
  v1::CheckPathRequest request;
  *request.mutable_context() = context(question, Want::verdict, v1::ANSWER_FORM_BULK);
  request.set_robot(robot);
  *request.mutable_waypoints() = doubles(waypoints);
  request.set_mode(question.mode_);
  *request.mutable_effort() = question.effort_;
  return request;
}

v1::DistanceRequest Scene::distance_request(const std::vector<v1::Subject>& subjects, const Question& question) const {
  v1::DistanceRequest request;
  *request.mutable_context() = context(question, Want::witness, v1::ANSWER_FORM_ITEMS);
  put_subjects(*request.mutable_items(), subjects);
  request.set_mode(question.mode_);
  return request;
}

v1::CollideRequest Scene::collide_request(const std::vector<v1::Subject>& subjects, const Question& question) const {
  v1::CollideRequest request;
  *request.mutable_context() = context(question, Want::verdict, v1::ANSWER_FORM_ITEMS);
  put_subjects(*request.mutable_items(), subjects);
  request.set_mode(question.mode_);
  return request;
}

v1::ClearanceRequest Scene::clearance_request(double within, const std::vector<v1::Subject>& subjects, const Question& question) const {
  v1::ClearanceRequest request;
  *request.mutable_context() = context(question, Want::distance, v1::ANSWER_FORM_ITEMS);
  request.set_within(within);
  request.set_mode(question.mode_);
  put_subjects(*request.mutable_items()->mutable_items(), subjects);
  return request;
}

v1::ClearanceRequest Scene::clearance_of_states_request(const std::string& robot, const Rows& states, double within,
                                                        const Question& question) const {
  v1::ClearanceRequest request;
  *request.mutable_context() = context(question, Want::distance, v1::ANSWER_FORM_ITEMS);
  request.set_within(within);
  request.set_mode(question.mode_);
  request.mutable_states()->set_robot(robot);
  *request.mutable_states()->mutable_positions() = doubles(states);
  return request;
}

}  // namespace clearance
