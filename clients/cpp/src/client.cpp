#include "clearance/client.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include <openssl/evp.h>

#include "channel.hpp"

namespace clearance {
namespace {

/// Bytes of a file in one message of an upload.
constexpr std::size_t chunk = std::size_t{1} << 20;

std::string sha256_of(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("OpenSSL has no SHA-256");
  }
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < length; ++i) {
    text += digits[digest[i] >> 4];
    text += digits[digest[i] & 15];
  }
  return text;
}

}  // namespace

Client::Client(const std::string& address, Options options)
    : options_(std::move(options)),
      channel_(open_channel(address, options_)),
      scenes_(v1::Scenes::NewStub(channel_)),
      assets_(v1::Assets::NewStub(channel_)),
      robots_(v1::Robots::NewStub(channel_)),
      queries_(v1::Queries::NewStub(channel_)),
      server_(v1::Server::NewStub(channel_)) {}

void Client::prepare(grpc::ClientContext& context, std::optional<std::chrono::milliseconds> timeout) const {
  const auto time = timeout.value_or(options_.timeout);
  if (time.count() > 0) context.set_deadline(std::chrono::system_clock::now() + time);
  if (!options_.token.empty()) context.AddMetadata("authorization", "Bearer " + options_.token);
}

v1::GetServerInfoResponse Client::server_info() {
  return call(server(), &v1::Server::Stub::GetServerInfo, v1::GetServerInfoRequest());
}

Scene Client::create_scene(const std::string& name) {
  v1::CreateSceneRequest request;
  request.set_name(name);
  call(scenes(), &v1::Scenes::Stub::CreateScene, request);
  return scene(name);
}

std::vector<v1::SceneSummary> Client::list_scenes() {
  const auto answer = call(scenes(), &v1::Scenes::Stub::ListScenes, v1::ListScenesRequest());
  return {answer.scenes().begin(), answer.scenes().end()};
}

Robot Client::load_robot(const RobotDescription& description) {
  std::vector<std::string_view> files;
  for (const auto& mesh : description.meshes) files.push_back(mesh.second);
  const auto hashes = upload(files);
  v1::LoadRobotRequest request;
  request.set_urdf(description.urdf);
  if (description.srdf) request.set_srdf(*description.srdf);
  std::size_t i = 0;
  for (const auto& mesh : description.meshes) {
    auto& binding = *request.add_meshes();
    binding.set_filename(mesh.first);
    binding.set_sha256(hashes[i++]);
  }
  request.set_mesh_mode(description.mesh_mode);
  request.set_padding(description.padding);
  request.set_scale(description.scale);
  for (const auto& link : description.links) *request.add_links() = link;
  auto answer = call(robots(), &v1::Robots::Stub::LoadRobot, request);
  return Robot(std::move(*answer.mutable_robot()));
}

std::vector<std::string> Client::upload(const std::vector<std::string_view>& files) {
  std::vector<std::string> hashes;
  if (files.empty()) return hashes;
  v1::HasAssetsRequest request;
  for (const auto file : files) {
    hashes.push_back(sha256_of(file));
    request.add_sha256(hashes.back());
  }
  const auto answer = call(assets(), &v1::Assets::Stub::HasAssets, request);
  std::map<std::string, bool> here;
  for (std::size_t i = 0; i < hashes.size(); ++i) here[hashes[i]] = answer.present(static_cast<int>(i));
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    bool& present = here[hashes[i]];
    if (!present) put_asset(hashes[i], files[i]);
    present = true;
  }
  return hashes;
}

void Client::put_asset(const std::string& sha256, std::string_view file) {
  grpc::ClientContext context;
  prepare(context);
  v1::PutAssetResponse response;
  const auto writer = assets_->PutAsset(&context, &response);
  v1::PutAssetRequest part;
  part.mutable_header()->set_sha256(sha256);
  part.mutable_header()->set_bytes(file.size());
  // A refused upload takes no more parts; the end has the reason.
  bool taken = writer->Write(part);
  for (std::size_t start = 0; taken && start < file.size(); start += chunk) {
    const auto piece = file.substr(start, chunk);
    part.set_chunk(piece.data(), piece.size());
    taken = writer->Write(part);
  }
  writer->WritesDone();
  check(writer->Finish(), context);
}

}  // namespace clearance
