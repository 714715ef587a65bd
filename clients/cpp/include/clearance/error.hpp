/// What can go wrong with a request. Geometry never does: it is a verdict.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include "clearance/v1/service.pb.h"

namespace clearance {

/// A request was refused or could not be delivered. What the daemon did not say is empty.
class Error : public std::runtime_error {
 public:
  /// Looks up what the daemon said under a key such as `clearance-field`.
  using Details = std::function<std::optional<std::string>(const std::string&)>;

  Error(grpc::StatusCode code, const std::string& message, const Details& details);

  /// gRPC's kind of error.
  grpc::StatusCode code;
  /// For programs, for example `INVALID_FIELD`; see `ErrorReason` in service.proto.
  std::string reason;
  /// The field that cannot be as it is, for example `items[3].shape.box.half_extents.x`.
  std::string field;
  /// Of a list of edits, subjects or the like: which element the field is in.
  std::optional<std::size_t> item;
  /// The cap that was hit, how much was asked, how much is allowed.
  std::string limit;
  std::optional<std::uint64_t> asked;
  std::optional<std::uint64_t> allowed;
  /// When the limit lets this client in again.
  std::optional<std::chrono::milliseconds> retry_after;
  /// The scope that the token lacks, `read` or `write`.
  std::string scope;
  /// The scene as it is now, where it is not as was expected.
  std::optional<std::uint64_t> epoch;
  std::optional<std::uint64_t> revision;
  std::optional<std::uint64_t> oldest_revision;
};

/// A field cannot be as it is; `field` and `item` say which.
struct InvalidRequest : Error {
  using Error::Error;
};
/// A scene, body, robot, model, asset or group is not there.
struct NotFound : Error {
  using Error::Error;
};
/// The scene is not as the request needs it: a taken name, an edit that does not fit, another revision or epoch.
struct Conflict : Error {
  using Error::Error;
};
/// The revision asked for is not kept any more; `oldest_revision` is.
struct RevisionGone : Error {
  using Error::Error;
};
/// A cap of the daemon; `limit`, `asked` and `allowed` say which, `retry_after` when to ask again if time helps.
struct LimitExceeded : Error {
  using Error::Error;
};
/// The daemon wants a token, does not know this one, or it lacks `scope`; `reason` says which.
struct NotAllowed : Error {
  using Error::Error;
};
/// Nothing could be answered in time.
struct DeadlineExceeded : Error {
  using Error::Error;
};
/// No daemon there, one that shuts down, or a revision that did not come in time.
struct Unavailable : Error {
  using Error::Error;
};

/// Throws what a finished call ended with, unless it went well.
void check(const grpc::Status& status, const grpc::ClientContext& context);

/// Throws the error of one question of a stream, as a call of its own would have.
[[noreturn]] void throw_refusal(const v1::QueryError& refusal);

}  // namespace clearance
