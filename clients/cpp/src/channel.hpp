/// How a client reaches a daemon.
#pragma once

#include <memory>
#include <string>

#include <grpcpp/channel.h>

#include "clearance/client.hpp"

namespace clearance {

/// A channel to `address`; throws std::invalid_argument.
std::shared_ptr<grpc::Channel> open_channel(const std::string& address, const Options& options);

}  // namespace clearance
