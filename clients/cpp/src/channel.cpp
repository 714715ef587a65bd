#include "channel.hpp"

#include <algorithm>
#include <stdexcept>

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

namespace clearance {
namespace {

bool starts_with(const std::string& text, const std::string& start) { return text.compare(0, start.size(), start) == 0; }

}  // namespace

std::shared_ptr<grpc::Channel> open_channel(const std::string& address, const Options& options) {
  const bool printable = std::all_of(options.token.begin(), options.token.end(), [](char c) { return c > ' ' && c <= '~'; });
  // The text of a token has no place in an error.
  if (!printable) throw std::invalid_argument("the token is not printable ASCII");
  if (options.certificate.empty() != options.key.empty()) throw std::invalid_argument("certificate and key go together");

  const bool has_tls = !options.ca.empty() || !options.certificate.empty();
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  arguments.SetMaxSendMessageSize(-1);
  std::string target = address;
  bool encrypted = has_tls;
  if (starts_with(address, "unix:")) {
    encrypted = false;
    // gRPC would name the path as host, with characters that HTTP/2 servers in Rust refuse.
    arguments.SetString(GRPC_ARG_DEFAULT_AUTHORITY, "localhost");
  } else if (starts_with(address, "https://")) {
    encrypted = true;
    target = address.substr(8);
  } else if (starts_with(address, "http://")) {
    encrypted = false;
    target = address.substr(7);
  }
  if (has_tls && !encrypted) {
    throw std::invalid_argument(address + " has no TLS: ca, certificate and key have no meaning there");
  }
  if (!encrypted) return grpc::CreateCustomChannel(target, grpc::InsecureChannelCredentials(), arguments);
  grpc::SslCredentialsOptions tls;
  tls.pem_root_certs = options.ca;
  tls.pem_cert_chain = options.certificate;
  tls.pem_private_key = options.key;
  return grpc::CreateCustomChannel(target, grpc::SslCredentials(tls), arguments);
}

}  // namespace clearance
