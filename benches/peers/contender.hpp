// What makes a program a contender: it reads commands, makes passes over pairs, and times each pair (see README.md).
#pragma once

#include <x86intrin.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <numeric>
#include <sstream>

#include "pairs.hpp"

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

// Pairs at the end of a set that are asked about before a pass begins.
constexpr size_t WARMING = 16;

// One visit to each of the first `count` pairs of a set; goes out as four numbers a pair: ticks, answer, lower, upper.
class Pass {
 public:
  Pass(size_t pairs, double cost) : count(pairs), timer_cost(cost) {}

  // `ask(i)` answers about pair i of the set. A contender without brackets leaves both ends NaN.
  template <class Ask>
  void run(Ask&& ask) {
    results.reserve(4 * count);
    // Not counted: another program ran before, and the processor has to find its way again.
    for (size_t i = count - std::min(count, WARMING); i < count; i++) {
      double answer = ask(i);
      asm volatile("" : : "x"(answer));
    }
    for (size_t i = 0; i < count; i++) {
      uint64_t start = tick();
      double answer = ask(i);
      uint64_t end = tick();
      asm volatile("" : : "x"(answer));
      double ticks = double(end - start) - timer_cost;
      results.insert(results.end(), {ticks, answer, double(NAN), double(NAN)});
    }
  }

  void send() const {
    fwrite(results.data(), sizeof(double), results.size(), stdout);
    fflush(stdout);
  }

 private:
  size_t count;
  double timer_cost;
  std::vector<double> results;
};

// `Contender` has `configs(set, operation)`, a list of names, and `ask(set, operation, config, pass)`.
template <class Contender>
int serve(Contender& contender, const Pairs& pairs) {
  Timer timer;
  printf("ready %.9f %g\n", ticks_per_nanosecond(), timer.step);
  fflush(stdout);
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream words(line);
    std::string command, set_name, operation, config;
    size_t count = 0;
    words >> command >> set_name >> operation >> config >> count;
    const PairSet* set = pairs.set(set_name);
    if (!set) Reader::fail(("no set " + set_name).c_str());
    if (command == "configs") {
      for (const std::string& name : contender.configs(*set, operation)) printf("%s ", name.c_str());
      printf("\n");
      fflush(stdout);
      continue;
    }
    Pass pass(std::min<size_t>(count, set->count), timer.cost);
    contender.ask(*set, operation, config, pass);
    pass.send();
  }
  return 0;
}
