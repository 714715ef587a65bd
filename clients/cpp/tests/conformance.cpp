// The recorded answers of tests/data/conformance are brought, byte for byte; tests/clients/record.rs says what a line means.

#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include <clearance/clearance.hpp>
#include <doctest/doctest.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include "daemon.hpp"

using namespace clearance;

namespace {

std::string bytes_of(const std::string& digits) {
  std::string bytes;
  if (digits == "-") return bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return bytes;
}

std::string digits_of(const std::string& bytes) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const char byte : bytes) {
    text += digits[static_cast<unsigned char>(byte) >> 4];
    text += digits[static_cast<unsigned char>(byte) & 15];
  }
  return text.empty() ? "-" : text;
}

std::vector<std::string> split(const std::string& text, char by, std::size_t most) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == by && parts.size() < most) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// Without epochs and counts of nodes.
void clear(google::protobuf::Message& message) {
  const auto& reflection = *message.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const auto* field : fields) {
    if (field->name() == "epoch" || (field->name() == "nodes" && message.GetDescriptor()->name() == "Cost")) {
      reflection.ClearField(&message, field);
    } else if (field->message_type() == nullptr || field->is_map()) {
      continue;
    } else if (field->is_repeated()) {
      for (int i = 0; i < reflection.FieldSize(message, field); ++i) clear(*reflection.MutableRepeatedMessage(&message, field, i));
    } else {
      clear(*reflection.MutableMessage(&message, field));
    }
  }
}

std::string canonical(google::protobuf::Message& message) {
  clear(message);
  std::string bytes;
  {
    google::protobuf::io::StringOutputStream into(&bytes);
    google::protobuf::io::CodedOutputStream out(&into);
    out.SetSerializationDeterministic(true);
    REQUIRE(message.SerializeToCodedStream(&out));
  }
  return digits_of(bytes);
}

/// Asks by a method of a stub with a message in digits.
template <typename Stub, typename Request, typename Response>
std::string ask(Client& client, Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                const std::string& digits) {
  Request request;
  REQUIRE(request.ParseFromString(bytes_of(digits)));
  auto answer = client.call(stub, method, request);
  return canonical(answer);
}

std::string ask(Client& client, const std::string& method, const std::string& request) {
  using Scenes = v1::Scenes::Stub;
  using Queries = v1::Queries::Stub;
  if (method == "Scenes/CreateScene") return ask(client, client.scenes(), &Scenes::CreateScene, request);
  if (method == "Scenes/Apply") return ask(client, client.scenes(), &Scenes::Apply, request);
  if (method == "Scenes/GetScene") return ask(client, client.scenes(), &Scenes::GetScene, request);
  if (method == "Assets/HasAssets") return ask(client, client.assets(), &v1::Assets::Stub::HasAssets, request);
  if (method == "Robots/LoadRobot") return ask(client, client.robots(), &v1::Robots::Stub::LoadRobot, request);
  if (method == "Queries/CheckStates") return ask(client, client.queries(), &Queries::CheckStates, request);
  if (method == "Queries/Collide") return ask(client, client.queries(), &Queries::Collide, request);
  if (method == "Queries/Distance") return ask(client, client.queries(), &Queries::Distance, request);
  if (method == "Queries/CastRays") return ask(client, client.queries(), &Queries::CastRays, request);
  if (method == "Queries/CastShapes") return ask(client, client.queries(), &Queries::CastShapes, request);
  if (method == "Queries/CheckMovingPairs") return ask(client, client.queries(), &Queries::CheckMovingPairs, request);
  if (method == "Queries/Overlap") return ask(client, client.queries(), &Queries::Overlap, request);
  if (method == "Queries/NearestBodies") return ask(client, client.queries(), &Queries::NearestBodies, request);
  if (method == "Queries/CheckMotions") return ask(client, client.queries(), &Queries::CheckMotions, request);
  if (method == "Queries/CheckPath") return ask(client, client.queries(), &Queries::CheckPath, request);
  if (method == "Queries/Clearance") return ask(client, client.queries(), &Queries::Clearance, request);
  throw std::runtime_error("no such method: " + method);
}

std::string refusal(Client& client, const std::string& method, const std::string& request) {
  try {
    ask(client, method, request);
  } catch (const Error& error) {
    const std::string what = error.what();
    return what.substr(0, what.find(':')) + " " + error.reason + " " + (error.field.empty() ? "-" : error.field);
  }
  return "no refusal";
}

std::string stream(Client& client, const std::string& requests) {
  grpc::ClientContext context;
  client.prepare(context);
  const auto sending = client.queries().QueryStream(&context);
  for (const auto& digits : split(requests, ',', 1000)) {
    v1::QueryStreamRequest question;
    REQUIRE(question.ParseFromString(bytes_of(digits)));
    REQUIRE(sending->Write(question));
  }
  sending->WritesDone();
  std::string answers;
  v1::QueryStreamResponse answer;
  while (sending->Read(&answer)) answers += (answers.empty() ? "" : ",") + canonical(answer);
  check(sending->Finish(), context);
  return answers;
}

}  // namespace

TEST_CASE("the recorded answers are brought") {
  Daemon daemon;
  Client client(daemon.address());
  const auto root = told("CLEARANCE_ROOT");
  std::ifstream records(root + "/tests/data/conformance/records.txt");
  std::map<std::string, int> seen;
  for (std::string line; std::getline(records, line);) {
    if (line.front() == '#') continue;
    const auto words = split(line, ' ', 4);
    ++seen[words[0]];
    INFO(line.substr(0, 120));
    if (words[0] == "asset") {
      std::ifstream file(root + "/" + words[1], std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), {}};
      client.upload({bytes});
    } else if (words[0] == "ask") {
      CHECK(ask(client, words[1], words[2]) == words[3]);
    } else if (words[0] == "refuse") {
      CHECK(refusal(client, words[1], words[2]) == words[3]);
    } else {
      REQUIRE(words[0] == "stream");
      CHECK(stream(client, words[2]) == words[3]);
    }
  }
  CHECK(seen["asset"] > 0);
  CHECK(seen["ask"] > 0);
  CHECK(seen["refuse"] > 0);
  CHECK(seen["stream"] > 0);
}
