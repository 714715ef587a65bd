/// A connection to a daemon.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "clearance/error.hpp"
#include "clearance/robot.hpp"
#include "clearance/scene.hpp"
#include "clearance/v1/service.grpc.pb.h"

namespace clearance {

/// Where `clearance serve` listens unless told otherwise.
inline constexpr const char* default_address = "127.0.0.1:50551";

/// What a client shows the daemon, and whom it trusts.
struct Options {
  /// Goes with every call. Without TLS it can be read on its way.
  std::string token;
  /// Certificates (PEM) of which one must have signed the daemon's; empty: those that gRPC brings along are trusted.
  std::string ca;
  /// The client's own certificate and its key (PEM).
  std::string certificate;
  std::string key;
  /// The deadline of every call that has none of its own; zero: none.
  std::chrono::milliseconds timeout{60'000};
};

/// A connection. It may be used by any number of threads.
class Client {
 public:
  /// `address` is HOST:PORT, http://HOST:PORT, https://HOST:PORT or unix:PATH. A bare HOST:PORT means TLS if the options have
  /// anything of TLS. The connection is made when it is needed: a daemon that is not there shows with the first call. Throws
  /// std::invalid_argument if the options make no sense together.
  explicit Client(const std::string& address = default_address, Options options = {});
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Version, doors, limits, scenes and their epochs.
  v1::GetServerInfoResponse server_info();
  /// A new, empty scene.
  Scene create_scene(const std::string& name);
  /// A scene that is there already. Whether it is shows with the first call.
  Scene scene(const std::string& name) { return Scene(*this, name); }
  /// All scenes, in the order of their names.
  std::vector<v1::SceneSummary> list_scenes();
  /// Uploads the meshes that the daemon does not have, and loads the robot.
  Robot load_robot(const RobotDescription& description);
  /// Uploads files that the daemon does not have yet; returns the SHA-256 of each, by which messages name them.
  std::vector<std::string> upload(const std::vector<std::string_view>& files);

  /// The generated stubs, for everything that has no method here.
  v1::Scenes::Stub& scenes() { return *scenes_; }
  v1::Assets::Stub& assets() { return *assets_; }
  v1::Robots::Stub& robots() { return *robots_; }
  v1::Queries::Stub& queries() { return *queries_; }
  v1::Server::Stub& server() { return *server_; }
  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }

  /// Makes a call of a stub, with token and deadline; throws Error:
  /// `client.call(client.queries(), &v1::Queries::Stub::CastRays, request)`.
  template <typename Stub, typename Request, typename Response>
  Response call(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*), const Request& request,
                std::optional<std::chrono::milliseconds> timeout = {}) {
    grpc::ClientContext context;
    prepare(context, timeout);
    Response response;
    check((stub.*method)(&context, request, &response), context);
    return response;
  }

  /// Puts token and deadline on a call of a stub's own, such as a stream. Zero: no deadline.
  void prepare(grpc::ClientContext& context, std::optional<std::chrono::milliseconds> timeout = {}) const;

 private:
  void put_asset(const std::string& sha256, std::string_view file);

  Options options_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::Scenes::Stub> scenes_;
  std::unique_ptr<v1::Assets::Stub> assets_;
  std::unique_ptr<v1::Robots::Stub> robots_;
  std::unique_ptr<v1::Queries::Stub> queries_;
  std::unique_ptr<v1::Server::Stub> server_;
};

}  // namespace clearance
