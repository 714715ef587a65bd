#include "clearance/answers.hpp"

#include <stdexcept>

#include "little_endian.hpp"

namespace clearance {
namespace {

/// The daemon sees one list of numbers and cuts it by the robot's joints, whatever the rows were.
void check_count(const char* what, std::size_t asked, std::size_t answered) {
  if (asked == answered) return;
  throw std::invalid_argument(std::string(what) + ": " + std::to_string(asked) + " were asked and " + std::to_string(answered) +
                              " answered: they do not have as many numbers as the robot takes");
}

Brackets brackets_of(const v1::BulkBrackets& bulk) {
  return {doubles_of(bulk.lower()), doubles_of(bulk.upper()), doubles_of(bulk.signed_distance())};
}

/// What both kinds of answers have.
template <typename Batch>
Batch batch_of(const v1::Answer& answer) {
  Batch batch;
  batch.epoch = answer.epoch();
  batch.revision = answer.revision();
  for (const char number : answer.bulk().verdicts()) batch.verdicts.push_back(static_cast<Verdict>(number));
  for (const auto& problem : answer.bulk().problems()) batch.problems[problem.item()] = problem.problem();
  if (answer.has_stopped_at()) batch.stopped_at = answer.stopped_at();
  batch.out_of_time = answer.out_of_time();
  batch.cost = answer.cost();
  return batch;
}

}  // namespace

std::string to_string(v1::Verdict verdict) {
  const std::string name = v1::Verdict_Name(verdict), prefix = "VERDICT_";
  return name.compare(0, prefix.size(), prefix) == 0 ? name.substr(prefix.size()) : name;
}

std::string to_string(Verdict verdict) { return to_string(static_cast<v1::Verdict>(verdict)); }

States States::of(const v1::Answer& answer, std::size_t asked) {
  auto batch = batch_of<States>(answer);
  check_count("states", asked, batch.verdicts.size());
  batch.nearest = brackets_of(answer.bulk().nearest());
  batch.nearest_self = brackets_of(answer.bulk().nearest_self());
  batch.nearest_scene = brackets_of(answer.bulk().nearest_scene());
  return batch;
}

Motions Motions::of(const v1::Answer& answer, const v1::BulkMotions& bulk, std::size_t asked) {
  auto batch = batch_of<Motions>(answer);
  check_count("motions", asked, batch.verdicts.size());
  batch.free_until = doubles_of(bulk.free_until());
  batch.reached_from = doubles_of(bulk.reached_from());
  batch.reached_to = doubles_of(bulk.reached_to());
  batch.undecided_from = doubles_of(bulk.undecided_from());
  batch.undecided_to = doubles_of(bulk.undecided_to());
  batch.states = doubles_of(bulk.states());
  return batch;
}

}  // namespace clearance
