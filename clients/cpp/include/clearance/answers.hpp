/// Answers of batches as arrays. Metres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clearance/v1/motion.pb.h"
#include "clearance/v1/query.pb.h"

namespace clearance {

/// What a bracket decides.
enum class Verdict : std::uint8_t {
  free = v1::VERDICT_FREE,
  margin = v1::VERDICT_MARGIN,
  collision = v1::VERDICT_COLLISION,
  indeterminate = v1::VERDICT_INDETERMINATE,
  not_run = v1::VERDICT_NOT_RUN,
  invalid_input = v1::VERDICT_INVALID_INPUT,
};

/// For example `COLLISION`.
std::string to_string(Verdict verdict);
std::string to_string(v1::Verdict verdict);

/// Brackets of all items of a batch; NaN where an item has no such pair, empty where none has or none was wanted.
struct Brackets {
  /// The signed distance is, in the truth, between these; negative is depth.
  std::vector<double> lower;
  std::vector<double> upper;
  /// The best estimate inside.
  std::vector<double> signed_distance;
};

/// The answer to a batch of a robot's states, one element a state.
struct States {
  /// The state of the scene that was asked.
  std::uint64_t epoch = 0;
  std::uint64_t revision = 0;
  std::vector<Verdict> verdicts;
  /// Of the nearest pair at all, of two links, of a link and a body.
  Brackets nearest;
  Brackets nearest_self;
  Brackets nearest_scene;
  /// Of states that are `invalid_input`: which field, and what is wrong with it.
  std::map<std::size_t, std::string> problems;
  /// With `stop_at_first`: the state that stopped the batch.
  std::optional<std::size_t> stopped_at;
  /// Time ran out; states not looked at are `not_run`.
  bool out_of_time = false;
  v1::Cost cost;

  /// `asked`: how many states were.
  static States of(const v1::Answer& answer, std::size_t asked);
};

/// The answer to a batch of motions, one element a motion. Times are fractions of a motion: 0 at its start, 1 at its goal; NaN
/// where a motion has no such time.
struct Motions {
  /// The state of the scene that was asked.
  std::uint64_t epoch = 0;
  std::uint64_t revision = 0;
  std::vector<Verdict> verdicts;
  /// Every state before this is proved farther than the margins.
  std::vector<double> free_until;
  /// Of collisions: all before `reached_from` is proved apart, and the state at `reached_to` collides. Of `margin` the same for
  /// coming within a margin.
  std::vector<double> reached_from;
  std::vector<double> reached_to;
  /// Of `indeterminate`: the first stretch that nothing decides.
  std::vector<double> undecided_from;
  std::vector<double> undecided_to;
  /// States that each motion was looked at in, count.
  std::vector<double> states;
  /// Of motions that are `invalid_input`: which field, and what is wrong with it.
  std::map<std::size_t, std::string> problems;
  /// The motion that stopped the batch, of a path the first that is blocked.
  std::optional<std::size_t> stopped_at;
  /// Time ran out; motions not looked at are `not_run`.
  bool out_of_time = false;
  v1::Cost cost;

  /// `asked`: how many motions were.
  static Motions of(const v1::Answer& answer, const v1::BulkMotions& bulk, std::size_t asked);
};

}  // namespace clearance
