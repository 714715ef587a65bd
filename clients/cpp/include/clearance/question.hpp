/// How a question is to be answered.
#pragma once

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <optional>

#include "clearance/edits.hpp"
#include "clearance/v1/motion.pb.h"
#include "clearance/v1/query.pb.h"

namespace clearance {

/// What an answer has beside its verdicts.
enum class Want {
  /// Nothing; the quickest.
  verdict,
  /// Brackets of the nearest pairs; loose ones of pairs that overlap.
  distance,
  /// Tight brackets of pairs that overlap as well.
  depth,
  /// Points and normals as well.
  witness,
  /// As well, where faces touch: `PairAnswer.patch` of pairs that are not proved apart by more than their margin.
  patch,
};

/// Words that can be left out, one after the other: `Question().want(Want::depth).at_least(revision)`.
class Question {
 public:
  /// Replaces what the method would want.
  Question& want(Want wanted);
  /// How pairs that have points and normals change when their bodies move, as well; exact unless the options say otherwise.
  Question& derivatives(v1::DerivativeOptions options = {});
  /// Metres: a pair apart but nearer than this is MARGIN.
  Question& margin(double metres);
  /// Metres: pairs farther than this need no distance.
  Question& cut_off(double metres);
  /// Waits for a revision until the deadline.
  Question& at_least(std::uint64_t revision);
  Question& exactly(std::uint64_t revision);
  /// Items after the first hit are left NOT_RUN; `stopped_at` of the answer names it.
  Question& stop_at_first();
  /// How long the daemon may look; items not looked at by then are NOT_RUN.
  Question& budget(std::chrono::duration<double> time);
  /// Pairs listed for an item at most.
  Question& max_pairs(std::uint32_t count);
  /// Bodies to be left out.
  Question& ignore(std::initializer_list<Body> bodies);
  /// Edits that only this question sees.
  Question& what_if(v1::Overlay overlay);
  /// How far motions are followed.
  Question& effort(v1::MotionEffort effort);
  /// The deadline of this call, in place of the client's.
  Question& timeout(std::chrono::milliseconds time);

  /// Whatever no word above sets is set here.
  v1::Context& context() { return context_; }

 private:
  friend class Scene;

  v1::Context context_;
  std::optional<Want> want_;
  v1::Mode mode_ = v1::MODE_UNSPECIFIED;
  v1::MotionEffort effort_;
  std::optional<std::chrono::milliseconds> timeout_;
};

}  // namespace clearance
