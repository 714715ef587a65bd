/// What would a question cost? Which prices are asked for; Scene::estimate_states and its like ask.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "clearance/v1/estimate.pb.h"

namespace clearance {

/// What an estimate measures. Empty: every output that the question has, at the daemon's ladder of tolerances.
struct Prices {
  /// How wide a bracket may be, metres; 0: as narrow as rounding lets it be. Of motions the resolution, too, and positive.
  std::vector<double> tolerances;
  /// What to compute, one at a time.
  std::vector<v1::Output> outputs;
  /// Items to measure at most; empty or beyond the daemon's cap: as many as that is.
  std::optional<std::uint32_t> sample;
  /// How long to measure at most; empty or beyond the daemon's cap: as long as that is.
  std::optional<std::chrono::duration<double>> time;
};

}  // namespace clearance
