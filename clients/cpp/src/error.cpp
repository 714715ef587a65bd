#include "clearance/error.hpp"

#include <cstdlib>
#include <regex>

namespace clearance {
namespace {

std::optional<std::uint64_t> number(const std::optional<std::string>& text) {
  if (!text || text->empty() || text->find_first_not_of("0123456789") != std::string::npos) return {};
  return std::strtoull(text->c_str(), nullptr, 10);
}

std::optional<std::size_t> item_of(const std::string& field) {
  static const std::regex form(R"((\w+)\[(\d+)\].*)");
  std::smatch found;
  if (!std::regex_match(field, found, form)) return {};
  return number(found[2].str());
}

std::string code_name(grpc::StatusCode code) {
  switch (code) {
    case grpc::StatusCode::INVALID_ARGUMENT: return "INVALID_ARGUMENT";
    case grpc::StatusCode::NOT_FOUND: return "NOT_FOUND";
    case grpc::StatusCode::ALREADY_EXISTS: return "ALREADY_EXISTS";
    case grpc::StatusCode::FAILED_PRECONDITION: return "FAILED_PRECONDITION";
    case grpc::StatusCode::ABORTED: return "ABORTED";
    case grpc::StatusCode::OUT_OF_RANGE: return "OUT_OF_RANGE";
    case grpc::StatusCode::RESOURCE_EXHAUSTED: return "RESOURCE_EXHAUSTED";
    case grpc::StatusCode::UNAUTHENTICATED: return "UNAUTHENTICATED";
    case grpc::StatusCode::PERMISSION_DENIED: return "PERMISSION_DENIED";
    case grpc::StatusCode::DEADLINE_EXCEEDED: return "DEADLINE_EXCEEDED";
    case grpc::StatusCode::UNAVAILABLE: return "UNAVAILABLE";
    case grpc::StatusCode::DATA_LOSS: return "DATA_LOSS";
    case grpc::StatusCode::CANCELLED: return "CANCELLED";
    case grpc::StatusCode::INTERNAL: return "INTERNAL";
    default: return "code " + std::to_string(static_cast<int>(code));
  }
}

[[noreturn]] void raise(grpc::StatusCode code, const std::string& message, const Error::Details& details) {
  switch (code) {
    case grpc::StatusCode::INVALID_ARGUMENT: throw InvalidRequest(code, message, details);
    case grpc::StatusCode::NOT_FOUND: throw NotFound(code, message, details);
    case grpc::StatusCode::ALREADY_EXISTS:
    case grpc::StatusCode::FAILED_PRECONDITION:
    case grpc::StatusCode::ABORTED: throw Conflict(code, message, details);
    case grpc::StatusCode::OUT_OF_RANGE: throw RevisionGone(code, message, details);
    case grpc::StatusCode::RESOURCE_EXHAUSTED: throw LimitExceeded(code, message, details);
    case grpc::StatusCode::UNAUTHENTICATED:
    case grpc::StatusCode::PERMISSION_DENIED: throw NotAllowed(code, message, details);
    case grpc::StatusCode::DEADLINE_EXCEEDED: throw DeadlineExceeded(code, message, details);
    case grpc::StatusCode::UNAVAILABLE: throw Unavailable(code, message, details);
    default: throw Error(code, message, details);
  }
}

}  // namespace

Error::Error(grpc::StatusCode kind, const std::string& message, const Details& details)
    : std::runtime_error(code_name(kind) + ": " + message),
      code(kind),
      reason(details("clearance-reason").value_or("")),
      field(details("clearance-field").value_or("")),
      item(item_of(field)),
      limit(details("clearance-limit").value_or("")),
      asked(number(details("clearance-asked"))),
      allowed(number(details("clearance-allowed"))),
      scope(details("clearance-scope").value_or("")),
      epoch(number(details("clearance-epoch"))),
      revision(number(details("clearance-revision"))),
      oldest_revision(number(details("clearance-oldest-revision"))) {
  if (const auto time = number(details("clearance-retry-after-ms"))) retry_after = std::chrono::milliseconds(*time);
}

void check(const grpc::Status& status, const grpc::ClientContext& context) {
  if (status.ok()) return;
  const auto& trailer = context.GetServerTrailingMetadata();
  raise(status.error_code(), status.error_message(), [&trailer](const std::string& key) -> std::optional<std::string> {
    const auto found = trailer.find(key);
    if (found == trailer.end()) return {};
    return std::string(found->second.data(), found->second.size());
  });
}

void throw_refusal(const v1::QueryError& refusal) {
  const std::string name = v1::ErrorReason_Name(refusal.reason());
  const std::string prefix = "ERROR_REASON_";
  const std::string reason = name.compare(0, prefix.size(), prefix) == 0 ? name.substr(prefix.size()) : name;
  raise(static_cast<grpc::StatusCode>(refusal.code()), refusal.message(),
        [&](const std::string& key) -> std::optional<std::string> {
          if (key == "clearance-reason") return reason;
          const auto found = refusal.details().find(key);
          if (found == refusal.details().end()) return {};
          return found->second;
        });
}

}  // namespace clearance
