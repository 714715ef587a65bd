// How long does something take? In ticks of the processor's time stamp.
#pragma once

#include <x86intrin.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <numeric>
#include <vector>

// Time stamp, with everything before it done and nothing after it begun.
inline uint64_t tick() {
  _mm_lfence();
  uint64_t now = __rdtsc();
  _mm_lfence();
  return now;
}

// What two stamps with nothing between them differ by, and the step that stamps grow by (26 ticks on some machines).
struct Timer {
  double cost, step;

  Timer() {
    std::vector<uint64_t> costs(20001);
    for (uint64_t& cost : costs) {
      uint64_t start = tick();
      cost = tick() - start;
    }
    std::sort(costs.begin(), costs.end());
    costs.resize(costs.size() * 9 / 10);  // the others were interrupted
    // The mean, for it resolves what lies between two steps.
    cost = std::accumulate(costs.begin(), costs.end(), 0.0) / double(costs.size());
    auto second = std::upper_bound(costs.begin(), costs.end(), costs[0]);
    step = second == costs.end() ? double(costs[0]) : double(*second - costs[0]);
  }
};

inline double ticks_per_nanosecond() {
  using clock = std::chrono::steady_clock;
  auto began = clock::now();
  uint64_t first = tick();
  while (clock::now() - began < std::chrono::milliseconds(100)) {
  }
  auto ended = clock::now();
  return double(tick() - first) / std::chrono::duration<double, std::nano>(ended - began).count();
}
