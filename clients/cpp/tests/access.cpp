// What a client shows a daemon: tokens, certificates; and a Unix socket. The test script makes the certificates.

#include <fstream>
#include <iterator>

#include <clearance/clearance.hpp>
#include <doctest/doctest.h>

#include "daemon.hpp"

using namespace clearance;

namespace {

std::string file(const std::string& name) {
  std::ifstream in(told("CERTIFICATES") + "/" + name);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  REQUIRE_FALSE(text.empty());
  return text;
}

}  // namespace

TEST_CASE("a token allows what its scopes say") {
  const std::string token = "a-token-that-only-reads";
  const auto path = std::filesystem::temp_directory_path() / ("clearance-cpp-token-" + std::to_string(getpid()));
  std::ofstream(path) << token;
  Daemon daemon("[[grpc.tokens]]\nname = \"reader\"\nfile = \"" + path.string() + "\"\nscopes = [\"read\"]\n");
  std::filesystem::remove(path);

  try {
    Client(daemon.address()).list_scenes();
    FAIL("nobody is let in");
  } catch (const NotAllowed& error) {
    CHECK(error.reason == "NO_TOKEN");
  }
  Options options;
  options.token = "some-other-token";
  CHECK_THROWS_AS(Client(daemon.address(), options).list_scenes(), NotAllowed);
  options.token = token;
  Client client(daemon.address(), options);
  CHECK(client.list_scenes().empty());
  try {
    client.create_scene("cell");
    FAIL("it only reads");
  } catch (const NotAllowed& error) {
    CHECK(error.reason == "MISSING_SCOPE");
    CHECK(error.scope == "write");
  }
  options.token = "not\nprintable";
  CHECK_THROWS_AS(Client(daemon.address(), options), std::invalid_argument);
}

TEST_CASE("a Unix socket") {
  const auto path = std::filesystem::temp_directory_path() / ("clearance-cpp-" + std::to_string(getpid()) + ".sock");
  Daemon daemon("", "unix:" + path.string());
  Client client(daemon.address());
  client.create_scene("cell");
  Options options;
  options.ca = "something";
  CHECK_THROWS_AS(Client(daemon.address(), options), std::invalid_argument);
}

TEST_CASE("certificates of both sides") {
  const auto folder = told("CERTIFICATES");
  Daemon daemon("[grpc.tls]\ncertificate = \"" + folder + "/server.pem\"\nkey = \"" + folder + "/server_key.pem\"\nclient_ca = \"" +
                folder + "/ca.pem\"\n");
  const auto address = "localhost" + daemon.address().substr(daemon.address().rfind(':'));
  Options options;
  options.ca = file("ca.pem");
  options.certificate = file("client.pem");
  options.key = file("client_key.pem");
  CHECK(Client("https://" + address, options).server_info().threads() > 0);
  CHECK_THROWS_AS(Client("http://" + address, options), std::invalid_argument);

  Options nameless = options;
  nameless.certificate.clear();
  CHECK_THROWS_AS(Client(address, nameless), std::invalid_argument);
  nameless.key.clear();
  CHECK_THROWS_AS(Client(address, nameless).server_info(), Unavailable);
  Options distrustful = options;
  distrustful.ca = file("other_ca.pem");
  CHECK_THROWS_AS(Client(address, distrustful).server_info(), Unavailable);
}
