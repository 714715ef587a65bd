// What a refused call throws.

#include <limits>

#include <clearance/clearance.hpp>
#include <doctest/doctest.h>

#include "daemon.hpp"

using namespace clearance;

namespace {

/// Runs what must throw an `E`, and returns it.
template <typename E, typename F>
E thrown(F&& run) {
  try {
    run();
  } catch (const E& error) {
    return error;
  }
  throw std::runtime_error("nothing was thrown");
}

}  // namespace

TEST_CASE("errors say what") {
  Daemon daemon("limits.max_items = 3\n");
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  scene.apply({add_body("a", sphere(1))});

  const auto invalid = thrown<InvalidRequest>([&] {
    scene.apply({move_body("a", at(0, 0, 1)), add_body("b", sphere(std::numeric_limits<double>::quiet_NaN()))});
  });
  CHECK(invalid.item == std::size_t{1});
  CHECK(invalid.field == "edits[1].add_body.shape.sphere.radius");
  CHECK(invalid.reason == "INVALID_FIELD");
  CHECK(invalid.code == grpc::StatusCode::INVALID_ARGUMENT);
  CHECK(std::string(invalid.what()).find("INVALID_ARGUMENT: ") == 0);

  const auto taken = thrown<Conflict>([&] { client.create_scene("cell"); });
  CHECK(taken.reason == "ALREADY_EXISTS");
  CHECK_FALSE(taken.item);
  Expected expected;
  expected.revision = 7;
  const auto moved = thrown<Conflict>([&] { scene.apply({remove_body("a")}, expected); });
  CHECK(moved.reason == "REVISION_MOVED_ON");
  CHECK(moved.revision == std::uint64_t{1});
  CHECK_THROWS_AS(client.scene("nowhere").distance(), NotFound);

  const auto probe = subject("a");
  const auto limit = thrown<LimitExceeded>([&] { scene.collide({probe, probe, probe, probe}); });
  CHECK(limit.limit == "max_items");
  CHECK(limit.asked == std::uint64_t{4});
  CHECK(limit.allowed == std::uint64_t{3});

  for (int i = 0; i < 65; ++i) scene.apply({move_body("a", at(i, 0, 0))});
  const auto gone = thrown<RevisionGone>([&] { scene.distance({}, Question().exactly(1)); });
  CHECK(gone.oldest_revision.value() > 1);

  // The daemon and the client count the same deadline; either may be the first to tell.
  try {
    scene.distance({}, Question().at_least(1000).timeout(std::chrono::milliseconds(50)));
    FAIL("the revision never comes");
  } catch (const Unavailable&) {
  } catch (const DeadlineExceeded&) {
  }
}

TEST_CASE("a rate limit says when to ask again") {
  Daemon daemon("limits.max_client_items_per_second = 2\n");
  Client client(daemon.address());
  auto scene = client.create_scene("cell");
  const auto refused = thrown<LimitExceeded>([&] {
    for (int i = 0; i < 1000; ++i) scene.apply({add_body("body" + std::to_string(i), sphere(1))});
  });
  CHECK(refused.limit == "max_client_items_per_second");
  CHECK(refused.retry_after.value().count() > 0);
}

TEST_CASE("a daemon that is not there is unavailable") {
  Client client("127.0.0.1:1");
  CHECK_THROWS_AS(client.server_info(), Unavailable);
}
