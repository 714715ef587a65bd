#include "clearance/question.hpp"

#include <utility>

namespace clearance {

Question& Question::want(Want wanted) {
  want_ = wanted;
  return *this;
}

Question& Question::derivatives(v1::DerivativeOptions options) {
  *context_.mutable_derivatives() = std::move(options);
  return *this;
}

Question& Question::margin(double metres) {
  context_.set_margin(metres);
  return *this;
}

Question& Question::cut_off(double metres) {
  context_.set_cut_off(metres);
  return *this;
}

Question& Question::at_least(std::uint64_t revision) {
  context_.mutable_revision()->set_at_least(revision);
  return *this;
}

Question& Question::exactly(std::uint64_t revision) {
  context_.mutable_revision()->set_exactly(revision);
  return *this;
}

Question& Question::stop_at_first() {
  mode_ = v1::MODE_STOP_AT_FIRST;
  return *this;
}

Question& Question::budget(std::chrono::duration<double> time) {
  context_.set_time_budget(time.count());
  return *this;
}

Question& Question::max_pairs(std::uint32_t count) {
  context_.set_max_pairs(count);
  return *this;
}

Question& Question::ignore(std::initializer_list<Body> bodies) {
  for (const auto& body : bodies) *context_.mutable_filter()->add_ignore() = body.message();
  return *this;
}

Question& Question::what_if(v1::Overlay overlay) {
  *context_.mutable_overlay() = std::move(overlay);
  return *this;
}

Question& Question::effort(v1::MotionEffort effort) {
  effort_ = std::move(effort);
  return *this;
}

Question& Question::timeout(std::chrono::milliseconds time) {
  timeout_ = time;
  return *this;
}

}  // namespace clearance
