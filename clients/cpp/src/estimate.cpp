#include "clearance/estimate.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "clearance/client.hpp"
#include "clearance/scene.hpp"

namespace clearance {
namespace {

/// The daemon sees one list of numbers and cuts it by the robot's joints, whatever the rows were.
v1::EstimateResponse counted(const char* what, std::size_t asked, v1::EstimateResponse response) {
  if (response.items() == asked) return response;
  throw std::invalid_argument(std::string(what) + ": do not have as many numbers as the robot takes");
}

}  // namespace

v1::EstimateResponse Scene::estimate(v1::EstimateRequest& request, const Prices& prices, const Question& question) {
  for (const double tolerance : prices.tolerances) request.add_tolerances(tolerance);
  for (const auto output : prices.outputs) request.add_outputs(output);
  if (prices.sample) request.set_sample(*prices.sample);
  if (prices.time) request.set_time(prices.time->count());
  return client_->call(client_->queries(), &v1::Queries::Stub::Estimate, request, question.timeout_);
}

v1::EstimateResponse Scene::estimate_states(const std::string& robot, Rows states, const Prices& prices, const Question& question) {
  v1::EstimateRequest request;
  *request.mutable_check_states() = states_request(robot, states, question, Want::distance, v1::ANSWER_FORM_BULK);
  return counted("states", states.count(), estimate(request, prices, question));
}

v1::EstimateResponse Scene::estimate_motions(const std::string& robot, Rows starts, Rows goals, const Prices& prices,
                                             const Question& question) {
  v1::EstimateRequest request;
  *request.mutable_check_motions() = motions_request(robot, starts, goals, question);
  return counted("motions", starts.count(), estimate(request, prices, question));
}

v1::EstimateResponse Scene::estimate_path(const std::string& robot, Rows waypoints, const Prices& prices, const Question& question) {
  v1::EstimateRequest request;
  *request.mutable_check_path() = path_request(robot, waypoints, question);
  const std::size_t motions = waypoints.count() > 0 ? waypoints.count() - 1 : 0;
  return counted("waypoints", motions, estimate(request, prices, question));
}

v1::EstimateResponse Scene::estimate_distance(const std::vector<v1::Subject>& subjects, const Prices& prices, const Question& question) {
  v1::EstimateRequest request;
  *request.mutable_distance() = distance_request(subjects, question);
  return estimate(request, prices, question);
}

v1::EstimateResponse Scene::estimate_collide(const std::vector<v1::Subject>& subjects, const Prices& prices, const Question& question) {
  v1::EstimateRequest request;
  *request.mutable_collide() = collide_request(subjects, question);
  return estimate(request, prices, question);
}

v1::EstimateResponse Scene::estimate_clearance(double within, const std::vector<v1::Subject>& subjects, const Prices& prices,
                                               const Question& question) {
  v1::EstimateRequest request;
  *request.mutable_clearance() = clearance_request(within, subjects, question);
  return estimate(request, prices, question);
}

}  // namespace clearance
