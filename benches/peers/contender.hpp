// What makes a program a contender: it reads commands, makes passes over pairs, and times each pair (see README.md).
#pragma once

#include <cmath>
#include <iostream>
#include <sstream>

#include "pairs.hpp"
#include "timer.hpp"

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
